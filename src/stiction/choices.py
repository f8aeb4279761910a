"""What a choice that the paper leaves open does to the crack length of Table III: paired comparison of two readings."""

from dataclasses import dataclass

import numpy as np

from stiction.estimates import mean_with_error


@dataclass(frozen=True)
class Reading:
    """One case under one reading of the paper."""

    energy: np.ndarray  #: meso-scale energies ē of the sampled pairs (m,) [J m⁻²]
    crack_length: np.ndarray  #: of the released beams (n,) [m]
    stuck: np.ndarray  #: whether each ended S-shaped (n,) bool


def mean_crack_length(reading):
    """Mean crack length of the S-shaped beams and its standard error over beams and sampled pairs [m].

    Beams share their finite number of sampled pairs; through l_s ~ ē^(-1/4), Eq. (13), its error adds a quarter of the
    relative error of the mean energy.
    """
    mean, error = mean_with_error(reading.crack_length[reading.stuck])
    energy, energy_error = mean_with_error(reading.energy)
    return mean, np.hypot(error, mean * energy_error / (4 * energy))


def shift(reading, base):
    """Change of the mean crack length from ``base`` to ``reading`` and its standard error over pairs [m].

    Beam k and sample k of both readings use the same random numbers: their differences are the independent samples.
    """
    both = reading.stuck & base.stuck
    mean, error = mean_with_error(reading.crack_length[both] - base.crack_length[both])
    relative = [r.energy / r.energy.mean() for r in (reading, base)]
    _, energy_error = mean_with_error(relative[0] - relative[1])
    return mean, np.hypot(error, base.crack_length[both].mean() * energy_error / 4)


def energy_shift(reading, base):
    """Relative change of the mean meso-scale energy from ``base`` to ``reading`` and its standard error [-]."""
    ratio = reading.energy.mean() / base.energy.mean()
    _, error = mean_with_error(reading.energy / reading.energy.mean() - base.energy / base.energy.mean())
    return ratio - 1, ratio * error


def rms_deviation(values, errors, references):
    """Root mean square of relative deviations from references (n,), with its error for independent values [-]."""
    deviations, errors = np.asarray(values) / references - 1, np.asarray(errors) / references
    rms = np.sqrt(np.mean(deviations**2))
    return rms, np.sqrt(np.sum((deviations * errors) ** 2)) / (len(deviations) * rms)

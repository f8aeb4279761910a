"""What a choice that the paper leaves open does to the crack length of Table III: paired comparison of two readings.

Crack lengths are NaN where fewer than two beams stick.
"""

from dataclasses import dataclass

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.estimates import mean_on_shared_samples, mean_with_error


@dataclass(frozen=True)
class Reading:
    """One case under one reading of the paper."""

    energy: np.ndarray  #: meso-scale energies ē of the sampled pairs (m,) [J m⁻²]
    crack_length: np.ndarray  #: of the released beams (n,) [m]
    stuck: np.ndarray  #: whether each ended S-shaped (n,) bool


def mean_crack_length(reading):
    """Mean crack length of the S-shaped beams and its standard error over beams and sampled pairs [m]."""
    mean, *errors = crack_length_with_errors(reading)
    return mean, np.hypot(*errors)


def crack_length_with_errors(reading):
    """Mean crack length of the S-shaped beams and its standard errors: over beams, and over sampled pairs [m]."""
    if reading.stuck.sum() < 2:
        return np.nan, np.nan, np.nan
    return mean_on_shared_samples(reading.crack_length[reading.stuck], reading.energy, CRACK_LENGTH_POWER)


def shift(reading, base):
    """Change of the mean crack length from ``base`` to ``reading`` and its standard error over pairs [m].

    Beam k and sample k of both readings use the same random numbers: their differences are the independent samples.
    """
    both = reading.stuck & base.stuck
    if both.sum() < 2:
        return np.nan, np.nan
    mean, error = mean_with_error(reading.crack_length[both] - base.crack_length[both])
    relative = [r.energy / r.energy.mean() for r in (reading, base)]
    _, energy_error = mean_with_error(relative[0] - relative[1])
    return mean, np.hypot(error, base.crack_length[both].mean() * CRACK_LENGTH_POWER * energy_error)


def energy_shift(reading, base):
    """Relative change of the mean meso-scale energy from ``base`` to ``reading`` and its standard error [-]."""
    ratio = reading.energy.mean() / base.energy.mean()
    _, error = mean_with_error(reading.energy / reading.energy.mean() - base.energy / base.energy.mean())
    return ratio - 1, ratio * error


def rms_deviation(values, own, common, references):
    """Root mean square of relative deviations from references (n,), with its standard error [-].

    Parameters
    ----------
    values : (n,) array
        One of each case.
    own, common : (n,) arrays
        Standard errors: independent from case to case, and of the samples that all cases share.
    references : (n,) array
    """
    deviations = np.asarray(values) / references - 1
    rms = np.sqrt(np.mean(deviations**2))
    slopes = deviations / (len(deviations) * rms * references)
    return rms, np.hypot(np.linalg.norm(slopes * own), slopes @ common)


def removed_share(values, base, references, errors):
    """Share of the mean square deviation of ``base`` from references that ``values`` do not have, and its error [-].

    Parameters
    ----------
    values, base, references : (n,) arrays
        One of each case.
    errors : (3, n) array
        Standard errors: of values - base, whose parts are common to the cases and add up; of base, independent from
        case to case; of base, common to them. What moves the base moves the values with it.
    """
    before, after = (np.asarray(x) / references - 1 for x in (base, values))
    total, left = np.sum(before**2), np.sum(after**2)
    by_shift, by_base = 2 * after / references / total, 2 * (left / total * before - after) / references / total
    shift, own, common = errors
    parts = np.abs(by_shift) @ shift, np.linalg.norm(by_base * own), by_base @ common
    return 1 - left / total, np.linalg.norm(parts)

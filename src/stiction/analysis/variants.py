"""Effect of a model choice left open by the paper on the crack lengths of Table III: paired comparison of variants.

Crack lengths are NaN if fewer than two beams stick.
"""

from dataclasses import dataclass

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.estimates import mean_on_shared_samples, mean_with_error


@dataclass(frozen=True)
class Variant:
    """Case under one variant of the model."""

    energy: np.ndarray  #: meso-scale adhesion energies ē of the sampled pairs (m,) [J m⁻²]
    crack_length: np.ndarray  #: of the released beams (n,) [m]
    stuck: np.ndarray  #: whether each beam ended S-shaped (n,) bool


def mean_crack_length(variant: Variant) -> tuple[float, float]:
    """Mean crack length of the S-shaped beams and its standard error from beams and sampled pairs [m]."""
    mean, *errors = crack_length_with_errors(variant)
    return mean, np.hypot(*errors)


def crack_length_with_errors(variant: Variant) -> tuple[float, float, float]:
    """Mean crack length of the S-shaped beams and its standard errors from beams and from sampled pairs [m]."""
    if variant.stuck.sum() < 2:
        return np.nan, np.nan, np.nan
    return mean_on_shared_samples(variant.crack_length[variant.stuck], variant.energy, CRACK_LENGTH_POWER)


def shift(variant: Variant, base: Variant) -> tuple[float, float]:
    """Change of the mean crack length from ``base`` to ``variant`` and its standard error [m].

    Beam k and sample k of both variants use the same random numbers: their differences are the independent samples.
    """
    stuck_in_both = variant.stuck & base.stuck
    if stuck_in_both.sum() < 2:
        return np.nan, np.nan
    mean, error = mean_with_error(variant.crack_length[stuck_in_both] - base.crack_length[stuck_in_both])
    relative = [r.energy / r.energy.mean() for r in (variant, base)]
    _, energy_error = mean_with_error(relative[0] - relative[1])
    return mean, np.hypot(error, base.crack_length[stuck_in_both].mean() * CRACK_LENGTH_POWER * energy_error)


def energy_shift(variant: Variant, base: Variant) -> tuple[float, float]:
    """Relative change of the mean meso-scale energy from ``base`` to ``variant`` and its standard error [-]."""
    return relative_shift(variant.energy, base.energy)


def relative_shift(values: np.ndarray, base: np.ndarray) -> tuple[float, float]:
    """Relative change of the mean from ``base`` to ``values`` (m,), paired samples, and its standard error [-]."""
    ratio = values.mean() / base.mean()
    _, error = mean_with_error(values / values.mean() - base / base.mean())
    return ratio - 1, ratio * error


def rms_deviation(
    values: np.ndarray, independent: np.ndarray, common: np.ndarray, references: np.ndarray
) -> tuple[float, float]:
    """Root mean square of relative deviations of values from references (n,), with its standard error [-].

    The values have ``independent`` errors, and ``common`` ones from samples that all cases share, (n,) each.
    """
    deviations = np.asarray(values) / references - 1
    rms = np.sqrt(np.mean(deviations**2))
    slopes = deviations / (len(deviations) * rms * references)
    return rms, np.hypot(np.linalg.norm(slopes * independent), slopes @ common)


def removed_share(
    values: np.ndarray, base: np.ndarray, references: np.ndarray, errors: np.ndarray
) -> tuple[float, float]:
    """Fraction of the mean square deviation of ``base`` from references removed by ``values``, with its error [-].

    There is one of each per case (n,). The standard errors (3, n) are those of values - base, common to the cases, so
    that they add up; of base, independent between cases; and of base, common to the cases. An error of the base shifts
    the values by the same amount.
    """
    before, after = (np.asarray(x) / references - 1 for x in (base, values))
    total, left = np.sum(before**2), np.sum(after**2)
    by_shift, by_base = 2 * after / references / total, 2 * (left / total * before - after) / references / total
    shift, independent, common = errors
    parts = np.abs(by_shift) @ shift, np.linalg.norm(by_base * independent), by_base @ common
    return 1 - left / total, np.linalg.norm(parts)

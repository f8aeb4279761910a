r"""Chart of lengths over thickness and gap: a power law :math:`l = c \, t^\alpha h^\beta` between computed beams.

The powers of Eq. (13) are 3/4 and 1/2; those of beams on rough surfaces differ a little, because a crack stops where
adhesion is strongest, and a longer crack has more places to stop. The power law is fitted to beams by finite elements,
and used only as far as beams that were left out confirm it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from stiction.rounding import is_at_most

#: Largest relative error of a power law that is used.
ALLOWED = 0.01
#: Fewest humidities of which every second one can check a cubic between the others.
FEWEST_HUMIDITIES = 5
#: Humidities at which beams of all sizes are computed.
OF_SIZES = 3


@dataclass(frozen=True)
class PowerLaw:
    """Length c t^α h^β, within the thicknesses and gaps of its fit."""

    prefactor: float  #: c [m^(1 - α - β)]
    thickness_power: float  #: α [-]
    gap_power: float  #: β [-]
    thicknesses: tuple[float, float]  #: smallest and largest t [m]
    gaps: tuple[float, float]  #: smallest and largest h [m]

    def __call__(self, thickness: float | np.ndarray, gap: float | np.ndarray) -> float | np.ndarray:
        """Length [m]. Thickness and gap [m] broadcast.

        Raises
        ------
        ValueError
            If a thickness or a gap is outside of the fitted range.
        """
        for name, values, (low, high) in (("thickness", thickness, self.thicknesses), ("gap", gap, self.gaps)):
            if not (is_at_most(low, np.min(values)) and is_at_most(np.max(values), high)):
                raise ValueError(f"a {name} of {values} m is outside of the computed {low:.3g} to {high:.3g} m")
        return self.prefactor * thickness**self.thickness_power * gap**self.gap_power


def fit_power_law(thickness: np.ndarray, gap: np.ndarray, length: np.ndarray) -> PowerLaw:
    """Power law through the dimensions and lengths of computed beams (n,) [m], by least squares of the logarithms.

    A power of a dimension that does not vary is zero: the law then holds at this dimension alone.

    Raises
    ------
    ValueError
        If there are fewer beams than unknowns.
    """
    dimensions = np.log([thickness, gap]).T
    varied = np.array([not is_at_most(np.max(values), np.min(values)) for values in (thickness, gap)])
    terms = np.column_stack([np.ones(len(dimensions)), dimensions[:, varied]])
    solution, _, rank, _ = np.linalg.lstsq(terms, np.log(length), rcond=None)
    if rank < terms.shape[1]:
        raise ValueError(f"{len(length)} beams do not determine a power law: vary thickness and gap independently")
    powers = np.zeros(2)
    powers[varied] = solution[1:]
    ranges = ((float(np.min(values)), float(np.max(values))) for values in (thickness, gap))
    return PowerLaw(float(np.exp(solution[0])), *map(float, powers), *ranges)


def largest_error(law: PowerLaw, thickness: np.ndarray, gap: np.ndarray, length: np.ndarray) -> float:
    """Largest relative error of a power law at beams outside its fit (n,) [-]."""
    return float(np.max(np.abs(law(thickness, gap) / length - 1)))


def checked_power_law(
    thickness: np.ndarray, gap: np.ndarray, length: np.ndarray, test: np.ndarray
) -> tuple[PowerLaw, float]:
    """Power law through the beams not in ``test`` (n,) bool, and its `largest_error` at the others.

    Raises
    ------
    ValueError
        If the error exceeds ``ALLOWED``: more beams, closer to each other, must then be computed.
    """
    law = fit_power_law(thickness[~test], gap[~test], length[~test])
    error = largest_error(law, thickness[test], gap[test], length[test])
    if error > ALLOWED:
        raise ValueError(f"a power law errs by {error:.1%} between the computed beams, more than {ALLOWED:.0%}")
    return law, error


def between(humidities: np.ndarray, lengths: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Lengths between computed ones (n,) at increasing humidities (n,) [-], a monotone cubic of the logarithm [m].

    It never leaves the range of two neighbours (Fritsch and Carlson), so that a computed minimum is the least length.
    """
    return np.exp(PchipInterpolator(humidities, np.log(lengths))(at))


def error_between(humidities: np.ndarray, lengths: np.ndarray) -> float:
    """Largest relative error of `between` at humidities that were left out, NaN for fewer than five of them [-].

    Every second one is left out, apart from the ends. The cubic through all of them has half the distances, so that
    this is more than its own error. It contains the error of simulation of the lengths (n,) [m].
    """
    if len(humidities) < FEWEST_HUMIDITIES or not np.isfinite(lengths).all():
        return np.nan
    left_out = np.arange(1, len(humidities) - 1, 2)
    kept = np.delete(np.arange(len(humidities)), left_out)
    interpolated = between(humidities[kept], lengths[kept], humidities[left_out])
    return float(np.max(np.abs(interpolated / lengths[left_out] - 1)))


def of_sizes(humidities: Sequence[float]) -> list[float]:
    """Driest, middle and wettest of increasing humidities of a chart, or all if they are no more [-].

    Examples
    --------
    >>> of_sizes([0.44, 0.5, 0.6, 0.67, 0.8, 0.92, 0.95])
    [0.44, 0.67, 0.95]
    """
    positions = np.linspace(0, len(humidities) - 1, min(OF_SIZES, len(humidities)))
    return [humidities[round(position)] for position in positions]


#: Normal scores at which the lengths of two sizes are compared: the median, and 1 of 700.
SCORES = np.array([0.0, -3.0])
#: Scores of the quantiles whose line is compared: fewer beams are below them, and more may not stick above.
_FITTED = -2.0, 0.0


def spread_of(quantiles: np.ndarray, scores: np.ndarray) -> np.ndarray:
    """Logarithms of lengths at `SCORES`, (..., 2), by the line through those of the quantiles (..., scores) [m].

    NaN where a quantile between the 2nd percentile and the median is not known.
    """
    used = (scores >= _FITTED[0]) & (scores <= _FITTED[1])
    logarithms, centred = np.log(quantiles[..., used]), scores[used] - scores[used].mean()
    slope = logarithms @ centred / (centred @ centred)
    return logarithms.mean(axis=-1, keepdims=True) + slope[..., None] * (SCORES - scores[used].mean())


def parabola(humidities: Sequence[float], values: np.ndarray, at: float) -> tuple[np.ndarray, np.ndarray]:
    """Values at a humidity, by a parabola through those at three others (3, ...), and their errors (...).

    The error is that of a line between driest and wettest at the middle humidity, where the parabola has none.
    """
    dry, middle, wet = humidities
    share = (middle - dry) / (wet - dry)
    error = np.abs((1 - share) * values[0] + share * values[2] - values[1])
    weights = [
        np.prod([(at - other) / (humidity - other) for other in humidities if other != humidity])
        for humidity in humidities
    ]
    return np.tensordot(weights, values, axes=1), error


def rescaled(lengths: np.ndarray, spread: np.ndarray, ratios: np.ndarray) -> np.ndarray:
    """Lengths of beams of another size (n,) from those of one (n,) with this `spread_of` [m].

    Ratios are the logarithms of those of both sizes at `SCORES` (2,) [-].
    """
    power = 1 + (ratios[1] - ratios[0]) / (spread[1] - spread[0])
    return np.exp(spread[0] + ratios[0] + power * (np.log(lengths) - spread[0]))

r"""Sufficient roughness of a surface: crossings of a length, or a force, with the requirement of a device.

Lengths and forces are known at a few roughnesses. The margin is :math:`\ln (l / l_\mathrm{required})` of a length, or
:math:`-\ln (F / F_\mathrm{required})` of a force: what is positive suffices. Between the known points it is a cubic
that is monotone where they are. It may cross zero several times: a stopper may hold most at a roughness inside a range.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

#: Largest margin that is distinguished: a factor of 1000. No device sticks where the margin is infinite.
LARGEST = np.log(1e3)
#: Positive margin that is next to none.
_LEAST = 1e-12


@dataclass(frozen=True)
class Scale:
    """Coordinate of a quantity in which margins are smooth."""

    coordinate: Callable  #: coordinate of a value
    value: Callable  #: value at a coordinate
    slope: Callable  #: derivative of the value, by the value
    spaced: Callable  #: values from one to another, evenly spaced in the coordinate


def _spaced_by_rests(low, high, number):
    """Shares whose rests of one fall by equal factors."""
    return 1 - np.geomspace(1 - low, 1 - high, number)


#: Scales by name. The variance of surfaces that follow each other falls like the rest of their coherence.
SCALES = {
    "linear": Scale(lambda value: value, lambda coordinate: coordinate, np.ones_like, np.linspace),
    "log": Scale(np.log, np.exp, lambda value: value, np.geomspace),
    "rest": Scale(
        lambda value: -np.log1p(-value),
        lambda coordinate: -np.expm1(-coordinate),
        lambda value: 1 - value,
        _spaced_by_rests,
    ),
}


@dataclass(frozen=True)
class Crossing:
    """Place of zero margin."""

    coordinate: float  #: coordinate of the roughness
    error: float  #: standard error, of the margin and of the cubic between its points


def margins(values: np.ndarray, required: float, more_is_better: bool) -> np.ndarray:
    """Margins (n,) of lengths or forces (n,) to the required one, NaN where unknown.

    Examples
    --------
    >>> margins(np.array([100.0, 200.0, np.inf]), 200.0, more_is_better=True).round(1)
    array([-0.7,  0. ,  6.9])
    """
    with np.errstate(divide="ignore"):
        ratios = np.log(np.asarray(values, float) / required)
    return np.clip(ratios if more_is_better else -ratios, -LARGEST, LARGEST)


def crossings(axis: np.ndarray, margin: np.ndarray, errors: np.ndarray) -> list[Crossing]:
    """All places of zero margin, increasing.

    Parameters
    ----------
    axis : (n,) array
        Coordinate of the roughness, increasing: one in which the margin is smooth, such as ln rms.
    margin : (n,) array
        NaN where it is not known: there are no crossings next to such a point.
    errors : (n,) array
        Standard errors of the margin. ASSUME: between two points it is that of the curve through them, because all
        points have the same random numbers.

    Returns
    -------
    list of Crossing
        ASSUME: the cubic errs as much as it differs from that of Akima, which has other slopes at the points.
    """
    crossed = []
    for points in _known_runs(margin):
        monotone = PchipInterpolator(axis[points], margin[points])
        other = Akima1DInterpolator(axis[points], margin[points])
        for coordinate in _zeros(monotone):
            error = np.hypot(np.interp(coordinate, axis[points], errors[points]), other(coordinate))
            anywhere = _anywhere(coordinate, axis[points], margin[points])
            crossed.append(
                Crossing(coordinate, float(np.hypot(error / abs(monotone.derivative()(coordinate)), anywhere)))
            )
    return crossed


def sufficient(axis: np.ndarray, margin: np.ndarray) -> list[tuple[float, float]]:
    """Ranges of the roughness without a negative margin, increasing. Parameters as of `crossings`.

    Ranges reach a point whose margin is the largest from their inside alone: beside it, the margin may be any.
    """
    ranges, margin = [], np.where(margin >= LARGEST, _LEAST, margin)
    for points in _known_runs(margin):
        monotone, grid = PchipInterpolator(axis[points], margin[points]), axis[points]
        ends = np.array([grid[0], *_zeros(monotone), grid[-1]])
        enough = monotone((ends[:-1] + ends[1:]) / 2) >= 0
        ranges += [(float(low), float(high)) for low, high, holds in zip(ends, ends[1:], enough, strict=False) if holds]
    return ranges


def _known_runs(margin: np.ndarray) -> list[slice]:
    """Runs of at least two neighbouring points with a margin."""
    runs = np.ma.clump_unmasked(np.ma.masked_invalid(margin))
    return [run for run in runs if run.stop - run.start > 1]


def _anywhere(coordinate: float, axis: np.ndarray, margin: np.ndarray) -> float:
    """Standard deviation of a place anywhere between two points, one of them with the largest margin."""
    right = np.searchsorted(axis, coordinate)
    between = slice(right - 1, right + 1)
    return float(np.ptp(axis[between]) / np.sqrt(12)) if np.abs(margin[between]).max() >= LARGEST else 0.0


def _zeros(curve: PchipInterpolator) -> list[float]:
    """Places inside a curve with a change of its sign, without the ends of the curve."""
    roots = np.unique(curve.roots(extrapolate=False).round(12))
    inside = roots[(roots > curve.x[0]) & (roots < curve.x[-1])]
    ends = np.array([curve.x[0], *inside, curve.x[-1]])
    signs = np.sign(curve((ends[:-1] + ends[1:]) / 2))
    return [float(root) for root, before, after in zip(inside, signs, signs[1:], strict=False) if before != after]

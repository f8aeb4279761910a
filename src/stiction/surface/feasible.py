"""Feasible moments of the heights, with a maximum-entropy density, and the nearest ones to others (Sec. II-A).

At skewness 0 a density of the form of Eq. (3) has a kurtosis of at most 3. The moments of a Gaussian surface therefore
lie on the border of the feasible ones, and half of all measurements of a Gaussian surface fall outside.
"""

import functools
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from stiction.errors import NotConverged
from stiction.surface import maxent
from stiction.surface.translation import LARGEST_SCORE

#: ASSUME: moments whose errors are not known are those of this number of independent Gaussian heights. One scan of
#: 10 µm x 10 µm of a surface like B2 contains A m₂ / (4 π² s(0)) = 2036 areas of correlated heights.
SAMPLE = 2000
#: Largest distance of the substituted moments from the measured ones [standard errors]. If the true moments are
#: feasible, measured ones are farther from them with a probability of 5 %; for scans, whose errors are known, of 0.1 %.
#: ASSUME: to refuse a Gaussian surface is worse than to accept one that is beyond the border.
LARGEST_DISTANCE, LARGEST_DISTANCE_OF_SCANS = (float(np.sqrt(-2 * np.log(p))) for p in (0.05, 0.001))

#: Kurtosis above skewness² + 1 that is feasible at any skewness of a surface, and the least one that is sought.
_FEASIBLE, _LEAST = 0.5, 0.05
#: Resolution of the largest kurtosis [-], and of the skewness in standard errors, far below any error of measurement.
_RESOLUTION, _STEP = 1e-5, 1e-2


class Moments(NamedTuple):
    """Feasible moments and their distance from given ones."""

    skewness: float  #: [-]
    kurtosis: float  #: [-]
    distance: float  #: in standard errors [-]; 0 if the given moments are feasible


def _solve(skewness, kurtosis):
    """Maximum-entropy density with all normal scores. Raises the errors of `stiction.surface.maxent`."""
    density = maxent.solve(skewness, kurtosis)
    density.quantile_of_normal(np.array([-LARGEST_SCORE, LARGEST_SCORE]))
    return density


@functools.lru_cache(maxsize=4096)
def is_feasible(skewness: float, kurtosis: float) -> bool:
    """Whether a maximum-entropy density has these moments and covers all normal scores of surfaces."""
    try:
        _solve(skewness, kurtosis)
    except (ValueError, NotConverged):
        return False
    return True


def least_kurtosis(skewness: float) -> float:
    """Kurtosis at a skewness, feasible and a little above the bound of any heights [-].

    Examples
    --------
    >>> least_kurtosis(-1.0), is_feasible(-1.0, least_kurtosis(-1.0))
    (2.05, True)
    """
    return skewness**2 + 1 + _LEAST


@functools.lru_cache(maxsize=4096)
def largest_kurtosis(skewness: float) -> float:
    """Largest feasible kurtosis at a skewness, by bisection [-].

    Examples
    --------
    >>> round(largest_kurtosis(-0.3), 2)
    3.24
    """
    low, high = skewness**2 + 1 + np.array([1, 2]) * _FEASIBLE
    while is_feasible(skewness, float(high)):
        low, high = high, 2 * high
    while high - low > _RESOLUTION:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_feasible(skewness, float(middle)) else (low, middle)
    return float(low)


def sampling_covariance(heights: float) -> np.ndarray:
    """Covariance of skewness and kurtosis of ``heights`` independent Gaussian heights: diag(6, 24) / n, (2, 2) [-]."""
    return np.diag([6.0, 24.0]) / heights


def nearest_feasible(
    skewness: float, kurtosis: float, covariance: np.ndarray | None = None, largest: float = LARGEST_DISTANCE
) -> Moments:
    r"""Feasible moments nearest to measured ones. The measured ones themselves if they are feasible.

    .. math:: d^2 = \delta^\mathsf{T} C^{-1} \delta

    with the difference δ of skewness and kurtosis and the covariance C of their errors of measurement.

    Parameters
    ----------
    skewness, kurtosis : float
        Measured moments, Eq. (2) [-].
    covariance : (2, 2) array, optional
        C [-]; by default that of ``SAMPLE`` independent Gaussian heights.
    largest : float, optional
        Largest accepted d; any if it is infinite [-].

    Raises
    ------
    ValueError
        If no feasible moments are within ``largest``, or no density has the measured ones because their kurtosis is too
        low.
    NotConverged
        If the density is not found because the kurtosis is near its lower bound.

    Examples
    --------
    >>> nearest_feasible(-0.76, 3.9)
    Moments(skewness=-0.76, kurtosis=3.9, distance=0.0)
    >>> [round(x, 2) for x in nearest_feasible(-0.1, 3.05)]
    [-0.1, 3.03, 0.21]
    """
    if is_feasible(skewness, kurtosis):
        return Moments(skewness, kurtosis, 0.0)
    if kurtosis < skewness**2 + 1 + _FEASIBLE:
        _solve(skewness, kurtosis)  # raises: moments near the lower bound are not replaced
    covariance = sampling_covariance(SAMPLE) if covariance is None else np.asarray(covariance, float)
    errors, inverse = np.sqrt(np.diag(covariance)), np.linalg.inv(covariance)

    def on_border(trial):
        """Moments on the border at a skewness, and their distance from the measured ones."""
        border = largest_kurtosis(float(trial))
        off = np.array([trial - skewness, border - kurtosis])
        return Moments(float(trial), border, float(np.sqrt(off @ inverse @ off)))

    straight = on_border(skewness)
    reach = min(straight.distance, largest) * errors[0]  # a point at another skewness beyond it is farther away
    # The largest kurtosis grows with |skewness|: no point within the distance is feasible if this corner is not.
    if largest_kurtosis(float(abs(skewness) + reach)) < kurtosis - largest * errors[1]:
        raise _too_far(skewness, kurtosis, errors, largest)
    sides = [
        minimize_scalar(
            lambda trial: on_border(trial).distance,
            bounds=sorted((skewness, end)),
            method="bounded",
            options={"xatol": _STEP * errors[0]},
        )
        for end in (skewness - reach, skewness + reach)
    ]
    nearest = min(straight, *(on_border(side.x) for side in sides), key=lambda moments: moments.distance)
    if nearest.distance > largest:
        raise _too_far(skewness, kurtosis, errors, largest)
    return nearest


def _too_far(skewness, kurtosis, errors, largest):
    return ValueError(
        f"no maximum-entropy density has moments within {largest:.3g} standard errors ({errors[0]:.2g} and "
        f"{errors[1]:.2g}) of skewness {skewness} and kurtosis {kurtosis}; at this skewness the largest kurtosis is "
        f"{largest_kurtosis(skewness):.4g}"
    )

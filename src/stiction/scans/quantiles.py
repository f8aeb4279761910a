r"""Form of the height density: measured quantiles, their density, and the test of a description by four moments.

Quantiles are heights at normal scores u, as in Eq. (5), of the standardised heights.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc, ndtr, ndtri

from stiction.errors import NotConverged
from stiction.surface import maxent
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import LARGEST_DISTANCE_OF_SCANS, Moments, is_feasible, nearest_feasible
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import Spectrum

#: Scores at which quantiles are measured.
SCORES = np.linspace(-3, 3, 49)
#: Scores at which the form is compared: both sides, the upper tail in more points, as only the highest summits touch.
COMPARED = np.searchsorted(SCORES, (-2.0, 1.0, 2.0, 2.5, 3.0))
#: Fewest correlation areas beyond the outermost measured quantile that is used.
_AREAS_BEYOND = 10
#: Differences of the moments for the slopes of the quantiles.
_STEP = 0.02


def quantiles(scans: Sequence[np.ndarray]) -> np.ndarray:
    """Heights of all scans at `SCORES`, less their mean and over their rms, (49,) [-]."""
    z = np.concatenate([scan[np.isfinite(scan)] for scan in scans])
    return (np.quantile(z, ndtr(SCORES)) - z.mean()) / z.std()


def correlation_areas(spectrum: Spectrum, variance: float, area: float) -> float:
    """Number of areas A m₂ / (4 π² s_Z(0)) with independent heights in a scanned area [-]."""
    return area * variance / (4 * np.pi**2 * float(spectrum(0.0)))


def measured_density(heights: np.ndarray, areas: float) -> MeasuredDensity:
    """Density of measured quantiles (49,) at `SCORES`, of scans with a number of `correlation_areas`.

    Quantiles at scores of ±1 are used of few areas as well.

    Raises
    ------
    ValueError
        If nearly all heights are equal.
    """
    largest = max(-ndtri(min(_AREAS_BEYOND / areas, 0.5)), 1.0)
    inside = np.abs(SCORES) <= largest + 1e-9
    values = np.asarray(heights)[inside]
    if not values[-1] > values[0]:
        raise ValueError("nearly all of the heights are equal")
    return MeasuredDensity(SCORES[inside], values)


@dataclass(frozen=True)
class Feasible:
    """Maximum-entropy density of the moments nearest to the measured ones."""

    density: HeightDensity
    skewness: float  #: [-]
    kurtosis: float  #: [-]
    distance: float  #: from the measured ones in standard errors, 0 if they have a density [-]


def feasible(
    skewness: float,
    kurtosis: float,
    covariance: Callable[[], np.ndarray],
    largest: float = LARGEST_DISTANCE_OF_SCANS,
) -> Feasible | None:
    """Maximum-entropy density of measured moments, or of the nearest feasible ones, or ``None`` if none is near.

    The covariance of both moments (2, 2) is asked for only if they have no density. The largest accepted distance may
    be infinite [standard errors].
    """
    try:
        nearest = (
            Moments(skewness, kurtosis, 0.0)
            if is_feasible(skewness, kurtosis)
            else nearest_feasible(skewness, kurtosis, covariance(), largest)
        )
        return Feasible(maxent.solve(nearest.skewness, nearest.kurtosis), *nearest)
    except (ValueError, NotConverged):
        return None


def compared_slopes(skewness: float, kurtosis: float) -> np.ndarray:
    """Slopes of the compared quantiles of maximum entropy with skewness and kurtosis, (2, 5) [-].

    The differences are taken at a slightly smaller kurtosis and towards a larger |skewness|, where a density exists.

    Raises
    ------
    ValueError, NotConverged
        If there is none nevertheless.
    """
    base, step = kurtosis - _STEP, np.copysign(_STEP / 2, skewness)

    def compared(s, k):
        """Compared heights of the density of a skewness and kurtosis [-]."""
        return maxent.solve(s, k).quantile_of_normal(SCORES[COMPARED])

    centre = compared(skewness, base)
    of_skewness = (compared(skewness + step, base) - centre) / step
    return np.array([of_skewness, (centre - compared(skewness, base - _STEP)) / _STEP])


def goodness(residual: np.ndarray, model_residuals: np.ndarray, scans: int) -> tuple[float, float]:
    """Compare deviations of quantiles from the four-moment density with those of finite scans.

    Residuals are quantiles less those of the density: of all measured scans together (p,), and of single scans drawn
    from the density (n, p), where rows of ``nan`` are left out.

    Returns
    -------
    chi2, p : float
        Squared distance in the covariance of the model scans (χ² of p degrees of freedom if that is known exactly), and
        the probability of a larger one, which counts that it is estimated (Hotelling); ``nan`` without a density.
    """
    model_residuals = model_residuals[np.isfinite(model_residuals).all(axis=1)]
    n, size = model_residuals.shape
    if n <= size or not np.isfinite(residual).all():
        return np.nan, np.nan
    difference = residual - model_residuals.mean(axis=0)
    covariance = np.cov(model_residuals.T) * (1 / scans + 1 / n)
    chi2 = float(difference @ np.linalg.solve(covariance, difference))
    return chi2, float(fdtrc(size, n - size, chi2 * (n - size) / (size * (n - 1))))

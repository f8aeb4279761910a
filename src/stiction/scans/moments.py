r"""Moments of the heights of finite scans, and their covariance in closed form.

The moments are the vector (ln rms, skewness, kurtosis) of Eq. (2). To first order an estimate from a finite scan
differs from the truth by the mean over the scan of the influence functions ψ(z). With ψ(g(u)) expanded in
orthonormal Hermite polynomials, coefficients a_ik, and ρ the autocorrelation of the Gaussian field u, the covariance is

.. math::

    C_{ij} = \sum_k a_{ik} a_{jk} I_k, \quad
    I_k = \frac{1}{L_1 L_2} \iint (1 - |\tau_1| / L_1) (1 - |\tau_2| / L_2) \, \rho(\tau)^k \, d^2\tau .
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq
from scipy.special import chdtrc, erfc, ndtri

from stiction.estimates import jackknife
from stiction.surface.spectrum import Spectrum, autocovariance
from stiction.surface.translation import LARGEST_SCORE, Translation, hermite_coefficients

#: Lags of the radial integral, and trapezoids of the transform per radian of its fastest wave.
_LAGS, _PANELS_PER_RADIAN, _FEWEST_PANELS = 1500, 2, 4000
#: ASSUME: places differ with this probability before scans are compared. The logarithm of τ is uniform from a share to
#: a multiple of the error of a scan then: 1000 errors of 0.2 % are a factor of 7. τ is never taken as zero. Homogeneous
#: scans get larger errors: the median of the growth is 17 % for 2 scans, 9 % for 3, 7 % for 5.
DIFFER, _SCATTER = 0.26, (0.3, 1000.0)
#: Points of the density of τ, and probability beyond the interval that gives the error.
_POINTS, _BEYOND = 80, 0.05


def powers(heights: np.ndarray) -> np.ndarray:
    """Means of z, z², z³, z⁴ over the defined heights, (4,) [m … m⁴]."""
    z = np.asarray(heights, float)[np.isfinite(heights)]
    square = z * z
    return np.array([np.mean(values) for values in (z, square, square * z, square * square)])


def central_moments(m1: np.ndarray, p2: np.ndarray, p3: np.ndarray, p4: np.ndarray) -> tuple[np.ndarray, ...]:
    """Central moments of orders 2, 3 and 4 from the means of z, z², z³ and z⁴ [m², m³, m⁴]."""
    return p2 - m1**2, p3 - 3 * m1 * p2 + 2 * m1**3, p4 - 4 * m1 * p3 + 6 * m1**2 * p2 - 3 * m1**4


def moments(powers: np.ndarray) -> np.ndarray:
    """Moments (ln rms, skewness, kurtosis) from the means of the powers of the heights, (..., 4) -> (..., 3) [-].

    The rms is in metres.
    """
    m2, m3, m4 = central_moments(*np.moveaxis(np.asarray(powers, float), -1, 0))
    return np.stack([np.log(m2) / 2, m3 / m2**1.5, m4 / m2**2], axis=-1)


def influence(powers: np.ndarray, skewness: float, kurtosis: float) -> np.ndarray:
    """Influence functions ψ of (ln rms, skewness, kurtosis), (3, ...) [-].

    They are linear in the powers z, z², z³, z⁴ of standardised heights, of which means may be given as well, (4, ...)
    [-].
    """
    first, second, third, fourth = powers
    spread = second - 1
    return np.array(
        [
            spread / 2,
            third - skewness - 3 * first - 1.5 * skewness * spread,
            fourth - kurtosis - 4 * skewness * first - 2 * kurtosis * spread,
        ]
    )


def moments_of(translation: Translation) -> np.ndarray:
    """Moments (ln rms, skewness, kurtosis) of the standardised heights of a translation, (3,) [-]."""
    score = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, len(translation.table))
    share = np.exp(-(score**2) / 2)
    return moments(_table_powers(translation) @ (share / share.sum()))


def _table_powers(translation):
    """Powers z, z², z³, z⁴ of the tabulated heights, (4, n)."""
    return translation.table ** np.arange(1, 5)[:, None]


def covariance(translation: Translation, underlying: Spectrum, size: tuple[float, float], reach: float) -> np.ndarray:
    """Covariance of (ln rms, skewness, kurtosis) of one scan, (3, 3) [-].

    Parameters
    ----------
    translation : Translation
        Eq. (5), of the standardised heights.
    underlying : Spectrum
        Of the Gaussian field; its scale has no effect.
    size : (L1, L2)
        Of the scan [m].
    reach : float
        Lag up to which the autocorrelation of ``underlying`` is known; there it must have vanished [m].
    """
    _, skewness, kurtosis = moments_of(translation)
    coefficients = hermite_coefficients(influence(_table_powers(translation), skewness, kurtosis))
    overlaps = overlap_integrals(underlying, size, reach, len(coefficients))
    return np.einsum("ki,kj,k->ij", coefficients, coefficients, overlaps)


def overlap_integrals(underlying: Spectrum, size: tuple[float, float], reach: float, terms: int) -> np.ndarray:
    """Integrals I_1 … I_terms of the powers of the autocorrelation over the scan, (terms,) [-].

    The angle is integrated in closed form; lags beyond the shorter side have a negligible weight.
    """
    longest = min(*size, reach)
    lag = longest * np.linspace(0, 1, _LAGS) ** 2  # dense near 0, where high powers decay
    panels = max(_FEWEST_PANELS, int(_PANELS_PER_RADIAN * underlying.cutoff * longest))
    rho = autocovariance(underlying, lag, panels)
    angle = 2 * np.pi - 4 * lag * (1 / size[0] + 1 / size[1]) + 2 * lag**2 / (size[0] * size[1])
    rows = (rho / rho[0]) ** np.arange(1, terms + 1)[:, None] * angle * lag
    return np.trapezoid(rows, lag) / (size[0] * size[1])


def mode_covariance(translation: Translation, overlaps: np.ndarray, orders: Sequence[int]) -> np.ndarray:
    """Covariance of ln rms and of the means over a scan of Hermite polynomials of n orders k >= 1, (1 + n, 1 + n) [-].

    The means are those that change measured heights, see `stiction.analysis.shifts`. They are uncorrelated and have the
    variances I_k, given as I_1 … I_24; the translation of Eq. (5) is that of the standardised heights.
    """
    _, skewness, kurtosis = moments_of(translation)
    of_rms = hermite_coefficients(influence(_table_powers(translation), skewness, kurtosis)[0])
    chosen = np.array(orders) - 1
    covariance = np.diag([of_rms**2 @ overlaps, *overlaps[chosen]])
    covariance[0, 1:] = covariance[1:, 0] = (of_rms * overlaps)[chosen]
    return covariance


def homogeneity(per_scan: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Scatter between scans against the scatter of finite scans of one surface: χ² and its probability.

    From the moments of every scan (n, 3) and their covariance for one scan (3, 3).

    Returns
    -------
    chi2, p : (3,) arrays
        Sum of the squared deviations from the mean in standard errors, and the probability of a larger one; ``nan``
        for a single scan.
    """
    freedom = len(per_scan) - 1
    if freedom == 0:
        return np.full(3, np.nan), np.full(3, np.nan)
    chi2 = np.sum((per_scan - per_scan.mean(axis=0)) ** 2, axis=0) / np.diag(covariance)
    return chi2, chdtrc(freedom, chi2)


def growth(values: np.ndarray, variances: np.ndarray, weights: np.ndarray) -> float:
    r"""Error of the weighted mean at another place over that on one homogeneous surface, at least 1 [-].

    Scan i of n errs by a known variance vᵢ about the value of its place, and places scatter by an unknown τ about their
    mean. The mean :math:`\sum w_i x_i` therefore differs from another place, where a device is built, by the variance
    :math:`\sum w_i^2 v_i + \tau^2 (1 + \sum w_i^2)`. τ has a posterior density by the scatter of the scans; where that
    is clear, the interval is Student's t.
    The error is the half width of the 95 % interval over 1.96. It is 1 for a single scan, which shows no other place.

    Parameters
    ----------
    values, variances : (n,) arrays
        A quantity of every scan, and the variance by which it errs on a homogeneous surface.
    weights : (n,) array
        Of the scans in the mean, of sum 1.

    Examples
    --------
    >>> alike, thirds = np.array([-1.0, 0.0, 1.0]), np.full(3, 1 / 3)
    >>> [round(growth(size * alike, np.ones(3), thirds), 1) for size in (1, 3, 10)]
    [1.1, 11.9, 43.6]
    """
    if len(values) < 2:
        return 1.0
    squares = np.r_[0.0, np.geomspace(*_SCATTER, _POINTS) ** 2] * np.median(variances)
    prior = np.r_[1 - DIFFER, np.full(_POINTS, DIFFER / _POINTS)]
    likelihood = _log_likelihood(values, variances + squares[:, None])
    share = prior * np.exp(likelihood - likelihood.max())
    alone = weights**2 @ variances
    widths = np.sqrt(2 * (alone + squares * (1 + weights @ weights)))
    half = brentq(lambda z: share @ erfc(z / widths) / share.sum() - _BEYOND, 0, 10 * widths.max())
    return max(float(half / -ndtri(_BEYOND / 2) / np.sqrt(alone)), 1.0)


def _log_likelihood(values, variances):
    """Restricted log-likelihood of values (n,) with an unknown mean, for each row of variances (m, n), (m,)."""
    weight = 1 / variances
    total = weight.sum(axis=1)
    deviation = values - (weight @ values / total)[:, None]
    return -(np.log(variances).sum(axis=1) + np.log(total) + np.sum(weight * deviation**2, axis=1)) / 2


def tiles(scan: np.ndarray, sides: int) -> list[np.ndarray]:
    """Equal tiles of a map (n1, n2), ``sides`` along each side. A remainder at the far edges is left out."""
    rows, columns = (n // sides for n in scan.shape)
    return [
        scan[i * rows : (i + 1) * rows, j * columns : (j + 1) * columns] for i in range(sides) for j in range(sides)
    ]


def tile_errors(scans: Sequence[np.ndarray], sides: int) -> np.ndarray:
    """Standard errors of the pooled moments from the scatter between tiles of the scans, (3,) [-]."""
    rows = np.array([powers(tile) for scan in scans for tile in tiles(scan, sides) if np.isfinite(tile).any()])
    return jackknife(moments, rows)[1]

"""Maximum-entropy density of the surface heights (Sec. II-A), in standardised heights z / rms."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtri_exp

from stiction.errors import NotConverged

#: Heights beyond this many rms have a negligible share in the moments (B1 needs 10).
SUPPORT = 15.0
_HEIGHTS = np.linspace(-SUPPORT, SUPPORT, 6001)
_STEP = _HEIGHTS[1] - _HEIGHTS[0]
_POWERS = _HEIGHTS ** np.arange(1, 5)[:, None]
#: A more distant mode is unphysical for a rough surface: the moments are close to the line without solution.
_FARTHEST_MODE = 5.0


@dataclass(frozen=True)
class HeightDensity:
    """Density exp(-λ₀ - Σ λᵢ zⁱ) of the standardised height, Eq. (3)."""

    multipliers: tuple[float, float, float, float]  #: λ₁ … λ₄ [-]

    @cached_property
    def log_normalisation(self) -> float:
        """Multiplier λ₀ [-]."""
        return _log_partition(np.asarray(self.multipliers))[0]

    def __call__(self, height: float | np.ndarray) -> float | np.ndarray:
        """Probability density at the standardised ``height``, any shape [-]."""
        exponent = np.polynomial.polynomial.polyval(height, (self.log_normalisation, *self.multipliers))
        return np.exp(-exponent)

    def moment(self, order: int) -> float:
        """Moment of the standardised height, Eq. (1) [-]."""
        return float(np.sum(_HEIGHTS**order * self(_HEIGHTS)) * _STEP)

    @cached_property
    def _normal_score(self):
        """Heights (n,) and their normal scores u = Φ⁻¹(C_Z(z)), (n,)."""
        panels = 0.5 * (self(_HEIGHTS[1:]) + self(_HEIGHTS[:-1])) * _STEP
        below = np.log(np.maximum(np.cumsum(panels)[:-1], 1e-300))
        # The upper tail governs the contact; it would be lost to rounding in 1 - CDF.
        above = np.log(np.maximum(np.cumsum(panels[::-1])[::-1][1:], 1e-300))
        score = np.where(below < above, ndtri_exp(np.minimum(below, 0)), -ndtri_exp(np.minimum(above, 0)))
        inside = (np.abs(score) < 9) & np.r_[True, np.diff(score) > 0]
        return _HEIGHTS[1:-1][inside], score[inside]

    def quantile_of_normal(self, score: float | np.ndarray) -> np.ndarray:
        """Height C_Z⁻¹(Φ(u)) of the normal score u, Eq. (5), any shape, |u| <= 8 [-].

        Raises
        ------
        ValueError
            If the tails are so heavy that a score corresponds to a height beyond ``SUPPORT``.
        """
        from scipy.interpolate import PchipInterpolator  # takes 0.3 s, and only jobs that draw surfaces need it

        height, scores = self._normal_score
        if np.any((score < scores[0]) | (score > scores[-1])):
            raise ValueError(
                f"heights within {SUPPORT:g} rms cover normal scores from {scores[0]:.3g} to {scores[-1]:.3g} only: "
                f"the tails of the density with multipliers {self.multipliers} are too heavy"
            )
        return PchipInterpolator(scores, height, extrapolate=False)(score)


#: Heights of a Gaussian surface; its translation is the identity.
GAUSSIAN = HeightDensity((0.0, 0.5, 0.0, 0.0))


def solve(skewness: float, kurtosis: float, tolerance: float = 1e-10, max_iterations: int = 100) -> HeightDensity:
    """Find the density of largest entropy with mean 0, variance 1 and these moments: Newton on the convex dual.

    Parameters
    ----------
    skewness, kurtosis : float
        Eq. (2) [-].
    tolerance : float
        Largest error of the four moments [-].
    max_iterations : int

    Raises
    ------
    ValueError
        If no density has these moments, or none of the form of Eq. (3) that describes a surface.
    NotConverged
        If Newton's method does not converge.

    Examples
    --------
    >>> [round(x, 4) for x in solve(-0.76, 3.9).multipliers]
    [-0.4222, 0.5278, 0.161, 0.02]
    """
    if not kurtosis > skewness**2 + 1:
        raise ValueError(f"need kurtosis > skewness² + 1 = {skewness**2 + 1:.4g}, got kurtosis {kurtosis}")
    target = np.array([0.0, 1.0, skewness, kurtosis])
    multipliers, residual = np.array(GAUSSIAN.multipliers), np.inf
    for _ in range(max_iterations):
        objective, moments, covariance = _dual(multipliers, target)
        residual = np.abs(moments - target).max()
        if residual < tolerance:
            break
        try:
            step = np.linalg.solve(covariance, moments - target)
        except np.linalg.LinAlgError:
            raise _no_solution(skewness, kurtosis) from None
        multipliers = _line_search(multipliers, step, objective, target)
    else:
        raise NotConverged(
            f"maximum entropy at skewness {skewness}, kurtosis {kurtosis}", residual, tolerance, max_iterations
        )
    if not _belongs_to_a_surface(multipliers):
        raise _no_solution(skewness, kurtosis)
    return HeightDensity(tuple(map(float, multipliers)))


def _log_partition(multipliers):
    """Return log ∫ exp(-Σ λᵢ zⁱ) dz and the normalised weights of the heights, (n,)."""
    exponent = -multipliers @ _POWERS
    largest = exponent.max()
    weights = np.exp(exponent - largest)
    total = weights.sum()
    return largest + np.log(total * _STEP), weights / total


def _dual(multipliers, target):
    """Value of the dual, moments (4,) and their covariance (4, 4) = Hessian."""
    log_partition, weights = _log_partition(multipliers)
    moments = _POWERS @ weights
    covariance = (_POWERS * weights) @ _POWERS.T - np.outer(moments, moments)
    return log_partition + multipliers @ target, moments, covariance


def _line_search(multipliers, step, objective, target):
    """Halve the Newton step until the convex dual does not rise beyond rounding."""
    for halving in range(40):
        trial = multipliers + step * 0.5**halving
        if _dual(trial, target)[0] <= objective + 1e-13:
            return trial
    return trial


def _belongs_to_a_surface(multipliers):
    """Whether all extrema of the density are near the mean. A density rising again (λ₄ < 0) also has a distant one."""
    slope = np.polynomial.Polynomial([multipliers[0], *(np.arange(2, 5) * multipliers[1:])])
    roots = slope.trim(1e-12).roots()
    return np.abs(roots[np.abs(roots.imag) < 1e-9].real).max() < _FARTHEST_MODE


def _no_solution(skewness, kurtosis):
    return ValueError(
        f"no maximum-entropy density for skewness {skewness} with kurtosis {kurtosis}: near skewness 0 a kurtosis > 3 "
        "would need a second, distant mode; decrease the kurtosis or increase the skewness"
    )

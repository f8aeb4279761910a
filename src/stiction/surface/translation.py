"""Translate a Gaussian field to the heights of a non-Gaussian one and back (Sec. II-B2).

A surface of unit variance is z = g(u), with u a standard Gaussian field and g = C_Z⁻¹ ∘ Φ, Eq. (5). In orthonormal
Hermite polynomials g = Σ c_k h_k, so the autocorrelation of z is Σ c_k² ρ^k, where ρ is the autocorrelation of u.
Solving for ρ gives the spectrum of u without sampling.

DEPARTS: Fig. 4 iterates with the periodogram of one surface, whose noise remains in s_ZG; the closed form is the
noise-free limit of that iteration.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy import fft

from stiction.errors import NotConverged
from stiction.kernels import kernel
from stiction.surface.spectrum import Spectrum, TabulatedSpectrum, require_resolved, ring_means

#: Largest normal score considered; the probability of a larger one is 1e-15.
LARGEST_SCORE = 8.0
_SCORES = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 4097)
_TERMS = 24


class Density(Protocol):
    """Density of the standardised heights. All classes with this signature are interchangeable."""

    def __call__(self, height: float | np.ndarray) -> float | np.ndarray:
        """Probability density at the standardised ``height``, any shape [-]."""

    def quantile_of_normal(self, score: float | np.ndarray) -> np.ndarray:
        """Standardised height C_Z⁻¹(Φ(u)) of the normal score u, Eq. (5), any shape, |u| <= ``LARGEST_SCORE`` [-]."""


class TranslationMap(Protocol):
    """Monotone map g of Eq. (5) from normal scores to standardised heights."""

    @property
    def table(self) -> np.ndarray:
        """Heights g(u) at equally spaced scores in ±``LARGEST_SCORE``, (n,) [-]."""

    def autocorrelation(self, underlying: np.ndarray) -> np.ndarray:
        """Autocorrelation of the heights, from the Gaussian field's, any shape [-]."""

    def underlying_autocorrelation(self, autocorrelation: np.ndarray) -> np.ndarray:
        """Inverse of `autocorrelation`, any shape [-]."""


@dataclass(frozen=True)
class Translation:
    """`TranslationMap` of a height density: g = C_Z⁻¹ ∘ Φ, Eq. (5)."""

    density: Density

    @cached_property
    def table(self) -> np.ndarray:
        """Heights g(u) at equally spaced scores in ±``LARGEST_SCORE``, (4097,) [-]."""
        return self.density.quantile_of_normal(_SCORES)

    @cached_property
    def hermite_coefficients(self) -> np.ndarray:
        """Coefficients c₁ … c₂₄ on orthonormal Hermite polynomials, (24,) [-]."""
        return hermite_coefficients(self.table)

    def __call__(self, score: float | np.ndarray) -> float | np.ndarray:
        """Standardised height g(u), Eq. (5), any shape [-]."""
        return np.interp(score, _SCORES, self.table)

    def autocorrelation(self, underlying: float | np.ndarray) -> float | np.ndarray:
        """Autocorrelation Σ c_k² ρ^k of the heights, from the Gaussian field's, any shape [-]."""
        return _polynomial(underlying, self._series)

    def underlying_autocorrelation(
        self, autocorrelation: float | np.ndarray, tolerance: float = 1e-12, max_iterations: int = 50
    ) -> np.ndarray:
        """Invert :meth:`autocorrelation` by Newton's method, any shape [-].

        Raises
        ------
        ValueError
            If an autocorrelation is below the lowest that the translation can produce.
        NotConverged
            If Newton's method does not converge.
        """
        lowest = self.autocorrelation(-1.0)
        if np.min(autocorrelation) < lowest:
            raise ValueError(
                f"autocorrelations of this surface are at least {lowest:.4g}, got {np.min(autocorrelation):.4g}"
            )
        slope = np.polynomial.polynomial.polyder(self._series)
        rho, error = np.array(autocorrelation, float), np.inf
        for _ in range(max_iterations):
            error = self.autocorrelation(rho) - autocorrelation
            if np.abs(error).max() < tolerance:
                return rho
            rho -= error / _polynomial(rho, slope)
        raise NotConverged("underlying autocorrelation", np.abs(error).max(), tolerance, max_iterations)

    @cached_property
    def _series(self):
        power = self.hermite_coefficients**2
        return np.r_[0.0, power / power.sum()]


def _polynomial(x, coefficients):
    """Polynomial with these coefficients, of x⁰ first, any shape."""
    return _horner(np.ravel(np.asarray(x, float)), coefficients).reshape(np.shape(x))[()]


@kernel
def _horner(x, coefficients):
    """Horner's rule for many x, (n,), in parts small enough for the cache of the processor."""
    result = np.full(len(x), coefficients[-1])
    for start in range(0, len(x), 256):
        block, value = x[start : start + 256], result[start : start + 256]
        for k in range(len(coefficients) - 2, -1, -1):
            for j in range(len(block)):
                value[j] = coefficients[k] + value[j] * block[j]
    return result


def hermite_coefficients(values: np.ndarray) -> np.ndarray:
    """Coefficients c₁ … c₂₄ on orthonormal Hermite polynomials of functions tabulated like `Translation.table`.

    Parameters
    ----------
    values : (..., 4097) array

    Returns
    -------
    (24, ...) array
        In the unit of ``values``.
    """
    weights = np.exp(-(_SCORES**2) / 2) * (_SCORES[1] - _SCORES[0]) / np.sqrt(2 * np.pi) * values
    previous, current = np.zeros_like(_SCORES), np.ones_like(_SCORES)
    coefficients = []
    for k in range(1, _TERMS + 1):
        previous, current = current, (_SCORES * current - np.sqrt(k - 1) * previous) / np.sqrt(k)
        coefficients.append(weights @ current)
    return np.array(coefficients)


def underlying_spectrum(
    target: Spectrum, translation: TranslationMap, spacing: float, points: int = 1024
) -> tuple[TabulatedSpectrum, float]:
    """Spectrum s_ZG of the Gaussian field underlying a surface with spectrum ``target``.

    Parameters
    ----------
    target : Spectrum
        Spectrum s_Z of the heights; its scale has no effect.
    translation : Translation
    spacing : float
        Grid on which the field will be sampled [m]; the cut-off must be below its Nyquist wave number.
    points : int
        Points along each side of the periodic square of the transforms.

    Returns
    -------
    spectrum : TabulatedSpectrum
        Radial, of unit variance [m²].
    defect : float
        Share of the variance that no Gaussian field can represent: negative s_ZG, and s_ZG beyond the cut-off [-].

    Raises
    ------
    ValueError
        If the grid does not resolve the target.
    """
    require_resolved(target.cutoff, spacing)
    zeta, cell = square(spacing, points)
    correlation = fft.fft2(on_square(target, zeta)).real
    rho = _on_one_half(translation.underlying_autocorrelation, correlation / correlation[0, 0])
    density = fft.ifft2(rho).real / cell
    possible = np.where(zeta <= target.cutoff, np.maximum(density, 0), 0)
    defect = np.abs(density - possible).sum() * cell
    return _radial(possible / (possible.sum() * cell), zeta, target.cutoff), float(defect)


def spectrum_of_heights(
    underlying: Spectrum, translation: TranslationMap, spacing: float, points: int = 1024
) -> TabulatedSpectrum:
    """Spectrum of the translated field, of unit variance: inverse of `underlying_spectrum`, with the same errors."""
    require_resolved(underlying.cutoff, spacing)
    zeta, cell = square(spacing, points)
    correlation = fft.fft2(on_square(underlying, zeta)).real
    heights = fft.ifft2(_on_one_half(translation.autocorrelation, correlation / correlation[0, 0])).real / cell
    return _radial(np.maximum(heights, 0), zeta, np.inf)  # rounding may make it negative


def square(spacing: float, points: int) -> tuple[np.ndarray, float]:
    """Wave numbers |ζ| (n, n) of a periodic square and Δζ²."""
    axis = 2 * np.pi * fft.fftfreq(points, spacing)
    return np.hypot(axis[:, None], axis), axis[1] ** 2


def on_square(spectrum: Spectrum, zeta: np.ndarray) -> np.ndarray:
    """Spectrum at all wave numbers of `square`, computed in a quarter and mirrored to the others."""
    numbers = np.arange(len(zeta))
    mirrored = np.minimum(numbers, len(zeta) - numbers)
    quarter = spectrum(zeta[: mirrored.max() + 1, : mirrored.max() + 1])
    return quarter[mirrored[:, None], mirrored]


def _on_one_half(function, values):
    """Function of values (n, n) even in the lag, computed on one half and mirrored to the other."""
    n = len(values)
    half = function(values[:, : n // 2 + 1])
    return np.hstack((half, half[-np.arange(n), n - half.shape[1] : 0 : -1]))


def _radial(spectrum, zeta, cutoff):
    """Average a spectrum over rings up to the Nyquist wave number, over the part of each ring within the cut-off."""
    mean = ring_means(spectrum, zeta <= cutoff)
    rings = min(len(mean), len(zeta) // 2)
    wavenumber = zeta[0, 1] * np.arange(rings)
    return TabulatedSpectrum(wavenumber, mean[:rings], cutoff if np.isfinite(cutoff) else wavenumber[-1])

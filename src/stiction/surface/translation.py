"""From a Gaussian field to the heights of a non-Gaussian one and back (Sec. II-B2).

A surface of unit variance is z = g(u), with u a standard Gaussian field and g = C_Z⁻¹ ∘ Φ, Eq. (5). In orthonormal
Hermite polynomials g = Σ c_k h_k, so the autocorrelation of z is Σ c_k² ρ^k, with ρ that of u. Solved for ρ, this gives
the spectrum of u without sampling.

DEPARTS: Fig. 4 iterates with the periodogram of one surface, whose noise stays in s_ZG; this is where it tends to.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from stiction.errors import NotConverged
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import TabulatedSpectrum

#: Normal scores beyond these do not occur: probability 1e-15.
LARGEST_SCORE = 8.0
_SCORES = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 4097)
_TERMS = 24


@dataclass(frozen=True)
class Translation:
    """The map g of Eq. (5) for standardised heights."""

    density: HeightDensity

    @cached_property
    def table(self):
        """Heights g(u) at equally spaced scores in ±``LARGEST_SCORE``, (4097,) [-]."""
        return self.density.quantile_of_normal(_SCORES)

    @cached_property
    def hermite_coefficients(self):
        """Coefficients c₁ … c₂₄ on orthonormal Hermite polynomials, (24,) [-]."""
        weights = np.exp(-(_SCORES**2) / 2) * (_SCORES[1] - _SCORES[0]) / np.sqrt(2 * np.pi) * self.table
        previous, current = np.zeros_like(_SCORES), np.ones_like(_SCORES)
        coefficients = []
        for k in range(1, _TERMS + 1):
            previous, current = current, (_SCORES * current - np.sqrt(k - 1) * previous) / np.sqrt(k)
            coefficients.append(weights @ current)
        return np.array(coefficients)

    def __call__(self, score):
        """Standardised height g(u), Eq. (5), any shape [-]."""
        return np.interp(score, _SCORES, self.table)

    def autocorrelation(self, underlying):
        """Autocorrelation Σ c_k² ρ^k of the heights, for that of the Gaussian field, any shape [-]."""
        return np.polynomial.polynomial.polyval(underlying, self._series)

    def underlying_autocorrelation(self, autocorrelation, tolerance=1e-12, max_iterations=50):
        """Invert :meth:`autocorrelation` by Newton's method, any shape [-].

        Raises
        ------
        ValueError
            If a correlation lies below what the translation can reach.
        NotConverged
            If Newton's method stalls.
        """
        lowest = self.autocorrelation(-1.0)
        if np.min(autocorrelation) < lowest:
            raise ValueError(
                f"heights of this surface correlate by {lowest:.4g} or more, got {np.min(autocorrelation):.4g}"
            )
        slope = np.polynomial.polynomial.polyder(self._series)
        rho = np.array(autocorrelation, float)
        for _ in range(max_iterations):
            error = self.autocorrelation(rho) - autocorrelation
            if np.abs(error).max() < tolerance:
                return rho
            rho -= error / np.polynomial.polynomial.polyval(rho, slope)
        raise NotConverged("underlying autocorrelation", np.abs(error).max(), tolerance, max_iterations)

    @cached_property
    def _series(self):
        power = self.hermite_coefficients**2
        return np.r_[0.0, power / power.sum()]


def underlying_spectrum(target, translation, spacing, points=1024):
    """Spectrum s_ZG of the Gaussian field behind a surface with spectrum ``target``.

    Parameters
    ----------
    target : CutoffSelfAffine
        Spectrum s_Z of the heights; only its shape counts.
    translation : Translation
    spacing : float
        Grid on which the field will be sampled [m]; the cut-off must lie below its Nyquist number.
    points : int
        Side of the periodic square on which the transforms are made.

    Returns
    -------
    spectrum : TabulatedSpectrum
        Radial, of unit variance [m²].
    defect : float
        Share of the variance that no Gaussian field provides: negative parts of s_ZG, parts beyond the cut-off [-].
    """
    zeta, index, cell = _square(spacing, points)
    correlation = fft.fft2(target(zeta)).real
    rho = translation.underlying_autocorrelation(correlation / correlation[0, 0])
    wanted = fft.ifft2(rho).real / cell
    possible = np.where(zeta <= target.cutoff, np.maximum(wanted, 0), 0)
    defect = np.abs(wanted - possible).sum() * cell
    return _radial(possible / (possible.sum() * cell), zeta, index, target.cutoff), float(defect)


def spectrum_of_heights(underlying, translation, spacing, points=1024):
    """Spectrum of the translated field, of unit variance: the inverse of `underlying_spectrum`."""
    zeta, index, cell = _square(spacing, points)
    correlation = fft.fft2(underlying(zeta)).real
    heights = fft.ifft2(translation.autocorrelation(correlation / correlation[0, 0])).real / cell
    return _radial(heights, zeta, index, np.inf)


def _square(spacing, points):
    """Wave numbers |ζ| (n, n) of a periodic square, the ring each belongs to, and Δζ²."""
    axis = 2 * np.pi * fft.fftfreq(points, spacing)
    zeta = np.hypot(axis[:, None], axis)
    return zeta, np.rint(zeta / axis[1]).astype(int), axis[1] ** 2


def _radial(spectrum, zeta, index, cutoff):
    """Average a spectrum over rings, up to the Nyquist number; rings cut by the cut-off count their inner part."""
    inside = (zeta <= cutoff).ravel()
    ring = index.ravel()[inside]
    mean = np.bincount(ring, spectrum.ravel()[inside]) / np.maximum(np.bincount(ring), 1)
    rings = min(len(mean), len(zeta) // 2)
    wavenumber = zeta[0, 1] * np.arange(rings)
    return TabulatedSpectrum(wavenumber, mean[:rings], cutoff if np.isfinite(cutoff) else wavenumber[-1])

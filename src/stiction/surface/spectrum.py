r"""Power spectral density of an isotropic rough surface (Sec. II-C).

Convention, used everywhere: wave numbers are angular [rad m⁻¹] and

.. math:: m_2 = \iint s_Z(\zeta) \, d\zeta_1 d\zeta_2 ,

so ``s_Z`` is in m⁴ and no :math:`2\pi` appears outside this module. Table II
follows this convention; Eq. (4) does not.
"""

from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np

from stiction.rounding import is_at_most

#: Wavelengths of the corner within which heights become uncorrelated, and corners beyond which waves are too short to
#: correlate heights that far apart: a table of them is not needed.
_REACH, _SHORT = 6.0, 30.0
#: ASSUME: largest density of a surface [m⁴], which only numbers in nm⁴ exceed. The fourth root is a millimetre.
_LARGEST_DENSITY = 1e-12


class Spectrum(Protocol):
    """Isotropic spectrum. All classes with this signature are interchangeable."""

    @property
    def cutoff(self) -> float:
        """Cut-off: wave number without roughness beyond [rad m⁻¹]."""

    @property
    def corner(self) -> float:
        """Corner: wave number at the end of the plateau of the density [rad m⁻¹]."""

    @property
    def variance(self) -> float:
        """Second moment m₂ of the heights [m²]."""

    def __call__(self, wavenumber: float | np.ndarray) -> float | np.ndarray:
        """s_Z at |ζ| [m⁴], shape of ``wavenumber`` [rad m⁻¹]."""


@dataclass(frozen=True)
class CutoffSelfAffine:
    """Plateau, power law, cut-off: Eq. (7). Parameters as in Table II."""

    plateau: float  #: s⁰ [m⁴]
    floor: float  #: s¹, reached at the cut-off [m⁴]
    corner: float  #: ζ₀, end of the plateau [rad m⁻¹]
    cutoff: float  #: ζ_max, no roughness beyond [rad m⁻¹]

    def __post_init__(self):
        if not 0 < self.corner < self.cutoff < np.inf:
            raise ValueError(f"need 0 < corner < cutoff, got {self.corner:.4g}, {self.cutoff:.4g} rad/m")
        if not 0 < self.floor <= self.plateau:
            raise ValueError(f"need 0 < floor <= plateau, got {self.floor:.4g}, {self.plateau:.4g} m⁴")
        if not self.plateau <= _LARGEST_DENSITY:
            raise ValueError(
                f"need plateau <= {_LARGEST_DENSITY:g}, got {self.plateau:.4g} m⁴: convert nm⁴ by the factor 1e-36"
            )

    @property
    def slope(self) -> float:
        """Exponent of the power law, negative [-]."""
        return np.log(self.floor / self.plateau) / np.log(self.cutoff / self.corner)

    def __call__(self, wavenumber: float | np.ndarray) -> float | np.ndarray:
        """s_Z at |ζ| [m⁴], shape of ``wavenumber`` [rad m⁻¹]."""
        decay = np.maximum(wavenumber / self.corner, 1.0) ** self.slope
        return np.where(wavenumber <= self.cutoff, self.plateau * decay, 0.0)

    def moment(self, order: int) -> float:
        r"""Radial moment ∫ s_Z ζ^(order+1) dζ [m⁴ (rad m⁻¹)^(order+2)], in closed form."""
        power = order + 2
        flat = self.corner**power / power
        exponent = power + self.slope
        ratio = self.cutoff / self.corner
        tail = np.log(ratio) if abs(exponent) < 1e-12 else (ratio**exponent - 1) / exponent
        return self.plateau * (flat + self.corner**power * tail)

    @property
    def variance(self) -> float:
        """Second moment m₂ of the heights [m²]."""
        return 2 * np.pi * self.moment(0)


@dataclass(frozen=True)
class TabulatedSpectrum:
    """Spectrum tabulated at equally spaced wave numbers. Zero beyond its cut-off."""

    wavenumber: np.ndarray  #: |ζ|, (n,); below the first the density is constant [rad m⁻¹]
    density: np.ndarray  #: s_Z, (n,) [m⁴] or, for unit variance, [m²]
    cutoff: float  #: no roughness beyond [rad m⁻¹]

    def __post_init__(self):
        zeta, density = np.asarray(self.wavenumber, float), np.asarray(self.density, float)
        if zeta.ndim != 1 or zeta.shape != density.shape or len(zeta) < 2:
            raise ValueError(f"need a density for each of two or more wave numbers, got {density.shape}, {zeta.shape}")
        rising = (zeta >= 0) & (zeta < np.inf) & (np.diff(zeta, prepend=-1.0) > 0)
        if not rising.all():
            raise ValueError(f"need wave numbers from 0 on that increase, got {zeta[np.argmin(rising)]:.4g} rad/m")
        possible = (density >= 0) & (density < np.inf)
        if not possible.all():
            raise ValueError(f"need densities of 0 or more, got {density[np.argmin(possible)]:.4g}")
        if not (0 < self.cutoff < np.inf and np.any(density[zeta <= self.cutoff])):
            raise ValueError(f"need a density above 0 below the cut-off, {self.cutoff:.4g} rad/m")

    def __call__(self, wavenumber: float | np.ndarray) -> float | np.ndarray:
        """s_Z at |ζ|, shape of ``wavenumber`` [rad m⁻¹], in the unit of ``density``."""
        return np.where(wavenumber <= self.cutoff, np.interp(wavenumber, self.wavenumber, self.density), 0.0)

    @property
    def corner(self) -> float:
        """First wave number at less than half of the density at 0 [rad m⁻¹], a bit above the corner of Eq. (7)."""
        below = np.flatnonzero(self(self.wavenumber) < 0.5 * self.density[0])
        return float(self.wavenumber[below[0]]) if len(below) else self.cutoff

    @property
    def variance(self) -> float:
        """Second moment m₂ of the heights, in the unit of ``density`` over m²."""
        return float(2 * np.pi * np.trapezoid(self.wavenumber * self(self.wavenumber), self.wavenumber))


@dataclass(frozen=True)
class NayakSummits:
    """Summits of a continuous Gaussian surface (Nayak): starting point of the identification of a PSD."""

    spectrum: CutoffSelfAffine

    @property
    def profile_moments(self) -> tuple[float, float, float]:
        """Profile spectral moments m₀ [m²], m₂ [-], m₄ [m⁻²]."""
        return (
            2 * np.pi * self.spectrum.moment(0),
            np.pi * self.spectrum.moment(2),
            0.75 * np.pi * self.spectrum.moment(4),
        )

    @property
    def bandwidth(self) -> float:
        """Parameter α = m₀ m₄ / m₂², at least 1.5 [-]."""
        m0, m2, m4 = self.profile_moments
        return m0 * m4 / m2**2

    @property
    def density(self) -> float:
        """Summits per area [m⁻²]."""
        _, m2, m4 = self.profile_moments
        return m4 / (6 * np.pi * np.sqrt(3) * m2)

    @property
    def mean_curvature(self) -> float:
        """Mean curvature of the summits [m⁻¹]."""
        return 8 / 3 * np.sqrt(self.profile_moments[2] / np.pi)


def require_resolved(cutoff: float, spacing: float) -> None:
    """Refuse points too far apart [m] to resolve the waves up to a cut-off [rad m⁻¹]."""
    if not 0 < spacing < np.inf:
        raise ValueError(f"need a distance of the points above 0, got {spacing:.4g} m")
    if not is_at_most(cutoff, np.pi / spacing):
        raise ValueError(
            f"cut-off {cutoff:.4g} rad/m is beyond the Nyquist wave number of the grid, {np.pi / spacing:.4g} rad/m"
        )


def autocovariance(spectrum: Spectrum, lag: np.ndarray, panels: int = 4000, end: float = np.inf) -> np.ndarray:
    """Autocovariance r_Z(τ) = 2π ∫ s_Z J₀(ζτ) ζ dζ of an isotropic spectrum.

    Parameters
    ----------
    spectrum : Spectrum
    lag : (n,) array
        Distances τ [m].
    panels : int
        Number of trapezoids up to the cut-off.
    end : float
        Wave number beyond which waves are left out [rad m⁻¹].

    Returns
    -------
    (n,) array
        In the unit of the heights squared, [m²].
    """
    from scipy.special import j0  # takes 0.2 s, and a plan needs only the numbers of spectra

    zeta = np.linspace(0, min(spectrum.cutoff, end), panels + 1)
    weights = np.full(panels + 1, zeta[1])
    weights[[0, -1]] /= 2
    return 2 * np.pi * j0(np.outer(lag, zeta)) @ (weights * zeta * spectrum(zeta))


def correlation_length(spectrum: Spectrum, threshold: float = 0.01, reach: float = _REACH) -> float:
    """Distance l^m beyond the last correlation r_Z above ``threshold`` · m₂ (Sec. III) [m].

    Searched up to ``reach`` wavelengths of the corner; the slowest decay, that of a pure plateau, needs 4.7.

    Raises
    ------
    ValueError
        If the heights are still correlated at the end of the search.
    """
    lag = np.linspace(0, reach * 2 * np.pi / spectrum.corner, 1201)
    end = _SHORT * spectrum.corner
    covariance = autocovariance(spectrum, lag, panels=1500, end=end)
    if spectrum.cutoff > end:
        covariance[0] = spectrum.variance  # with the waves that are left out
    last = np.flatnonzero(covariance >= threshold * covariance[0])[-1]
    if last == len(lag) - 1:
        raise ValueError(
            f"heights {1e6 * lag[-1]:.3g} µm apart, {reach:g} wavelengths of the corner of their spectrum, are still "
            f"correlated by {threshold:g} or more"
        )
    return float(lag[last])


def uncorrelated_beyond(spectrum: Spectrum) -> float:
    """`correlation_length`, or the end of its search if heights of a measured spectrum are correlated there [m]."""
    try:
        return correlation_length(spectrum)
    except ValueError:
        return _REACH * 2 * np.pi / spectrum.corner


def ring_means(values: np.ndarray, inside: np.ndarray | None = None) -> np.ndarray:
    """Means over rings of equal |ζ| of values (n, n) at the wave numbers of an FFT.

    Parameters
    ----------
    values : (n, n) array
    inside : (n, n) bool array, optional
        Wave numbers included in the means; all by default.

    Returns
    -------
    (n_rings,) float64
        Mean at |ζ| = 0, 1, 2, ... steps of the wave number; 0 for an empty ring.
    """
    counted = slice(None) if inside is None else inside.ravel()
    ring = _rings(len(values))[counted]
    return np.bincount(ring, values.ravel()[counted]) / np.maximum(np.bincount(ring), 1)


@cache
def _rings(n):
    """Number of the ring of every wave number of an FFT of n x n points, (n²,)."""
    axis = np.fft.fftfreq(n, 1 / n)
    return np.rint(np.hypot(axis[:, None], axis)).astype(int).ravel()


def radial_spectrum(values: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Wave number [rad m⁻¹] and `ring_means` from the first ring around 0 to the Nyquist wave number, (n // 2,) each.

    ``values`` (n, n) are at the wave numbers of an FFT, ``step`` [rad m⁻¹] apart.
    """
    rings = len(values) // 2
    return step * np.arange(1, rings + 1), ring_means(values)[1 : rings + 1]

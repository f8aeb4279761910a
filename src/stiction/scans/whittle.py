r"""Spectrum of Eq. (7) from a measured one: Whittle's likelihood, within the reach of the microscope.

The ring means P of a periodogram are s_Z times a χ² variable with 2 n degrees of freedom over 2 n, so that the fit
minimises :math:`\sum n (\ln s_Z + P / s_Z)`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from stiction.scans.periodogram import Rings
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

#: Longest wave of the fit: levelling and taper reduce longer ones.
_LONGEST_WAVE = 1 / 1.5
#: Shortest wave of the fit in pixels, half of the Nyquist wave number: aliases and noise raise the spectrum beyond.
_SHORTEST_WAVE = 4
#: Peak curvatures above this share of that of the tip are not resolved (Sanner et al., 2022).
_TIP_SAFETY = 0.5
#: ASSUME: the errors of rings on non-Gaussian heights exceed those of Gaussian ones by the scatter of drawn scans.
NON_GAUSSIAN = 1.15
#: A spectrum has ended where it is below this share of the fit in all further rings, and the fewest of these.
_ENDED, _RINGS_BEYOND = 0.5, 4
#: Starting points of the search: corners per decade of the range, and exponents of the power law.
_CORNERS, _SLOPES = 12, -np.geomspace(0.5, 12, 16)
#: Steepest and flattest exponent of the search.
_BOUNDS = (-40.0, -0.05)
_POINTS = 2000


@dataclass(frozen=True)
class Reach:
    """Wave numbers that a scan resolves."""

    low: float  #: [rad m⁻¹]
    high: float  #: [rad m⁻¹]
    nyquist: float  #: of the wider distance of points [rad m⁻¹]
    tip: float  #: wave number beyond which the tip rounds the surface; infinite if it does not [rad m⁻¹]
    end: float  #: wave number beyond which the scan shows no roughness, the Nyquist wave number at most [rad m⁻¹]


def reach(
    size: tuple[float, float], pixel: tuple[float, float], shortest: float | None = None, tip: float = np.inf
) -> Reach:
    """Reach of a scan with this size and these distances of its points [m].

    The shortest wavelength used is by default four pixels, half of the Nyquist wave number [m]; ``tip`` is the reach of
    the tip, `tip_reach` [rad m⁻¹].
    """
    nyquist = np.pi / max(pixel)
    high = 2 * np.pi / (_SHORTEST_WAVE * max(pixel) if shortest is None else shortest)
    return Reach(2 * np.pi / (_LONGEST_WAVE * min(size)), min(high, nyquist, tip), nyquist, tip, nyquist)


def tip_reach(scans: Sequence[np.ndarray], pixel: float, radius: float) -> float:
    """Wave number beyond which a tip of a radius [m] rounds the surface [rad m⁻¹].

    The largest peak curvature h'' over a stencil along the fast axis, the first of the scans (n1, n2) [m], decreases
    with the length of the stencil; where it is that of the tip, less a margin, ends the reach. The pixel is that along
    this axis [m].
    """
    halves = np.arange(1, (len(scans[0]) - 1) // 4)
    curvature = np.array([max(_peak_curvature(z, half, pixel) for z in scans) for half in halves])
    sharp = np.flatnonzero(curvature > _TIP_SAFETY / radius)
    if len(sharp) == 0:
        return np.inf
    last = min(sharp[-1], len(halves) - 2)
    part = np.interp(-_TIP_SAFETY / radius, -curvature[[last, last + 1]], [0, 1])
    return np.pi / (pixel * (halves[last] + part))


def _peak_curvature(z, half, pixel):
    """Largest -h'' over stencils of ``2 half`` pixels along the fast axis [m⁻¹]."""
    return np.nanmax(2 * z[half:-half] - z[: -2 * half] - z[2 * half :]) / (half * pixel) ** 2


@dataclass(frozen=True)
class WhittleFit:
    """Plateau and power law of Eq. (7) that fit a measured spectrum."""

    plateau: float  #: s⁰ [m⁴]
    corner: float  #: ζ₀ [rad m⁻¹]
    slope: float  #: exponent of the power law [-]
    covariance: np.ndarray  #: of (ln plateau, ln corner, slope), (3, 3) [-]
    chi2: float  #: sum over the rings of the squared relative deviations in standard errors [-]
    freedom: int  #: rings less parameters

    def spectrum(self, cutoff: float) -> CutoffSelfAffine:
        """Eq. (7) with a cut-off [rad m⁻¹]."""
        return CutoffSelfAffine(self.plateau, self.plateau * (cutoff / self.corner) ** self.slope, self.corner, cutoff)


def fit_to_the_end(rings: Rings, within: Reach) -> tuple[WhittleFit, Reach]:
    """`fit` up to the end of the measured spectrum at most, and the reach with that end.

    Aliases and noise raise a spectrum, so that a drop is real: the surface, or what tip and instrument leave of it, has
    no shorter waves.
    """
    while True:
        fitted = fit(rings, within)
        end = _end(rings, within, fitted)
        if end >= within.high:
            return fitted, replace(within, end=end)
        within = replace(within, high=end)


def _end(rings, within, fitted):
    """Wave number beyond which all rings are below half of the fit; the Nyquist one if there is none [rad m⁻¹]."""
    known = rings.between(within.low, within.nyquist)
    last = np.flatnonzero(known.density >= _ENDED * fitted.spectrum(within.nyquist)(known.wavenumber))[-1]
    if len(known.wavenumber) - 1 - last < _RINGS_BEYOND:
        return within.nyquist
    return float(known.wavenumber[last : last + 2].mean())


def fit(rings: Rings, within: Reach) -> WhittleFit:
    """Fit plateau, corner and slope of Eq. (7) to the rings within the reach.

    Where Eq. (7) misfits, the covariance grows by χ² per degree of freedom.

    Raises
    ------
    ValueError
        If fewer than 8 rings are within the reach.
    """
    known = rings.between(within.low, within.high)
    wavenumber, density, weight = known.wavenumber, known.density, known.weight
    if len(wavenumber) < 8:
        raise ValueError(f"8 rings are needed within the reach of the scan, there are {len(wavenumber)}")

    def objective(parameters):
        shape = _shape(wavenumber, *parameters)
        plateau = np.average(density / shape, weights=weight)
        return np.log(plateau) + np.average(np.log(shape), weights=weight)  # P / s is 1 on average at its optimum

    decades = np.log10(wavenumber[-1] / wavenumber[0])
    corners = np.linspace(*np.log(wavenumber[[0, -1]]), int(_CORNERS * decades) + 3)[:-1]
    start = min(((corner, slope) for corner in corners for slope in _SLOPES), key=objective)
    bounds = [(np.log(wavenumber[0] / 4), np.log(wavenumber[-1])), _BOUNDS]
    corner, slope = minimize(
        objective, start, method="Nelder-Mead", bounds=bounds, options={"xatol": 1e-5, "fatol": 1e-10}
    ).x
    shape = _shape(wavenumber, corner, slope)
    plateau = np.average(density / shape, weights=weight)
    chi2, freedom = float(np.sum(known.modes * (density / (plateau * shape) - 1) ** 2)), len(wavenumber) - 3
    covariance = max(chi2 / freedom, 1.0) * _covariance(wavenumber, weight, corner, slope)
    return WhittleFit(float(plateau), float(np.exp(corner)), float(slope), covariance, chi2, freedom)


def _shape(wavenumber, log_corner, slope):
    """Eq. (7) with a plateau of 1 and without cut-off."""
    return np.maximum(wavenumber / np.exp(log_corner), 1.0) ** slope


def _covariance(wavenumber, weight, log_corner, slope):
    """Inverse of Fisher's information for (ln plateau, ln corner, slope), (3, 3)."""
    decay = np.log(wavenumber) - log_corner
    gradient = np.where(decay > 0, [np.ones_like(decay), np.full_like(decay, -slope), decay], 0.0)
    gradient[0] = 1.0
    return NON_GAUSSIAN**2 * np.linalg.pinv(gradient * weight @ gradient.T, hermitian=True)


def tabulated(rings: Rings, within: Reach, slope: float, cutoff: float) -> TabulatedSpectrum:
    """Measured spectrum itself: log-log interpolation of the rings within the reach, up to a cut-off [rad m⁻¹].

    ASSUME: the first ring continues to 0, and the last one to the cut-off as the power law of the fit, with this slope:
    rings beyond the reach hold aliases.
    """
    inside = rings.between(within.low, within.high)
    known, wavenumber = inside.wavenumber, np.linspace(0, cutoff, _POINTS)
    inner = np.interp(np.log(np.maximum(wavenumber, known[0])), np.log(known), np.log(inside.density))
    beyond = slope * np.log(np.maximum(wavenumber / known[-1], 1.0))
    return TabulatedSpectrum(wavenumber, np.exp(inner + beyond), cutoff)

r"""Spectrum along a line of an isotropic surface, and the fit of Eq. (7) to it.

The spectrum along a line is the projection of that of the surface, no cut through it:

.. math:: C(k) = \int_{-\infty}^{\infty} s_Z(\sqrt{k^2 + q^2}) \, dq , \quad \int C \, dk = m_2 .

Every wave that is oblique to the line adds to a longer one along it. C therefore falls with a slope that is flatter by
1 than that of s_Z, and bends below the corner. An inversion of C takes its derivative, which noise spoils: Eq. (7) is
fitted by its own C instead.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft
from scipy.optimize import minimize
from scipy.special import beta, betainc

#: Share of a line that is tapered, and wave numbers that levelling changes, in steps from 0.
_TAPERED, _LEVELLED = 0.5, 2
#: Points per shortest wave that is used by default.
_SHORTEST_WAVE = 4.0
#: Least and largest exponent of the search, and exponents and corners that it starts from. C is finite below -1.
_SLOPES, _START = (-12.0, -1.2), (-np.geomspace(1.5, 9, 8), 12)
#: Logarithm of the longest wave of the corner over the longest one used.
_LONGER = np.log(2)
#: Logarithms of the least and largest noise over the spectrum along a line at 0.
_NOISE = (-16.0, 0.0)
#: Fewest groups of wave numbers of a fit, and their width relative to the wave number.
FEWEST_WAVES, _WIDTH = 16, 0.03


def line_spectrum(wavenumber: np.ndarray, corner: float, slope: float) -> np.ndarray:
    r"""Spectrum along a line of Eq. (7) with a plateau of 1 and no cut-off, in closed form.

    With n the exponent, positive, ζ₀ the corner and t = min(1, k²/ζ₀²), it is

    .. math:: 2 \sqrt{(\zeta_0^2 - k^2)_+} + \zeta_0^n k^{1-n} B_t(\tfrac{n-1}{2}, \tfrac12) .

    Parameters
    ----------
    wavenumber : (n,) array
        Along the line, above 0 [rad m⁻¹].
    corner : float
        [rad m⁻¹].
    slope : float
        Exponent of s_Z, below -1 [-].

    Returns
    -------
    (n,) array
        Over the plateau [rad m⁻¹].

    Examples
    --------
    >>> round(float(line_spectrum(np.array([2.0]), 1.0, -3.0)[0]), 9)  # 2 ζ₀³ / k² beyond the corner
    0.5
    """
    half = (-slope - 1) / 2
    inside = np.minimum(wavenumber / corner, 1.0)
    tail = beta(half, 0.5) * betainc(half, 0.5, inside**2) * (wavenumber / corner) ** (1 + slope)
    return corner * (2 * np.sqrt(1 - inside**2) + tail)


@dataclass(frozen=True)
class Waves:
    """Periodogram of lines, averaged over groups of neighbouring wave numbers."""

    wavenumber: np.ndarray  #: rising, (n,) [rad m⁻¹]
    power: np.ndarray  #: C, (n,) [m³]
    weight: np.ndarray  #: independent values of each: the relative variance of ``power`` is 1 / weight, (n,) [-]

    @cached_property
    def share(self) -> np.ndarray:
        """Share of each in the weight of all, (n,) [-]."""
        return self.weight / self.weight.sum()


def waves(lines: Sequence[np.ndarray], step: float, shortest: float | None = None) -> Waves:
    """Periodogram of levelled lines (n,) each [m], of equal steps [m], up to the shortest wave used [m]."""
    from scipy.signal.windows import tukey  # noqa: PLC0415, slow, and needed for lines only

    highest = 2 * np.pi / (_SHORTEST_WAVE * step if shortest is None else shortest)
    parts = []
    for line in lines:
        taper = tukey(len(line) + 1, _TAPERED)[:-1]
        power = np.abs(fft.rfft(line * taper)) ** 2 * step / (len(line) * np.mean(taper**2) * 2 * np.pi)
        wavenumber = 2 * np.pi * fft.rfftfreq(len(line), step)
        used = (np.arange(len(wavenumber)) > _LEVELLED) & (wavenumber <= highest)
        parts.append((wavenumber[used], power[used], np.full(used.sum(), np.mean(taper**2) ** 2 / np.mean(taper**4))))
    return _grouped(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def _grouped(wavenumber, power, weight):
    """Waves of a periodogram (n,) each."""
    order = np.argsort(wavenumber, kind="stable")
    number = np.log(wavenumber[order]) // _WIDTH
    begins = np.flatnonzero(np.diff(number, prepend=-np.inf))
    count = np.diff([*begins, len(order)])
    means = (np.add.reduceat(values[order], begins) / count for values in (wavenumber, power))
    return Waves(*means, np.add.reduceat(weight[order], begins))


@dataclass(frozen=True)
class LineFit:
    """Eq. (7) and white noise, fitted to the spectrum along lines."""

    plateau: float  #: s⁰ [m⁴]
    corner: float  #: ζ₀ [rad m⁻¹]
    slope: float  #: exponent of the power law of s_Z [-]
    noise: float  #: constant part of the spectrum along the line [m³]
    misfit: float  #: χ² per degree of freedom, above 1 also by chance where groups have few values [-]

    @property
    def parameters(self) -> np.ndarray:
        """Logarithm of the corner and slope, (2,)."""
        return np.array([np.log(self.corner), self.slope])

    def variance_of_noise(self, step: float) -> float:
        """Variance of the noise on points of this distance [m²]."""
        return 2 * np.pi / step * self.noise


def fit(spectrum: Waves, start: np.ndarray | None = None) -> LineFit:
    """Most likely plateau, corner, slope and white noise by the spectrum along lines (Whittle).

    The search starts from a logarithm of the corner and a slope (2,), or from the best of a grid. Noise is never left
    out: at half of the Nyquist wave number it can hide in a flatter slope.
    """
    first, last = np.log(spectrum.wavenumber[[0, -1]])
    bounds = [(first - _LONGER, last), _SLOPES, _NOISE]
    start = _start(spectrum, bounds[0]) if start is None else start
    least = np.min(_ratio(spectrum, [*start, -np.inf])[1]) / _scale(start)
    guess = np.clip([*start, np.log(least / 2)], *np.transpose(bounds))
    options = {"xatol": 1e-3, "fatol": 1e-8}
    best = minimize(_deviance, guess, args=(spectrum,), method="Nelder-Mead", bounds=bounds, options=options).x
    plateau, relative = _ratio(spectrum, best)
    chi2 = spectrum.weight @ (spectrum.power / (plateau * relative) - 1) ** 2
    noise, misfit = plateau * _scale(best) * np.exp(best[2]), chi2 / (len(relative) - len(best) - 1)
    return LineFit(plateau, float(np.exp(best[0])), float(best[1]), float(noise), float(misfit))


def _scale(parameters):
    """Spectrum along a line at 0 over the plateau of s_Z [rad m⁻¹]."""
    corner, slope = np.exp(parameters[0]), parameters[1]
    return 2 * corner * slope / (1 + slope)


def _ratio(spectrum, parameters):
    """Best plateau [m⁴], and spectrum along lines with noise over it, (n,) [rad m⁻¹]."""
    relative = line_spectrum(spectrum.wavenumber, np.exp(parameters[0]), parameters[1])
    relative += _scale(parameters) * np.exp(parameters[2])
    return float(spectrum.share @ (spectrum.power / relative)), relative


def _deviance(parameters, spectrum):
    """Half of the deviance per independent value at the best plateau."""
    plateau, relative = _ratio(spectrum, parameters)
    return np.log(plateau) + spectrum.share @ np.log(relative)


def _start(spectrum, ends):
    """Logarithm of the corner and slope of the best of a grid."""
    slopes, corners = _START
    grid = [(corner, slope, -np.inf) for corner in np.linspace(*ends, corners) for slope in slopes]
    return min(grid, key=lambda parameters: _deviance(parameters, spectrum))[:2]

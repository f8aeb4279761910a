r"""Spectrum of levelled scans, in the convention of `stiction.surface.spectrum`: tapered periodogram and its means.

A scan is not periodic: without a taper its edges would add a spectrum of ζ⁻² along the axes. The slow axis of a
microscope holds drift and jumps of lines; the wave numbers next to it are left out of all means.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.signal.windows import tukey

#: Share of each side that is tapered: no bias on slopes of -5, and half of the scatter of a Hann window.
_TAPERED = 0.5
#: Wave numbers nearer to the slow axis than this number of steps are left out.
_SLOW_BAND = 3
#: Number of sectors of 180°/8 in which the spectrum of an isotropic surface is equal.
SECTORS = 8


@dataclass(frozen=True)
class Periodogram:
    """Mean periodogram of the scans of one surface, at the wave numbers of their FFT."""

    power: np.ndarray  #: s_Z, (n1, n2) [m⁴]
    size: tuple[float, float]  #: of a scan [m]
    independence: float  #: independent values per wave number: number of scans, less the correlation by the taper [-]

    @property
    def wavenumbers(self) -> tuple[np.ndarray, np.ndarray]:
        """ζ₁ (n1, 1) along the fast axis and ζ₂ (1, n2) along the slow one [rad m⁻¹]."""
        first, second = (
            2 * np.pi * fft.fftfreq(n, length / n) for n, length in zip(self.power.shape, self.size, strict=True)
        )
        return first[:, None], second[None, :]

    @property
    def near_slow_axis(self) -> np.ndarray:
        """Wave numbers that drift and jumps of lines change, (n1, 1) bool."""
        return np.abs(self.wavenumbers[0]) * self.size[0] / (2 * np.pi) < _SLOW_BAND - 0.5


@dataclass(frozen=True)
class Rings:
    """Means of a periodogram over rings of equal |ζ|."""

    wavenumber: np.ndarray  #: mean |ζ| of each ring, (n,) [rad m⁻¹]
    density: np.ndarray  #: s_Z, (n,) [m⁴]
    modes: np.ndarray  #: effective number of independent values: relative variance of ``density`` is 1 / modes, (n,)


def periodogram(scans: Sequence[np.ndarray], size: tuple[float, float]) -> Periodogram:
    """Mean periodogram of levelled scans (n1, n2) of equal size; undefined points are at the level."""
    n1, n2 = scans[0].shape
    window = np.outer(*(tukey(n + 1, _TAPERED)[:n] for n in (n1, n2)))
    square, fourth = np.mean(window**2), np.mean(window**4)
    power = sum(np.abs(fft.fft2(np.nan_to_num(z) * window)) ** 2 for z in scans) / len(scans)
    scale = size[0] * size[1] / (n1 * n2) ** 2 / (square * 4 * np.pi**2)
    return Periodogram(scale * power, size, len(scans) * square**2 / fourth)


def rings(spectrum: Periodogram, inside: np.ndarray | None = None) -> Rings:
    """Means over rings that are one wave number of the shorter side wide, without the rings that have no value.

    Parameters
    ----------
    spectrum : Periodogram
    inside : (n1, n2) bool array, optional
        Wave numbers included; by default all but those near the slow axis.
    """
    first, second = spectrum.wavenumbers
    radius = np.hypot(first, second)
    counted = np.broadcast_to(~spectrum.near_slow_axis if inside is None else inside, radius.shape)
    number = np.rint(radius * min(spectrum.size) / (2 * np.pi)).astype(int)[counted]
    count = np.bincount(number)
    taken = np.flatnonzero(count)
    mean = [np.bincount(number, values[counted])[taken] / count[taken] for values in (radius, spectrum.power)]
    return Rings(*mean, count[taken] / 2 * spectrum.independence)  # ζ and -ζ have the same value


def sectors(spectrum: Periodogram, low: float, high: float) -> np.ndarray:
    """Means of the spectrum in sectors relative to the mean of each ring, (8,) [-].

    Sector i holds the directions from 22.5° i to 22.5° (i + 1) against the fast axis, and the opposite ones. All are 1
    on an isotropic surface.

    Parameters
    ----------
    spectrum : Periodogram
    low, high : float
        Range of |ζ| [rad m⁻¹].
    """
    first, second = spectrum.wavenumbers
    radius = np.hypot(first, second)
    mean = rings(spectrum)
    inside = (radius >= low) & (radius <= high) & ~spectrum.near_slow_axis
    white = spectrum.power[inside] / np.interp(radius[inside], mean.wavenumber, mean.density)
    angle = np.broadcast_to(np.arctan2(second, first), radius.shape)[inside] % np.pi
    sector = (angle * SECTORS / np.pi).astype(int) % SECTORS
    return np.bincount(sector, white, SECTORS) / np.bincount(sector, minlength=SECTORS)

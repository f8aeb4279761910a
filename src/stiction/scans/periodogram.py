r"""Spectrum of levelled scans, in the convention of `stiction.surface.spectrum`: tapered periodogram and its means.

A scan is not periodic: without a taper its edges would add a spectrum of ζ⁻² along the axes. The slow axis of a
microscope holds drift and jumps of lines; the wave numbers next to it are left out of all means.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from itertools import product

import numpy as np
from scipy import fft

#: Share of each side that is tapered: no bias on slopes of -5, and half of the scatter of a Hann window.
_TAPERED = 0.5
#: Wave numbers nearer to the slow axis than this number of steps are left out.
_SLOW_BAND = 3
#: Number of sectors of 180°/8 in which the spectrum of an isotropic surface is equal.
SECTORS = 8
#: Values of a tapered periodogram farther apart than this number of steps along an axis are not correlated.
_CORRELATED = 2
#: Standard errors by which a ring stands out of a floor of noise: none does by chance.
_SEEN = 4


@dataclass(frozen=True)
class Periodogram:
    """Mean periodogram of the scans of one surface, at the wave numbers of their FFT."""

    power: np.ndarray  #: s_Z, (n1, n2) [m⁴]
    size: tuple[float, float]  #: of a scan [m]
    scans: int  #: number of scans
    correlation: np.ndarray  #: by the taper, of values 0, 1, 2 steps apart along either axis, (2, 3) [-]
    floor: float = 0.0  #: of white noise, which the power does not contain any more [m⁴]

    @property
    def independence(self) -> float:
        """Independent values per wave number and its opposite in means over many: 1/2, less the correlation [-]."""
        return self.scans / 2 / np.prod(2 * self.correlation.sum(axis=1) - 1)

    @property
    def wavenumbers(self) -> tuple[np.ndarray, np.ndarray]:
        """ζ₁ (n1, 1) along the fast axis and ζ₂ (1, n2) along the slow one [rad m⁻¹]."""
        first, second = (
            2 * np.pi * fft.fftfreq(n, length / n) for n, length in zip(self.power.shape, self.size, strict=True)
        )
        return first[:, None], second[None, :]

    @property
    def near_slow_axis(self) -> np.ndarray:
        """Wave numbers changed by drift and jumps of lines, (n1, 1) bool."""
        return np.abs(self.wavenumbers[0]) * self.size[0] / (2 * np.pi) < _SLOW_BAND - 0.5


@dataclass(frozen=True)
class Rings:
    """Means of a periodogram over rings of equal |ζ|."""

    wavenumber: np.ndarray  #: mean |ζ| of each ring, (n,) [rad m⁻¹]
    density: np.ndarray  #: s_Z, (n,) [m⁴]
    modes: np.ndarray  #: effective number of independent values: relative variance of ``density`` is 1 / modes, (n,)
    weight: np.ndarray  #: part in the independent values of many rings: neighbouring rings are correlated, too, (n,)

    def between(self, low: float, high: float) -> "Rings":
        """Rings from the wave number ``low`` to ``high`` [rad m⁻¹]."""
        inside = (self.wavenumber >= low) & (self.wavenumber <= high)
        return Rings(*(getattr(self, field.name)[inside] for field in fields(self)))


def in_order(spectra: Iterable[Rings]) -> Rings:
    """Rings of several spectra together, by increasing wave number."""
    spectra = list(spectra)
    order = np.argsort(np.concatenate([spectrum.wavenumber for spectrum in spectra]), kind="stable")
    columns = (np.concatenate([getattr(spectrum, field.name) for spectrum in spectra]) for field in fields(Rings))
    return Rings(*(values[order] for values in columns))


def periodogram(scans: Sequence[np.ndarray], size: tuple[float, float]) -> Periodogram:
    """Mean periodogram of levelled scans (n1, n2) of equal size, without undefined points."""
    n1, n2 = scans[0].shape
    along = tapers((n1, n2))
    window = np.outer(*along)
    power = sum(np.abs(fft.fft2(z * window)) ** 2 for z in scans) / len(scans)
    scale = size[0] * size[1] / (n1 * n2) ** 2 / (np.mean(window**2) * 4 * np.pi**2)
    return Periodogram(scale * power, size, len(scans), np.array(list(map(_correlation, along))))


def tapers(shape: tuple[int, int]) -> list[np.ndarray]:
    """Tapers along both axes of a map (n1, n2), (n1,) and (n2,) [-]."""
    from scipy.signal.windows import tukey  # noqa: PLC0415, slow, and needed for scans only

    return [tukey(n + 1, _TAPERED)[:n] for n in shape]


def without_floor(spectrum: Periodogram, floor: float) -> Periodogram:
    """Spectrum less a floor of white noise [m⁴]."""
    return replace(spectrum, power=spectrum.power - floor, floor=spectrum.floor + floor)


def _correlation(taper):
    """Squared correlation of waves of tapered white noise 0, 1, 2 steps apart, (3,) [-]."""
    overlap = np.abs(fft.rfft(taper**2)[: _CORRELATED + 1])
    return (overlap / overlap[0]) ** 2


def rings(spectrum: Periodogram, inside: np.ndarray | None = None) -> Rings:
    """Means over rings one wave number of the shorter side wide, without empty rings.

    Wave numbers (n1, n2) that are ``inside`` are included, by default all but those near the slow axis. Rings that a
    floor of noise hides are 0 and without weight; others err as much as with the noise.
    """
    first, second = spectrum.wavenumbers
    radius = np.hypot(first, second)
    counted = np.broadcast_to(~spectrum.near_slow_axis if inside is None else inside, radius.shape)
    number = np.where(counted, np.rint(radius * min(spectrum.size) / (2 * np.pi)).astype(np.int32), -1)
    count = np.bincount(number[counted])
    occupied = np.flatnonzero(count)
    wavenumber, density = (
        np.bincount(number[counted], values[counted])[occupied] / count[occupied] for values in (radius, spectrum.power)
    )
    modes = spectrum.scans / 2 * count**2 / np.maximum(_correlated(number, count, spectrum.correlation), 1)
    share = (density / (density + spectrum.floor)) ** 2
    hidden = (density < spectrum.floor) & ((density < 0) | (modes[occupied] * share < _SEEN**2))
    density, share = (np.where(hidden, 0.0, values) for values in (density, share))
    return Rings(wavenumber, density, share * modes[occupied], share * spectrum.independence * count[occupied])


def _correlated(number, count, correlation):
    """Sum of the squared correlations of all pairs of values in the same ring, each with itself included, (rings,).

    Each value (n1, n2) has the number of its ring, -1 for none, and each ring a number of values; the correlation (2,
    3) is that of `Periodogram`.
    """
    total = count.astype(float)
    for i, j in product(range(_CORRELATED + 1), range(-_CORRELATED, _CORRELATED + 1)):
        if (i, j) > (0, 0):  # and as many pairs in the opposite direction
            same = number[(number == np.roll(number, (i, j), (0, 1))) & (number >= 0)]
            total += 2 * correlation[0, i] * correlation[1, abs(j)] * np.bincount(same, minlength=len(count))
    return total


def sectors(spectrum: Periodogram, mean: Rings, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Means of the spectrum in sectors relative to the mean of each ring, and their standard errors, (8,) each [-].

    Sector i holds the directions from 22.5° i to 22.5° (i + 1) against the fast axis, and the opposite ones, between
    two wave numbers [rad m⁻¹]. All are 1 on an isotropic surface.
    """
    first, second = spectrum.wavenumbers
    radius = np.hypot(first, second)
    expected = np.interp(radius, mean.wavenumber, mean.density)
    inside = (radius >= low) & (radius <= high) & ~spectrum.near_slow_axis & (expected > 0)  # noise hides the others
    white = spectrum.power[inside] / expected[inside]
    angle = np.broadcast_to(np.arctan2(second, first), radius.shape)[inside] % np.pi
    sector = (angle * SECTORS / np.pi).astype(int) % SECTORS
    count = np.bincount(sector, minlength=SECTORS)
    return np.bincount(sector, white, SECTORS) / count, 1 / np.sqrt(spectrum.independence * count)

r"""Coherence of two facing surfaces of one place, from a scan of each after the upper part was turned over.

Heights of both scans point out of their solids, so that in place they point towards each other and a copy is the
negative of its original (`stiction.surface.replica`). Turning mirrors one axis of the upper scan. Spectra are
divided by their means over rings, S. The register is the turn and shift s with the largest mean

.. math:: -\Re \frac{S_{12}(\zeta)}{\sqrt{S_1 S_2}} e^{-i \zeta \cdot s},

sought on the waves in every other sector of directions, and the coherence is this mean over the waves in the others,
and in turn: without a copy chance makes one register the best, but not for waves that it was not chosen by.

Noise of the microscope and rotation between the scans lower the coherence, the unsafe side: it holds for waves that
both scans show above their noise. ASSUME: both have the same directions of their axes after the turn.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.optimize import minimize

from stiction.errors import ScanError
from stiction.scans.levelling import Levelling, level
from stiction.scans.periodogram import SECTORS, periodogram, tapers
from stiction.scans.scan import Scan

#: Fewest waves along the shorter side, and ratio of the wavelengths at the ends of a band.
_FEWEST, _BAND = 3, np.sqrt(2)
#: Power of waves, on that of the strongest, below which the taper may have moved it there from longer waves.
_LEAKAGE = 1e-6
#: Largest shift between the scans, in their sides.
_LARGEST_SHIFT = 0.25
#: Fewest independent waves in a band.
_LEAST = 10
#: Turns that mirror the slow or the fast axis.
_TURNS = np.s_[:, ::-1], np.s_[::-1, :]


@dataclass(frozen=True)
class FacingCoherence:
    """Coherence of the heights of two facing surfaces by wavelength."""

    wavelength: np.ndarray  #: geometric mean of the ends of each band, decreasing (n,) [m]
    coherence: np.ndarray  #: c (n,) [-]
    error: np.ndarray  #: standard errors of c (n,) [-]
    shifts: np.ndarray  #: of both registers, of the upper scan along both axes (2, 2) [m]
    pixel: float  #: larger distance of the points [m]

    @property
    def is_registered(self) -> bool:
        """Whether both registers agree to a pixel. Otherwise chance made them, and no copy is seen."""
        return bool(np.all(np.abs(np.diff(self.shifts, axis=0)) <= self.pixel))


def facing_coherence(upper: Scan, lower: Scan) -> FacingCoherence:
    """Coherence of two facing surfaces from their scans, of equal size and pixels and without undefined points.

    Raises
    ------
    ScanError
        If the scans cannot be compared.

    Examples
    --------
    >>> ground = np.random.default_rng(1).normal(size=(64, 64)) * 1e-9
    >>> copy = Scan(-ground[:, ::-1], (1e-6, 1e-6))
    >>> facing_coherence(copy, Scan(ground, (1e-6, 1e-6))).coherence.round(3)
    array([1., 1., 1., 1., 1., 1.])
    """
    for scan in (upper, lower):
        if not scan.defined.all() or scan.frame != lower.frame:
            raise ScanError(scan.name, "files", f"must have heights at all points, and points and size of {lower.name}")
    upper_heights, lower_heights = (level(scan.heights, Levelling()) for scan in (upper, lower))
    turned, halves = [upper_heights[turn] for turn in _TURNS], []
    for half in (0, 1):
        shifts = [_shift(each, lower_heights, lower.frame, half) for each in turned]
        best = int(np.argmax([mean for mean, _ in shifts]))
        halves.append(_refined(turned[best], lower_heights, lower.frame, half, shifts[best][1]))
    sums = np.sum([of_half for _, of_half in halves], axis=0)
    resolved = np.flatnonzero(sums[-1] > _LEAST)
    crossed, *powers, number = sums[:, resolved]
    c = crossed / np.sqrt(np.prod(powers, axis=0))
    pixels, ends = np.array(lower.frame.pixel), _ends(lower.frame)
    wavelength, shifts = np.sqrt(ends[:-1] * ends[1:])[resolved], pixels * [shift for shift, _ in halves]
    return FacingCoherence(wavelength, c, (1 - c**2) / np.sqrt(number), shifts, float(pixels.max()))


def _ends(frame):
    """Ends of the bands, from the longest wavelength to the shortest [m]."""
    halvings = np.log2(min(frame.shape) / 2 / _FEWEST)
    return min(frame.size) / _FEWEST / _BAND ** np.arange(int(2 * halvings) + 1)


@dataclass(frozen=True)
class _Waves:
    """Waves of two maps that overlap."""

    crossed: np.ndarray  #: negative cross spectrum (m,) complex [-]
    powers: np.ndarray  #: of both (2, m), of mean 1 in each ring [-]
    zeta: np.ndarray  #: (2, m) [rad per pixel]
    weight: np.ndarray  #: in the choice of the register (m,) [-]
    places: tuple  #: in the array of the FFT, (m,) each
    number: np.ndarray  #: of waves along the shorter side (m,) [-]
    half: np.ndarray  #: 0 or 1, the part of the directions (m,)
    independence: float  #: see `stiction.scans.periodogram.Periodogram`

    def mean(self, shift, half):
        """Mean over the waves of a half at a shift of the upper map [pixels]."""
        inside = self.half == half
        in_register = (self.crossed[inside] * np.exp(-1j * (shift @ self.zeta[:, inside]))).real
        return float(np.average(in_register, weights=self.weight[inside]))


def _waves(upper, lower, frame):
    """Waves of two maps (n1, n2) with this distance of their points [m]."""
    spectra = [periodogram([z], tuple(np.multiply(z.shape, frame.pixel))) for z in (upper, lower)]
    window = np.outer(*tapers(upper.shape))
    waves = np.array([fft.fft2(z * window) for z in (upper, lower)])
    first, second = spectra[0].wavenumbers
    number = np.hypot(first, second) * min(spectra[0].size) / (2 * np.pi)
    ring = np.rint(number).astype(int)
    inside = (number >= _FEWEST) & (number < min(upper.shape) / 2) & ~spectra[0].near_slow_axis
    weight = np.ones(ring.shape)
    for z in waves:
        of_rings = np.bincount(ring.ravel(), np.abs(z.ravel()) ** 2) / np.bincount(ring.ravel())
        z /= np.sqrt(of_rings)[ring]
        weight *= of_rings[ring] ** (1 / 8)
        inside &= (of_rings > _LEAKAGE * of_rings[_FEWEST:].max())[ring]
    zeta = np.stack(np.broadcast_arrays(first * frame.pixel[0], second * frame.pixel[1]))[:, inside]
    sector = np.arctan2(second, first)[inside] % np.pi * SECTORS / np.pi
    half = sector.astype(int) % 2
    waves = waves[:, inside]
    return _Waves(
        -waves[0] * waves[1].conj(),
        np.abs(waves) ** 2,
        zeta,
        weight[inside],
        np.nonzero(inside),
        number[inside],
        half,
        spectra[0].independence,
    )


def _shift(upper, lower, frame, half):
    """Largest mean over the waves of a half, and its shift in whole pixels (2,)."""
    waves = _waves(upper, lower, frame)
    of_half = np.zeros(upper.shape, complex)
    weight = np.where(waves.half == half, waves.weight, 0)
    of_half[waves.places] = weight * waves.crossed / weight.sum()
    means = fft.fft2(of_half).real
    shifts = [np.rint(fft.fftfreq(n, 1 / n)).astype(int) for n in upper.shape]
    near = [np.abs(shift) <= _LARGEST_SHIFT * len(shift) for shift in shifts]
    best = np.unravel_index(np.argmax(np.where(np.outer(*near), means, -np.inf)), means.shape)
    return means[best], np.array([shift[k] for shift, k in zip(shifts, best, strict=True)])


def _refined(upper, lower, frame, half, shift):
    """Shift in pixels (2,), and sums over the waves of the other half in bands (4, bands).

    Sums are those of the cross spectrum, of both powers, and the number of independent waves.
    """
    parts = [np.s_[max(-s, 0) : n - max(s, 0)] for s, n in zip(shift, upper.shape, strict=True)]
    facing = [np.s_[max(s, 0) : n - max(-s, 0)] for s, n in zip(shift, upper.shape, strict=True)]
    waves = _waves(upper[tuple(parts)], lower[tuple(facing)], frame)
    finer = minimize(lambda s: -waves.mean(s, half), np.zeros(2), method="Nelder-Mead", bounds=[(-1, 1)] * 2).x
    in_register, ends = (waves.crossed * np.exp(-1j * (finer @ waves.zeta))).real, _ends(frame)
    overlap = min(np.multiply([overlap_range.stop - overlap_range.start for overlap_range in parts], frame.pixel))
    band = np.digitize(overlap / waves.number, ends) - 1
    inside = (waves.half != half) & (band >= 0) & (band < len(ends) - 1)
    values = in_register, *waves.powers, np.full(len(band), 2 * waves.independence)
    return shift + finer, np.array([np.bincount(band[inside], each[inside], len(ends) - 1) for each in values])

"""Scans of a surface without a model: levelled heights, moments, spectrum and its fit by Eq. (7).

Scans may differ in size and number of points. Each size is evaluated by itself; moments and quantiles of all sizes are
averaged by scanned area, and Eq. (7) is fitted to the spectra of all sizes, each within its reach.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from operator import itemgetter
from typing import Any

import numpy as np

from stiction.errors import ScanError
from stiction.scans import periodogram as spectra
from stiction.scans.holes import filled, whole_part
from stiction.scans.levelling import Levelling, level
from stiction.scans.moments import moments, powers
from stiction.scans.noise import Floor, above, can_be_noise, slopes_with_noise, white_floor, without_noise
from stiction.scans.periodogram import Periodogram, Rings, in_order
from stiction.scans.quantiles import correlation_areas, quantiles
from stiction.scans.remainder import Remainder, remainders
from stiction.scans.scan import FEWEST_POINTS, Frame, Scan
from stiction.scans.whittle import NON_GAUSSIAN, Reach, WhittleFit, fit, fit_to_the_end, reach, spectrum, tip_reach
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

#: Fewest wavelengths of the corner along a scan: for a plateau at all. ASSUME: the spectrum of smaller scans is flat up
#: to the first waves that they show. Longer waves would only make the surface rougher.
FEWEST_WAVELENGTHS = 4
#: ASSUME: fewest waves along a side from which the smaller scans count for the spectrum. A ring is one wave wide, so
#: that its mean of a power law of slope -n is too large by about n (n + 1) / 24 over the square of this number: 1 %.
_FEWEST_WAVES = 10
#: Largest relative difference between the sides of scans that count as one size.
_SAME_SIZE = 0.01


@dataclass(frozen=True)
class Settings:
    """Settings for the evaluation of scans."""

    levelling: Levelling = Levelling()
    tip_radius: float | None = None  #: of the microscope [m]
    shortest: float | None = None  #: wavelength used of the spectrum; four pixels by default [m]
    tiles: int = 4  #: tiles along each side of a scan, whose scatter tests that the scan is homogeneous
    undefined_share: float = 0.01  #: share of points without height from which only a part gives the spectrum [-]


@dataclass(frozen=True, eq=False)
class Maps:
    """Levelled scans of one size and number of points."""

    names: tuple[str, ...]  #: of the scans
    numbers: tuple[int, ...]  #: of these scans among all
    frame: Frame
    levelled: tuple[np.ndarray, ...]  #: heights, NaN where undefined, (n1, n2) each [m]
    complete: tuple[np.ndarray, ...]  #: the same, or their largest whole part, with undefined points filled [m]
    complete_frame: Frame  #: of these
    periodogram: Periodogram
    rings: Rings  #: without the floor of the noise
    reach: Reach
    floor: Floor  #: of white noise
    floor_left: Floor  #: floor that stays in heights and spectrum, because no heights are left without it

    @classmethod
    def from_scans(cls, alike: Mapping[int, Scan], settings: Settings) -> "Maps":
        """Level scans of the same size and number of points, by their numbers."""
        scans = list(alike.values())
        frame = scans[0].frame
        levelled = tuple(level(scan.heights, settings.levelling) for scan in scans)
        complete = tuple(map(partial(_without_holes, settings), scans, levelled))
        frame_of_part = _frame_of(complete[0], frame)
        noisy = spectra.periodogram(complete, frame_of_part.size)
        tip = np.inf if settings.tip_radius is None else tip_reach(complete, frame.pixel[0], settings.tip_radius)
        within = reach(frame_of_part.size, frame.pixel, settings.shortest, tip)
        floor, kept = white_floor(spectra.rings(noisy), within), Floor()
        if not can_be_noise(moments(np.mean([powers(z) for z in levelled], axis=0)), floor.variance(frame.pixel)[0]):
            floor, kept = kept, floor
        within, clean = above(spectra.rings(noisy), within, floor), spectra.without_floor(noisy, floor.density)
        names = tuple(scan.name for scan in scans)
        spectrum_of = spectra.rings(clean)
        return cls(
            names, tuple(alike), frame, levelled, complete, frame_of_part, clean, spectrum_of, within, floor, kept
        )

    @property
    def size(self) -> str:
        """Size in words."""
        return _in_words(self.frame)

    @property
    def part_in_words(self) -> str:
        """Size of the part used for the spectrum."""
        return _in_words(self.complete_frame)

    @property
    def area(self) -> float:
        """Area with heights of all scans [m²]."""
        return self.frame.area * self.number

    @cached_property
    def number(self) -> float:
        """Number of the scans, less the share of their undefined points."""
        return len(self.names) * float(np.mean(np.isfinite(self.levelled)))

    @cached_property
    def powers(self) -> np.ndarray:
        """Means of z … z⁴ of every scan, (n, 4)."""
        return np.array([powers(z) for z in self.levelled])

    @property
    def noisy_moments(self) -> np.ndarray:
        """Moments (ln rms, skewness, kurtosis) of all scans together, with the noise, (3,)."""
        return moments(self.powers.mean(axis=0))

    @property
    def moments(self) -> np.ndarray:
        """Moments without white noise, (3,)."""
        return without_noise(self.noisy_moments, self.floor.variance(self.frame.pixel)[0])

    @property
    def noise(self) -> float:
        """Root mean square of white noise [m]."""
        return float(np.sqrt(self.floor.variance(self.frame.pixel)[0]))

    @property
    def noise_covariance(self) -> np.ndarray:
        """Covariance of the moments by the error of the variance of the noise, (3, 3)."""
        variance, error = self.floor.variance(self.frame.pixel)
        slope = slopes_with_noise(self.moments)
        return error**2 * np.outer(slope, slope)

    @cached_property
    def quantiles(self) -> np.ndarray:
        """Standardised heights of all scans together at `stiction.scans.quantiles.SCORES`, (49,) [-]."""
        return quantiles(self.levelled)

    def fits(self, within: Reach) -> list[WhittleFit]:
        """Fits to the spectrum of every scan alone, within a reach as far as it is that of these scans."""
        within = replace(within, low=max(within.low, self.reach.low), high=min(within.high, self.reach.high))
        alone = (spectra.periodogram([z], self.complete_frame.size) for z in self.complete)
        return [fit(spectra.rings(spectra.without_floor(each, self.floor.density)), within) for each in alone]

    def wavelengths(self, fit: WhittleFit) -> float:
        """Wavelengths of the corner along the shorter side [-]."""
        return fit.corner * min(self.complete_frame.size) / (2 * np.pi)


@dataclass(frozen=True)
class Inspection:
    """Results of the scans of a surface without any model."""

    sizes: tuple[Maps, ...]  #: the largest first
    settings: Settings
    rings: Rings  #: of all sizes
    reach: Reach
    fit: WhittleFit

    @property
    def largest(self) -> Maps:
        """Scans of the largest size."""
        return self.sizes[0]

    @property
    def finest(self) -> Maps:
        """Scans with the smallest pixels."""
        return min(self.sizes, key=_pixel)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all scans, in their given order."""
        return self.in_order([maps.names for maps in self.sizes])

    def in_order(self, of_sizes: Sequence[Sequence[Any]]) -> tuple[Any, ...]:
        """Values of the scans of each size, in the given order of the scans."""
        numbered = [
            pair
            for maps, values in zip(self.sizes, of_sizes, strict=True)
            for pair in zip(maps.numbers, values, strict=True)
        ]
        return tuple(value for _, value in sorted(numbered, key=itemgetter(0)))

    @property
    def counted(self) -> tuple[Maps, ...]:
        """Sizes counted for moments and quantiles, the largest first: those with a plateau, if there are any."""
        shown = tuple(maps for maps in self.sizes if maps.wavelengths(self.fit) >= FEWEST_WAVELENGTHS)
        return shown or (self.largest,)

    @cached_property
    def weights(self) -> np.ndarray:
        """Weight of each counted size in the mean moments and quantiles: its fraction of the area, (n,) [-]."""
        areas = np.array([maps.area for maps in self.counted])
        return areas / areas.sum()

    def averaged(self, values: Sequence[np.ndarray]) -> np.ndarray:
        """Mean of a value over all counted sizes."""
        return sum(weight * value for weight, value in zip(self.weights, values, strict=True))

    def propagated(self, covariances: Sequence[np.ndarray]) -> np.ndarray:
        """Covariance of the mean of a value over all counted sizes."""
        return sum(weight**2 * value for weight, value in zip(self.weights, covariances, strict=True))

    @property
    def moments(self) -> np.ndarray:
        """Moments (ln rms, skewness, kurtosis) of all scans together, (3,)."""
        return self.averaged([maps.moments for maps in self.counted])

    @property
    def quantiles(self) -> np.ndarray:
        """Standardised heights of all scans together at `stiction.scans.quantiles.SCORES`, (49,) [-]."""
        return self.averaged([maps.quantiles for maps in self.counted])

    @property
    def spectra_of_scans(self) -> list[tuple[float, float, float, float, float]]:
        """Logarithm of the corner, slope, their variances and weight of each scan. One row if a scan has few rings.

        Variances are those with which the mean has the error of the fit to all scans. Own errors of a scan that hardly
        shows its plateau are a hundred times as large, and would hide that its corner is elsewhere.
        """
        try:
            fits = [maps.fits(self.reach) for maps in self.counted]
        except ValueError:
            return [(0.0, 0.0, 1.0, 1.0, 1.0)]
        shares = np.repeat(np.divide(self.weights, list(map(len, fits))), list(map(len, fits)))
        variances = np.diag(self.fit.covariance)[1:] / shares[:, None]
        fits_of_scans = (scan_fit for of_size in fits for scan_fit in of_size)
        return [
            (np.log(scan_fit.corner), scan_fit.slope, *of_one, share)
            for scan_fit, of_one, share in zip(fits_of_scans, variances, shares, strict=True)
        ]

    @property
    def spectrum(self) -> CutoffSelfAffine:
        """Fit, up to the end of the measured spectrum."""
        return self.fit.spectrum(self.reach.end)

    def spectrum_in(self, maps: Maps) -> CutoffSelfAffine | TabulatedSpectrum:
        """Spectrum in agreement with the scans, without waves shorter than two pixels of some scan."""
        return spectrum("fitted", self.fit, self.rings, self.reach, min(self.reach.end, maps.reach.nyquist))

    @property
    def is_resolved(self) -> bool:
        """Whether the scans resolve the power law."""
        return self.fit.is_resolved(self.reach)

    @property
    def filled_share(self) -> float:
        """Share of the undefined points of all scans [-]."""
        return float(np.mean(np.concatenate([~np.isfinite(z).ravel() for maps in self.sizes for z in maps.levelled])))

    @cached_property
    def remainders(self) -> tuple[Remainder, ...]:
        """Tilts and bows left by levelling in the scans of the largest size, the one with the plateau.

        They are compared with the fitted spectrum. A large bow hides the plateau of the scan that it is on.
        """
        error, maps = self.fit.amplitude_error, self.largest
        return remainders(maps.levelled, maps.frame.size, self.settings.levelling, self.spectrum, error)

    @property
    def wavelengths(self) -> float:
        """Wavelengths of the corner along the shorter side of the largest scans [-]."""
        return self.largest.wavelengths(self.fit)

    @property
    def areas(self) -> float:
        """Correlation areas of all scans counted for the moments [-]."""
        area = sum(maps.area for maps in self.counted)
        return correlation_areas(self.spectrum, np.exp(2 * self.moments[0]), area)

    @property
    def spectral_steps(self) -> Iterator[tuple[Maps, Maps, float, float]]:
        """Neighbouring sizes, the second spectrum over the first in their common range, and its error.

        Sizes without common wave numbers are left out.
        """
        for first, second in pairwise(self.sizes):
            low = max(_first_wave(maps, self.sizes) for maps in (first, second))
            high = min(self.reach.high, *(maps.reach.high for maps in (first, second)))
            rings = [maps.rings.between(low, high) for maps in (first, second)]
            if all(len(of_size.wavenumber) for of_size in rings):
                fitted = self.fit.density
                means = [
                    np.average(of_size.density / fitted(of_size.wavenumber), weights=of_size.weight)
                    for of_size in rings
                ]
                error = NON_GAUSSIAN * np.sqrt(sum(1 / of_size.weight.sum() for of_size in rings))
                yield first, second, means[1] / means[0], error * means[1] / means[0]


def inspect(scans: Sequence[Scan], settings: Settings) -> Inspection:
    """Level the scans and fit their spectrum: the fast part of an estimate, with all reasons to refuse scans.

    Raises
    ------
    ScanError
        If a scan has no part without holes that is large enough, or if the scans are too small to give a spectrum.
    """
    names = ", ".join(scan.name for scan in scans)
    groups = [Maps.from_scans(alike, settings) for alike in by_size(scans, settings.undefined_share)]
    sizes = tuple(sorted(groups, key=lambda maps: _extent(maps.complete_frame), reverse=True))
    try:
        fitted, rings, within = _fitted(sizes)
    except ValueError as reason:
        raise ScanError(names, "files", f"cannot give a spectrum: {reason}") from None
    return Inspection(sizes, settings, rings, within, fitted)


def _without_holes(settings, scan, levelled):
    """Levelled heights without holes. Of a scan with many undefined points only its largest whole part, levelled anew.

    Raises
    ------
    ScanError
        If no part is large enough.
    """
    if scan.undefined_share <= settings.undefined_share:
        return filled(levelled, scan.frame.pixel)
    heights = level(scan.heights[whole_part(scan.heights)], settings.levelling) if scan.defined.any() else levelled[:0]
    if min(heights.shape) < FEWEST_POINTS:
        share = f"{100 * scan.undefined_share:.3g} % of its points undefined"
        share += f" ({scan.stopped})" if scan.stopped else ""
        reason = f"has {share}, and no part without holes that has {FEWEST_POINTS} points along each side"
        raise ScanError(scan.name, "files", reason)
    return filled(heights, scan.frame.pixel)


def _in_words(frame):
    """Size of a map."""
    return " x ".join(f"{1e6 * side:.4g}" for side in frame.size) + " µm"


def _frame_of(heights, frame):
    """Frame of a part of a map."""
    if heights.shape == frame.shape:
        return frame
    return Frame(heights.shape, tuple(n * pixel for n, pixel in zip(heights.shape, frame.pixel, strict=True)))


def by_size(scans: Sequence[Scan], undefined_share: float = 1.0) -> list[dict[int, Scan]]:
    """Group scans of equal size and number of points, by their numbers.

    The largest size is first, and of equal sizes that with more points. Scans with a larger share of undefined points
    stand alone, because the parts that give their spectra differ.
    """
    groups = []
    for number, scan in enumerate(scans):
        group = next((group for group in groups if _alike(scan, next(iter(group.values())), undefined_share)), None)
        if group is None:
            groups.append(group := {})
        group[number] = scan
    return sorted(groups, key=lambda group: _extent(next(iter(group.values())).frame), reverse=True)


def _extent(frame):
    """Shorter side of a scan and number of its points, for sorting sizes."""
    return min(frame.size), math.prod(frame.shape)


def _alike(first, second, undefined_share):
    """Whether two scans have the same number of points and, nearly, the same size, and neither has many holes."""
    same = first.frame.shape == second.frame.shape and np.allclose(first.size, second.size, rtol=_SAME_SIZE, atol=0)
    return same and max(first.undefined_share, second.undefined_share) <= undefined_share


def _fitted(sizes):
    """Fit to the spectra of all sizes, their rings and their reach.

    The finest scans say where the spectrum ends; the others count within their reach only, because aliases raise the
    spectrum beyond.
    """
    finest = min(sizes, key=_pixel)
    rings, within = finest.rings, finest.reach
    if len(sizes) > 1:
        rings = in_order(maps.rings.between(_first_wave(maps, sizes), _last_wave(maps, finest)) for maps in sizes)
        within = replace(within, low=sizes[0].reach.low)
    fitted, within = fit_to_the_end(rings, within)
    return fitted, rings, within


def _first_wave(maps, sizes):
    """Wave number from which scans count for a spectrum of several sizes [rad m⁻¹]."""
    return maps.reach.low if maps is sizes[0] else 2 * np.pi * _FEWEST_WAVES / min(maps.complete_frame.size)


def _last_wave(maps, finest):
    """Wave number up to which scans count for such a spectrum [rad m⁻¹]."""
    return np.inf if maps is finest else maps.reach.high


def _pixel(maps):
    """Wider distance of the points of scans [m]."""
    return max(maps.frame.pixel)

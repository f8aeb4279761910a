"""Scans drawn from the estimated surface, with pixel and size of the measured ones, for the effect of levelling."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from stiction.scans.levelling import Levelling, level
from stiction.scans.moments import covariance, influence, moments, moments_of, overlap_integrals, powers
from stiction.scans.quantiles import quantiles
from stiction.scans.scan import Frame
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import Spectrum, TabulatedSpectrum
from stiction.surface.summits import summits_per_area
from stiction.surface.translation import Translation, underlying_spectrum

#: Period of the transforms from the heights to the underlying Gaussian field over the correlation; least and largest
#: number of its points.
_PERIOD, _POINTS = 8, (512, 4096)


@dataclass(frozen=True)
class SurfaceModel:
    """Surface estimated from scans: density, spectrum, rms."""

    density: HeightDensity | MeasuredDensity
    spectrum: Spectrum  #: of the heights; its scale has no effect
    correlation: float  #: distance at which heights are not correlated any more [m]
    rms: float  #: [m]
    frame: Frame

    @cached_property
    def translation(self) -> Translation:
        """Eq. (5)."""
        return Translation(self.density)

    @cached_property
    def moments(self) -> np.ndarray:
        """Moments (ln rms, skewness, kurtosis), (3,)."""
        return moments_of(self.translation) + [np.log(self.rms), 0, 0]

    @cached_property
    def underlying(self) -> TabulatedSpectrum:
        """Spectrum of the Gaussian field. Raises ValueError if no field has these heights and this spectrum."""
        return underlying_spectrum(self.spectrum, self.translation, min(self.frame.pixel), self._points)[0]

    @property
    def _points(self):
        return fft.next_fast_len(int(np.clip(_PERIOD * self.correlation / min(self.frame.pixel), *_POINTS)))

    @cached_property
    def covariance(self) -> np.ndarray:
        """Covariance of (ln rms, skewness, kurtosis) of one scan, (3, 3)."""
        return covariance(self.translation, self.underlying, self.frame.size, self._longest_lag)

    @cached_property
    def overlaps(self) -> np.ndarray:
        """Integrals I_1 … I_24 of `stiction.scans.moments.overlap_integrals`, (24,) [-]."""
        terms = len(self.translation.hermite_coefficients)
        return overlap_integrals(self.underlying, self.frame.size, self._longest_lag, terms)

    @property
    def _longest_lag(self):
        """Longest lag of a known autocorrelation [m]."""
        return self._points * min(self.frame.pixel) / 2

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        """Draw one scan, with a true mean of 0 [m].

        Pixels that are not square hold the nearest point of a grid of square ones.
        """
        shape, pixel = self.frame.shape, self.frame.pixel
        rows, columns = (np.rint(np.arange(n) * p / min(pixel)).astype(int) for n, p in zip(shape, pixel, strict=True))
        return self._surface.draw(rng)[np.ix_(rows, columns)].astype(float)

    @cached_property
    def _surface(self):
        """Surface on a grid of square pixels."""
        length, width = ((n + 1) * p for n, p in zip(self.frame.shape, self.frame.pixel, strict=True))
        grid = StripGrid(length, width, min(self.frame.pixel), self.correlation)
        return RoughSurface(self.underlying, self.translation, self.rms, grid)


@dataclass(frozen=True)
class ModelScans:
    """Statistics of levelled model scans."""

    powers: np.ndarray  #: means of z … z⁴, (n, 4)
    influence: np.ndarray  #: means of the influence functions over the scans before levelling; expectation 0, (n, 3)
    quantiles: np.ndarray  #: at `stiction.scans.quantiles.SCORES`, (n, 49)
    levelled_off: np.ndarray  #: change of the quantiles by levelling, (n, 49)
    summits: np.ndarray  #: `summits_of_map`, (n, 2)

    def bias(self, truth: np.ndarray, scans: int) -> np.ndarray:
        """Bias of the moments of ``scans`` scans by levelling and finite size, (3,).

        The mean over groups of as many model scans; their sampling error is reduced by the influence functions.
        """
        groups = len(self.powers) // scans
        averaged, expected = (
            rows[: groups * scans].reshape(groups, scans, -1).mean(axis=1) for rows in (self.powers, self.influence)
        )
        return np.mean(moments(averaged) - expected, axis=0) - truth

    @property
    def bias_covariance(self) -> np.ndarray:
        """Covariance of `bias` by the finite number of model scans, (3, 3)."""
        return np.cov((moments(self.powers) - self.influence).T) / len(self.powers)


def draw_model_scans(model: SurfaceModel, levelling: Levelling, rngs: Iterable[np.random.Generator]) -> ModelScans:
    """Draw scans of a model, one per generator, and level them."""
    rows = []
    for rng in rngs:
        raw = model.draw(rng)
        levelled = level(raw, levelling)
        heights = quantiles([levelled])
        rows.append(
            (
                powers(levelled),
                influence(powers(raw) / model.rms ** np.arange(1, 5), *model.moments[1:]),
                heights,
                heights - quantiles([raw]),
                summits_of_map(levelled, model.frame),
            )
        )
    return ModelScans(*map(np.array, zip(*rows, strict=True)))


def summits_of_map(heights: np.ndarray, frame: Frame) -> np.ndarray:
    """Summits of a map per area, (2,) [m⁻²], [m⁻³], from `stiction.surface.summits.summits_per_area`.

    They are ``nan`` if the pixels of the map are not square.
    """
    return summits_per_area(heights, frame.pixel[0]) if frame.square else np.full(2, np.nan)

"""Moments and isotropic spectrum of a surface from lines across it, with errors by lines drawn from the estimate.

No line shows whether a surface is isotropic: it is assumed. Biases by levelling, finite lines, cut-off and fit, and the
scatter of finite lines, are those of the same evaluation of drawn lines (parametric bootstrap). Errors are for another
place if the lines scatter more than those of one homogeneous surface, as for maps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import fft

from stiction.errors import NotConverged, ScanError
from stiction.estimates import jackknife
from stiction.scans.lines.spectrum import FEWEST_WAVES, LineFit, fit, waves
from stiction.scans.moments import growth, moments, moments_of, powers
from stiction.scans.noise import can_be_noise, without_noise
from stiction.scans.quantiles import feasible
from stiction.scans.scan import PIXELS, SLOPES
from stiction.streams import stream
from stiction.surface import self_affine
from stiction.surface.spectrum import CutoffSelfAffine, autocovariance
from stiction.surface.translation import Translation, underlying_spectrum

#: Degrees of the polynomial subtracted from each line.
LEVELS = {"offset": 0, "tilt": 1, "bow": 2}
#: Sets of lines drawn for biases and errors: errors of 9 % of the errors.
_SETS = 64
#: Fewest points of a line, and largest relative difference of steps that are equal.
FEWEST_POINTS, _SAME = 128, 0.01
#: Fewest wavelengths of the corner along the longest line. ASSUME: fewer do not show a plateau.
_FEWEST_WAVELENGTHS = 4
#: Wavelengths of the corner over which heights are correlated, and period of transforms over that; their least and
#: largest number of points, and trapezoids per point of a transform.
_CORRELATED, _PERIOD, _POINTS, _PANELS = 2, 8, (512, 4096), 4
#: χ² over the mean of drawn lines, and above all of them, from which a spectrum is not of the form of Eq. (7).
_MISFIT = 1.5
#: Parts of a line, whose scatter gives the errors of moments that no density has.
_PARTS = 8


@dataclass(frozen=True)
class Settings:
    """Settings for the evaluation of lines."""

    level: str = "tilt"  #: key of `LEVELS`
    shortest: float | None = None  #: wavelength used of the spectrum; four steps by default [m]


@dataclass(frozen=True)
class LineEstimate:
    """Surface measured along lines. Values are ln rms, skewness, kurtosis, ln corner and slope, the rms in metres."""

    values: np.ndarray  #: without noise and bias, (5,)
    errors: np.ndarray  #: standard errors at another place, (5,)
    spectrum: CutoffSelfAffine  #: Eq. (7) of these values, up to the shortest wave, or that of two steps
    noise: float  #: root mean square of white noise [m]


@dataclass(frozen=True)
class _Model:
    """Surface that lines are drawn from."""

    rms: float  #: [m]
    translation: Translation
    spectrum: CutoffSelfAffine
    step: float  #: between the points of lines [m]
    noise: float  #: standard deviation of white noise [m]

    @property
    def values(self):
        """Its values, as of `LineEstimate`, (5,)."""
        of_heights = moments_of(self.translation) + [np.log(self.rms), 0, 0]
        return np.array([*of_heights, np.log(self.spectrum.corner), self.spectrum.slope])

    @cached_property
    def _correlation(self):
        """Autocorrelation of the Gaussian field at whole steps, up to where it vanishes, (n,) [-]."""
        reach = _PERIOD * _CORRELATED * 2 * np.pi / self.spectrum.corner
        points = fft.next_fast_len(int(np.clip(reach / self.step, *_POINTS)))
        underlying = underlying_spectrum(self.spectrum, self.translation, self.step, points)[0]
        rho = autocovariance(underlying, self.step * np.arange(points // 2), _PANELS * points)
        return rho / rho[0]

    def draw(self, points: int, rng: np.random.Generator) -> np.ndarray:
        """Draw one line of equally spaced heights, (points,) [m]."""
        correlation = self._correlation
        half = fft.next_fast_len(points + len(correlation))
        rho = np.zeros(half + 1)
        rho[: len(correlation)] = correlation
        density = np.maximum(fft.irfft(rho, 2 * half)[: half + 1] * 2 * half, 0)  # of the even continuation
        wave = rng.standard_normal(half + 1) + 1j * rng.standard_normal(half + 1)
        wave[[0, -1]] = np.sqrt(2) * wave[[0, -1]].real
        score = fft.irfft(np.sqrt(density / 2) * wave, 2 * half)[:points] * np.sqrt(2 * half)
        return self.rms * self.translation(score) + self.noise * rng.standard_normal(points)


def estimate_lines(
    lines: Sequence[np.ndarray], step: float, seed: int, settings: Settings | None = None, surface: str = ""
) -> LineEstimate:
    """Estimate a surface from heights (n,) [m] along straight lines, of equal steps [m].

    The seed and the name of the surface give the random numbers of drawn lines.

    Raises
    ------
    ScanError
        If the lines are too short, or no surface has their heights and spectrum.
    """
    settings, lengths = settings or Settings(), np.array(list(map(len, lines)))
    raw, first = _evaluated(lines, step, settings, None)
    if first.corner * lengths.max() * step / (2 * np.pi) < _FEWEST_WAVELENGTHS:
        raise ScanError(surface, "files", "is measured along lines too short to show the longest waves: measure more")
    model = _model(raw, lines, first, step, settings)  # up to the Nyquist wave number, as waves beyond those used
    sets = [_drawn(model, lengths, settings, stream(seed, "lines", surface, number)) for number in range(_SETS)]
    drawn = np.array([values for values, _ in sets])
    by_chance = np.array([fitted.misfit for _, fitted in sets])
    misfit = float(first.misfit / by_chance.mean())
    if misfit > _MISFIT and first.misfit > by_chance.max():
        reason = f"has a spectrum that is not that of Eq. (7), with {misfit:.2g} times the χ² of drawn lines"
        raise ScanError(surface, "files", f"{reason}: give a longer shortest_nm, if tip or filter took short waves")
    wider = np.repeat([1.0, np.sqrt(max(misfit, 1.0))], [3, 2])
    errors = wider * drawn.std(axis=0, ddof=1)
    values = raw - (drawn.mean(axis=0) - model.values)
    nearest = feasible(*map(float, values[1:3]), lambda: np.cov(drawn[:, 1:3].T), np.inf)
    form = [nearest.skewness, nearest.kurtosis] if nearest else model.values[1:3]
    errors[1:3] = np.hypot(errors[1:3], values[1:3] - form)
    values[1:3] = form
    spectrum = _spectrum(values, 2 * np.pi / max(2 * step, settings.shortest or 0), surface)
    errors *= _places(lines, step, settings, first, errors)
    return LineEstimate(values, errors, spectrum, model.noise)


def _spectrum(values, cutoff, surface):
    """Eq. (7) of the values of an estimate, up to a cut-off [rad m⁻¹]."""
    log_rms, _, _, log_corner, slope = map(float, values)
    try:
        return self_affine.spectrum(np.exp(log_rms), slope, np.exp(log_corner), cutoff)
    except ValueError:
        reason = "shows no power law between its longest and its shortest waves: measure with shorter steps"
        raise ScanError(surface, "files", reason) from None


def require_alike(lines: Mapping[str, tuple[np.ndarray, float]]) -> float:
    """Common step of lines, by the names of their files, of heights (n,) and steps [m] of a surface.

    Raises
    ------
    ScanError
        If steps differ, or a line is too short, or is that of no surface.
    """
    first = next(iter(lines.values()))[1]
    for name, (heights, step) in lines.items():
        slope = float(np.sqrt(np.mean(np.diff(heights) ** 2))) / step
        micrometres = f"{1e6 * step:.3g} µm between its points"
        if len(heights) < FEWEST_POINTS:
            raise ScanError(name, "files", f"has {len(heights)} points, must have at least {FEWEST_POINTS}")
        if not PIXELS[0] <= 1e6 * step <= PIXELS[1]:
            reason = f"has {micrometres}, must be from {PIXELS[0]:g} to {PIXELS[1]:g}: its places are in another unit"
            raise ScanError(name, "files", reason)
        if not SLOPES[0] <= slope <= SLOPES[1]:
            reason = f"has an rms slope of {slope:.3g}, must be from {SLOPES[0]:g} to {SLOPES[1]:g}"
            raise ScanError(name, "files", f"{reason}: its places or heights are in another unit")
        if abs(step / first - 1) > _SAME:
            reason = f"has {micrometres}, and {next(iter(lines))} has {1e6 * first:.3g} µm: resample one of them"
            raise ScanError(name, "files", reason)
    return first


def _drawn(model, lengths, settings, rng):
    """Values and fit of one set of drawn lines."""
    start = model.values[3:]
    return _evaluated([model.draw(points, rng) for points in lengths], model.step, settings, start)


def _evaluated(lines, step, settings, start):
    """Values of lines (5,), as of `LineEstimate`, with their bias, and fit of their spectrum."""
    levelled = [_levelled(line, LEVELS[settings.level]) for line in lines]
    spectrum = waves(levelled, step, settings.shortest)
    if len(spectrum.wavenumber) < FEWEST_WAVES:
        raise ScanError("", "files", "is measured along lines with too few points for a spectrum: measure longer ones")
    fitted = fit(spectrum, start)
    of_heights, variance = moments(powers(np.concatenate(levelled))), fitted.variance_of_noise(step)
    if not can_be_noise(of_heights, variance):
        fitted, variance = replace(fitted, noise=0.0), 0.0
    return np.array([*without_noise(of_heights, variance), *fitted.parameters]), fitted


def _levelled(line, degree):
    """Heights of a line less their polynomial, (n,) [m]."""
    position = np.linspace(-1, 1, len(line))
    return line - np.polynomial.legendre.legval(position, np.polynomial.legendre.legfit(position, line, degree))


def _model(values, lines, fitted, step, settings):
    """Surface with such values, or the nearest that has a density. Raises ScanError without any."""
    try:
        nearest = feasible(*map(float, values[1:3]), lambda: _scatter(lines, settings))
        if nearest is None:
            reason = "has heights that skewness and kurtosis do not describe: measure a map, or leave out marks"
            raise ScanError("", "files", reason)
        rms = float(np.exp(values[0]))
        spectrum = self_affine.spectrum(rms, fitted.slope, fitted.corner, np.pi / step)
        noise = float(np.sqrt(fitted.variance_of_noise(step)))
        return _Model(rms, Translation(nearest.density), spectrum, step, noise)
    except (ValueError, NotConverged) as reason:
        raise reason if isinstance(reason, ScanError) else ScanError("", "files", f"has no surface: {reason}") from None


def _scatter(lines, settings):
    """Covariance of skewness and kurtosis by parts of the lines, as if they were independent, (2, 2)."""
    levelled = (_levelled(line, LEVELS[settings.level]) for line in lines)
    rows = np.array([powers(section) for line in levelled for section in np.array_split(line, _PARTS)])
    return np.diag(jackknife(moments, rows)[1][1:] ** 2)


def _places(lines, step, settings, joint: LineFit, errors):
    """Growth of the errors by the difference between places, (5,), see `stiction.scans.moments.growth`."""
    if len(lines) == 1:
        return np.ones(5)
    weights = np.array(list(map(len, lines))) / sum(map(len, lines))
    alone = np.array([_evaluated([line], step, settings, joint.parameters)[0] for line in lines])
    return np.array([growth(alone[:, k], errors[k] ** 2 / weights, weights) for k in range(5)])

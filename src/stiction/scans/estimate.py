"""From the scans of a surface to everything that the model needs of it, with errors and notes on its limits.

The scans of a surface have equal numbers of points and equal size.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import chdtrc

from stiction.errors import NotConverged, ScanError
from stiction.estimates import jackknife
from stiction.scans import periodogram as spectra
from stiction.scans.holes import filled
from stiction.scans.levelling import LEVELS, Levelling, level, line_jump
from stiction.scans.model_scans import SurfaceModel, draw_model_scans, summits_of_map
from stiction.scans.moments import homogeneity, moments, powers, tile_errors, tiles
from stiction.scans.periodogram import Periodogram, Rings
from stiction.scans.quantiles import (
    COMPARED,
    SCORES,
    Feasible,
    compared_slopes,
    correlation_areas,
    feasible,
    goodness,
    measured_density,
    quantiles,
)
from stiction.scans.remainder import Remainder, remainders
from stiction.scans.scan import Frame, Scan
from stiction.scans.whittle import Reach, WhittleFit, fit_to_the_end, reach, tabulated, tip_reach
from stiction.streams import stream
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import LARGEST_DISTANCE_OF_SCANS
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum
from stiction.surface.summits import radius_and_density

#: Fewest wavelengths of the corner along a scan: for a plateau at all, and for reliable errors.
FEWEST_WAVELENGTHS, ENOUGH_WAVELENGTHS = 4, 10
#: Largest relative difference between the sizes of the scans of a surface.
_SAME_SIZE = 0.01
#: Rounds of bias correction; the second starts from the corrected surface.
_ROUNDS = 2
#: Fewest model scans of a round per scan: the error of the bias is small beside that of the scans.
_PER_SCAN = 8
#: Heights farther apart than this number of wavelengths of the corner are not correlated.
_CORRELATED = 2
#: Limits of the flags: error by tiles over that of the closed form, χ² per degree of freedom, sector ratio, p, step
#: between lines over step along them, and difference of the summits in standard errors.
_TILES, _MISFIT, _ANISOTROPY, _UNLIKELY, _JUMP, _SUMMITS = 2.0, 2.0, 1.5, 0.01, 2.0, 4.0
#: Names of the moments in flags, and a factor of an error that is worth a flag.
_MOMENTS, _WIDER = ("rms", "skewness", "kurtosis"), 1.1
#: Difference of the largest and the smallest of 8 normal values that is exceeded with the probability 0.01, in standard
#: deviations (studentized range).
_RANGE_OF_SECTORS = 4.99


@dataclass(frozen=True)
class Settings:
    """How scans are evaluated."""

    levelling: Levelling = Levelling()
    tip_radius: float | None = None  #: of the microscope [m]
    shortest: float | None = None  #: wavelength used of the spectrum; four pixels by default [m]
    tiles: int = 4  #: tiles along each side of a scan, whose scatter tests that the scan is homogeneous
    undefined_share: float = 0.01  #: largest share of points without height [-]


@dataclass(frozen=True)
class Inspection:
    """What the scans show without any model."""

    names: tuple[str, ...]  #: of the scans
    frame: Frame
    settings: Settings
    levelled: tuple[np.ndarray, ...]  #: heights, NaN where undefined, (n1, n2) each [m]
    complete: tuple[np.ndarray, ...]  #: the same with undefined points filled from their neighbours [m]
    periodogram: Periodogram
    rings: Rings
    reach: Reach
    fit: WhittleFit

    @cached_property
    def powers(self) -> np.ndarray:
        """Means of z … z⁴ of every scan, (n, 4)."""
        return np.array([powers(z) for z in self.levelled])

    @property
    def moments(self) -> np.ndarray:
        """Moments (ln rms, skewness, kurtosis) of all scans together, (3,)."""
        return moments(self.powers.mean(axis=0))

    @cached_property
    def quantiles(self) -> np.ndarray:
        """Standardised heights of all scans together at `stiction.scans.quantiles.SCORES`, (49,) [-]."""
        return quantiles(self.levelled)

    @property
    def spectrum(self) -> CutoffSelfAffine:
        """Fit, up to the end of the measured spectrum."""
        return self.fit.spectrum(self.reach.end)

    @property
    def filled_share(self) -> float:
        """Share of the undefined points of all scans [-]."""
        return float(np.mean(~np.isfinite(self.levelled)))

    @cached_property
    def remainders(self) -> tuple[Remainder, ...]:
        """Tilts and bows that levelling left."""
        error = np.sqrt(self.fit.covariance[0, 0])
        return remainders(self.levelled, self.frame.size, self.settings.levelling, self.spectrum, error)

    @property
    def wavelengths(self) -> float:
        """Wavelengths of the corner along the shorter side [-]."""
        return self.fit.corner * min(self.frame.size) / (2 * np.pi)

    @property
    def areas(self) -> float:
        """Correlation areas of all scans [-]."""
        return correlation_areas(self.spectrum, np.exp(2 * self.moments[0]), self.frame.area * len(self.names))


def inspect(scans: Sequence[Scan], settings: Settings) -> Inspection:
    """Level the scans and fit their spectrum: the fast part of `estimate`, with all reasons to refuse scans.

    Raises
    ------
    ScanError
        If scans of different points or size are given, if too many points are undefined, or if the scans are too small
        to show the plateau of the spectrum.
    """
    frame, names = scans[0].frame, tuple(scan.name for scan in scans)
    for scan in scans:
        _refuse_other_frame(scan, scans[0])
        if scan.undefined_share > settings.undefined_share:
            share = f"{100 * scan.undefined_share:.3g} % of its points undefined"
            raise ScanError(scan.name, "files", f"has {share}, at most {100 * settings.undefined_share:.3g} % may be")
    levelled = tuple(level(scan.heights, settings.levelling) for scan in scans)
    complete = tuple(filled(z, frame.pixel) for z in levelled)
    spectrum = spectra.periodogram(complete, frame.size)
    tip = np.inf if settings.tip_radius is None else tip_reach(complete, frame.pixel[0], settings.tip_radius)
    within = reach(frame.size, frame.pixel, settings.shortest, tip)
    rings = spectra.rings(spectrum)
    try:
        fitted, within = fit_to_the_end(rings, within)
    except ValueError as reason:
        raise ScanError(", ".join(names), "files", f"cannot give a spectrum: {reason}") from None
    found = Inspection(names, frame, settings, levelled, complete, spectrum, rings, within, fitted)
    if found.wavelengths < FEWEST_WAVELENGTHS:
        side = min(frame.size) * FEWEST_WAVELENGTHS / found.wavelengths
        raise ScanError(
            ", ".join(names),
            "files",
            f"shows no plateau of the spectrum: {found.wavelengths:.2g} wavelengths of its corner fit into the scan, "
            f"{FEWEST_WAVELENGTHS} are needed, as on a side of about {1e6 * side:.2g} µm or more",
        )
    return found


def _refuse_other_frame(scan, first):
    """Refuse a scan that is not like the first one."""
    if scan.frame.shape != first.frame.shape or not np.allclose(scan.size, first.size, rtol=_SAME_SIZE, atol=0):
        shown = [
            f"{s.frame.shape[0]} x {s.frame.shape[1]} points on {1e6 * s.size[0]:.4g} x {1e6 * s.size[1]:.4g} µm"
            for s in (scan, first)
        ]
        raise ScanError(scan.name, "files", f"has {shown[0]}, {first.name} has {shown[1]}: all must be alike")


@dataclass(frozen=True)
class SurfaceEstimate:
    """A surface measured by scans. Moments are (ln rms, skewness, kurtosis), the rms in metres."""

    inspection: Inspection
    moments: np.ndarray  #: without the bias of levelling and finite size, (3,)
    covariance: np.ndarray  #: of the moments, by the finite scans and model scans; see `widened`, (3, 3)
    closed_form_errors: np.ndarray  #: standard errors of the moments if the heights have the density of the model, (3,)
    tile_errors: np.ndarray  #: standard errors of the moments from the scatter of tiles, (3,)
    homogeneity: tuple[np.ndarray, np.ndarray]  #: χ² of the scatter between scans and p, (3,) each
    model: SurfaceModel  #: surface of which the model scans were drawn
    feasible: Feasible | None  #: maximum-entropy density of the model, ``None`` if it has the measured density
    quantiles: np.ndarray  #: at `stiction.scans.quantiles.SCORES`, without the bias of levelling, (49,) [-]
    quantile_errors: np.ndarray  #: (49,) [-]
    goodness: tuple[float, float]  #: χ² of the quantiles against the four-moment density, and p; ``nan`` without it
    sectors: np.ndarray  #: mean of the spectrum in directions relative to that in all, (8,) [-]
    sector_errors: np.ndarray  #: (8,) [-]
    summits: np.ndarray  #: radius [m] and density [m⁻²], (2,); ``nan`` without summits or square pixels
    summit_errors: np.ndarray  #: (2,)
    model_summits: np.ndarray  #: of the model scans, (2,)
    model_summit_errors: np.ndarray  #: scatter between model scans, (2,)
    line_jump: tuple[float, float]  #: largest `stiction.scans.levelling.line_jump` of the scans [m]

    @property
    def errors(self) -> np.ndarray:
        """Standard errors of the moments, (3,)."""
        return np.sqrt(np.diag(self.covariance))

    def density(self, heights: str) -> HeightDensity | MeasuredDensity:
        """Height density of ``moments`` (maximum entropy) or ``measured``.

        Raises
        ------
        ScanError
            If the measured moments, and none near them, have a maximum-entropy density.
        """
        if heights == "measured":
            return measured_density(self.quantiles, self.inspection.areas)
        if self.feasible is None:
            raise ScanError(", ".join(self.inspection.names), "heights", _infeasible(self) + ": use measured")
        return self.feasible.density

    def spectrum(self, psd: str, cutoff: float) -> CutoffSelfAffine | TabulatedSpectrum:
        """Spectrum ``fitted`` or ``tabulated`` up to a cut-off [rad m⁻¹]."""
        found = self.inspection
        if psd == "fitted":
            return found.fit.spectrum(cutoff)
        return tabulated(found.rings, found.reach, found.fit.slope, cutoff)

    @property
    def flags(self) -> tuple[str, ...]:
        """Sentences on everything that limits the estimate."""
        return tuple(sentence for flag in _FLAGS if (sentence := flag(self)))


def estimate(
    scans: Sequence[Scan], seed: int, settings: Settings | None = None, surface: str = "", model_scans: int = 24
) -> SurfaceEstimate:
    """Estimate a surface from its scans.

    Parameters
    ----------
    scans : sequence of Scan
    seed : int
        Of the random numbers of the model scans.
    settings : Settings, optional
    surface : str
        Its name, part of the addresses of these numbers.
    model_scans : int
        Model scans of a round, more if there are many scans.

    Raises
    ------
    ScanError
        If the scans cannot be used, or no surface has their heights and spectrum.
    """
    settings = settings or Settings()
    found = inspect(scans, settings)
    values, heights = found.moments, found.quantiles
    model, nearest = _model(found, values, heights)
    # Feasibility is decided once, on the uncorrected moments, so that a run cannot refuse what validation accepted.
    largest = LARGEST_DISTANCE_OF_SCANS if nearest is None else np.inf
    residuals = []
    for number in range(_ROUNDS):
        rngs = (stream(seed, "estimate", surface, number, k) for k in range(max(model_scans, _PER_SCAN * len(scans))))
        drawn = draw_model_scans(model, settings.levelling, rngs)
        values = found.moments - drawn.bias(model.moments, len(scans))
        heights = found.quantiles - drawn.levelled_off.mean(axis=0)
        residuals.append(_residual(nearest, drawn.quantiles, moments(drawn.powers)))
        model, nearest = _model(found, values, heights, largest)
    closed_form = model.covariance / len(scans) + drawn.bias_covariance
    by_tiles = tile_errors(found.levelled, settings.tiles)
    fitness = goodness(_residual(nearest, found.quantiles, found.moments), np.vstack(residuals), len(scans))
    described = nearest is not None and not fitness[1] < _UNLIKELY
    sectors, sector_errors = spectra.sectors(found.periodogram, found.rings, found.reach.low, found.reach.high)
    return SurfaceEstimate(
        inspection=found,
        moments=values,
        covariance=closed_form if described else widened(closed_form, by_tiles),
        closed_form_errors=np.sqrt(np.diag(closed_form)),
        tile_errors=by_tiles,
        homogeneity=homogeneity(moments(found.powers), model.covariance),
        model=model,
        feasible=nearest,
        quantiles=heights,
        quantile_errors=drawn.quantiles.std(axis=0, ddof=1) / np.sqrt(len(scans)),
        goodness=fitness,
        sectors=sectors,
        sector_errors=sector_errors,
        **_summits(found, drawn),
        line_jump=max(line_jump(z, found.frame.pixel) for z in found.levelled),
    )


def nearest_density(found: Inspection) -> Feasible | None:
    """Maximum-entropy density of the scans as they are, before the bias is known; ``None`` if there is none near.

    Raises
    ------
    ScanError
        If no surface has the heights and the spectrum of the scans.
    """
    return _model(found, found.moments, found.quantiles)[1]


def _model(found, values, heights, largest=LARGEST_DISTANCE_OF_SCANS):
    """Surface with these moments, or with the density of these quantiles if they have none, and that of the moments."""
    correlation = _CORRELATED * 2 * np.pi / found.fit.corner

    def surface(density):
        return SurfaceModel(density, found.spectrum, correlation, float(np.exp(values[0])), found.frame)

    try:
        fallback = surface(measured_density(heights, found.areas))
        density = feasible(*map(float, values[1:]), lambda: fallback.covariance[1:, 1:] / len(found.names), largest)
        model = fallback if density is None else surface(density.density)
        model.underlying  # noqa: B018
    except (ValueError, NotConverged) as reason:
        raise ScanError(
            ", ".join(found.names), "files", f"has heights that no surface can be drawn with: {reason}"
        ) from None
    return model, density


def widened(closed_form: np.ndarray, by_tiles: np.ndarray) -> np.ndarray:
    """Covariance with the standard errors by tiles where these are larger, and unchanged correlations, (3, 3).

    For heights that four moments do not describe: errors in closed form follow from moments of the density up to the
    eighth, and those of the real heights, which the tiles sample, may be much larger.

    Parameters
    ----------
    closed_form : (3, 3) array
        Covariance.
    by_tiles : (3,) array
        Standard errors.
    """
    ratio = np.maximum(by_tiles / np.sqrt(np.diag(closed_form)), 1)
    return closed_form * np.outer(ratio, ratio)


def _residual(nearest: Feasible | None, quantile: np.ndarray, moment: np.ndarray):
    """Compared quantiles less those of maximum entropy with the moments (..., 3) of the same scan, (..., 5) [-].

    The moments are near those of ``nearest``, so that the density is not solved for every scan; ``nan`` without it, or
    without others near it.
    """
    unknown = np.full_like(quantile[..., COMPARED], np.nan)
    if nearest is None:
        return unknown
    try:
        slopes = compared_slopes(nearest.skewness, nearest.kurtosis)
    except (ValueError, NotConverged):
        return unknown
    shift = moment[..., 1:] - [nearest.skewness, nearest.kurtosis]
    return quantile[..., COMPARED] - nearest.density.quantile_of_normal(SCORES[COMPARED]) - shift @ slopes


def _summits(found, drawn):
    """Summits of the scans, with errors by tiles, and of the model scans."""
    count = found.settings.tiles
    per_tile = [
        summits_of_map(tile, _tile_frame(found.frame, tile)) for z in found.complete for tile in tiles(z, count)
    ]
    values, errors = jackknife(radius_and_density, np.array(per_tile))
    modelled, error = jackknife(radius_and_density, drawn.summits)
    return {
        "summits": values,
        "summit_errors": errors,
        "model_summits": modelled,
        "model_summit_errors": np.sqrt(len(drawn.summits)) * error,
    }


def _tile_frame(frame, tile):
    """Frame of a tile of a scan."""
    return Frame(tile.shape, tuple(n * p for n, p in zip(tile.shape, frame.pixel, strict=True)))


def _infeasible(found: SurfaceEstimate):
    _, skewness, kurtosis = found.moments
    return f"skewness {skewness:.3g} with kurtosis {kurtosis:.3g} has no maximum-entropy density"


def _few_wavelengths(found):
    number = found.inspection.wavelengths
    if number < ENOUGH_WAVELENGTHS:
        return f"only {number:.2g} wavelengths of the corner fit into the scan; errors are reliable from 10 on"
    return ""


def _not_homogeneous(found):
    ratio = np.max(found.tile_errors / found.closed_form_errors)
    if ratio > _TILES:
        reason = "bow, particles or marks"
        return f"parts of a scan differ {ratio:.2g} times as much as those of one homogeneous surface ({reason})"
    return ""


def _bowed(found):
    inspection = found.inspection
    left = [remainder for remainder in inspection.remainders if remainder.likely < _UNLIKELY]
    if not left:
        return ""
    size = left[-1].rms / np.exp(inspection.moments[0])
    shape = "tilt" if LEVELS[left[-1].level] == 1 else "bow"
    return f"levelling leaves a {shape} of {size:.2g} rms (p {left[-1].likely:.1g}); level: {left[-1].level} removes it"


def _holes(found):
    share = found.inspection.filled_share
    return f"{100 * share:.2g} % of the points were undefined and are filled from their neighbours" if share else ""


def _scans_differ(found):
    likely = found.homogeneity[1]
    names = [name for name, p in zip(_MOMENTS, likely, strict=True) if p < _UNLIKELY]
    return f"the scans differ in {', '.join(names)} by more than their errors" if names else ""


def _spectrum_misfits(found):
    fit = found.inspection.fit
    ratio = fit.chi2 / fit.freedom
    if ratio > _MISFIT and chdtrc(fit.freedom, fit.chi2) < _UNLIKELY:
        return f"the spectrum is not of the form of Eq. (7) (chi²/dof {ratio:.2g}); psd: tabulated follows it"
    return ""


def _spectrum_ends(found):
    within = found.inspection.reach
    if within.end < within.nyquist:
        return f"the spectrum ends near {1e-6 * within.end:.3g} rad/µm; beyond: cut ends there, too"
    return ""


def _anisotropic(found):
    ratio = found.sectors.max() / found.sectors.min()
    if not np.log(ratio) > max(np.log(_ANISOTROPY), _RANGE_OF_SECTORS * found.sector_errors.max()):
        return ""
    width = 180 / spectra.SECTORS
    direction = (np.argmax(found.sectors) + 0.5) * width
    return (
        f"the spectrum is {ratio:.2g} times as large at {direction:.0f}° to the fast axis as in the weakest direction"
    )


def _moments_have_no_density(found):
    if found.feasible is None:
        return f"{_infeasible(found)}, nor have others within their errors; only heights: measured can be used"
    if found.feasible.distance > 0:
        near = f"skewness {found.feasible.skewness:.3g} with kurtosis {found.feasible.kurtosis:.3g}"
        return f"{_infeasible(found)}; {near}, which is {found.feasible.distance:.2g} standard errors away, is used"
    return ""


def _moments_do_not_describe(found):
    distance, likely = found.goodness
    if likely < _UNLIKELY:
        return f"four moments do not describe the heights (T² {distance:.3g}, p {likely:.1g}); heights: measured does"
    return ""


def _errors_are_wider(found):
    ratio = found.errors / found.closed_form_errors
    names = [name for name, r in zip(_MOMENTS, ratio, strict=True) if r > _WIDER]
    if not names:
        return ""
    return f"errors of {', '.join(names)} are those by tiles, up to {ratio.max():.2g} times those in closed form"


def _tip_rounds(found):
    within = found.inspection.reach
    if within.tip < within.nyquist:
        return f"the tip rounds waves shorter than {2e9 * np.pi / within.tip:.3g} nm"
    return ""


def _lines_jump(found):
    slow, fast = found.line_jump
    if slow > _JUMP * fast:
        steps = f"{1e9 * slow:.2g} nm, against steps of {1e9 * fast:.2g} nm along a line"
        return f"lines jump by {steps}; lines: offset levels them"
    return ""


def _summits_differ(found):
    # ASSUME: the spectrum of the model errs as much as the summits of its scans scatter; its rms changes all radii.
    variance = found.summit_errors**2 + found.model_summit_errors**2 / len(found.inspection.names)
    variance[0] += (found.errors[0] * found.summits[0]) ** 2
    if not np.any(np.abs(found.summits - found.model_summits) > _SUMMITS * np.sqrt(variance)):
        return ""
    radius, density = found.summits / found.model_summits
    sharper = radius < 1 < density
    reason = "noise, or short waves that the fit does not have" if sharper else "its short waves differ from the scans"
    return f"summits have {radius:.2g} times the radius and {density:.2g} times the density of the model: {reason}"


def _no_summits(found):
    if np.isfinite(found.summits + found.summit_errors).all():
        return ""
    reason = "there are too few" if found.inspection.frame.square else "pixels are not square"
    return f"{reason}: summits are not compared"


_FLAGS = (
    _few_wavelengths,
    _bowed,
    _holes,
    _not_homogeneous,
    _scans_differ,
    _spectrum_misfits,
    _spectrum_ends,
    _anisotropic,
    _moments_have_no_density,
    _moments_do_not_describe,
    _errors_are_wider,
    _tip_rounds,
    _lines_jump,
    _summits_differ,
    _no_summits,
)

"""Everything needed by the model from the scans of a surface, with errors and notes on its limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtrc

from stiction.errors import NotConverged, ScanError
from stiction.estimates import jackknife
from stiction.scans import flags
from stiction.scans import periodogram as spectra
from stiction.scans.flags import UNLIKELY, infeasible
from stiction.scans.inspection import Inspection, Maps, Settings, inspect
from stiction.scans.levelling import line_jump
from stiction.scans.model_scans import SurfaceModel, draw_model_scans, summits_of_map
from stiction.scans.moments import growth, homogeneity, moments, tile_errors, tiles
from stiction.scans.quantiles import COMPARED, SCORES, Feasible, compared_slopes, feasible, goodness, measured_density
from stiction.scans.scan import Frame, Scan
from stiction.scans.whittle import spectrum
from stiction.streams import stream
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.feasible import LARGEST_DISTANCE_OF_SCANS
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum
from stiction.surface.summits import radius_and_density

#: Rounds of bias correction; the second starts from the corrected surface.
_ROUNDS = 2
#: Fewest model scans of a round per scan: the error of the bias is small beside that of the scans.
_PER_SCAN = 8
#: Heights farther apart than this number of wavelengths of the corner are not correlated.
_CORRELATED = 2


def model_in(inspection: Inspection, model: SurfaceModel, maps: Maps) -> SurfaceModel:
    """Model of a surface in scans of another size."""
    return (
        model if maps is inspection.largest else replace(model, spectrum=inspection.spectrum_in(maps), frame=maps.frame)
    )


@dataclass(frozen=True)
class SurfaceEstimate:
    """Surface measured by scans. Moments are (ln rms, skewness, kurtosis), the rms in metres."""

    inspection: Inspection
    moments: np.ndarray  #: without white noise and without the bias of levelling and finite size, (3,)
    covariance: np.ndarray  #: of the moments at another place, see `widened` and `elsewhere`, (3, 3)
    closed_form_errors: np.ndarray  #: standard errors of the moments if the heights have the density of the model, (3,)
    tile_errors: np.ndarray  #: standard errors of the moments from the scatter of tiles, (3,)
    places: np.ndarray  #: `stiction.scans.moments.growth` of the errors of moments, ln corner and slope, (5,) [-]
    homogeneity: tuple[np.ndarray, np.ndarray]  #: χ² of the scatter between scans of one size and p, (3,) each
    agreement: tuple[np.ndarray, np.ndarray]  #: the same between sizes, (3,) each
    model: SurfaceModel  #: surface of which the model scans of the largest size were drawn
    feasible: Feasible | None  #: maximum-entropy density of the model, ``None`` if it has the measured density
    quantiles: np.ndarray  #: at `stiction.scans.quantiles.SCORES`, without the bias of levelling, (49,) [-]
    quantile_errors: np.ndarray  #: (49,) [-]
    goodness: tuple[float, float]  #: χ² of the quantiles against the four-moment density, and p; ``nan`` without it
    sectors: np.ndarray  #: mean of the spectrum in directions relative to that in all, (8,) [-]
    sector_errors: np.ndarray  #: (8,) [-]
    summits: np.ndarray  #: of the finest scans, radius [m] and density [m⁻²], (2,); ``nan`` without square pixels
    summit_errors: np.ndarray  #: (2,)
    model_summits: np.ndarray  #: of the model scans, (2,)
    model_summit_errors: np.ndarray  #: scatter between model scans, (2,)
    line_jump: tuple[float, float]  #: largest `stiction.scans.levelling.line_jump` of the scans [m]

    @property
    def errors(self) -> np.ndarray:
        """Standard errors of the moments, (3,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def fit_covariance(self) -> np.ndarray:
        """Covariance of (ln plateau, ln corner, slope) at another place, (3, 3)."""
        corner, slope = self.places[3:]
        return elsewhere(self.inspection.fit.covariance, np.array([max(corner, slope), corner, slope]))

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
            raise ScanError(", ".join(self.inspection.names), "heights", infeasible(self) + ": use measured")
        return self.feasible.density

    def spectrum(self, psd: str, cutoff: float) -> CutoffSelfAffine | TabulatedSpectrum:
        """Spectrum ``fitted``, unless the scans contradict it, or ``tabulated``, up to a cut-off [rad m⁻¹]."""
        inspection = self.inspection
        return spectrum(psd, inspection.fit, inspection.rings, inspection.reach, cutoff)

    @property
    def flags_by_kind(self) -> dict[str, str]:
        """Sentences on all limits of the estimate, by the kind of limit."""
        return flags.by_kind(self)

    @property
    def flags(self) -> tuple[str, ...]:
        """Sentences on all limits of the estimate."""
        return tuple(self.flags_by_kind.values())


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
    inspection = inspect(scans, settings)
    values, heights = inspection.moments, inspection.quantiles
    model, nearest = _model(inspection, values, heights)
    # Feasibility is decided once, on the uncorrected moments, so that a run cannot refuse what validation accepted.
    farthest = LARGEST_DISTANCE_OF_SCANS if nearest is None else np.inf
    residuals = []
    for number in range(_ROUNDS):
        drawn = _drawn_scans(
            inspection, model, lambda k, number=number: stream(seed, "estimate", surface, number, k), model_scans
        )
        of_sizes, heights = _unbiased(inspection, drawn, model)
        values = inspection.averaged(of_sizes)
        residuals.append(_residual(nearest, drawn[0].quantiles, moments(drawn[0].powers)))
        model, nearest = _model(inspection, values, heights, farthest)
    largest, count = inspection.largest, len(inspection.largest.names)
    fitness = goodness(_residual(nearest, largest.quantiles, largest.noisy_moments), np.vstack(residuals), count)
    return SurfaceEstimate(
        inspection=inspection,
        moments=values,
        homogeneity=_homogeneity(inspection, model),
        model=model,
        feasible=nearest,
        quantiles=heights,
        quantile_errors=_quantile_errors(inspection, drawn),
        goodness=fitness,
        **_errors(inspection, model, drawn, of_sizes, nearest is not None and not fitness[1] < UNLIKELY),
        agreement=_agreement(of_sizes, values, _covariances(inspection, model, drawn)),
        **_sectors(inspection),
        **_summits(inspection, drawn),
        line_jump=max(line_jump(z, maps.frame.pixel) for maps in inspection.sizes for z in maps.levelled),
    )


def _covariances(inspection, model, model_scans):
    """Covariance of the moments of every size, (3, 3) each."""
    return [
        model_in(inspection, model, maps).covariance / maps.number
        + scans_of_size.bias_covariance
        + maps.noise_covariance
        for maps, scans_of_size in zip(inspection.counted, model_scans, strict=False)
    ]


def _errors(inspection, model, model_scans, of_sizes, described):
    """Covariance of the moments, by their form if four moments describe the heights, and their errors of all kinds."""
    closed_form = inspection.propagated(_covariances(inspection, model, model_scans))
    of_tiles = [tile_errors(maps.levelled, inspection.settings.tiles) ** 2 for maps in inspection.counted]
    by_tiles = np.sqrt(inspection.propagated(of_tiles))
    covariance = closed_form if described else widened(closed_form, by_tiles)
    places = _places(inspection, model, of_sizes, np.diag(covariance) / np.diag(closed_form))
    return {
        "covariance": elsewhere(covariance, places[:3]),
        "closed_form_errors": np.sqrt(np.diag(closed_form)),
        "tile_errors": by_tiles,
        "places": places,
    }


def _places(inspection, model, of_sizes, wider):
    """Growth of the errors of moments and spectrum by the difference between places, (5,) [-].

    Variances of the moments of a scan are those in closed form times ``wider``, (3,).
    """
    rows = []
    for maps, weight, unbiased in zip(inspection.counted, inspection.weights, of_sizes, strict=True):
        values = moments(maps.powers) + unbiased - maps.noisy_moments
        variances = np.diag(model_in(inspection, model, maps).covariance) * wider
        rows += [(*scan, *variances, weight / len(values)) for scan in values]
    of_moments, of_spectra = np.array(rows), np.array(inspection.spectra_of_scans)
    columns = [(of_moments, 3, k) for k in range(3)] + [(of_spectra, 2, k) for k in range(2)]
    return np.array([growth(table[:, k], table[:, k + n], table[:, -1]) for table, n, k in columns])


def _sectors(inspection):
    """Spectrum of the largest scans by direction, relative to all directions, where resolved, and its errors."""
    reach, largest = inspection.reach, inspection.largest
    resolved = reach.low, min(reach.high, largest.reach.high)
    sectors, errors = spectra.sectors(largest.periodogram, inspection.rings, *resolved)
    return {"sectors": sectors, "sector_errors": errors}


def _unbiased(inspection, model_scans, model):
    """Moments of every size, and quantiles of all together, less the changes by levelling and the finite size."""
    counted = list(zip(inspection.counted, model_scans, strict=False))
    of_sizes = [maps.moments - scans_of_size.bias(model.moments, len(maps.names)) for maps, scans_of_size in counted]
    return of_sizes, inspection.averaged(
        [maps.quantiles - scans_of_size.levelled_off.mean(axis=0) for maps, scans_of_size in counted]
    )


def _drawn_scans(inspection, model, rng, fewest):
    """Draw model scans of every size. ``rng(k)`` gives the random numbers of number k of all."""
    counts = [max(fewest, _PER_SCAN * len(maps.names)) for maps in inspection.sizes]
    first = np.cumsum([0, *counts])
    return [
        draw_model_scans(
            model_in(inspection, model, maps), inspection.settings.levelling, (rng(k + start) for k in range(count))
        )
        for maps, count, start in zip(inspection.sizes, counts, first, strict=False)
    ]


def nearest_density(inspection: Inspection) -> Feasible | None:
    """Maximum-entropy density of the raw scans, before the bias is known, or ``None`` without one nearby.

    Raises
    ------
    ScanError
        If no surface has the heights and the spectrum of the scans.
    """
    return _model(inspection, inspection.moments, inspection.quantiles)[1]


def _model(inspection, values, heights, largest=LARGEST_DISTANCE_OF_SCANS):
    """Surface with these moments, or with the density of these quantiles without moments, and the moments' density."""
    correlation = _CORRELATED * 2 * np.pi / inspection.fit.corner

    def surface(density):
        """Surface with a density, and the spectrum of the scans."""
        spectrum = inspection.spectrum_in(inspection.largest)
        return SurfaceModel(density, spectrum, correlation, float(np.exp(values[0])), inspection.largest.frame)

    try:
        fallback = surface(measured_density(heights, inspection.areas))
        density = feasible(*map(float, values[1:]), lambda: _covariance(inspection, fallback)[1:, 1:], largest)
        model = fallback if density is None else surface(density.density)
        model.underlying  # noqa: B018
    except (ValueError, NotConverged) as reason:
        raise ScanError(
            ", ".join(inspection.names), "files", f"has heights that no surface can be drawn with: {reason}"
        ) from None
    return model, density


def _covariance(inspection, model):
    """Covariance of the moments of all scans by the finite scans, (3, 3)."""
    return inspection.propagated(
        [model_in(inspection, model, maps).covariance / maps.number for maps in inspection.counted]
    )


def _homogeneity(inspection, model):
    """`stiction.scans.moments.homogeneity` of the scans of every size, together."""
    parts = [
        (maps, homogeneity(moments(maps.powers), model_in(inspection, model, maps).covariance))
        for maps in inspection.counted
    ]
    several = [(len(maps.names) - 1, chi2) for maps, (chi2, _) in parts if len(maps.names) > 1]
    if not several:
        return parts[0][1]
    freedom, chi2 = (sum(values) for values in zip(*several, strict=True))
    return chi2, chdtrc(freedom, chi2)


def _agreement(of_sizes, values, covariances):
    """χ² of the moments of the sizes against their mean, and the probability of a larger one, (3,) each, or ``nan``."""
    freedom = len(of_sizes) - 1
    if freedom == 0:
        return np.full(3, np.nan), np.full(3, np.nan)
    chi2 = sum((size - values) ** 2 / np.diag(error) for size, error in zip(of_sizes, covariances, strict=True))
    return chi2, chdtrc(freedom, chi2)


def _quantile_errors(inspection, model_scans):
    """Standard errors of the quantiles by the scatter of model scans, (49,) [-]."""
    variances = [
        (scans_of_size.quantiles.std(axis=0, ddof=1) / np.sqrt(len(maps.names))) ** 2
        for maps, scans_of_size in zip(inspection.counted, model_scans, strict=False)
    ]
    return np.sqrt(inspection.propagated(variances))


def widened(closed_form: np.ndarray, by_tiles: np.ndarray) -> np.ndarray:
    """Covariance with the larger of its errors and of those by tiles (3,), and unchanged correlations, (3, 3).

    For heights that four moments do not describe: errors in closed form follow from moments of the density up to the
    eighth, and those of the real heights, which the tiles sample, may be much larger.
    """
    ratio = np.maximum(by_tiles / np.sqrt(np.diag(closed_form)), 1)
    return closed_form * np.outer(ratio, ratio)


def elsewhere(covariance: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Covariance (k, k) whose errors have grown by the difference between places (k,).

    ASSUME: quantities of places are correlated as those of finite scans. Few scans do not show these correlations.
    """
    return covariance * np.outer(places, places)


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


def _summits(inspection, model_scans):
    """Summits of the finest scans, with errors by tiles, and of the model scans."""
    maps, count = inspection.finest, inspection.settings.tiles
    per_tile = [summits_of_map(tile, _tile_frame(maps.frame, tile)) for z in maps.complete for tile in tiles(z, count)]
    values, errors = jackknife(radius_and_density, np.array(per_tile))
    of_model = model_scans[inspection.sizes.index(maps)].summits
    modelled, error = jackknife(radius_and_density, of_model)
    return {
        "summits": values,
        "summit_errors": errors,
        "model_summits": modelled,
        "model_summit_errors": np.sqrt(len(of_model)) * error,
    }


def _tile_frame(frame, tile):
    """Frame of a tile of a scan."""
    return Frame(tile.shape, tuple(n * p for n, p in zip(tile.shape, frame.pixel, strict=True)))

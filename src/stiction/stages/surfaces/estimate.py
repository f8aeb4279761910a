"""Stage estimate: a measured surface with errors, from its scans."""

import warnings
from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np
import xarray as xr

from stiction.analysis.shifts import ORDERS
from stiction.config.units import from_si
from stiction.models import MODE_QUANTITIES
from stiction.plan.stage import Running, Stage
from stiction.scans import estimate as evaluation
from stiction.scans import periodogram as spectra
from stiction.scans import whittle
from stiction.scans.estimate import SurfaceEstimate
from stiction.scans.histogram import EDGES, histogram, histogram_errors
from stiction.scans.moments import mode_covariance, moments
from stiction.scans.periodogram import Rings
from stiction.scans.quantiles import SCORES, measured_density
from stiction.scans.scan import Frame
from stiction.scans.whittle import Reach, WhittleFit
from stiction.stages.surfaces import scan as stage_scan
from stiction.stages.surfaces.surface_flags import NOTE, flagged
from stiction.surface import maxent
from stiction.surface.empirical import MeasuredDensity
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum

MOMENTS = ("ln_rms", "skewness", "kurtosis")
PARAMETERS = ("ln_plateau", "ln_corner", "slope")
#: Variables of the fields of `stiction.scans.whittle.Reach`.
_REACH = ("lowest", "highest", "nyquist", "tip", "end")


@dataclass(frozen=True)
class Settings:
    """Settings of an estimate, without the scans."""

    seed: int
    evaluation: evaluation.Settings
    model_scans: int  #: number of model scans, more if there are more scans
    files: tuple[str, ...] = ()  #: names of the files; they do not affect the numbers
    left_out: tuple[str, ...] = ()  #: sentences on files that are not used, as well


def compute(scans: Sequence[xr.Dataset], surface: str, settings: Settings) -> xr.Dataset:
    """Estimate a surface from its scans. A warning states each limit of the estimate.

    Raises
    ------
    ScanError
        If the scans cannot be used, or no surface has their heights and spectrum.
    """
    maps = [stage_scan.scan_of(dataset) for dataset in scans]
    estimate = evaluation.estimate(maps, settings.seed, settings.evaluation, surface, settings.model_scans)
    for sentence in estimate.flags:
        warnings.warn(f"surface {surface}: {sentence}", stacklevel=2)
    return layout(estimate, [*settings.left_out, *(note for data in scans for note in stage_scan.notes(data))])


def layout(estimate: SurfaceEstimate, notes: Sequence[str] = ()) -> xr.Dataset:
    """Dataset of an estimate. The notes on the files follow the sentences on the estimate."""
    return xr.Dataset(
        _moments(estimate) | _spectrum(estimate) | _heights(estimate) | _summits(estimate) | _scans(estimate, notes),
        coords={
            "moment": list(MOMENTS),
            "other_moment": list(MOMENTS),
            "shape": ["skewness", "kurtosis", "distance"],
            "quantity": [*MOMENTS, *PARAMETERS[1:]],
            "parameter": list(PARAMETERS),
            "other_parameter": list(PARAMETERS),
            "score": ("score", SCORES),
            "summit": ["radius", "density"],
            "axis": ["fast", "slow"],
            "mode": list(MODE_QUANTITIES),
            "other_mode": list(MODE_QUANTITIES),
        },
    )


def _moments(estimate):
    """Variables of the moments, their errors, and whether scans agree."""
    inspection, nearest = estimate.inspection, estimate.feasible
    near = (np.nan,) * 3 if nearest is None else (nearest.skewness, nearest.kurtosis, nearest.distance)
    powers = np.array(inspection.in_order([maps.powers for maps in inspection.sizes]))
    return {
        "moments": ("moment", estimate.moments),
        "covariance": (("moment", "other_moment"), estimate.covariance),
        "raw_moments": ("moment", inspection.moments),
        "scan_moments": (("scan", "moment"), moments(powers)),
        "closed_form_errors": ("moment", estimate.closed_form_errors),
        "places": ("quantity", estimate.places),
        "tile_errors": ("moment", estimate.tile_errors),
        "homogeneity_chi2": ("moment", estimate.homogeneity[0]),
        "homogeneity_p": ("moment", estimate.homogeneity[1]),
        "agreement_chi2": ("moment", estimate.agreement[0]),
        "agreement_p": ("moment", estimate.agreement[1]),
        "feasible": ("shape", list(near)),
    }


def _spectrum(estimate):
    """Variables of the spectrum, its fit, and the wave numbers resolved by the scans."""
    inspection, largest = estimate.inspection, estimate.inspection.largest
    rings, fit = inspection.rings, inspection.fit
    slow = spectra.rings(largest.periodogram, largest.periodogram.near_slow_axis)
    reach = zip(_REACH, astuple(inspection.reach), strict=True)
    return {
        "wavenumber": ("ring", rings.wavenumber),
        "density": ("ring", rings.density),
        "modes": ("ring", rings.modes),
        "weight": ("ring", rings.weight),
        "slow_wavenumber": ("slow_ring", slow.wavenumber),
        "slow_density": ("slow_ring", slow.density),
        "plateau": ((), fit.plateau),
        "corner": ((), fit.corner),
        "slope": ((), fit.slope),
        "fit_covariance": (("parameter", "other_parameter"), estimate.fit_covariance),
        "fit_chi2": ((), fit.chi2),
        "fit_freedom": ((), fit.freedom),
        **{name: ((), value) for name, value in reach},
        "wavelengths": ((), inspection.wavelengths),
        "areas": ((), inspection.areas),
        "sectors": ("sector", estimate.sectors),
        "sector_errors": ("sector", estimate.sector_errors),
    }


def _heights(estimate):
    """Variables of the form of the heights, and a map of them."""
    largest = estimate.inspection.largest
    density = histogram(largest.levelled, largest.quantiles, estimate.quantiles)
    errors = histogram_errors(estimate.model) / np.sqrt(len(largest.names))
    return {
        "quantile": ("score", estimate.quantiles),
        "quantile_error": ("score", estimate.quantile_errors),
        "goodness_chi2": ((), estimate.goodness[0]),
        "goodness_p": ((), estimate.goodness[1]),
        "histogram": ("bin", density),
        "histogram_error": ("bin", errors),
        "edge": ("edges", EDGES),
        "mode_covariance": (("mode", "other_mode"), _mode_covariance(estimate)),
        "elevation": (("fast", "slow"), largest.levelled[0].astype(np.float32)),
    }


def _summits(estimate):
    """Variables of the summits of the scans and of the model."""
    return {
        "summits": ("summit", estimate.summits),
        "summit_errors": ("summit", estimate.summit_errors),
        "model_summits": ("summit", estimate.model_summits),
        "model_summit_errors": ("summit", estimate.model_summit_errors),
    }


def _scans(estimate, notes):
    """Variables of the scans themselves, and sentences about them."""
    inspection = estimate.inspection
    flags = [*estimate.flags_by_kind.items(), *((NOTE, note) for note in notes)]
    return {
        "line_jump": ("axis", list(estimate.line_jump[::-1])),
        "noise": ("size", [maps.noise for maps in inspection.sizes]),
        "scans": ("size", [len(maps.names) for maps in inspection.sizes]),
        "counted": ((), len(inspection.counted)),
        "pixel": (("size", "axis"), [maps.frame.pixel for maps in inspection.sizes]),
        "points": (("size", "axis"), [maps.frame.shape for maps in inspection.sizes]),
        "files": ((), "\n".join(inspection.names)),
        **flagged(flags),
    }


def _mode_covariance(estimate):
    """Covariance of the quantities of a measured density, `stiction.models.MODE_QUANTITIES`."""
    inspection = estimate.inspection
    models = [(evaluation.model_in(inspection, estimate.model, maps), len(maps.names)) for maps in inspection.counted]
    covariance = inspection.propagated(
        [mode_covariance(model.translation, model.overlaps, ORDERS) / count for model, count in models]
    )
    # ASSUME: modes differ between places as much as the skewness or the kurtosis, whichever differs more.
    rms, *shape = estimate.places[:3]
    covariance = evaluation.elsewhere(covariance, np.array([rms, *[max(shape)] * len(ORDERS)]))
    covariance[0, 0] = estimate.covariance[0, 0]
    return covariance


def files(estimate: xr.Dataset) -> tuple[str, ...]:
    """Names of the files."""
    return tuple(str(estimate.files.item()).splitlines())


def rms(estimate: xr.Dataset) -> float:
    """Root mean square of the heights [m]."""
    return float(np.exp(estimate.moments.sel(moment="ln_rms")))


def shape(estimate: xr.Dataset) -> tuple[float, float]:
    """Measured skewness and kurtosis [-]."""
    return tuple(float(estimate.moments.sel(moment=name)) for name in MOMENTS[1:])


def fit(estimate: xr.Dataset) -> WhittleFit:
    """Fit of Eq. (7)."""
    plateau, corner, slope, chi2 = (float(estimate[name]) for name in ("plateau", "corner", "slope", "fit_chi2"))
    return WhittleFit(plateau, corner, slope, estimate.fit_covariance.values, chi2, int(estimate.fit_freedom))


def is_resolved(estimate: xr.Dataset) -> bool:
    """Whether the scans resolve the power law of the fit."""
    return fit(estimate).is_resolved(reach(estimate))


def rings(estimate: xr.Dataset) -> Rings:
    """Measured spectrum."""
    return Rings(*(estimate[name].values for name in ("wavenumber", "density", "modes", "weight")))


def frames(estimate: xr.Dataset) -> list[tuple[int, Frame]]:
    """Number of the scans of each size, and their points and size. The largest first."""
    return [
        (
            int(of_size.scans),
            Frame(tuple(map(int, of_size.points.values)), tuple(map(float, (of_size.points * of_size.pixel).values))),
        )
        for of_size in (estimate.isel(size=k) for k in range(estimate.sizes["size"]))
    ]


def counted_frames(estimate: xr.Dataset) -> list[tuple[int, Frame]]:
    """Frames counted for the moments."""
    return frames(estimate)[: int(estimate.counted)]


def reach(estimate: xr.Dataset) -> Reach:
    """Wave numbers resolved by the scans."""
    return Reach(*(float(estimate[name]) for name in _REACH))


def distance(estimate: xr.Dataset) -> float:
    """Distance of the moments of the maximum-entropy density from the measured ones. NaN without it [errors]."""
    return float(estimate.feasible.sel(shape="distance"))


def feasible(estimate: xr.Dataset) -> tuple[float, float]:
    """Skewness and kurtosis of the maximum-entropy density. NaN without it [-]."""
    return tuple(float(estimate.feasible.sel(shape=name)) for name in MOMENTS[1:])


def density(estimate: xr.Dataset, heights: str) -> HeightDensity | MeasuredDensity:
    """Height density of ``moments`` (maximum entropy) or ``measured``.

    Raises
    ------
    ValueError
        If the measured moments, and none near them, have a maximum-entropy density.
    """
    if heights == "measured":
        return measured_density(estimate["quantile"].values, float(estimate.areas))
    if np.isnan(distance(estimate)):
        skewness, kurtosis = shape(estimate)
        raise ValueError(
            f"no maximum-entropy density has moments near the skewness {skewness:.3g} and kurtosis {kurtosis:.3g} of "
            f"{', '.join(files(estimate))}; heights: measured does not need one"
        )
    return maxent.solve(*feasible(estimate))


def spectrum(estimate: xr.Dataset, psd: str, cutoff: float) -> CutoffSelfAffine | TabulatedSpectrum:
    """Spectrum ``fitted``, unless the scans contradict it, or ``tabulated``, up to a cut-off [rad m⁻¹]."""
    return whittle.spectrum(psd, fit(estimate), rings(estimate), reach(estimate), cutoff)


def statistics(estimate: xr.Dataset) -> dict[str, float]:
    """Measured statistics of the surface, by the keys of the configuration."""
    skewness, kurtosis = shape(estimate)
    radius, number = estimate.summits.values
    return {
        "rms_nm": from_si(rms(estimate), "nm"),
        "skewness": skewness,
        "kurtosis": kurtosis,
        "mean_summit_radius_um": from_si(float(radius), "um"),
        "summit_density_per_um2": from_si(float(number), "per_um2"),
    }


STAGES = (
    Stage.writing(
        "estimate",
        "estimate/{surface}",
        surfaces=lambda plan: plan.scans.surfaces,
        inputs=lambda plan, at: {"scans": [f"scan/{at.surface}_{number}" for number in plan.scans.files(at.surface)]},
        settings=lambda plan, at: plan.scans.estimate(at.surface),
        kind=Settings,
        compute=compute,
        message="Estimate surface {surface} from its scans.",
        running=Running(minutes=10),
    ),
)

"""Tables of measured surfaces: their scans, and the uncertainty of the prediction due to finite scans."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.models import ALTERNATIVES_OF_SCANS
from stiction.plan.names import by_name
from stiction.report.format import NM, UM, signed, with_error
from stiction.report.table import PAIR, Line, Table, Term, table_stage
from stiction.stages.laws.scan_uncertainty import GOAL
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import scan as stage_scan
from stiction.stages.surfaces import surface_flags

#: Parts of an estimate as columns.
_PARTS = {"rms": "rms", "shape": "skewness and kurtosis", "spectrum": "spectrum", "total": "total"}


def scans(
    estimates: Mapping[str, xr.Dataset],
    spectra: Mapping[str, xr.Dataset],
    maps: Mapping[str, Sequence[xr.Dataset]],
) -> Table:
    """Scans of the measured surfaces, one row per file.

    All datasets are by surface; spectra are those of surfaces that are simulated. The maps of a surface
    are in the order of its files in the configuration.
    """
    limits = {
        name: surface_flags.flags(estimate, *([spectra[name]] if name in spectra else []))
        for name, estimate in estimates.items()
    }
    rows = [
        row | {"flags": "; ".join(limits[name])}
        for name, estimate in estimates.items()
        for row in _scans(name, estimate, maps[name])
    ]
    caption = (
        "Scans of the measured surfaces: moments of the levelled heights of each file, ± standard error of one scan of "
        "its size. The moments of the surface, without the bias of levelling, are in the title of its sheet."
    )
    flags = [f"{name}: {flag}" for name, sentences in limits.items() for flag in sentences]
    return Table.from_rows(rows, [caption, *map(Line, flags)], _SCANS)


def _scans(name, estimate, maps):
    """Rows of one surface."""
    for dataset, moments in zip(maps, estimate.scan_moments.values, strict=True):
        scan = stage_scan.scan_of(dataset)
        # The variance of a mean is inverse to the area.
        scans = sum(count * (frame.area / scan.frame.area) for count, frame in stage_estimate.counted_frames(estimate))
        errors = np.sqrt(np.diag(estimate.covariance) * scans) / estimate.places.values[:3]
        rms = np.exp(moments[0]) / NM
        row = {"surface": name, "file": scan.name, "channel": str(dataset.channel.item())}
        row |= {f"size_{axis}_um": length / UM for axis, length in zip(("fast", "slow"), scan.size, strict=True)}
        row |= {f"points_{axis}": n for axis, n in zip(("fast", "slow"), scan.heights.shape, strict=True)}
        row |= {"undefined_percent": 100 * scan.undefined_share, "rms_nm": rms, "rms_se_nm": rms * errors[0]}
        row |= {"skewness": moments[1], "skewness_se": errors[1], "kurtosis": moments[2], "kurtosis_se": errors[2]}
        yield row


_SCANS = {name: (str, name) for name in ("surface", "file", "channel")} | {
    "size [µm]": ("{:.4g} × {:.4g}".format, "size_fast_um", "size_slow_um"),
    "points": ("{} × {}".format, "points_fast", "points_slow"),
    "rms [nm]": (with_error, "rms_nm", "rms_se_nm"),
    "skewness": (with_error, "skewness", "skewness_se"),
    "kurtosis": (with_error, "kurtosis", "kurtosis_se"),
}


def scan_uncertainty(studies: Mapping[str, xr.Dataset]) -> Table:
    """Standard errors due to finite scans: a row per pair, humidity and surface, and one for all surfaces.

    The studies are by pair.
    """
    rows = [
        row for pair, study in studies.items() for k in range(study.sizes["humidity"]) for row in _rows(pair, study, k)
    ]
    shows = (
        "Relative standard error of the mean adhesion energy ē due to the finite scans of measured surfaces, by what "
        "the scans measure (skewness and kurtosis with their correlation), and of the mean crack length l_s; the total "
        "± its standard error due to sampling.",
        Term(
            "Needed",
            f"scans of each surface, the fewest in all, with which the error of ē is below {100 * GOAL:g} % where "
            "places are alike.",
        ),
        Term(
            "Last columns",
            "change of ē if measured surfaces had the other value of the key, ± standard error due to sampling and, "
            "for heights, to the scans. Scans measure the shape of the height density less precisely than the moments.",
        ),
    )
    return Table.from_rows(rows, shows, _UNCERTAINTY | _choice_columns(rows))


def _rows(pair, study, k):
    """Rows of one pair at its humidity number ``k``."""
    case = study.isel(humidity=k)
    key = {"pair": pair, "relative_humidity": float(case.humidity)}
    for name in study.surface.values:
        surface = case.sel(surface=name)
        parts = {f"{cause}_percent": 100 * float(surface.error.sel(part=cause)) for cause in _PARTS}
        parts |= {"total_se_percent": 100 * float(surface.error_sampling)}
        number_of = {"scans": int(surface.scans), "scans_needed": int(surface.scans_needed)}
        yield key | {"surface": str(name)} | parts | _crack_length(float(surface.error.sel(part="total"))) | number_of
    changes = {}
    for choice in study.choice.values:
        of_choice = case.sel(choice=choice)
        errors = float(of_choice.change_error), float(of_choice.change_error_scans)
        changes |= {f"{choice}_percent": 100 * float(of_choice.change), f"{choice}_se_percent": 100 * np.hypot(*errors)}
    total = float(case.pair_error)
    parts = {"total_percent": 100 * total, "total_se_percent": 100 * float(case.pair_error_sampling)}
    number_of = {"scans": int(case.scans.sum()), "scans_needed": int(case.scans_needed.sum())}
    yield key | {"surface": "all"} | parts | _crack_length(total) | number_of | changes


def _crack_length(error):
    """Relative error of the mean crack length from the error of ē."""
    return {"crack_length_percent": 100 * abs(CRACK_LENGTH_POWER) * error}


_UNCERTAINTY = (
    PAIR
    | {"surface": (str, "surface")}
    | {f"ē: {title} [%]": (".2g", f"{cause}_percent") for cause, title in _PARTS.items()}
    | {"ē: total [%]": (with_error, "total_percent", "total_se_percent"), "l_s [%]": (".2g", "crack_length_percent")}
    | {"scans": (".0f", "scans"), "needed": (".0f", "scans_needed")}
)


def _choice_columns(rows):
    """Columns of the changes by other choices, as far as any row has them."""
    chosen = [name for name in ALTERNATIVES_OF_SCANS if any(f"{name}_percent" in row for row in rows)]
    return {f"other {name} [%]": (signed, f"{name}_percent", f"{name}_se_percent") for name in chosen}


STAGES = (
    table_stage(
        "scans",
        "scans of the measured surfaces",
        inputs=lambda plan, at: {
            "estimates": by_name("estimate", plan.scans.surfaces),
            "spectra": by_name("spectrum", filter(plan.is_drawn, plan.scans.surfaces)),
            "scans": {(name, k): f"scan/{name}_{k}" for name in plan.scans.surfaces for k in plan.scans.files(name)},
        },
        compute=lambda data: scans(
            data["estimates"],
            data["spectra"],
            {name: [scan for key, scan in data["scans"].items() if key[0] == name] for name in data["estimates"]},
        ),
        jobs=lambda plan: [{}] if plan.scans.surfaces else [],
        targets=("tables", "measured", "scans"),
    ),
    table_stage(
        "scan_uncertainty",
        "uncertainty due to finite scans",
        inputs=lambda plan, at: {"studies": by_name("studies/scan_uncertainty", plan.scanned_pairs)},
        compute=scan_uncertainty,
        jobs=lambda plan: [{}] if plan.scanned_pairs else [],
        targets=("tables", "measured"),
    ),
)

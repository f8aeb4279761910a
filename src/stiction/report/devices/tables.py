"""Tables of devices: lengths of releasing beams, at their humidities and along the axes of charts."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from stiction.devices.risk import Basis
from stiction.plan.names import by_case
from stiction.report.format import (
    MISSING,
    UM,
    error_alone,
    fraction_with_band,
    humidity_text,
    number,
)
from stiction.report.limits import words
from stiction.report.limits.words import numbered, texts, with_numbers
from stiction.report.model_error import column
from stiction.report.model_error import sentences as model_errors
from stiction.report.table import DEVICE, Table, Term, as_text, table_stage, warned
from stiction.rounding import in_percent, lower_to
from stiction.stages.devices import device_warnings
from stiction.stages.devices.chart import axes, charts, largest_error_between
from stiction.stages.devices.device_warnings import curves, not_modelled
from stiction.stages.devices.end_states import END_STATES

_SAFE_LENGTHS = (
    Term(
        "Simulated limit",
        "the largest length with at most a fraction p of the devices stuck, with a confidence of 95 %. A cantilever "
        "sticks along its beam (S-shape) or at its tip alone (arc), a bridge at its middle.",
    ),
    Term(
        "Estimate",
        "length with a fraction p stuck, with standard errors due to the number of beams and to the number of sampled "
        "surfaces. Every beam has its own tip, and the scatter of the tips is part of the first error.",
    ),
    Term(
        "Basis",
        "sampled, by order statistics; fitted, by a line through the shortest 5 %; extrapolated, by this line beyond "
        "its verified range.",
    ),
)
#: What these limits leave out.
_EXACT = (
    "One touchdown, no voltage, and all inputs exact: lengths to build, with everything inside, are in table devices."
)
#: What other bases of a safe length mean, where they occur.
_FEW = {
    Basis.LONGEST: "longest, the longest simulated devices, with at most a fraction p stuck",
    Basis.FLAT: "flat, the length that sticks on flat surfaces, as too few of the simulated devices stick for a line",
}
_OF_BRIDGE = "For a bridge: no surface, however smooth, can hold a bridge shorter than this"
_FLOODED = (
    "for a cantilever, the sticking length of flat surfaces in contact, with water in all gaps. "
    f"{_OF_BRIDGE} at this humidity."
)
_DRY = f"for a cantilever, the sticking length of flats in contact, as no water condenses. {_OF_BRIDGE}."
_OF_TIP = (
    "The bound of a tip has its edge and holds only on average. A single rough tip can stick harder than {}, so a "
    "fitted length may fall below it."
)
_BOUND, _DRY_BOUND = f"{_FLOODED} {_OF_TIP.format('flat, flooded surfaces')}", f"{_DRY} {_OF_TIP.format('flats')}"
_CHART = (
    "Simulated limit of beams of the thicknesses and gaps of a chart against relative humidity: the largest length "
    "with at most a fraction p stuck, with a confidence of 95 %.",
    Term(
        "From",
        "finite elements, or a power law between their sizes and humidities, with its largest error at beams outside "
        "its fit.",
    ),
    "One touchdown, no voltage, and all inputs exact: table devices has lengths to build.",
)
_CHART_BOUND = (
    f"{_FLOODED.replace('flat surfaces', 'flats')} A single rough tip can hold a shorter beam than flooded flats."
)
_DRY_CHART_BOUND = f"{_DRY} A single rough tip can hold a shorter beam than flats."
_CHART_WARNINGS = "The warnings are about the shortest length of each thickness and gap."
#: Ends what is said about bounds if water condenses in some cases only.
_WHERE_DRY = "Without condensation, bounds are those of flats in contact."

#: P(stuck) of a beam at the length that its device states.
_AT_LENGTH = Term(
    "P(stuck)",
    "fraction of the devices stuck at their given length, with its 95 % band given the drawn surfaces, and "
    "the standard error due to the number of these surfaces.",
)


def _at_length(dataset: xr.Dataset) -> dict[str, float]:
    """Columns of a row of the table of safe lengths, from a dataset of one shape, none without a given length."""
    if "length_of_device" not in dataset:
        return {}
    stuck, low, high = map(float, dataset.stuck_at_length)
    row = {"length_um": float(dataset.length_of_device) / UM, "share_stuck": stuck}
    row |= {"share_stuck_low": low, "share_stuck_high": high}
    return row | {"share_stuck_se_surfaces": float(dataset.stuck_surfaces_error)}


#: Column with the interval of a length with the form of the model as an error.
_PREDICTION = {
    "95 %, form of the model [µm]": (
        lambda low, high: MISSING if np.isnan(low) else f"{low:.0f} to {high:.0f}",
        *("prediction_low_um", "prediction_high_um"),
    )
}
#: Meaning of this column.
_PREDICTED = Term(
    "95 %, form of the model",
    "prediction interval of the estimate of a cantilever held by its beam, if this model errs "
    "on its pair as it does on the paper's, whose measured lengths show how far, with the standard errors. It is "
    "beside the simulated limit and does not change it. Tips, bridges and dry air, which the paper did not measure, "
    "and devices with test beams have none.",
)
_COLUMNS_AT_LENGTH = {
    "length [µm]": (lambda length: number(length, "g"), "length_um"),
    "P(stuck) [%]": (
        lambda stuck, low, high, error: fraction_with_band(stuck, low, high) + f", ± {100 * error:.2g}" * (error > 0),
        *("share_stuck", "share_stuck_low", "share_stuck_high", "share_stuck_se_surfaces"),
    ),
}


def safe_lengths(
    datasets: Mapping[tuple[str, float], xr.Dataset],
    warnings: Mapping[tuple[str, float, str], list],
    errors: Mapping[str, xr.Dataset] | None = None,
    not_modelled: str = "",
) -> Table:
    """Safe lengths of all beams, one row per device, humidity, shape and share.

    Errors of the model are by device. The caption ends with what is not in the model.
    """
    rows, marks = [], []
    numbers = numbered(warnings)
    for (device, humidity), dataset in datasets.items():
        for shape in map(str, dataset["shape"].values):
            head = {"device": device, "relative_humidity": humidity, "held_by": END_STATES[shape].by}
            head |= _at_length(dataset.sel(shape=shape))
            last = model_errors.device_change(errors, device, humidity, shape)
            last |= {"warnings": " ".join(texts(warnings[device, humidity, shape]))}
            rows += [head | _safe_length(dataset.sel(shape=shape, share=p)) | last for p in dataset.share.values]
            marks += [", ".join(map(str, numbers[device, humidity, shape]))] * dataset.sizes["share"]
    frame = pd.DataFrame(rows)
    at_length = _COLUMNS_AT_LENGTH if "length_um" in frame else {}
    shows, columns = (*_SAFE_LENGTHS, _EXACT, *_few(datasets)), _HELD | at_length | _LENGTHS
    shows = *([_AT_LENGTH] if at_length else []), *shows, _bounds(datasets, _BOUND, _DRY_BOUND)
    if "prediction_low_um" in frame:
        shows, columns = (*shows, _PREDICTED), columns | _PREDICTION
    if errors:
        shows, columns = (*shows, column.caption(errors)), columns | column.COLUMN
    return Table(frame, (*shows, *_ends(warnings, not_modelled)), as_text(frame, columns).assign(warnings=marks))


def _few(datasets):
    """Basis of lengths with few stuck devices, or nothing if enough of them stick."""
    bases = {str(basis) for dataset in datasets.values() for basis in dataset.basis.values.flat}
    if not (bases_in_words := [text for basis, text in _FEW.items() if basis in bases]):
        return []
    return [Term("Where few stick", f"{'; '.join(bases_in_words)}; an estimate beyond these is not known.")]


def _bounds(datasets, humid, dry):
    """Meaning of the column of bounds."""
    return Term("Bound", about_bounds(datasets, humid, dry, _WHERE_DRY))


def about_bounds(datasets: Mapping[Any, xr.Dataset], humid: str, dry: str, where_dry: str) -> str:
    """Meaning of the bounds of some cases: of humid air, with a difference without condensation, or of dry air.

    Cases have datasets with the height of their film, which is zero where no water condenses.
    """
    without_water = [float(dataset.film) == 0 for dataset in datasets.values()]
    if all(without_water):
        return dry
    return f"{humid} {where_dry}" if any(without_water) else humid


def _ends(warnings, not_modelled):
    """End of a caption: missing effects and, below each other, numbered warnings."""
    return not_modelled, *warned(with_numbers(warnings))


def _safe_length(point):
    """One simulated limit with its errors, and its prediction interval where there is one."""
    ends = [name for name in ("prediction_low", "prediction_high") if name in point]
    return {
        "share": float(point.share),
        "safe_length_um": float(point.safe_length) / UM,
        "estimate_um": float(point.estimate.where(np.isfinite(point.estimate))) / UM,
        "estimate_se_beams_um": float(point.beams_error) / UM,
        "estimate_se_surfaces_um": float(point.surfaces_error) / UM,
        "basis": str(point.basis.values),
        "bound_um": _bound(point),
        **{f"{name}_um": float(point[name]) / UM for name in ends},
    }


def _bound(point):
    """Bound of the length by flooded flats [µm]."""
    return float(point.flooded_length) / UM


_HELD = DEVICE | {"held by": (str, "held_by")}
_LENGTHS = {
    "p": ("g", "share"),
    "simulated limit [µm]": (lower_to(1), "safe_length_um"),
    "estimate [µm]": (".1f", "estimate_um"),
    "se, beams": (error_alone, "estimate_se_beams_um"),
    "se, surfaces": (error_alone, "estimate_se_surfaces_um"),
    "basis": (str, "basis"),
    "bound [µm]": (lower_to(1), "bound_um"),
}


# Charts


def chart(
    datasets: Mapping[tuple[str, float], xr.Dataset],
    warnings: Mapping[tuple[str, float, float, str], list],
    not_modelled: str = "",
) -> Table:
    """Safe lengths along the axes of all charts, curve by curve. A line of text has the lengths of all shares.

    Warnings are by name, thickness [m], gap [m] and shape. The caption ends with what is not in the model.
    """
    numbers = numbered(warnings)
    rows, cells = [], []
    for device, curve in dict.fromkeys(
        (name, curve) for (name, _), dataset in datasets.items() for curve in curves(dataset)
    ):
        last = {"warnings": " ".join(texts(warnings[device, *curve]))}
        marks = {"warnings": ", ".join(map(str, numbers[device, *curve]))}
        for humidity in sorted(humidity for name, humidity in datasets if name == device):
            dataset = datasets[device, humidity].sel(dict(zip(("thickness", "gap", "shape"), curve, strict=True)))
            beam = {"device": device, "relative_humidity": humidity} | _beam(dataset)
            lengths = dict(zip(dataset.share.values.tolist(), dataset.safe_length.values / UM, strict=True))
            rows += [beam | {"share": share, "safe_length_um": length} | last for share, length in lengths.items()]
            cells.append(_beam_as_text(beam, lengths) | marks)
    bounds = _bounds(datasets, _CHART_BOUND, _DRY_CHART_BOUND)
    shows = *_CHART, *_between(datasets), bounds, _CHART_WARNINGS, *_ends(warnings, not_modelled)
    return Table(pd.DataFrame(rows), shows, pd.DataFrame(cells))


def _between(datasets):
    """Error of the cubic between the humidities of all charts, nothing with too few of them."""
    error = max(map(largest_error_between, axes(datasets).values()), key=np.nan_to_num)
    if np.isnan(error):
        return []
    return [f"Between these humidities, a monotone cubic through the logarithms errs by ± {in_percent(error)}."]


def _beam(point):
    """Size of a beam of a chart, the source of its lengths, and its limit."""
    computed = bool(point.by_elements)
    return {
        "thickness_um": round(float(point.thickness) / UM, 9),  # as in the configuration
        "gap_um": round(float(point.gap) / UM, 9),
        "held_by": END_STATES[str(point["shape"].values)].by,
        "from": "finite elements" if computed else "power law",
        "power_law_error_percent": np.nan if computed else 100 * float(point.power_law_error),
        "bound_um": _bound(point),
    }


def _beam_as_text(beam, lengths):
    """Safe lengths of a beam of a chart as text."""
    error = beam["power_law_error_percent"]
    return {
        "device": beam["device"],
        "thickness [µm]": f"{beam['thickness_um']:g}",
        "gap [µm]": f"{beam['gap_um']:g}",
        "held by": beam["held_by"],
        "RH": humidity_text(beam["relative_humidity"]),
        **{f"p = {share:g} [µm]": lower_to(1)(length) for share, length in lengths.items()},
        "from": beam["from"] + ("" if np.isnan(error) else f", ± {in_percent(error / 100)}"),
        "bound [µm]": lower_to(1)(beam["bound_um"]),
    }


STAGES = (
    table_stage(
        "safe_lengths",
        "lengths of releasing beams",
        title="Simulated limits of beams",
        inputs=lambda plan, at: (
            {
                "lengths": by_case("devices/safe_lengths", plan.devices.cases),
                "warnings": device_warnings.files_of(*plan.devices.beams),
            }
            | model_errors.error_inputs(plan, *plan.devices.beams)
        ),
        settings=lambda plan, at: {"not_modelled": not_modelled(plan, *plan.devices.beams)},
        compute=lambda data, settings: safe_lengths(
            data["lengths"],
            device_warnings.read(data["warnings"]).lengths,
            data.get("errors"),
            words.not_modelled(**settings["not_modelled"]),
        ),
        jobs=lambda plan: [{}] if plan.devices.cases else [],
        targets=("devices",),
    ),
    table_stage(
        "chart",
        "simulated limit against relative humidity",
        inputs=lambda plan, at: charts(plan) | {"warnings": device_warnings.files_of(*plan.devices.with_chart)},
        settings=lambda plan, at: {"not_modelled": not_modelled(plan, *plan.devices.with_chart)},
        compute=lambda data, settings: chart(
            data["charts"],
            device_warnings.read(data["warnings"]).curves,
            words.not_modelled(**settings["not_modelled"]),
        ),
        jobs=lambda plan: [{}] if plan.devices.with_chart else [],
        targets=("devices",),
    ),
)

"""Table of estimates at once beside the lengths of a run, and the section of a page."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.devices.risk import one_in
from stiction.plan.names import by_name
from stiction.report.format import MISSING, UM, airs, with_error
from stiction.report.page import Page, Section
from stiction.report.table import DEVICE, HUMIDITY, Table, table_stage, with_list
from stiction.stages.at_once.beside import CONFIDENCE, estimated, is_estimated

_CAPTION = (
    "Lengths at which a fraction sticks, by beam or tip: of the run with its standard error, and of stiction "
    "estimate. One touchdown, no voltage, exact inputs, surfaces as stated."
)
#: Title of the section.
_TITLE = "The estimate at once beside the run"
_MISSING = "the estimate refuses this air, or too few of the simulated devices stick for a length"
#: Units of the inputs of the estimate, for those that have one.
_SIZES = dict.fromkeys(("thickness", "gap", "width"), "um")
_OF_SIDES = {"rms": "nm", "skewness": "", "kurtosis": "", "plateau": "nm4", "floor": "nm4"}
_OF_SIDES |= dict.fromkeys(("corner", "cutoff"), "rad_per_um")
#: Words by whether the length of the run is inside the interval of the estimate.
_INSIDE = {True: "yes", False: "no"}


def is_inside(dataset: xr.Dataset) -> xr.DataArray:
    """Whether each length of a run is inside the interval of the estimate, 1 or 0, NaN if one of both is not known."""
    inside = (dataset.low <= dataset.length) & (dataset.length <= dataset.high)
    return inside.where((dataset.length + dataset.estimate).notnull())


def table(estimates: Mapping[str, xr.Dataset]) -> Table:
    """Lengths of runs beside estimates, with all inputs of the estimate, by device."""
    rows = [row for name, dataset in estimates.items() for row in _rows(name, dataset)]
    refused = [f"{name}: {sentence}" for name, dataset in estimates.items() for sentence in refusals(dataset)]
    caption = with_list(" ".join([_CAPTION, counted(list(estimates.values()))]), refused)
    return Table.of(rows, caption, DEVICE | _COLUMNS)


def _rows(device, dataset) -> Iterator[dict[str, Any]]:
    """Rows of one device."""
    inputs, inside = _inputs(dataset), is_inside(dataset)
    for air in dataset.humidity.values:
        of_air, is_in = dataset.sel(humidity=air), inside.sel(humidity=air)
        for share in dataset.share.values:
            one, known = of_air.sel(share=share), float(is_in.sel(share=share))
            lengths = {f"{name}_um": float(one[key]) / UM for name, key in _LENGTHS.items()}
            said = {"inside": "" if np.isnan(known) else _INSIDE[bool(known)], "refused": str(of_air.refused.values)}
            yield {"device": device, "relative_humidity": float(air), "share": float(share)} | lengths | said | inputs


#: Columns of lengths, by variable.
_LENGTHS = {"run": "length", "run_se": "length_error", "estimate": "estimate", "low": "low", "high": "high"}
_COLUMNS = {
    "stuck": (one_in, "share"),
    "run [µm]": (with_error, "run_um", "run_se_um"),
    "estimate [µm]": (".0f", "estimate_um"),
    f"{CONFIDENCE} % [µm]": (
        lambda low, high: MISSING if np.isnan(low) else f"{low:.0f} to {high:.0f}",
        "low_um",
        "high_um",
    ),
    "inside": (lambda inside: inside or MISSING, "inside"),
}


def _inputs(dataset):
    """Inputs of the estimate in the units of a configuration, none where it refuses the configuration."""
    if "side" not in dataset.dims:
        return {}
    own = {f"{name}_{unit}": (dataset[name], unit) for name, unit in _SIZES.items()}
    for side in dataset.side.values:
        of_side = dataset.sel(side=side)
        own |= {f"{side}_{name}_{unit}".rstrip("_"): (of_side[name], unit) for name, unit in _OF_SIDES.items()}
    return {key: _as_stated(float(value), unit) for key, (value, unit) in own.items()}


def _as_stated(value, unit):
    """Number of a configuration, without the rounding of its unit."""
    return float(f"{from_si(value, unit) if unit else value:.12g}")


def counted(datasets: Sequence[xr.Dataset]) -> str:
    """How many lengths of runs are outside the intervals of the estimate, in words."""
    inside = np.concatenate([is_inside(dataset).values.ravel() for dataset in datasets])
    known = inside[~np.isnan(inside)]
    if not known.size:
        return "No length of the run stands beside an estimate."
    return f"{known.size - int(known.sum())} of {known.size} lengths are outside the interval of {CONFIDENCE} %."


def refusals(dataset: xr.Dataset) -> list[str]:
    """Why the estimate refuses some airs, in words."""
    by_reason = dataset.refused.to_series().groupby(dataset.refused.values, sort=False).groups
    return [f"Not known at once {airs(list(of))}: {reason}." for reason, of in by_reason.items() if reason]


def section(dataset: xr.Dataset) -> Section:
    """Section of the page of a device."""
    if not np.isfinite(dataset.estimate).any():
        return Section(_TITLE, refusals(dataset))
    cells = Table.of(_rows("", dataset), "", HUMIDITY | _COLUMNS).cells
    return Section(_TITLE, [" ".join([_CAPTION, counted([dataset])]), *refusals(dataset)], cells, missing=_MISSING)


def inputs(plan: Any, device: str) -> dict[str, str]:
    """Dataset of a device of a kind that the estimate knows, as input of its page."""
    return {"estimate": f"devices/estimate/{device}"} if is_estimated(plan, device) else {}


def with_estimate(page: Page, data: Mapping[str, Any]) -> Page:
    """Page with the estimate of its device beside the run, itself for other kinds."""
    if "estimate" not in data:
        return page
    return replace(page, sections=[*page.sections, section(data["estimate"])])


STAGES = (
    table_stage(
        "estimate",
        "estimates at once beside the run",
        inputs=lambda plan, at: {"estimates": by_name("devices/estimate", estimated(plan))},
        compute=lambda data: table(data["estimates"]),
        jobs=lambda plan: [{}] if estimated(plan) else [],
        targets=("devices",),
    ),
)

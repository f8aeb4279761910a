"""Tables of estimates at once beside the sizes of a run, and the section of a page."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.devices.risk import one_in
from stiction.report.format import MISSING, airs, bounding, with_error
from stiction.report.page import Page, Section
from stiction.report.table import DEVICE, HUMIDITY, Columns, Line, Table, table_stage
from stiction.stages.at_once.beside import CONFIDENCE, FORCES, LENGTHS, estimated, file_of


@dataclass(frozen=True)
class Sizes:
    """Sizes of devices beside which estimates are, in words."""

    stage: str  #: of their datasets
    file: str  #: of their table
    name: str  #: of the variable of the run
    unit: str  #: of the keys
    symbol: str
    form: str  #: of a number
    shows: str  #: end of the title of the table
    caption: str

    @property
    def keys(self) -> dict[str, str]:
        """Keys of the columns of sizes, by variable."""
        names = {"run": self.name, "run_se": f"{self.name}_error", "estimate": "estimate", "low": "low", "high": "high"}
        return {f"{name}_{self.unit}": variable for name, variable in names.items()}

    @property
    def columns(self) -> Columns:
        """Columns for reading."""
        run, error, estimate, *ends = self.keys
        return {
            "stuck": (one_in, "share"),
            f"run [{self.symbol}]": (with_error, run, error),
            f"estimate at once [{self.symbol}]": (self.form, estimate),
            f"{CONFIDENCE} % [{self.symbol}]": (self._ends, *ends),
            "inside": (lambda inside: inside or MISSING, "inside"),
        }

    def _ends(self, low, high):
        """Ends of an interval, rounded outwards."""
        return MISSING if np.isnan(low) else f"{bounding(low, 3, up=False)} to {bounding(high, 3, up=True)}"


_OF_ALL = "One touchdown, no voltage, exact inputs, surfaces as stated."
#: Sizes by their variable in datasets.
SIZES = {
    "length": Sizes(
        LENGTHS,
        "estimate",
        "length",
        "um",
        "µm",
        ".0f",
        "estimates at once beside the run",
        "Lengths at which a fraction sticks, by beam, tip or middle: of the run with its standard error, and of "
        f"stiction estimate. {_OF_ALL}",
    ),
    "force": Sizes(
        FORCES,
        "estimate_of_force",
        "force",
        "uN",
        "µN",
        ".3g",
        "forces at once beside the run",
        "Restoring forces at which a fraction sticks: of the run with its standard error, and of stiction estimate. "
        f"{_OF_ALL}",
    ),
}
#: Title of the section.
_TITLE = "The estimate at once beside the run"
_MISSING = "the estimate refuses this air, or too few of the simulated devices stick for a size"
#: Units of the inputs of the estimate, for those that have one.
_SIZES = dict.fromkeys(("thickness", "gap", "width"), "um") | {
    "residual_stress": "MPa",
    "wetting": "",
    "temperature": "K",
}
_SIZES |= dict.fromkeys(("hamaker_constant", "hamaker_constant_in_water"), "zJ")
_SIZES |= dict.fromkeys(("modulus", "beam_modulus"), "GPa")
_OF_SIDES = {"rms": "nm", "skewness": "", "kurtosis": "", "plateau": "nm4", "floor": "nm4"}
_OF_SIDES |= dict.fromkeys(("corner", "cutoff"), "rad_per_um")
#: Words by whether the size of the run is inside the interval of the estimate.
_INSIDE = {True: "yes", False: "no"}


def sizes_of(dataset: xr.Dataset) -> Sizes:
    """Sizes of a dataset."""
    return next(sizes for name, sizes in SIZES.items() if name in dataset)


def is_inside(dataset: xr.Dataset) -> xr.DataArray:
    """Whether each size of a run is inside the interval of the estimate, 1 or 0, NaN if one of both is not known."""
    run = dataset[sizes_of(dataset).name]
    inside = (dataset.low <= run) & (run <= dataset.high)
    return inside.where((run + dataset.estimate).notnull())


def table(estimates: Mapping[str, xr.Dataset], sizes: Sizes = SIZES["length"]) -> Table:
    """Sizes of runs beside estimates, with all inputs of the estimate, by device."""
    rows = [row for name, dataset in estimates.items() for row in _rows(name, dataset)]
    refused = [f"{name}: {sentence}" for name, dataset in estimates.items() for sentence in refusals(dataset)]
    shows = sizes.caption, counted(list(estimates.values()), sizes), *map(Line, refused)
    return Table.from_rows(rows, shows, DEVICE | sizes.columns)


def _rows(device, dataset) -> Iterator[dict[str, Any]]:
    """Rows of one device."""
    inputs, inside, sizes = _inputs(dataset), is_inside(dataset), sizes_of(dataset)
    for air in dataset.humidity.values:
        of_air, is_in = dataset.sel(humidity=air), inside.sel(humidity=air)
        for share in dataset.share.values:
            at_share, within = of_air.sel(share=share), float(is_in.sel(share=share))
            numbers = {key: from_si(float(at_share[name]), sizes.unit) for key, name in sizes.keys.items()}
            words = {
                "inside": "" if np.isnan(within) else _INSIDE[bool(within)],
                "refused": str(of_air.refused.values),
            }
            yield {"device": device, "relative_humidity": float(air), "share": float(share)} | numbers | words | inputs


def _inputs(dataset):
    """Inputs of the estimate in the units of a configuration, none where it refuses the configuration."""
    if "side" not in dataset.dims:
        return {}
    stated = ((name, unit) for name, unit in _SIZES.items() if name in dataset)
    numbers = {f"{name}_{unit}".rstrip("_"): (dataset[name], unit) for name, unit in stated}
    for direction in dataset.direction.values if "contact" in dataset else ():
        numbers[f"contact_{direction}_um"] = dataset.contact.sel(direction=direction), "um"
    for side in dataset.side.values:
        of_side = dataset.sel(side=side)
        numbers |= {f"{side}_{name}_{unit}".rstrip("_"): (of_side[name], unit) for name, unit in _OF_SIDES.items()}
    return {key: _as_stated(float(value), unit) for key, (value, unit) in numbers.items()}


def _as_stated(value, unit):
    """Number of a configuration, without the rounding of its unit."""
    return float(f"{from_si(value, unit) if unit else value:.12g}")


def counted(datasets: Sequence[xr.Dataset], sizes: Sizes = SIZES["length"]) -> str:
    """How many sizes of runs are outside the intervals of the estimate, in words."""
    inside = np.concatenate([is_inside(dataset).values.ravel() for dataset in datasets])
    judged = inside[~np.isnan(inside)]
    if not judged.size:
        return f"No {sizes.name} of the run stands beside an estimate."
    return (
        f"{judged.size - int(judged.sum())} of {judged.size} {sizes.name}s are outside the interval of {CONFIDENCE} %."
    )


def refusals(dataset: xr.Dataset) -> list[str]:
    """Why the estimate refuses some airs, in words."""
    by_reason = dataset.refused.to_series().groupby(dataset.refused.values, sort=False).groups
    return [f"Not known at once {airs(list(rhs))}: {reason}." for reason, rhs in by_reason.items() if reason]


def section(dataset: xr.Dataset) -> Section:
    """Section of the page of a device."""
    if not np.isfinite(dataset.estimate).any():
        return Section(_TITLE, refusals(dataset))
    sizes = sizes_of(dataset)
    cells = Table.from_rows(_rows("", dataset), "", HUMIDITY | sizes.columns).cells
    sentences = [" ".join([sizes.caption, counted([dataset], sizes)]), *refusals(dataset)]
    return Section(_TITLE, sentences, cells, missing=_MISSING)


def inputs(plan: Any, device: str) -> dict[str, str]:
    """Dataset of a device of a kind that the estimate knows, as input of its page."""
    file = file_of(plan, device)
    return {"estimate": file} if file else {}


def with_estimate(page: Page, data: Mapping[str, Any]) -> Page:
    """Page with the estimate of its device beside the run, itself for other kinds."""
    if "estimate" not in data:
        return page
    return replace(page, sections=[*page.sections, section(data["estimate"])])


def _stage(sizes):
    """Stage of the table of some sizes."""
    return table_stage(
        sizes.file,
        sizes.shows,
        inputs=lambda plan, at: {"estimates": {name: file_of(plan, name) for name in estimated(plan, sizes.stage)}},
        compute=lambda data: table(data["estimates"], sizes),
        jobs=lambda plan: [{}] if estimated(plan, sizes.stage) else [],
        targets=("devices",),
    )


STAGES = tuple(map(_stage, SIZES.values()))

"""Units, symbols, equations and meanings of all variables in result files.

``variables.csv`` has a row for each variable of some stages, or of all stages where none is named. A row without the
name of a variable is the title of the files of a stage.
"""

import csv
import warnings
from functools import cache
from pathlib import Path
from typing import NamedTuple

import xarray as xr

#: Unit in the table where the stage states it, because it depends on the configuration.
_STATED = "stated"
#: Names of the CF conventions, by symbol.
_STANDARD_NAMES = {"RH": "relative_humidity"}


class VariableAttributes(NamedTuple):
    """Attributes of a variable, empty where it has none."""

    units: str  #: as UDUNITS spells it; empty for text and for mixed quantities
    symbol: str  #: in the paper
    equation: str  #: number in the paper
    long_name: str


@cache
def rows() -> dict[tuple[str, str], VariableAttributes]:
    """Rows of the table by stage and variable. The stage is empty in rows for all stages."""
    with Path(__file__).with_name("variables.csv").open(encoding="utf-8", newline="") as file:
        _, *lines = csv.reader(file)
    return {(stage, name): VariableAttributes(*row) for stages, name, *row in lines for stage in stages.split() or [""]}


def described(dataset: xr.Dataset, stage: str) -> xr.Dataset:
    """Dataset of a stage with its title and the attributes of every variable.

    A variable without a row keeps what its stage states, with a warning, which fails every test: a description that is
    missing is no reason to lose what a run has computed.
    """
    labelled = dataset.copy()
    if title := _row(stage, ""):
        labelled.attrs["title"] = title.long_name
    for name in labelled.variables:
        if row := _row(stage, name):
            labelled[name].attrs = _attributes(labelled[name].attrs, row)
    return labelled


def _row(stage, name):
    """Row of a variable, of its stage or of all, or None with a warning."""
    table = rows()
    if row := table.get((stage, name)) or table.get(("", name)):
        return row
    subject = f"variable {name} of stage {stage}" if name else f"title of stage {stage}"
    warnings.warn(f"run/variables.csv has no row for the {subject}; add one", stacklevel=2)
    return None


def _attributes(attributes, row):
    """Attributes of a variable: of its row, and others that the stage states."""
    units = attributes.get("units", "") if row.units == _STATED else row.units
    of_row = row._asdict() | {"units": units, "standard_name": _STANDARD_NAMES.get(row.symbol, "")}
    return {key: text for key, text in of_row.items() if text} | {
        k: v for k, v in attributes.items() if k not in of_row
    }

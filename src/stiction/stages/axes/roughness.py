"""Stages of roughness: a device along one quantity of a surface or two, and the roughnesses that suffice.

At the last point of a curve the surfaces are as they are given, with the results of the device itself. Form of the
heights and shape of the spectrum stay.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.analysis.shifts import value_of, with_value
from stiction.config.kinds import ROUGHNESSES
from stiction.config.merging import merged
from stiction.config.units import without_unit
from stiction.devices.roughness import crossings, sufficient
from stiction.plan.stage import Running, Stage
from stiction.rounding import is_equal
from stiction.stages.axes import points
from stiction.stages.axes.points import Device, Surfaces, joined
from stiction.stages.axes.requirement import flagged, margins_of, relative_errors
from stiction.stages.surfaces.rough_surfaces import both

#: Points of a curve, the last of which has the surface as it is given.
POINTS = 8
#: Curves of a map over two quantities, the first of which has the second quantity as it is given.
CURVES = 5
#: Kurtosis of a point, which curves and maps over the skewness have.
KURTOSIS = "kurtosis"
#: Dimensions of what is found on a curve.
_TABLES = ("crossing", "range")


# Points


class Varied(NamedTuple):
    """Varied quantity: one key of section ``roughness`` of a device."""

    surface: str
    key: str  #: of `stiction.config.kinds.ROUGHNESSES`
    low: float  #: ends of the range, in the unit of the key
    high: float

    def value(self, number: int) -> float | None:
        """Value of a point in the unit of the key, ``None`` as it is given. Evenly spaced, or by equal factors."""
        return None if number == POINTS - 1 else self._spaced(number, POINTS - 1)

    def value_of_curve(self, number: int) -> float | None:
        """Value of a curve of a map, see `value`."""
        return None if number == 0 else self._spaced(number - 1, CURVES - 1)

    def _spaced(self, number, count):
        spaced = np.geomspace if ROUGHNESSES[self.key].logarithmic else np.linspace
        return float(spaced(self.low, self.high, count)[number].round(9))

    def named(self, name: str, value: float | None) -> dict[str, float | None]:
        """Value by a name with the unit of the key."""
        unit = self.key.removeprefix(without_unit(self.key))
        return {name + unit * (value is not None): value}


@dataclass(frozen=True)
class Settings:
    """Settings of a point, without its surfaces."""

    device: Device
    surface: str  #: the one that is changed; on both sides of the pair if both have it
    quantity: str  #: rms, skewness or corner
    value: float | None  #: [SI]; none for the surface as it is given
    other: str = ""  #: another quantity that is changed as well
    other_value: float | None = None  #: [SI]


def compute(surfaces: Surfaces, settings: Settings) -> xr.Dataset:
    """Device at a point, with the value of the quantity, and of an unchanged second one, as variables.

    So is the kurtosis, which may change with the skewness, see `stiction.analysis.shifts.with_value`.
    """
    given = changed = settings.device.described(surfaces)[settings.surface]
    for quantity, value in ((settings.quantity, settings.value), (settings.other, settings.other_value)):
        if value is not None:
            changed = with_value(changed, quantity, value)
    (point,) = settings.device.on(surfaces, [{} if changed is given else {settings.surface: changed}])
    values = {"roughness": value_of(changed, settings.quantity), KURTOSIS: changed.kurtosis}
    if settings.other:
        values |= {name: value_of(of, settings.other) for name, of in (("other", changed), ("other_given", given))}
    return point.assign({name: float(value) for name, value in values.items()})


def varied_quantities(plan: Any, device: str) -> list[Varied]:
    """Varied quantities of the surfaces of a device: along its curves and, for a map, from curve to curve."""
    section = plan.config["devices"][device]["roughness"]
    return [Varied(section["surface"], key, *section[key]) for key in ROUGHNESSES if key in section]


def points_of(plan: Any, device: str) -> range:
    """Numbers of the points of a device, curve by curve."""
    return range(POINTS * (CURVES if len(varied_quantities(plan, device)) > 1 else 1))


def _settings(plan, at):
    """Settings of a point of a device, with its values of the varied quantities."""
    what, *others = varied_quantities(plan, at.device)
    curve, number = divmod(int(at.number), POINTS)
    values = [(what, what.value(number)), *((other, other.value_of_curve(curve)) for other in others)]
    own = plan.config["surfaces"][what.surface]
    changed = {varied.key: value for varied, value in values if value is not None and varied.key in own}
    rough = replace(plan, config=merged(plan.config, {"surfaces": {what.surface: changed}})) if changed else plan
    settings = {"device": points.settings_of(plan, at.device, rough), "surface": what.surface}
    settings |= {"quantity": without_unit(what.key)} | what.named("value", values[0][1])
    for other, value in values[1:] if curve else ():
        settings |= {"other": without_unit(other.key)} | other.named("other_value", value)
    return settings


# Curves and maps


def curve_or_map(points: Sequence[xr.Dataset], surface: str, key: str, other: str = "") -> xr.Dataset:
    """Device along the roughness of a surface, with crossings of the requirement and sufficient ranges.

    Parameters
    ----------
    points : sequence of Dataset
        The last one of each curve has the surfaces as they are given; others at the same roughness are left out. So
        are curves with the second quantity of the first one, at which it is as given.
    surface : str
        Name of the surface.
    key, other : str
        What is varied, of `stiction.config.kinds.ROUGHNESSES`: along a curve and, for a map, from curve to curve.
    """
    if "skewness" not in (key, other):
        points = [point.drop_vars(KURTOSIS, errors="ignore") for point in points]
    rows, given = [points[k : k + POINTS] for k in range(0, len(points), POINTS)], {"given": points[-1].roughness}
    over, attrs = ["roughness"], {"key": key, "surface": surface}
    if other:
        over, attrs = ["other", *over], attrs | {"other_key": other}
        rows, given = _rows_apart(rows), given | {"other_given": points[-1].other_given}
    found = joined([point for row in rows for point in _apart(row)], *over).sortby(over)
    found = found.assign(given).assign_attrs(attrs)
    return _with_tables(flagged(found, (found.roughness < found.given) & (key == "rms_nm")))


def _apart(row):
    """Points of a curve with another roughness than the given one, which is the last, and this one."""
    *others, given = row
    largest = max(abs(float(point.roughness)) for point in row)
    return [point for point in others if not is_equal(point.roughness, given.roughness, largest)] + [given]


def _rows_apart(rows):
    """Curves of a map, each point with its second quantity: the first as given, and others apart from it."""
    given, others = float(rows[-1][-1].other_given), [float(row[0].other) for row in rows[1:]]
    largest, values = max(map(abs, others)), zip(others, rows[1:], strict=True)
    kept = [(given, rows[0]), *((value, row) for value, row in values if not is_equal(value, given, largest))]
    return [
        [point.drop_vars("other_given", errors="ignore").assign(other=value) for point in row] for value, row in kept
    ]


def _with_tables(found):
    """Curve or map with its crossings of the requirement and its sufficient ranges, one after the other."""
    logarithmic = ROUGHNESSES[found.attrs["key"]].logarithmic
    axis = np.log(found.roughness.values) if logarithmic else found.roughness.values
    dimensions, crossed, ranges = [name for name in ("other", "humidity", "shape") if name in found.dims], [], []
    for at in product(*(found[name].values for name in dimensions)):
        curve = found.sel(dict(zip(dimensions, at, strict=True)))
        met = crossings(axis, margins_of(curve), relative_errors(curve))
        crossed += [(*at, crossing.place, crossing.error) for crossing in met]
        ranges += [(*at, *ends) for ends in sufficient(axis, margins_of(curve, "safe"))]
    columns = _columns("crossing", crossed, [*dimensions, "place", "error"])
    columns |= _columns("range", ranges, [*dimensions, "low", "high"])
    if logarithmic:
        columns |= {name: np.exp(columns[name]) for name in ("crossing_place", "range_low", "range_high")}
        columns["crossing_error"] = columns["crossing_place"] * columns["crossing_error"]
    return found.assign({name: (name.partition("_")[0], column) for name, column in columns.items()})


def _columns(table, rows, names):
    """Columns of the rows of a table by the names of their variables."""
    columns = zip(names, zip(*rows, strict=True) if rows else [()] * len(names), strict=True)
    return {f"{table}_{name}": np.array(column, str if name == "shape" else float) for name, column in columns}


def curves_of(found: xr.Dataset) -> list[xr.Dataset]:
    """Curve of a device, or all curves of its map, each with its value of the second quantity as ``other``."""
    if "other" not in found.dims:
        return [found]
    own = [{name: np.flatnonzero(found[f"{name}_other"] == value) for name in _TABLES} for value in found.other]
    return [found.sel(other=value).isel(rows) for value, rows in zip(found.other.values, own, strict=True)]


def _what(plan, device):
    """Varied quantities, and their surface."""
    first, *others = varied_quantities(plan, device)
    return {"key": first.key, "surface": first.surface} | ({"other": others[0].key} if others else {})


STAGES = (
    Stage.writing(
        "roughness_point",
        "devices/roughness/points/{device}_{number}",
        inputs=lambda plan, at: points.inputs(plan, at.device),
        settings=_settings,
        kind=Settings,
        complete=lambda settings, data: replace(settings, device=settings.device.corrected(data)),
        compute=lambda data, settings: compute(both(data), settings),
        message="Device {device} at roughness {number}.",
        running=Running(minutes=120),
    ),
    Stage.writing(
        "roughness",
        "devices/roughness/{device}",
        inputs=lambda plan, at: {
            "points": [f"devices/roughness/points/{at.device}_{number}" for number in points_of(plan, at.device)]
        },
        settings=lambda plan, at: _what(plan, at.device),
        compute=lambda data, settings: curve_or_map(data["points"], **settings),
        message="Roughness that device {device} needs.",
    ),
)

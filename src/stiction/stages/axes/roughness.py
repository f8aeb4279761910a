"""Stages of roughness: a device along one quantity of a surface or two, and the roughnesses that suffice.

At the last point of a curve the surfaces are as they are given, with the results of the device itself. Form of the
heights and shape of the spectrum stay. The quantity may also be the coherence of a surface that follows the other one,
or its play.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.shifts import value_of, with_value
from stiction.config.kinds import ROUGHNESSES
from stiction.config.merging import merged
from stiction.config.units import without_unit
from stiction.devices.roughness import SCALES, crossings, sufficient
from stiction.plan.stage import Running, Stage
from stiction.rounding import is_equal
from stiction.stages.axes import points
from stiction.stages.axes.points import DeviceAtPoint, Surfaces, joined
from stiction.stages.axes.requirement import flagged, margins_of, relative_errors
from stiction.stages.contact.pairs import require_feasible
from stiction.stages.surfaces.rough_surfaces import sides_of
from stiction.surface.replica import Coherence

#: Points of a curve, the last of which has the surface as it is given.
POINTS = 8
#: Curves of a map over two quantities, the first of which has the second quantity as it is given.
CURVES = 5
#: Kurtosis of a point, which curves and maps over the skewness have.
KURTOSIS = "kurtosis"
#: Keys of quantities of a surface that follows the other one.
OF_COPIES = {key for key, quantity in ROUGHNESSES.items() if quantity.of_replica}
#: Dimensions of what is found on a curve.
_TABLES = ("crossing", "range")


# Points


@dataclass(frozen=True)
class VariedQuantities:
    """Values of quantities of a surface, none as they are given."""

    rms: float | None = None  #: [m]
    skewness: float | None = None
    corner: float | None = None  #: [rad m⁻¹]


@dataclass(frozen=True)
class Settings:
    """Settings of a point, without its surfaces."""

    device: DeviceAtPoint
    surface: str  #: the one that is changed; on both sides of the pair if both have it
    varied: tuple[str, ...]  #: quantities along a curve and, for a map, from curve to curve
    values: VariedQuantities
    replica: Coherence | None = None  #: of the pair as it is given, if its quantities are varied


def compute(surfaces: Surfaces, settings: Settings) -> xr.Dataset:
    """Device at a point, with the varied quantities of the surface as variables, that of a map also as it is given.

    So is the kurtosis, which may change with the skewness, see `stiction.analysis.shifts.with_value`.
    """
    original = changed = settings.device.described(surfaces)[settings.surface]
    replica = settings.device.patch.replica
    if settings.replica:
        require_feasible(surfaces, "NG", settings.device.patch)
    for quantity, value in vars(settings.values).items():
        changed = changed if value is None else with_value(changed, quantity, value)
    (point,) = settings.device.on(surfaces, [{} if changed is original else {settings.surface: changed}])
    along, *others = settings.varied
    values = {"roughness": _value(along, changed, replica), KURTOSIS: changed.kurtosis}
    for other in others:
        values |= {"other": _value(other, changed, replica), "other_given": _value(other, original, settings.replica)}
    return point.assign({name: float(value) for name, value in values.items()})


def _value(quantity, surface, replica):
    """Value of a quantity of a surface, or of its replica."""
    return getattr(replica, quantity) if quantity in map(without_unit, OF_COPIES) else value_of(surface, quantity)


def axes_of(plan: Any, device: str) -> dict[str, list[float | None]]:
    """Values by key of section ``roughness``, in its unit: along a curve and, for a map, from curve to curve.

    None is as given: the last point of a curve, and the first curve of a map.
    """
    section = plan.config["devices"][device]["roughness"]
    first, *others = [key for key in ROUGHNESSES if key in section]
    axes = {first: [*spaced(first, *section[first], POINTS - 1), None]}
    return axes | {other: [None, *spaced(other, *section[other], CURVES - 1)] for other in others}


def spaced(key: str, low: float, high: float, number: int) -> list[float]:
    """Values of a quantity between the ends of its range, evenly spaced or by equal factors."""
    return SCALES[ROUGHNESSES[key].scale].spaced(low, high, number).round(9).tolist()


def _settings(plan, at):
    """Settings of a point of a device, with its values of the varied quantities."""
    axes, section = axes_of(plan, at.device), plan.config["devices"][at.device]
    surface, pair = section["roughness"]["surface"], section["pair"]
    values = zip(axes, points.values_at(at.number, list(axes.values())), strict=True)
    values = {key: value for key, value in values if value is not None}
    quantities = {key: value for key, value in values.items() if key in plan.config["surfaces"][surface]}
    copy = {key: values.pop(key) for key in OF_COPIES if key in values}
    replica = plan.replica(pair) if OF_COPIES & axes.keys() else {}
    plan = replace(plan, config=merged(plan.config, {"pairs": {pair: {"replica": copy}}})) if copy else plan
    rough = replace(plan, config=merged(plan.config, {"surfaces": {surface: quantities}})) if quantities else plan
    settings = {"device": points.settings_of(plan, at.device, rough), "surface": surface}
    return settings | {"varied": list(map(without_unit, axes)), "values": values} | replica


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
    rows, reference = [points[k : k + POINTS] for k in range(0, len(points), POINTS)], {"given": points[-1].roughness}
    over, attrs = ["roughness"], {"key": key, "surface": surface}
    if other:
        over, attrs = ["other", *over], attrs | {"other_key": other}
        rows, reference = _rows_apart(rows), reference | {"other_given": points[-1].other_given}
    curves = joined([point for row in rows for point in _apart(row)], *over).sortby(over)
    curves = curves.assign(reference).assign_attrs(attrs)
    smoother = ROUGHNESSES[key].smooths * (curves.roughness - curves.given) > 0
    if other:
        smoother = smoother | (ROUGHNESSES[other].smooths * (curves.other - curves.other_given) > 0)
    return _with_tables(flagged(curves, smoother))


def _apart(row):
    """Points of a curve with another roughness than the given one, which is the last, and this one."""
    *others, original = row
    largest = max(abs(float(point.roughness)) for point in row)
    return [point for point in others if not is_equal(point.roughness, original.roughness, largest)] + [original]


def _rows_apart(rows):
    """Curves of a map whose second quantity differs from that of the first curve, and this one."""
    (original, *_), *others = rows
    largest = max(abs(float(row[0].other)) for row in others)
    apart = [row for row in others if not is_equal(row[0].other, original.other_given, largest)]
    return [[point.drop_vars("other_given") for point in row] for row in (rows[0], *apart)]


def _with_tables(curves):
    """Curve or map with its crossings of the requirement and its sufficient ranges, one after the other."""
    scale = SCALES[ROUGHNESSES[curves.attrs["key"]].scale]
    axis = scale.coordinate(curves.roughness.values)
    dimensions, crossed, ranges = [name for name in ("other", "humidity", "shape") if name in curves.dims], [], []
    for at in product(*(curves[name].values for name in dimensions)):
        curve = curves.sel(dict(zip(dimensions, at, strict=True)))
        roots = crossings(axis, margins_of(curve), relative_errors(curve))
        crossed += [(*at, crossing.coordinate, crossing.error) for crossing in roots]
        ranges += [(*at, *ends) for ends in sufficient(axis, margins_of(curve, "safe"))]
    columns = _columns("crossing", crossed, [*dimensions, "place", "error"])
    columns |= _columns("range", ranges, [*dimensions, "low", "high"])
    columns |= {name: scale.value(columns[name]) for name in ("crossing_place", "range_low", "range_high")}
    columns["crossing_error"] = scale.slope(columns["crossing_place"]) * columns["crossing_error"]
    return curves.assign({name: (name.partition("_")[0], column) for name, column in columns.items()})


def _columns(table, rows, names):
    """Columns of the rows of a table by the names of their variables."""
    columns = zip(names, zip(*rows, strict=True) if rows else [()] * len(names), strict=True)
    return {f"{table}_{name}": np.array(column, str if name == "shape" else float) for name, column in columns}


def curves_of(curves: xr.Dataset) -> list[xr.Dataset]:
    """Curve of a device, or all curves of its map, each with its value of the second quantity as ``other``."""
    if "other" not in curves.dims:
        return [curves]
    rows_of = [{name: np.flatnonzero(curves[f"{name}_other"] == value) for name in _TABLES} for value in curves.other]
    return [curves.sel(other=value).isel(rows) for value, rows in zip(curves.other.values, rows_of, strict=True)]


def _axes_and_surface(plan, at):
    """Varied quantities, and their surface."""
    settings = {"surface": plan.config["devices"][at.device]["roughness"]["surface"]}
    return settings | dict(zip(("key", "other"), axes_of(plan, at.device), strict=False))


STAGES = (
    Stage.writing(
        "roughness_point",
        "devices/roughness/points/{device}_{number}",
        inputs=lambda plan, at: points.inputs(plan, at.device),
        settings=_settings,
        kind=Settings,
        complete=lambda settings, data: replace(settings, device=settings.device.corrected(data)),
        compute=lambda data, settings: compute(sides_of(data), settings),
        message="Device {device} at roughness {number}.",
        running=Running(minutes=120),
    ),
    Stage.writing(
        "roughness",
        "devices/roughness/{device}",
        inputs=lambda plan, at: {
            "points": points.names("devices/roughness/points", at.device, axes_of(plan, at.device).values())
        },
        settings=_axes_and_surface,
        compute=lambda data, settings: curve_or_map(data["points"], **settings),
        message="Roughness that device {device} needs.",
    ),
)

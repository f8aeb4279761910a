"""Stage roughness: safe length or force of a device along the roughness of a surface, and sufficient roughnesses.

Every point of the curve is the device on surfaces of another roughness, with the same random numbers; the last one has
the surfaces as they are given, and thus the results of the device itself.
"""

import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.chaos.model import Truncation
from stiction.config.kinds import ROUGHNESSES, restoring_force
from stiction.config.units import in_si
from stiction.contact.correction import NONE
from stiction.contact.environment import Water
from stiction.devices import risk
from stiction.devices.limits.limit import Limit, Side
from stiction.devices.limits.rules import long_strips, triggered
from stiction.devices.roughness import crossings, margins, sufficient
from stiction.errors import NotConverged
from stiction.plan.stage import Running, Stage, select
from stiction.rounding import is_equal
from stiction.run.stored_limits import as_text, of_text
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices import sticking, stoppers
from stiction.stages.devices.contact_names import corrections_of
from stiction.stages.devices.opening import FORCE, DesignedBeam, section_of_beam
from stiction.stages.roughness.contacts import POINTS, contacts_of, points_of, roughness_of, varied_quantities

#: Value of a second quantity of a point of a map, and that of the surface as it is given.
OTHERS = ("other", "other_given")
#: Kurtosis of a point, which curves and maps over the skewness have.
KURTOSIS = "kurtosis"
#: Limit of surfaces smoother than those on which full elastic contact was computed, where they change more.
SMOOTHER = Limit("smoother_than_full_contact", Side.UNSAFE, False)
#: Dimensions of what is found on a curve.
_TABLES = ("crossing", "range")


class Response(NamedTuple):
    """Length [m], or restoring force [N], with the allowed fraction p stuck, and the fraction stuck at another."""

    safe: float  #: one-sided 95 % bound
    estimate: float  #: infinite if no device sticks at any length
    error: float  #: standard error of the estimate
    bound: float  #: shortest length that sticks on any surface; NaN of a force
    stuck: tuple[float, float, float]  #: P(stuck) at the required length or force, with the ends of its 95 % band


#: Responses at a humidity by shape, and limits of all of them.
Found = tuple[list[Response], list[Limit]]


@dataclass(frozen=True, kw_only=True)
class OfBeam:
    """Settings of a point, without its contacts: a beam with a required length."""

    seed: int
    chaos: Truncation
    water: Water
    humidities: tuple[float, ...]  #: [-]
    device: DesignedBeam
    beams: int
    share: float  #: p [-]
    length: float  #: required [m]
    edge_radius: float  #: of tips, for the bound of flats [m]

    @property
    def required(self) -> tuple[float, str]:
        """Required number, with its unit."""
        return self.length, "m"

    @property
    def shares(self) -> tuple[float, ...]:
        """Fractions, as in other settings of safe lengths."""
        return (self.share,)

    @property
    def shapes(self) -> tuple[str, ...]:
        """End states of a stuck device."""
        return self.device.opening.shapes

    def responses(self, contact: xr.Dataset, tips: xr.Dataset | None, humidity: float) -> Found:
        """Safe lengths at a humidity by shape, and the limit of strips that are too long."""
        met = sticking.ground(contact, tips, humidity, self)
        beams = sticking.release_beams(self.device, met, self)
        known = sticking.lengths_without_samples(self.device, self.water, humidity, self.edge_radius, beams.reach)
        safe = sticking.by_shape(beams, self, known)
        limit = long_strips(
            self.device.strip, self.device.opening.longest_strip(self.device, met.laws), self.device.opening.arms == 2
        )
        found = [self._response(held, *safe[shape], known[shape]) for shape, held in beams.lengths.items()]
        return found, triggered(limit)

    def _response(self, lengths, safe, known):
        """Response from stuck lengths (n,) [m], their safe length and other known lengths."""
        shares = risk.stuck_share(np.array([self.length]), lengths, known.reach)
        error = np.sqrt(np.nansum(np.square([safe.error, safe.surfaces_error])))
        return Response(safe.length, safe.estimate, float(error), known.flat, tuple(float(part[0]) for part in shares))


@dataclass(frozen=True, kw_only=True)
class OfStopper:
    """Settings as of `OfBeam`, of a stopper with a restoring force."""

    seed: int
    water: Water
    humidities: tuple[float, ...]  #: [-]
    contact: tuple[float, float]  #: sides of the patch [m]
    share: float  #: p [-]
    restoring_force: float  #: [N]

    shapes = (FORCE,)

    @property
    def required(self) -> tuple[float, str]:
        """Required number, with its unit."""
        return self.restoring_force, "N"

    def responses(self, contact: xr.Dataset, _tips: None, humidity: float) -> Found:
        """Safe force at a humidity, without limits of strips."""
        forces = stoppers.forces(contact, humidity, self)
        change = self.water.changes(humidity)[1]
        stuck = tuple(stoppers.stuck_with_band(forces, self.restoring_force, change))
        (safe,) = stoppers.safe_forces_of(forces[None], self.share, self.seed, [change])
        return [Response(safe.force, safe.estimate, safe.error, np.nan, stuck)], []


def point_settings(settings: dict[str, Any], data: Mapping[str, Any]) -> OfBeam | OfStopper:
    """Settings of a point from those of a job and its inputs: those of beams have their dimensions."""
    return with_correction(in_si(OfBeam if "device" in settings else OfStopper, settings), data)


# Points


def compute(
    contact: Mapping[bool, xr.Dataset], settings: OfBeam | OfStopper, tips: Mapping[bool, xr.Dataset] | None = None
) -> xr.Dataset:
    """One point of the curve: lengths or forces at all humidities, or the reason against them.

    The contacts are those of `stiction.stages.roughness.contacts` in humid and in dry air, of tips if there are any.
    """
    responses, flagged, refused = [], [], []
    for humidity in settings.humidities:
        met, air = (contact[humidity > 0], (tips or {}).get(humidity > 0)), settings.water.at(humidity)
        try:
            found, limits = replace(settings, water=air).responses(*met, humidity)
            reason = ""
        except (ValueError, NotConverged) as error:
            traceback.print_exc()  # the log keeps where the reason arose, should it be an error of the code
            found, limits = [Response(np.nan, np.nan, np.nan, np.nan, (np.nan,) * 3)] * len(settings.shapes), []
            reason = str(error)
        responses.append(found)
        flagged.append(as_text(limits))
        refused.append(reason)
    first = next(iter(contact.values()))
    said = {"flagged": ("humidity", flagged), "refused": ("humidity", refused)}
    point = layout(responses, roughness_of(first), first.sizes["strip"], settings).assign(said)
    return point.assign({name: first[name] for name in (*OTHERS, KURTOSIS) if name in first})


def layout(
    responses: Sequence[Sequence[Response]],
    value: float,
    samples: int,
    settings: OfBeam | OfStopper,
) -> xr.Dataset:
    """Dataset of a point: responses by humidity and shape."""
    required, unit = settings.required
    over, note = ("humidity", "shape"), {"units": unit}
    columns = {name: [[getattr(one, name) for one in row] for row in responses] for name in Response._fields}
    return xr.Dataset(
        {name: (over, columns[name], note) for name in ("safe", "estimate", "error", "bound")}
        | {
            "stuck": ((*over, "end"), columns["stuck"], {"units": "1"}),
            "roughness": ((), value),
            "samples": ((), samples if isinstance(settings, OfStopper) else settings.beams),
            "required": ((), required, note),
            "share": ((), settings.share, {"units": "1"}),
            "corrected": ("humidity", [settings.water.changes(rh) != (NONE, NONE) for rh in settings.humidities]),
        },
        coords={
            "humidity": list(settings.humidities),
            "shape": list(settings.shapes),
            "end": ["estimate", "low", "high"],
        },
    )


# Curves


def join_points(points: Sequence[xr.Dataset], key: str, surface: str) -> xr.Dataset:
    """Curve of all points along the roughness, its crossings of the requirement, and its sufficient ranges.

    Parameters
    ----------
    points : sequence of Dataset
        The last one has the surfaces as they are given; others at the same roughness are left out.
    key : str
        What is varied, of `stiction.config.kinds.ROUGHNESSES`.
    surface : str
        Name of the surface.
    """
    *others, given = points
    largest = max(abs(float(point.roughness)) for point in points)
    apart = [point for point in others if not is_equal(point.roughness, given.roughness, largest)]
    shared = ["required", "share", "samples"]
    over = [point.drop_vars(shared).set_coords("roughness") for point in (*apart, given)]
    curve = xr.concat(over, "roughness").sortby("roughness")
    curve = curve.assign(given[shared]).assign(given=given.roughness).assign_attrs(key=key, surface=surface)
    curve = flagged(curve, (curve.roughness < curve.given) & (key == "rms_nm"))
    logarithmic = ROUGHNESSES[key].logarithmic
    axis = np.log(curve.roughness.values) if logarithmic else curve.roughness.values
    places, ranges = [], []
    for humidity in curve.humidity.values:
        for shape in curve["shape"].values:
            subject, at = curve.sel(humidity=humidity, shape=shape), (float(humidity), str(shape))
            met = crossings(axis, *_margins(subject, "estimate"))
            places += [(*at, crossing.place, crossing.error) for crossing in met]
            ranges += [(*at, *ends) for ends in sufficient(axis, _margins(subject, "safe")[0])]
    places, ranges = (np.array(rows, dtype=object).reshape(len(rows), 4) for rows in (places, ranges))
    if logarithmic:
        places[:, 2], ranges[:, 2:] = np.exp(places[:, 2].astype(float)), np.exp(ranges[:, 2:].astype(float))
        places[:, 3] = places[:, 2] * places[:, 3]
    return curve.assign(_rows("crossing", places, "place", "error") | _rows("range", ranges, "low", "high"))


def flagged(points: xr.Dataset, smoother: xr.DataArray | bool) -> xr.Dataset:
    """Points with a flag where they are corrected, and ``smoother`` than where full elastic contact was computed."""
    joined = np.vectorize(lambda flag, is_beyond: as_text([*of_text(flag), *[SMOOTHER] * is_beyond]), otypes=[object])
    flags = xr.apply_ufunc(joined, points.flagged, points.corrected & smoother)
    return points.assign(flagged=flags).drop_vars("corrected")


def curve_or_map(points: Sequence[xr.Dataset], surface: str, key: str, other: str = "") -> xr.Dataset:
    """Curve of a device, or, over a second quantity ``other``, all curves along a dimension of this name.

    The first curve has the second quantity as it is given; others at the same value are left out.
    """
    if "skewness" not in (key, other):
        points = [point.drop_vars(KURTOSIS, errors="ignore") for point in points]
    first, *more = [
        join_points([point.drop_vars(OTHERS, errors="ignore") for point in points[k : k + POINTS]], key, surface)
        for k in range(0, len(points), POINTS)
    ]
    if not more:
        return first
    given, others = float(points[-1].other_given), [float(point.other) for point in points[POINTS::POINTS]]
    curves = {given: first}
    for value, curve in zip(others, more, strict=True):
        if not is_equal(value, given, max(map(abs, others))):
            curves[value] = curve
    values = sorted(curves)
    alone = [curves[value].drop_dims(["crossing", "range"]) for value in values]
    over = [name for name in first.data_vars if "roughness" in first[name].dims]
    grid = xr.concat(alone, "other", data_vars=over, coords="minimal", compat="equals", join="exact")
    grid = grid.assign_coords(other=values).assign(other_given=given)
    rows = [xr.concat([_rows_of(curves[value], name, value) for value in values], name) for name in _TABLES]
    return xr.merge([grid, *rows], combine_attrs="override").assign_attrs(other_key=other)


def _rows_of(curve, name, value):
    """Crossings or ranges of a curve, with its value of the second quantity."""
    own = curve[[variable for variable in curve.data_vars if name in curve[variable].dims]]
    return own.drop_attrs().assign({f"{name}_other": (name, np.full(own.sizes[name], value))})


def curves_of(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Curve of a device, or all curves of its map, each with its value of the second quantity as ``other``."""
    if "other" not in dataset.dims:
        return [dataset]
    own = [{name: np.flatnonzero(dataset[f"{name}_other"] == value) for name in _TABLES} for value in dataset.other]
    return [dataset.sel(other=value).isel(rows) for value, rows in zip(dataset.other.values, own, strict=True)]


def _margins(curve, name):
    """Margins of a curve to the requirement, and their standard errors."""
    more_is_better = curve.required.attrs["units"] == "m"
    known = np.isfinite(curve.estimate.values) & (curve.estimate.values > 0)
    errors = np.divide(curve.error.values, curve.estimate.values, out=np.zeros(known.size), where=known)
    return margins(curve[name].values, float(curve.required), more_is_better), errors


def _rows(dimension, rows, *names):
    """Variables of rows (humidity, shape, two numbers named ``names``) along a dimension."""
    humidity, shape, first, second = rows.T if len(rows) else ((),) * 4
    columns = {"humidity": humidity, "shape": shape} | dict(zip(names, (first, second), strict=True))
    kinds = {"shape": str}
    return {
        f"{dimension}_{name}": (dimension, np.array(list(values), kinds.get(name, float)))
        for name, values in columns.items()
    }


# Stages


def settings_of(plan: Any, at: Any) -> dict[str, Any]:
    """Requirement of a device, and settings of its length or force, without the contact."""
    section = plan.config["devices"][at.device]
    air = plan.air_of_devices
    wettest = air.contact(section["pair"], max(section["humidities"]))
    own = plan.config["design"] | section | section["requirement"] | {"water": air.water(wettest)}
    if not plan.devices.kind(at.device).is_beam:
        return select(OfStopper, own | {"seed": plan.config["seed"]} | {"restoring_force_uN": restoring_force(section)})
    common = {key: plan.config[key] for key in ("seed", "chaos")}
    edge = {"edge_radius_um": plan.devices.edge_radius(at.device)}
    return select(OfBeam, own | common | edge | {"device": section_of_beam(plan, at.device)})


def _what(plan, device):
    """Varied quantities, and their surface."""
    first, *others = varied_quantities(plan, device)
    return {"key": first.key, "surface": first.surface} | ({"other": others[0].key} if others else {})


STAGES = (
    Stage.writing(
        "roughness_point",
        "devices/roughness/points/{device}_{number}",
        # ASSUME: a correction to full elastic contact is that of the given surfaces at every roughness.
        inputs=lambda plan, at: contacts_of(plan, at.device, int(at.number)) | corrections_of(plan, at.device),
        settings=settings_of,
        complete=point_settings,
        compute=compute,
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

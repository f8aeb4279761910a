"""Requirement of a device on surfaces in contact: its length or force with the allowed fraction stuck, in all airs."""

import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.answer.sought import SOUGHT, Sought
from stiction.chaos.model import Truncation
from stiction.contact.air import Air
from stiction.contact.correction import NONE
from stiction.contact.environment import Water
from stiction.devices import risk
from stiction.devices.limits.limit import Limit, Side
from stiction.devices.limits.rules import long_strips, triggered
from stiction.devices.roughness import margins
from stiction.errors import NotConverged
from stiction.plan.stage import select
from stiction.run.stored_limits import as_text, of_text
from stiction.stages.devices import sticking, stoppers
from stiction.stages.devices.opening import FORCE, DesignedBeam, own_section

#: Limit of surfaces smoother than those on which full elastic contact was computed, where they change more.
SMOOTHER = Limit("smoother_than_full_contact", Side.UNSAFE, False)


def sought_of(points: xr.Dataset) -> Sought:
    """Number that the requirement of a dataset is about."""
    return SOUGHT[points.required.attrs["units"]]


class Response(NamedTuple):
    """Length [m], or restoring force [N], with the allowed fraction p stuck, and the fraction stuck at another."""

    safe: float  #: one-sided 95 % bound
    estimate: float  #: infinite if no device sticks at any length
    error: float  #: standard error of the estimate
    bound: float  #: shortest length that sticks on any surface; NaN of a force
    stuck: tuple[float, float, float]  #: P(stuck) at the required length or force, with the ends of its 95 % band


#: Responses at a humidity by shape, and limits of all of them.
ResponsesAndLimits = tuple[list[Response], list[Limit]]


@dataclass(frozen=True, kw_only=True)
class RequiredBeam:
    """Settings of a beam with a required length, without its contacts."""

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
    def number(self) -> int:
        """Number of devices."""
        return self.beams

    @property
    def shares(self) -> tuple[float, ...]:
        """Fractions, as in other settings of safe lengths."""
        return (self.share,)

    @property
    def shapes(self) -> tuple[str, ...]:
        """End states of a stuck device."""
        return self.device.opening.shapes

    def responses(self, contact: xr.Dataset, tips: xr.Dataset | None, humidity: float) -> ResponsesAndLimits:
        """Safe lengths at a humidity by shape, and the limit of strips that are too long."""
        ground = sticking.ground(contact, tips, humidity, self)
        beams = sticking.release_beams(self.device, ground, self)
        bounds = sticking.lengths_without_samples(self.device, self.water, humidity, self.edge_radius, beams.reach)
        safe = sticking.by_shape(beams, self, bounds)
        limit = long_strips(
            self.device.strip,
            self.device.opening.longest_strip(self.device, ground.laws),
            self.device.opening.arms == 2,
        )
        responses = [self._response(held, *safe[shape], bounds[shape]) for shape, held in beams.lengths.items()]
        return responses, triggered(limit)

    def _response(self, lengths, safe, bounds):
        """Response from stuck lengths (n,) [m], their safe length and its bounds without samples."""
        shares = risk.stuck_share(np.array([self.length]), lengths, bounds.reach)
        error = np.sqrt(np.nansum(np.square([safe.error, safe.surfaces_error])))
        return Response(
            safe.length, safe.estimate, float(error), bounds.flat, tuple(float(fraction[0]) for fraction in shares)
        )


@dataclass(frozen=True, kw_only=True)
class RequiredStopper:
    """Settings as of `RequiredBeam`, of a stopper with a restoring force."""

    seed: int
    water: Water
    humidities: tuple[float, ...]  #: [-]
    contact: tuple[float, float]  #: sides of the patch [m]
    share: float  #: p [-]
    restoring_force: float  #: [N]

    shapes, number = (FORCE,), 0  # one stopper for each sample of the contact

    @property
    def required(self) -> tuple[float, str]:
        """Required number, with its unit."""
        return self.restoring_force, "N"

    def responses(self, contact: xr.Dataset, _tips: None, humidity: float) -> ResponsesAndLimits:
        """Safe force at a humidity, without limits of strips."""
        forces = stoppers.forces(contact, humidity, self)
        change = self.water.changes(humidity)[1]
        stuck = tuple(stoppers.stuck_with_band(forces, self.restoring_force, change))
        (safe,) = stoppers.safe_forces_of(forces[None], self.share, self.seed, [change])
        return [Response(safe.force, safe.estimate, safe.error, np.nan, stuck)], []


#: By the name of the release.
OF_RELEASE = {"beam": RequiredBeam, "stopper": RequiredStopper}


def compute(
    contact: Mapping[str, xr.Dataset],
    settings: RequiredBeam | RequiredStopper,
    tips: Mapping[str, xr.Dataset] | None = None,
) -> xr.Dataset:
    """Lengths or forces at all humidities, or the reason against them.

    The contacts are by the kind of air, of tips if there are any.
    """
    responses, flagged, refused = [], [], []
    for humidity in settings.humidities:
        kind, water = Air(humidity).kind, settings.water.at(humidity)
        try:
            row, limits = replace(settings, water=water).responses(contact[kind], (tips or {}).get(kind), humidity)
            reason = ""
        except (ValueError, NotConverged) as error:
            traceback.print_exc()  # the log keeps where the reason arose, should it be an error of the code
            row, limits = [Response(np.nan, np.nan, np.nan, np.nan, (np.nan,) * 3)] * len(settings.shapes), []
            reason = str(error)
        responses.append(row)
        flagged.append(as_text(limits))
        refused.append(reason)
    texts = {"flagged": ("humidity", flagged), "refused": ("humidity", refused)}
    return layout(responses, next(iter(contact.values())).sizes["strip"], settings).assign(texts)


def layout(
    responses: Sequence[Sequence[Response]], samples: int, settings: RequiredBeam | RequiredStopper
) -> xr.Dataset:
    """Dataset of a device: responses by humidity and shape."""
    required, unit = settings.required
    over, note = ("humidity", "shape"), {"units": unit}
    columns = {name: [[getattr(response, name) for response in row] for row in responses] for name in Response._fields}
    return xr.Dataset(
        {name: (over, columns[name], note) for name in ("safe", "estimate", "error", "bound")}
        | {
            "stuck": ((*over, "end"), columns["stuck"]),
            "samples": ((), settings.number or samples),
            "required": ((), required, note),
            "share": ((), settings.share),
            "corrected": ("humidity", [settings.water.changes(rh) != (NONE, NONE) for rh in settings.humidities]),
        },
        coords={
            "humidity": list(settings.humidities),
            "shape": list(settings.shapes),
            "end": ["estimate", "low", "high"],
        },
    )


def margins_of(points: xr.Dataset, name: str = "estimate") -> np.ndarray:
    """Margins of a variable of devices to their requirement, of its shape [-]."""
    return margins(points[name].values, float(points.required), not sought_of(points).more_is_better)


def relative_errors(points: xr.Dataset) -> np.ndarray:
    """Standard errors of the margins of estimates due to the simulation: none where no device sticks [-]."""
    is_known = np.isfinite(points.estimate.values) & (points.estimate.values > 0)
    return np.divide(points.error.values, points.estimate.values, out=np.zeros(is_known.shape), where=is_known)


def flagged(points: xr.Dataset, smoother: xr.DataArray | bool) -> xr.Dataset:
    """Points with a flag where they are corrected, and ``smoother`` than where full elastic contact was computed."""
    joined = np.vectorize(lambda flag, is_beyond: as_text([*of_text(flag), *[SMOOTHER] * is_beyond]), otypes=[object])
    flags = xr.apply_ufunc(joined, points.flagged, points.corrected & smoother)
    return points.assign(flagged=flags).drop_vars("corrected")


def settings_of(plan: Any, device: str) -> dict[str, Any]:
    """Requirement of a device, and settings of its length or force, without the contact."""
    section = plan.config["devices"][device]
    air = plan.air_of_devices
    wettest = air.contact(section["pair"], max(section["humidities"]))
    keys = plan.config["design"] | plan.devices.stated(device) | section["requirement"] | {"water": air.water(wettest)}
    keys |= {key: plan.config[key] for key in ("seed", "chaos")} | own_section(plan, device)
    keys |= {"edge_radius_um": plan.devices.edge_radius(device)}
    return select(OF_RELEASE[plan.devices.kind(device).release.name], keys)

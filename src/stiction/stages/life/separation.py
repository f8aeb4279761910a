"""Stages of separation: what holds devices that separate faster than water evaporates, at humidities with water.

For a stopper: the pull-off force of every patch, at least that of slow separation. For a beam: factors of its sticking
lengths by end state. ASSUME: they are those of the means, (e / e_V)^(1/4) of the energies of strips, for beams and for
the middle of bridges, and the mean inverse length of slow over that of fast separation for tips. For tips this is the
safe side: those of pair b that hold the shortest beams gain least. Strips and tips are those of all beams on them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.cases import Case, case_id
from stiction.contact.environment import Water
from stiction.devices import arcs
from stiction.devices.stoppers import pull_off_force
from stiction.estimates import jackknife
from stiction.plan.stage import At, Stage, select
from stiction.stages.contact import curves
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.contact_names import (
    case_on,
    contact_of,
    corrections_of,
    name_of_ground,
    tips_of,
)
from stiction.stages.devices.opening import DesignedBeam


@dataclass(frozen=True)
class StopperSettings:
    """Settings of the fast separation of a stopper, without its contacts."""

    water: Water
    contact: tuple[float, float]  #: sides of the patch [m]


@dataclass(frozen=True)
class FastInAir:
    """Settings of the fast separation of strips or tips, without their contact."""

    water: Water
    humidity: float  #: [-]


def of_stopper(contacts: Mapping[float, xr.Dataset], settings: StopperSettings) -> xr.Dataset:
    """Pull-off forces of all patches of a stopper, from its contacts by humidity."""
    area, water = settings.contact[0] * settings.contact[1], settings.water
    largest = [
        np.maximum(curves.fast_pull_offs(contact, at, water), curves.pull_offs(contact, at, water))
        for at, contact in contacts.items()
    ]
    forces = (("humidity", "sample"), pull_off_force(np.array(largest), area))
    return xr.Dataset({"pull_off": forces}, coords={"humidity": list(contacts)})


def of_strips(contact: xr.Dataset, settings: FastInAir) -> xr.Dataset:
    """Factor of the length of a crack by the mean energies of strips, and its standard error."""
    fast, slow = (
        statistic(contact, settings.humidity, settings.water) for statistic in (curves.fast_energies, curves.energies)
    )
    factors = _ratio(np.maximum(fast, slow), slow, lambda means: (means[..., 1] / means[..., 0]) ** 0.25)
    return xr.Dataset(dict(zip(("factor", "factor_error"), (((), factor) for factor in factors), strict=True)))


def of_tips(contact: xr.Dataset, settings: FastInAir) -> xr.Dataset:
    """Largest attractions P/w of tips over their slopes, in slow and in fast separation."""
    slopes, slow = curves.tip_forces(contact, settings.humidity, settings.water)
    fast = curves.fast_tip_forces(contact, settings.humidity, settings.water)
    forces = {name: (("tip", "slope"), values) for name, values in (("slow", slow), ("fast", fast))}
    return xr.Dataset(forces, coords={"slope": slopes})


def of_beam(strips: Mapping[float, xr.Dataset], tips: Mapping[float, xr.Dataset], device: DesignedBeam) -> xr.Dataset:
    """Factors of the lengths of a beam by end state with their errors, from its strips and tips by humidity."""
    rows = [
        [
            (float(dataset.factor), float(dataset.factor_error)),
            *([factor_of_tips(tips[humidity], device)] if humidity in tips else []),
        ]
        for humidity, dataset in strips.items()
    ]
    values, errors = np.moveaxis(np.array(rows), -1, 0)
    over, coords = ("humidity", "shape"), {"humidity": list(strips), "shape": [*device.opening.shapes]}
    return xr.Dataset({"factor": (over, values), "factor_error": (over, errors)}, coords=coords)


def factor_of_tips(forces: xr.Dataset, device: DesignedBeam) -> tuple[float, float]:
    """Factor of the length that a tip holds, by the mean inverse lengths of all tips, and its standard error [-].

    The forces are those of `of_tips`.
    """
    slow, fast = forces.slow.values, forces.fast.values
    stopped = np.isfinite(fast).all(axis=1)
    inverse = [
        1 / arcs.longest_free(forces.slope.values, np.where(stopped[:, None], forces_of_tips, slow), device.beam)
        for forces_of_tips in (fast, slow)
    ]
    return _ratio(np.where(stopped, inverse[0], np.inf), inverse[1], lambda means: means[..., 1] / means[..., 0])


def _ratio(fast, slow, factor):
    """Factor from the means of two samples and its error; zero, without an error, if no summits stop some of them."""
    if np.isinf(fast).any():
        return 0.0, np.nan
    return tuple(map(float, jackknife(factor, np.column_stack([fast, slow]))))


def separation_inputs(plan: Any, device: str) -> dict[str, Any]:
    """Forces of a stopper, or strips and tips of a beam by humidity, as inputs of a stage; none without water."""
    return _INPUTS[plan.devices.kind(device).release.name](plan, device, _wet(plan, device))


def _inputs_of_beam(plan, device, wet):
    """Strips and tips of a beam by humidity."""
    tips = wet if plan.devices.kind(device).has_tip else {}
    return {
        "fast_strips": {
            humidity: f"devices/fast_strips/{name_of_ground(plan, case)}" for humidity, case in wet.items()
        },
        "fast_tips": {humidity: f"devices/fast_tips/{_name_of_tips(plan, case)}" for humidity, case in tips.items()},
    }


_INPUTS = {
    "beam": _inputs_of_beam,
    "stopper": lambda _plan, device, wet: {"separation": f"devices/separation/{device}"} if wet else {},
}


def _wet(plan, device):
    """Cases of a device at those of its humidities at which water condenses, by humidity."""
    section = plan.config["devices"][device]
    return {rh: Case(case_id(device, rh)) for rh in plan.air_of_devices.wet(section["pair"], section["humidities"])}


def _name_of_tips(plan, case):
    """Name of the tips of a cantilever at a humidity."""
    tips = plan.devices.tips(case.device)
    return f"{case_id(tips.pair, case.humidity)}_{tips.length}x{tips.width}"


def _contacts_of_stopper(plan, at):
    """Contacts of a stopper by humidity."""
    contacts = {humidity: contact_of(plan, case) for humidity, case in _wet(plan, at.device).items()}
    return {"contacts": contacts} | corrections_of(plan, at.device)


def _settings_of_stopper(plan, at):
    """Water around a stopper, and its patch."""
    section = plan.config["devices"][at.device]
    return select(StopperSettings, section | {"water": plan.air_of_devices.water(section["pair"])})


def _in_air(plan, at):
    """Water around strips or tips."""
    return {"water": plan.air_of_devices.water(at.case.pair), "humidity": at.case.humidity}


def _contact_of_strips(plan: Any, at: At) -> dict[str, str]:
    """Contact of strips, with its correction."""
    case = case_on(plan, at)
    return {"contact": contact_of(plan, case)} | corrections_of(plan, case.device, case.humidity)


def _contact_of_tips(plan: Any, at: At) -> dict[str, str]:
    """Contact of tips, with its correction."""
    case = case_on(plan, at, of_tips=True)
    return {"contact": tips_of(plan, case)["tips"]} | corrections_of(plan, case.device, case.humidity)


STAGES = (
    Stage.writing(
        "separation",
        "devices/separation/{device}",
        inputs=_contacts_of_stopper,
        settings=_settings_of_stopper,
        kind=StopperSettings,
        complete=with_correction,
        compute=of_stopper,
        message="Fast separation of stopper {device}.",
    ),
    Stage.writing(
        "fast_strips",
        "devices/fast_strips/{case}_{length}x{width}",
        inputs=_contact_of_strips,
        settings=_in_air,
        kind=FastInAir,
        complete=with_correction,
        compute=of_strips,
        message="Fast separation of {case}, strips of {length} x {width} nm.",
    ),
    Stage.writing(
        "fast_tips",
        "devices/fast_tips/{case}_{length}x{width}",
        inputs=_contact_of_tips,
        settings=_in_air,
        kind=FastInAir,
        complete=with_correction,
        compute=of_tips,
        message="Fast separation of tips of {case}, {length} x {width} nm.",
    ),
)

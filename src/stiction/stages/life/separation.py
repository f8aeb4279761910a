"""Stage separation: what holds a device that separates faster than water evaporates, at its humidities with water.

For a stopper: the pull-off force of every patch, at least that of slow separation. For a beam: factors of its sticking
lengths by end state. ASSUME: they are those of the means, (e / e_V)^(1/4) of the energies of strips, for beams and for
the middle of bridges, and the mean inverse length of slow over that of fast separation for tips. For tips this is the
safe side: those of pair b that hold the shortest beams gain least.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.cases import case_id
from stiction.contact.environment import Water
from stiction.devices import arcs
from stiction.devices.stoppers import pull_off_force
from stiction.estimates import jackknife
from stiction.plan.stage import Stage, select
from stiction.stages.contact import curves
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.contact_names import contact_of, corrections_of, tips_of
from stiction.stages.devices.opening import DesignedBeam, section_of_beam


@dataclass(frozen=True)
class Settings:
    """Everything that a fast separation depends on apart from the contact."""

    water: Water
    contact: tuple[float, float] | None = None  #: sides of the patch of a stopper [m]; none for a beam
    device: DesignedBeam | None = None  #: a beam; none for a stopper


def compute(
    contacts: Mapping[float, xr.Dataset], settings: Settings, tips: Mapping[float, xr.Dataset] | None = None
) -> xr.Dataset:
    """Pull-off forces of a stopper or factors of the lengths of a beam, from its contacts by humidity."""
    found = _forces(contacts, settings) if settings.contact else _factors(contacts, tips or {}, settings)
    return xr.Dataset(found, coords={"humidity": list(contacts)})


def _forces(contacts, settings):
    """Pull-off forces of all patches of a stopper."""
    area, water = settings.contact[0] * settings.contact[1], settings.water
    largest = [
        np.maximum(curves.fast_pull_offs(one, at, water), curves.pull_offs(one, at, water))
        for at, one in contacts.items()
    ]
    return {"pull_off": (("humidity", "sample"), pull_off_force(np.array(largest), area), {"units": "N"})}


def _factors(contacts, tips, settings):
    """Factors of the lengths of a beam by end state, with their standard errors."""
    rows = [
        [factor_of_strips(one, at, settings.water), *([factor_of_tips(tips[at], at, settings)] if at in tips else [])]
        for at, one in contacts.items()
    ]
    none = {"units": "1", "long_name": "length of fast separation over that of slow separation"}
    values, errors = np.moveaxis(np.array(rows), -1, 0)
    over = ("humidity", "shape")
    return {
        "factor": (over, values, none),
        "factor_error": (over, errors, none),
        "shape": [*settings.device.opening.shapes],
    }


def factor_of_strips(contact: xr.Dataset, humidity: float, water: Water) -> tuple[float, float]:
    """Factor of the length of a crack by the mean energies of strips, and its standard error [-]."""
    energies = (of(contact, humidity, water) for of in (curves.fast_energies, curves.energies))
    return _ratio(*energies, lambda means: (means[..., 1] / means[..., 0]) ** 0.25)


def factor_of_tips(tips: xr.Dataset, humidity: float, settings: Settings) -> tuple[float, float]:
    """Factor of the length that a tip holds, by the mean inverse lengths of all tips, and its standard error [-]."""
    slopes, slow = curves.tip_forces(tips, humidity, settings.water)
    fast = curves.fast_tip_forces(tips, humidity, settings.water)
    stopped = np.isfinite(fast).all(axis=1)
    inverse = [
        1 / arcs.longest_free(slopes, np.where(stopped[:, None], forces, slow), settings.device.beam)
        for forces in (fast, slow)
    ]
    return _ratio(np.where(stopped, inverse[0], np.inf), inverse[1], lambda means: means[..., 1] / means[..., 0])


def _ratio(fast, slow, factor):
    """Factor from the means of two samples and its error; zero, without an error, if no summits stop some of them."""
    if np.isinf(fast).any():
        return 0.0, np.nan
    return tuple(map(float, jackknife(factor, np.column_stack([fast, slow]))))


def separation_inputs(plan: Any, device: str) -> dict[str, str]:
    """Dataset of a device, as input of a stage; none if no water condenses in any of its airs."""
    return {"separation": f"devices/separation/{device}"} if _wet(plan, device) else {}


def _wet(plan, device):
    """Names of a device at those of its humidities at which water condenses, by humidity."""
    section = plan.config["devices"][device]
    humid = [humidity for humidity in section["humidities"] if humidity > 0]
    wetted = humid if plan.air_of_devices.is_wetted(section["pair"]) else []
    return {humidity: case_id(device, humidity) for humidity in wetted}


def _inputs(plan, at):
    """Contacts of a device, and of its tips if it has any, by humidity."""
    cases = _wet(plan, at.device)
    tips = {humidity: name for humidity, case in cases.items() for name in tips_of(plan, case).values()}
    contacts = {humidity: contact_of(plan, case) for humidity, case in cases.items()}
    return {"contacts": contacts, "tips": tips} | corrections_of(plan, at.device)


def _settings(plan, at):
    """Water around a device, and the patch of a stopper or the beam."""
    section = plan.config["devices"][at.device]
    water = {"water": plan.air_of_devices.water(section["pair"])}
    if plan.devices.kind(at.device).is_beam:
        return select(Settings, water | {"device": section_of_beam(plan, at.device)})
    return select(Settings, section | water)


STAGES = (
    Stage.writing(
        "separation",
        "devices/separation/{device}",
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        complete=with_correction,
        compute=compute,
        message="Fast separation of device {device}.",
    ),
)

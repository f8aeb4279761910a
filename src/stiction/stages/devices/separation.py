"""Stage separation: what holds a device that separates faster than water evaporates, at its humidities with water.

For a stopper: the pull-off force of every patch, at least that of slow separation. For a beam: the mean adhesion energy
of its strips over that of slow separation.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.cases import case_id
from stiction.contact.environment import Water
from stiction.devices.stoppers import pull_off_force
from stiction.estimates import jackknife
from stiction.plan.stage import Stage, select
from stiction.stages.contact import curves
from stiction.stages.contact.corrections import corrected
from stiction.stages.devices.contact_names import contact_of, corrections_of


@dataclass(frozen=True)
class Settings:
    """Everything that a fast separation depends on apart from the contact."""

    water: Water
    contact: tuple[float, float] | None = None  #: sides of the patch of a stopper [m]; none for a beam


def compute(contacts: Mapping[float, xr.Dataset], settings: Settings) -> xr.Dataset:
    """Pull-off forces of a stopper or ratios of the energies of a beam, from its contacts by humidity."""
    found = _forces(contacts, settings) if settings.contact else _ratios(contacts, settings.water)
    return xr.Dataset(found, coords={"humidity": list(contacts)})


def _forces(contacts, settings):
    """Pull-off forces of all patches of a stopper."""
    area, water = settings.contact[0] * settings.contact[1], settings.water
    largest = [
        np.maximum(curves.fast_pull_offs(one, at, water), curves.pull_offs(one, at, water))
        for at, one in contacts.items()
    ]
    return {"pull_off": (("humidity", "sample"), pull_off_force(np.array(largest), area), {"units": "N"})}


def _ratios(contacts, water):
    """Ratios of the energies of a beam, with their standard errors."""
    none = {"units": "1", "long_name": "mean energy of fast separation over that of slow separation"}
    values, errors = np.transpose([energy_ratio(one, at, water) for at, one in contacts.items()])
    return {"energy_ratio": ("humidity", values, none), "energy_ratio_error": ("humidity", errors, none)}


def energy_ratio(contact: xr.Dataset, humidity: float, water: Water) -> tuple[float, float]:
    """Mean adhesion energy of fast separation over that of slow separation, and its standard error [-].

    Infinite, without an error, if no summits stop some of the strips.
    """
    energies = [of(contact, humidity, water) for of in (curves.fast_energies, curves.energies)]
    if np.isinf(energies[0]).any():
        return np.inf, np.nan
    ratio, error = jackknife(lambda means: means[..., 0] / means[..., 1], np.transpose(energies))
    return float(ratio), float(error)


def of_device(plan: Any, device: str) -> dict[str, str]:
    """Dataset of a device, as input of a stage; none if no water condenses in any of its airs."""
    return {"separation": f"devices/separation/{device}"} if _contacts(plan, device) else {}


def _contacts(plan, device):
    """Contacts of a device by those of its humidities at which water condenses."""
    section = plan.config["devices"][device]
    humid = [humidity for humidity in section["humidities"] if humidity > 0]
    wetted = humid if plan.air_of_devices.is_wetted(section["pair"]) else []
    return {humidity: contact_of(plan, case_id(device, humidity)) for humidity in wetted}


def _settings(plan, at):
    """Water around a device, and the patch of a stopper."""
    section = plan.config["devices"][at.device]
    return select(Settings, section | {"water": plan.air_of_devices.water(section["pair"])})


STAGES = (
    Stage.writing(
        "separation",
        "devices/separation/{device}",
        inputs=lambda plan, at: {"contacts": _contacts(plan, at.device)} | corrections_of(plan, at.device),
        settings=_settings,
        kind=Settings,
        compute=lambda data, settings: compute(data["contacts"], corrected(settings, data)),
        message="Fast separation of device {device}.",
    ),
)

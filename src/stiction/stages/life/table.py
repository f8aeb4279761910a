"""Stage life: causes of the contact of a device, its adhesion then, and ways to free it.

Every answer is a number between two bounds, which are equal where the model leaves nothing open, or the keys that give
the number.
"""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from stiction.config.units import from_si, in_si
from stiction.constants import LIQUIDS
from stiction.plan.stage import Stage, select
from stiction.stages.devices.opening import own_section
from stiction.stages.devices.results import results_of
from stiction.stages.life import beams, stoppers
from stiction.stages.life.inputs import BeamKeys, StopperKeys
from stiction.stages.life.separation import separation_inputs


def compute(data: Mapping[str, Any], settings: dict[str, Any]) -> xr.Dataset:
    """Answers about a device, from its safe lengths by humidity or from the forces of a stopper."""
    ((release, values),) = settings.items()
    kind, answers = _OF_RELEASE[release]
    return answers(data, in_si(kind, values))


#: Settings, and what makes the dataset, by the name of the release.
_OF_RELEASE = {"beam": (BeamKeys, beams.dataset), "stopper": (StopperKeys, stoppers.dataset)}


def _settings(plan, at):
    """Settings of a device, with the liquids and its density."""
    values, release = {"uncertainty": {}} | plan.devices.stated(at.device), plan.devices.kind(at.device).release
    usual = {name: {"surface_tension_mN_per_m": from_si(tension, "mN_per_m")} for name, tension in LIQUIDS.items()}
    values |= {"liquids": usual | plan.config.get("liquids", {})} | own_section(plan, at.device)
    values |= {"density_kg_per_m3": plan.materials.density(values["pair"])}
    values |= {"unasked": keys} if (keys := plan.devices.kind(at.device).unasked) else {}
    return {release.name: select(_OF_RELEASE[release.name][0], values)}


STAGES = (
    Stage.writing(
        "life",
        "devices/life/{device}",
        inputs=lambda plan, at: results_of(plan, at.device) | separation_inputs(plan, at.device),
        settings=_settings,
        compute=compute,
        message="Life of device {device}.",
    ),
)

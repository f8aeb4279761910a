"""Stage ground: force laws of strips of one size at a humidity, for all beams of devices on them.

The chaos model of a ground is fitted once. Cracks and charts of devices of any thickness, gap and length draw from it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import xarray as xr

from stiction.chaos.model import Truncation
from stiction.config.cases import Case
from stiction.contact.correction import NONE, ElasticChange
from stiction.contact.environment import Water
from stiction.plan.stage import At, Running, Stage, select
from stiction.stages.contact import curves
from stiction.stages.contact.contact import surface_rms, with_correlations
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices.contact_names import case_on, contact_of, corrections_of, name_of_ground
from stiction.stages.devices.opening import settings_of_beam
from stiction.stages.devices.sticking import BeamSettings, Ground, Laws, fitted_laws, ground_of_laws
from stiction.stages.laws.stored_model import chaos_model, model_variables
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs


@dataclass(frozen=True)
class Settings:
    """Settings of the force laws of a ground, without its contact."""

    chaos: Truncation
    water: Water
    humidity: float  #: [-]
    strip: float  #: length of a strip [m]
    width: float  #: [m]


def compute(data: Mapping[str, Any], settings: Settings) -> xr.Dataset:
    """Fit the force laws of a contact, from its dataset and those of both surfaces by stage."""
    contact, sides = data["contact"], (settings.strip, settings.width)
    laws = fitted_laws(with_correlations(contact, sides_of(data), sides), settings.humidity, settings, sides)
    share = curves.share_flat(contact, settings.humidity, settings.water)
    return layout(laws, surface_rms(contact), share)


def layout(laws: Laws, rms: float, share_flat: float) -> xr.Dataset:
    """Dataset of force laws, with the rms of the sum of both surfaces [m] and the share of flat samples [-]."""
    moved = laws.displacements
    displacements = {} if moved is None else {"displacement": ("sample", moved)}
    return xr.Dataset(
        model_variables(laws.model)
        | displacements
        | {
            "sampled": (("sample", "parameter"), laws.sampled),
            "rms": ((), rms),
            "share_flat": ((), share_flat),
            "resampled": ((), len(laws.sampled) * laws.is_narrow),
            "repetition": ((), laws.repetition),
        }
        | {f"change_{name}": ((), value) for name, value in laws.change._asdict().items() if laws.change != NONE},
        coords={"parameter": ["f_max", "d_max", "a_left", "a_right"]},
    )


def ground_from(dataset: xr.Dataset, settings: BeamSettings) -> Ground:
    """Ground without tips from its dataset."""
    change = {name: float(dataset[f"change_{name}"]) for name in ElasticChange._fields if f"change_{name}" in dataset}
    of_strips = dataset.sampled.values, bool(dataset.resampled), float(dataset.repetition)
    displacements = dataset.displacement.values if "displacement" in dataset else None
    laws = Laws(chaos_model(dataset), *of_strips, ElasticChange(**change), displacements)
    return ground_of_laws(laws, settings)


def ground_inputs(plan: Any, case: Case) -> dict[str, str]:
    """Ground of a device at a humidity, as input of a stage."""
    return {"ground": f"devices/ground/{name_of_ground(plan, case)}"}


def _inputs(plan: Any, at: At) -> dict[str, str]:
    """Contact of a ground, with its surfaces and its correction."""
    case = case_on(plan, at)
    surfaces = surface_inputs(plan, plan.config["devices"][case.device]["pair"])
    return {"contact": contact_of(plan, case)} | surfaces | corrections_of(plan, case.device, case.humidity)


def _settings(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the force laws, the same for all devices on a ground."""
    case = case_on(plan, at)
    sides = {"strip_um": plan.devices.strip(case.device), "width_um": plan.config["devices"][case.device]["width_um"]}
    return select(Settings, settings_of_beam(plan, case) | sides)


STAGES = (
    Stage.writing(
        "ground",
        "devices/ground/{case}_{length}x{width}",
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        complete=with_correction,
        compute=compute,
        message="Force laws of {case}, strips of {length} x {width} nm.",
        running=Running(priority=1),
    ),
)

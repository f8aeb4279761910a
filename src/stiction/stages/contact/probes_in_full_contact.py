"""Probes in full elastic contact, beside the sum over summits: ratios of their own pull-off forces.

ASSUME: a few places say how both models differ. Where one does not settle, forces stay those on summits.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage, select
from stiction.stages.contact import full_contact, pair_model_error
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

#: Places in full contact, as many as they may become until their error counts little, and those on summits alone.
PLACES = {"strips": 8, "most": 24, "on_summits": 200}


@dataclass(frozen=True, kw_only=True)
class Settings(full_contact.Settings):
    """Settings of full contact, with the name of the pair."""

    pair: str


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], settings: Settings) -> xr.Dataset:
    """Places of a probe in full contact, of unknown forces where one does not settle.

    Variables as of ``full_contact.compute``.
    """
    try:
        return full_contact.compute(surfaces, settings.pair, settings)
    except (NotConverged, ValueError):
        spacing = settings.sampling.spacing * settings.contact.every
        unknown = np.full((2, len(settings.humidities), len(full_contact.VARIABLES)), np.nan)
        return full_contact.layout(unknown, settings.humidities, spacing)


def changes(study: xr.Dataset) -> xr.Dataset:
    """Changes of the forces of a probe by full contact, as a dataset of stage model_error_of_devices."""
    humidities = tuple(study.humidity.values.tolist())
    errors = pair_model_error.compute(study, humidities, humidities).drop_vars("strips")
    is_known = np.isfinite(errors.pull_off_ratio)
    flags = dict.fromkeys(("applied", "pull_off_applied"), is_known) | {"tip_applied": is_known & False}
    return errors.assign(flags | {"nearest": ((), True)} | _largest_residuals(study, errors))


def _largest_residuals(study, errors):
    """Largest part of one place in the squared error of the ratio of forces, NaN for energies."""
    residuals = study.pull_off - errors.pull_off_ratio * study.summit_pull_off
    largest = (residuals**2).max("strip") / (residuals**2).sum("strip")
    return {"pull_off_largest_residual": largest, "largest_residual": largest.where(np.isnan(largest))}


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of places of a probe at its humidities."""
    ground, humidities = plan.devices.ground(at.device), plan.config["devices"][at.device]["humidities"]
    settings = {"pair": ground.pair, "water": plan.air_of_devices.water(ground.pair), "humidities": humidities}
    return select(Settings, GROUND.settings(plan, At(**ground._asdict()), samples=None) | PLACES | settings)


STAGES = (
    Stage.writing(
        "probe_in_full_contact",
        "studies/full_contact/probes/{device}",
        inputs=lambda plan, at: surface_inputs(plan, plan.config["devices"][at.device]["pair"]),
        settings=settings_of,
        kind=Settings,
        compute=lambda data, settings: compute(sides_of(data), settings),
        label="full_contact",
        message="Full elastic contact of probe {device}, beside the sum over summits.",
        running=Running(minutes=120, priority=1),
    ),
    Stage.writing(
        "model_error_of_probes",
        "studies/model_error/probes/{device}",
        inputs=lambda plan, at: {"study": f"studies/full_contact/probes/{at.device}"},
        compute=changes,
        label="model_error_of_devices",
        message="Full elastic contact of probe {device}, over the sum over summits.",
        running=Running(priority=1),
    ),
)

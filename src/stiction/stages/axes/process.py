"""Stage process_point: a device on the surfaces of a process at one value of its variable.

At some values, its slopes by the quantities of the law are computed as well.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.process_law import QUANTITIES, grid, jacobian
from stiction.analysis.shifts import bracketed
from stiction.config.surfaces import process
from stiction.devices.roughness import LARGEST
from stiction.plan.stage import Running, Stage
from stiction.stages.axes import points
from stiction.stages.axes.law import in_order, law_inputs, on_law, slope_of
from stiction.stages.axes.points import DeviceAtPoint, Surfaces
from stiction.stages.axes.requirement import flagged, margins_of
from stiction.stages.surfaces.rough_surfaces import sides_of

#: Fewest intervals between values of the variable of a second process.
SECOND = 4


@dataclass(frozen=True)
class Settings:
    """Settings of a point, without the surfaces and the laws."""

    device: DeviceAtPoint
    value: float  #: of the variable [its unit]
    second: float | None = None  #: of that of a second process [its unit]
    samples: int = 0  #: patches for the slopes, none at values without slopes


def compute(surfaces: Surfaces, laws: Sequence[xr.Dataset], settings: Settings) -> xr.Dataset:
    """Device at a point, with slopes of the margin by the scaled quantities of the laws."""
    descriptions = settings.device.described(surfaces)
    second = settings.value if settings.second is None else settings.second
    values = {str(law.surface): (law, value) for law, value in zip(laws, (settings.value, second), strict=False)}
    change = {surface: on_law(descriptions[surface], *at) for surface, at in values.items()}
    (point,) = settings.device.on(surfaces, [change])
    rms, rms_given = (
        np.hypot(*(surface.rms for surface in each.values())) for each in (descriptions | change, descriptions)
    )
    point = flagged(point, bool(rms < rms_given)).assign(value=settings.value)
    point = point if settings.second is None else point.assign(second=second)
    if not settings.samples:
        return point
    few = settings.device.with_samples(settings.samples)
    slopes = [_slopes(surfaces, change, law, few) for law in laws]
    # ASSUME: slopes are linear between these values: both ends and the middle.
    return point.assign(slopes=(("humidity", "shape", "law_quantity"), np.concatenate(slopes, axis=-1)))


def _slopes(surfaces, change, law, device):
    """Slopes of the margins by the scaled quantities of one law, (n_rh, shapes, q)."""
    surface, names = change[str(law.surface)], list(map(str, law["quantity"].values))
    pairs_of, differences = zip(*(bracketed(surface, name) for name in names), strict=True)
    sides = [change | {str(law.surface): side} for both_sides in pairs_of for side in both_sides]
    margins = np.array([margins_of(point) for point in device.on(surfaces, sides)])
    margins[np.abs(margins) >= LARGEST] = np.nan
    by_plain = (margins[1::2] - margins[::2]) / np.reshape(differences, (-1, 1, 1))
    places = [QUANTITIES.index(name) for name in names]
    at = [np.log(surface.rms), surface.skewness, surface.kurtosis, np.log(surface.spectrum.corner), slope_of(surface)]
    return np.einsum("jhs,jk->hsk", by_plain, jacobian(np.array(at))[np.ix_(places, places)])


# Plan


def values_of(plan: Any, device: str) -> list[float]:
    """Computed values of the variable, within the settings of all processes of a device."""
    processes = plan.config["process"]
    named = process.processes_of(plan.config, device)
    settings = [sorted(setting["value"] for setting in processes[name]["settings"]) for name in named]
    low, high = max(values[0] for values in settings), min(values[-1] for values in settings)
    inside = {value for values in settings for value in values if low <= value <= high}
    return grid(sorted(inside | {low, high})).tolist()


def axes_of(plan: Any, device: str) -> list[list[float]]:
    """Values of the variable, and of the variable of a second process."""
    if not process.is_mapped(plan.config, device):
        return [values_of(plan, device)]
    first, second = (
        sorted(setting["value"] for setting in plan.config["process"][name]["settings"])
        for name in process.processes_of(plan.config, device)
    )
    return [grid(first).tolist(), grid(second, SECOND).tolist()]


def _settings(plan, at):
    """Settings of a point of a device."""
    axes = axes_of(plan, at.device)
    values = points.values_at(at.number, axes)
    settings = {"device": points.settings_of(plan, at.device, _as_rough(plan, at.device, values[0], values[-1]))}
    settings |= dict(zip(("value", "second"), values, strict=False))
    pairs = zip(axes, points.places(at.number, axes), strict=True)
    has_slopes = all(index in (0, (len(axis) - 1) // 2, len(axis) - 1) for axis, index in pairs)
    return settings | ({"samples": plan.config["design"]["budget_samples"]} if has_slopes else {})


def _as_rough(plan, device, *at):
    """Plan with the rms of the surfaces at a value of the variable, on which the length of tips depends.

    It is preliminary: on straight lines through the logarithms at the settings.
    """
    for name, value in zip(process.processes_of(plan.config, device), at, strict=False):
        section, surfaces = plan.config["process"][name], plan.config["surfaces"]
        values = sorted(setting["value"] for setting in section["settings"])
        log_rms = np.log([plan.devices.rms(surface) for surface in in_order(plan, name)])
        entry = {key: kept for key, kept in surfaces[section["surface"]].items() if key != "scans"}
        entry["rms_nm"] = float(np.exp(np.interp(value, values, log_rms)).round(9))
        plan = replace(plan, config=plan.config | {"surfaces": surfaces | {section["surface"]: entry}})
    return plan


STAGES = (
    Stage.writing(
        "process_point",
        "process/points/{device}_{number}",
        inputs=lambda plan, at: points.inputs(plan, at.device) | law_inputs(plan, at.device),
        settings=_settings,
        kind=Settings,
        complete=lambda settings, data: replace(settings, device=settings.device.corrected(data)),
        compute=lambda data, settings: compute(sides_of(data), data["laws"], settings),
        message="Device {device} at value {number} of its process.",
        running=Running(minutes=120),
    ),
)

"""Stage process_curve: margins of a device over a process variable, with the errors of simulation, law and model."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtri

from stiction.config.surfaces import process
from stiction.devices.process import CONFIDENCE, Curve, law_error, run_error
from stiction.devices.roughness import margins
from stiction.plan.stage import Stage
from stiction.stages.process.law import law_inputs, law_of
from stiction.stages.process.points import points_of


@dataclass(frozen=True)
class Settings:
    """Process behind a curve."""

    variable: str  #: name with its unit
    processes: tuple[str, ...]  #: one for each of the laws
    surfaces: tuple[str, ...]  #: that they make


def compute(
    points: Sequence[xr.Dataset], laws: Sequence[xr.Dataset], settings: Settings, model_error: xr.Dataset | None = None
) -> xr.Dataset:
    """Join the points, with the margins to the requirement and the parts of their standard errors.

    The error of the model is that of full elastic contact, if it is known.
    """
    curve = join_points(points, "value", model_error).assign(slopes=_slopes(points))
    known, dims = [law_of(one) for one in laws], ("value", "humidity", "shape")
    of_law, of_run = (np.full(curve.margin.shape, np.nan) for _ in range(2))
    for humidity, shape, one in curves_of(curve):
        at = dict(humidity=humidity, shape=shape)
        places = np.isin(curve.value.values, one.settings)
        of_law[places, *_indices(curve, at)] = law_error(one, known)
        of_run[places, *_indices(curve, at)] = run_error(one, known)
    curve = curve.assign(law_error=(dims, of_law), run_error=(dims, of_run)).assign_coords(labels_of(laws, settings))
    return curve.assign_attrs(variable=settings.variable, surface=" and ".join(settings.surfaces))


def join_points(points: Sequence[xr.Dataset], along: str, model_error: xr.Dataset | None) -> xr.Dataset:
    """Points along a dimension, without slopes, with their margins and the errors of simulation and model."""
    shared = ["required", "share", "samples"]
    over = [point.drop_vars([*shared, "roughness", "slopes"], errors="ignore").set_coords("value") for point in points]
    curve = xr.concat(over, along).assign(points[0][shared])
    required, more_is_better = float(curve.required), curve.required.attrs["units"] == "m"
    margin, safe = (margins(curve[name].values, required, more_is_better) for name in ("estimate", "safe"))
    dims = (along, "humidity", "shape")
    # The bound of a safe value is one-sided: the errors of simulation alone leave it as it is.
    parts = {"simulation": (margin - safe) / ndtri(CONFIDENCE), "model": _model_error(curve, model_error)}
    return curve.assign({"margin": (dims, margin)} | {f"{name}_error": (dims, one) for name, one in parts.items()})


def labels_of(laws: Sequence[xr.Dataset], settings: Settings) -> dict[str, Any]:
    """Process and quantity of each slope."""
    names = [name for name, law in zip(settings.processes, laws, strict=True) for _ in law["quantity"].values]
    quantities = [str(one) for law in laws for one in law["quantity"].values]
    return {"law_process": ("law_quantity", names), "law_quantity": quantities}


def _indices(curve, at):
    """Numbers of a humidity and an end state."""
    return tuple(list(curve[name].values).index(value) for name, value in at.items())


def _slopes(points):
    """Slopes at all points, between those at which they are known. Unknown if they are so everywhere."""
    values = np.array([float(point.value) for point in points])
    known = [(float(point.value), point.slopes.values) for point in points if "slopes" in point]
    places, found = np.array([value for value, _ in known]), np.array([slopes for _, slopes in known])
    flat = found.reshape(len(places), -1)
    filled = np.full((len(values), flat.shape[1]), np.nan)
    for k, column in enumerate(flat.T):
        finite = np.isfinite(column)
        if finite.any():
            filled[:, k] = np.interp(values, places[finite], column[finite])
    dims = ("value", "humidity", "shape", "law_quantity")
    return dims, filled.reshape(len(values), *found.shape[1:]), {"long_name": "of the margin by scaled quantities"}


def _model_error(curve, model_error):
    """Standard error of the margins due to the model: full elastic contact changes them, or errs itself if applied."""
    shape = curve.estimate.shape
    if model_error is None:
        return np.zeros(shape)
    own = model_error.sel(humidity=curve.humidity, shape=curve["shape"]).transpose("humidity", "shape", ...)
    relative = own.factor_error / own.factor
    change = np.log(own.factor).where(~own.applied, 0.0)
    return np.broadcast_to(np.nan_to_num(np.hypot(change, relative).values), shape)


def curves_of(curve: xr.Dataset) -> Iterator[tuple[float, str, Curve]]:
    """Yield humidity, end state and curve wherever at least two neighbouring margins are known.

    ASSUME: an unknown margin between known ones is on a smooth curve through them. Those at the ends are left out.
    """
    for humidity in curve.humidity.values:
        for shape in curve["shape"].values:
            one = curve.sel(humidity=humidity, shape=shape)
            known = np.isfinite(one.margin.values + one.simulation_error.values + one.slopes.values.sum(axis=-1))
            if known.sum() > 1:
                one = one.isel(value=known)
                error = np.hypot(one.simulation_error.values, one.model_error.values)
                arrays = one.value.values, one.margin.values, one.slopes.values, error
                yield float(humidity), str(shape), Curve(*arrays)


def inputs(plan: Any, at: Any) -> dict[str, Any]:
    """Points of a device and laws of its processes, and the error of the model if it is stated."""
    section = plan.config["devices"][at.device]
    is_stated = plan.states_model_error(section["pair"], section["humidities"])
    errors = {"model_error": f"devices/model_error/{at.device}"} if is_stated else {}
    return (
        {"points": [f"process/points/{at.device}_{number}" for number in points_of(plan, at.device)]}
        | law_inputs(plan, at.device)
        | errors
    )


def settings_of(plan: Any, at: Any) -> dict[str, Any]:
    """Processes of a device."""
    named = process.processes_of(plan.config, at.device)
    sections = [plan.config["process"][name] for name in named]
    surfaces = [section["surface"] for section in sections]
    return {"variable": sections[0]["variable"], "processes": named, "surfaces": surfaces}


STAGES = (
    Stage.writing(
        "process_curve",
        "process/curves/{device}",
        inputs=inputs,
        settings=settings_of,
        kind=Settings,
        compute=compute,
        message="Device {device} over its process.",
    ),
)

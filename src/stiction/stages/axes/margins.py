"""Stages process_curve, process_map: margins of a device over one process or two, with their errors by source."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtri

from stiction.config.surfaces import process
from stiction.devices.process import CONFIDENCE, Margins, law_error, run_error
from stiction.plan.stage import Stage
from stiction.stages.axes import points, requirement
from stiction.stages.axes.law import law_inputs, law_of
from stiction.stages.axes.points import joined
from stiction.stages.axes.process import axes_of

#: Parts of the error of a margin of the mean process, in the names of variables.
PARTS = ("simulation", "law", "model")
#: Dimensions of settings, of one process or two, in the order of `stiction.devices.process.Margins`.
_DIMENSIONS = ("second", "value")


def compute(
    points: Sequence[xr.Dataset],
    laws: Sequence[xr.Dataset],
    variables: Sequence[str],
    processes: Sequence[str],
    surfaces: Sequence[str],
    model_error: xr.Dataset | None = None,
) -> xr.Dataset:
    """Join the points, with the margins to the requirement, their slopes and the parts of their standard errors.

    The variables of the axes are names with their units. Each process is that of a law, and makes a surface. The error
    of the model is that of full elastic contact, if it is known.
    """
    over = [dimension for dimension in _DIMENSIONS if dimension in points[0]]
    curve = joined([point.drop_vars("slopes", errors="ignore") for point in points], *over)
    curve = _with_margins(curve, (*over, "humidity", "shape"), model_error)
    curve = curve.assign(slopes=_slopes(points, curve, over)).assign_coords(_labels(laws, processes))
    fitted = [law_of(law) for law in laws]
    errors = {"law_error": xr.full_like(curve.margin, np.nan), "run_error": xr.full_like(curve.margin, np.nan)}
    for at, margins in known_margins(curve):
        places = at | dict(zip(over, margins.axes, strict=True))
        errors["law_error"].loc[places] = law_error(margins, fitted)
        errors["run_error"].loc[places] = run_error(margins, fitted)
    of_axes = dict(zip(("variable", "second_variable"), variables, strict=False))
    return curve.assign(errors).assign_attrs(of_axes | {"surface": " and ".join(surfaces)})


def _with_margins(points, dims, model_error):
    """Points with their margins and the errors of simulation and model."""
    margin, safe = (requirement.margins_of(points, name) for name in ("estimate", "safe"))
    # The bound of a safe value is one-sided: the errors of simulation alone leave it as it is.
    errors = {"simulation": (margin - safe) / ndtri(CONFIDENCE), "model": _model_error(points, model_error)}
    return points.assign(
        {"margin": (dims, margin)} | {f"{name}_error": (dims, error) for name, error in errors.items()}
    )


def _labels(laws: Sequence[xr.Dataset], processes: Sequence[str]) -> dict[str, Any]:
    """Process and quantity of each slope."""
    names = [name for name, law in zip(processes, laws, strict=True) for _ in law["quantity"].values]
    quantities = [str(quantity) for law in laws for quantity in law["quantity"].values]
    return {"law_process": ("law_quantity", names), "law_quantity": quantities}


def _slopes(points, curve, over):
    """Slopes at all points, linear between those at which they are known. Unknown if they are so everywhere."""
    sloped = [point for point in points if "slopes" in point]
    axes = [np.unique([float(point[dimension]) for point in sloped]) for dimension in over]
    slopes = np.reshape([point.slopes.values for point in sloped], (*map(len, axes), *sloped[0].slopes.shape))
    for number, (places, dimension) in enumerate(zip(axes, over, strict=True)):
        slopes = np.apply_along_axis(_between, number, slopes, places, curve[dimension].values)
    dims = (*over, "humidity", "shape", "law_quantity")
    return dims, slopes


def _between(values, places, others):
    """Values (n,) at places (n,), linearly between the known ones at others (m,)."""
    is_known = np.isfinite(values)
    return np.interp(others, places[is_known], values[is_known]) if is_known.any() else np.full(len(others), np.nan)


def _model_error(points, model_error):
    """Standard error of the margins due to the model: full elastic contact changes them, or errs itself if applied."""
    shape = points.estimate.shape
    if model_error is None:
        return np.zeros(shape)
    of_points = model_error.sel(humidity=points.humidity, shape=points["shape"]).transpose("humidity", "shape", ...)
    relative = of_points.factor_error / of_points.factor
    change = np.log(of_points.factor).where(~of_points.applied, 0.0)
    return np.broadcast_to(np.nan_to_num(np.hypot(change, relative).values), shape)


def known_margins(curve: xr.Dataset) -> Iterator[tuple[dict[str, Any], Margins]]:
    """Yield coordinates of humidity and end state with the margins at all pairs, or at two settings or more.

    ASSUME: an unknown margin between known ones is on a smooth curve through them. Those at the ends are left out.
    """
    over = [dimension for dimension in _DIMENSIONS if dimension in curve.dims]
    for humidity in curve.humidity.values:
        for shape in curve["shape"].values:
            at = {"humidity": float(humidity), "shape": str(shape)}
            of_shape = curve.sel(at)
            is_known = np.isfinite(
                of_shape.margin.values + of_shape.simulation_error.values + of_shape.slopes.values.sum(axis=-1)
            )
            of_shape = of_shape.isel(value=is_known) if is_known.ndim == 1 else of_shape
            if is_known.all() or of_shape.sizes["value"] > 1 == is_known.ndim:
                error = np.hypot(of_shape.simulation_error.values, of_shape.model_error.values)
                axes = tuple(of_shape[dimension].values for dimension in over)
                yield at, Margins(axes, of_shape.margin.values, of_shape.slopes.values, error)


def inputs(plan: Any, at: Any) -> dict[str, Any]:
    """Points of a device and laws of its processes, and the error of the model if it is stated."""
    is_stated = plan.states_error_of_device(at.device)
    errors = {"model_error": f"devices/model_error/{at.device}"} if is_stated else {}
    return (
        {"points": points.names("process/points", at.device, axes_of(plan, at.device))}
        | law_inputs(plan, at.device)
        | errors
    )


def settings_of(plan: Any, at: Any) -> dict[str, Any]:
    """Processes of a device, which have the same variable unless it has two axes."""
    named = process.processes_of(plan.config, at.device)
    sections = [plan.config["process"][name] for name in named]
    surfaces = [section["surface"] for section in sections]
    axes = 1 + process.is_mapped(plan.config, at.device)
    variables = [section["variable"] for section in sections[:axes]]
    return {"variables": variables, "processes": named, "surfaces": surfaces}


def _stage(name, folder, over):
    """Stage of the margins of a device over one process or two."""
    return Stage.writing(
        name,
        f"process/{folder}/{{device}}",
        inputs=inputs,
        settings=settings_of,
        compute=compute,
        message=f"Device {{device}} over {over}.",
    )


STAGES = (_stage("process_curve", "curves", "its process"), _stage("process_map", "maps", "two processes"))

"""Stages process_map, process_pairs: margins of a device over two processes, and sufficient pairs of settings."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import RegularGridInterpolator

from stiction.devices.process import PAIRS, Map, Pairs, law_error, recommended_pairs, run_error, unknown
from stiction.devices.roughness import sufficient
from stiction.plan.stage import Stage
from stiction.stages.process.curves import Settings, inputs, join_points, labels_of, settings_of
from stiction.stages.process.law import law_inputs, law_of
from stiction.streams import stream


def compute(
    points: Sequence[xr.Dataset], laws: Sequence[xr.Dataset], settings: Settings, model_error: xr.Dataset | None = None
) -> xr.Dataset:
    """Margins of a device at all points, with their slopes and the parts of their standard errors.

    The points are at one setting of the second process after the other.
    """
    seconds, values = (np.unique([float(point[name]) for point in points]) for name in ("second", "value"))
    flat = [point.drop_vars("second") for point in points]
    rows = [join_points(flat[k : k + len(values)], "value", model_error) for k in range(0, len(flat), len(values))]
    over = [name for name in rows[0].data_vars if "value" in rows[0][name].dims]
    found = xr.concat(rows, "second", data_vars=over, coords="minimal", compat="equals", join="exact")
    dims = ("second", "value", "humidity", "shape")
    slopes = (*dims, "law_quantity"), _slopes(points, seconds, values)
    found = found.assign_coords(second=seconds, **labels_of(laws, settings)).assign(slopes=slopes)
    known = [law_of(one) for one in laws]
    of_law, of_run = (np.full([found.sizes[name] for name in dims], np.nan) for _ in range(2))
    for (humidity, shape), one in _maps(found):
        rows = one.at(values, seconds)
        of_law[:, :, humidity, shape] = [law_error(curve, known) for curve in rows]
        of_run[:, :, humidity, shape] = [run_error(curve, known) for curve in rows]
    attrs = {"variable": settings.variable, "second_variable": laws[1].variable}
    errors = {"law_error": (dims, of_law), "run_error": (dims, of_run)}
    return found.assign(errors).assign_attrs(attrs | {"surface": " and ".join(settings.surfaces)})


def _slopes(points, seconds, values):
    """Slopes at all points, linear in both settings between the points that have them."""
    known = [point for point in points if "slopes" in point]
    axes = [np.unique([float(point[name]) for point in known]) for name in ("second", "value")]
    first = known[0].slopes.values
    slopes = np.reshape([point.slopes.values for point in known], (*map(len, axes), *first.shape))
    return RegularGridInterpolator(axes, slopes)(np.stack(np.meshgrid(seconds, values, indexing="ij"), axis=-1))


def _maps(found: xr.Dataset) -> Iterator[tuple[tuple[int, int], Map]]:
    """Yield numbers of humidity and end state, and the map, wherever all margins are known."""
    error = np.hypot(found.simulation_error.values, found.model_error.values)
    for humidity, shape in np.ndindex(found.sizes["humidity"], found.sizes["shape"]):
        at = (slice(None), slice(None), humidity, shape)
        arrays = found.margin.values[at], found.slopes.values[at], error[at]
        if all(np.isfinite(one).all() for one in arrays):
            yield (humidity, shape), Map(found["value"].values, found.second.values, *arrays)


def recommended(found: xr.Dataset, laws: Sequence[xr.Dataset], device: str, seed: int) -> xr.Dataset:
    """Sufficient pairs of settings for a device, and the best one. They are unknown with their margin."""
    maps, known = [one for _, one in _maps(found)], [law_of(one) for one in laws]
    if len(maps) < found.sizes["humidity"] * found.sizes["shape"]:
        pairs = unknown(np.linspace(*known[0].ends, PAIRS), known[1].settings)
    else:
        errors = [law.errors.values.mean(axis=0) for law in laws]
        pairs = recommended_pairs(maps, known, errors, stream(seed, "process", "pairs", device))
    return layout(pairs, found, known[1].settings)


def layout(pairs: Pairs, found: xr.Dataset, settings: np.ndarray) -> xr.Dataset:
    """Dataset of recommended pairs, with variables and share of the map, and the settings of the second process."""
    over = ("second", "value")
    return xr.Dataset(
        {
            "margin": (over, pairs.margin, {"long_name": "smallest margin"}),
            "safe": (over, pairs.safe, {"long_name": "margin of the next runs with 95 % confidence"}),
            "safe_mean": (over, pairs.safe_mean, {"long_name": "margin of the mean processes with 95 % confidence"}),
            "best": ("process", pairs.best, {"long_name": "pair of settings with the largest margin"}),
            "best_error": ("process", pairs.error),
            "best_interval": (("process", "end"), pairs.interval),
            "next": ("process", pairs.next, {"long_name": "setting to measure next"}),
            "next_again": ("process", pairs.again),
            "next_after": ("process", pairs.after, {"long_name": "expected error of the best setting then"}),
            "second_settings": ("setting", settings),
            "share": found.share,
        },
        coords={"second": pairs.seconds, "value": pairs.settings, "end": ["low", "high"]},
        attrs={name: found.attrs[name] for name in ("variable", "second_variable")},
    )


def settings_of_processes(pairs: xr.Dataset) -> list[xr.Dataset]:
    """Settings of each process: all sufficient ones at some setting of the other process, and the best.

    Their variables are as in a dataset of `stiction.stages.process.recommended`.
    """
    axes = (("value", "second", "variable"), ("second", "value", "second_variable"))
    return [_settings_of_process(pairs, number, *names) for number, names in enumerate(axes)]


def _settings_of_process(pairs, number, own, other, variable):
    """Settings of one process."""
    ranges, of_mean = (
        np.reshape(sufficient(pairs[own].values, pairs[name].max(other, skipna=False).values), (-1, 2))
        for name in ("safe", "safe_mean")
    )
    named = ("best", "best_error", "best_interval", "next", "next_again", "next_after")
    best = {name: pairs[name].isel(process=number) for name in named}
    best |= {"next_before": best["best_error"], "next_subject": xr.DataArray("best")}
    places = {"value": ("place", pairs[own].values), "sufficient": (("range", "end"), ranges)}
    places |= {"sufficient_mean": (("mean_range", "end"), of_mean)}
    return xr.Dataset(
        places | {name: one.variable for name, one in best.items()}, attrs={"variable": pairs.attrs[variable]}
    )


def _pairs_inputs(plan: Any, at: Any) -> dict[str, Any]:
    """Map of a device and the laws of its processes."""
    return {"map": f"process/maps/{at.device}"} | law_inputs(plan, at.device)


STAGES = (
    Stage.writing(
        "process_map",
        "process/maps/{device}",
        inputs=inputs,
        settings=settings_of,
        kind=Settings,
        compute=compute,
        message="Device {device} over two processes.",
    ),
    Stage.writing(
        "process_pairs",
        "process/pairs/{device}",
        inputs=_pairs_inputs,
        settings=lambda plan, at: {"seed": plan.config["seed"]},
        compute=lambda data, at, settings: recommended(data["map"], data["laws"], at.device, settings["seed"]),
        message="Recommended pairs of settings for {device}.",
    ),
)

"""Stages process_settings, process_pairs: sufficient settings of one process or two, the best, the next to measure."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.process_law import Law
from stiction.config.surfaces import process
from stiction.devices.process import PAIRS, SETTINGS, Recommendation, recommended, unknown
from stiction.devices.roughness import sufficient
from stiction.plan.names import by_name
from stiction.plan.stage import Stage
from stiction.stages.axes.law import law_inputs, law_of
from stiction.stages.axes.margins import known_margins
from stiction.streams import stream

#: All devices of a variable together, beside each of them.
ALL = "all devices"
#: Numbers of a best setting and of the next one to measure.
_NUMBERS = ("best", "best_error", "best_interval", "next", "next_again", "next_after")


def compute(curves: Mapping[str, xr.Dataset], laws: Mapping[str, xr.Dataset], variable: str, seed: int) -> xr.Dataset:
    """Recommended settings for each device by name, and for all together if there are several.

    All devices have the same drawn laws.
    """
    groups = {name: [curve] for name, curve in curves.items()}
    groups |= {ALL: list(curves.values())} if len(curves) > 1 else {}
    settings = {
        name: layout(_recommended(group, laws, stream(seed, "process", variable))) for name, group in groups.items()
    }
    who = xr.DataArray(list(settings), dims="who", name="who")
    shares = [float(curves[name].share) if name in curves else np.nan for name in settings]
    joined = xr.concat(_padded_to_one_size(settings.values()), who)
    return joined.assign(share=("who", shares)).assign_attrs(variable=variable)


def of_pairs(curves: xr.Dataset, laws: Iterable[xr.Dataset], device: str, seed: int) -> xr.Dataset:
    """Sufficient pairs of settings for a device, and the best one. They are unknown with their margin."""
    laws = dict(zip(dict.fromkeys(map(str, curves.law_process.values)), laws, strict=True))
    pairs = _recommended([curves], laws, stream(seed, "process", "pairs", device))
    _, second = laws.values()
    measured = {"second_settings": ("setting", second.setting.values), "share": curves.share}
    variables = {name: curves.attrs[name] for name in ("variable", "second_variable")}
    return layout(pairs).assign(measured).assign_attrs(variables)


def _recommended(curves, laws, rng):
    """Recommended settings for some devices together."""
    laws_by_name = {name: law_of(dataset) for name, dataset in laws.items()}
    parts = [
        replace(margins, slopes=_by_laws(curve, margins.slopes, laws_by_name))
        for curve in curves
        for _, margins in known_margins(curve)
    ]
    if len(parts) < sum(curve.sizes["humidity"] * curve.sizes["shape"] for curve in curves):
        first, *others = laws_by_name.values()
        if "second" in curves[0].dims:
            return unknown(others[0].settings, np.linspace(*first.ends, PAIRS))
        return unknown(np.linspace(*first.ends, SETTINGS))
    errors = [law.errors.values.mean(axis=0) for law in laws.values()]
    return recommended(parts, list(laws_by_name.values()), errors, rng)


def _by_laws(curve: xr.Dataset, slopes: np.ndarray, laws: Mapping[str, Law]) -> np.ndarray:
    """Slopes by the quantities of all laws, zero by those of others than the device's."""
    process_of_slope = curve.law_process.values
    parts = [
        slopes[..., process_of_slope == name]
        if (process_of_slope == name).any()
        else np.zeros((*slopes.shape[:-1], len(law.coefficients)))
        for name, law in laws.items()
    ]
    return np.concatenate(parts, axis=-1)


def _padded_to_one_size(datasets):
    """Datasets with as many ranges and crossings each: those missing are NaN."""
    sizes = {
        name: range(max(dataset.sizes[name] for dataset in datasets)) for name in ("range", "mean_range", "crossings")
    }
    return [
        dataset.assign_coords({name: range(dataset.sizes[name]) for name in sizes}).reindex(sizes)
        for dataset in datasets
    ]


def layout(advice: Recommendation) -> xr.Dataset:
    """Dataset of one recommendation: of pairs, or of settings with the ranges that suffice."""
    are_pairs = len(advice.axes) > 1
    over, each = (("second", "value"), ("process",)) if are_pairs else (("place",), ())
    numbers = (
        advice.best,
        advice.error,
        advice.interval,
        advice.next,
        advice.again,
        advice.after,
    )
    common = {
        "margin": (over, advice.margin),
        "safe": (over, advice.safe),
        "safe_mean": (over, advice.safe_mean),
    } | {
        name: ((*each, "end") if name == "best_interval" else each, values if are_pairs else values[0])
        for name, values in zip(_NUMBERS, numbers, strict=True)
    }
    coords = {"end": ["low", "high"]} | (dict(zip(over, advice.axes, strict=True)) if are_pairs else {})
    return xr.Dataset(common | ({} if are_pairs else _along_one(advice)), coords)


def _along_one(advice):
    """Variables of the settings of one process."""
    places = np.reshape([(crossing.coordinate, crossing.error) for crossing in advice.crossings], (-1, 2))
    return {
        "value": ("place", *advice.axes),
        "band": (("end", "place"), advice.band),
        "crossing": ("crossings", places[:, 0]),
        "crossing_error": ("crossings", places[:, 1]),
        "next_subject": ((), advice.subject),
        "next_before": ((), advice.before[0]),
    } | _ranges(advice.sufficient, advice.sufficient_mean)


def _ranges(of_run, of_mean):
    """Variables of the ranges that suffice for the next run and for the mean process."""
    return {
        "sufficient": (("range", "end"), np.reshape(of_run, (-1, 2))),
        "sufficient_mean": (("mean_range", "end"), np.reshape(of_mean, (-1, 2))),
    }


def settings_of_processes(pairs: xr.Dataset) -> list[xr.Dataset]:
    """Settings of each process: all sufficient ones at some setting of the other process, and the best.

    Their variables are those of the settings of one process.
    """
    axes = (("value", "second", "variable"), ("second", "value", "second_variable"))
    return [_settings_of_process(pairs, number, *names) for number, names in enumerate(axes)]


def _settings_of_process(pairs, number, axis, other, variable):
    """Settings of one process."""
    ranges = (
        sufficient(pairs[axis].values, pairs[name].max(other, skipna=False).values) for name in ("safe", "safe_mean")
    )
    best = {name: pairs[name].isel(process=number).variable for name in _NUMBERS}
    best |= {"next_before": best["best_error"], "next_subject": ((), "best")}
    places = {"value": ("place", pairs[axis].values)}
    return xr.Dataset(places | _ranges(*ranges) | best, attrs={"variable": pairs.attrs[variable]})


def devices_over(plan: Any, variable: str) -> list[str]:
    """Devices over the processes with a variable."""
    processes = plan.config.get("process", {})
    return [
        name
        for name in plan.devices.over_process
        if any(processes[each]["variable"] == variable for each in process.processes_of(plan.config, name))
    ]


def variables(plan: Any) -> list[str]:
    """Variables of the processes of devices."""
    processes = plan.config.get("process", {})
    return list(
        dict.fromkeys(section["variable"] for section in processes.values() if devices_over(plan, section["variable"]))
    )


def _inputs(plan, at):
    """Curves of the devices over a variable, and the laws of their processes."""
    devices = devices_over(plan, at.variable)
    named = dict.fromkeys(each for name in devices for each in process.processes_of(plan.config, name))
    return {"curves": by_name("process/curves", devices), "laws": by_name("process/laws", named)}


def _seed(plan, _at):
    """Seed of the drawn laws."""
    return {"seed": plan.config["seed"]}


STAGES = (
    Stage.writing(
        "process_settings",
        "process/settings/{variable}",
        inputs=_inputs,
        settings=_seed,
        compute=lambda data, at, settings: compute(data["curves"], data["laws"], at.variable, settings["seed"]),
        message="Recommended {variable}.",
    ),
    Stage.writing(
        "process_pairs",
        "process/pairs/{device}",
        inputs=lambda plan, at: {"map": f"process/maps/{at.device}"} | law_inputs(plan, at.device),
        settings=_seed,
        compute=lambda data, at, settings: of_pairs(data["map"], data["laws"], at.device, settings["seed"]),
        message="Recommended pairs of settings for {device}.",
    ),
)

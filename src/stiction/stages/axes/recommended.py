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
    found = {name: layout(_recommended(of, laws, stream(seed, "process", variable))) for name, of in groups.items()}
    who = xr.DataArray(list(found), dims="who", name="who")
    shares = [float(curves[name].share) if name in curves else np.nan for name in found]
    joined = xr.concat(_padded_to_one_size(found.values()), who)
    return joined.assign(share=("who", shares)).assign_attrs(variable=variable)


def of_pairs(found: xr.Dataset, laws: Iterable[xr.Dataset], device: str, seed: int) -> xr.Dataset:
    """Sufficient pairs of settings for a device, and the best one. They are unknown with their margin."""
    laws = dict(zip(dict.fromkeys(map(str, found.law_process.values)), laws, strict=True))
    pairs = _recommended([found], laws, stream(seed, "process", "pairs", device))
    _, second = laws.values()
    measured = {"second_settings": ("setting", second.setting.values), "share": found.share}
    variables = {name: found.attrs[name] for name in ("variable", "second_variable")}
    return layout(pairs).assign(measured).assign_attrs(variables)


def _recommended(found, laws, rng):
    """Recommended settings for some devices together."""
    known = {name: law_of(one) for name, one in laws.items()}
    parts = [replace(one, slopes=_by_laws(of, one.slopes, known)) for of in found for _, one in known_margins(of)]
    if len(parts) < sum(of.sizes["humidity"] * of.sizes["shape"] for of in found):
        first, *others = known.values()
        if "second" in found[0].dims:
            return unknown(others[0].settings, np.linspace(*first.ends, PAIRS))
        return unknown(np.linspace(*first.ends, SETTINGS))
    errors = [law.errors.values.mean(axis=0) for law in laws.values()]
    return recommended(parts, list(known.values()), errors, rng)


def _by_laws(found: xr.Dataset, slopes: np.ndarray, laws: Mapping[str, Law]) -> np.ndarray:
    """Slopes by the quantities of all laws, zero by those of others than the device's."""
    of = found.law_process.values
    parts = [
        slopes[..., of == name] if (of == name).any() else np.zeros((*slopes.shape[:-1], len(law.coefficients)))
        for name, law in laws.items()
    ]
    return np.concatenate(parts, axis=-1)


def _padded_to_one_size(found):
    """Datasets with as many ranges and crossings each: those missing are NaN."""
    sizes = {name: range(max(one.sizes[name] for one in found)) for name in ("range", "mean_range", "crossings")}
    return [one.assign_coords({name: range(one.sizes[name]) for name in sizes}).reindex(sizes) for one in found]


def layout(found: Recommendation) -> xr.Dataset:
    """Dataset of one recommendation: of pairs, or of settings with the ranges that suffice."""
    are_pairs = len(found.axes) > 1
    over, each = (("second", "value"), ("process",)) if are_pairs else (("place",), ())
    numbers = (found.best, found.error, found.interval, found.next, found.again, found.after)
    common = {
        "margin": (over, found.margin, {"long_name": "smallest margin"}),
        "safe": (over, found.safe, {"long_name": "margin of the next run with 95 % confidence"}),
        "safe_mean": (over, found.safe_mean, {"long_name": "margin of the mean process with 95 % confidence"}),
    } | {
        name: ((*each, "end") if name == "best_interval" else each, values if are_pairs else values[0])
        for name, values in zip(_NUMBERS, numbers, strict=True)
    }
    coords = {"end": ["low", "high"]} | (dict(zip(over, found.axes, strict=True)) if are_pairs else {})
    return xr.Dataset(common | ({} if are_pairs else _along_one(found)), coords)


def _along_one(found):
    """Variables of the settings of one process."""
    places = np.reshape([(one.place, one.error) for one in found.crossings], (-1, 2))
    return {
        "value": ("place", *found.axes, {"long_name": "of the variable"}),
        "band": (("end", "place"), found.band, {"long_name": "95 % band of the margin of the mean process"}),
        "crossing": ("crossings", places[:, 0]),
        "crossing_error": ("crossings", places[:, 1]),
        "next_subject": ((), found.subject),
        "next_before": ((), found.before[0]),
    } | _ranges(found.sufficient, found.sufficient_mean)


def _ranges(of_run, of_mean):
    """Variables of the ranges that suffice for the next run and for the mean process."""
    return {
        "sufficient": (("range", "end"), np.reshape(of_run, (-1, 2)), {"long_name": "next run"}),
        "sufficient_mean": (("mean_range", "end"), np.reshape(of_mean, (-1, 2)), {"long_name": "mean process"}),
    }


def settings_of_processes(pairs: xr.Dataset) -> list[xr.Dataset]:
    """Settings of each process: all sufficient ones at some setting of the other process, and the best.

    Their variables are those of the settings of one process.
    """
    axes = (("value", "second", "variable"), ("second", "value", "second_variable"))
    return [_settings_of_process(pairs, number, *names) for number, names in enumerate(axes)]


def _settings_of_process(pairs, number, own, other, variable):
    """Settings of one process."""
    ranges = (
        sufficient(pairs[own].values, pairs[name].max(other, skipna=False).values) for name in ("safe", "safe_mean")
    )
    best = {name: pairs[name].isel(process=number).variable for name in _NUMBERS}
    best |= {"next_before": best["best_error"], "next_subject": ((), "best")}
    places = {"value": ("place", pairs[own].values)}
    return xr.Dataset(places | _ranges(*ranges) | best, attrs={"variable": pairs.attrs[variable]})


def devices_over(plan: Any, variable: str) -> list[str]:
    """Devices over the processes with a variable."""
    known = plan.config.get("process", {})
    return [
        name
        for name in plan.devices.over_process
        if any(known[one]["variable"] == variable for one in process.processes_of(plan.config, name))
    ]


def variables(plan: Any) -> list[str]:
    """Variables of the processes of devices."""
    known = plan.config.get("process", {})
    return list(
        dict.fromkeys(section["variable"] for section in known.values() if devices_over(plan, section["variable"]))
    )


def _inputs(plan, at):
    """Curves of the devices over a variable, and the laws of their processes."""
    devices = devices_over(plan, at.variable)
    named = dict.fromkeys(one for name in devices for one in process.processes_of(plan.config, name))
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

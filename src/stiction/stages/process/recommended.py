"""Stage process_settings: sufficient settings of a process for its devices, the best one, the next to measure."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.surfaces import process
from stiction.devices.process import SETTINGS, Recommendation, recommended, unknown
from stiction.plan.names import by_name
from stiction.plan.stage import Stage
from stiction.stages.process.curves import curves_of
from stiction.stages.process.law import law_of
from stiction.streams import stream

#: All devices of a variable together, beside each of them.
ALL = "all devices"


def compute(curves: Mapping[str, xr.Dataset], laws: Mapping[str, xr.Dataset], variable: str, seed: int) -> xr.Dataset:
    """Recommended settings for each device by name, and for all together if there are several.

    All devices have the same drawn laws.
    """
    groups = {name: {name: curve} for name, curve in curves.items()}
    groups |= {ALL: curves} if len(curves) > 1 else {}
    found = {name: layout(_recommended(of, laws, variable, seed)) for name, of in groups.items()}
    who = xr.DataArray(list(found), dims="who", name="who")
    shares = [float(curves[name].share) if name in curves else np.nan for name in found]
    return (
        xr.concat(_padded_to_one_size(found.values()), who)
        .assign(share=("who", shares))
        .assign_attrs(variable=variable)
    )


def _padded_to_one_size(found):
    """Datasets with as many ranges and crossings each: those missing are NaN."""
    sizes = {name: range(max(one.sizes[name] for one in found)) for name in ("range", "mean_range", "crossings")}
    return [one.assign_coords({name: range(one.sizes[name]) for name in sizes}).reindex(sizes) for one in found]


def _recommended(curves, laws, variable, seed):
    """Recommended settings for some devices together."""
    known, names = {name: law_of(one) for name, one in laws.items()}, list(laws)
    parts = [
        replace(one, slopes=_by_laws(curve, one.slopes, known))
        for curve in curves.values()
        for _, _, one in curves_of(curve)
    ]
    if len(parts) < sum(curve.sizes["humidity"] * curve.sizes["shape"] for curve in curves.values()):
        return unknown(np.linspace(*next(iter(known.values())).ends, SETTINGS))
    errors = [laws[name].errors.values.mean(axis=0) for name in names]
    return recommended(parts, list(known.values()), errors, stream(seed, "process", variable))


def _by_laws(curve, slopes, laws):
    """Slopes by the quantities of all laws, zero by those of others than the device's."""
    of = curve.law_process.values
    parts = [
        slopes[:, of == name] if (of == name).any() else np.zeros((len(slopes), len(law.coefficients)))
        for name, law in laws.items()
    ]
    return np.concatenate(parts, axis=1)


def layout(found: Recommendation) -> xr.Dataset:
    """Dataset of one recommendation."""
    ranges, of_mean = (np.reshape(some, (-1, 2)) for some in (found.sufficient, found.sufficient_mean))
    places = np.reshape([(one.place, one.error) for one in found.crossings], (-1, 2))
    return xr.Dataset(
        {
            "value": ("place", found.settings, {"long_name": "of the variable"}),
            "margin": ("place", found.margin, {"long_name": "smallest margin"}),
            "band": (("end", "place"), found.band, {"long_name": "95 % band of the margin of the mean process"}),
            "safe": ("place", found.safe, {"long_name": "margin of the next run with 95 % confidence"}),
            "safe_mean": ("place", found.safe_mean, {"long_name": "margin of the mean process with 95 % confidence"}),
            "sufficient": (("range", "end"), ranges, {"long_name": "next run"}),
            "sufficient_mean": (("mean_range", "end"), of_mean, {"long_name": "mean process"}),
            "crossing": ("crossings", places[:, 0]),
            "crossing_error": ("crossings", places[:, 1]),
            "best": ((), found.best),
            "best_error": ((), found.error),
            "best_interval": ("end", list(found.interval)),
            "next": ((), found.next),
            "next_again": ((), found.again),
            "next_subject": ((), found.subject),
            "next_before": ((), found.before),
            "next_after": ((), found.after),
        },
        coords={"end": ["low", "high"]},
    )


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


STAGES = (
    Stage.writing(
        "process_settings",
        "process/settings/{variable}",
        inputs=_inputs,
        settings=lambda plan, at: {"seed": plan.config["seed"]},
        compute=lambda data, at, settings: compute(data["curves"], data["laws"], at.variable, settings["seed"]),
        message="Recommended {variable}.",
    ),
)

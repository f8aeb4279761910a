"""Tables along an axis: devices over the roughness of a surface, over a process, and over two processes."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
import xarray as xr

from stiction.answer.sought import LENGTH
from stiction.plan.names import by_name
from stiction.report.axes import process, roughness
from stiction.report.axes.axis import axes_of
from stiction.report.format import UM, bounding, with_band, with_error
from stiction.report.table import DEVICE, Line, Table, Term, table_stage
from stiction.stages.axes.law import law_inputs
from stiction.stages.axes.margins import PARTS
from stiction.stages.axes.recommended import ALL, variables
from stiction.stages.axes.requirement import sought_of
from stiction.stages.axes.roughness import KURTOSIS
from stiction.stages.devices.end_states import END_STATES


def of_roughness(datasets: Mapping[str, xr.Dataset]) -> Table:
    """Lengths or forces of devices over the roughness: a row per device, humidity, end state and roughness.

    The datasets are by name of the device.
    """
    rows = [row for device, dataset in datasets.items() for row in _rows(device, dataset)]
    sentences = [
        f"{device}: {sentence}" for device, dataset in datasets.items() for sentence in roughness.answers(dataset)
    ]
    shows = (
        "Simulated limit of a length, or of a restoring force, against the roughness of a surface: with a "
        "confidence of 95 % (of a stopper: given the drawn surfaces), at most a fraction p sticks.",
        Term("Estimate", "a fraction p sticks, ± standard error due to the numbers of devices and of drawn surfaces."),
        Term("P(stuck)", "at the required length or force, with its 95 % band."),
        roughness.form(*datasets.values()),
        Term("Devices", "number of simulated devices at every roughness."),
        *map(Line, sentences),
    )
    shown = {"and": "other", KURTOSIS: KURTOSIS}
    columns = {
        name: column
        for name, column in _OF_ROUGHNESS.items()
        if name not in shown or any(shown[name] in row for row in rows)
    }
    return Table.from_rows(rows, shows, columns)


def of_processes(
    curves: Mapping[str, xr.Dataset], recommended: Sequence[xr.Dataset], laws: Mapping[str, Sequence[xr.Dataset]]
) -> Table:
    """Margins of devices over process variables: a row per device, humidity, end state and setting."""
    sentences = [
        sentence if who == ALL else f"{who}: {sentence}"
        for advice in recommended
        for who in map(str, advice.who.values)
        for sentence in process.answers(advice, who)
    ]
    return _of_margins(curves, laws, sentences, "a process makes at values of its variable")


def of_pairs(
    maps: Mapping[str, xr.Dataset], pairs: Mapping[str, xr.Dataset], laws: Mapping[str, Sequence[xr.Dataset]]
) -> Table:
    """Margins of devices over two processes: a row per device, humidity, end state and pair of settings."""
    sentences = [
        f"{name}: {sentence}"
        for name, pairs_of_device in pairs.items()
        for sentence in process.answers_of_pairs(pairs_of_device)
    ]
    return _of_margins(maps, laws, sentences, "two processes make at values of their variables")


def _of_margins(curves, laws, sentences, makes):
    """Table of margins over processes, with sentences, and what the processes make in words."""
    sentences += dict.fromkeys(
        sentence for device, curve in curves.items() for sentence in process.notes(curve, laws[device])
    )
    rows = [row for device, curve in curves.items() for row in _rows(device, curve)]
    caption = (
        "Length of a beam, or restoring force of a stopper, with the allowed fraction p stuck, on the surfaces that "
        f"{makes}, and its margin to the required one: the logarithm of their ratio, positive where the requirement is "
        "met. Errors of the margin are due to the simulation, to the law of the surface at and between the measured "
        "settings, and to full elastic contact if it is computed. The next run scatters about the mean process as well."
    )
    is_map = any("second_value" in row for row in rows)
    columns = {name: column for name, column in _OF_PROCESSES.items() if is_map or name not in _SECOND}
    return Table.from_rows(rows, [caption, *map(Line, sentences)], columns)


def _rows(device: str, curves: xr.Dataset) -> Iterator[dict]:
    """Numbers of a device, along one curve after the other."""
    along, *others = axes_of(curves)
    second = [others[0].dimension] if others else []
    dimensions = [*second, "humidity", "shape", along.dimension]
    for at in product(*(curves[dimension].values for dimension in dimensions)):
        point = curves.sel(dict(zip(dimensions, at, strict=True)))
        yield _row(device, point, along) | (_other(others[0], at[0]) if others else {}) | _kurtosis_of(point)


def _row(device, point, along):
    """Numbers of a device at a point of an axis."""
    is_rough = along.is_quantity
    stuck = dict(
        zip(("stuck_percent", "stuck_low_percent", "stuck_high_percent"), 100 * point.stuck.values, strict=True)
    )
    return (
        {
            "device": device,
            "relative_humidity": float(point.humidity),
            "held_by": END_STATES[str(point["shape"].values)].by,
        }
        | ({"varied": along.label} if is_rough else {"variable": along.name})
        | {"value": float(along.in_unit(point[along.dimension])), "share": float(point.share)}
        | {"unit": sought_of(point).shown}
        | ({"safe": float(point.safe) / UM} if is_rough else {})
        | {"estimate": float(point.estimate) / UM, "estimate_se": float(point.error) / UM}
        | {"required": float(point.required) / UM}
        | ({} if is_rough else _margins(point))
        | {name: float(percent) for name, percent in stuck.items()}
        | ({"devices": int(point.samples)} if is_rough else {})
    )


def _margins(point):
    """Margin at a point with its errors by source."""
    parts = {name: float(point[f"{name}_error"]) for name in (*PARTS, "run")}
    of_mean = float(np.hypot(np.hypot(parts["simulation"], parts["law"]), parts["model"]))
    errors = {"margin_se": of_mean, "margin_of_run_se": float(np.hypot(of_mean, parts["run"]))}
    return {"margin": float(point.margin)} | errors | {f"{name}_se": error for name, error in parts.items()}


def _other(axis, value):
    """Value along the second axis of a map."""
    if axis.is_quantity:
        return {"other": axis.label, "other_value": float(axis.in_unit(value))}
    return {"second_variable": axis.name, "second_value": float(value)}


def _kurtosis_of(point):
    """Kurtosis of a skewness, nothing for others."""
    return {KURTOSIS: float(point[KURTOSIS])} if KURTOSIS in point else {}


def _second(name, value):
    """Value of a second quantity, if there is one."""
    return f"{name}: {value:.3g}" if isinstance(name, str) else ""


def _kurtosis(value):
    """Kurtosis of a skewness, if one is varied."""
    return "" if np.isnan(value) else f"{value:.3g}"


_STUCK = {"P(stuck) [%]": (with_band, "stuck_percent", "stuck_low_percent", "stuck_high_percent")}
_OF_ROUGHNESS = DEVICE | {
    "held by": (str, "held_by"),
    "varied": (str, "varied"),
    "value": (".3g", "value"),
    "and": (_second, "other", "other_value"),
    KURTOSIS: (_kurtosis, KURTOSIS),
    "p": ("g", "share"),
    "unit": (str, "unit"),
    "simulated limit": (lambda safe, unit: bounding(safe, 4, unit != LENGTH.shown), "safe", "unit"),
    "estimate": (with_error, "estimate", "estimate_se"),
    "required": ("g", "required"),
    **_STUCK,
    "devices": (str, "devices"),
}
_SECOND = {"second variable": (str, "second_variable"), "at": (".6g", "second_value")}
_OF_PROCESSES = DEVICE | {
    "held by": (str, "held_by"),
    "variable": (str, "variable"),
    "value": (".6g", "value"),
    **_SECOND,
    "p": ("g", "share"),
    "unit": (str, "unit"),
    "estimate": (with_error, "estimate", "estimate_se"),
    "required": ("g", "required"),
    "margin, mean process": (with_error, "margin", "margin_se"),
    "margin, next run": (with_error, "margin", "margin_of_run_se"),
    "of simulation": (".2g", "simulation_se"),
    "of the law": (".2g", "law_se"),
    "of the model": (".2g", "model_se"),
    "of one run": (".2g", "run_se"),
    **_STUCK,
}


def _stage(name, shows, devices, inputs, compute):
    """Stage of a table of some devices of a plan, with inputs by the plan and the names of the devices."""
    return table_stage(
        name,
        shows,
        inputs=lambda plan, _at: inputs(plan, devices(plan)),
        compute=compute,
        jobs=lambda plan: [{}] if devices(plan) else [],
        targets=("devices",),
    )


def _laws(plan, names):
    """Inputs of the laws of each device."""
    return {f"laws_{name}": law_inputs(plan, name)["laws"] for name in names}


def _of_laws(table):
    """Table of margins from the data of its inputs."""
    return lambda data: table(
        data["found"], data["recommended"], {name: data[f"laws_{name}"] for name in data["found"]}
    )


STAGES = (
    _stage(
        "roughness",
        "how rough a surface must be",
        lambda plan: plan.devices.over_roughness,
        lambda _plan, names: {"roughness": by_name("devices/roughness", names)},
        lambda data: of_roughness(data["roughness"]),
    ),
    _stage(
        "process",
        "which settings of a process suffice",
        lambda plan: plan.devices.over_process,
        lambda plan, names: (
            {"found": by_name("process/curves", names)}
            | {"recommended": [f"process/settings/{variable}" for variable in variables(plan)]}
            | _laws(plan, names)
        ),
        _of_laws(of_processes),
    ),
    _stage(
        "process_map",
        "which pairs of settings of two processes suffice",
        lambda plan: plan.devices.processed_twice,
        lambda plan, names: (
            {"found": by_name("process/maps", names), "recommended": by_name("process/pairs", names)}
            | _laws(plan, names)
        ),
        _of_laws(of_pairs),
    ),
)

"""Table of processes: devices over a process variable, and sentences on sufficient settings."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from stiction.config.surfaces import process
from stiction.devices.risk import one_in
from stiction.plan.names import by_name
from stiction.report.format import UM, with_band, with_error
from stiction.report.roughness.tables import said_of_point
from stiction.report.table import DEVICE, Table, table_stage, with_list
from stiction.stages.axes.recommended import ALL, variables
from stiction.stages.devices.end_states import END_STATES


def answers(recommended: xr.Dataset, who: str) -> list[str]:
    """Sentences on the sufficient settings for a device or for all, the best one and the next to measure."""
    one, unit = recommended.sel(who=who), unit_of(recommended)
    if np.isnan(float(one.best)):
        return [_sufficient(one, who, unit)]
    said = [_sufficient(one, who, unit)]
    if places := [at(one, *pair) for pair in _pairs(one.crossing, one.crossing_error)]:
        said.append(f"The estimate meets the requirement exactly at {' and at '.join(places)}.")
    return said + best(one) + following(one, unit)


def briefly(recommended: xr.Dataset, who: str) -> str:
    """Sentence on the sufficient settings and the best one."""
    return _sufficient(recommended.sel(who=who), who, unit_of(recommended))


def unit_of(dataset: xr.Dataset) -> str:
    """Unit of the variable of a dataset."""
    return process.unit_of(dataset.variable)


def _sufficient(one, who, unit):
    """Range of settings that suffices, and the best setting."""
    words, value = process.words_of(one.variable), one.value.values
    if np.isnan(float(one.best)):
        return f"{_subject(who, 'Settings')} of the {words} that suffice are not known: too few could be computed."
    share = "the allowed share of every device" if who == ALL else one_in(float(one.share))
    most = at(one, float(one.best), float(one.best_error))
    ranges = [
        f"{setting_text(one, low)} to {setting_text(one, high)} {unit}"
        for low, high in _pairs(*one.sufficient.values.T)
    ]
    if not ranges:
        settings = f"{_subject(who, 'No setting')} of the {words} from {value[0]:g} to {value[-1]:g} {unit}"
        return (
            f"{settings} is sure to leave at most {share} stuck in the next run ({mean_process(one)}); the best is "
            f"{most}."
        )
    enough = " or ".join(ranges)
    settings = f"{_subject(who, 'Settings')} of the {words} from {enough}"
    return (
        f"{settings} leave at most {share} stuck in the next run (95 % confidence; {mean_process(one)}), best {most}."
    )


def mean_process(one: xr.Dataset) -> str:
    """Settings that suffice for the mean process, beside those for the next run."""
    ranges = [
        f"{setting_text(one, low)} to {setting_text(one, high)} {unit_of(one)}"
        for low, high in _pairs(*one.sufficient_mean.values.T)
    ]
    return f"mean process: {' or '.join(ranges) or 'none'}"


def _subject(who, begins):
    """Beginning of a sentence, on all devices together or on one."""
    return f"All devices together: {begins[:1].lower()}{begins[1:]}" if who == ALL else begins


def at(one: xr.Dataset, value: float, error: float) -> str:
    """Setting with its error, if it has one."""
    return f"{with_error(value, error) if error > 0 else setting_text(one, value)} {unit_of(one)}"


def setting_text(dataset: xr.Dataset, value: float) -> str:
    """Setting to a hundredth of the range of all, or finer by less than a digit."""
    decimals = max(0, -math.floor(math.log10(np.ptp(dataset.value.values) / 100)))
    return f"{round(float(value), decimals):.10g}"


def _pairs(first, second):
    """Pairs of numbers that are known."""
    return [pair for pair in zip(map(float, first), map(float, second), strict=True) if np.isfinite(pair[0])]


def best(one: xr.Dataset) -> list[str]:
    """Interval of the best setting, and the reasons of its ends."""
    unit, (low, high) = unit_of(one), map(float, one.best_interval)
    first, last = map(float, one.value.values[[0, -1]])
    if low == high and low in (first, last) and not _pairs(*one.sufficient.values.T):
        side = "below" if low == first else "above"
        return [f"The best setting is the end of the measured range: measure settings {side} {low:g} {unit}."]
    said = (
        [f"The best setting lies between {setting_text(one, low)} and {setting_text(one, high)} {unit} (95 %)."]
        if low < high
        else []
    )
    ends = [f"{end:g} {unit}" for end, near in ((first, low == first), (last, high == last)) if near]
    if ends:
        said.append(
            f"It may lie beyond {' or '.join(ends)}, where nothing was measured: nothing is said about settings there."
        )
    return said


def following(one: xr.Dataset, unit: str) -> list[str]:
    """Setting to measure next, or nothing if none shrinks an error."""
    if np.isnan(float(one.next)):
        return []
    subject = {"best": "the best setting", "range": "the length of the range that suffices"}[
        str(one.next_subject.values)
    ]
    errors = f"from {float(one.next_before):.2g} to {float(one.next_after):.2g} {unit}"
    when = "again" if bool(one.next_again) else "next"
    place = f"{setting_text(one, one.next)} {unit}"
    return [f"Measure {place} {when}: this is expected to shrink the error of {subject} {errors}."]


def notes(curve: xr.Dataset, laws: Sequence[xr.Dataset]) -> list[str]:
    """Sentences on settings in contradiction to a law, and on points not computed or flagged."""
    said = [sentence for law in laws for sentence in str(law.flags.item()).splitlines()]
    for name, begins in {"flagged": "Where", "refused": "Not computed where"}.items():
        places = {}
        for humidity in curve.humidity.values:
            for value in curve.value.values:
                if sentence := said_of_point(name, str(curve[name].sel(humidity=humidity, value=value).values)):
                    places.setdefault(sentence.rstrip("."), []).append(f"{setting_text(curve, value)} {unit_of(curve)}")
        words = process.words_of(curve.variable)
        said += [
            f"{begins} the {words} is {', '.join(dict.fromkeys(at))}: {sentence}." for sentence, at in places.items()
        ]
    return said


def table(
    curves: Mapping[str, xr.Dataset], recommended: Sequence[xr.Dataset], laws: Mapping[str, Sequence[xr.Dataset]]
) -> Table:
    """Margins of devices over process variables: a row per device, humidity, end state and setting."""
    said = [
        sentence if who == ALL else f"{who}: {sentence}"
        for one in recommended
        for who in map(str, one.who.values)
        for sentence in answers(one, who)
    ]
    said += dict.fromkeys(sentence for device, curve in curves.items() for sentence in notes(curve, laws[device]))
    of_all = [row for device, curve in curves.items() for row in rows(device, curve)]
    return Table.of(of_all, with_list(caption("a process makes at values of its variable"), said), COLUMNS)


def caption(made: str) -> str:
    """Caption of a table, with the processes of the surfaces."""
    return (
        "Length of a beam, or restoring force of a stopper, with the allowed fraction p stuck, on the surfaces that "
        f"{made}, and its margin to the required one: the logarithm of their ratio, positive where the requirement is "
        "met. Errors of the margin are due to the simulation, to the law of the surface at and between the measured "
        "settings, and to full elastic contact if it is computed. The next run scatters about the mean process as well."
    )


def rows(device: str, curve: xr.Dataset) -> Iterator[dict]:
    """Numbers of a device."""
    for humidity in curve.humidity.values:
        for shape in map(str, curve["shape"].values):
            for value in curve.value.values:
                point = curve.sel(humidity=humidity, shape=shape, value=value)
                parts = {name: float(point[f"{name}_error"]) for name in ("simulation", "law", "model", "run")}
                of_mean = float(np.hypot(np.hypot(parts["simulation"], parts["law"]), parts["model"]))
                stuck, low, high = (100 * point.stuck.values).tolist()
                yield (
                    {
                        "device": device,
                        "relative_humidity": float(humidity),
                        "held_by": END_STATES[shape].by,
                        "variable": curve.variable,
                        "value": float(value),
                        "share": float(curve.share),
                        "unit": "µN" if curve.required.attrs["units"] == "N" else "µm",
                        "estimate": float(point.estimate) / UM,
                        "estimate_se": float(point.error) / UM,
                        "required": float(curve.required) / UM,
                        "margin": float(point.margin),
                        "margin_se": of_mean,
                        "margin_of_run_se": float(np.hypot(of_mean, parts["run"])),
                    }
                    | {f"{name}_se": part for name, part in parts.items()}
                    | {
                        "stuck_percent": stuck,
                        "stuck_low_percent": low,
                        "stuck_high_percent": high,
                    }
                )


COLUMNS = DEVICE | {
    "held by": (str, "held_by"),
    "variable": (str, "variable"),
    "value": (".6g", "value"),
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
    "P(stuck) [%]": (with_band, "stuck_percent", "stuck_low_percent", "stuck_high_percent"),
}


def _inputs(plan, _at):
    """Curves, recommended settings and laws of all devices over a process."""
    devices = plan.devices.over_process
    laws = {name: [f"process/laws/{one}" for one in process.processes_of(plan.config, name)] for name in devices}
    own = {f"laws_{name}": named for name, named in laws.items()}
    settings = [f"process/settings/{variable}" for variable in variables(plan)]
    return {"curves": by_name("process/curves", devices), "recommended": settings} | own


STAGES = (
    table_stage(
        "process",
        "which settings of a process suffice",
        inputs=_inputs,
        compute=lambda data: table(
            data["curves"], data["recommended"], {name: data[f"laws_{name}"] for name in data["curves"]}
        ),
        jobs=lambda plan: [{}] if plan.devices.over_process else [],
        targets=("devices",),
    ),
)

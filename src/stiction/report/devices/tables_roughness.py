"""Table of roughness: lengths and forces over the roughness of a surface, and which roughness suffices."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.config.kinds import ROUGHNESSES
from stiction.config.units import from_si, without_unit
from stiction.plan.names import by_name
from stiction.report.format import UM, with_error
from stiction.report.tables import DEVICE, Table, table_stage, with_list
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.releases import FORCE

#: What stays while one quantity is varied.
FORM = (
    "One quantity of one surface is varied. The form of its heights and the shape of its spectrum stay; a process that "
    "changes one of them usually changes all."
)


# Sentences


def in_unit(found: xr.Dataset, values: float | np.ndarray) -> float | np.ndarray:
    """Values of the varied quantity in the unit of its key."""
    key = found.attrs["key"]
    unit = key.removeprefix(without_unit(key)).removeprefix("_")
    return from_si(values, unit) if unit else values


def name_of(found: xr.Dataset) -> str:
    """The varied quantity in words.

    Examples
    --------
    >>> name_of(xr.Dataset(attrs={"key": "rms_nm", "surface": "B2"}))
    'rms of B2'
    """
    return f"{ROUGHNESSES[found.attrs['key']].words} of {found.attrs['surface']}"


def labelled(found: xr.Dataset) -> str:
    """The varied quantity with its unit, for axes and tables.

    Examples
    --------
    >>> labelled(xr.Dataset(attrs={"key": "rms_nm", "surface": "B2"}))
    'rms of B2 [nm]'
    """
    return f"{name_of(found)} [{_unit(found).strip() or '–'}]"


def answers(found: xr.Dataset) -> list[str]:
    """Which roughness suffices, one sentence for each humidity and end state, and why some is not computed."""
    subjects = [(float(h), str(shape)) for h in found.humidity.values for shape in found["shape"].values]
    return [_answer(found, *subject) for subject in subjects] + _refusals(found)


def _answer(found, humidity, shape):
    """Which roughness suffices at a humidity against one end state."""
    required = f"{float(found.required) / UM:g} {_required_unit(found)}"
    wanted = (
        f"a restoring force of {required}" if shape == FORCE else f"a length of {required} ({END_STATES[shape].by})"
    )
    places = [
        with_error(in_unit(found, float(row.crossing_place)), in_unit(found, float(row.crossing_error))) + _unit(found)
        for row in _rows(found, "crossing", humidity, shape)
    ]
    exactly = f"; exactly {_share(found)} sticks at {' and at '.join(places)}" if places else ""
    enough = _enough(found, found.sel(humidity=humidity, shape=shape), _rows(found, "range", humidity, shape))
    return f"For {wanted}, at a relative humidity of {humidity:g}, {enough}{exactly}. {_given(found, humidity, shape)}"


def _enough(found, curve, rows):
    """Where the safe value of a curve meets what is required."""
    known = curve.roughness.values[np.isfinite(curve.safe.values)]
    if not len(known):
        return "nothing is computed"
    name, share, whole = name_of(found), _share(found), _range(found, known[0], known[-1])
    ranges = [_range(found, float(row.range_low), float(row.range_high)) for row in rows]
    if not ranges:
        return f"no {name} of {whole} suffices: nowhere there is it certain that at most {share} sticks"
    sure = "95 % confidence, given the drawn surfaces"
    if ranges == [whole]:
        return f"at most {share} sticks at any {name} of {whole} ({sure})"
    return f"at most {share} sticks where the {name} is {' or '.join(ranges)} ({sure}; computed for {whole})"


def _given(found, humidity, shape):
    """P(stuck) on the surfaces as they are given, if it is known."""
    given = found.sel(humidity=humidity, shape=shape, roughness=float(found.given))
    stuck, low, high = (100 * given.stuck.values).tolist()
    if np.isnan(stuck):
        return "On the surfaces as they are given, it is not computed."
    place = f"{_shown(found, float(found.given))}{_unit(found)}"
    return f"On the surfaces as they are given, at {place}, {stuck:.3g} % ({low:.3g} to {high:.3g} %) stick."


def _rows(found, dimension, humidity, shape):
    """Crossings or ranges of a humidity and end state."""
    names = [f"{dimension}_humidity", f"{dimension}_shape"]
    own = (found[names[0]].values == humidity) & (found[names[1]].values == shape)
    return [found.isel({dimension: k}) for k in np.flatnonzero(own)]


def _shown(found, value):
    """A value of the varied quantity as text."""
    return f"{in_unit(found, float(value)):.3g}"


def _range(found, low, high):
    """A range of the varied quantity as text."""
    return f"{_shown(found, low)} to {_shown(found, high)}{_unit(found)}"


def _share(found):
    """The allowed share as text."""
    return f"1 in {1 / float(found.share):g}"


def _refusals(found):
    """Where nothing is computed, by reason."""
    places = {}
    for humidity in found.humidity.values:
        for value in found.roughness.values:
            if reason := str(found.refused.sel(humidity=humidity, roughness=value).values):
                at = f"{_shown(found, value)}{_unit(found)} (RH {humidity:g})"
                places.setdefault(reason, []).append(at)
    return [f"Not computed at a {name_of(found)} of {', '.join(at)}: {reason}." for reason, at in places.items()]


def _unit(found):
    """Unit of the varied quantity with a space before it, or nothing."""
    return ROUGHNESSES[found.attrs["key"]].unit


def _required_unit(found):
    """Unit of what is required, as shown."""
    return "µN" if found.required.attrs["units"] == "N" else "µm"


# Table


def roughness(datasets: Mapping[str, xr.Dataset]) -> Table:
    """Lengths or forces over the roughness, one row per device, humidity, end state and roughness.

    Parameters
    ----------
    datasets : dict
        Device to the dataset of stage roughness.
    """
    rows = [row for device, found in datasets.items() for row in _points(device, found)]
    sentences = [f"{device}: {sentence}" for device, found in datasets.items() for sentence in answers(found)]
    caption = (
        "Safe length of a beam, or safe restoring force of a stopper, over the roughness of a surface: with a "
        "confidence of 95 % given the drawn surfaces, at most a share p sticks. Estimate: where a share p sticks, ± "
        "standard error due to the numbers of devices and of drawn surfaces. P(stuck): at the required length or "
        f"force, with its 95 % band. {FORM} Devices: number of simulated devices at every roughness."
    )
    return Table.of(rows, with_list(caption, sentences), _COLUMNS)


def _points(device, found):
    """Numbers of one device."""
    for humidity in found.humidity.values:
        for shape in map(str, found["shape"].values):
            for value in found.roughness.values:
                one = found.sel(humidity=humidity, shape=shape, roughness=value)
                stuck, low, high = (100 * one.stuck.values).tolist()
                yield {
                    "device": device,
                    "relative_humidity": float(humidity),
                    "held_by": END_STATES[shape].by,
                    "varied": labelled(found),
                    "value": float(in_unit(found, value)),
                    "share": float(found.share),
                    "unit": _required_unit(found),
                    "safe": float(one.safe) / UM,
                    "estimate": float(one.estimate) / UM,
                    "estimate_se": float(one.error) / UM,
                    "required": float(found.required) / UM,
                    "stuck_percent": stuck,
                    "stuck_low_percent": low,
                    "stuck_high_percent": high,
                    "devices": int(found.samples),
                }


def _stuck(stuck, low, high):
    """P(stuck) with its band."""
    return "–" if np.isnan(stuck) else f"{stuck:.3g} ({low:.3g} to {high:.3g})"


_COLUMNS = DEVICE | {
    "held by": (str, "held_by"),
    "varied": (str, "varied"),
    "value": (".3g", "value"),
    "p": ("g", "share"),
    "unit": (str, "unit"),
    "safe": (".4g", "safe"),
    "estimate": (with_error, "estimate", "estimate_se"),
    "required": ("g", "required"),
    "P(stuck) [%]": (_stuck, "stuck_percent", "stuck_low_percent", "stuck_high_percent"),
    "devices": (str, "devices"),
}


STAGES = (
    table_stage(
        "table_roughness",
        "roughness",
        "how rough a surface must be",
        inputs=lambda plan, at: {"roughness": by_name("devices/roughness", plan.devices.roughened)},
        compute=lambda data, at, settings: roughness(data["roughness"]),
        jobs=lambda plan: [{}] if plan.devices.roughened else [],
        targets=("devices",),
    ),
)

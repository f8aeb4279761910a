"""Table of roughness: lengths and forces against the roughness of a surface, and sufficient roughnesses."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.config.kinds import ROUGHNESSES
from stiction.config.units import from_si, without_unit
from stiction.devices.risk import VERIFIED, one_in, samples_for
from stiction.plan.names import by_name
from stiction.report.format import UM, airs, fraction_with_band, with_band, with_error
from stiction.report.limits import words
from stiction.report.table import DEVICE, Table, table_stage, with_list
from stiction.run.stored_limits import of_text
from stiction.stages.axes.roughness import KURTOSIS, curves_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import FORCE

#: Standard errors beyond which two forces count as different.
DIFFERENT = 3


# Sentences


def form(*datasets: xr.Dataset) -> str:
    """Constants while the quantities of some curves and maps are varied, and their changes."""
    varied = (
        "Two quantities of one surface are varied."
        if any("other" in dataset.dims for dataset in datasets)
        else "One quantity of one surface is varied."
    )
    stays = "The form of its heights and the shape of its spectrum stay"
    if any(KURTOSIS in dataset for dataset in datasets):
        stays = (
            "A skewness comes with the kurtosis of the surface. If no density of maximum entropy has both, it comes "
            "with the largest kurtosis of such a density, shown beside it. All else of the form of its heights and the "
            "shape of its spectrum stays"
        )
    return f"{varied} {stays}; a process that changes one of them usually changes all."


def in_unit(dataset: xr.Dataset, values: float | np.ndarray, key: str = "key") -> float | np.ndarray:
    """Values of a varied quantity in the unit of its key, given by an attribute: ``key`` or ``other_key``."""
    name = dataset.attrs[key]
    unit = name.removeprefix(without_unit(name)).removeprefix("_")
    return from_si(values, unit) if unit else values


def name_of(dataset: xr.Dataset, key: str = "key") -> str:
    """Varied quantity in words.

    Examples
    --------
    >>> name_of(xr.Dataset(attrs={"key": "rms_nm", "surface": "B2"}))
    'rms of B2'
    """
    return f"{ROUGHNESSES[dataset.attrs[key]].words} of {dataset.attrs['surface']}"


def quantity_with_unit(dataset: xr.Dataset, key: str = "key") -> str:
    """Varied quantity with its unit, for axes and tables.

    Examples
    --------
    >>> quantity_with_unit(xr.Dataset(attrs={"key": "rms_nm", "surface": "B2"}))
    'rms of B2 [nm]'
    """
    return f"{name_of(dataset, key)} [{_unit(dataset, key).strip() or '–'}]"


def answers(dataset: xr.Dataset) -> list[str]:
    """Sufficient roughnesses, one sentence for each humidity and end state, and reasons against others.

    Those of a map are about each of its curves.
    """
    said = [_at_other(curve) + sentence for curve in curves_of(dataset) for sentence in _answers(curve)]
    return said + note_on_extrapolation(dataset)


def _answers(curve):
    """Sentences of `answers`, of one curve."""
    said = {"flagged": "Where", "refused": "Not computed where"}
    notes = [note for name, begins in said.items() for note in _notes(curve, name, begins)]
    return [_answer(curve, *subject) for subject in _subjects(curve)] + notes


def briefly(dataset: xr.Dataset) -> list[str]:
    """Places of sufficient roughness, one sentence for each humidity and end state, of a map at its given value."""
    curves = [curve for curve in curves_of(dataset) if not _is_changed(curve)]
    return [f"{_enough(curve, *subject)}." for curve in curves for subject in _subjects(curve)] + note_on_extrapolation(
        dataset
    )


def note_on_extrapolation(dataset: xr.Dataset) -> list[str]:
    """Note on an extrapolated fraction, beyond the bound from the devices and beyond verification."""
    share, samples = float(dataset.share), int(dataset.samples)
    if share >= VERIFIED or samples >= samples_for(share):
        return []
    return [
        f"The result for {one_in(share)} is extrapolated from {samples} simulated devices, by a line through the 5 % "
        f"that stick most easily. The line was verified down to {one_in(VERIFIED)}."
    ]


def _subjects(curve):
    """Humidities and end states of a curve."""
    return [(float(h), str(shape)) for h in curve.humidity.values for shape in curve["shape"].values]


def _at_other(curve):
    """Beginning of the sentences on a curve of a map, nothing for others."""
    if "other" not in curve.coords:
        return ""
    key, given = "other_key", "" if _is_changed(curve) else ", as given"
    value = f"{_value_text(curve, curve.other, key)}{_unit(curve, key)}{_kurtosis_column(curve)}"
    return f"Where the {name_of(curve, key)} is {value}{given}: "


def _kurtosis_column(curve):
    """Kurtosis of a curve of a map along the skewness, nothing for others."""
    if curve.attrs["other_key"] != "skewness":
        return ""
    return f" and the kurtosis {float(curve[KURTOSIS][0]):.3g}"


def _is_changed(curve):
    """Whether the second quantity of a curve differs from the surface's."""
    return "other" in curve.coords and float(curve.other) != float(curve.other_given)


def _answer(curve, humidity, shape):
    """Sufficient roughness at a humidity against one end state."""
    places = [
        with_error(in_unit(curve, float(row.crossing_place)), in_unit(curve, float(row.crossing_error))) + _unit(curve)
        for row in _rows(curve, "crossing", humidity, shape)
    ]
    exactly = f"; exactly {_share(curve)} sticks at {' and at '.join(places)}" if places else ""
    more = _worst(curve, humidity, shape) + _stuck_as_given(curve, humidity, shape)
    return f"{_enough(curve, humidity, shape)}{exactly}. {more}"


def _enough(curve, humidity, shape):
    """Place of the requirement on the safe values at a humidity against one end state."""
    required = f"{float(curve.required) / UM:g} {_required_unit(curve)}"
    wanted = (
        f"a restoring force of {required}" if shape == FORCE else f"a length of {required} ({END_STATES[shape].by})"
    )
    where = _where(curve, curve.sel(humidity=humidity, shape=shape), _rows(curve, "range", humidity, shape))
    return f"For {wanted}, {airs([humidity])}, {where}"


def _where(dataset, curve, rows):
    """Roughness with the safe value of a curve at the requirement."""
    known = curve.roughness.values[curve.safe.notnull().values]
    if not len(known):
        return "nothing is computed"
    name, share, whole = name_of(dataset), _share(dataset), _range(dataset, known[0], known[-1])
    ranges = [_range(dataset, float(row.range_low), float(row.range_high)) for row in rows]
    if not ranges:
        return f"no {name} of {whole} suffices: nowhere there is it certain that at most {share} sticks"
    of_beam = curve.required.attrs["units"] == "m"  # bounds of beams allow for the number of drawn surfaces
    sure = "95 % confidence" if of_beam else "95 % confidence, given the drawn surfaces"
    if ranges == [whole]:
        return f"at most {share} sticks at any {name} of {whole} ({sure})"
    return f"at most {share} sticks where the {name} is {' or '.join(ranges)} ({sure}; computed for {whole})"


def _worst(curve, humidity, shape):
    """Roughness of strongest adhesion of a stopper if it is inside the range, beyond the errors of both ends."""
    known = curve.sel(humidity=humidity, shape=shape).dropna("roughness", subset=["estimate"])
    forces, errors = known.estimate.values, known.error.values
    if shape != FORCE or not len(forces):
        return ""
    most = int(np.argmax(forces))
    apart = [forces[most] - forces[end] > DIFFERENT * np.hypot(errors[most], errors[end]) for end in (0, -1)]
    if not all(apart):
        return ""
    place = f"{_value_text(curve, known.roughness[most])}{_unit(curve)}"
    return f"The worst {name_of(curve)} is inside this range, near {place}: less and more of it hold less. "


def _stuck_as_given(curve, humidity, shape):
    """P(stuck) on the surfaces as they are given, if it is known."""
    given = curve.sel(humidity=humidity, shape=shape, roughness=float(curve.given))
    stuck = given.stuck.values.tolist()
    where = f"At the given {name_of(curve)}" if _is_changed(curve) else "On the surfaces as they are given"
    if np.isnan(stuck[0]):
        return f"{where}, it is not computed."
    place = f"{_value_text(curve, float(curve.given))}{_unit(curve)}"
    return f"{where}, at {place}, {fraction_with_band(*stuck, ' %')} stick."


def _rows(curve, dimension, humidity, shape):
    """Crossings or ranges of a humidity and end state."""
    names = [f"{dimension}_humidity", f"{dimension}_shape"]
    own = (curve[names[0]].values == humidity) & (curve[names[1]].values == shape)
    return [curve.isel({dimension: k}) for k in np.flatnonzero(own)]


def _value_text(dataset, value, key="key"):
    """Value of a varied quantity as text."""
    return f"{in_unit(dataset, float(value), key):.3g}"


def _range(dataset, low, high):
    """Range of the varied quantity as text."""
    return f"{_value_text(dataset, low)} to {_value_text(dataset, high)}{_unit(dataset)}"


def _share(dataset):
    """Allowed fraction as text."""
    return one_in(float(dataset.share))


def said_of_point(name: str, text: str) -> str:
    """Sentence of a variable of a point: reasons are stored in words, flags as limits."""
    return words.joined(of_text(text)) if name == "flagged" else text


def _notes(curve, name, begins):
    """Sentences of a variable about single points, each with its places."""
    places = {}
    for humidity in curve.humidity.values:
        for value in curve.roughness.values:
            if said := said_of_point(name, str(curve[name].sel(humidity=humidity, roughness=value).values)):
                at = f"{_value_text(curve, value)}{_unit(curve)} ({Air(humidity).words})"
                places.setdefault(said.rstrip("."), []).append(at)
    return [f"{begins} the {name_of(curve)} is {', '.join(at)}: {said}." for said, at in places.items()]


def _unit(dataset, key="key"):
    """Unit of a varied quantity with a space before it, or nothing."""
    return ROUGHNESSES[dataset.attrs[key]].unit


def _required_unit(dataset):
    """Unit of the requirement, as shown."""
    return "µN" if dataset.required.attrs["units"] == "N" else "µm"


# Table


def roughness(datasets: Mapping[str, xr.Dataset]) -> Table:
    """Lengths or forces of devices over the roughness: a row per device, humidity, end state and roughness.

    The datasets are by name of the device.
    """
    rows = [
        row for device, dataset in datasets.items() for curve in curves_of(dataset) for row in _points(device, curve)
    ]
    sentences = [f"{device}: {sentence}" for device, dataset in datasets.items() for sentence in answers(dataset)]
    of_maps = any("other" in row for row in rows)
    caption = (
        "Simulated limit of a length, or of a restoring force, against the roughness of a surface: with a "
        "confidence of 95 % (of a stopper: given the drawn surfaces), at most a fraction p sticks. Estimate: a "
        "fraction p sticks, ± standard error due to the numbers of devices and of drawn surfaces. P(stuck): at the "
        f"required length or force, with its 95 % band. {form(*datasets.values())} Devices: number of simulated "
        "devices at every roughness."
    )
    shown = {"and": of_maps, KURTOSIS: any(KURTOSIS in row for row in rows)}
    columns = {name: column for name, column in _COLUMNS.items() if shown.get(name, True)}
    return Table.of(rows, with_list(caption, sentences), columns)


def _points(device, curve):
    """Numbers of one curve of a device."""
    other = {}
    if "other" in curve.coords:
        other = {
            "other": quantity_with_unit(curve, "other_key"),
            "other_value": float(in_unit(curve, curve.other, "other_key")),
        }
    for humidity in curve.humidity.values:
        for shape in map(str, curve["shape"].values):
            for value in curve.roughness.values:
                point = curve.sel(humidity=humidity, shape=shape, roughness=value)
                stuck, low, high = (100 * point.stuck.values).tolist()
                yield (
                    {
                        "device": device,
                        "relative_humidity": float(humidity),
                        "held_by": END_STATES[shape].by,
                        "varied": quantity_with_unit(curve),
                        "value": float(in_unit(curve, value)),
                        "share": float(curve.share),
                        "unit": _required_unit(curve),
                        "safe": float(point.safe) / UM,
                        "estimate": float(point.estimate) / UM,
                        "estimate_se": float(point.error) / UM,
                        "required": float(curve.required) / UM,
                        "stuck_percent": stuck,
                        "stuck_low_percent": low,
                        "stuck_high_percent": high,
                        "devices": int(curve.samples),
                    }
                    | other
                    | ({KURTOSIS: float(point[KURTOSIS])} if KURTOSIS in curve else {})
                )


def _second(name, value):
    """Value of a second quantity, if there is one."""
    return f"{name}: {value:.3g}" if isinstance(name, str) else ""


def _kurtosis(value):
    """Kurtosis of a skewness, if one is varied."""
    return "" if np.isnan(value) else f"{value:.3g}"


_COLUMNS = DEVICE | {
    "held by": (str, "held_by"),
    "varied": (str, "varied"),
    "value": (".3g", "value"),
    "and": (_second, "other", "other_value"),
    KURTOSIS: (_kurtosis, KURTOSIS),
    "p": ("g", "share"),
    "unit": (str, "unit"),
    "simulated limit": (".4g", "safe"),
    "estimate": (with_error, "estimate", "estimate_se"),
    "required": ("g", "required"),
    "P(stuck) [%]": (with_band, "stuck_percent", "stuck_low_percent", "stuck_high_percent"),
    "devices": (str, "devices"),
}


STAGES = (
    table_stage(
        "roughness",
        "how rough a surface must be",
        inputs=lambda plan, at: {"roughness": by_name("devices/roughness", plan.devices.over_roughness)},
        compute=lambda data: roughness(data["roughness"]),
        jobs=lambda plan: [{}] if plan.devices.over_roughness else [],
        targets=("devices",),
    ),
)

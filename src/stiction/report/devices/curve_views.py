"""Views of the page of a device over its process or a roughness, see `stiction.report.devices.curves`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

from stiction.config.kinds import ROUGHNESSES
from stiction.config.surfaces import process
from stiction.devices.risk import one_in
from stiction.devices.roughness import margins, sufficient
from stiction.report.devices.curves import Curves, line
from stiction.report.devices.explorer import View, humidity_axis
from stiction.report.devices.grid import Axis
from stiction.report.format import UM
from stiction.report.roughness.tables import in_unit, name_of
from stiction.stages.axes.recommended import settings_of_processes
from stiction.stages.axes.roughness import curves_of

#: Parts of the standard error of a margin over a process.
_PARTS = ("simulation_error", "law_error", "model_error")


@dataclass(frozen=True)
class _Required:
    """Requirement of a device."""

    name: str  #: of the device
    section: Mapping[str, Any]
    dataset: xr.Dataset

    @property
    def falls(self) -> bool:
        """Whether a larger size sticks less often."""
        return self.dataset.required.attrs["units"] == "N"

    @property
    def share(self) -> Axis:
        """Allowed fraction."""
        reason = f"it is the required one; devices.{self.name}.requirement changes this"
        return _one("share", "fraction p that may stick", "", "score", float(self.dataset.share), reason)

    @property
    def size(self) -> Axis:
        """Required length, or restoring force."""
        key, label, unit = ("force", "restoring force", "µN") if self.falls else ("length", "required length", "µm")
        keys = ("restoring_force_uN", "stiffness_N_per_m") if self.falls else ("requirement.length_um",)
        stated = next((one for one in keys if one in self.section), keys[0])
        reason = f"it is that of the device; devices.{self.name}.{stated} changes this"
        return _one(key, label, unit, "linear", float(f"{float(self.dataset.required) / UM:.9g}"), reason)

    def humidity(self, margin: xr.DataArray) -> Axis:
        """Humidities of the device. The smallest margin is that of the worst."""
        of_each = margin.mean([dim for dim in margin.dims if dim != "humidity"]).fillna(np.inf)
        return humidity_axis(
            margin.humidity.values,
            float(of_each.humidity[int(np.argmin(of_each.values))]),
            f"devices.{self.name}.humidities",
            False,
        )

    def words(self, where: str, copied: str) -> dict[str, str]:
        """Words of a view: where a value suffices, and what a copied study has."""
        few, size = one_in(float(self.dataset.share)), f"{self.size.start:g} {self.size.unit}"
        return {
            "yes": f"suffices {where}: at most {few} sticks with {size} (95 % confidence)",
            "no": f"not sure to suffice {where}",
            "size": f"{'Force needed' if self.falls else 'Length'} for {few}",
            "stick": f"{'Stoppers' if self.falls else 'Devices'} with {size} that stick",
            "copied": copied,
        }


def _one(key, label, unit, scale, value, reason):
    """Axis of one value."""
    return Axis(key, label, unit, scale, (value,), value, False, reason)


def _joined_lines(parts: Sequence[Mapping[str, np.ndarray]], sizes: Sequence[int]) -> dict[str, np.ndarray]:
    """Lines of all choices together, from those of each."""
    return {name: np.reshape([one[name] for one in parts], (*sizes, *parts[0][name].shape)) for name in parts[0]}


def _stuck_lines(curve, places):
    """Lines of the fraction stuck and its band."""
    return {
        name: line(places, curve.stuck.sel(end=end).values, PchipInterpolator)
        for name, end in (("stuck", "estimate"), ("low", "low"), ("high", "high"))
    }


def views(name: str, section: Mapping[str, Any], data: Mapping[str, Any]) -> list[View]:
    """Views of a device with the datasets of its page: over its process and over a roughness, as far as it has them."""
    found = []
    if "process_map" in data:
        found.append(map_view(name, section, data["process_map"], data["process_pairs"]))
    if "process_settings" in data:
        found.append(process_view(name, section, data["process"], data["process_settings"]))
    if "roughness" in data:
        found.append(roughness_view(name, section, data["roughness"]))
    return found


# Process


def process_view(name: str, section: Mapping[str, Any], curve: xr.Dataset, recommended: xr.Dataset) -> View:
    """View over one process: section of a device, datasets of stages process_curve and process_settings."""
    curve, one = curve.sortby("humidity"), recommended.sel(who=name)
    ranges = one.sufficient.values[np.isfinite(one.sufficient.values[:, 0])].tolist()
    best = tuple(float(part) for part in (one.best, *one.best_interval.values))
    required, axis = _Required(name, section, curve), _variable_axis(curve, "value", best[0])
    humidity = required.humidity(curve.margin.isel(shape=-1))
    grid = Curves(
        (axis, humidity),
        required.share,
        required.size,
        _joined_lines([_over_process(curve.sel(humidity=rh), axis) for rh in humidity.values], [len(humidity.values)]),
        [ranges for _ in humidity.values],
        best if np.isfinite(best[0]) else None,
        required.falls,
    )
    return View(axis.label, grid, required.words("in all airs of the device", _note_on_copy(curve)))


def map_view(name: str, section: Mapping[str, Any], found: xr.Dataset, pairs: xr.Dataset) -> View:
    """View over the first of two processes at settings of the second: datasets of stages process_map, process_pairs."""
    found, (first, second) = found.sortby("humidity"), settings_of_processes(pairs)
    required, axis = _Required(name, section, found), _variable_axis(found, "value", float(first.best))
    other = _variable_axis(found, "second", float(second.best), between=False)
    humidity = required.humidity(found.margin.isel(shape=-1))
    rows = [found.sel(second=value, humidity=rh) for value in other.values for rh in humidity.values]
    safe = [pairs.safe.interp(second=value).values for value in other.values]
    grid = Curves(
        (axis, other, humidity),
        required.share,
        required.size,
        _joined_lines([_over_process(row, axis) for row in rows], [len(other.values), len(humidity.values)]),
        [[sufficient(pairs["value"].values, one)] * len(humidity.values) for one in safe],
        None,
        required.falls,
    )
    words = required.words("in all airs of the device", _note_on_copy(found))
    return View(f"{axis.label}, {other.label}", grid, words)


def _over_process(curve, axis):
    """Lines of a device at one humidity, held by whatever holds it, over a process."""
    held = curve.isel(shape=-1)
    error = np.sqrt(sum(held[part].values ** 2 for part in _PARTS))
    lines = {
        "margin": line(axis.places, held.margin.values, Akima1DInterpolator),
        "error": line(axis.places, error, PchipInterpolator),
    }
    return lines | _stuck_lines(held, axis.places)


def _variable_axis(found, dimension, start, between=True):
    """Axis of the variable of a process, which starts at the best setting if it is known."""
    variable = found.attrs["variable" if dimension == "value" else "second_variable"]
    values, unit = tuple(float(f"{value:.9g}") for value in found[dimension].values), process.unit_of(variable)
    names = list(dict.fromkeys(map(str, found.law_process.values)))
    reason = f"the process is measured from {values[0]:g} to {values[-1]:g} {unit}"
    if not between:
        reason = f"the device is computed at {', '.join(f'{value:g}' for value in values)} {unit} alone"
    reason += f"; process.{names[-1] if dimension == 'second' else names[0]}.settings changes this"
    start = values[len(values) // 2] if np.isnan(start) else start
    start = float(f"{start:.4g}") if between else min(values, key=lambda value: abs(value - start))
    start = min(max(start, values[0]), values[-1])
    return Axis(variable, process.words_of(variable), unit, "linear", values, start, between, reason)


def _note_on_copy(found):
    """Note on a copied study: a setting of a process is no key."""
    name = str(found.law_process.values[0])
    call = f'stiction.Process.of(stiction.load("mine.yaml"), "{name}").at({{value}})'
    return f"It computes the whole curve: no key states a single setting. The surface at this one is {call} in Python"


# Roughness


def roughness_view(name: str, section: Mapping[str, Any], found: xr.Dataset) -> View:
    """View over the roughness of a surface: section of a device, dataset of stage roughness."""
    found = found.sortby("humidity")
    required, curves = _Required(name, section, found), curves_of(found)
    axis = _roughness_axis(found, "key", found.roughness.values, float(found.given), name)
    if found.surface in section.get("measured", ()):
        axis = replace(axis, setting="")
    others = [
        _roughness_axis(found, "other_key", found.other.values, float(found.other_given), name) for _ in curves[1:2]
    ]
    humidity = required.humidity(_margin(found, "estimate", required.falls).isel(shape=-1))
    cases = [(curve, rh) for curve in curves for rh in humidity.values]
    rows = [_over_roughness(curve.sel(humidity=rh), axis, required.falls) for curve, rh in cases]
    ranges = [[_ranges(curve, rh) for rh in humidity.values] for curve in curves]
    grid = Curves(
        (axis, *others, humidity),
        required.share,
        required.size,
        _joined_lines(rows, [*(len(other.values) for other in others), len(humidity.values)]),
        ranges if others else ranges[0],
        None,
        required.falls,
    )
    copied = "" if axis.setting else f"It has the {name_of(found)} as it is given; this address keeps the value shown"
    return View(name_of(found), grid, required.words("at this humidity", copied))


def _over_roughness(curve, axis, falls):
    """Lines of a device at one humidity, held by whatever holds it, over a roughness."""
    held = curve.isel(shape=-1)
    known = np.isfinite(held.estimate.values) & (held.estimate.values > 0)
    error = np.divide(held.error.values, held.estimate.values, out=np.zeros(known.size), where=known)
    lines = {name: _margin(held, name, falls).values for name in ("estimate", "safe")}
    error[np.isnan(lines["estimate"])] = np.nan
    parts = {"margin": lines["estimate"], "error": error, "safe": lines["safe"]}
    return {name: line(axis.places, part, PchipInterpolator) for name, part in parts.items()} | _stuck_lines(
        held, axis.places
    )


def _margin(curve, name, falls):
    """Margins of a variable of a curve to the requirement."""
    return curve[name].copy(data=margins(curve[name].values, float(curve.required), not falls))


def _ranges(curve, humidity):
    """Ranges that suffice at a humidity however the device is held, in the unit of the quantity."""
    rows = (curve.range_humidity.values == humidity) & (curve.range_shape.values == str(curve["shape"].values[-1]))
    ends = np.stack([curve.range_low.values[rows], curve.range_high.values[rows]], axis=-1)
    return [[float(f"{end:.9g}") for end in row] for row in in_unit(curve, ends.astype(float))]


def _roughness_axis(found, key, values, given, name):
    """Axis of a varied quantity, which starts as it is given."""
    quantity, unit = ROUGHNESSES[found.attrs[key]], ROUGHNESSES[found.attrs[key]].unit.strip()
    shown, between = tuple(float(f"{in_unit(found, value, key):.9g}") for value in values), key == "key"
    text = f"from {shown[0]:g} to {shown[-1]:g}" if between else f"at {', '.join(f'{value:.4g}' for value in shown)}"
    reason = f"it is computed {text}{quantity.unit}{'' if between else ' alone'}; devices.{name}.roughness changes this"
    start = min(shown, key=lambda value: abs(value - in_unit(found, given, key)))
    scale = "log" if quantity.logarithmic and between else "linear"
    # A study with another skewness needs its kurtosis, and one with another corner the rest of the spectrum.
    setting = f"surfaces.{found.attrs['surface']}.rms_nm" if found.attrs[key] == "rms_nm" else ""
    return Axis(found.attrs[key], name_of(found, key), unit, scale, shown, start, between, reason, setting)

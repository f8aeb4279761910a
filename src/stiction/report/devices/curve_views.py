"""Views of the page of a device over its process or a roughness, see `stiction.report.devices.curves`."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import Akima1DInterpolator, PchipInterpolator

from stiction.config.kinds import kind_of
from stiction.devices.risk import one_in
from stiction.devices.roughness import sufficient
from stiction.report.axes.axis import axes_of
from stiction.report.devices.curves import Curves, line
from stiction.report.devices.explorer import View, humidity_axis
from stiction.report.devices.grid import GridAxis
from stiction.report.format import UM
from stiction.stages.axes.margins import PARTS
from stiction.stages.axes.recommended import settings_of_processes
from stiction.stages.axes.requirement import margins_of, relative_errors, sought_of
from stiction.stages.axes.roughness import curves_of


@dataclass(frozen=True)
class _Required:
    """Requirement of a device."""

    name: str  #: of the device
    section: Mapping[str, Any]
    dataset: xr.Dataset

    @property
    def falls(self) -> bool:
        """Whether a larger size sticks less often."""
        return sought_of(self.dataset).more_is_better

    @property
    def share(self) -> GridAxis:
        """Allowed fraction."""
        reason = f"it is the required one; devices.{self.name}.requirement changes this"
        return _single_value("share", "fraction p that may stick", "", "score", float(self.dataset.share), reason)

    @property
    def size(self) -> GridAxis:
        """Required length, or restoring force."""
        sought = sought_of(self.dataset)
        kind = kind_of(self.section)
        stated = kind.way(self.section).keys[0] if kind.ways else "requirement.length_um"
        reason = f"it is that of the device; devices.{self.name}.{stated} changes this"
        return _single_value(
            sought.name,
            sought.required,
            sought.shown,
            "linear",
            float(f"{float(self.dataset.required) / UM:.9g}"),
            reason,
        )

    @property
    def humidity(self) -> GridAxis:
        """Humidities of the device. The smallest margin is that of the worst."""
        margin = self.dataset.estimate.copy(data=margins_of(self.dataset)).isel(shape=-1)
        of_each = margin.mean([dim for dim in margin.dims if dim != "humidity"]).fillna(np.inf)
        worst = float(of_each.humidity[int(np.argmin(of_each.values))])
        return humidity_axis(margin.humidity.values, worst, f"devices.{self.name}.humidities", False)

    def words(self, where: str, copied: str) -> dict[str, str]:
        """Words of a view: where a value suffices, and what a copied study has."""
        few, size = one_in(float(self.dataset.share)), f"{self.size.start:g} {self.size.unit}"
        return {
            "yes": f"suffices {where}: at most {few} sticks with {size} (95 % confidence)",
            "no": f"not sure to suffice {where}",
            "size": f"{sought_of(self.dataset).response.capitalize()} for {few}",
            "stick": f"{sought_of(self.dataset).devices.capitalize()} with {size} that stick",
            "copied": copied,
        }


def _single_value(key, label, unit, scale, value, reason):
    """Axis of one value."""
    return GridAxis(key, label, unit, scale, (value,), value, False, reason)


def _stuck_lines(curve, coordinates):
    """Lines of the fraction stuck and its band."""
    return {
        name: line(coordinates, curve.stuck.sel(end=end).values, PchipInterpolator)
        for name, end in (("stuck", "estimate"), ("low", "low"), ("high", "high"))
    }


def views(name: str, section: Mapping[str, Any], data: Mapping[str, Any]) -> list[View]:
    """Views of a device with the datasets of its page: over its process and over a roughness, as far as it has them."""
    views_of_device = []
    if "process_map" in data:
        views_of_device.append(map_view(name, section, data["process_map"], data["process_pairs"]))
    if "process_settings" in data:
        views_of_device.append(process_view(name, section, data["process"], data["process_settings"]))
    if "roughness" in data:
        views_of_device.append(roughness_view(name, section, data["roughness"]))
    return views_of_device


def _view(required, axes, lines, ranges, **shown):
    """View over axes: ``lines`` and ``ranges`` that suffice, of each curve of a device at each humidity.

    Shown are a ``title``, ``where`` a value suffices, what a ``copied`` study has, perhaps the ``best`` value.
    """
    dataset, humidity = required.dataset, required.humidity
    curves = (
        [dataset.sel(second=value) for value in dataset.second.values]
        if "second" in dataset.dims
        else curves_of(dataset)
    )
    parts = [
        lines(curve.sel(humidity=rh).isel(shape=-1), axes[0].coordinates) for curve in curves for rh in humidity.values
    ]
    sizes = [*(len(axis.values) for axis in axes[1:]), len(humidity.values)]
    joined = {
        name: np.reshape([curve_lines[name] for curve_lines in parts], (*sizes, *parts[0][name].shape))
        for name in parts[0]
    }
    enough = [[ranges(curve, rh) for rh in humidity.values] for curve in curves]
    enough = enough if len(axes) > 1 else enough[0]
    axes, best = (*axes, humidity), shown.get("best")
    grid = Curves(axes, required.share, required.size, joined, enough, best, required.falls)
    return View(shown["title"], grid, required.words(shown["where"], shown["copied"]))


# Process


def process_view(name: str, section: Mapping[str, Any], curve: xr.Dataset, recommended: xr.Dataset) -> View:
    """View over one process: section of a device, datasets of stages process_curve and process_settings."""
    curve, advice = curve.sortby("humidity"), recommended.sel(who=name)
    ranges = advice.sufficient.values[np.isfinite(advice.sufficient.values[:, 0])].tolist()
    best = tuple(float(number) for number in (advice.best, *advice.best_interval.values))
    axis = _variable(curve, 0, best[0])
    shown = {"title": axis.label, "where": "in all airs of the device", "copied": _note_on_copy(curve)}
    shown |= {"best": best if np.isfinite(best[0]) else None}
    return _view(_Required(name, section, curve), (axis,), _over_process, lambda _curve, _rh: ranges, **shown)


def map_view(name: str, section: Mapping[str, Any], dataset: xr.Dataset, pairs: xr.Dataset) -> View:
    """View over the first of two processes at settings of the second: datasets of stages process_map, process_pairs."""
    dataset = dataset.sortby("humidity")
    axes = [_variable(dataset, number, float(view.best)) for number, view in enumerate(settings_of_processes(pairs))]

    def ranges(curve, _humidity):
        """Settings of the first process that suffice at one of the second."""
        return sufficient(pairs["value"].values, pairs.safe.interp(second=float(curve.second)).values)

    shown = {"title": ", ".join(axis.label for axis in axes), "where": "in all airs of the device"}
    return _view(_Required(name, section, dataset), axes, _over_process, ranges, **shown, copied=_note_on_copy(dataset))


def _over_process(curve, coordinates):
    """Lines of a device at one humidity, held by whatever holds it, over a process."""
    error = np.sqrt(sum(curve[f"{cause}_error"].values ** 2 for cause in PARTS))
    lines = {
        "margin": line(coordinates, curve.margin.values, Akima1DInterpolator),
        "error": line(coordinates, error, PchipInterpolator),
    }
    return lines | _stuck_lines(curve, coordinates)


def _variable(dataset, number, start):
    """Axis of the variable of a process, which starts at the best setting if it is known."""
    along, between = axes_of(dataset)[number], number == 0
    values, unit = tuple(float(f"{value:.9g}") for value in along.values), along.unit.strip()
    names = list(dict.fromkeys(map(str, dataset.law_process.values)))
    reason = f"the process is measured from {values[0]:g} to {values[-1]:g} {unit}"
    if not between:
        reason = f"the device is computed at {', '.join(f'{value:g}' for value in values)} {unit} alone"
    reason += f"; process.{names[-number]}.settings changes this"
    start = values[len(values) // 2] if np.isnan(start) else start
    start = float(f"{start:.4g}") if between else min(values, key=lambda value: abs(value - start))
    start = min(max(start, values[0]), values[-1])
    return GridAxis(along.name, along.words, unit, "linear", values, start, between, reason)


def _note_on_copy(dataset):
    """Note on a copied study: a setting of a process is no key."""
    name = str(dataset.law_process.values[0])
    call = f'stiction.Process.of(stiction.load("mine.yaml"), "{name}").at({{value}})'
    return f"It computes the whole curve: no key states a single setting. The surface at this one is {call} in Python"


# Roughness


def roughness_view(name: str, section: Mapping[str, Any], dataset: xr.Dataset) -> View:
    """View over the roughness of a surface: section of a device, dataset of stage roughness."""
    dataset = dataset.sortby("humidity")
    values = [float(dataset[value]) for value in ("given", "other_given") if value in dataset]
    axes = [_quantity(dataset, number, value, name) for number, value in enumerate(values)]
    if dataset.surface in section.get("measured", ()):
        axes[0] = replace(axes[0], setting="")
    words = axes[0].label
    copied = "" if axes[0].setting else f"It has the {words} as it is given; this address keeps the value shown"
    shown = {"title": words, "where": "at this humidity by simulation alone", "copied": copied}
    return _view(_Required(name, section, dataset), axes, _over_roughness, _ranges, **shown)


def _over_roughness(curve, coordinates):
    """Lines of a device at one humidity, held by whatever holds it, over a roughness."""
    margin = margins_of(curve)
    error = np.where(np.isnan(margin), np.nan, relative_errors(curve))
    parts = {"margin": margin, "error": error, "safe": margins_of(curve, "safe")}
    return {name: line(coordinates, values, PchipInterpolator) for name, values in parts.items()} | _stuck_lines(
        curve, coordinates
    )


def _ranges(curve, humidity):
    """Ranges that suffice at a humidity however the device is held, in the unit of the quantity."""
    rows = (curve.range_humidity.values == humidity) & (curve.range_shape.values == str(curve["shape"].values[-1]))
    ends = np.stack([curve.range_low.values[rows], curve.range_high.values[rows]], axis=-1)
    return [[float(f"{end:.9g}") for end in row] for row in axes_of(curve)[0].in_unit(ends)]


def _quantity(dataset, number, start_value, name):
    """Axis of a varied quantity, which starts as it is given."""
    along, between = axes_of(dataset)[number], number == 0
    shown = tuple(float(f"{value:.9g}") for value in along.in_unit(along.values))
    text = f"from {shown[0]:g} to {shown[-1]:g}" if between else f"at {', '.join(f'{value:.4g}' for value in shown)}"
    reason = f"it is computed {text}{along.unit}{'' if between else ' alone'}; devices.{name}.roughness changes this"
    start = min(shown, key=lambda value: abs(value - along.in_unit(start_value)))
    scale = along.scale if between else "linear"
    # A study with another skewness needs its kurtosis, and one with another corner the rest of the spectrum.
    setting = f"surfaces.{dataset.attrs['surface']}.rms_nm" if along.name == "rms_nm" else ""
    return GridAxis(along.name, along.words, along.unit.strip(), scale, shown, start, between, reason, setting)

"""Grid of the computed states of a device for the controls of its page."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtr

from stiction.answer.data import Answer
from stiction.config.kinds import KEYS, kind_of
from stiction.config.units import from_si
from stiction.contact.air import has_dry, is_humid
from stiction.devices.risk import SCORES, quantiles
from stiction.report.devices import levels
from stiction.report.devices.curves import Curves
from stiction.report.devices.grid import Grid, GridAxis
from stiction.report.devices.levels import Simulated
from stiction.report.format import UM, UN, safe_size
from stiction.stages.devices.stoppers import bounded_share

#: Title of a view of a device in its own airs.
_ALONE = "the device itself"
#: Fractions of places that hold more than a force.
_FRACTIONS = (0.05, 0.25, 0.5)
#: Part of a size beyond the smallest and largest computed ones that a control reaches.
_ROOM = 0.05


@dataclass(frozen=True)
class View:
    """Grid that the controls of a page move on."""

    title: str
    grid: Grid | Curves
    words: Mapping[str, str]  #: that differ between beams and stoppers


def beside(view: View, answer: Answer) -> View:
    """View of simulated limits that names the size to build beside them."""
    if answer.forbidden or not np.isfinite(answer.build):
        return view
    build = f"{answer.sought.name} to build, with everything inside: {safe_size(answer.build, answer.sought)}"
    return replace(view, words={**view.words, "safe": f"{view.words['safe']} ({build})"})


def content(name: str, section: Mapping[str, Any], views: Sequence[View]) -> dict:
    """Content of the controls of the page of a device."""
    keys_of_device = {key: value for key, value in section.items() if key in kind_of(section).allowed_keys}
    return {
        "name": name,
        "section": keys_of_device,
        "views": [asdict(view) | {"grid": view.grid.json} for view in views],
    }


def views_of_beam(
    name: str,
    section: Mapping[str, Any],
    safe_lengths: Mapping[float, xr.Dataset],
    charts: Mapping[float, xr.Dataset],
    answer: Answer,
) -> list[View]:
    """Views of a cantilever or bridge, the first of which begins with the number of its answer.

    It is the one over the chart, or, if the chart has neither the device itself nor its worst air, the device alone.
    """
    view = beam_view(name, section, safe_lengths, charts, answer)
    state = answer.together.humidity, section["thickness_um"], section["gap_um"]
    if all(np.isclose(axis.values, value, rtol=1e-9).any() for axis, value in zip(view.grid.axes, state, strict=True)):
        return [view]
    return [replace(beam_view(name, section, safe_lengths, {}, answer), title=_ALONE), view]


def beam_view(
    name: str,
    section: Mapping[str, Any],
    safe_lengths: Mapping[float, xr.Dataset],
    charts: Mapping[float, xr.Dataset],
    answer: Answer,
) -> View:
    """View of a cantilever or bridge, with its datasets by humidity. Charts may be empty."""
    humid = {humidity: chart for humidity, chart in sorted(charts.items()) if is_humid(humidity)}
    itself = alone(section, safe_lengths)
    joined = _chart_views(humid) if humid else itself
    worst, chart = answer.together.humidity, f"devices.{name}.chart"
    axes = (
        humidity_axis(
            joined.humidity.values, worst, f"{chart}.humidities" if humid else f"devices.{name}.humidities", humid
        ),
        _size_axis("thickness_um", "thickness", joined.thickness.values / UM, section, f"{chart}.thicknesses_um"),
        _size_axis("gap_um", "gap", joined.gap.values / UM, section, f"{chart}.gaps_um"),
    )
    layers = levels.of_answer(
        answer, joined.humidity.values, _simulated(joined, answer), _of_device_itself(joined, itself, answer)
    )
    build, sizes = layers.factor * joined.safe_length.values / UM, layers.sizes / UM
    start = section.get("length_um", _start_length(answer, float(np.nanmin(joined.safe_length)) / UM))
    size = size_axis("length_um", "length", "µm", (build, sizes[0]), start)
    share = share_axis(joined.share.values, answer.share, "shares")
    shown = {"scores": layers.scores, "first": layers.first / UM}
    grid = Grid(axes, share, size, build, sizes, int(joined.beams), False, **shown)
    words = {"what": "length", "safe": "Length to build", "bound": "to build"} | _all_airs(answer)
    words |= {"stick": "Devices of this length that stick"}
    return View("sizes and air", grid, words)


def _all_airs(answer):
    """Humidity at which the answer is that for all airs together, nothing for a single one."""
    return {"all_airs": f"{answer.together.humidity:g}"} if len(answer.airs) > 1 else {}


def _start_length(answer, otherwise):
    """Length to build as the first screen rounds it [µm], or another one if none is known."""
    return answer.sought.safe(answer.build) if np.isfinite(answer.build) else otherwise


def _simulated(dataset, answer):
    """Simulation of beams at the states of a dataset."""
    return Simulated(dataset["quantile"].values, dataset.safe_length.sel(share=answer.share).values)


def _of_device_itself(joined, itself, answer):
    """Simulation of the device itself in its airs, from the states if they have it. Dry air is beside humid ones."""
    simulated = {}
    for humidity in itself.humidity.values:
        at = {"humidity": humidity, "thickness": itself.thickness.values[0], "gap": itself.gap.values[0]}
        try:
            simulated[float(humidity)] = _simulated(joined.sel(at, method="nearest", tolerance=1e-12), answer)
        except KeyError:
            simulated[float(humidity)] = _simulated(itself.isel(thickness=0, gap=0).sel(humidity=humidity), answer)
    return _as_axis(simulated, joined.humidity.values)


def _as_axis(simulated, humidities):
    """Own airs that are humid if those of an axis are, all if none is."""
    humid = {humidity: simulation for humidity, simulation in simulated.items() if is_humid(humidity)}
    return humid if humid and not has_dry(humidities) else simulated


def _chart_views(charts):
    """Charts of all humid airs, for whatever holds the devices, over humidity, thickness, gap and share."""
    parts = [chart.isel(shape=-1).assign_coords(humidity=humidity) for humidity, chart in charts.items()]
    names = ["safe_length", "quantile"]
    joined = xr.concat([chart[names] for chart in parts], "humidity", coords="minimal", compat="override", join="exact")
    return joined.sortby("share").assign(beams=parts[0].beams).transpose("humidity", "thickness", "gap", ...)


def alone(section: Mapping[str, Any], safe_lengths: Mapping[float, xr.Dataset]) -> xr.Dataset:
    """Safe lengths of the device itself, as a chart of one thickness and gap."""
    parts = []
    for humidity, dataset in sorted(safe_lengths.items()):
        held = dataset.isel(shape=-1)
        quantiles_of_lengths = ("score", _quantiles(held.length.values, held.stuck.values, int(dataset.beams)))
        parts.append(
            held[["safe_length"]]
            .drop_vars("shape")
            .assign(quantile=quantiles_of_lengths)
            .assign_coords(humidity=humidity)
        )
    sizes = {"thickness": [section["thickness_um"] * UM], "gap": [section["gap_um"] * UM]}
    joined = xr.concat(parts, "humidity", coords="minimal", compat="override", join="exact").expand_dims(sizes)
    joined = joined.sortby("share").assign(beams=next(iter(safe_lengths.values())).beams)
    return joined.transpose("humidity", "thickness", "gap", ...)


def _quantiles(lengths, stuck, samples):
    """Lengths at `SCORES` on a curve of P(stuck), NaN beyond the first and last device on it [m]."""
    shares = ndtr(SCORES)
    inside = (shares * samples >= 0.5) & ((1 - shares) * samples >= 0.5) & (shares <= stuck[-1])
    return np.where(inside, np.interp(shares, stuck, lengths), np.nan)


def views_of_stopper(section: Mapping[str, Any], stopper: xr.Dataset, answer: Answer) -> list[View]:
    """Views of a stopper, the first of which begins with the force of its answer.

    It is the one over the humidity, or, if the worst of its airs is dry and others are humid, the device alone.
    """
    view, worst = stopper_view(section, stopper, answer), answer.together.humidity
    if worst in view.grid.axes[0].values:
        return [view]
    sorted_airs = stopper.sortby("humidity")
    axis = humidity_axis(sorted_airs.humidity.values, worst, "humidities of the device", False)
    scored = np.array([quantiles(row) for row in sorted_airs.pull_off.values])
    alone = (axis,), sorted_airs.safe_force.sel(part="safe", drop=True), scored
    return [replace(_to_build(alone, section, stopper, answer), title=_ALONE), view]


def stopper_view(section: Mapping[str, Any], stopper: xr.Dataset, answer: Answer) -> View:
    """View of a stopper over the humidity: its section, dataset of stage stoppers and answer."""
    safe, scored = _along(stopper)
    wet = is_humid(safe.axis.values)
    shown = wet if wet.any() else slice(None)
    key = "design.worst_humidities" if wet.any() else "humidities of the device"
    axis = humidity_axis(safe.axis.values[shown], answer.together.humidity, key, True)
    return _to_build(((axis,), safe.isel(axis=shown), scored[shown]), section, stopper, answer)


def _to_build(states, section, stopper, answer):
    """View of forces to build over states, their simulated limits and quantiles, as `beam_view`."""
    view, ((axis,), safe, scored) = _force_view(*states, section, stopper), states
    safe, limits = safe.sel(share=answer.share), stopper.safe_force.sel(part="safe", share=answer.share)
    simulated_airs = {
        float(forces.humidity): Simulated(quantiles(forces.values)[::-1], float(limits.sel(humidity=forces.humidity)))
        for forces in stopper.pull_off.transpose("humidity", ...)
    }
    simulated = Simulated(scored[:, ::-1], safe.values)
    layers = levels.of_answer(answer, axis.values, simulated, _as_axis(simulated_airs, axis.values))
    grid, per = view.grid, answer.size / view.grid.size.start  # of forces, or of stiffnesses
    build, sizes = layers.factor * grid.safe, layers.sizes / per
    size = size_axis(grid.size.key, grid.size.label, grid.size.unit, (build, sizes[0]), grid.size.start)
    shown = {"scores": layers.scores, "first": layers.first / per}
    words = {**view.words, "safe": f"{size.label.capitalize()} to build", "bound": "to build"}
    words |= _all_airs(answer)
    return replace(view, grid=replace(grid, size=size, safe=build, levels=sizes, **shown), words=words)


def view_of_places(stopper: xr.Dataset, answer: Answer) -> View:
    """View of the forces of places in the stated airs, from a dataset of stage stoppers and an answer."""
    airs, sought = sorted(answer.airs, key=lambda air: air.humidity), answer.sought
    axis = humidity_axis([air.humidity for air in airs], answer.together.humidity, "humidities of the device", False)
    scores, sizes = levels.of_places(answer, airs)
    forces = [stopper.pull_off.sel(humidity=air.humidity).values for air in airs]
    most = np.quantile(forces, 1 - np.array(_FRACTIONS), axis=1).T / sought.scale
    start = answer.size if np.isfinite(answer.size) else answer.pull_off.quantiles[1, 0]
    numbers = (sizes[0] / sought.scale,), start / sought.scale
    size = size_axis(sought.name, sought.label, sought.shown, *numbers, sought.fraction)
    size = replace(size, setting="measured_nN" if np.isfinite(answer.size) else "")
    share = share_axis(_FRACTIONS, _FRACTIONS[-1], "", "fraction p of places that hold more")
    shown = {"scores": scores, "first": np.array([[air.first] for air in airs]) / sought.scale}
    words = {"what": sought.label, "bound": "force that places exceed", "share": sought.fraction}
    words |= {"stick": "Measurements that give more", "safe": "Force that places exceed, by simulation alone,"}
    grid = Grid((axis,), share, size, most, sizes / sought.scale, stopper.sizes["sample"], True, **shown)
    return View("places", grid, words)


def _along(stopper):
    """Safe forces along the fine axis of a stopper with its own humidities on it, and quantiles of the forces."""
    airs, fine = stopper.humidity.values, stopper.axis.values
    kept = np.array([not np.isclose(airs, value).any() for value in fine])
    order = np.argsort(np.append(airs, fine[kept]))
    stated = stopper.safe_force.sel(part="safe", drop=True).rename(humidity="axis")
    scored = np.array([quantiles(row) for row in stopper.pull_off.values])
    safe = xr.concat([stated, stopper.safe_force_along.isel(axis=kept)], "axis", coords="minimal", compat="override")
    return safe.isel(axis=order), np.concatenate([scored, stopper.scored_along.values[kept]])[order]


def tilted_view(name: str, section: Mapping[str, Any], tilted: xr.Dataset, stopper: xr.Dataset) -> View:
    """View of a stopper over its tilts: its section, datasets of stages tilted_stoppers and stoppers."""
    tilted, key = tilted.sortby("humidity"), f"devices.{name}"
    tilts = tuple(float(f"{from_si(float(tilt), 'deg'):.6g}") for tilt in tilted.tilt)
    reason = f"it is computed at {', '.join(f'{tilt:g}' for tilt in tilts)}° alone; {key}.tilt_deg changes this"
    tilt = GridAxis("tilt_deg", "tilt", "°", "linear", tilts, tilts[0], False, reason, "tilt_deg")
    stuck = tilted.stuck.sel(bound="estimate").max("tilt")
    worst = float(tilted.humidity[int(np.argmax(stuck.values))])
    humidity = humidity_axis(tilted.humidity.values, worst, f"{key}.humidities", False)
    scored = np.apply_along_axis(quantiles, -1, tilted.pull_off.transpose("tilt", "humidity", "sample").values)
    safe = tilted.safe_force.sel(part="safe").transpose("tilt", "humidity", "share")
    return replace(_force_view((tilt, humidity), safe, scored, section, stopper), title="tilt")


def _force_view(axes, safe, scored, section, stopper):
    """View of safe forces (axes, shares) and quantiles of forces (axes, scores) [N]."""
    bounded = np.isfinite(safe.values).all(axis=tuple(range(len(axes))))
    bounded_shares = safe.isel(share=bounded if bounded.any() else [int(np.argmax(safe.share.values))]).sortby("share")
    way = kind_of(section).way(section)
    key, per = way.keys[0], UN * way.per(section)
    label, unit = KEYS[key]
    numbers = bounded_shares.values / per, scored / per
    size = size_axis(key, label, unit, numbers, float(stopper.restoring_force) / per)
    least = bounded_share(stopper)
    share = share_axis(
        bounded_shares.share.values,
        least if least in bounded_shares.share.values else float(bounded_shares.share[-1]),
        "",
    )
    layers = levels.counted(numbers[1][..., ::-1], stopper.sizes["sample"])
    grid = Grid(axes, share, size, numbers[0], layers, stopper.sizes["sample"], True)
    words = {"what": label, "safe": f"{label.capitalize()} that simulation alone allows", "bound": "limit"}
    words |= {"stick": f"Stoppers with this {label} that stick"}
    return View("humidity", grid, words)


def humidity_axis(values: Sequence[float], worst: float, key: str, between: bool) -> GridAxis:
    """Axis of relative humidities."""
    values = tuple(map(float, values))
    several = between and len(values) > 1
    each = ", ".join(f"{value:g}" if value else "0 (dry air)" for value in values)
    text = f"computed from {values[0]:g} to {values[-1]:g}" if several else f"computed at {each} alone"
    start = min(max(worst, values[0]), values[-1]) if between else worst
    reason = f"it is {text}; {key} changes this"
    return GridAxis("humidity", "relative humidity", "", "linear", values, start, bool(between), reason, "humidities")


def _size_axis(key, label, values, section, key_of_values):
    """Axis of thicknesses or gaps [µm]."""
    values = tuple(float(f"{value:.9g}") for value in values)
    several = len(values) > 1
    text = f"computed from {values[0]:g} to {values[-1]:g} µm" if several else f"computed for {values[0]:g} µm alone"
    start = min(max(float(section[key]), values[0]), values[-1])
    return GridAxis(key, label, "µm", "log", values, start, several, f"it is {text}; {key_of_values} changes this", key)


def share_axis(
    values: Sequence[float], start: float, setting: str, label: str = "fraction p that may stick"
) -> GridAxis:
    """Axis of the fractions that may stick. Only beams have a key of them."""
    values = tuple(map(float, values))
    several = f"from {values[0]:g} to {values[-1]:g}" if len(values) > 1 else f"= {values[0]:g} alone"
    reason = f"limits are computed for p {several}"
    reason += f"; design.{setting} changes this" if setting else ""
    return GridAxis("share", label, "", "score", values, float(start), len(values) > 1, reason, setting)


def size_axis(
    key: str, label: str, unit: str, sizes: Sequence[np.ndarray], start: float, fraction: str = "P(stuck)"
) -> GridAxis:
    """Axis of lengths or forces, around all computed ones and the first of a page."""
    numbers = np.concatenate([np.ravel(values) for values in sizes])
    numbers = np.append(numbers[np.isfinite(numbers)], start)
    low, high = (float(f"{value:.3g}") for value in (numbers.min() * (1 - _ROOM), numbers.max() * (1 + _ROOM)))
    reason = f"{fraction} is known between {low:g} and {high:g} {unit}"
    return GridAxis(key, label, unit, "linear", (low, high), float(f"{start:.4g}"), True, reason, key)

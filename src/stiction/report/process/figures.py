"""Figures of processes: devices over one process with bands or over two as maps, and the laws of the surfaces."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure

from stiction.config.cases import Air
from stiction.config.surfaces import process
from stiction.report.format import TO_NM, TO_UM
from stiction.report.style import (
    DOUBLE,
    INTERVAL,
    SINGLE,
    columns_of_panels,
    figure_stage,
    handles,
    humidity_colours,
    legend_outside,
    letter,
    panels,
    plain_log,
    styled,
)
from stiction.stages.axes.law import law_of, plain
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import FORCE

#: Quantities of a surface on an axis: words and function of the unscaled quantity.
_SHOWN = {
    "rms": ("rms [nm]", lambda values: TO_NM * np.exp(values)),
    "skewness": ("skewness", lambda values: values),
    "kurtosis": ("kurtosis", lambda values: values),
    "corner": ("corner [rad/µm]", lambda values: np.exp(values) / TO_UM),
    "slope": ("slope of the spectrum", lambda values: values),
}
#: Number of values along a law.
_POINTS = 101


@styled
def devices(curve: xr.Dataset, recommended: xr.Dataset, device: str) -> Figure:
    """Estimate of a device over a process variable, with its 95 % band, the required value and the best setting.

    A panel for each end state. Grey: the settings that suffice at all humidities and against all end states.
    """
    shapes = list(map(str, curve["shape"].values))
    figure, axes = panels(1, len(shapes), (min(DOUBLE, 1.3 * SINGLE * len(shapes)), 3.0))
    own, along = ("restoring force", "force needed [µN]") if shapes == [FORCE] else ("required length", "length [µm]")
    one, unit = recommended.sel(who=device), process.unit_of(curve.variable)
    for panel, shape in zip(axes[0], shapes, strict=True):
        for humidity, colour in humidity_colours(curve.humidity.values.tolist()).items():
            _band(panel, curve.sel(humidity=humidity, shape=shape), colour)
        panel.axhline(TO_UM * float(curve.required), color="black", linewidth=0.8, label=own)
        for low, high in one.sufficient.values[np.isfinite(one.sufficient.values[:, 0])]:
            panel.axvspan(low, high, color="0.9", zorder=0, label="next run suffices, 95 %")
        at = [[float(one.best) - float(one.best_interval[0])], [float(one.best_interval[1]) - float(one.best)]]
        place = float(one.best), TO_UM * float(curve.required)
        panel.errorbar(
            *place, xerr=np.maximum(at, 0), fmt="D", color="black", markersize=4, label="best and 95 % interval"
        )
        panel.set_yscale("log")
        plain_log(panel.yaxis)
        panel.set_xlabel(f"{process.words_of(curve.variable)} [{unit}]")
    axes[0, 0].set_ylabel(f"{along}, p = {float(curve.share):g}")
    letter(axes, [END_STATES[shape].by for shape in shapes])
    legend_outside(figure, handles(*axes[0]), "lower", 2 * len(shapes))
    return figure


def _band(panel, line, colour):
    """Estimate at one humidity, with the bands of the mean process and, wider, of the next run."""
    x, estimate, parts = line.value.values, TO_UM * line.estimate.values, ("simulation", "law", "model")
    for names in (parts, (*parts, "run")):
        factor = np.exp(INTERVAL * np.sqrt(sum(line[f"{name}_error"].values ** 2 for name in names)))
        panel.fill_between(x, estimate / factor, estimate * factor, color=colour, alpha=0.15, linewidth=0)
    panel.plot(
        x,
        estimate,
        ".-",
        color=colour,
        label=f"{Air(float(line.humidity)).words}, estimate, 95 % bands of mean and next run",
    )


@styled
def laws(law: xr.Dataset) -> Figure:
    """Quantities of a surface over a process variable: settings with their errors, and the law with its 95 % band."""
    fitted, names = law_of(law), list(map(str, law["quantity"].values))
    figure, columns, _ = columns_of_panels(len(names), 1, lambda count: min(DOUBLE, 2.4 * count), 2.2)
    values = np.linspace(*fitted.ends, _POINTS)
    curves = plain(fitted.at(values), fitted.covariance_at(values), names)
    points = plain(law.measured.values, law.errors.values, names)
    for k, (name, (panel, *_)) in enumerate(zip(names, columns, strict=True)):
        words, shown = _SHOWN[name]
        low, line, high = (shown(curves[0][:, k] + INTERVAL * sign * curves[1][:, k]) for sign in (-1, 0, 1))
        below, at, above = (shown(points[0][:, k] + INTERVAL * sign * points[1][:, k]) for sign in (-1, 0, 1))
        panel.fill_between(values, low, high, color="0.85", linewidth=0, label="95 % band of the law")
        panel.plot(values, line, color="black", label="law")
        panel.errorbar(
            law.setting.values, at, yerr=[at - below, above - at], fmt="o", markersize=3, label="settings, 95 %"
        )
        panel.set_xlabel(f"{process.words_of(law.variable)} [{process.unit_of(law.variable)}]")
        panel.set_ylabel(words)
    legend_outside(figure, handles(columns[0][0]), "lower", 3)
    return figure


@styled
def process_map(found: xr.Dataset, pairs: xr.Dataset) -> Figure:
    """Smallest margin of a device over two processes, with its lines of zero margin and the best pair."""
    figure, ((panel,),) = panels(1, 1, (1.5 * SINGLE, 3.4))
    x, y, best, interval = pairs["value"].values, pairs.second.values, pairs.best.values, pairs.best_interval.values
    levels = np.ma.masked_invalid(pairs.margin.values / np.log(10))
    if levels.count():
        colours = panel.contourf(x, y, levels, 12, cmap="RdBu", norm=CenteredNorm())
        figure.colorbar(colours, ax=panel, label="lg (smallest margin)")
    for name, line, words in (
        ("margin", "-", "estimate meets the requirement"),
        ("safe", "--", "with 95 % confidence"),
    ):
        values = pairs[name].values
        if np.nanmin(values, initial=np.inf) < 0 < np.nanmax(values, initial=-np.inf):
            panel.contour(x, y, values, [0], colors="black", linestyles=line)
            panel.plot([], [], line, color="black", label=words)
    panel.plot(
        *map(np.ravel, np.meshgrid(found["value"], found.second)), ".", color="0.3", markersize=2, label="computed"
    )
    reach = np.abs(interval - best[:, None])[..., None]
    panel.errorbar(
        *best,
        xerr=reach[0],
        yerr=reach[1],
        fmt="D",
        color="black",
        markersize=4,
        label="best, 95 % intervals",
        clip_on=False,
    )
    for scale, variable in ((panel.set_xlabel, "variable"), (panel.set_ylabel, "second_variable")):
        name = found.attrs[variable]
        scale(f"{process.words_of(name)} [{process.unit_of(name)}]")
    legend_outside(figure, handles(panel), "lower", 2)
    return figure


def _jobs(names: Sequence[str], wildcard: str) -> list[dict]:
    """Wildcards of the jobs of some names."""
    return [{wildcard: name} for name in names]


STAGES = (
    figure_stage(
        "process_{device}",
        "which settings of its process leave {device} free",
        "Devices",
        inputs=lambda plan, at: {
            "curve": f"process/curves/{at.device}",
            "recommended": f"process/settings/{process.variable_of(plan.config, at.device)}",
        },
        compute=devices,
        jobs=lambda plan: _jobs(plan.devices.over_process, "device"),
        targets=("devices",),
    ),
    figure_stage(
        "process_law_{process}",
        "surface over the variable of process {process}",
        "Devices",
        inputs=lambda plan, at: {"law": f"process/laws/{at.process}"},
        compute=laws,
        jobs=lambda plan: _jobs(process.used_processes(plan.config), "process"),
        targets=("devices",),
    ),
    figure_stage(
        "process_map_{device}",
        "which pairs of settings of two processes leave {device} free",
        "Devices",
        inputs=lambda plan, at: {"map": f"process/maps/{at.device}", "pairs": f"process/pairs/{at.device}"},
        compute=lambda data: process_map(data["map"], data["pairs"]),
        jobs=lambda plan: [{"device": name} for name in plan.devices.processed_twice],
        targets=("devices",),
    ),
)

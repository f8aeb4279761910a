"""Figure of roughness: safe length or force against the roughness of a surface, and sufficient roughnesses."""

import numpy as np
import xarray as xr
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure

from stiction.config.cases import Air
from stiction.config.kinds import ROUGHNESSES
from stiction.devices.roughness import margins
from stiction.report.format import TO_UM
from stiction.report.roughness.tables import in_unit, quantity_with_unit
from stiction.report.style import (
    DOUBLE,
    INTERVAL,
    SINGLE,
    figure_stage,
    handles,
    humidity_colours,
    legend_outside,
    letter,
    panels,
    plain_log,
    styled,
)
from stiction.stages.axes.roughness import KURTOSIS, curves_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import FORCE

#: What meets a requirement with confidence, and what is expected to.
_VALUES = ("safe", "estimate")


@styled
def roughness(dataset: xr.Dataset) -> Figure:
    """Estimate with its band of 95 %, safe value and crossings with the required one. A panel for each end state.

    Of a map, the curve with the second quantity as given is drawn.
    """
    as_given = (one for one in curves_of(dataset) if "other" not in one.coords or one.other == one.other_given)
    curve = next(as_given)
    shapes = list(map(str, curve["shape"].values))
    figure, axes = panels(1, len(shapes), (min(DOUBLE, 1.3 * SINGLE * len(shapes)), 3.0))
    own, along = ("restoring force", "force needed [µN]") if shapes == [FORCE] else ("required length", "length [µm]")
    for panel, shape in zip(axes[0], shapes, strict=True):
        for humidity, colour in humidity_colours(curve.humidity.values.tolist()).items():
            _curve(panel, curve.sel(humidity=humidity, shape=shape), colour)
            _crossings(panel, curve, (humidity, shape), colour)
        panel.axhline(TO_UM * float(curve.required), color="black", linewidth=0.8, label=own)
        panel.axvline(in_unit(curve, float(curve.given)), color="0.6", linestyle=":", label="as given")
        panel.set_yscale("log")
        plain_log(panel.yaxis)
        _axis(panel.xaxis, panel.set_xscale, curve)
    axes[0, 0].set_ylabel(f"{along}, p = {float(curve.share):g}")
    letter(axes, [END_STATES[shape].by for shape in shapes])
    legend_outside(figure, handles(*axes[0]), "lower", 2 * len(shapes))
    return figure


def _curve(panel, line, colour):
    """Estimate of one humidity with its band, and the safe values."""
    x, estimate = in_unit(line, line.roughness.values), TO_UM * line.estimate.values
    reach = INTERVAL * TO_UM * line.error.values
    panel.fill_between(x, estimate - reach, estimate + reach, color=colour, alpha=0.2, linewidth=0)
    panel.plot(x, estimate, ".-", color=colour, label=f"{Air(float(line.humidity)).words}, estimate and 95 % band")
    panel.plot(x, TO_UM * line.safe.values, "_", color=colour, markersize=8, label="safe, 95 % confidence")
    if np.isfinite(line.bound.values).any():
        state = END_STATES[str(line["shape"].values)]
        panel.plot(
            x,
            TO_UM * line.bound.values,
            state.lines[1],
            color=colour,
            linewidth=0.8,
            label=f"flat surfaces, {state.by}",
        )


def _crossings(panel, curve, subject, colour):
    """Places with the requirement met by a curve, with their 95 % intervals."""
    own = np.array(
        [at == subject for at in zip(curve.crossing_humidity.values, curve.crossing_shape.values, strict=True)]
    )
    places, errors = (curve[name].values[own.astype(bool)] for name in ("crossing_place", "crossing_error"))
    if len(places):
        at, error = in_unit(curve, places), INTERVAL * in_unit(curve, errors)
        height = np.full(len(at), TO_UM * float(curve.required))
        panel.errorbar(at, height, xerr=error, fmt="o", color=colour, fillstyle="none", zorder=3)


@styled
def roughness_map(data: xr.Dataset) -> Figure:
    """Margin to the requirement, and lines of zero margin, against the two quantities of a dataset of stage roughness.

    The panels are by humidity and end state.
    """
    humidities, shapes = data.humidity.values, list(map(str, data["shape"].values))
    size = min(DOUBLE, 1.3 * SINGLE * len(shapes)), 2.8 * len(humidities)
    figure, axes = panels(len(humidities), len(shapes), size)
    more_is_better = data.required.attrs["units"] == "m"
    margin = "length / required length" if more_is_better else "restoring force / force needed"
    x, y = in_unit(data, data.roughness.values), in_unit(data, data.other.values, "other_key")
    for row, humidity in zip(axes, humidities, strict=True):
        for panel, shape in zip(row, shapes, strict=True):
            curve = data.sel(humidity=humidity, shape=shape).transpose("other", "roughness", ...)
            safe, estimate = (margins(curve[name].values, float(data.required), more_is_better) for name in _VALUES)
            colours = panel.contourf(
                x, y, np.ma.masked_invalid(estimate / np.log(10)), 12, cmap="RdBu", norm=CenteredNorm()
            )
            figure.colorbar(colours, ax=panel, label=f"lg ({margin})")
            for values, line in ((estimate, "-"), (safe, "--")):
                if np.nanmin(values) < 0 < np.nanmax(values):
                    panel.contour(x, y, np.ma.masked_invalid(values), [0], colors="black", linestyles=line)
            panel.plot(*map(np.ravel, np.meshgrid(x, y)), ".", color="0.3", markersize=2)
            panel.plot(in_unit(data, float(data.given)), in_unit(data, float(data.other_given), "other_key"), "k+")
            _axis(panel.xaxis, panel.set_xscale, data)
            _axis(panel.yaxis, panel.set_yscale, data, "other")
            panel.set_title(f"{END_STATES[shape].by}, {Air(humidity).words}")
    return figure


def _axis(axis, scale, data, dimension="roughness"):
    """Scale and label of a varied quantity. A skewness has its kurtosis in brackets at every computed value."""
    key = "key" if dimension == "roughness" else "other_key"
    axis.set_label_text(quantity_with_unit(data, key))
    if ROUGHNESSES[data.attrs[key]].logarithmic:
        scale("log")
        plain_log(axis)
    if data.attrs[key] == "skewness":
        along = data[KURTOSIS].isel({other: 0 for other in data[KURTOSIS].dims if other != dimension})
        texts = [
            f"{at:.3g}\n({kurtosis:.3g})" for at, kurtosis in zip(along[dimension].values, along.values, strict=True)
        ]
        axis.set_ticks(along[dimension].values, texts)
        axis.set_label_text(f"{quantity_with_unit(data, key)} (kurtosis)")


def _stage(name, shows, draw, devices):
    """Stage for a figure of each of some devices of a plan."""
    return figure_stage(
        f"{name}_{{device}}",
        shows,
        "Devices",
        inputs=lambda plan, at: {"roughness": f"devices/roughness/{at.device}"},
        compute=lambda data: draw(data["roughness"]),
        jobs=lambda plan: [{"device": device} for device in devices(plan)],
        targets=("devices",),
    )


STAGES = (
    _stage(
        "roughness", "how rough the surfaces of {device} must be", roughness, lambda plan: plan.devices.over_roughness
    ),
    _stage(
        "roughness_map",
        "how rough the surfaces of {device} must be, over two quantities",
        roughness_map,
        lambda plan: plan.devices.over_two_quantities,
    ),
)

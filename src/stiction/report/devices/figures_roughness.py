"""Figure of roughness: safe length or force over the roughness of a surface, and which roughness suffices."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stiction.config.kinds import ROUGHNESSES
from stiction.report.devices.tables_roughness import in_unit, labelled
from stiction.report.format import TO_UM
from stiction.report.style import DOUBLE, SINGLE, figure_stage, letter, panels, plain_log, shades, styled
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.releases import FORCE

#: Lightest colour of a curve; half width of an interval that holds 95 %, in standard errors.
_LIGHTEST, _INTERVAL = 0.25, 1.96


@styled
def roughness(found: xr.Dataset) -> Figure:
    """Estimate with its band of 95 %, safe value and crossings with the required one; a panel for each end state.

    Parameters
    ----------
    found : Dataset
        Of stage roughness of one device.
    """
    shapes = list(map(str, found["shape"].values))
    figure, axes = panels(1, len(shapes), (min(DOUBLE, 1.3 * SINGLE * len(shapes)), 3.0))
    what = ROUGHNESSES[found.attrs["key"]]
    for panel, shape in zip(axes[0], shapes, strict=True):
        for humidity, shade in zip(found.humidity.values, shades(found.sizes["humidity"], _LIGHTEST), strict=True):
            _curve(panel, found.sel(humidity=humidity, shape=shape), shade)
            _crossings(panel, found, (float(humidity), shape), shade)
        panel.axhline(TO_UM * float(found.required), color="black", linewidth=0.8, label="required")
        panel.axvline(in_unit(found, float(found.given)), color="0.6", linestyle=":", label="as given")
        panel.set(yscale="log", xlabel=labelled(found))
        plain_log(panel.yaxis)
        if what.logarithmic:
            panel.set_xscale("log")
            plain_log(panel.xaxis)
    axes[0, 0].set_ylabel(
        f"{'restoring force [µN]' if shapes == [FORCE] else 'length [µm]'}, p = {float(found.share):g}"
    )
    letter(axes, [END_STATES[shape].by for shape in shapes])
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2 * len(shapes))
    return figure


def _curve(panel, one, colour):
    """Estimate of one humidity with its band, and the safe values."""
    x, estimate = in_unit(one, one.roughness.values), TO_UM * one.estimate.values
    reach = _INTERVAL * TO_UM * one.error.values
    panel.fill_between(x, estimate - reach, estimate + reach, color=colour, alpha=0.2, linewidth=0)
    panel.plot(x, estimate, ".-", color=colour, label=f"RH {float(one.humidity):g}, estimate and 95 % band")
    panel.plot(x, TO_UM * one.safe.values, "_", color=colour, markersize=8, label="safe, 95 % confidence")
    if np.isfinite(one.bound.values).any():
        state = END_STATES[str(one["shape"].values)]
        panel.plot(x, TO_UM * one.bound.values, state.lines[1], color=colour, linewidth=0.8, label=state.bound)


def _crossings(panel, found, subject, colour):
    """Places where a curve meets what is required, with their 95 % intervals."""
    own = np.array(
        [at == subject for at in zip(found.crossing_humidity.values, found.crossing_shape.values, strict=True)]
    )
    places, errors = (found[name].values[own.astype(bool)] for name in ("crossing_place", "crossing_error"))
    if len(places):
        at, error = in_unit(found, places), _INTERVAL * in_unit(found, errors)
        height = np.full(len(at), TO_UM * float(found.required))
        panel.errorbar(at, height, xerr=error, fmt="o", color=colour, fillstyle="none", zorder=3)


STAGES = (
    figure_stage(
        "figure_roughness",
        "roughness_{device}",
        "how rough the surfaces of {device} must be",
        "Devices",
        caption="roughness",
        inputs=lambda plan, at: {"roughness": f"devices/roughness/{at.device}"},
        compute=lambda data, at, settings: roughness(data["roughness"]),
        jobs=lambda plan: [{"device": name} for name in plan.devices.roughened],
        targets=("devices",),
    ),
)

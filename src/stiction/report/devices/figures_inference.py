"""Figure of test beams: crack lengths over the humidity and inputs, before and after the measurement."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stiction.report.format import TO_UM
from stiction.report.style import DOUBLE, figure_stage, humidity_axis, letter, panels, styled

#: Colours before and after the measurement.
_BEFORE, _AFTER = "0.6", "#0072B2"
#: Height of a row of inputs and of everything else [in]; half the height of a bar in rows.
_ROW, _AROUND, _HALF = 0.19, 0.9, 0.36
#: Half width of an interval that holds 95 %, in standard deviations.
_INTERVAL = 1.96


@styled
def test_beams(found: xr.Dataset) -> Figure:
    """Measured crack lengths of each array with bands of 95 % before and after, and inputs in standard uncertainties.

    Parameters
    ----------
    found : Dataset
        Of stage test_beams of one device.
    """
    arrays = list(dict.fromkeys(map(str, found.array.values)))
    uncertain = found.isel(input=np.flatnonzero(found.prior_deviation.values > 0))
    height = max(2.4, _ROW * uncertain.sizes["input"] + _AROUND)
    figure, axes = panels(1, len(arrays) + 1, (DOUBLE, height))
    for panel, name in zip(axes[0], arrays, strict=False):
        shared = _lengths(panel, found.isel(datum=np.flatnonzero(found.array.values == name)))
    axes[0, 0].set_ylabel("crack length [µm]")
    _inputs(axes[0, -1], uncertain)
    letter(axes, [*arrays, "inputs"])
    figure.legend(handles=shared, loc="outside lower center", ncols=3)
    return figure


def _lengths(panel, data):
    """Crack lengths of one array over the humidity; returns the entries of the legend."""
    humidity, order = data.datum_humidity.values, np.argsort(data.datum_humidity.values)
    computed, shift = TO_UM * data.computed.values, data.datum_shift.values
    entries = []
    cases = (
        ("before", computed, data.datum_before, _BEFORE),
        ("after", computed * np.exp(shift), data.datum_after, _AFTER),
    )
    for name, centre, deviation, colour in cases:
        reach = np.exp(_INTERVAL * deviation.values)
        panel.fill_between(
            humidity[order], (centre / reach)[order], (centre * reach)[order], color=colour, alpha=0.25, lw=0
        )
        entries += panel.plot(humidity[order], centre[order], color=colour, label=f"{name} the measurement, 95 %")
    error = _INTERVAL * TO_UM * (data.measured * data.datum_measured_error).values
    points = panel.errorbar(
        humidity, TO_UM * data.measured, yerr=error, fmt="o", color="black", markersize=3, label="measured, 95 %"
    )
    panel.set(xlabel="relative humidity [–]", ylim=(0, None))
    humidity_axis(panel)
    return [*entries, points]


def _inputs(panel, found):
    """Inputs before and after, in standard uncertainties before the measurement."""
    places = np.arange(found.sizes["input"])
    scale = found.prior_deviation.values
    for centre, deviation, colour, half in (
        (0 * places, np.ones(len(places)), _BEFORE, _HALF),
        (found["shift"].values / scale, found.deviation.values / scale, _AFTER, _HALF / 2),
    ):
        panel.barh(places, 2 * deviation, 2 * half, left=centre - deviation, color=colour, alpha=0.6, linewidth=0)
    panel.axvline(0, color="black", linewidth=0.6)
    panel.set_yticks(places, list(found.input.values))
    panel.tick_params(axis="y", length=0)
    panel.set(ylim=(len(places) - 0.4, -0.6), xlabel="standard uncertainties")


STAGES = (
    figure_stage(
        "figure_test_beams",
        "test_beams_{device}",
        "what test beams say about {device}",
        "Devices",
        caption="test_beams",
        inputs=lambda plan, at: {"test_beams": f"devices/test_beams/{at.device}"},
        compute=lambda data, at, settings: test_beams(data["test_beams"]),
        jobs=lambda plan: [{"device": name} for name in plan.designs.tested],
        targets=("devices",),
    ),
)

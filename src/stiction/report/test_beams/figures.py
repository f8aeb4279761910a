"""Figure of test beams: crack lengths over the humidity and inputs, before and after the measurement."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stiction.contact.air import has_dry, is_humid
from stiction.report.format import TO_UM
from stiction.report.style import (
    DOUBLE,
    INTERVAL,
    figure_stage,
    humidity_axis,
    is_page,
    legend_below,
    legend_outside,
    letter,
    panels,
    places,
    styled,
)

#: Colours before and after the measurement.
_BEFORE, _AFTER = "0.6", "#0072B2"
#: Height of a row of inputs and of everything else [in]; half the height of a bar in rows.
_ROW, _AROUND, _HALF = 0.19, 0.9, 0.36
#: Marks of measured crack lengths and of the lengths of counted beams.
_POINT = {"fmt": "o", "color": "black", "markersize": 3}
_COUNT = {"marker": "D", "color": "black", "markersize": 3, "linestyle": "none", "markerfacecolor": "white"}
#: Where the numbers of a count are beside its mark.
_LEFT, _RIGHT = {"xytext": (-4, -3), "ha": "right", "va": "top"}, {"xytext": (4, 3)}
#: Largest half width of a band at a single humidity [-], also in distances to the next place.
_ALONE, _NEXT = 0.01, 0.3
#: Share of an axis as wide as the figure that the numbers of the counts in dry air need on their left.
_ROOM = 0.1
#: Share of an axis above its data, for the number of the longest counted beams.
_HEAD = 0.12
#: Change of an input that is not shown, in standard uncertainties before the measurement.
_UNMOVED = 0.1


@styled
def test_beams(update: xr.Dataset) -> Figure:
    """Measured crack lengths with bands of 95 % before and after, and inputs in units of their standard uncertainty."""
    arrays = list(dict.fromkeys(map(str, update.array.values)))
    moved, others = _moved(update)
    height = max(2.8, _ROW * moved.sizes["input"] + _AROUND)
    figure, axes = panels(1, len(arrays) + 1, (DOUBLE, height))
    shared = {}
    for panel, name in zip(axes[0], arrays, strict=False):
        chosen = {
            size: np.flatnonzero(update[key].values == name)
            for size, key in (("datum", "array"), ("count", "array_of_count"))
        }
        shared |= _lengths(panel, update.isel(chosen), _ROOM * (len(arrays) + 1))
    if arrays:
        axes[0, 0].set_ylabel("crack length [µm]")
    _inputs(axes[0, -1], moved, _names(moved, arrays))
    legend_below(axes[0, -1], _explained())
    if is_page() and arrays:
        legend_below(axes[0, -2], list(shared.values()))
    named = arrays if len(arrays) > 1 else ["crack lengths of test beams"] * len(arrays)
    letter(axes, [*named, f"inputs; {others} others hardly move" if others else "inputs"])
    if not is_page():
        legend_outside(figure, (list(shared.values()), list(shared)), "lower", 3)
    return figure


def _moved(update):
    """Inputs that the measurement moves or narrows by more than `_UNMOVED`, and the number of the others."""
    prior = update.prior_deviation.where(update.prior_deviation > 0)
    changes = np.maximum(abs(update["shift"]), abs(update.deviation - prior)) / prior
    kept = np.flatnonzero(changes.fillna(0).values > _UNMOVED)
    kept = kept if len(kept) else np.flatnonzero(prior.notnull().values)[:1]
    return update.isel(input=kept), int(prior.notnull().sum()) - len(kept)


def _names(moved, arrays):
    """Names of inputs, without that of the test beams where there are no others."""
    names = list(map(str, moved.input.values))
    return [name.replace(f" of {arrays[0]}", " of test beams") for name in names] if len(arrays) == 1 else names


def _band(humidity, indices, placed):
    """Places along a band through some humidities, in order, with a width for a single one."""
    if len(indices) == 1:
        half = min([_ALONE, *(_NEXT * np.diff(sorted(placed.values())))])
        return humidity[indices] + np.array([-half, half]), [indices[0], indices[0]]
    order = indices[np.argsort(humidity[indices])]
    return humidity[order], order


def _lengths(panel, data, room):
    """Crack lengths and counts of one array against humidity. Returns the entries of the legend by their name.

    Counts in dry air have ``room`` for their numbers, a share of the axis.
    """
    placed = places([*data.datum_humidity.values.tolist(), *data.humidity_of_count.values.tolist()])
    humidity = np.array([placed[rh] for rh in data.datum_humidity.values])
    dry = ~is_humid(data.datum_humidity.values)
    bands = [_band(humidity, indices, placed) for indices in map(np.flatnonzero, (~dry, dry)) if len(indices)]
    computed, shift = TO_UM * data.computed.values, data.datum_shift.values
    entries, on_the_left = [], _on_the_left(placed)
    cases = (
        ("before", computed, data.datum_before * data.score, _BEFORE),
        ("after", computed * np.exp(shift), data.datum_quantile, _AFTER),
    )
    for name, centre, quantiles, colour in cases:
        low, high = (computed * np.exp(quantiles.interp(score=end).values) for end in (-INTERVAL, INTERVAL))
        for along, order in bands:
            style = {"color": colour, "alpha": 0.25, "lw": 0, "label": f"{name}, 95 %"}
            entries += panel.plot(along, centre[order], color=colour, label=f"{name} the measurement")
            entries.append(panel.fill_between(along, low[order], high[order], **style))
    if data.measured.notnull().any():
        error = INTERVAL * TO_UM * (data.measured * data.datum_measured_error).values
        entries.append(panel.errorbar(humidity, TO_UM * data.measured, yerr=error, **_POINT, label="measured, 95 %"))
    for k in range(data.sizes["count"]):
        at = data.isel(count=k)
        point = placed[float(at.humidity_of_count)], TO_UM * float(at.length_of_count)
        (mark,) = panel.plot(*point, **_COUNT, label="length of counted beams, number of those that stick")
        side = _LEFT if point[0] in on_the_left else _RIGHT
        panel.annotate(f"{int(at.stuck)} of {int(at.counted)}", point, textcoords="offset points", **side)
        entries += [mark] if k == 0 else []
    panel.set(xlabel="relative humidity [–]", ylim=(0, (1 + _HEAD) * panel.dataLim.y1))
    if has_dry(data.humidity_of_count):
        left, right = panel.get_xlim()
        panel.set_xlim(min(left, (placed[0] - room * right) / (1 - room)), right)
    humidity_axis(panel, placed)
    return {entry.get_label(): entry for entry in entries}


def _on_the_left(placed):
    """Places with numbers of counts on the left: dry air, and the last of several humidities, at the frame."""
    dry, wet = ([placed[rh] for rh in placed if is_humid(rh) == humid] for humid in (False, True))
    return dry + sorted(wet)[1:][-1:]


def _explained():
    """Entries of the legend of inputs: their bars are no 95 % bands."""
    bars = (("before", _BEFORE), ("after", _AFTER))
    return [Patch(color=colour, alpha=0.6, label=f"{name}, ± 1 standard uncertainty") for name, colour in bars]


def _inputs(panel, uncertain, names):
    """Inputs of some names before and after, in standard uncertainties before the measurement."""
    places = np.arange(uncertain.sizes["input"])
    scale = uncertain.prior_deviation.values
    for centre, deviation, colour, half in (
        (0 * places, np.ones(len(places)), _BEFORE, _HALF),
        (uncertain["shift"].values / scale, uncertain.deviation.values / scale, _AFTER, _HALF / 2),
    ):
        panel.barh(places, 2 * deviation, 2 * half, left=centre - deviation, color=colour, alpha=0.6, linewidth=0)
    panel.axvline(0, color="black", linewidth=0.6)
    panel.set_yticks(places, names)
    panel.tick_params(axis="y", length=0)
    panel.use_sticky_edges = False
    panel.autoscale_view(scaley=False)
    panel.set(ylim=(len(places) - 0.4, -0.6), xlabel="value in standard uncertainties before [–]")


STAGES = (
    figure_stage(
        "test_beams_{device}",
        "what test beams say about {device}",
        "Devices",
        inputs=lambda plan, at: {"test_beams": f"devices/test_beams/{at.device}"},
        compute=lambda data: test_beams(data["test_beams"]),
        jobs=lambda plan: [{"device": name} for name in plan.devices.with_test_beams],
        targets=("devices",),
    ),
)

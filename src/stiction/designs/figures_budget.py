"""Figures of stoppers and of the uncertainty of devices."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stiction.designs.budget import budget_of, groups_of
from stiction.designs.figures_devices import below
from stiction.designs.tables_budget import RESPONSES, SCATTER, TOTAL
from stiction.devices.risk import stuck_share
from stiction.report.format import TO_UN
from stiction.report.style import (
    DOUBLE,
    OUTLINED,
    SINGLE,
    columns_of_panels,
    dashes,
    humidity_axis,
    letter,
    panels,
    styled,
)
from stiction.report.tables_studies import variant_label

_COLOUR, _CHOICE, _NEUTRAL = "#0072B2", "#D55E00", "0.6"
_BESIDE = {"xycoords": "data", "textcoords": "offset points", "fontsize": 6, "va": "center"}
#: Height of one bar and of everything else in a panel of the budget [in].
_BAR, _AROUND = 0.17, 0.62


# Stoppers


@styled
def stoppers(datasets: Mapping[str, xr.Dataset], warnings: Mapping[str, Sequence[str]]) -> Figure:
    """Stoppers: P(stuck) over the restoring force, and pull-off force over the humidity; a column for each.

    Parameters
    ----------
    datasets : dict
        Device to the dataset of stage stoppers.
    warnings : dict
        Device to sentences, which are written below the figure.
    """
    figure, columns, lines = columns_of_panels(len(datasets), 2, lambda n: min(DOUBLE, SINGLE * n), 4.4)
    for column, dataset in zip(columns, datasets.values(), strict=True):
        _stuck_over_force(column[0], dataset)
        _force_over_humidity(column[1], dataset)
    for line in lines:
        line[0, 0].set_ylabel("P(stuck) [–]")
        line[1, 0].set_ylabel("pull-off force [µN]")
    letter(np.concatenate([line.ravel() for line in lines]), [name for name in datasets for _ in range(2)])
    below(figure, [f"{device}: {sentence}" for device, found in warnings.items() for sentence in found])
    return figure


def _stuck_over_force(panel, dataset):
    """Share of the patches that hold more than a force, at every humidity of the device, with its band."""
    restoring = TO_UN * float(dataset.restoring_force)
    for k, humidity in enumerate(dataset.humidity.values):
        forces = TO_UN * dataset.pull_off.sel(humidity=humidity).values
        at = np.sort(forces)
        share, low, high = stuck_share(-at, -forces)
        panel.plot(at, share, color=f"C{k}", linestyle=dashes(k), label=f"RH {humidity:g}")
        panel.fill_between(at, low, high, color=f"C{k}", alpha=0.2, linewidth=0)
    panel.axvline(restoring, color="0.4", linestyle=":", linewidth=0.8)
    panel.annotate(
        "restoring force",
        (restoring, 0.03),
        (2, 0),
        panel.get_xaxis_transform(),
        "offset points",
        fontsize=7,
        path_effects=OUTLINED,
    )
    panel.set(xlabel="restoring force [µN]", yscale="log", xlim=(0, None), ylim=(0.5 / dataset.sizes["sample"], 1.3))
    panel.legend(loc="upper right")


def _force_over_humidity(panel, dataset):
    """Mean and 5 to 95 % of the pull-off force along the fine axis, and the worst humidity."""
    low, high = (TO_UN * dataset.quantile_along.sel(probability=p) for p in dataset.probability.values[[0, -1]])
    panel.fill_between(dataset.axis, low, high, color=_COLOUR, alpha=0.2, linewidth=0, label="5 to 95 % of the patches")
    panel.plot(dataset.axis, TO_UN * dataset.mean_along, color=_COLOUR, label="mean")
    panel.axhline(TO_UN * float(dataset.restoring_force), color="0.4", linestyle=":", linewidth=0.8)
    worst = float(dataset.worst_humidity)
    top = TO_UN * float(dataset.mean_along.max())
    panel.plot([worst], [top], "v", color="black", label=f"worst humidity {worst:.2f}")
    panel.set(xlabel="relative humidity [–]", ylim=(0, None))
    humidity_axis(panel)
    panel.legend(loc="upper left")


# Budget


@styled
def budget(datasets: Mapping[tuple[str, float], xr.Dataset]) -> Figure:
    """Tornado of every device: effect of each measurement, total, scatter and choices of the model, at every humidity.

    Parameters
    ----------
    datasets : dict
        (device, humidity) to the dataset of stage budget.
    """
    devices = {device: {h: data for (name, h), data in datasets.items() if name == device} for device, _ in datasets}
    bars = {device: _bars(cases) for device, cases in devices.items()}
    heights = [_BAR * sum(len(row) for row in rows.values()) + _AROUND for rows in bars.values()]
    figure, axes = panels(len(devices), 1, (DOUBLE, sum(heights) + 0.3), height_ratios=heights)
    for panel, (device, rows) in zip(axes[:, 0], bars.items(), strict=True):
        _tornado(panel, rows, list(devices[device]))
        response = RESPONSES[next(iter(devices[device].values()))["mean"].attrs["units"]]
        panel.set_xlabel(f"change of the {response} [%]")
    letter(axes, list(devices))
    marks = {"measurements": _COLOUR, "total and scatter": _NEUTRAL, "choices of the model": _CHOICE}
    figure.legend(
        [Patch(color=colour) for colour in marks.values()], list(marks), loc="outside lower center", ncols=len(marks)
    )
    return figure


def _bars(cases):
    """Rows of a tornado, the largest measurement first: name to (low, high, error, colour) at every humidity [%]."""
    first = next(iter(cases.values()))
    found = {humidity: budget_of(dataset) for humidity, dataset in cases.items()}
    groups = groups_of(first)
    largest = sorted(groups, key=lambda name: -max(budget.effect(groups[name]) for budget in found.values()))
    rows = {}
    for name in largest:
        rows[name] = [
            _both_sides(budget.effect(groups[name]), budget.error_of_effect(groups[name], data.slope_error.values))
            for budget, data in zip(found.values(), cases.values(), strict=True)
        ]
    rows[TOTAL] = [
        _both_sides(budget.total, budget.error_of_effect(budget.names, data.slope_error.values), _NEUTRAL)
        for budget, data in zip(found.values(), cases.values(), strict=True)
    ]
    rows[SCATTER] = [_both_sides(float(data.scatter), 0.0, _NEUTRAL) for data in cases.values()]
    for choice in first.choice.values:
        chosen = [data.sel(choice=choice) for data in cases.values()]
        rows[f"choice: {variant_label(str(choice))}"] = [
            (*sorted((0.0, 100 * float(data.effect))), 100 * float(data.effect_error), _CHOICE) for data in chosen
        ]
    return rows


def _both_sides(effect, error, colour=_COLOUR):
    """Bar of an effect in both directions."""
    return -100 * effect, 100 * effect, 100 * error, colour


def _tornado(panel, rows: Mapping[str, Sequence[tuple]], humidities: Sequence[float]):
    """Draw the rows from top to bottom; the bars of a row are those of the humidities, which a text names."""
    place, ticks = 0.0, []
    widest = max(max(-low, high) + error for row in rows.values() for low, high, error, _ in row)
    for row in rows.values():
        ticks.append(place + (len(row) - 1) / 2)
        for k, (low, high, error, colour) in enumerate(row):
            panel.barh(place + k, high - low, 0.8, left=low, color=colour, alpha=1 - 0.25 * k, linewidth=0)
            end = high if high > -low else low
            panel.errorbar(end, place + k, xerr=error, color="black", linewidth=0.6, capsize=1)
            if len(humidities) > 1:
                beyond = high + error * (end == high)
                panel.annotate(f"RH {humidities[k]:g}", (beyond, place + k), (4, 0), **_BESIDE)
        place += len(row) + 0.6
    panel.axvline(0, color="black", linewidth=0.6)
    panel.set_yticks(ticks, list(rows))
    panel.tick_params(axis="y", length=0)
    panel.set(ylim=(place - 0.8, -0.8), xlim=(-1.1 * widest, 1.2 * widest))

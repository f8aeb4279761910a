"""Figures of stoppers and of the uncertainty of devices."""

import textwrap
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stiction.answer.data import Answer
from stiction.contact.air import Air, is_humid
from stiction.devices.limits.limit import Limit
from stiction.devices.risk import one_in
from stiction.devices.stoppers import stuck_patches
from stiction.plan.names import by_name
from stiction.report.answer.tables import of_datasets
from stiction.report.answer.words import is_forbidden, to_build_beside, unasked
from stiction.report.budget.tables import choice_label, response_text
from stiction.report.format import TO_UN, bounding, number, safe_size
from stiction.report.limits import words
from stiction.report.style import (
    BUILD,
    OUTLINED,
    SINGLE,
    at_most_double,
    columns_of_panels,
    dashes,
    figure_stage,
    handles,
    humidity_axis,
    humidity_colours,
    legend_below,
    legend_outside,
    letter,
    letter_lines,
    on_own_axes,
    panels,
    places,
    styled,
)
from stiction.stages.devices import device_warnings
from stiction.stages.devices.budget import budget_of, budgets_of, groups_of, slope_errors_of
from stiction.stages.devices.stoppers import bounded_share, stuck_over

#: Longest line of a label [characters].
_WIDE = 42
#: Colours of pull-off forces and of their limit.
_COLOUR, _LIMIT = "#0072B2", "#AA3377"
#: Number of quantiles, and of forces between the ends, at which the band of a stopper is computed.
_BAND = 101
#: Heights of a row of a budget, of everything else in its panel, and of the legend [in]; share of a row with bars.
_ROW, _AROUND, _LEGEND, _FILLED = 0.17, 0.62, 0.3, 0.8
#: All of the variance, and the share [%] below which measurements are in one row.
_ALL, _SMALL = 100, 2
_SHARES, _OTHERS = "share of the variance [%]", "others"
#: Width of a budget [in], and most characters of a line of its titles: 7 points of 390 pixels are 11 pixels.
_WIDTH, _TITLE = 3.3, 38
#: Bar of a standard error.
_ERROR = {"color": "black", "linewidth": 0.6}
#: Height of each further line of a title [in].
_LINE = 0.15


# Stoppers


@styled
def stoppers(
    datasets: Mapping[str, xr.Dataset],
    warnings: Mapping[str, Sequence[Limit]],
    answers: Mapping[str, Answer] | None = None,
) -> Figure:
    """Stoppers: P(stuck) against restoring force, and pull-off force against humidity, a column for each.

    Datasets and limits, which the table of stoppers contains, are by device, as are answers with the forces to build.
    """
    figure, columns, lines = columns_of_panels(len(datasets), 2, at_most_double(SINGLE), 5.6)
    for column, (name, dataset) in zip(columns, datasets.items(), strict=True):
        answer = (answers or {}).get(name)
        answer = None if answer is None or is_forbidden(answer) or not np.isfinite(answer.build) else answer
        _stuck_over_force(column[0], dataset, answer)
        column[0].set_xlabel(on_own_axes("restoring force [µN]", columns.T))
        _force_over_humidity(column[1], dataset, answer)
    for line in lines:
        line[0, 0].set_ylabel("P(stuck) [–]")
        line[1, 0].set_ylabel(on_own_axes("pull-off force [µN]", line))
    letter_lines(lines, list(datasets), (": share stuck after one touchdown", ": force against humidity"))
    if sentences := [f"{name}: {sentence}" for name, limits in warnings.items() for sentence in words.texts(limits)]:
        figure.set_label("\n".join(["Warnings:", *sentences]))
        figure.supxlabel("Some results are beyond limits of the model.", fontsize=7, ha="left", x=0.01)
    return figure


def _stuck_over_force(panel, dataset, answer):
    """P(stuck) over the force, at every humidity of the device, with the band and the limits of its table.

    The force to build is that of an answer, or unknown.
    """
    restoring, lowest = TO_UN * float(dataset.restoring_force), 0.5 / dataset.sizes["sample"]
    colours = humidity_colours(dataset.humidity.values.tolist())
    limits = dataset.safe_force.sel(part="safe", share=dataset.share > lowest)
    for k, (humidity, colour) in enumerate(colours.items()):
        forces, of_air = np.sort(dataset.pull_off.sel(humidity=humidity).values), limits.sel(humidity=humidity)
        style = {"color": colour, "linestyle": dashes(k), "label": Air(humidity).words}
        panel.plot(TO_UN * forces, stuck_patches(forces, forces)[0], **style)
        at = _forces_of_band(dataset, forces, of_air)
        _, *band = stuck_over(dataset, humidity, at)
        panel.fill_between(TO_UN * at, *band, color=colour, alpha=0.2, linewidth=0)
        panel.plot(TO_UN * of_air, of_air.share, "|", color=colour, markersize=9, markeredgewidth=1.5)
    if limits.notnull().any():
        panel.plot([], [], "|", color="0.3", markersize=9, markeredgewidth=1.5, label="simulated limit, 95 %")
    if answer is not None:
        label = f"to build, {safe_size(answer.build, answer.sought)}"
        panel.axvline(TO_UN * answer.build, color=BUILD, linewidth=1.2, label=label)
        _lines_of_stricter_forces(panel, answer)
    panel.axvline(restoring, color="0.4", linestyle=":", linewidth=0.8)
    panel.set(yscale="log", xlim=(0, None), ylim=(lowest, 1.3))
    if np.isfinite(restoring):
        _name_restoring_force(panel, restoring)
    legend_below(panel, [*handles(panel)[0], Patch(color="0.3", alpha=0.2, linewidth=0, label="95 % band")])


def _lines_of_stricter_forces(panel, answer):
    """Lines of the forces beside that to build that are stricter, which the panel below explains, under one label."""
    beside = [limit.size for limit in (answer.between, *answer.unasked) if limit]
    sizes = sorted(size for size in beside if answer.sought.is_stricter(size, answer.build))
    label = f"stricter: {', '.join(safe_size(size, answer.sought) for size in sizes)}"
    for k, size in enumerate(sizes):
        panel.axvline(TO_UN * size, color=BUILD, linewidth=1, linestyle="--", label="_" if k else label)


def _forces_of_band(dataset, forces, limits):
    """Forces at which a band is drawn: up to the largest of the patches and of the limits, with that of the spring."""
    end, restoring = np.nanmax([forces[-1], *limits.values]), float(dataset.restoring_force)
    spring = [restoring] if forces[0] < restoring < end else []
    return np.unique([*np.quantile(forces, np.linspace(0, 1, _BAND)), *np.linspace(forces[0], end, _BAND), *spring])


def _name_restoring_force(panel, restoring):
    """Name the line of the restoring force."""
    is_left = restoring < np.mean(panel.get_xlim())
    panel.annotate(
        "restoring force",
        (restoring, 0.03),
        (2 if is_left else -2, 0),
        panel.get_xaxis_transform(),
        "offset points",
        fontsize=7,
        ha="left" if is_left else "right",
        path_effects=OUTLINED,
    )


def _force_over_humidity(panel, dataset, answer):
    """Mean and 5 to 95 % of the pull-off force along the fine axis, its limit, the largest of both, and what to build.

    The forces to build are those of an answer, or unknown.
    """
    low, high = (TO_UN * dataset.quantile_along.sel(probability=p) for p in dataset.probability.values[[0, -1]])
    light = {"color": _COLOUR, "alpha": 0.2, "linewidth": 0}
    worst, humid = Air(float(dataset.worst_humidity)), is_humid(dataset.axis.values)
    placed = places([*dataset.axis.values.tolist(), worst.humidity])
    single = ~humid | (humid.sum() == 1)
    axis, means = dataset.axis[humid], TO_UN * dataset.mean_along
    entries: list = []
    if not single.all():
        entries += panel.plot(axis, means[humid], color=_COLOUR, label="mean")
        entries.append(panel.fill_between(axis, low[humid], high[humid], **light, label="5 to 95 % of the patches"))
    if single.any():
        reach = np.abs(np.stack([low, high]) - means.values)[:, single]
        label = "mean and 5 to 95 %" + ", dry" * (not humid[single].any())
        at = [placed[float(value)] for value in dataset.axis.values[single]]
        points = {"fmt": "o", "color": _COLOUR, "markersize": 3, "alpha": 0.6, "label": label}
        entries.append(panel.errorbar(at, means[single], reach, **points))
    entries += _limit_over_humidity(panel, dataset, placed, single)
    if np.isfinite(restoring := TO_UN * float(dataset.restoring_force)):
        entries.append(panel.axhline(restoring, color="0.4", linestyle=":", linewidth=0.8, label="restoring force"))
    if answer is not None:
        entries += _forces_to_build(panel, placed, answer)
    if not single.all():
        label = f"largest mean, {worst.choose(f'RH {worst.humidity:.2f}', worst.where)}"
        entries += panel.plot([placed[worst.humidity]], [float(means.max())], "v", color="black", label=label)
    legend_below(panel, entries)
    panel.set(xlabel="relative humidity [–]", ylim=(0, None))
    humidity_axis(panel, placed)


def _forces_to_build(panel, placed, answer):
    """Force to build in the air that decides, and the largest between the stated airs if it is stricter, for a legend.

    The latter is in the strictest air. Other stated airs alone would need less.
    """
    words, air = to_build_beside(answer, unasked(answer)), answer.together.humidity
    label = textwrap.fill(f"to build for all stated airs, {words}", _WIDE)
    entries = panel.plot(placed.get(air, air), TO_UN * answer.build, "D", color=BUILD, markersize=4, label=label)
    if between := answer.between:
        size = safe_size(between.size, answer.sought)
        label = f"strictest air, RH {between.humidity:.2g}, interpolated: to build {size}"
        style = {"color": BUILD, "markersize": 5, "markerfacecolor": "white", "label": label}
        entries += panel.plot(between.humidity, TO_UN * between.size, "D", **style)
    return entries


def _limit_over_humidity(panel, dataset, placed, single):
    """Simulated limit of the smallest fraction that the patches bound, and its largest value, as entries of a legend.

    It is a line along the fine axis, and a dash in single airs.
    """
    if (share := bounded_share(dataset)) is None:
        return []
    limit, axis = TO_UN * dataset.safe_force_along.sel(share=share).values, dataset.axis.values
    text, style = f"simulated limit, {one_in(share)}", {"color": _LIMIT, "markersize": 8}
    entries = []
    if single.any():
        at = [placed[float(value)] for value in axis[single]]
        entries = panel.plot(at, limit[single], "_", label=text, **style)
    if not single.all():
        largest = int(np.argmax(np.where(single, -np.inf, limit)))
        entries = panel.plot(axis[~single], limit[~single], "--", label=text, **style)
        label = f"largest limit, RH {axis[largest]:.2f}: {bounding(float(limit[largest]), 3, up=True)} µN"
        entries += panel.plot(axis[largest], limit[largest], "^", color=_LIMIT, markersize=5, label=label)
    return entries


# Budget


@styled
def budget(budgets: Mapping[tuple, xr.Dataset]) -> Figure:
    """Share of each measurement in the variance of a device, below its total in words. Below it, choices of the model.

    The budgets are by device, humidity and, for those of tips, ``tip``. All panels are below each other, as wide as a
    column of a journal, so that their text can be read on a phone.
    """
    parts = {}
    for (_, humidity, *_), dataset in budgets.items():
        parts.setdefault(response_text(dataset), {})[humidity] = dataset
    colours = humidity_colours(humidity for _, humidity, *_ in budgets)
    contents = [content for text, cases in parts.items() for content in _contents(text, cases)]
    heights = [_ROW * len(rows) + _AROUND + _LINE * title.count("\n") for title, *_, rows in contents]
    figure, axes = panels(len(contents), 1, (_WIDTH, sum(heights) + _LEGEND), height_ratios=heights)
    for panel, (_, label, cases, rows) in zip(axes.flat, contents, strict=True):
        _rows_of_bars(panel, rows, [colours[humidity] for humidity in cases], of_all=label == _SHARES)
        panel.set_xlabel(label)
    letter(axes, [title for title, *_ in contents])
    marks = [Patch(color=colour, label=Air(humidity).words) for humidity, colour in colours.items()]
    marks.append(Line2D([], [], **_ERROR, marker="|", markersize=3, label="± standard error"))
    if len(marks) > 2:
        marks.append(Line2D([], [], linestyle="", label="in titles: airs in this order"))
    legend_outside(figure, (marks, [mark.get_label() for mark in marks]), "lower", 8)
    return figure


def _contents(text, cases):
    """Title, label of the axis, budgets by humidity and rows of the panels of a response."""
    yield (
        "\n".join(textwrap.fill(line, _TITLE) for line in (text, *_in_words(cases))),
        _SHARES,
        cases,
        _measurements(cases),
    )
    if choices := _choices(cases):
        yield "choices of the model", "change [%]", cases, choices


def _in_words(cases):
    """Sentences on uncertainty and scatter, numbers in the order of the humidities."""
    budgets = [budget_of(dataset) for dataset in cases.values()]
    totals = [budget.effect(budget.names) for budget in budgets]
    for name, numbers in (
        ("total: standard uncertainty", totals),
        ("devices scatter", [float(dataset.scatter) for dataset in cases.values()]),
    ):
        texts = [number(100 * deviation, "#.2g").rstrip(".") for deviation in numbers]
        yield f"{name} ± {', '.join(texts)} %"


def _measurements(cases):
    """Rows of all measurements, the largest first, and of small ones together: name to bars [%] by humidity."""
    groups = {name: inputs for dataset in cases.values() for name, inputs in groups_of(dataset).items()}
    rows = {name: _shares(cases, inputs) for name, inputs in groups.items()}
    highest = {name: max(high for _, high, _ in bars) for name, bars in rows.items()}
    small = [name for name, high in highest.items() if high < _SMALL]
    together = small if len(small) > 1 else []
    largest = sorted(set(groups) - set(together), key=lambda name: (-highest[name], list(groups).index(name)))
    bars_by_name = {name.removeprefix("the "): rows[name] for name in largest}
    others = [entry for name in together for entry in groups[name]]
    return bars_by_name | ({_OTHERS: _shares(cases, others)} if together else {})


def _shares(cases, inputs):
    """Bars of some inputs by humidity."""
    budgets = [(budget_of(dataset), slope_errors_of(dataset)) for dataset in cases.values()]
    return [_share(budget, errors, inputs, budget.effect(budget.names)) for budget, errors in budgets]


def _share(budget, slope_errors, inputs, total):
    """Bar of the share of some inputs in the variance, and its error [%]. Zero if a budget has none of them."""
    names = [name for name in budget.names if name in inputs]
    if not names or not total > 0:
        return 0.0, 0.0, 0.0
    effect = budget.effect(names) / total
    return 0.0, 100 * effect**2, 200 * effect * budget.error_of_effect(names, slope_errors) / total


def _choices(cases):
    """Rows of all choices of the model: name to bars from zero, with errors [%], by humidity."""
    rows = {}
    for choice in dict.fromkeys(name for dataset in cases.values() for name in dataset.choice.values.tolist()):
        rows[choice_label(choice)] = [_from_zero(dataset, choice) for dataset in cases.values()]
    return rows


def _from_zero(dataset, choice):
    """Bar of the effect of a choice of the model, and its error [%]. Zero if a budget does not have this choice."""
    if choice not in dataset.choice.values:
        return 0.0, 0.0, 0.0
    of_choice = dataset.sel(choice=choice)
    return (*sorted((0.0, 100 * float(of_choice.effect))), 100 * float(of_choice.effect_error))


def _rows_of_bars(panel, rows: Mapping[str, Sequence[tuple]], colours: Sequence[np.ndarray], *, of_all: bool = False):
    """Draw rows of bars (low, high, error) from top to bottom. The bars of a row are those of the humidities.

    Bars that are not known are left out. Those ``of_all`` are shares, whose errors end where nothing and all are.
    """
    ends = []
    for row, bars in enumerate(rows.values()):
        height = _FILLED / len(bars)
        for k, ((low, high, error), shade) in enumerate(zip(bars, colours, strict=True)):
            if not np.isfinite(high - low):
                continue
            error = error if np.isfinite(error) else 0.0
            end = high if high > -low else low
            reach = [min(error, high), max(0.0, min(error, _ALL - high))] if of_all else [error, error]
            ends += [abs(low), abs(high), abs(end) + reach[1]]
            at = row + (k - (len(bars) - 1) / 2) * height
            panel.barh(at, high - low, height, left=low, color=shade, linewidth=0)
            if error > 0:
                panel.errorbar(end, at, xerr=np.c_[reach], **_ERROR, capsize=1)
    widest = max(ends, default=0.0) or 1.0
    panel.axvline(0, color="black", linewidth=0.6)
    panel.set_yticks(range(len(rows)), list(rows))
    panel.tick_params(axis="y", length=0)
    xlim = (0, max(_ALL, widest)) if of_all else (-1.1 * widest, 1.1 * widest)
    panel.set(ylim=(len(rows) - 0.4, -0.6), xlim=xlim)


def _stoppers(data):
    """Figure of stoppers from their datasets, answers and limits."""
    limits = device_warnings.read(data["warnings"]).patches
    return stoppers(data["stoppers"], limits, of_datasets(data["answers"], data["warnings"]))


STAGES = (
    figure_stage(
        "stoppers",
        "pull-off force of stoppers",
        "Devices",
        inputs=lambda plan, at: {
            "stoppers": by_name("devices/stoppers", plan.devices.stoppers),
            "answers": by_name("devices/answer", plan.devices.stoppers),
            "warnings": device_warnings.files_of(*plan.devices.stoppers),
        },
        compute=_stoppers,
        jobs=lambda plan: [{}] if plan.devices.stoppers else [],
        targets=("devices",),
    ),
    figure_stage(
        "budget_{device}",
        "uncertainty of {device}",
        "Devices",
        inputs=lambda plan, at: {"budgets": budgets_of(plan, at.device)},
        compute=budget,
        jobs=lambda plan: [{"device": name} for name in plan.devices.with_budget],
        targets=("devices",),
    ),
)

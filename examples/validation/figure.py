"""Figure of the benchmark: measured values over their median predictions, the largest first."""

import textwrap
from functools import partial

import numpy as np
import pandas as pd
from experiment import LINEAR
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.report.style import DOUBLE, legend_outside, letter, panels, plain_log, styled

#: Colour and marker of a measured value inside and outside of its interval.
INSIDE, OUTSIDE = ("#0072B2", "o"), ("#D55E00", "D")
#: Height of a line of a panel, what its axis takes [in], and height of the lower panels over that of the upper ones.
LINE, AROUND, LOWER = 0.19, 0.7, 0.6
#: Most characters of a line of a name, and of that of a level, which its value follows.
NAME, NAME_OF_LEVEL = 48, 46
#: Ratio of the ends of an axis below which it has plain numbers.
DECADE = 10
#: Start of the names of experiments on crack lengths.
CRACKS = "crack_lengths_"
#: Predicted interval.
BAR = {"color": "0.6", "linewidth": 3, "solid_capstyle": "butt"}


@styled
def drawn(frame: pd.DataFrame) -> Figure:
    """Predicted intervals and measured values: levels and laws as factors, crack lengths, and laws as differences."""
    known = frame[frame.predicted.notna()]
    cracks, linear = known.experiment.str.startswith(CRACKS), known.kind.isin(LINEAR)
    level = known.kind == "level"
    groups = {
        "Levels": known[level & ~cracks],
        "Laws: ratios, thresholds": known[~level & ~linear],
        "Crack lengths": known[cracks],
        "Laws: exponents, maxima": known[linear],
    }
    most = max(len(groups["Levels"]), len(groups["Laws: ratios, thresholds"]), 1)
    size = DOUBLE, 2 * AROUND + (1 + LOWER) * LINE * most
    figure, axes = panels(2, 2, size, height_ratios=(1, LOWER))
    for panel, rows in zip(axes.flat, groups.values(), strict=True):
        draw(panel, rows)
    letter(axes, [f"{name}\n{counted(rows)}" for name, rows in groups.items()])
    legend_outside(figure, (entries := list(legend()), [entry.get_label() for entry in entries]), "lower", 4)
    return figure


def counted(rows):
    """How many measured values of some rows are inside of their intervals, and how many bounds hold."""
    parts = []
    for of, words in ((rows[rows.value.notna()], "inside"), (rows[rows.value.isna()], "bounds hold")):
        if len(of):
            parts.append(f"{of.inside.sum():.0f} of {len(of)} {words}")
    return ", ".join(parts)


def draw(panel, rows):
    """One line for each row, the furthest above its prediction first: factors, or differences if all are linear."""
    linear = len(rows) > 0 and rows.kind.isin(LINEAR).all()
    stated = rows.value.fillna(rows.at_least).fillna(rows.at_most)
    order = np.argsort(-on_axis(rows, stated, linear=linear).to_numpy(), kind="stable")
    rows = rows.iloc[order]
    for place, row in enumerate(rows.itertuples()):
        panel.plot(on_axis(row, np.array([row.low, row.high]), linear=linear), [place, place], **BAR)
        mark(panel, row, place, partial(on_axis, row, linear=linear))
    panel.axvline(0 if linear else 1, color="0.8", linewidth=0.6, zorder=0)
    if linear:
        panel.set_xlabel("value − median prediction [–]")
    else:
        panel.set(xscale="log", xlabel="value / median prediction [–]")
        if np.divide(*panel.get_xlim()[::-1]) < DECADE:
            plain_log(panel.xaxis)
    name_lines(panel, [label(row) for row in rows.itertuples()])


def on_axis(row, values, *, linear):
    """Values beside the median prediction of a row, or of rows."""
    return values - row.predicted if linear else values / row.predicted


def name_lines(panel, names):
    """Names at the left of their lines, from top to bottom."""
    panel.set_yticks(range(len(names)), names, fontsize=5.5, linespacing=1)
    panel.tick_params(axis="y", length=0)
    panel.set_ylim(len(names) - 0.4, -0.6)


def mark(panel, row, place, on_axis):
    """Measured value, or its bound with an arrow towards the allowed side."""
    colour, marker = INSIDE if row.inside else OUTSIDE
    if not np.isnan(row.value):
        panel.plot(on_axis(row.value), place, marker, color=colour, markersize=3.5)
        return
    marker, bound = (">", row.at_least) if np.isnan(row.at_most) else ("<", row.at_most)
    panel.plot(on_axis(bound), place, marker, color=colour, markersize=4.5)


def legend():
    """Entries of the legend."""
    yield Line2D([], [], **BAR, label="predicted, 90 %")
    for (colour, marker), name in ((INSIDE, "measured, inside"), (OUTSIDE, "measured, outside")):
        yield Line2D([], [], color=colour, marker=marker, linestyle="", label=name)
    yield Line2D([], [], color="0.3", marker=">", linestyle="", label="measured bound, allowed side")


def stated(row):
    """Measured value or bound of a law, with its unit."""
    unit = "" if row.unit == "-" else f" {row.unit}"
    if not np.isnan(row.value):
        return f"{row.value:g}{unit}"
    return f"≥ {row.at_least:g}{unit}" if np.isnan(row.at_most) else f"≤ {row.at_most:g}{unit}"


def label(row):
    """Name of a row: pair and air of a crack length, what was tested otherwise; a law has its quantity below."""
    if row.experiment.startswith(CRACKS):
        return f"pair {row.experiment.removeprefix(CRACKS)}, {row.quantity.rpartition(', ')[2]}"
    name = row.title.rpartition(", ")[0] or row.title
    if row.kind == "level":
        return f"{textwrap.shorten(name, NAME_OF_LEVEL, placeholder=' …')}: {stated(row)}"
    quantity = textwrap.shorten(row.quantity, NAME, placeholder=" …").replace("₄", "$_4$")
    return f"{textwrap.shorten(name, NAME, placeholder=' …')}\n{quantity}: {stated(row)}"

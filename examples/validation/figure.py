"""Figure of the benchmark: levels over their median prediction, and laws by their place in their interval."""

import numpy as np
import pandas as pd
from experiment import LINEAR
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.report.style import DOUBLE, legend_outside, letter, panels, styled

#: Colour and marker of a measured value inside and outside of its interval.
INSIDE, OUTSIDE = ("#0072B2", "o"), ("#D55E00", "D")
#: Height of a line of a panel, and what its axis takes [in].
LINE, AROUND = 0.145, 0.9
#: Predicted interval.
BAR = {"color": "0.6", "linewidth": 3, "solid_capstyle": "butt"}


@styled
def drawn(frame: pd.DataFrame) -> Figure:
    """Predicted intervals and measured values, a line for each level and each law."""
    known = frame[frame.predicted.notna()]
    levels, laws = known[known.kind == "level"], known[known.kind != "level"]
    most = max(len(levels), len(laws), 1)
    figure, ((left, right),) = panels(1, 2, (DOUBLE, AROUND + LINE * most))
    draw_levels(left, levels)
    draw_laws(right, laws)
    letter([left, right], ["Levels", "Laws"])
    legend_outside(figure, (entries := list(legend()), [entry.get_label() for entry in entries]), "lower", 4)
    return figure


def draw_levels(panel, levels):
    """One line for each level, all over their median prediction."""
    for place, row in enumerate(levels.itertuples()):
        panel.plot(np.array([row.low, row.high]) / row.predicted, [place, place], **BAR)
        mark(panel, row, place, lambda value, row=row: value / row.predicted)
    panel.axvline(1, color="0.8", linewidth=0.6, zorder=0)
    panel.set(xscale="log", xlabel="value / median prediction [–]")
    name_lines(panel, [label(row) for row in levels.itertuples()])


def draw_laws(panel, laws):
    """One line for each law, all intervals from 0 to 1."""
    for place, row in enumerate(laws.itertuples()):
        panel.plot([0, 1], [place, place], **BAR)
        mark(panel, row, place, lambda value, row=row: in_interval(row, value))
    panel.set_xlabel("place in the predicted interval [–]")
    name_lines(panel, [f"{label(row)}: {row.kind} {stated(row)}" for row in laws.itertuples()])


def in_interval(row, value):
    """Place of a value in the interval of a law: 0 at its lower and 1 at its upper end, between them by ratios."""
    low, high, at = (row.low, row.high, value) if row.kind in LINEAR else np.log([row.low, row.high, value])
    return (at - low) / (high - low)


def name_lines(panel, names):
    """Names at the left of their lines, from top to bottom."""
    panel.set_yticks(range(len(names)), names, fontsize=6)
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
    """Name of a row."""
    name = row.experiment.replace("_", " ")
    return f"{name}, {row.quantity.rpartition(', ')[2]}" if name.startswith("crack lengths") else name

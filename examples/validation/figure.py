"""Figure of the benchmark: levels on one logarithmic axis, a small panel for each law."""

import numpy as np
import pandas as pd
from experiment import LINEAR
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.report.style import DOUBLE, legend_outside, letter, plain_log, styled

#: Colour and marker of a measured value inside and outside of its interval.
INSIDE, OUTSIDE = ("#0072B2", "o"), ("#D55E00", "D")
#: Height of a line of the panel of levels, and what its axis takes [in].
LINE, AROUND = 0.145, 0.9
#: Columns of the panels of laws.
ACROSS = 2


@styled
def drawn(frame: pd.DataFrame) -> Figure:
    """Predicted intervals and measured values: levels over their median prediction, laws as they are."""
    known = frame[frame.predicted.notna()]
    levels, laws = known[known.kind == "level"], known[known.kind != "level"]
    figure = Figure(figsize=(DOUBLE, AROUND + LINE * max(len(levels), 1)), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.15, 1))
    panel = left.subplots()
    draw_levels(panel, levels)
    rows = -(-max(len(laws), 1) // ACROSS)
    panels = right.subplots(rows, ACROSS, squeeze=False).ravel()
    for small, law in zip(panels, laws.itertuples(), strict=False):
        draw_law(small, law)
    for unused in panels[len(laws) :]:
        unused.remove()
    letter([panel, panels[0]], ["Levels over the median prediction", "Laws"] if len(laws) else ["Levels", ""])
    entries = [
        Line2D([], [], color="0.6", linewidth=3, label="predicted, 90 %"),
        *(
            Line2D([], [], color=colour, marker=mark, linestyle="", label=f"measured, {name}")
            for (colour, mark), name in ((INSIDE, "inside"), (OUTSIDE, "outside"))
        ),
    ]
    legend_outside(figure, (entries, [entry.get_label() for entry in entries]), "lower", 3)
    return figure


def draw_levels(panel, levels):
    """One line for each level, all over their median prediction."""
    for place, row in enumerate(levels.itertuples()):
        panel.plot(np.array([row.low, row.high]) / row.predicted, [place, place], color="0.6", linewidth=3)
        mark(panel, row, place, row.predicted)
    panel.axvline(1, color="0.8", linewidth=0.6, zorder=0)
    panel.set_xscale("log")
    panel.set(xlabel="value / median prediction [–]", ylim=(len(levels) - 0.4, -0.6))
    panel.set_yticks(range(len(levels)), [label(row) for row in levels.itertuples()], fontsize=6)
    panel.tick_params(axis="y", length=0)


def draw_law(panel, row):
    """Interval and measured value of one law."""
    panel.plot([row.low, row.high], [0, 0], color="0.6", linewidth=3)
    mark(panel, row, 0, 1.0)
    if row.kind not in LINEAR:
        panel.set_xscale("log")
        if max(row.high, row.value) < 100 * min(row.low, np.nan_to_num(row.value, nan=row.low)):
            plain_log(panel.xaxis)
    panel.set_ylim(-1, 1)
    panel.set_yticks([])
    unit = "" if row.unit == "-" else f" [{row.unit}]"
    panel.set_xlabel(f"{label(row)}: {row.kind}{unit}", fontsize=6)
    panel.tick_params(labelsize=6)


def mark(panel, row, place, unit):
    """Measured value, or its bound with an arrow towards the allowed side."""
    colour, marker = INSIDE if row.inside else OUTSIDE
    if not np.isnan(row.value):
        panel.plot(row.value / unit, place, marker, color=colour, markersize=3.5)
        return
    marker, bound = (">", row.at_least) if np.isnan(row.at_most) else ("<", row.at_most)
    panel.plot(bound / unit, place, marker, color=colour, markersize=4.5)


def label(row):
    """Name of a row."""
    name = row.experiment.replace("_", " ")
    return f"{name}, {row.quantity.rpartition(', ')[2]}" if name.startswith("crack lengths") else name

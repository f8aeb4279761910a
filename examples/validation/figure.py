"""Figure of the benchmark: measured values over their median predictions, those outside of their intervals first."""

import textwrap
from functools import partial

import numpy as np
import pandas as pd
from experiment import LINEAR
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.report.style import OUTLINED, legend_outside, letter, panels, plain_log, styled

#: Colour and marker of a measured value inside and outside of its interval.
INSIDE, OUTSIDE = ("#0072B2", "o"), ("#D55E00", "D")
#: Width, of which a phone shows 7 points as 10 pixels, and height of a line of a name, of a bar and of an axis [in].
WIDTH, LINE, BAR_HEIGHT, AROUND = 3.6, 0.1, 0.11, 0.65
#: Most characters of a line of a name.
NAME = 74
#: Ratio of the ends of an axis below which it has plain numbers.
DECADE = 10
#: Start of the names of experiments on crack lengths.
CRACKS = "crack_lengths_"
#: Side of the axis of crack lengths that is safe.
LONGER = "\nright: longer than predicted, safer"
#: Side of the axis of levels that is unsafe.
STICKIER = "\nright: sticks more than predicted, unsafe (energies, forces)"
#: Predicted interval.
BAR = {"color": "0.6", "linewidth": 3, "solid_capstyle": "butt"}
#: Grounds of rows, one after the other.
GROUNDS = "white", "0.96"
#: Text of a name.
NAMED = {"fontsize": 7, "linespacing": 1, "path_effects": OUTLINED}


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
    groups = {name: in_order(rows) for name, rows in groups.items()}
    heights = [AROUND + sum(map(height, rows.itertuples())) for rows in groups.values()]
    figure, axes = panels(len(groups), 1, (WIDTH, AROUND + sum(heights)), height_ratios=heights)
    for panel, rows in zip(axes.flat, groups.values(), strict=True):
        draw(panel, rows)
    letter(axes, [f"{name}: {counted(rows)}" for name, rows in groups.items()])
    legend_outside(figure, (entries := list(legend()), [entry.get_label() for entry in entries]), "upper", 2)
    return figure


def counted(rows):
    """How many measured values of some rows are inside of their intervals, and how many bounds hold."""
    parts = []
    for of, words in ((rows[rows.value.notna()], "inside"), (rows[rows.value.isna()], "bounds hold")):
        if len(of):
            parts.append(f"{of.inside.sum():.0f} of {len(of)} {words}")
    return ", ".join(parts)


def all_linear(rows):
    """Whether a panel shows differences."""
    return len(rows) > 0 and bool(rows.kind.isin(LINEAR).all())


def in_order(rows):
    """Rows outside of their intervals first, then those inside, each the furthest above its prediction first."""
    stated = rows.value.fillna(rows.at_least).fillna(rows.at_most)
    above = on_axis(rows, stated, linear=all_linear(rows)).to_numpy(float)
    return rows.iloc[np.lexsort([-above, rows.inside.to_numpy(bool)])]


def height(row):
    """Height of a row: its bar below its name [in]."""
    return BAR_HEIGHT + LINE * (1 + label(row).count("\n"))


def draw(panel, rows):
    """Bar and measured value of each row below its name, in order: factors, or differences if all are linear."""
    linear, bottom = all_linear(rows), 0.0
    for k, row in enumerate(rows.itertuples()):
        panel.axhspan(bottom, bottom + height(row), color=GROUNDS[k % 2], linewidth=0, zorder=-1)
        panel.text(0.01, bottom + 0.01, label(row), va="top", **NAMED, transform=panel.get_yaxis_transform())
        bottom += height(row)
        place = bottom - BAR_HEIGHT / 2
        panel.plot(on_axis(row, np.array([row.low, row.high]), linear=linear), [place, place], **BAR)
        mark(panel, row, place, partial(on_axis, row, linear=linear))
    panel.axvline(0 if linear else 1, color="0.8", linewidth=0.6, zorder=0)
    if linear:
        panel.set_xlabel("value − median prediction [–]")
    else:
        panel.set(xscale="log", xlabel=f"value / median prediction [–]{side_of(rows)}")
        if np.divide(*panel.get_xlim()[::-1]) < DECADE:
            plain_log(panel.xaxis)
    panel.set(yticks=[], ylim=(bottom + 0.06, -0.04))


def side_of(rows):
    """What an axis of factors means to its right, if rows have one meaning."""
    if not (len(rows) and (rows.kind == "level").all()):
        return ""
    return LONGER if rows.experiment.str.startswith(CRACKS).all() else STICKIER


def on_axis(row, values, *, linear):
    """Values beside the median prediction of a row, or of rows."""
    return values - row.predicted if linear else values / row.predicted


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
    yield Line2D([], [], color="0.3", marker=">", linestyle="", label="measured limit, pointing to allowed values")


def stated(row):
    """Measured value or bound of a law, with its unit."""
    unit = "" if row.unit == "-" else f" {row.unit}"
    if not np.isnan(row.value):
        return f"{row.value:g}{unit}"
    return f"≥ {row.at_least:g}{unit}" if np.isnan(row.at_most) else f"≤ {row.at_most:g}{unit}"


def label(row):
    """Name of a row: pair and air of a crack length, what was tested otherwise; a law with its quantity."""
    if row.experiment.startswith(CRACKS):
        return f"pair {row.experiment.removeprefix(CRACKS)}, {row.quantity.rpartition(', ')[2]}"
    name = row.title.rpartition(", ")[0] or row.title
    quantity = "" if row.kind == "level" else f", {row.quantity}"
    return textwrap.fill(f"{name}{quantity}: {stated(row)}", NAME).replace("₄", "$_4$")

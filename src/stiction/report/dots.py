"""Dot plots that read like a table: labels left of the axis, a mark for each number, and the number beside it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise
from operator import itemgetter

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.report.style import OUTLINED, PUBLISHED

#: Height of a row of dots, of each further line of its label, and of everything else in a panel [in].
ROW, LINE, AROUND = 0.24, 0.13, 0.75
#: Least space between the texts of two rows, least height of a panel, whose title can wrap later, and height of a
#: figure with room for all texts of a layout [in].
_APART, _LEAST, _SPARE = 0.04, 0.6, 20.0
#: Widths of the bar of a mark and of its ends [points].
_THICK, _END = 3.5, 7
#: Distance of a number from its mark, and width of one of its characters [in]. Part of a figure that its panels fill,
#: and free part of an axis on its left.
_AWAY, _CHARACTER, _FILLED, _LEFT = 0.08, 0.06, 0.55, 0.06
_NUMBER = {"textcoords": "offset points", "va": "center", "fontsize": 7, "path_effects": OUTLINED}
#: White ground of a number, so that no line of a panel strikes it through.
_GROUND = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}


@dataclass(frozen=True)
class Mark:
    """Number, or the two ends of an interval, in a row."""

    low: float
    high: float
    color: str
    text: str = ""  #: beside the mark
    error: float = 0.0  #: standard error of a single number
    label: str = ""  #: in the legend
    filled: bool = True
    text_color: str = "black"
    marker: str = "o"  #: of a single number


def draw(panel: Axes, rows: Mapping[str, Sequence[Mark]], *, column: str | None = None) -> None:
    """Draw the marks of each row by its label, from top to bottom. What a panel already shows stays within its axis.

    Numbers are beside their marks, or in a ``column`` below its name to the right of the panel.
    """
    in_column = {"xycoords": panel.get_yaxis_transform(), "xytext": (3, 0), "ha": "left", **_NUMBER}
    for row, marks in enumerate(rows.values()):
        panel.axhline(row, color="0.9", linewidth=0.6, zorder=0)
        for mark in marks:
            _draw(panel, row, mark)
            if not mark.text:
                continue
            if column is not None:
                panel.annotate(mark.text, (1, row), **in_column, color=mark.text_color)
            else:
                at, style = (mark.high + mark.error, row), {"color": mark.text_color, "bbox": _GROUND}
                panel.annotate(mark.text, at, (6, 0), **_NUMBER, **style)
    panel.set_yticks(range(len(rows)), list(rows), linespacing=1)
    panel.tick_params(axis="y", length=0)
    panel.set_ylim(len(rows) - 0.4, -0.6 - bool(column))
    if column:
        panel.annotate(column, (1, -1), **in_column)
    beside = [len(mark.text) for marks in rows.values() for mark in marks if column is None]
    _set_ends(panel, max(beside, default=0))


def _set_ends(panel, longest):
    """Set the ends of the axis, with room for the longest number on the right."""
    low, high = panel.dataLim.intervalx
    span = (high - low) or abs(high) or 1.0
    width = _FILLED * panel.figure.get_figwidth() / panel.get_gridspec().ncols
    right = min(0.5, (_AWAY + _CHARACTER * longest) / width) if longest else _LEFT
    panel.set_xlim(low - _LEFT * span, high + span * right / (1 - right))


def height(labels: Iterable[str]) -> float:
    """Height of a panel with rows of some labels, broken into lines [in]."""
    lines = [label.count("\n") for label in labels]
    return AROUND + len(lines) * (ROW + LINE * max(lines, default=0))


def heighten(figure: Figure, panels: Sequence[Axes]) -> None:
    """Make panels below each other so high that labels and numbers of neighbouring rows are apart.

    All that is around panels, such as a title of many lines and a legend, keeps its height. No panel gets lower.
    """
    before, grid = figure.get_figheight(), panels[0].get_gridspec()
    figure.set_figheight(before + _SPARE)  # whatever is around panels leaves them room
    figure.draw_without_rendering()
    heights = np.array([panel.bbox.height for panel in panels]) / figure.dpi
    without = heights - _SPARE * heights / heights.sum()
    needed = np.maximum(heights - [_spare(panel) for panel in panels], np.maximum(without, _LEAST))
    figure.set_figheight(before + (needed - without).sum())
    grid.set_height_ratios(needed)


def _spare(panel):
    """Height that rows of a panel can lose until labels, or numbers, of neighbouring ones are just apart [in]."""
    labels = [(tick.get_loc(), tick.label1) for tick in panel.yaxis.get_major_ticks()]
    numbers = [(text.xy[1], text) for text in panel.texts if text.get_text()]
    gaps = chain.from_iterable(map(_gaps, (labels, numbers)))
    return (min(gaps, default=np.inf) / panel.figure.dpi - _APART) * abs(np.subtract(*panel.get_ylim()))


def _gaps(texts):
    """Distances of neighbouring texts by the place of their row, over the number of rows between them [pixels]."""
    shown = [(row, text.get_window_extent()) for row, text in sorted(texts, key=itemgetter(0))]
    return [(upper.y0 - lower.y1) / (below - row) for (row, upper), (below, lower) in pairwise(shown) if below > row]


def signed(number: float) -> str:
    """Number with its sign and one digit after the point.

    Examples
    --------
    >>> signed(-6.41), signed(0.12), signed(-0.02)
    ('−6.4', '+0.1', '0.0')
    """
    rounded = round(float(number), 1)
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"


def _draw(panel, row, mark):
    """One mark without its text."""
    style = {"color": mark.color, "label": mark.label or "_"}
    if mark.low < mark.high:
        panel.plot([mark.low, mark.high], [row] * 2, linewidth=_THICK, solid_capstyle="butt", **style)
        panel.plot([mark.low, mark.high], [row] * 2, "|", color=mark.color, markersize=_END)
    else:
        face = mark.color if mark.filled else "white"
        panel.errorbar(
            [mark.high], [row], xerr=[mark.error], fmt=mark.marker, markersize=4, markerfacecolor=face, **style
        )


def references(panel: Axes, length: float, base: str, references_of_case: pd.DataFrame) -> None:
    """Lines of changes [%] of a crack length [µm], of some name: none, and those to the published and measured ones.

    The rows of Table III of a case are known, or none.
    """
    panel.axvline(0, color="black", linewidth=0.8, label=base)
    for row in references_of_case.itertuples():
        if np.isfinite(row.ng):
            panel.axvline(100 * (row.ng / length - 1), color=PUBLISHED, label="published")
        if np.isfinite(row.experiment):
            measured, spread = 100 * (row.experiment / length - 1), 100 * np.nan_to_num(row.experiment_std) / length
            style = {"color": "0.4", "alpha": 0.2, "linewidth": 0, "zorder": 0}
            panel.axvspan(measured - spread, measured + spread, **style)
            panel.axvline(measured, color="0.4", linestyle="--", label="measured ± standard deviation")

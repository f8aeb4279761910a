"""Dot plots that read like a table: labels left of the axis, a mark for each number, and the number beside it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from stiction.report.style import OUTLINED

#: Height of a row of dots, and of everything else in a panel [in].
ROW, AROUND = 0.24, 0.75
#: Widths of the bar of a mark and of its ends [points]; free part of an axis beside its marks, for their numbers.
_THICK, _END, _FREE = 3.5, 7, 0.22
_NUMBER = {"textcoords": "offset points", "va": "center", "fontsize": 7, "path_effects": OUTLINED}


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


def draw(panel: Axes, rows: Mapping[str, Sequence[Mark]]) -> None:
    """Draw the marks of each row by its label, from top to bottom."""
    for place, marks in enumerate(rows.values()):
        panel.axhline(place, color="0.9", linewidth=0.6, zorder=0)
        for mark in marks:
            _draw(panel, place, mark)
    panel.set_yticks(range(len(rows)), list(rows))
    panel.tick_params(axis="y", length=0)
    panel.set_ylim(len(rows) - 0.4, -0.6)
    panel.margins(x=_FREE)


def signed(number: float) -> str:
    """Number with its sign and one digit after the point.

    Examples
    --------
    >>> signed(-6.41), signed(0.12), signed(-0.02)
    ('−6.4', '+0.1', '0.0')
    """
    rounded = round(float(number), 1)
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"


def _draw(panel, place, mark):
    """One mark with its text on its right."""
    style = {"color": mark.color, "label": mark.label or "_"}
    if mark.low < mark.high:
        panel.plot([mark.low, mark.high], [place] * 2, linewidth=_THICK, solid_capstyle="butt", **style)
        panel.plot([mark.low, mark.high], [place] * 2, "|", color=mark.color, markersize=_END)
    else:
        face = mark.color if mark.filled else "white"
        panel.errorbar([mark.high], [place], xerr=[mark.error], fmt="o", markersize=4, markerfacecolor=face, **style)
    panel.annotate(mark.text, (mark.high + mark.error, place), (6, 0), **_NUMBER)

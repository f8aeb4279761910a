"""Words beside the required line of a panel, where they are clear of its curves and of each other."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from stiction.report.style import OUTLINED

#: Size of words [points], mean width of their characters in it, and part of a figure that its panel fills across.
_SIZE, _CHARACTER, _FILLED = 7, 0.45, 0.85
#: Distance of words from the sides of the panel, and from what they name, in parts of the panel.
_APART = 0.02
#: Places along words at which their room is looked at, and distance from a curve that is enough, in parts of the panel.
_PLACES, _ENOUGH = 25, 0.15


@dataclass(frozen=True)
class Label:
    """Words beside a line, next to a position on it or at one of its ends."""

    text: str
    color: object
    position: float | None = None  #: along the axis, in its unit


@dataclass(frozen=True)
class Room:
    """Room for words above or below a line, in parts of the panel."""

    low: float
    high: float
    above: bool
    starts: bool  #: whether words start at ``low``, or end at ``high``

    def meets(self, other: "Room") -> bool:
        """Whether words in both would cover each other."""
        apart = max(self.low - other.high, other.low - self.high)
        return self.above == other.above and apart < _APART

    def free(self, curves: list[np.ndarray], level: float) -> float:
        """Mean distance from the line to the nearest curve (n, 2), or to the end of the panel, as far as it counts."""
        if self.low < 0 or self.high > 1:
            return 0.0
        at, sign = np.linspace(self.low, self.high, _PLACES), 1 if self.above else -1
        nearest = np.full(_PLACES, min(_ENOUGH, 1 - level if self.above else level))
        for curve in curves:
            apart = sign * (np.interp(at, *curve.T, left=np.nan, right=np.nan) - level)
            nearest = np.where(apart >= 0, np.minimum(apart, nearest), nearest)
        return float(nearest.mean())


def put(panel: Axes, level: float, labels: list[Label]) -> None:
    """Write labels beside the line at a level, each where there is most room. Scales and ends of the axes are set."""
    to_parts = panel.transData + panel.transAxes.inverted()
    curves = [to_parts.transform(line.get_xydata()) for line in panel.lines if line.get_transform() == panel.transData]
    curves = [finite for curve in curves if len(finite := curve[np.isfinite(curve).all(axis=1)])]
    height, filled = float(to_parts.transform((panel.get_xlim()[0], level))[1]), []
    for label in labels:
        at = None if label.position is None else float(to_parts.transform((label.position, level))[0])
        width = (
            _CHARACTER * _SIZE / 72 * max(map(len, label.text.splitlines())) / (_FILLED * panel.figure.get_figwidth())
        )
        rooms = list(_rooms(at, width))
        unused = [room for room in rooms if not any(room.meets(other) for other in filled)]
        room = max(unused or rooms, key=lambda room: room.free(curves, height))
        filled.append(room)
        _write(panel, level, label, room)


def _rooms(at: float | None, width: float) -> Iterator[Room]:
    """Rooms on both sides of a place, or at both ends of the panel."""
    left, right = (_APART, 1 - _APART) if at is None else (at + _APART, at - _APART)
    for above in (True, False):
        yield Room(left, left + width, above, starts=True)
        yield Room(right - width, right, above, starts=False)


def _write(panel, level, label, room):
    """Words in their room."""
    panel.annotate(
        label.text,
        (room.low if room.starts else room.high, level),
        (0, 2 if room.above else -2),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        ha="left" if room.starts else "right",
        va="bottom" if room.above else "top",
        color=label.color,
        fontsize=_SIZE,
        path_effects=OUTLINED,
    )

"""Words beside the required line of a panel, where they are clear of its curves and of each other."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes

from stiction.report.style import OUTLINED

#: Size of words [points], mean width of their characters in it, and part of a figure that its panel fills across.
_SIZE, _CHARACTER, _FILLED = 7, 0.45, 0.85
#: Distance of words from the sides of the panel, and from what they name, in parts of the panel.
_APART = 0.02
#: Places along words at which their room is looked at; in parts of the panel, height of a line and least room of words.
_PLACES, _LINE, _ENOUGH = 25, 0.085, 0.15


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
    height: float
    away: float = 0.0  #: from the line, beyond other words

    def meets(self, other: "Room") -> bool:
        """Whether words in both would cover each other."""
        apart = max(self.low - other.high, other.low - self.high)
        nearer, further = sorted((self, other), key=lambda room: room.away)
        return self.above == other.above and apart < _APART and further.away < nearer.away + nearer.height

    def beyond(self, filled: "list[Room]") -> "Room":
        """Its place away from the line as far as the rooms that it meets reach."""
        return replace(self, away=max((room.away + room.height for room in filled if self.meets(room)), default=0.0))

    def free(self, curves: list[np.ndarray], level: float) -> float:
        """Mean distance from its side at the line to the nearest curve (n, 2) or the end of the panel, if it counts."""
        if self.low < 0 or self.high > 1:
            return 0.0
        at, sign = np.linspace(self.low, self.high, _PLACES), 1 if self.above else -1
        nearest = np.full(_PLACES, (1 - level if self.above else level) - self.away)
        for curve in curves:
            apart = sign * (np.interp(at, *curve.T, left=np.nan, right=np.nan) - level)
            nearest = np.where(apart >= 0, np.minimum(apart - self.away, nearest), nearest)
        return float(nearest.clip(0, max(self.height, _ENOUGH)).mean())


def put(panel: Axes, level: float, labels: list[Label]) -> None:
    """Write labels beside the line at a level, each where there is most room. Scales and ends of the axes are set."""
    to_parts = panel.transData + panel.transAxes.inverted()
    curves = [to_parts.transform(line.get_xydata()) for line in panel.lines if line.get_transform() == panel.transData]
    curves = [finite for curve in curves if len(finite := curve[np.isfinite(curve).all(axis=1)])]
    height, filled = float(to_parts.transform((panel.get_xlim()[0], level))[1]), []
    for label in labels:
        at = None if label.position is None else float(to_parts.transform((label.position, level))[0])
        lines = label.text.splitlines()
        width = _CHARACTER * _SIZE / 72 * max(map(len, lines)) / (_FILLED * panel.figure.get_figwidth())
        rooms = [room.beyond(filled) for room in _rooms(at, width, _LINE * len(lines))]
        room = max(sorted(rooms, key=lambda room: room.away), key=lambda room: room.free(curves, height))
        filled.append(room)
        _write(panel, height, label, room)


def _rooms(at: float | None, width: float, height: float) -> Iterator[Room]:
    """Rooms on both sides of a place, or at both ends of the panel."""
    left, right = (_APART, 1 - _APART) if at is None else (at + _APART, at - _APART)
    for above in (True, False):
        yield Room(left, left + width, above, starts=True, height=height)
        yield Room(right - width, right, above, starts=False, height=height)


def _write(panel, height, label, room):
    """Words in their room beside a line at a height."""
    panel.annotate(
        label.text,
        (room.low if room.starts else room.high, height + (room.away if room.above else -room.away)),
        (0, 4 if room.above else -4),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="left" if room.starts else "right",
        va="bottom" if room.above else "top",
        color=label.color,
        fontsize=_SIZE,
        path_effects=OUTLINED,
    )

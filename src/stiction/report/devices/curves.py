"""Curves of a page: a device against one quantity of its surface, with bands, through its computed points.

A page has them as JSON, and ``templates/explorer.js`` repeats the formulas of this module. Every line is a piecewise
cubic, stored as its values and slopes at the computed points. Nothing is said beyond the points, or next to one that
could not be computed.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from stiction.devices.roughness import LARGEST
from stiction.report.devices.grid import GridAxis, hermite, nested_lists
from stiction.report.devices.levels import Z95


@dataclass(frozen=True)
class Curves:
    """Margins of a device to its requirement against one quantity, and fractions stuck at the required size.

    Lines and ranges are those of each choice, such as a humidity. The lines are ``margin``, ``error`` (its standard
    error), ``stuck``, ``low`` and ``high`` (the fraction stuck and its band), perhaps also ``safe`` (margin with 95 %
    confidence).
    """

    axes: tuple[GridAxis, ...]  #: the quantity, and choices with answers at the computed values alone
    share: GridAxis  #: fraction p that may stick, one value
    size: GridAxis  #: required length or force, one value
    lines: Mapping[str, np.ndarray]  #: (choices..., 2, n): values and slopes at the places of the quantity
    ranges: list  #: ranges of the quantity that suffice, in lists over the choices
    best: tuple[float, float, float] | None  #: best value and the ends of its 95 % interval
    falls: bool  #: whether fewer stick at a larger size

    def at(self, state: Mapping[str, float]) -> dict[str, float]:
        """Value of each line at a state, NaN next to a point that could not be computed."""
        quantity, coordinate = self.axes[0], self.axes[0].coordinate(state[self.axes[0].key])
        return {
            name: _at(quantity.coordinates, *self._selection(line, state), coordinate)
            for name, line in self.lines.items()
        }

    def sizes(self, state: Mapping[str, float]) -> tuple[float, float, float]:
        """Length or force with the allowed fraction stuck, and the ends of its 95 % band."""
        values, sign = self.at(state), -1 if self.falls else 1
        reach = Z95 * values["error"]
        return tuple(self.size.start * float(np.exp(sign * values["margin"] + shift)) for shift in (0.0, -reach, reach))

    def suffices(self, state: Mapping[str, float]) -> bool:
        """Whether the quantity is in a range that suffices."""
        value = state[self.axes[0].key]
        return any(low <= value <= high for low, high in self._selection(self.ranges, state))

    def _selection(self, values, state):
        """Part of the lines or ranges for the choices of a state."""
        for axis in self.axes[1:]:
            axis.coordinate(state[axis.key])
            values = values[axis.values.index(state[axis.key])]
        return values

    @property
    def start(self) -> dict[str, float]:
        """State at which a page begins."""
        return {axis.key: axis.start for axis in (*self.axes, self.share, self.size)}

    @property
    def json(self) -> dict[str, Any]:
        """Content for a page."""
        lines = {name: nested_lists(line) for name, line in self.lines.items()}
        return asdict(self) | {"lines": lines, "largest": float(LARGEST)}


def line(coordinates: np.ndarray, values: np.ndarray, cubic: type) -> np.ndarray:
    """Values and slopes (2, n) of a curve of scipy through each run of known values (n,) at increasing places (n,)."""
    slopes = np.full(len(values), np.nan)
    for run in np.ma.clump_unmasked(np.ma.masked_invalid(values)):
        if run.stop - run.start > 1:
            slopes[run] = cubic(coordinates[run], values[run]).derivative()(coordinates[run])
    return np.array([values, slopes])


def _at(coordinates, values, slopes, coordinate):
    """Value of a line at a place."""
    k = int(np.searchsorted(coordinates, coordinate, "right")) - 1
    if coordinates[k] == coordinate:
        return float(values[k])
    width, between = coordinates[k + 1] - coordinates[k], slice(k, k + 2)
    return float(hermite(width, (coordinate - coordinates[k]) / width, values[between], slopes[between]))

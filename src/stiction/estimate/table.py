r"""Table of the estimate: a Gaussian process on a linear trend, through some points of the design. Plain Python.

With coordinates c in units of their scatter, and of the lengths l over which they matter, every quantity is

.. math:: q(c) = a + \sum_i b_i c_i + \sum_k w_k \, \exp \Bigl( -\sum_i \frac{(c_i - c_{ki})^2}{2 l_i^2} \Bigr) .
"""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from operator import mul
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("table.json")
#: Names of the changes on other solids, by `stiction.estimate.solids.BesideWater.logarithms`.
CHANGES = ("attraction", "attraction_through_air", "stiffness")


@dataclass(frozen=True)
class Surrogate:
    """Quantities over coordinates."""

    columns: Sequence[int]  #: numbers of the coordinates that it knows
    centre: Sequence[float]  #: of these
    scale: Sequence[float]  #: scatter of the coordinates over the design
    lengths: Sequence[float]  #: over which they matter, in scatters
    nodes: Sequence[Sequence[float]]  #: points in units of both
    trend: Mapping[str, Sequence[float]]  #: factors of 1 and of the coordinates, by name of a quantity
    weights: Mapping[str, Sequence[float]]
    low: Sequence[float]  #: ends of the coordinates of the design
    high: Sequence[float]
    farthest: float  #: largest distance from the nearest node at which the process is trusted

    def at(self, coordinates: Sequence[float]) -> "Values":
        """Quantities at some coordinates, with the distance from the nearest node."""
        chosen = [coordinates[k] for k in self.columns]
        standard = [(x - mean) / scale for x, mean, scale in zip(chosen, self.centre, self.scale, strict=True)]
        scaled = [x / length for x, length in zip(standard, self.lengths, strict=True)]
        distances = [math.dist(scaled, node) for node in self.nodes]
        near, terms = [math.exp(-0.5 * distance * distance) for distance in distances], [1.0, *standard]
        quantities = {name: _dot(self.trend[name], terms) + _dot(self.weights[name], near) for name in self.trend}
        return Values(quantities, min(distances), self._outside(chosen))

    def side(self, number: int, coordinate: float) -> str:
        """Side of the design on which a coordinate of a number is, in a word."""
        return "large" if coordinate > self.centre[self.columns.index(number)] else "small"

    def _outside(self, chosen):
        """Numbers of the coordinates beyond the design."""
        ends = zip(self.columns, chosen, self.low, self.high, strict=True)
        return tuple(k for k, x, low, high in ends if not low <= x <= high)


def processes(section: Mapping[str, Any], *names: str) -> tuple[Surrogate, ...]:
    """Processes of a part of the table by name, then its changes on other solids."""
    return tuple(Surrogate(**section[name]) for name in (*names, *CHANGES))


@dataclass(frozen=True)
class Values:
    """Quantities at one place."""

    of: Mapping[str, float]
    distance: float  #: from the nearest node, in the units of the process
    outside: tuple[int, ...]  #: coordinates beyond the design


def _dot(left, right):
    """Scalar product."""
    return sum(map(mul, left, right))


@cache
def content() -> dict[str, Any]:
    """Content of the file."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def origin() -> str:
    """From how many pairs of surfaces the file is learnt, and which file it is, in words."""
    numbers = dict.fromkeys(("learn", "decide", "check"), 0)
    for name, effort in content()["sets"].items():
        if (use := name.partition("_")[0]) in numbers:
            numbers[use] += effort["points"]
    learnt, deciding, checking = numbers.values()
    digest = hashlib.sha256(FILE.read_bytes()).hexdigest()[:8]
    return (
        f"Learnt from {learnt} drawn pairs of surfaces, {deciding} others decide the intervals and {checking} test "
        f"them; table {digest}, with the contacts of this version."
    )


@cache
def process(name: str) -> Surrogate:
    """Process of the file by name: ``tips`` on summits, or the change of their forces in ``full`` contact."""
    return Surrogate(**content()[name])


def known() -> tuple[dict[str, Any], Surrogate, Surrogate]:
    """All that an answer needs: the content of the file, and its processes of tips on summits and in full contact."""
    return content(), process("tips"), process("full")

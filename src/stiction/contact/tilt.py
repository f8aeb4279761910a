r"""Slope and edge of the tip of a beam, before any surface is drawn.

With the slope θ, heights of the underside drop by θ x at the distance x from where the edge begins, seen from the
substrate. A rounded edge of the radius R bends away from there, at x < 0, and is highest at x = -θ R:

.. math:: u = \theta x + \frac{\min(x, 0)^2}{2 R} + \frac{\theta^2 R}{2} .
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from stiction.contact.materials import InputStep, Property

#: Radius of a rounded edge as an uncertain input. Slopes by steps of 0.2 and 0.5 are equal within their errors, and the
#: larger step halves the errors.
EDGE_RADIUS = Property("edge_radius_um", "radius of the edge", InputStep(0.5))


class Edge(StrEnum):
    """Edge of a tip."""

    ROUNDED = "rounded"  #: it bends away; summits are those before the tilt
    SQUARE = "square"  #: it is cut; its own maxima touch as well


@dataclass(frozen=True)
class Tilt:
    """Slopes of a strip and its edge."""

    slopes: tuple[float, ...]  #: increasing [-]
    reach: float  #: how far below the distances points count as wet: at least the height of the film [m]
    edge: Edge = Edge.ROUNDED
    radius: float = 0.0  #: R of a rounded edge; with 0, nothing is before x = 0 [m]
    room: float | None = None  #: radius of an edge for which there is room before x = 0, by default R [m]

    @property
    def before(self) -> float:
        """Length of the strip before x = 0 [m]."""
        return length_of_edge(self.radius if self.room is None else self.room, self.reach, self.slopes[-1])

    def drop(self, slope: float, along: np.ndarray) -> np.ndarray:
        """Drop u of heights at distances x from the edge, below its highest line (n,) [m]."""
        if not self.radius:
            return slope * along
        return slope * along + np.minimum(along, 0) ** 2 / (2 * self.radius) + slope**2 * self.radius / 2

    @property
    def ends(self) -> np.ndarray:
        """Sum of 1/|u'| where wedge and edge have dropped by the reach (s,) [-]."""
        of_edge = math.sqrt(self.radius / (2 * self.reach)) if self.radius else 0.0
        return 1 / np.array(self.slopes) + of_edge


def length_of_edge(radius: float, reach: float, slope: float) -> float:
    """Length of a rounded edge up to where it has dropped by a reach, at a slope [-] of the tip, in one unit.

    Examples
    --------
    >>> length_of_edge(0.1, 0.02, 0)
    0.06324555320336758
    """
    return radius * slope + math.sqrt(2 * radius * reach)

r"""Shape of a probe: a sphere, the tip of an AFM, or a flat punch with a round rim.

At the distance r from its axis it has risen by

.. math:: u = \frac{\max(r - a, 0)^2}{2 R}

with the radius a of its flat, 0 for a sphere, and the radius R of the sphere or of the rim.

ASSUME: R is far above the height of the film, so that parabolas stand for spheres.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

#: Rise of a probe at the sides of the patch under it [m]. ASSUME: nothing acts across larger gaps.
RISE = 100e-9


@dataclass(frozen=True)
class Probe:
    """Sphere or punch."""

    radius: float  #: R of the sphere, or of the rim of a punch [m]
    flat: float = 0.0  #: radius a of the flat of a punch [m]

    @property
    def side(self) -> float:
        """Side of the square at whose sides it has risen by `RISE` [m].

        Examples
        --------
        >>> round(1e6 * Probe(10e-6).side, 3)
        2.828
        """
        return 2 * self.zone(RISE)

    def zone(self, rise: float) -> float:
        """Radius of the circle in which it has risen by no more than this [m]."""
        return self.flat + math.sqrt(2 * self.radius * rise)

    def rise(self, shape: tuple[int, int], spacing: float) -> "np.ndarray":
        """Rise u over points with this spacing, with the axis on one in the middle (n1, n2) [m]."""
        import numpy as np  # not before: every start of the command reads the kinds of devices

        x, y = (spacing * (np.arange(number) - number // 2) for number in shape)
        return np.maximum(np.hypot(x[:, None], y) - self.flat, 0) ** 2 / (2 * self.radius)

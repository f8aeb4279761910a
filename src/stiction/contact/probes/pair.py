r"""Contact of a rough surface with a probe (independent of humidity).

The gap is larger by the rise u of `stiction.contact.probes.shape`: a point of the height z is as high as one of the
height z - u under a flat. Summits are the maxima of z - u, so that a smooth sphere is one of its radius.

Limits of the pull-off force of a sphere: under a zone much wider than the correlation of the surfaces
:math:`2 \pi R \bar e` (B. V. Derjaguin, Kolloid-Z. 69, 155, 1934), on smooth solids in humid air
:math:`4 \pi R \gamma`.

ASSUME: the axis meets the surfaces anywhere, and each sample has another place of both. A probe that touches with one
spot of its own scatters less.
"""

from dataclasses import dataclass, field

import numpy as np

from stiction.contact.pair import DistanceGrid, Summits, SurfacePair, solid_pressure
from stiction.contact.probes.shape import RISE, Probe
from stiction.surface.summits import find_summits

#: Depth below the lowest height to which a probe can be pressed [m]. Smooth spheres of 100 µm of silicon sink by 2 nm.
PRESSED = 10e-9


@dataclass(frozen=True)
class ProbedPair(SurfacePair):
    """Two surfaces, one of them of a probe."""

    probe: Probe = field(kw_only=True)

    @property
    def depth(self) -> float:
        """Depth of the first distance below the mean planes: no solid is deeper [m]."""
        return self.step * super().distances.below + PRESSED

    @property
    def distances(self) -> DistanceGrid:
        """Grid of the distances, from `depth` up to the highest possible height."""
        above = super().distances.above + int(np.ceil(self.depth / self.step))
        return DistanceGrid(self.step, int(np.ceil(RISE / self.step)), above)

    def under_flat(self, heights: np.ndarray) -> np.ndarray:
        """Heights z - u above `depth` of a surface z (n1, n2) [m], float32."""
        lowered = self.depth - self.probe.rise(heights.shape, self.spacing)
        return (heights + lowered).astype(np.float32)

    def contact(self, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solid pressure and bearing area of a surface z (n1, n2) [m] under the probe.

        As by ``SurfacePair.contact``.

        Both refer to the whole patch: away from the axis nothing touches, so that sides without summits miss none.
        """
        raised = self.under_flat(heights)
        tops, curvatures, _ = find_summits(raised, self.spacing)
        summits = Summits(tops, curvatures, raised.size * self.spacing**2)
        return solid_pressure(self.asperity, summits, self.distances), self.bearing_area(raised)

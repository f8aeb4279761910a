r"""Middle of a bridge in dry air, as the estimate knows it. Plain Python, SI units.

As in `stiction.estimate.bridge`, a law that attracts with f up to the reach e / f holds a bridge up to

.. math:: L^8 = \frac{768 (E t^3)^2 h^3}{e f} .

The pull-off pressure f of a patch is known from stoppers, and the reach is of the order of the distance :math:`D_0` of
solids at rest. What is learnt is the logarithm of a length in full contact over :math:`L_f`, the length with f and
:math:`e = f D_0`.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

from stiction.estimate.dry import AT_REST, OF_PATCHES, DryPatch
from stiction.estimate.length import Lengths, falling, known_at
from stiction.estimate.state import curvature, held_by
from stiction.estimate.table import Surrogate

#: Names of the coordinates, for messages: rms, attraction and area.
COORDINATES = (
    *OF_PATCHES[:2],
    "area of the middle in contact in summits (from thickness, gap and width)",
)
#: Area of the patch whose pull-off pressure counts [m²]. ASSUME: it hardly depends on the area.
AREA = 9e-12


@dataclass(frozen=True)
class DryMiddle:
    """Surfaces, solids and a bridge."""

    patch: DryPatch  #: of `AREA`
    pull_off: float  #: its pull-off pressure f [Pa]
    rigidity: float  #: E t³ [N m]
    gap: float  #: h [m]
    width: float  #: [m]
    names: ClassVar[tuple[str, ...]] = COORDINATES

    @property
    def patch_length(self) -> float:
        """L_f [m]."""
        return (held_by(self.rigidity, self.gap) / (self.pull_off**2 * AT_REST)) ** 0.125

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which its length over L_f depends, by ``COORDINATES``. ASSUME: on no others."""
        contact = 8 * self.rigidity * self.gap / (self.patch_length**3 * self.pull_off)
        summits = self.width * contact * curvature(self.patch.heights) ** 2
        return *self.patch.coordinates[:2], math.log(summits)


def lengths(state: DryMiddle, middle: Surrogate) -> Lengths:
    """Lengths without stress that are held as well as those under it [m].

    Raises
    ------
    NotLearnt
        If the state is beyond what was learnt.
    """
    return falling(known_at(middle, state.coordinates, state.names), math.log(state.patch_length))

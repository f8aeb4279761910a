r"""Force that holds a fraction of stoppers, as the estimate knows it. Plain Python, SI units.

Pull-off forces F have the scores of lengths 1/F: the larger the force, the fewer stick. Full contact changes them as in
`stiction.contact.correction`: their mean by a ratio r, and their scatter s by a power b. With the median m on summits,

.. math:: \ln F = \ln m + b \ln \frac F m + \ln r + \frac{(1 - b^2) s^2}{2} .

ASSUME: forces are lognormal for the mean of the powers, with the scatter from the median to the last score.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from stiction.config.units import to_si
from stiction.estimate import dry
from stiction.estimate.asked import Asked
from stiction.estimate.closed import flats
from stiction.estimate.closed.flats import FlatBound, FlatPull
from stiction.estimate.closed.life import StopperLife
from stiction.estimate.length import LengthRow, Lengths, NotLearnt, falling, known_at, on_solids
from stiction.estimate.state import OF_PATCHES, Film, PatchState
from stiction.estimate.statistics import Heights
from stiction.estimate.table import Surrogate, processes
from stiction.estimate.voltage import Pulled


@dataclass(frozen=True)
class ForceRow:
    """Restoring force below which a fraction sticks."""

    fraction: float
    force: float  #: [N]
    intervals: dict[str, tuple[float, float]]  #: by confidence [N]

    @property
    def size(self) -> float:
        """What a device is built to, in SI."""
        return self.force


def reciprocals(patch: PatchState, forces: Surrogate, full: Surrogate, *changes: Surrogate) -> Lengths:
    """Reciprocals of the pull-off forces of a patch [1/N].

    Raises
    ------
    NotLearnt
        If the patch is beyond what was learnt.
    """
    change = known_at(full, patch.coordinates, OF_PATCHES)
    summits = falling(on_solids(forces, patch, *changes), -math.log(patch.flooded_force))
    return _changed(summits, change["ratio"], max(1.0, change["power"]))


def _changed(summits, ratio, power):
    """Reciprocals by full contact, from the logarithm of its ratio and its power."""
    median = summits.logarithms[0]
    shift = median - ratio - (1 - power**2) * summits.fall**2 / 2
    return Lengths(tuple(shift + power * (each - median) for each in summits.logarithms), power * summits.slope)


def pull_off(patch: PatchState, learnt: Mapping[str, Any]) -> float:
    """Median pull-off pressure of a patch, from the part of the table about stoppers [Pa].

    Raises
    ------
    NotLearnt
        If the patch is beyond what was learnt.
    """
    return math.exp(-_reciprocals_of(patch, learnt).logarithms[0]) / patch.area


def _reciprocals_of(patch, learnt):
    """Reciprocals of the forces of a patch."""
    return reciprocals(patch, *processes(learnt, "forces", "full"))


@dataclass(frozen=True)
class Stopper(Asked):
    """Question about one stopper."""

    sides: tuple[float, float]  #: of its area [m]
    force: float | None = None  #: that restores it [N]
    unit: ClassVar[str] = "uN"  #: of its size, a force

    @property
    def size(self) -> float | None:
        """Its restoring force [N]."""
        return self.force

    @property
    def stated(self) -> float | None:
        """Reciprocal of its force [1/N]."""
        return None if self.force is None else 1 / self.force

    @property
    def closed(self) -> Pulled:
        """Closed form of its forces at its voltage."""
        return Pulled(self.added)

    @property
    def life(self) -> StopperLife:
        """Its life."""
        return StopperLife(self.surroundings)

    def on_flats(self, attracted: Sequence[FlatPull]) -> FlatBound:
        """Force that flat surfaces hold by their attractions."""
        return flats.of_stopper(math.prod(self.sides), attracted)

    def errors(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """Part of the table with the errors of its forces."""
        return table["stoppers"]

    def lengths(self, heights: Heights, water: Film, table: Mapping[str, Any], *_tips: Surrogate | None) -> Lengths:
        """Reciprocals of its pull-off forces on the sum of two surfaces [1/N]."""
        learnt, ratios = table["stoppers"], self.solids.beside_water(water.energy)
        patch = PatchState(heights, water, self._area(learnt), self.solids.modulus, ratios)
        return _reciprocals_of(patch, learnt)

    def in_dry_air(self, heights: Heights, table: Mapping[str, Any]) -> Lengths:
        """Reciprocals of its pull-off forces in dry air [1/N]."""
        learnt = table["dry"]["stoppers"]
        patch = dry.DryPatch(heights, self.solids.in_dry_air, self._area(learnt), self.solids.modulus)
        return dry.reciprocals(patch, *dry.processes(learnt, "forces", "full"))

    def _area(self, learnt):
        """Area [m²] with learnt sides."""
        if self.force is not None and not self.force > 0:
            raise ValueError(f"a restoring force must be positive, got {self.force}")
        low, high = (to_si(end, "um") for end in learnt["sides"])
        if not all(low <= side <= high for side in self.sides):
            raise NotLearnt(f"sides of a stopper must be from {learnt['sides'][0]:g} to {learnt['sides'][1]:g} µm")
        return math.prod(self.sides)

    def row(self, row: LengthRow) -> ForceRow:
        """Force by its reciprocal."""
        ends = {name: (1 / high, 1 / low) for name, (low, high) in row.intervals.items()}
        return ForceRow(row.fraction, 1 / row.length, ends)

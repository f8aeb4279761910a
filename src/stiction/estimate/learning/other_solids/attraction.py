"""Contacts of the design with solids that attract each other more or less than polysilicon, beside its water.

Tips, patches and bridges on summits, on the strips of some points of `stiction.estimate.learning.training`,
`stiction.estimate.learning.patches` and `stiction.estimate.learning.bridges`, so that what changes is the attraction
alone: through water with what follows from it through air, then through air alone:

    python -m stiction.estimate.learning.other_solids.attraction FOLDER [SET [FIRST LAST]]
"""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import from_si, to_si
from stiction.estimate.learning import bridges, patches, training
from stiction.estimate.learning.design import Point, states
from stiction.estimate.learning.training import TrainingEffort, TrainingTips, main, train, with_materials
from stiction.estimate.solids import OF_POLYSILICON, Attraction, SolidPair, following
from stiction.plan.plan import Plan
from stiction.streams import stream

#: Airs of a point, the first of those of polysilicon.
AIRS = 3
#: Names of the ratios in files, by the fields of `stiction.estimate.solids.Attraction`.
_KEYS = ("ratio", "ratio_through_air")
#: Sets to learn from.
_LEARNT = ("learn_any", "learn_typical")


@dataclass(frozen=True)
class LearntRatio:
    """Points at which an attraction changes, beside those at which it does not."""

    name: str  #: field of `stiction.estimate.solids.Attraction`
    range: tuple[float, float]  #: its least and largest value, even in its logarithm
    folder: str  #: of the points, beside those of polysilicon
    before: "LearntRatio | None"  #: that of the points at which it does not change, none for polysilicon
    points: int  #: of each set, the first ones of polysilicon
    bridges: int  #: of these, some of which have bridges

    @property
    def number(self) -> int:
        """Number of the ratios that differ from polysilicon's."""
        return 1 + (self.before.number if self.before else 0)

    @property
    def sets(self) -> dict[str, TrainingEffort]:
        """Sets of points."""
        return {name: replace(training.SETS[name], points=self.points, states=AIRS) for name in _LEARNT}

    @property
    def of_bridges(self) -> dict[str, TrainingEffort]:
        """Sets of points of bridges."""
        return {name: replace(effort, points=self.bridges) for name, effort in self.sets.items()}

    def attraction(self, point: Point, seed: int) -> Attraction:
        """Attraction at a point."""
        ratios = self.before.attraction(point, seed) if self.before else OF_POLYSILICON
        low, high = map(math.log, self.range)
        drawn = math.exp(stream(seed, "estimate", self.folder, point.number).uniform(low, high))
        return replace(ratios, **{self.name: round(drawn, 4)})


#: From silica through water to gold on sides of which water has a contact angle of 70°.
THROUGH_WATER = LearntRatio("through_water", (0.04, 8.0), "attraction", None, 32, 28)
#: Solids of the combining relation have 1.4 to 2.7: polysilicon has less, contact angles and unlike sides add.
THROUGH_AIR = LearntRatio("through_air", (0.5, 4.0), "attraction_through_air", THROUGH_WATER, 24, 16)


def scaled(plan: Plan, attraction: Attraction) -> Plan:
    """Plan of a point whose solids have an attraction beside polysilicon's."""
    polysilicon = SolidPair()
    through_water = attraction.through_water * polysilicon.through_water
    dry = attraction.through_air * (following(through_water) / following(polysilicon.through_water))
    constants = {"water": through_water, "dry": dry * polysilicon.in_dry_air}
    material = {"hamaker_constant_zJ": {medium: from_si(constant, "zJ") for medium, constant in constants.items()}}
    return with_materials(plan, material, material)


def _ratios(attraction):
    """Ratios of an attraction for a file."""
    return dict(zip(_KEYS, map(np.array, vars(attraction).values()), strict=True))


def stored_attraction(numbers: Mapping[str, Any]) -> Attraction:
    """Attraction of a file, which may have that through water alone."""
    return Attraction(*(float(numbers[key]) for key in _KEYS if key in numbers))


def computed(point: Point, name: str, valid: dict[str, Any], ratio: LearntRatio) -> dict[str, Any]:
    """Numbers of one point of a set."""
    effort, of_polysilicon = ratio.sets[name], training.SETS[name]
    attraction = ratio.attraction(point, effort.seed)
    airs = states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    number = effort.tips + round(effort.tips_by_width / to_si(point.width, "um"))
    tips = TrainingTips.of(point, scaled(training.plan_of(point, valid), attraction), number, effort.seed)
    sides = patches.sides_of(point, effort.seed, effort.law)
    plan = scaled(patches.plan_of(point, sides, patches.base()), attraction)
    forces = patches.forces_of(point, plan, airs[:, 0], effort.patches, effort.seed)
    slopes = np.array([tips.slopes(*air) for air in airs], np.float32)
    return _ratios(attraction) | {"slopes": slopes, "forces": forces.astype(np.float32)}


def computed_bridges(point: Point, name: str, valid: dict[str, Any], ratio: LearntRatio) -> dict[str, Any]:
    """Lengths that the middle of the bridges of one point of a set holds."""
    effort, of_polysilicon = ratio.of_bridges[name], training.SETS[name]
    attraction = ratio.attraction(point, effort.seed)
    airs = states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    strips = bridges.TrainingStrips.of(
        point, scaled(bridges.plan_of(point, valid), attraction), bridges.STRIPS, effort.seed
    )
    each = zip(airs[:, 0], bridges.sizes_of(point, name), strict=False)
    lengths = np.array([strips.lengths(height, size, effort.patches) for height, size in each])
    return _ratios(attraction) | {"lengths": lengths.astype(np.float32)}


if __name__ == "__main__":
    for of_ratio in (THROUGH_WATER, THROUGH_AIR):
        trained = Path(sys.argv[1]) / of_ratio.folder
        main(training.base(), partial(computed, ratio=of_ratio), trained, of_ratio.sets, *sys.argv[2:])
        for each, of_set in of_ratio.of_bridges.items():
            numbers = range(0, of_set.points, bridges.EVERY[each])
            train(
                trained / bridges.FOLDER / each,
                of_set.all,
                numbers,
                bridges.base(),
                partial(computed_bridges, ratio=of_ratio),
            )

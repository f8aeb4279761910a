"""Contacts of the design with solids that attract each other more or less, or are stiffer, beside their water.

Tips, patches and bridges on summits, on the strips of some points of `stiction.estimate.learning.training`,
`stiction.estimate.learning.patches` and `stiction.estimate.learning.bridges`, so that what changes is one ratio alone:
the attraction through water with what follows from it through air, then that through air, or the stiffness.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stiction.config.units import from_si, to_si
from stiction.estimate.learning import bridges, patches, training
from stiction.estimate.learning.design import Point, states
from stiction.estimate.learning.training import TrainingEffort, TrainingTips, of_beam, with_materials
from stiction.estimate.solids import OF_POLYSILICON, BesideWater, SolidPair, following
from stiction.streams import stream

#: Airs of a point, the first of those of polysilicon.
AIRS = 3
#: Names of the ratios in files, by the fields of `stiction.estimate.solids.BesideWater`.
KEYS = ("ratio", "ratio_through_air", "ratio_of_stiffness")
#: Sets to learn from.
_LEARNT = ("learn_any", "learn_typical")


@dataclass(frozen=True)
class LearntRatio:
    """Points at which one ratio changes, beside those at which it does not."""

    name: str  #: field of `stiction.estimate.solids.BesideWater`
    range: tuple[float, float]  #: its least and largest value, even in its logarithm
    folder: str  #: of the points, beside those of polysilicon
    before: "LearntRatio | None"  #: that of the points at which it does not change, none for polysilicon
    points: int  #: of each set, the first ones of polysilicon
    bridges: int  #: of these, some of which have bridges
    random: Callable[[int, int], np.random.Generator]  #: of a point, from a seed and its number

    @property
    def numbers(self) -> tuple[int, ...]:
        """Numbers of the ratios that differ from polysilicon's, its own last."""
        before = self.before.numbers if self.before else ()
        return (*before, list(vars(OF_POLYSILICON)).index(self.name))

    @property
    def sets(self) -> dict[str, TrainingEffort]:
        """Sets of points."""
        return {name: replace(training.SETS[name], points=self.points, states=AIRS) for name in _LEARNT}

    @property
    def of_bridges(self) -> dict[str, TrainingEffort]:
        """Sets of points of bridges."""
        return {name: replace(effort, points=self.bridges) for name, effort in self.sets.items()}

    def beside_water(self, point: Point, seed: int) -> BesideWater:
        """Ratios at a point."""
        ratios = self.before.beside_water(point, seed) if self.before else OF_POLYSILICON
        low, high = map(math.log, self.range)
        drawn = math.exp(self.random(seed, point.number).uniform(low, high))
        return replace(ratios, **{self.name: round(drawn, 4)})


#: From silica through water to gold on sides of which water has a contact angle of 70°.
THROUGH_WATER = LearntRatio(
    "through_water", (0.04, 8.0), "attraction", None, 32, 28, lambda seed, k: stream(seed, "estimate", "attraction", k)
)
#: Solids of the combining relation have 1.4 to 2.7: polysilicon has less, contact angles and unlike sides add.
THROUGH_AIR = LearntRatio(
    "through_air",
    (0.5, 4.0),
    "attraction_through_air",
    THROUGH_WATER,
    24,
    16,
    lambda seed, k: stream(seed, "estimate", "attraction_through_air", k),
)
#: From 60 GPa to 400 GPa on sides of which water has a contact angle of 80°. ASSUME: alike at any attraction.
STIFFNESS = LearntRatio(
    "stiffness", (0.3, 12.0), "stiffness", None, 80, 40, lambda seed, k: stream(seed, "estimate", "stiffness", k)
)
#: All, in the order of `stiction.estimate.table.CHANGES`.
ALL = (THROUGH_WATER, THROUGH_AIR, STIFFNESS)


def material_of(ratios: BesideWater) -> dict[str, Any]:
    """Material of both solids with some ratios beside water as on polysilicon, in the units of files."""
    polysilicon = SolidPair()
    through_water = ratios.through_water * polysilicon.through_water
    dry = ratios.through_air * (following(through_water) / following(polysilicon.through_water))
    constants = {"water": through_water, "dry": dry * polysilicon.in_dry_air}
    return {
        "hamaker_constant_zJ": {medium: from_si(constant, "zJ") for medium, constant in constants.items()},
        "young_modulus_GPa": from_si(ratios.stiffness * polysilicon.modulus, "GPa"),
    }


def _stored(ratios):
    """Ratios for a file."""
    return dict(zip(KEYS, map(np.array, vars(ratios).values()), strict=True))


def stored_ratios(numbers: Mapping[str, Any]) -> BesideWater:
    """Ratios of a file, of which the last may be missing."""
    return BesideWater(*(float(numbers[key]) for key in KEYS if key in numbers))


def computed(point: Point, name: str, valid: dict[str, Any], ratio: LearntRatio) -> dict[str, Any]:
    """Numbers of one point of a set."""
    effort, of_polysilicon = ratio.sets[name], training.SETS[name]
    ratios = ratio.beside_water(point, effort.seed)
    material = material_of(ratios)
    airs = states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    number = effort.tips + round(effort.tips_by_width / to_si(point.width, "um"))
    plan = with_materials(training.plan_of(of_beam(point, material, valid), valid), material, material)
    tips = TrainingTips.of(point, plan, number, effort.seed)
    sides = patches.sides_of(point, effort.seed, effort.law)
    plan = with_materials(patches.plan_of(point, sides, patches.base()), material, material)
    forces = patches.forces_of(point, plan, airs[:, 0], effort.patches, effort.seed)
    slopes = np.array([tips.slopes(*air) for air in airs], np.float32)
    return _stored(ratios) | {"slopes": slopes, "forces": forces.astype(np.float32)}


def as_stiff(sizes: np.ndarray, stiffness: float) -> np.ndarray:
    """Thickness t, gap and stress of bridges (airs, 3) on stiffer solids, as stiff as those of some sizes.

    With :math:`E t^3` and the force of the stress, σ t, all their coordinates stay.
    """
    thinner = stiffness ** (-1 / 3)
    return sizes * np.array([thinner, 1, 1 / thinner])


def computed_bridges(point: Point, name: str, valid: dict[str, Any], ratio: LearntRatio) -> dict[str, Any]:
    """Lengths that the middle of the bridges of one point of a set holds."""
    effort, of_polysilicon = ratio.of_bridges[name], training.SETS[name]
    ratios = ratio.beside_water(point, effort.seed)
    material = material_of(ratios)
    airs = states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    plan = with_materials(bridges.plan_of(point, valid), material, material)
    strips = bridges.TrainingStrips.of(point, plan, bridges.STRIPS, effort.seed)
    each = zip(airs[:, 0], as_stiff(bridges.sizes_of(point, name), ratios.stiffness), strict=False)
    lengths = np.array([strips.lengths(height, size, effort.patches) for height, size in each])
    return _stored(ratios) | {"lengths": lengths.astype(np.float32)}

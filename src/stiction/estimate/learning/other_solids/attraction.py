"""Contacts of the design with solids that attract each other more or less than polysilicon, beside its water.

Tips, patches and bridges on summits, on the strips of some points of `stiction.estimate.learning.training`,
`stiction.estimate.learning.patches` and `stiction.estimate.learning.bridges`, so that what changes is the attraction
alone:

    python -m stiction.estimate.learning.other_solids.attraction FOLDER [SET [FIRST LAST]]
"""

import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import from_si, to_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.estimate.learning import bridges, patches, training
from stiction.estimate.learning.design import Point, states
from stiction.estimate.learning.training import TrainingTips, main, train, with_materials
from stiction.plan.plan import Plan
from stiction.streams import stream

#: Folder of the points beside those of polysilicon.
FOLDER = "attraction"
#: Least and largest Hamaker constant over polysilicon's, even in its logarithm: from silica through water to gold on
#: sides of which water has a contact angle of 70°.
RATIOS = (0.04, 8.0)
#: Hamaker constant of water [zJ]; J. N. Israelachvili, Intermolecular and Surface Forces.
_OF_WATER = 37.0
#: Airs of a point, the first of those of polysilicon.
AIRS = 3
#: Sets to learn from: the first points of those of polysilicon.
SETS = {
    name: replace(training.SETS[name], points=points, states=AIRS)
    for name, points in (("learn_any", 32), ("learn_typical", 32))
}


#: The same of bridges, which some of the points have.
OF_BRIDGES = {name: replace(training.SETS[name], points=28, states=AIRS) for name in SETS}


def ratio_of(point: Point, seed: int) -> float:
    """Hamaker constants of a point over polysilicon's [-]."""
    low, high = map(math.log, RATIOS)
    return round(math.exp(stream(seed, "estimate", "attraction", point.number).uniform(low, high)), 4)


def in_dry_air(through_water: float) -> float:
    """Hamaker constant of two solids in dry air, from that through water, by the combining relation [zJ].

    As `stiction.contact.vanderwaals.combined`.

    Examples
    --------
    >>> round(in_dry_air(4.6)), round(in_dry_air(250))  # silica, gold
    (68, 479)
    """
    return (through_water**0.5 + _OF_WATER**0.5) ** 2


def scaled(plan: Plan, ratio: float) -> Plan:
    """Plan of a point whose solids attract each other through water as polysilicon by a ratio.

    ASSUME: in air, beyond the film, they do as the combining relation says, in proportion to polysilicon.
    """
    polysilicon = {medium: from_si(constant, "zJ") for medium, constant in HAMAKER_CONSTANT.items()}
    through_water = ratio * polysilicon["water"]
    dry = polysilicon["dry"] * (in_dry_air(through_water) / in_dry_air(polysilicon["water"]))
    material = {"hamaker_constant_zJ": {"water": through_water, "dry": dry}}
    return with_materials(plan, material, material)


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set."""
    effort, of_polysilicon = SETS[name], training.SETS[name]
    ratio, airs = ratio_of(point, effort.seed), states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    number = effort.tips + round(effort.tips_by_width / to_si(point.width, "um"))
    tips = TrainingTips.of(point, scaled(training.plan_of(point, valid), ratio), number, effort.seed)
    sides = patches.sides_of(point, effort.seed, effort.law)
    plan = scaled(patches.plan_of(point, sides, patches.base()), ratio)
    forces = patches.forces_of(point, plan, airs[:, 0], effort.patches, effort.seed)
    slopes = np.array([tips.slopes(*air) for air in airs], np.float32)
    return {"ratio": np.array(ratio), "slopes": slopes, "forces": forces.astype(np.float32)}


def computed_bridges(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Lengths that the middle of the bridges of one point of a set holds."""
    effort, of_polysilicon = OF_BRIDGES[name], training.SETS[name]
    ratio, airs = ratio_of(point, effort.seed), states(of_polysilicon.states, point.number, effort.seed)[:AIRS]
    plan = scaled(bridges.plan_of(point, valid), ratio)
    strips = bridges.TrainingStrips.of(point, plan, bridges.STRIPS, effort.seed)
    each = zip(airs[:, 0], bridges.sizes_of(point, name), strict=False)
    lengths = np.array([strips.lengths(height, size, effort.patches) for height, size in each])
    return {"ratio": np.array(ratio), "lengths": lengths.astype(np.float32)}


if __name__ == "__main__":
    trained = Path(sys.argv[1]) / FOLDER
    main(training.base(), computed, trained, SETS, *sys.argv[2:])
    for each, of_set in OF_BRIDGES.items():
        numbers = range(0, of_set.points, bridges.EVERY[each])
        train(trained / bridges.FOLDER / each, of_set.all, numbers, bridges.base(), computed_bridges)

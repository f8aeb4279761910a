"""Contacts of other solids at other temperatures, by which the estimate is tested: none of them is learnt.

As `stiction.estimate.learning.training` and `stiction.estimate.learning.patches`, with other moduli, Hamaker constants
and contact angles on both sides.
"""

import math
from typing import Any

import numpy as np

from stiction.config.units import from_si, to_si
from stiction.contact import meniscus
from stiction.estimate.learning import patches, training
from stiction.estimate.learning.design import Point, SurfaceLaw, states
from stiction.estimate.learning.training import (
    FACTORS,
    TrainingEffort,
    TrainingTips,
    changes_of,
    full_contact_of,
    of_beam,
    water_of,
    with_materials,
)
from stiction.estimate.solids import following
from stiction.plan.plan import Plan
from stiction.streams import stream

#: Folder of the tips beside those of polysilicon; it has that of the patches.
FOLDER = "solids"
#: Ranges: temperature [K] of both, and of each side Young's modulus [GPa], Poisson's ratio, Hamaker constant through
#: water [zJ], logarithmic, and contact angle [°].
TEMPERATURES = (275.0, 370.0)
RANGES = {"modulus": (60.0, 400.0), "poisson_ratio": (0.15, 0.35), "hamaker": (4.6, 250.0), "angle": (0.0, 80.0)}
#: Sets of points by name. Their seeds are in no other set.
SETS = {
    "decide_typical": TrainingEffort(40, 21, SurfaceLaw.TYPICAL, 40, to_si(1600, "um"), 1, 1, 400),
    "decide_any": TrainingEffort(40, 22, SurfaceLaw.ANY, 40, to_si(1600, "um"), 1, 1, 400),
    "check_typical": TrainingEffort(16, 23, SurfaceLaw.TYPICAL, 40, to_si(1600, "um"), 1, 1, 400),
    "check_any": TrainingEffort(16, 24, SurfaceLaw.ANY, 40, to_si(1600, "um"), 1, 1, 400),
}


def drawn(point: Point, seed: int) -> tuple[float, list[dict[str, Any]]]:
    """Temperature [K] of a point, and the materials of both sides in the units of files."""
    rng = stream(seed, "estimate", "solids", point.number)
    temperature = round(rng.uniform(*TEMPERATURES), 1)
    return temperature, [_material(rng) for _ in range(2)]


def _material(rng):
    """Material of one side. Its constants through water and air follow from each other by the combining relation."""
    modulus, poisson_ratio, angle = (rng.uniform(*RANGES[name]) for name in ("modulus", "poisson_ratio", "angle"))
    through_water = math.exp(rng.uniform(*map(math.log, RANGES["hamaker"])))
    through_air = from_si(following(to_si(through_water, "zJ")), "zJ")
    return {
        "young_modulus_GPa": round(modulus, 1),
        "poisson_ratio": round(poisson_ratio, 3),
        "hamaker_constant_zJ": {"water": round(through_water, 2), "dry": round(through_air, 2)},
        "contact_angle_deg": round(angle, 1),
    }


def humidity_of(temperature: float, materials: list[dict[str, Any]], height: float) -> float:
    """Humidity of a film of a height [m], with the decimals that a configuration has."""
    angles = tuple(to_si(material["contact_angle_deg"], "deg") for material in materials)
    of_e = float(meniscus.meniscus_height(np.exp(-1), temperature, angles))  # inverse to the logarithm
    return round(math.exp(-of_e / height), 4)


def with_solids(plan: Plan, temperature: float, materials: list[dict[str, Any]]) -> Plan:
    """Plan of a point with a temperature [K] and the materials of both sides."""
    return with_materials(Plan(plan.config | {"water": {"temperature_K": temperature}}), *materials)


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of the tips of one point of a set."""
    effort, (temperature, materials) = SETS[name], drawn(point, SETS[name].seed)
    humidity = humidity_of(temperature, materials, states(1, point.number, effort.seed)[0, 0])
    plan = with_solids(training.plan_of(of_beam(point, materials[0], valid), valid), temperature, materials)
    number = effort.tips + round(effort.tips_by_width / to_si(point.width, "um"))
    tips, water = TrainingTips.of(point, plan, number, effort.seed), water_of(plan)
    of_full = full_contact_of(point, plan, humidity, effort)
    slopes = tips.slopes_in(humidity, water, changes_of(**of_full))[FACTORS.index(1.0)]
    return of_full | {"humidity": np.array(humidity), "changed": slopes.astype(np.float32)}


def computed_patches(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Pull-off pressures of the patches of one point of a set, and their change by full contact."""
    effort, (temperature, materials) = SETS[name], drawn(point, SETS[name].seed)
    humidity = humidity_of(temperature, materials, states(1, point.number, effort.seed)[0, 0])
    sides = patches.sides_of(point, effort.seed, effort.law)
    plan = with_solids(patches.plan_of(point, sides, valid), temperature, materials)
    forces = patches.forces_in(point, plan, [humidity], effort.patches, effort.seed)
    results = {"humidity": np.array(humidity), "sides": np.array(sides), "forces": forces.astype(np.float32)}
    return results | patches.change_in(point, plan, humidity, effort.seed)

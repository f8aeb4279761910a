"""Patches of the design: pull-off forces of stoppers on summits, and the change of their mean by full contact.

As `stiction.estimate.learning.training`, whose surfaces and air they have.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from stiction.config.cases import Case, case_id
from stiction.config.files import load
from stiction.config.units import in_si, to_si
from stiction.contact.full.effort import TooLong
from stiction.errors import NotConverged
from stiction.estimate.learning.design import SIDES, Point, SurfaceLaw, states
from stiction.estimate.learning.training import HUMIDITIES, PAIR, SETS, air_of, surfaces_of, water_of
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact, curves, full_energy
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices.contact_names import patch_of
from stiction.streams import stream

#: Folder of the patches beside the sets of the tips.
FOLDER = "patches"
#: Name of the device.
DEVICE = "S"
#: Sides of the patches on surfaces of the paper [µm].
_OF_PAPER = (3.0, 3.0)
#: Width of strips in full contact [m], and relative error of the ratio of means for which strips are drawn.
_WIDTH, _ERROR = to_si(6, "um"), 0.08


def base() -> dict[str, Any]:
    """Configuration of the points: all that stoppers have by default."""
    device = {"kind": "stopper", "pair": PAIR, "contact_um": list(_OF_PAPER), "restoring_force_uN": 1}
    pair = {"beam": "S", "substrate": "T", "gap_um": 2, "humidities": HUMIDITIES}
    return load(
        {
            "run": {"pairs": [], "studies": []},
            "surfaces": {"S": {"rms_nm": 3, "like": "B2"}, "T": {"rms_nm": 0.2, "like": "Sub1"}},
            "pairs": {PAIR: pair},
            "devices": {DEVICE: device | {"humidities": HUMIDITIES}},
        }
    )


def sides_of(point: Point, seed: int, law: SurfaceLaw) -> tuple[float, float]:
    """Sides of the patch of a point [µm]."""
    if law is SurfaceLaw.PAPER:
        return _OF_PAPER
    drawn = np.exp(stream(seed, "estimate", "sides", point.number).uniform(*map(math.log, SIDES), 2))
    return tuple(np.round(drawn, 1).tolist())


def plan_of(point: Point, sides: tuple[float, float], valid: dict[str, Any]) -> Plan:
    """Plan of a point under a patch [µm], from a valid configuration with one pair and one device."""
    surfaces = valid["surfaces"] | dict(zip("ST", point.sides, strict=True))
    device = valid["devices"][DEVICE] | {"contact_um": list(sides)}
    return Plan(valid | {"surfaces": surfaces, "devices": {DEVICE: device}})


def forces_of(point: Point, plan: Plan, heights: np.ndarray, number: int, seed: int) -> np.ndarray:
    """Pull-off pressures of a number of patches on summits, in films of some heights [m], (films, number) [Pa]."""
    temperature = water_of(plan).temperature
    return forces_in(point, plan, [air_of(height, 1.0, temperature)[0] for height in heights], number, seed)


def forces_in(point: Point, plan: Plan, airs: Sequence[float], number: int, seed: int) -> np.ndarray:
    """Pull-off pressures as of `forces_of` at some humidities [-]."""
    patch = patch_of(plan, Case(case_id(DEVICE, HUMIDITIES[0])))
    at = At(**{name: str(value) for name, value in patch._asdict().items()})
    settings = replace(in_si(Settings, GROUND.settings(plan, at, number)), seed=seed)
    dataset, water = contact.compute(surfaces_of(plan), f"estimate{point.number}", "NG", settings), water_of(plan)
    return np.array([curves.pull_offs(dataset, air, water) for air in airs])


def change_of(point: Point, plan: Plan, height: float, seed: int) -> dict[str, float]:
    """Change of pull-off pressures by full contact, as `change_in`, in a film of a height [m]."""
    return change_in(point, plan, air_of(height, 1.0, water_of(plan).temperature)[0], seed)


def change_in(point: Point, plan: Plan, humidity: float, seed: int) -> dict[str, float]:
    """Ratio of the mean pull-off in full contact to that on summits, and power of its scatter, NaN if not found."""
    stated = full_energy.settings_of(plan, At(case=Case(case_id(PAIR, round(humidity, 4)))))
    settings = replace(in_si(full_energy.Settings, stated), forces=True, seed=seed)
    settings = replace(settings, beam=replace(settings.beam, width=_WIDTH))
    try:
        strips = full_energy.strips_of(surfaces_of(plan), f"estimate{point.number}", settings)
        ratio = full_energy.ratio_of_forces(strips, _ERROR, seed, point.number)
    except (NotConverged, TooLong, ValueError):
        ratio = full_energy.UNKNOWN
    return {"ratio": ratio.ratio, "ratio_error": ratio.error, "power": ratio.power}


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set."""
    effort = SETS[name]
    sides = sides_of(point, effort.seed, effort.law)
    plan, airs = plan_of(point, sides, valid), states(effort.states, point.number, effort.seed)
    forces = forces_of(point, plan, airs[:, 0], effort.patches, effort.seed)
    results = {"airs": airs, "sides": np.array(sides), "forces": forces.astype(np.float32)}
    if point.number % effort.every == 0:
        results |= change_of(point, plan, airs[0, 0], effort.seed)
    return results

"""Contacts of the design: slopes up to which tips stick, and full contact that changes some of them as a run does."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import few_tip_ratios
from stiction.config.cases import Case, case_id
from stiction.config.files import load
from stiction.config.units import from_si, in_si, to_si
from stiction.contact import meniscus
from stiction.contact.correction import NONE, Correction, ElasticChange, TipChanges
from stiction.contact.environment import Water
from stiction.devices.arcs import longest_free, tip_slope
from stiction.estimate.learning.design import Point, SurfaceLaw, points, states
from stiction.pilot import surface
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact, curves, tips_in_full_contact
from stiction.stages.contact.changes.patches import TIPS
from stiction.stages.contact.pair_model_error import POWER_ERROR
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices.contact_names import patch_of_tips
from stiction.stages.devices.opening import DesignedBeam, section_of_beam

#: Folder of the points.
FOLDER = "tips"
#: Names of pair and device of every point.
PAIR, DEVICE = "p", "D"
#: Thickness of the beams [µm]: the estimate knows E t³ / h² alone.
_THICKNESS = 2.6
#: Humidities of which the wettest decides how long tips are.
HUMIDITIES = [0.5, 0.92]
#: Stiffnesses of the beams of a point, over its own.
FACTORS = (0.5, 1.0, 2.0)


@dataclass(frozen=True)
class TrainingEffort:
    """Points of a set, and numbers that decide their errors."""

    points: int
    seed: int
    law: SurfaceLaw
    tips: int  #: at least
    tips_by_width: float  #: width of more tips together [m]
    states: int
    every: int  #: one of so many points has full contact, in its first air
    patches: int  #: of a stopper
    strips: tuple[int, int] = (8, 64)  #: in full contact and on summits, by default those of a run

    @property
    def all(self) -> list[Point]:
        """Points."""
        return points(self.points, self.seed, self.law)


#: Sets of points by name: to learn from, to decide intervals, to check these, and for control numbers. Seeds of sets
#: that check are in no other set.
SETS = {
    "learn_any": TrainingEffort(80, 1, SurfaceLaw.ANY, 20, to_si(800, "um"), 8, 2, 100),
    "learn_typical": TrainingEffort(96, 3, SurfaceLaw.TYPICAL, 20, to_si(800, "um"), 8, 1, 100),
    "decide_typical": TrainingEffort(50, 4, SurfaceLaw.TYPICAL, 40, to_si(1600, "um"), 1, 1, 400),
    "decide_any": TrainingEffort(50, 2, SurfaceLaw.ANY, 40, to_si(1600, "um"), 1, 1, 400),
    "check_paper": TrainingEffort(6, 5, SurfaceLaw.PAPER, 400, 0.0, 1, 1, 400),
    "check_typical": TrainingEffort(80, 11, SurfaceLaw.TYPICAL, 40, to_si(1600, "um"), 1, 1, 400),
    "check_any": TrainingEffort(48, 12, SurfaceLaw.ANY, 40, to_si(1600, "um"), 1, 1, 400),
    "control": TrainingEffort(1, 1, SurfaceLaw.ANY, 3, 0.0, 1, 1, 3, (1, 1)),
}
#: Width of strips in full contact [m]. On B2 and Sub1 at RH 0.44, strips of 2, 4, 10 and 30 µm have ratios of 0.36,
#: 0.35, 0.31 and 0.25 (± 0.06), and scatter alike.
_NARROW = to_si(12, "um")


def plan_of(point: Point, base: dict[str, Any]) -> Plan:
    """Plan of a point, from a valid configuration with one pair and one device."""
    modulus, thickness = to_si(base["solid"]["young_modulus_GPa"], "GPa"), to_si(_THICKNESS, "um")
    gap = from_si((modulus * thickness**3 / point.stiffness) ** 0.5, "um")
    device = base["devices"][DEVICE] | {"gap_um": round(gap, 4), "width_um": point.width}
    surfaces = base["surfaces"] | dict(zip("ST", point.sides, strict=True))
    pairs = {PAIR: base["pairs"][PAIR] | {"gap_um": round(gap, 4)}}
    return Plan(base | {"surfaces": surfaces, "pairs": pairs, "devices": {DEVICE: device}})


def of_beam(point: Point, material: dict[str, Any], valid: dict[str, Any]) -> Point:
    """Point of which `plan_of` finds a gap for its stiffness and a beam of a material, in the units of files."""
    relative = material["young_modulus_GPa"] / valid["solid"]["young_modulus_GPa"]
    return replace(point, stiffness=point.stiffness / relative)


def with_materials(plan: Plan, *materials: dict[str, Any]) -> Plan:
    """Plan of a point with the materials of both solids, in the units of files."""
    named = {f"Of{side}": material for side, material in zip("ST", materials, strict=True)}
    surfaces = {side: plan.config["surfaces"][side] | {"material": f"Of{side}"} for side in "ST"}
    others = {name: entry for name, entry in plan.config["surfaces"].items() if name not in surfaces}
    return Plan(plan.config | {"surfaces": others | surfaces, "materials": named})


def base() -> dict[str, Any]:
    """Configuration of the points: all that devices have by default."""
    device = {"kind": "cantilever", "pair": PAIR, "thickness_um": _THICKNESS, "gap_um": 20, "width_um": 30}
    pair = {"beam": "S", "substrate": "T", "gap_um": 20, "humidities": HUMIDITIES}
    return load(
        {
            "run": {"pairs": [], "studies": []},
            "surfaces": {"S": {"rms_nm": 3, "like": "B2"}, "T": {"rms_nm": 0.2, "like": "Sub1"}},
            "pairs": {PAIR: pair},
            "devices": {DEVICE: device | {"humidities": HUMIDITIES}},
        }
    )


@dataclass(frozen=True)
class TrainingTips:
    """Tips of a point on its strips."""

    contact: xr.Dataset
    water: Water
    device: DesignedBeam

    @classmethod
    def of(cls, point: Point, plan: Plan, tips: int, seed: int) -> "TrainingTips":
        """Draw a number of tips."""
        case = Case(case_id(DEVICE, HUMIDITIES[0]))
        at = At(**{name: str(value) for name, value in patch_of_tips(plan, case)._asdict().items()})
        settings = replace(in_si(Settings, TIPS.settings(plan, at, tips)), seed=seed)
        dataset = contact.compute(surfaces_of(plan), f"estimate{point.number}", "NG", settings)
        return cls(dataset, water_of(plan), in_si(DesignedBeam, section_of_beam(plan, DEVICE)))

    def slopes(self, height: float, wetting: float, changes: TipChanges | None = None) -> np.ndarray:
        """Slopes up to which tips stick, by `FACTORS` (stiffnesses, tips) [-].

        In a film of a height [m] and a mean cosine of the contact angles, on summits or changed by full contact.
        """
        humidity, angle = air_of(height, wetting, self.water.temperature)
        return self.slopes_in(humidity, replace(self.water, contact_angles=(angle, angle)), changes)

    def slopes_in(self, humidity: float, water: Water, changes: TipChanges | None = None) -> np.ndarray:
        """Slopes as of `slopes` at a humidity [-] with water."""
        change = None if changes is None else Correction(np.array([humidity]), NONE, NONE, changes)
        at, forces = curves.tip_forces(self.contact, humidity, replace(water, correction=change))
        beams = [replace(self.device, gap=self.device.gap / factor**0.5).beam for factor in FACTORS]
        return np.array([tip_slope(longest_free(at, forces, beam), beam.gap) for beam in beams])


def full_contact_of(point: Point, plan: Plan, humidity: float, effort: TrainingEffort) -> dict[str, np.ndarray]:
    """Largest attractions of few tips in full contact and of more on summits, at three slopes."""
    stated = tips_in_full_contact.settings_of_devices(plan, At(case=Case(case_id(PAIR, round(humidity, 4)))))
    settings = in_si(tips_in_full_contact.Settings, stated)
    narrow = replace(settings, strips=effort.strips[0], on_summits=effort.strips[1], seed=effort.seed)
    narrow = replace(narrow, beam=replace(narrow.beam, width=min(narrow.beam.width, _NARROW)))
    study = tips_in_full_contact.compute_for_devices(surfaces_of(plan), f"estimate{point.number}", narrow)
    full, summits = tips_in_full_contact.models_of_devices(study)
    return {"slope": study.slope.values, "full": full[:, 0], "summits": summits[:, 0]}


def changes_of(slope: np.ndarray, full: np.ndarray, summits: np.ndarray) -> TipChanges:
    """Changes of tips that a run applies, from slopes (s,) and attractions (n, s) and (N, s)."""
    ratio, error = few_tip_ratios(full[:, None], summits[:, None], POWER_ERROR)
    return TipChanges(slope, ElasticChange(ratio, np.ones(1), error))


def air_of(height: float, wetting: float, temperature: float) -> tuple[float, float]:
    """Humidity [-] of a film of a height [m], and contact angle [rad] of a mean cosine."""
    perfect = float(meniscus.meniscus_height(np.exp(-1), temperature))
    return float(np.exp(-wetting * perfect / height)), float(np.arccos(wetting))


def water_of(plan: Plan) -> Water:
    """Water between the surfaces of the pair."""
    return in_si(Water, plan.air_of_devices.water(PAIR))


def surfaces_of(plan: Plan) -> list[tuple[xr.Dataset, xr.Dataset]]:
    """Datasets of both surfaces."""
    return [surface(plan, name) for name in "ST"]


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set."""
    effort, plan = SETS[name], plan_of(point, valid)
    airs = states(effort.states, point.number, effort.seed)
    number = effort.tips + round(effort.tips_by_width / to_si(point.width, "um"))
    tips = TrainingTips.of(point, plan, number, effort.seed)
    results = {"airs": airs, "slopes": np.array([tips.slopes(*air) for air in airs], np.float32)}
    if point.number % effort.every == 0:
        humidity, _ = air_of(airs[0, 0], 1.0, water_of(plan).temperature)
        of_full = full_contact_of(point, plan, humidity, effort)
        changed = tips.slopes(*airs[0], changes_of(**of_full))[FACTORS.index(1.0)]
        results |= of_full | {"changed": changed.astype(np.float32)}
    return results

"""Contacts of the design in dry air: slopes up to which tips stick, on summits and changed by full contact as in a run.

As `stiction.estimate.learning.training`, whose surfaces and beams they have, for some Hamaker constants.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stiction.analysis.model_error import tip_ratios
from stiction.config.cases import Case, case_id
from stiction.config.files import load
from stiction.config.reading import paper
from stiction.config.units import from_si, in_si, to_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.air import DRY, DRY_AIR
from stiction.contact.correction import ElasticChange, TipChanges
from stiction.estimate.learning import training
from stiction.estimate.learning.design import Point, SurfaceLaw
from stiction.estimate.learning.training import (
    DEVICE,
    FACTORS,
    PAIR,
    TrainingEffort,
    TrainingTips,
    surfaces_of,
    water_of,
    with_materials,
)
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact, full_contact, tips_in_full_contact
from stiction.stages.contact.changes.patches import TIPS
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices.contact_names import patch_of_tips
from stiction.stages.devices.opening import DesignedBeam, section_of_beam
from stiction.streams import stream

#: Folder of the points in dry air beside those in humid air.
FOLDER = "dry"
#: Least and largest Hamaker constant of two solids in dry air [zJ], about half and twice that of polysilicon.
CONSTANTS = (90.0, 380.0)
#: Width of strips in full contact [m], as in humid air.
_NARROW = to_si(12, "um")

#: Most tips of a set where their width asks for no more.
_MOST = 100


@dataclass(frozen=True)
class DryEffort(TrainingEffort):
    """Points of a set in dry air. Each has some Hamaker constants as states, and full contact at the first of them."""

    strips: tuple[int, int] = (20, 32)  #: in full contact, at each slope of tips and under stoppers
    stoppers: int = 1  #: number of the points that have stoppers


def _effort(name, points, stoppers, states, patches, strips):
    """Effort of a set, with the first points of a set in humid air."""
    humid = training.SETS[name]
    tips = min(humid.tips, _MOST)
    return DryEffort(points, humid.seed, humid.law, tips, humid.tips_by_width, states, 1, patches, strips, stoppers)


#: Sets of points by name, as in humid air.
SETS = {
    "learn_any": _effort("learn_any", 32, 60, 2, 200, (8, 32)),
    "learn_typical": _effort("learn_typical", 36, 70, 2, 200, (8, 32)),
    "decide_typical": _effort("decide_typical", 20, 40, 1, 200, (20, 32)),
    "decide_any": _effort("decide_any", 22, 40, 1, 200, (20, 32)),
    "check_paper": _effort("check_paper", 6, 6, 1, 200, (20, 32)),
    "check_typical": _effort("check_typical", 12, 7, 1, 200, (20, 32)),
    "check_any": _effort("check_any", 8, 8, 1, 200, (20, 32)),
    "control": _effort("control", 1, 1, 1, 3, (2, 12)),
}


def constants(point: Point, name: str) -> np.ndarray:
    """Hamaker constants of a point of a set [J], even in their logarithm. Surfaces of the paper have polysilicon's."""
    effort = SETS[name]
    if effort.law is SurfaceLaw.PAPER:
        return np.array([HAMAKER_CONSTANT[DRY]])
    drawn = stream(effort.seed, "estimate", "constants", point.number).uniform(*map(math.log, CONSTANTS), effort.states)
    return to_si(np.round(np.exp(drawn), 2), "zJ")


def base() -> dict[str, Any]:
    """Configuration of the points: all that devices have by default in dry air."""
    device = {"kind": "cantilever", "pair": PAIR, "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    return load(
        {
            "run": {"pairs": [], "studies": []},
            "surfaces": {"S": {"rms_nm": 3, "like": "B2"}, "T": {"rms_nm": 0.2, "like": "Sub1"}},
            "pairs": {PAIR: {"beam": "S", "substrate": "T", "gap_um": 20, "humidities": [DRY]}},
            "devices": {DEVICE: device | {"humidities": [DRY]}},
        }
    )


def with_constant(plan: Plan, constant: float) -> Plan:
    """Plan of a point with a Hamaker constant of both solids [J]."""
    zj = {medium: round(from_si(constant, "zJ"), 4) for medium in HAMAKER_CONSTANT}
    return with_materials(plan, *[{"hamaker_constant_zJ": zj}] * 2)


def drawn(plan: Plan, name: str, number: int) -> TrainingTips:
    """Tips of a point of a set in dry air."""
    effort, case = SETS[name], Case(case_id(DEVICE, DRY_AIR.humidity))
    at = At(**{key: str(value) for key, value in patch_of_tips(plan, case)._asdict().items()})
    tips = effort.tips + round(effort.tips_by_width / to_si(plan.config["devices"][DEVICE]["width_um"], "um"))
    settings = replace(in_si(Settings, TIPS.settings(plan, at, tips)), seed=effort.seed)
    dataset = contact.compute(surfaces_of(plan), f"estimate{number}", "NG", settings)
    return TrainingTips(dataset, water_of(plan), in_si(DesignedBeam, section_of_beam(plan, DEVICE)))


def slopes_of(tips: TrainingTips, changes: TipChanges | None = None) -> np.ndarray:
    """Slopes up to which tips stick in dry air, by stiffness and tip [-]."""
    return tips.slopes_in(DRY_AIR.humidity, tips.water, changes)


def full_contact_of(plan: Plan, name: str, number: int) -> dict[str, np.ndarray]:
    """Largest attractions of tips in full contact and on summits, at three slopes, on narrow strips."""
    stated = full_contact.settings_in_dry_air(plan, At(pair=PAIR)) | plan.devices.all_tips(PAIR)
    settings = in_si(tips_in_full_contact.Settings, stated | {"most": 0, "on_summits": 0})
    settings = replace(settings, strips=SETS[name].strips[0], seed=SETS[name].seed)
    narrow = replace(settings, beam=replace(settings.beam, width=min(settings.beam.width, _NARROW)))
    study = tips_in_full_contact.compute_for_devices(surfaces_of(plan), f"estimate{number}", narrow)
    full, summits = tips_in_full_contact.models(study)
    return {"slope": study.slope.values, "full": full[:, 0], "summits": summits[:, 0]}


def changes_of(slope: np.ndarray, full: np.ndarray, summits: np.ndarray) -> TipChanges:
    """Changes of tips that a run applies in dry air, from slopes (s,) and attractions (n, s)."""
    ratios = tip_ratios(full[:, None], summits[:, None])
    return TipChanges(slope, ElasticChange(ratios.means, np.maximum(ratios.powers, 1), in_run(ratios.error, len(full))))


def in_run(error: np.ndarray, strips: int) -> np.ndarray:
    """Errors of ratios in a run, which draws strips until they are known, from those by a number of strips.

    ASSUME: errors fall with the root of the number of strips.
    """
    first = paper()["studies"]["full_contact"]["samples"]
    numbers = range(first, tips_in_full_contact.MOST + 1, first // 2)
    errors = (error * math.sqrt(strips / number) for number in numbers)
    return next(
        (each for each in errors if np.all(each <= tips_in_full_contact.ACCURACY)),
        error * math.sqrt(strips / numbers[-1]),
    )


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set."""
    plans = [with_constant(training.plan_of(point, valid), each) for each in constants(point, name)]
    tips = [drawn(plan, name, point.number) for plan in plans]
    results = {"constants": constants(point, name), "slopes": np.array([slopes_of(each) for each in tips], np.float32)}
    of_full = full_contact_of(plans[0], name, point.number)
    changed = slopes_of(tips[0], changes_of(**of_full))[FACTORS.index(1.0)]
    return results | of_full | {"changed": changed.astype(np.float32)}


def control() -> dict[str, list[float]]:
    """Slopes of a few tips and forces of some in full contact, by which a test sees that they are still the same."""
    (point,), name = SETS["control"].all, "control"
    numbers = computed(point, name, base())
    return {key: numbers[key].ravel().tolist() for key in ("slopes", "full")}

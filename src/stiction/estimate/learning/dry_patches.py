"""Patches of the design in dry air: pull-off forces of stoppers on summits, and their change by full contact.

As `stiction.estimate.learning.dry`, whose surfaces and Hamaker constants they have, with sides as in humid air.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import mean_ratios, scatter_ratios
from stiction.config.cases import Case, case_id
from stiction.config.files import load
from stiction.config.units import in_si, to_si
from stiction.contact.air import DRY, DRY_AIR
from stiction.errors import NotConverged
from stiction.estimate.learning import dry, patches
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.training import PAIR, surfaces_of, water_of
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact, curves, full_contact
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices.contact_names import patch_of

#: Folder of the patches beside the sets of the tips.
FOLDER = f"{dry.FOLDER}/{patches.FOLDER}"
#: Sets of points with stoppers by name.
SETS = {name: replace(effort, points=effort.stoppers) for name, effort in dry.SETS.items()}
#: Width of strips in full contact [m]. On B2 and Sub1, strips of 3, 6 and 30 µm have ratios of 1.46, 1.40 and 1.43
#: (± 0.05, 0.05, 0.15), and on a rougher pair 1.22, 1.18 and 1.29 (± 0.04, 0.05, 0.08).
_WIDTH = to_si(3, "um")


def base() -> dict[str, Any]:
    """Configuration of the points: all that stoppers have by default in dry air."""
    device = {"kind": "stopper", "pair": PAIR, "contact_um": [3, 3], "restoring_force_uN": 1, "humidities": [DRY]}
    return load(
        {
            "run": {"pairs": [], "studies": []},
            "surfaces": {"S": {"rms_nm": 3, "like": "B2"}, "T": {"rms_nm": 0.2, "like": "Sub1"}},
            "pairs": {PAIR: {"beam": "S", "substrate": "T", "gap_um": 2, "humidities": [DRY]}},
            "devices": {patches.DEVICE: device},
        }
    )


def forces_of(plan: Plan, name: str, number: int) -> np.ndarray:
    """Pull-off pressures of the patches of a point of a set, on summits in dry air (n,) [Pa]."""
    patch = patch_of(plan, Case(case_id(patches.DEVICE, DRY_AIR.humidity)))
    at = At(**{key: str(value) for key, value in patch._asdict().items()})
    settings = replace(in_si(Settings, GROUND.settings(plan, at, SETS[name].patches)), seed=SETS[name].seed)
    dataset = contact.compute(surfaces_of(plan), f"estimate{number}", "NG", settings)
    return curves.pull_offs(dataset, DRY_AIR.humidity, water_of(plan))


def study_of(plan: Plan, name: str, number: int) -> xr.Dataset | None:
    """Strips of a point of a set in full contact, none if it is not found."""
    settings = in_si(full_contact.Settings, full_contact.settings_in_dry_air(plan, At(pair=PAIR)))
    settings_drawn = replace(settings, strips=SETS[name].strips[1], most=0, seed=SETS[name].seed)
    try:
        return full_contact.compute(
            surfaces_of(plan),
            f"estimate{number}",
            replace(settings_drawn, beam=replace(settings_drawn.beam, width=_WIDTH)),
        )
    except (NotConverged, ValueError):
        return None


def change_of(plan: Plan, name: str, number: int) -> dict[str, float]:
    """Ratio of the mean pull-off in full contact to that on summits, and power of its scatter, NaN if not found."""
    if (study := study_of(plan, name, number)) is None:
        return dict.fromkeys(("ratio", "ratio_error", "power"), np.nan)
    at, *models = full_contact.pull_offs(study)
    ratio, error = mean_ratios(*full_contact.moved_models(study)[..., 1], at, at)
    power, _ = scatter_ratios(*models, at, at)
    return {"ratio": ratio.item(), "ratio_error": (error / ratio).item(), "power": power.item()}


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set."""
    sides = patches.sides_of(point, SETS[name].seed, SETS[name].law)
    constants = dry.constants(point, name)
    plans = [dry.with_constant(patches.plan_of(point, sides, valid), each) for each in constants]
    forces = np.array([forces_of(plan, name, point.number) for plan in plans], np.float32)
    results = {"constants": constants, "sides": np.array(sides), "forces": forces}
    return results | change_of(plans[0], name, point.number)


def control() -> dict[str, list[float]]:
    """Pull-off pressures of a few patches and the ratio of some strips, as `stiction.estimate.learning.dry.control`."""
    (point,), name = SETS["control"].all, "control"
    numbers = computed(point, name, base())
    return {"forces": numbers["forces"].ravel().tolist(), "ratio": [numbers["ratio"]]}

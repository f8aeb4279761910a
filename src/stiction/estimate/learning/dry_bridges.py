"""Bridges of the design in dry air: lengths that their middle holds, changed by full contact as a run does it.

As `stiction.estimate.learning.dry_patches`, whose surfaces, solids and full contact they have, with sizes of bridges as
in humid air.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import mean_ratios, scatter_ratios
from stiction.contact.air import DRY, DRY_AIR
from stiction.contact.correction import Correction, ElasticChange
from stiction.estimate.learning import bridges, dry, dry_patches
from stiction.estimate.learning.bridges import STRIPS, TrainingStrips, sizes_of
from stiction.estimate.learning.design import Point
from stiction.stages.contact import full_contact

#: Folder of the bridges beside the sets of the tips.
FOLDER = f"{dry.FOLDER}/{bridges.FOLDER}"
#: Points of the sets, the first of those in dry air.
_POINTS = {"learn_any": 20, "learn_typical": 20, "decide_typical": 30, "decide_any": 30}
_POINTS |= {"check_paper": 6, "check_typical": 8, "check_any": 8, "control": 1}
SETS = {name: replace(dry.SETS[name], points=points) for name, points in _POINTS.items()}
#: Most bridges of a point, each of other sizes.
_SIZES = 3


def correction_of(study: xr.Dataset) -> Correction:
    """Changes of energies and of largest attractions that a run applies in dry air."""
    changes = []
    for k, (at, *models) in enumerate((full_contact.energies(study), full_contact.pull_offs(study))):
        ratio, _ = mean_ratios(*full_contact.moved_models(study)[..., k], at, at)
        changes.append(ElasticChange(ratio, np.maximum(scatter_ratios(*models, at, at)[0], 1)))
    return Correction(np.array([DRY_AIR.humidity]), *changes, nearest=True)


def computed(point: Point, name: str, valid: dict[str, Any]) -> dict[str, Any]:
    """Numbers of one point of a set: lengths are unknown where full contact is."""
    effort, sizes, constant = SETS[name], sizes_of(point, name)[:_SIZES], dry.constants(point, name)[0]
    plan = dry.with_constant(bridges.plan_of(point, valid), constant)
    results = {"constant": constant, "sizes": sizes}
    if (study := dry_patches.study_of(plan, name, point.number)) is None:
        return results
    strips = TrainingStrips.of(point, plan, STRIPS, effort.seed, DRY_AIR.humidity)
    change = correction_of(study)
    lengths = [strips.lengths_in(DRY_AIR.humidity, each, effort.patches, change) for each in sizes]
    ratios = [each.ratio.item() for each in (change.energy, change.pull_off)]
    return results | {"lengths": np.array(lengths, np.float32), "ratios": np.array(ratios)}


def control() -> dict[str, list[float]]:
    """Lengths of a few bridges, as `stiction.estimate.learning.dry.control`."""
    (point,), name = SETS["control"].all, "control"
    return {"lengths": computed(point, name, bridges.base([DRY]))["lengths"].ravel().tolist()}

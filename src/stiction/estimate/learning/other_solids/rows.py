"""Rows about other solids: how their attraction changes lengths and forces, and errors of the estimate on them.

From the files of `stiction.estimate.learning.other_solids.attraction` and
`stiction.estimate.learning.other_solids.points`.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.estimate.bridge import COORDINATES as OF_BRIDGES
from stiction.estimate.force import reciprocals
from stiction.estimate.learning import bridges, patches
from stiction.estimate.learning.bridge_rows import are_known, of_middle
from stiction.estimate.learning.bridge_rows import states_of as bridges_of
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.errors import Tested, beside, lengths_of
from stiction.estimate.learning.fit import DesignRows
from stiction.estimate.learning.other_solids import attraction, points
from stiction.estimate.learning.rows import (
    OF_FULL,
    OF_RATIO,
    change_of,
    of_forces,
    of_tips,
    patches_of,
    states_of,
    stored,
)
from stiction.estimate.learning.training import TrainingEffort
from stiction.estimate.length import NAMES, lengths
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import COORDINATES, OF_PATCHES, PatchState, TipState, film
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate

#: Coordinates that the change by the attraction depends on, with its own as the last. ASSUME: no others.
OF_TIPS_ATTRACTED, OF_PATCHES_ATTRACTED = (*OF_FULL, len(COORDINATES)), (*OF_RATIO, len(OF_PATCHES))
OF_BRIDGES_ATTRACTED = (*OF_RATIO, len(OF_BRIDGES))


def _both(
    folder: Path, of_polysilicon: Path, sets: Mapping[str, TrainingEffort] = attraction.SETS
) -> Iterator[tuple[Point, dict[str, Any], dict[str, Any]]]:
    """Points with their numbers at another attraction and on polysilicon."""
    for name in sets:
        for point, numbers in stored(folder, name, sets):
            number = next(each.number for each in sets[name].all if each.sides == point.sides)
            with np.load(of_polysilicon / name / f"{number:04}.npz") as file:
                yield point, numbers, dict(file)


def _rows(entries):
    """Rows of the change of quantities by the logarithm of the attraction, from both at each state."""
    surface, coordinates, changed, of_polysilicon, by = zip(*entries, strict=True)
    by = np.array(by)
    pairs = list(zip(changed, of_polysilicon, strict=True))
    values = {name: np.array([more[name] - less[name] for more, less in pairs]) / by for name in NAMES[:3]}
    return DesignRows(np.column_stack([coordinates, by]), values, np.array(surface), 1 / np.abs(by))


def rows_of_tips(folder: Path, modulus: float) -> DesignRows:
    """Rows of all tips on summits at another attraction."""
    return _rows(
        (point.number, state.coordinates, *(of_tips(slopes / state.flooded_slope) for slopes in both), by)
        for point, numbers, of_polysilicon in _both(folder / attraction.FOLDER, folder)
        for by in [math.log(numbers["ratio"])]
        for states, *of_air in zip(
            states_of(point, of_polysilicon["airs"][: attraction.AIRS], modulus),
            numbers["slopes"],
            of_polysilicon["slopes"],
            strict=False,
        )
        for state, *both in zip(states, *of_air, strict=True)
    )


def rows_of_patches(folder: Path, modulus: float) -> DesignRows:
    """Rows of all patches on summits at another attraction."""
    return _rows(
        (point.number, patch.coordinates, *(of_forces(each, patch) for each in both), by)
        for point, numbers, of_polysilicon in _both(folder / attraction.FOLDER, folder / patches.FOLDER)
        for by in [math.log(numbers["ratio"])]
        for patch, *both in zip(
            patches_of(point, of_polysilicon, modulus), numbers["forces"], of_polysilicon["forces"], strict=False
        )
    )


def rows_of_bridges(folder: Path, modulus: float) -> DesignRows:
    """Rows of all bridges on summits at another attraction whose lengths are known at both."""
    changed = folder / attraction.FOLDER / bridges.FOLDER
    return _rows(
        (point.number, bridge.coordinates, *(of_middle(bridge, each) for each in both), by)
        for point, numbers, of_polysilicon in _both(changed, folder / bridges.FOLDER, attraction.OF_BRIDGES)
        for by in [math.log(numbers["ratio"])]
        for bridge, *both in zip(
            bridges_of(point, of_polysilicon, modulus), numbers["lengths"], of_polysilicon["lengths"], strict=False
        )
        if are_known(np.array(both)).all()
    )


def solids_of(point: Point, name: str) -> tuple[SolidPair, float]:
    """Solids of a point of a set, and its temperature [K]."""
    temperature, materials = points.drawn(point, points.SETS[name].seed)
    return SolidPair.of(*materials), temperature


def _stored(folder, name, as_polysilicon):
    """Points of a set with their numbers, with solids and film as stated or as of polysilicon."""
    for point in points.SETS[name].all:
        if (file := folder / name / f"{point.number:04}.npz").exists():
            with np.load(file) as numbers:
                solids, temperature = solids_of(point, name)
                solids = SolidPair() if as_polysilicon else solids
                water = film(float(numbers["humidity"]), temperature, solids.wetting)
                yield point, dict(numbers), solids, water


def tested(
    folder: Path, name: str, score: float, processes: Sequence[Surrogate], as_polysilicon: bool
) -> Iterator[Tested]:
    """Lengths of a set of other solids, as `stiction.estimate.learning.errors.tested`, of processes that learnt all.

    The estimate can take them as polysilicon, for a control.
    """
    for point, numbers, solids, water in _stored(folder / points.FOLDER, name, as_polysilicon):
        if np.isfinite(numbers["changed"]).all():
            sizes = point.stiffness, to_si(point.width, "um")
            state = TipState(of_pair(point.sides), water, *sizes, solids.modulus, solids.attraction(water.energy))
            true = lengths_of(of_tips(numbers["changed"]), math.log(1.5))
            yield beside(point, true, score, lambda state=state: lengths(state, 1.0, *processes))


def tested_forces(
    folder: Path, name: str, score: float, processes: Sequence[Surrogate], as_polysilicon: bool
) -> Iterator[Tested]:
    """Reciprocals of forces of a set of other solids, as `tested`."""
    for point, numbers, solids, water in _stored(folder / points.FOLDER / patches.FOLDER, name, as_polysilicon):
        if np.isfinite(numbers["ratio"]):
            area = float(np.prod(to_si(numbers["sides"], "um")))
            patch = PatchState(of_pair(point.sides), water, area, solids.modulus, solids.attraction(water.energy))
            pressures = numbers["forces"][0].astype(float)
            changed = change_of(numbers).of(pressures)(pressures)
            true = lengths_of(of_forces(changed, patch), -math.log(patch.flooded_force))
            yield beside(point, true, score, lambda patch=patch: reciprocals(patch, *processes))

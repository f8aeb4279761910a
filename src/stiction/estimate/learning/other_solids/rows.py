"""Rows about other solids: how their attraction changes lengths and forces, and errors of the estimate on them.

From the files of `attraction` and `points` of this folder.
"""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.estimate.force import reciprocals
from stiction.estimate.learning import patches
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.errors import Processes, Tested, beside, lengths_of
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
from stiction.estimate.length import NAMES, lengths
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import COORDINATES, OF_PATCHES, Film, PatchState, TipState, film
from stiction.estimate.statistics import of_pair

#: Coordinates that the change by the attraction depends on, with its own as the last. ASSUME: no others.
OF_TIPS_ATTRACTED, OF_PATCHES_ATTRACTED = (*OF_FULL, len(COORDINATES)), (*OF_RATIO, len(OF_PATCHES))


def _both(folder: Path, of_polysilicon: Path) -> Iterator[tuple[Point, dict[str, Any], dict[str, Any]]]:
    """Points with their numbers at another attraction and on polysilicon."""
    for name in attraction.SETS:
        for point, numbers in stored(folder / attraction.FOLDER, name, attraction.SETS):
            number = next(each.number for each in attraction.SETS[name].all if each.sides == point.sides)
            with np.load(of_polysilicon / name / f"{number:04}.npz") as file:
                yield point, numbers, dict(file)


def _rows(entries):
    """Rows of the change of quantities by the logarithm of the attraction, from values over those of flats."""
    surface, coordinates, changed, of_polysilicon, by = zip(*entries, strict=True)
    pairs = [[of_tips(each) for each in both] for both in zip(changed, of_polysilicon, strict=True)]
    by = np.array(by)
    values = {name: np.array([more[name] - less[name] for more, less in pairs]) / by for name in NAMES[:3]}
    return DesignRows(np.column_stack([coordinates, by]), values, np.array(surface), 1 / np.abs(by))


def rows_of_tips(folder: Path, modulus: float) -> DesignRows:
    """Rows of all tips on summits at another attraction."""
    return _rows(
        (point.number, state.coordinates, *(slopes / state.flooded_slope for slopes in both), by)
        for point, numbers, of_polysilicon in _both(folder, folder)
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
        (point.number, patch.coordinates, *(each.astype(float) for each in both), by)
        for point, numbers, of_polysilicon in _both(folder, folder / patches.FOLDER)
        for by in [math.log(numbers["ratio"])]
        for patch, *both in zip(
            patches_of(point, of_polysilicon, modulus), numbers["forces"], of_polysilicon["forces"], strict=False
        )
    )


def solids_of(point: Point, name: str) -> tuple[SolidPair, float]:
    """SolidPair of a point of a set, and its temperature [K]."""
    temperature, materials = points.drawn(point, points.SETS[name].seed)
    return SolidPair.of(*materials), temperature


def _stored(folder: Path, name: str) -> Iterator[tuple[Point, Mapping[str, Any], SolidPair, Film]]:
    """Points of a set that settle in full contact, with numbers, solids and film."""
    for point in points.SETS[name].all:
        if (file := folder / name / f"{point.number:04}.npz").exists():
            with np.load(file) as numbers:
                of_point, temperature = solids_of(point, name)
                water = film(float(numbers["humidity"]), temperature, of_point.wetting)
                yield point, dict(numbers), of_point, water


def tested(folder: Path, name: str, _modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of a set of other solids, as `stiction.estimate.learning.errors.tested`."""
    for point, numbers, solids, water in _stored(folder / points.FOLDER, name):
        if np.isfinite(numbers["changed"]).all():
            sizes = point.stiffness, to_si(point.width, "um")
            state = TipState(of_pair(point.sides), water, *sizes, solids.modulus, solids.attraction(water.energy))
            true = lengths_of(of_tips(numbers["changed"]), math.log(1.5))
            yield beside(point, true, score, lambda state=state, at=point: lengths(state, 1.0, *processes(at)))


def tested_forces(folder: Path, name: str, _modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Reciprocals of forces of a set of other solids, as `tested`."""
    for point, numbers, solids, water in _stored(folder / points.FOLDER / patches.FOLDER, name):
        if np.isfinite(numbers["ratio"]):
            area = float(np.prod(to_si(numbers["sides"], "um")))
            patch = PatchState(of_pair(point.sides), water, area, solids.modulus, solids.attraction(water.energy))
            pressures = numbers["forces"][0].astype(float)
            changed = change_of(numbers).of(pressures)(pressures)
            true = lengths_of(of_forces(changed, patch), -math.log(patch.flooded_force))
            yield beside(point, true, score, lambda patch=patch, at=point: reciprocals(patch, *processes(at)))

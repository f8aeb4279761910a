"""Rows about other solids: how their ratios change lengths and forces, and errors of the estimate on them.

From the files of `stiction.estimate.learning.other_solids.ratios` and
`stiction.estimate.learning.other_solids.points`.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.estimate.bridge import COORDINATES as OF_BRIDGES
from stiction.estimate.force import reciprocals
from stiction.estimate.learning import bridges, patches, training
from stiction.estimate.learning.bridge_rows import are_known, of_middle
from stiction.estimate.learning.bridge_rows import states_of as bridges_of
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.errors import Tested, beside, lengths_of
from stiction.estimate.learning.files import numbers_of, path_of
from stiction.estimate.learning.fit import DesignRows
from stiction.estimate.learning.other_solids import points, ratios
from stiction.estimate.learning.other_solids.ratios import LearntRatio, stored_ratios
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
from stiction.estimate.state import COORDINATES, OF_PATCHES, PatchState, TipState, film
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate

#: Coordinates of tips, patches and bridges that changes by ratios depend on. ASSUME: no others.
_OF_TIPS, _OF_PATCHES, _OF_BRIDGES = (OF_FULL, COORDINATES), (OF_RATIO, OF_PATCHES), (OF_RATIO, OF_BRIDGES)


@dataclass(frozen=True)
class RowsOfRatio:
    """Rows of the change by the logarithm of one ratio, and the coordinates that it depends on."""

    rows: DesignRows
    columns: tuple[int, ...]  #: the last is that logarithm


@dataclass(frozen=True)
class _Changed:
    """Numbers of a point of a ratio, beside those without it."""

    point: Point
    of_polysilicon: dict[str, Any]
    numbers: dict[str, Any]
    before: dict[str, Any]
    logarithms: tuple[float, ...]  #: of all ratios

    def each(self, name):
        """Numbers of a name in each air, with those without the ratio."""
        return zip(self.numbers[name], self.before[name], strict=False)


def _changed(folder, ratio, place, part=""):
    """Points of a ratio. Their numbers are in a part of its folder, those of polysilicon at a place."""
    sets = ratio.of_bridges if part else ratio.sets
    for name in sets:
        for point, numbers in stored(folder / ratio.folder / part, name, sets):
            number = next(each.number for each in sets[name].all if each.sides == point.sides)
            before = folder / ratio.before.folder / part if ratio.before else folder / place
            of_both = [numbers_of(each / name, number) for each in (folder / place, before)]
            yield _Changed(point, of_both[0], numbers, of_both[1], stored_ratios(numbers).logarithms)


def _rows(entries, ratio, columns, names):
    """Rows of the change of quantities by the logarithm of a ratio, from both at each state."""
    surface, coordinates, changed, before, logarithms = zip(*entries, strict=True)
    logarithms = np.array(logarithms)
    by, pairs = logarithms[:, ratio.numbers[-1]], list(zip(changed, before, strict=True))
    values = {name: np.array([more[name] - less[name] for more, less in pairs]) / by for name in NAMES[:3]}
    rows = DesignRows(np.column_stack([coordinates, logarithms]), values, np.array(surface), 1 / np.abs(by))
    return RowsOfRatio(rows, (*columns, *(len(names) + number for number in ratio.numbers)))


def rows_of_tips(folder: Path, modulus: float, ratio: LearntRatio) -> RowsOfRatio:
    """Rows of all tips on summits at the points of a ratio."""
    entries = (
        (one.point.number, state.coordinates, *(of_tips(slopes / state.flooded_slope) for slopes in both), by)
        for one in _changed(folder, ratio, training.FOLDER)
        for by in [one.logarithms]
        for states, of_air in zip(
            states_of(one.point, one.of_polysilicon["airs"][: ratios.AIRS], modulus),
            one.each("slopes"),
            strict=False,
        )
        for state, *both in zip(states, *of_air, strict=True)
    )
    return _rows(entries, ratio, *_OF_TIPS)


def rows_of_patches(folder: Path, modulus: float, ratio: LearntRatio) -> RowsOfRatio:
    """Rows of all patches on summits at the points of a ratio."""
    entries = (
        (one.point.number, patch.coordinates, *(of_forces(each, patch) for each in both), one.logarithms)
        for one in _changed(folder, ratio, patches.FOLDER)
        for patch, both in zip(patches_of(one.point, one.of_polysilicon, modulus), one.each("forces"), strict=False)
    )
    return _rows(entries, ratio, *_OF_PATCHES)


def rows_of_bridges(folder: Path, modulus: float, ratio: LearntRatio) -> RowsOfRatio:
    """Rows of all bridges on summits at the points of a ratio whose lengths are known with and without it."""
    entries = (
        (one.point.number, bridge.coordinates, *(of_middle(bridge, each) for each in both), one.logarithms)
        for one in _changed(folder, ratio, bridges.FOLDER, bridges.FOLDER)
        for bridge, both in zip(bridges_of(one.point, one.of_polysilicon, modulus), one.each("lengths"), strict=False)
        if are_known(np.array(both)).all()
    )
    return _rows(entries, ratio, *_OF_BRIDGES)


def solids_of(point: Point, name: str) -> tuple[SolidPair, float]:
    """Solids of a point of a set, and its temperature [K]."""
    temperature, materials = points.drawn(point, points.SETS[name].seed)
    return SolidPair.of(*materials), temperature


def _stored(folder, name, as_polysilicon):
    """Points of a set with their numbers, with solids and film as stated or as of polysilicon."""
    for point in points.SETS[name].all:
        if path_of(folder / name, point.number).exists():
            numbers = numbers_of(folder / name, point.number)
            solids, temperature = solids_of(point, name)
            solids = SolidPair() if as_polysilicon else solids
            water = film(float(numbers["humidity"]), temperature, solids.wetting)
            yield point, numbers, solids, water


def tested(
    folder: Path, name: str, score: float, processes: Sequence[Surrogate], as_polysilicon: bool
) -> Iterator[Tested]:
    """Lengths of a set of other solids, as `stiction.estimate.learning.errors.tested`, of processes that learnt all.

    The estimate can take them as polysilicon, for a control.
    """
    for point, numbers, solids, water in _stored(folder / points.FOLDER, name, as_polysilicon):
        if np.isfinite(numbers["changed"]).all():
            sizes = point.stiffness, to_si(point.width, "um")
            state = TipState(of_pair(point.sides), water, *sizes, solids.modulus, solids.beside_water(water.energy))
            true = lengths_of(of_tips(numbers["changed"]), math.log(1.5))
            yield beside(point, true, score, lambda state=state: lengths(state, 1.0, *processes))


def tested_forces(
    folder: Path, name: str, score: float, processes: Sequence[Surrogate], as_polysilicon: bool
) -> Iterator[Tested]:
    """Reciprocals of forces of a set of other solids, as `tested`."""
    for point, numbers, solids, water in _stored(folder / points.FOLDER / patches.FOLDER, name, as_polysilicon):
        if np.isfinite(numbers["ratio"]):
            area = float(np.prod(to_si(numbers["sides"], "um")))
            patch = PatchState(of_pair(point.sides), water, area, solids.modulus, solids.beside_water(water.energy))
            pressures = numbers["forces"][0].astype(float)
            changed = change_of(numbers).of(pressures)(pressures)
            true = lengths_of(of_forces(changed, patch), -math.log(patch.flooded_force))
            yield beside(point, true, score, lambda patch=patch: reciprocals(patch, *processes))

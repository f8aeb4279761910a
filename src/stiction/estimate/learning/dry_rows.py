"""Rows and errors of the estimate in dry air, from the files of `stiction.estimate.learning.dry` and its patches."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.devices.risk import CONFIDENCE
from stiction.estimate import dry_bridge
from stiction.estimate.bridge import Stretched
from stiction.estimate.dry import DryPatch, DryTip, lengths, reciprocals
from stiction.estimate.dry_bridge import DryMiddle
from stiction.estimate.learning import dry, dry_bridges, dry_patches
from stiction.estimate.learning.bridge_rows import TAIL, are_known
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.errors import Processes, Tested, beside, lengths_of
from stiction.estimate.learning.fit import DesignRows
from stiction.estimate.learning.rows import change_of, of_lengths, of_tips, rows_of, stored
from stiction.estimate.learning.training import FACTORS
from stiction.estimate.length import NAMES
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate

#: Coordinates that the changes of tips and of forces by full contact depend on. ASSUME: no others.
OF_FULL, OF_RATIO = (0, 1, 2, 6, 7), (0, 1, 2, 6)


def tips_of(point: Point, constant: float, modulus: float) -> list[DryTip]:
    """Tips of a point at a Hamaker constant [J], by stiffness."""
    heights, width = of_pair(point.sides), to_si(point.width, "um")
    return [DryTip(heights, constant, factor * point.stiffness, width, modulus) for factor in FACTORS]


def patches_of(point: Point, numbers: Mapping[str, Any], modulus: float) -> list[DryPatch]:
    """Patches of a point, by Hamaker constant."""
    heights, area = of_pair(point.sides), float(np.prod(to_si(numbers["sides"], "um")))
    return [DryPatch(heights, float(constant), area, modulus) for constant in numbers["constants"]]


def rows_of_tips(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all tips of a set on summits."""
    return rows_of(
        (point.number, tip.coordinates, of_beam / tip.flat_slope)
        for point, numbers in stored(folder / dry.FOLDER, name, dry.SETS)
        for constant, slopes in zip(numbers["constants"], numbers["slopes"], strict=True)
        for tip, of_beam in zip(tips_of(point, float(constant), modulus), slopes, strict=True)
    )


def _relative(pressures, patch):
    """Pull-off forces of a patch over that of flats (n,)."""
    return pressures.astype(float) * patch.area / patch.flat_force


def rows_of_patches(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all patches of a set on summits."""
    return rows_of(
        (point.number, patch.coordinates, _relative(pressures, patch))
        for point, numbers in stored(folder / dry_patches.FOLDER, name, dry_patches.SETS)
        for patch, pressures in zip(patches_of(point, numbers, modulus), numbers["forces"], strict=True)
    )


def rows_of_full(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the logarithm of the ratio that a run applies to tips, at three slopes, and of its power."""
    coordinates, ratios, powers, surface, noise = [], [], [], [], []
    for point, numbers in stored(folder / dry.FOLDER, name, dry.SETS):
        if np.isfinite(numbers["full"]).all():
            changes = dry.changes_of(*(numbers[key] for key in ("slope", "full", "summits")))
            middle = tips_of(point, float(numbers["constants"][0]), modulus)[0]
            coordinates += [middle.at(slope).coordinates for slope in changes.slopes]
            ratios += np.log(changes.change.at_most(CONFIDENCE).ratio[0]).tolist()
            powers += [changes.change.power.item()] * len(changes.slopes)
            noise += changes.change.ratio_error[0].tolist()
            surface += [point.number] * len(changes.slopes)
    values = {"ratio": np.array(ratios), "power": np.array(powers)}
    return DesignRows(np.array(coordinates), values, np.array(surface), np.array(noise))


def rows_of_ratios(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the logarithm of the ratio, and of the power, of the change of pull-off forces by full contact."""
    every = stored(folder / dry_patches.FOLDER, name, dry_patches.SETS)
    settled = [(point, numbers) for point, numbers in every if np.isfinite(numbers["ratio"])]
    coordinates = np.array([patches_of(*point_and_numbers, modulus)[0].coordinates for point_and_numbers in settled])
    changes = [change_of(numbers) for _, numbers in settled]
    values = {"ratio": np.log([change.ratio for change in changes]), "power": np.array([c.power for c in changes])}
    noise = np.array([float(numbers["ratio_error"]) for _, numbers in settled])
    return DesignRows(coordinates, values, np.array([point.number for point, _ in settled]), noise)


def tested(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of some sets at a normal score up to -2, as `stiction.estimate.learning.errors.tested`."""
    for point, numbers in stored(folder / dry.FOLDER, sets, dry.SETS):
        if np.isfinite(numbers["changed"]).all():
            tip = tips_of(point, float(numbers["constants"][0]), modulus)[FACTORS.index(1.0)]
            true = lengths_of(of_tips(numbers["changed"]), math.log(1.5))
            yield beside(point, true, score, lambda tip=tip, at=point: lengths(tip, 1.0, *processes(at)))


def tested_forces(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Reciprocals of forces of some sets, as `tested`."""
    for point, numbers in stored(folder / dry_patches.FOLDER, sets, dry_patches.SETS):
        if np.isfinite(numbers["ratio"]):
            patch, pressures = patches_of(point, numbers, modulus)[0], numbers["forces"][0].astype(float)
            changed = change_of(numbers).of(pressures)(pressures)
            true = lengths_of(of_tips(_relative(changed, patch)), -math.log(patch.flat_force))
            yield beside(point, true, score, lambda patch=patch, at=point: reciprocals(patch, *processes(at)))


def bridges_of(point: Point, numbers: Mapping[str, Any], modulus: float, *of_patches: Surrogate) -> list[DryMiddle]:
    """Bridges of a point, by size, with the pull-off pressure that processes of patches know."""
    patch = DryPatch(of_pair(point.sides), float(numbers["constant"]), dry_bridge.AREA, modulus)
    force = math.exp(-reciprocals(patch, *of_patches).logarithms[0]) / patch.area
    width = to_si(point.width, "um")
    return [
        DryMiddle(patch, force, modulus * thickness**3, gap, width) for thickness, gap, _ in numbers["sizes"].tolist()
    ]


def _bare(numbers, modulus):
    """Lengths without stress that are held as well as those of the bridges of a point, by size (sizes, n) [m]."""
    for (thickness, _, stress), lengths_under in zip(numbers["sizes"].tolist(), numbers["lengths"], strict=True):
        bare = Stretched.of(stress, thickness, modulus).bare
        yield np.array([bare(each) if np.isfinite(each) else np.inf for each in np.sort(lengths_under).tolist()])


def _stored_bridges(folder, name):
    """Points of some sets with bridges in full contact."""
    every = stored(folder / dry_bridges.FOLDER, name, dry_bridges.SETS)
    return ((point, numbers) for point, numbers in every if "lengths" in numbers)


def rows_of_middles(folder: Path, name: str, modulus: float, *of_patches: Surrogate) -> DesignRows:
    """Rows of all bridges of a set with known lengths, in full contact."""
    coordinates, values, surface = [], [], []
    for point, numbers in _stored_bridges(folder, name):
        bridges = zip(bridges_of(point, numbers, modulus, *of_patches), _bare(numbers, modulus), strict=True)
        for bridge, bare in [each for each in bridges if are_known(each[1])]:
            coordinates.append(bridge.coordinates)
            values.append(of_lengths(bare / bridge.patch_length))
            surface.append(point.number)
    columns = {key: np.array([row[key] for row in values]) for key in NAMES}
    return DesignRows(np.array(coordinates), columns, np.array(surface), columns["slope"])


def tested_bridges(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of bridges without stress that are held as well as those under it, of some sets, as `tested`."""
    for point, numbers in _stored_bridges(folder, sets):
        if not are_known(numbers["lengths"][0], TAIL):
            continue
        middle, *of_patches = processes(point)
        true = lengths_of(of_lengths(next(_bare(numbers, modulus))), 0.0)

        def estimate(at=(point, numbers, modulus, *of_patches), middle=middle):
            """Lengths of the first bridge."""
            return dry_bridge.lengths(bridges_of(*at)[0], middle)

        yield beside(point, true, score, estimate)

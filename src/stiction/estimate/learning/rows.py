"""Rows of the design: coordinates and learnt quantities from the files of `stiction.estimate.learning.training`."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr

from stiction.config.units import to_si
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.contact.correction import ElasticChange
from stiction.devices.tail import fit_tail
from stiction.estimate.learning import patches, training
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.files import numbers_of, path_of
from stiction.estimate.learning.fit import DesignRows
from stiction.estimate.learning.training import FACTORS, SETS, TrainingEffort
from stiction.estimate.length import NAMES, SCORES
from stiction.estimate.state import Film, PatchState, TipState
from stiction.estimate.statistics import of_pair

#: More than the points of a set.
_SET = 10_000
#: Part of the tips whose line gives the shortest lengths, and their least number.
PART, FEW = 0.2, 10


def stored(
    folder: Path, start: str, sets: Mapping[str, TrainingEffort] = SETS
) -> Iterator[tuple[Point, dict[str, Any]]]:
    """Points of all sets of a purpose that are computed, with their numbers, each under a number of its own."""
    for k, (name, effort) in enumerate(sets.items()):
        for point in effort.all if name.startswith(start) else ():
            if path_of(folder / name, point.number).exists():
                yield replace(point, number=_SET * k + point.number), numbers_of(folder / name, point.number)


def states_of(point: Point, airs: np.ndarray, modulus: float) -> list[list[TipState]]:
    """States of a point, by air and stiffness."""
    heights, width = of_pair(point.sides), to_si(point.width, "um")
    return [
        [
            TipState(
                heights, Film(height, 2 * WATER_SURFACE_ENERGY * wetting), factor * point.stiffness, width, modulus
            )
            for factor in FACTORS
        ]
        for height, wetting in airs
    ]


def of_tips(slopes: np.ndarray) -> dict[str, float]:
    """Quantities of tips that stick up to some slopes, or of patches up to some forces, over that of flooded flats."""
    return of_lengths(1 / np.sort(slopes)[::-1])


def of_lengths(lengths: np.ndarray) -> dict[str, float]:
    """Quantities of lengths (n,), of which some may be infinite."""
    line = fit_tail(lengths, max(PART, FEW / len(lengths)))
    with np.errstate(invalid="ignore"):  # between infinite lengths
        first, second = np.log(np.quantile(lengths, ndtr(SCORES[:2])))
    return dict(zip(NAMES, (first, second, line.logarithm(ndtr(SCORES[2])), line.slope), strict=True))


def rows_of(entries: Iterable[tuple[int, Sequence[float], np.ndarray]]) -> DesignRows:
    """Rows of quantities of tips or patches, from numbers of surfaces, coordinates, and values over those of flats."""
    surface, coordinates, relative = zip(*entries, strict=True)
    values = [of_tips(each) for each in relative]
    noise = [row["slope"] / len(each) ** 0.5 for row, each in zip(values, relative, strict=True)]
    columns = {key: np.array([row[key] for row in values]) for key in NAMES}
    return DesignRows(np.array(coordinates), columns, np.array(surface), np.array(noise))


def rows_of_tips(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all tips of a set on summits."""
    return rows_of(
        (point.number, state.coordinates, of_beam / state.flooded_slope)
        for point, numbers in stored(folder / training.FOLDER, name)
        for states, slopes in zip(states_of(point, numbers["airs"], modulus), numbers["slopes"], strict=True)
        for state, of_beam in zip(states, slopes, strict=True)
    )


#: Coordinates that the change by full contact depends on: ASSUME: no others. Few points have it.
OF_FULL = (0, 1, 2, 6, 8)


def rows_of_full(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the logarithm of the change of tips by full contact, at three slopes of some points.

    Their noise is in proportion to the scatter on summits, of which there are more strips.
    """
    coordinates, values, surface, noise = [], [], [], []
    for point, numbers in stored(folder / training.FOLDER, name):
        if "slope" not in numbers or not np.isfinite(numbers["full"]).all():
            continue
        film = states_of(point, numbers["airs"], modulus)[0][1].film
        full, summits = numbers["full"], numbers["summits"]
        ratios = np.log(full.mean(axis=0) / summits.mean(axis=0))
        noise += (summits.std(axis=0) / summits.mean(axis=0)).tolist()
        for slope, ratio in zip(numbers["slope"], ratios, strict=True):
            state = TipState(
                of_pair(point.sides), film, 13.5 * film.energy / slope**4, to_si(point.width, "um"), modulus
            )
            coordinates.append(state.coordinates)
            values.append(ratio)
            surface.append(point.number)
    return DesignRows(np.array(coordinates), {"ratio": np.array(values)}, np.array(surface), np.array(noise))


def patches_of(point: Point, numbers: Mapping[str, Any], modulus: float) -> list[PatchState]:
    """Patches of a point, by air."""
    heights, area = of_pair(point.sides), float(np.prod(to_si(numbers["sides"], "um")))
    films = [Film(height, 2 * WATER_SURFACE_ENERGY * wetting) for height, wetting in numbers["airs"]]
    return [PatchState(heights, film, area, modulus) for film in films]


def of_forces(pressures: np.ndarray, patch: PatchState) -> dict[str, float]:
    """Quantities of a patch from pull-off pressures (n,) [Pa]."""
    return of_tips(_relative(pressures, patch))


def _relative(pressures, patch):
    """Pull-off forces of a patch over that of flooded flats (n,)."""
    return pressures.astype(float) * patch.area / patch.flooded_force


def rows_of_patches(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all patches of a set on summits."""
    return rows_of(
        (point.number, patch.coordinates, _relative(pressures, patch))
        for point, numbers in stored(folder / patches.FOLDER, name)
        for patch, pressures in zip(patches_of(point, numbers, modulus), numbers["forces"], strict=True)
    )


#: Coordinates that the change of forces depends on, as surfaces that are left out say. ASSUME: no others.
OF_RATIO = (0, 1, 2, 4, 7)


def rows_of_ratios(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the logarithm of the ratio, and of the power, of the change of pull-off forces by full contact."""
    settled = [(p, n) for p, n in stored(folder / patches.FOLDER, name) if np.isfinite(n.get("ratio", np.nan))]
    coordinates = np.array([patches_of(*point_and_numbers, modulus)[0].coordinates for point_and_numbers in settled])
    values = {name: np.array([float(numbers[name]) for _, numbers in settled]) for name in ("ratio", "ratio_error")}
    changes = {
        "ratio": np.log(values["ratio"]),
        "power": np.array([change_of(numbers).power for _, numbers in settled]),
    }
    return DesignRows(coordinates, changes, np.array([point.number for point, _ in settled]), values["ratio_error"])


def change_of(numbers: Mapping[str, Any]) -> ElasticChange:
    """Change of the forces of a point that a run applies: the power of their scatter is at least 1."""
    return ElasticChange(float(numbers["ratio"]), max(float(numbers["power"]), 1.0))

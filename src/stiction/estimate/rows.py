"""Rows of the design: coordinates and learnt quantities from the files of `stiction.estimate.training`."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr

from stiction.config.units import to_si
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.devices.tail import fit_tail
from stiction.estimate.design import Point
from stiction.estimate.fit import DesignRows
from stiction.estimate.length import NAMES, SCORES
from stiction.estimate.state import Film, TipState
from stiction.estimate.statistics import of_pair
from stiction.estimate.training import FACTORS, SETS

#: More than the points of a set.
_SET = 10_000
#: Part of the tips whose line gives the shortest lengths, and their least number.
PART, FEW = 0.2, 10


def stored(folder: Path, start: str) -> Iterator[tuple[Point, dict[str, Any]]]:
    """Points of all sets of a purpose that are computed, with their numbers, each under a number of its own."""
    for k, (name, effort) in enumerate(SETS.items()):
        for point in effort.all if name.startswith(start) else ():
            if (file := folder / name / f"{point.number:04}.npz").exists():
                with np.load(file) as numbers:
                    yield replace(point, number=_SET * k + point.number), dict(numbers)


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
    """Quantities of tips that stick up to some slopes over that of flooded flats (n,) [-]."""
    lengths = 1 / np.sort(slopes)[::-1]
    line = fit_tail(lengths, max(PART, FEW / len(lengths)))
    first, second = np.log(np.quantile(lengths, ndtr(SCORES[:2])))
    return dict(zip(NAMES, (first, second, line.logarithm(ndtr(SCORES[2])), line.slope), strict=True))


def rows_of_tips(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all tips of a set on summits."""
    coordinates, values, surface, noise = [], [], [], []
    for point, numbers in stored(folder, name):
        for states, slopes in zip(states_of(point, numbers["airs"], modulus), numbers["slopes"], strict=True):
            for state, of_beam in zip(states, slopes, strict=True):
                coordinates.append(state.coordinates)
                values.append(of_tips(of_beam / state.flooded_slope))
                surface.append(point.number)
                noise.append(values[-1]["slope"] / len(of_beam) ** 0.5)
    columns = {key: np.array([row[key] for row in values]) for key in NAMES}
    return DesignRows(np.array(coordinates), columns, np.array(surface), np.array(noise))


#: Coordinates that the change by full contact depends on: ASSUME: no others. Few points have it.
OF_FULL = (0, 1, 2, 6, 8)


def rows_of_full(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the logarithm of the change of tips by full contact, at three slopes of some points.

    Their noise is in proportion to the scatter on summits, of which there are more strips.
    """
    coordinates, values, surface, noise = [], [], [], []
    for point, numbers in stored(folder, name):
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

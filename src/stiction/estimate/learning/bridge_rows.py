"""Rows of the design about bridges, from the files of `stiction.estimate.learning.bridges`."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.estimate.bridge import MiddleState
from stiction.estimate.learning import patches
from stiction.estimate.learning.bridges import FOLDER
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.fit import DesignRows
from stiction.estimate.learning.rows import of_lengths, stored
from stiction.estimate.length import NAMES
from stiction.estimate.state import Film
from stiction.estimate.statistics import of_pair


def states_of(point: Point, numbers: Mapping[str, Any], modulus: float) -> list[MiddleState]:
    """Bridges of a point, by air."""
    heights, width = of_pair(point.sides), to_si(point.width, "um")
    films = [Film(height, 2 * WATER_SURFACE_ENERGY * wetting) for height, wetting in numbers["airs"]]
    return [
        MiddleState(heights, film, thickness, gap, width, stress, modulus, modulus)
        for film, (thickness, gap, stress) in zip(films, numbers["sizes"].tolist(), strict=True)
    ]


def of_middle(state: MiddleState, lengths: np.ndarray) -> dict[str, float]:
    """Quantities of the lengths (n,) of a bridge [m], which are infinite where two cracks free it at once."""
    ordered = np.sort(lengths.astype(float))
    bare = [state.stretched.bare(length) if np.isfinite(length) else np.inf for length in ordered.tolist()]
    return of_lengths(np.array(bare) / state.flooded_length)


#: Part of the lengths that must be finite to learn from them, and to test those of which few stick.
MOST, TAIL = 0.55, 0.1


def are_known(lengths: np.ndarray, share: float = MOST) -> np.ndarray:
    """Whether a part of some lengths (..., n) is finite (...,)."""
    return np.isfinite(lengths).mean(axis=-1) > share


def rows_of_middles(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of all bridges of a set on summits with known lengths."""
    coordinates, values, surface = [], [], []
    for point, numbers in stored(folder / FOLDER, name):
        bridges = zip(states_of(point, numbers, modulus), numbers["lengths"], strict=True)
        for bridge, lengths in [each for each in bridges if are_known(each[1])]:
            coordinates.append(bridge.coordinates)
            values.append(of_middle(bridge, lengths))
            surface.append(point.number)
    columns = {key: np.array([row[key] for row in values]) for key in NAMES}
    return DesignRows(np.array(coordinates), columns, np.array(surface), columns["slope"])


def with_changes(folder: Path, name: str, share: float = MOST) -> Iterator[tuple[Point, dict[str, Any]]]:
    """Points of some sets whose lengths by full contact are known."""
    for point, numbers in stored(folder / FOLDER, name):
        if "changed" in numbers and are_known(np.array([numbers["lengths"][0], numbers["changed"]]), share).all():
            yield point, numbers


def rows_of_changes(folder: Path, name: str, modulus: float) -> DesignRows:
    """Rows of the change of lengths by full contact: shift of their logarithm, and power of their scatter.

    The shift is that of energy and largest attraction in the closed form of `stiction.estimate.bridge`.
    """
    coordinates, values, surface, noise = [], [], [], []
    forces = {
        point.number: float(numbers["ratio"])
        for point, numbers in stored(folder / patches.FOLDER, name)
        if "ratio" in numbers
    }
    for point, numbers in with_changes(folder, name):
        bridge, *_ = states_of(point, numbers, modulus)
        changed = [of_middle(bridge, each) for each in (numbers["changed"], numbers["lengths"][0])]
        falls = [each["at_0"] - each["at_2"] for each in changed]
        coordinates.append(bridge.coordinates)
        values.append((-math.log(float(numbers["ratio"]) * forces[point.number]) / 8, falls[0] / falls[1]))
        surface.append(point.number)
        noise.append(float(numbers["ratio_error"]))
    shift, power = np.array(values).T
    return DesignRows(np.array(coordinates), {"shift": shift, "power": power}, np.array(surface), np.array(noise))

"""Errors of the estimate on surfaces that were not learnt, and the intervals that follow from them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from stiction.estimate.answer import difficulty
from stiction.estimate.length import NAMES, SCORES, Lengths, NotLearnt, lengths, most
from stiction.estimate.rows import of_tips, states_of, stored
from stiction.estimate.table import Process
from stiction.estimate.training import FACTORS


@dataclass(frozen=True)
class Tested:
    """Length of a state that was not learnt, by its tips and by the estimate."""

    surface: int
    slope: float  #: of the estimate, NaN where it refuses
    true: float  #: [m]
    estimate: float  #: NaN where the estimate refuses [m]

    @property
    def error(self) -> float:
        """Logarithm of the true length over the estimate."""
        return math.log(self.true / self.estimate)

    @property
    def score(self) -> float:
        """Error over its difficulty."""
        return abs(self.error) / difficulty(self.slope)


def tested(folder: Path, sets: str, table: Mapping[str, Any], score: float, changed: bool) -> Iterator[Tested]:
    """Lengths of some sets at a normal score up to -2, on summits alone, or in the first air by full contact."""
    tips, full = Process(**table["tips"]), Process(**table["full"]) if changed else None
    for point, numbers in stored(folder, sets):
        airs = zip(states_of(point, numbers["airs"], table["modulus"]), numbers["slopes"], strict=True)
        for states, slopes in islice(airs, 1 if changed else None):
            own = [_of_tips(each) for each in slopes]
            true = _at_stiffness(own, math.log(_change_of(numbers, own[1]))) if changed else own[1]
            try:
                found = lengths(states[1], 1.0, tips, full)
            except NotLearnt:
                yield Tested(point.number, math.nan, true.at(score), math.nan)
            else:
                yield Tested(point.number, found.slope, true.at(score), found.at(score))


def _of_tips(slopes):
    """Lengths over a gap of 1 m by the slopes of tips (n,)."""
    quantities = of_tips(slopes)
    logarithms = (math.log(1.5) + quantities[name] for name in NAMES[:3])
    return Lengths(tuple(logarithms), quantities["slope"])


def _change_of(numbers, own):
    """Factor of the attraction by the own full contact of a point, at the slope of its own tips."""
    ratios = np.log(numbers["full"].mean(axis=0) / numbers["summits"].mean(axis=0))
    slope = math.log(1.5 / own.at(SCORES[-1]))
    return most(math.exp(np.interp(slope, np.log(numbers["slope"]), ratios)), own.slope)


def _at_stiffness(own, change):
    """Lengths under a change of the attraction, which acts as a change of the stiffness between those computed."""
    at = np.log(FACTORS)
    columns = np.array([[*each.logarithms, each.slope] for each in own]).T
    *logarithms, slope = (float(np.interp(-change, at, column)) for column in columns)
    return Lengths(tuple(logarithms), slope)


def conformal(errors: np.ndarray, confidence: float) -> float:
    """Half of a split conformal interval, from errors on surfaces (n,), infinite where they are too few."""
    rank = math.ceil(confidence * (len(errors) + 1))
    return float(np.sort(np.abs(errors))[rank - 1]) if rank <= len(errors) else math.inf


def by_surface(found: Sequence[Tested]) -> np.ndarray:
    """Largest error over its difficulty on each surface that the estimate does not refuse."""
    known = [one for one in found if not math.isnan(one.estimate)]
    return np.array([max(one.score for one in known if one.surface == k) for k in {one.surface for one in known}])

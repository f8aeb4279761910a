"""Length at which a fraction of cantilevers sticks, with its interval, or the reason why it is not known.

Plain Python: the page has the same arithmetic in JavaScript.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

from stiction.estimate.solids import BesideWater
from stiction.estimate.state import COORDINATES, OF_SOLIDS, TipState
from stiction.estimate.table import Surrogate

#: Normal scores of the learnt lengths: the last one and the slope there give all shorter lengths.
SCORES = (0.0, -1.0, -2.0)
NAMES = ("at_0", "at_1", "at_2", "slope")
#: Confidence with which tips count as held harder than full contact of few strips says, in standard errors.
_AT_MOST = 1.645
#: Strips of a run in full contact and on summits, half of two standard errors of Student's t of them, error of their
#: power, and normal score of the largest tips: `stiction.analysis.model_error.few_tip_ratios`.
_FULL, _SUMMITS, _STUDENT, _POWER_ERROR, _LARGEST = 8, 64, 1.17, 0.1, 3.09
#: Scatter of the logarithm of P over that of the length. ASSUME: P falls as θ⁻¹ as that of smooth tips, the safe side.
OF_FORCES = 4.0


@dataclass(frozen=True)
class LengthRow:
    """Length at which a fraction sticks."""

    fraction: float
    length: float  #: [m]
    intervals: dict[str, tuple[float, float]]  #: by confidence [m]

    @property
    def size(self) -> float:
        """What a device is built to, in SI."""
        return self.length


@dataclass(frozen=True)
class Lengths:
    """Distribution of the shortest length that sticks, of tips in one state."""

    logarithms: tuple[float, float, float]  #: of the length [m] at `SCORES`
    slope: float  #: by the normal score below the last one

    @property
    def fall(self) -> float:
        """Fall of the logarithm from the median to the last score, by the normal score."""
        return (self.logarithms[0] - self.logarithms[-1]) / (SCORES[0] - SCORES[-1])

    def at(self, score: float) -> float:
        """Length at a normal score up to the first one [m]."""
        (first, second, third), (_, b, c) = self.logarithms, SCORES
        if score <= c:
            return math.exp(third + self.slope * (score - c))
        low, step, start = (third, second - third, c) if score <= b else (second, first - second, b)
        return math.exp(low + step * (score - start))


class NotLearnt(Exception):
    """Refusal to estimate, in words."""


class Impossible(NotLearnt):
    """Refusal of numbers that no device has. A run refuses them, too."""


def lengths(state: TipState, gap: float, tips: Surrogate, full: Surrogate | None, *changes: Surrogate) -> Lengths:
    """Lengths of beams over a gap [m] in a state.

    Full contact changes an attraction by a factor, as a stiffer beam would. ASSUME: on other solids by the same factor.

    Raises
    ------
    NotLearnt
        If the state is beyond what was learnt.
    """
    distribution = _on_summits(state, gap, tips, *changes)
    for _ in range(2 if full else 0):
        changed = replace(state, stiffness=state.stiffness / change(state, distribution, gap, full))
        distribution = _on_summits(changed, gap, tips, *changes)
    return distribution


def _on_summits(state, gap, tips, *changes):
    """Lengths on summits alone."""
    return falling(on_solids(tips, state, *changes), math.log(1.5 * gap / state.flooded_slope))


class OnSolids(Protocol):
    """State of two solids with water between them."""

    beside_water: BesideWater
    coordinates: Sequence[float]
    names: ClassVar[tuple[str, ...]]


def on_solids(process: Surrogate, state: OnSolids, *changes: Surrogate) -> Mapping[str, float]:
    """Quantities of a process on the solids of a state, from those on polysilicon.

    By the changes for one of each of `stiction.estimate.solids.BesideWater.logarithms`.

    Raises
    ------
    NotLearnt
        If the state is beyond what was learnt.
    """
    coordinates, by = state.coordinates, state.beside_water.logarithms
    values = dict(known_at(process, coordinates, state.names))
    for change_by_one, logarithm in zip(changes, by, strict=False):
        if logarithm:
            of_one = known_at(change_by_one, (*coordinates, *by), (*state.names, *OF_SOLIDS))
            values |= {name: values[name] + logarithm * of_one[name] for name in NAMES[:3]}
    return values


#: Least fall of the logarithm of a length by one normal score.
_LEAST = 2e-3


def falling(values: Mapping[str, float], shift: float) -> Lengths:
    """Lengths from learnt quantities, whose logarithms are shifted and fall with the score."""
    first, second, third = (values[name] + shift for name in NAMES[:3])
    second = min(first - _LEAST, second)
    return Lengths((first, second, min(second - _LEAST, third)), max(_LEAST, values["slope"]))


def known_at(process: Surrogate, coordinates: Sequence[float], names: Sequence[str]) -> Mapping[str, float]:
    """Quantities of a process at coordinates with some names.

    Raises
    ------
    NotLearnt
        If it is beyond what was learnt.
    """
    values = process.at(coordinates)
    if values.outside:
        first = values.outside[0]
        raise NotLearnt(f"{names[first]} is too {process.side(first, coordinates[first])}, beyond what was learnt")
    if values.distance > process.farthest:
        raise NotLearnt("its numbers together are unlike all that was learnt: change the humidity or the rms")
    return values.of


def change(state: TipState, distribution: Lengths, gap: float, full: Surrogate) -> float:
    """Factor of the attraction of tips by full contact, as a run applies it."""
    slope = 1.5 * gap / distribution.at(SCORES[-1])
    at_slope = replace(state, stiffness=13.5 * state.film.energy / slope**4)  # flooded flats hold up to this slope
    ratio = known_at(full, at_slope.coordinates, COORDINATES)["ratio"]
    return most(math.exp(ratio), distribution.fall)


def most(ratio: float, fall: float) -> float:
    """Upper end of a ratio of the means of few tips, which a run applies, from the `Lengths.fall` of the lengths."""
    scatter = OF_FORCES * fall
    of_means = _STUDENT * math.sqrt(math.expm1(scatter**2) * (1 / (_FULL - 1) + 1 / (_SUMMITS - 1)))
    error = math.hypot(of_means, _POWER_ERROR * scatter * max(_LARGEST - scatter, 0.0))
    return ratio * math.exp(_AT_MOST * error)


#: Least normal score that is asked for.
_LEAST_SCORE = -9.0


def normal_score(fraction: float) -> float:
    """Normal score of a fraction [-].

    Examples
    --------
    >>> round(normal_score(1e-3), 4), round(fraction_of(-3.0902), 6)
    (-3.0902, 0.001)
    """
    low, high = _LEAST_SCORE, -_LEAST_SCORE
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fraction_of(middle) < fraction else (low, middle)
    return 0.5 * (low + high)


def score_at(logarithm: Callable[[float], float], value: float) -> float:
    """Normal score at which a logarithm of lengths, which falls with the score, has a value: at most the first one."""
    low, high = _LEAST_SCORE, SCORES[0]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if logarithm(middle) < value else (low, middle)
    return high


def fraction_of(score: float) -> float:
    """Fraction below a normal score [-]."""
    return 0.5 * math.erfc(-score / math.sqrt(2))


def after(score: float, touchdowns: int) -> float:
    """Fraction that sticks after some independent touchdowns, of which each has a normal score [-]."""
    return -math.expm1(touchdowns * math.log1p(-fraction_of(score)))


def most_after(touchdowns: int) -> float:
    """Largest fraction that is known after some touchdowns, that at the first of `SCORES` [-]."""
    return after(SCORES[0], touchdowns)

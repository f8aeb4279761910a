r"""Joint draws of all that is unknown about a device: simulation, inputs, and the errors of their budget.

A device of size L sticks if and only if :math:`v = \ln L` is above its threshold, the logarithm of its sticking length.
A stopper with the restoring force F sticks if :math:`v = -\ln F` is above minus the logarithm of its pull-off force.

A *condition* is one set of circumstances: an air, an end state, with or without voltage. The answer belongs to the
worst condition in every draw, so that one more condition never makes a beam longer.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from scipy.special import ndtr, ndtri

from stiction.answer.data import Cause
from stiction.answer.unknowns import Draws, Unknowns, normal
from stiction.devices.risk import CONFIDENCE, upper_bound
from stiction.devices.tail import TAIL, TailFit, simulated_lines
from stiction.life.freeing import probability_for, stuck_after
from stiction.streams import stream

#: Number of draws. They leave 0.3 % in a size.
DRAWS = 20_000


@dataclass(frozen=True)
class Stated:
    """Size for a fraction as a dataset states it, as v."""

    share: float  #: p [-]
    estimate: float
    bound: float  #: with 95 % confidence, no larger than the estimate


@dataclass(frozen=True)
class Sampled:
    """Thresholds of simulated devices."""

    values: np.ndarray  #: increasing, infinite where a device does not stick (n,)
    tail: TailFit | None  #: line through the lowest; none if too few stick
    stated: Stated
    reach: float = np.inf  #: end of the simulation
    floor: float = -np.inf  #: below which no surfaces hold a device
    surfaces_error: float = 0.0  #: standard error of all thresholds by the number of sampled surfaces


@dataclass(frozen=True)
class Condition:
    """Thresholds in one set of circumstances, sampled or a bound by another route."""

    humidity: float  #: [-]
    shape: str  #: end state
    cause: Cause  #: `Cause.ESTIMATE` for a stated air; otherwise the step to which it belongs
    source: str  #: dataset
    sampled: Sampled | None = None
    bound: float = np.nan  #: threshold of all devices, where none is sampled
    shift: float = 0.0  #: of all thresholds
    error: float = 0.0  #: standard error of ``shift``, or of ``bound``


@dataclass(frozen=True)
class World:
    """Draws of all conditions of a device.

    ``causes`` names the steps inside. The same draws are the same errors whatever the conditions and causes are.
    """

    conditions: tuple[Condition, ...]
    unknowns: Unknowns
    causes: frozenset[Cause]
    touchdowns: int = 1
    draws: Draws = Draws(DRAWS, 0)
    exact: frozenset[str] = field(default_factory=frozenset)  #: groups of inputs that count as known

    @cached_property
    def inside(self) -> tuple[Condition, ...]:
        """Conditions of the causes inside."""
        return tuple(one for one in self.conditions if one.cause is Cause.ESTIMATE or one.cause in self.causes)

    @property
    def _is_simulated(self):
        """Whether errors of the simulation are inside."""
        return Cause.SIMULATION in self.causes

    @property
    def _repeats(self):
        """Touchdowns that count."""
        return self.touchdowns if Cause.TOUCHDOWNS in self.causes else 1

    @cached_property
    def _shifts(self):
        """Shift of every condition by the errors of the inputs, and by its own (conditions, draws)."""
        of_inputs = self.causes & {Cause.INPUTS, Cause.TEST_BEAMS}
        shifts = np.array([np.full(self.draws.number, one.shift) for one in self.inside])
        for row, one in zip(shifts, self.inside, strict=True):
            if self._is_simulated and one.error:
                row += one.error * normal(self.draws, "shift", one.source)
            if of_inputs:
                row += self.unknowns.shift((one.humidity, one.shape), self.draws, self.exact)
        return shifts

    @cached_property
    def _lines(self):
        """Intercepts and slopes of the tails of all sampled conditions, with the errors of the simulation."""
        return {k: self._line(one) for k, one in enumerate(self.inside) if one.sampled and one.sampled.tail}

    def _line(self, condition):
        """Intercepts and slopes of one tail (draws,) each. All airs of an end state share their samples."""
        of, tail = condition.sampled, condition.sampled.tail
        if not self._is_simulated:
            intercept = (
                np.full(self.draws.number, tail.intercept) + of.stated.estimate - tail.logarithm(of.stated.share)
            )
            return intercept, np.full(self.draws.number, tail.slope)
        at, along = _pivots(tail.samples, tail.fitted, condition.shape, self.draws)
        slopes = tail.slope / along
        intercepts = tail.intercept - at * slopes + of.surfaces_error * normal(self.draws, "surfaces")
        return intercepts + _to_stated(of.stated, intercepts + slopes * ndtri(of.stated.share)), slopes

    def thresholds(self, share: float) -> np.ndarray:
        """Quantile of the thresholds of every condition at a fraction, in every draw (conditions, draws)."""
        score, rows = ndtri(probability_for(share, self._repeats)), []
        for k, one in enumerate(self.inside):
            if k in self._lines:
                intercepts, slopes = self._lines[k]
                rows.append(np.maximum(intercepts + slopes * score, one.sampled.floor))
            else:
                rows.append(np.full(self.draws.number, one.sampled.stated.bound if one.sampled else one.bound))
        return np.array(rows) + self._shifts

    def size(self, share: float) -> tuple[float, Condition]:
        """Size that at most a fraction sticks at, with confidence where errors are inside, and what decides."""
        rows = self.thresholds(share)
        least = rows.min(axis=0)
        bound = float(np.quantile(least, 1 - CONFIDENCE) if self._is_simulated else np.median(least))
        near = np.abs(least - bound) <= np.quantile(np.abs(least - bound), 0.02)
        decides = np.bincount(rows[:, near].argmin(axis=0), minlength=len(rows)).argmax()
        return bound, self.inside[int(decides)]

    def stuck(self, v: float) -> np.ndarray:
        """Fraction stuck at v in the worst sampled condition, in every draw (draws,)."""
        rows = [self._stuck(k, v - self._shifts[k]) for k, one in enumerate(self.inside) if one.sampled]
        return np.max(rows, axis=0)

    def _stuck(self, k, at):
        """Fraction stuck in one condition at values (draws,): by counts, or by the line where few stick."""
        of, n = self.inside[k].sampled, len(self.inside[k].sampled.values)
        below = np.searchsorted(of.values, at)
        rng = stream(self.draws.seed, "answer", "counts", self.inside[k].shape)
        share = rng.beta(below + 0.5, n - below + 0.5)
        if k in self._lines:
            intercepts, slopes = self._lines[k]
            share = np.where(below > TAIL * n, share, ndtr((at - intercepts) / slopes))
        share = np.where(at < of.floor, 0.0, share)
        beyond = share + (1 - share) * rng.random(self.draws.number)  # devices that did not stick there may all do so
        return stuck_after(np.where(at > of.reach, beyond, share), self._repeats)

    def seen(self, v: float) -> int:
        """Largest number of simulated devices stuck at v in a condition, all inputs as stated."""
        return max(int(np.searchsorted(one.sampled.values, v - one.shift)) for one in self.inside if one.sampled)

    def unseen(self) -> float:
        """Largest fraction stuck where no simulated device sticks, after all touchdowns (95 % confidence) [-]."""
        fewest = min(len(one.sampled.values) for one in self.inside if one.sampled)
        return float(stuck_after(upper_bound(0, fewest, (1 + CONFIDENCE) / 2), self._repeats))


@lru_cache(maxsize=8)  # all airs of an end state, and every step, ask for the same
def _pivots(samples, fitted, shape, draws):
    """Intercepts and slopes of lines through the lowest of normal samples (draws,) each."""
    return simulated_lines(samples, fitted, stream(draws.seed, "answer", "tail", shape), draws.number)


def _to_stated(stated: Stated, drawn: np.ndarray) -> np.ndarray:
    """Addition to drawn quantiles (draws,) that makes their median and 5 % quantile those of a stated bound.

    A bound of order statistics, or one that is no larger than that in drier air, is not that of a line.
    """
    middle, least = np.median(drawn), np.quantile(drawn, 1 - CONFIDENCE)
    wider = (stated.estimate - stated.bound) / (middle - least)
    return stated.estimate - drawn + (drawn - middle) * wider


def worst_first(conditions: Sequence[Condition], share: float) -> list[Condition]:
    """Sampled conditions, that with the smallest stated bound first."""
    sampled = [one for one in conditions if one.sampled and one.sampled.stated.share == share]
    return sorted(sampled, key=lambda one: one.sampled.stated.bound + one.shift)

"""Ladder from the estimate to the size to build, and P(stuck) at a size, from the draws of all conditions."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stiction.answer.data import Answer, AnswerInAir, Cause, Probability, Stay, Step, band
from stiction.answer.sought import SOUGHT
from stiction.answer.unknowns import Draws, OfBudgets, OfTestBeams, Unknowns
from stiction.answer.worlds import Condition, World
from stiction.devices.risk import CONFIDENCE
from stiction.life.freeing import probability_for

#: Points of a curve of P(stuck), how far it goes below the size to build in ln size, and the fraction at its end.
_POINTS, _BELOW, _MOST = 41, 0.25, 0.99


@dataclass(frozen=True)
class MainQuestion:
    """Main question about a device."""

    device: str
    kind: str
    share: float  #: allowed fraction of stuck devices [-]
    unit: str  #: of sizes, m or N
    size: float = np.nan  #: stated, NaN without one
    touchdowns: int = 1
    stays: tuple[Stay, ...] = ()  #: airs of the touchdowns; without these, all count in the worst air
    left_out: tuple[str, ...] = ()  #: conditions that are stated but not inside
    forbidden: tuple[str, ...] = ()  #: kinds of the limits that forbid a number

    @property
    def sign(self) -> float:
        """Sign of ln size in v."""
        return SOUGHT[self.unit].sign

    def size_of(self, v: float) -> float:
        """Size at v [m, N], NaN where nothing bounds it."""
        return float(np.exp(self.sign * v)) if v > -np.inf else np.nan

    @property
    def v(self) -> float:
        """V of the stated size."""
        return self.sign * float(np.log(self.size))


def answer(
    question: MainQuestion,
    conditions: Sequence[Condition],
    unknowns: Unknowns,
    draws: Draws,
    before: Unknowns | None = None,
) -> Answer:
    """Answer from all conditions. Only a cause that is not stated leaves the size to build as it is.

    With test beams, ``before`` are the errors of the inputs without them.
    """
    stated = question.share, question.touchdowns
    start = World(tuple(conditions), unknowns, frozenset(), *stated, draws, stays=question.stays)
    steps = _steps(question, start, _present(question, start))
    inside = frozenset(step.cause for step in steps if step.stated) - {Cause.ESTIMATE}
    world = replace(start, causes=inside)
    exact = replace(world, causes=inside - {Cause.INPUTS, Cause.TEST_BEAMS})
    alone, sizes = replace(exact, causes=exact.causes | {Cause.INPUTS}), _sizes(question, world)
    measure, if_measured = _to_measure(question, world)
    airs = dict.fromkeys(condition.humidity for condition in world.inside)
    return Answer(
        **vars(question),
        build=question.size_of(world.size),
        exact=question.size_of(exact.size),
        steps=tuple(steps),
        airs=tuple(_in_air(question, world, humidity, sizes) for humidity in airs),
        stuck=_stuck(question, world),
        extrapolated=world.is_extrapolated,
        measure=measure,
        if_measured=if_measured,
        spread_of_budget=_spread_of_budget(world),
        without_test_beams=np.nan if before is None else question.size_of(replace(alone, unknowns=before).size),
        sizes=sizes,
        curve=_curve(question, world, sizes),
    )


def _steps(question, start, causes):
    """Steps in the order of the causes. Those of causes that are not stated stand beside."""
    steps, world = [_step(question, Cause.ESTIMATE, start, start)], start
    for cause in causes:
        after = replace(world, causes=world.causes | {cause})
        steps.append(_step(question, cause, world, after))
        world = after if steps[-1].stated else world
    return steps


def _step(question, cause, before, after):
    """Step from one world to the next."""
    change = 0.0 if before.size == after.size else question.sign * (after.size - before.size)
    one, is_stated = after.decides, all(one.stated for one in after.conditions if one.cause is cause)
    where = one.humidity, one.shape, one.source
    return Step(cause, question.size_of(after.size), float(np.exp(change)), *where, is_stated)


def _present(question, world):
    """Causes that a device has, in their order."""
    unknowns = world.unknowns
    present = {Cause.SIMULATION, *(one.cause for one in world.conditions)} - {Cause.ESTIMATE}
    present |= {Cause.TOUCHDOWNS} if question.touchdowns > 1 else set()
    present |= {Cause.INPUTS} if isinstance(unknowns, OfBudgets) and unknowns.budgets else set()
    present |= {Cause.TEST_BEAMS} if isinstance(unknowns, OfTestBeams) else set()
    return [cause for cause in Cause if cause in present]


def _stuck(question, world):
    """P(stuck) at the stated size, none without one."""
    return None if np.isnan(question.size) else probability(world, question.v)


def probability(world: World, v: float) -> Probability:
    """P(stuck) at v.

    A few draws of which all devices stick can raise the expectation above the band, which then ends there.
    """
    fractions, none_seen = world.stuck(v), v < world.first
    value, (low, high) = float(fractions.mean()), band(fractions)
    if none_seen:
        low, high = 0.0, float(np.quantile(fractions, CONFIDENCE, method="lower"))
    return Probability(value, min(low, value), max(high, value, world.least_bound(v)), none_seen)


def _sizes(question, world):
    """Sizes of the curves of P(stuck), from below the size to build to those at which most stick in every air."""
    ends: dict[float, float] = {}
    share = probability_for(_MOST, question.touchdowns)
    for one in (one for one in world.inside if one.sampled):
        most = float(one.sampled.values[int(share * (len(one.sampled.values) - 1))])
        ends[one.humidity] = min(most, one.sampled.reach, ends.get(one.humidity, np.inf))
    known = [end for end in (*ends.values(), world.size, question.v) if np.isfinite(end)]
    if not known:
        return np.empty(0)
    low, high = min(known) - _BELOW, max(known) + 0.02
    return np.exp(question.sign * np.linspace(low, high, _POINTS))


def _in_air(question, world, humidity, sizes):
    """Answer for one stated air alone."""
    own = replace(world, conditions=tuple(one for one in world.conditions if one.humidity == humidity))
    without_tip, shapes = np.nan, list(dict.fromkeys(one.shape for one in own.inside if one.sampled))
    if len(shapes) > 1:
        along = replace(own, conditions=tuple(one for one in own.conditions if one.shape != shapes[-1]))
        without_tip = question.size_of(along.size)
    first, curve = question.size_of(own.first), _curve(question, own, sizes)
    return AnswerInAir(humidity, question.size_of(own.size), without_tip, _stuck(question, own), curve, first)


def _curve(question, world, sizes):
    """Expected fraction stuck at some sizes, and ends of its band (3, n) [-]."""
    found = [probability(world, v) for v in question.sign * np.log(sizes)]
    return np.array([[one.value, one.low, one.high] for one in found]).reshape(-1, 3).T


def _to_measure(question, world):
    """Group of inputs whose exact knowledge changes the size to build most, and the size then."""
    if Cause.INPUTS not in world.causes:
        return "", np.nan
    left = {group: replace(world, exact=frozenset({group})).size for group in world.unknowns.groups}
    best = max(left, key=left.get, default="")
    return best, question.size_of(left[best]) if best else np.nan


def _spread_of_budget(world):
    """Part of the size that the errors of the budget itself take [-]."""
    if Cause.INPUTS not in world.causes or np.isinf(world.size):
        return 0.0
    known = replace(world, unknowns=replace(world.unknowns, own_errors=False))
    return abs(known.size - world.size)

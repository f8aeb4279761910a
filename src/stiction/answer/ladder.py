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
    requirement = question.share, question.touchdowns
    start = World(tuple(conditions), unknowns, frozenset(), *requirement, draws, stays=question.stays)
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
    is_stated = all(condition.is_stated for condition in after.conditions if condition.cause is cause)
    where = after.decides.humidity, after.decides.shape, after.decides.source
    return Step(cause, question.size_of(after.size), float(np.exp(change)), *where, is_stated)


def _present(question, world):
    """Causes that a device has, in their order."""
    unknowns = world.unknowns
    present = {Cause.SIMULATION, *(condition.cause for condition in world.conditions)} - {Cause.ESTIMATE}
    present |= {Cause.TOUCHDOWNS} if question.touchdowns > 1 else set()
    present |= {Cause.INPUTS} if isinstance(unknowns, OfBudgets) and unknowns.budgets else set()
    present |= {Cause.TEST_BEAMS} if isinstance(unknowns, OfTestBeams) else set()
    return [cause for cause in Cause if cause in present]


def _stuck(question, world):
    """P(stuck) at the stated size, none without one."""
    return None if np.isnan(question.size) else probability(world, question.v)


def probability(world: World, v: float) -> Probability:
    """P(stuck) at v.

    A few draws of which all devices stick can raise the expectation above the band, which then ends there, or above the
    bound of a fraction of which no device is seen. The bound is the statement of the size to build and stays.
    """
    fractions, least = world.stuck(v), world.least_bound(v)
    value = float(fractions.mean())
    if v < world.first:
        bound = float(np.quantile(fractions, CONFIDENCE, method="lower"))
        return Probability(value, 0.0, max(bound, least), none_seen=True)
    low, high = band(fractions)
    return Probability(value, min(low, value), max(high, value, least))


def _sizes(question, world):
    """Sizes of the curves of P(stuck), from below the size to build to those at which most stick in every air."""
    ends: dict[float, float] = {}
    share = probability_for(_MOST, question.touchdowns)
    for condition in (condition for condition in world.inside if condition.sampled):
        most = float(condition.sampled.values[int(share * (len(condition.sampled.values) - 1))])
        ends[condition.humidity] = min(most, condition.sampled.reach, ends.get(condition.humidity, np.inf))
    finite_ends = [end for end in (*ends.values(), world.size, question.v) if np.isfinite(end)]
    if not finite_ends:
        return np.empty(0)
    low, high = min(finite_ends) - _BELOW, max(finite_ends) + 0.02
    return np.exp(question.sign * np.linspace(low, high, _POINTS))


def _in_air(question, world, humidity, sizes):
    """Answer for one stated air alone."""
    alone = replace(
        world, conditions=tuple(condition for condition in world.conditions if condition.humidity == humidity)
    )
    without_tip = np.nan
    shapes = list(dict.fromkeys(condition.shape for condition in alone.inside if condition.sampled))
    if len(shapes) > 1:
        along = replace(
            alone, conditions=tuple(condition for condition in alone.conditions if condition.shape != shapes[-1])
        )
        without_tip = question.size_of(along.size)
    first, curve = question.size_of(alone.first), _curve(question, alone, sizes)
    return AnswerInAir(humidity, question.size_of(alone.size), without_tip, _stuck(question, alone), curve, first)


def _curve(question, world, sizes):
    """Expected fraction stuck at some sizes, and ends of its band (3, n) [-]."""
    probabilities = [probability(world, v) for v in question.sign * np.log(sizes)]
    return np.array([[p.value, p.low, p.high] for p in probabilities]).reshape(-1, 3).T


def _to_measure(question, world):
    """Group of inputs whose exact knowledge changes the size to build most, and the size then."""
    if Cause.INPUTS not in world.causes:
        return "", np.nan
    sizes = {group: replace(world, exact=frozenset({group})).size for group in world.unknowns.groups}
    best = max(sizes, key=sizes.get, default="")
    return best, question.size_of(sizes[best]) if best else np.nan


def _spread_of_budget(world):
    """Part of the size that the errors of the budget itself take [-]."""
    if Cause.INPUTS not in world.causes or np.isinf(world.size):
        return 0.0
    without_errors = replace(world, unknowns=replace(world.unknowns, own_errors=False))
    return abs(without_errors.size - world.size)

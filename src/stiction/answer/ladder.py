"""Ladder from the estimate to the size to build, and P(stuck) at a size, from the draws of all conditions."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from stiction.answer.data import Answer, Cause, InAir, Probability, Step, band
from stiction.answer.unknowns import Draws, OfBudgets, Unknowns
from stiction.answer.worlds import Condition, World

#: Points of a curve of P(stuck), and how far it goes below the size to build in ln size.
_POINTS, _BELOW = 41, 0.25


@dataclass(frozen=True)
class Question:
    """Main question about a device."""

    device: str
    kind: str
    share: float  #: allowed fraction of stuck devices [-]
    unit: str  #: of sizes, m or N
    size: float = np.nan  #: stated, NaN without one
    touchdowns: int = 1
    left_out: tuple[str, ...] = ()  #: conditions that are stated but not inside
    forbidden: tuple[str, ...] = ()  #: kinds of the limits that forbid a number

    @property
    def sign(self) -> float:
        """Sign of ln size in v."""
        return -1.0 if self.unit == "N" else 1.0

    def size_of(self, v: float) -> float:
        """Size at v [m, N]."""
        return float(np.exp(self.sign * v))


def answer(
    question: Question,
    conditions: Sequence[Condition],
    unknowns: Unknowns,
    draws: Draws,
    before: Unknowns | None = None,
) -> Answer:
    """Answer from all conditions. Only a cause that is not stated leaves the size to build as it is.

    With test beams, ``before`` are the errors of the inputs without them.
    """
    steps = _steps(question, World(tuple(conditions), unknowns, frozenset(), question.touchdowns, draws), unknowns)
    inside = frozenset(step.cause for step in steps if step.stated) - {Cause.ESTIMATE}
    world = World(tuple(conditions), unknowns, inside, question.touchdowns, draws)
    exact = replace(world, causes=inside - {Cause.INPUTS, Cause.TEST_BEAMS})
    build = [step for step in steps if step.stated][-1].size
    sizes = _sizes(question, world, build)
    measure, if_measured = _to_measure(question, world)
    return Answer(
        question.device,
        question.kind,
        question.share,
        question.unit,
        build,
        question.size_of(exact.size(question.share)[0]),
        tuple(steps),
        tuple(_in_air(question, world, rh, sizes) for rh in dict.fromkeys(one.humidity for one in world.inside)),
        question.size,
        _stuck(question, world, build),
        question.touchdowns,
        question.left_out,
        question.forbidden,
        measure,
        if_measured,
        _spread_of_budget(question, world, build),
        np.nan if before is None else _without_test_beams(question, exact, before),
        sizes,
    )


def _steps(question, start, unknowns):
    """Steps in the order of the causes. Those of causes that are not stated stand beside."""
    v, decides = start.size(question.share)
    steps = [Step(Cause.ESTIMATE, question.size_of(v), 1.0, decides.humidity, decides.shape, decides.source)]
    inside: frozenset[Cause] = frozenset()
    for cause in _present(question, start, unknowns):
        more = inside | {cause}
        after, decides = replace(start, causes=more).size(question.share)
        is_stated = cause is not Cause.FAST
        factor = question.size_of(after) / question.size_of(v)
        steps.append(
            Step(cause, question.size_of(after), factor, decides.humidity, decides.shape, decides.source, is_stated)
        )
        if is_stated:
            inside, v = more, after
    return steps


def _present(question, world, unknowns):
    """Causes that a device has, in their order."""
    present = {Cause.SIMULATION, *(one.cause for one in world.conditions)} - {Cause.ESTIMATE}
    present |= {Cause.TOUCHDOWNS} if question.touchdowns > 1 else set()
    present |= {Cause.INPUTS} if isinstance(unknowns, OfBudgets) and unknowns.budgets else set()
    present |= {Cause.TEST_BEAMS} if not isinstance(unknowns, OfBudgets) and unknowns.groups else set()
    return [cause for cause in Cause if cause in present]


def _stuck(question, world, build):
    """P(stuck) at the stated size, none without one.

    Where no simulated device sticks, the count bounds it, and so does the size to build if the stated one is within it.
    """
    if np.isnan(question.size):
        return None
    v = question.sign * np.log(question.size)
    fractions = world.stuck(v)
    value, (low, high), unseen = float(fractions.mean()), band(fractions), world.unseen()
    if world.seen(v) or value > unseen:
        return Probability(value, low, high)
    within = question.sign * (np.log(build) - np.log(question.size)) >= 0
    return Probability(value, 0.0, min(max(high, unseen), question.share if within else 1.0), none_seen=True)


def _sizes(question, world, build):
    """Sizes of the curves of P(stuck), from below the size to build to those at which most devices stick."""
    ends = [float(one.sampled.values[int(0.9 * (len(one.sampled.values) - 1))]) for one in world.inside if one.sampled]
    ends += [one.sampled.reach for one in world.inside if one.sampled]
    stated = [question.sign * np.log(size) for size in (build, question.size) if 0 < size < np.inf]
    known = [end for end in (*ends, *stated) if np.isfinite(end)]
    highest = min((end for end in ends if np.isfinite(end)), default=max(known))
    low, high = min([*stated, *known]) - _BELOW, max([highest, *stated]) + 0.02
    return np.exp(question.sign * np.linspace(low, high, _POINTS))


def _without_test_beams(question, exact, before):
    """Size to build without test beams."""
    return question.size_of(
        replace(exact, unknowns=before, causes=exact.causes | {Cause.INPUTS}).size(question.share)[0]
    )


def _in_air(question, world, humidity, sizes):
    """Answer for one stated air alone."""
    own = replace(world, conditions=tuple(one for one in world.conditions if one.humidity == humidity))
    build, without_tip = question.size_of(own.size(question.share)[0]), np.nan
    shapes = list(dict.fromkeys(one.shape for one in own.inside))
    if len(shapes) > 1:
        along = replace(own, conditions=tuple(one for one in own.conditions if one.shape == shapes[0]))
        without_tip = question.size_of(along.size(question.share)[0])
    fractions = [own.stuck(v) for v in question.sign * np.log(sizes)]
    curve = np.array([[some.mean(), *band(some)] for some in fractions]).T
    return InAir(humidity, build, without_tip, _stuck(question, own, build), curve)


def _to_measure(question, world):
    """Group of inputs whose exact knowledge changes the size to build most, and the size then."""
    if Cause.INPUTS not in world.causes:
        return "", np.nan
    left = {group: replace(world, exact=frozenset({group})).size(question.share)[0] for group in world.unknowns.groups}
    best = max(left, key=left.get, default="")
    return best, question.size_of(left[best]) if best else np.nan


def _spread_of_budget(question, world, build):
    """Part of the size that the errors of the budget itself take [-]."""
    if Cause.INPUTS not in world.causes:
        return 0.0
    known = replace(world, unknowns=replace(world.unknowns, own_errors=False))
    return float(abs(np.log(question.size_of(known.size(question.share)[0]) / build)))

r"""Joint draws of all that is unknown about a device: simulation, inputs, and the errors of their budget.

A device of size L sticks if and only if :math:`v = \ln L` is above its threshold, the logarithm of its sticking length.
A stopper with the restoring force F sticks if :math:`v = -\ln F` is above minus the logarithm of its pull-off force.

A *condition* is one set of circumstances: an air, an end state, with or without voltage. The answer belongs to the
worst condition in every draw, so that one more condition never makes a beam longer.

If a mission says which touchdowns happen in which airs, those of air i are :math:`n_i`, each on other summits, and in
the worst condition of this air:

.. math:: P(v) = 1 - \prod_i (1 - \max_k P_{ik}(v))^{n_i} .
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import betaincinv, expit, logit, ndtr, ndtri

from stiction.answer.data import Cause, Stay
from stiction.answer.unknowns import Draws, Unknowns, normal
from stiction.devices.risk import CONFIDENCE, DECADE, VERIFIED, upper_bound
from stiction.devices.tail import FEWEST, TAIL, TailFit, fit_tail, simulated_lines
from stiction.life.freeing import probability_for, stuck_after
from stiction.streams import stream

#: Number of draws. They leave 0.3 % in a size.
DRAWS = 20_000
#: Smallest scatter of ln size. Where no strips resolve the ground, all devices are alike.
_ALIKE = 1e-9
#: Distance of the normal scores of two points of a line that tell its slope.
_APART = 0.5
#: Halvings of an interval of v. They leave 1e-7 of it.
_HALVES = 24
#: Normal scores at which distributions of counted fractions are tabulated.
_SCORES = np.linspace(-4.0, 4.0, 33)


@dataclass(frozen=True)
class StatedSize:
    """Size for a fraction as a dataset states it, as v."""

    share: float  #: p [-]
    estimate: float  #: infinite if the bound does not rest on a line or an order statistic
    bound: float  #: with 95 % confidence, no larger than the estimate; minus infinity if none is known


@dataclass(frozen=True)
class Sampled:
    """Thresholds of simulated devices."""

    values: np.ndarray  #: increasing, infinite where a device does not stick (n,)
    stated_sizes: tuple[StatedSize, ...]  #: for the fraction after one touchdown, and after all of them
    reach: float = np.inf  #: end of the simulation
    floor: float = -np.inf  #: below which no surfaces hold a device
    flat: float = -np.inf  #: threshold on flat surfaces, the bound without a line and a statement
    surfaces_error: float = 0.0  #: standard error of all thresholds by the number of sampled surfaces
    is_bounded: bool = True  #: whether there are enough devices to state anything about few

    @cached_property
    def tail(self) -> TailFit | None:
        """Line through the lowest thresholds; none if too few devices stick."""
        within = np.where(self.values <= self.reach, self.values, np.inf)
        enough = min(np.isfinite(within).sum(), int(TAIL * len(within))) >= FEWEST
        return fit_tail(np.exp(within)) if enough and self.is_bounded else None

    @property
    def last(self) -> float:
        """Largest threshold that is known."""
        return float(min(self.reach, np.max(self.values, where=np.isfinite(self.values), initial=-np.inf)))

    def stated_for(self, share: float) -> StatedSize | None:
        """Statement for a fraction, none if there is none."""
        return next((size for size in self.stated_sizes if np.isclose(size.share, share, rtol=1e-9, atol=0)), None)

    def bound_for(self, share: float) -> float:
        """Bound for a fraction without a line."""
        size = self.stated_for(share)
        return self.flat if size is None else size.bound

    def moved(self, move: Callable[[np.ndarray], np.ndarray]) -> "Sampled":
        """Thresholds after a change that increases with them."""

        def end(v):
            """Finite end after the change."""
            return float(move(np.array(v))) if np.isfinite(v) else v

        sizes = tuple(StatedSize(size.share, end(size.estimate), end(size.bound)) for size in self.stated_sizes)
        ends = {name: end(getattr(self, name)) for name in ("reach", "floor", "flat")}
        return replace(self, values=move(self.values), stated_sizes=sizes, **ends)


@dataclass(frozen=True)
class Condition:
    """Thresholds in one set of circumstances, sampled or a bound by another route."""

    humidity: float  #: [-]
    shape: str  #: end state
    cause: Cause  #: ``Cause.ESTIMATE`` for a stated air; otherwise the step to which it belongs
    source: str  #: dataset
    sampled: Sampled | None = None
    bound: float = np.nan  #: threshold of all devices, where none is sampled
    shift: float = 0.0  #: of all thresholds
    error: float = 0.0  #: standard error of ``shift`` by the simulation, or of ``bound`` by its inputs
    is_stated: bool = True  #: whether the user stated its cause


@dataclass(frozen=True)
class World:
    """Draws of all conditions of a device.

    ``causes`` names the steps inside. The same draws are the same errors whatever the conditions and causes are.
    """

    conditions: tuple[Condition, ...]
    unknowns: Unknowns
    causes: frozenset[Cause]
    share: float  #: allowed fraction of stuck devices [-]
    touchdowns: int = 1
    draws: Draws = Draws(DRAWS, 0)
    exact: frozenset[str] = field(default_factory=frozenset)  #: groups of inputs that count as known
    stays: tuple[Stay, ...] = ()  #: without these, all touchdowns happen in the worst condition

    @cached_property
    def inside(self) -> tuple[Condition, ...]:
        """Conditions of the causes inside."""
        return tuple(
            condition
            for condition in self.conditions
            if condition.cause is Cause.ESTIMATE or condition.cause in self.causes
        )

    @property
    def _is_simulated(self):
        """Whether errors of the simulation are inside."""
        return Cause.SIMULATION in self.causes

    @property
    def _repeats(self):
        """Touchdowns that count."""
        return self.touchdowns if Cause.TOUCHDOWNS in self.causes else 1

    @property
    def _once(self):
        """Fraction of devices that may stick at each touchdown [-]."""
        return probability_for(self.share, self._repeats)

    @cached_property
    def _shifts(self):
        """Shift of every condition by the errors of the inputs, and by its own (conditions, draws)."""
        of_inputs = self.causes & {Cause.INPUTS, Cause.TEST_BEAMS}
        shifts = np.array([np.full(self.draws.number, condition.shift) for condition in self.inside])
        for row, condition in zip(shifts, self.inside, strict=True):
            if condition.error and (self._is_simulated if condition.sampled else of_inputs):
                row += condition.error * normal(self.draws, "shift", condition.source)
            if of_inputs:
                row += self.unknowns.shift((condition.humidity, condition.shape), self.draws, self.exact)
        return shifts

    @cached_property
    def _lines(self):
        """Intercepts and slopes of the tails of all sampled conditions, with the errors of the simulation."""
        return {
            k: self._line(condition.sampled)
            for k, condition in enumerate(self.inside)
            if condition.sampled and condition.sampled.tail
        }

    def _line(self, sampled):
        """Intercepts and slopes of one tail (draws,) each.

        The same draw is the same rank in all conditions. The least of their bounds then is one of all of them, whatever
        their errors have in common.
        """
        tail, slope = sampled.tail, max(sampled.tail.slope, _ALIKE)
        if not self._is_simulated:
            exact = np.full(self.draws.number, tail.intercept), np.full(self.draws.number, slope)
            return _to_stated(sampled, self._once, *exact)
        at, along = _pivots(tail.samples, tail.fitted, self.draws)
        slopes = slope / along
        intercepts = tail.intercept - at * slopes + sampled.surfaces_error * normal(self.draws, "surfaces")
        order = np.argsort(intercepts + slopes * ndtri(self._once))
        intercepts, slopes = _to_stated(sampled, self._once, intercepts, slopes)
        return intercepts[order], slopes[order]

    @cached_property
    def thresholds(self) -> np.ndarray:
        """Thresholds of the allowed fraction in every condition and draw (conditions, draws)."""
        score, rows = ndtri(self._once), []
        for k, condition in enumerate(self.inside):
            if k in self._by_line:
                intercepts, slopes = self._lines[k]
                rows.append(np.maximum(intercepts + slopes * score, condition.sampled.floor))
            else:
                rows.append(np.full(self.draws.number, self._bound(condition)))
        return np.array(rows) + self._shifts

    @cached_property
    def _by_line(self):
        """Conditions of which a line gives the threshold of the allowed fraction."""
        sizes = {k: self.inside[k].sampled.stated_for(self._once) for k in self._lines}
        return frozenset(k for k, size in sizes.items() if size is None or np.isfinite(size.estimate))

    @cached_property
    def _spread(self):
        """Parts of the mission if they count, each with the places of its conditions."""
        stays = self.stays if Cause.TOUCHDOWNS in self.causes else ()
        conditions_of_stays = [
            ([k for k, condition in enumerate(self.inside) if condition.humidity in stay.humidities], stay)
            for stay in stays
        ]
        return [(positions, stay.touchdowns) for positions, stay in conditions_of_stays if positions]

    def _after_all(self, once):
        """Fraction stuck after all touchdowns (draws,), from that of one in each condition (conditions, draws)."""
        if not self._spread:
            return stuck_after(once.max(axis=0), self._repeats)
        with np.errstate(divide="ignore"):  # all stick
            free = [number * np.log1p(-once[positions].max(axis=0)) for positions, number in self._spread]
        return -np.expm1(np.sum(free, axis=0))

    @cached_property
    def _together(self):
        """Values at which the allowed fraction is stuck in all conditions together (draws,).

        At the least threshold, the product over a mission is at most the power for all touchdowns in its worst air.
        """
        low = self.thresholds.min(axis=0)
        if not self._spread:
            return low
        finite = np.isfinite(low)
        low, high = np.where(finite, low, 0.0), np.maximum(low, self._ends)
        for _ in range(_HALVES):
            middle = np.where(finite, (low + high) / 2, 0.0)
            is_safe = self._after_all(self._at_most(middle)) <= self.share
            low, high = np.where(is_safe, middle, low), np.where(is_safe, high, middle)
        return np.where(finite, low, -np.inf)

    @cached_property
    def _ends(self):
        """Least value beyond which a condition says nothing (draws,)."""
        ends = [
            condition.sampled.last if k in self._by_line else self._bound(condition)
            for k, condition in enumerate(self.inside)
        ]
        return (np.array(ends)[:, None] + self._shifts).min(axis=0)

    def _bound(self, condition):
        """Threshold of the allowed fraction without a line."""
        return condition.sampled.bound_for(self._once) if condition.sampled else condition.bound

    def _at_most(self, v):
        """Fraction stuck at one touchdown in every condition that is safe to state at v (draws,): (conditions, draws).

        That is the allowed one up to a bound, none on what holds no device, and all beyond what is known.
        """
        rows = []
        for k, condition in enumerate(self.inside):
            at = v - self._shifts[k]
            if k in self._by_line:
                rows.append(np.where(at <= condition.sampled.last, self._stuck(k, at), 1.0))
            else:
                free = max(condition.sampled.flat, condition.sampled.floor) if condition.sampled else condition.bound
                rows.append(np.where(at <= free, 0.0, np.where(at <= self._bound(condition), self._once, 1.0)))
        return np.array(rows)

    @cached_property
    def _size(self):
        """Size to build as v, and the place of what decides: it is worst in most draws near the size."""
        least = self._together
        order, number = np.argsort(least), len(least)
        at = int((1 - CONFIDENCE) * number) if self._is_simulated else number // 2
        near = order[max(at - number // 100, 0) : at + number // 100]
        worst = self._most_stuck(near) if self._spread else self.thresholds[:, near].argmin(axis=0)
        return float(least[order[at]]), int(np.bincount(worst, minlength=len(self.inside)).argmax())

    def _most_stuck(self, near):
        """Places of the conditions with most stuck devices over the life, in some draws at their sizes."""
        once, counts = self._at_most(self._together)[:, near], np.zeros(len(self.inside))
        for positions, number in self._spread:
            counts[positions] += number
        return (counts[:, None] * once).argmax(axis=0)

    @property
    def size(self) -> float:
        """Size to build as v, with confidence where errors of the simulation are inside; minus infinity without any."""
        return self._size[0]

    @property
    def decides(self) -> Condition:
        """Condition that decides about the size."""
        return self.inside[self._size[1]]

    @property
    def is_extrapolated(self) -> bool:
        """Whether the size rests on a line beyond the fractions and the samples for which it was verified."""
        if self._size[1] not in self._by_line:
            return False
        return self._once < VERIFIED or len(self.decides.sampled.values) * self._once < DECADE

    def stuck(self, v: float) -> np.ndarray:
        """Fraction stuck at v in the worst sampled condition, or over a mission, in every draw (draws,)."""
        none = np.zeros(self.draws.number)
        rows = [
            self._stuck(k, v - self._shifts[k]) if condition.sampled else none
            for k, condition in enumerate(self.inside)
        ]
        return self._after_all(np.array(rows))

    def _stuck(self, k, at):
        """Fraction stuck at one touchdown in one condition at values (draws,): by counts, or a line where few stick.

        ASSUME: beyond the reach, devices that did not stick there do so in every second draw.
        """
        sampled = self.inside[k].sampled
        n, number = len(sampled.values), normal(self.draws, "counts")
        moved = at - sampled.surfaces_error * normal(self.draws, "surfaces")
        share = _counted(n, np.searchsorted(sampled.values, moved), number)
        if k in self._lines:
            intercepts, slopes = self._lines[k]
            end = sampled.values[sampled.tail.fitted - 1]
            line = ndtr((np.minimum(at, end) - intercepts) / slopes)
            share = np.where(at > end, np.maximum(share, line), line)
        if k not in self._by_line:
            share = np.where(at <= sampled.bound_for(self._once), np.minimum(share, self._once), share)
        share = np.where(at < sampled.floor, 0.0, share)
        return np.where((at > sampled.reach) & (normal(self.draws, "beyond") > 0), 1.0, share)

    @cached_property
    def first(self) -> float:
        """Value of v from which the fraction stuck has a lower end.

        Below it no simulated device sticks, all inputs as stated, and the band ends before that of one that does.
        """
        two_sided = (1 + CONFIDENCE) / 2
        fewest = min(len(condition.sampled.values) for condition in self.inside if condition.sampled)
        of_one = stuck_after(upper_bound(1, fewest, two_sided), self._repeats)

        def excess(v):
            """Upper end of the band at v above that of one device of all."""
            return np.quantile(self.stuck(v), two_sided) - of_one

        ends = [
            min(condition.sampled.values[0], condition.sampled.reach) + condition.shift
            for condition in self.inside
            if condition.sampled
        ]
        last = float(min(ends))
        if not np.isfinite(last) or excess(last) <= 0:
            return last
        low = last - 1
        while excess(low) > 0:
            low -= 1
        return float(brentq(excess, low, last))

    def least_bound(self, v: float) -> float:
        """Fraction below which no upper end goes at v, after all touchdowns [-].

        ASSUME: neither a line nor a bound by other routes states less than the fraction that was verified, or than the
        allowed one. Elsewhere none of n devices leave 3 / n (95 % confidence).
        """
        least = 0.0
        for k, condition in enumerate(self.inside):
            if condition.sampled:
                count = upper_bound(0, len(condition.sampled.values))
                is_stated = k in self._by_line or v <= _least(self.thresholds[k])
                least = max(least, min(VERIFIED, self._once, count) if is_stated else count)
        return float(stuck_after(least, self._repeats))


@lru_cache(maxsize=8)  # all airs and end states, and every step, ask for the same
def _pivots(samples, fitted, draws):
    """Intercepts and slopes of lines through the lowest of normal samples (draws,) each."""
    return simulated_lines(samples, fitted, stream(draws.seed, "answer", "tail"), draws.number)


@lru_cache(maxsize=8)
def _table(n):
    """Logits of Jeffreys' quantiles of fractions of n devices by the number stuck, at `_SCORES` (n + 1, scores)."""
    stuck = np.arange(n + 1)[:, None]
    return logit(betaincinv(stuck + 0.5, n - stuck + 0.5, ndtr(_SCORES)))


def _counted(n, stuck, scores):
    """Fractions by Jeffreys' distribution of counts of n devices (draws,), at normal scores (draws,).

    They increase with the counts in every draw, to one where all devices stick.
    """
    position = np.clip((scores - _SCORES[0]) / (_SCORES[1] - _SCORES[0]), 0, len(_SCORES) - 1.001)
    lower = position.astype(int)
    low, high = _table(n)[stuck, lower], _table(n)[stuck, lower + 1]
    return np.where(stuck < n, expit(low + (position - lower) * (high - low)), 1.0)


def _to_stated(sampled, share, intercepts, slopes):
    """Lines (draws,) with the median and the 5 % quantile of a stated bound. They turn about the end of the fit.

    A bound of order statistics, or one that is no larger than that in drier air, is not that of a line. Where nothing
    is stated for a fraction, no line passes what is stated for another one.
    """
    size = sampled.stated_for(share) or next(iter(sampled.stated_sizes), None)
    if size is None or not np.isfinite([size.estimate, size.bound]).all():
        return intercepts, slopes
    score, end = ndtri(size.share), ndtri(sampled.tail.fitted / sampled.tail.samples)
    draws = intercepts + slopes * score
    middle, least = np.median(draws), _least(draws)
    if sampled.stated_for(share) is None:
        return intercepts + min(0.0, (size.bound if middle > least else size.estimate) - least), slopes
    wider = (size.estimate - size.bound) / (middle - least) if middle > least else 0.0
    moved = size.estimate + (draws - middle) * wider
    if score < end - _APART:
        slopes = np.maximum((intercepts + slopes * end - moved) / (end - score), _ALIKE)
    return moved - slopes * score, slopes


def _least(draws):
    """5 % quantile of draws (draws,), one of them."""
    return np.sort(draws)[int((1 - CONFIDENCE) * len(draws))]

r"""Ratio of means in full contact to those on summits, from few strips on a fine grid and many on coarse ones.

A strip on a coarse grid is a control of the same strip on the fine grid: their ratio scatters by a percent, where that
to the sum over summits scatters by a third. A chain of levels, fine > coarse > summits, has the ratio of means

.. math:: R = \prod_i \frac{\bar x_i^{(n_i)}}{\bar x_{i+1}^{(n_i)}} , \quad
          \left(\frac{\sigma_R}{R}\right)^2 = \sum_i \frac{s_i^2}{n_i} ,

of the first n strips of each level, which has at least those of the finer ones. The numbers of least cost are
proportional to the scatter over the root of the cost. Few strips hardly show the scatter s, and the control chosen by
it is the luckiest: scatters are shrunk to believed ones, worth `WORTH` strips, and errors have Student's quantiles.

Where every control scatters too much, single strips decide. They are drawn in proportion to their values on summits,
and the ratio is the mean of theirs (M. H. Hansen and W. N. Hurwitz, Ann. Math. Stat. 14, 333 (1943)).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.special import stdtrit

from stiction.estimates import jackknife

#: Levels: the sum over summits, or full contact on every n-th point of the fine grid.
SUMMITS, FINE = 0, 1
#: Cost of a strip, in units of a fine one. On pairs a, b and c at RH 0.44 to 0.9, coarse grids cost 0.17 to 0.21 and
#: 0.07 to 0.09. Measured times would make results depend on the machine.
COSTS = {SUMMITS: 0.01, FINE: 1.0, 2: 0.2, 3: 0.08}
#: Believed relative scatter of a strip about its control. ASSUME: pessimistic. Pair b has 0.3, 0.01 and 0.03.
BELIEFS = {SUMMITS: 0.4, 2: 0.05, 3: 0.1}
#: Strips of the first round, and strips that a belief is worth.
PILOT, WORTH = 4, 4
#: Largest scatter of a control.
CONTROL = 0.1
#: Strips on the coarsest grid, from which the scatter of energies follows.
COARSE = 48
#: Most strips on the fine grid and on a coarse one.
MOST, MOST_COARSE = 64, 256
#: Strips drawn in proportion, at least and at most, and strips on summits among which they are.
FEWEST, POOL = 32, 500
#: ASSUME: factor of the errors of strips in proportion: without it, 32 of 60 strips of pair c are within one and two
#: errors in 0.66 and 0.90 of the cases.
HEAVY = 1.25
#: Confidence of two standard errors of a normal value, one-sided.
_TWO = 0.97725

#: Value of a strip at a level, by level and number; NaN where a coarse grid has none.
Value = Callable[[int, int], float]


@dataclass(frozen=True)
class Ratio:
    """Ratio of full contact to the sum over summits for the mean, and power of its scatter."""

    ratio: float  #: of the means [-]
    error: float  #: relative, half of what covers two standard errors by Student's t [-]
    power: float  #: ratio of the standard deviations of the logarithms, see `scatter_ratio` [-]
    power_error: float  #: standard error of the power [-]
    chain: tuple[int, ...]  #: levels, the fine one first
    strips: dict[int, int]  #: number of strips by level
    largest: float  #: part of one strip in the squared error, at most [-]


class Link(NamedTuple):
    """Ratio of means of two levels on the same strips."""

    ratio: float
    scatter: float  #: relative, of one strip about the ratio, shrunk [-]
    freedom: int  #: degrees of freedom of the scatter
    residuals: np.ndarray  #: relative, of each strip [-]

    @property
    def weight(self) -> float:
        """Part of a squared residual in the variance of the ratio [-]."""
        return 1 / (self.freedom * len(self.residuals))

    @property
    def variance(self) -> float:
        """Relative variance of the ratio [-]."""
        return self.scatter**2 / len(self.residuals)


def link(upper: np.ndarray, lower: np.ndarray, belief: float) -> Link:
    """Link of the first strips that both levels have, with the believed scatter."""
    n = min(len(upper), len(lower))
    ratio = upper[:n].mean() / lower[:n].mean()
    residuals = (upper[:n] - ratio * lower[:n]) / upper[:n].mean()
    freedom = n - 1 + WORTH
    return Link(ratio, float(np.sqrt((np.sum(residuals**2) + WORTH * belief**2) / freedom)), freedom, residuals)


def links(values: Mapping[int, np.ndarray], chain: Sequence[int]) -> list[Link]:
    """Links of a chain, from the values of the first strips by level."""
    return [link(values[a], values[b], BELIEFS[b]) for a, b in zip(chain, chain[1:], strict=False)]


def half_of_two(variances: Sequence[float], freedoms: Sequence[int]) -> float:
    """Half of the two-sigma error of a sum of independent parts, by Student's t.

    The degrees of freedom are those of F. E. Satterthwaite, Biometrics Bull. 2, 110 (1946).
    """
    total = np.sum(variances)
    if total == 0:
        return 0.0
    freedom = total**2 / np.sum(np.square(variances) / freedoms)
    return float(np.sqrt(total) * stdtrit(freedom, _TWO) / 2)


def numbers(chain: Sequence[int], scatters: Sequence[float], target: float) -> dict[int, int]:
    """Number of strips at each level of a chain but the last, for a relative error of the ratio at the least cost."""
    costs = np.array([COSTS[level] for level in chain[:-1]])
    total = np.sum(scatters * np.sqrt(costs)) / target**2
    needed = np.ceil(scatters / np.sqrt(costs) * total).astype(int)
    return dict(zip(chain, np.maximum.accumulate(np.maximum(needed, PILOT)).tolist(), strict=False))


def cheapest(values: Mapping[int, np.ndarray], target: float) -> tuple[tuple[int, ...], dict[int, int]]:
    """Chain with the least cost of a target, and its numbers of strips."""
    grids, chains = sorted(set(values) - {SUMMITS, FINE}), []
    for size in range(len(grids) + 1):
        for between in combinations(grids, size):
            chain = (FINE, *between, SUMMITS)
            of_chain = links(values, chain)
            widening = half_of_two([each.variance for each in of_chain], [each.freedom for each in of_chain])
            widening /= np.sqrt(sum(each.variance for each in of_chain))
            needed = numbers(chain, np.array([each.scatter for each in of_chain]), target / widening)
            chains.append((sum(COSTS[level] * number for level, number in needed.items()), chain, needed))
    return min(chains)[1:]


def by_levels(value: Value, grids: Sequence[int], target: float) -> Ratio | None:
    """Ratio from a chain of levels with a relative error, from as many strips as that needs. None without a control.

    Strips on each level at most double in a round.
    """
    usable = [grid for grid in grids if np.isfinite([value(grid, k) for k in range(PILOT)]).all()]
    counts = dict.fromkeys((FINE, *usable), PILOT)
    if usable:
        counts[max(usable)] = COARSE
    while True:
        values = {level: np.array([value(level, k) for k in range(number)]) for level, number in counts.items()}
        values = {level: of_level for level, of_level in values.items() if level == FINE or (of_level > 0).all()}
        counts = {level: counts[level] for level in values}
        values[SUMMITS] = np.array([value(SUMMITS, k) for k in range(max(counts.values()))])
        if min(link(values[FINE], values[grid], BELIEFS[grid]).scatter for grid in values if grid != FINE) > CONTROL:
            return None
        chain, needed = cheapest(values, target)
        ratio = _of_chain(values, chain)
        next_counts = {level: min(number, 2 * counts[level], _most(level)) for level, number in needed.items()}
        if ratio.error <= target or all(number <= counts[level] for level, number in next_counts.items()):
            return ratio
        counts |= {level: max(number, counts[level]) for level, number in next_counts.items()}
        counts |= {level: max(counts[level], counts[FINE]) for level in counts}


def _most(level):
    """Most strips of a level."""
    return MOST if level == FINE else MOST_COARSE


def _of_chain(values, chain):
    """Ratio of a chain, with the power of the level with the most strips."""
    of_chain = links(values, chain)
    error = half_of_two([each.variance for each in of_chain], [each.freedom for each in of_chain])
    level = max(set(values) - {SUMMITS}, key=lambda each: (len(values[each]), -each))
    n = len(values[level])
    power, power_error = scatter_ratio(values[level], values[SUMMITS][:n], np.ones(n))
    total = sum(each.variance for each in of_chain)
    largest = max(np.max(each.residuals**2) * each.weight for each in of_chain) / total
    ratio = float(np.prod([each.ratio for each in of_chain]))
    strips = {each: len(values[each]) for each in values}
    return Ratio(ratio, error, power, power_error, chain, strips, float(largest))


def scatter_ratio(full: np.ndarray, summits: np.ndarray, weights: np.ndarray) -> tuple[float, float]:
    r"""Ratio of the standard deviations of ln e of full contact and of summits, and its jackknife error. Arrays (n,).

    As in `stiction.analysis.model_error.tip_ratios`, both are log-normal with :math:`s^2 = \ln (\overline{e^2} / \bar
    e^2)`: strips with next to no energy hold no beam, but decide the deviation of the logarithm itself. Over 300 strips
    of pair b at RH 0.44, the error is half as large, and the 98 % quantile closer.
    """
    columns = [weights, *(weights * each**power for each in (full, summits) for power in (1, 2))]

    def ratio(means):
        """Ratio from the weighted means and mean squares."""
        first, second = means[1:].reshape(2, 2).T / means[0]
        return np.sqrt(np.divide(*np.log(second / first**2)))

    value, error = jackknife(ratio, np.transpose(columns))
    return float(value), float(error)


def in_proportion(value: Value, target: float, rng: np.random.Generator) -> Ratio:
    """Ratio from strips drawn in proportion to their values on summits, twice as many until it has a relative error."""
    summits = np.array([value(SUMMITS, k) for k in range(POOL)])
    drawn, number = rng.choice(POOL, 2 * MOST, p=summits / summits.sum()), FEWEST
    while True:
        full, of_drawn = np.array([value(FINE, k) for k in drawn[:number]]), summits[drawn[:number]]
        ratios = full / of_drawn
        residuals = ratios / ratios.mean() - 1
        variance = HEAVY**2 * np.sum(residuals**2) / (number - 1) * (1 / number + 1 / POOL)
        error = half_of_two([variance], [number - 1])
        if error <= target or number >= len(drawn):
            break
        number *= 2
    power, power_error = scatter_ratio(full, of_drawn, 1 / of_drawn)
    of_strip = np.bincount(drawn[:number], residuals**2)
    largest = float(of_strip.max() / max(of_strip.sum(), np.finfo(float).tiny))
    strips = {FINE: number, SUMMITS: POOL}
    return Ratio(float(ratios.mean()), error, power, power_error, (FINE, SUMMITS), strips, largest)


def ratio_of_means(value: Value, grids: Sequence[int], target: float, rng: np.random.Generator) -> Ratio:
    """Ratio by levels, or from strips in proportion where no control scatters little enough."""
    return by_levels(value, grids, target) or in_proportion(value, target, rng)

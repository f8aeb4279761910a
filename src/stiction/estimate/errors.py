"""Errors of the estimate on surfaces that were not learnt, and the intervals that follow from them."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import betaincinv

from stiction.estimate.answer import difficulty
from stiction.estimate.design import Point
from stiction.estimate.length import NAMES, Lengths, NotLearnt, lengths
from stiction.estimate.rows import of_tips, states_of, stored
from stiction.estimate.table import Surrogate
from stiction.estimate.training import FACTORS

#: Numbers between which the rest of `stiction.estimate.answer.difficulty` is found.
_RESTS = 1e-3, 1.0


@dataclass(frozen=True)
class Tested:
    """Length of a surface that was not learnt, by its tips in full contact as of a run and by the estimate."""

    surface: int
    slope: float  #: of the estimate, NaN where it refuses
    true: float  #: [m]
    estimate: float  #: NaN where the estimate refuses [m]

    @property
    def is_known(self) -> bool:
        """Whether the estimate does not refuse."""
        return not math.isnan(self.estimate)

    @property
    def error(self) -> float:
        """Logarithm of the true length over the estimate."""
        return math.log(self.true / self.estimate)

    def score(self, rest: float) -> float:
        """Size of the error over its difficulty."""
        return abs(self.error) / difficulty(self.slope, rest)


#: Processes of tips on summits and in full contact that have not learnt a point.
Processes = Callable[[Point], tuple[Surrogate, Surrogate]]


def tested(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of some sets at a normal score up to -2, in the first air, by the full contact that settles."""
    for point, numbers in stored(folder, sets):
        if "changed" not in numbers or not np.isfinite(numbers["changed"]).all():
            continue
        state = states_of(point, numbers["airs"][:1], modulus)[0][FACTORS.index(1.0)]
        true = _of_tips(numbers["changed"]).at(score)
        try:
            found = lengths(state, 1.0, *processes(point))
        except NotLearnt:
            yield Tested(point.number, math.nan, true, math.nan)
        else:
            yield Tested(point.number, found.slope, true, found.at(score))


def _of_tips(slopes):
    """Lengths over a gap of 1 m by the slopes of tips (n,)."""
    quantities = of_tips(slopes)
    logarithms = (math.log(1.5) + quantities[name] for name in NAMES[:3])
    return Lengths(tuple(logarithms), quantities["slope"])


def rest_of(found: Sequence[Tested]) -> float:
    r"""Rest r of the difficulty, of greatest likelihood where errors are normal with a scatter in proportion to it.

    It minimises :math:`\frac 1 2 \ln \overline{(\epsilon / d)^2} + \overline{\ln d}`, with :math:`d^2 = s^2 + r^2`.
    """
    slopes, errors = np.array([(one.slope, one.error) for one in found if one.is_known]).T

    def cost(logarithm):
        """Negative logarithm of the likelihood of one error, the scatter at its best."""
        of_all = np.hypot(slopes, math.exp(logarithm))
        return 0.5 * np.log(np.mean((errors / of_all) ** 2)) + np.log(of_all).mean()

    ends = tuple(map(math.log, _RESTS))
    return math.exp(minimize_scalar(cost, bounds=ends, method="bounded").x)


def conformal(errors: np.ndarray, confidence: float) -> float:
    """Half of a split conformal interval, from errors on surfaces (n,), infinite where they are too few."""
    rank = math.ceil(confidence * (len(errors) + 1))
    return float(np.sort(np.abs(errors))[rank - 1]) if rank <= len(errors) else math.inf


def scores(found: Sequence[Tested], rest: float) -> np.ndarray:
    """Sizes of errors over their difficulties on the surfaces that the estimate does not refuse."""
    return np.array([one.score(rest) for one in found if one.is_known])


def coverage(inside: int, number: int, confidence: float = 0.95) -> tuple[float, float]:
    """Ends of the share inside, from the number of surfaces inside: C. J. Clopper, E. S. Pearson, Biometrika 26, 404.

    Examples
    --------
    >>> [round(end, 3) for end in coverage(9, 10)]
    [0.555, 0.997]
    """
    tail, out = (1 - confidence) / 2, number - inside
    low = float(betaincinv(inside, out + 1, tail)) if inside else 0.0
    return low, float(betaincinv(inside + 1, out, 1 - tail)) if out else 1.0

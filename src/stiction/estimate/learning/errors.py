"""Errors of the estimate on surfaces that were not learnt, and the intervals that follow from them."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import betaincinv

from stiction.devices.risk import CONFIDENCE
from stiction.estimate.answer import CONFIDENCES, TO_USE, difficulty
from stiction.estimate.bridge import lengths as lengths_of_bridges
from stiction.estimate.bridge import over_flooded
from stiction.estimate.force import reciprocals
from stiction.estimate.learning import patches, training
from stiction.estimate.learning.bridge_rows import TAIL, of_middle, with_changes
from stiction.estimate.learning.bridge_rows import states_of as states_of_bridges
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.rows import change_of, of_forces, of_tips, patches_of, states_of, stored
from stiction.estimate.learning.training import FACTORS, changes_of
from stiction.estimate.length import NAMES, Lengths, NotLearnt, lengths
from stiction.estimate.promise import kept
from stiction.estimate.state import PatchState, TipState
from stiction.estimate.table import Surrogate
from stiction.streams import stream

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
        """Error over its difficulty, negative on the unsafe side."""
        return self.error / difficulty(self.slope, rest)


#: Processes of tips on summits and in full contact that have not learnt a point.
Processes = Callable[[Point], tuple[Surrogate, Surrogate]]


def settled_tips(folder: Path, sets: str, modulus: float) -> Iterator[tuple[Point, TipState, Lengths]]:
    """Tips of some sets in their first air, with their lengths over the gap by the full contact that settles."""
    for point, numbers in stored(folder / training.FOLDER, sets):
        if "changed" in numbers and np.isfinite(numbers["changed"]).all():
            state = states_of(point, numbers["airs"][:1], modulus)[0][FACTORS.index(1.0)]
            yield point, state, lengths_of(of_tips(numbers["changed"]), math.log(1.5))


def settled_patches(folder: Path, sets: str, modulus: float) -> Iterator[tuple[Point, PatchState, Lengths]]:
    """Patches of some sets in their first air, with the reciprocals of their forces [N⁻¹], as `settled_tips`."""
    for point, numbers in stored(folder / patches.FOLDER, sets):
        if np.isfinite(numbers.get("ratio", np.nan)):
            patch, pressures = patches_of(point, numbers, modulus)[0], numbers["forces"][0].astype(float)
            changed = change_of(numbers).of(pressures)(pressures)
            yield point, patch, lengths_of(of_forces(changed, patch), -math.log(patch.flooded_force))


def tested(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of some sets at a normal score up to -2, in the first air, by the full contact that settles."""
    for point, state, true in settled_tips(folder, sets, modulus):
        yield beside(point, true, score, lambda state=state, at=point: lengths(state, 1.0, *processes(at)))


def tested_forces(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Reciprocals of forces of some sets, as `tested`."""
    for point, patch, true in settled_patches(folder, sets, modulus):
        yield beside(point, true, score, lambda patch=patch, at=point: reciprocals(patch, *processes(at)))


def tested_bridges(folder: Path, sets: str, modulus: float, score: float, processes: Processes) -> Iterator[Tested]:
    """Lengths of bridges without stress that are held as well as those under it, of some sets, as `tested`."""
    for point, numbers in with_changes(folder, sets, TAIL):
        state, *_ = states_of_bridges(point, numbers, modulus)
        true = lengths_of(of_middle(state, numbers["changed"]), math.log(state.flooded_length))
        yield beside(point, true, score, lambda state=state, at=point: lengths_of_bridges(state, *processes(at)))


def longest_tested(folder: Path, sets: str, modulus: float, *processes: Surrogate) -> float:
    """Largest of `stiction.estimate.bridge.over_flooded` of the bridges of some sets that are tested."""
    ratios = []
    for point, numbers in with_changes(folder, sets, TAIL):
        state, *_ = states_of_bridges(point, numbers, modulus)
        with suppress(NotLearnt):
            ratios.append(over_flooded(state, lengths_of_bridges(state, *processes)))
    return max(ratios)


def beside(point: Point, true: Lengths, score: float, estimate: Callable[[], Lengths]) -> Tested:
    """Tested length of a point at a score."""
    try:
        distribution = estimate()
    except NotLearnt:
        return Tested(point.number, math.nan, true.at(score), math.nan)
    return Tested(point.number, distribution.slope, true.at(score), distribution.at(score))


def lengths_of(quantities: Mapping[str, float], shift: float) -> Lengths:
    """Lengths by the quantities of tips or patches, whose logarithms are shifted."""
    return Lengths(tuple(quantities[name] + shift for name in NAMES[:3]), quantities["slope"])


def rest_of(surfaces: Sequence[Tested]) -> float:
    r"""Rest r of the difficulty, of greatest likelihood where errors are normal with a scatter in proportion to it.

    It minimises :math:`\frac 1 2 \ln \overline{(\epsilon / d)^2} + \overline{\ln d}`, with :math:`d^2 = s^2 + r^2`.
    """
    slopes, errors = np.array([(surface.slope, surface.error) for surface in surfaces if surface.is_known]).T

    def cost(logarithm):
        """Negative logarithm of the likelihood of one error, the scatter at its best."""
        of_all = np.hypot(slopes, math.exp(logarithm))
        return 0.5 * np.log(np.mean((errors / of_all) ** 2)) + np.log(of_all).mean()

    ends = tuple(map(math.log, _RESTS))
    return math.exp(minimize_scalar(cost, bounds=ends, method="bounded").x)


def conformal(sizes: np.ndarray, confidence: float) -> float:
    """Split conformal bound of a further size of an error, from those on surfaces (n,), infinite if they are too few.

    Sizes are absolute for half of an interval, or on one side for one of its ends.
    """
    rank = math.ceil(confidence * (len(sizes) + 1))
    return float(np.sort(sizes)[rank - 1]) if rank <= len(sizes) else math.inf


def margins_of(errors: np.ndarray) -> dict[str, float]:
    """Margins of intervals by confidence, and that to the end to use, from errors over their difficulties (n,).

    The last is no less than that of both sides. It keeps its promise for errors of any law, see
    `stiction.estimate.promise`.
    """
    both = {name: conformal(np.abs(errors), float(name) / 100) for name in CONFIDENCES}
    first = CONFIDENCES[0]
    return both | {TO_USE: max(both[first], conformal(-errors, kept(first) / 100))}


def scores(surfaces: Sequence[Tested], rest: float) -> np.ndarray:
    """Errors over their difficulties on the surfaces that the estimate does not refuse (n,)."""
    return np.array([surface.score(rest) for surface in surfaces if surface.is_known])


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


#: Draws of a bootstrap.
_DRAWS = 200


def noise_of(folder: Path, sets: str, score: float) -> np.ndarray:
    """Standard errors of the logarithm of a length as of a run, by its strips in full contact and by its tips (n, 2).

    Of all points of some sets whose full contact settles. By the bootstrap: B. Efron, Ann. Stat. 7, 1 (1979).
    """
    errors, rng = [], stream(0, "estimate", "bootstrap")
    for _, numbers in stored(folder / training.FOLDER, sets):
        if "changed" in numbers and np.isfinite(numbers["changed"]).all():
            errors.append((_noise_of_strips(numbers, score, rng), _noise_of_tips(numbers["changed"], score, rng)))
    return np.array(errors)


def _noise_of_tips(slopes, score, rng):
    """Noise of the length of tips (n,)."""
    drawn = rng.choice(slopes, (_DRAWS, len(slopes)))
    return float(np.std([math.log(lengths_of(of_tips(each), 0.0).at(score)) for each in drawn]))


def _noise_of_strips(numbers, score, rng):
    """Noise of the length by the upper end of the change that a run applies at the slope of its tips."""
    slope = 1 / lengths_of(of_tips(numbers["changed"]), 0.0).at(score)
    near = int(np.argmin(np.abs(np.log(numbers["slope"] / slope))))
    forces = [numbers[name][:, near] for name in ("full", "summits")]
    ratios = []
    for _ in range(_DRAWS):
        drawn = (rng.choice(each, len(each))[:, None] for each in forces)
        ratios.append(changes_of(np.ones(1), *drawn).change.at_most(CONFIDENCE).ratio.item())
    return float(np.std(np.log(ratios))) * _power(numbers["slopes"][0])


def _power(slopes):
    """Power with which lengths fall with attractions, from slopes of tips (FACTORS, n)."""
    ends = [FACTORS.index(end(FACTORS)) for end in (min, max)]
    return float(np.log(np.divide(*(np.median(slopes[k]) for k in ends))) / math.log(max(FACTORS) / min(FACTORS)))

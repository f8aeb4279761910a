r"""Force laws of the strips in a row under a beam.

Strips are independent draws from a chaos model of their force laws, with two exceptions.

A polynomial does not follow rare strong strips, such as one of 500 that holds 44 times the mean energy. Where the model
loses mean or scatter of the adhesion energy, the strips are drawn from the samples themselves, with replacement.

Where long waves raise or lower whole strips, neighbours are alike. ASSUME: a strip repeats the law of its neighbour
with a probability ρ, so laws k strips apart are correlated by :math:`\rho^k`. The law of one strip keeps its
distribution. Adhesion is correlated less than the mean heights that set ρ: on fields of 40 or 60 strips of three pairs
with mean heights correlated by 0.44 to 0.52, works of neighbours (`stiction.devices.sampling`) are correlated by 0.04
to 0.43, energies and pull-off forces by 0.18 at most. Lengths come out at or below those on these fields, the safe
side; those of independent strips are 6 to 8 % longer (1 in 10) where works are correlated by 0.3 or 0.4.

A beam above a surface that it follows (`stiction.surface.replica`) moves in its plane as one body. ASSUME: its strips
are drawn from the samples with the nearest displacements, no larger than its own: adhesion decreases with displacement.
"""

import math
from collections.abc import Callable
from functools import partial

import numpy as np

#: Number of draws for the comparison of model and samples, and smallest ratios of the mean and of the standard
#: deviation of the adhesion energy. 2 % of the mean energy is 0.5 % of a length.
DRAWS, LEAST_MEAN, LEAST_SCATTER = 20_000, 0.98, 0.9
#: Probability to repeat a law below which strips count as independent. That of the pairs of the paper is below 0.02,
#: and below 0.05 on strips of 0.5 µm under bridges.
INDEPENDENT = 0.1
#: Share of the samples from which the strips of one beam above its copy are drawn, and their least number.
NEAREST, FEWEST = 0.02, 20
#: Draw of force laws: ``(number, rng) -> (number, 4)`` [SI].
Draw = Callable[[int, np.random.Generator], np.ndarray]


def is_narrow(drawn: np.ndarray, sampled: np.ndarray) -> bool:
    """Whether energies (n,) of a model lack mean or scatter of the energies of its samples (m,)."""
    return bool(drawn.mean() < LEAST_MEAN * sampled.mean() or drawn.std() < LEAST_SCATTER * sampled.std())


def resampled(laws: np.ndarray, number: int, rng: np.random.Generator) -> np.ndarray:
    """Draw force laws of samples (m, 4) with replacement, (number, 4)."""
    return laws[rng.integers(len(laws), size=number)]


def drawn_from(laws: np.ndarray, displacements: np.ndarray | None) -> Draw:
    """Draw from samples (m, 4): of one body if they have displacements, see `of_one_body`, otherwise `resampled`."""
    return partial(resampled, laws) if displacements is None else of_one_body(laws, displacements)


def of_one_body(laws: np.ndarray, displacements: np.ndarray) -> Draw:
    """Draw whose laws are those of one beam, from samples (m, 4) with displacements (m,) [m]."""
    return partial(_of_one_body, laws[np.argsort(displacements, kind="stable")])


def in_register(laws: np.ndarray, displacements: np.ndarray) -> Draw:
    """Draw from the samples (m, 4) nearest to their register: those of the body that moved least."""
    return partial(resampled, laws[np.argsort(displacements, kind="stable")][: _nearest(len(laws))])


def _nearest(samples):
    """Number of samples of one beam."""
    return min(max(math.ceil(NEAREST * samples), FEWEST), samples)


def _of_one_body(laws, number, rng):
    """Laws of the strips of one beam (number, 4), from samples in the order of their displacements."""
    nearest = _nearest(len(laws))
    end = max(int(rng.integers(len(laws))) + 1, nearest)
    return resampled(laws[end - nearest : end], number, rng)


def repetition(correlations: np.ndarray) -> float:
    """Probability to repeat the law of a neighbour, from correlations of mean heights 1, 2, ... strips apart (n,) [-].

    It is the smallest with which means over any number of strips scatter as much as with these correlations: their
    variance has sums of the correlations of the first strips. Zero counts as independent.

    Examples
    --------
    >>> repetition(np.array([0.5, 0.0])), repetition(np.array([0.5, 0.4])), repetition(np.array([0.05]))
    (0.5, 0.573, 0.0)
    """
    grid = np.arange(1001) / 1000
    of_chain = np.cumsum(grid[:, None] ** np.arange(1, len(correlations) + 1), axis=1)
    suffices = np.all(of_chain >= np.cumsum(correlations), axis=1)
    probability = float(grid[np.argmax(suffices)])
    return probability if probability >= INDEPENDENT else 0.0


def in_row(draw: Draw, repetition: float, arms: int) -> Draw:
    """Draw in which strips repeat the law of their neighbour with a probability.

    Strips are in the order in which a beam with this number of arms draws them: along it, or from the middle of a
    bridge outwards, on both sides in turn.
    """
    return partial(_in_row, draw, repetition, arms) if repetition else draw


def _in_row(draw, repetition, arms, number, rng):
    """Laws of a number of strips (number, 4)."""
    laws, repeats = draw(number, rng), rng.random(number) < repetition
    source = np.where(repeats, 0, np.arange(number))
    for arm in range(arms):
        source[arm::arms] = np.maximum.accumulate(source[arm::arms])
    return laws[source]

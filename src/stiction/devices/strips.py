r"""Force laws of the strips in a row under a beam.

Strips are independent draws from a chaos model of their force laws, with two exceptions.

A polynomial does not follow rare strong strips, such as one of 500 that holds 44 times the mean energy. Where the model
loses mean or scatter of the adhesion energy, the strips are drawn from the samples themselves, with replacement.

Where heights are correlated over more than three strips, neighbours are alike. ASSUME: all strips within the
correlation length have the same law; these blocks begin at a random place under every beam. The law of one strip keeps
its distribution, and patches of several strips scatter more than on the real surface. Cracks stop earlier, and lengths
come out too short, the safe side.
"""

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from stiction.rounding import is_at_most

#: Number of draws for the comparison of model and samples, and smallest ratios of the mean and of the standard
#: deviation of the adhesion energy. 2 % of the mean energy is 0.5 % of a length.
DRAWS, LEAST_MEAN, LEAST_SCATTER = 20_000, 0.98, 0.9
#: Strips over which heights may be correlated while the adhesion of neighbours is not. Measured on strips of 1.5 µm:
#: the correlation of ln e is zero within 0.07 if heights are over 2.9 of them, and 0.25 to 0.34 if they are over 5.5.
INDEPENDENT = 3
#: Draw of force laws: ``(number, rng) -> (number, 4)`` [SI].
Draw = Callable[[int, np.random.Generator], np.ndarray]


def is_narrow(drawn: np.ndarray, sampled: np.ndarray) -> bool:
    """Whether energies (n,) of a model lack mean or scatter of the energies of its samples (m,)."""
    return bool(drawn.mean() < LEAST_MEAN * sampled.mean() or drawn.std() < LEAST_SCATTER * sampled.std())


def resampled(laws: np.ndarray, number: int, rng: np.random.Generator) -> np.ndarray:
    """Draw force laws of samples (m, 4) with replacement, (number, 4)."""
    return laws[rng.integers(len(laws), size=number)]


def alike(correlated: float, strip: float) -> int:
    """Number of neighbouring strips with one law, from the correlation length of the heights and the strip length [m].

    Examples
    --------
    >>> alike(0.7e-6, 1.5e-6), alike(4.4e-6, 1.5e-6), alike(7.7e-6, 1.5e-6)
    (1, 1, 6)
    """
    return 1 if is_at_most(correlated, INDEPENDENT * strip) else math.ceil(correlated / strip)


def in_blocks(draw: Draw, alike: int) -> Draw:
    """Draw in which this number of neighbours have the same law. The first block is cut at random."""
    return partial(_blocks, draw, alike) if alike > 1 else draw


def _blocks(draw, alike, number, rng):
    """Laws of a number of strips in blocks (number, 4)."""
    cut = int(rng.integers(alike))
    laws = draw(-(-(number + cut) // alike), rng)
    return np.repeat(laws, alike, axis=0)[cut : cut + number]

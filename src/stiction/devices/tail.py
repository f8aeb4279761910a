"""Short end of a distribution of lengths: small quantiles, from few samples.

The logarithms of the lowest 5 % of the lengths are fitted by a line over the normal score, as if the end of the
distribution, and only that, were lognormal. S-shapes, tips and bridges of the paper's pair b follow such a line down to
a share of 1e-4 at least, as 110 000, 200 000 and 100 000 of them show.
"""

import pickle
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import ndtri

#: Share of the samples that is fitted.
TAIL = 0.05
#: Smallest number of fitted samples, so that 200 samples can be fitted without one of the 20 groups of a jackknife.
FEWEST = 9


@dataclass(frozen=True)
class TailFit:
    """Line ln l = intercept + slope z over the normal score z."""

    intercept: float  #: ln l at z = 0 [-], l in m
    slope: float  #: [-]
    samples: int  #: number n of all samples
    fitted: int  #: number of the lowest ones that are fitted

    def logarithm(self, share: float) -> float:
        """Logarithm of `length`."""
        return float(self.intercept + self.slope * ndtri(share))

    def length(self, share: float) -> float:
        """Quantile of all lengths at a share [m]."""
        return float(np.exp(self.logarithm(share)))


def normal_scores(samples: int, fitted: int | None = None) -> np.ndarray:
    """Normal scores of the ``fitted`` lowest of ``samples``, by default the share ``TAIL``, by Blom's positions."""
    ranks = np.arange(1, (int(TAIL * samples) if fitted is None else fitted) + 1)
    return ndtri((ranks - 0.375) / (samples + 0.25))


def _lines(logarithms, scores):
    """Intercepts and slopes of least-squares lines through rows of ``logarithms`` (..., k)."""
    centred = scores - scores.mean()
    slopes = logarithms @ centred / (centred @ centred)
    return logarithms.mean(axis=-1) - slopes * scores.mean(), slopes


def fit_tail(lengths: np.ndarray, fraction: float = TAIL) -> TailFit:
    """Fit the lowest ``fraction`` of n lengths (n,) [m], by default 5 %, or the known, finite ones among them.

    Raises
    ------
    ValueError
        If fewer than ``FEWEST`` lengths are fitted.
    """
    samples, finite = len(lengths), int(np.isfinite(lengths).sum())
    if int(fraction * samples) < FEWEST:
        raise ValueError(f"a fit of the lowest {fraction:.0%} needs {round(FEWEST / fraction)} lengths, got {samples}")
    if finite < FEWEST:
        raise ValueError(f"a fit of the shortest lengths needs {FEWEST} of them, got {finite}")
    fitted = min(int(fraction * samples), finite)
    intercept, slope = _lines(np.log(np.sort(lengths)[:fitted]), normal_scores(samples, fitted))
    return TailFit(float(intercept), float(slope), samples, fitted)


def scaled_errors(
    samples: int, share: float, rng: np.random.Generator, repeats: int = 2000, fitted: int | None = None
) -> np.ndarray:
    """Errors of fitted logarithms of a length, in units of the true slope and of the fitted one, (2, repeats).

    For a distribution that is lognormal at its end, the fit is equivariant, so that the errors do not depend on the
    distribution. They are simulated from the lowest order statistics of ``samples`` normal numbers, of which as many
    are ``fitted`` as by `normal_scores`.
    """
    intercepts, slopes, rng.bit_generator.state = _simulated_lines(samples, pickle.dumps(rng), repeats, fitted)
    errors = intercepts + (slopes - 1) * ndtri(share)
    return np.array([errors, errors / slopes])


@lru_cache(maxsize=64)  # a device asks for the same lines for every share, shape and error of the surfaces
def _simulated_lines(samples, generator, repeats, fitted):
    """Intercepts and slopes of simulated lines from a pickled generator, and its state after them."""
    rng = pickle.loads(generator)
    return *simulated_lines(samples, fitted, rng, repeats), rng.bit_generator.state


def simulated_lines(
    samples: int, fitted: int | None, rng: np.random.Generator, repeats: int
) -> tuple[np.ndarray, np.ndarray]:
    """Intercepts and slopes of lines through the lowest of ``samples`` normal numbers (repeats,) each.

    As many are ``fitted`` as by `normal_scores`.
    """
    scores = normal_scores(samples, fitted)
    k = len(scores)
    sums = np.cumsum(rng.exponential(size=(repeats, k)), axis=1)
    beyond = rng.gamma(samples + 1 - k, size=(repeats, 1))
    return _lines(ndtri(sums / (sums[:, -1:] + beyond)), scores)

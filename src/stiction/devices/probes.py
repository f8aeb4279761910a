r"""Probes: the place of a measured pull-off force among the forces of sampled places.

A measurement with the normal error :math:`\varepsilon` of a force F gives at most M with the probability

.. math:: P = E \, [ \, G(e^s (M + \varepsilon)) \, ] ,

with the distribution G of the sampled places, and the error s of the logarithm of all forces by the inputs.

ASSUME: the measurement is that of one place, or a mean that scatters less: the force of any single place then covers
it, on the side that calls a misfit a fit.
"""

import numpy as np
from scipy.special import betaincinv, ndtr, ndtri

#: Fraction of forces further out than a measurement, on both sides, below which it does not fit.
UNLIKELY = 0.05
#: Quantiles of the normal errors of a measurement.
_SCORES = ndtri((np.arange(199) + 0.5) / 199)


def shares_below(forces: np.ndarray, shifts: np.ndarray, measured: float, error: float = 0.0) -> np.ndarray:
    """Fraction of measurements that give no more than one [N] with a standard error [N], for each shift (draws,) [-].

    From the forces of sampled places (n,) [N], which fall by the factor exp(-shift). Ties count half.

    Examples
    --------
    >>> shares_below(np.array([1.0, 3.0]), np.log([1.0, 2.0, 4.0]), 2.0).round(12)
    array([0.5, 1. , 1. ])
    """
    ordered = np.sort(forces)
    at = np.exp(shifts)[:, None] * (measured + error * (_SCORES if error else np.zeros(1)))
    counts = [np.searchsorted(ordered, at.ravel(), side) for side in ("left", "right")]
    return np.mean(counts, axis=0).reshape(at.shape).mean(axis=1) / len(forces)


def counted(share: float | np.ndarray, places: int, scores: float | np.ndarray) -> np.ndarray:
    """Fraction of all places at normal scores of its error, where one of some sampled places is known [-].

    By Jeffreys' distribution, which also covers fractions between whole counts: these scatter less.

    Examples
    --------
    >>> counted(0.0, 600, np.array([-1.96, 1.96])).round(4), float(counted(0.5, 100, 0.0))
    (array([0.    , 0.0042]), 0.5)
    """
    fraction = betaincinv(places * share + 0.5, places * (1 - share) + 0.5, ndtr(scores))
    fraction = np.where((share <= 0) & (scores < 0), 0.0, fraction)
    return np.where((share >= 1) & (scores > 0), 1.0, fraction)


def two_sided(share: float | np.ndarray) -> float | np.ndarray:
    """Twice the smaller of a fraction and the rest [-]."""
    return 2 * np.minimum(share, 1 - np.asarray(share))


def quantile(forces: np.ndarray, share: float, shifts: np.ndarray, scores: np.ndarray) -> np.ndarray:
    """Force that a fraction of all places holds at most, by shifts and normal scores of their errors (draws,) [N]."""
    places = len(forces)
    ranks = places * betaincinv(places * share, places * (1 - share), ndtr(scores)) - 0.5
    return np.exp(-shifts) * np.interp(ranks, np.arange(places), np.sort(forces))

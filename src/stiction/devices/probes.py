"""Probes: whether a measured pull-off force fits the forces of sampled places.

ASSUME: the measurement is that of one place, or a mean that scatters less: the force of any single place then covers
it, on the side that calls a misfit a fit. Errors of the inputs move the logarithm of all forces alike.
"""

import numpy as np
from scipy.special import ndtri

#: Fraction of forces further out than a measurement, on both sides, below which it does not fit.
UNLIKELY = 0.05
#: Quantiles of the normal errors.
_SCORES = ndtri((np.arange(99) + 0.5) / 99)


def share_above(forces: np.ndarray, relative_error: float, measured: float, error: float) -> float:
    """Probability that a place holds more than was measured [-].

    From forces of sampled places (n,) [N] with a common relative standard error [-], and the measured force with its
    standard error [N].

    Examples
    --------
    >>> round(share_above(np.array([1.0, 3.0]), 0.0, 2.0, 0.1), 12)
    0.5
    """
    drawn = np.sort(np.multiply.outer(forces, np.exp(relative_error * _SCORES)).ravel())
    return float(1 - np.mean(np.searchsorted(drawn, measured + error * _SCORES)) / drawn.size)


def fits(above: float) -> bool:
    """Whether a measured force fits, of which a fraction of the forces lies above."""
    return 2 * min(above, 1 - above) >= UNLIKELY

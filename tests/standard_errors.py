"""How far a Monte-Carlo mean lies from a law, in its own standard errors."""

import numpy as np

from stiction.estimates import mean_with_error

#: A law holds if the mean of independent samples lies within this many standard errors: one false alarm in 16 000.
ALLOWED = 4


def errors_off(samples, expected):
    """Largest distance of the mean over the first axis from what is expected, in standard errors."""
    mean, error = mean_with_error(samples)
    return np.max(np.abs(mean - expected) / error)

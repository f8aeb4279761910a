"""Deviation of a Monte-Carlo mean from its expected value, in standard errors."""

import numpy as np

from stiction.estimates import mean_with_error

#: Largest allowed deviation of a mean of independent samples, in standard errors: one false alarm in 16 000.
ALLOWED = 4


def errors_off(samples, expected):
    """Largest distance of the mean over the first axis from the expected value, in standard errors."""
    mean, error = mean_with_error(samples)
    return np.max(np.abs(mean - expected) / error)

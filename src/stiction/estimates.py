"""Standard errors of Monte-Carlo figures."""

import numpy as np


def mean_with_error(samples):
    """Mean and its standard error over the first axis; NaN error for a single sample is an error of the caller."""
    samples = np.asarray(samples, float)
    if len(samples) < 2:
        raise ValueError(f"a standard error needs two samples, got {len(samples)}")
    return samples.mean(axis=0), samples.std(axis=0, ddof=1) / np.sqrt(len(samples))


def jackknife(estimate, samples):
    """Estimate from all samples and its jackknife standard error.

    Parameters
    ----------
    estimate : callable
        Function of the mean of ``samples``, (k,) -> scalar or array.
    samples : (n, k) array
        Independent samples, n >= 2.

    Returns
    -------
    value, standard_error
    """
    samples = np.asarray(samples, float)
    n = len(samples)
    if n < 2:
        raise ValueError(f"a standard error needs two samples, got {n}")
    total = samples.sum(axis=0)
    left_out = np.array([estimate((total - sample) / (n - 1)) for sample in samples])
    error = np.sqrt((n - 1) / n * np.sum((left_out - left_out.mean(axis=0)) ** 2, axis=0))
    return estimate(total / n), error

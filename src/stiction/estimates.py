"""Standard errors of Monte-Carlo estimates."""

from collections.abc import Callable

import numpy as np


def mean_with_error(samples: np.ndarray) -> tuple[float | np.ndarray, float | np.ndarray]:
    """Mean over the first axis and its standard error. Raises ValueError for a single sample."""
    samples = np.asarray(samples, float)
    if len(samples) < 2:
        raise ValueError(f"a standard error needs two samples, got {len(samples)}")
    return samples.mean(axis=0), samples.std(axis=0, ddof=1) / np.sqrt(len(samples))


def mean_on_shared_samples(values: np.ndarray, shared: np.ndarray, power: float) -> tuple[float, float, float]:
    """Mean of values with one common set of samples, and both parts of its standard error.

    The beams of a case share a finite number of sampled pairs, whose sampling error is common to all beams.

    Parameters
    ----------
    values : (n,) array
        Values that are independent given the samples.
    shared : (m,) array
        Samples on which all values depend.
    power : float
        ASSUME: the values are proportional to the mean of the samples to this power. Resampled studies scatter by 0.7
        to 1.6 times the reported common error. The common error is invalid if the values are a selection, such as the
        few beams that stick.

    Returns
    -------
    mean : float
    own, common : float
        Standard errors due to the n values and due to the m samples.
    """
    mean, error_of_mean = mean_with_error(values)
    centre, error = mean_with_error(shared)
    return mean, error_of_mean, abs(power * mean * error / centre)


def jackknife(
    estimate: Callable[[np.ndarray], float | np.ndarray], samples: np.ndarray
) -> tuple[float | np.ndarray, float | np.ndarray]:
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

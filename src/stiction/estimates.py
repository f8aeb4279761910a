"""Standard errors of Monte-Carlo figures."""

import numpy as np


def mean_with_error(samples):
    """Mean and its standard error over the first axis; ValueError for a single sample."""
    samples = np.asarray(samples, float)
    if len(samples) < 2:
        raise ValueError(f"a standard error needs two samples, got {len(samples)}")
    return samples.mean(axis=0), samples.std(axis=0, ddof=1) / np.sqrt(len(samples))


def mean_on_shared_samples(values, shared, power):
    """Mean of values that all rest on one set of samples, with both parts of its standard error.

    Beams of a case share their finite number of sampled pairs: what these have by chance, all beams have.

    Parameters
    ----------
    values : (n,) array
        Independent of each other but for the samples.
    shared : (m,) array
        The samples.
    power : float
        ASSUME: the values follow the mean of the samples to this power. Resampled studies scatter by 0.7 to 1.6 times
        the stated common error; it means nothing where the case selects its values, as among a few beams that stick.

    Returns
    -------
    mean : float
    own, common : float
        Standard errors of the n values and of the m samples.
    """
    mean, own = mean_with_error(values)
    centre, error = mean_with_error(shared)
    return mean, own, abs(power * mean * error / centre)


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

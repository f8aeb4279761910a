r"""Number of samples and polynomials to be enough (App. B-C).

Distributions are compared by Kolmogorov's distance :math:`D = \sup |F - G|`. The distance of m samples from their own
distribution is random with mean 0.869 / √m: smaller distances cannot be resolved with m samples.
"""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.special import ndtr

from stiction.chaos.density import silverman_bandwidth

#: Mean and standard deviation of Kolmogorov's limit distribution, √m D of m samples: √(π/2) ln 2, √(π²/12 - mean²).
KOLMOGOROV_MEAN = np.sqrt(np.pi / 2) * np.log(2)
KOLMOGOROV_DEVIATION = np.sqrt(np.pi**2 / 12 - KOLMOGOROV_MEAN**2)


def sampling_distance(*numbers: int) -> float:
    """Expected distance of independent draws from their distribution, or of two sets of draws from each other [-].

    Examples
    --------
    >>> round(float(sampling_distance(5000)), 4)
    0.0123
    """
    return KOLMOGOROV_MEAN * np.sqrt(sum(1 / number for number in numbers))


def distance_to(samples: np.ndarray, distribution: Callable[[np.ndarray], np.ndarray]) -> float:
    """Kolmogorov's distance of samples (n,) from a continuous distribution function [-]."""
    n = len(samples)
    expected = distribution(np.sort(samples))
    return max(np.max(np.arange(1, n + 1) / n - expected), np.max(expected - np.arange(n) / n))


def distance_between(samples: np.ndarray, reference: np.ndarray) -> float:
    """Kolmogorov's distance between the empirical distributions of two sets of samples, (n,) and (m,) [-]."""
    at = np.sort(np.concatenate([samples, reference]))
    shares = [np.searchsorted(np.sort(s), at, side="right") / len(s) for s in (samples, reference)]
    return np.max(np.abs(shares[0] - shares[1]))


def distance_of_parts(samples: np.ndarray, size: int) -> tuple[float, float]:
    """Mean distance of subsets of ``size`` samples from all samples, with its standard error by Kolmogorov's law [-].

    The subsets are consecutive and disjoint; independent samples give 0.869 √(1/size - 1/n). All samples contain every
    subset, so that F - G of two subsets has the correlation -size / (n - size), and their distances, which do not
    depend on its sign, have about the square of it: two halves have the same distance.
    """
    n = len(samples)
    parts = [samples[k : k + size] for k in range(0, n - size + 1, size)]
    if not parts:
        raise ValueError(f"{n} samples have no part of {size}")
    correlation = (size / (n - size)) ** 2 if len(parts) > 1 else 0.0
    independent = len(parts) / (1 + (len(parts) - 1) * correlation)  # parts that would give the same error
    error = KOLMOGOROV_DEVIATION * np.sqrt((1 / size - 1 / n) / independent)
    return np.mean([distance_between(subset, samples) for subset in parts]), error


def kernel_distribution(
    centres: np.ndarray, bandwidth: float, points: int = 2000
) -> Callable[[np.ndarray], np.ndarray]:
    """Distribution function of equal Gaussian kernels at ``centres`` (m,), interpolated between ``points`` values."""
    table = np.linspace(centres.min() - 8 * bandwidth, centres.max() + 8 * bandwidth, points)
    values = np.array([ndtr((x - centres) / bandwidth).mean() for x in table])
    return lambda x: np.interp(x, table, values)


def kernel_estimate(samples: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Density of samples (n,) at given values, by Gaussian kernels of Silverman's width [1 / unit of the samples]."""
    width = silverman_bandwidth(len(samples), 1) * np.std(samples)
    return np.array([np.exp(-(((x - samples) / width) ** 2) / 2).mean() for x in at]) / (np.sqrt(2 * np.pi) * width)


def converged_order(orders: Sequence[int], distances: np.ndarray, samples: int, draws: int) -> int:
    """Smallest order with converged marginals, or 0 without any.

    From there on, each marginal is as close to its target as ``samples`` draws from it. The distances of the marginals
    of increasing orders from their target are Kolmogorov's (n,) [-]. A marginal is known from draws, whose own distance
    from it is allowed in addition.

    Examples
    --------
    >>> converged_order([1, 2, 3, 4], [0.2, 0.01, 0.1, 0.01], 1000, 200_000)
    4
    """
    far = np.flatnonzero(np.asarray(distances) > sampling_distance(samples, draws))
    first = far[-1] + 1 if len(far) else 0
    return int(orders[first]) if first < len(orders) else 0

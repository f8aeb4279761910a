r"""Weighted draws of errors, independent and standard normal before a measurement of any likelihood.

Adaptive importance sampling (J.-M. Cornuet et al., Scand. J. Stat. 39, 798 (2012)). The first draws z are those
before the measurement, with density :math:`\varphi`, and those around the most probable errors after it. As long as too
few of them are probable after it, further normal distributions give more. Their moments are those of a product of
powers of the density after the measurement and, in turn, of :math:`\varphi` or of that of all first draws. The former
finds several maxima, the latter what was nearly impossible before. Draws from all N of these distributions :math:`q_i`
have weights

.. math:: w \propto L(z) \, \varphi(z) \, / \sum_{i=1}^N q_i(z)

with the likelihood :math:`L`. They are bounded: one of the distributions is :math:`\varphi`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import logsumexp, softmax

from stiction.errors import NotConverged

#: Draws from every distribution, number of equally weighted draws that weighted ones must be worth, and most
#: distributions.
_DRAWS, _ENOUGH, _MOST = 4096, 2048, 100


@dataclass(frozen=True)
class _Normal:
    """Normal distribution, up to a common factor of its density."""

    mean: np.ndarray  #: (r,)
    root: np.ndarray  #: lower triangle, the covariance is its product with its transpose (r, r)

    @classmethod
    def from_draws(cls, draws: np.ndarray, weights: np.ndarray) -> "_Normal":
        """Fit the moments of weighted draws."""
        mean = weights @ draws
        apart = draws - mean
        return cls(mean, np.linalg.cholesky((apart * weights[:, None]).T @ apart))

    @classmethod
    def around(cls, mode: np.ndarray, curvature: np.ndarray) -> "_Normal":
        """Normal distribution, nowhere wider than the standard one."""
        curvatures, axes = np.linalg.eigh(curvature)
        covariance = axes / np.maximum(curvatures, 1.0) @ axes.T
        return cls(mode, np.linalg.cholesky(covariance))

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        """Draw in pairs around the mean, with exactly the covariance of the distribution (m, r)."""
        half = rng.standard_normal((_DRAWS // 2, len(self.mean)))
        exact = half @ np.linalg.inv(np.linalg.cholesky(half.T @ half / len(half))).T @ self.root.T
        return self.mean + np.concatenate([exact, -exact])

    def log_density(self, draws: np.ndarray) -> np.ndarray:
        """Logarithm of the density at (m, r) draws, (m,)."""
        inverse = np.linalg.inv(self.root)
        return -np.sum(((draws - self.mean) @ inverse.T) ** 2, axis=1) / 2 + np.log(np.diag(inverse)).sum()


def weighted(
    log_likelihood: Callable[[np.ndarray], np.ndarray],
    mode: np.ndarray,
    curvature: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """Draw errors, standard normal before a measurement: draws (m, r) and their weights after it (m,).

    ``log_likelihood`` takes draws (m, r) and returns (m,). The most probable errors are (r,), and the curvature is that
    of half the misfit there (r, r).

    Raises
    ------
    NotConverged
        If the draws are worth too few equally weighted ones.
    """
    normals = [_Normal(np.zeros(len(mode)), np.eye(len(mode))), _Normal.around(mode, curvature)]
    draws = np.concatenate([normal.draw(rng) for normal in normals])
    mixture, likelihood = _density(normals, draws), log_likelihood(draws)
    for turn in range(_MOST):
        start = _density(normals[: 1 + turn % 2], draws)
        ratio = normals[0].log_density(draws) + likelihood - start
        power = _power(start - mixture, ratio)
        weights = softmax(start - mixture + power * ratio)
        if power == 1:
            return draws, weights
        normals.append(_Normal.from_draws(draws, weights))
        more = normals[-1].draw(rng)
        mixture = np.concatenate([np.logaddexp(mixture, normals[-1].log_density(draws)), _density(normals, more)])
        draws, likelihood = np.concatenate([draws, more]), np.concatenate([likelihood, log_likelihood(more)])
    missing = _ENOUGH / _worth(normals[0].log_density(draws) + likelihood - mixture)
    raise NotConverged("draws of the errors of the inputs that are needed over those there are", missing, 1, _MOST)


def _density(normals, draws):
    """Logarithm of the sum of the densities at the draws (m,)."""
    return logsumexp([normal.log_density(draws) for normal in normals], axis=0)


def _power(before, ratio):
    """Largest power of the ratio of densities, up to 1, with draws still worth enough."""

    def spare(power):
        """Worth of the draws at a power, less the required one."""
        return _worth(before + power * ratio) - _ENOUGH

    return 1.0 if spare(1.0) >= 0 else brentq(spare, 0.0, 1.0, rtol=1e-6)


def _worth(logarithms):
    """Number of equally weighted draws with the same error of a mean, by the logarithms of the weights."""
    return np.exp(2 * logsumexp(logarithms) - logsumexp(2 * logarithms))

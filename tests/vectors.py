"""Synthetic vectors v similar to those of a pair of rough surfaces, for tests of the chaos model."""

import numpy as np

from stiction.chaos.coordinates import principal_coordinates

M = 5000


def sampled_vectors(m=M, spread=0.3, seed=1):
    """Correlated, skewed and not quite linearly related vectors (m, 4)."""
    z = np.random.default_rng(seed).standard_normal((m, 4))
    log_e = np.log(7e-3) + spread * (z[:, 0] + 0.1 * z[:, 0] ** 2)
    log_f = np.log(2e6) + spread * (0.9 * z[:, 0] + 0.44 * z[:, 1] + 0.1 * z[:, 0] ** 2)
    d_max = 8e-9 + 0.3e-9 * (0.5 * z[:, 0] + 0.87 * z[:, 2] + 0.15 * z[:, 2] ** 2)
    gap = 1.5e-9 * np.exp(0.15 * (0.3 * z[:, 2] + 0.2 * z[:, 0] + 0.9 * z[:, 3] + 0.1 * z[:, 3] ** 2))
    return np.column_stack([np.exp(log_e), np.exp(log_f), d_max, d_max - gap])


def reduced(vectors, dimension):
    """First principal coordinates of vectors (m, dimension)."""
    return principal_coordinates(vectors).reduce(vectors)[:, :dimension]


VECTORS = sampled_vectors()
F_LIMIT = VECTORS[:, 1].max()

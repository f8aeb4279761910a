"""Undefined points of a map of heights, filled from their neighbours.

Scattered points at the level would act as white noise: they would raise the whole spectrum by the variance of the
heights times their share, which hides where it ends.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve


def filled(heights: np.ndarray, pixel: tuple[float, float]) -> np.ndarray:
    """Heights (n1, n2) in which Laplace's equation holds where they were NaN, undefined; the others are unchanged [m].

    A filled height is the mean of its four neighbours, weighted by their inverse squared distance, and thus never
    higher or lower than the rim of its hole. Distances of the points [m].
    """
    undefined = ~np.isfinite(heights)
    if not undefined.any():
        return heights
    where, complete = undefined.ravel(), np.where(undefined, 0.0, heights)
    equations = _laplacian(heights.shape, pixel)[where]
    complete[undefined] = spsolve(equations[:, where].tocsc(), -(equations @ complete.ravel()))
    return complete


def _laplacian(shape, pixel):
    """Differences of every point from its neighbours over their squared distance, a sparse (n1 n2, n1 n2) array."""
    along, across = (_second_difference(n) * (pixel[0] / p) ** 2 for n, p in zip(shape, pixel, strict=True))
    return sparse.csr_array(
        sparse.kron(along, sparse.eye_array(shape[1])) + sparse.kron(sparse.eye_array(shape[0]), across)
    )


def _second_difference(points):
    """Second difference of a row of points, whose ends have one neighbour, (points, points)."""
    step = sparse.diags_array([[-1.0], [1.0]], offsets=[0, 1], shape=(points - 1, points))
    return step.T @ step

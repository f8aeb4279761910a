"""Undefined points of a map of heights: narrow holes are filled from their neighbours, wide ones are left out.

Scattered points at the level would act as white noise: they would raise the whole spectrum by the variance of the
heights times their share, which hides where it ends. In a wide hole, filled heights would have no roughness.
"""

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse.linalg import spsolve

#: Points along each side of the smallest wide hole. ASSUME: the shortest wavelength used of a spectrum is so long, see
#: `stiction.scans.whittle.reach`, so that it holds no wave that a narrower hole hides.
_WIDE = 4


def whole_part(heights: np.ndarray) -> tuple[slice, slice]:
    """Largest rectangle of a map without wide holes, by its shorter side. This side decides the plateau.

    Examples
    --------
    >>> z = np.zeros((40, 50))
    >>> z[30:35, 10:15] = np.nan
    >>> whole_part(z)
    (slice(0, 40, None), slice(15, 50, None))
    """
    wide = ndimage.binary_opening(~np.isfinite(heights), np.ones((_WIDE, _WIDE)))
    best, rectangle = (0, 0), (slice(0, 0), slice(0, 0))
    columns = np.arange(heights.shape[1])
    length, left, right = np.zeros_like(columns), np.zeros_like(columns), np.full_like(columns, len(columns))
    for row, free in enumerate(~wide):
        # Of every point: free points above it, and the columns between which all of them are free.
        length = np.where(free, length + 1, 0)
        start = np.maximum.accumulate(np.where(free, 0, columns + 1))
        end = np.minimum.accumulate(np.where(free, len(columns), columns)[::-1])[::-1]
        left, right = np.where(free, np.maximum(left, start), 0), np.where(free, np.minimum(right, end), len(columns))
        width = np.where(free, right - left, 0)
        shorter, area = np.minimum(length, width), length * width
        k = int(np.lexsort((area, shorter))[-1])
        if (shorter[k], area[k]) > best:
            best = shorter[k], area[k]
            rectangle = slice(row + 1 - int(length[k]), row + 1), slice(int(left[k]), int(right[k]))
    return rectangle


def filled(heights: np.ndarray, pixel: tuple[float, float]) -> np.ndarray:
    """Heights (n1, n2) with undefined points (NaN) filled by Laplace's equation, and the others unchanged [m].

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
    """Second difference of a row of points with one neighbour at its ends, (points, points)."""
    step = sparse.diags_array([[-1.0], [1.0]], offsets=[0, 1], shape=(points - 1, points))
    return step.T @ step

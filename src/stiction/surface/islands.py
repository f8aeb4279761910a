"""Islands of a sampled surface above every level: a component tree (Sec. III-A2, step (i)).

Islands are the connected parts of z >= level; points are neighbours also across a corner. From high to low levels they
appear, grow and merge, but never part. A union-find over the points in the order of their levels therefore finds all
islands at all levels in one pass.
"""

from typing import NamedTuple

import numpy as np

from stiction.kernels import kernel
from stiction.surface.summits import mean_curvature

#: First number of islands for which there is space.
_SPACE = 1 << 15
#: The eight neighbours of a point, around it.
_AROUND = ((-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1), (0, -1))


class Islands(NamedTuple):
    """Islands at all levels, from the highest level down. Each is listed at every level of its existence."""

    levels: np.ndarray  #: number of the level, (m,) int32
    tops: np.ndarray  #: height of the highest point, (m,) float64 [m]
    curvatures: np.ndarray  #: mean curvature of the surface there, (m,) float64 [m⁻¹]
    points: np.ndarray  #: number of points, (m,) int32
    #: Top [m] and curvature [m⁻¹] of the paraboloid of revolution fitted to all points by least squares (m, 2) float64.
    #: NaN for fewer than five points, a paraboloid that opens upwards, and one with its top outside the island's box.
    fits: np.ndarray


def find_islands(
    heights: np.ndarray, spacing: float, step: float, numbers: tuple[int, int], *, fitted: bool = False
) -> Islands:
    """Find the islands of a surface above the levels ``step * arange(*numbers)``.

    Islands whose highest point lies on the edge of the surface, where it may not be a summit, are left out.

    Parameters
    ----------
    heights : (n1, n2) array
        [m]
    spacing : float
        Of the points [m].
    step : float
        Of the levels [m].
    numbers : tuple of 2 ints
        Of the first level and the one behind the last.
    fitted : bool
        Whether paraboloids are fitted; ``fits`` is empty otherwise, (0, 2).
    """
    z = np.ascontiguousarray(heights, np.float32)
    places, ends = _from_the_highest(z, step, numbers)
    levels, summits, points, fits = _grown(z, places, ends, fitted)
    tops, curvatures = _shapes(z, spacing, summits)
    return Islands(levels + numbers[0], tops, curvatures, points, fits / [1, spacing**2])


@kernel
def _from_the_highest(z, step, numbers):
    """Places of the points above the first level, by the highest level below them, and the end of each level's.

    Those of level k are ``places[ends[k + 1] : ends[k]]``.
    """
    first, last, inverse = numbers[0], numbers[1] - 1, 1 / step
    heights, lowest = z.ravel(), first * step
    unordered, levels, above = np.empty(z.size, np.int32), np.empty(z.size, np.int32), 0
    for index in range(z.size):
        if heights[index] >= lowest:
            unordered[above] = index
            levels[above] = min(max(int(np.floor(heights[index] * inverse)), first), last) - first
            above += 1
    ends = np.zeros(last - first + 2, np.int64)
    for level in levels[:above]:
        ends[level] += 1
    for level in range(last - first, -1, -1):
        ends[level] += ends[level + 1]
    places, following = np.empty(above, np.int32), ends[1:].copy()
    for index, level in zip(unordered[:above], levels[:above]):  # noqa: B905 - compiled code knows no strict
        places[following[level]] = index
        following[level] += 1
    return places, ends


@kernel
def _root(parents, k):
    """Highest point of the island of a point, by its rank."""
    while parents[k] != k:
        parents[k] = parents[parents[k]]
        k = parents[k]
    return k


@kernel
def _grown(z, places, ends, fitted):
    """Level, place of the highest point and number of points of every island at every level, and their `_fit`.

    Points are known by their ranks, the positions in ``places``. The parent of a point is one of its island that is at
    least as high; the root of an island is its highest point. The points of an island follow each other in a ring.
    """
    rows, columns = z.shape
    ranks = np.full((rows + 2) * (columns + 2), -1, np.int32)  # with a frame, whose points never appear
    around = np.array([i * (columns + 2) + j for i, j in _AROUND])
    heights = z.ravel()[places]
    parents, points = np.arange(places.size).astype(np.int32), np.ones(places.size, np.int32)
    roots, islands = np.empty(places.size, np.int32), 0
    ring = np.arange(places.size).astype(np.int32)
    listed, fits, number = np.empty((_SPACE, 3), np.int32), np.empty((_SPACE if fitted else 0, 2)), 0
    for level in range(ends.size - 2, -1, -1):
        for rank in range(ends[level + 1], ends[level]):
            framed = places[rank] + columns + 3 + 2 * (places[rank] // columns)
            ranks[framed] = rank
            _join(ranks, framed, around, heights, parents, points, ring)
            roots[islands] = rank
            islands += 1
        islands = _keep_roots(roots, islands, parents)
        if number + islands > len(listed):
            more = max(len(listed), islands)
            listed = np.concatenate((listed, np.empty((more, 3), np.int32)))
            fits = np.concatenate((fits, np.empty((more if fitted else 0, 2))))
        for root in roots[:islands]:
            i, j = places[root] // columns, places[root] % columns
            if 0 < i < rows - 1 and 0 < j < columns - 1:
                listed[number, 0], listed[number, 1], listed[number, 2] = level, places[root], points[root]
                if fitted:
                    fits[number] = _fit(root, ring, places, heights, columns)
                number += 1
    return listed[:number, 0].copy(), listed[:number, 1].copy(), listed[:number, 2].copy(), fits[:number].copy()


@kernel
def _keep_roots(roots, islands, parents):
    """Drop the islands already joined with a higher one, in place. Return the number of islands left."""
    remaining = 0
    for n in range(islands):
        if parents[roots[n]] == roots[n]:
            roots[remaining] = roots[n]
            remaining += 1
    return remaining


@kernel(inline="always")
def _join(ranks, framed, around, heights, parents, points, ring):
    """Join the point at a place with the islands of its neighbours."""
    root, before = ranks[framed], ranks[framed + around[-1]] >= 0
    for n in range(around.size):
        rank = ranks[framed + around[n]]
        # A neighbour that appeared next to another one is in the same island already.
        if rank >= 0 and not (before and n > 0):
            other = _root(parents, rank)
            if other != root:
                if heights[other] > heights[root]:
                    root, other = other, root
                parents[other] = root
                points[root] += points[other]
                ring[root], ring[other] = ring[other], ring[root]
        before = rank >= 0


@kernel
def _fit(root, ring, places, heights, columns):
    """Top and curvature of z = a + b x + c y + e (x² + y²) fitted to an island. Lengths in spacings, NaN for no fit."""
    sums, box = _sums(root, ring, places, heights, columns)
    if sums[0, 0] < 5 or not _eliminate(sums):
        return np.nan, np.nan
    e = sums[3, 4] / sums[3, 3]
    c = (sums[2, 4] - sums[2, 3] * e) / sums[2, 2]
    b = (sums[1, 4] - sums[1, 2] * c - sums[1, 3] * e) / sums[1, 1]
    a = (sums[0, 4] - sums[0, 1] * b - sums[0, 2] * c - sums[0, 3] * e) / sums[0, 0]
    top = np.array([-b, -c]) / (2 * e)
    if e >= 0 or np.any(top < box[0]) or np.any(top > box[1]):
        return np.nan, np.nan
    return heights[root] + a - (b**2 + c**2) / (4 * e), -2 * e


@kernel
def _sums(root, ring, places, heights, columns):
    """Sums over an island of all products of 1, x, y, x² + y² and z, from its highest point, and its box in x, y."""
    sums, box, each, rank = np.zeros((5, 5)), np.zeros((2, 2)), np.ones(5), root
    while True:
        each[1] = places[rank] // columns - places[root] // columns
        each[2] = places[rank] % columns - places[root] % columns
        each[3] = each[1] ** 2 + each[2] ** 2
        each[4] = np.float64(heights[rank]) - heights[root]
        box[0], box[1] = np.minimum(box[0], each[1:3]), np.maximum(box[1], each[1:3])
        for i in range(5):
            for j in range(i, 5):
                sums[i, j] += each[i] * each[j]
        rank = ring[rank]
        if rank == root:
            return sums, box


@kernel
def _eliminate(sums):
    """Bring normal equations to triangular form, in place. Returns False if they have no unique solution."""
    for i in range(4):
        if not sums[i, i] > 1e-9 * sums[0, 0]:
            return False
        for j in range(i + 1, 4):
            for k in range(j, 5):
                sums[j, k] -= sums[i, j] * sums[i, k] / sums[i, i]
    return True


@kernel
def _shapes(z, spacing, places):
    """Heights and mean curvatures of the surface at inner points."""
    heights, curvatures = np.empty(places.size), np.empty(places.size)
    for n in range(places.size):
        i, j = places[n] // z.shape[1], places[n] % z.shape[1]
        heights[n] = z[i, j]
        curvatures[n] = mean_curvature(z, i, j, spacing)
    return heights, curvatures

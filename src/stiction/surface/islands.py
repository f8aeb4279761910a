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
    """Islands at all levels, those of the highest level first; each is listed at every level at which it exists."""

    levels: np.ndarray  #: number of the level, (m,) int32
    tops: np.ndarray  #: height of the highest point, (m,) float64 [m]
    curvatures: np.ndarray  #: mean curvature of the surface there, (m,) float64 [m⁻¹]
    points: np.ndarray  #: number of points, (m,) int32


def find_islands(heights: np.ndarray, spacing: float, step: float, numbers: tuple[int, int]) -> Islands:
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
    """
    z = np.ascontiguousarray(heights, np.float32)
    places, ends = _from_the_highest(z, step, numbers)
    levels, summits, points = _grown(z, places, ends)
    tops, curvatures = _shapes(z, spacing, summits)
    return Islands(levels + numbers[0], tops, curvatures, points)


@kernel
def _from_the_highest(z, step, numbers):
    """Places of the points above the first level, ordered by the highest level below them, and where those of each end.

    Those of level k are ``places[ends[k + 1] : ends[k]]``.
    """
    first, last, inverse = numbers[0], numbers[1] - 1, 1 / step
    heights, lowest = z.ravel(), first * step
    unordered, levels, above = np.empty(z.size, np.int32), np.empty(z.size, np.int32), 0
    for place in range(z.size):
        if heights[place] >= lowest:
            unordered[above] = place
            levels[above] = min(max(int(np.floor(heights[place] * inverse)), first), last) - first
            above += 1
    ends = np.zeros(last - first + 2, np.int64)
    for level in levels[:above]:
        ends[level] += 1
    for level in range(last - first, -1, -1):
        ends[level] += ends[level + 1]
    places, following = np.empty(above, np.int32), ends[1:].copy()
    for place, level in zip(unordered[:above], levels[:above]):  # noqa: B905 - compiled code knows no strict
        places[following[level]] = place
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
def _grown(z, places, ends):
    """Level, place of the highest point and number of points of every island at every level.

    Points are known by their ranks, the positions in ``places``. The parent of a point is one of its island that is at
    least as high; the root of an island is its highest point.
    """
    rows, columns = z.shape
    ranks = np.full((rows + 2) * (columns + 2), -1, np.int32)  # with a frame, whose points never appear
    around = np.array([i * (columns + 2) + j for i, j in _AROUND])
    heights = z.ravel()[places]
    parents, points = np.arange(places.size).astype(np.int32), np.ones(places.size, np.int32)
    roots, islands = np.empty(places.size, np.int32), 0
    listed, found = np.empty((_SPACE, 3), np.int32), 0
    for level in range(ends.size - 2, -1, -1):
        for rank in range(ends[level + 1], ends[level]):
            place = places[rank] + columns + 3 + 2 * (places[rank] // columns)
            ranks[place] = rank
            _join(ranks, place, around, heights, parents, points)
            roots[islands] = rank
            islands += 1
        kept = 0
        for n in range(islands):
            if parents[roots[n]] == roots[n]:
                roots[kept] = roots[n]
                kept += 1
        islands = kept
        if found + islands > len(listed):
            listed = np.concatenate((listed, np.empty((max(len(listed), islands), 3), np.int32)))
        for root in roots[:islands]:
            i, j = places[root] // columns, places[root] % columns
            if 0 < i < rows - 1 and 0 < j < columns - 1:
                listed[found, 0], listed[found, 1], listed[found, 2] = level, places[root], points[root]
                found += 1
    return listed[:found, 0].copy(), listed[:found, 1].copy(), listed[:found, 2].copy()


@kernel(inline="always")
def _join(ranks, place, around, heights, parents, points):
    """Join the point at a place with the islands of its neighbours."""
    root, before = ranks[place], ranks[place + around[-1]] >= 0
    for n in range(around.size):
        rank = ranks[place + around[n]]
        # A neighbour that appeared next to another one is in the same island already.
        if rank >= 0 and not (before and n > 0):
            other = _root(parents, rank)
            if other != root:
                if heights[other] > heights[root]:
                    root, other = other, root
                parents[other] = root
                points[root] += points[other]
        before = rank >= 0


@kernel
def _shapes(z, spacing, places):
    """Heights and mean curvatures of the surface at inner points."""
    heights, curvatures = np.empty(places.size), np.empty(places.size)
    for n in range(places.size):
        i, j = places[n] // z.shape[1], places[n] % z.shape[1]
        heights[n] = z[i, j]
        curvatures[n] = mean_curvature(z, i, j, spacing)
    return heights, curvatures

r"""Contact of a strip of rough surface tilted about its edge: the tip of a beam (independent of humidity).

A tip with the slope θ touches as a wedge. At the distance d between the mean planes where the edge is highest, a point
of height z is as high as one of height z - u on a strip without slope, with the drop u of `stiction.contact.tilt`. The
edge begins on a row of grid points.

ASSUME: the edge is one of two. A rounded one has the summits of the surface before it is tilted. With the radius 0, the
row of points on it carries neither solids nor water. A square edge touches as well: the summits are the maxima of the
tilted surface, and those on its edge are spheres of the curvature along it.
"""

from dataclasses import dataclass, field

import numpy as np

from stiction.contact.pair import DistanceGrid, Summits, SurfacePair, solid_pressure
from stiction.contact.tilt import Edge, Tilt
from stiction.kernels import kernel
from stiction.surface.summits import mark_summits, mean_curvature

#: Largest radius of a maximum of a square edge [m]. ASSUME: flatter ones, whose curvature the grid does not resolve,
#: would attract without bound.
LARGEST_RADIUS = 2e-6


@dataclass(frozen=True)
class TiltedPair(SurfacePair):
    """Two surfaces in contact at several slopes."""

    tilt: Tilt = field(kw_only=True)

    @property
    def depth(self) -> float:
        """Depth of the first distances below the mean plane [m].

        ASSUME: no tip is pressed deeper than three times the rms of the heights. The edge of a narrow beam, whose wedge
        has few summits, may be drawn below its mean plane.
        """
        return 3 * float(np.hypot(self.beam.rms, self.substrate.rms))

    @property
    def distances(self) -> DistanceGrid:
        """Grid of the distances at the edge from `depth`, up to the highest possible height."""
        above = int(np.ceil(self.depth / self.step)) + super().distances.above
        return DistanceGrid(self.step, int(np.ceil(self.tilt.reach / self.step)), above)

    @property
    def length(self) -> float:
        """Length of the represented part of the strip [m]."""
        return (len(range(0, self.beam.grid.shape[0], self.every)) - 1 + first_weight(self.tilt.edge)) * self.spacing

    def contact(self, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solid pressure and bearing area of one equivalent surface (n1, n2) [m] at every slope.

        Both refer to the area of the strip, whose first axis begins at the edge.

        Returns
        -------
        solid_pressure : (n_slopes, n_solid) array
            At ``distances.solid`` [Pa].
        bearing_area : (n_slopes, n_bearing) array
            At ``distances.bearing`` [-].
        """
        grid, square, first = self.distances, self.tilt.edge == Edge.SQUARE, first_weight(self.tilt.edge)
        upright, highest = summits_by_row(heights, self.spacing, 0.0), float(heights.max())
        solid, bearing = [], []
        for slope in self.tilt.slopes:
            fall, drop = slope * self.spacing, self.drop(slope, len(heights))
            rows, tops, curvatures = summits_by_row(heights, self.spacing, fall) if square else upright
            lowered = tops - drop[rows] + self.depth
            if square:
                of_edge, along = edge_maxima(heights, self.spacing, fall)
                lowered, curvatures = np.append(lowered, of_edge + self.depth), np.append(curvatures, along)
            # ASSUME: no point at the sides of a strip is a summit, as in the contact without slope.
            area = self.length * (heights.shape[1] - 2) * self.spacing
            solid.append(solid_pressure(self.asperity, Summits(lowered, curvatures, area), grid))
            level = self.depth, highest
            bearing.append(tilted_bearing_area(heights, drop, level, first, (grid.step, grid.below, grid.above)))
        return np.array(solid), np.array(bearing)

    def drop(self, slope: float, number: int) -> np.ndarray:
        """Drop u of the rows of a strip at a slope (number,) [m]."""
        return self.tilt.drop(slope, self.spacing * (np.arange(number) - round(self.tilt.before / self.spacing)))


def first_weight(edge: Edge) -> float:
    """Fraction of a cell of the grid wetted on the row of points at the edge [-].

    The strip then ends where its first summits do: half of a point outside the first inner row, or on the edge itself.
    With another weight, lengths would depend on the grid: with half of a cell at a rounded edge, those of pair b change
    by up to 9 % from 10 to 5 nm, and with none by 2 ± 1 %.
    """
    return 0.5 if edge == Edge.SQUARE else 0.0


@kernel
def _lowered(heights, i, rise, out):
    """Write rows i - 1, i and i + 1 of a strip falling by ``rise`` per row, seen from row i, to ``out`` (3, n2)."""
    for k in range(3):
        for j in range(heights.shape[1]):
            out[k, j] = heights[i + k - 1, j] - (k - 1) * rise


@kernel
def _collect(heights, spacing, rise, rows, tops, curvatures):
    count, marks, near = 0, np.empty(heights.shape[1], np.bool_), np.empty((3, heights.shape[1]))
    for i in range(1, heights.shape[0] - 1):
        _lowered(heights, i, rise, near)
        mark_summits(near, 1, marks)
        for j in range(1, heights.shape[1] - 1):
            if marks[j]:
                rows[count], tops[count] = i, heights[i, j]
                curvatures[count] = mean_curvature(heights, i, j, spacing)
                count += 1
    return count


def summits_by_row(heights: np.ndarray, spacing: float, rise: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Maxima of a strip (n1, n2) [m] falling by ``rise`` [m] per row: row, height without slope, mean curvature.

    Each (m,) [-], [m], [m⁻¹]; the slope does not change the curvature. Edges have no summits.
    """
    inner = (heights.shape[0] - 2) * (heights.shape[1] - 2)
    rows, tops, curvatures = np.empty(inner, np.int64), np.empty(inner), np.empty(inner)
    count = _collect(heights, spacing, rise, rows, tops, curvatures)
    return rows[:count].copy(), tops[:count].copy(), curvatures[:count].copy()


def edge_maxima(heights: np.ndarray, spacing: float, rise: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights and curvatures of the maxima on the edge of a strip (n1, n2) [m] falling by ``rise`` [m] per row.

    Each (m,) [m], [m⁻¹]. They are higher than their five neighbours; the curvature is that along the edge, and at least
    that of the `LARGEST_RADIUS`.
    """
    edge, inner = heights[0].astype(float), heights[1] - rise
    middle = edge[1:-1]
    neighbours = [edge[:-2], edge[2:], inner[:-2], inner[1:-1], inner[2:]]
    maxima = np.all([middle > other for other in neighbours], axis=0)
    curvatures = (2 * middle - edge[:-2] - edge[2:]) / spacing**2
    return middle[maxima], np.maximum(curvatures[maxima], 1 / LARGEST_RADIUS)


@kernel
def tilted_bearing_area(
    heights: np.ndarray, drop: np.ndarray, level: tuple[float, float], first: float, grid: tuple[float, int, int]
) -> np.ndarray:
    """Fraction of the area of a strip (n1, n2) [m] higher than each distance at its edge [-].

    Its rows are lower by their ``drop`` (n1,) than without slope [m]. ``level``: the depth from which the distances are
    measured, and its highest point without slope [m]. Its first row has the weight ``first``. ``grid``: step and
    numbers of the distances, ``step * arange(-below, above)`` [m].
    """
    (step, below, above), (depth, highest) = grid, level
    cells = np.empty(heights.shape[1], np.int32)
    of_edge, count = np.zeros(below + above + 1, np.int64), np.zeros(below + above + 1, np.int64)
    for i in range(heights.shape[0]):
        lowered = drop[i] - depth
        if highest - lowered < -below * step:  # lower than all distances
            continue
        _cells_below(heights[i], lowered, step, (below, above), cells)
        counted = count if i else of_edge
        for cell in cells:
            counted[np.uint32(cell)] += 1
    area, higher = np.zeros(below + above), 0.0
    for k in range(below + above, 0, -1):
        higher += first * of_edge[k] + count[k]
        area[k - 1] = higher / ((heights.shape[0] - 1 + first) * heights.shape[1])
    return area


@kernel
def _cells_below(heights, lowered, step, numbers, cells):
    """Number of distances not above each point of a row that is lowered [m]."""
    (below, above), inverse = numbers, 1 / step
    lowest, highest = np.float64(-below - 1), np.float64(above - 1)
    for j in range(heights.size):
        cell = min(max(np.floor((heights[j] - lowered) * inverse), lowest), highest)
        cells[j] = np.int32(cell) + np.int32(below + 1)

r"""Semi-analytical adhesive contact of two rough surfaces (Sec. III-A2), independent of humidity.

The pair is an equivalent surface z = z₁ + z₂ against a flat at the distance d between the mean planes (the means of the
processes, 0). Pressures are positive in repulsion. Two functions of distance determine the force at any humidity:

.. math:: f(d) = p_s(d) - |\Delta P| \, A(d - h_C)

with the solid pressure p_s (spheres fitted to the asperities, Hertz or Maugis) and the bearing area A (share of z > d).
ASSUME: asperities below the mean plane are never in contact.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from stiction.contact.asperity import Asperity, Ranges
from stiction.kernels import kernel
from stiction.surface.field import RoughSurface
from stiction.surface.islands import find_islands
from stiction.surface.replica import Replica
from stiction.surface.summits import find_summits

#: Levels at which islands are found, on one rms of the heights: enough for crack lengths to 0.2 %.
LEVELS_PER_RMS = 30


@dataclass(frozen=True)
class DistanceGrid:
    """Equally spaced distances. Solid contact needs only distances >= 0, the water negative ones as well."""

    step: float  #: [m]
    below: int  #: number of grid points with negative distance
    above: int  #: number of grid points with distance >= 0

    @classmethod
    def covering(cls, lowest: float, highest: float, step: float) -> "DistanceGrid":
        """Grid from the lowest (negative) to the highest height of an equivalent surface [m]."""
        return cls(step, int(np.ceil(-lowest / step)), int(np.ceil(highest / step)) + 1)

    @property
    def solid(self) -> np.ndarray:
        """Distances of the solid pressure, (above,) [m]."""
        return self.step * np.arange(self.above)

    @property
    def bearing(self) -> np.ndarray:
        """Distances of the bearing area, (below + above,) [m]."""
        return self.step * np.arange(-self.below, self.above)


class Definition(StrEnum):
    """Definition of an asperity: the part of the surface for the fit of a sphere in step (i)."""

    SUMMIT = "summit"  #: a point higher than its eight neighbours, with its curvature there
    ISLAND = "island"  #: a connected part of the surface above the flat, with its area
    FITTED = "fitted"  #: the same, by least squares


class Summits(NamedTuple):
    """Spheres in place of the asperities of an equivalent surface."""

    tops: np.ndarray  #: heights, (m,) [m]
    curvatures: np.ndarray  #: mean curvatures, (m,) [m⁻¹]
    area: float  #: in which a point can be a summit [m²]
    between: Ranges | None = None  #: distances at which each is in force; all distances if none are given


@dataclass(frozen=True)
class EquivalentSurface:
    """Sum z = z₁ + z₂ of two rough surfaces and the step of the distances: all of a pair but its elasticity."""

    beam: RoughSurface
    substrate: RoughSurface
    step: float  #: of the distances [m]
    every: int = 1  #: summits and area are taken from every n-th point of the drawn grid
    definition: Definition = Definition.SUMMIT  #: of an asperity
    replica: Replica | None = None  #: of both surfaces, if the beam follows the substrate

    def __post_init__(self):
        beam, substrate = self.beam.grid, self.substrate.grid
        if (beam.shape, beam.spacing) != (substrate.shape, substrate.spacing):
            raise ValueError(
                f"surfaces must have the same points, got {beam.shape} points every {beam.spacing:.3g} m "
                f"and {substrate.shape} every {substrate.spacing:.3g} m"
            )

    @property
    def spacing(self) -> float:
        """Spacing of the grid of the contact [m]."""
        return self.beam.grid.spacing * self.every

    @property
    def rms(self) -> float:
        """Root mean square of z₁ + z₂ [m]."""
        return self.replica.rms if self.replica else float(np.hypot(self.beam.rms, self.substrate.rms))

    @property
    def distances(self) -> DistanceGrid:
        """Grid of the distances, covering every possible height z₁ + z₂."""
        lowest, highest = (float(self.beam.table[end]) + float(self.substrate.table[end]) for end in (0, -1))
        return DistanceGrid.covering(lowest, highest, self.step)

    def draw(self, beam_rng: np.random.Generator, substrate_rng: np.random.Generator) -> np.ndarray:
        """Draw one equivalent surface z = z₁ + z₂, (n1, n2) float32 [m]."""
        if self.replica:
            heights = self.replica.draw(beam_rng, substrate_rng)
        else:
            heights = self.beam.draw(beam_rng)
            self.substrate.add_to(heights, substrate_rng)
        return np.ascontiguousarray(heights[:: self.every, :: self.every])

    def under_flat(self, heights: np.ndarray) -> np.ndarray:
        """Heights that touch a flat where z (n1, n2) touches its counterpart [m]: here z itself."""
        return heights

    def asperities(self, heights: np.ndarray) -> Summits:
        """Asperities of one equivalent surface z (n1, n2) [m], by the chosen definition."""
        return self.summits(heights) if self.definition == Definition.SUMMIT else self.islands(heights)

    def summits(self, heights: np.ndarray) -> Summits:
        """Summits of one equivalent surface z (n1, n2) [m].

        ASSUME: a summit is higher than its eight neighbours on this grid, and a sphere of its mean curvature there.
        """
        tops, curvatures, _ = find_summits(heights, self.spacing)
        # ASSUME: the area is the one in which a point can be a summit, 1.4 % less than that of a strip of 1.5 µm,
        # because points on the edge have fewer than eight neighbours.
        return Summits(tops, curvatures, (heights.shape[0] - 2) * (heights.shape[1] - 2) * self.spacing**2)

    def islands(self, heights: np.ndarray) -> Summits:
        r"""Islands of one equivalent surface z (n1, n2) [m] above the flat, at every distance d.

        ASSUME: an island of n points, each of a cell of area h², is a sphere of the same area with its highest point,

        .. math:: n h^2 = 2 \pi R (\delta + s), \quad h^2 = 2 \pi R_0 s,

        with the overlap δ, and the radius R₀ and the depth s of a summit there: the true top is higher than the highest
        point of a grid, by about the depth of a cap of one cell. An island of one point that just touches is a summit,
        and so is an asperity that does not touch yet; for large islands s is negligible.
        ASSUME: below the rms of the heights, where islands are about to become one, they keep their spheres from there.
        ASSUME: fitted by least squares, an island without a fit has the sphere of its area.
        """
        summits, grid, rms = self.summits(heights), self.distances, self.rms
        stride = max(round(rms / (LEVELS_PER_RMS * grid.step)), 1)
        levels = DistanceGrid(stride * grid.step, 0, -(-grid.above // stride))
        lowest = min(int(np.ceil(rms / levels.step)), levels.above - 1)
        by_fit, numbers = self.definition == Definition.FITTED, (lowest, levels.above)
        islands = find_islands(heights, self.spacing, levels.step, numbers, fitted=by_fit)
        overlap = islands.tops - islands.levels * levels.step
        spheres = np.stack(
            [islands.tops, (islands.curvatures + 2 * np.pi * overlap / self.spacing**2) / islands.points], 1
        )
        if by_fit:
            spheres = np.where(np.isfinite(islands.fits), islands.fits, spheres)
        first = np.where(islands.levels == lowest, 0, islands.levels * stride)
        touching = Ranges(first, np.minimum((islands.levels + 1) * stride, self._first_without_contact(islands.tops)))
        high = summits.tops >= lowest * levels.step
        apart = Ranges(self._first_without_contact(summits.tops[high]), np.full(high.sum(), grid.above))
        return Summits(
            np.append(spheres[:, 0], summits.tops[high]),
            np.append(spheres[:, 1], summits.curvatures[high]),
            summits.area,
            Ranges(*map(np.append, touching, apart)),
        )

    def _first_without_contact(self, tops):
        """Numbers of the first distances without contact of asperities with these tops (m,) [m]."""
        return np.floor(tops / self.step).astype(int) + 1

    def bearing_area(self, heights: np.ndarray) -> np.ndarray:
        """Share A of z (n1, n2) [m] above the distances ``distances.bearing``, (n_bearing,) [-]."""
        grid = self.distances
        return bearing_area(heights, grid.step, grid.below, grid.above)


@dataclass(frozen=True)
class SurfacePair(EquivalentSurface):
    """Two surfaces in contact."""

    asperity: Asperity = field(kw_only=True)  #: model of one summit

    def contact(self, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solid pressure and bearing area of one equivalent surface.

        Parameters
        ----------
        heights : (n1, n2) float32 array
            z [m].

        Returns
        -------
        solid_pressure : (n_solid,) array
            p_s at ``distances.solid`` [Pa].
        bearing_area : (n_bearing,) array
            A at ``distances.bearing`` [-].
        """
        solid = solid_pressure(self.asperity, self.asperities(heights), self.distances)
        return solid, self.bearing_area(heights)


def solid_pressure(asperity: Asperity, summits: Summits, distances: DistanceGrid) -> np.ndarray:
    """Pressure p_s of the asperities at ``distances.solid``, (n_solid,) [Pa]."""
    force = np.zeros(distances.above)
    asperity.add_forces(summits.tops, summits.curvatures, distances.step, force, summits.between)
    return force / summits.area


@kernel
def bearing_area(heights: np.ndarray, step: float, below: int, above: int) -> np.ndarray:
    """Fraction of the points higher than each distance, ``step * arange(-below, above)`` [-]."""
    cells = np.empty(heights.shape[1], np.int32)
    count = np.zeros(below + above + 1, np.int64)
    for i in range(heights.shape[0]):
        _cells_below(heights[i], step, below, above, cells)
        for cell in cells:
            count[np.uint32(cell)] += 1
    area = np.zeros(below + above)
    higher = 0
    for k in range(below + above, 0, -1):
        higher += count[k]
        area[k - 1] = higher / heights.size
    return area


@kernel
def _cells_below(heights, step, below, above, cells):
    """Number of distances ``step * arange(-below, above)`` not above each point of a row."""
    inverse = np.float32(1 / step)
    lowest, highest = np.float32(-below - 1), np.float32(above - 1)
    for j in range(heights.size):
        cell = min(max(np.floor(heights[j] * inverse), lowest), highest)
        cells[j] = np.int32(cell) + np.int32(below + 1)


def contacts_of_samples(
    pairs: Sequence[SurfacePair],
    streams: Callable[[int], tuple[np.random.Generator, np.random.Generator]],
    samples: Iterable[int],
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Contact of numbered samples of several pairs with the same random numbers.

    For each pair (n, n_solid) pressures [Pa] and (n, n_bearing) areas [-], both float32. ``streams(k)`` returns the
    streams of the two surfaces of sample k; its result does not depend on other samples.

    A surface that is the same object in several pairs is drawn once for all of them.
    """
    contacts = [([], []) for _ in pairs]
    for k in samples:
        for curves, pair, heights in zip(contacts, pairs, _equivalent_surface(pairs, streams, k), strict=True):
            for column, curve in zip(curves, pair.contact(heights), strict=True):
                column.append(curve.astype(np.float32))
    return [(np.array(solid), np.array(bearing)) for solid, bearing in contacts]


def _equivalent_surface(pairs, streams, sample):
    """Equivalent surface of one sample of each pair."""
    if len(pairs) == 1:  # the second surface is added in place, which needs no array of its heights
        yield pairs[0].draw(*streams(sample))
        return
    strips = {}
    for pair in pairs:
        above = (id(pair.beam), id(pair.substrate)) if pair.replica else id(pair.beam)
        if above not in strips:
            rngs = streams(sample)
            strips[above] = pair.replica.draw_beam(*rngs) if pair.replica else pair.beam.draw(rngs[0])
        below = "substrate", id(pair.substrate)
        if below not in strips:
            strips[below] = pair.substrate.draw(streams(sample)[1])
        heights = strips[above] + strips[below]
        yield np.ascontiguousarray(heights[:: pair.every, :: pair.every])

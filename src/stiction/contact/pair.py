r"""Semi-analytical adhesive contact of two rough surfaces (Sec. III-A2), free of humidity.

The pair is an equivalent surface z = z₁ + z₂ against a flat at the distance d between the mean planes (the means of the
processes, 0). Pressures are positive in repulsion. Two functions of distance hold everything a humidity needs:

.. math:: f(d) = p_s(d) - |\Delta P| \, A(d - h_C)

with the solid pressure p_s (spheres fitted to the summits, Hertz or Maugis) and the bearing area A (share of z > d).
ASSUME: summits below the mean plane never touch.
"""

from dataclasses import dataclass

import numba
import numpy as np

from stiction.contact.asperity import MaugisTable
from stiction.surface.field import RoughSurface, add_heights
from stiction.surface.summits import is_summit, mean_curvature


@dataclass(frozen=True)
class DistanceGrid:
    """Equally spaced distances; the solid touches at positive ones only, the water reaches below."""

    step: float  #: [m]
    below: int  #: number of grid points with negative distance
    above: int  #: number of grid points with distance >= 0

    @classmethod
    def covering(cls, lowest, highest, step):
        """Grid from the lowest (negative) to the highest height of an equivalent surface [m]."""
        return cls(step, int(np.ceil(-lowest / step)), int(np.ceil(highest / step)) + 1)

    @property
    def solid(self):
        """Distances of the solid pressure, (above,) [m]."""
        return self.step * np.arange(self.above)

    @property
    def bearing(self):
        """Distances of the bearing area, (below + above,) [m]."""
        return self.step * np.arange(-self.below, self.above)


@dataclass(frozen=True)
class SurfacePair:
    """Two surfaces that meet, their elasticity and attraction, and the distances of interest."""

    beam: RoughSurface
    substrate: RoughSurface
    solid: MaugisTable  #: one asperity
    step: float  #: of the distances [m]
    every: int = 1  #: summits and area are taken from every n-th point of the drawn grid

    def __post_init__(self):
        beam, substrate = self.beam.grid, self.substrate.grid
        if (beam.shape, beam.spacing) != (substrate.shape, substrate.spacing):
            raise ValueError(
                f"surfaces must meet point by point, got {beam.shape} points every {beam.spacing:.3g} m "
                f"and {substrate.shape} every {substrate.spacing:.3g} m"
            )

    @property
    def distances(self):
        """Grid of the distances, from which no height of z₁ + z₂ stands out."""
        lowest, highest = (float(self.beam.table[end]) + float(self.substrate.table[end]) for end in (0, -1))
        return DistanceGrid.covering(lowest, highest, self.step)

    def draw(self, beam_rng, substrate_rng):
        """Draw one equivalent surface z = z₁ + z₂; (n1, n2) float32 [m]."""
        heights = self.beam.draw(beam_rng)
        add_heights(self.substrate.draw_scores(substrate_rng), self.substrate.table, heights)
        return np.ascontiguousarray(heights[:: self.every, :: self.every])

    def contact(self, heights):
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

        Raises
        ------
        ValueError
            If a summit is too sharp, too blunt or pressed too deeply for the tabulated asperity.
        """
        grid = self.distances
        spacing = self.beam.grid.spacing * self.every
        force = np.zeros(grid.above)
        # ASSUME: a summit stands above its eight neighbours on this grid and is a sphere of its mean curvature there.
        if self.solid.attraction.hamaker_constant > 0:
            outside = _add_maugis(
                heights, spacing, grid.step, self.solid.dimensional, self.solid.snap_off, self.solid.load, force
            )
            if outside:
                raise ValueError(
                    f"{outside} summits leave the table of Maugis' λ {self.solid.transitions} or interference: "
                    "such rms, spectrum or modulus is not provided for"
                )
        else:
            _add_hertz(heights, spacing, grid.step, self.solid.modulus, force)
        # ASSUME: the area is that in which a point can be a summit, 1.4 % less than that of a strip of 1.5 µm, because
        # points on the edge lack neighbours.
        inside = (heights.shape[0] - 2) * (heights.shape[1] - 2) * spacing**2
        return force / inside, bearing_area(heights, grid.step, grid.below, grid.above)


@numba.njit(cache=True, nogil=True)
def bearing_area(heights, step, below, above):
    """Share of the points that stand above each distance, ``step * arange(-below, above)`` [-]."""
    count = np.zeros(below + above + 1)
    inverse = np.float32(1 / step)
    for z in heights.ravel():
        count[min(max(int(np.floor(z * inverse)) + below + 1, 0), below + above)] += 1
    higher = 0.0
    for k in range(below + above, 0, -1):
        higher += count[k]
        count[k] = higher / heights.size
    return count[1:]


@numba.njit(cache=True, nogil=True)
def _add_hertz(heights, spacing, step, modulus, force):
    """Add the Hertz force of every summit at the distances ``step * arange(n)`` [N]."""
    for i in range(1, heights.shape[0] - 1):
        for j in range(1, heights.shape[1] - 1):
            if heights[i, j] > 0 and is_summit(heights, i, j):
                factor = 4 / 3 * modulus / np.sqrt(mean_curvature(heights, i, j, spacing))
                for k in range(min(int(heights[i, j] / step) + 1, len(force))):
                    overlap = max(heights[i, j] - k * step, 0.0)
                    force[k] += factor * overlap * np.sqrt(overlap)


@numba.njit(cache=True, nogil=True)
def _add_maugis(heights, spacing, step, scales, snap_off, load, force):
    """Add the force of every summit, interpolated in the table of one asperity; count summits that leave the table.

    ``scales`` are those of a sphere of radius 1 m: ln λ, interference [m], force [N]; then the first value and the step
    of ln λ, and the step of the root.
    """
    log_transition, unit_interference, unit_force, first, log_step, root_step = scales
    outside = 0
    for i in range(1, heights.shape[0] - 1):
        for j in range(1, heights.shape[1] - 1):
            z = np.float64(heights[i, j])
            if z <= 0 or not is_summit(heights, i, j):
                continue
            radius = 1 / mean_curvature(heights, i, j, spacing)
            third = radius ** (1 / 3)
            place = (log_transition + np.log(third) - first) / log_step
            row = int(np.floor(place))
            if row < 0 or row >= len(snap_off) - 1:
                outside += 1
                continue
            share = place - row
            low, high = load[row], load[row + 1]
            inverse = 1 / (unit_interference * third)
            deepest = (1 - share) * snap_off[row] + share * snap_off[row + 1]
            weight = unit_force * radius
            last = min(int(np.floor((z - deepest / inverse) / step)), len(force) - 1)
            for k in range(last + 1):
                root = np.sqrt(max((z - k * step) * inverse - deepest, 0.0)) / root_step
                cell = int(root)
                if cell >= len(low) - 1:
                    outside += 1
                    continue
                part = root - cell
                below = low[cell] + part * (low[cell + 1] - low[cell])
                above = high[cell] + part * (high[cell + 1] - high[cell])
                force[k] += weight * ((1 - share) * below + share * above)
    return outside


def contact_of_samples(pair, streams, samples):
    """Contact of numbered samples: (n, n_solid) pressures [Pa] and (n, n_bearing) areas [-], both float32.

    ``streams(k)`` makes the streams of the two surfaces of sample k: no result depends on the range it stands in.
    """
    solid_pressure, bearing_areas = [], []
    for k in samples:
        try:
            solid, bearing = pair.contact(pair.draw(*streams(k)))
        except ValueError as error:
            raise ValueError(f"sample {k}: {error}") from error
        solid_pressure.append(solid.astype(np.float32))
        bearing_areas.append(bearing.astype(np.float32))
    return np.array(solid_pressure), np.array(bearing_areas)

"""Contact regions of a rough strip, each solved alone with its true shape (not in the paper).

A region is a connected part of the surface that the flat touches at a distance, or may attract: within twice the reach
of the attraction, because attracted elements rise and lift their neighbours. Its elements displace each other on an
infinite half-space, and no elements of other regions. Compared with a sum over asperities, regions keep the
shape to which a sphere would be fitted; compared with full elastic contact (`stiction.contact.full.elements`), they do
not act on each other. As in the paper, the film of water acts on the undeformed surfaces and is not part of the
pressure.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from stiction.contact import forcelaw
from stiction.contact.full.elements import Adhesion, State, equilibrium
from stiction.contact.full.halfspace import HalfSpace, love
from stiction.contact.pair import DistanceGrid, bearing_area
from stiction.kernels import kernel

#: Between the distances at which contact is computed [m]; with half of it, energies change by less than 1 %.
BETWEEN = 1e-10

#: The eight neighbours of a point.
_AROUND = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))

#: Elements of a strip (m,), and the space in which they displace each other, at the height of the lowest of them [m].
_Within = Callable[[float], tuple[np.ndarray, "HalfSpace | Regions"]]


@dataclass(frozen=True)
class Regions:
    """Elements in one row, region after region, with displacements in their own region alone, as in a half-space."""

    rows: np.ndarray  #: of the elements in the strip (m,) int32
    columns: np.ndarray  #: (m,) int32
    ends: np.ndarray  #: position behind the last element of each region (k,)
    offsets: np.ndarray  #: displacement by an element at each offset (n1, n2) float32 [m Pa⁻¹]
    unit: float  #: Δ/E' [m Pa⁻¹]

    @property
    def shape(self) -> tuple[int, int]:
        """Number of elements."""
        return 1, self.rows.size

    def displacement(self, pressure: np.ndarray) -> np.ndarray:
        """Displacement of all elements (1, m) float32 [m] under pressures on them (1, m) float32 [Pa]."""
        return _displacement(pressure, self.rows, self.columns, self.ends, self.offsets)


def alone(heights: np.ndarray, space: HalfSpace) -> _Within:
    """Regions of a strip of heights z (n1, n2) float32 [m], connected across corners and, if periodic, across ends."""
    along = [np.minimum(k, n - k) if space.periodic else k for n in space.shape for k in [np.arange(n)]]
    offsets = (space.unit * love(*np.ix_(*along))).astype(np.float32)

    def within(level):
        """Places of the points above a level [m], and their regions."""
        positions, ends = _connected(heights, level, space.periodic)
        rows, columns = (k.astype(np.int32) for k in np.unravel_index(positions, heights.shape))
        return positions, Regions(rows, columns, ends, offsets, space.unit)

    return within


def together(space: HalfSpace) -> _Within:
    """All elements of a strip, with mutual displacements."""
    elements = np.arange(space.shape[0] * space.shape[1])
    return lambda level: (elements, space)


@dataclass(frozen=True)
class Strip:
    """Strip of heights z and films of water on its undeformed surfaces, as in Sec. III-A."""

    heights: np.ndarray  #: z (n1, n2) float32 [m]
    grid: DistanceGrid  #: distances
    films: Sequence[tuple[float, float]]  #: height [m] and tension [Pa] at each humidity

    @cached_property
    def bearing_area(self) -> np.ndarray:
        """Share A of z above ``grid.bearing`` (n_bearing,) [-]."""
        return bearing_area(self.heights, self.grid.step, self.grid.below, self.grid.above)

    @cached_property
    def pull(self) -> np.ndarray:
        """Largest tension of all films per apparent area at ``grid.solid`` (n_solid,) [Pa]."""
        no_pressure = np.zeros(self.grid.above)
        return np.max([-self._curve(no_pressure, film)[1][: self.grid.above] for film in self.films], axis=0)

    def energies(self, solid: np.ndarray) -> list[float]:
        """Adhesion energy e under each film [J m⁻²], for a pressure at the last distances of ``grid.solid`` [Pa]."""
        return [forcelaw.adhesion_energy(*self._curve(solid, film)) for film in self.films]

    def _curve(self, solid, film):
        """Distances [m] and force [Pa] under a film."""
        starts = float(self.grid.solid[-len(solid)]), float(self.grid.bearing[0])
        distance, curve = forcelaw.humid_curves(solid[None], self.bearing_area[None], starts, self.grid.step, film)
        return distance, curve(0)


def solid_pressure(strip: Strip, within: _Within, attraction: Adhesion) -> np.ndarray:
    """Pressure of the solids p_s at the last distances of ``grid.solid`` (n,) [Pa], until it exceeds the water's pull.

    ``within`` is `alone` or `together`, and the attraction that of the solids, without a film.

    ASSUME: where several states have the same distance, the strip is in the one that it reaches during approach. The
    energies of the pairs of the paper are less than 1 % larger in those that it reaches during separation.
    """
    grid, heights = strip.grid, strip.heights.ravel()
    numbers = np.arange(grid.above - 1, -1, -max(round(BETWEEN / grid.step), 1))
    reach = 2 * attraction.reach
    pressure, pull = np.zeros((2, heights.size), np.float32)
    pressures = []
    for number in numbers:
        distance = float(grid.solid[number])
        points, space = within(distance - reach)
        if not points.size:
            pressures.append(0.0)
            continue
        z, *before = (values[points].reshape(space.shape) for values in (heights, pressure, pull))
        state = equilibrium(space, z, distance, attraction, State(distance, *before, z, 0))
        pressure[points], pull[points] = state.pressure.ravel(), state.attraction.ravel()
        pressures.append(state.force * points.size / heights.size)
        if pressures[-1] > strip.pull[number]:
            break
    solved = numbers[: len(pressures)][::-1]
    return PchipInterpolator(solved, pressures[::-1])(np.arange(solved[0], grid.above))


@kernel
def _connected(heights, level, periodic):
    """Places of the points above a level (m,), region after region, and the end of each region (k,)."""
    rows, columns = heights.shape
    unseen = heights.ravel() > level
    positions, ends = np.empty(unseen.sum(), np.int64), np.empty(unseen.sum(), np.int64)
    end, head, regions = 0, 0, 0
    for first in range(unseen.size):
        if unseen[first]:
            unseen[first] = False
            positions[end] = first
            end += 1
            while head < end:
                i, j = positions[head] // columns, positions[head] % columns
                head += 1
                for down, right in _AROUND:
                    row, column = i + down, j + right
                    if periodic or (0 <= row < rows and 0 <= column < columns):
                        position = row % rows * columns + column % columns
                        if unseen[position]:
                            unseen[position] = False
                            positions[end] = position
                            end += 1
            ends[regions] = end
            regions += 1
    return positions, ends[:regions].copy()


@kernel
def _displacement(pressure, rows, columns, ends, offsets):
    """Sum over the elements of each region."""
    displacement, first = np.zeros_like(pressure), 0
    for end in ends:
        for source in range(first, end):
            if pressure[0, source] != 0:
                i, j = rows[source], columns[source]
                for k in range(first, end):
                    displacement[0, k] += pressure[0, source] * offsets[abs(rows[k] - i), abs(columns[k] - j)]
        first = end
    return displacement

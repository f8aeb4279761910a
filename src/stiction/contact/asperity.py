r"""Contact of a sphere with a flat: Hertz and, with a Dugdale attraction, Maugis (Sec. III-A2).

Forces are positive in repulsion, interferences positive in overlap. Maugis' theory is written in

.. math:: \bar P = \frac{P}{\pi w R}, \quad \bar a = \frac{a}{(\pi w R^2/K)^{1/3}}, \quad
          \bar\delta = \frac{\delta}{(\pi^2 w^2 R/K^2)^{1/3}}, \quad
          \lambda = 2\sigma_0 \left(\frac{R}{\pi w K^2}\right)^{1/3}, \quad K = \tfrac43 E' ;

λ → 0 is DMT, λ → ∞ is JKR. ASSUME: where several states have the same interference, the sphere is in the one of
largest contact, as during separation.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from stiction.kernels import kernel


class Attraction(Protocol):
    """Attraction of two flats as a constant stress over a short range (Dugdale), the input of Maugis' theory."""

    @property
    def work_of_adhesion(self) -> float:
        """Work per area w to separate the flats [J m⁻²]."""

    @property
    def stress(self) -> float:
        """Tension σ₀ within the range, positive [Pa]."""


def reduced_modulus(young_modulus: float, poisson_ratio: float) -> float:
    """Modulus E' of two equal bodies, below Eq. (14) [Pa]."""
    return young_modulus / (2 * (1 - poisson_ratio**2))


def hertz_force(interference: float | np.ndarray, radius: float | np.ndarray, modulus: float) -> float | np.ndarray:
    """Elastic force of a sphere on a flat [N], from interference [m], radius [m] and reduced modulus [Pa]."""
    return 4 / 3 * modulus * np.sqrt(radius) * np.maximum(interference, 0) ** 1.5


def hertz_maximum_stress(
    interference: float | np.ndarray, radius: float | np.ndarray, modulus: float
) -> float | np.ndarray:
    """Largest contact stress, Eq. (14) [Pa], from interference [m], radius [m] and reduced modulus [Pa]."""
    return 2 / np.pi * modulus * np.sqrt(np.maximum(interference, 0) / radius)


def transition_parameter(radius: float, modulus: float, attraction: Attraction) -> float:
    """Maugis' λ of a sphere of ``radius`` [m] [-]."""
    stiffness = 4 / 3 * modulus
    return 2 * attraction.stress * (radius / (np.pi * attraction.work_of_adhesion * stiffness**2)) ** (1 / 3)


def interference_scale(radius: float, modulus: float, attraction: Attraction) -> float:
    """Unit of the interference in Maugis' theory [m]."""
    return (np.pi**2 * attraction.work_of_adhesion**2 * radius / (4 / 3 * modulus) ** 2) ** (1 / 3)


def maugis_in_contact(spread: np.ndarray, transition: float) -> tuple[np.ndarray, np.ndarray]:
    """State of a sphere in contact, in closed form.

    Parameters
    ----------
    spread : (n,) array
        √(m² - 1) with m = c/a, the ratio of adhesive to contact radius [-].
    transition : float
        λ [-].

    Returns
    -------
    load, interference : (n,) arrays
        P̄ and δ̄ [-].
    """
    u, t, m = spread, np.arctan(spread), np.hypot(spread, 1)
    quadratic = 0.5 * transition * (u + (u**2 - 1) * t)
    linear = 4 / 3 * transition**2 * (u * t - m + 1)
    a = 2 / (linear + np.sqrt(linear**2 + 4 * quadratic))
    load = a**3 - transition * a**2 * (u + m**2 * t)
    return load, a**2 - 4 / 3 * transition * a * u


def maugis_apart(
    adhesive_radius: float | np.ndarray, transition: float
) -> tuple[float | np.ndarray, float | np.ndarray]:
    """State of a sphere without contact, held by the attraction only: P̄ and δ̄ for the radius c̄, (n,) [-]."""
    c = adhesive_radius
    load = -0.5 * np.pi * transition * c**2
    return load, 0.5 * c**2 - 8 / (3 * np.pi) * transition * c - 2 / (np.pi * transition)


def touching_radius(transition: float) -> float:
    """Adhesive radius c̄ at first contact: the limit m → ∞ of the closure [-]."""
    quadratic, linear = 0.25 * np.pi * transition, 4 / 3 * transition**2 * (0.5 * np.pi - 1)
    return 2 / (linear + np.sqrt(linear**2 + 4 * quadratic))


def maugis_branch(transition: float, points: int = 6000) -> tuple[np.ndarray, np.ndarray]:
    """Loads and interferences from deep contact to separation, ordered by interference.

    Returns
    -------
    load, interference : (n,) arrays
        P̄ and δ̄ of the stable states [-]; the first is the point of snap-off.
    """
    # The spread falls with the depth of contact; the closure loses digits to cancellation there. This end is deeper
    # than δ̄ = 1e3 for any λ.
    spread = np.geomspace(min(1e-2, 0.1 / transition), 1e4, points)
    touching = touching_radius(transition)
    radius = np.linspace(touching, min(touching, 8 * transition / (3 * np.pi)), points)
    load, interference = np.hstack([maugis_in_contact(spread, transition), maugis_apart(radius, transition)])
    fold = np.argmin(interference)
    return load[fold::-1], interference[fold::-1]


@kernel
def deep_load(interference: float) -> float:
    r"""Load P̄ of a sphere in deep contact at an interference δ̄ [-]: the limit of Maugis' theory for any λ.

    .. math:: \bar P = \bar\delta^{3/2} - 1

    The attraction lowers the interference as much as the load, so that only a constant distinguishes the load from that
    of Hertz. For JKR, :math:`\bar P = \bar a^3 - \bar a \sqrt{6 \bar a}` and :math:`\bar\delta = \bar a^2 - \tfrac23
    \sqrt{6 \bar a}`, the expansion in 1/ā shows it. For δ̄ > 800 and λ > 0.01 the load exceeds that of Maugis by less
    than 0.07 πwR, 3e-6 of the load.
    """
    return interference * np.sqrt(interference) - 1


@kernel
def weak_load(interference: float, transition: float) -> float:
    r"""Load P̄ of a sphere at an interference δ̄ and a small λ [-]: the limit λ → 0 of Maugis' theory, DMT.

    .. math:: \bar P = \max(\bar\delta, 0)^{3/2} - 2 \min\bigl(1 + \tfrac\pi2 \lambda \bar\delta, 1\bigr) ,
              \quad \bar\delta > -\frac{2}{\pi\lambda}

    For λ < 0.01 the load of Maugis is equal to 0.003 πwR without contact, and higher by at most 1 πwR in contact: 2e-3
    of the load at an interference as large as the range of the attraction.
    """
    return max(interference, 0.0) ** 1.5 - 2 * min(max(1 + 0.5 * np.pi * transition * interference, 0.0), 1.0)


class Ranges(NamedTuple):
    """Ranges of the distances with spheres in place of asperities."""

    first: np.ndarray  #: number of the first distance of each, (m,) int32
    end: np.ndarray  #: number of the distance behind the last, (m,) int32


def everywhere(spheres: int, distances: int) -> Ranges:
    """Ranges of spheres at all distances, from the number of spheres and of distances."""
    return Ranges(np.zeros(spheres, np.int32), np.full(spheres, distances, np.int32))


class Asperity(Protocol):
    """Elastic sphere on a flat. Interchangeable models of one asperity."""

    def force(self, interference: float | np.ndarray, radius: float) -> float | np.ndarray:
        """Force [N] of a sphere of this radius [m] at interferences (n,) [m]."""

    def add_forces(
        self, tops: np.ndarray, curvatures: np.ndarray, step: float, force: np.ndarray, between: Ranges | None = None
    ) -> None:
        """Add the force of all spheres of an equivalent surface on a flat.

        Parameters
        ----------
        tops, curvatures : (m,) float64 arrays
            Height [m] and mean curvature [m⁻¹] of each sphere; those below the mean plane are left out.
        step : float
            Of the distances [m].
        force : (n,) float64 array
            Receives the sum at the distances ``step * arange(n)`` [N].
        between : Ranges, optional
            Distances at which each sphere is in force; all by default.
        """


@dataclass(frozen=True)
class HertzAsperity:
    """`Asperity` without attraction."""

    modulus: float  #: reduced modulus E' [Pa]

    def force(self, interference: float | np.ndarray, radius: float) -> float | np.ndarray:
        """Elastic force, see `Asperity`."""
        return hertz_force(interference, radius, self.modulus)

    def add_forces(
        self, tops: np.ndarray, curvatures: np.ndarray, step: float, force: np.ndarray, between: Ranges | None = None
    ) -> None:
        """Add the elastic force of all spheres, see `Asperity`."""
        _add_hertz((tops, curvatures), between or everywhere(tops.size, force.size), step, self.modulus, force)


class TableScales(NamedTuple):
    """Scales of a sphere of radius 1 m and spacing of a `MaugisTable`."""

    log_transition: float  #: ln λ of that sphere [-]
    interference: float  #: unit of the interference in Maugis' theory [m]
    force: float  #: πw [N]
    first: float  #: ln λ of the first row of `MaugisTable.transitions` [-]
    before: int  #: number of rows before it
    log_step: float  #: of ln λ [-]
    root_step: float  #: of √(δ̄ - δ̄_min) [-]


@dataclass(frozen=True)
class MaugisTable:
    """`Asperity` with attraction: its load tabulated over ln λ and √(δ̄ - δ̄_min).

    The square root removes the vertical tangent of the load at the point of snap-off. Beyond the table the load has the
    closed form of deep contact, `deep_load`, beyond its last row that of this row: JKR within 3e-3 πwR, and before its
    first row that of λ → 0, `weak_load`: DMT.
    """

    modulus: float  #: reduced modulus E' [Pa]
    attraction: Attraction

    #: Range of λ and of √(δ̄ - δ̄_min), and their numbers of points.
    transitions = (0.03, 6.0, 128)
    roots = (0.0, 30.0, 4096)
    #: Numbers of further rows below and above this range of λ, at the same ratio: from 0.01 to 20.
    further = (27, 29)

    @cached_property
    def rows(self) -> np.ndarray:
        """Tabulated λ, (n_λ,) [-]."""
        low, high, n = self.transitions
        ratio, (below, above) = (high / low) ** (1 / (n - 1)), self.further
        inner = np.geomspace(low, high, n)
        return np.hstack([low * ratio ** np.arange(-below, 0.0), inner, high * ratio ** np.arange(1.0, above + 1)])

    @cached_property
    def _tabulated(self):
        """`snap_off` and `load`: one branch at a time, because a branch has three times as many points as its row."""
        root, rows = np.linspace(*self.roots), []
        for load, delta in map(maugis_branch, self.rows):
            rows.append((delta[0], np.interp(root, np.sqrt(delta - delta[0]), load)))
        return tuple(map(np.array, zip(*rows, strict=True)))

    @property
    def snap_off(self) -> np.ndarray:
        """Interference δ̄_min of every tabulated λ, (n_λ,) [-]."""
        return self._tabulated[0]

    @property
    def load(self) -> np.ndarray:
        """Load P̄, (n_λ, n_root) [-]."""
        return self._tabulated[1]

    @property
    def scales(self) -> TableScales:
        """Scales to make the table dimensional."""
        low, high, n = self.transitions
        return TableScales(
            log_transition=float(np.log(transition_parameter(1.0, self.modulus, self.attraction))),
            interference=float(interference_scale(1.0, self.modulus, self.attraction)),
            force=float(np.pi * self.attraction.work_of_adhesion),
            first=float(np.log(low)),
            before=self.further[0],
            log_step=float(np.log(high / low) / (n - 1)),
            root_step=float(self.roots[1] / (self.roots[2] - 1)),
        )

    def force(self, interference: float | np.ndarray, radius: float) -> float | np.ndarray:
        """Force of one sphere without interpolation in λ [N], 0 beyond snap-off. Interference (n,) [m], radius [m]."""
        load, delta = maugis_branch(transition_parameter(radius, self.modulus, self.attraction), 20000)
        scaled = np.asarray(interference) / interference_scale(radius, self.modulus, self.attraction)
        interpolated = np.interp(np.sqrt(np.maximum(scaled - delta[0], 0)), np.sqrt(delta - delta[0]), load)
        return np.pi * self.attraction.work_of_adhesion * radius * np.where(scaled < delta[0], 0.0, interpolated)

    def add_forces(
        self, tops: np.ndarray, curvatures: np.ndarray, step: float, force: np.ndarray, between: Ranges | None = None
    ) -> None:
        """Add the force of all spheres by interpolation in the table, see `Asperity`."""
        between = between or everywhere(tops.size, force.size)
        _add_maugis((tops, curvatures), between, step, self.scales, self.snap_off, self.load, force)


@lru_cache(maxsize=4)  # the table of Maugis takes longer than the contact of ten strips
def asperity(modulus: float, attraction: Attraction | None) -> Asperity:
    """Model of one asperity of reduced modulus E' [Pa]: Maugis with attraction, Hertz without."""
    return HertzAsperity(modulus) if attraction is None else MaugisTable(modulus, attraction)


@kernel
def _add_hertz(spheres, between, step, modulus, force):
    """Add the Hertz force of every sphere (tops, curvatures) at its distances ``step * arange(first, end)`` [N]."""
    tops, curvatures = spheres
    for n in range(tops.size):
        if tops[n] > 0:
            factor = 4 / 3 * modulus / np.sqrt(curvatures[n])
            for k in range(between.first[n], min(int(tops[n] / step) + 1, between.end[n])):
                overlap = max(tops[n] - k * step, 0.0)
                force[k] += factor * overlap * np.sqrt(overlap)


@kernel
def _add_maugis(spheres, between, step, scales, snap_off, load, force):
    """Add the Maugis force of every sphere (tops, curvatures) at its distances, by interpolation in the table."""
    (tops, curvatures), roots = spheres, np.empty(force.size)
    for n in range(tops.size):
        if tops[n] > 0:
            first, end = between.first[n], between.end[n]
            sphere = tops[n] - first * step, 1 / curvatures[n]
            _add_sphere(sphere, step, scales, snap_off, load, roots, force[first:end])


@kernel
def _add_sphere(sphere, step, scales, snap_off, load, roots, force):
    """Add the force of one sphere (top, radius). ``roots``: workspace."""
    top, radius = sphere
    third = radius ** (1 / 3)
    position = (scales.log_transition + np.log(third) - scales.first) / scales.log_step
    row = int(np.floor(position))
    share = position - row
    row += scales.before
    inverse, weight = 1 / (scales.interference * third), scales.force * radius
    if row < 0:  # DMT
        transition = np.exp(scales.log_transition) * third
        for k in range(force.size):
            force[k] += weight * weak_load((top - k * step) * inverse, transition)
        return
    if row >= len(snap_off) - 1:  # JKR
        row, share = len(snap_off) - 2, 1.0
    deepest = (1 - share) * snap_off[row] + share * snap_off[row + 1]
    count = min(max(int(np.floor((top - deepest / inverse) / step)) + 1, 0), len(force))
    _roots(top, step, inverse, deepest, scales.root_step, roots[:count])
    deep = 0  # number of distances beyond the table; the root falls with the distance
    while deep < count and roots[deep] >= load.shape[1] - 1:
        force[deep] += weight * deep_load((top - deep * step) * inverse)
        deep += 1
    _add_loads(roots[deep:count], load[row], load[row + 1], share, weight, force[deep:])


# Two loops, because only one without a look-up computes several distances at a time.


@kernel
def _roots(top, step, inverse, deepest, root_step, roots):
    """Places √(δ̄ - δ̄_min) of a sphere in the table at the distances ``step * arange(n)``, in steps of the table."""
    for k in range(roots.size):
        beyond = (top - np.int32(k) * step) * inverse - deepest
        roots[k] = np.sqrt(max(beyond, 0.0)) / root_step


@kernel
def _add_loads(roots, low, high, share, weight, force):
    """Add ``weight`` times the load between two rows of the table, at these places of their columns."""
    for k in range(roots.size):
        cell = np.uint32(np.int32(roots[k]))  # without a sign, so that it cannot count from the end of a row
        fraction = roots[k] - cell
        below = low[cell] + fraction * (low[cell + np.uint32(1)] - low[cell])
        above = high[cell] + fraction * (high[cell + np.uint32(1)] - high[cell])
        force[k] += weight * ((1 - share) * below + share * above)

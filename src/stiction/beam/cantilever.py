r"""The micro cantilever on rough ground (Sec. III-C): Euler-Bernoulli elements with one random force law per point.

Conventions, used everywhere: x runs from the clamp (x = 0) to the free end (x = L); the deflection u is positive
towards the substrate, so that the distance is ``d = gap - u``; a force law is positive when it repels (Eq. 12). Each
node carries ``[u, u']`` [m, -]. Inside the compiled code the slope is stored times the element length, so that every
degree of freedom is a length and every residual a force.

Laws are rows ``[f_max, d_max, a_left, a_right]`` (SI) of shape (points, 4). Point r sits in the middle of the r-th of
``points`` equal segments of the beam; ``points`` is a multiple of ``elements``, and (0, 4) is a beam without contact.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numba import njit

from stiction.errors import NotConverged

#: Largest unbalanced force of an equilibrium, in units of the mean pull f_max w l_quad of a point (about 1e-4 N).
TOLERANCE = 1e-6
#: Rounding of the bending forces, in units of 12 EI/l_e³ h: added to the tolerance, because no step can get below it.
ROUNDING = 64 * np.finfo(float).eps
#: Newton steps after which an equilibrium is given up; a crack that opens over most of the beam takes about 1000.
MAX_ITERATIONS = 20_000

#: Beyond d_max + REACH / a_right a law carries less than 1e-12 f_max and counts as no force.
REACH = 30.0
#: A step may change a distance by this share of the length 1/a of its law, by more where the point is far outside.
STEP = 0.6
#: Elements ahead of the crack front that move with it in every step; the others follow in each WHOLE-th.
AHEAD, WHOLE = 6, 64


class EndState(IntEnum):
    """How a released beam ends."""

    S_SHAPE = 0  #: adheres beyond the crack
    ARC = 1  #: only the tip holds
    FREE = 2  #: no contact


@dataclass(frozen=True)
class Beam:
    """A cantilever above a substrate and its mesh, Fig. 1 and Sec. IV."""

    length: float  #: L [m]
    width: float  #: w [m]
    thickness: float  #: t [m]
    young_modulus: float  #: E [Pa]
    gap: float  #: h, height of the clamp above the substrate [m]
    elements: int  #: N_e [-]

    def __post_init__(self):
        for name, value in vars(self).items():
            if not (value > 0 and np.isfinite(value)):
                raise ValueError(f"{name} of a beam must be positive, got {value}")
        if self.elements != int(self.elements):
            raise ValueError(f"a beam needs a whole number of elements, got {self.elements}")

    @property
    def second_moment(self):
        """Second moment of area, w t³ / 12 [m⁴]."""
        return self.width * self.thickness**3 / 12

    @property
    def bending_stiffness(self):
        """E I [N m²]."""
        return self.young_modulus * self.second_moment

    @property
    def element_length(self):
        """l_e [m]."""
        return self.length / self.elements

    @property
    def nodes(self):
        """Positions of the nodes, (elements + 1,) [m]."""
        return np.linspace(0, self.length, self.elements + 1)


@dataclass(frozen=True)
class Equilibrium:
    """A beam in balance."""

    deflection: np.ndarray  #: [u, u'] of every node, (elements + 1, 2) [m, -]
    imbalance: float  #: largest unbalanced force [N]
    iterations: int  #: Newton steps


class _Mesh(NamedTuple):
    """What the compiled code knows of a beam and its load."""

    shape: np.ndarray  # Hermite functions at the points of an element, (points per element, 4)
    stiffness: float  # EI / l_e³ [N/m]
    gap: float  # [m]
    area: float  # of one point, w l_quad [m²]
    load: float  # uniform load times l_e [N]
    tip_force: float  # [N]


class _System(NamedTuple):
    """The linear system of one Newton step: upper band, right-hand side, and where each point stands in its law."""

    band: np.ndarray  # (2 nodes + 3, 4) [N/m]; row i holds A[i, i:i+4]
    force: np.ndarray  # (2 nodes + 3,): unbalanced force [N], after the solution the step [m]
    stretch: np.ndarray  # a (d - d_max) of every point [-]


def hermite(s):
    """Hermite functions at the relative position ``s`` in an element, (..., 4) [-]; for [u, l u'] of its two ends.

    >>> hermite(0.5).tolist()
    [0.5, 0.125, 0.5, -0.125]
    """
    s = np.asarray(s, float)
    return np.stack([1 - 3 * s**2 + 2 * s**3, s - 2 * s**2 + s**3, 3 * s**2 - 2 * s**3, s**3 - s**2], -1)


@njit(cache=True, nogil=True)
def _add_element(u, system, mesh, element):
    """Add bending force, stiffness and load of one element."""
    i, k, load = 2 * element, mesh.stiffness, mesh.load
    band, force = system.band, system.force
    band[i, 0] += 12 * k
    band[i, 1] += 6 * k
    band[i, 2] -= 12 * k
    band[i, 3] += 6 * k
    band[i + 1, 0] += 4 * k
    band[i + 1, 1] -= 6 * k
    band[i + 1, 2] += 2 * k
    band[i + 2, 0] += 12 * k
    band[i + 2, 1] -= 6 * k
    band[i + 3, 0] += 4 * k
    rise = 6 * k * (u[i] - u[i + 2])
    shear = 2 * rise + 6 * k * (u[i + 1] + u[i + 3])
    force[i] += load / 2 - shear
    force[i + 1] += load / 12 - rise - k * (4 * u[i + 1] + 2 * u[i + 3])
    force[i + 2] += load / 2 + shear
    force[i + 3] -= load / 12 + rise + k * (2 * u[i + 1] + 4 * u[i + 3])


@njit(cache=True, nogil=True)
def _add_open_part(u, system, mesh, first):
    """Add the beam from the clamp to node ``first``: without contact it is one long element, exactly."""
    i, k, load = 2 * first, mesh.stiffness, mesh.load
    system.band[i, 0] += 12 * k / first**3
    system.band[i, 1] -= 6 * k / first**2
    system.band[i + 1, 0] += 4 * k / first
    system.force[i] += load * first / 2 - 12 * k / first**3 * u[i] + 6 * k / first**2 * u[i + 1]
    system.force[i + 1] += -load * first**2 / 12 + 6 * k / first**2 * u[i] - 4 * k / first * u[i + 1]


@njit(cache=True, nogil=True)
def _hold(system, node):
    """Keep a node where it is, in the system as it stands between assembly and solution."""
    for i in range(2 * node, 2 * node + 2):
        for k in range(1, 4):
            system.band[i, k] = 0.0
            if i >= k:
                system.band[i - k, k] = 0.0
        system.band[i, 0] = 1.0
        system.force[i] = 0.0


@njit(cache=True, nogil=True)
def _add_points(u, laws, system, mesh, element, viscosity):
    """Add force and tangent of the contact points of one element, Eq. (12), and a dashpot on each that is in reach."""
    i, points = 2 * element, mesh.shape.shape[0]
    for p in range(points):
        r = element * points + p
        n = mesh.shape[p]
        distance = mesh.gap - (n[0] * u[i] + n[1] * u[i + 1] + n[2] * u[i + 2] + n[3] * u[i + 3])
        a = laws[r, 2] if distance < laws[r, 1] else laws[r, 3]
        t = a * (distance - laws[r, 1])
        system.stretch[r] = t
        if t < REACH:
            x = np.exp(-t)
            push = laws[r, 0] * mesh.area * x * (x - 2)
            k = 2 * a * laws[r, 0] * mesh.area * x * (x - 1) + viscosity / (1 + max(t, 0.0)) ** 2
            for row in range(4):
                system.force[i + row] -= n[row] * push
                for column in range(row, 4):
                    system.band[i + row, column - row] += k * n[row] * n[column]


@njit(cache=True, nogil=True)
def _assemble(u, laws, system, mesh, window, viscosity):
    """Fill the system of the elements ``window`` = (first, last); the largest unbalanced force [N]."""
    first, last = window
    rows = slice(2 * first, 2 * last + 2)
    system.band[rows] = 0.0
    system.force[rows] = 0.0
    for element in range(first, last):
        _add_element(u, system, mesh, element)
        _add_points(u, laws, system, mesh, element, viscosity)
    if first > 0:
        _add_open_part(u, system, mesh, first)
    else:
        _hold(system, 0)
    if 2 * last + 2 < u.size:
        _hold(system, last)
    else:
        system.force[2 * last] += mesh.tip_force
    return np.abs(system.force[rows]).max()


@njit(cache=True, nogil=True)
def _solve(band, x, start, stop):
    """Solve rows [start, stop) of a symmetric system by LDLᵀ, in place; False if it is not positive definite.

    Entries that reach beyond ``stop`` are zero, so that no row needs a special case.
    """
    for i in range(start, stop):
        if not band[i, 0] > 0:
            return False
        band[i, 0] = 1 / band[i, 0]
        for k in range(1, 4):
            m = band[i, k] * band[i, 0]
            for j in range(k, 4):
                band[i + k, j - k] -= m * band[i, j]
            x[i + k] -= m * x[i]
    for i in range(stop - 1, start - 1, -1):
        x[i] = band[i, 0] * (x[i] - band[i, 1] * x[i + 1] - band[i, 2] * x[i + 2] - band[i, 3] * x[i + 3])
    return True


@njit(cache=True, nogil=True)
def _largest_move(laws, system, mesh, window):
    """Largest change of distance in the solved step, in units of what it may be [-]."""
    points, step, move = mesh.shape.shape[0], system.force, 0.0
    for element in range(window[0], window[1]):
        i = 2 * element
        for p in range(points):
            r = element * points + p
            t = system.stretch[r]
            if t < REACH:
                n = mesh.shape[p]
                change = n[0] * step[i] + n[1] * step[i + 1] + n[2] * step[i + 2] + n[3] * step[i + 3]
                a = laws[r, 2] if t < 0 else laws[r, 3]
                move = max(move, a * abs(change) / (1 + max(t, 0.0)))
    return move / STEP


@njit(cache=True, nogil=True)
def _step(u, laws, system, mesh, window):
    """Solve and, if it is not much too long, take a step; its length in units of what it may be [-], or infinity."""
    rows = slice(2 * window[0], 2 * window[1] + 2)
    if not _solve(system.band, system.force, rows.start, rows.stop):
        return np.inf
    move = _largest_move(laws, system, mesh, window)
    if move <= 2:
        u[rows] += system.force[rows]
    return move


@njit(cache=True, nogil=True)
def _open(u, laws, mesh, first):
    """First element, from ``first`` on, that still has a point within reach of its law."""
    points, elements = mesh.shape.shape[0], u.size // 2 - 1
    while first < elements:
        distance = mesh.gap - u[2 * first + 2]  # at its end, where an open crack is narrowest
        for r in range(first * points, (first + 1) * points):
            if laws[r, 3] * (distance - laws[r, 1]) < REACH:
                return first
        first += 1
    return first


@njit(cache=True, nogil=True)
def _front(stretch, points, element, elements):
    """First element, from ``element`` on, that has a point closer than d_max."""
    while element < elements:
        for r in range(element * points, (element + 1) * points):
            if stretch[r] <= 0:
                return element
        element += 1
    return element


@njit(cache=True, nogil=True)
def _fill_open_part(u, mesh, first):
    """Bend the nodes between the clamp and ``first``: the cubic to that node and the bow of the load."""
    end, slope = u[2 * first], u[2 * first + 1] * first
    bow = mesh.load * first**4 / (24 * mesh.stiffness)
    for node in range(first):
        s = node / first
        u[2 * node] = end * s**2 * (3 - 2 * s) + slope * s**2 * (s - 1) + bow * (s * (1 - s)) ** 2
        rate = 6 * end * s * (1 - s) + slope * s * (3 * s - 2) + 2 * bow * s * (1 - s) * (1 - 2 * s)
        u[2 * node + 1] = rate / first


@njit(cache=True, nogil=True)
def _relax(u, laws, mesh, tolerance, max_iterations):
    """Let the beam move to its next equilibrium, in place; the largest unbalanced force [N] and the number of steps.

    The contact points carry dashpots, so the beam creeps downhill and cannot jump over a place that would stop it.
    Their viscosity [N/m] keeps the tangent positive definite and the steps short, and fades where neither needs it: the
    last steps are plain Newton. Elements that the crack has left are condensed, those far ahead of it mostly rest.
    """
    elements, points = u.size // 2 - 1, mesh.shape.shape[0]
    system = _System(np.zeros((u.size + 3, 4)), np.zeros(u.size + 3), np.full(laws.shape[0], -1.0))
    steepest = 0.5 * np.max(laws[:, 0] * laws[:, 3]) * mesh.area if laws.size else 0.0
    viscosity, first, front, residual, settled = steepest, 0, 0, np.inf, False
    for iteration in range(max_iterations):
        first = _open(u, laws, mesh, first)
        front = _front(system.stretch, points, max(first, front), elements)
        whole = settled or iteration % WHOLE == 0
        window = (first, elements if whole else min(front + AHEAD, elements))
        residual = _assemble(u, laws, system, mesh, window, viscosity)
        settled = residual <= tolerance
        if settled and whole:
            _fill_open_part(u, mesh, first)
            if _open(u, laws, mesh, 0) >= first:
                return residual, iteration
            first = 0  # the crack has closed again
        elif not settled:
            move = _step(u, laws, system, mesh, window)
            viscosity = max(viscosity, 0.01 * steepest * (move > 1)) * min(max(move, 0.25), 4.0)
    return residual, max_iterations


def _points(beam, laws):
    """Hermite functions at the points of an element, (points per element, 4) [-].

    Raises
    ------
    ValueError
        If the laws are no laws, or do not spread evenly over the elements.
    """
    points, rest = divmod(len(laws), beam.elements)
    if rest:
        raise ValueError(f"{len(laws)} laws do not spread evenly over {beam.elements} elements")
    broken = ~np.all(np.isfinite(laws) & (laws >= 0), axis=1)
    if broken.any():
        raise ValueError(f"law {broken.argmax()} has a negative or no value: {laws[broken.argmax()]}")
    return hermite((np.arange(points) + 0.5) / max(points, 1))


def _mesh(beam, laws, load, tip_force):
    """The beam as the compiled code knows it."""
    shape, l_e = _points(beam, laws), beam.element_length
    area = beam.width * l_e / max(len(shape), 1)
    return _Mesh(shape, beam.bending_stiffness / l_e**3, float(beam.gap), area, float(load) * l_e, float(tip_force))


def allowed_imbalance(beam, pull):
    """Largest unbalanced force of an equilibrium whose points pull with ``pull`` [N] at most, in the mean [N]."""
    return TOLERANCE * pull + ROUNDING * 12 * (beam.bending_stiffness / beam.element_length**3) * beam.gap


def equilibrate(beam, laws, start, load=0.0, tip_force=0.0, max_iterations=MAX_ITERATIONS):
    """Creep from a deflection downhill to the next equilibrium with the substrate (Sec. III-C).

    Parameters
    ----------
    beam : Beam
    laws : (points, 4) float64
        Rows [f_max, d_max, a_left, a_right], SI; (0, 4) without contact.
    start : (elements + 1, 2) array
        Deflection [m] and slope [-] of the nodes.
    load, tip_force : float
        Uniform load [N/m] and force on the free end [N], positive towards the substrate.
    max_iterations : int
        Newton steps after which to give up.

    Returns
    -------
    Equilibrium

    Raises
    ------
    ValueError
        If the laws are not finite and positive, or their number is no multiple of the number of elements.
    NotConverged
        If no equilibrium is found.
    """
    laws = np.ascontiguousarray(laws, float)
    mesh = _mesh(beam, laws, load, tip_force)
    tolerance = allowed_imbalance(beam, laws[:, 0].mean() * mesh.area if len(laws) else 0.0)
    scale = np.array([1, beam.element_length])
    u = (np.asarray(start, float) * scale).ravel()
    imbalance, iterations = _relax(u, laws, mesh, tolerance, max_iterations)
    if not imbalance <= tolerance:
        raise NotConverged("equilibrium of the beam [N]", imbalance, tolerance, iterations)
    return Equilibrium(u.reshape(-1, 2) / scale, imbalance, iterations)


def holding_load(beam, crack):
    """Uniform load that presses a beam without adhesion to an S-shape of this crack length, 72 EI h / l⁴ [N/m].

    It follows from EI u⁽⁴⁾ = q with u = u⁽¹⁾ = 0 at the clamp and u = h, u⁽¹⁾ = u⁽²⁾ = 0 at the end of the crack.
    """
    return 72 * beam.bending_stiffness * beam.gap / crack**4


def s_shape(beam, depth, crack):
    """Deflection under `holding_load` of a beam that touches down at ``depth`` [m]; (elements + 1, 2) [m, -]."""
    s = np.minimum(beam.nodes / crack, 1)
    return depth * np.stack([s**2 * (6 - 8 * s + 3 * s**2), 12 * s * (1 - s) ** 2 / crack], axis=-1)


def _release_from(beam, laws, crack):
    """Press a beam down up to a crack length [m], then let go; Equilibrium."""
    rest = np.mean(laws[:, 1] - np.log(2) / laws[:, 2])  # f(rest) = 0 for the mean law
    start = s_shape(beam, beam.gap - rest, crack)
    held = equilibrate(beam, laws, start, holding_load(beam, crack))
    return equilibrate(beam, laws, held.deflection)


def release(beam, laws, start_crack):
    """Press a beam down and let it go: the crack opens up to the first place that is tough enough (Sec. III-C).

    Parameters
    ----------
    beam : Beam
    laws : (points, 4) float64
        Rows [f_max, d_max, a_left, a_right], SI.
    start_crack : float
        Crack length under the artificial load [m], well short of the expected one. A beam that does not open by half of
        it is pressed down again on half the length, so that no result is the start.

    Returns
    -------
    Equilibrium

    Raises
    ------
    ValueError
        If the crack would have to be so short that the elements do not resolve it.
    NotConverged
        If no equilibrium is found.
    """
    # DEPARTS: the load is taken away at once, not progressively: creeping, the crack cannot run past its place.
    while not start_crack < 2 * beam.element_length:
        end = _release_from(beam, laws, start_crack)
        if crack_length(beam, laws, end.deflection) > 1.5 * start_crack:
            return end
        start_crack /= 2
    raise ValueError(
        f"elements of {beam.element_length:.3g} m do not resolve a crack of {start_crack:.3g} m: take more"
    )


def distances(beam, laws, deflection):
    """Distance to the substrate at the point of each law, (points,) [m]."""
    ends = deflection * [1, beam.element_length]
    return beam.gap - (np.hstack([ends[:-1], ends[1:]]) @ _points(beam, laws).T).ravel()


def crack_length(beam, laws, deflection):
    """First place from the clamp, between points, where d < d_max; the whole length if there is none [m].

    ASSUME: the paper does not say where a crack ends; here it ends where the attraction has passed its maximum.
    """
    excess = distances(beam, laws, deflection) - laws[:, 1]
    r = int(np.argmax(excess < 0))
    if excess[r] >= 0:
        return beam.length
    before = excess[r - 1] if r else np.inf
    behind = excess[r] / (before - excess[r]) if r else 0.0
    return (r + 0.5 + behind) * beam.length / len(laws)


def end_state(beam, laws, deflection):
    """Whether a beam ends S-shaped, as an arc or free; EndState.

    ASSUME: an arc leaves its crack with the slope 3h/2l of a cantilever on a simple support, an S-shape with none, and
    the nearer of the two counts; the paper speaks of S-shapes only.
    """
    if np.all(distances(beam, laws, deflection) >= laws[:, 1]):
        return EndState.FREE
    crack = crack_length(beam, laws, deflection)
    slope = np.interp(crack, beam.nodes, deflection[:, 1])
    return EndState.ARC if slope > 0.75 * beam.gap / crack else EndState.S_SHAPE

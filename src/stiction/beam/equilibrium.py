"""Equilibrium of a beam in contact: Euler-Bernoulli elements, Newton's method with dashpots (Sec. III-C).

Inside the compiled code the slope is multiplied by the element length, so that every degree of freedom is a length and
every residual a force.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.foundation import foundation_length
from stiction.beam.tension import SLACK, add_open_part_in_tension, add_tension, fill_open_part_in_tension
from stiction.errors import NotConverged
from stiction.kernels import kernel

#: Largest unbalanced force of an equilibrium, in units of a point's mean pull-off force f_max w l_quad (about 1e-4 N).
TOLERANCE = 1e-6
#: Rounding of the bending forces, in units of 12 EI/l_e³ h: added to the tolerance, as a lower bound of the residual.
ROUNDING = 64 * np.finfo(float).eps
#: Largest number of Newton steps; a crack that opens over most of the beam takes about 1000.
MAX_ITERATIONS = 20_000

#: Beyond d_max + REACH / a_right a law is below 1e-12 f_max and is neglected.
REACH = 30.0
#: Largest change of a distance in one step, as a share of the length 1/a of its law; more where the point is far off.
STEP = 0.6
#: Smallest and largest factor of the viscosity from step to step.
SLOWER, FASTER = 0.5, 4.0
#: Least viscosity of steps longer than a tenth of the allowed ones, in units of the mean slope of the laws; that of
#: shorter steps is in proportion to their length. With less, the crack passes shallow places of arrest: of 4000 beams
#: on the paper's pairs a, b and c, seven do with nearly none and one with half of it.
LEAST = 0.1
#: The beam that moves with the crack front in every step reaches this many foundation lengths and this many elements
#: ahead of it; the rest follows in every FULL_PERIOD-th step. A beam held closer to the front passes places of arrest.
AHEAD, AHEAD_ELEMENTS, FULL_PERIOD = 12.0, 6, 64


@dataclass(frozen=True)
class Equilibrium:
    """Beam in equilibrium."""

    deflection: np.ndarray  #: [u, u'] of every node, (elements + 1, 2) [m, -]
    imbalance: float  #: largest unbalanced force [N]
    iterations: int  #: Newton steps, among them those that were rejected


class Mesh(NamedTuple):
    """Mesh, stiffness and load of a beam as the compiled code uses them."""

    hermite: np.ndarray  # Hermite functions at the points of an element, (points per element, 4)
    points_per_element: int
    stiffness: float  # EI / l_e³ [N/m]
    gap: float  # [m]
    area: float  # of one point, w l_quad [m²]
    load: float  # uniform load times l_e [N]
    tip_force: float  # [N]
    decay: float  # √(N/EI) l_e [-]; 0 without tension


class System(NamedTuple):
    """Linear system of one Newton step: upper band, right-hand side, and position of each point on its law."""

    band: np.ndarray  # (2 nodes + 3, 4) [N/m]; row i holds A[i, i:i+4]
    force: np.ndarray  # (2 nodes + 3,): unbalanced force [N], after the solution the step [m]
    stretch: np.ndarray  # a (d - d_max) of every point [-]


def hermite(s: float | np.ndarray) -> np.ndarray:
    """Hermite functions for [u, l u'] of both ends at the relative position ``s`` in an element, (..., 4) [-].

    >>> hermite(0.5).tolist()
    [0.5, 0.125, 0.5, -0.125]
    """
    s = np.asarray(s, float)
    return np.stack([1 - 3 * s**2 + 2 * s**3, s - 2 * s**2 + s**3, 3 * s**2 - 2 * s**3, s**3 - s**2], -1)


@kernel
def add_element(u, system, mesh, element):
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


@kernel
def _add_open_part(u, system, mesh, first):
    """Add the beam from the clamp to node ``first``: without contact, a single long element is exact."""
    i, k, load = 2 * first, mesh.stiffness, mesh.load
    system.band[i, 0] += 12 * k / first**3
    system.band[i, 1] -= 6 * k / first**2
    system.band[i + 1, 0] += 4 * k / first
    system.force[i] += load * first / 2 - 12 * k / first**3 * u[i] + 6 * k / first**2 * u[i + 1]
    system.force[i + 1] += -load * first**2 / 12 + 6 * k / first**2 * u[i] - 4 * k / first * u[i + 1]


@kernel
def _hold(system, node):
    """Fix a node in the assembled system, before its solution."""
    for i in range(2 * node, 2 * node + 2):
        for k in range(1, 4):
            system.band[i, k] = 0.0
            if i >= k:
                system.band[i - k, k] = 0.0
        system.band[i, 0] = 1.0
        system.force[i] = 0.0


@kernel
def add_points(u, laws, system, mesh, element, viscosity):
    """Add force and tangent of the contact points of one element, Eq. (12), with a dashpot at each within reach."""
    i, points = 2 * element, mesh.points_per_element
    band, force = system.band, system.force
    # The sums of an element are in registers while its points are added.
    u_0, u_1, u_2, u_3 = u[i], u[i + 1], u[i + 2], u[i + 3]
    f_0, f_1, f_2, f_3 = force[i], force[i + 1], force[i + 2], force[i + 3]
    k_00, k_01, k_02, k_03 = band[i, 0], band[i, 1], band[i, 2], band[i, 3]
    k_11, k_12, k_13 = band[i + 1, 0], band[i + 1, 1], band[i + 1, 2]
    k_22, k_23, k_33 = band[i + 2, 0], band[i + 2, 1], band[i + 3, 0]
    for p in range(points):
        r = element * points + p
        n_0, n_1, n_2, n_3 = mesh.hermite[p, 0], mesh.hermite[p, 1], mesh.hermite[p, 2], mesh.hermite[p, 3]
        distance = mesh.gap - (n_0 * u_0 + n_1 * u_1 + n_2 * u_2 + n_3 * u_3)
        a = laws[r, 2] if distance < laws[r, 1] else laws[r, 3]
        t = a * (distance - laws[r, 1])
        system.stretch[r] = t
        if t < REACH:
            x = np.exp(-t)
            push = laws[r, 0] * mesh.area * x * (x - 2)
            dashpot = viscosity / (1 + t) ** 2 if t > 0 else viscosity
            k = 2 * a * laws[r, 0] * mesh.area * x * (x - 1) + dashpot
            f_0, f_1, f_2, f_3 = f_0 - n_0 * push, f_1 - n_1 * push, f_2 - n_2 * push, f_3 - n_3 * push
            m_0, m_1, m_2, m_3 = k * n_0, k * n_1, k * n_2, k * n_3
            k_00, k_01, k_02, k_03 = k_00 + m_0 * n_0, k_01 + m_0 * n_1, k_02 + m_0 * n_2, k_03 + m_0 * n_3
            k_11, k_12, k_13 = k_11 + m_1 * n_1, k_12 + m_1 * n_2, k_13 + m_1 * n_3
            k_22, k_23, k_33 = k_22 + m_2 * n_2, k_23 + m_2 * n_3, k_33 + m_3 * n_3
    force[i], force[i + 1], force[i + 2], force[i + 3] = f_0, f_1, f_2, f_3
    band[i, 0], band[i, 1], band[i, 2], band[i, 3] = k_00, k_01, k_02, k_03
    band[i + 1, 0], band[i + 1, 1], band[i + 1, 2] = k_11, k_12, k_13
    band[i + 2, 0], band[i + 2, 1], band[i + 3, 0] = k_22, k_23, k_33


@kernel
def _assemble(u, laws, system, mesh, clamp, window, viscosity):
    """Assemble the elements ``window`` = (first, last). Returns the largest unbalanced force [N].

    The beam from its clamp to element ``first`` is open, unless the window begins at node ``clamp``, which is fixed.
    """
    first, last = window
    rows = slice(2 * first, 2 * last + 2)
    system.band[rows] = 0.0
    system.force[rows] = 0.0
    for element in range(first, last):
        add_element(u, system, mesh, element)
        if mesh.decay > 0:
            pull = mesh.stiffness * mesh.decay**2
            add_tension(u, system.band, system.force, pull, 2 * element)
        add_points(u, laws, system, mesh, element, viscosity)
    if first == clamp:
        _hold(system, first)
    elif mesh.decay > 0:
        kl = first * mesh.decay
        add_open_part_in_tension(u, system.band, system.force, first, kl, mesh.stiffness, mesh.load)
    else:
        _add_open_part(u, system, mesh, first)
    if 2 * last + 2 < u.size:
        _hold(system, last)
    else:
        system.force[2 * last] += mesh.tip_force
    return np.abs(system.force[rows]).max()


@kernel
def solve(band, x, start, stop):
    """Solve rows [start, stop) of a symmetric system by LDLᵀ, in place. Return False if it is not positive definite.

    Entries beyond ``stop`` are zero, so that the last rows need no special treatment.
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


@kernel
def largest_moves(laws, system, mesh, window):
    """Largest changes of distance in the solved step [-].

    The first is within reach of the laws, relative to the allowed change. The second is beyond their reach, towards the
    ground, relative to the distance from d_max.
    """
    points, step, move, approach = mesh.points_per_element, system.force, 0.0, 0.0
    for element in range(window[0], window[1]):
        i = 2 * element
        for p in range(points):
            r = element * points + p
            t, n = system.stretch[r], mesh.hermite[p]
            change = n[0] * step[i] + n[1] * step[i + 1] + n[2] * step[i + 2] + n[3] * step[i + 3]
            a = laws[r, 2] if t < 0 else laws[r, 3]
            if t < REACH:
                move = max(move, a * abs(change) / (1 + max(t, 0.0)))
            else:
                approach = max(approach, a * change / t)
    return move / STEP, approach


@kernel
def newton_step(u, laws, system, mesh, window):
    """Solve and take the step unless it is too long. Returns its relative length (`largest_moves`) [-], or infinity.

    The step is shortened where a point beyond the reach of its law would pass through the ground.
    """
    rows = slice(2 * window[0], 2 * window[1] + 2)
    if not solve(system.band, system.force, rows.start, rows.stop):
        return np.inf
    move, approach = largest_moves(laws, system, mesh, window)
    share = min(1.0, STEP / approach) if approach > 0 else 1.0
    if share * move <= 2:
        u[rows] += share * system.force[rows]
    return share * move


@kernel
def _open(u, laws, mesh, first):
    """First element, from ``first`` on, with a point within reach of its law."""
    points, elements = mesh.points_per_element, u.size // 2 - 1
    while first < elements:
        distance = mesh.gap - u[2 * first + 2]  # at the end of the element, where an open crack is narrowest
        for r in range(first * points, (first + 1) * points):
            if laws[r, 3] * (distance - laws[r, 1]) < REACH:
                return first
        first += 1
    return first


@kernel
def _front(stretch, points, element, elements):
    """First element, from ``element`` on, with a point closer than d_max."""
    while element < elements:
        for r in range(element * points, (element + 1) * points):
            if stretch[r] <= 0:
                return element
        element += 1
    return element


@kernel
def _fill_open_part(u, mesh, first):
    """Deflect the nodes between the clamp and ``first``: the cubic to this node and the deflection by the load."""
    if first * mesh.decay > SLACK:
        fill_open_part_in_tension(u, first, first * mesh.decay, mesh.stiffness, mesh.load)
        return
    end, slope = u[2 * first], u[2 * first + 1] * first
    bow = mesh.load * first**4 / (24 * mesh.stiffness)
    for node in range(first):
        s = node / first
        u[2 * node] = end * s**2 * (3 - 2 * s) + slope * s**2 * (s - 1) + bow * (s * (1 - s)) ** 2
        rate = 6 * end * s * (1 - s) + slope * s * (3 * s - 2) + 2 * bow * s * (1 - s) * (1 - 2 * s)
        u[2 * node + 1] = rate / first


@kernel
def next_viscosity(viscosity, move, slope):
    """Viscosity after a step of this relative length [N/m]. It grows with long steps, from the mean ``slope``."""
    return max(viscosity * min(max(move, SLOWER), FASTER), LEAST * slope * min(10 * move, 1.0))


@kernel
def _system(u, laws, mesh):
    """Empty system, and the largest and the mean slope of the laws at a point [N/m]."""
    system = System(np.zeros((u.size + 3, 4)), np.zeros(u.size + 3), np.full(laws.shape[0], -1.0))
    slopes = 0.5 * mesh.area * laws[:, 0] * laws[:, 3]
    return system, slopes.max() if laws.size else 0.0, slopes.mean() if laws.size else 0.0


@kernel
def _settle(u, laws, mesh, held, tolerance, max_iterations):
    """Relax the beam beyond the fixed node ``held``, in place. Returns as `_relax`."""
    system, steepest, slope = _system(u, laws, mesh)
    viscosity, residual, window = steepest, np.inf, (held, u.size // 2 - 1)
    for iteration in range(max_iterations):
        residual = _assemble(u, laws, system, mesh, held, window, viscosity)
        if residual <= tolerance:
            return residual, iteration
        move = newton_step(u, laws, system, mesh, window)
        viscosity = next_viscosity(viscosity, move, slope)
    return residual, max_iterations


@kernel
def _relax(u, laws, mesh, ahead, tolerance, max_iterations):
    """Relax the beam to its next equilibrium, in place. Returns the largest unbalanced force [N] and the Newton steps.

    Dashpots at the contact points make the beam creep downhill, so that the crack cannot jump over a place of arrest.
    Their viscosity [N/m] keeps the tangent positive definite and the steps short, and vanishes where it is not needed:
    the last steps are plain Newton. The open part of the crack is condensed; elements far ahead of the crack front are
    updated only in every FULL_PERIOD-th step, those beyond ``ahead`` elements.
    """
    elements, points = u.size // 2 - 1, mesh.points_per_element
    system, steepest, slope = _system(u, laws, mesh)
    viscosity, first, front, residual, arrested = steepest, 0, 0, np.inf, False
    for iteration in range(max_iterations):
        first = _open(u, laws, mesh, first)
        reached, front = front, _front(system.stretch, points, max(first, front), elements)
        arrested = arrested and front == reached
        all_elements = arrested or iteration % FULL_PERIOD == 0
        window = (first, elements if all_elements else min(front + ahead, elements))
        residual = _assemble(u, laws, system, mesh, 0, window, viscosity)
        settled = residual <= tolerance
        if settled and all_elements:
            _fill_open_part(u, mesh, first)
            if _open(u, laws, mesh, 0) >= first:
                return residual, iteration
            first = 0  # the crack has closed again
        elif settled:
            arrested = True  # from now on the whole beam moves, until its front moves on
        else:
            move = newton_step(u, laws, system, mesh, window)
            viscosity = next_viscosity(viscosity, move, slope)
    return residual, max_iterations


def _points(beam, laws):
    """Hermite functions at the points of an element, (points per element, 4) [-].

    Raises
    ------
    ValueError
        If a coefficient other than d_max is negative, one is not finite, or the number of laws is no multiple of that
        of elements.
    """
    points, remainder = divmod(len(laws), beam.elements)
    if remainder:
        raise ValueError(f"{len(laws)} laws do not spread evenly over {beam.elements} elements")
    # Summits of soft or skewed surfaces can attract most where the mean planes are below each other, d_max < 0.
    broken = ~(np.isfinite(laws).all(axis=1) & (laws[:, [0, 2, 3]] >= 0).all(axis=1))
    if broken.any():
        raise ValueError(f"law {broken.argmax()} has no value, or a negative one: {laws[broken.argmax()]}")
    return hermite((np.arange(points) + 0.5) / max(points, 1))


def mesh_of(beam: Beam, laws: np.ndarray, load: float, tip_force: float) -> Mesh:
    """Mesh of a beam for compiled code. Parameters and errors as in `equilibrate`."""
    functions, l_e = _points(beam, laws), beam.element_length
    points = len(functions)
    area = beam.width * l_e / max(points, 1)
    stiffness = beam.bending_stiffness / l_e**3
    return Mesh(
        functions, points, stiffness, float(beam.gap), area, float(load) * l_e, float(tip_force), beam.decay * l_e
    )


def _ahead(beam, laws):
    """Number of elements ahead of the crack front to move with it in every step."""
    if not np.any(laws[:, 0] * laws[:, 2]):  # nothing holds the beam
        return beam.elements
    reach = np.ceil(AHEAD * foundation_length(beam, laws) / beam.element_length)
    return int(min(max(reach, AHEAD_ELEMENTS), beam.elements))


def allowed_imbalance(beam: Beam, pull: float) -> float:
    """Tolerance for the unbalanced force [N] of a beam with the mean pull-off force ``pull`` per point [N]."""
    return TOLERANCE * pull + ROUNDING * 12 * (beam.bending_stiffness / beam.element_length**3) * beam.gap


def equilibrate(
    beam: Beam,
    laws: np.ndarray,
    start: np.ndarray,
    load: float = 0.0,
    tip_force: float = 0.0,
    max_iterations: int = MAX_ITERATIONS,
    held: int = 0,
) -> Equilibrium:
    """Relax from a deflection downhill to the next equilibrium on the substrate (Sec. III-C).

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
        Largest number of Newton steps.
    held : int
        Node that keeps its start until the beam beyond it is in equilibrium. Only then the crack up to it opens. A
        crack that opens into a beam that still settles passes places of arrest.

    Raises
    ------
    ValueError
        If a coefficient other than d_max is negative, one is not finite, or the number of laws is no multiple of that
        of elements.
    NotConverged
        If no equilibrium is found.
    """
    laws = np.ascontiguousarray(laws, float)
    mesh = mesh_of(beam, laws, load, tip_force)
    tolerance = allowed_imbalance(beam, laws[:, 0].mean() * mesh.area if len(laws) else 0.0)
    scale = np.array([1, beam.element_length])
    u = (np.asarray(start, float) * scale).ravel()
    settling = 0
    if held:
        imbalance, settling = _settle(u, laws, mesh, held, tolerance, max_iterations)
        _fill_open_part(u, mesh, held)
    imbalance, iterations = _relax(u, laws, mesh, _ahead(beam, laws), tolerance, max_iterations - settling)
    iterations += settling
    if not imbalance <= tolerance:
        raise NotConverged("equilibrium of the beam [N]", imbalance, tolerance, iterations)
    return Equilibrium(u.reshape(-1, 2) / scale, imbalance, iterations)


def distances(beam: Beam, laws: np.ndarray, deflection: np.ndarray) -> np.ndarray:
    """Distance to the substrate at the point of each law, (points,) [m]."""
    ends = deflection * [1, beam.element_length]
    return beam.gap - (np.hstack([ends[:-1], ends[1:]]) @ _points(beam, laws).T).ravel()

"""Middle of a bridge on random ground: the shortest bridge, clamped at both ends, to stick there.

A bridge that is shorter than its two cracks touches with its middle, which has no slope: it is a parabola, and
adhesion acts on a few micrometres. Finite elements resolve this zone; both open arms are condensed into their exact
stiffness under tension. From a bridge that is held, the arms are shortened until it comes free.
"""

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.equilibrium import (
    MAX_ITERATIONS,
    System,
    add_element,
    add_points,
    allowed_imbalance,
    mesh_of,
    newton_step,
    next_viscosity,
)
from stiction.beam.release import touching
from stiction.beam.tension import add_tension, end_stiffness
from stiction.errors import NotConverged
from stiction.kernels import kernel

#: First step by which a bridge is shortened, and the step at which the search ends, as shares of its length.
FIRST, LAST = 0.1, 0.001
#: How a relaxation of a bridge ends.
_FREE, _HELD, _OPEN = 0, 1, 2


def outwards(number: int) -> np.ndarray:
    """Positions along a zone of an even number of strips, numbered from the middle outwards (number,).

    The ground of a bridge thus stays the same if its zone grows.

    Examples
    --------
    >>> outwards(6).tolist()
    [5, 3, 1, 0, 2, 4]
    """
    return np.concatenate([np.arange(number - 1, 0, -2), np.arange(0, number, 2)])


@kernel
def _add_arms(u, system, mesh, arm):
    """Add both open arms as exact elements, each from its clamp to the next end of the zone, ``arm`` elements long."""
    band, force, k, i = system.band, system.force, mesh.stiffness, u.size - 2
    f, c, m, _ = end_stiffness(arm * mesh.decay) if mesh.decay > 0 else (12.0, 6.0, 4.0, 2.0)
    f, c, m = f * k / arm**3, c * k / arm**2, m * k / arm
    band[0, 0] += f
    band[0, 1] -= c
    band[1, 0] += m
    band[i, 0] += f
    band[i, 1] += c
    band[i + 1, 0] += m
    force[0] -= f * u[0] - c * u[1]
    force[1] += c * u[0] - m * u[1]
    force[i] -= f * u[i] + c * u[i + 1]
    force[i + 1] -= c * u[i] + m * u[i + 1]


@kernel
def _assemble(u, laws, system, mesh, arm, viscosity):
    """Assemble zone and arms. Returns the largest unbalanced force [N]."""
    system.band[:] = 0.0
    system.force[:] = 0.0
    pull = mesh.stiffness * mesh.decay**2
    for element in range(u.size // 2 - 1):
        add_element(u, system, mesh, element)
        if pull > 0:
            add_tension(u, system.band, system.force, pull, 2 * element)
        add_points(u, laws, system, mesh, element, viscosity)
    _add_arms(u, system, mesh, arm)
    return np.abs(system.force).max()


@kernel
def _relax(u, laws, mesh, arm, tolerance, system):
    """Relax a bridge in place: creep downhill, as `stiction.beam.equilibrium.equilibrate`. Returns its end.

    It is free as soon as all points are beyond the largest attraction of their law.
    """
    slopes = 0.5 * mesh.area * laws[:, 0] * laws[:, 3]
    viscosity, slope, window = slopes.max(), slopes.mean(), (0, u.size // 2 - 1)
    for _ in range(MAX_ITERATIONS):
        residual = _assemble(u, laws, system, mesh, arm, viscosity)
        if system.stretch.min() > 0:
            return _FREE
        if residual <= tolerance:
            return _HELD
        move = newton_step(u, laws, system, mesh, window)
        viscosity = next_viscosity(viscosity, move, slope)
    return _OPEN


@kernel
def _shorten(u, laws, mesh, arm, tolerance):
    """Shorten a bridge until it releases. Return the last arm with adhesion [elements] and the end of the search."""
    system = System(np.zeros((u.size + 3, 4)), np.zeros(u.size + 3), np.zeros(laws.shape[0]))
    half, step = u.size // 4, FIRST
    end = _relax(u, laws, mesh, arm, tolerance, system)
    if end != _HELD:
        return np.inf, end
    while step > LAST:
        shorter, trial = arm - step * (arm + half), u.copy()
        end = _relax(trial, laws, mesh, shorter, tolerance, system) if shorter > 0 else _FREE
        if end == _OPEN:
            return shorter, end
        if end == _HELD:
            arm, u = shorter, trial
        else:
            step /= 2
    return arm, _HELD


def shortest_held(zone: Beam, laws: np.ndarray, longest: float) -> float:
    """Length of the shortest bridge to stick at its middle on this ground, to 0.1 % [m].

    The bridge was pressed down on the whole zone. Its arms are shortened step by step; after each step it creeps
    downhill to its next equilibrium.

    Parameters
    ----------
    zone : Beam
        Middle of the bridge, under its tension, with one law per element; it must contain every point that touches.
    laws : (n, 4) float64
        Rows [f_max, d_max, a_left, a_right] along the zone, SI.
    longest : float
        Length of the bridge from which the search starts; infinity is returned if it already comes free [m].

    Raises
    ------
    ValueError
        If the zone is longer than the bridge, or the laws do not fit to its elements.
    NotConverged
        If no equilibrium is found.
    """
    if not longest > zone.length:
        raise ValueError(f"a bridge of {longest} m is shorter than its middle zone of {zone.length} m")
    laws = np.ascontiguousarray(laws, float)
    mesh = mesh_of(zone, laws, 0.0, 0.0)
    tolerance = allowed_imbalance(zone, laws[:, 0].mean() * mesh.area)
    start = np.zeros(2 * zone.elements + 2)
    start[::2] = zone.gap - touching(laws)
    arm, end = _shorten(start, laws, mesh, (longest - zone.length) / 2 / zone.element_length, tolerance)
    if end == _OPEN:
        raise NotConverged("equilibrium of the middle of a bridge [N]", np.nan, tolerance, MAX_ITERATIONS)
    return zone.length + 2 * arm * zone.element_length

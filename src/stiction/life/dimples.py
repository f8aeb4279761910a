r"""Dimples in rows under a beam, at distances x from its clamp, that touch before it does.

A dimple of the height :math:`h_d` touches where the beam has come down by :math:`h - h_d`. Between clamps and rows the
beam is an exact element of `stiction.beam.tension`. Rows that hold it prescribe its deflection and exert no moment. The
beam pulls on a single row with :math:`k (h - h_d)`, :math:`k = 3 EI / x^3` for a cantilever and
:math:`3 EI L^3 / x^3 (L - x)^3` for a bridge without tension. Each dimple may be too weak alone: a row holds with the
*sum* of the forces on its dimples.

A beam on several rows is at rest on some of them (`states`), where the others are above the substrate. Some rows may
be pressed down by the beam, so that they need no force. The beam sticks if in any such state every row holds more than
the beam pulls there.

The beam comes down farther elsewhere: between rows, and a cantilever beyond its last row, with one row by
:math:`1 + 3 (L - x) / 2 x` times as much at its tip. Where that is more than h, it touches beside its dimples, which
then do not protect it.

**Loads** that grow as the gap g closes, :math:`c / g^n` per length, of a voltage (n = 2) or of a liquid (n = 1), bring
it down there. They are at most as large as at the smallest gap. A load on one part can lift the next one. With the
deflection a by the rows, and b by a uniform load on those parts alone that bring a place down, the beam stands up to

.. math:: c = \max_g g^n \min_x \frac{h - g - a(x)}{b(x)} ,

a bound on the safe side. It is the least of all states but those in which such a load certainly brings another row
down, which then carries the beam as well. There, a place has at least the load of its largest gap, and where it lifts
the row, at most that of its smallest one.

The forces of *different* rows do not add up. A cantilever of 200 µm, 2 µm thick, pulls with 2.4 N/m on a row at 160 µm
alone, and with 60 and -16 N/m on rows at 80 and 160 µm together. If each holds half of what the outer one needs alone,
their sum suffices, but the beam peels off row by row.

ASSUME: the beam does not twist, so that all dimples of a row let go at once. Rows that touch do not move under a load,
and it does not lift them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.tension import SLACK, end_stiffness

#: Points along a part of a beam at which its deflection is looked for, and gaps at which a load is.
_POINTS = 201
#: Rounding of a deflection of one.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class HeldBeam:
    """How a beam bends while some rows of dimples hold it, per deflection at these rows."""

    rows: tuple[int, ...]  #: that touch, numbered along the beam
    pull: np.ndarray  #: force on each of them, negative where the beam presses it down [N m⁻¹]
    bent: np.ndarray  #: deflections along the beam over that at the rows (n,) [-]
    sag: np.ndarray  #: deflections by a uniform load on parts that bring the place down (n,) [m² N⁻¹]
    lift: np.ndarray  #: the same upwards, by one on the other parts (n,) [m² N⁻¹]
    other_rows: np.ndarray  #: deflections at all other rows over that at the rows that touch (k,) [-]
    influence: np.ndarray  #: deflections there by a unit load per length on each place along the beam (k, n) [m² N⁻¹]

    @property
    def deepest(self) -> float:
        """Largest deflection anywhere over that at the rows [-]."""
        return float(self.bent.max())


def states(beam: Beam, clamps: int, at: Sequence[float]) -> list[HeldBeam]:
    """States of rest of a beam on rows of dimples at increasing distances from a clamp [m], below its length.

    Examples
    --------
    >>> beam = Beam(200e-6, 30e-6, 2e-6, 164e9, 3e-6, 1)
    >>> (found,) = states(beam, clamps=1, at=[100e-6])
    >>> round(float(found.pull[0]), 2), round(found.deepest, 3)  # N/m
    (9.84, 2.5)
    >>> [one.rows for one in states(beam, clamps=1, at=[100e-6, 150e-6])]
    [(1,), (0, 1)]
    """
    supports, states_of_rest = [0.0, *at, beam.length], []
    along = np.concatenate([np.linspace(*span, _POINTS) for span in zip(supports, supports[1:], strict=False)])
    for number in range(1, len(at) + 1):
        for rows in combinations(range(len(at)), number):
            held = _HeldBeam(beam, clamps, tuple(at[row] for row in rows))
            u = held.turned(1.0)
            if all(held.bent(u, np.array(at)) <= 1 + _ROUNDING):
                pull = (held.stiffness @ u)[2 : 2 * number + 2 : 2]
                free = [at[row] for row in range(len(at)) if row not in rows]
                influence = np.array([held.influence(distance, along) for distance in free]).reshape(-1, len(along))
                others = held.bent(u, np.array(free))
                states_of_rest.append(HeldBeam(rows, pull, held.bent(u, along), *held.sags(along), others, influence))
    return states_of_rest


def least_pull(rest_states: Sequence[HeldBeam]) -> float:
    """Largest pull on a row in the state in which it is least, per deflection [N m⁻¹]."""
    return min(float(state.pull.max()) for state in rest_states)


def holds(rest_states: Sequence[HeldBeam], way: float, forces: np.ndarray) -> np.ndarray:
    """Whether rows that hold forces (beams, rows) [N] keep beams down, deflected by a way [m], (beams,) bool."""
    return np.any([np.all(forces[:, state.rows] > way * state.pull, axis=1) for state in rest_states], axis=0)


def least_load(rest_states: Sequence[HeldBeam], way: float, gap: float, power: int) -> float:
    """Largest load per length, times the ``power`` of the gap, that brings no place down to the substrate [SI].

    The rows are deflected by a way [m]. Zero if the beam touches beside them without a load.
    """
    loads = []
    for state in rest_states:
        bears = state.sag > _ROUNDING * state.sag.max()
        clear, sag = gap - way * state.bent[bears], state.sag[bears]
        gaps = np.linspace(0, max(clear.min(), 0.0), _POINTS)
        limits = np.array([((clear - each) / sag).min() * each**power for each in gaps])
        fold = int(np.argmax(limits))
        if not limits[fold] or not _brings_down(state, way, gap, limits[fold:], gaps[fold:], power):
            loads.append(float(limits[fold]))
    return min(loads)


def _brings_down(state, way, gap, loads, gaps, power):
    """Whether one of some loads certainly brings another row down, where they leave at least some gaps."""
    for load, least in zip(loads, gaps, strict=True):
        if least > 0:
            pressure, unloaded = load / least**power, gap - way * state.bent
            most, few = unloaded + pressure * state.lift, np.maximum(unloaded - pressure * state.sag, least)
            down = load * (state.influence / np.where(state.influence > 0, most, few) ** power).sum(axis=1)
            if np.any(way * state.other_rows + down > way):
                return True
    return False


@dataclass(frozen=True)
class _HeldBeam:
    """Beam as exact elements between clamps and the rows that hold it. Unknowns are [u, u'] of every node."""

    beam: Beam
    clamps: int
    at: tuple[float, ...]

    @cached_property
    def nodes(self):
        """Places of clamps and rows [m]."""
        return [0.0, *self.at, *([self.beam.length] if self.clamps == 2 else [])]

    @cached_property
    def sizes(self):
        """Lengths of the parts between nodes [m]."""
        return np.diff(self.nodes)

    @cached_property
    def stiffness(self):
        """Stiffness of all nodes, a square matrix."""
        matrix = np.zeros((2 * len(self.nodes),) * 2)
        for i, size in enumerate(self.sizes):
            f, c, m, o = self._ends(size)
            by = np.array([[f, c, -f, c], [c, m, -c, o], [-f, -c, f, -c], [c, o, -c, m]])
            scale = np.array([1, size, 1, size])
            block = slice(2 * i, 2 * i + 4)
            matrix[block, block] += self.beam.bending_stiffness / size**3 * scale[:, None] * by * scale
        return matrix

    def _ends(self, size):
        """Stiffness of a part at its end, see `stiction.beam.tension.end_stiffness`."""
        kl = self.beam.decay * size
        return end_stiffness(kl) if kl else (12.0, 6.0, 4.0, 2.0)

    def turned(self, deflection, moments=0.0):
        """Unknowns of all nodes with rows at a deflection, under moments at all nodes."""
        turning = np.arange(3, 2 * len(self.at) + 3, 2)
        u, by_moments = np.zeros(len(self.stiffness)), np.broadcast_to(moments, len(self.nodes))
        u[turning - 1] = deflection
        unbalanced = by_moments[1 : len(self.at) + 1] - (self.stiffness @ u)[turning]
        u[turning] = np.linalg.solve(self.stiffness[np.ix_(turning, turning)], unbalanced)
        return u

    def bent(self, u, along):
        """Deflection at places along the beam. Beyond its last row, a cantilever is straight."""
        deflections = u[-2] + u[-1] * (along - self.nodes[-1])
        for i, (start, size) in enumerate(zip(self.nodes, self.sizes, strict=False)):
            inside = (along >= start) & (along <= start + size)
            ends, x = u[2 * i : 2 * i + 4], (along[inside] - start) / size
            deflections[inside] = _between(self.beam.decay * size, ends * [1, size, 1, size], x)
        return deflections

    def influence(self, distance, along):
        """Deflection at a place by a unit load per length around each point along the beam (n,) [m² N⁻¹].

        It is that of these points by a force at the place (Maxwell and Betti), times the length between them.
        """
        at = tuple(sorted((*self.at, distance)))
        further = _HeldBeam(self.beam, self.clamps, at)
        u = further.turned(np.array([float(row == distance) for row in at]))
        force = (further.stiffness @ u)[2 * at.index(distance) + 2]
        steps = np.diff(along, append=along[-1]) / 2 + np.diff(along, prepend=along[0]) / 2
        return further.bent(u, along) / force * steps

    def sags(self, along):
        """Deflections down by 1 N/m on those parts that bring a place down, and up by the others (2, n) [m² N⁻¹]."""
        by_part = []
        for i, (start, size) in enumerate(zip(self.nodes, self.sizes, strict=False)):
            moments, inside = np.zeros(len(self.nodes)), (along >= start) & (along <= start + size)
            moments[i : i + 2] = np.array([1, -1]) * size**2 / (2 * self._ends(size)[1])
            by = self.bent(self.turned(0.0, moments), along)
            scale = size**4 / self.beam.bending_stiffness
            by[inside] += scale * _bow(self.beam.decay * size, (along[inside] - start) / size)
            by_part.append(by)
        if self.clamps == 1 and (overhang := self.beam.length - self.nodes[-1]) > 0:
            moments, beyond = np.zeros(len(self.nodes)), np.maximum(along - self.nodes[-1], 0.0) / overhang
            moments[-1] = overhang**2 / 2
            arm = overhang**4 / (24 * self.beam.bending_stiffness) * (beyond**4 - 4 * beyond**3 + 6 * beyond**2)
            by_part.append(self.bent(self.turned(0.0, moments), along) + arm)
        return [np.maximum(sign * np.array(by_part), 0.0).sum(axis=0) for sign in (1, -1)]


def _between(kl, ends, x):
    """Deflection of a part at 0 <= x <= 1 (n,) from deflection and slope at both ends (4,), lengths in its own."""
    first, turn, last, turn_last = ends
    if kl < 1e-3:
        # The cubic of Hermite, which tension changes by (kL)² / 60 at most.
        cubic = first * (1 - 3 * x**2 + 2 * x**3) + last * (3 * x**2 - 2 * x**3)
        return cubic + turn * x * (1 - x) ** 2 + turn_last * x**2 * (x - 1)

    def shapes(x):
        """Solutions of the bent beam without load, (4, n)."""
        return np.array([np.ones_like(x), x, np.exp(-kl * x), np.exp(-kl * (1 - x))])

    ends_of_part = np.array([0.0, 1.0])
    values, (_, _, fall, rise) = shapes(ends_of_part), shapes(ends_of_part)
    rates = np.array([np.zeros(2), np.ones(2), -kl * fall, kl * rise])
    system = np.array([values[:, 0], rates[:, 0], values[:, 1], rates[:, 1]])
    return np.linalg.solve(system, ends) @ shapes(x)


def _bow(kl, x):
    """Deflection at 0 <= x <= 1 (n,) of a part clamped at both ends under a uniform load, in its length and EI."""
    if kl < SLACK:
        return (x * (1 - x)) ** 2 / 24
    y, top = x - 0.5, -np.expm1(-kl)
    hyperbolic = (np.exp(kl * (y - 0.5)) + np.exp(-kl * (y + 0.5))) / top  # cosh(kl y) / sinh(kl / 2)
    return ((hyperbolic - 1 / np.tanh(kl / 2)) / kl + 0.25 - y**2) / (2 * kl**2)

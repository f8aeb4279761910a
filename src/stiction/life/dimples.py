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

ASSUME: the beam does not twist, so that all dimples of a row let go at once. It bends under the forces of its rows
alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.tension import end_stiffness

#: Points along a part of a beam at which its deflection is looked for.
_POINTS = 401
#: Rounding of a deflection of one.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class State:
    """How a beam bends while some rows of dimples hold it, per deflection at these rows."""

    rows: tuple[int, ...]  #: that touch, numbered along the beam
    pull: np.ndarray  #: force on each of them, negative where the beam presses it down [N m⁻¹]
    deepest: float  #: largest deflection anywhere over that at the rows [-]


def states(beam: Beam, clamps: int, at: Sequence[float]) -> list[State]:
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
    found = []
    for number in range(1, len(at) + 1):
        for rows in combinations(range(len(at)), number):
            pull, bent = _held(beam, clamps, [at[row] for row in rows])
            others = [at[row] for row in range(len(at)) if row not in rows]
            if all(bent(np.array(others)) <= 1 + _ROUNDING):
                points = np.concatenate([np.linspace(*span, _POINTS) for span in _spans(beam, at)])
                found.append(State(rows, pull, float(bent(points).max())))
    return found


def least_pull(found: Sequence[State]) -> float:
    """Largest pull on a row in the state in which it is least, per deflection [N m⁻¹]."""
    return min(float(state.pull.max()) for state in found)


def holds(found: Sequence[State], way: float, held: np.ndarray) -> np.ndarray:
    """Whether rows that hold forces (beams, rows) [N] keep beams down, deflected by a way [m], (beams,) bool."""
    return np.any([np.all(held[:, state.rows] > way * state.pull, axis=1) for state in found], axis=0)


def _spans(beam, at):
    """Parts of a beam between its ends and rows."""
    places = [0.0, *at, beam.length]
    return zip(places, places[1:], strict=False)


def _held(beam, clamps, at):
    """Pull on rows at a deflection of one [N m⁻¹], and the deflection along the beam as a function of the place."""
    nodes = [0.0, *at, *([beam.length] if clamps == 2 else [])]
    matrix = np.zeros((2 * len(nodes),) * 2)
    for i, (start, end) in enumerate(zip(nodes, nodes[1:], strict=False)):
        matrix[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += _element(beam, end - start)
    inner = slice(1, len(at) + 1)
    u = np.zeros(2 * len(nodes))
    u[::2][inner] = 1.0
    turning = np.arange(1, 2 * len(nodes), 2)[inner]
    u[turning] = -np.linalg.solve(matrix[np.ix_(turning, turning)], (matrix @ u)[turning])

    def bent(places):
        """Deflection at places along the beam [-]. Beyond the last row, a cantilever is straight."""
        places = np.asarray(places)
        i = np.clip(np.searchsorted(nodes, places) - 1, 0, len(nodes) - 2)
        deflections = u[-2] + u[-1] * (places - nodes[-1])
        for k in set(i[places <= nodes[-1]].tolist()):
            inside = (i == k) & (places <= nodes[-1])
            length = nodes[k + 1] - nodes[k]
            deflections[inside] = _along(beam, length, u[2 * k : 2 * k + 4], (places[inside] - nodes[k]) / length)
        return deflections

    return (matrix @ u)[::2][inner], bent


def _element(beam, length):
    """Stiffness of a part by deflection and slope at both ends (4, 4) [N m⁻¹, N, N m]."""
    kl = beam.decay * length
    f, c, m, o = end_stiffness(kl) if kl else (12.0, 6.0, 4.0, 2.0)
    by = np.array([[f, c, -f, c], [c, m, -c, o], [-f, -c, f, -c], [c, o, -c, m]])
    scale = np.array([1, length, 1, length])
    return beam.bending_stiffness / length**3 * scale[:, None] * by * scale


def _along(beam, length, ends, x):
    """Deflection of a part at 0 <= x <= 1 (n,) from deflection and slope [m⁻¹] at both ends (4,)."""
    kl, (first, turn, last, turn_last) = beam.decay * length, ends
    if kl < 1e-3:
        # The cubic of Hermite, which tension changes by (kL)² / 60 at most.
        cubic = first * (1 - 3 * x**2 + 2 * x**3) + last * (3 * x**2 - 2 * x**3)
        return cubic + length * (turn * x * (1 - x) ** 2 + turn_last * x**2 * (x - 1))
    both = np.array([0.0, 1.0])

    def shapes(x):
        """Solutions of the bent beam without load, (4, n)."""
        return np.array([np.ones_like(x), x, np.exp(-kl * x), np.exp(-kl * (1 - x))])

    decays = np.exp(-kl * both), np.exp(-kl * (1 - both))
    rates = np.array([np.zeros(2), np.ones(2), -kl * decays[0], kl * decays[1]])
    values = shapes(both)
    system = np.array([values[:, 0], rates[:, 0], values[:, 1], rates[:, 1]])
    return np.linalg.solve(system, [first, turn * length, last, turn_last * length]) @ shapes(x)

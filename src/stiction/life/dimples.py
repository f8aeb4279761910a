r"""Dimples in a row under a beam, at the distance x from its clamp, that touch before it does.

A dimple of the height :math:`h_d` touches where the beam has come down by :math:`h - h_d`. The beam then pulls with
:math:`k (h - h_d)` on the whole row. Its stiffness there is that of both parts, from the row to a clamp, joined without
a kink: :math:`k = 3 EI / x^3` for a cantilever, :math:`3 EI L^3 / x^3 (L - x)^3` for a bridge without tension. Each
dimple may be too weak alone: the row is held if the *sum* of the forces on its dimples is larger.

The beam comes down farther elsewhere, a cantilever by :math:`1 + 3 (L - x) / 2 x` times as much at its tip. Where that
is more than h, it touches beside its dimples, which then do not protect it.

ASSUME: the beam does not twist, so that all dimples of a row let go at once. It bends under the force of the row alone.
"""

from dataclasses import dataclass

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.tension import end_stiffness

#: Points along a part of a bridge at which its deflection is looked for.
_POINTS = 401


@dataclass(frozen=True)
class Row:
    """How a beam bends under a force at a row of dimples."""

    stiffness: float  #: force over deflection at the row [N m⁻¹]
    deepest: float  #: largest deflection over that at the row [-]


def row(beam: Beam, clamps: int, at: float) -> Row:
    """Row of dimples at a distance from a clamp [m], below the length of the beam.

    Examples
    --------
    >>> beam = Beam(200e-6, 30e-6, 2e-6, 164e9, 3e-6, 1)
    >>> found = row(beam, clamps=1, at=100e-6)
    >>> round(found.stiffness, 2), round(found.deepest, 3)  # N/m
    (9.84, 2.5)
    """
    near = _part(beam, at, 1)
    if clamps == 1:
        slope = -near[1, 0] / near[1, 1]
        return Row(_without_moment(near), float(1 + slope * (beam.length - at)))
    whole = near + _part(beam, beam.length - at, -1)
    slope = -whole[1, 0] / whole[1, 1]
    sides = (at, slope), (beam.length - at, -slope)
    return Row(_without_moment(whole), max(_deepest(beam, *side) for side in sides))


def _part(beam, length, side):
    """Stiffness of a part to a clamp at its other end, by deflection and slope (2, 2); ``side`` 1 if that is before."""
    kl = beam.decay * length
    force, coupling, moment, _ = end_stiffness(kl) if kl else (12.0, 6.0, 4.0, 2.0)
    units = np.array([[force, -side * coupling * length], [-side * coupling * length, moment * length**2]])
    return beam.bending_stiffness / length**3 * units


def _without_moment(matrix):
    """Stiffness of the deflection alone, where no moment acts [N m⁻¹]."""
    return float(matrix[0, 0] - matrix[0, 1] * matrix[1, 0] / matrix[1, 1])


def _deepest(beam, length, slope):
    """Largest deflection of a part with one at its end, and a slope there away from its clamp [m⁻¹]; the other is 0."""
    x, kl = np.linspace(0, 1, _POINTS), beam.decay * length
    if kl < 1e-3:
        # The cubic of Hermite, which tension changes by (kL)² / 60 at most.
        return float((x**2 * (3 - 2 * x) - slope * length * x**2 * (1 - x)).max())
    decays = np.exp(-kl * x), np.exp(-kl * (1 - x))
    shapes = np.array([np.ones_like(x), x, *decays])
    rates = np.array([np.zeros_like(x), np.ones_like(x), -kl * decays[0], kl * decays[1]])
    ends = np.array([shapes[:, 0], rates[:, 0], shapes[:, -1], rates[:, -1]])
    return float((np.linalg.solve(ends, [0, 0, 1, slope * length]) @ shapes).max())

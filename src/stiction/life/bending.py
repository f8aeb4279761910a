r"""Beams bent by a load growing as their gap closes, and the fold before their collapse.

With x in units of the length L, the deflection U in units of the gap h and the load in units of EI h / L⁴,

.. math:: U'''' - \left(\tau + s \int U'^2 dx\right) U'' = \lambda f(U), \quad
    \tau = \frac{N L^2}{EI}, \quad s = \frac{6 h^2}{t^2} .

N is the tension of a bridge. Its ends do not move if clamps are rigid. It then stretches by
:math:`\frac{1}{2} \int u'^2 dx`, which adds :math:`E w t / 2L \int u'^2 dx` to N. Clamps that yield
(s = 0) are the safe side.

Ritz's method: the curvature is a sum of Legendre polynomials, whose double integrals have no deflection and no slope at
clamped ends. The bending stiffness is diagonal, and 16 polynomials suffice: folds of distributed loads are exact to ten
digits without tension and at τ = 1000, and to 1e-5 at τ = 10⁵. Those of a drop, which ends abruptly, are exact to 2e-6.

The deflection at the free end, or at the middle of a bridge, is prescribed, and the load follows. A fold is the largest
load along the deflection.

**Loads switched on at once** bring a beam down earlier. Without damping it moves at the constant energy

.. math:: \frac{1}{2} \int U''^2 + \tau U'^2 dx + \frac{s}{4} \left( \int U'^2 dx \right)^2
    - \lambda \int \int_0^U f(u) \, du \, dx = 0 ,

and cannot pass the equilibrium beyond the fold, from which it falls, if that has more. The load with as much is a bound
on the safe side (`Bent.fold_at_once`).

ASSUME: slopes are small, and the beam is clamped ideally. The gap is the same along the beam: no curl.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.optimize import brentq, minimize_scalar

from stiction.errors import NotConverged

#: Polynomials of the curvature, and points at which loads are integrated.
_POLYNOMIALS, _POINTS = 16, 64
#: Largest change of a deflection in units of the gap after which an iteration ends, and most iterations.
_TOLERANCE, _ITERATIONS = 1e-12, 500
#: Points and weights of the integral of a load over the deflection.
_PARTS = legendre.leggauss(24)
#: Deflections in gaps between which the energy of an equilibrium becomes that at rest: 1/2 of a plate on a spring.
_BEYOND = 0.2, 0.95


class _Basis(NamedTuple):
    """Deflections of a bent beam, each with a curvature of one Legendre polynomial."""

    series: np.ndarray  #: (n, m), Legendre coefficients of the deflections on [-1, 1], where the length is 2
    areas: np.ndarray  #: (n + 1, m), of the integrals of the deflections
    at: np.ndarray  #: (p, m), deflections at the points of the integrals
    weights: np.ndarray  #: (p,) of the integrals over x from 0 to 1
    end: np.ndarray  #: (m,), deflections at the free end, or at the middle of a bridge
    bending: np.ndarray  #: (m, m), ∫ U''² dx
    slope: np.ndarray  #: (m, m), ∫ U'² dx


@cache
def _basis(clamps):
    """Basis of beams with one or two clamps. Bridges are symmetric about their middle."""
    orders = np.arange(_POLYNOMIALS) if clamps == 1 else 2 + 2 * np.arange(_POLYNOMIALS)
    curvatures = np.eye(orders[-1] + 1)[:, orders]
    slopes, series, areas = (legendre.legint(curvatures, m=m, lbnd=-1) for m in (1, 2, 3))
    points, weights = legendre.leggauss(_POINTS + orders[-1])
    along = legendre.legval(points, slopes).T
    return _Basis(
        series=series,
        areas=areas,
        at=legendre.legval(points, series).T,
        weights=weights / 2,
        end=legendre.legval(1.0 if clamps == 1 else 0.0, series),
        bending=np.diag(8 * 2 / (2 * orders + 1)),
        slope=2 * along.T @ (weights[:, None] * along),
    )


@dataclass(frozen=True)
class Load:
    """Load on a beam by its deflection U in gaps (p,)."""

    along: Callable[[np.ndarray], np.ndarray]  #: f, per length [-]
    at_end: Callable[[np.ndarray], np.ndarray] = lambda u: 0 * u  #: at the free end, over the length [-]


@dataclass(frozen=True)
class Bent:
    """Beam in units of its length, gap and stiffness."""

    clamps: int  #: 1, a cantilever, or 2, a bridge
    tension: float = 0.0  #: τ [-]
    stretching: float = 0.0  #: s [-], of a bridge between rigid clamps

    def under(self, load: "Load | Callable", deflection: float) -> tuple[float, np.ndarray]:
        """Load factor λ to bend the end or middle to a deflection, and the coefficients of the beam (m,).

        ``load`` is a `Load`, or f alone. ``deflection`` is a part of the gap.

        Raises
        ------
        NotConverged
            If the deflection is so large that the load concentrates in a point.
        """
        basis, load = _basis(self.clamps), self._complete(load)

        def forces(u):
            """Forces on the coefficients."""
            along = basis.at.T @ (basis.weights * load.along(basis.at @ u))
            return along + basis.end * load.at_end(basis.end @ u)

        return self._balanced(forces, deflection)

    def fold_of_drop(self) -> float:
        r"""Smallest λ of a connected drop at the end or middle to pull the beam down, over all places of its edge.

        Its pressure is uniform, and that of a meniscus where it begins, at x = a: :math:`f = 1 / (1 - U(a))`. Without
        stretching, U(a) is S(a) times the load, and :math:`\lambda = 1 / 4 S(a)`, at U(a) = 1/2.
        """

        def largest(begin):
            """Largest λ of a drop from x = ``begin`` to the end [-]."""
            factor, pull = self.under_part(begin, 1.0)
            return factor / (4 * pull)

        return _least(largest, 1.0 if self.clamps == 1 else 0.5)[1]

    def under_part(self, begin: float, deflection: float) -> tuple[float, float]:
        """Load factor and deflection at ``begin``, for a uniform load up to the end, or of a bridge to 1 - ``begin``.

        Returns the load factor and the deflection at ``begin``.
        """
        basis = _basis(self.clamps)
        ends = 2 * np.array([begin, 1.0 if self.clamps == 1 else 1 - begin]) - 1
        total = np.diff(legendre.legval(ends, basis.areas), axis=-1)[:, 0] / 2
        factor, u = self._balanced(lambda _: total, deflection)
        return factor, float(legendre.legval(ends[0], basis.series) @ u)

    def _complete(self, load):
        """Load along the beam and at its free end, if it has one."""
        if isinstance(load, Load):
            return load if self.clamps == 1 else Load(load.along)
        return Load(load)

    def _balanced(self, forces, deflection):
        """Load factor and coefficients at a deflection, from the forces on the coefficients."""
        basis = _basis(self.clamps)
        u, change = np.zeros(len(basis.end)), np.inf
        for _ in range(_ITERATIONS):
            stiffness = basis.bending + (self.tension + self.stretching * u @ basis.slope @ u) * basis.slope
            by_unit = np.linalg.solve(stiffness, forces(u))
            factor = deflection / (basis.end @ by_unit)
            change, u = np.abs(basis.at @ (factor * by_unit - u)).max(), factor * by_unit
            if change < _TOLERANCE:
                return float(factor), u
        raise NotConverged("deflection of a beam, in parts of its gap", float(change), _TOLERANCE, _ITERATIONS)

    def fold(self, load: "Load | Callable") -> float:
        """Largest λ of a load along the whole beam. Beyond it there is no equilibrium."""
        return -_least(lambda deflection: -self.under(load, deflection)[0], 1.0)[1]

    def fold_at_once(self, load: "Load | Callable") -> float:
        """Largest λ of a load that certainly does not bring the beam down if it is switched on at once."""
        load = self._complete(load)

        def energy(deflection):
            """Energy of the equilibrium at a deflection of the end or middle, over that at rest."""
            factor, u = self.under(load, deflection)
            return self._stored(u) - factor * self._work(load, u)

        return self.under(load, brentq(energy, *_BEYOND))[0]

    def _stored(self, u):
        """Energy of bending, tension and stretching."""
        basis = _basis(self.clamps)
        slopes = u @ basis.slope @ u
        return (u @ basis.bending @ u + self.tension * slopes) / 2 + self.stretching * slopes**2 / 4

    def _work(self, load, u):
        """Work of a load from rest to some coefficients, at λ = 1."""
        basis = _basis(self.clamps)
        nodes, weights = (1 + _PARTS[0]) / 2, _PARTS[1] / 2
        along, end = basis.at @ u, basis.end @ u
        by_place = along * (weights @ load.along(nodes[:, None] * along))
        return basis.weights @ by_place + end * (weights @ (load.at_end(nodes * end) + 0 * nodes))

    def overshoot(self) -> float:
        r"""Deflection of the end or middle with all modes of one sign, relative to a uniform load's.

        A uniform load that is not static moves mode n by at most a factor times its static part :math:`c_n`, at a
        time of its own. The end thus moves by at most this factor times :math:`\sum |c_n|`, where the static deflection
        is :math:`\sum c_n`.
        """
        basis = _basis(self.clamps)
        mass = basis.at.T @ (basis.weights[:, None] * basis.at)
        squares, modes = eigh(basis.bending + self.tension * basis.slope, mass)
        modal = (basis.end @ modes) * (basis.weights @ basis.at @ modes) / squares
        return float(np.abs(modal).sum() / modal.sum())


def _least(function, upper):
    """Place and value of the least of a function between 0 and an upper bound."""
    minimum = minimize_scalar(function, bounds=(0.02 * upper, 0.98 * upper), method="bounded")
    return float(minimum.x), float(minimum.fun)

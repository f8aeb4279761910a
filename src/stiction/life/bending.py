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

ASSUME: slopes are small, and the beam is clamped ideally. The gap is the same along the beam: no curl.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.optimize import minimize_scalar

from stiction.errors import NotConverged

#: Polynomials of the curvature, and points at which loads are integrated.
_POLYNOMIALS, _POINTS = 16, 64
#: Largest change of a deflection in units of the gap after which an iteration ends, and most iterations.
_TOLERANCE, _ITERATIONS = 1e-12, 500


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
class Bent:
    """Beam in units of its length, gap and stiffness."""

    clamps: int  #: 1, a cantilever, or 2, a bridge
    tension: float = 0.0  #: τ [-]
    stretching: float = 0.0  #: s [-], of a bridge between rigid clamps

    def under(self, load: Callable[[np.ndarray], np.ndarray], deflection: float) -> tuple[float, np.ndarray]:
        """Load factor λ to bend the end or middle to a deflection, and the coefficients of the beam (m,).

        ``load`` gives f from the deflections (p,) at the points of the integrals, ``deflection`` is a part of the gap.

        Raises
        ------
        NotConverged
            If the deflection is so large that the load concentrates in a point.
        """
        basis = _basis(self.clamps)
        return self._balanced(lambda u: basis.at.T @ (basis.weights * load(basis.at @ u)), deflection)

    def fold_of_drop(self) -> float:
        r"""Smallest λ of a connected drop at the end or middle to pull the beam down, over all places of its edge.

        Its pressure is uniform, and that of a meniscus where it begins, at x = a: :math:`f = 1 / (1 - U(a))`. Without
        stretching, U(a) is S(a) times the load, and :math:`\lambda = 1 / 4 S(a)`, at U(a) = 1/2.
        """

        def largest(begin):
            """Largest λ of a drop from x = ``begin`` to the end [-]."""
            factor, there = self.under_part(begin, 1.0)
            return factor / (4 * there)

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

    def fold(self, power: int) -> float:
        """Largest λ of a load (1 - U)^-power along the whole beam. Beyond it there is no equilibrium."""
        return -_least(lambda deflection: -self.under(lambda u: (1 - u) ** -power, deflection)[0], 1.0)[1]

    def overshoot(self) -> float:
        r"""Deflection of the end or middle with all modes of one sign, relative to a uniform load's.

        A uniform load that is not static moves mode n by at most a factor times its static part :math:`c_n`, at a
        time of its own. The end thus moves by at most this factor times :math:`\sum |c_n|`, where the static deflection
        is :math:`\sum c_n`.
        """
        basis = _basis(self.clamps)
        mass = basis.at.T @ (basis.weights[:, None] * basis.at)
        squares, modes = eigh(basis.bending + self.tension * basis.slope, mass)
        parts = (basis.end @ modes) * (basis.weights @ basis.at @ modes) / squares
        return float(np.abs(parts).sum() / parts.sum())


def _least(function, upper):
    """Place and value of the least of a function between 0 and an upper bound."""
    found = minimize_scalar(function, bounds=(0.02 * upper, 0.98 * upper), method="bounded")
    return float(found.x), float(found.fun)

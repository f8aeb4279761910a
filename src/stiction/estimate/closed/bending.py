r"""Beams bent by a load that grows as their gap closes: `stiction.life.bending` in plain Python.

With x in units of the length, the deflection U in units of the gap and the load in units of EI h / L⁴,

.. math:: U'''' - \tau U'' = \lambda f(U) , \quad \tau = \frac{N L^2}{EI} .

The curvature is a sum of the same Legendre polynomials. Bending is diagonal in them and tension couples neighbours
alone, so that a beam under a load needs no matrix.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from operator import mul

from stiction.errors import NotConverged

#: Polynomials of the curvature, points at which loads are integrated along a beam, and over a deflection.
_POLYNOMIALS, _POINTS, _PARTS = 16, 32, 24
#: Steps of Newton's method to a point of Gauss.
_NEWTON = 8
#: Largest change after which an iteration ends, and most iterations.
_TOLERANCE, _ITERATIONS = 1e-12, 500
#: Ratio of the golden section, and steps with it to a largest value, near which the value hardly changes.
_GOLDEN, _STEPS = (5**0.5 - 1) / 2, 26
#: Parts of an interval between which a largest value is.
_INSIDE = 0.02, 0.98
#: Deflections between which a beam has the energy that it had at rest, as of `stiction.life.bending`.
_BEYOND = 0.2, 0.95
#: Below this kL, as `stiction.beam.tension.SLACK`.
SLACK = 0.03


def _dot(left: Iterable[float], right: Iterable[float]) -> float:
    """Scalar product."""
    return sum(map(mul, left, right))


def _legendre(x, number):
    """Legendre polynomials at x."""
    values = [1.0, x]
    for n in range(1, number - 1):
        values.append(((2 * n + 1) * x * values[n] - n * values[n - 1]) / (n + 1))
    return values


def _integral(series):
    """Integral from -1 of a sum of Legendre polynomials, by the factors of both."""
    total = [series[0], series[0], *[0.0] * (len(series) - 1)]
    for n, factor in enumerate(series[1:], 1):
        total[n + 1] += factor / (2 * n + 1)
        total[n - 1] -= factor / (2 * n + 1)
    return total


@cache
def _gauss(number):
    """Points of Gauss and Legendre from 0 to 1, and their weights."""
    rule = []
    for k in range(number):
        x = math.cos(math.pi * (k + 3 / 4) / (number + 1 / 2))
        for _ in range(_NEWTON):
            *_, before, value = _legendre(x, number + 1)
            slope = number * (before - x * value) / (1 - x * x)
            x -= value / slope
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    return tuple(zip(*rule, strict=True))


class _Basis:
    """Deflections of a bent beam from 0 to 1, each with a curvature of one Legendre polynomial."""

    def __init__(self, clamps):
        """Beam with one or two clamps. A bridge is symmetric: half of its points stand for all."""
        orders = range(_POLYNOMIALS) if clamps == 1 else range(2, 2 * _POLYNOMIALS + 2, 2)
        slopes = [_integral([0.0] * order + [1.0]) for order in orders]
        self._series = [_integral(series) for series in slopes]
        self._areas = [_integral(series) for series in self._series]
        points, self.weights = _gauss(_POINTS)
        self.at = [self.deflections(point / clamps) for point in points]
        self.by_polynomial = [[*map(mul, column, self.weights)] for column in zip(*self.at, strict=True)]
        self.end = self.deflections(1 / clamps)
        self.bending = [1 / (2 * order + 1) for order in orders]
        squares = [1 / (4 * (2 * n + 1)) for n in range(len(slopes[-1]))]
        self.slope = [_dot(map(mul, series, series), squares) for series in slopes]
        self.coupling = [_dot(map(mul, *both), squares) for both in pairwise(slopes)]

    def deflections(self, x):
        """Deflection of each polynomial at x."""
        return self._at(self._series, x, 4)

    def areas(self, x):
        """Integral of each deflection from 0 to x."""
        return self._at(self._areas, x, 8)

    @staticmethod
    def _at(rows, x, scale):
        """Values of some series at x, where -1 to 1 is the length of a beam."""
        values = _legendre(2 * x - 1, len(rows[-1]))
        return [_dot(row, values) / scale for row in rows]


_basis = cache(_Basis)
#: Logarithm of a load factor, and factors of the polynomials, where an iteration begins.
AT_REST = [0.0] * (1 + _POLYNOMIALS)


@dataclass(frozen=True)
class GrowingLoad:
    """Load on a beam by its deflection U in gaps."""

    along: Callable[[float], float]  #: f, per length [-]
    at_end: Callable[[float], float] | None = None  #: at the free end, over the length [-]


@dataclass(frozen=True)
class BentBeam:
    """Beam in units of its length, gap and stiffness."""

    clamps: int  #: 1, a cantilever, or 2, a bridge
    tension: float = 0.0  #: τ [-]

    def under(self, load: GrowingLoad, deflection: float) -> tuple[float, list[float]]:
        """Load factor λ to bend the end or middle to a deflection in gaps, and the factors of the polynomials."""
        logarithm, *factors = settled(lambda state: self.nearer(load, deflection, state[1:]), AT_REST)
        return math.exp(logarithm), factors

    def nearer(self, load: GrowingLoad, deflection: float, factors: Sequence[float]) -> list[float]:
        """Logarithm of the load factor, and factors of the polynomials, nearer to a balance than some factors."""
        basis = _basis(self.clamps)
        along = [load.along(_dot(row, factors)) for row in basis.at]
        forces = [_dot(row, along) for row in basis.by_polynomial]
        if load.at_end and self.clamps == 1:
            end = load.at_end(deflection)
            forces = [force + end * at_end for force, at_end in zip(forces, basis.end, strict=True)]
        by_unit = self._bent_by(forces)
        factor = deflection / _dot(basis.end, by_unit)
        return [math.log(factor), *(factor * each for each in by_unit)]

    def _bent_by(self, forces):
        """Factors of the polynomials under forces on them, by elimination between neighbours."""
        basis, bent = _basis(self.clamps), [*forces]
        stiffness = [bending + self.tension * slope for bending, slope in zip(basis.bending, basis.slope, strict=True)]
        couplings = [self.tension * coupling for coupling in basis.coupling]
        for k, coupling in enumerate(couplings):
            ratio = coupling / stiffness[k]
            stiffness[k + 1] -= ratio * coupling
            bent[k + 1] -= ratio * bent[k]
        bent[-1] /= stiffness[-1]
        for k in reversed(range(len(couplings))):
            bent[k] = (bent[k] - couplings[k] * bent[k + 1]) / stiffness[k]
        return bent

    def fold_of_drop(self) -> float:
        """Smallest λ of a connected drop at the end or middle, as of `stiction.life.bending.Bent.fold_of_drop`."""
        basis = _basis(self.clamps)

        def pull(begin):
            """Deflection where a drop of unit load begins."""
            ends = map(basis.areas, (1.0 if self.clamps == 1 else 1 - begin, begin))
            forces = [to_end - to_begin for to_end, to_begin in zip(*ends, strict=True)]
            return _dot(self._bent_by(forces), basis.deflections(begin))

        return 1 / (4 * largest(pull, 1 / self.clamps))

    def fold_at_once(self, load: GrowingLoad) -> float:
        """Largest λ of a load that certainly does not bring the beam down if it is switched on at once."""

        def energy(deflection):
            """Energy of the equilibrium at a deflection of the end or middle, over that at rest."""
            factor, factors = self.under(load, deflection)
            return self._stored(factors) - factor * self._work(load, factors)

        return self.under(load, root(energy, *_BEYOND))[0]

    def _stored(self, factors):
        """Energy of bending and tension."""
        basis, squares = _basis(self.clamps), [factor**2 for factor in factors]
        coupled = 2 * _dot(basis.coupling, map(mul, factors, factors[1:]))
        return (_dot(basis.bending, squares) + self.tension * (_dot(basis.slope, squares) + coupled)) / 2

    def _work(self, load, factors):
        """Work of a load from rest to some deflections, at λ = 1."""
        basis, (fractions, weights) = _basis(self.clamps), _gauss(_PARTS)

        def work(force, deflection):
            """Work of a force along a deflection."""
            return deflection * _dot(weights, [force(fraction * deflection) for fraction in fractions])

        along = [work(load.along, _dot(row, factors)) for row in basis.at]
        at_end = work(load.at_end, _dot(basis.end, factors)) if load.at_end and self.clamps == 1 else 0.0
        return _dot(basis.weights, along) + at_end


def end_stiffness(kl: float) -> tuple[float, float]:
    """Stiffnesses F and M of half of a bridge, of the length L and under a tension of kL [-].

    Examples
    --------
    >>> [round(value, 6) for value in (*end_stiffness(0.0), *end_stiffness(0.029))]
    [12.0, 6.0, 12.001009, 6.000084]
    """
    mean = math.tanh(kl / 2) / (kl / 2) if kl else 1.0
    force = 12 / (1 - kl**2 / 10 + 17 * kl**4 / 1680) if kl < SLACK else kl**2 / (1 - mean)
    return force, force * mean / 2


def largest(function: Callable[[float], float], upper: float) -> float:
    """Largest value of a function between 0 and an upper bound, by the golden section.

    Examples
    --------
    >>> round(largest(lambda x: x * (1 - x), 2.0), 9)
    0.25
    """
    low, high = (inside * upper for inside in _INSIDE)
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    for _ in range(_STEPS):
        if at_left > at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = function(right)
    return max(at_left, at_right)


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Root of a function between two places where its signs differ, by false position (Illinois).

    Examples
    --------
    >>> round(root(lambda x: x**3 - 2, 0.0, 2.0) ** 3, 9)
    2.0
    """
    at_low, at_high = function(low), function(high)
    for _ in range(_ITERATIONS):
        guess = (low * at_high - high * at_low) / (at_high - at_low)
        at_guess = function(guess)
        if abs(guess - high) < _TOLERANCE or not at_guess:
            return guess
        if at_guess * at_high < 0:
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = guess, at_guess
    raise NotConverged("root of a function", abs(at_high), _TOLERANCE, _ITERATIONS)


def settled(step: Callable[[list[float]], list[float]], start: list[float]) -> list[float]:
    """Numbers that a step leaves as they are.

    Examples
    --------
    >>> round(settled(lambda numbers: [numbers[0] / 2 + 1], [0.0])[0], 9)
    2.0
    """
    for _ in range(_ITERATIONS):
        numbers = step(start)
        if (change := max(abs(new - old) for new, old in zip(numbers, start, strict=True))) < _TOLERANCE:
            return numbers
        start = numbers
    raise NotConverged("deflection or length of a beam", change, _TOLERANCE, _ITERATIONS)

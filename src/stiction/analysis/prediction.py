r"""Prediction intervals of crack lengths, with the form of the model as an error.

The differences :math:`\delta = \ln(l_\mathrm{measured} / l_\mathrm{computed})` of pair i of surfaces are

.. math:: \delta_{ij} = \alpha_i + \beta_i u_{ij} + \varepsilon_{ij}, \qquad u_{ij} = \ln l_{ij} - \overline{\ln l_i},

with a factor, a slope and a rest, normal with mean zero and variances :math:`\tau_\alpha^2, \tau_\beta^2, \sigma^2`.
ASSUME: mean zero, so that the interval lies around the computed length: what is learnt is how far the model errs, and
not in which direction. Least squares give :math:`\hat\alpha_i, \hat\beta_i` and the sum S of the squares of all rests,

.. math::

   \frac{S}{\sigma^2} \sim \chi^2_{n - 2K}, \qquad
   \frac{\sum_i \hat\alpha_i^2}{\tau_\alpha^2 + v_\alpha \sigma^2} \sim \chi^2_K, \qquad
   \frac{\sum_i \hat\beta_i^2}{\tau_\beta^2 + v_\beta \sigma^2} \sim \chi^2_K,

independent of each other, for K pairs with n lengths, where :math:`v_\alpha` and :math:`v_\beta` are the means over the
pairs of :math:`1/n_i` and :math:`1/\sum_j u_{ij}^2` (exact for pairs of equal design). Solved for the variances at the
quantiles of these three distributions, they are generalised pivots (S. Weerahandi, J. Am. Stat. Assoc. 88, 899, 1993);
negative variances are zero. Given the variances, a new length is normal in its logarithm with variance
:math:`\tau_\alpha^2 + \tau_\beta^2 u^2 + \sigma^2 + s^2`, where s is the error of the simulation. The mixture over the
variances is the prediction: a Student distribution with K degrees of freedom for a factor alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import chdtri, ndtr

#: Fewest lengths of a pair that leave something to the rest, and fewest pairs.
LENGTHS, PAIRS = 3, 2
#: Points in the cube of probabilities of the three variances, and generators of their lattice: powers of 1/g with
#: g⁴ = g + 1 (M. Roberts, 2018).
_POINTS, _LATTICE = 4096, 1.2207440846057596 ** -np.arange(1.0, 4.0)
#: Halvings of the interval with a half-width.
_HALVINGS = 40


@dataclass(frozen=True)
class Discrepancy:
    """Differences of computed from measured lengths of some pairs, as sums of squares with degrees of freedom."""

    factors: np.ndarray  #: of each pair (K,) [-]
    slopes: np.ndarray  #: of each pair (K,) [-]
    rest: float  #: sum of the squares of the rests [-]
    freedom: int  #: of the rests
    shares: tuple[float, float]  #: of the variance of the rest in those of the factors and of the slopes [-]

    @classmethod
    def learnt(cls, pairs: Sequence[tuple[np.ndarray, np.ndarray]]) -> "Discrepancy":
        """Discrepancy from computed and measured lengths of each pair, (n_i,) each, at least three different ones."""
        fits = [_line(np.log(computed), np.log(measured / computed)) for computed, measured in pairs]
        factors, slopes, rests, *shares = map(np.array, zip(*fits, strict=True))
        freedom = sum(len(computed) for computed, _ in pairs) - 2 * len(pairs)
        return cls(factors, slopes, float(rests.sum()), freedom, tuple(float(share.mean()) for share in shares))

    def variances(self) -> np.ndarray:
        """Equally probable variances of factor, slope and rest, (3, m) [-]."""
        rest = self.rest / _chi_squared(self.freedom, 0)
        between = (
            values @ values / _chi_squared(len(values), axis) - share * rest
            for axis, (values, share) in enumerate(zip((self.factors, self.slopes), self.shares, strict=True), 1)
        )
        return np.array([*(np.maximum(variance, 0.0) for variance in between), rest])

    def probability(self, half_widths: np.ndarray, coordinates: np.ndarray, errors: np.ndarray) -> np.ndarray:
        """Probability of a measured length in the interval of ln l, (r,) [-].

        Parameters
        ----------
        half_widths : (r,) array
            Of the interval around the computed ln l [-].
        coordinates : (r,) array
            u, ln l less its mean over the lengths of the pair [-].
        errors : (r,) array
            Standard errors of the computed ln l [-].
        """
        factor, slope, rest = self.variances()
        deviations = np.sqrt(factor + slope * coordinates[:, None] ** 2 + rest + errors[:, None] ** 2)
        return 2 * ndtr(half_widths[:, None] / deviations).mean(axis=1) - 1

    def half_widths(self, coordinates: np.ndarray, errors: np.ndarray, coverage: float) -> np.ndarray:
        """Half-widths of the interval of ln l with a probability of a measured length, (r,) [-]."""
        low, high = np.zeros(len(coordinates)), np.full(len(coordinates), self._widest(coordinates, errors, coverage))
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            is_short = self.probability(middle, coordinates, errors) < coverage
            low, high = np.where(is_short, middle, low), np.where(is_short, high, middle)
        return (low + high) / 2

    def _widest(self, coordinates, errors, coverage):
        """Half-width that contains the length with more than a probability at all places [-]."""
        widest = 1.0
        while (self.probability(np.full(len(coordinates), widest), coordinates, errors) <= coverage).any():
            widest *= 2
        return widest


@cache
def _chi_squared(freedom, axis):
    """Equally probable values with a chi-squared distribution, at one coordinate of the lattice (m,) [-]."""
    return chdtri(freedom, (np.arange(_POINTS) + 0.5) * _LATTICE[axis] % 1)


def _line(logarithms, differences):
    """Factor, slope, squares of the rests of one pair, and the shares of its rest in both."""
    places = logarithms - logarithms.mean()
    square = places @ places
    factor, slope = differences.mean(), places @ differences / square
    residuals = differences - factor - slope * places
    return factor, slope, residuals @ residuals, 1 / len(places), 1 / square

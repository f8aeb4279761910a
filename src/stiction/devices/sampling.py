r"""Error of lengths of beams due to the finite number of sampled surfaces, by the delta method.

A beam sticks at a length l other than :math:`l_0`, the length on uniform ground, Eq. (13) for a cantilever, because a
crack stops where adhesion is strongest. Without scatter s of the adhesion it would not: :math:`\ln(l_0 / l)` is
proportional to s. With few samples neither the length on their mean nor the scatter is exact,

.. math:: \delta \ln l = \delta \ln l_0 - \ln(l_0 / l) \, \delta \ln s .

The first term alone is cv(e) / (4 √N) of N energies e of strips under a cantilever. The scatter between groups of
samples of pair b is larger, 1.4 times for the mean length and twice for the length of P(stuck) = 0.01 at RH 0.67. Mean
lengths of bridges are those on uniform ground, and the first term is 0.98 of their variance.

The scatter is that of the work against a strip from a common distance, :math:`e - \bar f_\mathrm{max} (d_\mathrm{max} -
\bar d_\mathrm{max})` over the mean of e: a strip that lies lower than others holds a beam on a longer way. Groups of
samples have the same covariance of length and work, and of length and energy alone a smaller one.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from stiction.contact import forcelaw

#: Most groups of samples of which each is left out once.
GROUPS = 200
#: Lengths as on other samples of the same surfaces: (n,) -> (n,) [m].
Move = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class SampledSurfaces:
    """Length of a beam on ground without scatter, and the errors of mean and scatter of the sampled surfaces."""

    length: float  #: l₀ [m]
    covariance: np.ndarray  #: of ln l₀ and ln s (2, 2)

    def with_errors(self, of_length: float, of_scatter: float) -> "SampledSurfaces":
        """With further independent errors of ln l₀ and ln s: those of few strips in full elastic contact."""
        return replace(self, covariance=self.covariance + np.diag(np.square([of_length, of_scatter])))

    def error(self, statistic: Callable[[Move], np.ndarray]) -> np.ndarray:
        """Standard error of a statistic of lengths, of any shape; NaN where a move leaves it infinite.

        ``statistic(move)`` has the statistic of all lengths after a `Move`.
        """
        variances, directions = np.linalg.eigh(self.covariance)
        steps = (directions * np.sqrt(np.maximum(variances, 0.0))).T
        with np.errstate(invalid="ignore"):
            effects = [(statistic(self._move(*step)) - statistic(self._move(*-step))) / 2 for step in steps]
        variance = np.sum(np.square(effects), axis=0)
        return np.sqrt(np.where(np.isfinite(variance), variance, np.nan))

    def _move(self, of_mean, of_scatter):
        """Move with errors of ln l₀ and ln s."""
        return partial(_moved, factor=np.exp(of_mean) * self.length**-of_scatter, power=1 + of_scatter)


def _moved(lengths, factor, power):
    """Lengths (n,) to a power, infinite ones as they are [m]."""
    return factor * lengths**power


def sampled_surfaces(
    laws: np.ndarray,
    contribution: Callable[[np.ndarray], np.ndarray],
    length_on_mean: Callable[[np.ndarray], float],
    uniform: float,
) -> SampledSurfaces:
    """Errors of mean and scatter of sampled force laws (m, 4) [SI], by a jackknife.

    ``contribution`` of the laws is (m, ...), and ``length_on_mean`` of some of it is proportional to the length;
    ``uniform`` is the length without scatter [m].
    """
    contributions, energies, works = contribution(laws), forcelaw.energy(laws), _works(laws)
    groups = min(GROUPS, len(laws))
    group = np.arange(len(laws)) % groups

    def logarithms(used):
        """Logarithms of length and scatter of some samples (m,) bool."""
        return np.log([length_on_mean(contributions[used]), works[used].std() / energies[used].mean()])

    left_out = np.array([logarithms(group != k) for k in range(groups)])
    covariance = (groups - 1) ** 2 / groups * np.cov(left_out.T)
    return SampledSurfaces(uniform, covariance)


def _works(laws):
    """Work against each strip from the mean distance of the largest attractions (m,) [J m⁻²]."""
    largest, distance = laws[:, 0], laws[:, 1]
    return forcelaw.energy(laws) - largest.mean() * (distance - distance.mean())

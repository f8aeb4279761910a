r"""Uncertainty budget of a length: effects of its inputs, and the most useful measurement.

The length is linear in its inputs on a logarithmic scale, :math:`d \ln l = \sum_k g_k dx_k`; joint shifts of the inputs
of pair b add up to within 0.1 %. The slopes come from runs with common random numbers. With the covariance C of the
inputs, the relative variance of the length is :math:`g^T C g`. Inputs from one measurement are correlated: the errors
of skewness and kurtosis from one scan cancel by half, and taking them as independent doubles the result.

Large errors of stated surfaces are not linear: the margin of a length to build has their curvature. What is assumed of
a surface is that of one of m typical surfaces, on each of which the response is computed. Among the inputs, these
surfaces are m weights of their shifts. With 1/m expected of each, and the covariance of `weights_of_kind`, they have
mean and variance of a further surface of the kind.

The scatter from beam to beam is no uncertainty of the length and is stated apart, as are choices of the model, which
have no distribution.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

#: Standard uncertainties that are subtracted from a length to build: normal errors exceed them on the unsafe side with
#: a probability of 2 %.
SUBTRACTED = 2.0
#: Largest uncertainty of the logarithm of a length that allows a length to build. ASSUME: above it, where twice as much
#: takes two thirds of the length, a budget that is linear does not say how much to subtract.
LARGEST = 0.5
#: Relative error of a slope below which all devices have the same slope, but for rounding, and share of a variance.
_ROUNDING = 1e-9


def weights_of_kind(m: int) -> np.ndarray:
    """Covariance of the weights of m surfaces of one kind, whose sum is exact (m, m) [-].

    Raises
    ------
    ValueError
        If there are fewer than two surfaces.
    """
    if m < 2:
        raise ValueError(f"a kind needs two surfaces or more, got {m}")
    return (np.eye(m) - 1 / m) * (1 + 1 / m) / (m - 1)


@dataclass(frozen=True)
class Budget:
    """Slopes and covariance of the inputs of one length."""

    names: tuple[str, ...]  #: of the inputs
    slopes: np.ndarray  #: d ln l / dx of each (k,) [1 / unit of x]
    covariance: np.ndarray  #: of their errors (k, k)
    kinds: tuple[tuple[str, ...], ...] = ()  #: inputs that are surfaces of one kind, whose slopes are shifts

    def __post_init__(self):
        k = len(self.names)
        if np.shape(self.slopes) != (k,) or np.shape(self.covariance) != (k, k):
            raise ValueError(f"{k} inputs need as many slopes and a square covariance")
        scale = np.sqrt(np.diag(self.covariance))
        correlation = self.covariance / np.outer(*[np.where(scale > 0, scale, 1)] * 2)
        if not np.allclose(correlation, correlation.T) or np.linalg.eigvalsh(correlation).min(initial=0) < -1e-9:
            raise ValueError("a covariance must be symmetric and must not have negative eigenvalues")

    @property
    def total(self) -> float:
        """Relative standard uncertainty of the length [-]."""
        return float(np.sqrt(np.maximum(self.slopes @ self.covariance @ self.slopes, 0)))

    @property
    def uncorrelated(self) -> "Budget":
        """Budget of the same inputs, taken as independent. Surfaces of one kind are one input."""
        correlated = np.eye(len(self.names), dtype=bool)
        for kind in self.kinds:
            correlated[np.ix_(*[self._positions(kind)] * 2)] = True
        return replace(self, covariance=np.where(correlated, self.covariance, 0.0))

    def unsafe_total(self, bends: np.ndarray) -> float:
        r"""Half of a margin that keeps its probability where the response is curved [-].

        With :math:`g_k x + b_k x^2` and b (k,) [1 / unit of x²], an error of two standard uncertainties moves the
        response by :math:`2 \sigma_k (|g_k| + 2 b_k \sigma_k)` to its unsafe side, and all curvatures move its mean by
        :math:`\sum b_k \sigma_k^2`. What is curved to the safe side counts as linear: the margin is then too large.
        """
        deviations, curved = np.sqrt(np.diag(self.covariance)), np.maximum(bends, 0.0)
        steeper = SUBTRACTED * curved * deviations
        slopes = self.slopes + np.where(self.slopes < 0, -steeper, steeper)
        return replace(self, slopes=slopes).total + float(curved @ deviations**2) / SUBTRACTED

    def effect(self, group: Sequence[str]) -> float:
        """Relative standard uncertainty of the length due to some inputs together, the others being exact [-]."""
        positions = self._positions(group)
        return float(
            np.sqrt(
                np.maximum(
                    self.slopes[positions] @ self.covariance[np.ix_(positions, positions)] @ self.slopes[positions], 0
                )
            )
        )

    def error_of_effect(self, group: Sequence[str], slope_errors: np.ndarray) -> float:
        """Standard error of `effect` due to those of the slopes of all inputs (k,) [-]."""
        positions, effect = self._positions(group), self.effect(group)
        if effect == 0:
            return 0.0
        gradient = self.covariance[np.ix_(positions, positions)] @ self.slopes[positions] / effect
        return float(np.linalg.norm(gradient * np.asarray(slope_errors)[positions]))

    def remaining(self, group: Sequence[str]) -> float:
        """Relative standard uncertainty of the length left if some inputs were known exactly [-].

        What is correlated with these inputs is then better known, too: the variance falls by that of the regression
        on them.
        """
        positions = self._positions(group)
        shared = self.covariance[positions] @ self.slopes
        explained = shared @ np.linalg.pinv(self.covariance[np.ix_(positions, positions)], hermitian=True) @ shared
        unexplained = self.total**2 - explained
        return 0.0 if unexplained < _ROUNDING * self.total**2 else float(np.sqrt(unexplained))

    def _positions(self, group):
        """Positions of inputs."""
        return [self.names.index(name) for name in group]


def joined(budgets: Sequence[Budget]) -> Budget:
    """Budget of inputs from independent measurements."""
    names = tuple(name for budget in budgets for name in budget.names)
    slopes = np.concatenate([budget.slopes for budget in budgets])
    kinds = sum((budget.kinds for budget in budgets), ())
    return Budget(names, slopes, block_diag(*(budget.covariance for budget in budgets)), kinds)


def log_slope(
    length: Callable[[np.ndarray], float], less: np.ndarray, more: np.ndarray, step: float, groups: int = 20
) -> tuple[float, float]:
    """Slope d ln l / dx by a central difference, and its jackknife standard error over groups of devices.

    ``length`` is that of a sample of devices, such as ``np.mean`` of crack lengths, (n,) -> [m]. Device k has the same
    random numbers in ``less`` and ``more``, the lengths (n,) at both values of the input x [m], which differ by a step.
    Each of at most n groups is left out once. Slope and error are NaN where ``length`` is infinite, because too few
    devices stick.
    """

    def slope(devices):
        """Central difference of ln length over the step, NaN without finite lengths."""
        ends = length(less[devices]), length(more[devices])
        return np.log(ends[1] / ends[0]) / step if np.isfinite(ends).all() else np.nan

    group = np.arange(len(less)) % groups
    of_all, left_out = float(slope(np.ones(len(less), bool))), np.array([slope(group != k) for k in range(groups)])
    if not np.isfinite([of_all, *left_out]).all():
        return np.nan, np.nan
    error = float(np.sqrt((groups - 1) / groups * np.sum((left_out - left_out.mean()) ** 2)))
    return of_all, error if error > _ROUNDING * abs(of_all) else 0.0


def choice_effect(base: float, changed: float) -> float:
    """Relative change of a length by another choice of the model, ln(changed / base) [-]. NaN without a finite one."""
    return float(np.log(changed / base)) if np.isfinite([base, changed]).all() else np.nan


def ranked(budget: Budget, groups: Mapping[str, Sequence[str]]) -> list[tuple[str, float, float]]:
    """Name, effect and remaining uncertainty of groups of inputs, the largest gain first."""
    rows = [(name, budget.effect(inputs), budget.remaining(inputs)) for name, inputs in groups.items()]
    return sorted(rows, key=lambda row: row[2])


def advice(budget: Budget, groups: Mapping[str, Sequence[str]], response: str = "length") -> str:
    """Sentence on the best measurement: the group with the largest reduction of uncertainty if known exactly.

    ``response`` is what the budget is of.
    """
    name, _, remaining = ranked(budget, groups)[0]
    return (
        f"Measure {name} better: known exactly, the standard uncertainty of the {response} would fall from "
        f"{100 * budget.total:.1f} to {100 * remaining:.1f} %."
    )

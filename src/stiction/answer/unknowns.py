"""Errors of the inputs of a device: by the slopes of budgets, by whole typical surfaces, or as test beams leave them.

Every cause has the same errors in all airs and end states of a device.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from stiction.devices.budget import SUBTRACTED, Budget
from stiction.streams import stream


class Draws(NamedTuple):
    """Number of draws, and the seed of their random numbers."""

    number: int
    seed: int


@lru_cache(maxsize=256)  # every step asks for the same
def normal(draws: Draws, *key: str) -> np.ndarray:
    """Standard normal numbers of a key (number,)."""
    return stream(draws.seed, "error in answers", *key).standard_normal(draws.number)


#: Humidity [-] and end state.
At = tuple[float, str]


class Unknowns(Protocol):
    """Shifts of the thresholds of a device by the errors of its inputs."""

    def shift(self, at: At, draws: Draws, exact: frozenset[str], /) -> np.ndarray:
        """Shift in an air and end state, in every draw (number,), if some groups of inputs are exact."""

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of inputs that one measurement determines."""


@dataclass(frozen=True)
class Members:
    """Shifts of v on whole typical surfaces in place of one surface of a pair."""

    surface: str
    shifts: np.ndarray  #: (m,)
    errors: np.ndarray | float = 0.0  #: standard errors of the shifts (m,)

    def further(self, draws: Draws, shape: str = "") -> np.ndarray:
        r"""Draw shifts on further surfaces of the kind of which m are known (number,).

        With m normal members the shift of another one is :math:`\bar s + s \sqrt{1 + 1/m}\, t_{m-1}`. The same member
        numbers serve all airs and end states, so that their covariance is that of the members. Errors of the shifts are
        those of an end state, and left out without one.

        Examples
        --------
        >>> float(np.ptp(Members("B2", np.array([0.25, 0.25, 0.25, 0.25])).further(Draws(5, 0))))
        0.0
        """
        m = len(self.shifts)
        mixed, scale = _members(m, draws, self.surface)
        shifts = self.shifts[:, None] + np.zeros((m, draws.number))
        if shape and np.any(self.errors):
            noise = [normal(draws, "member", self.surface, str(k), shape) for k in range(m)]
            shifts += np.broadcast_to(self.errors, m)[:, None] * noise
        mean = shifts.mean(axis=0)
        return mean + np.sqrt(1 + 1 / m) * scale * ((shifts - mean) * mixed).sum(axis=0)


@dataclass(frozen=True)
class Slopes:
    """Slopes of v by the inputs in one air and end state, with their errors."""

    names: tuple[str, ...]
    groups: tuple[str, ...]  #: of each input
    slopes: np.ndarray  #: (k,)
    errors: np.ndarray  #: standard errors of the slopes (k,)
    bends: np.ndarray  #: curvatures b in g x + b x² (k,)
    covariance: np.ndarray  #: of the inputs (k, k)
    members: tuple[Members, ...] = ()
    limits: np.ndarray | None = None  #: errors of the inputs beyond which they count as there (k, 2); all count without

    @property
    def total(self) -> float:
        """Standard uncertainty of v by inputs with slopes [-]."""
        return float(np.sqrt(self.slopes @ self.covariance @ self.slopes))

    @property
    def margin(self) -> float:
        """Half of a margin for inputs with slopes, with their curvature, see `stiction.devices.budget` [-]."""
        return Budget(self.names, self.slopes, self._counted_covariance).unsafe_total(-self.bends)

    @property
    def _counted_covariance(self):
        """Covariance of errors of which the subtracted ones are within their limits on the unsafe side (k, k)."""
        if self.limits is None:
            return self.covariance
        deviations = np.sqrt(np.diag(self.covariance))
        ends = np.where(self.slopes > 0, -self.limits[:, 0], self.limits[:, 1]) / SUBTRACTED
        shares = np.divide(ends, deviations, out=np.ones(len(ends)), where=deviations > ends)
        return self.covariance * np.outer(shares, shares)

    def counted(self, k: int, errors: np.ndarray) -> np.ndarray:
        """Errors of one input as they count (n,)."""
        return errors if self.limits is None else np.clip(errors, *self.limits[k])

    @property
    def is_known(self) -> bool:
        """Whether enough devices stick to show what every input changes."""
        return all(np.isfinite(values).all() for values in (self.slopes, *(member.shifts for member in self.members)))


#: Group of the inputs that a scan of a surface determines together.
_OF_SURFACE = "the surface {}"


@dataclass(frozen=True)
class OfBudgets:
    """Inputs with the slopes of budgets, by air and end state."""

    budgets: Mapping[At, Slopes]
    own_errors: bool = True  #: whether the errors of the slopes count
    #: Errors that were drawn.
    _drawn: dict = field(default_factory=dict, repr=False, compare=False)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of inputs, in the order of the budgets."""
        of_slopes = [group for budget in self.budgets.values() for group in budget.groups]
        surfaces = [_OF_SURFACE.format(member.surface) for budget in self.budgets.values() for member in budget.members]
        return tuple(dict.fromkeys([*surfaces, *of_slopes]))

    def budget(self, at: At) -> Slopes | None:
        """Budget of an air and end state, or the most uncertain one of this end state where too few devices stick."""
        slopes = self.budgets.get(at)
        if slopes is None or slopes.is_known:
            return slopes
        others = [slopes for (_, shape), slopes in self.budgets.items() if shape == at[1] and slopes.is_known]
        return max(others, key=lambda slopes: slopes.total, default=None)

    def shift(self, at: At, draws: Draws, exact: frozenset[str]) -> np.ndarray:
        """Shift as of `Unknowns`."""
        budget, shift = self.budget(at), np.zeros(draws.number)
        if budget is None:
            return shift
        errors = self._errors(draws)
        for k, (name, group) in enumerate(zip(budget.names, budget.groups, strict=True)):
            if group not in exact:
                slope = budget.slopes[k]
                if self.own_errors:
                    slope = slope + budget.errors[k] * normal(draws, "slope", name, at[1])
                # ASSUME: what bends to the safe side counts as linear, as in `Budget.unsafe_total`.
                error = budget.counted(k, errors[name])
                shift += slope * error + min(budget.bends[k], 0.0) * error**2
        for members in budget.members:
            if _OF_SURFACE.format(members.surface) not in exact:
                shift += members.further(draws, at[1] if self.own_errors else "")
        return shift

    def _errors(self, draws):
        """Errors of all inputs, (number,) each, by name."""
        if draws not in self._drawn:
            names, covariance = joint(list(self.budgets.values()))
            scales = np.sqrt(np.diag(covariance))  # inputs have units of their own
            values, vectors = np.linalg.eigh(covariance / np.outer(*[np.where(scales > 0, scales, 1.0)] * 2))
            root = scales[:, None] * vectors * np.sqrt(np.clip(values, 0, None))
            # One stream for each input, so that a further input changes no error of the others.
            independent = np.array([normal(draws, "input", name) for name in names]).reshape(-1, draws.number)
            self._drawn[draws] = dict(zip(names, root @ vectors.T @ independent, strict=True))
        return self._drawn[draws]


def joint(budgets: Sequence[Slopes]) -> tuple[list[str], np.ndarray]:
    """Names of all inputs of some budgets, and their covariance. Inputs that no budget has together are independent."""
    names = list(dict.fromkeys(name for budget in budgets for name in budget.names))
    covariance = np.zeros((len(names), len(names)))
    for budget in reversed(budgets):
        positions = [names.index(name) for name in budget.names]
        covariance[np.ix_(positions, positions)] = budget.covariance
    return names, covariance


@lru_cache(maxsize=64)
def _members(m, draws, surface):
    """Weights of members (m, number) and factors of Student's distribution (number,)."""
    rng = stream(draws.seed, "answer", "members", surface)
    weights = rng.standard_normal((m, draws.number)) / np.sqrt(m - 1)
    return weights, np.sqrt((m - 1) / rng.chisquare(m - 1, draws.number))


@dataclass(frozen=True)
class OfTestBeams:
    """Inputs and model as test beams leave them: quantiles of the shift of v by its normal score."""

    scores: np.ndarray  #: increasing (s,)
    quantiles: Mapping[At, np.ndarray]  #: by air and end state (s,)
    groups: tuple[str, ...] = ()

    def shift(self, at: At, draws: Draws, _exact: frozenset[str]) -> np.ndarray:
        """Shift as of `Unknowns`. ASSUME: the errors left in all airs and end states are those of one cause."""
        if at not in self.quantiles:
            return np.zeros(draws.number)
        return np.interp(normal(draws, "test beams"), self.scores, self.quantiles[at])


@dataclass(frozen=True)
class Exact:
    """Inputs without errors."""

    groups: tuple[str, ...] = ()

    def shift(self, _at: At, draws: Draws, _exact: frozenset[str]) -> np.ndarray:
        """Shift as of `Unknowns`: none."""
        return np.zeros(draws.number)

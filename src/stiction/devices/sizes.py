r"""Lengths of beams of many sizes on one ground, from beams of a few sizes by finite elements.

Beams of all sizes meet the same random strips, so that their sorted lengths are smooth in the size. Each of them
follows a power law of thickness and gap, :math:`l_k = c_k \, t^{\alpha_k} h^{\beta_k}`, through beams of the smallest
and largest sizes. Beams of sizes between them, to which it was not fitted, say how much it errs.

On grounds of the paper's pair b at RH 0.44 and 0.67, over a factor of 3 in thickness and 2 in gap, the shortest 5 % of
the lengths err by -0.9 to +0.4 %: in the middle the laws are mostly too short, the safe side.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from stiction.devices.tail import TAIL
from stiction.rounding import is_at_most

#: Largest relative error of power laws that are used. ASSUME: lengths for a share of 1e-3 are known to 1 to 3 %.
ALLOWED = 0.02


@dataclass(frozen=True)
class PowerLaws:
    """Power law of each of the sorted lengths."""

    powers: np.ndarray  #: ln c, α and β of each length (3, n) [SI]
    error: float  #: largest relative error, mostly at sizes to which they were not fitted [-]
    excess: float  #: by how much they are too long at most [-]

    @property
    def holds(self) -> bool:
        """Whether they are good enough to be used."""
        return is_at_most(self.error, ALLOWED)

    def lengths(self, thickness: float, gap: float) -> np.ndarray:
        """Lengths of beams of one size (n,) [m]. ASSUME: no size exceeds its own by more than those tested."""
        return _by(self.powers, thickness, gap) * (1 - self.excess)


def _by(powers, thickness, gap):
    """Lengths by power laws (n,)."""
    return np.exp(np.array([1.0, np.log(thickness), np.log(gap)]) @ powers)


def _errors(predicted, lengths):
    """Relative errors of sorted lengths (n,): mean of the shortest 5 %, and of all."""
    errors = np.log(predicted / lengths)
    return [float(errors[: int(TAIL * errors.size) or 1].mean()), float(errors.mean())]


def fitted(thicknesses: Sequence[float], gaps: Sequence[float], lengths: Sequence[np.ndarray]) -> PowerLaws:
    """Power laws through the corners of sizes, and their error at all others. They hold nowhere if a length is unknown.

    Parameters
    ----------
    thicknesses, gaps : sequence of float
        Smallest, middle and largest, or the only one [m].
    lengths : sequence of (n,) array
        Of beams of all sizes, the products of thicknesses and gaps in this order; infinite ones are unknown [m].
    """
    if not np.isfinite(lengths).all():
        return PowerLaws(np.full((3, len(lengths[0])), np.nan), np.inf, np.inf)
    sizes = dict(zip(product(thicknesses, gaps), np.sort(lengths), strict=True))
    corners = list(dict.fromkeys(product(*([each[0], each[-1]] for each in (thicknesses, gaps)))))
    terms = np.column_stack([np.ones(len(corners)), np.log(corners)])
    # A dimension that does not vary has no power of its own: the least one of all solutions holds at its value.
    powers = np.linalg.lstsq(terms, np.log([sizes[size] for size in corners]))[0]
    errors = [error for size, simulated in sizes.items() for error in _errors(_by(powers, *size), simulated)]
    return PowerLaws(powers, max(map(abs, errors)), max(0.0, *errors))

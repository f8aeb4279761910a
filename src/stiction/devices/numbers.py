r"""Numbers of beams and of sampled strips for a relative standard error of a length, from a pilot.

The squared error of a length has two independent parts, of n beams and of N strips,

.. math:: \epsilon^2 = (s \, c(n))^2 + r^2 / N ,

with the slope s of the logarithm of the length over the normal score, the error c(n) of a quantile of normal numbers,
and r by the delta method (`stiction.devices.sampling`). Each part may have a half, or what the other one leaves of it.

Where no accuracy is asked for, the length without scatter alone decides the number of strips.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.special import ndtri

from stiction.devices.risk import samples_for
from stiction.devices.tail import scaled_errors
from stiction.streams import stream

#: Most beams and most strips.
MOST_BEAMS, MOST_STRIPS = 20_000, 10_000
#: Numbers are multiples of these. 200 beams are the fewest with a fit of the shortest lengths.
_BEAMS, _STRIPS = 200, 100
#: Relative error of the length without scatter, and fewest and most strips for it, multiples of the fewest.
#: ASSUME: half the error of the length of P(stuck) = 0.001 of 1000 beams of pair b at RH 0.67, which is 0.6 %.
MEAN_ERROR, FEWEST_OF_MEAN, MOST_OF_MEAN = 0.003, 500, 5000
#: Number of beams for which the error of a fit is simulated. Times the root of the number, it is nearly constant.
_SIMULATED = 1000


@dataclass(frozen=True)
class Spread:
    """Spread of a length in a pilot."""

    slope: float  #: of the logarithm of the length over the normal score, at its lower end [-]
    surfaces: float  #: relative error of the length on one strip; of many, it falls with the root of their number [-]

    def error(self, beams: int, strips: int, share: float) -> float:
        """Relative standard error of the length of P(stuck) = share [-]."""
        return float(np.hypot(self.slope * quantile_errors(np.array([beams]), share)[0], self.surfaces / strips**0.5))


def quantile_errors(numbers: np.ndarray, share: float) -> np.ndarray:
    """Standard error of a quantile of normal numbers, for several numbers of them (n,) [-].

    As in `stiction.devices.risk.safe_length`: an order statistic if there are enough, otherwise a fit of the lowest.
    """
    sampled = np.sqrt(2 * np.pi * share * (1 - share)) * np.exp(ndtri(share) ** 2 / 2)
    return np.where(numbers >= samples_for(share), sampled, _error_of_fit(share)) / numbers**0.5


@cache
def _error_of_fit(share):
    """Error of a fit, times the root of the number of beams [-]."""
    return scaled_errors(_SIMULATED, share, stream(0, "numbers"))[0].std() * _SIMULATED**0.5


def beams_for(spreads: Sequence[Spread], share: float, accuracy: float, strips: int) -> int:
    """Smallest number of beams for an accuracy of all lengths, with at least this number of strips.

    Without such a number, that with the smallest error: up to `MOST_BEAMS`, or below the step to order statistics,
    which have a larger error than a fit.
    """
    numbers = np.arange(_BEAMS, MOST_BEAMS + 1, _BEAMS)
    errors = quantile_errors(numbers, share)
    enough = np.all(
        [spread.slope * errors <= _remaining_error(accuracy, spread.surfaces / strips**0.5) for spread in spreads],
        axis=0,
    )
    return int(numbers[np.argmax(enough) if enough.any() else np.argmin(errors)])


def strips_for(spreads: Sequence[Spread], share: float, accuracy: float, beams: int, fewest: int) -> int:
    """Smallest number of strips for an accuracy of all lengths with a number of beams, up to `MOST_STRIPS`."""
    error = quantile_errors(np.array([beams]), share)[0]
    strips = max((spread.surfaces / _remaining_error(accuracy, spread.slope * error)) ** 2 for spread in spreads)
    return min(max(int(np.ceil(strips / _STRIPS)), -(-fewest // _STRIPS)) * _STRIPS, MOST_STRIPS)


def strips_for_mean(error: float, fewest: int) -> int:
    """Number of strips for the error `MEAN_ERROR` of a length without scatter, from its error on one strip [-].

    At least `FEWEST_OF_MEAN` and this number, rounded up to a multiple, at most `MOST_OF_MEAN`.

    Examples
    --------
    >>> strips_for_mean(0.25 * 0.24, 300), strips_for_mean(0.25 * 0.59, 300), strips_for_mean(0.25 * 0.24, 1820)
    (500, 2500, 2000)
    """
    strips = max((error / MEAN_ERROR) ** 2, fewest, 1)
    return min(math.ceil(strips / FEWEST_OF_MEAN) * FEWEST_OF_MEAN, MOST_OF_MEAN)


def _remaining_error(accuracy, other):
    """Error that the other part leaves of an accuracy, at least half of its square [-]."""
    return max(accuracy**2 / 2, accuracy**2 - other**2) ** 0.5

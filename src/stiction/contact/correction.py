"""Correction of the sum over summits to full elastic contact: the ratios of both models, over the humidity."""

from dataclasses import dataclass

import numpy as np

from stiction.rounding import is_at_most


def interpolated(ratios: np.ndarray, humidities: np.ndarray, at: float | np.ndarray) -> float | np.ndarray:
    """Ratios at some humidities, from ratios (h,) at the computed, increasing ones, NaN beyond them [-].

    ASSUME: between the computed humidities, the logarithm of a ratio is linear in the humidity.

    Examples
    --------
    >>> round(float(interpolated(np.array([0.64, 1.0]), np.array([0.4, 0.8]), 0.6)), 12)
    0.8
    """
    return np.exp(np.interp(at, humidities, np.log(ratios), left=np.nan, right=np.nan))


@dataclass(frozen=True)
class Correction:
    """Ratios of full elastic contact to the sum over summits.

    Only the energy e and the largest attraction f_max are corrected: distances of both models are between different
    mean planes, those of the deformed surfaces and those of the undeformed ones, and have no common origin.
    """

    humidities: np.ndarray  #: increasing (h,) [-]
    energy: np.ndarray  #: of the mean energies e (h,) [-]
    pull_off: np.ndarray  #: of the mean largest attractions f_max (h,) [-]

    def at(self, humidity: float) -> tuple[float, float]:
        """Ratios of e and of f_max at a humidity.

        Raises
        ------
        ValueError
            If the humidity is beyond those at which full contact was computed.
        """
        low, high = self.humidities[[0, -1]]
        if not (is_at_most(low, humidity) and is_at_most(humidity, high)):
            raise ValueError(
                f"full elastic contact was computed at relative humidities from {low:g} to {high:g} and is not "
                f"extrapolated to {humidity:g}: add it to those of the pair, or choose contact.model: summits"
            )
        within = np.clip(humidity, low, high)  # rounding can leave it a little outside
        energy, pull_off = (interpolated(ratios, self.humidities, within) for ratios in (self.energy, self.pull_off))
        return float(energy), float(pull_off)

    def vectors(self, vectors: np.ndarray, limit: float, humidity: float) -> tuple[np.ndarray, float]:
        """Vectors v of Eq. (11) (n, 4) and f_limit [SI] at a humidity: e and f_max of all samples by one ratio each."""
        energy, pull_off = self.at(humidity)
        return vectors * [energy, pull_off, 1, 1], limit * pull_off

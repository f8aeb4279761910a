"""Correction of the sum over summits to full elastic contact: the ratios of both models, over the humidity."""

from dataclasses import dataclass

import numpy as np

from stiction.rounding import is_at_most


def interpolated(ratios: np.ndarray, humidities: np.ndarray, at: float | np.ndarray) -> float | np.ndarray:
    """Ratios at some humidities, from ratios (h,) at the computed, increasing ones, NaN beyond them [-].

    ASSUME: between the computed humidities, the logarithm of a ratio is linear in the humidity. Dry air, humidity 0, is
    no end of such a line.

    Examples
    --------
    >>> round(float(interpolated(np.array([0.64, 1.0]), np.array([0.4, 0.8]), 0.6)), 12)
    0.8
    """
    humid, found = humidities > 0, np.full(np.shape(at), np.nan)
    if humid.any():
        found = np.exp(np.interp(at, humidities[humid], np.log(ratios[humid]), left=np.nan, right=np.nan))
    return found if humid.all() else np.where(np.equal(at, 0), ratios[~humid][0], found)


@dataclass(frozen=True)
class Correction:
    """Ratios of full elastic contact to the sum over summits.

    Only the energy e and the largest attraction f_max are corrected: distances of both models are between different
    mean planes, those of the deformed surfaces and those of the undeformed ones, and have no common origin.
    """

    humidities: np.ndarray  #: increasing (h,), 0 for dry air [-]
    energy: np.ndarray  #: of the mean energies e (h,) [-]
    pull_off: np.ndarray  #: of the mean largest attractions f_max (h,) [-]

    def at(self, humidity: float) -> tuple[float, float]:
        """Ratios of e and of f_max at a humidity, 0 for dry air: 1 in humid air with ratios in dry air alone.

        Raises
        ------
        ValueError
            If the humidity is beyond those at which full contact was computed.
        """
        known = self.humidities[(self.humidities > 0) == (humidity > 0)]
        if humidity > 0 and not known.size:
            return 1.0, 1.0
        low, high = known.min(initial=1.0), known.max(initial=0.0)
        if not (is_at_most(low, humidity) and is_at_most(humidity, high)):
            where = f"at relative humidities from {low:g} to {high:g}" if known.size else "in other air alone"
            raise ValueError(
                f"full elastic contact was computed {where} and is not extrapolated to {humidity:g}: add it to the "
                "humidities of the pair, or choose contact.model: summits"
            )
        within = np.clip(humidity, low, high)  # rounding can leave it a little outside
        energy, pull_off = (interpolated(ratios, self.humidities, within) for ratios in (self.energy, self.pull_off))
        return float(energy), float(pull_off)

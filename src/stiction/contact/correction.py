"""Correction of the sum over summits to full elastic contact: changes between both models, over the humidity."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from stiction.contact.air import is_humid
from stiction.contact.full.smooth_pairs import in_wetter_air
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
    humid, values = is_humid(humidities), np.full(np.shape(at), np.nan)
    if humid.any():
        values = np.exp(np.interp(at, humidities[humid], np.log(ratios[humid]), left=np.nan, right=np.nan))
    return values if humid.all() else np.where(is_humid(at), values, ratios[~humid][0])


class ElasticChange(NamedTuple):
    r"""Change of a quantity of samples by full elastic contact, at one humidity or at several (h,).

    A value x on summits becomes :math:`c x^b`. c follows from the ratio of both means, and the power b is the ratio of
    both standard deviations of ln x. ASSUME: the order of the samples is the same, and b is at least 1, the safe side:
    over 40 strips each of 3.4 and 6.8 nm rms in dry air, ln e of both models has a correlation of 0.91 and 0.95.
    """

    ratio: float | np.ndarray = 1.0  #: of the means [-]
    power: float | np.ndarray = 1.0  #: b [-]
    ratio_error: float | np.ndarray = 0.0  #: relative standard error of the ratio [-]
    power_error: float | np.ndarray = 0.0  #: standard error of the power [-]

    def of(self, summits: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """Change of values beside those of all samples on summits (m, ...)."""
        if self == NONE:
            return lambda values: values
        mean, powered = (np.asarray(values.mean(axis=0)) for values in (summits, summits**self.power))
        scale = self.ratio * np.divide(mean, powered, out=np.ones_like(mean), where=powered > 0)
        return lambda values: scale * values**self.power

    def at_most(self, confidence: float) -> "ElasticChange":
        """Change with the upper end of the ratio at a one-sided confidence."""
        return self._replace(ratio=self.ratio * np.exp(ndtri(confidence) * self.ratio_error))


#: Without a correction.
NONE = ElasticChange()


class TipChanges(NamedTuple):
    """Changes of the largest attraction of tips by full elastic contact, over the slope.

    ASSUME: between the slopes, the logarithm of the ratio is linear in that of the slope; beyond them it stays.
    """

    slopes: np.ndarray  #: increasing (s,) [-]
    #: At the humidities of the correction: ratio and its error (h, s), and one power (h,). The error is that of what 1
    #: in 1000 tips exceeds.
    change: ElasticChange

    def at(self, slope: float) -> ElasticChange:
        """Change at a slope, at each humidity (h,)."""
        position = np.interp(np.log(slope), np.log(self.slopes), np.arange(len(self.slopes)))
        below = min(int(position), len(self.slopes) - 2)
        weights, near = [below + 1 - position, position - below], np.s_[:, below : below + 2]
        ratio, error = np.exp(np.log(self.change.ratio[near]) @ weights), self.change.ratio_error[near] @ weights
        return ElasticChange(ratio, self.change.power, error)


def _not_falling(ratio, reference, humidity):
    """Ratio of energies in air wetter than where it was computed: one above 1 stays, as that of rough pairs falls."""
    return max(ratio, in_wetter_air(min(ratio, 1.0), reference, humidity))


@dataclass(frozen=True)
class Correction:
    """Changes from the sum over summits to full elastic contact.

    Only the energy e and the largest attractions are corrected: distances of both models are between different mean
    planes, those of the deformed surfaces and those of the undeformed ones, and have no common origin.
    """

    humidities: np.ndarray  #: increasing (h,), 0 for dry air [-]
    energy: ElasticChange  #: of the energies e (h,)
    pull_off: ElasticChange  #: of the largest attractions f_max (h,)
    tips: TipChanges | None = None  #: of the largest attractions of tips, if any are on the pair
    #: Whether changes hold beyond these, where shifts of a budget are, instead of an error. ASSUME: in drier air the
    #: change is that in the driest. In wetter air ratios of energies below 1 rise to 1 in saturated air, others stay,
    #: and those of forces are as `stiction.contact.full.smooth_pairs.in_wetter_air`.
    nearest: bool = False

    def at(self, humidity: float) -> tuple[ElasticChange, ElasticChange]:
        """Changes of e and of f_max at a humidity, 0 for dry air: none in humid air if dry air alone is corrected.

        Raises
        ------
        ValueError
            If the humidity is beyond those at which full contact was computed.
        """
        return self._at(humidity, self.energy), self._at(humidity, self.pull_off, in_wetter_air)

    def of_tips(self, humidity: float, slopes: np.ndarray) -> list[ElasticChange]:
        """Changes of the largest attraction of tips at slopes (n,) [-], none without tips. Otherwise as `at`."""
        if self.tips is None:
            return [NONE] * len(slopes)
        return [self._at(humidity, self.tips.at(slope), in_wetter_air) for slope in slopes]

    def _at(self, humidity, changes, wetter=_not_falling):
        """Change at a humidity."""
        in_humid_air = is_humid(humidity)
        same_air = self.humidities[is_humid(self.humidities) == in_humid_air]
        if in_humid_air and not same_air.size:
            return NONE
        low, high = same_air.min(initial=1.0), same_air.max(initial=0.0)
        is_near = self.nearest and in_humid_air
        if not (is_near or is_at_most(low, humidity) and is_at_most(humidity, high)):
            where = f"at relative humidities from {low:g} to {high:g}" if same_air.size else "in other air alone"
            raise ValueError(
                f"full elastic contact was computed {where} and is not extrapolated to {humidity:g}: add it to the "
                "humidities of the pair, or choose contact.model: summits"
            )
        change = self._between(changes, np.clip(humidity, low, high))  # rounding can leave it a little outside
        if not (is_near and humidity > high):
            return change
        return change._replace(ratio=wetter(change.ratio, high, humidity))

    def _between(self, changes, humidity):
        """Change at a humidity within the computed ones. A power below 1 errs only as far as it may be above."""
        ratio, power, *errors = (np.broadcast_to(each, self.humidities.shape) for each in changes)
        ratio, power = (float(interpolated(each, self.humidities, humidity)) for each in (ratio, power))
        of_ratio, of_power = (float(np.interp(humidity, self.humidities, error)) for error in errors)
        if not power >= 1:
            power, of_power = 1.0, max(0.0, power + of_power - 1)
        return ElasticChange(ratio, power, of_ratio, of_power)

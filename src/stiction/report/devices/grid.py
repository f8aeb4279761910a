"""Grid of computed answers of a device, and the answers between its points.

A page has the grid as JSON, and ``templates/explorer.js`` repeats the formulas of this module. Logarithms of sizes
are interpolated by monotone cubics, axis by axis. Nothing is extrapolated.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr, ndtri

from stiction.devices.chart import error_between
from stiction.devices.risk import SCORES

#: Significant digits of the numbers in a page, and an error too small to show, which has a logarithm.
_DIGITS, _EXACT = 7, 1e-9
#: Normal score of a band of 95 %.
Z95 = float(ndtri(0.975))
#: Coordinate of a value along an axis, by its scale.
_PLACES = {"linear": lambda value: value, "log": np.log, "score": ndtri}


@dataclass(frozen=True)
class Axis:
    """Computed values of one quantity."""

    key: str  #: in states and addresses
    label: str
    unit: str
    scale: str  #: ``linear``, ``log``, or ``score``, the normal score of a probability
    values: tuple[float, ...]  #: increasing
    start: float  #: first value of a page
    between: bool  #: whether values between the computed ones have an answer
    reason: str  #: why it ends or stays where it does
    setting: str = ""  #: key of a device with this quantity

    @property
    def places(self) -> np.ndarray:
        """Coordinates of the computed values."""
        return _PLACES[self.scale](np.array(self.values))

    def place(self, value: float) -> float:
        """Coordinate of a value.

        Raises
        ------
        ValueError
            If the value is outside of the computed ones, or between them where this has no answer.
        """
        inside = self.values[0] <= value <= self.values[-1] if self.between else value in self.values
        if not inside:
            raise ValueError(f"{self.label} {value:g} {self.unit} has no answer: {self.reason}")
        return float(_PLACES[self.scale](value))


@dataclass(frozen=True)
class Stuck:
    """Fraction of stuck devices."""

    share: float  #: [-]; NaN if it is not known
    low: float  #: lower end of the band of 95 % due to the number of devices
    high: float
    beyond: int  #: -1 or 1 if the fraction is below or above ``share``, the last one that the devices show


@dataclass(frozen=True)
class Grid:
    """Safe sizes of a device, and quantiles of the sizes that stick, over its computed states.

    The size is the length of a beam, or the force or stiffness of a stopper.
    """

    axes: tuple[Axis, ...]  #: of the device and its air
    share: Axis  #: fraction p that may stick
    size: Axis  #: its ends bound the control only
    safe: np.ndarray  #: over the axes and the shares, 95 % bounds
    quantiles: np.ndarray  #: over the axes and the scores of `stiction.devices.risk`; NaN if unknown
    samples: int  #: simulated devices of each state
    falls: bool  #: whether fewer stick at a larger size
    counted: Sequence[tuple[Mapping[str, float], float, float, float]] = ()  #: states of tables, fraction and its band

    def safe_size(self, state: Mapping[str, float]) -> float:
        """Safe size for the state's share."""
        return float(
            np.exp(monotone(self.share.places, self._at(self.safe, state, self.axes), self.share.place(state["share"])))
        )

    def stuck(self, state: Mapping[str, float]) -> Stuck:
        """P(stuck) at the state's size: as in the tables if they have this state."""
        for at, *found in self.counted:
            if all(state[key] == value for key, value in at.items()):
                return Stuck(*found, 0)
        levels, scores = self._levels(state)
        if not len(levels):
            return Stuck(np.nan, np.nan, np.nan, 0)
        at, sign = np.log(state[self.size.key]), -1 if self.falls else 1
        beyond = sign * (int(at > levels[-1]) - int(at < levels[0]))
        share = float(ndtr(sign * np.interp(at, levels, scores)))
        return Stuck(share, *band(share, self.samples), beyond)

    @cached_property
    def noise(self) -> np.ndarray:
        """Relative error of safe sizes between computed values of the first axis, over the other axes and shares.

        It is that of the band in the figure of a chart, NaN for too few values.
        """
        values = self.axes[0].values if self.axes[0].between else ()
        errors = np.apply_along_axis(lambda sizes: error_between(np.array(values), sizes), 0, self.safe)
        return np.maximum(errors, _EXACT)

    def noise_at(self, state: Mapping[str, float]) -> float:
        """Relative error of the safe size between computed values of the first axis, at the state's others."""
        found = self._at(self.noise, state, self.axes[1:])
        return float(np.exp(monotone(self.share.places, found, self.share.place(state["share"]))))

    def _levels(self, state):
        """Logarithms of the known quantiles at a state, and their normal scores."""
        levels = self._at(self.quantiles, state, self.axes)
        known = np.isfinite(levels)
        return levels[known], SCORES[known]

    def _at(self, values, state, axes):
        """Logarithms of values over some axes at a state, over their last dimension."""
        found = np.log(values)
        for axis in axes:
            place = axis.place(state[axis.key])
            found = monotone(axis.places, found, place) if axis.between else found[axis.values.index(state[axis.key])]
        return found

    @property
    def start(self) -> dict[str, float]:
        """State at which a page begins."""
        return {axis.key: axis.start for axis in (*self.axes, self.share, self.size)}

    @property
    def json(self) -> dict:
        """Content for a page."""
        numbers = {name: nested_lists(getattr(self, name)) for name in ("safe", "quantiles", "noise")}
        return asdict(self) | numbers | {"scores": SCORES.tolist()}


def band(share: float, samples: int) -> tuple[float, float]:
    """Band of 95 % of a fraction of samples, by Wilson [-].

    >>> [round(end, 3) for end in band(0.5, 100)]
    [0.404, 0.596]
    """
    part = Z95**2 / samples
    half = Z95 * np.sqrt(share * (1 - share) / samples + part / (4 * samples))
    return tuple(float((share + part / 2 + sign * half) / (1 + part)) for sign in (-1, 1))


def monotone(places: Sequence[float], values: np.ndarray, at: float) -> np.ndarray:
    """Monotone cubic through values (n, ...) at increasing places (n,), by Fritsch and Butland, at one place."""
    if len(places) == 1:
        return values[0]
    widths = np.diff(places)
    secants = np.diff(values, axis=0) / widths.reshape(-1, *[1] * (values.ndim - 1))
    k = int(np.clip(np.searchsorted(places, at, "right") - 1, 0, len(widths) - 1))
    slopes = [_slope(j, widths, secants) for j in (k, k + 1)]
    return hermite(widths[k], (at - places[k]) / widths[k], values[k : k + 2], slopes)


def hermite(width: float, part: float, values: Sequence, slopes: Sequence) -> np.ndarray:
    """Cubic with values and slopes at both ends of an interval, at a part of its width, from 0 to 1."""
    t, s = part, 1 - part
    ends = values[0] * (1 + 2 * t) * s**2 + values[1] * t**2 * (3 - 2 * t)
    return ends + width * (slopes[0] * t * s**2 - slopes[1] * t**2 * s)


def _slope(k, widths, secants):
    """Slope of a monotone cubic at its k-th place: a harmonic mean inside, of three points at an end."""
    last = len(widths)
    if last == 1:
        return secants[0]
    if k in (0, last):
        (w0, w1), (d0, d1) = (
            (part[0], part[1]) if k == 0 else (part[last - 1], part[last - 2]) for part in (widths, secants)
        )
        found = ((2 * w0 + w1) * d0 - w0 * d1) / (w0 + w1)
        found = np.where((d0 * d1 < 0) & (abs(found) > abs(3 * d0)), 3 * d0, found)
        return np.where(found * d0 <= 0, 0 * found, found)
    d0, d1 = secants[k - 1], secants[k]
    w0, w1 = widths[k] * 2 + widths[k - 1], widths[k] + 2 * widths[k - 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(d0 * d1 <= 0, 0 * d0 * d1, (w0 + w1) / (w0 / d0 + w1 / d1))


def nested_lists(values: np.ndarray) -> list:
    """Nested lists of numbers with few digits, `None` for NaN."""
    if values.ndim > 1:
        return [nested_lists(part) for part in values]
    return [float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None for value in values]

"""Grid of computed answers of a device, and the answers between its points.

A page has the grid as JSON, and ``templates/explorer.js`` repeats the formulas of this module. Logarithms of sizes
are interpolated by monotone cubics, axis by axis. Nothing is extrapolated.
"""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.special import ndtr, ndtri

from stiction.devices.chart import error_between
from stiction.devices.roughness import SCALES
from stiction.report.devices.levels import SHOWN

#: Significant digits of the numbers in a page, and an error too small to show, which has a logarithm.
_DIGITS, _EXACT = 7, 1e-9
#: Code of an unknown size.
_UNKNOWN_CODE = (1 << 24) - 1
#: Relative difference of sizes that rounding makes.
_SAME = 2e-6
#: Fractions of layers where they have no levels: nothing is known, or no more than that a fraction is from 0 to 1.
_UNKNOWN = np.nan, 0.0, 1.0
#: Coordinate of a value along an axis, by its scale.
_COORDINATES = {name: scale.coordinate for name, scale in SCALES.items()} | {"score": ndtri}


@dataclass(frozen=True)
class GridAxis:
    """Computed values of one quantity."""

    key: str  #: in states and addresses
    label: str
    unit: str
    scale: str  #: of `stiction.devices.roughness.SCALES`, or ``score``, the normal score of a probability
    values: tuple[float, ...]  #: increasing
    start: float  #: first value of a page
    between: bool  #: whether values between the computed ones have an answer
    reason: str  #: why it ends or stays where it does
    setting: str = ""  #: key of a device with this quantity

    @property
    def coordinates(self) -> np.ndarray:
        """Coordinates of the computed values."""
        return _COORDINATES[self.scale](np.array(self.values))

    def coordinate(self, value: float) -> float:
        """Coordinate of a value.

        Raises
        ------
        ValueError
            If the value is outside of the computed ones, or between them where this has no answer.
        """
        inside = self.values[0] <= value <= self.values[-1] if self.between else value in self.values
        if not inside:
            raise ValueError(f"{self.label} {value:g} {self.unit} has no answer: {self.reason}")
        return float(_COORDINATES[self.scale](value))


@dataclass(frozen=True)
class StuckShares:
    """Fraction of stuck devices."""

    share: float  #: [-]; NaN if it is not known
    low: float  #: lower end of its band of 95 %
    high: float
    beyond: int  #: -1 or 1 if only the upper or lower end is known


@dataclass(frozen=True)
class Grid:
    """Sizes to build of a device, and levels of P(stuck), over its computed states.

    The size is the length of a beam, or the force or stiffness of a stopper.
    """

    axes: tuple[GridAxis, ...]  #: of the device and its air
    share: GridAxis  #: fraction p that may stick
    size: GridAxis  #: its ends bound the control only
    safe: np.ndarray  #: over the axes and the shares, 95 % bounds
    levels: np.ndarray  #: layers of `stiction.report.devices.levels`, over the axes and scores; NaN if unknown
    samples: int  #: simulated devices of each state
    falls: bool  #: whether fewer stick at a larger size
    scores: np.ndarray = field(default_factory=lambda: SHOWN)  #: of the levels
    first: np.ndarray | None = None  #: size from which a lower end of P(stuck) is known, over the axes and once

    def safe_size(self, state: Mapping[str, float]) -> float:
        """Safe size for the state's share."""
        return float(
            np.exp(
                monotone(
                    self.share.coordinates, self._at(self.safe, state, self.axes), self.share.coordinate(state["share"])
                )
            )
        )

    def stuck(self, state: Mapping[str, float]) -> StuckShares:
        """P(stuck) at the state's size. Where no simulated device sticks, its upper end alone is known."""
        sign = -1 if self.falls else 1
        v = sign * np.log(state[self.size.key])
        (share, beyond), (low, _), (high, _) = (
            self._fraction(sign * self._at(layer, state, self.axes), v, unknown)
            for layer, unknown in zip(self.levels, _UNKNOWN, strict=True)
        )
        if self.first is None or v >= sign * self._at(self.first, state, self.axes)[0]:
            return StuckShares(share, low, high, beyond)
        return StuckShares(share, 0.0, high, -1)

    def _fraction(self, levels, v, unknown):
        """Fraction of a layer at v, and -1 or 1 below and above all known ones.

        Below a lower end, and above an upper end, it is the one of an unknown layer, not the nearest known one. Where
        few samples leave levels that fall with the score, a lower end is less and everything else more.
        """
        finite = np.isfinite(levels)
        if not finite.any():
            return unknown, 0
        levels, scores = levels[finite], self.scores[finite]
        rising = np.maximum.accumulate(levels), np.minimum.accumulate(levels[::-1])[::-1]
        levels = rising[unknown != 0]
        below, above = v < levels[0] - _SAME, v > levels[-1] + _SAME
        if (unknown == 0 and below) or (unknown == 1 and above):
            return unknown, 0
        return float(ndtr(np.interp(v, levels, scores))), int(above) - int(below)

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
        logarithms = self._at(self.noise, state, self.axes[1:])
        return float(np.exp(monotone(self.share.coordinates, logarithms, self.share.coordinate(state["share"]))))

    def _at(self, values, state, axes):
        """Logarithms of values over some axes at a state, over their last dimension."""
        logarithms = np.log(values)
        for axis in axes:
            coordinate = axis.coordinate(state[axis.key])
            logarithms = (
                monotone(axis.coordinates, logarithms, coordinate)
                if axis.between
                else logarithms[axis.values.index(state[axis.key])]
            )
        return logarithms

    @property
    def start(self) -> dict[str, float]:
        """State at which a page begins."""
        return {axis.key: axis.start for axis in (*self.axes, self.share, self.size)}

    @property
    def json(self) -> dict:
        """Content for a page."""
        names = ["safe", "noise", "scores", *(["first"] if self.first is not None else [])]
        lists = {name: nested_lists(getattr(self, name)) for name in names}
        return asdict(self) | lists | {"levels": packed(self.levels)}


def monotone(coordinates: Sequence[float], values: np.ndarray, at: float) -> np.ndarray:
    """Monotone cubic through values (n, ...) at increasing places (n,) at one place, NaN near an unknown value."""
    if len(coordinates) == 1:
        return values[0]
    k = int(np.clip(np.searchsorted(coordinates, at, "right") - 1, 0, len(coordinates) - 2))
    near = slice(max(k - 1, 0), k + 3)  # all that decides the slopes at both ends of the interval
    cubic = PchipInterpolator(coordinates[near], np.nan_to_num(values[near]))
    return np.where(np.isfinite(values[near]).all(axis=0), cubic(at), np.nan)[()]


def hermite(width: float, fraction: float, values: Sequence, slopes: Sequence) -> np.ndarray:
    """Cubic with values and slopes at both ends of an interval, at a part of its width, from 0 to 1."""
    t, s = fraction, 1 - fraction
    ends = values[0] * (1 + 2 * t) * s**2 + values[1] * t**2 * (3 - 2 * t)
    return ends + width * (slopes[0] * t * s**2 - slopes[1] * t**2 * s)


def packed(sizes: np.ndarray) -> dict:
    """Content of a page for many sizes (...), in half the characters that their digits take.

    Logarithms are in steps from the lowest one, in 24 bits each, big-endian, Base64. The largest number is an unknown
    size. A step is below 1e-6 for sizes over seven decades.
    """
    is_known = np.isfinite(sizes) & (sizes > 0)
    logarithms = np.log(sizes[is_known])
    low, high = (float(logarithms.min()), float(logarithms.max())) if is_known.any() else (0.0, 0.0)
    step = (high - low) / (_UNKNOWN_CODE - 1) or 1.0
    codes = np.full(sizes.shape, _UNKNOWN_CODE, ">u4")
    codes[is_known] = np.rint((logarithms - low) / step)
    content = codes.ravel().view(np.uint8).reshape(-1, 4)[:, 1:].tobytes()
    return {"low": low, "step": step, "shape": list(sizes.shape), "content": base64.b64encode(content).decode()}


def nested_lists(values: np.ndarray) -> list:
    """Nested lists of numbers with few digits, `None` for NaN."""
    if values.ndim > 1:
        return [nested_lists(row) for row in values]
    return [float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None for value in values]

"""One scan of a surface: the map of heights from a microscope.

Convention, used in this folder: the first index of a map runs along the fast axis of the microscope, so that a line of
the scan is ``heights[:, j]``.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stiction.errors import ScanError

#: Fewest points along a side: 8 sectors, 16 tiles and a line of degree 2 need them.
FEWEST_POINTS = 32
#: Relative difference of the sides of a pixel that still is square.
_SQUARE = 1e-3
#: ASSUME: range of the distances of points [µm], from a tenth of an atom to the coarsest optical profilers; of the rms
#: of the heights [µm]; and of their rms slope [-], from mirrors of telescopes to needles. Wrong units give others.
PIXELS, _HEIGHTS, SLOPES = (1e-5, 10.0), (1e-6, 100.0), (1e-6, 10.0)
#: ASSUME: a point is no part of the surface if it is so many rms of the map away from all its neighbours.
_OUT = 10.0


@dataclass(frozen=True)
class Frame:
    """Points and size of a scan."""

    shape: tuple[int, int]  #: points along the fast and the slow axis
    size: tuple[float, float]  #: along both, number of points times their distance [m]

    @property
    def pixel(self) -> tuple[float, float]:
        """Distances of the points [m]."""
        return self.size[0] / self.shape[0], self.size[1] / self.shape[1]

    @property
    def square(self) -> bool:
        """Whether pixels are square."""
        return abs(self.pixel[0] / self.pixel[1] - 1) < _SQUARE

    @property
    def area(self) -> float:
        """Scanned area [m²]."""
        return self.size[0] * self.size[1]


@dataclass(frozen=True, eq=False)
class Scan:
    """Heights on a rectangular grid.

    Masked and infinite heights are undefined, and so are lines along either axis that are constant or equal to an
    earlier one: a microscope leaves them where a scan was stopped.

    Raises
    ------
    ScanError
        If the heights are no map, or if size, heights or slopes are those of no surface.
    """

    heights: np.ndarray  #: fast axis first, NaN where undefined, (n1, n2) [m]
    size: tuple[float, float]  #: along the fast and the slow axis, number of points times their distance [m]
    name: str = "scan"  #: of the file, for messages

    def __post_init__(self):
        heights = np.ma.filled(np.ma.asarray(self.heights, dtype=float), np.nan)
        if heights.ndim != 2 or min(heights.shape) < FEWEST_POINTS:
            shown = " x ".join(map(str, heights.shape)) or "no"
            raise ScanError(self.name, "files", f"has {shown} points, needs {FEWEST_POINTS} along each side of a map")
        size = tuple(np.asarray(self.size, float).ravel())
        if len(size) != 2 or not all(0 < length < np.inf for length in size):
            shown = " x ".join(f"{length:.4g}" for length in size)
            raise ScanError(self.name, "size_um", f"has a size of {shown} m, must be two lengths")
        object.__setattr__(self, "size", tuple(map(float, size)))
        object.__setattr__(self, "heights", _without_repeats(np.where(np.isfinite(heights), heights, np.nan)))
        if not self.defined.any():
            raise ScanError(self.name, "files", "has the same height, or none, at all points of different lines")
        self._require_possible()

    def _require_possible(self):
        """Refuse values impossible for a surface."""
        if np.isnan(self._rms_slope()):
            reason = "has no neighbouring points with heights along one side, because its lines repeat each other"
            raise ScanError(
                self.name, "files", f"{reason}: it is a profile or a pattern, and a map of heights is needed"
            )
        for key, phrase, value, (least, largest) in (
            ("size_um", "a distance of its points of {} µm", 1e6 * min(self.frame.pixel), PIXELS),
            ("size_um", "a distance of its points of {} µm", 1e6 * max(self.frame.pixel), PIXELS),
            ("height_unit", "heights with an rms of {} µm", 1e6 * np.nanstd(self.heights), _HEIGHTS),
            ("height_unit", "an rms slope of {}", self._rms_slope(), SLOPES),
        ):
            if not least <= value <= largest:
                reason = f"has {phrase.format(f'{value:.3g}')}, must be from {least:g} to {largest:g}"
                coarse = key == "size_um" and value > largest
                cause = "it is too coarse for what touches, or its size is" if coarse else "its size or its heights are"
                raise ScanError(self.name, key, f"{reason}: {cause} in another unit than is stated")

    def _rms_slope(self):
        """Rms slope between neighbours, with the tilt of the map [-]. NaN without neighbours."""
        steps = [np.diff(self.heights, axis=axis) / pixel for axis, pixel in enumerate(self.frame.pixel)]
        defined = [step[np.isfinite(step)] for step in steps]
        return float(np.sqrt(sum(np.mean(step**2) if step.size else np.nan for step in defined)))

    @property
    def frame(self) -> Frame:
        """Points and size."""
        return Frame(self.heights.shape, self.size)

    @cached_property
    def defined(self) -> np.ndarray:
        """Points with a height, (n1, n2) bool."""
        return np.isfinite(self.heights)

    @property
    def undefined_share(self) -> float:
        """Share of the points without a height [-]."""
        return 1 - float(self.defined.mean())

    @property
    def stopped(self) -> str:
        """Lines along either axis without a height, in words. Empty if there are none.

        Examples
        --------
        >>> heights = np.random.default_rng(1).normal(0, 1e-9, (32, 40))
        >>> heights[:, 37:] = 0
        >>> Scan(heights, (1e-6, 1e-6)).stopped
        '3 empty, constant or repeated lines, as where a scan was stopped'
        """
        lines = sum(int((~self.defined.any(axis=axis)).sum()) for axis in (0, 1))
        counted = f"{lines} empty, constant or repeated line{'s' * (lines > 1)}"
        return f"{counted}, as where a scan was stopped" if lines else ""

    @property
    def standing_out(self) -> str:
        """Single points far from all their neighbours, in words. Empty if there are none.

        Examples
        --------
        >>> heights = np.random.default_rng(1).normal(0, 1e-9, (32, 40))
        >>> heights[7, 7] = 1e-7
        >>> Scan(heights, (1e-6, 1e-6)).standing_out
        '1 point stands out of all its neighbours by up to 99.4 nm'
        """
        centre = self.heights[1:-1, 1:-1]
        beside = np.array([np.roll(self.heights, by, axis)[1:-1, 1:-1] for axis in (0, 1) for by in (-1, 1)])
        away = np.maximum(centre - np.fmax.reduce(beside), np.fmin.reduce(beside) - centre)
        count = int(np.sum(away > _OUT * np.nanstd(self.heights)))
        if not count:
            return ""
        stand = "point stands out of all its" if count == 1 else "points stand out of all their"
        return f"{count} {stand} neighbours by up to {1e9 * np.nanmax(away):.3g} nm"


def stored_once(heights: np.ndarray) -> tuple[np.ndarray, tuple[int, int]]:
    """Map without copies of its lines (n1, n2), and how often it had each line along both axes.

    Programs enlarge a map by repeating its points. Heights may be masked.

    Examples
    --------
    >>> map_, times = stored_once(np.kron(np.random.default_rng(1).normal(size=(32, 40)), np.ones((2, 3))))
    >>> map_.shape, times
    ((32, 40), (2, 3))
    """
    times = tuple(_copies(rows) for rows in (heights, heights.T))
    return heights[:: times[0], :: times[1]], times


def _copies(rows):
    """How often each of some rows (n, points) stands there, 1 if not all stand equally often or too few differ."""
    rows = np.ma.filled(np.ma.asarray(rows, dtype=float), np.nan)
    begins = np.flatnonzero([True, *(a.tobytes() != b.tobytes() for a, b in zip(rows, rows[1:], strict=False))])
    length = np.diff([*begins, len(rows)])
    return int(length[0]) if len(begins) >= FEWEST_POINTS and np.all(length == length[0]) else 1


def _without_repeats(heights):
    """Heights with lines along both axes undefined if they are constant or equal to an earlier line [m]."""
    across, along = _repeated(heights), _repeated(heights.T)
    return np.where(across[:, None] | along, np.nan, heights)


def _repeated(rows):
    """Mark rows (n, points) if they are constant or equal to an earlier one, (n,) bool."""
    first = {}
    earlier = [first.setdefault(row.tobytes(), number) != number for number, row in enumerate(rows)]
    return np.array(earlier) | (np.fmax.reduce(rows, axis=1) == np.fmin.reduce(rows, axis=1))

"""One scan of a surface: the map of heights that a microscope measured.

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


@dataclass(frozen=True)
class Scan:
    """Heights on a rectangular grid."""

    heights: np.ndarray  #: fast axis first, NaN where undefined, (n1, n2) [m]
    size: tuple[float, float]  #: along the fast and the slow axis, number of points times their distance [m]
    name: str = "scan"  #: of the file, for messages

    def __post_init__(self):
        if min(self.heights.shape) < FEWEST_POINTS:
            shown = " x ".join(map(str, self.heights.shape))
            raise ScanError(self.name, "files", f"has {shown} points, needs {FEWEST_POINTS} along each side")
        if not all(0 < length < np.inf for length in self.size):
            raise ScanError(self.name, "size_um", f"has a size of {self.size[0]:.4g} x {self.size[1]:.4g} m")
        if not np.nanmax(self.heights, initial=-np.inf) > np.nanmin(self.heights, initial=np.inf):
            raise ScanError(self.name, "files", "has the same height, or none, at all points")

    @property
    def frame(self) -> Frame:
        """Points and size."""
        return Frame(self.heights.shape, self.size)

    @cached_property
    def defined(self) -> np.ndarray:
        """Points that have a height, (n1, n2) bool."""
        return np.isfinite(self.heights)

    @property
    def undefined_share(self) -> float:
        """Share of the points without a height [-]."""
        return 1 - float(self.defined.mean())

"""Axes in a map: lines of coordinates or numbers of points, as spreadsheets and profilers write before the heights."""

from collections.abc import Sequence

import numpy as np

#: Most lines of an axis on one side: the numbers of the points and their coordinates.
MOST_AXES = 2
#: ASSUME: farthest that rounded coordinates lie from even distances, in steps, and how much closer to them an axis is
#: than the lines of heights. On a rough surface no line has even steps; on a tilted smooth one, all have.
_ROUNDED, _CLOSER = 0.5, 0.1


def without_axes(heights: np.ndarray) -> tuple[np.ndarray, str]:
    """Map without leading lines of coordinates along both axes, and what was left out, in words.

    Parameters
    ----------
    heights : array, (n_x, n_y)

    Examples
    --------
    >>> z = np.random.default_rng(1).standard_normal((40, 50))
    >>> z[0] = 0.1 * np.arange(50)
    >>> found, words = without_axes(z)
    >>> found.shape, words
    ((39, 50), 'its first column counts evenly and was taken as an axis')
    """
    columns, rows = _axes(heights), _axes(heights.T)
    counted = [
        f"{'first' if number == 1 else 'first two'} {lines}{'s' * (number > 1)}"
        for lines, number in (("row", rows), ("column", columns))
        if number
    ]
    if not counted:
        return heights, ""
    several = len(counted) > 1 or max(rows, columns) > 1
    verbs = "count evenly and were taken as axes" if several else "counts evenly and was taken as an axis"
    return heights[columns:, rows:], f"its {' and '.join(counted)} {verbs}"


def unevenness(lines: np.ndarray) -> np.ndarray:
    """Largest distance of the values of every line (n, points) from even steps, in steps; infinite without any."""
    number = np.arange(lines.shape[1])
    step = (lines[:, -1] - lines[:, 0]) / number[-1]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        away = np.abs(lines - lines[:, :1] - step[:, None] * number).max(axis=1) / np.abs(step)
    return np.where(np.isfinite(away), away, np.inf)


def is_even(values: Sequence[float]) -> bool:
    """Whether at least three values have even steps, up to rounding."""
    return len(values) > MOST_AXES and bool(unevenness(np.array([values], float))[0] <= _ROUNDED)


def _axes(lines):
    """Number of leading lines that are axes. Corners are in none of them."""
    if min(lines.shape) <= 2 * MOST_AXES:
        return 0
    away = unevenness(lines[:, MOST_AXES:])
    even = away <= min(_ROUNDED, _CLOSER * float(np.median(away)))
    leading = int(np.argmin(even)) if not even.all() else len(even)
    return leading if leading <= MOST_AXES else 0

"""Numbers that stand in a map where no height is defined, as -9999 does."""

import numpy as np

#: Whole numbers that programs write so: nines, and the ends of integers. Beside them, all that no unit can mean.
MARKS = [sign * number for number in (9999, 99999, 999999, 32767, 2147483647) for sign in (-1, 1)]
MARKS += [-32768, 65535, -2147483648, -9999.99, 9999.99, -999.25, -999.99]
_IMPOSSIBLE = 1e20
#: Relative rounding of numbers of 32 bits, as which many programs save -999.99.
_ROUNDING = 1e-7
#: ASSUME: from how many equal values, more than of any other one, a mark among the heights is doubtful.
_OFTEN = 3
#: ASSUME: no surface has one point that stands out by so many times the range of all others.
_ALONE = 1000
#: Fewest different heights with a range of all but one.
_FEWEST = 4


def without_marks(heights: np.ndarray) -> tuple[np.ndarray, str]:
    """Map with no height where a known mark stands, and what was left out, in words.

    A mark lies farther from all heights than these from each other.

    Parameters
    ----------
    heights : array, (n_x, n_y)
        Numbers as they stand in the file, NaN where undefined.

    Raises
    ------
    ValueError
        In words, if values may be a mark or heights.

    Examples
    --------
    >>> z = np.random.default_rng(1).standard_normal((40, 50))
    >>> z[7, 8:10] = -9999
    >>> found, words = without_marks(z)
    >>> np.argwhere(np.isnan(found)).tolist(), words
    ([[7, 8], [7, 9]], '2 points have -9999, the mark of no data, and count as undefined')
    """
    values, counts = np.unique(heights[np.isfinite(heights)], return_counts=True)
    is_mark = (np.abs(values) > _IMPOSSIBLE) | np.isclose(values[:, None], MARKS, rtol=_ROUNDING, atol=0).any(axis=1)
    if not is_mark.any() or is_mark.all():
        return heights, ""
    unmarked, most = values[~is_mark], int(counts[~is_mark].max())
    away = np.maximum(values - unmarked[-1], unmarked[0] - values)
    marks = is_mark & (away > unmarked[-1] - unmarked[0])
    doubtful = is_mark & ~marks & (counts >= max(_OFTEN, most + 1))
    if doubtful.any():
        raise ValueError(_doubt(values[doubtful][0], counts[doubtful][0]))
    if not marks.any():
        return heights, ""
    number, shown = int(counts[marks].sum()), ", ".join(f"{value:.6g}" for value in values[marks])
    subject = f"{number} points have {shown}, the mark" if number > 1 else f"1 point has {shown}, the mark"
    verb = "count" if number > 1 else "counts"
    return np.where(np.isin(heights, values[marks]), np.nan, heights), f"{subject} of no data, and {verb} as undefined"


def require_no_mark(heights: np.ndarray) -> None:
    """Refuse a map with an extreme value farther from all others than these lie apart.

    It stands at several points, or alone so far away that no surface has it.

    Raises
    ------
    ValueError
        In words.
    """
    values, counts = np.unique(heights[np.isfinite(heights)], return_counts=True)
    if len(values) < _FEWEST:
        return
    for value, count, others in zip(values[[0, -1]], counts[[0, -1]], (values[1:], values[:-1]), strict=True):
        if np.abs(others - value).min() > np.ptp(others) * (1 if count > 1 else _ALONE):
            raise ValueError(_doubt(value, count))


def _doubt(value, count):
    """Question about a value in words."""
    where = f"{count} points" if count > 1 else "1 point"
    reason = f"has {value:.6g} at {where}, which may be a mark of no data or the end of a detector"
    return f"{reason}: write nan where no height is known"

"""Comparison of numbers up to rounding."""

import numpy as np

#: Relative error that a number has if it was computed in other units or in another order.
_ROUNDING = 1e-9


def is_multiple(whole: float, part: float) -> bool:
    """Whether ``whole`` is 1, 2, 3, ... times ``part``, up to rounding.

    Examples
    --------
    >>> is_multiple(0.3, 0.1), is_multiple(0.3, 0.2), is_multiple(0.1, 0.3)
    (True, False, False)
    """
    return bool(np.isclose(whole / part, max(1, round(whole / part)), rtol=_ROUNDING))


def is_at_most(value: float, limit: float) -> bool:
    """Whether ``value`` is at most ``limit``, up to rounding: a limit in other units is another floating-point number.

    Examples
    --------
    >>> is_at_most(0.1 + 0.2, 0.3), is_at_most(0.2, 0.3), is_at_most(0.3001, 0.3)
    (True, True, False)
    """
    return bool(value - limit <= _ROUNDING * abs(limit))


def is_equal(value: float, other: float, scale: float) -> bool:
    """Whether two of several numbers are equal, up to rounding of the largest one, ``scale`` in absolute value.

    Examples
    --------
    >>> is_equal(0.1 + 0.2, 0.3, 0.3), is_equal(1e-17, 0.0, 0.3), is_equal(0.1, 0.2, 0.3)
    (True, True, False)
    """
    return bool(abs(value - other) <= _ROUNDING * scale)

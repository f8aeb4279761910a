"""Comparison of numbers up to rounding, and numbers rounded for sentences."""

import numpy as np

#: Relative error that a number has if it was computed in other units or in another order.
_ROUNDING = 1e-9
#: Number from which on the digits of a rounded one are in groups of three.
_GROUPED = 9999.5


def is_multiple(multiple: float, unit: float) -> bool:
    """Whether ``multiple`` is 1, 2, 3, ... times ``unit``, up to rounding.

    Examples
    --------
    >>> is_multiple(0.3, 0.1), is_multiple(0.3, 0.2), is_multiple(0.1, 0.3)
    (True, False, False)
    """
    return bool(np.isclose(multiple / unit, max(1, round(multiple / unit)), rtol=_ROUNDING))


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


def in_percent(share: float) -> str:
    """Share in percent for sentences: two digits, and all digits of the whole part from 99.5 on.

    Examples
    --------
    >>> in_percent(0.02449), in_percent(0.997), in_percent(3.472)
    ('2.4 %', '100 %', '347 %')
    """
    value = 100 * float(share)
    return f"{value:.2g} %" if abs(value) < 99.5 else f"{value:.0f} %"


def grouped(number: float) -> str:
    """Whole number for sentences, from 10 000 on in groups of three digits.

    Examples
    --------
    >>> grouped(9999.4), grouped(9999.5), grouped(1e6)
    ('9999', '10 000', '1 000 000')
    """
    return f"{number:,.0f}".replace(",", " ") if number >= _GROUPED else f"{number:.0f}"

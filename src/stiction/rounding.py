"""Comparison of numbers up to rounding, and numbers rounded for sentences. Plain Python."""

import math
from collections.abc import Callable
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

#: Relative error that a number has if it was computed in other units or in another order.
_ROUNDING = 1e-9
#: Error of a ratio that counts as rounding.
_OF_RATIO = 1e-8
#: Number from which on the digits of a rounded one are in groups of three.
_GROUPED = 9999.5
#: Text of a missing number.
MISSING = "–"
#: Nine digits of a number do not show in which units or order it was computed.
_COMPUTED = Context(prec=9)


def is_multiple(multiple: float, unit: float) -> bool:
    """Whether ``multiple`` is 1, 2, 3, ... times ``unit``, up to rounding.

    Examples
    --------
    >>> is_multiple(0.3, 0.1), is_multiple(0.3, 0.2), is_multiple(0.1, 0.3)
    (True, False, False)
    """
    ratio = multiple / unit
    return math.isclose(ratio, max(1, round(ratio)), rel_tol=_ROUNDING, abs_tol=_OF_RATIO)


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


def number(value: float, form: str) -> str:
    """Text of a number in a format such as ``+.1f``, with – for NaN and zero without a minus sign.

    Examples
    --------
    >>> number(-0.04, "+.1f"), number(-1.25, ".3g"), number(float("nan"), "g")
    ('+0.0', '-1.25', '–')
    """
    if math.isnan(value):
        return MISSING
    text = format(value, form)
    return text if float(text) else format(0.0, form)


def bounding(value: float, digits: int, up: bool) -> str:
    """Text of a bound with some significant digits, never below it if ``up``, else never above.

    Examples
    --------
    >>> bounding(0.0994, 2, up=True), bounding(200.66, 3, up=False), bounding(1234.5, 3, up=True)
    ('0.1', '200', '1240')
    >>> bounding(250 * (1 + 1e-15), 3, up=True), bounding(float("nan"), 3, up=True)
    ('250', '–')
    """
    if not math.isfinite(value) or not value:
        return number(value, "g")
    return f"{rounded(value, digits, up):f}"


def rounded(bound: float, digits: int, up: bool) -> Decimal:
    """Bound with some significant digits, never below it if ``up``, else never above."""
    return Context(prec=digits, rounding=ROUND_CEILING if up else ROUND_FLOOR).plus(_as_computed(bound)).normalize()


def _as_computed(number):
    """Number without the digits that depend on how it was computed."""
    return _COMPUTED.create_decimal(Decimal(float(number)))


def lower_to(decimals: int) -> Callable[[float], str]:
    """Text of a lower bound with some decimals, never above it.

    Examples
    --------
    >>> lower_to(1)(219.39), lower_to(1)(219.4), lower_to(1)(float("nan"))
    ('219.3', '219.4', '–')
    """
    step = Decimal(1).scaleb(-decimals)

    def text(value):
        """Text of one bound."""
        if not math.isfinite(value):
            return number(value, "g")
        return str(_as_computed(value).quantize(step, ROUND_FLOOR))

    return text

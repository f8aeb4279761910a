"""Numbers as people and programs write them: with points or commas, and with separators of thousands."""

import re
from collections.abc import Sequence

from stiction.errors import ScanError
from stiction.formats.no_data import MARKS

#: Words of the library for files for an undefined height, in lower case.
UNDEFINED = frozenset({"nan", "bad", "inf", "-inf", "+inf", "infinite", "infinity"})
#: Decimal sign and separator of thousands. A later one is taken only if it fits more of the values.
_STYLES = ((".", ""), (",", ""), (".", ","), (",", "."), (".", "'"), (",", "'"), (".", "\xa0"), (",", "\xa0"))
#: Pairs of which one reads as decimals what the other one reads as thousands: 1,234 and 1.234.
_RIVALS = {(",", ""): (".", ","), (".", ""): (",", ".")}
#: Marks of no data, which programs write without separators.
_MARKS = frozenset(map(str, MARKS))
_EXPONENT = r"(?:[eE][+-]?\d+)?"
_LONGEST = 20
#: Fewest different whole numbers that show that others have separators of thousands. A mark of no data is one.
_FEWEST = 3


def _pattern(style):
    """Pattern of the numbers of a style."""
    decimal, thousands = map(re.escape, style)
    digits = rf"(?:\d{{1,3}}|[1-9]\d{{0,2}}(?:{thousands}\d{{3}})+)" if thousands else r"\d+"
    fraction = rf"(?:{decimal}\d+)" if decimal == "," else rf"(?:{decimal}\d*)"
    return re.compile(rf"[+-]?(?:{digits}{fraction}?|{decimal}\d+){_EXPONENT}")


_PATTERNS = {style: _pattern(style) for style in _STYLES}
_ANY = re.compile("|".join(f"(?:{pattern.pattern})" for pattern in _PATTERNS.values()))


def is_number(value: str) -> bool:
    """Whether a value is a number of any style, or a word for an undefined height."""
    return bool(_ANY.fullmatch(value)) or value.lower() in UNDEFINED


def is_plain(value: str) -> bool:
    """Whether a value is a number without separators of thousands, or can be one."""
    return any(_PATTERNS[style].fullmatch(value) for style in _STYLES[:2])


def style_of(values: Sequence[str], label: str, *, comma_expected: bool = False) -> tuple[str, str]:
    """Decimal sign and separator of thousands of all numbers of a table.

    Parameters
    ----------
    values : sequence of str
        Values of the table; those that are no numbers are left out.
    label : str
        Name of the file, for messages.
    comma_expected : bool
        Whether the table is of a program that writes decimal commas, so that 1.234 is not surely a decimal.

    Raises
    ------
    ScanError
        If the numbers can be read in two ways.

    Examples
    --------
    >>> style_of(["0,309", "1,234"], ""), style_of(["309", "27", "5", "1,234"], ""), style_of(["1.234", "2.5"], "")
    ((',', ''), ('.', ','), ('.', ''))
    """
    numbers, style = _numbers_and_style([value for value in values if value not in _MARKS])
    rival = _RIVALS.get(style)
    signed = [value for value in numbers if style[0] in value]
    if not signed or rival is None or not _fits(rival, filter(_PATTERNS[style].fullmatch, numbers)):
        return style
    # Decimals of which all have three places, and none is below 1, are thousands if others have no places at all.
    integers = {value for value in numbers if value.strip("+-").isdigit() and value.strip("+-0")}
    if len(integers) >= _FEWEST:
        return rival
    if not integers and style[0] == "." and not comma_expected:
        return style
    shown = signed[0][:_LONGEST]
    plain = shown.replace(style[0], "")
    raise ScanError(
        label,
        "files",
        f"has only numbers like {shown}, which may be {shown.replace(style[0], '.')} or {plain}: write them with four "
        "decimals, or without a separator of thousands",
    )


def _numbers_and_style(values):
    """Numbers among values, and the style of all, or of most, of them."""
    style = next((style for style in _STYLES if _fits(style, values)), None)
    if style is not None:
        return values, style
    numbers = list(filter(_ANY.fullmatch, values))
    return numbers, max(_STYLES, key=lambda style: sum(map(bool, map(_PATTERNS[style].fullmatch, numbers))))


def _fits(style, values):
    """Whether all values are numbers of a style."""
    return all(map(_PATTERNS[style].fullmatch, values))


def in_points(value: str, style: tuple[str, str]) -> str:
    """Number of a style with a decimal point and without a separator of thousands. Other values are unchanged."""
    if style == _STYLES[0] or not _PATTERNS[style].fullmatch(value):
        return value
    decimal, thousands = style
    return (value.replace(thousands, "") if thousands else value).replace(decimal, ".")

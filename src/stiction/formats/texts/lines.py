"""Lines without numbers in a text file of heights.

The library for files leaves out every line in which it does not understand a value, as it does with headings. The map
then has fewer lines over the same size.
"""

import re
from collections import Counter

from stiction.formats.texts.numbers import UNDEFINED

_ENDS, _BETWEEN = re.compile(r"\r\n?|\n"), re.compile(r"[\s;,]+")
#: Number of values up to which a line lists the coordinates of a point. The names of columns are such a line, too.
COORDINATES = 3


def misread(text: str, *, commas: bool = False) -> tuple[int, str] | None:
    r"""First line of data with a value other than a number, and its first such value, or ``None`` without any.

    Data are all lines between the first and the last line of numbers, and others with as many values. Empty lines and
    comments, which begin with #, are no data.

    Parameters
    ----------
    text : str
        Content of a file.
    commas : bool
        Whether commas and semicolons separate values, as white space does.

    Examples
    --------
    >>> misread("# Width: 2 µm\nWidth: 2 µm\n1 2 3 4\n5 6 nan 8\n")
    >>> misread("1 2 3 4\n5 6 *** 8\n9 10 11 12"), misread("1 2 3 4\n5 6 7 ---")
    ((2, '***'), (2, '---'))
    """
    rows = list(_rows(text, commas))
    counts = Counter(len(values) for _, values, wrong in rows if wrong is None)
    if not counts:
        return None
    usual = counts.most_common(1)[0][0]
    numbers = [line for line, values, wrong in rows if wrong is None and len(values) == usual]
    for line, values, wrong in rows:
        beside = len(values) == usual and (usual > COORDINATES or not all(map(_is_no_number, values)))
        if wrong is not None and (beside or numbers[0] < line < numbers[-1]):
            return line, wrong
    return None


def uneven(text: str, *, commas: bool = False) -> tuple[int, int, int] | None:
    r"""First line of a table of numbers with more or fewer values than most, its number of values, and the usual one.

    ``None`` without any. Lines before the first one with the usual number are a head. Parameters are those of
    `misread`.

    Examples
    --------
    >>> uneven("64\n1 2 3\n4 5 6\n"), uneven("1 2 3\n4 5\n6 7 8\n")
    (None, (2, 2, 3))
    """
    counts = [(line, len(values)) for line, values, wrong in _rows(text, commas) if wrong is None]
    if not counts:
        return None
    usual = Counter(number for _, number in counts).most_common(1)[0][0]
    first = next(line for line, number in counts if number == usual)
    return next(((line, number, usual) for line, number in counts if number != usual and line > first), None)


def _rows(text, commas):
    """Number, values and first non-number of every line, without empty lines and comments."""
    for line, content in enumerate(_ENDS.split(text.removeprefix("\ufeff")), 1):
        values = [value for value in _BETWEEN.split(content) if value] if commas else content.split()
        if values and not values[0].startswith("#"):
            yield line, values, next(filter(_is_no_number, values), None)


def _is_no_number(value):
    """Whether a value is neither a number nor a word for an undefined height."""
    try:
        float(value)
    except ValueError:
        return value.lower() not in UNDEFINED
    return False

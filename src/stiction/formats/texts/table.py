"""Tables of numbers in texts of any separator and decimal sign, as the library for files reads them."""

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from stiction.errors import ScanError
from stiction.formats.axes import MOST_AXES, is_even
from stiction.formats.texts.lines import COORDINATES
from stiction.formats.texts.numbers import in_points, is_number, is_plain, style_of

#: Separators of tables, ``None`` for white space. Of those with the most numbers in the most lines, the first is taken.
_SEPARATORS = ("\t", None, ";", ",")
#: ASSUME: separators of programs that may write decimal commas, and thus 1.234 for 1234. Others write decimal points.
_COMMA_EXPECTED = (";", "\t")
#: Lines from which the form of a table is found, and fewest numbers of a line of a table.
_LINES, _FEWEST = 100, 3
#: Fewest columns of which every second one can be told from the others by its digits.
_PAIRS = 16
#: Comma between digits, and separators at the end of a line.
_DECIMAL, _TRAILING = re.compile(r"(?<=\d),(?=\d)"), " \t;,"
_QUOTED, _INVISIBLE = re.compile(r'"[^"]*"'), re.compile("[\xa0\"']")
#: Line of a head that states the number that stands where no height is defined.
_NO_DATA = re.compile(r"^[#\s]*no_?data(?:[_ ]?value)?\s*[:=]?\s*(\S+?)[\s;,]*$", re.IGNORECASE | re.MULTILINE)


@dataclass(frozen=True)
class _Form:
    """Form of a table."""

    separator: str | None  #: ``None`` for white space
    columns: int
    ended: bool  #: whether a separator ends its lines

    def values(self, line: str) -> list[str]:
        """Values of a line, without blanks and quotes. Undefined ones are empty."""
        values = _split(line, self.separator)
        return values[:-1] if self.ended and values and not values[-1] else values


def plain(text: str, label: str = "text", fewest: int = _FEWEST) -> str:
    r"""Text with white space between the numbers of a table, and points in their decimals.

    A table has at least ``fewest`` numbers in most of its lines. Other texts are returned unchanged.

    Parameters
    ----------
    text : str
    label : str, optional
        Name of the file, for messages.
    fewest : int, optional
        Fewest numbers of a line of a table.

    Raises
    ------
    ScanError
        If the numbers of a table can be read in two ways.

    Examples
    --------
    >>> plain("Width: 2,5 µm;\n1,5;2;3\n;3,5;4\n"), plain('"1.5","2","3"\n'), plain("1.5 2\nnan 4\n")
    ('Width: 2.5 µm\n1.5 2 3\nnan 3.5 4\n', '1.5 2 3\n', '1.5 2\nnan 4\n')
    """
    lines = text.split("\n")
    filled = [line for line in lines if line.strip() and not line.startswith("#")]
    form = _form(filled[len(filled) // 2 :][:_LINES])
    if form.columns < fewest:
        return text
    rows = [None if line.startswith("#") else form.values(line) for line in lines]
    stated = _NO_DATA.findall(text)
    style = _style(rows, form, label, stated)
    marks = {_float(in_points(mark, style)) for mark in stated}
    written = rows if style == (".", "") else [row and [in_points(value, style) for value in row] for row in rows]
    cornered = _with_corner(_without_index(written, form.columns), form.columns)
    usual = form.separator is None and style == (".", "") and not marks and not _INVISIBLE.search(text)
    return text if usual and cornered is written else "\n".join(_lines(cornered, lines, form, style, marks))


def _split(line, separator):
    """Values of a line, without blanks and quotes around them."""
    if separator is None:
        if not _INVISIBLE.search(line):
            return line.split()
        parts = line.strip(" \t\xa0").replace("\t", " ").split(" ")
        return [word.strip("\"'\xa0") for word in parts if word]
    if not _INVISIBLE.search(line) and " " not in line:
        return line.split(separator)
    outside = _QUOTED.sub(lambda quoted: quoted[0].replace(separator, "\0"), line) if '"' in line else line
    parts = [value.replace("\0", separator).strip(" \t\"'\xa0") for value in outside.strip(" ").split(separator)]
    return [value.replace(" ", "\xa0") if separator != "," else value for value in parts]


def _form(lines: Sequence[str]) -> _Form:
    """Form of a table, from some of its lines."""
    forms = [(_columns([_split(line, separator) for line in lines]), separator) for separator in _SEPARATORS]
    (columns, _, ended), separator = max(forms, key=lambda form: form[0][:2])
    return _Form(separator, columns, ended)


def _columns(rows) -> tuple[int, int, bool]:
    """Usual number of values of a line, how many lines have it, and whether an empty one ends all of them.

    All are 0 if fewer than half of the lines have this number, all of them numbers.
    """
    filled = [row for row in rows if any(row)]
    ended = bool(filled) and all(not row[-1] for row in filled)
    values = [row[:-1] if ended else row for row in filled]
    counts = Counter(len(row) for row in values if all(is_number(value or "nan") for value in row))
    usual, often = next(iter(counts.most_common(1)), (0, 0))
    return (usual, often, ended) if 2 * often > len(rows) else (0, 0, False)


def _style(rows, form, label, marks):
    """Decimal sign and separator of thousands of the numbers of a table. Axes may have others."""
    table = [row for row in rows if _in_table(row, form)]
    border = MOST_AXES if form.columns > COORDINATES + MOST_AXES else 0
    _require_no_pairs(table[border:], form, label)
    inside = [value for row in table[border:] for value in row[border:]]
    axes = [value for row in table[:border] for value in row] + [value for row in table for value in row[:border]]
    values = inside + [value for value in axes if not is_plain(value)]
    numbers = [value for value in values if value not in marks] if marks else values
    return style_of(numbers, label, comma_expected=form.separator in _COMMA_EXPECTED)


def _require_no_pairs(rows, form, label):
    """Refuse a table whose commas both separate and are decimal signs. Every second number then has as many digits."""
    if form.separator != ",":
        return
    columns = list(zip(*(row for row in rows if len(row) == form.columns), strict=True))[MOST_AXES:]
    shapes = [{_shape(value) for column in columns[k::2] for value in column if value} for k in (0, 1)]
    alone = len(columns) >= _PAIRS and 1 in map(len, shapes)
    padded = any(value.isdigit() and value[0] == "0" and value != "0" for column in columns for value in column)
    if alone and (padded or shapes[0] != shapes[1]) and None not in set.union(*shapes):
        raise ScanError(
            label, "files", "has commas both between and within its numbers: write decimals with a point, or tabulators"
        )


def _shape(value):
    """Number of digits of a whole number, negative if it has a sign. ``None`` for other values."""
    return None if not value.strip("+-").isdigit() else len(value) if value.isdigit() else -len(value)


def _in_table(row, form):
    """Whether the values of a line are of the table, also if some of them are no numbers."""
    return bool(row) and any(row) and (len(row) == form.columns or all(is_number(value or "nan") for value in row))


def _without_index(rows, columns):
    """Lines of points without a column that counts the points."""
    if columns != COORDINATES + 1:
        return rows
    table = [row for row in rows if row and len(row) == columns and all(is_number(value or "nan") for value in row)]
    if not is_even([_float(row[0]) for row in table]):
        return rows
    return [row[1:] if row and len(row) == columns else row for row in rows]


def _with_corner(rows, columns):
    """Lines with an undefined corner in the first one, if this is an axis with a word there, or with nothing."""
    for k, row in enumerate(rows):
        *word, first = [row[:1], row[1:]] if row and len(row) == columns else [row or []]
        if len(first) == columns - 1 and is_even(list(map(_float, first))):
            is_corner = word and (not word[0][0] or is_number(word[0][0]))
            return rows if is_corner else [*rows[:k], ["", *first], *rows[k + 1 :]]
        if row and all(map(is_number, row)):
            break
    return rows


def _float(value):
    """Value of a table as a number, NaN if it is none."""
    try:
        return float(value)
    except ValueError:
        return math.nan


def _lines(rows, lines, form, style, marks):
    """Lines of a text with white space and points."""
    for row, line in zip(rows, lines, strict=True):
        if row is None or not _in_table(row, form):
            line = line.rstrip(_TRAILING)
            yield _DECIMAL.sub(".", line) if style[0] == "," else line
        else:
            yield " ".join(_value(value, marks) for value in row)


def _value(value, marks):
    """Value of a table as the library reads it."""
    if not value or (marks and _float(value) in marks):
        return "nan"
    parts = value.split()
    # Python reads 1_2 as 12, but not 1__2.
    return value if len(parts) == 1 else ("_" if math.isnan(_float("_".join(parts))) else "__").join(parts)

"""Tables of numbers in text files of any encoding, separator and decimal sign, as the library for files reads them."""

import codecs
import contextlib
import re
from collections import Counter
from collections.abc import Sequence

#: Marks of encodings at the beginning of a text.
_MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
#: Encodings of texts without a mark with the signs that show that another is right, or that a file is no text.
_CONTROL = "\\x00-\\x08\\x0e-\\x19\\x1b-\\x1f"
_ENCODINGS = {"utf-8": _CONTROL, "utf-16-le": f"{_CONTROL}\\u0400-\\uffff", "utf-16-be": f"{_CONTROL}\\u0400-\\uffff"}
_ENCODINGS |= {"latin-1": _CONTROL}
#: Separators and decimal signs of tables; of those that give the most numbers, the first is taken.
_FORMS = ((None, "."), (";", "."), (",", "."), ("\t", "."), (";", ","), ("\t", ","), (None, ","))
#: Lines from which the form of a table is found, and fewest numbers of a line of a table.
_LINES, _FEWEST = 400, 3
#: Comma between digits, and separators at the end of a line.
_DECIMAL, _TRAILING = re.compile(r"(?<=\d),(?=\d)"), " \t;,"


def decoded(content: bytes) -> str | None:
    r"""Text of a file, with the line ends of Python, or ``None`` if it is no text.

    Examples
    --------
    >>> decoded("1 µm\r\n".encode("latin-1")), decoded("1 µm".encode("utf-16-le")), decoded(bytes(9))
    ('1 µm\n', '1 µm', None)
    """
    marked = {encoding: _CONTROL for mark, encoding in _MARKS.items() if content.startswith(mark)}
    for encoding, wrong in (marked or _ENCODINGS).items():
        with contextlib.suppress(UnicodeDecodeError):
            text = content.decode(encoding)
            if not re.search(f"[{wrong}]", text):
                return re.sub(r"\r\n?", "\n", text)
    return None


def plain(text: str) -> str:
    r"""Text with white space between the numbers of a table, and points in their decimals.

    A table has at least three numbers in most of its lines. Other texts are returned unchanged.

    Examples
    --------
    >>> plain("Width: 2,5 µm;\n1,5;2;3\n;3,5;4\n"), plain('"1.5","2","3"\n'), plain("1.5 2\nnan 4\n")
    ('Width: 2.5 µm\n1.5 2 3\nnan 3.5 4\n', '1.5 2 3\n', '1.5 2\nnan 4\n')
    """
    lines = text.split("\n")
    filled = [line for line in lines if line.strip() and not line.startswith("#")]
    sample = filled[len(filled) // 2 :][:_LINES]
    columns, (separator, decimal) = max(
        ((_columns(sample, *form), form) for form in _FORMS), key=lambda found: found[0]
    )
    if columns < _FEWEST or (separator, decimal) == (None, "."):
        return text
    return "\n".join(_plain(line, columns, separator, decimal) for line in lines)


def _columns(lines: Sequence[str], separator: str | None, decimal: str) -> int:
    """Usual number of values of a line, or 0 if fewer than half of the lines have this number, all of them numbers."""
    values = [_values(line, separator, decimal) for line in lines]
    counts = Counter(len(row) for row in values if row and all(map(_is_number, row)))
    usual, often = next(iter(counts.most_common(1)), (0, 0))
    return usual if 2 * often > len(lines) else 0


def _plain(line, columns, separator, decimal):
    """Line with white space and points. It belongs to the table also if some of its values are no numbers."""
    values = _values(line, separator, decimal)
    if values and not line.startswith("#") and (len(values) == columns or all(map(_is_number, values))):
        return " ".join(value.replace(" ", "_") for value in values)
    line = line.rstrip(_TRAILING)
    return _DECIMAL.sub(".", line) if decimal == "," else line


def _values(line, separator, decimal):
    """Values of a line. Empty values between separators are undefined."""
    line = line.strip(" ")
    parts = line.removesuffix(separator).split(separator) if separator and line else line.split()
    return [part.strip(" \t\"'").replace(decimal, ".") or "nan" for part in parts]


def _is_number(value):
    """Whether a value is a number."""
    try:
        float(value)
    except ValueError:
        return False
    return True

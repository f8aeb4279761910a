"""Text of a file of any encoding."""

import codecs
import contextlib
import re

#: Marks of encodings at the beginning of a text.
_MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
#: Encodings of texts without a mark with the signs that show that another is right, or that a file is no text.
_CONTROL = "\\x00-\\x08\\x0e-\\x19\\x1b-\\x1f"
_SWAPPED = f"{_CONTROL}\\u0400-\\u1fff\\u2300-\\uffff"
_ENCODINGS = {"utf-8": _CONTROL, "utf-16-le": _SWAPPED, "utf-16-be": _SWAPPED}
_ENCODINGS |= {"latin-1": _CONTROL}
#: Signs that no reader of numbers knows: further marks of encodings, the printed minus, blanks that do not break.
_SIGNS = str.maketrans({"\ufeff": None, "\u2212": "-", "\u2019": "'", "\u202f": "\xa0", "\u2009": "\xa0"})


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
                return re.sub(r"\r\n?", "\n", text).translate(_SIGNS)
    return None

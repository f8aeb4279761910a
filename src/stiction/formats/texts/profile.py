"""Heights along a line in a text with two columns: place and height, of any separator, decimal sign and head."""

import math
import re

import numpy as np

from stiction.errors import ScanError
from stiction.formats.axes import is_even, unevenness
from stiction.formats.heights import UNITS
from stiction.formats.no_data import without_marks
from stiction.formats.texts.lines import COORDINATES, misread
from stiction.formats.texts.table import plain

#: Unit of a column in a head, as a word of its own.
_UNIT = re.compile(r"(?<![A-Za-zµÅ])(pm|nm|µm|um|mm|m|Å)(?![A-Za-zµÅ])")
#: Units that a configuration can state.
STATED = ("m", "mm", "µm", "um", "nm")
#: Columns of a profile, and signs of a value that a sentence quotes.
_COLUMNS, _LONGEST = 2, 40
#: ASSUME: farthest that places may lie from even ones, in steps, and largest share of undefined heights to be filled.
_UNEVEN, _UNDEFINED = 0.1, 0.01


def profile(text: str, label: str, units: dict[str, str]) -> tuple[np.ndarray, float]:
    r"""Heights (n,) [m] and step [m] of a text.

    Parameters
    ----------
    text : str
    label : str
        Name of the file, for messages.
    units : dict
        Stated units of places and heights, ``x_unit`` and ``height_unit``, for texts without units in their head.

    Raises
    ------
    ScanError
        If it is no profile, or its units are not clear.

    Examples
    --------
    >>> heights, step = profile("x [µm];z [nm]\n0;1,5\n0,5;2\n1;3\n", "a.txt", {})
    >>> (1e9 * heights).round(3).tolist(), round(1e6 * step, 3)
    ([1.5, 2.0, 3.0], 0.5)
    """
    written = plain(text.replace("μ", "µ"), label, fewest=_COLUMNS)
    rows, head, table = _table(written)
    if wrong := misread(table):
        line, value = len(head) + wrong[0], wrong[1][:_LONGEST]
        raise ScanError(label, "files", f"has {value!r} in line {line}, must be a number, or nan for no height")
    places, heights = _columns(rows, label)
    x_unit, height_unit = _units(head, units, label)
    return _filled(_without_marks(heights, label), label) * UNITS[height_unit], _step(places, label) * UNITS[x_unit]


def _table(text):
    """Numbers in lines of most columns, the lines before them, and the text from the first one on."""
    lines = text.split("\n")
    numbers = [_numbers(line) for line in lines]
    counts = [len(row) for row in numbers]
    usual = max(set(counts) - {0}, key=counts.count, default=0)
    first = counts.index(usual) if usual else len(lines)
    return (
        np.array([row for row in numbers if usual and len(row) == usual], float),
        lines[:first],
        "\n".join(lines[first:]),
    )


def _numbers(line):
    """Numbers of a line, none if it has something else."""
    try:
        return [] if line.startswith("#") else list(map(float, line.split()))
    except ValueError:
        return []


def _columns(rows, label):
    """Places and heights (n,) of lines of numbers, without a column that counts them."""
    columns = rows.shape[1] if rows.ndim == _COLUMNS else 0
    if columns == COORDINATES and is_even(rows[:, 0]) and is_even(rows[:, 1]):
        return rows[:, 1], rows[:, 2]
    if columns == _COLUMNS:
        return rows.T
    if not columns:
        raise ScanError(label, "files", "has no numbers in columns; a profile has two, places and heights")
    shown = "one column" if columns == 1 else f"{columns} columns"
    reason = f"has {shown}; a profile has two, places and heights"
    raise ScanError(label, "files", reason if columns == 1 else f"{reason}, and maps are listed under scans")


def _units(head, units, label):
    """Units of places and heights: stated ones, or those of a line of the head with two."""
    stated = [units.get("x_unit"), units.get("height_unit")]
    in_head = next((units for line in reversed(head) if len(units := _UNIT.findall(line)) == _COLUMNS), [None, None])
    for key, stated_unit, stored in zip(("x_unit", "height_unit"), stated, in_head, strict=True):
        if None not in (stated_unit, stored) and UNITS[stated_unit] != UNITS[stored]:
            raise ScanError(
                label, key, f"has {stored} in its head, not {stated_unit}: leave out {key}, or correct the file"
            )
        if stated_unit is stored is None:
            raise ScanError(label, key, f"has no units in its head; give {key}, one of {', '.join(STATED)}")
    return [stated_unit or stored for stated_unit, stored in zip(stated, in_head, strict=True)]


def _step(places, label):
    """Even step between places, in their unit."""
    steps = np.diff(places)
    if len(steps) < _COLUMNS or not np.isfinite(places).all() or not (np.all(steps > 0) or np.all(steps < 0)):
        wrong = int(np.argmin(np.sign(steps) == np.sign(np.median(steps)))) + 1 if len(steps) else 0
        reason = f"has places that do not rise all along (point {wrong + 1}): sort them, or swap the columns"
        raise ScanError(label, "files", reason)
    away = float(unevenness(places[None, :])[0])
    if away > _UNEVEN:
        reason = f"has unevenly spaced places, up to {away:.2g} steps from even ones, must be at most {_UNEVEN:g}"
        raise ScanError(label, "files", f"{reason}: resample it")
    return abs(float(places[-1] - places[0])) / len(steps)


def _without_marks(heights, label):
    """Heights with nan for marks of no data."""
    try:
        return without_marks(heights)[0]
    except ValueError as doubt:
        raise ScanError(label, "files", str(doubt)) from None


def _filled(heights, label):
    """Heights with few undefined ones filled between their neighbours."""
    defined = np.isfinite(heights)
    share = 1 - float(defined.mean())
    if share > _UNDEFINED or math.isnan(share):
        reason = f"has {100 * share:.3g} % of its points undefined, must be at most {100 * _UNDEFINED:g} %"
        raise ScanError(label, "files", f"{reason}: cut it to a part without gaps")
    number = np.arange(len(heights))
    return np.interp(number, number[defined], heights[defined])

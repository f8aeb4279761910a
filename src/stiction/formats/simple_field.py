"""Simple fields of Gwyddion, ``.gsf``: a head of lines, zeros, and 32-bit numbers of one map.

The layout is that of the guide of Gwyddion: lines of ``key = value``, one to four zeros up to a multiple of four bytes,
and the rows from the top, least significant byte first.
"""

import re
from dataclasses import replace

import numpy as np

from stiction.formats.channel import Channel, numbered
from stiction.formats.heights import STORED, UNITS

#: First bytes of a file.
MAGIC = b"Gwyddion Simple Field 1.0\n"
_NUMBER = np.dtype("<f4")
_LINE = re.compile(r"^[ \t]*(\w+)[ \t]*=[ \t]*(.*?)[ \t\r]*$", re.MULTILINE)


def channels(content: bytes) -> list[Channel]:
    """Channel of a file.

    Raises
    ------
    ValueError, KeyError
        If its data are not those that its head describes, or its sides are no lengths.
    """
    end = content.index(b"\0")
    lines = _LINE.findall(content[len(MAGIC) : end].decode("utf-8"))
    head = dict(lines)
    if len(head) < len(lines):
        raise ValueError("its head has a key twice")
    points, start = (int(head["XRes"]), int(head["YRes"])), end + 4 - end % 4
    if min(points) < 1 or content[end:start].strip(b"\0") or len(content) != start + points[0] * points[1] * 4:
        raise ValueError("its data are not those that its head describes")
    unit = head.get("XYUnits") or None
    if unit and (unit not in STORED or not {"XReal", "YReal"} <= head.keys()):
        raise ValueError("its sides are no lengths")
    sides = tuple(UNITS.get(unit, 1.0) * float(head.get(key, 1.0)) for key in ("XReal", "YReal"))
    values = np.frombuffer(content, _NUMBER, offset=start).reshape(points[::-1])
    name, measured = head.get("Title") or "Default", head.get("ZUnits", "")
    scale = UNITS.get(measured, 1.0) if unit else 1.0
    channel = Channel(name, measured, points, sides, lambda: scale * values[::-1].T.astype(float))
    return numbered([channel if unit else replace(channel, unit=None)])

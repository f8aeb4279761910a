"""Scans of Nanonis, ``.sxm``: a text of tags, and 32-bit numbers of every channel in both directions.

The layout is that of the manual of Nanonis. Values are in SI units, and NaN where a scan was stopped.
Lines, and the points of a line, are in the order of the scan, so that backward images are mirrored.
"""

import re
from collections.abc import Iterator

import numpy as np

from stiction.formats.channel import Channel, numbered

#: First bytes of a file, the tag after which its data begin, and the bytes before these.
MAGIC, _END, _BEFORE_DATA = b":NANONIS_VERSION:", b":SCANIT_END:", b"\x1a\x04"
#: Tags on which the values depend.
_USED = ("SCANIT_TYPE", "SCAN_PIXELS", "SCAN_RANGE", "SCAN_DIR", "DATA_INFO")


def channels(content: bytes) -> list[Channel]:
    """Channels of a file.

    Raises
    ------
    ValueError
        If its data are not those that its tags describe.
    """
    end = content.index(_END)
    parts = re.split(r"^:([^:\n]+):\r?$", content[:end].decode("latin-1"), flags=re.MULTILINE)
    tags, data = dict(zip(parts[1::2], parts[2::2], strict=True)), content[content.index(_BEFORE_DATA, end) + 2 :]
    if tags["SCANIT_TYPE"].split() != ["FLOAT", "MSBFIRST"]:
        raise ValueError(f"its numbers are {' '.join(tags['SCANIT_TYPE'].split())}, not FLOAT MSBFIRST")
    points, sides = tuple(map(int, tags["SCAN_PIXELS"].split())), tuple(map(float, tags["SCAN_RANGE"].split()))
    size, images = points[0] * points[1], list(_images(tags["DATA_INFO"]))
    if any(parts[1::2].count(tag) > 1 for tag in _USED) or min(points) < 1 or len(data) != 4 * size * len(images):
        raise ValueError("its data are not those that its tags describe")
    values = np.frombuffer(data, ">f4").reshape(len(images), points[1], points[0])
    upwards = tags["SCAN_DIR"].strip() == "up"
    return numbered(
        Channel(f"{name} ({direction})", unit, points, sides, lambda k=k: _oriented(values[k], upwards, images[k][2]))
        for k, (name, unit, direction) in enumerate(images)
    )


def _images(table) -> Iterator[tuple[str, str, str]]:
    """Name, unit and direction of every image, in the order of the data."""
    head, *rows = (line.strip("\t\r").split("\t") for line in table.strip("\r\n").splitlines() if line.strip())
    for row in rows:
        channel = dict(zip(head, row, strict=False))
        directions = ("forward", "backward") if channel["Direction"] == "both" else (channel["Direction"],)
        for direction in directions:
            yield channel["Name"], channel["Unit"], direction


def _oriented(lines, upwards, direction):
    """Map (n_x, n_y) with x to the right and y up, from lines and points in the order of the scan."""
    ordered = lines if upwards else lines[::-1]
    return (ordered[:, ::-1] if direction == "backward" else ordered).T.astype(float)

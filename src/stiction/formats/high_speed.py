"""Movies of high-speed microscopes, ``.asd``: levels of voltage of two channels, one frame after another.

The layouts of the three versions are those of libasd. Every frame is a map of the same area.
"""

import struct
from collections.abc import Iterator

import numpy as np

from stiction.formats.channel import Channel, numbered

_NM = 1e-9
#: Voltages of the first and the last level, by code [V]. ASSUME: heights fall with the level in all ranges, as the
#: piezo below the sample retreats; libasd says so of ranges that are symmetric about 0, and the opposite of others.
_RANGES = {1: (0.0, -1.0), 2: (0.0, -2.5), 3: (0.0, -9.99), 4: (0.0, -5.0)}
_RANGES |= {0x00010000: (1.0, -1.0), 0x00020000: (2.5, -2.5), 0x00040000: (5.0, -5.0)}
#: Bits of levels. ASSUME: levels of 16 bits do not all fit into 12.
_BITS = (12, 16)
#: ASSUME: least and largest extension of a piezo [nm/V], and gain of its amplifier. Others are damage.
_PIEZO = ((0.1, 1000.0), (0.1, 1000.0))
_UNSURE = "readers of this format disagree on the sign of its heights: check on the sheet that elevations are red"
#: Names of the quantities of channels, and that of heights.
_NAMES = {"TP": "Topography", "ER": "Error", "PH": "Phase"}
_HEIGHTS = "TP"
#: Headers of versions 0 and 1, and what follows the texts of version 2: a number of frames, four of the scan, and the
#: numbers of anchors of three colours.
_VERSION_0, _VERSION_1, _COLOURS = "<i2s2s5i4h3fIi?ihh6B2f3i3ih", "<6i4s4s8i?i8i3fi12siIi6f", "<iid2i3i"
#: Positions of values in the headers: channels, sizes of frame headers and texts, frames, points, sides, extension and
#: gain of the piezo, range and bits of the levels.
_PLACES = {
    0: {"channels": (1, 2), "frame": 4, "texts": (5, 6, 7), "frames": 33, "points": (8, 9), "sides": (10, 11)}
    | {"piezo": (13, 14), "range": 15, "bits": 16},
    1: {"channels": (6, 7), "frame": 2, "texts": (4, 5), "frames": 9, "points": (12, 13), "sides": (14, 15)}
    | {"piezo": (38, 39), "range": 32, "bits": 33},
}


def channels(content: bytes) -> list[Channel]:
    """Channels of a file: every frame of the heights is one.

    Raises
    ------
    ValueError
        If the file is of another version, has no heights, or has levels of another range.
    """
    (version,) = struct.unpack_from("<i", content)
    if version not in (0, 1, 2):
        raise ValueError(f"its version is {version}, not 0, 1 or 2")
    layout, places = (_VERSION_0, _PLACES[0]) if version == 0 else (_VERSION_1, _PLACES[1])
    header = struct.unpack_from(layout, content)
    value = {name: _at(header, position) for name, position in places.items()}
    if min(*value["texts"], *value["points"], value["frame"], value["frames"]) < 0:
        raise ValueError("its header has a negative size")
    start = struct.calcsize(layout) + sum(value["texts"]) + _after_the_texts(version, content, layout, value["texts"])
    return numbered(_frames(content[start:], value))


def _at(header, position):
    """Value, or values, of a header."""
    return tuple(header[index] for index in position) if isinstance(position, tuple) else header[position]


def _after_the_texts(version, content, layout, texts):
    """Number of bytes between the texts and the frames."""
    if version == 0:
        return struct.calcsize("<2fi")
    if version == 1:
        return 0
    *_, red, green, blue = struct.unpack_from(_COLOURS, content, struct.calcsize(layout) + sum(texts))
    return struct.calcsize(_COLOURS) + 8 * (red + green + blue)


def _frames(data, value) -> Iterator[Channel]:
    """Channels of the frames of heights."""
    kinds = [kind.rstrip(b"\0").decode("ascii") for kind in value["channels"]]
    if _HEIGHTS not in kinds:
        raise ValueError(f"its channels are {', '.join(_NAMES.get(kind, kind) for kind in kinds if kind)}")
    if value["range"] not in _RANGES:
        raise ValueError(f"its levels have the range {value['range']:#x} of voltages")
    points, sides = value["points"], tuple(_NM * length for length in value["sides"])
    size = value["frame"] + 2 * points[0] * points[1]
    if min(points) < 1 or len(data) != size * value["frames"] * sum(map(bool, kinds)):
        raise ValueError("its size is not that of the frames in its header")
    first = size * value["frames"] * kinds.index(_HEIGHTS)
    if not all(
        least <= value_of_piezo <= most for value_of_piezo, (least, most) in zip(value["piezo"], _PIEZO, strict=True)
    ):
        raise ValueError("the extension of its piezo, or its gain, is that of no instrument")
    for number in range(value["frames"]):
        levels = np.frombuffer(data, "<i2", points[0] * points[1], first + size * number + value["frame"])
        _require_levels(levels, value["bits"])
        info = {} if _RANGES[value["range"]][0] else {"note": _UNSURE}
        yield Channel(_NAMES[_HEIGHTS], "m", points, sides, lambda levels=levels: _heights(levels, value), info=info)


def _require_levels(levels, bits):
    """Refuse levels that need fewer or more bits than the header has, of the numbers of bits of instruments."""
    needed = next((number for number in _BITS if levels.min() >= 0 and levels.max() < 2**number), None)
    if bits != needed:
        raise ValueError(f"its levels are not of {bits} bits")


def _heights(levels, value):
    """Heights [m] of levels of voltage."""
    extension, gain = value["piezo"]
    first, last = _RANGES[value["range"]]
    volts = first + (last - first) * levels.astype(float) / 2 ** value["bits"]
    return _NM * extension * gain * volts.reshape(value["points"][::-1]).T

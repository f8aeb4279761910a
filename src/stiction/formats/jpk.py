"""Scans of JPK in HDF5, ``.h5-jpk``: every channel is a column of levels per frame, with its scale.

Every frame is a map of the same area.
"""

import io
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from stiction.formats.channel import Channel, numbered
from stiction.formats.heights import UNITS
from stiction.formats.limits import require_points

_MEASUREMENT, _CHANNEL, _SCALING = re.compile(r"Measurement_\d+"), re.compile(r"Channel_\d+"), "net-encoder.scaling"


def channels(content: bytes, label: str) -> list[Channel]:
    """Channels of a file. None if it is another file of HDF5."""
    import h5py  # comes with the library for files

    with h5py.File(io.BytesIO(content)) as file:
        measured = [file[name] for name in file if _MEASUREMENT.fullmatch(name)]
        return numbered(
            channel
            for measurement in measured
            for name in measurement
            if _CHANNEL.fullmatch(name)
            for channel in _frames(measurement.attrs, measurement[name], label)
        )


def _frames(scan, group, label) -> Iterator[Channel]:
    """Channel of every frame of a group."""
    stored = next(group[name] for name in group if name != "thumbnail")
    require_points(stored.shape, label)
    levels = stored[()]
    points = tuple(int(scan[f"position-pattern.grid.{side}length"]) for side in "ij")
    if levels.ndim != 2 or min(points) < 1 or len(levels) != points[0] * points[1]:
        raise ValueError(f"its frames have {len(levels)} points, not {points[0]} x {points[1]}")
    sides = tuple(float(scan[f"position-pattern.grid.{side}length"]) for side in "uv")
    scale, offset = (float(group.attrs[f"{_SCALING}.{name}"]) for name in ("multiplier", "offset"))
    direction = "retrace" if _text(group.attrs["retrace"]) == "true" else "trace"
    name, unit = f"{_text(group.attrs['channel.name'])} ({direction})", _text(group.attrs[f"{_SCALING}.unit.unit"])
    metres = UNITS.get(unit, 1.0)
    for frame in levels.T:
        yield Channel(name, unit, points, sides, lambda frame=frame: _map(metres * (scale * frame + offset), points))


def _map(values, points):
    """Values (n_x, n_y) from those of one line after another."""
    return np.asarray(values, float).reshape(points[::-1]).T


def _text(attribute: Any) -> str:
    return attribute.decode() if isinstance(attribute, bytes) else str(attribute)

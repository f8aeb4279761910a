"""Maps with coordinates in netCDF, as xarray and other programs write them.

Sides are the coordinates of both dimensions, with the attribute ``units``. The library for files knows only its own
layout, whose coordinates have the attribute ``length``.
"""

from typing import Any

import numpy as np

from stiction.formats.axes import unevenness
from stiction.formats.channel import Channel, numbered
from stiction.formats.heights import STORED, UNITS
from stiction.formats.limits import HDF5, require_points

#: First bytes of files.
MAGIC = (b"CDF\x01", b"CDF\x02", b"CDF\x05", HDF5)
#: Largest distance of coordinates from even steps, in steps.
_EVEN = 0.05


def channels(content: bytes, label: str) -> list[Channel]:
    """Channels of a file, without any if it is of another layout."""
    import netCDF4

    try:
        file = netCDF4.Dataset("scan", memory=content)
    except OSError:
        return []  # other files of HDF5
    with file:
        maps = [variable for variable in file.variables.values() if _is_map(file, variable)]
        return numbered(_channel(file, variable, label) for variable in maps)


def _is_map(file, variable):
    """Whether a variable is a map of numbers over two coordinates."""
    sides = [file.variables.get(name) for name in variable.dimensions]
    on_grid = len(sides) == 2 and all(side is not None and side.dimensions == (side.name,) for side in sides)
    return on_grid and variable.dtype.kind in "iuf" and not any("length" in side.ncattrs() for side in sides)


def _channel(file, variable, label) -> Channel:
    """Map of a variable, x first: the dimension named so, or the last one."""
    require_points(variable.shape, label)
    order = (0, 1) if variable.dimensions[0].lower() == "x" else (1, 0)
    names = [variable.dimensions[k] for k in order]
    lengths, units = zip(*(_side(file.variables[name]) for name in names), strict=True)
    values = np.ma.filled(np.ma.asarray(variable[:], dtype=float), np.nan).transpose(order)
    unit = _unit(variable) or ""
    if not set(units) <= STORED:
        return Channel(variable.name, unit, values.shape, lengths, lambda: values, unit=None)
    sides = tuple(UNITS[side] * length for side, length in zip(units, lengths, strict=True))
    return Channel(variable.name, unit, values.shape, sides, lambda: values * UNITS.get(unit, 1.0))


def _side(coordinate) -> tuple[float, str | None]:
    """Number of points times their distance, and its unit. Raises ValueError for unequal distances."""
    values = np.ma.filled(np.ma.asarray(coordinate[:], dtype=float), np.nan)
    if len(values) < 2 or unevenness(values[None])[0] > _EVEN:
        raise ValueError(f"its coordinate {coordinate.name} has unequal distances between its points")
    return abs(values[-1] - values[0]) / (len(values) - 1) * len(values), _unit(coordinate)


def _unit(variable: Any) -> str | None:
    """Unit of a variable, as `stiction.formats.heights.UNITS` if it is a length."""
    unit = next((getattr(variable, key) for key in ("units", "unit") if key in variable.ncattrs()), None)
    return _LONG.get(str(unit).lower(), str(unit)) if unit is not None else None


#: Units of length by their names.
_LONG = {"metre": "m", "meter": "m", "millimetre": "mm", "millimeter": "mm", "micrometre": "µm", "micrometer": "µm"}
_LONG |= {"micron": "µm", "nanometre": "nm", "nanometer": "nm", "angstrom": "Å", "picometre": "pm", "picometer": "pm"}
_LONG |= {f"{name}s": unit for name, unit in _LONG.items()} | {"\u03bcm": "µm"}

"""Units of the configuration: settings as typed, frozen objects in SI units, and single values to SI and back.

Keys of the configuration carry their units (``gap_um``); fields of the objects do not (``gap``). No later module but
`stiction.report.format`, which has the units of tables and figures, contains a factor between units; the physics, in SI
units, states lengths in µm in its messages.
"""

import math
import re
from dataclasses import is_dataclass
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

from stiction.constants import FREE_FALL

#: Powers of ten of the units, in SI; MB are bytes.
_POWERS = {
    "nm": -9,
    "um": -6,
    "nm4": -36,
    "rad_per_um": 6,
    "per_um2": 12,
    "GPa": 9,
    "MPa": 6,
    "uN": -6,
    "nN": -9,
    "N_per_m": 0,
    "zJ": -21,
    "um2": -12,
    "ng": -12,
    "mN_per_m": -3,
    "kg_per_m3": 0,
    "V": 0,
    "K": 0,
    "MB": 6,
    "ms": -3,
}
_TO_SI = {unit: float(f"1e{power}") for unit, power in _POWERS.items()} | {"deg": math.pi / 180, "g": FREE_FALL}
#: Not one over the factors to SI: 1 / 1e-9 is not 1e9.
_FROM_SI = {unit: float(f"1e{-power}") for unit, power in _POWERS.items()} | {"deg": 180 / math.pi, "g": 1 / FREE_FALL}
#: Lengths, forces and memory are in two units each: nanometres in a micrometre, nN in a µN, MB in a GB.
NM_PER_UM, MB_PER_GB = 1e3, 1e3
_UNIT = re.compile("_(" + "|".join(sorted(_TO_SI, key=len, reverse=True)) + ")$")

T = TypeVar("T")


def to_si(value: T, unit: str) -> T:
    """Convert a value or array to SI from the unit of a key of the configuration.

    Examples
    --------
    >>> to_si(2.5, "nm"), to_si(32, "rad_per_um"), round(to_si(180, "deg"), 4)
    (2.5e-09, 32000000.0, 3.1416)
    """
    return value * _TO_SI[unit]


def from_si(value: T, unit: str) -> T:
    """Convert a value or array from SI to the unit of a key of the configuration.

    Examples
    --------
    >>> from_si(2.5e-9, "nm"), from_si(20e-6, "um"), from_si(68e12, "per_um2")
    (2.5, 20.0, 68.0)
    """
    return value * _FROM_SI[unit]


def without_unit(key: str) -> str:
    """Key of the configuration without its unit, the name of the field of a dataclass.

    Examples
    --------
    >>> without_unit("gap_um"), without_unit("samples")
    ('gap', 'samples')
    """
    return _UNIT.sub("", key)


def in_si(kind: type[T], section: dict[str, Any]) -> T:
    """Section of the configuration, or settings of a job, as a frozen dataclass in SI.

    Fields that are dataclasses, or dicts of dataclasses, are built from nested sections; lists become tuples.
    Numbers by name, below a key with a unit, stay a dict.

    Parameters
    ----------
    kind : type
        Dataclass whose fields are named like the keys, without units.
    section : dict
        Plain numbers, strings, lists and dicts.

    Raises
    ------
    TypeError
        If a key of the section is not a field, or a field without default has no key.

    Examples
    --------
    >>> from dataclasses import make_dataclass
    >>> Water = make_dataclass("Water", [("temperature", float), ("samples", int)])
    >>> in_si(Water, {"temperature_K": 300, "samples": 5})
    Water(temperature=300.0, samples=5)
    """
    kinds = get_type_hints(kind)
    values = {}
    for key, value in section.items():
        unit = _UNIT.search(key)
        name = key[: unit.start()] if unit else key
        values[name] = _converted(value, kinds.get(name), unit[1] if unit else None)
    return kind(**values)


def _converted(value, kind, unit):
    """Value of one key in SI units, converted to the type of its field."""
    if isinstance(value, dict):
        return _section(value, kind) if unit is None else {name: to_si(item, unit) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return tuple(value) if unit is None else tuple(to_si(item, unit) for item in value)
    return value if unit is None else to_si(value, unit)


def _section(value, kind):
    """Section as the dataclass, or the dict of dataclasses, given by a type."""
    if get_origin(kind) is dict:
        return {name: in_si(get_args(kind)[1], entry) for name, entry in value.items()}
    return in_si(next(option for option in (kind, *get_args(kind)) if is_dataclass(option)), value)

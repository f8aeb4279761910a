"""Settings as typed, frozen objects in SI units; units are converted only here.

Keys of the configuration carry their units (``gap_um``); fields of the objects do not (``gap``).
"""

import math
import re
from dataclasses import is_dataclass
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

_FACTORS = {
    "nm": 1e-9,
    "um": 1e-6,
    "nm4": 1e-36,
    "rad_per_um": 1e6,
    "per_um2": 1e12,
    "GPa": 1e9,
    "MPa": 1e6,
    "uN": 1e-6,
    "zJ": 1e-21,
    "deg": math.pi / 180,
    "K": 1.0,
}
#: Lengths of the configuration are in two units: nanometres in a micrometre.
NM_PER_UM = 1e3
_UNIT = re.compile("_(" + "|".join(sorted(_FACTORS, key=len, reverse=True)) + ")$")

T = TypeVar("T")


def typed(kind: type[T], section: dict[str, Any]) -> T:
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
    >>> typed(Water, {"temperature_K": 300, "samples": 5})
    Water(temperature=300.0, samples=5)
    """
    kinds = get_type_hints(kind)
    values = {}
    for key, value in section.items():
        unit = _UNIT.search(key)
        name = key[: unit.start()] if unit else key
        values[name] = _converted(value, kinds.get(name), _FACTORS[unit[1]] if unit else None)
    return kind(**values)


def _converted(value, kind, factor):
    """Value of one key in SI units, converted to the type of its field."""
    if isinstance(value, dict):
        return _section(value, kind) if factor is None else {name: item * factor for name, item in value.items()}
    if isinstance(value, list | tuple):
        return tuple(value) if factor is None else tuple(item * factor for item in value)
    return value if factor is None else value * factor


def _section(value, kind):
    """Section as the dataclass, or the dict of dataclasses, given by a type."""
    if get_origin(kind) is dict:
        return {name: typed(get_args(kind)[1], entry) for name, entry in value.items()}
    return typed(next(option for option in (kind, *get_args(kind)) if is_dataclass(option)), value)

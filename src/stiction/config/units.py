"""Units at the border: entries of the configuration, whose keys carry units, in SI. Nothing else converts."""

import re

_FACTORS = {
    "nm": 1e-9,
    "um": 1e-6,
    "nm4": 1e-36,
    "rad_per_um": 1e6,
    "per_um2": 1e12,
    "GPa": 1e9,
    "K": 1.0,
}
_UNIT = re.compile("_(" + "|".join(sorted(_FACTORS, key=len, reverse=True)) + ")$")


def si(entry):
    """Convert a section: ``{"gap_um": 20}`` becomes ``{"gap": 2e-5}``; keys without a unit stay as they are.

    Examples
    --------
    >>> si({"temperature_K": 300, "samples": 5})
    {'temperature': 300.0, 'samples': 5}
    """
    converted = {}
    for key, value in entry.items():
        unit = _UNIT.search(key)
        converted[key[: unit.start()] if unit else key] = value * _FACTORS[unit[1]] if unit else value
    return converted

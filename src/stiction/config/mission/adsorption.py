"""Films that adsorb on both solids, by the isotherm of a configuration."""

from collections.abc import Iterable, Mapping
from typing import Any

from stiction.config.units import in_si
from stiction.contact.meniscus import Isotherm
from stiction.devices.limits.limit import Limit
from stiction.devices.limits.rules import beyond_isotherm, triggered


def adsorbed_heights(water: Mapping[str, Any], humidities: Iterable[float]) -> list[float]:
    """Heights that an isotherm adds to the water at some humidities, zero without one [m]."""
    isotherm = in_si(Isotherm, water["isotherm"]) if "isotherm" in water else None
    return [isotherm.height(humidity) if isotherm else 0.0 for humidity in humidities]


def unmeasured(water: Mapping[str, Any], wet: Iterable[float]) -> list[Limit]:
    """Limit by humidities at which water condenses above those of an isotherm, none without one."""
    if "isotherm" not in water:
        return []
    return triggered(beyond_isotherm(water["isotherm"]["humidities"][-1], max(wet, default=0.0)))

"""Films that adsorb on both solids, by the isotherm of a configuration."""

from collections.abc import Iterable, Mapping
from typing import Any

from stiction.config.units import in_si
from stiction.contact.meniscus import Isotherm


def adsorbed_heights(water: Mapping[str, Any], humidities: Iterable[float]) -> list[float]:
    """Heights that an isotherm adds to the water at some humidities, zero without one [m]."""
    isotherm = in_si(Isotherm, water["isotherm"]) if "isotherm" in water else None
    return [isotherm.height(humidity) if isotherm else 0.0 for humidity in humidities]

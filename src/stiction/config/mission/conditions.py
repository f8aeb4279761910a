"""Conditions of devices: the temperature of each, and its humidity or dew point."""

from collections.abc import Iterator, Mapping
from typing import Any

from stiction.constants import ZERO_CELSIUS
from stiction.contact.meniscus import humidity_at

#: Key of the conditions of a device.
CONDITIONS = "conditions"
#: Lowest dew point with a vapour pressure [K].
_COLDEST = 150.0
#: Decimals of humidities in the names of files.
DECIMALS = 4


def humidity_of_air(temperature: float, dew_point: float) -> float | None:
    """Humidity of air to four decimals, none if water condenses [-]. It is not dry. Both in K."""
    if dew_point >= temperature:
        return None
    humidity = round(humidity_at(temperature, dew_point), DECIMALS) if dew_point > _COLDEST else 0.0
    return None if humidity >= 1 else max(humidity, 10**-DECIMALS)


def kelvin(condition: Mapping[str, Any]) -> float:
    """Temperature of a condition [K]."""
    return round(condition["temperature_C"] + ZERO_CELSIUS, 6)


def humidity_of(condition: Mapping[str, Any]) -> float | None:
    """Humidity of a condition, none where water condenses [-]."""
    if "humidity" in condition:
        return condition["humidity"]
    return humidity_of_air(kelvin(condition), condition["dew_point_C"] + ZERO_CELSIUS)


def airs(config: Mapping[str, Any], pair: str) -> Iterator[tuple[str, float, float]]:
    """Yield key, humidity and temperature [K] of each condition of the devices on a pair with humid air."""
    for name, device in config.get("devices", {}).items():
        for number, condition in enumerate(device.get(CONDITIONS, ()) if device["pair"] == pair else ()):
            if humidity := humidity_of(condition):
                yield f"devices.{name}.{CONDITIONS}.{number}", humidity, kelvin(condition)


def temperatures(config: Mapping[str, Any], pair: str) -> dict[float, float]:
    """Temperatures of the water between the surfaces of a pair in the conditions of its devices, by humidity [K]."""
    return {humidity: temperature for _, humidity, temperature in airs(config, pair)}

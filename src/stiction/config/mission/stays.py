"""Touchdowns of a mission: those of each condition, in the airs that bound its film."""

import math
from collections.abc import Mapping
from typing import Any

from stiction.config.mission.conditions import CONDITIONS, DECIMALS, humidity_of, kelvin
from stiction.contact.air import DRY_AIR, is_humid
from stiction.contact.meniscus import BRIDGE, least_humidity


def stays(device: Mapping[str, Any], angles: tuple[float, ...]) -> dict[str, dict[str, Any]]:
    """Airs and touchdowns of each condition of a device by number; none unless shares of the touchdowns are stated.

    Between surfaces with contact angles [rad], none without water. All touchdowns of a condition happen in the worst of
    its own air, of those that bound its film, and of the humidities beside the conditions.
    """
    conditions = [
        condition
        for condition in device.get(CONDITIONS, ())
        if "share" in condition and humidity_of(condition) is not None
    ]
    brackets = [with_bounds(humidity_of(condition), kelvin(condition), angles) for condition in conditions]
    inside = {air for bracket in brackets for air in bracket}
    others = [air for air in device["humidities"] if air not in inside]
    shares = [condition["share"] for condition in conditions]
    return {
        str(k): {"humidities": [*bracket, *others], "touchdowns": share / sum(shares) * device.get("touchdowns", 1)}
        for k, (bracket, share) in enumerate(zip(brackets, shares, strict=True))
        if share
    }


def with_bounds(air: float, temperature: float, angles: tuple[float, ...]) -> tuple[float, ...]:
    """Air of a condition with those that bound its film, at a temperature [K] and between contact angles [rad]."""
    thinnest = _thinnest(temperature, angles) if angles else 0.0
    if not is_humid(air) or air >= thinnest:
        return (air,)
    is_bridge = air >= least_humidity(temperature, angles, BRIDGE)
    return (air, DRY_AIR.humidity, thinnest) if is_bridge else (DRY_AIR.humidity,)


def _thinnest(temperature, angles):
    """Lowest humidity of a liquid film that names of files can contain [-]."""
    steps = 10**DECIMALS
    return min(math.ceil(least_humidity(temperature, angles) * steps), steps - 1) / steps

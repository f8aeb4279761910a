"""Mission of a device: its conditions as humidities, and what bounds films that are no liquid.

``conditions: [{temperature_C: 25, dew_point_C: 10}, {temperature_C: 15, dew_point_C: 10}]`` adds the humidities 0.3875
and 0.7201 to a device. At each of them its water has the temperature of the condition, see
`stiction.config.mission.conditions.temperatures`: no stage knows of missions.

ASSUME: all touchdowns happen at the largest voltage, in the largest shock and, where no ``share`` says in which
condition, in the worst one. That is the safe side.
"""

import math
from functools import partial
from typing import Any

from stiction.config import test_beams
from stiction.config.cases import in_numbers
from stiction.config.keys import Keys, Relations
from stiction.config.meetings import ANY, TEMPERATURE, device_meeting
from stiction.config.merging import section_at
from stiction.config.messages import ConfigError, Problem, one_line
from stiction.config.mission.conditions import CONDITIONS, DECIMALS, airs, humidity_of, kelvin
from stiction.config.mission.stays import with_bounds
from stiction.constants import ZERO_CELSIUS
from stiction.contact.air import humid, is_humid

#: Keys of the air of a condition, of which it has one.
_AIR = "humidity", "dew_point_C"
#: Keys of a condition that become keys of the device.
OF_DEVICE = "touchdowns", "voltage_V", "shock_g"
#: Relations between the keys of a condition, and between the conditions of devices.
relation_of_conditions, relation = Relations(), Relations()


def with_keys_of_airs(config: Any) -> Any:
    """Configuration, valid or not, with each dew point of a condition in a key of its own, not in its humidity."""
    return _with_devices(config, _with_dew_points)


def with_any_air(config: Any) -> Any:
    """Configuration, valid or not, with some humidity of each device that has conditions. A schema wants one."""
    return _with_devices(config, lambda device, _name: {"humidities": [ANY]} | device)


def expanded(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration in which devices have the humidities of their conditions, each of which states its air.

    Raises
    ------
    ConfigError
        If water condenses in all conditions of a device.
    """
    return _with_devices(config, _with_airs)


def _with_devices(config, change):
    """Configuration, valid or not, with devices with conditions changed by a function of their section and name."""
    devices = section_at(config, "devices")
    changed = {name: change(device, name) for name, device in devices.items() if CONDITIONS in section_at(device)}
    return config | {"devices": devices | changed} if changed else config


def _with_dew_points(device, _name):
    """Section of a device with conditions, valid or not, with their dew points in keys of their own."""
    stated = device[CONDITIONS]
    return device | {CONDITIONS: list(map(_with_dew_point, stated)) if isinstance(stated, list) else stated}


def _with_dew_point(condition):
    """Condition with its dew point in a key of its own, if it has one in place of the humidity."""
    if {*(air := section_at(condition, "humidity"))} != {"dew_point_C"}:
        return condition
    return {key: value for key, value in condition.items() if key != "humidity"} | air


def _with_airs(device, name):
    """Section of a device with all that its conditions give it."""
    conditions, stated = in_numbers(device[CONDITIONS]), device.get("humidities", [])
    humidities = dict.fromkeys(map(humidity_of, conditions))
    if not stated and {*humidities} == {None}:
        words = f"is {one_line(conditions)}, must have a condition above its dew point: in all of these water condenses"
        raise ConfigError(str(Problem(("devices", name, CONDITIONS), words)))
    added = [air for air in humidities if air is not None and air not in stated]
    kept = [{key: value for key, value in each.items() if key not in OF_DEVICE} for each in conditions]
    return device | _of_device(device, conditions) | {"humidities": [*stated, *added], CONDITIONS: kept}


def _of_device(device, conditions):
    """Keys of a device by what its conditions and itself state.

    These are the touchdowns of all together, the voltage with the largest potential, and the largest shock.
    """
    stated = {key: [section[key] for section in (device, *conditions) if key in section] for key in OF_DEVICE}
    offset = device.get("offset_V", 0)
    of_all = {
        "touchdowns": sum,
        "voltage_V": partial(max, key=lambda volt: (abs(volt + offset), volt)),
        "shock_g": max,
    }
    return {key: of_all[key](values) for key, values in stated.items() if values}


def bracketed(config: dict[str, Any]) -> dict[str, Any]:
    r"""Configuration in which each film of a device that is too thin for a liquid has what bounds it beside it.

    Whatever its structure, a film attracts flats at a gap g with some f(g) and needs the work :math:`\int f \, dg =
    \gamma (\cos\theta_1 + \cos\theta_2)` to separate them. ASSUME: f decreases, its tension is at most that of its
    humidity, or `stiction.contact.meniscus.STRENGTH`, and it reaches no farther than the thinnest liquid. It then is a
    mixture of films with heights h from that of its humidity to that of the thinnest liquid, with tensions
    :math:`\gamma (\cos\theta_1 + \cos\theta_2) / h`. Where the bearing area A is convex, so is A(d - h) / h in 1 / h:
    energy and largest force are at most the larger of those at both ends. Without a meniscus, they are those of dry
    air. The answer is the worst of the three airs.

    ASSUME: below one molecule there is no meniscus. A condition in such air counts as dry.

    A film of an isotherm without a meniscus is no fourth answer. As coatings of water on both solids (37 zJ), films of
    0.8 nm lower the energy of dry pairs a, b and c from 0.60, 0.21 and 0.022 to 0.18, 0.076 and 0.016 mJ/m², away from
    the 6.9, 2.1 and 0.032 at RH 0.30: not monotone, and a jump by 38, 28 and 2 where menisci begin (100 samples on
    summits, within 5 %). Flats need 231 mJ/m² with any meniscus and 166 without.
    """
    keys, changed = Keys({"materials": {}} | config), {}
    for name, device in config.get("devices", {}).items():
        if angles := device_meeting(name, keys).wetting():
            changed[name] = _bracketed(device, angles, keys[TEMPERATURE])
    return config | {"devices": config["devices"] | changed} if changed else config


def _bracketed(device, angles, temperature):
    """Section of a device with the airs that bound those of thin films, between surfaces with contact angles [rad]."""
    conditions, stated, bounds = device.get(CONDITIONS, []), [], []
    temperatures = {humidity_of(condition): kelvin(condition) for condition in conditions}
    shared = {"share": 0} if any("share" in condition for condition in conditions) else {}
    for air in device["humidities"]:
        at = temperatures.get(air, temperature)
        first, *others = with_bounds(air, at, angles)
        stated.append(first if air in temperatures else air)  # a relation refuses that of a stated humidity
        bounds += others
        new = [
            humidity
            for humidity in others
            if is_humid(humidity) and air in temperatures and humidity not in temperatures
        ]
        conditions = conditions + [_same(at, humidity) | shared for humidity in new]
    airs = [*stated, *(air for air in dict.fromkeys(bounds) if air not in stated)]
    airs = [*dict.fromkeys(airs)] if temperatures else airs  # several conditions may be dry
    return device | {"humidities": airs} | ({CONDITIONS: conditions} if conditions else {})


def _same(temperature, humidity):
    """Condition at a temperature [K] and a humidity."""
    return {"temperature_C": round(temperature - ZERO_CELSIUS, 6), "humidity": humidity}


@relation_of_conditions
def conditions_state_their_air_once(config):
    """Require either the humidity or the dew point of a condition."""
    for name, conditions in config.entries("devices", CONDITIONS):
        for number, condition in enumerate(conditions):
            if len({*_AIR} & {*condition}) != 1:
                yield f"devices.{name}.{CONDITIONS}.{number}", f"must have either {' or '.join(_AIR)}"


@relation_of_conditions
def shares_are_of_all_touchdowns(config):
    """Require shares of either all conditions or none, that add up to one, in place of their touchdowns."""
    for name, conditions in config.entries("devices", CONDITIONS):
        key = f"devices.{name}.{CONDITIONS}"
        for number, condition in enumerate(conditions):
            if {"share", "touchdowns"} <= {*condition}:
                yield f"{key}.{number}", "must have either share, of the touchdowns of the device, or touchdowns"
        shares = [condition["share"] for condition in conditions if "share" in condition]
        if shares and len(shares) < len(conditions):
            yield key, "must have a share in all conditions or in none"
        elif shares and not math.isclose(sum(shares), 1, abs_tol=10**-DECIMALS):
            yield key, f"must have shares that add up to 1, these to {sum(shares):.6g}"
        else:
            yield from _too_few_touchdowns(key, conditions, config["devices"][name].get("touchdowns", 1))


def _too_few_touchdowns(key, conditions, touchdowns):
    """Yield refusals of shares of less than one touchdown."""
    for number, condition in enumerate(conditions):
        if 0 < condition.get("share", 0) * touchdowns < 1 - 10**-DECIMALS:
            refusal = f"must be at least {1 / touchdowns:.4g}, one of the touchdowns of the device, {touchdowns}"
            yield f"{key}.{number}.share", refusal


@relation
def air_has_one_temperature_at_a_humidity(config):
    """Require one temperature of the water between two surfaces at a humidity, which names its results."""
    for pair in dict.fromkeys(pair for _, pair in config.entries("devices", "pair")):
        temperatures = {}
        for key, humidity, temperature in [*_other_airs(config, pair), *airs(config.config, pair)]:
            before, other = temperatures.setdefault(humidity, (temperature, key))
            if before != temperature:
                allowed = f"{humidity + 10**-DECIMALS:.4g}"
                yield (
                    key,
                    f"must have another humidity than {humidity:g}, such as {allowed}, at another temperature",
                    other,
                )


def _other_airs(config, pair):
    """Yield key, humidity and temperature of the humidities of test beams, and of devices without a condition [K]."""
    for name, on in config.entries("test_beams", "pair"):
        for humidity in humid(test_beams.humidities(config["test_beams"][name])) if on == pair else ():
            yield f"test_beams.{name}.pair", humidity, config[TEMPERATURE]
    for name, on, humidities in config.entries("devices", "pair", "humidities"):
        airs_of_conditions = {humidity_of(condition) for condition in config["devices"][name].get(CONDITIONS, ())}
        for humidity in humid([air for air in humidities if air not in airs_of_conditions]) if on == pair else ():
            yield f"devices.{name}.humidities", humidity, config[TEMPERATURE]

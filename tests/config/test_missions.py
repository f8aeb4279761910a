"""Conditions of devices become humidities with temperatures of their own, and thin films get what bounds them."""

import itertools

import numpy as np
import pytest
from configurations import problems
from hypothesis import given
from hypothesis import strategies as st
from plans import job_settings

from stiction.config.files import joined
from stiction.config.merging import merged
from stiction.config.mission.airs import OF_DEVICE, expanded
from stiction.config.mission.conditions import temperatures
from stiction.config.mission.stays import stays
from stiction.config.relations import schema
from stiction.config.units import in_si
from stiction.config.validation import checked
from stiction.constants import WATER_MOLECULE
from stiction.contact.air import MOLECULES
from stiction.contact.environment import Water
from stiction.contact.meniscus import BRIDGE, humidity_at, least_humidity, meniscus_height
from stiction.plan import devices
from stiction.plan.devices import DevicePlan
from stiction.plan.plan import Plan
from stiction.plan.stage import select

LEVER = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "width_um": 30, "gap_um": 20}
MISSION = [
    {"temperature_C": 12, "dew_point_C": 10},
    {"temperature_C": 25, "dew_point_C": 10},
    {"temperature_C": 60, "humidity": 0.6},
]
DIELECTRIC = {"dielectric": {"thickness_nm": 100, "permittivity": 3.9}}


def configuration(more=(), **keys):
    """Configuration of a lever with keys of its own."""
    return joined(merged({"run": {"pairs": [], "studies": []}, "devices": {"Lever": LEVER | keys}}, dict(more)))


def lever(more=(), **keys):
    """Complete section of the lever, and its configuration."""
    config = checked(configuration(more, **keys)).config
    return config["devices"]["Lever"], config


def test_conditions_are_the_humidities_of_tables_at_their_temperatures():
    """Psychrometric chart at a dew point of 10 °C: 0.88 at 12 °C, 0.39 at 25 °C."""
    device, config = lever(conditions=MISSION)
    assert device["humidities"] == pytest.approx([0.39, 0.6, 0.88], abs=0.006)
    assert list(temperatures(config, "b").values()) == pytest.approx([285.15, 298.15, 333.15])
    for humidity, kelvin in temperatures(config, "b").items():
        assert Plan(config).air_of_devices.temperature("b", humidity) == kelvin
        assert Plan(config).air.temperature("b", humidity) == 300  # pairs keep the temperature of the water


def test_tips_are_at_the_temperatures_of_conditions_which_a_plan_reads_once(monkeypatch):
    _, config = lever(conditions=MISSION)
    config = config | {"devices": dict.fromkeys("ABC", config["devices"]["Lever"])}
    read = []
    monkeypatch.setattr(devices, "temperatures", lambda *asked: read.append(asked[1]) or temperatures(*asked))
    plan = DevicePlan(config)
    plan.all_tips("b")
    assert read == ["b"]
    assert plan._temperatures(config["devices"]["A"]) == temperatures(config, "b")
    assert DevicePlan(plain := lever(humidities=[0.6])[1])._temperatures(plain["devices"]["Lever"]) == {0.6: 300}


def test_a_dew_point_in_place_of_the_humidity_is_that_of_the_condition():
    as_humidity = {"temperature_C": 12, "humidity": {"dew_point_C": 10}}
    assert lever(conditions=[as_humidity])[0] == lever(conditions=MISSION[:1])[0]
    lines = problems(configuration(conditions=[as_humidity, {"temperature_C": "cold", "humidity": 0.5}]))
    assert any(line.startswith("devices.Lever.conditions[1].temperature_C is 'cold'") for line in lines)


def test_the_film_follows_the_temperature_of_its_condition():
    water = in_si(Water, select(Water, Plan(lever(conditions=MISSION)[1]).air_of_devices.water("b")))
    for condition in MISSION:
        kelvin = condition["temperature_C"] + 273.15
        humidity = condition.get("humidity") or round(humidity_at(kelvin, 283.15), 4)
        assert water.film(humidity)[0] == pytest.approx(float(meniscus_height(humidity, kelvin)))
    assert water.film(0.5)[0] == pytest.approx(float(meniscus_height(0.5, 300.0)))


def test_a_mission_of_one_condition_is_the_device_in_this_air():
    """At the temperature of the water all settings are equal. At another one the films are."""
    one = {"temperature_C": 25, "humidity": 0.5, "touchdowns": 7, "voltage_V": 3}
    plain = {"humidities": [0.5], "touchdowns": 7, "voltage_V": 3}
    at_25 = {"water": {"temperature_K": 298.15}}
    device, config = lever(at_25, conditions=[one], **DIELECTRIC)
    as_air, stated = lever(at_25, **plain, **DIELECTRIC)
    assert {**device, "conditions": None} == {**as_air, "conditions": None}
    assert Plan(config).air_of_devices.water("b") == Plan(stated).air_of_devices.water("b")
    at_300 = Plan(lever(conditions=[one], **DIELECTRIC)[1]).air_of_devices.water("b")
    waters = [in_si(Water, select(Water, water)) for water in (at_300, Plan(stated).air_of_devices.water("b"))]
    assert waters[0].film(0.5) == waters[1].film(0.5)
    assert Plan(lever(conditions=[one], **DIELECTRIC)[1]).devices.tips("Lever") == Plan(stated).devices.tips("Lever")


def test_the_order_of_conditions_does_not_matter():
    configs = [lever(conditions=list(order))[1] for order in itertools.permutations(MISSION)]
    assert all(config == configs[0] for config in configs)
    assert checked(configs[0]).config == configs[0]


conditions = st.lists(
    st.fixed_dictionaries({"temperature_C": st.integers(-40, 99), "dew_point_C": st.integers(-60, 90)})
    | st.fixed_dictionaries(
        {"temperature_C": st.integers(-40, 99), "humidity": st.sampled_from([0.0, 0.05, 0.31, 0.7])}
    ),
    min_size=1,
    max_size=4,
)


@given(conditions, conditions)
def test_one_more_condition_takes_no_air_away(some, more):
    """The answer belongs to the worst of all airs in every draw: more airs never make a beam longer."""
    both = [expanded({"devices": {"Lever": LEVER | {"humidities": [0.5], "conditions": all_}}})
            for all_ in (some, some + more)]  # fmt: skip
    few, many = (set(config["devices"]["Lever"]["humidities"]) for config in both)
    assert few <= many
    assert len(many) <= 1 + len(some) + len(more)


def test_condensing_conditions_give_no_air_and_a_limit_each():
    cold = [{"temperature_C": -20, "dew_point_C": 10}, {"temperature_C": 10, "dew_point_C": 10}]
    device, _ = lever(conditions=[*MISSION, *cold])
    assert len(device["humidities"]) == 3
    assert len(device["conditions"]) == 5
    (line,) = problems(configuration(conditions=cold))
    assert line.startswith("devices.Lever.conditions is [")
    assert "must have a condition above its dew point" in line


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (
            {"conditions": [{"temperature_C": 20}]},
            "conditions[0] is {'temperature_C': 20}, must have either humidity or",
        ),
        ({"conditions": [{"dew_point_C": 20}]}, "conditions[0].temperature_C is missing"),
        (
            {"conditions": [{"temperature_C": -60, "humidity": 0.5}]},
            "conditions[0].temperature_C is -60, must be a number",
        ),
        (
            {"conditions": [{"temperature_C": 1e6, "dew_point_C": 10}]},
            "conditions[0].temperature_C is 1000000.0, must be",
        ),
        ({"conditions": [{"temperature_C": 20, "humidity": 1.5}]}, "conditions[0].humidity is 1.5, must be a number"),
        ({"conditions": []}, "conditions is [], must be a list"),
        ({"conditions": {"temperature_C": 20}}, "conditions is {'temperature_C': 20}, must be a list"),
        ({"conditions": [{"temperature_C": 20, "humidity": 0.5, "part": 1}]}, "conditions[0].part"),
        ({"conditions": [MISSION[0] | {"share": 2}]}, "conditions[0].share is 2, must be a number"),
        ({"conditions": [MISSION[0] | {"share": 0.9}]}, "conditions is [{'temperature_C': 12, "),
        ({"conditions": [MISSION[0] | {"share": 1}, MISSION[1]]}, "conditions is [{'temperature_C': 12, "),
        ({"conditions": [MISSION[0] | {"share": 1, "touchdowns": 9}]}, "conditions[0] is {"),
        (
            {"conditions": [MISSION[0] | {"share": 0.99}, MISSION[1] | {"share": 0.01}], "touchdowns": 50},
            "conditions[1].share is 0.01, must be at least 0.02, one of the touchdowns of the device, 50",
        ),
        (
            {"conditions": [{"temperature_C": 20, "humidity": 0.5}, {"temperature_C": 30, "humidity": 0.5}]},
            "conditions[1] is {'temperature_C': 30, 'humidity': 0.5}, must have another humidity than 0.5, such as",
        ),
        (
            {"humidities": [0.5], "conditions": [{"temperature_C": 20, "humidity": 0.5}, MISSION[0], 3]},
            "conditions[2] is 3",
        ),
    ],
)
def test_wrong_conditions_are_refused_in_one_sentence(keys, words):
    (line,) = problems(configuration(**keys))
    assert line.startswith(f"devices.Lever.{words}")


def test_test_beams_are_at_the_temperature_of_the_water():
    array = {"pair": "b", "length_um": 1500, "thickness_um": 2.5, "gap_um": 2, "width_um": 30}
    array["crack_lengths"] = [{"humidity": 0.67, "mean_um": 700, "std_um": 20, "beams": 9}]
    beams, keys = {"test_beams": {"A": array}}, {"test_beams": ["A"]}
    assert problems(configuration(beams, conditions=[{"temperature_C": 50, "humidity": 0.66}], **keys)) == ()
    (line,) = problems(configuration(beams, conditions=[{"temperature_C": 50, "humidity": 0.67}], **keys))
    assert "must have another humidity than 0.67, such as 0.6701" in line


CONDITION = schema()["properties"]["devices"]["additionalProperties"]["properties"]["conditions"]["items"]["properties"]


@pytest.mark.parametrize("key", OF_DEVICE)
def test_a_wrong_value_is_refused_where_it_was_written(key):
    least, most = CONDITION[key]["minimum"], CONDITION[key]["maximum"]
    for value in (least - 1, most + 1, "much", True, *[2.5] * (key == "touchdowns")):
        (line,) = problems(configuration(conditions=[MISSION[0] | {key: value}], **DIELECTRIC, offset_V=1))
        assert line.startswith(f"devices.Lever.conditions[0].{key} is {value!r}, must be a")
    for value in (least, most):
        lever(conditions=[MISSION[0] | {key: value}], **DIELECTRIC, offset_V=1)


def test_touchdowns_of_all_conditions_have_the_limit_of_a_device():
    most = CONDITION["touchdowns"]["maximum"]
    (line,) = problems(configuration(conditions=[one | {"touchdowns": most} for one in MISSION]))
    assert line.startswith(f"devices.Lever.touchdowns is {len(MISSION) * most}, must be a whole number")


def test_touchdowns_add_up_and_the_largest_voltage_counts():
    own = [{"touchdowns": 5, "voltage_V": -8}, {"touchdowns": 7, "voltage_V": 6}, {}]
    mission = [one | more for one, more in zip(MISSION, own, strict=True)]
    device, _ = lever(conditions=mission, touchdowns=100, voltage_V=1, offset_V=3, **DIELECTRIC)
    assert (device["touchdowns"], device["voltage_V"]) == (112, 6)  # 9 V with the offset, -8 V have 5 V
    assert all(not {"touchdowns", "voltage_V"} & {*condition} for condition in device["conditions"])


def test_the_largest_shock_of_a_mission_is_that_of_the_device():
    def shocked(*shocks, **keys):
        """Section of the lever with shocks in its first conditions, without these."""
        own = [{"shock_g": shock} if shock else {} for shock in (*shocks, None, None, None)]
        device, config = lever(conditions=[one | more for one, more in zip(MISSION, own, strict=False)], **keys)
        assert checked(config).config == config
        return device

    device = shocked(None, shock_g=3000)
    assert shocked(None, 3000) == shocked(3000) == device
    assert shocked(3000, shock_g=200) == shocked(200, 3000) == shocked(200, shock_g=3000) == device
    assert shocked(200) != device  # control
    assert "shock_g" not in shocked(None)
    assert shocked(None) == {key: value for key, value in device.items() if key != "shock_g"}


def stays_of(shares, more=(), **keys):
    """Touchdowns of the lever for shares of some conditions, and the airs in which they happen."""
    device, config = lever(more, conditions=[one | {"share": share} for one, share in shares], **keys)
    assert checked(config).config == config
    found = stays(device, Plan(config).air_of_devices.wetting("b"))
    return sorted((round(stay["touchdowns"], 6), sorted(stay["humidities"])) for stay in found.values())


def test_shares_of_touchdowns_are_in_the_airs_that_bound_each_condition():
    shares = [({"temperature_C": 85, "dew_point_C": 10}, 0.5), ({"temperature_C": 60, "humidity": 0.2}, 0.3)]
    shares += [(MISSION[0], 0.2)]
    wet, liquid = (pytest.approx(air, abs=1e-4) for air in (0.8755, least_humidity(333.15)))
    assert stays_of(shares, touchdowns=50) == [(10, [wet]), (15, [0, 0.2, liquid]), (25, [0])]
    assert stays_of([(MISSION[0], 1)], touchdowns=9, humidities=[0.6]) == [(9, [0.6, wet])]  # all may happen beside it
    assert stays_of([(MISSION[0], 1), (MISSION[1], 0)], touchdowns=9) == [(9, [wet])]
    rounded = [(one, 0.3333) for one in MISSION]
    assert [number for number, _ in stays_of(rounded, touchdowns=9)] == [3, 3, 3]
    coat = {"materials": {"Coat": {"contact_angle_deg": 120}}, "surfaces": {"B2": {"material": "Coat"}}}
    coat["surfaces"]["Sub1"] = {"material": "Coat"}
    assert stays_of([(MISSION[2], 1)], coat, touchdowns=9) == [(9, [0.6])]
    device, config = lever(conditions=MISSION, touchdowns=9)
    assert not stays(device, Plan(config).air_of_devices.wetting("b"))


# Thin films


@given(st.floats(0.01, 0.9).map(lambda humidity: round(humidity, 4)), st.sampled_from([0, 40, 80, 95, 110, 120]))
def test_films_of_devices_are_liquids_or_bounded_or_refused(humidity, angle):
    material = {"materials": {"Coat": {"contact_angle_deg": angle}}, "surfaces": {"B2": {"material": "Coat"}}}
    angles, config = (np.radians(angle), 0.0), configuration(material, humidities=[humidity])
    liquid, bridge = (least_humidity(300.0, angles, molecules) for molecules in (MOLECULES, BRIDGE))
    if humidity < bridge:
        assert any("devices.Lever.humidities" in line and "write dry" in line for line in problems(config))
        return
    airs = checked(config).config["devices"]["Lever"]["humidities"]
    if humidity >= liquid:
        assert airs == [humidity]
        return
    dry, thin, thinnest = airs
    assert (dry, thin) == (0.0, humidity)
    height = meniscus_height(thinnest, 300.0, angles) / WATER_MOLECULE
    assert MOLECULES <= height < MOLECULES * 1.01


def test_conditions_with_less_than_a_molecule_of_water_count_as_dry_and_thin_ones_are_bounded_at_their_temperature():
    device, config = lever(
        conditions=[{"temperature_C": 85, "dew_point_C": 10}, {"temperature_C": 60, "humidity": 0.2}]
    )
    liquid = least_humidity(333.15)
    assert device["humidities"] == pytest.approx([0, 0.2, liquid], abs=1e-4)
    assert temperatures(config, "b")[device["humidities"][-1]] == pytest.approx(333.15)


def test_pairs_and_charts_are_still_refused_where_a_film_is_no_liquid():
    refused = {"pairs": {"b": {"humidities": [0.2, "dry"]}}, "run": {"pairs": ["b"], "studies": []}}
    assert any("pairs.b.humidities" in line and "only the humidities of a device can be lower" in line
               for line in problems(configuration(refused, humidities=[0.5])))  # fmt: skip
    chart = {"thicknesses_um": [2.6], "humidities": [0.2, 0.9]}
    (line,) = problems(configuration(humidities=[0.5], chart=chart))
    assert line.startswith("devices.Lever.chart.humidities is [0.2, 0.9], must be at least 0.2903")


def test_an_answer_knows_the_temperature_of_all_water_of_its_mission():
    _, config = lever(conditions=MISSION[:1], humidities=[0.0, 0.5])
    assert job_settings(Plan(config), "devices/answer/Lever")["temperatures_K"] == {"0.5": 300, "0.8755": 285.15}
    _, plain = lever(humidities=[0.0, 0.5])
    assert "temperatures_K" not in job_settings(Plan(plain), "devices/answer/Lever")

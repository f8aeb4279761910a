"""Results in wetter air than that of an isotherm have a limit that forbids relying on them. Others have none."""

import pytest

import stiction
from stiction.devices.limits.limit import restored
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

ISOTHERM = {"isotherm": {"humidities": [0.3, 0.75], "thickness_nm": [0.8, 1.2]}}
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 1}
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}


def forbidden(device, water=ISOTHERM, **more):
    """Wettest airs of the limits of a device that forbid numbers, from the settings of its warnings."""
    config = stiction.load({"devices": {"D1": device}, "water": water, **more})
    settings = Graph(Plan(config)).job("devices/warnings/D1.json").settings
    limits = map(restored, settings.get("assumed", []))
    return [limit.numbers["wettest"] for limit in limits if limit.kind == "beyond_isotherm" and limit.forbids]


@pytest.mark.parametrize("device", [BUMP, BEAM])
def test_devices_in_wetter_air_than_their_isotherm_have_no_number(device):
    assert forbidden(device | {"humidities": [0.5, 0.8]}) == [0.8]
    assert forbidden(device | {"humidities": ["dry", 0.5, 0.75]}) == []
    assert forbidden(device | {"humidities": [0.8]}, water={}) == []


def test_air_of_a_chart_and_of_a_search_counts_and_that_of_unwetted_surfaces_does_not():
    chart = {"gaps_um": [10, 20], "thicknesses_um": [2, 3], "humidities": [0.5, 0.9]}
    assert forbidden(BEAM | {"humidities": [0.5], "chart": chart}) == [0.9]
    search = {"design": {"worst_humidities": [0.4, 0.95]}}
    assert forbidden(BUMP | {"humidities": [0.5]}, **search) == [0.95]
    assert forbidden(BEAM | {"humidities": [0.5]}, **search) == []
    wax = {"material": "Wax"}
    waxed = {
        "materials": {"Wax": {"contact_angle_deg": 110}},
        "surfaces": {"B2": wax, "Sub1": wax},
        "run": {"pairs": []},
    }
    assert forbidden(BUMP | {"humidities": [0.9]}, **waxed) == []


def test_pairs_in_wetter_air_have_the_limit_among_their_warnings():
    plan = Plan(stiction.load({"run": {"pairs": ["b"]}, "water": ISOTHERM}))
    (limit,) = plan.limits_of_pairs()["b"]
    assert restored(limit).numbers == {"measured": 0.75, "wettest": 0.92}
    assert Plan(stiction.load({"run": {"pairs": ["b"]}})).limits_of_pairs() == {}

"""Answers of missions and of thin films: laws on small samples, and the example in reduced form."""

from pathlib import Path

import numpy as np
import pytest

import stiction
from stiction.answer.data import Verdict
from stiction.report.answer import words

EXAMPLE = Path(__file__).parents[3] / "examples" / "mission.yaml"
SMALL = {
    "run": {"pairs": [], "studies": []},
    "contact": {"samples": 300, "chunks": 1, "model": "summits"},
    "design": {"beams": 200, "budget_beams": 20, "budget_samples": 20},
}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 5}
AT_12, AT_25, AT_85 = ({"temperature_C": celsius, "dew_point_C": 10} for celsius in (12, 25, 85))
ONE_SIDE = {"materials": {"Coat": {"contact_angle_deg": 110}}, "surfaces": {"B2": {"material": "Coat"}}}


def device(*more, **keys):
    """Stopper with keys of its own, on little surface."""
    return stiction.Device.of(stiction.load(SMALL, {"devices": {"S": STOPPER | keys}}, *more), "S")


def forces(*more, **keys):
    """Force to build in each air by humidity [N], and in all airs under ``None``."""
    answer = device(*more, **keys).answer()
    return {None: answer.build} | {air.humidity: air.build for air in answer.airs}


@pytest.mark.slow
def test_one_more_condition_never_makes_a_force_smaller_and_one_condition_is_the_device_in_its_air():
    whole = forces(conditions=[AT_12, AT_25, AT_85])
    assert whole == forces(conditions=[AT_85, AT_12, AT_25])
    assert whole[None] == max(force for air, force in whole.items() if air is not None)
    few = forces(conditions=[AT_25])
    (humidity,) = set(few) - {None}
    assert few[None] == few[humidity] == whole[humidity] <= whole[None]
    stated = forces({"water": {"temperature_K": 298.15}}, humidities=[humidity])
    assert stated == few
    at_300 = forces(humidities=[humidity, "dry"])
    assert at_300[humidity] != few[humidity]  # control
    assert at_300[0.0] == whole[0.0]  # at 85 °C there is less than a molecule of water


@pytest.mark.slow
@pytest.mark.parametrize(("more", "humidity"), [((ONE_SIDE,), 0.45), ((), 0.1)])
def test_a_thin_film_has_the_worst_of_three_airs(more, humidity):
    found = forces(*more, humidities=[humidity])
    liquid = max(filter(None, found))
    assert found[None] == max(found[air] for air in (0.0, humidity, liquid))
    assert found[liquid] == forces(*more, humidities=[liquid])[None]
    if more:  # at the same tension, a coated side makes the film thinner
        assert found[humidity] < forces(humidities=[humidity])[humidity]
    thin = device(*more, humidities=[humidity])
    limits = {limit.kind: limit.side for limit in thin.limits(thin.forces())}
    assert limits["solid_film"] == "safe"


@pytest.mark.slow
def test_shares_of_touchdowns_lie_between_the_worst_condition_and_each_alone():
    """The wet air decides, whatever happens in the dry one, and a mission in one air is the device in it."""
    keys = {"touchdowns": 3, "restoring_force_uN": 17}

    def mission(*shares):
        """Answer for a share at 12 and one at 85 °C."""
        at = [one | {"share": share} for one, share in zip((AT_12, AT_85), shares, strict=True) if share]
        return device(conditions=at, **keys).answer()

    worst = device(conditions=[AT_12, AT_85], **keys).answer()
    third = mission(1 / 3, 2 / 3)
    assert third.build <= worst.build * (1 + 1e-6)
    assert third.stuck.value < worst.stuck.value
    assert third.stuck.value >= third.airs[0].stuck.value
    assert {row["touchdowns"] for row in words.of_airs(third)} == {"1", "2"}
    assert "after 3 touchdowns, shared among its conditions, in dry air" in words.promise(third)
    assert mission(1, 0).build == pytest.approx(device(conditions=[AT_12], **keys).answer().build, rel=1e-6)
    with pytest.raises(stiction.ConfigError, match=r"conditions\[0\].share is 0.1, must be at least 0.3333, one of"):
        mission(0.1, 0.9)


@pytest.mark.slow
def test_water_that_condenses_leaves_no_number():
    condensing = device(conditions=[AT_25, {"temperature_C": -20, "dew_point_C": 10}]).answer()
    assert condensing.verdict is Verdict.NONE
    assert "condensing" in condensing.forbidden


@pytest.mark.slow
def test_the_example_of_a_mission_names_the_temperature_that_decides():
    # A surface of the paper in place of an assumed one, whose budget takes most of the time.
    small = {"devices": {"Lever": {"gap_um": 2, "width_um": 2}}, "pairs": {"mine": {"beam": "B2"}}}
    answer = stiction.Device.of(stiction.load(EXAMPLE, SMALL, small), "Lever").answer()
    assert answer.touchdowns == 1000
    rows = words.of_airs(answer)
    assert [row["°C"] for row in rows] == ["any", "25", "12"]
    assert answer.build <= min(air.build for air in answer.airs) * (1 + 1e-9)
    assert np.isfinite(answer.build)
    assert f"at {25 if answer.stated_steps[-1].humidity < 0.5 else 12} °C" in words.decides(answer)

"""Pull-off forces among test beams in a configuration: what is refused, what jobs take from them, and what stays."""

import copy

import pytest
from configurations import PAPER, problems
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

STATED = {"humidity": 0.01, "scan_um": 10}
BALL = {"kind": "probe", "pair": "b", "radius_um": 10, "humidities": [0.45, 0.67], "uncertainty": STATED}
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
BEAM |= {"uncertainty": STATED | {"thickness_um": 0.05}, "test_beams": ["Day"]}
DAY = {"probe": "Ball", "pull_offs": [{"humidity": 0.45, "forces_nN": [71, 84, 91], "error_nN": 8}]}
SECTIONS = {"test_beams": {"Day": DAY}, "devices": {"Ball": BALL, "Beam": BEAM}}


def refused(day=None, datum=None, ball=None, beam=None):
    """Problems of the configuration with changed keys of the forces, of their entry, of the probe and of the beam."""
    config = copy.deepcopy(SECTIONS)
    config["test_beams"]["Day"] |= day or {}
    config["test_beams"]["Day"]["pull_offs"][0] |= datum or {}
    config["devices"]["Ball"] |= ball or {}
    config["devices"]["Beam"] |= beam or {}
    return problems(merged(PAPER, config))


def test_forces_with_all_their_keys_are_valid_also_in_dry_air_alone():
    assert refused() == ()
    dry = {"humidities": ["dry"], "uncertainty": {"scan_um": 10}}
    assert refused(datum={"humidity": "dry"}, ball=dry) == ()


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"day": {"strip_um": 1}}, "test_beams.Day.probe", "must come without strip_um, for pull_offs are of no beam"),
        ({"day": {"probe": "Beam"}}, "test_beams.Day.probe", "must be one of Ball"),
        ({"datum": {"humidity": 0.6}}, "test_beams.Day.pull_offs[0].humidity", "must be among the humidities of its"),
        ({"day": {"pull_offs": DAY["pull_offs"] * 2}}, "test_beams.Day.pull_offs", "must list each humidity once"),
        ({"datum": {"forces_nN": []}}, "test_beams.Day.pull_offs[0].forces_nN", "a list with 1 to"),
        ({"datum": {"forces_nN": [0]}}, "test_beams.Day.pull_offs[0].forces_nN[0]", "above 0"),
        ({"ball": {"uncertainty": {"scan_um": 10}}}, "devices.Beam.test_beams", "must not name Day, because its probe"),
        ({"beam": {"test_beams": ["Night"]}}, "devices.Beam.test_beams", "must be among Day: Night is not there"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(changes, key, words):
    (problem,) = refused(**changes)
    assert problem.startswith(f"{key} is ")
    assert words in problem


def test_forces_need_a_probe_of_the_materials_of_the_device():
    config = copy.deepcopy(SECTIONS)
    del config["devices"]["Ball"]
    (problem,) = problems(merged(PAPER, config))
    assert problem == "test_beams.Day.probe is 'Ball', must be a device of kind probe: there is none"
    for missing, other in (("probe", "pull_offs"), ("pull_offs", "probe")):
        (problem,) = problems(merged(PAPER, SECTIONS | {"test_beams": {"Day": {other: DAY[other]}}}))
        assert problem.startswith(f"test_beams.Day.{missing} is missing")
    glass = {"materials": {"Glass": {"young_modulus_GPa": 70}}, "surfaces": {"B1": {"material": "Glass"}}}
    found = problems(merged(PAPER, merged(SECTIONS, glass | {"devices": {"Ball": {"pair": "a"}}})))
    assert any(line.startswith("devices.Beam.test_beams is ['Day'], must have the materials of the") for line in found)


def test_a_device_gets_the_means_of_the_forces_and_the_budget_and_the_places_of_the_probe():
    graph = Graph(Plan(load(SECTIONS)))
    job = graph.job("devices/test_beams/Beam")
    assert job.inputs["test_beams"] == {("Day", 0.45): "devices/budget/Ball_rh045"}
    assert job.inputs["forces"] == {"Day": "devices/stoppers/Ball"}
    found = job.settings["pull_offs"]["Day"]
    assert {key: found[key] for key in ("humidity", "mean_nN", "number", "error_nN")} == {
        "humidity": [0.45],
        "mean_nN": [82],
        "number": [3],
        "error_nN": [8],
    }
    assert found["std_nN"] == [pytest.approx(10.1489)]
    single = merged(SECTIONS, {"test_beams": {"Day": {"pull_offs": [DAY["pull_offs"][0] | {"forces_nN": [71]}]}}})
    assert job_settings(Plan(load(single)), "devices/test_beams/Beam")["pull_offs"]["Day"]["std_nN"] == [0.0]
    again = graph.job("devices/test_beams/rerun/Beam").inputs
    assert set(again["budgets"]) == {("Beam", 0.67), ("Day", 0.45)}
    assert again["model_errors"] == {"b_2830x2830": "studies/model_error/probes/Ball"}


def test_surfaces_of_probes_have_slopes_of_what_is_assumed_as_those_of_their_devices():
    assumed = {"surfaces": {"Mine": {"like": "B2", "rms_nm": 3, "unknown": ["rms"]}}}
    assumed |= {"pairs": {"b": {"beam": "Mine"}}}
    plan = Plan(load(merged(SECTIONS, assumed)))
    assert plan.devices.members("Ball") == plan.devices.members("Beam") == {}
    alone = merged(SECTIONS, assumed) | {"test_beams": {}}
    alone["devices"] = {"Ball": BALL}
    assert Plan(load(alone)).devices.members("Ball") != {}


def test_compared_surfaces_copy_the_forces_with_their_probe():
    config = load(SECTIONS | {"compare": {"surfaces.B2.rms_nm": [3, 5]}})
    assert {name: one["probe"] for name, one in config["test_beams"].items()} == {
        "DayRms3": "BallRms3",
        "DayRms5": "BallRms5",
    }
    assert config["devices"]["BeamRms5"]["test_beams"] == ["DayRms5"]


ARRAY = {"pair": "b", "length_um": 1500, "thickness_um": 2, "gap_um": 20, "width_um": 30}
ARRAY |= {"crack_lengths": [{"humidity": 0.67, "mean_um": 705, "std_um": 30, "beams": 12}]}


def test_devices_without_forces_keep_all_settings_of_their_jobs():
    lever = {"test_beams": {"first": ARRAY}, "devices": {"Lever": BEAM | {"test_beams": ["first"]}}}
    alone, beside = Graph(Plan(load(lever))), Graph(Plan(load(merged(SECTIONS, lever))))
    names = [f"devices/{name}" for name in ("test_beams/Lever", "test_beams/rerun/Lever", "budget/Lever_rh067")]
    for name in (*names, "devices/test_beams/budget/first_rh067", "devices/Lever.html"):
        assert alone.job(name).settings == beside.job(name).settings
        assert alone.job(name).inputs == beside.job(name).inputs
    assert "pull_offs" not in alone.job("devices/test_beams/Lever").settings
    assert "pull_offs" in beside.job("devices/test_beams/Beam").settings

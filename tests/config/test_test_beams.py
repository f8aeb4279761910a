"""Test beams in a configuration: what is refused, what they share with their devices, and what is computed for them."""

import copy
from pathlib import Path

import pytest
from configurations import PAPER, problems
from plans import job_settings

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report import published

C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
STATED = {"thickness_um": 0.05, "young_modulus_GPa": 5, "humidity": 0.01, "scan_um": 10}
DATA = [{"humidity": rh, "mean_um": mean, "std_um": 30, "beams": 12} for rh, mean in ((0.67, 705), (0.44, 952))]
ARRAY = {"pair": "b", "length_um": 1500, "thickness_um": 2, "gap_um": 20, "width_um": 30, "crack_lengths": DATA}
ARRAY |= {"uncertainty": {"gap_um": 0.3}}
SECTIONS = {
    "test_beams": {"first": ARRAY},
    "devices": {"C1": C1 | {"uncertainty": STATED, "test_beams": ["first"]}, "C2": C1},
}
PLAN = Plan(load(SECTIONS))


def refused(array=None, datum=None, **device):
    """Problems of the configuration with changed keys of the array, of its first datum and of the device."""
    config = copy.deepcopy(SECTIONS)
    config["test_beams"]["first"] |= array or {}
    config["test_beams"]["first"]["crack_lengths"][0] |= datum or {}
    config["devices"]["C1"] |= device
    return problems(merged(PAPER, config))


def test_test_beams_with_all_their_keys_are_valid():
    assert refused() == ()


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"datum": {"mean_um": 1600}}, "test_beams.first.crack_lengths[0].mean_um", "below the length of the beams"),
        ({"datum": {"mean_um": 15, "std_um": 1}}, "test_beams.first.crack_lengths[0].mean_um", "above the thickness"),
        ({"datum": {"std_um": 800}}, "test_beams.first.crack_lengths[0].std_um", "must be below the mean (given"),
        (
            {"datum": {"std_um": 1e-300}},
            "test_beams.first.crack_lengths[0].std_um",
            "must be at least 0.0001 of the mean",
        ),
        ({"datum": {"beams": 1}}, "test_beams.first.crack_lengths[0].beams", "at least 2"),
        ({"datum": {"humidity": 67}}, "test_beams.first.crack_lengths[0].humidity", "as a fraction of 1"),
        ({"datum": {"humidity": 0.2}}, "test_beams.first.crack_lengths[0].humidity", "must be at least 0.2903: in dr"),
        ({"datum": {"humidity": 0.66666}}, "test_beams.first.crack_lengths[0].humidity", "have at most 4 decimals"),
        ({"datum": {"humidity": 0.44}}, "test_beams.first.crack_lengths", "must list each humidity once"),
        (
            {"datum": {"humidity": 0.995}},
            "devices.C1.uncertainty.humidity",
            "above 0 and below 1 (given test_beams.first.crack_lengths[0].humidity = 0.995)",
        ),
        (
            {"array": {"gap_um": 0.001, "uncertainty": {}}},
            "test_beams.first.gap_um",
            "(given test_beams.first.crack_lengths[0].humidity = 0.67",
        ),
        ({"array": {"pair": "d"}}, "test_beams.first.pair", "must be one of a, b, c"),
        (
            {"array": {"uncertainty": {"gap_um": 30}}},
            "test_beams.first.uncertainty.gap_um",
            "below the dimension itself",
        ),
        ({"array": {"uncertainty": {"humidity": 0.1}}}, "test_beams.first.uncertainty.humidity", "is unknown"),
        ({"test_beams": ["second"]}, "devices.C1.test_beams", "must be among first: second is not there"),
        ({"test_beams": ["first", "first"]}, "devices.C1.test_beams", "must contain each array once"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(changes, key, words):
    (problem,) = refused(**changes)
    assert problem.startswith(f"{key} is ")
    assert words in problem


def test_a_standard_deviation_needs_the_number_of_beams():
    config = copy.deepcopy(SECTIONS)
    del config["test_beams"]["first"]["crack_lengths"][1]["beams"]
    (problem,) = problems(merged(PAPER, config))
    assert problem.startswith("test_beams.first.crack_lengths[1].beams is missing, must be a whole number at least 2")


COUNTS = [{"humidity": 0.67, "length_um": 300, "stuck": 3, "of": 20}]
COUNTED = {key: value for key, value in ARRAY.items() if key not in ("length_um", "crack_lengths")} | {"stuck": COUNTS}


def of_array(array):
    """Problems of the configuration with another array."""
    return problems(merged(PAPER, {**copy.deepcopy(SECTIONS), "test_beams": {"first": array}}))


def test_counts_need_no_crack_lengths_and_may_stand_beside_them():
    assert of_array(COUNTED) == ()
    assert of_array(ARRAY | {"stuck": COUNTS}) == ()


@pytest.mark.parametrize(
    ("array", "key", "words"),
    [
        ({**COUNTED, "stuck": [COUNTS[0] | {"stuck": 21}]}, "stuck[0].stuck", "no more than there are beams"),
        ({**COUNTED, "stuck": [COUNTS[0] | {"length_um": 20}]}, "stuck[0].length_um", "in µm, above the thickness and"),
        ({**COUNTED, "stuck": COUNTS * 2}, "stuck", "beams of 300 µm at RH 0.67 are listed twice"),
        (
            {**COUNTED, "stuck": [COUNTS[0] | {"humidity": 0.2}]},
            "stuck[0].humidity",
            "must be at least 0.2903: in drier",
        ),
        (ARRAY | {"stuck": [COUNTS[0] | {"humidity": 0.2}]}, "stuck[0].humidity", "must be at least 0.2903: in drier"),
        ({**COUNTED, "stuck": [COUNTS[0] | {"of": 0}]}, "stuck[0].of", "at least 1"),
        (
            {key: COUNTED[key] for key in COUNTED if key != "stuck"},
            "pair",
            "must come with crack_lengths, stuck or file",
        ),
        ({key: ARRAY[key] for key in ARRAY if key != "length_um"}, "crack_lengths", "must come with length_um"),
    ],
)
def test_counts_that_cannot_be_are_refused_in_one_sentence(array, key, words):
    (problem,) = of_array(array)
    assert problem.startswith(f"test_beams.first.{key} is ")
    assert words in problem


def test_counts_have_budgets_of_beams_and_tips_on_the_contacts_of_the_device():
    graph = Graph(Plan(load(merged(SECTIONS, {"test_beams": {"first": {"stuck": COUNTS, "thickness_um": 2.6}}}))))
    inputs = graph.job("devices/test_beams/C1").inputs
    assert set(inputs["test_beams"]) == {("first", 0.44), ("first", 0.67), ("first", 0.67, "tip")}
    tips = [graph.job(f"devices/{name}_rh067_tip") for name in ("budget/C1", "test_beams/budget/first")]
    assert tips[1].settings["budget"]["share"] == 0.5
    assert tips[0].inputs["contact"] == tips[1].inputs["contact"] == inputs["tips"]["first", "humid"]
    assert tips[0].inputs["less"] == tips[1].inputs["less"] != {}
    assert inputs["grounds"]["first", "humid"] == graph.job("devices/budget/C1_rh067").inputs["contact"]
    assert Graph(PLAN).job("devices/test_beams/C1").inputs["grounds"] == {}
    of_device = graph.job("devices/safe_lengths/C1_rh067").inputs["model_error"]
    assert inputs["changes"] == {"first": of_device}, "tips of both have the same changes"


@pytest.mark.parametrize(
    "kind", [{"stuck": [COUNTS[0] | {"humidity": "dry"}]}, {"crack_lengths": [DATA[0] | {"humidity": "dry"}]}]
)
def test_test_beams_in_dry_air_need_attraction_across_gaps_and_have_no_uncertain_humidity(kind):
    array = {key: value for key, value in ARRAY.items() if key != "crack_lengths"} | kind
    config = SECTIONS | {"test_beams": {"first": array}}
    (problem,) = problems(merged(PAPER, config | {"attraction": {"reach": "touching"}}))
    assert problem.startswith("attraction.reach is 'touching', must be all for pair b, in dry air")
    assert "[0].humidity = 'dry')" in problem
    across = Plan(load(config))
    assert "humidity" in across.config["devices"]["C1"]["uncertainty"]
    assert "humidity" not in across.with_test_beams.config["devices"]["first"]["uncertainty"]
    mixed = config | {"test_beams": {"first": array | {"stuck": [COUNTS[0], COUNTS[0] | {"humidity": "dry"}]}}}
    assert problems(merged(PAPER, mixed)) == ()


def test_tips_of_counted_beams_are_drawn_with_their_own_slopes():
    thin = Plan(load(merged(SECTIONS, {"test_beams": {"first": {"stuck": COUNTS}}})))
    tips = thin.with_test_beams.devices.tips("first")
    assert tips != thin.devices.tips("C1")
    assert thin.devices.tilt(tips)["slopes"] == list(thin.with_test_beams.devices._slopes("first"))
    with pytest.raises(KeyError, match="no device has tips"):
        PLAN.devices.tilt(tips)  # beams that were not counted need no tips


def test_what_is_shared_has_one_uncertainty():
    other = {"C3": SECTIONS["devices"]["C1"] | {"uncertainty": STATED | {"humidity": 0.02}}}
    found = problems(merged(PAPER, merged(SECTIONS, {"devices": other})))
    assert [line.partition(" is ")[0] for line in found] == ["devices.C1.test_beams", "devices.C3.test_beams"]
    assert all("which states other uncertainties" in line for line in found)
    own = {"C3": SECTIONS["devices"]["C1"] | {"uncertainty": STATED | {"thickness_um": 0.1}}}
    assert problems(merged(PAPER, merged(SECTIONS, {"devices": own}))) == ()


def test_materials_of_test_beams_are_those_of_the_device():
    glass = {"materials": {"Glass": {"young_modulus_GPa": 70}}, "surfaces": {"B1": {"material": "Glass"}}}
    changed = merged(SECTIONS, glass | {"test_beams": {"first": {"pair": "a"}}})
    found = problems(merged(PAPER, changed))
    assert any(line.startswith("devices.C1.test_beams is ['first'], must have the materials of the") for line in found)


def test_test_beams_share_all_inputs_with_their_device_but_the_dimensions():
    found = job_settings(PLAN, "devices/test_beams/budget/first_rh044")["budget"]
    shared = {key: value for key, value in STATED.items() if key != "thickness_um"}
    assert found["uncertainty"] == shared | {"gap_um": 0.3}
    assert (found["device"]["thickness_um"], found["humidity"]) == (2, 0.44)


def test_contacts_of_test_beams_and_device_are_the_same_and_drawn_once():
    graph = Graph(PLAN)
    of_device, of_beams = (
        graph.job(name).inputs for name in ("devices/budget/C1_rh067", "devices/test_beams/budget/first_rh067")
    )
    assert of_beams["contact"] == of_device["contact"]
    for side in ("less", "more", "properties_less", "properties_more"):
        assert of_beams[side] == of_device[side] != {}
    assert of_beams["choices"] == {}


def test_bridges_and_stoppers_use_test_beams_as_well():
    stated = {key: value for key, value in STATED.items() if key != "thickness_um"}
    stopper = {"kind": "stopper", "pair": "b", "contact_um": [5, 5], "restoring_force_uN": 30, "humidities": [0.67]}
    bridge = C1 | {"kind": "bridge", "residual_stress_MPa": 50}
    others = {"R1": bridge, "S1": stopper}
    devices = {name: one | {"uncertainty": stated, "test_beams": ["first"]} for name, one in others.items()}
    graph = Graph(Plan(load(merged(SECTIONS, {"devices": devices}))))
    assert graph.job("devices/test_beams/S1").inputs["predicted"] == "devices/stoppers/S1"
    assert set(graph.job("devices/test_beams/R1").inputs["predicted"]) == {0.67}
    for name in devices:
        assert graph.job(f"devices/{name}.html").inputs["test_beams"] == f"devices/test_beams/rerun/{name}"
        assert set(graph.job(f"devices/test_beams/{name}").inputs["budgets"]) == {(name, 0.67)}


def test_only_devices_with_test_beams_have_them_in_their_jobs():
    graph = Graph(PLAN)
    assert "test_beams" in graph.job("devices/C1.html").inputs
    assert "test_beams" not in graph.job("devices/C2.html").inputs
    assert PLAN.devices.with_test_beams == ["C1"]
    assert set(graph.job("devices/test_beams/C1").inputs["test_beams"]) == {("first", 0.44), ("first", 0.67)}


def test_the_example_has_the_crack_lengths_that_the_paper_measured():
    config = load(Path(__file__).parents[2] / "examples" / "test_beams.yaml")
    table = published.read(published.file("table_3"))
    for pair in "abc":
        rows = table[table.pair == pair]
        array = config["test_beams"][f"paper{pair.upper()}"]
        found = [[datum[key] for datum in array["crack_lengths"]] for key in ("humidity", "mean_um", "std_um")]
        assert found == [rows[key].tolist() for key in ("relative_humidity", "experiment", "experiment_std")]
        assert array["gap_um"] == config["pairs"][pair]["gap_um"]

"""Values of one key side by side: every copy has the settings of the configuration with this single value."""

import json
import math
import re

import pytest
import yaml

from stiction.config import merging
from stiction.config.files import load
from stiction.config.messages import ConfigError
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.5]}
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.5]}
ARRAY = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "length_um": 1500}
ARRAY |= {"crack_lengths": [{"humidity": 0.5, "mean_um": 900, "std_um": 30, "beams": 9}]}
BASE = {
    "run": {"pairs": ["a", "b"]},
    "materials": {"Oxide": {"young_modulus_GPa": 70}},
    "surfaces": {"Sub1": {"material": "Oxide"}},
    "test_beams": {"T": ARRAY},
    "devices": {"S1": S1, "C1": C1 | {"test_beams": ["T"], "uncertainty": {"humidity": 0.01}}},
}
SECTIONS = ("materials", "surfaces", "pairs", "test_beams", "devices")
#: Compared key, two of its values, and the end of the copies of the second.
KEYS = {
    "surfaces.B2.rms_nm": (3, 4.5, "Rms4p5"),
    "surfaces.B2.published_psd.corner_rad_per_um": (16, 18, "Corner18"),
    "materials.Oxide.young_modulus_GPa": (60, 80, "YoungModulus80"),
    "pairs.b.gap_um": (10, 12, "Gap12"),
    "devices.C1.thickness_um": (2, 3, "Thickness3"),
}


def single(path, value):
    """Configuration with one value of a key."""
    change = value
    for key in reversed(path.split(".")):
        change = {key: change}
    return load(BASE, change)


def settings(config, end=""):
    """Settings of jobs about pair b and the devices, as text without an end of names."""
    graph = Graph(Plan(config))
    names = [f"heights/B2{end}", f"forces/b{end}_rh067_NG", f"beams/b{end}_rh067_GEO", f"devices/stoppers/S1{end}"]
    names += [f"devices/safe_lengths/C1{end}_rh050", f"devices/budget/C1{end}_rh050", f"devices/test_beams/C1{end}"]
    return [json.dumps(graph.job(name).settings, sort_keys=True).replace(end or "?", "") for name in names]


@pytest.mark.parametrize("path", KEYS)
def test_copies_are_the_entries_of_single_values(path):
    first, second, end = KEYS[path]
    found, alone = load(BASE, {"compare": {path: [first, second]}}), single(path, second)
    copies = {
        (section, name.removesuffix(end)): json.loads(json.dumps(entry).replace(end, ""))
        for section in SECTIONS
        for name, entry in found[section].items()
        if name.endswith(end)
    }
    assert copies
    assert copies == {(section, name): alone[section][name] for section, name in copies}
    other = single(path, first)
    assert any(copies[section, name] != other[section][name] for section, name in copies)


#: Keys of one surface, and of both surfaces of a pair, that change together.
TOGETHER = [
    {"surfaces.B2.skewness": [-0.5, 0], "surfaces.B2.kurtosis": [3.4, 3]},
    {"surfaces.B2.rms_nm": [3, 4], "surfaces.Sub1.rms_nm": [0.3, 0.2]},
]


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("compare", [dict(sorted(keys.items(), reverse=way)) for keys in TOGETHER for way in (0, 1)])
def test_keys_that_change_together_make_one_copy_for_each_place_of_their_lists(compare, number):
    found = load(BASE, {"compare": compare})
    end, alone = list(merging.values(found))[number], BASE
    for path, listed in compare.items():
        section, name, key = path.split(".")
        alone = merging.merged(alone, {section: {name: {key: listed[number]}}})
    assert settings(found, end) == settings(load(alone))
    assert {pair for pair in found["run"]["pairs"] if pair[0] == "b"} == {f"b{end}" for end in merging.values(found)}


@pytest.mark.parametrize(
    ("compare", "message"),
    [
        (
            {"surfaces.B2.skewness": [0, -0.5], "surfaces.B2.kurtosis": [3, 3.4, 3.9]},
            "must list as many values of .*kurtosis",
        ),
        ({"surfaces.B2.skewness": [0, 0], "surfaces.B2.kurtosis": [3, 3]}, "must list each copy once; 3, 0 is|0, 3 is"),
        ({"surfaces.B2.rms_nm": [2, 2]}, "must list each copy once; 2 is listed twice"),
    ],
)
def test_values_that_make_no_different_copies_are_refused(compare, message):
    with pytest.raises(ConfigError, match=f"^compare is .*({message})"):
        load(BASE, {"compare": compare})


def test_jobs_of_copies_have_the_settings_of_single_values():
    path = "surfaces.B2.rms_nm"
    found = load(BASE, {"compare": {path: [3, 4.5]}})
    assert settings(found, "Rms4p5") == settings(single(path, 4.5))
    assert settings(found, "Rms3") == settings(single(path, 3))
    assert settings(found, "Rms3") != settings(single(path, 4.5))


def test_copies_take_the_place_of_what_runs_and_of_nothing_else():
    found = load(BASE, {"compare": {"surfaces.B2.rms_nm": [3, 4.5]}})
    assert found["run"]["pairs"] == ["a", "bRms3", "bRms4p5"]
    assert sorted(found["devices"]) == ["C1Rms3", "C1Rms4p5", "S1Rms3", "S1Rms4p5"]
    assert found["studies"]["plasticity"]["distance_nm"]["bRms3"] == found["studies"]["plasticity"]["distance_nm"]["b"]
    of_device = load(BASE, {"compare": {"devices.C1.thickness_um": [2, 3]}})
    assert of_device["run"]["pairs"] == ["a", "b"]
    assert sorted(of_device["devices"]) == ["C1Thickness2", "C1Thickness3", "S1"]


@pytest.mark.parametrize(
    ("path", "entries"),
    [
        ("run.pairs.b", "materials.NAME.KEY with NAME Oxide; surfaces.NAME.KEY with NAME B1 or .*; devices.NAME.KEY"),
        ("surfaces.B9.rms_nm", "surfaces.NAME.KEY with NAME B1 or B2 or [^;]*$"),
        ("devices.C9.gap_um", "devices.NAME.KEY with NAME S1 or C1$"),
    ],
)
def test_a_key_of_no_entry_is_refused_with_the_names_of_entries(path, entries):
    with pytest.raises(ConfigError, match=f"^compare.{path} is no key of an entry that exists, must be {entries}"):
        load(BASE, {"compare": {path: [1, 2]}})


@pytest.mark.parametrize("path", ["beam.thickness_um", "devices.C1", "seed"])
def test_a_key_that_is_not_below_an_entry_is_refused_with_an_example(path):
    with pytest.raises(ConfigError, match=f"^compare.'?{path}'? is no key, must be the section, the name of an entry"):
        load(BASE, {"compare": {path: [1, 2]}})


@pytest.mark.parametrize("listed", [[1, 2], 5, None])
def test_a_key_with_other_signs_is_refused_once_with_an_example(listed):
    with pytest.raises(ConfigError) as refused:
        load(BASE, {"compare": {"surfaces.B2.rms-nm": listed}})
    lines = str(refused.value).splitlines()
    assert sum("is no key, must be the section" in line and line.endswith("surfaces.B2.rms_nm") for line in lines) == 1
    assert not [line for line in lines if "B2Rms" in line or "letters" in line]


@pytest.mark.parametrize("compare", [[1], {}, {"surfaces.B2.rms_nm": [1]}, {"surfaces.B2.rms_nm": [2, 2]}])
def test_what_is_no_list_of_different_values_is_refused(compare):
    with pytest.raises(ConfigError, match="^compare"):
        load(BASE, {"compare": compare})


#: What a list of compared values may not be, and how the refusal of the list or of the value says so.
FEW = "must be a list with at least 2 entries: different values"
WRONG = [
    (5, f"is 5, {FEW}.*; several values are wanted, as in \\[3, 5, 7\\]$"),
    (None, f"is None, {FEW}.*; there is no value after the key$"),
    ([], f"is \\[\\], {FEW}.*\\[unit of the key\\]$"),
    ([3], f"is \\[3\\], {FEW}.*\\[unit of the key\\]$"),
    *(([3, value], "must be a number") for value in ("a", None, True, [4], math.nan)),
]


@pytest.mark.parametrize(("listed", "refusal"), WRONG)
def test_a_list_that_is_refused_is_the_only_problem_and_says_what_to_write(listed, refusal):
    with pytest.raises(ConfigError) as refused:
        load(BASE, {"compare": {"surfaces.B2.rms_nm": listed}})
    (problem,) = str(refused.value).splitlines()
    assert re.match(rf"compare\.'surfaces\.B2\.rms_nm'(\[1\])? .*{refusal}", problem)


def test_without_the_section_nothing_changes():
    config = load(BASE)
    assert merging.expanded(config) is config


OWN = {
    "surfaces.B2Rms3": {"rms_nm": 7},
    "materials.OxideRms3": {"young_modulus_GPa": 60},
    "pairs.bRms3": {"beam": "B2", "substrate": "Sub1", "gap_um": 3, "humidities": [0.5]},
    "test_beams.TRms3": ARRAY,
    "devices.S1Rms3": S1 | {"restoring_force_uN": 30},
    "studies.plasticity.distance_nm.bRms3": 4,
}


@pytest.mark.parametrize("name", OWN)
def test_an_entry_that_has_the_name_of_a_copy_is_refused_and_not_replaced(name):
    own = OWN[name]
    for part in reversed(name.split(".")):
        own = {part: own}
    compared = {"compare": {"surfaces.B2.rms_nm": [3, 5]}}
    if name == "materials.OxideRms3":  # no copy of a material is made
        assert merging.expanded(merging.merged(single("seed", 1), merging.merged(own, compared)))
        return
    with pytest.raises(ConfigError) as error:
        load(BASE, own, compared)
    assert error.value.problems == (
        f"{name} must have another name: compare.surfaces.B2.rms_nm makes a copy of this name",
    )


def test_copies_that_are_there_already_are_those_of_the_same_key():
    found = load(BASE, {"compare": {"surfaces.B2.rms_nm": [3, 5]}})
    assert load(found) == found


MALFORMED = ["studies: [1]", "studies: {plasticity: 5}", "studies: {plasticity: {distance_nm: [1]}}", "devices: 5"]
MALFORMED += [
    "pairs: 5",
    "pairs: {5: {beam: B2}}",
    "pairs: {b: [B2]}",
    "run: 5",
    "run: {pairs: [{}, 1]}",
    "materials: [1]",
]
MALFORMED += [
    "surfaces: {5: {material: Oxide}}",
    "devices: {5: {pair: b}}",
    "devices: {S: {pair: [b]}}",
    "run: {pairs: b}",
]


@pytest.mark.parametrize("wrong", MALFORMED)
def test_copies_hide_nothing_that_is_wrong(wrong):
    wrong, compared = yaml.safe_load(wrong), {"compare": {"surfaces.B2.rms_nm": [3, 5]}}
    (key,) = wrong
    with pytest.raises(ConfigError) as alone:
        load(wrong)
    with pytest.raises(ConfigError) as beside:
        load(wrong, compared)
    assert alone.value.problems[0].startswith(key)
    assert alone.value.problems[0] in [line.replace("Rms3", "") for line in beside.value.problems]

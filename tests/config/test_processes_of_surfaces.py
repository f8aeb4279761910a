"""Bad processes are refused in one sentence with the key, and what a setting leaves open is that of its surface."""

import numpy as np
import pytest
from written_scans import write

import stiction
from stiction.config.keys import Keys
from stiction.config.surfaces import process, process_relations

STATED = {"rms_nm": 3.0, "uncertainty": {"rms_nm": 0.1}}
SETTINGS = [{"value": value} | STATED for value in (30, 60, 90)]
ETCH = {"variable": "etch_time_s", "surface": "B2", "settings": SETTINGS}
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 8, "humidities": [0.6]}
BUMP |= {"requirement": {"share": 0.05}, "process": "etch"}
RUN = {"run": {"pairs": [], "studies": []}, "devices": {"Bump": BUMP}}


def problems(*overlays, **changed):
    """Problems of a configuration with a changed process."""
    try:
        stiction.load(RUN, {"process": {"etch": ETCH | changed}}, *overlays)
    except stiction.ConfigError as error:
        return error.problems
    return ()


def with_setting(number, **changed):
    """Settings, one of them changed."""
    return [one | changed if k == number else one for k, one in enumerate(SETTINGS)]


def test_a_process_without_unit_is_refused_by_its_relations_alone():
    config = stiction.load(RUN, {"process": {"etch": ETCH}})
    config["process"]["etch"]["variable"] = "etch_time"
    (found,) = process_relations.relation.problems(Keys(config))
    assert "must end in its unit" in str(found)


def test_a_good_process_is_accepted():
    assert problems() == ()
    numbers = {"rms_nm": 3.0, "skewness": -0.5, "kurtosis": 3.4, "corner_rad_per_um": 15, "hurst": 0.9}
    errors = {"uncertainty": {key: abs(one) / 50 for key, one in numbers.items()}}
    assert problems(settings=[{"value": value} | numbers | errors for value in (1, 2)]) == ()


#: Moments that no heights have.
NO_HEIGHTS = {"skewness": 0.0, "kurtosis": 9.0, "uncertainty": {"rms_nm": 0.1, "skewness": 0.1, "kurtosis": 1}}
#: Changes of the process, and begin and part of the only problem.
BAD = {
    "one setting": ({"settings": SETTINGS[:1]}, "process.etch.settings[0].value is 30", "at least two settings"),
    "equal values": ({"settings": with_setting(2, value=30)}, "process.etch.settings[2].value is 30", "must differ"),
    "no unit": ({"variable": "etch_time"}, "process.etch.variable is 'etch_time'", "must end in its unit"),
    "value with unit": (
        {"settings": with_setting(1, value="60 s")},
        "process.etch.settings[1].value is '60 s'",
        "number",
    ),
    "no numbers": (
        {"settings": [*SETTINGS[:2], {"value": 90}]},
        "process.etch.settings[2].value is 90",
        "must come with scans, or with some of rms_nm",
    ),
    "no error": (
        {"settings": [*SETTINGS[:2], {"value": 90, "rms_nm": 4}]},
        "process.etch.settings[2].value is 90",
        "uncertainty: {rms_nm: ...} is missing",
    ),
    "error of nothing": (
        {"settings": with_setting(1, uncertainty={"rms_nm": 0.1, "hurst": 0.1})},
        "process.etch.settings[1].value is 60",
        "must come with hurst, of which it states an uncertainty",
    ),
    "skewness alone": (
        {"settings": with_setting(1, skewness=-0.5, uncertainty={"rms_nm": 0.1, "skewness": 0.1})},
        "process.etch.settings[1].value is 60",
        "skewness and kurtosis or without both",
    ),
    "other numbers": (
        {"settings": with_setting(1, hurst=0.8, uncertainty={"rms_nm": 0.1, "hurst": 0.1})},
        "process.etch.settings[1].value is 60",
        "what the first setting states, rms_nm; it has rms_nm, hurst",
    ),
    "unknown surface": ({"surface": "B7"}, "process.etch.surface is 'B7'", "must be one of B1, B2"),
    "surface of a setting": ({"surface": "etch-1"}, "process.etch.surface is 'etch-1'", "must be one of B1, B2"),
    "several surfaces": ({"surface": ["B2"]}, "process.etch.surface is ['B2']", "must be text"),
    "surface of no pair": ({"surface": "B1"}, "devices.Bump.process is 'etch'", "a surface of pair b, B2 or Sub1"),
    "wrong unit": ({"settings": with_setting(1, rms_nm=3e-9)}, "process.etch.settings[1].rms_nm is 3e-09", "0.001"),
    "no such heights": (
        {"settings": [one | NO_HEIGHTS for one in SETTINGS]},
        "process.etch.settings[0].kurtosis is 9.0",
        "",
    ),
}


@pytest.mark.parametrize(("changed", "begin", "part"), BAD.values(), ids=BAD)
def test_a_bad_process_is_refused_in_one_sentence(changed, begin, part):
    first, *more = problems(**changed)
    assert first.startswith(begin)
    assert part in first
    assert "etch-" not in first.replace("is 'etch-1'", "")
    assert more == [] or "kurtosis" in first


def test_a_device_names_a_process_that_exists_and_what_it_requires():
    (unknown,) = problems({"devices": {"Bump": {"process": "etsh"}}})
    assert unknown.startswith("devices.Bump.process is 'etsh', must be one of etch; did you mean etch?")
    alone = BUMP | {"process": "etch"}
    del alone["requirement"]
    with pytest.raises(stiction.ConfigError, match="devices.Bump.process is 'etch', must come with requirement"):
        stiction.load(RUN | {"devices": {"Bump": alone}}, {"process": {"etch": ETCH}})


@pytest.mark.parametrize(
    ("polish", "part"),
    [
        ({}, ""),
        ({"variable": "polish_time_s"}, "the same variable, in the same unit"),
        ({"variable": "etch_time_min"}, "the same variable, in the same unit"),
        ({"surface": "B2"}, "makes another surface"),
        ({"together_with": "polish"}, "must be one of etch"),
        ({"settings": [one | {"value": one["value"] + 60} for one in SETTINGS]}, "settings in a common range"),
    ],
)
def test_processes_at_the_same_time_have_one_variable_and_two_surfaces(polish, part):
    smooth = [one | {"rms_nm": 0.3, "uncertainty": {"rms_nm": 0.01}} for one in SETTINGS]
    both = {"process": {"polish": ETCH | {"surface": "Sub1", "settings": smooth, "together_with": "etch"} | polish}}
    found = problems(both)
    assert len(found) == bool(part)
    assert all(one.startswith("process.polish.together_with is ") and part in one for one in found)


SMOOTH = [one | {"rms_nm": 0.3, "uncertainty": {"rms_nm": 0.01}} for one in SETTINGS]
DEPOSITION = {"variable": "deposition_time_min", "surface": "Sub1", "settings": SMOOTH}


@pytest.mark.parametrize(
    ("changed", "second", "part"),
    [
        ({}, "deposition", ""),
        ({}, "etch", "must be one of deposition"),
        ({}, "depositon", "must be one of deposition; did you mean deposition?"),
        ({"surface": "B2"}, "deposition", "the other surface of pair b, beside B2 (given process.deposition.surface"),
        ({"surface": "B1"}, "deposition", "the other surface of pair b, beside B2 (given process.deposition.surface"),
        (
            {"variable": "etch_time_s"},
            "deposition",
            "with the same one, state together_with: etch in process.deposition",
        ),
    ],
)
def test_a_second_process_has_another_variable_and_makes_the_other_surface(changed, second, part):
    found = problems({"process": {"deposition": DEPOSITION | changed}, "devices": {"Bump": {"second_process": second}}})
    assert len(found) == bool(part)
    assert all(one.startswith(f"devices.Bump.second_process is '{second}'") and part in one for one in found)


def test_a_second_process_is_beside_a_first_one_and_no_other_at_the_same_time():
    together = ETCH | {"surface": "Sub1", "settings": SMOOTH, "together_with": "etch"}
    twice = {"process": {"deposition": DEPOSITION, "polish": together}}
    (found,) = problems(twice, {"devices": {"Bump": {"second_process": "deposition"}}})
    assert "must be left out, where process polish makes the other surface together with etch" in found
    alone = {name: value for name, value in BUMP.items() if name not in ("process", "requirement")}
    with pytest.raises(stiction.ConfigError, match="second_process is 'deposition', must come with process"):
        stiction.load(
            RUN | {"devices": {"Bump": alone | {"second_process": "deposition"}}},
            {"process": {"deposition": DEPOSITION}},
        )


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """Folder with four scans of heights of 3 nm."""
    folder, rng = tmp_path_factory.mktemp("scans"), np.random.default_rng(1)
    for number in range(4):
        write(folder / f"{number}.x3p", 3e-9 * rng.standard_normal((64, 64)), (1e-6, 1e-6))
    return folder


@pytest.mark.slow
def test_a_scan_is_of_one_setting_and_of_one_surface(scans):
    files = [str(scans / f"{number}.x3p") for number in range(4)]
    settings = [{"value": value, "scans": [file]} for value, file in zip((30, 60, 90), files, strict=False)]
    twice = problems(settings=[*settings[:2], {"value": 90, "scans": files[1:2]}])
    assert sum("must be a scan of one setting and of one surface" in one for one in twice) == 1
    other = {"surfaces": {"Mine": {"scans": {"files": files[:1]}}}}
    (shared, *_) = [one for one in problems(other, settings=settings) if "one surface" in one]
    assert shared.startswith("process.etch.settings[0].scans[0] is ")
    assert "surfaces.Mine.scans.files" in shared


def test_a_missing_scan_is_reported_at_its_setting():
    settings = [{"value": value, "scans": [f"/nowhere/{value}.x3p"]} for value in (30, 60)]
    found = problems(settings=settings)
    assert [one.partition(" is ")[0] for one in found] == [f"process.etch.settings[{k}].scans[0]" for k in range(2)]
    assert all("cannot be opened" in one for one in found)


def test_files_of_scans_are_relative_to_the_configuration(tmp_path):
    (tmp_path / "mine.yaml").write_text(
        "process: {etch: {variable: etch_time_s, surface: B2, settings: [{value: 30, scans: [a.x3p]}]}}"
    )
    found = stiction.config.files.read_located(tmp_path / "mine.yaml")
    assert found["process"]["etch"]["settings"][0]["scans"] == [str(tmp_path / "a.x3p")]


def test_a_setting_is_as_its_surface_apart_from_what_it_states():
    config = stiction.load(RUN, {"process": {"etch": ETCH}})
    made, given = (config["surfaces"][name] for name in ("etch-2", "B2"))
    assert made == given | STATED
    assert process.names(config, "etch") == ["etch-1", "etch-2", "etch-3"]
    corner = [
        one | {"corner_rad_per_um": 15, "uncertainty": {"rms_nm": 0.1, "corner_rad_per_um": 1}} for one in SETTINGS
    ]
    bent = stiction.load(RUN, {"process": {"etch": ETCH | {"settings": corner}}})["surfaces"]["etch-1"]["published_psd"]
    assert bent["corner_rad_per_um"] == 15
    slope = np.log(bent["floor_nm4"] / bent["plateau_nm4"]) / np.log(bent["cutoff_rad_per_um"] / 15)
    old = given["published_psd"]
    ratio = old["cutoff_rad_per_um"] / old["corner_rad_per_um"]
    np.testing.assert_allclose(slope, np.log(old["floor_nm4"] / old["plateau_nm4"]) / np.log(ratio))


def test_a_surface_with_the_name_of_a_setting_is_refused():
    mine = {"surfaces": {"etch-1": {"like": "B2", "rms_nm": 3}}}
    with pytest.raises(stiction.ConfigError, match="surfaces.etch-1 must have another name"):
        stiction.load(RUN, mine, {"process": {"etch": ETCH}})


def test_compared_surfaces_have_processes_of_their_own():
    compared = {"compare": {"surfaces.B2.skewness": [-0.5, -0.7]}}
    config = stiction.load(RUN, {"process": {"etch": ETCH}}, compared)
    for end, skewness in (("Skewnessm0p5", -0.5), ("Skewnessm0p7", -0.7)):
        assert config["devices"][f"Bump{end}"]["process"] == f"etch{end}"
        assert config["process"][f"etch{end}"]["surface"] == f"B2{end}"
        assert config["surfaces"][f"etch{end}-1"]["skewness"] == skewness

"""Devices of a spreadsheet: the same as in the configuration, and what is wrong with a cell, in one sentence."""

import copy
import csv
import io

import numpy as np
import pytest
import yaml
from configurations import ROOT
from snakemake.utils import update_config

from stiction.config import files
from stiction.config.merging import merged, without_inherited
from stiction.config.messages import ConfigError
from stiction.config.reading import paper
from stiction.config.tables import device_table
from stiction.config.validation import checked
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

STUDY = {
    "run": {"pairs": [], "studies": []},
    "pairs": {"mine": {"beam": "B2", "substrate": "Sub1", "gap_um": 20, "humidities": [0.45, 0.6]}},
}
#: Keys beside the file.
SHARED = {"kind": "cantilever", "pair": "mine", "humidities": [0.45, 0.6], "uncertainty": {"thickness_um": 0.1}}
LINES = ["name,length_um,width_um,thickness_um,gap_um", "L1,250,30,2.6,20", "L2,200,30,2,20", "L3,150,20,2,2"]


@pytest.fixture
def study(tmp_path):
    """Configuration file with devices in a CSV file of these lines, or bytes, and keys beside the file."""

    def written(*lines, content=None, **beside):
        config = STUDY | {"devices": {"file": "range.csv"} | SHARED | beside}
        (tmp_path / "study.yaml").write_text(yaml.safe_dump(config))
        (tmp_path / "range.csv").write_bytes("\n".join(lines).encode() if content is None else content)
        return tmp_path / "study.yaml"

    return written


def drawn(number):
    """Devices with values that differ, in a random order, and the keys that a row of each has."""
    rng = np.random.default_rng([74, number])
    devices = {}
    for k in rng.permutation(int(rng.integers(1, 9))):
        device = {
            "length_um": float(np.round(rng.uniform(30, 900), int(rng.integers(0, 4)))),
            "width_um": int(rng.choice([10, 20, 30])),
            "thickness_um": float(rng.choice([2, 2.6, 3.05])),
            "gap_um": int(rng.choice([2, 20])),
            "touchdowns": int(rng.integers(1, 10**6)),
            "humidities": [0.45] if rng.uniform() < 0.5 else [0.45, "dry", 0.6],
            "uncertainty": {"gap_um": 0.1, "thickness_um": float(rng.choice([0.01, 1e-3]))},
        }
        left_out = rng.choice(["touchdowns", "humidities", "uncertainty", ""])
        devices[f"L{k}"] = {key: value for key, value in device.items() if key != left_out}
    return devices


def as_csv(devices):
    """Devices as a spreadsheet writes them: a column for each key of any of them, empty where a device has none."""
    flat = {
        name: {
            **{key: value for key, value in device.items() if key != "uncertainty"},
            **{f"uncertainty.{key}": value for key, value in device.get("uncertainty", {}).items()},
        }
        for name, device in devices.items()
    }
    columns = sorted({key for device in flat.values() for key in device}, reverse=True)
    table = csv.DictWriter(text := io.StringIO(), ["gap_um", "name", *(key for key in columns if key != "gap_um")])
    table.writeheader()
    for name, device in flat.items():
        cells = {key: " ".join(map(str, value)) if isinstance(value, list) else value for key, value in device.items()}
        table.writerow({"name": name} | cells)
    return text.getvalue()


@pytest.mark.parametrize("number", range(8))
def test_devices_of_a_table_are_those_of_the_configuration(study, number):
    devices = drawn(number)
    found = files.load(study(content=as_csv(devices).encode("utf-8-sig")))
    assert found["design"].pop("order") == list(devices)
    stated = {name: merged(SHARED, device) for name, device in devices.items()}
    assert found == files.load(STUDY | {"devices": stated})


def test_an_overlay_changes_a_row_adds_a_device_and_what_rows_share(study, tmp_path):
    path = study("# from the mask", *LINES, "", ",,,,")
    overlay = {"L1": {"length_um": 260}, "extra": SHARED | {"width_um": 30, "thickness_um": 2, "gap_um": 2}}
    found = files.load(path, {"devices": overlay | {"humidities": [0.6]}})
    assert {name: device["humidities"] for name, device in found["devices"].items()} == {
        "L1": [0.6], "L2": [0.6], "L3": [0.6], "extra": [0.45, 0.6]
    }  # fmt: skip
    assert found["devices"]["L1"]["length_um"] == 260
    assert Plan(found).devices.in_order == ["L1", "L2", "L3", "extra"]
    # the second route: all files merged by Snakemake, before their paths are resolved
    whole, changes = copy.deepcopy(paper()), yaml.safe_load(path.read_text())
    update_config(whole, copy.deepcopy(changes))
    update_config(whole, {"devices": overlay | {"humidities": [0.6]}})
    whole = without_inherited(whole, paper(), [changes])
    assert checked(device_table.with_rows(files.located(whole, changes, tmp_path))).config == found


def test_a_file_is_that_of_the_configuration_that_names_it(tmp_path):
    named, other = {"devices": {"file": "range.csv"}}, {"devices": {"file": "other.csv"}}
    assert device_table.in_folder(named, named, tmp_path)["devices"]["file"] == str(tmp_path / "range.csv")
    assert device_table.in_folder(other, named, tmp_path) == other
    for broken in ({}, {"devices": 5}, {"devices": {"file": 7}}, {"devices": {"file": {"kind": "stopper"}}}):
        assert device_table.with_rows(device_table.in_folder(broken, broken, tmp_path)) == broken


@pytest.mark.parametrize("name", ["On", "Off", "no", "null", "NaN", "e5"])
def test_names_are_text_whatever_yaml_would_read(study, name):
    assert list(files.load(study(LINES[0], f"{name},250,30,2.6,20"))["devices"]) == [name]


@pytest.mark.parametrize("name", ["007", "1e5", "Lever 1", "a,b", "L_dry", 33 * "L"])
def test_a_name_that_no_file_can_have_is_refused_as_it_is_written(study, name):
    with pytest.raises(ConfigError) as refused:
        files.load(study(LINES[0], LINES[1], f'"{name}",250,30,2.6,20'))
    (sentence,) = refused.value.problems
    assert sentence.startswith(f"devices.file is 'range.csv', row 3: name is {name!r}, which is not a valid name, must")


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([], "which is empty, must begin with the names of its columns: name,"),
        (LINES[:1], "which holds no device"),
        (["length_um,gap_um", "250,2"], "row 1: the columns are length_um, gap_um, must have name, each once"),
        (["name,gap_um,gap_um", "L1,2,2"], "each once"),
        (["name,length,gap_um", "L1,250,2"], "row 1: column 'length' is unknown, must be among name, kind, pair"),
        (["name,length,gap_um", "L1,250,2"], "; did you mean length_um?"),
        (["name,uncertainty", "L1,2"], "row 1: column 'uncertainty' is unknown"),
        (["name;length_um", "L1;250"], "; separate columns by commas"),
        ([*LINES, "L4,250,30,2,6,20"], "row 5: commas separate 6 values, must be 5, with points in decimal numbers"),
        ([*LINES, ",250,30,2,20"], "row 5: name is empty, must be the name of a device"),
        ([*LINES, "L2,250,30,2,20"], "row 5: name is 'L2' as in row 3, must differ"),
        ([*LINES, 'L4,250,30,"2,6",20'], "row 5: thickness_um is '2,6', must be a number at least 0.001"),
        ([*LINES, 'L4,250,30,"2,6",20'], "; write 2.6 without quotes, unit or decimal comma"),
        ([*LINES, "L4,250 nm,30,2.6,20"], "row 5: length_um is '250 nm', must be a number"),
        ([*LINES, "L4,nan,30,2.6,20"], "row 5: length_um is 'nan', must be a number"),
        ([*LINES, "L4,1e999,30,2.6,20"], "row 5: length_um is inf, must be a number"),
        ([*LINES, "L4,0,30,2.6,20", "L5,0,30,2.6,20"], "rows 5, 6: length_um is 0, must be a number at least 0.1"),
        ([*LINES, "L4,2,30,2.6,20"], "row 5: length_um is 2, must be in µm, above the thickness and the gap of the "),
        ([*LINES, "L4,250,30.001,2.6,20"], "row 5: width_um is 30.001, must be a whole number of contact points"),
        ([*LINES, "L4,250,30,,20"], "row 5: kind is 'cantilever', must come with thickness_um"),
        ([LINES[0] + ",kind", *(line + ",lever" for line in LINES[1:])], "rows 2 to 4: kind is 'lever', must be one"),
        ([LINES[0] + ",pair", *(line + ",1e5" for line in LINES[1:])], "rows 2 to 4: pair is '1e5', must be one of a"),
        ([LINES[0] + ",humidities", *(line + ",0.45 45" for line in LINES[1:])], "to 4: humidities[1] is 45, must be"),
        ([LINES[0] + ",touchdowns", *(line + ",1e3" for line in LINES[1:])], "touchdowns is 1000.0, must be a whole"),
        ([*LINES, "file,250,30,2.6,20"], "row 5: name is 'file', must differ from the key that names this file"),
        ([*LINES, 'L4,250,30,2.6,"20'], "row 5 of 17 characters cannot be read: unexpected end of data"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file_is_one_sentence_with_row_and_column(study, lines, words):
    with pytest.raises(ConfigError) as refused:
        files.load(study(*lines))
    (sentence,) = refused.value.problems
    assert sentence.startswith("devices.file is 'range.csv', ")
    assert words in sentence


def refused(path):
    """The only sentence that refuses a configuration."""
    with pytest.raises(ConfigError) as refusal:
        files.load(path)
    (sentence,) = refusal.value.problems
    return sentence


def test_what_is_wrong_beside_a_file_is_not_said_of_its_rows(study):
    assert refused(study(*LINES, humidities=[45])).startswith("devices.humidities[0] is 45, must be")
    assert refused(study(*LINES, uncertainty={"gap_um": -1})).startswith("devices.uncertainty.gap_um is -1, must be")
    assert refused(study(*LINES, L1={"length_um": 0})).startswith("devices.L1.length_um is 0, must be")
    assert refused(study(*LINES, L1=None)).startswith("devices.L1 is None, must be")
    too_wide = refused(study(*LINES, L1={"touchdowns": 3, "humidities": [45]}))
    assert too_wide.startswith("devices.L1.humidities[0] is 45, must be")
    of_one = study(LINES[0], "L1,0,30,2.6,20", L1={"touchdowns": 3})
    assert refused(of_one).startswith("devices.file is 'range.csv', row 2: length_um is 0"), "control: in the file"


def test_a_damaged_or_missing_file_is_named(study):
    path = study(content=b"name,length_um\nL1,\xff\n")
    for reason in ("line 2 holds a character that is not UTF-8", "No such file"):
        with pytest.raises(ConfigError, match=rf"^devices\.file is 'range\.csv', which cannot be read: {reason}"):
            files.load(path)
        path.with_name("range.csv").unlink(missing_ok=True)


def jobs(config):
    """Settings and inputs of all jobs for devices, by stage and wildcards."""
    decided = config | {"design": config["design"] | {"samples_of_patches": {}}}
    return {
        (job.stage.name, *sorted(vars(job.at).items())): (repr(job.settings), repr(dict(job.inputs)))
        for job in Graph(Plan(decided)).needed("devices")
    }


def test_a_changed_row_reruns_its_device_alone_and_a_changed_order_only_the_table(study):
    before = jobs(files.load(study(*LINES, humidities=[0.6])))

    def rerun(*lines, **beside):
        """Jobs with other settings or inputs than before."""
        now = jobs(files.load(study(*lines, humidities=[0.6], **beside)))
        return {job for job in {*before, *now} if before.get(job) != now.get(job)}

    longer = rerun(*LINES[:2], "L2,210,30,2,20", LINES[3])
    of_all = {job for job in longer if job[0] == "device_limits"}  # one page about the limits of all devices
    named = [wildcards[0][1] for _, *wildcards in longer - of_all]
    assert ("answer", ("device", "L2")) in longer
    assert {str(name).partition("_")[0] for name in named} == {"L2"}
    assert rerun(*LINES[:1], *LINES[:0:-1]) == {("table_devices",)}
    # the control: what rows share reruns all
    shared = rerun(*LINES, uncertainty={"thickness_um": 0.2})
    assert {("budget", ("case", f"{name}_rh060")) for name in ("L1", "L2", "L3")} <= shared


def test_the_example_has_devices_of_its_file_in_order():
    found = files.load(ROOT / "examples" / "range" / "mine.yaml")
    rows = (ROOT / "examples" / "range" / "range.csv").read_text().splitlines()[1:]
    assert found["design"]["order"] == [row.partition(",")[0] for row in rows]

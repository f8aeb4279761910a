"""Front page of the report: answers, links, checks, warnings and provenance of finished results."""

import copy
import json
import re
from pathlib import Path

import pytest
import yaml
from hostile import HOSTILE, MADE, Reading
from noted import noted, save_page

from stiction.command.front_page import answers, front_page, is_finished, pairs, provenance
from stiction.command.present import Present
from stiction.config.files import paper
from stiction.run.provenance import record

#: Part of Table III of two pairs.
TABLE = """pair,relative_humidity,model,crack_length_um,crack_length_std_um,share_s_shape,share_arc,share_free
b,0.67,G,1360,76,0.5,0.5,0
b,0.67,NG,685.68,16.284,0.98,0.02,0
b,0.88,NG,,,0,0.25,0.75
c,0.6,NG,501,10.2,1,0,0
"""


def finished(results, devices=(), **changes):
    """Files of a finished run of pairs b and c and some devices in a folder of results."""
    for folder in ("tables", "devices"):
        (results / folder).mkdir(parents=True, exist_ok=True)
    config = copy.deepcopy(paper()) | {"run": {"pairs": ["b", "c"]}, "devices": dict.fromkeys(devices, {})} | changes
    record(results / "provenance.json", results, config)
    (results / "verdict.txt").write_text("All 3 checks of the results passed.\n")
    save_page(results, noted("Too <dry> & {{ thin }}."))
    save_page(results / "devices", noted("Too long."), name="C1")
    (results / "tables" / "table_3.csv").write_text(TABLE)
    (results / "tables" / "table_3.html").touch()
    for name in devices:
        (results / "devices" / f"{name}.html").touch()
        (results / "devices" / f"{name}.txt").write_text(f"Build {name} no longer than 3 µm & more.\nAnd others.\n")
    return config


def test_the_answers_are_those_of_devices_and_of_the_beams_on_non_gaussian_surfaces(tmp_path):
    config = finished(tmp_path, ["C1", "S1"])
    assert list(answers(Present(tmp_path), config)) == [
        "Device C1: Build C1 no longer than 3 µm & more.",
        "Device S1: Build S1 no longer than 3 µm & more.",
    ]
    rows = [["b", "0.67", "98", "686 ± 16", "2"], ["b", "0.88", "0", "–", "25"], ["c", "0.6", "100", "501 ± 10", "0"]]
    assert [list(row.values()) for row in pairs(Present(tmp_path))] == rows
    assert Reading(front_page(tmp_path)).text["td"] == [cell for row in rows for cell in row]


def test_the_page_holds_verdict_warnings_provenance_and_what_differs_from_the_paper(tmp_path):
    config = finished(tmp_path, ["C1"], seed=7)
    config["surfaces"]["B2"] = {"scans": {"files": ["folder/mine.gwy"]}}
    record(tmp_path / "provenance.json", tmp_path, config)
    page = front_page(tmp_path)
    (version,) = re.findall(r"<li>(stiction [\d.]+), installed</li>", page)
    assert version
    for part in (
        "All 3 checks",
        "Too &lt;dry&gt; &amp; &#123;&#123; thin &#125;&#125;.",
        "C1: surface B2: Too long.",
        "the last of 2 runs",
        "seed: 7\n",
    ):
        assert part in page
    assert "Scans of B2: mine.gwy" in page
    assert "sampling:" not in page, "is that of the paper"
    assert "Not in the model" not in page.split("Provenance")[0]


def test_the_page_lists_files_that_git_does_not_know_apart_from_changed_ones():
    run = {"started": "2026-03-01T08:30:59+00:00", "versions": {}, "config": {"surfaces": {}}}
    run |= {"machine": dict.fromkeys(("system", "cpu", "cores"), "")}
    listed = list(provenance(run | {"git": {"commit": "abc", "changed": ["law.py"], "untracked": ["notes"]}}, 1))
    assert listed[1:4] == [
        "stiction, commit abc",
        "Files that are changed in its folder: law.py",
        "Files that are untracked in its folder: notes",
    ]


def test_what_is_shown_depends_on_the_configuration_and_not_on_files_of_other_runs(tmp_path):
    finished(tmp_path, ["C1"])
    assert "<li>Devices › C1: what to build</li>" in front_page(tmp_path)
    finished(tmp_path)
    page = front_page(tmp_path)
    assert "C1" not in page
    assert "<li>Tables › Table 3: crack lengths and adhesion energies</li>" in page
    finished(tmp_path, ["C1"], run={"pairs": []})
    page = front_page(tmp_path)
    assert "device C1" in page
    assert "Checks" not in page
    assert "Table 3" not in page


@pytest.mark.parametrize(("pairs", "needed"), [(["b"], "verdict.txt"), ([], "devices/warnings.md")])
def test_a_run_is_finished_when_all_that_its_configuration_names_is_there(tmp_path, pairs, needed):
    assert not is_finished(tmp_path)
    finished(tmp_path, ["C1"], run={"pairs": pairs})
    assert is_finished(tmp_path)
    (tmp_path / needed).unlink()
    assert not is_finished(tmp_path)


def filled(page):
    """The page as Snakemake makes it of a template in restructured text, and what is on it."""
    jinja2, core = (pytest.importorskip(name) for name in ("jinja2", "docutils.core"))
    environment = jinja2.Environment(trim_blocks=True, lstrip_blocks=True)
    html = core.publish_parts(environment.from_string(page).render(), writer="html")["html_body"]
    return html, Reading(html)


def test_indentation_survives_in_restructured_text(tmp_path):
    finished(tmp_path)
    html, shown = filled(front_page(tmp_path))
    assert any("{{ thin }}" in item for item in shown.text["li"])
    assert html.count("<h2>") == 6


def with_text(value, text):
    """A value of JSON in which every text is another one."""
    if isinstance(value, dict):
        return {key: with_text(inner, text) for key, inner in value.items()}
    if isinstance(value, list):
        return [with_text(inner, text) for inner in value]
    return text if isinstance(value, str) else value


def test_text_of_configurations_files_and_names_is_on_the_page_as_it_is(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where the hostile template would make a folder
    config = finished(tmp_path, ["C1"])
    config["surfaces"]["B2"] = {"scans": {"files": [HOSTILE], "channel": HOSTILE}}
    record(tmp_path / "provenance.json", tmp_path, config)
    runs = json.loads((tmp_path / "provenance.json").read_text())
    git = {"commit": HOSTILE, "changed": [HOSTILE], "untracked": [HOSTILE]}
    run = with_text(runs[-1] | {"git": git}, HOSTILE) | {"started": runs[-1]["started"]}
    (tmp_path / "provenance.json").write_text(json.dumps([*runs, run]))
    (tmp_path / "verdict.txt").write_text(HOSTILE)
    save_page(tmp_path, noted(HOSTILE), name=HOSTILE)
    (tmp_path / "devices" / "C1.txt").write_text(HOSTILE)
    _, shown = filled(front_page(tmp_path))
    assert not (tmp_path / MADE).exists()
    assert shown.code == []
    assert shown.text["h2"][0] == f"Results of pairs {HOSTILE}, {HOSTILE} and device C1"
    assert shown.text["p"][1:] == [HOSTILE, "Keys that differ from those of the paper:"]
    files = [f"Files that are {state} in its folder: {HOSTILE}" for state in ("changed", "untracked")]
    scans = f"Scans of B2: {Path(HOSTILE).name}"
    warned = f"{HOSTILE}: surface B2: {HOSTILE}"
    assert {f"Device C1: {HOSTILE}", warned, *files, scans} < {*shown.text["li"]}
    assert sum(HOSTILE in item for item in shown.text["li"]) == 4 + len(["commit", "machine", "libraries"])
    (written,) = shown.text["pre"]
    assert yaml.safe_load(written)["surfaces"]["B2"] == {"scans": {"files": [HOSTILE], "channel": HOSTILE}}

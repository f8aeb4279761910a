"""The report of a study whose free texts and names of files are templates, HTML and formulas shows them as they are."""

import json
import re

import pytest
import yaml
from conftest import TINY, snakemake
from drawn_scans import published
from hostile import HOSTILE, HOSTILE_FILE, MADE, Reading
from noted import noted, save_page
from written_scans import QUICK, SIDE, SurfaceTopography

from stiction.command.front_page import FRONT, front_page

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with the report of a surface whose file and channel have such names, after pair b has finished."""
    folder = tmp_path_factory.mktemp("hostile")
    (scan,) = published("B2", SIDE, 1)
    topography = SurfaceTopography.Topography(scan.heights, scan.size, unit="m")
    topography.to_gwy(str(folder / HOSTILE_FILE), name=HOSTILE)
    scans = {"scans": {"files": [HOSTILE_FILE], "channel": HOSTILE}}
    (folder / "mine.yaml").write_text(yaml.safe_dump(yaml.safe_load(TINY) | QUICK | {"surfaces": {"Mine": scans}}))
    snakemake(folder, "scans", configs=[folder / "mine.yaml"])
    results = folder / "results"
    (results / "verdict.txt").write_text(HOSTILE)  # of a finished run of the pair, without its jobs
    save_page(results, noted(HOSTILE))
    (results / "tables" / "table_3.csv").write_text("pair,model\n")
    (folder / FRONT).write_text(front_page(results), encoding="utf-8")
    snakemake(folder, "scans", "--report", "results/report.html", configs=[folder / "mine.yaml"])
    return folder


def test_a_report_runs_no_code_of_a_study_and_shows_its_text(folder):
    assert not list(folder.rglob(MADE))
    page = (folder / "results" / "report.html").read_text(encoding="utf-8")
    scripts = Reading(page).text["script"]
    assert not [script for script in scripts if script.lstrip().startswith("alert")]
    (front,) = re.findall(r"^ *var workflow_desc = (.*);$", page, re.MULTILINE)
    shown = Reading(json.loads(front))
    assert shown.code == []
    assert f"Scans of Mine: {HOSTILE_FILE}" in shown.text["li"]
    assert f"pair b: surface B2: {HOSTILE}" in shown.text["li"]
    assert HOSTILE in shown.text["p"]
    written = yaml.safe_load(shown.text["pre"][0])["surfaces"]["Mine"]["scans"]
    assert written["channel"] == HOSTILE
    assert written["files"][0].endswith(HOSTILE_FILE)


def test_tables_and_captions_beside_figures_show_it(folder):
    results = folder / "results"
    table = Reading((results / "tables" / "scans.html").read_text(encoding="utf-8"))
    assert table.code == ["meta", "meta", "script"]
    (own,) = table.text["script"]
    assert own.startswith("if (self !== top)"), "the link out of a report"
    assert {HOSTILE, HOSTILE_FILE} < {*table.text["td"]}
    page = (results / "report.html").read_text(encoding="utf-8")
    known = re.search(r"^ *var results = (\{.*\});$", page, re.MULTILINE)[1]
    captions = {path: Reading(result["caption"]) for path, result in json.loads(known).items()}
    assert all(not caption.code for caption in captions.values())
    assert "results/figures/surface_sheet_Mine.png" in captions

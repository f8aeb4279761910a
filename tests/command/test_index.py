"""The index of a run lists what its configuration wants and its folder holds, and nothing else."""

import copy
import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from hostile import HOSTILE, Reading
from noted import noted, save_page
from test_front_page import finished

from stiction.command import index, main
from stiction.command.front_page import MODELS_IN_WORDS
from stiction.command.present import Present
from stiction.config.files import load, paper
from stiction.models import BEAM_MODELS, SIDES
from stiction.plan.planner import Planner
from stiction.run.provenance import record

DEVICE = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44]}
#: Rules of a planner: a page of every device, a table, a figure, and a dataset, which is not shown.
RULES = [
    {
        "files": {"html": "results/devices/{device}.html", "answer": "results/devices/{device}.txt"},
        "wanted": [f"results/devices/{name}" for name in ("C1.html", "C1.txt", "S1.html", "S1.txt")],
        "shown": {"file": "html", "title": "{device}: what to build", "category": "Devices"},
    },
    {
        "files": {key: f"results/tables/table_3.{key}" for key in ("csv", "md", "html")},
        "wanted": [f"results/tables/table_3.{key}" for key in ("csv", "md", "html")],
        "shown": {"file": "html", "title": "Table 3: crack lengths", "category": "Tables"},
    },
    {
        "files": {key: f"results/figures/figure_08.{key}" for key in ("pdf", "png")},
        "wanted": [f"results/figures/figure_08.{key}" for key in ("pdf", "png")],
        "shown": {"file": "png", "title": "Figure 8: surfaces", "category": "Surfaces (Sec. II)"},
    },
    {"files": {"dataset": "results/heights/B1.nc"}, "wanted": ["results/heights/B1.nc"], "shown": None},
]


def of_run(results, *devices, **changes):
    """Files and configuration of a finished run with devices."""
    config = finished(results, devices, **changes)
    record(results / "provenance.json", results, config | {"devices": dict.fromkeys(devices, DEVICE)})
    return index.index(results, RULES)


def links(page):
    """Addresses of a page: of links, and of what is shown."""
    return [unquote(address) for address in re.findall(r'(?:href|src)="([^"]*)"', page)]


def files_of(page):
    """Files to which a page refers."""
    return [address for address in links(page) if not address.startswith("#")]


def test_every_device_is_there_with_its_answer_its_page_and_its_warnings(tmp_path):
    page = of_run(tmp_path, "C1", "S1")
    assert "<strong>Build C1 no longer than 3 µm &amp; more.</strong>" in page
    assert {"devices/C1.html", "devices/S1.html"} <= set(files_of(page))
    cards = re.findall(r'<section class="card">.*?</section>', page, re.DOTALL)
    assert ["1 warning<" in card for card in cards] == [True, False]
    assert page.count('<svg xmlns="http://www.w3.org/2000/svg" class="drawing"') == 2


def test_many_devices_are_rows_of_a_table_with_their_answers_pages_and_warnings(tmp_path):
    few, many = (["C1", "S1", *(f"D{k}" for k in range(number))] for number in (18, 19))
    assert of_run(tmp_path, *few).count('<section class="card">') == len(few)
    page = of_run(tmp_path, *many)
    assert 'class="card"><h3>' not in page.replace("\n", "")
    assert 'class="drawing"' not in page
    rows = re.findall(r'<tr><td class="text">(.*?)</td>.*?<td class="text">([^<]*)</td><td>(\d+)</td></tr>', page)
    found = {name: said for name, *said in rows}
    assert len(found) == len(many)
    assert found['<a href="devices/C1.html">C1</a>'] == ["Build C1 no longer than 3 µm &amp; more.", "1"]
    assert found['<a href="devices/S1.html">S1</a>'][1] == "0"
    assert "D18" in found, "a device without a page has no link"


def test_what_does_not_exist_is_not_linked_and_every_link_has_its_file(tmp_path):
    page = of_run(tmp_path, "C1", "S1")
    assert "tables/table_3.html" in files_of(page)
    assert "tables/table_3.md" not in files_of(page)
    assert "figure_08" not in page
    assert all((tmp_path / file).is_file() for file in files_of(page))
    (tmp_path / "devices" / "C1.txt").unlink()
    (tmp_path / "devices" / "C1.html").unlink()
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "figure_08.png").touch()
    page = index.index(tmp_path, RULES)
    assert "<strong>Not computed yet.</strong>" in page
    assert "devices/C1.html" not in files_of(page)
    assert files_of(page).count("figures/figure_08.png") == 2
    assert all((tmp_path / file).is_file() for file in files_of(page))


def test_files_of_another_configuration_are_not_listed(tmp_path):
    of_run(tmp_path, "C1")
    assert "devices/C1" not in of_run(tmp_path)


def test_pairs_checks_warnings_provenance_and_changes_are_on_the_page(tmp_path):
    (tmp_path / "checks.csv").write_text('name,case,passed,message\nmass,"b, NG",True,kept\nlaw,c,False,broken\n')
    page = of_run(tmp_path, seed=7)
    for part in (
        "All 3 checks",
        "<td>98</td><td>686 ± 16</td>",
        "<td>passed</td><td>mass</td><td>b, NG</td><td>kept</td>",
        "<td>failed</td><td>law</td><td>c</td><td>broken</td>",
        "<li>pair b: surface B2: Too &lt;dry&gt; &amp; {{ thin }}.</li>",
        "Last run: 20",
        "provenance.json",
        "seed: 7\n",
    ):
        assert part in page
    sides = [paper()["pairs"][pair][side] for pair in ("b", "c") for side in SIDES]
    assert all(f"<dt>{name}</dt>" in page for name in sides)


def test_every_model_that_checks_and_warnings_name_is_explained_and_the_table_says_which_it_counts(tmp_path):
    (caption,) = (line for line in of_run(tmp_path).partition("<h2>Pairs</h2>")[2].split("<p>")[1:2])
    assert "counted on non-Gaussian surfaces (model NG) alone" in caption
    assert all(f"{model}, {words}" in caption for model, words in MODELS_IN_WORDS.items())
    assert tuple(MODELS_IN_WORDS) == BEAM_MODELS


def test_failed_checks_are_named_where_no_verdict_was_written(tmp_path):
    (tmp_path / "checks.csv").write_text('name,case,passed,message\nmass,"b, NG",True,kept\nlaw,c,False,broken\n')
    of_run(tmp_path)
    (tmp_path / "verdict.txt").unlink()
    assert index.index(tmp_path, RULES).count("1 of 2 checks of the results failed. law: c: broken<") == 2


def test_flags_are_beside_their_surface_and_its_sheet_is_linked(tmp_path):
    of_run(tmp_path)
    config = copy.deepcopy(paper()) | {"run": {"pairs": []}}
    config["surfaces"]["Mine"] = {"scans": {"files": ["a.gwy"]}}
    record(tmp_path / "provenance.json", tmp_path, config)
    (tmp_path / "tables" / "scans.md").write_text("Scans.\n\n- Mine: lines jump: by 1 nm\n- Other: no\n")
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "surface_sheet_Mine.png").touch()
    page = index.index(tmp_path, RULES)
    assert "Results of surfaces Mine" in page
    assert "<li>lines jump: by 1 nm</li>" in page
    assert "<li>no</li>" not in page
    assert "figures/surface_sheet_Mine.png" in files_of(page)


def test_a_run_without_warnings_says_whether_it_has_asked(tmp_path):
    asked, unasked = "No result is beyond", "has not asked"
    of_run(tmp_path)
    save_page(tmp_path)
    page = index.index(tmp_path, RULES)
    assert (asked in page, unasked in page) == (True, False)
    (tmp_path / "warnings.md").unlink()
    page = index.index(tmp_path, RULES)
    assert (asked in page, unasked in page) == (False, True)


def test_texts_of_users_are_their_characters_and_no_script_runs(tmp_path):
    of_run(tmp_path, "C1")
    (tmp_path / "devices" / "C1.txt").write_text(f"{HOSTILE}\n")
    save_page(tmp_path, noted(HOSTILE))
    config = copy.deepcopy(paper()) | {"run": {"pairs": ["b"]}, "devices": {"C1": DEVICE}}
    config["surfaces"]["B2"] |= {"material": HOSTILE}
    record(tmp_path / "provenance.json", tmp_path, config)
    page = index.index(tmp_path, RULES)
    read = Reading(page)
    assert read.code == ["meta"] * 2, "those of the template"
    assert HOSTILE in read.text["strong"]
    assert f"pair b: surface B2: {HOSTILE}" in read.text["li"]
    assert not [address for address in links(page) if ":" in address or address.startswith("/")]


def test_the_index_is_written_only_if_it_changes(tmp_path):
    of_run(tmp_path, "C1")
    index.write(tmp_path, RULES)
    file = tmp_path / "index.html"
    first = file.stat()
    index.write(tmp_path, RULES)
    again = file.stat()  # reading it may change the time of access
    assert (again.st_ino, again.st_mtime_ns) == (first.st_ino, first.st_mtime_ns)
    (tmp_path / "devices" / "C1.txt").write_text("Build it shorter.\n")
    index.write(tmp_path, RULES)
    assert "Build it shorter." in file.read_text(encoding="utf-8")


def test_all_that_a_run_wants_is_listed(tmp_path):
    config = load(Path(__file__).parents[2] / "examples" / "devices.yaml")
    rules = Planner(config, {}, index._now, index._now).rules
    record(tmp_path / "provenance.json", tmp_path, config)
    wanted = {file for rule in rules for file in rule["wanted"]}
    for file in wanted:
        (tmp_path / file.removeprefix("results/")).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file.removeprefix("results/")).touch()
    listed = set(files_of(index.index(tmp_path, rules)))
    shown = {item.shown for item in index.items(Present(tmp_path), rules)}
    assert shown <= listed
    assert {f"devices/{name}.html" for name in config["devices"]} <= listed
    ends = (".png", ".pdf", ".html", ".csv")
    of_readers = {file.removeprefix("results/") for file in wanted if file.endswith(ends) and "checks" not in file}
    assert of_readers <= listed


@pytest.mark.parametrize("display", ["", ":0"])
def test_show_names_the_index_and_opens_it_where_there_is_a_display(tmp_path, monkeypatch, capsys, display):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main.main(["show", "--directory", str(tmp_path)]) == main.Status.REFUSED
    finished(tmp_path / "results")
    assert main.main(["show", "--directory", str(tmp_path)]) == main.Status.DONE
    page = tmp_path / "results" / "index.html"
    assert "All 3 checks" in page.read_text(encoding="utf-8")
    assert opened == [page.as_uri()] * bool(display)
    assert str(page) in capsys.readouterr().out


def test_a_damaged_record_of_runs_is_refused(tmp_path, capsys):
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "provenance.json").write_text("{")
    assert main.main(["show", "--directory", str(tmp_path)]) == main.Status.REFUSED
    assert "provenance.json cannot be read" in capsys.readouterr().err


def test_files_of_other_settings_are_not_on_the_page(tmp_path):
    of_run(tmp_path, "C1", "S1")
    names = [
        "verdict.txt",
        "devices/C1.txt",
        "devices/C1.html",
        "tables/table_3.html",
        "tables/table_3.csv",
        "warnings.md",
    ]
    marks = ["All 3 checks", "no longer than 3 µm", "devices/C1.html", "tables/table_3.html", "686 ± 16", "Too &lt;dry"]
    for name, mark in zip(names, marks, strict=True):
        page = index.index(tmp_path, RULES)
        without = index.index(tmp_path, RULES, {f"results/{name}": ""})
        assert page.count(mark) > without.count(mark), name

"""Scans without pairs and devices: what cannot be used is told on a sheet, and keeps nothing else from being drawn."""

from pathlib import Path

import pytest
import yaml
from configurations import problems
from drawn_scans import published
from written_scans import SIDE, etched, scans_of, write

from stiction.command import scans_alone
from stiction.command.main import main
from stiction.config import files, scans
from stiction.config.messages import ConfigError
from stiction.plan.plan import Plan
from stiction.report.scans.figures import refused_sheet


def study(folder, **surfaces):
    """File of a configuration with these surfaces, as files or as the section of their scans."""
    folder.mkdir(exist_ok=True)
    entries = {
        name: {"scans": {"files": scans} if isinstance(scans, list) else scans} for name, scans in surfaces.items()
    }
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump({"surfaces": entries}))
    return str(path)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with two good scans, an empty one and one that is no scan."""
    path = tmp_path_factory.mktemp("alone")
    scans_of(path, count=2)
    (path / "empty.gwy").write_bytes(b"")
    (path / "text.gwy").write_text("no scan")
    return path


def test_bad_files_are_left_out_with_their_reasons(folder, tmp_path):
    names = ["empty.gwy", "B2-0.gwy", "text.gwy", "missing.gwy", "B2-1.gwy"]
    found = scans_alone.alone([study(folder, Etched=names)], tmp_path)
    assert found.refused == {}
    section = found.overlay["surfaces"]["Etched"]["scans"]
    assert [Path(path).name for path in section["files"]] == ["B2-0.gwy", "B2-1.gwy"]
    empty, missing, text = sorted(section["left_out"])
    assert missing.startswith("missing.gwy is not used: it cannot be opened: No such file or directory")
    assert empty == "empty.gwy is not used: it is empty"
    assert text.endswith("open it in Gwyddion and save it as .gwy")


def process_of(folder, *settings, surface="B2"):
    """File of a configuration with scans at some settings of a process."""
    path = folder / "process.yaml"
    settings = [{"value": 30 * number, "scans": files} for number, files in enumerate(settings, 1)]
    path.write_text(
        yaml.safe_dump({"process": {"etch": {"variable": "etch_s", "surface": surface, "settings": settings}}})
    )
    return str(path)


def test_scans_of_settings_are_those_of_surfaces_read_as_the_surface_of_the_process_is(folder, tmp_path):
    path = process_of(folder, ["B2-0.gwy", "empty.gwy"], ["text.gwy"], ["B2-1.gwy"], surface="Etched")
    base = study(folder, Etched={"files": ["B2-0.gwy"], "level": "quadratic"})
    found = scans_alone.alone([base, path], tmp_path)
    assert list(found.overlay["surfaces"]) == ["Etched", "etch-1", "etch-3"]
    assert list(found.refused) == ["etch-2"]
    first = found.overlay["surfaces"]["etch-1"]["scans"]
    assert ([Path(file).name for file in first["files"]], first["level"]) == (["B2-0.gwy"], "quadratic")
    assert first["left_out"] == ["empty.gwy is not used: it is empty"]
    assert Plan(files.load(found.overlay)).scans.surfaces == ["Etched", "etch-1", "etch-3"]


@pytest.mark.parametrize(
    ("settings", "surface", "said"),
    [
        (["B2-0.gwy"], "B2", r"process.etch.settings\[0\].scans is 'B2-0.gwy', must be a list"),
        ([["B2-0.gwy"]], "B7", "process.etch.surface is 'B7', must be one of B1, B2, Sub1, Sub2"),
        ([["B2-0.gwy"]], "etch-1", "process.etch.surface is 'etch-1', must be one of B1, B2, Sub1, Sub2"),
        ([["B2-0.gwy"]], ["B2"], r"process.etch.surface is \['B2'\], must be text"),
    ],
)
def test_wrong_processes_are_told_before_any_file_is_read(folder, tmp_path, settings, surface, said):
    with pytest.raises(ConfigError, match=said) as refusal:
        scans_alone.alone([process_of(folder, *settings, surface=surface)], tmp_path)
    assert "surfaces.etch" not in str(refusal.value)


def test_a_surface_without_a_good_file_does_not_keep_others(folder, tmp_path):
    surfaces = {
        "Etched": ["B2-0.gwy"],
        "Bad": ["empty.gwy", "missing.gwy"],
        "Asked": {"files": ["B2-1.gwy"], "channel": "X"},
    }
    found = scans_alone.alone([study(folder, **surfaces)], tmp_path)
    assert list(found.overlay["surfaces"]) == ["Etched"]
    assert {name: len(reasons) for name, (_, reasons) in found.refused.items()} == {"Bad": 2, "Asked": 1}
    (asked,) = found.refused["Asked"][1]
    assert asked.startswith("B2-1.gwy is not used: it has no channel X, only: ")
    assert asked.endswith("(key channel)")
    assert problems(files.joined(found.overlay)) == ()


def test_a_scan_that_shows_no_surface_is_told_with_its_map(folder, tmp_path):
    tiny = published("B2", SIDE, 1)[0].heights[:40, :40]
    write(folder / "tiny.gwy", tiny, (0.8e-6, 0.8e-6))
    found = scans_alone.alone([study(folder, Tiny=["tiny.gwy"])], tmp_path)
    entry, reasons = found.refused["Tiny"]
    assert reasons[0].startswith("tiny.gwy is not used: it cannot give a spectrum")
    sheet = scans_alone.draw_refused("Tiny", entry, reasons, tmp_path)
    assert sheet.stat().st_size > 20_000
    assert sheet.with_suffix(".pdf").exists()


def test_a_sheet_without_any_map_shows_the_reasons():
    figure = refused_sheet("Bad", None, ["a.gwy is empty", "b.gwy is empty"])
    assert figure.get_supxlabel() == "– a.gwy is empty\n– b.gwy is empty"
    assert figure.get_suptitle() == "Bad: no estimate"


def test_no_rule_of_strips_grids_and_pairs_applies_where_nothing_is_simulated(folder, tmp_path):
    path = folder / "strips.yaml"
    strips = {
        "sampling": {"strip_length_um": 0.02, "margin_um": 0.01, "spacing_nm": 5000},
        "pairs": {"b": {"gap_um": -1}},
    }
    study_of_strips = etched("B2-0.gwy", "B2-1.gwy") | strips
    study_of_strips["surfaces"]["Etched"]["material"] = "Unobtainium"
    path.write_text(yaml.safe_dump(study_of_strips))
    with pytest.raises(ConfigError):
        files.load(path)
    found = scans_alone.alone([str(path)], tmp_path)
    config = files.load(found.overlay)
    assert Plan(config).pairs == []
    assert not Plan(config).is_drawn("Etched")


@pytest.mark.parametrize("used", ["pair", "device", "neither"])
def test_a_surface_is_simulated_if_a_pair_that_runs_or_a_device_has_it(used):
    config = {"surfaces": {"A": {}, "B": {}}, "pairs": {"p": {"beam": "A", "substrate": "B"}}, "run": {"pairs": []}}
    config |= {"run": {"pairs": ["p"]}} if used == "pair" else {}
    config |= {"devices": {"D": {"pair": "p"}}} if used == "device" else {}
    assert Plan(config).is_drawn("A") == (used != "neither")


def test_wrong_keys_are_told_before_any_file_is_read(folder, tmp_path):
    with pytest.raises(ConfigError, match="surfaces.Etched.scans.level is 'steep'"):
        scans_alone.alone([study(folder, Etched={"files": ["B2-0.gwy"], "level": "steep"})], tmp_path)


@pytest.mark.parametrize("pairs", [["b"], []])
def test_moments_without_a_density_leave_the_measured_one_whether_or_not_anything_is_simulated(
    folder, monkeypatch, pairs
):
    overlays = etched(folder / "B2-0.gwy"), {"run": {"pairs": pairs}}
    assert files.load(*overlays)["surfaces"]["Etched"]["heights"] == "moments", "control"
    estimate = scans._preliminary_numbers
    monkeypatch.setattr(scans, "_preliminary_numbers", lambda *given: estimate(*given) | {"feasible": None})
    assert files.load(*overlays)["surfaces"]["Etched"]["heights"] == "measured"


@pytest.mark.parametrize("has_scans", [True, False])
def test_the_command_asks_for_scans_of_a_surface_or_of_a_setting(folder, tmp_path, monkeypatch, capsys, has_scans):
    monkeypatch.setattr("stiction.command.main._run", lambda *_: 0)
    path = process_of(folder, *([["B2-1.gwy"]] if has_scans else []))
    assert main(["scans", path, "--directory", str(tmp_path)]) == (0 if has_scans else 2)
    assert (
        "add surfaces.NAME.scans or surfaces.NAME.profiles, or scans to the settings" in capsys.readouterr().err
    ) != has_scans


@pytest.mark.slow
def test_the_command_draws_what_can_be_drawn(folder, tmp_path, capsys):
    path = study(folder, Etched=["B2-0.gwy", "empty.gwy"], Bad=["text.gwy"])
    more = process_of(folder, ["B2-1.gwy"])  # whose scans are the only ones of this file
    assert main(["scans", more, path, "--directory", str(tmp_path), "--cores", "1"]) == 0
    printed = capsys.readouterr().out
    assert "Bad cannot be estimated: text.gwy is not used: it cannot be read" in printed
    names = {file.name for file in (tmp_path / "results" / "figures").glob("*.png")}
    assert names == {f"surface_sheet_{name}.png" for name in ("Etched", "Bad", "etch-1")}
    assert "empty.gwy is not used: it is empty" in (tmp_path / "results" / "tables" / "scans.md").read_text()


def test_the_refusal_of_a_scan_is_the_same_where_something_is_simulated(folder):
    (line,) = problems(files.joined(etched(folder / "B2-0.gwy", folder / "empty.gwy")))
    assert line == "surfaces.Etched.scans.files[1] is 'empty.gwy', which is empty"

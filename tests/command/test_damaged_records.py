"""Drawn damage of what a run reads of earlier runs: it works, or one sentence says why, and nothing outside is read."""

import copy
import json
import os
import random
from pathlib import Path

import pytest
from hostile import places
from test_front_page import finished

from stiction.command import launch, main
from stiction.command.last_lines import FAULT, Status
from stiction.config.files import paper
from stiction.run import labels, run_lock
from stiction.run.atomic import DataError
from stiction.run.disk_cache import DiskCache
from stiction.run.logs import logged, note_origin, recorded_checksums, recorded_origins
from stiction.run.provenance import record

DEVICE = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44]}
SECRET = "the key of somebody"
#: What a place in a record can hold instead of what it should.
ODD = [None, 5, -1.5, True, "", "../../secret", "x" * 3000, "a\nb", [], {}, [[]], {"pair": "b"}, ["b"], "\x00"]


def with_odd(runs, draw):
    """Runs with an odd value, or an odd name, at a drawn place; sometimes without the place."""
    changed, at = copy.deepcopy(runs), []
    while not at:  # places near the root as often as the many in the configuration
        depth = draw.randint(1, 5)
        at = [path for path in places(changed) if len(path) == depth]
    *above, last = draw.choice(at)
    parent = changed
    for key in above:
        parent = parent[key]
    value = parent.pop(last)
    kind = draw.randrange(3)
    if kind == 0 and isinstance(parent, dict):
        parent[draw.choice(["../../secret", "a/b", "", "x" * 300])] = value
    elif kind > 0:
        parent.insert(last, draw.choice(ODD)) if isinstance(parent, list) else parent.update({last: draw.choice(ODD)})
    return changed


@pytest.fixture
def run(tmp_path):
    """Folder of a finished run with a device, below a file that is not of it."""
    (tmp_path / "secret").write_text(SECRET)
    (tmp_path / "secret.txt").write_text(SECRET)
    folder = tmp_path / "a" / "run"
    finished(folder / "results", ["C1"])
    config = copy.deepcopy(paper()) | {"run": {"pairs": ["b"]}, "devices": {"C1": DEVICE}}
    (folder / "results" / "provenance.json").unlink()
    record(folder / "results" / "provenance.json", folder, config)
    return folder


def shown(folder, capsys):
    """Status of the command show and what it says; no file outside is on the page."""
    status = main.main(["show", "--directory", str(folder)])
    said = "".join(capsys.readouterr())
    assert FAULT not in said
    assert len(said.splitlines()) == 1
    page = folder / "results" / "index.html"
    assert not page.exists() or SECRET not in page.read_text(encoding="utf-8")
    return status, said


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 60, 20))
def test_drawn_records_are_shown_or_refused_in_one_sentence(run, capsys, first):
    path, seen = run / "results" / "provenance.json", set()
    runs = json.loads(path.read_text())
    for number in range(first, first + 20):
        path.write_text(json.dumps(with_odd(runs, random.Random(number))))
        seen.add(shown(run, capsys)[0])
    assert seen == {Status.DONE, Status.REFUSED}


def test_names_that_lead_outside_are_not_followed(run, capsys):
    path = run / "results" / "provenance.json"
    runs = json.loads(path.read_text())
    runs[-1]["config"]["devices"] = dict.fromkeys(["C1", "../../../secret", f"{run.parent.parent}/secret"], DEVICE)
    path.write_text(json.dumps(runs))
    assert shown(run, capsys)[0] == Status.DONE
    link = run / "results" / "devices" / "C1.txt"
    link.unlink()
    link.symlink_to(run.parent.parent / "secret")
    assert shown(run, capsys)[0] == Status.DONE


@pytest.mark.parametrize(
    "name", ["verdict.txt", "devices/C1.txt", "warnings.json", "provenance.json", "tables/table_3.csv"]
)
@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir])
def test_what_is_no_file_is_not_waited_for(run, capsys, name, make):
    path = run / "results" / name
    path.unlink()
    make(path)
    assert shown(run, capsys)[0] == (Status.REFUSED if name == "provenance.json" else Status.DONE)


def test_results_are_shown_where_a_scan_has_moved(run, capsys):
    config = copy.deepcopy(paper()) | {"run": {"pairs": ["b"]}, "devices": {}}
    measured = {"heights": "moments", "psd": "fitted", "beyond": "cut", "material": "Si"}
    config["surfaces"]["B2"] = measured | {"scans": {"files": [str(run / "moved.gwy")]}}
    record(run / "results" / "provenance.json", run, config)
    known = {"B2": {"rms_nm": 3.0, "feasible": [-0.3, 3.5], "skewness": -0.3, "kurtosis": 3.5}}
    (run / ".snakemake").mkdir()
    (run / ".snakemake" / "configuration.json").write_text(json.dumps({"planned": [config, known]}))
    assert shown(run, capsys)[0] == Status.DONE


@pytest.mark.parametrize("kind", ["bytes", "pipe", "folder", "link"])
def test_a_log_of_any_content_is_read(tmp_path, monkeypatch, kind):
    monkeypatch.chdir(tmp_path)
    Path("a.md").touch()
    with logged("logs/a.log", ["a.md"]):
        note_origin("1" * 64)
    path = Path("logs/b.log")
    {
        "bytes": lambda: path.write_bytes(b"\xff\xfe\x00" + random.Random(1).randbytes(10_000)),
        "pipe": lambda: os.mkfifo(path),
        "folder": path.mkdir,
        "link": lambda: path.symlink_to("nowhere"),
    }[kind]()
    assert list(recorded_checksums("logs")) == ["a.md"]
    assert recorded_origins("logs") == {"a.md": "1" * 64}


def test_a_cache_that_is_not_as_it_was_written_is_empty(tmp_path):
    path, draw = tmp_path / "kept.json", random.Random(1)
    remember = DiskCache(path)
    remember("key", lambda: {"a": [1, 2.5]})
    remember.save()
    sound = path.read_text()
    changed = [sound.replace("2.5", odd) for odd in ('"x"', "null", "{}", "[]", "NaN")]
    changed += ["{}", "[]", "5", "", "null", json.dumps({"key": 5}), "[" * 10**5]
    changed += [sound[: draw.randrange(len(sound))] for _ in range(50)]
    for text in changed:
        path.write_text(text)
        assert DiskCache(path)("key", lambda: "computed") == "computed"
    path.write_text(sound)
    assert DiskCache(path)("key", lambda: "computed") == {"a": [1, 2.5]}
    path.unlink()
    os.mkfifo(path)
    assert DiskCache(path)("key", lambda: "computed") == "computed"


@pytest.mark.parametrize("odd", ["5", "[]", '"a"', '{"a": 5}', "{", "[" * 10**5])
@pytest.mark.parametrize("key", ["settings", "before"])
def test_a_label_that_is_none_is_an_unreadable_dataset(tmp_path, key, odd):
    import netCDF4

    with netCDF4.Dataset(tmp_path / "a.nc", "w") as file:
        file.setncattr(key, odd)
    if (key, odd) != ("settings", '{"a": 5}'):
        with pytest.raises(DataError, match="cannot be read"):
            labels.read(tmp_path / "a.nc")


def test_a_dataset_or_a_lock_that_is_a_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe.nc")
    with pytest.raises(DataError, match="it is a pipe"):
        labels.read(tmp_path / "pipe.nc")
    with pytest.raises(OSError, match="it is a pipe"):
        run_lock.reserve(tmp_path / "pipe.nc")


@pytest.mark.parametrize("make", [os.mkfifo, lambda path: path.symlink_to("outside"), Path.mkdir, Path.touch])
def test_what_is_printed_is_never_written_through_a_link_or_into_a_pipe(tmp_path, monkeypatch, make):
    monkeypatch.chdir(tmp_path)
    (path := tmp_path / "printed.log").parent.joinpath("outside").write_text("mine")
    make(path)
    with launch.opened(path) as file:
        file.write("text")
    assert (tmp_path / "outside").read_text() == "mine"
    assert path.is_dir() or path.read_text() == "text"

import json
import os
import subprocess

import numpy
import pytest

from stiction import provenance


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package of three rooms and a script that reaches two of them."""
    files = {
        "near.py": "from stiction import far\nX = 1\n",
        "far.py": "def f():\n    return 2\n",
        "other.py": "Y = 3\n",
        "scripts/script.py": '"""Say."""\nfrom stiction.near import X\n',
    }
    (tmp_path / "scripts").mkdir()
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(provenance, "PACKAGE", tmp_path)
    return tmp_path


def rewrite(path, text):
    path.write_text(text)
    provenance._read.cache_clear()


def test_the_fingerprint_names_the_script_and_all_it_reaches(package):
    assert list(provenance.fingerprint(package / "scripts" / "script.py")) == [
        "script.py",
        "stiction.far",
        "stiction.near",
    ]


def test_a_script_and_a_module_of_one_file_name_both_count(package):
    script = package / "scripts" / "near.py"
    script.write_text("from stiction import near\n")
    assert list(provenance.fingerprint(script)) == ["near.py", "stiction.far", "stiction.near"]


def test_a_change_far_away_changes_one_entry(package):
    before = provenance.fingerprint(package / "scripts" / "script.py")
    rewrite(package / "far.py", "def f():\n    return 2.5\n")
    after = provenance.fingerprint(package / "scripts" / "script.py")
    assert {name for name in before if before[name] != after[name]} == {"stiction.far"}


def test_comments_docstrings_and_layout_do_not_count(package):
    before = provenance.fingerprint(package / "scripts" / "script.py")
    rewrite(package / "far.py", '"""A room."""\n\n# why\ndef f():\n    """Two."""\n    return (2)\n')
    assert provenance.fingerprint(package / "scripts" / "script.py") == before


def test_a_room_that_is_not_reached_does_not_count(package):
    before = provenance.fingerprint(package / "scripts" / "script.py")
    rewrite(package / "other.py", "Y = 4\n")
    assert provenance.fingerprint(package / "scripts" / "script.py") == before


def test_a_room_that_changes_no_number_does_not_count(package, monkeypatch):
    monkeypatch.setattr(provenance, "SILENT", {"far"})
    provenance._read.cache_clear()
    assert list(provenance.fingerprint(package / "scripts" / "script.py")) == ["script.py", "stiction.near"]


def test_every_run_adds_what_it_ran_with_to_the_record(tmp_path):
    path = tmp_path / "results" / "provenance.json"
    for seed in (1, 2):
        provenance.record(path, tmp_path, {"seed": seed})
    runs = json.loads(path.read_text())
    assert [run["config"] for run in runs] == [{"seed": 1}, {"seed": 2}]
    assert runs[0]["versions"]["numpy"] == numpy.__version__
    assert {"started", "versions", "git", "machine", "config"} == set(runs[0])
    assert runs[0]["machine"]["cores"] == os.cpu_count()
    assert [file.name for file in path.parent.iterdir()] == ["provenance.json"], "no draft is left"


@pytest.mark.parametrize("text", ["[1, 2", "{}"])
def test_a_record_that_is_none_is_named_and_kept(tmp_path, text):
    path = tmp_path / "provenance.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"provenance\.json .*; delete it"):
        provenance.record(path, tmp_path, {})
    assert path.read_text() == text


def test_git_state_is_the_commit_and_whether_files_differ_from_it(tmp_path):
    def git(*command):
        identity = ["-c", "user.name=A", "-c", "user.email=a@b"]
        subprocess.run(["git", "-C", tmp_path, *identity, *command], check=True, capture_output=True)

    assert provenance.git_state(tmp_path) is None
    git("init")
    (tmp_path / "law").write_text("1")
    git("add", "law")
    git("-c", "commit.gpgsign=false", "commit", "-m", "law", "--no-verify")
    clean = provenance.git_state(tmp_path)
    assert len(clean["commit"]) == 40
    assert not clean["changed"]
    (tmp_path / "law").write_text("2")
    assert provenance.git_state(tmp_path) == clean | {"changed": True}

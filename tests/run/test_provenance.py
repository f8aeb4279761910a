import json
import os
import subprocess

import numpy
import pytest

from stiction.run import provenance


def test_every_run_appends_its_code_machine_and_configuration_to_the_record(tmp_path):
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
def test_an_invalid_record_is_reported_and_kept(tmp_path, text):
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


def test_a_library_that_is_not_installed_is_recorded_as_none(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "LIBRARIES", ("numpy", "a-library-that-nobody-has"))
    provenance.record(tmp_path / "provenance.json", tmp_path, {})
    (run,) = json.loads((tmp_path / "provenance.json").read_text())
    assert run["versions"]["a-library-that-nobody-has"] is None
    assert run["versions"]["numpy"] == numpy.__version__

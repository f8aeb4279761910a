import json
import os
import platform
import re
import subprocess
from pathlib import Path

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


@pytest.mark.skipif(not Path("/proc/cpuinfo").exists(), reason="the system does not list its processors")
def test_the_processor_is_that_which_the_system_reports(tmp_path):
    provenance.record(tmp_path / "provenance.json", tmp_path, {})
    (run,) = json.loads((tmp_path / "provenance.json").read_text())
    named = re.search(r"^model name\s*:\s*(.*)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    assert run["machine"]["cpu"].strip() == (named[1].strip() if named else platform.processor())


@pytest.mark.parametrize("text", ["[1, 2", "{}"])
def test_an_invalid_record_is_reported_and_kept(tmp_path, text):
    path = tmp_path / "provenance.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"provenance\.json .*; delete it"):
        provenance.record(path, tmp_path, {})
    assert path.read_text() == text


@pytest.fixture
def checkout(tmp_path):
    """Checkout with one commit, and a function that runs git in it."""

    def git(*command):
        identity = ["-c", "user.name=A", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        return subprocess.run(["git", "-C", tmp_path, *identity, *command], capture_output=True, text=True)

    git("init")
    (tmp_path / "law").write_text("1")
    git("add", "law")
    git("commit", "-m", "law", "--no-verify")
    return tmp_path, git


def test_git_state_is_the_commit_and_the_files_that_differ_from_it_apart_from_untracked_ones(
    checkout, tmp_path_factory
):
    folder, git = checkout
    clean = provenance.git_state(folder)
    assert len(clean["commit"]) == 40
    assert (clean["changed"], clean["untracked"]) == ([], [])
    (folder / "my notes µ").write_text("1")
    assert provenance.git_state(folder) == clean | {"untracked": ["my notes µ"]}, "the code is that of the commit"
    (folder / "law").write_text("2")
    assert provenance.git_state(folder) == clean | {"changed": ["law"], "untracked": ["my notes µ"]}
    git("add", "my notes µ")
    assert provenance.git_state(folder)["changed"] == ["law", "my notes µ"]
    assert provenance.git_state(tmp_path_factory.mktemp("bare")) is None


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a checkout to another user")
def test_the_state_of_a_checkout_of_another_user_is_recorded(checkout, monkeypatch):
    folder, git = checkout
    for name in ("GIT_CONFIG_GLOBAL", "GIT_CONFIG_SYSTEM"):
        monkeypatch.setenv(name, os.devnull)  # no exceptions of this machine
    before = provenance.git_state(folder)
    for path in (folder, *folder.rglob("*")):
        os.chown(path, 65534, 65534)
    assert "dubious ownership" in git("rev-parse", "HEAD").stderr
    assert provenance.git_state(folder) == before is not None


def test_a_library_that_is_not_installed_is_recorded_as_none(tmp_path, monkeypatch):
    monkeypatch.setattr(provenance, "LIBRARIES", ("numpy", "a-library-that-nobody-has"))
    provenance.record(tmp_path / "provenance.json", tmp_path, {})
    (run,) = json.loads((tmp_path / "provenance.json").read_text())
    assert run["versions"]["a-library-that-nobody-has"] is None
    assert run["versions"]["numpy"] == numpy.__version__


# In words

RUN = {"started": "2026-01-31T23:05:59+00:00", "versions": {"stiction": "0.2.0", "numpy": "2.0"}, "git": None}


COMMIT = "abcdef0123456789"


def commit(*changed):
    return {"commit": COMMIT, "changed": list(changed), "untracked": ["notes.txt"]}


@pytest.mark.parametrize(
    ("git", "sentences"),
    [
        (None, ["stiction 0.2.0, installed"]),
        (commit(), [f"stiction 0.2.0, commit {COMMIT[:10]}"]),
        (
            commit("a.py", "b.py"),
            [f"stiction 0.2.0, commit {COMMIT[:10]}", "Files that are changed in its folder: a.py, b.py"],
        ),
    ],
)
def test_the_code_of_a_run_is_named_with_its_changed_files_alone(git, sentences):
    assert list(provenance.code_of(RUN | {"git": git})) == sentences
    assert next(provenance.code_of(RUN | {"git": git, "versions": {}})) == sentences[0].replace(" 0.2.0", "")


def test_a_result_is_made_by_the_last_run_of_the_record(tmp_path):
    record = tmp_path / "provenance.json"
    runs = [RUN | {"started": "2025-01-01T00:00:00+00:00", "git": commit()}, RUN]
    record.write_text(json.dumps([run | {"config": {}} for run in runs]))
    first, *code, last = provenance.last_run(record)
    assert first == "Made by the run of 2026-01-31 23:05 UTC."
    assert code == ["stiction 0.2.0, installed."]
    assert "results/provenance.json" in last

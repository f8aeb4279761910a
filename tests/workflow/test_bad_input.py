"""What cannot run stops before it starts, with a sentence that says what to do."""

import os
import shutil
import subprocess

import pytest
from conftest import ROOT
from planner import Planner
from wrong_configurations import WRONG as TABLE

WRONG = [
    ("surfaces: {B1: {kurtosis: 1.2}}", "surfaces.B1.kurtosis", "1.2", "must be"),
    ("chaos: {dimension_tolerance: 1e-3}", "chaos.dimension_tolerance", "'1e-3'", "write 1.0e-3"),
    ("beam: {thicknes_um: 2.5}", "beam.thicknes_um", "2.5", "did you mean thickness_um?"),
    ("pairs: {c: {beam: B3}}", "pairs.c.beam", "'B3'", "must be one of B1, B2, Sub1, Sub2"),
    ("van_der_waals: wet", "van_der_waals", "'wet'", "must be one of"),
    ("run: {pairs: []}", "run.pairs", "[]", "at least one"),
]


@pytest.fixture(scope="module")
def planner(tmp_path_factory):
    """Snakemake, ready to be asked."""
    planner = Planner(ROOT, tmp_path_factory.mktemp("printed"))
    yield planner
    planner.close()


ROWS = [*WRONG, *(pytest.param(*row, marks=pytest.mark.slow) for row in TABLE)]


@pytest.mark.parametrize(("text", "key", "value", "allowed"), ROWS)
def test_a_wrong_configuration_stops_before_the_first_job(planner, tmp_path, overlay, text, key, value, allowed):
    folder = tmp_path / "work"
    folder.mkdir()
    status, printed = planner("--directory", folder, "--cores", 1, config=[overlay(text)])
    assert status == 1
    (line,) = [line for line in printed.splitlines() if line.startswith(key)]
    assert value in line
    assert allowed in line
    assert "Traceback" not in printed
    assert not (folder / "results").exists()


def test_results_that_cannot_be_written_are_named(planner, tmp_path):
    # A file in its place stops root as well, whom permissions do not.
    (tmp_path / "results").write_text("mine")
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "Make it writable or choose another --directory" in printed
    assert "Traceback" not in printed


def test_a_record_of_runs_that_is_none_is_to_be_deleted_not_left_behind(planner, tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "provenance.json").write_text("[1, 2")
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "provenance.json cannot be read" in printed
    assert "; delete it" in printed
    assert "choose another --directory" not in printed


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write where permissions forbid it")
def test_a_read_only_folder_is_named(planner, tmp_path):
    (tmp_path / "results").mkdir(mode=0o555)
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "Make it writable or choose another --directory" in printed


def made(folder, *arguments):
    """Run make in a folder, without the variables of the make that runs the tests."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    words = ["make", "-C", folder, *arguments]
    return subprocess.run(words, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


@pytest.fixture
def make(tmp_path):
    """Run make in a folder with nothing but the Makefile and what it installs from."""
    for name in ("Makefile", "requirements.lock", "pyproject.toml"):
        shutil.copy2(ROOT / name, tmp_path)

    def run(*arguments):
        done = made(tmp_path, *arguments)
        assert not (tmp_path / ".venv").exists()
        assert "Traceback" not in done.stdout
        return done

    return run


def test_a_python_that_is_too_old_is_named_with_what_to_write(make, tmp_path):
    old = tmp_path / "python3.9"
    old.write_text('#!/bin/sh\n[ "$1" = --version ] && echo "Python 3.9.2"\nexit 1\n')
    old.chmod(0o755)
    done = make("paper", f"PYTHON={old}")
    assert done.returncode == 2
    assert f"needs Python 3.11 or newer; {old} is Python 3.9.2. Try: make PYTHON=python3" in done.stdout


def test_a_missing_lock_file_is_named_with_how_to_get_it_back(make, tmp_path):
    (tmp_path / "requirements.lock").unlink()
    done = make("paper")
    assert done.returncode == 2
    assert "requirements.lock is missing" in done.stdout
    assert "git checkout requirements.lock" in done.stdout


def test_make_run_without_settings_says_what_it_needs(tmp_path):
    shutil.copy2(ROOT / "Makefile", tmp_path)
    (tmp_path / ".venv").mkdir()
    for name in ("requirements.lock", "pyproject.toml", ".venv/ready"):
        (tmp_path / name).touch()
    done = made(tmp_path, "run")
    assert done.returncode == 2
    assert "make run CONFIG=mine.yaml" in done.stdout

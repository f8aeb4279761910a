"""Invalid input stops a run before its first job, with a message that includes the remedy."""

import os
import shutil
import subprocess
import sys
from itertools import product

import pytest
from conftest import ROOT

WRONG = [
    ("surfaces: {B1: {kurtosis: 1.2}}", "surfaces.B1.kurtosis", "1.2", "must be"),
    ("chaos: {dimension_tolerance: 1e-3}", "chaos.dimension_tolerance", "'1e-3'", "write 1.0e-3"),
    ("beam: {thicknes_um: 2.5}", "beam.thicknes_um", "2.5", "did you mean thickness_um?"),
    ("pairs: {c: {beam: B3}}", "pairs.c.beam", "'B3'", "must be one of B1, B2, Sub1, Sub2"),
    ("van_der_waals: wet", "van_der_waals", "'wet'", "must be one of"),
    ("run: {pairs: []}", "run.pairs", "[]", "must name a pair"),
]


#: Whatever else is wrong is refused by the same function, see tests/config.
ROWS = [*WRONG[:2], *(pytest.param(*row, marks=pytest.mark.slow) for row in WRONG[2:])]


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


def test_what_the_first_samples_show_stops_before_the_first_job(planner, tmp_path, overlay):
    file = overlay("run: {pairs: [b]}\nbeam: {width_um: 0.06}\nattraction: {reach: touching}")
    folder = tmp_path / "work"
    folder.mkdir()
    status, printed = planner("--directory", folder, "--cores", 1, "results/heights/B2.nc", config=[file])
    assert status == 1
    (line,) = [line for line in printed.splitlines() if line.startswith("beam.width_um")]
    assert "so many summits that every sample resists the adhesion" in line
    assert "Traceback" not in printed
    assert not (folder / "results").exists()
    assert (folder / ".snakemake" / "pilot.json").exists()


@pytest.mark.slow
def test_a_results_folder_that_cannot_be_written_is_reported(planner, tmp_path):
    # A file in place of the folder also stops root, which ignores permissions.
    (tmp_path / "results").write_text("mine")
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "Make it writable or choose another --directory" in printed
    assert "Traceback" not in printed


@pytest.mark.slow
def test_an_unreadable_record_of_runs_is_reported_with_the_advice_to_delete_it(planner, tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "provenance.json").write_text("[1, 2")
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "provenance.json cannot be read" in printed
    assert "; delete it" in printed
    assert "choose another --directory" not in printed


@pytest.mark.skipif(os.geteuid() == 0, reason="root ignores permissions")
def test_a_read_only_folder_is_reported(planner, tmp_path):
    (tmp_path / "results").mkdir(mode=0o555)
    status, printed = planner("--directory", tmp_path, "--cores", 1, "results/heights/B1.nc")
    assert status == 1
    assert "Make it writable or choose another --directory" in printed


def made(folder, *arguments):
    """Run make in a folder, without the variables of the make process that runs the tests, such as ARGS=-x."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("MAKE", "ARGS", "CONFIG"))}
    words = ["make", "-C", folder, *arguments]
    return subprocess.run(words, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


@pytest.fixture
def make(tmp_path):
    """Run make in a folder that contains only the Makefile and the files it installs from."""
    for name in ("Makefile", "requirements.lock", "pyproject.toml"):
        shutil.copy2(ROOT / name, tmp_path)

    def run(*arguments):
        done = made(tmp_path, *arguments)
        assert not (tmp_path / ".venv").exists()
        assert "Traceback" not in done.stdout
        return done

    return run


def test_an_unsupported_python_version_is_reported_with_the_remedy(make, tmp_path):
    old = tmp_path / "python3.9"
    old.write_text('#!/bin/sh\n[ "$1" = --version ] && echo "Python 3.9.2"\nexit 1\n')
    old.chmod(0o755)
    done = make("paper", f"PYTHON={old}")
    assert done.returncode == 2
    assert f"needs Python 3.11 or newer; {old} is Python 3.9.2. Try: make PYTHON=python3" in done.stdout


def test_a_missing_lock_file_is_reported_with_the_command_that_restores_it(make, tmp_path):
    (tmp_path / "requirements.lock").unlink()
    done = make("paper")
    assert done.returncode == 2
    assert "requirements.lock is missing" in done.stdout
    assert "git checkout requirements.lock" in done.stdout


def test_make_run_without_config_is_rejected_with_a_usage_message(tmp_path):
    ready(tmp_path)
    done = made(tmp_path, "run")
    assert done.returncode == 2
    assert "make run CONFIG=mine.yaml" in done.stdout


def ready(folder):
    """Makefile in a folder whose virtual environment counts as installed."""
    shutil.copy2(ROOT / "Makefile", folder)
    (folder / ".venv").mkdir()
    for name in ("requirements.lock", "pyproject.toml", ".venv/ready"):
        (folder / name).touch()


@pytest.mark.parametrize(
    ("target", "name"),
    [
        *product(["paper", "smoke", "test"], ["my folder"]),
        *product(["paper"], ["beams(1)", "Anna's", "a&b", "a;b", "a|b", "a*", "[a]", "a`b", 'a"b', "a\\b", "a<b"]),
    ],
)
def test_signs_that_the_shell_interprets_are_rejected_in_the_path_before_anything_is_installed(tmp_path, target, name):
    folder = tmp_path / name
    folder.mkdir()
    shutil.copy2(ROOT / "Makefile", folder)
    done = made(folder, target)
    assert done.returncode == 2
    assert "contains a space or one of" in done.stdout
    assert [path.name for path in folder.iterdir()] == ["Makefile"]


@pytest.mark.parametrize("name", ["Übung", "a-b_c.d", "x+y", "a,b", "50%", "~a", "a=b", "a@b"])
def test_a_path_without_such_signs_is_accepted(tmp_path, name):
    folder = tmp_path / name
    folder.mkdir()
    ready(folder)
    done = made(folder, "--dry-run", "smoke")
    assert done.returncode == 0, done.stdout


def test_a_space_in_the_name_of_the_configuration_is_rejected(tmp_path):
    ready(tmp_path)
    (tmp_path / "my file.yaml").touch()
    done = made(tmp_path, "run", "CONFIG=my file.yaml")
    assert done.returncode == 2
    assert "CONFIG contains a space (my file.yaml): rename the file" in done.stdout


@pytest.mark.parametrize(
    ("words", "called"),
    [
        ("paper", "paper -- "),
        ("paper CONFIG=mine.yaml", "run mine.yaml -- "),
        ("run CONFIG=mine.yaml ARGS=-n", "run mine.yaml -- -n"),
        ("smoke CONFIG=mine.yaml", "run workflow/smoke.yaml mine.yaml --directory runs/smoke -- "),
        ("devices", "devices  --directory runs/devices -- "),
        ("devices CONFIG=mine.yaml", "devices mine.yaml --directory runs/devices -- "),
        ("example", "run runs/example/mine.yaml --directory runs/example -- measured "),
        ("figures CONFIG=mine.yaml", "figures mine.yaml -- "),
        ("report", "report  -- "),
    ],
)
def test_targets_call_the_command(tmp_path, words, called):
    ready(tmp_path)
    (tmp_path / "mine.yaml").touch()
    done = made(tmp_path, "--dry-run", *words.split())
    assert f".venv/bin/stiction {called}" in done.stdout.splitlines()


@pytest.mark.parametrize(("version", "compiler", "stops"), [("14", "", True), ("14", "cc", False), ("13", "", False)])
def test_python_that_needs_a_compiler_says_so_before_pip(tmp_path, make, version, compiler, stops):
    (tmp_path / "bin").mkdir()
    for tool in ("sh", "make", "echo", "touch", *filter(None, [compiler])):
        (tmp_path / "bin" / tool).symlink_to(shutil.which(tool) or "/bin/true")
    python = tmp_path / "python"
    pretend = f"import sys; sys.version_info = (3, {version}, 0); exec(sys.argv[1])"
    python.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "Python 3.{version}.0" && exit\n'
        f'[ "$1" = -m ] && echo "pip would start" && exit 3\nexec {sys.executable} -c "{pretend}" "$2"\n'
    )
    python.chmod(0o755)
    done = make("paper", f"PYTHON={python}", f"PATH={tmp_path / 'bin'}")
    assert done.returncode == 2
    assert ("needs a C compiler (cc); " in done.stdout) == stops
    assert ("pip would start" in done.stdout) != stops

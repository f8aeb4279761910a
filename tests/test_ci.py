"""Continuous integration: every test is part of it, and none that fails or is cut off goes unnoticed."""

import itertools
import os
import re
import shutil
import stat
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["pytest"]["ini_options"]
MARKS = [mark.partition(":")[0] for mark in SETTINGS["markers"]]
#: Stands for Python: notes what it is asked, and ends with the status of the first line whose words are part of that.
PYTHON = """#!/usr/bin/env bash
[ "$1" = -V ] && echo "Python 3.14.0"
[ "$2" = pip ] && echo "$0" >> installed
[ "$2" = pytest ] || exit 0
call=$(printf '%s\\t' "$0" "$@")
echo "$call" >> asked
echo "${SHARED_RUNS:-}" >> shared
while read -r status words; do
  if [[ "$0 $*;" == *"$words"* ]]; then
    [ "$status" = hang ] && exec sleep 20
    [ "$status" = meet ] && exec timeout 20 bash -c 'until grep -qs newest asked installed; do sleep 0.1; done'
    [ "$status" = there ] && exec test -e .venv/newest/ready
    [ "$status" = skip ] && echo "2 passed, 1 skipped in 0.10s" && exit
    exit "$status"
  fi
done < ends
"""
WORKERS = ["--numprocesses", "auto", "--maxprocesses", "4", "--dist", "loadfile", "--no-loadscope-reorder"]
#: Words of the call of each part, which ends with a semicolon.
PARTS = {
    "fast tests": " ".join([".venv/bin/python -m pytest", *WORKERS]) + ";",
    "tests with SLURM": "-m cluster and not nightly",
    "tests in a browser": "-m browser",
    "fast tests on Python 3.14.0": "newest/bin/python -m pytest",
    "slow tests": "-m slow",
}

#: Programs without which a part is not run.
NEEDED = {"tests with SLURM": "slurmctld", "tests in a browser": "chromedriver"}


def executable(path, text):
    """Write a program."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


@pytest.fixture
def project(tmp_path):
    """Folder with the programs of continuous integration, in which nothing is installed and no test is run."""
    for name in ("Makefile", "pyproject.toml", "requirements.lock", ".ci/run"):
        executable(tmp_path / name, (ROOT / name).read_text(encoding="utf-8"))
    for environment in (".venv", ".venv/newest"):
        executable(tmp_path / environment / "bin" / "python", PYTHON)
        for tool in ("ruff", "snakefmt", "snakemake", "stiction"):
            executable(tmp_path / environment / "bin" / tool, "#!/bin/sh\n")
        (tmp_path / environment / "ready").touch()
    executable(tmp_path / "bin" / "id", "#!/bin/sh\necho 1000\n")  # installs nothing
    executable(tmp_path / "bin" / "python3.14", PYTHON)
    for program in NEEDED.values():
        executable(tmp_path / "bin" / program, "#!/bin/sh\n")
    return tmp_path


def run(folder, words, *ends):
    """Exit status, last lines and calls of pytest; ``ends`` are statuses with the words to which they belong."""
    (folder / "ends").write_text("".join(f"{end}\n" for end in ends))
    (folder / "asked").write_text("")
    search = os.pathsep.join([str(folder / "bin"), os.environ["PATH"]])
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")} | {"PATH": search}
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    asked = [line.rstrip("\t").split("\t") for line in (folder / "asked").read_text().splitlines()]
    return done.returncode, done.stdout, asked


def marks_of(asked):
    """Expression of the marks of the tests that a call of pytest selects."""
    arguments = [*SETTINGS["addopts"], *asked[3:]]
    return [after for word, after in itertools.pairwise(arguments) if word == "-m"][-1]


@pytest.mark.parametrize(("words", "nightly"), [([".ci/run"], False), ([shutil.which("make"), "nightly"], True)])
def test_every_test_is_in_a_part_of_continuous_integration_or_also_of_that_of_the_night(project, words, nightly):
    status, printed, asked = run(project, words)
    assert status == 0
    assert "FAILED" not in printed
    assert len(asked) == len(PARTS) + 2 * nightly
    for present in itertools.product([False, True], repeat=len(MARKS)):
        marks = dict(zip(MARKS, present, strict=True))
        assert nightly or marks["nightly"] or any(eval(marks_of(call), {}, marks) for call in asked), marks
        assert not nightly or any(eval(marks_of(call), {}, marks) for call in asked), marks


def test_every_test_in_a_browser_is_in_the_folder_that_its_part_collects():
    files = {path for path in (ROOT / "tests").rglob("*.py") if f"mark.{'browser'}" in path.read_text(encoding="utf-8")}
    folder = re.search(r"-m browser -rs (\S+)\"", (ROOT / ".ci" / "run").read_text(encoding="utf-8"))[1]
    assert len(files) > 2
    assert all(path.is_relative_to(ROOT / folder) for path in files)


def test_contributors_read_which_files_have_tests_of_the_night_only():
    nightly = {path.name for path in (ROOT / "tests").rglob("test_*.py") if f"mark.{'nightly'}" in path.read_text()}
    assert nightly == set(re.findall(r"`(test_\w+\.py)`", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")))


@pytest.mark.parametrize("part", PARTS)
def test_a_part_that_fails_fails_the_whole_after_all_others(project, part):
    status, printed, asked = run(project, [".ci/run"], f"1 {PARTS[part]}")
    assert status == 1
    assert printed.splitlines()[-1] == f"FAILED: {part}"
    assert len(asked) == len(PARTS) + (part == "slow tests"), "which have a second try"


def test_the_smoke_run_on_another_python_must_pass(project):
    executable(project / ".venv" / "newest" / "bin" / "stiction", "#!/bin/sh\nexit 3\n")
    status, printed, asked = run(project, [".ci/run"])
    assert status == 1
    assert printed.splitlines()[-1] == "FAILED: smoke run on Python 3.14.0"
    assert len(asked) == len(PARTS)


def test_another_python_leaves_the_workflow_to_its_smoke_run_and_the_computation_to_the_night(project):
    _, _, by_day = run(project, [".ci/run"])
    _, _, all_calls = run(project, [".ci/run", "nightly"])
    (ignored,) = [call[call.index("--ignore") :] for call in by_day if "--ignore" in call]
    computation = [folder for folder in ignored if folder not in ("--ignore", "tests/workflow")]
    assert {"tests/stages", "tests/beam"} <= set(computation)
    assert all((ROOT / folder).is_dir() for folder in computation)
    (at_night,) = [call for call in all_calls if call[-len(computation) :] == computation]
    assert ".venv/newest" in at_night[0]


@pytest.mark.parametrize("part", PARTS)
def test_a_part_whose_program_is_here_must_not_skip_a_test(project, part):
    status, printed, _ = run(project, [".ci/run"], f"skip {PARTS[part]}")
    assert status == (part in NEEDED)
    assert (printed.splitlines()[-1] == f"FAILED: {part} (some were skipped)") == (part in NEEDED)


@pytest.mark.parametrize("part", NEEDED)
@pytest.mark.parametrize("ends", [[], ["1 -m slow"]])
def test_a_part_that_cannot_run_here_is_named_last_with_the_reason(project, part, ends):
    script = project / ".ci" / "run"
    script.write_text(re.sub(rf"\b{NEEDED[part]} ", "absent ", script.read_text()))
    status, printed, asked = run(project, [".ci/run"], *ends)
    assert status == bool(ends)
    assert printed.splitlines()[-1] == f"NOT RUN: {part}: absent is not here and cannot be installed"
    assert not any(PARTS[part] in " ".join(call) for call in asked)


@pytest.mark.parametrize("part", ["fast tests", "slow tests"])
def test_the_output_of_parts_that_run_beside_the_first_and_the_slow_tests_follows_in_one_piece(project, part):
    status, printed, _ = run(project, [".ci/run"], f"meet {PARTS[part]}")
    assert status == 0, "these tests wait for the other Python"
    heads = [line.removeprefix("== ") for line in printed.splitlines() if line.startswith("== ")]
    order = ["fast tests", "slow tests", "fast tests on Python 3.14.0", "smoke run on Python 3.14.0"]
    order += ["tests with SLURM", "tests in a browser"]
    assert [head for head in heads if head in order] == order


def test_environments_are_complete_before_tests_start(project):
    (project / ".venv" / "newest" / "ready").unlink()
    status, _, asked = run(project, [".ci/run"], f"there {PARTS['fast tests']}")
    assert status == 0, "the first tests look for both environments"
    assert len(asked) == len(PARTS)


def test_all_parts_share_runs_in_a_folder_that_is_empty_before_and_gone_after(project):
    run(project, [".ci/run"])
    folders = {*(project / "shared").read_text().splitlines()}
    assert len(folders) == 1
    assert not Path(*folders).exists()


def test_parts_that_run_beside_others_must_reach_their_end(project):
    script = project / ".ci" / "run"
    script.write_text(script.read_text().replace("beside() {", "beside() { kill -KILL $BASHPID;"))
    status, printed, asked = run(project, [".ci/run"])
    assert status == 1
    assert printed.splitlines()[-1] == ("FAILED: tests on the newest Python, with SLURM and in a browser (ended early)")
    assert len(asked) == 2


def test_a_part_that_is_missing_fails_the_whole(project):
    makefile = project / "Makefile"
    makefile.write_text(makefile.read_text().replace("cluster", "other"))
    status, printed, _ = run(project, [".ci/run"])
    assert status == 1
    assert printed.splitlines()[-1] == "FAILED: tests with SLURM"


@pytest.mark.parametrize("part", ["tests with SLURM", "slow tests"])
def test_a_part_that_is_cut_off_fails_the_whole(project, part):
    script = project / ".ci" / "run"
    script.write_text(re.sub("limit=[0-9]+", "limit=2", script.read_text()))
    status, printed, _ = run(project, [".ci/run"], f"hang {PARTS[part]}")
    assert status == 1
    assert f"FAILED: {part} (cut off)" in printed


@pytest.mark.parametrize(
    ("ends", "tries", "passed"),
    [
        ([], 1, True),
        (["0 --last-failed", "1 slow"], 2, True),
        (["1 slow"], 2, False),
        (["5 --last-failed", "1 slow"], 2, False),
        (["0 --last-failed", "2 slow"], 1, False),
        (["0 --last-failed", "3 slow"], 1, False),
        (["0 --last-failed", "5 slow"], 1, False),
        (["0 --last-failed", "130 slow"], 1, False),
    ],
)
def test_slow_tests_have_a_second_try_only_if_all_were_run(project, ends, tries, passed):
    status, _, asked = run(project, [shutil.which("make"), "test-slow"], *ends)
    assert (status == 0) == passed
    assert len(asked) == tries

"""Fixtures that run the workflow as a user does: from the command line, in a temporary folder."""

import fcntl
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from browser import Browser
from planner import Planner

ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "workflow" / "smoke.yaml"

#: One case with very few samples, for tests of files rather than of numbers.
TINY = """
run: {pairs: [b]}
pairs: {b: {humidities: [0.88]}}
figures: {humidity: 0.88, pair: b}
character: {strips: 2}
identification: {patches: 2, patch_um: 2}
contact: {samples: 60, chunks: 2, distance_step_nm: 0.2, model: summits}
chaos: {order: 2}
beam: {samples: 4}
studies: {plasticity: {strips: 2}, orders: {draws: 1000}, sensitivity: {samples: 10},
          iteration: {iterations: 1, fields: 2}, variants: {samples: 20, beams: 2}, resampling: {beams: 4}}
"""
#: Dataset that depends on all stages of the main line.
BEAMS = "results/beams/b_rh088_NG.nc"


def command(directory, *arguments, configs=(SMOKE,), cores=2):
    """Arguments of a process that runs Snakemake with the project's Snakefile in ``directory``."""
    words = [sys.executable, "-m", "snakemake", "--snakefile", ROOT / "Snakefile", "--directory", directory]
    words += ["--profile", ROOT / "profiles" / "default", "--cores", cores, *arguments]
    words += ["--configfile", ROOT / "config.yaml", *configs]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    return {"args": list(map(str, words)), "cwd": ROOT, "env": environment, "text": True}


def snakemake(directory, *arguments, configs=(SMOKE,), cores=2, check=True):
    """Run Snakemake with the project's Snakefile in ``directory``; returns the finished process with its output."""
    words = command(directory, *arguments, configs=configs, cores=cores)
    done = subprocess.run(**words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if check and done.returncode:
        pytest.fail(f"snakemake stopped with {done.returncode}:\n{done.stdout[-6000:]}")
    return done


@pytest.fixture(scope="session")
def shared(tmp_path_factory):
    """Make a folder once: ``shared(name, fill)``; tests must not write into it.

    All processes of pytest-xdist share it, and all of continuous integration, which names a place in ``SHARED_RUNS``.
    """
    root = tmp_path_factory.getbasetemp()
    root = root.parent if "PYTEST_XDIST_WORKER" in os.environ else root
    root = Path(os.environ.get("SHARED_RUNS", root))

    def folder(name, fill):
        path, filled = root / name, root / f"{name}.filled"
        with (root / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not filled.exists():
                shutil.rmtree(path, ignore_errors=True)
                path.mkdir()
                fill(path)
                filled.touch()
        return path

    return folder


@pytest.fixture(scope="session")
def smoke(shared):
    """Folder of a finished smoke run: one pair, two humidities, all three models."""
    return shared("smoke", snakemake)


@pytest.fixture(scope="session")
def tiny(shared):
    """Path of the tiny configuration."""
    return shared("config", lambda folder: (folder / "tiny.yaml").write_text(TINY)) / "tiny.yaml"


@pytest.fixture(scope="session")
def undisturbed(shared, tiny):
    """Folder of a finished run of one tiny case."""
    return shared("undisturbed", lambda folder: snakemake(folder, BEAMS, configs=[tiny]))


def copied(folder, target, stages=()):
    """Copy of a finished run with Snakemake's record, without the files of some stages."""
    shutil.copytree(folder, target, dirs_exist_ok=True)
    for stage in stages:
        shutil.rmtree(target / "results" / stage)
    return target


def datasets(folder):
    """Content of every result file by name, without logs, temporary files, and the record and index of the last run."""
    results = Path(folder) / "results"
    kinds = ("nc", "csv", "md", "html", "pdf", "png")
    found = sorted(path for kind in kinds for path in results.rglob(f"*.{kind}") if path != results / "index.html")
    return {str(path.relative_to(results)): path.read_bytes() for path in found}


@pytest.fixture
def overlay(tmp_path):
    """Write a configuration overlay; returns its path."""

    def write(text):
        path = tmp_path / "mine.yaml"
        path.write_text(text)
        return path

    return write


@pytest.fixture(scope="module")
def planner(tmp_path_factory):
    """Snakemake in the root folder of the project."""
    planner = Planner(ROOT, tmp_path_factory.mktemp("printed"))
    yield planner
    planner.close()


@pytest.fixture(scope="module")
def browser():
    """Headless browser."""
    with Browser() as browser:
        yield browser


@pytest.fixture
def tree(done):
    """Source tree with all results up to date, which the module defines, restored after the test."""
    yield done
    done.git("checkout", "--force", "main")

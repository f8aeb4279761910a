"""Points of the estimate as jobs of a workflow of their own, and what makes them run again."""

import json
import subprocess
import sys

import pytest
from conftest import ROOT

from stiction.estimate.learning.jobs.families import FAMILIES

RULES = ROOT / "workflow" / "surrogate.smk"
CHUNK = "patches/control/0000"

pytestmark = pytest.mark.slow


def snakemake(folder, *arguments, rules=RULES):
    """Output of the workflow in a folder."""
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile",
        rules,
        "--directory",
        folder,
        "--cores",
        "1",
        *arguments,
    ]
    run = subprocess.run(list(map(str, command)), cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-3000:]
    return run.stdout + run.stderr


def jobs(folder, *targets, rules=RULES):
    """Number of jobs that the workflow would run."""
    lines = snakemake(folder, "-n", *targets, rules=rules).splitlines()
    return next((int(line.split()[-1]) for line in lines if line.startswith("total")), 0)


@pytest.fixture
def folder(tmp_path):
    """Folder with control numbers."""
    (tmp_path / "control.json").write_text(json.dumps({}))
    return tmp_path


def test_the_table_is_made_from_all_chunks(folder):
    assert jobs(folder) == 1 + sum(len(list(family.chunks())) for family in FAMILIES.values())


def test_bridges_run_after_the_patches_whose_change_they_read(folder):
    assert jobs(folder, CHUNK) == 1
    assert jobs(folder, "bridges/control/0000") == 2


def test_a_chunk_runs_again_after_other_control_numbers_or_another_effort(folder):
    snakemake(folder, CHUNK)
    assert (folder / CHUNK / "0000.npz").exists()
    assert jobs(folder, CHUNK) == 0
    other = folder / "other.smk"
    other.write_text(
        "from dataclasses import replace\n"
        "from stiction.estimate.learning import training\n"
        'training.SETS["control"] = replace(training.SETS["control"], patches=4)\n'
        f'include: "{RULES.as_posix()}"\n'
    )
    assert jobs(folder, CHUNK, rules=other) == 1
    (folder / "control.json").write_text(json.dumps({"other": 1}))
    assert jobs(folder, CHUNK) == 1

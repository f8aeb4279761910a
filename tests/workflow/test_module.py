"""The workflow as a module of another workflow, which states its changes alone."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import BEAMS, ROOT, TINY

USE = """
configfile: "config/config.yaml"

module stiction:
    snakefile: "{snakefile}"
    config: config
{prefix}

use rule * from stiction as {name}
"""
FIGURE = "results/figures/figure_05.png"
HANDLERS = """
onstart:
    stiction.onstart()

onsuccess:
    stiction.onsuccess()
"""


def run(folder, *targets, prefix=None, name="stiction_*"):
    """Run a workflow that uses this one, as the catalogue of Snakemake writes it."""
    folder.joinpath("config").mkdir(parents=True)
    folder.joinpath("config", "config.yaml").write_text(TINY)
    moved = f'    prefix: "{prefix}"' if prefix else ""
    folder.joinpath("Snakefile").write_text(
        USE.format(snakefile=ROOT / "workflow" / "Snakefile", prefix=moved, name=name)
    )
    words = [sys.executable, "-m", "snakemake", "--cores", "2", *targets]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.fixture(scope="module")
def renamed(tmp_path_factory):
    return run(tmp_path_factory.mktemp("renamed"), BEAMS, FIGURE)


@pytest.mark.slow
def test_a_module_with_renamed_rules_gives_the_bytes_of_the_workflow_itself(renamed, undisturbed):
    assert (renamed / BEAMS).read_bytes() == (undisturbed / BEAMS).read_bytes()
    caption = (renamed / FIGURE).with_suffix(".txt").read_text()
    assert "humidity 0.88" in " ".join(caption.split()), "of its own configuration"


@pytest.mark.slow
def test_a_module_can_write_below_a_prefix(renamed, tmp_path):
    below = run(tmp_path / "below", f"mems/{FIGURE}", prefix="mems", name="*")
    assert (below / "mems" / FIGURE).read_bytes() == (renamed / FIGURE).read_bytes()
    assert not (below / "results" / "figures").exists()


@pytest.fixture
def deployed(tmp_path):
    """Folder as snakedeploy makes it: a Snakefile with the module, and copies of the folders config and profiles."""
    for name in ("config", "profiles"):
        shutil.copytree(ROOT / name, tmp_path / name)
    (tmp_path / "workflow").mkdir()
    text = USE.format(snakefile=ROOT / "workflow" / "Snakefile", prefix="", name="*").replace(" as *", "")
    (tmp_path / "workflow" / "Snakefile").write_text(f"from snakemake.utils import min_version\n\n{text}")
    return tmp_path


def jobs(folder, *arguments):
    """Number of jobs by rule that a dry run plans."""
    words = [sys.executable, "-m", "snakemake", "-n", "-q", "rules", *arguments]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    counts = re.findall(r"^(\w+) +(\d+)$", done.stdout.split("Job stats:")[-1], re.MULTILINE)
    return {name: int(number) for name, number in counts}


@pytest.mark.slow
def test_the_first_command_in_a_deployed_folder_plans_the_paper(deployed):
    planned, own = jobs(deployed), jobs(deployed / "workflow", "-s", ROOT / "Snakefile", "--cores", "1")
    assert planned.pop("whole_workflow") == own.pop("all") == 1
    assert planned == own
    assert planned["total"] > 400


@pytest.mark.slow
def test_the_handlers_of_the_module_lock_check_and_record(deployed, undisturbed):
    (deployed / "config" / "config.yaml").write_text(TINY)
    with (deployed / "workflow" / "Snakefile").open("a") as snakefile:
        snakefile.write(HANDLERS)
    words = [sys.executable, "-m", "snakemake", BEAMS]
    done = subprocess.run(words, cwd=deployed, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (deployed / BEAMS).read_bytes() == (undisturbed / BEAMS).read_bytes()
    for written in ("results/provenance.json", "results/index.html", ".snakemake/running", ".snakemake/pilot.json"):
        assert (deployed / written).exists(), written

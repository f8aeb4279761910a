"""The workflow as a module of another workflow, which states its changes alone."""

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

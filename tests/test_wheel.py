"""The package installed from its wheel works in any folder, without checkout and without Snakemake."""

import json
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

import stiction

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
#: Prepares a Python with the wheel and the libraries, but without Snakemake and any other stiction.
PREPARE = """
import importlib.abc, json, sys

class Refused(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name.split(".")[0].startswith("snakemake"):
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, Refused())
sys.path[:0] = sys.argv[1:]
import stiction
"""
WALK = """
from stiction.report import style
from stiction.run import provenance

names = [getattr(stiction, name).__name__ for name in stiction.__all__]
provenance.record("provenance.json", ".", stiction.load("mine.yaml"))
files = [module.__file__ for name, module in sys.modules.items() if name.split(".")[0] == "stiction"]
print(json.dumps([stiction.__version__, stiction.load(), files]))
"""
BEAMS = """
study = stiction.PairStudy.of(stiction.load("mine.yaml"), "b")
print(json.dumps(study.beams(0.8).crack_length.values.tolist()))
"""
MINE = """
contact: {samples: 40}
chaos: {order: 3}
beam: {samples: 2, width_um: 6}
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder into which the wheel of this checkout is installed."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    shutil.copytree(ROOT / "src", source / "src", ignore=shutil.ignore_patterns("*.egg-info", "__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    subprocess.run([*pip, "wheel", "--no-deps", "--no-build-isolation", "-w", folder, source], check=True)
    (wheel,) = folder.glob("*.whl")
    subprocess.run([*pip, "install", "--no-deps", "--no-compile", "--target", folder / "site", wheel], check=True)
    return folder / "site"


def test_the_wheel_holds_all_files_that_the_package_reads(site):
    names = ("config/schema.yaml", "config/paper.yaml", "report/stiction.mplstyle", "py.typed")
    for name in names:
        assert (site / "stiction" / name).read_bytes() == (ROOT / "src" / "stiction" / name).read_bytes()
    modules = {path.relative_to(ROOT / "src") for path in (ROOT / "src" / "stiction").rglob("*.py")}
    assert modules == {path.relative_to(site) for path in (site / "stiction").rglob("*.py")}


@pytest.fixture
def alone(site, tmp_path):
    """Run a program on the wheel in a folder with one configuration file; returns what it prints as JSON."""
    (tmp_path / "mine.yaml").write_text(MINE, encoding="utf-8")

    def run(program):
        command = [sys.executable, "-I", "-S", "-c", PREPARE + program, site, sysconfig.get_paths()["purelib"]]
        done = subprocess.run(list(map(str, command)), cwd=tmp_path, capture_output=True, text=True)
        assert not done.returncode, done.stderr
        return json.loads(done.stdout)

    return run


def test_public_names_configuration_and_provenance_need_neither_checkout_nor_snakemake(site, alone, tmp_path):
    version, paper, files = alone(WALK)
    assert files
    assert all(Path(file).is_relative_to(site) for file in files)
    assert (version, paper) == (stiction.__version__, stiction.load())
    (run,) = json.loads((tmp_path / "provenance.json").read_text(encoding="utf-8"))
    assert run["config"]["contact"]["samples"] == 40


def test_beams_are_computed_without_checkout_and_snakemake(alone):
    cracks = alone(BEAMS)
    assert len(cracks) == 2
    assert all(0 < crack < 1500e-6 for crack in cracks)

"""The package installed from its wheel works in any folder, without checkout; all but its runs without Snakemake."""

import json
import os
import re
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
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE", "Snakefile", "config.yaml"):
        shutil.copy(ROOT / name, source)
    for name in ("workflow", "profiles", "examples"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    subprocess.run([*pip, "wheel", "--no-deps", "--no-build-isolation", "-w", folder, source], check=True)
    (wheel,) = folder.glob("*.whl")
    subprocess.run([*pip, "install", "--no-deps", "--no-compile", "--target", folder / "site", wheel], check=True)
    return folder / "site"


def test_the_wheel_holds_all_files_that_the_package_reads(site):
    names = ["config/schema.yaml", "config/paper.yaml", "command/study.yaml", "report/stiction.mplstyle", "py.typed"]
    names += ["stages/devices/paper_lengths.csv"]
    package = ROOT / "src" / "stiction"
    report = [path for kind in ("templates/*", "**/*.yaml") for path in (package / "report").glob(kind)]
    assert len(report) > 5
    names += [str(path.relative_to(package)) for path in report]
    for name in names:
        assert (site / "stiction" / name).read_bytes() == (ROOT / "src" / "stiction" / name).read_bytes()
    modules = {path.relative_to(ROOT / "src") for path in (ROOT / "src" / "stiction").rglob("*.py")}
    travelled = {path.relative_to(site) for path in (site / "stiction").rglob("*.py")}
    assert modules == {path for path in travelled if path.parts[1] != "project"}


def test_the_wheel_holds_the_workflow_as_it_is_in_the_repository(site):
    project = site / "stiction" / "project"
    names = ["Snakefile", "config.yaml", "examples/devices.yaml"]
    for folder in ("workflow", "profiles"):
        files = (path for path in (ROOT / folder).rglob("*") if path.is_file() and path.suffix != ".pyc")
        names += [path.relative_to(ROOT).as_posix() for path in files]
    found = {path.relative_to(project).as_posix(): path for path in project.rglob("*") if path.is_file()}
    assert set(found) == set(names)
    for name, path in found.items():
        assert path.read_bytes() == (ROOT / name).read_bytes()


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


@pytest.mark.nightly
def test_beams_are_computed_without_checkout_and_snakemake(alone):
    cracks = alone(BEAMS)
    assert len(cracks) == 2
    assert all(0 < crack < 1500e-6 for crack in cracks)


@pytest.fixture(scope="module")
def python(site, tmp_path_factory):
    """Python of a virtual environment that holds the wheel, and finds the libraries but no other stiction."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    (packages,) = folder.glob("lib/python*/site-packages")
    # The folder of the libraries is not searched for .pth files, of which one leads to the checkout.
    (packages / "libraries.pth").write_text(f"{site}\n{sysconfig.get_paths()['purelib']}\n", encoding="utf-8")
    return folder / "bin" / "python"


@pytest.fixture
def command(python, tmp_path):
    """Run the command of the wheel in an empty folder; returns its exit status and what it prints."""

    def run(*words):
        call = [python, "-m", "stiction.command.main", *words]
        environment = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "PYTHON"))}
        done = subprocess.run(
            call, cwd=tmp_path, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        return done.returncode, done.stdout

    return run


def test_the_wheel_installs_the_command_and_the_plugin_of_snakemake(site):
    (scripts,) = site.glob("*.dist-info/entry_points.txt")
    assert "stiction = stiction.command.at_once.entry:main" in scripts.read_text(encoding="utf-8")
    assert (site / "snakemake_logger_plugin_stiction" / "__init__.py").exists()


def test_the_command_plans_every_kind_of_run_in_an_empty_folder(command, tmp_path):
    status, printed = command("init")
    assert status == 0, printed
    status, printed = command("check", "study.yaml")
    assert status == 0, printed
    assert printed.startswith("study.yaml can run: pair mine.\nIt takes about "), printed
    for words in (("paper",), ("devices",), ("run", "study.yaml"), ("figures", "study.yaml")):
        status, printed = command(*words, "--dry-run")
        assert status == 0, printed
        assert re.match(r"\d+ jobs would run, about .* for each job\.\n", printed), printed
    assert command("report")[0] == 2
    assert {path.name for path in tmp_path.iterdir()} - {".snakemake"} == {"study.yaml", "stiction.schema.json"}


def test_jobs_run_in_an_empty_folder_on_the_code_of_the_wheel(command, site, tmp_path):
    (tmp_path / "tiny.yaml").write_text("identification: {patches: 2, patch_um: 2}\n", encoding="utf-8")
    targets = ["results/heights/B1.nc", "results/tables/table_2.csv"]
    status, printed = command("run", "tiny.yaml", "--", *targets)
    assert status == 0, printed
    assert all((tmp_path / target).exists() for target in targets)
    (run,) = json.loads((tmp_path / "results" / "provenance.json").read_text(encoding="utf-8"))
    assert run["git"] is None
    (log,) = (tmp_path / ".snakemake" / "log").glob("*.log")
    assert f"Snakefile: {site}" in log.read_text(encoding="utf-8")

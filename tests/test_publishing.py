"""Files for those who publish the package: they agree with each other and with the package."""

import json
import re
from pathlib import Path

import pytest
import yaml

import stiction

tomllib = pytest.importorskip("tomllib")
ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
ARCHIVE = json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))
DOCS = yaml.safe_load((ROOT / ".readthedocs.yaml").read_text(encoding="utf-8"))
WORKFLOWS = {path.stem: yaml.safe_load(path.read_text()) for path in (ROOT / ".github" / "workflows").glob("*.yml")}


def test_package_citation_and_archive_say_the_same():
    assert PROJECT["version"] == CITATION["version"] == ARCHIVE["version"] == stiction.__version__
    assert PROJECT["license"] == CITATION["license"] == ARCHIVE["license"]
    people = [[one["name"] for one in of] for of in (PROJECT["authors"], CITATION["authors"], ARCHIVE["creators"])]
    assert people[0] == people[1] == people[2]
    assert ARCHIVE["description"] == " ".join(CITATION["abstract"].split())
    assert set(PROJECT["keywords"]) == set(CITATION["keywords"]) == set(ARCHIVE["keywords"])


def test_the_classifiers_name_the_versions_of_python_that_the_readme_names():
    versions = re.findall(r"Python :: 3\.(\d+)", " ".join(PROJECT["classifiers"]))
    low, high = re.search(r"Python 3\.(\d+) to 3\.(\d+)", (ROOT / "README.md").read_text(encoding="utf-8")).groups()
    assert list(map(int, versions)) == list(range(int(low), int(high) + 1))
    assert PROJECT["requires-python"] == f">=3.{low}"


def test_the_host_of_the_docs_installs_extras_that_exist_and_builds_the_settings_here():
    (install,) = DOCS["python"]["install"]
    assert set(install["extra_requirements"]) <= PROJECT["optional-dependencies"].keys()
    assert (ROOT / DOCS["sphinx"]["configuration"]).is_file()


def test_the_workflow_runs_what_a_person_runs():
    (tests,) = WORKFLOWS["ci"]["jobs"].values()
    commands = [step["run"].split()[0] for step in tests["steps"] if "run" in step]
    assert commands == [".ci/run"]
    assert (ROOT / commands[0]).stat().st_mode & 0o100

"""A run speaks of files of its own configuration: of verdict, tables and figures of other settings it says so."""

import json
from functools import cache
from itertools import chain

import pytest
import yaml
from conftest import SMOKE, copied
from test_command import stiction

from stiction.config.files import load
from stiction.plan.graph import Graph, structured
from stiction.plan.plan import Plan
from stiction.plan.planner import ALL_TARGETS, Planner
from stiction.run.disk_cache import DiskCache
from stiction.run.logs import recorded_origins

#: Changes of a configuration: of all results, of few, of none that is computed.
CHANGES = ["seed: 2", "surfaces: {B2: {kurtosis: 4.5}}", "chaos: {order: 5}", "figures: {humidity_points: 7}", "{}"]


@cache
def planned(change):
    """Planner and graph of the smoke run with a change."""
    config = load(SMOKE, yaml.safe_load(change))
    return Planner(config, {}, DiskCache("none"), DiskCache("none")), Graph(Plan(config))


def texts(planner):
    """Files without a label that a whole run wants."""
    wanted = chain.from_iterable(rule["wanted"] for rule in planner.rules)
    return [file for file in wanted if not file.endswith(".nc")]


def everything_behind(graph, file, seen):
    """Settings of all jobs behind a file, by a walk from job to job."""
    if file in seen:
        return seen
    job = graph.job(file)
    seen[file], read = json.dumps(job.settings, sort_keys=True, default=str), []
    for names in job.inputs.values():
        structured(names, read.append)
    for name in read:
        inside = str(name).removeprefix("results/")
        if not str(name).startswith("/"):
            everything_behind(graph, inside, seen)
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_origins_differ_where_the_settings_of_any_job_behind_a_file_do(change):
    (planner, graph), (other, changed) = planned(CHANGES[-1]), planned(change)
    found = {file: planner.origin(file) != other.origin(file) for file in texts(planner)}
    walked = [file.removeprefix("results/") for file in found]
    expected = [everything_behind(graph, file, {}) != everything_behind(changed, file, {}) for file in walked]
    assert found == dict(zip(found, expected, strict=True))
    assert any(expected) == (change != CHANGES[-1])


@pytest.mark.slow
def test_what_jobs_note_from_the_labels_of_their_inputs_is_what_the_plan_expects(smoke):
    planner, _ = planned(CHANGES[-1])
    noted = recorded_origins(smoke / "results" / "logs")
    wanted = {file for target in ALL_TARGETS for file in planner.files_of(target) if not file.endswith(".nc")}
    assert set(noted) >= wanted
    assert len(wanted) > 50
    assert noted == {file: planner.origin(file) for file in noted}


@pytest.mark.slow
def test_a_run_speaks_only_of_files_of_its_configuration(smoke, tmp_path, overlay):
    folder, other = copied(smoke, tmp_path / "run"), overlay("seed: 2")
    record = (folder / "results" / "provenance.json").read_bytes()
    status, printed = stiction(folder, "run", SMOKE, other, "--", "--touch")
    assert (status, printed[-1][:46]) == (2, "--touch would mark files of other settings as ")
    assert (folder / "results" / "provenance.json").read_bytes() == record
    for asked in (["results/heights/B2.nc"], ["results/identification/B2.nc"]):
        status, printed = stiction(folder, "run", SMOKE, other, "--", *asked)
        assert status == 0
        assert printed[-1].startswith("Not computed in this run: results/verdict.txt was made with other settings (and")
        assert not any("checks of the results" in line for line in printed)
    assert json.loads((folder / "results" / "provenance.json").read_text())[-1]["config"]["seed"] == 2
    assert stiction(folder, "show")[0] == 0
    page = (folder / "results" / "index.html").read_text(encoding="utf-8")
    assert "checks of the results" not in page
    origin = planned("seed: 2")[0].origin
    others = [file for file, noted in recorded_origins(smoke / "results" / "logs").items() if origin(file) != noted]
    assert len(others) > 30
    assert not [file for file in others if f'"{file.removeprefix("results/")}"' in page]
    status, printed = stiction(folder, "report", SMOKE, other)
    assert (status, printed[-1][:25]) == (2, "results/verdict.txt was m")


@pytest.mark.slow
def test_files_of_the_same_configuration_can_be_touched_and_are_spoken_of(smoke, tmp_path):
    status, printed = stiction(copied(smoke, tmp_path / "run"), "run", SMOKE, "--", "--touch", "--forceall")
    assert status == 0
    assert any("checks of the results passed" in line for line in printed)
    assert "Not computed" not in printed[-1]

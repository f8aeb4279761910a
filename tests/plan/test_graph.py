"""Jobs that follow from the declarations: names, settings and inputs agree with each other, for every stage."""

import json
from pathlib import Path

import pytest
import yaml

from stiction.config.files import load
from stiction.config.plan import Plan
from stiction.plan.graph import Graph, stages
from stiction.plan.planner import Planner
from stiction.plan.stage import File, Stage

ROOT = Path(__file__).parents[2]
#: The paper, and the devices of the example, which need every stage that no measured surface needs.
PLAN = Plan(load(yaml.safe_load((ROOT / "examples" / "devices.yaml").read_text())))
GRAPH = Graph(PLAN)
#: Stages of surfaces described by scans; `tests/workflow/test_from_scans.py` runs them.
OF_SCANS = {"scan", "estimate", "heights_of_scans", "spectrum_of_scans", "choice_contact", "scan_uncertainty"}


def listed(names):
    """Names of an input."""
    if isinstance(names, str):
        return [names]
    return list(names.values() if isinstance(names, dict) else names)


def reached():
    """All jobs behind the files that the targets want, by the first name of each."""
    wanted = [
        name.format(**at)
        for stage, _ in stages().values()
        if stage.targets
        for at in stage.jobs(PLAN)
        for name in stage.files.values()
    ]
    wanted += [f"devices/{stage}/{case}" for stage in ("safe_lengths", "cracks") for case in PLAN.designs.cases]
    wanted += [f"devices/chart/{case}" for name in PLAN.designs.charted for case in PLAN.designs.chart_cases(name)]
    wanted += [f"devices/stoppers/{name}" for name in PLAN.designs.stoppers]
    wanted += [f"devices/budget/{name}" for name in PLAN.designs.budgets()]
    jobs = {}
    while wanted:
        name = wanted.pop()
        if name in jobs or isinstance(name, File):
            continue
        jobs[name] = job = GRAPH.job(name)
        wanted += [inner for names in job.inputs.values() for inner in listed(names)]
    return jobs


JOBS = reached()


def test_every_stage_has_a_job():
    assert {job.stage.name for job in JOBS.values()} | OF_SCANS >= {
        name for name, (stage, _) in stages().items() if stage.save is None
    } - {"slopes"}


def test_a_job_writes_the_file_by_which_it_is_found():
    for name, job in JOBS.items():
        assert name in job.names


def test_the_settings_of_every_job_are_those_that_its_stage_takes():
    for job in JOBS.values():
        plain = json.loads(json.dumps(job.settings))  # as Snakemake passes them on
        job.stage.converted(plain)


def test_a_name_of_no_stage_is_refused():
    with pytest.raises(KeyError, match="no stage writes nothing/of/this"):
        GRAPH.job("nothing/of/this")


def test_no_two_stages_write_the_same_file():
    for name, job in JOBS.items():
        others = [stage for stage, matches in GRAPH._expressions if matches.fullmatch(name)]
        assert others == [job.stage], name


@pytest.fixture
def planner(tmp_path):
    return Planner(PLAN.config, {}, lambda _, compute: compute(), tmp_path / "jobs.json")


def test_the_workflow_plans_the_jobs_of_the_declarations(planner):
    for name in (
        "contact/b_NG",
        "studies/slopes/contact/b_B2_rms_less",
        "devices/cracks/C1_rh067",
        "tables/table_3.csv",
    ):
        job = GRAPH.job(name)
        planned = planner.job(job.stage.name, vars(job.at))
        assert planned["settings"] == json.loads(json.dumps(job.settings))
        datasets = [
            f"results/{inner}.nc" for names in job.inputs.values() for inner in listed(names) if type(inner) is str
        ]
        assert [file for files in planned["files"].values() for file in files if file.endswith(".nc")] == datasets


def test_a_repeated_plan_needs_no_declaration_and_a_change_of_the_configuration_does(planner, tmp_path, monkeypatch):
    job = {"case": "b_rh067", "model": "NG"}
    first = planner.rules, planner.job("beams", job), planner.settings("results/beams/b_rh067_NG.nc")
    planner.save()

    def forbidden(*_):
        raise AssertionError("a declaration was read")

    monkeypatch.setattr(Graph, "job", forbidden)
    monkeypatch.setattr(Stage, "patterns", forbidden)
    again = Planner(PLAN.config, {}, lambda _, compute: compute(), tmp_path / "jobs.json")
    assert (again.rules, again.job("beams", job), again.settings("results/beams/b_rh067_NG.nc")) == first
    other = Planner(PLAN.config | {"seed": 2}, {}, lambda _, compute: compute(), tmp_path / "jobs.json")
    with pytest.raises(AssertionError, match="a declaration was read"):
        other.rules  # noqa: B018


def test_what_is_kept_depends_on_declarations_and_plans_although_fingerprints_leave_them_out(planner):
    reached = {name for code in planner._codes.values() for name in code}
    assert {
        f"stiction.{name}" for name in ("plan.stage", "plan.names", "stages.devices.patch_settings", "config.plan")
    } <= reached


def test_a_dataset_of_no_job_has_no_settings(planner):
    assert planner.settings("results/beams/nope_rh067_NG.nc") is None
    assert planner.settings("results/other/file.nc") is None

"""Jobs that follow from the declarations: names, settings and inputs agree with each other, for every stage."""

import json
import shutil
from inspect import Parameter, signature
from pathlib import Path

import every_stage
import pytest
from snakemake.iocontainers import Namedlist

from stiction.config.files import load
from stiction.config.relations import schema
from stiction.plan.graph import Graph, stages
from stiction.plan.plan import Plan
from stiction.plan.planner import NotPlanned, Planner
from stiction.plan.stage import File, Stage
from stiction.report import html
from stiction.report.style import STUDIES
from stiction.run.disk_cache import DiskCache
from stiction.run.fingerprint import PACKAGE, SILENT, fingerprint

ROOT = Path(__file__).parents[2]
PLAN = every_stage.of_paper_and_devices()
GRAPH, SCHEMA = Graph(PLAN), schema()
#: Stages of surfaces described by scans; `tests/workflow/test_from_scans.py` runs them.
OF_SCANS = {"scan", "estimate", "heights_of_scans", "spectrum_of_scans", "choice_contact", "scan_uncertainty"}
#: Corrections of curves of roughness in dry air; `tests/stages/axes` runs them.
OF_DRY_AIR = {"full_contact_dry", "pair_model_error_dry", "tips_in_full_contact_dry"}
#: Beams of a few sizes for many devices; `tests/stages/devices/test_cracks.py` runs them.
OF_MANY = {"sizes"}
#: Contacts on members of assumed surfaces; `tests/stages/devices/test_members_of_budgets.py` runs them.
OF_MEMBERS = {"device_member_contact", "tip_member_contact"}


def listed(names):
    """Names of an input."""
    if isinstance(names, str):
        return [names]
    return list(names.values() if isinstance(names, dict) else names)


def reached():
    """All jobs behind the files that the targets want, by the first name of each."""
    wanted = every_stage.wanted(PLAN)
    wanted += [f"devices/{stage}/{case}" for stage in ("safe_lengths", "cracks") for case in PLAN.devices.cases]
    wanted += [f"devices/chart/{case}" for name in PLAN.devices.with_chart for case in PLAN.devices.chart_cases(name)]
    wanted += [f"devices/stoppers/{name}" for name in PLAN.devices.stoppers]
    wanted += [f"devices/budget/{name}" for name in PLAN.devices.budgets()]
    wanted += [
        f"devices/{stage}/{name}" for stage in ("model_error", "left_out_gaps") for name in PLAN.devices.sections
    ]
    wanted += [f"studies/model_error/{between}{pair}" for between in ("", "across/") for pair in PLAN.pairs]
    wanted += ["process/settings/etch_time_s", "process/pairs/Bump"]
    return behind(GRAPH, wanted)


def behind(graph, wanted):
    """All jobs behind some files, by the first name of each."""
    jobs = {}
    while wanted:
        name = wanted.pop()
        if name in jobs or isinstance(name, File):
            continue
        jobs[name] = job = graph.job(name)
        wanted += [inner for names in job.inputs.values() for inner in listed(names)]
    return jobs


JOBS = reached()


def test_every_stage_has_a_job():
    assert {job.stage.name for job in JOBS.values()} | OF_SCANS | OF_DRY_AIR | OF_MANY | OF_MEMBERS >= {
        name for name, (stage, _) in stages().items() if stage.save is None
    } - {"slopes"}


def test_a_job_writes_the_file_by_which_it_is_found():
    for name, job in JOBS.items():
        assert name in job.names


def test_the_settings_of_every_job_are_those_that_its_stage_takes():
    for job in JOBS.values():
        plain = json.loads(json.dumps(job.settings))  # as Snakemake passes them on
        job.stage.converted(plain)


def test_no_input_or_file_of_a_job_has_a_name_that_snakemake_reserves():
    """As ``update`` is: a workflow with such a job ends before it starts."""
    reserved = set(dir(Namedlist)) - {"index", "sort"}
    assert "update" in reserved
    for name, job in JOBS.items():
        assert not reserved & {*job.inputs, *job.stage.files}, name


def _single(job):
    """Settings that a computation takes one by one."""
    is_whole = job.stage.kind or "settings" in signature(job.stage.compute).parameters
    return set() if is_whole else {*job.settings}


def test_every_computation_gets_what_its_parameters_name():
    for name, job in JOBS.items():
        arguments = {*_single(job), *job.inputs, *vars(job.at), "settings", "data", "at"}
        parameters = signature(job.stage.compute).parameters.values()
        assert {parameter.name for parameter in parameters if parameter.default is Parameter.empty} <= arguments, name


def test_no_two_of_the_inputs_and_wildcards_of_a_job_have_the_same_name():
    """A computation takes them by their names."""
    for name, job in JOBS.items():
        assert not {*job.inputs, "data", "at", "settings"} & {*vars(job.at)}, name
        assert not {"data", "at", "settings"} & {*job.inputs}, name
        assert not {"data", "at", "settings", *job.inputs, *vars(job.at)} & _single(job), name


def test_the_code_of_a_stage_has_all_that_its_jobs_run_and_no_declaration():
    for name, (stage, _) in stages().items():
        code = fingerprint(PACKAGE.parent / f"{stage.code.replace('.', '/')}.py")
        run = {part.__module__ for part in (stage.compute, stage.save, stage.running.first, stage.kind) if part}
        assert run - {"builtins"} <= code.keys(), name
        assert stage.code not in SILENT, name


def test_a_name_of_no_stage_is_refused():
    with pytest.raises(KeyError, match="no stage writes nothing/of/this"):
        GRAPH.job("nothing/of/this")


def test_no_two_stages_write_the_same_file():
    for name, job in JOBS.items():
        others = [stage for stage, matches in GRAPH._expressions if matches.fullmatch(name)]
        assert others == [job.stage], name


def without_studies(*studies):
    """Jobs of the paper with only some of its studies."""
    plan = Plan(load({"run": {"studies": list(studies)}}))
    return behind(Graph(plan), every_stage.wanted(plan))


def studied(jobs):
    """Names of the stages of studies among jobs."""
    return {job.stage.name for name, job in jobs.items() if name.startswith(("studies/", "iteration/"))}


def test_the_paper_runs_all_its_studies_and_a_configuration_without_studies_none_of_them():
    assert len(studied(JOBS)) > 10
    assert not studied(without_studies())
    assert studied(without_studies("mesh", "orders")) == {"mesh", "correlation", "orders"}


def test_without_studies_all_other_jobs_are_the_same():
    few = without_studies()
    assert {"table_3", "figure_14", "beams", "verdict"} <= {job.stage.name for job in few.values()}
    reduced = {"checks", "model_limits"}  # which read the results of studies, and the latter says how to run one
    for name, job in few.items():
        assert job.settings == JOBS[name].settings or job.stage.name == "model_limits"
        assert job.inputs == JOBS[name].inputs or job.stage.name in reduced


def test_every_study_of_the_paper_can_be_selected():
    listed = SCHEMA["properties"]["run"]["properties"]["studies"]["items"]["enum"]
    assert {*listed, "slopes"} == set(PLAN.config["studies"]), "slopes are part of errors, not a study of their own"
    assert {stage.study for stage, _ in stages().values()} == {*listed, ""}


def test_every_figure_has_its_caption_and_those_of_studies_of_the_paper_are_also_study_figures():
    for name, (stage, _) in stages().items():
        if "png" in stage.files:
            assert (ROOT / "workflow" / "report" / f"{stage.shown.caption}.rst").is_file(), name
            of_paper = stage.shown.category == STUDIES and stage.targets != (stage.study,)
            assert {*stage.targets} >= {"figures", "study_figures"} if of_paper else stage.targets, name


def test_whatever_writes_html_has_its_template_among_its_inputs():
    page = {*html.files("page.html")}
    written = [job for job in JOBS.values() if "html" in job.stage.files]
    assert len({job.stage.name for job in written}) > 10
    for job in written:
        read = {*listed(job.inputs["templates"])}
        assert read >= (page if job.stage.name == "device_page" else {*html.files("table.html")}), job.stage.name


@pytest.mark.parametrize(("figure", "table"), [("chart", "chart"), ("risk", "devices")])
def test_figures_of_devices_have_the_data_and_warnings_of_their_tables(figure, table):
    """Charts also mark the size to build."""
    drawn, written = GRAPH.job(f"figures/{figure}.png").inputs, GRAPH.job(f"tables/{table}.md").inputs
    of_figure = {"style", *(["answers"] if figure == "chart" else [])}
    assert {name: drawn[name] for name in drawn if name not in of_figure}.items() <= written.items()
    assert drawn["warnings"]


def computed(_, compute):
    """Result that nothing keeps."""
    return compute()


def test_without_pairs_only_devices_and_scans_are_wanted():
    config = PLAN.config | {"run": {"pairs": []}}
    whole, devices = (
        {rule["name"]: rule for rule in Planner(each, {}, computed, computed).rules} for each in (PLAN.config, config)
    )
    wanted = {name for name, rule in devices.items() if rule["wanted"]}
    assert wanted == {name for name, rule in whole.items() if "devices" in rule["targets"] and rule["wanted"]}
    assert wanted < {name for name, rule in whole.items() if rule["wanted"]}


@pytest.fixture
def jobs(tmp_path):
    """What is kept of the jobs of a plan."""
    return DiskCache(tmp_path / "jobs.json")


@pytest.fixture
def planner(jobs):
    return Planner(PLAN.config, {}, computed, jobs)


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


def test_a_file_with_a_name_that_the_configuration_lacks_is_refused_in_words(planner):
    pressed = next(rule for rule in planner.rules if rule["name"] == "pressed")
    assert planner.inputs(pressed, {"pair": "c"}) == planner.job("pressed", {"pair": "c"})["files"]
    with pytest.raises(NotPlanned, match="results/studies/pressing/a.nc .* the configuration has no 'a' for it"):
        planner.inputs(pressed, {"pair": "a"})
    assert planner.settings("results/studies/pressing/a.nc") is None


def test_a_key_that_a_declaration_lacks_is_no_fault_of_the_name_of_a_file(planner, monkeypatch):
    pressed = next(rule for rule in planner.rules if rule["name"] == "pressed")
    monkeypatch.setattr(Planner, "job", lambda *_: {}["seed"])
    with pytest.raises(KeyError, match="seed"):
        planner.inputs(pressed, {"pair": "a"})


def test_a_repeated_plan_needs_no_declaration_and_a_change_of_the_configuration_does(
    planner, jobs, tmp_path, monkeypatch
):
    job = {"case": "b_rh067", "model": "NG"}
    first = planner.rules, planner.job("beams", job), planner.settings("results/beams/b_rh067_NG.nc")
    jobs.save()

    def forbidden(*_):
        raise AssertionError("a declaration was read")

    monkeypatch.setattr(Graph, "job", forbidden)
    monkeypatch.setattr(Stage, "patterns", forbidden)
    again = Planner(PLAN.config, {}, computed, DiskCache(tmp_path / "jobs.json"))
    assert (again.rules, again.job("beams", job), again.settings("results/beams/b_rh067_NG.nc")) == first
    other = Planner(PLAN.config | {"seed": 2}, {}, computed, DiskCache(tmp_path / "jobs.json"))
    with pytest.raises(AssertionError, match="a declaration was read"):
        other.rules  # noqa: B018


@pytest.mark.parametrize(
    "file", ["plan/plan.py", "plan/stage.py", "stages/contact/changes/table.py", "models.py", "config/paper.yaml"]
)
def test_what_is_kept_depends_on_all_code_also_where_fingerprints_leave_it_out(planner, tmp_path, monkeypatch, file):
    copy = shutil.copytree(PACKAGE, tmp_path / "stiction", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr("stiction.plan.planner.PACKAGE", copy)

    def planned():
        return Planner(PLAN.config, {}, computed, computed)

    assert planned()._determined_by == planner._determined_by
    with (copy / file).open("a", encoding="utf-8") as text:
        text.write("# another comment")
    assert planned()._determined_by != planner._determined_by


def test_a_dataset_of_no_job_has_no_settings(planner):
    assert planner.settings("results/beams/nope_rh067_NG.nc") is None
    assert planner.settings("results/other/file.nc") is None

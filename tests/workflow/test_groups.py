"""What a cluster would be given of a study of many devices: few jobs, each of many, that know the plan of the run."""

import json
import os
import subprocess
import sys
from collections import Counter

import pytest
import yaml
from conftest import ROOT

from stiction.plan.graph import stages
from stiction.run.atomic import save_text

PROFILE = ROOT / "profiles" / "slurm"
#: A dry run that prints the rules and the resources of every job, and of every group of jobs.
PRINTING = """
import json, sys
from snakemake.cli import main
from snakemake.executors.dryrun import Executor

def run_job(self, job, run=Executor.run_job):
    jobs = list(job.jobs) if job.is_group() else [job]
    said = {key: value for key, value in job.resources.items() if key in ("_cores", "mem_mb", "runtime")}
    print("JOB", json.dumps([[each.rule.name for each in jobs], said]), flush=True)
    run(self, job)

Executor.run_job = run_job
main(sys.argv[1:])
"""


@pytest.mark.slow
def test_a_study_of_many_devices_is_submitted_as_few_jobs_of_one_core_each(tmp_path):
    devices = {
        f"D{k}": {"kind": "cantilever", "pair": "b", "thickness_um": 2 + k / 30, "gap_um": 20, "width_um": 30}
        | {"humidities": [0.44, 0.67]}
        for k in range(60)
    }
    study = tmp_path / "study.yaml"
    study.write_text(json.dumps({"run": {"pairs": []}, "devices": devices}))
    words = [sys.executable, "-c", PRINTING, "--snakefile", ROOT / "Snakefile", "--directory", tmp_path]
    words += ["--workflow-profile", PROFILE, "--executor", "local", "-n", "--configfile", ROOT / "config.yaml", study]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run([*map(str, words), "--", "devices"], env=environment, text=True, capture_output=True)
    lines = [line.partition(" ")[2] for line in done.stdout.splitlines() if line.startswith("JOB")]
    on_cluster = {name for name, (stage, _) in stages().items() if stage.running.minutes}
    jobs = [(Counter(rules), resources) for rules, resources in map(json.loads, lines)]
    submitted = [(rules, resources) for rules, resources in jobs if rules.keys() & on_cluster]
    cracks = [(rules.total(), said) for rules, said in submitted if "cracks" in rules]
    assert sorted(number for number, _ in cracks) == [20, 50, 50], done.stderr
    for number, reserved in cracks:
        assert reserved == {"_cores": 1, "mem_mb": 800, "runtime": 10 * number}
    assert sum("tip_contact" in rules for rules, _ in submitted) == 1
    assert len(submitted) < 12
    assert all(rules.keys() <= on_cluster for rules, _ in submitted)


def test_grouped_rules_are_submitted_and_every_group_has_a_size():
    profile = yaml.safe_load((PROFILE / "config.yaml").read_text(encoding="utf-8"))
    grouped = dict(entry.split("=") for entry in profile["groups"])
    sizes = dict(entry.split("=") for entry in profile["group-components"])
    assert {"cracks", "beams"} <= grouped.keys()
    assert all(stages()[name][0].running.minutes for name in grouped)
    assert set(grouped.values()) == sizes.keys()
    assert profile["cores"] == 1, "the jobs of a group run one after the other"


#: Options with which Snakemake starts a job on another machine.
REMOTE = ("--mode", "remote", "--rerun-triggers", "mtime", "params", "software-env", "--cores", "1", "--nolock", "-n")


@pytest.mark.slow
def test_a_job_plans_what_its_run_planned_without_the_files_of_the_configuration(planner, smoke, tmp_path):
    handed = smoke / ".snakemake" / "configuration.json"

    def planned(file):
        return planner("results/beams/b_rh067_NG.nc", "--directory", smoke, *REMOTE, config=[file])

    status, printed = planned(handed)
    assert status == 0, printed
    assert "Nothing to be done" in printed
    configuration, preliminary = json.loads(handed.read_text())["planned"]
    configuration["beam"]["samples"] += 1
    other = tmp_path / "other.json"
    save_text(json.dumps({"planned": [configuration, preliminary]}), other)
    status, printed = planned(other)
    assert status == 0, printed
    assert "beams" in printed, "the control: jobs read nothing but this file"
    assert "Nothing to be done" not in printed

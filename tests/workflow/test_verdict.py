"""The last rules: if a check of the results fails, so does the run, with a message and with all other results."""

import json
import shutil
from pathlib import Path

import pytest
from conftest import snakemake

from stiction.config.files import paper
from stiction.plan.planner import ALL_TARGETS, Planner


def verdict(folder):
    """Run rule verdict on the checks in a folder, and draw figure 5 where it is missing."""
    return snakemake(folder, "all", "--allowed-rules", "all", "verdict", "figure_05", check=False)


def now(_key, compute):
    """Compute a planner's value without keeping it."""
    return compute()


def test_all_checks_of_the_smoke_run_pass(smoke):
    assert (smoke / "results" / "verdict.txt").read_text().startswith("All ")
    assert "**FAILED**" not in (smoke / "results" / "checks.md").read_text()


@pytest.mark.slow
def test_a_failed_check_fails_the_run_after_everything_else_and_the_report_is_kept(smoke, tmp_path):
    results = Path(shutil.copytree(smoke / "results", tmp_path / "results"))
    report, figure = results / "checks.csv", results / "figures" / "figure_05.png"
    text = report.read_text()
    assert verdict(tmp_path).returncode == 0
    report.write_text(text.replace(",True,", ",False,", 1))
    figure.unlink()
    done = verdict(tmp_path)
    assert done.returncode == 1
    assert f"1 of {len(text.splitlines()) - 1} checks of the results failed." in done.stdout
    assert "Traceback" not in done.stdout
    assert report.exists()
    assert figure.exists()
    assert not (results / "verdict.txt").exists()


def test_the_last_job_waits_for_every_other_file_of_a_whole_run():
    planner = Planner(paper(), {}, now, now)
    wanted = {file for target in ALL_TARGETS for file in planner.files_of(target)}
    assert wanted - {*planner.before_last} == {"results/verdict.txt"}
    assert "results/tables/table_3.csv" in planner.before_last


def test_the_run_is_recorded_with_the_results(smoke):
    run = json.loads((smoke / "results" / "provenance.json").read_text())[0]
    assert run["config"]["contact"]["samples"] == 200
    assert run["versions"]["snakemake"]

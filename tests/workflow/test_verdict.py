"""The last rules: if a check of the results fails, the run stops with a message and the report is kept."""

import json
import shutil
from pathlib import Path

import pytest
from conftest import snakemake


def verdict(folder):
    """Run rule verdict on the checks in a folder, without the datasets behind them."""
    return snakemake(folder, "results/verdict.txt", "--allowed-rules", "verdict", check=False)


def test_all_checks_of_the_smoke_run_pass(smoke):
    assert (smoke / "results" / "verdict.txt").read_text().startswith("All ")
    assert "**FAILED**" not in (smoke / "results" / "checks.md").read_text()


@pytest.mark.slow
def test_a_failed_check_stops_the_run_with_a_message_and_the_report_is_kept(smoke, tmp_path):
    results = tmp_path / "results"
    results.mkdir()
    report = Path(shutil.copy(smoke / "results" / "checks.csv", results))
    text = report.read_text()
    assert verdict(tmp_path).returncode == 0
    report.write_text(text.replace(",True,", ",False,", 1))
    done = verdict(tmp_path)
    assert done.returncode == 1
    assert f"1 of {len(text.splitlines()) - 1} checks of the results failed." in done.stdout
    assert "Traceback" not in done.stdout
    assert report.exists()
    assert not (results / "verdict.txt").exists()


def test_the_run_is_recorded_with_the_results(smoke):
    run = json.loads((smoke / "results" / "provenance.json").read_text())[0]
    assert run["config"]["contact"]["samples"] == 200
    assert run["versions"]["snakemake"]

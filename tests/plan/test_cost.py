"""Estimated CPU times follow the sizes of jobs, and the measured times of the paper."""

from pathlib import Path

import pytest

import stiction
from stiction.plan import cost
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan

#: Table of ``make jobs``: rule, jobs, longest [s], all [s] and so on.
MEASURED = Path(__file__).parents[2] / "docs" / "tables" / "jobs.md"
SETTINGS = {
    "sampling": {"spacing_nm": 10, "strip_length_um": 1.5, "margin_um": 1},
    "beam": {"width_um": 30},
    "contact": {"samples": 1000},
}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [4, 4], "restoring_force_uN": 3, "humidities": [0.5]}


def measured():
    """CPU time of the jobs of each rule of the paper [s]."""
    rows = [line.split("|")[1:-1] for line in MEASURED.read_text(encoding="utf-8").splitlines()[2:]]
    return {row[0].strip(): float(row[3]) for row in rows}


def of_run(config, *targets):
    return sum(job.seconds for job in Graph(Plan(config)).needed(*targets or ("tables", "figures", "devices", "all")))


def test_the_time_of_contacts_grows_with_samples_points_and_datasets():
    one = cost.job_cost(SETTINGS, {}) - cost.PER_JOB
    twice = SETTINGS | {"contact": {"samples": 2000}}
    fine = SETTINGS | {"sampling": SETTINGS["sampling"] | {"spacing_nm": 5}}
    nested = {"contact": SETTINGS, "pair": "b"}
    for settings, wildcards, datasets, factor in (
        (twice, {}, 1, 2),
        (fine, {}, 1, 4),
        (SETTINGS, {}, 3, 3),
        (SETTINGS, {"chunk": "0", "number": "5"}, 1, 0.2),
        (nested, {}, 1, 1),
    ):
        assert cost.job_cost(settings, wildcards, datasets) - cost.PER_JOB == pytest.approx(factor * one, rel=1e-12)


def test_the_time_of_tips_grows_with_their_slopes_and_the_reach_of_their_forces():
    def extra(slopes, reach):
        """Time of a tilted strip beyond that of one without slope [s]."""
        tilt = {"slopes": [0.1] * slopes, "reach_nm": reach, "edge": "rounded"}
        return cost.job_cost(SETTINGS | {"tilt": tilt}, {}) - cost.job_cost(SETTINGS, {})

    assert extra(12, 100) == pytest.approx(12 * extra(1, 100), rel=1e-12)
    assert extra(12, 300) - extra(12, 200) == pytest.approx(extra(12, 200) - extra(12, 100), rel=1e-12)
    measured = 1000 * 12 * 6.9e-3 * (1.5 * 30) / (5.8 * 20)  # 35 nm rms, whose tips are longer
    assert extra(12, 107.6) == pytest.approx(measured, rel=0.1)


def test_the_time_of_beams_grows_with_their_number_and_sizes():
    one = cost.job_cost({"beams": 100}, {}) - cost.PER_JOB
    chart = {"beams": 100, "thicknesses_um": [2, 3], "gaps_um": [1, 2, 3]}
    assert cost.job_cost(chart, {}) - cost.PER_JOB == pytest.approx(6 * one, rel=1e-12)
    assert cost.job_cost({"beam": {"elements": 20}, "samples": 100}, {}) == cost.job_cost({"beams": 100}, {})


def test_the_time_of_full_contact_grows_with_strips_and_humidities():
    one, many = (cost.job_cost({"strips": n, "humidities": [0.5] * m}, {}) - cost.PER_JOB for n, m in ((1, 1), (5, 3)))
    assert many == pytest.approx(15 * one, rel=1e-12)
    dry = cost.job_cost({"strips": 5, "humidities": [0, 0.5]}, {}) - cost.PER_JOB
    assert dry == pytest.approx(5 * (one + cost.PER_DRY_STRIP), rel=1e-12)


def test_a_job_without_samples_and_beams_takes_the_time_of_any_job():
    assert cost.job_cost({"water": {"temperature_K": 300}}, {}) == cost.PER_JOB


def test_the_paper_takes_as_long_as_measured_within_a_factor_of_two():
    found = {}
    for job in Graph(Plan(stiction.load())).needed("tables", "figures", "devices", "all"):
        found[job.stage.name] = found.get(job.stage.name, 0) + job.seconds
    table = measured()
    assert 0.5 < sum(found.values()) / sum(table.values()) < 2
    assert all(0.8 < found[rule] / table[rule] < 1.25 for rule in ("contact_chunk", "beams"))


def test_one_in_a_million_costs_no_more_than_the_rarest_share_that_was_verified():
    # Before, 2 995 731 patches were drawn at each of eight roughnesses: 23 hours without a word.
    def hours(share):
        asked = {"requirement": {"share": share}, "roughness": {"surface": "B2", "rms_nm": [1, 8]}}
        return of_run(stiction.load({"run": {"pairs": []}, "devices": {"S1": STOPPER | asked}})) / 3600

    assert hours(1e-3) < hours(1e-4) == hours(1e-6) < 0.5

"""What a run would compute and why, in words."""

import logging

import pytest
from test_run_state import heard, plan, record, start

from stiction.command.explain import explained

PARAMS = "Params have changed since last execution: Union of exclusive params before and now across all output: "


def because(reason, rule="beams"):
    return list(explained(heard(plan(**{rule: 1}), start(0, rule, reason=reason))))[1]


def test_nothing_to_do():
    assert list(explained(heard())) == ["Nothing would be computed: all results are up to date."]


def test_a_dry_run_that_is_told_to_be_quiet_reports_no_jobs_but_their_number():
    assert list(explained(heard(plan(beams=2, all=1)))) == [
        "At most 3 jobs would run: without --quiet, this says which and why."
    ]


def test_causes_come_before_what_follows_from_them():
    run = heard(
        plan(beams=2, chaos=1, all=1),
        record("results/a.nc was computed with x: 1 instead of 2.", logging.WARNING),
        start(0, reason="Input files updated by another job: a, b"),
        start(1, "chaos", reason="Updated input files: .snakemake/stale"),
        start(2, reason="Input files updated by another job: a"),
        start(3, "all", log=()),
    )
    assert list(explained(run)) == [
        "3 jobs would run.",
        "results/a.nc was computed with x: 1 instead of 2.",
        "results that this run does not use: chaos",
        "follow from the jobs above: beams (2)",
    ]


def test_the_time_of_a_run_is_the_sum_of_its_jobs_and_its_memory_the_largest():
    jobs = [start(k) for k in range(3)]
    for job, megabytes in zip(jobs, (800, 1600, 800), strict=True):
        job.resources = {"cpu_ms": 300_000, "mem_mb": megabytes}
    (first, *_) = explained(heard(plan(beams=3), *jobs))
    assert first == "3 jobs would run, about 15 min of CPU time and 1600 MB for each job."


@pytest.mark.parametrize(
    ("reason", "words"),
    [
        ("Missing output files: a.nc", "results are missing: beams"),
        ("Missing output files: a.nc; Input files updated by another job: b.nc", "results are missing: beams"),
        ("Forced execution", "an option forces them: beams"),
        ("Updated input files: scan.gwy", "an input file is newer: beams"),
        ("Something new", "Something new: beams"),
        (
            PARAMS + "before: {'stiction.a': '1', 'x.py': '2'} now: {'stiction.a': '3', 'x.py': '2'}",
            "the code of stiction.a: beams",
        ),
        (
            PARAMS + "before: {'of': ['b'], 'beam': {'gap': 1}} now: {'of': ['b'], 'beam': {'gap': 3}}",
            "settings: beam.gap: 1 → 3: beams",
        ),
        (PARAMS + "before: <nothing exclusive> now: {'a': 1}", "settings: a: nothing → 1: beams"),
        (PARAMS + "before: <object at 0x1> now: {'a': 1}", "settings or code changed: beams"),
        ("Missing output files: a; " + PARAMS + "before: {'a': 2} now: {'a': 1}", "settings: a: 2 → 1: beams"),
    ],
)
def test_reasons_in_words(reason, words):
    assert because(reason) == words

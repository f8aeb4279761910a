"""The state of a run from the reports of Snakemake, and the estimate of the time that it still takes."""

import logging

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.command.run_state import Run
from stiction.stages.contact.changes.patches import STRIPS
from stiction.stages.contact.changes.table import AS_IT_IS, TABLE
from stiction.stages.devices import budget


def record(message=None, level=logging.INFO, at=0.0, **extra):
    """A report as Snakemake makes them."""
    made = logging.makeLogRecord({"msg": message, "levelno": level, "created": at} | extra)
    assert made.created == at
    return made


def start(number, rule="beams", at=0.0, reason="", log=("results/logs/a.log",)):
    about = {"rule_name": rule, "rule_msg": f"Job of {rule}.", "reason": reason, "log": list(log)}
    return record(at=at, event="job_info", jobid=number, **about)


def end(number, at):
    return record(at=at, event="job_finished", job_id=number)


def plan(**jobs):
    return record("Job stats", event="run_info", stats=jobs | {"total": sum(jobs.values())})


def failure(number, rule="beams"):
    return record(event="job_error", jobid=number, rule_name=rule, log=["results/logs/a.log", "slurm.log"])


def heard(*records):
    run = Run()
    for one in records:
        run.hear(one)
    return run


def test_rules_of_budgets_are_those_of_their_module_and_of_the_changes_on_patches_of_devices():
    changes = [row for change, row in TABLE.items() if change is not AS_IT_IS]
    contacts = {rule for row in changes for place, (rule, _) in row.items() if place is not STRIPS}
    rules = {stage.name for stage in budget.STAGES} | contacts | {"slope_contact"}
    assert heard(plan(**dict.fromkeys(rules, 1), beams=1)).budgets == rules
    assert heard(plan(beams=1)).budgets == set()


@given(st.integers(1, 8), st.integers(3, 20), st.integers(0, 30), st.floats(1, 100))
def test_the_time_left_of_equal_jobs_is_exact_for_any_number_of_cores(cores, rounds, left, seconds):
    done = cores * rounds
    run = heard(plan(beams=done + cores * left))
    for number in range(done):
        begin = (number // cores) * (seconds + 5)
        run.hear(start(number, at=begin))
        run.hear(end(number, at=begin + seconds + 5))
    now = rounds * (seconds + 5)
    assert run.done == done
    assert run.seconds_left(now) == pytest.approx(left * (seconds + 5))


def test_short_and_long_jobs_are_expected_to_take_as_long_as_those_of_their_rule():
    run = heard(plan(tables=12, contact=3))
    for number in range(2):
        run.hear(start(number, "contact", at=100.0 * number))
        run.hear(end(number, at=100.0 * number + 100))
    run.hear(start(2, "tables", at=200))
    run.hear(end(2, at=201))
    assert run.seconds_left(201) == pytest.approx(100 + 11, rel=0.01)


def test_the_time_left_falls_by_the_clock_until_the_next_job_finishes():
    run = heard(plan(beams=5))
    for number in range(3):
        run.hear(start(number, at=10.0 * number))
        run.hear(end(number, at=10.0 * number + 10))
    assert run.seconds_left(30) == pytest.approx(20)
    assert run.seconds_left(45) == pytest.approx(5)
    assert run.seconds_left(51) is None


def test_nothing_is_estimated_from_the_first_moments():
    run = heard(plan(beams=10), start(0), end(0, 1), start(1, at=1), end(1, 2))
    assert run.seconds_left(2) is None
    assert Run().seconds_left(0) is None


def test_a_job_that_succeeds_when_it_is_tried_again_is_no_failure():
    run = heard(plan(beams=1), start(0), failure(0))
    assert run.failures[0].logs == ("results/logs/a.log", "slurm.log")
    run.hear(start(0, at=5))
    run.hear(end(0, at=6))
    assert run.failures == {}


@pytest.mark.parametrize(
    "text",
    [
        'WorkflowError in file "/a b/Snakefile", line 62:\nThe folder\nis used.',
        'WorkflowError in rule all in file "/a/Snakefile", line 62:\nThe folder\nis used.\n  File "/a", line 1, in f',
        "WorkflowError:\nThe folder\nis used.",
        "The folder\nis used.",
        'E:\nThe folder\nis used.\n  File "/a", line 1, in f\n  File "/b", line 2, in <module>',
    ],
)
def test_a_refusal_is_told_without_its_place_in_a_file(text):
    assert heard(record(text, logging.ERROR, event="error")).refusal == "The folder\nis used."


@pytest.mark.parametrize(
    ("error", "told", "fault"),
    [
        ("NotPlanned: x.nc cannot be computed", "x.nc cannot be computed", False),
        ("KeyError: 'seed'", "KeyError: 'seed'", True),
    ],
)
def test_an_error_of_the_plan_is_told_without_what_snakemake_writes_around_it(error, told, fault):
    text = 'InputFunctionException in rule r in file "/a/Snakefile", line 5:\n'
    text += f'Error:\n  {error}\nWildcards:\n  pair=a\nTraceback:\n  File "/a", line 1, in f'
    run = heard(record(text, logging.ERROR, event="error", exception="InputFunctionException"))
    assert (run.refusal, bool(run.fault)) == (told, fault)


def test_warnings_and_unknown_reports():
    run = heard(record("x was computed", logging.WARNING), record(event="rulegraph"), record("Building DAG of jobs..."))
    assert run.warnings == ["x was computed"]
    assert not run.up_to_date
    run.hear(record("Nothing to be done (all requested files are present)."))
    assert run.up_to_date

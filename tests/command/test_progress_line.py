"""The line of progress on terminals and in files."""

import io

import pytest
from test_run_state import end, heard, plan, start

from stiction.command.progress_line import Display, costs, duration, line


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def run():
    return heard(
        plan(beams=4), *(start(number, at=10.0 * number) for number in range(4)), *(end(n, 40) for n in range(3))
    )


def test_the_line_tells_jobs_time_left_and_the_last_job(run):
    assert line(run, 40) == "3 of 4 jobs, about 13 s left: Job of beams."


def test_the_line_before_the_first_job_says_what_takes_so_long():
    assert line(heard(plan(beams=4)), 0) == "0 of 4 jobs: loading; after an installation, compiling for a minute"


def test_a_terminal_shows_one_line_that_fits_and_is_drawn_again_while_nothing_is_reported(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "12")
    monkeypatch.setattr("stiction.command.progress_line._REDRAWN", 0.01)
    display = Display(run, terminal := Terminal())
    while terminal.getvalue().count("3 of 4 jobs") < 3:
        pass
    display.close()
    drawn = terminal.getvalue()
    assert "\n" not in drawn
    first, *lines, last = drawn.split("\r\x1b[K")
    assert (first, set(lines), last) == ("", {"3 of 4 jobs"}, "")


def test_a_file_gets_few_lines_and_no_control_characters(run):
    display = Display(run, file := io.StringIO())
    for now in range(40, 101):
        display(now)
    display.close()
    assert len(file.getvalue().splitlines()) == 3
    assert "\x1b" not in file.getvalue()
    assert "\r" not in file.getvalue()


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_what_budgets_cost_is_said_once_before_the_first_job(stream):
    run = heard(plan(beams=4, budget=1, tip_slope_contact=5, slope_contact=10))
    display = Display(run, shown := stream())
    for now in (0, 100):
        display(now)
    display.close()
    (told,) = (text for text in shown.getvalue().splitlines() if "budget" in text)
    assert told.removeprefix("\x1b[K").startswith("16 of 20 jobs are for budgets: advice on what to measure better.")


def test_a_run_without_budgets_says_nothing_about_them(run):
    assert list(costs(run)) == []


def test_contacts_that_the_study_of_slopes_needs_anyway_are_no_costs_of_budgets():
    assert next(costs(heard(plan(slopes=2, budget=1, slope_contact=10)))).startswith("1 of 13 jobs are")


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0 s"), (59.4, "59 s"), (60, "1 min"), (3500, "58 min"), (5400, "1.5 h")]
)
def test_durations(seconds, text):
    assert duration(seconds) == text

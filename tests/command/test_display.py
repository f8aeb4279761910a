"""The line of progress on terminals and in files."""

import io

import pytest
from test_follow import end, heard, plan, start

from stiction.command.display import Display, duration, line


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


def test_a_terminal_shows_one_line_that_fits(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "20")
    display = Display(terminal := Terminal())
    for now in (40, 40.01, 41):
        display(run, now)
    display.clear()
    drawn = terminal.getvalue()
    assert "\n" not in drawn
    assert drawn.split("\r\x1b[K")[1:] == ["3 of 4 jobs, about ", "3 of 4 jobs, about ", ""]


def test_a_file_gets_few_lines_and_no_control_characters(run):
    display = Display(file := io.StringIO())
    for now in range(40, 101):
        display(run, now)
    display.clear()
    assert len(file.getvalue().splitlines()) == 3
    assert "\x1b" not in file.getvalue()
    assert "\r" not in file.getvalue()


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0 s"), (59.4, "59 s"), (60, "1 min"), (3500, "58 min"), (5400, "1.5 h")]
)
def test_durations(seconds, text):
    assert duration(seconds) == text

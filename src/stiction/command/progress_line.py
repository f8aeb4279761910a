"""Progress of a run: one line drawn again and again on a terminal, and few lines otherwise."""

import shutil
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TextIO

from stiction.command.output_streams import put
from stiction.command.run_state import Run
from stiction.run.atomic import DataError

#: Time between two lines of a file, and between two drawings on a terminal [s].
_APART, _REDRAWN = 30.0, 1.0
#: Clears the line on a terminal.
_ABOVE = "\r\x1b[K"
_START = "loading; after an installation, compiling for a minute"


class Display:
    """Line about a run: drawn again every second on a terminal until `close`. A file gets a line from time to time."""

    def __init__(self, run: Run, stream: TextIO, folder: Path = Path()):
        """Display on a stream of a run in a folder."""
        self._run, self._stream, self._folder = run, stream, folder.absolute()  # Snakemake changes into it
        self._last, self._closed, self._told, self._answered = 0.0, threading.Event(), False, False
        self._clock = threading.Thread(target=self._draw, daemon=True) if stream.isatty() else None
        if self._clock:
            self._clock.start()

    def _draw(self):
        """Draw the line until the end."""
        while not self._closed.wait(_REDRAWN):
            width = shutil.get_terminal_size().columns - 1
            self._write(f"{_ABOVE}{line(self._run, time.time())[:width]}")

    def __call__(self, now: float) -> None:
        """Write once the cost of budgets and the first answer, and to a file now and then a line about the run."""
        if self._run.planned and not self._told:
            self._told = True
            self._say(*costs(self._run))
        answering = filter(None, map(self._run.first.get, ("safe_lengths", "stoppers")))
        if not self._answered and (job := next(answering, None)):
            self._answered = True
            from stiction.command.first_answer import first_answer  # imports the physics

            with suppress(DataError):  # the job that reads the file says why
                self._say(first_answer(job.logs[0], self._folder))
        if self._clock is None and self._run.planned and now - self._last >= _APART:
            self._last = now
            self._write(f"{line(self._run, now)}\n")

    def _say(self, *texts):
        """Write lines that remain."""
        self._write("".join(f"{_ABOVE if self._clock else ''}{text}\n" for text in texts))

    def _write(self, text):
        put(text, self._stream)

    def close(self) -> None:
        """Remove the line from a terminal."""
        self._closed.set()
        if self._clock:
            self._clock.join()
            self._write(_ABOVE)


def line(run: Run, now: float) -> str:
    """Progress of a run in one line: jobs, time left, and the latest job."""
    seconds = run.seconds_left(now)
    remaining = "" if seconds is None else f", about {duration(seconds)} left"
    jobs = list(run.jobs.values())  # another thread adds jobs
    latest = max(jobs, key=lambda job: job.started).message if jobs else _START
    return f"{run.done} of {run.total} jobs{remaining}: {latest}" if run.planned else "planning"


def costs(run: Run) -> Iterator[str]:
    """Yield the cost of the budgets of a run, before it computes anything, or nothing without budgets."""
    if number := sum(run.planned[rule] for rule in run.budgets):
        yield (
            f"{number} of {run.total} jobs are for budgets: advice on what to measure better. Without them: stiction "
            "run FILE -- results/tables/safe_lengths.md (of stoppers: results/tables/stoppers.md)"
        )


def duration(seconds: float) -> str:
    """Time in words, to two digits at most.

    >>> duration(8.2), duration(95), duration(5000)
    ('8 s', '2 min', '1.4 h')
    """
    if seconds < 60:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 3600 else f"{seconds / 3600:.1f} h"

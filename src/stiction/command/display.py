"""Progress of a run: one line that is drawn again on a terminal, and few lines otherwise."""

import shutil
from typing import TextIO

from stiction.command.follow import Run

#: Shortest time between two lines of a log, and between two drawings on a terminal [s].
_APART, _REDRAWN = 30.0, 0.1
_START = "loading; after an installation, compiling for a minute"


class Display:
    """Line about a run.

    Parameters
    ----------
    stream : file
        A terminal or a file.
    """

    def __init__(self, stream: TextIO):
        self._stream, self._redraws = stream, stream.isatty()
        self._last, self._drawn = 0.0, False

    def __call__(self, run: Run, now: float) -> None:
        """Show how far a run is, unless this was shown a moment ago."""
        if run.planned and now - self._last >= (_REDRAWN if self._redraws else _APART):
            self._last = now
            self._write(line(run, now))

    def _write(self, text):
        if self._redraws:
            self._drawn = True
            width = shutil.get_terminal_size().columns - 1
            self._stream.write(f"\r\x1b[K{text[:width]}")
        else:
            self._stream.write(f"{text}\n")
        self._stream.flush()

    def clear(self) -> None:
        """Remove the line from a terminal."""
        if self._drawn:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
            self._drawn = False


def line(run: Run, now: float) -> str:
    """How far a run is, in one line: jobs, time left, and the job that started last."""
    left = run.seconds_left(now)
    remaining = "" if left is None else f", about {duration(left)} left"
    latest = max(run.jobs.values(), key=lambda job: job.started).message if run.jobs else _START
    return f"{run.done} of {run.total} jobs{remaining}: {latest}"


def duration(seconds: float) -> str:
    """Time in words, to two digits at most.

    >>> duration(8.2), duration(95), duration(5000)
    ('8 s', '2 min', '1.4 h')
    """
    if seconds < 60:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 3600 else f"{seconds / 3600:.1f} h"

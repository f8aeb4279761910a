"""Standard streams of the command: closed, without a reader or full, they are no error of the code."""

import os
import sys
from contextlib import suppress
from typing import TextIO


def open_closed() -> None:
    """Open closed standard streams as the null device, before other files take their numbers."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, mode, closefd=False))


def put(text: str, stream: TextIO) -> OSError | None:
    """Write a text at once, and return the error if this is not possible. All later text is then lost."""
    try:
        stream.write(text)
        stream.flush()
    except OSError as error:
        with suppress(OSError):  # what the stream still holds would fail once more when it is closed
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        return error
    return None


def say(line: str, stream: TextIO | None = None, end: str = "\n") -> None:
    """Print one line, on standard output by default.

    Errors need no reader, and a reader may have seen enough, as ``head`` has.

    Raises
    ------
    OSError
        If standard output cannot be written, on a full disk for example.
    """
    error = put(f"{line}{end}", stream or sys.stdout)
    if error and stream is None and not isinstance(error, BrokenPipeError):
        raise OSError(f"standard output cannot be written: {error.strerror}") from error

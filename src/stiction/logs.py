"""What a job leaves behind while it works: progress and errors in its log."""

import contextlib
import sys
import traceback
from pathlib import Path

from tqdm import tqdm


@contextlib.contextmanager
def logged(path):
    """Send warnings, progress and the traceback of an error to a log; the terminal gets the error's one line."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with Path(path).open("w", buffering=1, encoding="utf-8") as log:
        try:
            with contextlib.redirect_stderr(log):
                yield
        except Exception as error:
            traceback.print_exc(file=log)
            sys.exit(" ".join([f"{type(error).__name__}: {error}", *getattr(error, "__notes__", [])]))


def progress(steps, what, total=None):
    """Iterate with a progress bar in the log."""
    return tqdm(steps, desc=what, total=total, mininterval=2.0, ascii=True, file=sys.stderr)

"""What a job leaves behind while it works: progress, errors and what it took, in its log."""

import contextlib
import resource
import sys
import time
import traceback
from pathlib import Path


@contextlib.contextmanager
def logged(path):
    """Send warnings, progress and the traceback of an error to a log; the terminal gets the error's one line.

    The last line of the log of a job that succeeded tells how long it worked and its peak of memory.
    """
    start, failure = time.perf_counter(), None
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(path).touch()
    # A full disk takes no more lines of a log; the terminal still gets its own.
    what_fits = contextlib.suppress(OSError)
    with what_fits, Path(path).open("w", buffering=1, encoding="utf-8") as log, contextlib.redirect_stderr(log):
        try:
            yield
        except Exception as error:
            failure = " ".join([f"{type(error).__name__}: {error}", *getattr(error, "__notes__", [])])
            traceback.print_exc(file=log)
        else:
            log.write(f"took {time.perf_counter() - start:.1f} s, {peak_memory():.0f} MB\n")
    if failure:
        sys.exit(failure)


def peak_memory():
    """Largest resident memory of this process so far [MB]."""
    status = Path("/proc/self/status")  # where there is one, it counts this program alone; the other count inherits
    counted = dict(line.split(":", 1) for line in status.read_text().splitlines()) if status.exists() else {}
    if "VmHWM" in counted:
        return int(counted["VmHWM"].split()[0]) / 1024
    kilo = 1024 if sys.platform == "darwin" else 1
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / kilo / 1024

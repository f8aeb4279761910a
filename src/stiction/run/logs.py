"""Log of a job: progress, warnings, errors, run time and peak memory."""

import contextlib
import hashlib
import re
import resource
import sys
import time
import traceback
from collections.abc import Iterable, Iterator
from pathlib import Path


@contextlib.contextmanager
def logged(path: str | Path, results: Iterable[str] = ()) -> Iterator[None]:
    """Write warnings, progress and the traceback of an error to a log. Print one line about the error on the terminal.

    The log of a successful job ends with the SHA-256 checksums of its results, its run time and its peak memory.
    """
    start, failure = time.perf_counter(), None
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(path).touch()
    # On a full disk the log is incomplete, but the line about the error is still printed on the terminal.
    full_disk = contextlib.suppress(OSError)
    with full_disk, Path(path).open("w", buffering=1, encoding="utf-8") as log, contextlib.redirect_stderr(log):
        try:
            yield
        except Exception as error:
            failure = " ".join([f"{type(error).__name__}: {error}", *getattr(error, "__notes__", [])])
            traceback.print_exc(file=log)
        else:
            log.writelines(f"{checksum(file)}  {file}\n" for file in results)
            log.write(f"took {time.perf_counter() - start:.1f} s, {peak_memory():.0f} MB\n")
    if failure:
        sys.exit(failure)


def checksum(path: str | Path) -> str:
    """SHA-256 of a file, read in parts: datasets are large."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def recorded_checksums(folder: str | Path) -> dict[str, str]:
    """Checksums of results in the logs of a folder, by file."""
    texts = (path.read_text(encoding="utf-8") for path in sorted(Path(folder).rglob("*.log")))
    return {file: sha for text in texts for sha, file in re.findall(r"^([0-9a-f]{64})  (.+)$", text, re.MULTILINE)}


def peak_memory() -> float:
    """Largest resident memory of this process so far [MB]."""
    status = Path("/proc/self/status")  # Linux; getrusage would include the peak of the parent process
    counted = dict(line.split(":", 1) for line in status.read_text().splitlines()) if status.exists() else {}
    if "VmHWM" in counted:
        return int(counted["VmHWM"].split()[0]) / 1024
    kilo = 1024 if sys.platform == "darwin" else 1
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / kilo / 1024

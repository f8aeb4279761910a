"""Log of a job: progress, warnings, errors, CPU time, run time and peak memory."""

import contextlib
import hashlib
import os
import re
import resource
import sys
import time
import traceback
from collections.abc import Iterable, Iterator
from pathlib import Path

from stiction.regular_files import require_regular

#: Lines of a log about a result: its checksum and its name, and the origin of all results of the job.
_CHECKSUM = re.compile(r"^([0-9a-f]{64})  (.+)$", re.MULTILINE)
_ORIGIN = re.compile(r"^made from settings ([0-9a-f]{64})$", re.MULTILINE)


@contextlib.contextmanager
def logged(path: str | Path, results: Iterable[str] = ()) -> Iterator[None]:
    """Write warnings, progress and the traceback of an error to a log. Print one line about the error on the terminal.

    The log of a successful job ends with the SHA-256 checksums of its results, its CPU time, its run time and its peak
    memory. On a loaded machine the run time says little about the job.
    """
    start, cpu, failure = time.perf_counter(), cpu_time(), None
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
            clock = time.perf_counter() - start
            log.write(f"took {cpu_time() - cpu:.1f} s of CPU time, {clock:.1f} s in all, {peak_memory():.0f} MB\n")
    if failure:
        sys.exit(failure)


def checksum(path: str | Path) -> str:
    """SHA-256 of a file, read in parts: datasets are large."""
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def recorded_checksums(folder: str | Path) -> dict[str, str]:
    """Checksums of results in the logs of a folder, by file."""
    return {file: sha for text in _texts(folder) for sha, file in _CHECKSUM.findall(text)}


def note_origin(origin: str) -> None:
    """Note the origin of results without a label, from `stiction.run.labels.origin`, in the log of this job."""
    sys.stderr.write(f"made from settings {origin}\n")


def recorded_origin(log: str | Path) -> str | None:
    """Origin of the results of a job by its log, ``None`` without one."""
    return next(reversed(_ORIGIN.findall(_text(log))), None)


def recorded_origins(folder: str | Path) -> dict[str, str]:
    """Origins of results without a label in the logs of a folder, by file."""
    noted = ((text, origin) for text in _texts(folder) for origin in _ORIGIN.findall(text)[-1:])
    return {file: origin for text, origin in noted for _, file in _CHECKSUM.findall(text)}


def log_of(result: str | Path) -> Path:
    """Log of the job of a result without a label. Both are relative to the folder of the run."""
    _, *folders = Path(result).with_suffix(".log").parts
    return Path("results", "logs", *folders)


def _texts(folder):
    """Texts of all logs of a folder."""
    return map(_text, sorted(Path(folder).rglob("*.log")))


def _text(log):
    """Text of a log, empty if it cannot be read. A library can write bytes into it that are no UTF-8."""
    with contextlib.suppress(OSError):
        require_regular(log)
        return Path(log).read_text(encoding="utf-8", errors="replace")
    return ""


def cpu_time() -> float:
    """CPU time of this process so far, with all of its threads and the processes that it started and that ended [s]."""
    return sum(os.times()[:4])


def peak_memory() -> float:
    """Largest resident memory of this process so far [MB]."""
    status = Path("/proc/self/status")  # Linux; getrusage would include the peak of the parent process
    counted = dict(line.split(":", 1) for line in status.read_text().splitlines()) if status.exists() else {}
    if "VmHWM" in counted:
        return int(counted["VmHWM"].split()[0]) / 1024
    kilo = 1024 if sys.platform == "darwin" else 1
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / kilo / 1024

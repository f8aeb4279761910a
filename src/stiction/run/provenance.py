"""Record of every run: date, machine, code, libraries and configuration."""

import contextlib
import datetime
import json
import os
import platform
import subprocess
from collections.abc import Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from stiction.regular_files import require_regular
from stiction.run.atomic import DataError, save_text

#: Libraries on which results may depend.
LIBRARIES = (
    "stiction",
    "numpy",
    "scipy",
    "numba",
    "llvmlite",
    "xarray",
    "netCDF4",
    "pandas",
    "matplotlib",
    "snakemake",
    "SurfaceTopography",
)


class RecordError(ValueError):
    """Error of a record of runs: one sentence with its file and the remedy."""


def record(path: str | Path, checkout: str | Path, config: dict) -> None:
    """Append the starting run to the record of runs, oldest first. The JSON file is replaced atomically.

    ``checkout`` is the folder that contains the code.

    Raises
    ------
    RecordError
        If the file exists and is not a list of runs.
    DataError
        If the file cannot be written.
    """
    path = Path(path)
    runs = [*recorded_runs(path), _run(checkout, config)]
    save_text(json.dumps(runs, indent=1, sort_keys=True) + "\n", path)


def recorded_runs(path: Path) -> list[dict]:
    """Runs in a record, oldest first. Empty if there is no record.

    Raises
    ------
    RecordError
        If the file exists and is not a list of runs.
    """
    if not path.exists():
        return []
    try:
        require_regular(path)
        runs = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as reason:
        raise RecordError(f"{path} cannot be read ({reason}); delete it") from reason
    if not (isinstance(runs, list) and all(isinstance(run, dict) and "config" in run for run in runs)):
        raise RecordError(f"{path} does not contain a list of runs; delete it")
    return runs


@contextlib.contextmanager
def understood(record: Path) -> Iterator[None]:
    """Blame a record of runs for errors from its content: another version can have written it.

    Raises
    ------
    RecordError
        One sentence that names the record.
    """
    try:
        yield
    except (OSError, DataError, RecordError):
        raise
    except Exception as reason:  # a record can say anything
        error = " ".join(f"{type(reason).__name__}: {reason}".split())[:200]
        raise RecordError(
            f"{record} describes no run of this version of stiction ({error}): run stiction paper or stiction run FILE "
            "again"
        ) from reason


def _run(checkout, config):
    """Date, machine, code, libraries and configuration of a starting run."""
    return {
        "started": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "versions": {"python": platform.python_version()} | {name: version_of(name) for name in LIBRARIES},
        "git": git_state(checkout),
        "machine": {"host": platform.node(), "system": platform.platform(), "cpu": cpu_name(), "cores": os.cpu_count()},
        "config": config,
    }


def version_of(library: str) -> str | None:
    """Version of a library, ``None`` if it is not installed, e.g. Snakemake in a use of the package alone."""
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return None


#: Questions to git about a checkout; names of files end with a null character.
_COMMIT = ["rev-parse", "HEAD"]
_CHANGED = ["diff", "--name-only", "-z", "HEAD"]
_UNTRACKED = ["ls-files", "--others", "--exclude-standard", "-z"]


def git_state(checkout: str | Path) -> dict | None:
    """Commit of a checkout, changed files and files unknown to it, or ``None`` without a commit.

    The checkout may belong to another user, which git by itself refuses. A folder inside of another repository, such as
    that of an installed package, is no checkout.
    """
    if not (Path(checkout) / ".git").exists():
        return None
    try:
        commit, changed, untracked = (_git(checkout, *command) for command in (_COMMIT, _CHANGED, _UNTRACKED))
    except (OSError, subprocess.CalledProcessError):
        return None
    files = {"changed": changed, "untracked": untracked}
    return {"commit": commit.strip()} | {kind: text.split("\0")[:-1] for kind, text in files.items()}


def _git(checkout, *command):
    """Output of git about a checkout."""
    words = ["git", "-c", f"safe.directory={Path(checkout).resolve()}", "-C", checkout, *command]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def cpu_name() -> str:
    """Name of the processor, if the system reports it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor())


# In words


def start_of(run: Mapping[str, Any]) -> str:
    """Date and time of the start of a run.

    Examples
    --------
    >>> start_of({"started": "2026-01-31T23:05:59+00:00"})
    '2026-01-31 23:05 UTC'
    """
    return f"{datetime.datetime.fromisoformat(run['started']):%Y-%m-%d %H:%M %Z}"


#: Digits of a commit that pages show. The record has all.
_SHOWN = 10


def code_of(run: Mapping[str, Any]) -> Iterator[str]:
    """Version and commit of the code of a run, and its changed files, in words."""
    package, git = " ".join(filter(None, ["stiction", run["versions"].get("stiction")])), run["git"]
    if git is None:
        yield f"{package}, installed"
        return
    yield f"{package}, commit {git['commit'][:_SHOWN]}"
    if git["changed"]:
        yield f"Files that are changed in its folder: {', '.join(git['changed'])}"


def last_run(record: Path) -> list[str]:
    """Say the time and code of the last run of a record behind a result."""
    run = recorded_runs(record)[-1]
    more = "Machine, libraries and configuration of this run are in results/provenance.json."
    return [f"Made by the run of {start_of(run)}.", *(f"{sentence}." for sentence in code_of(run)), more]

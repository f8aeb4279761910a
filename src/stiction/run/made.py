"""By which code, and when, results were made: sentences from the record of a run."""

import json
from collections.abc import Iterator, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any


def started(run: Mapping[str, Any]) -> str:
    """Date and time at which a run started.

    Examples
    --------
    >>> started({"started": "2026-01-31T23:05:59+00:00"})
    '2026-01-31 23:05 UTC'
    """
    return f"{datetime.fromisoformat(run['started']):%Y-%m-%d %H:%M %Z}"


def code(run: Mapping[str, Any]) -> Iterator[str]:
    """Version and commit of the code of a run, and the files of the commit that were changed."""
    package, git = " ".join(filter(None, ["stiction", run["versions"].get("stiction")])), run["git"]
    if git is None:
        yield f"{package}, installed"
        return
    yield f"{package}, commit {git['commit']}"
    if git["changed"]:
        yield f"Files that are changed in its folder: {', '.join(git['changed'])}"


def by_the_last_run(record: Path) -> list[str]:
    """When and by which code the last run of a record makes a result."""
    run = json.loads(record.read_text(encoding="utf-8"))[-1]
    more = "Machine, libraries and configuration of this run are in results/provenance.json."
    return [f"Made by the run of {started(run)}.", *(f"{sentence}." for sentence in code(run)), more]

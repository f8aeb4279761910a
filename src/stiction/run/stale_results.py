"""Result files of earlier runs: whether a run may use them.

Snakemake compares settings only where its own record of a file exists, and never reads a file. A dataset copied
from another run, or a table cut off by a full disk, would be used silently.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, partial
from itertools import groupby
from pathlib import Path
from typing import Any

from stiction.run import labels
from stiction.run.atomic import DataError
from stiction.run.logs import checksum, recorded_checksums, recorded_origins


def foreign(
    paths: Iterable[str | Path],
    expected: Callable[[str], dict[str, Any] | None],
    remember: Callable[[object, Callable[[], Any]], Any],
) -> Iterator[tuple[str, str]]:
    """Yield datasets of other settings or another study, or unreadable ones, each with the reason.

    ``expected`` gives the settings of the job of a file in this run, ``None`` if no job writes it: such files are left
    out. A `stiction.run.disk_cache.DiskCache` keeps the labels of files that have not changed.

    Yields
    ------
    tuple of str
        File; and a clause about its content and what this run needs.
    """
    expected = cache(expected)  # many datasets depend on the same ones
    for path in map(Path, paths):
        if (settings := expected(path.as_posix())) is not None:
            reason = _difference(path, settings, expected, remember)
            if reason:
                yield path.as_posix(), reason


def _difference(path, settings, expected, remember):
    """Difference between a dataset and this run's, empty without any."""
    try:
        label = labels.DatasetLabel(*remember([_state(path), labels.DatasetLabel._fields], lambda: labels.read(path)))
    except (DataError, OSError):
        return "cannot be read"
    if label.name != path.stem:
        return f"holds {label.stage} of {label.name}" if label.stage else "holds no result of this study"
    if label.layout != labels.LAYOUT:
        return "was written by another version"
    if differing := _first(label.settings, settings):
        return f"was computed with {differing}"
    for file, stored in label.before.items():
        if differing := _first(stored, expected(file) or {}):
            return f"depends on {file} with {differing}"
    return ""


def _state(path):
    """State of a file on the disk. Any write changes the last number, and nobody can set it."""
    state = path.stat()
    return [str(path), state.st_ino, state.st_size, state.st_mtime_ns, state.st_ctime_ns]


def _first(stored, expected, path=()):
    """First different key of two sections, with both values, empty if they agree."""
    if stored == expected:
        return ""
    if isinstance(stored, dict) and isinstance(expected, dict):
        keys = sorted({*stored, *expected})
        return next(filter(None, (_first(stored.get(key), expected.get(key), (*path, key)) for key in keys)), "")
    expected = json.loads(json.dumps(expected))  # as it would be stored
    return "" if stored == expected else f"{'.'.join(path)}: {_value(stored)} instead of {_value(expected)}"


def _value(value):
    """Value in a message."""
    return "nothing" if value is None else value


def made_otherwise(logs: str | Path, expected: Callable[[str], str | None]) -> Iterator[tuple[str, str]]:
    """Yield results without a label that were made with other settings, by the origins in a folder of logs.

    ``expected`` gives the origin of a file in this run, ``None`` if no job writes it: such files are left out.
    """
    for path, origin in recorded_origins(logs).items():
        if Path(path).is_file() and expected(path) not in (None, origin):
            yield path, "was made with other settings"


def damaged(logs: str | Path, remember: Callable[[object, Callable[[], Any]], Any]) -> Iterator[tuple[str, str]]:
    """Yield files changed since the end of their jobs, by the checksums in a folder of logs, each with the reason.

    Files that are missing and files without a checksum are left out. A `stiction.run.disk_cache.DiskCache` keeps the
    checksums of files that have not changed.
    """
    for path, recorded in recorded_checksums(logs).items():
        file = Path(path)
        if file.is_file() and remember([_state(file), "checksum"], partial(checksum, file)) != recorded:
            yield path, "is not as its job wrote it"


def summary(unusable: Mapping[str, str]) -> Iterator[str]:
    """Yield one line about the first unusable file of each folder, with the number of the others."""
    paths = sorted(map(Path, unusable), key=lambda path: (path.parent, path.name))
    for _, files in groupby(paths, key=lambda path: path.parent):
        first, *further = map(Path.as_posix, files)
        more = f" (nor {len(further)} more of this folder)" if further else ""
        yield f"{first} {unusable[first]}; this run does not use it{more}."


def in_words(unusable: Mapping[str, str]) -> str:
    """Say which unusable file matters most to a reader, and the number of the others: datasets matter least."""
    first = min(unusable, key=lambda file: (file.endswith(".nc"), not file.endswith("verdict.txt"), file))
    more = len(unusable) - 1
    remainder = f" (and {more} more file{'s' * (more > 1)})" if more else ""
    return f"{first} {unusable[first]}{remainder}"

"""Disk cache for planning: results determined by their inputs and the code alone.

Planning a run again takes half of the time.
"""

import contextlib
import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stiction.regular_files import require_regular
from stiction.run.atomic import DataError, save_text
from stiction.run.fingerprint import not_kept
from stiction.temporary import own_folder


class DiskCache:
    """Results by the hash of all their sources."""

    def __init__(self, path: str | Path, unused: int = 0):
        """Results in a file. None if it cannot be read, or is not as it was written.

        Of those that this process does not use, the file keeps the ``unused`` latest ones.
        """
        self._path, self._used = Path(path).absolute(), {}  # Snakemake leaves its working directory before it ends
        self._unused = unused
        self._known = _stored(self._path)

    def __call__(self, determined_by: object, compute: Callable[[], Any]) -> Any:
        """Return a known result, or compute it now. An error is not kept.

        Plain numbers, strings, lists and dicts determine the result, which is of the same kind; its code is among them.
        A result that is computed now is as the file will give it back, in which tuples are lists.
        """
        text = json.dumps(determined_by, sort_keys=True, default=str)
        key = hashlib.sha256(text.encode()).hexdigest()
        if key not in self._used:
            self._used[key] = self._known[key] if key in self._known else json.loads(json.dumps(compute()))
        return self._used[key]

    def save(self) -> None:
        """Keep the used results. If the file cannot be written, only time is lost."""
        unused = [key for key in self._known if key not in self._used] if self._unused else []
        results = {key: self._known[key] for key in unused[-self._unused :]} | self._used
        if results != self._known:
            with contextlib.suppress(OSError, DataError):
                text = json.dumps(results)
                save_text(f"{_checksum(text)}\n{text}", self._path)
            self._known = results


def _stored(path):
    """Results in a file that begins with its checksum."""
    with contextlib.suppress(OSError, ValueError):
        require_regular(path)
        checksum, _, text = path.read_text(encoding="utf-8").partition("\n")
        return json.loads(text) if checksum == _checksum(text) else {}
    return {}


def _checksum(text):
    """SHA-256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Caches:
    """Caches for the next process that reads the same configuration. Without a folder, nothing is kept."""

    folder: Path | None = None
    code: Callable = not_kept  #: keeps the fingerprints of modules, see `stiction.run.fingerprint.fingerprint`

    @contextlib.contextmanager
    def cache(self, name: str) -> Iterator[Callable]:
        """Results in a file of the folder, which keeps those that are used."""
        if self.folder is None:
            yield not_kept
        else:
            yield (remember := DiskCache(self.folder / name))
            remember.save()


#: Nothing is kept.
NOWHERE = Caches()


class SharedCache(DiskCache):
    """Results that are kept in a file, and in one of this user for all folders.

    Other machines may not see the file of the user. Both keep what other commands use: `UNUSED` is that of a few
    versions of the code.
    """

    UNUSED = 2000  #: results that this process does not use

    def __init__(self, path: str | Path):
        """As `DiskCache`. The file of the user has the same name."""
        super().__init__(path, self.UNUSED)
        self._of_user = DiskCache(own_folder() / Path(path).name, self.UNUSED)

    def __call__(self, determined_by: object, compute: Callable[[], Any]) -> Any:
        """As `DiskCache`."""
        cached = super().__call__
        value = self._of_user(determined_by, lambda: cached(determined_by, compute))
        return cached(determined_by, lambda: value)

    def save(self) -> None:
        """As `DiskCache`."""
        super().save()
        self._of_user.save()


@contextlib.contextmanager
def caches_below(directory: Path) -> Iterator[Caches]:
    """Keep what a command finds out below the folder of a run. Nothing is kept if the folder is missing."""
    if not directory.is_dir():
        yield NOWHERE
        return
    code = SharedCache(directory / ".snakemake" / "code.json")
    try:
        yield Caches(directory / ".snakemake", code)
    finally:
        code.save()

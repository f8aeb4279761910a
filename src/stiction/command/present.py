"""Results in a folder, as far as they are of its last run."""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from stiction.regular_files import require_regular

#: Folder of results in names of files.
RESULTS = "results/"


@dataclass(frozen=True)
class Present:
    """Files of a folder of results by their names in it, without the files that are not of its last run."""

    folder: Path
    unlike: Collection[str] = ()  #: files of other settings, by their names with ``results/``

    def has(self, name: str) -> bool:
        """Whether there is a regular file of this name below the folder, and of the last run."""
        path = self.folder / name
        try:
            require_regular(path)
        except OSError:
            return False
        inside = path.resolve().is_relative_to(self.folder.resolve())  # names can contain .., and files be links
        return inside and RESULTS + name not in self.unlike

    def text(self, name: str) -> str:
        """Text of a file. Empty if it is missing."""
        return (self.folder / name).read_text(encoding="utf-8", errors="replace") if self.has(name) else ""

    def first(self, pattern: str) -> list[Path]:
        """First file of a pattern, empty without one."""
        names = sorted(path.relative_to(self.folder).as_posix() for path in self.folder.glob(pattern))
        return [self.folder / name for name in names if self.has(name)][:1]

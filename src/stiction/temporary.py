"""Folder of this user among temporary files, for use without a writable package or home."""

import os
import stat
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path


@cache
def own_folder() -> Path:
    """Folder writable by this user alone, the same for all his processes: machine code in it will be run.

    A folder of its name that belongs to somebody else, or that others can write, is left alone: the process gets one of
    its own.

    Raises
    ------
    OSError
        If no folder for temporary files can be written.
    """
    folder = Path(tempfile.gettempdir(), f"stiction-{os.getuid()}")
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    status = folder.lstat()
    safe = stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o022
    return folder if safe else Path(tempfile.mkdtemp(prefix="stiction-"))


def is_writable(folder: str | Path) -> bool:
    """Whether files can be written in a folder, after making it if necessary."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True

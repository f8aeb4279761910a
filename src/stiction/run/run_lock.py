"""Folder of a run: a test of writing, and a lock. Unlike Snakemake's, it ends with a killed run."""

import fcntl
import tempfile
from pathlib import Path
from typing import IO

from stiction.regular_files import require_regular


def require_writable(record: str | Path) -> None:
    """Refuse a folder without room for the record of Snakemake. It changes even if nothing is to do.

    Raises
    ------
    RuntimeError
        If no file can be written in the folder of the record.
    """
    try:
        Path(record).mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=record).close()
    except OSError as error:
        where = Path(record).absolute().parent
        raise RuntimeError(
            f"{where} cannot be written ({error.strerror}), which Snakemake needs even if nothing is to do. "
            "Make it writable, copy it or choose another --directory."
        ) from error


def reserve(lock: str | Path) -> IO[str]:
    """Lock the folder of a run by an open file. The lock ends with the process, or when the file is closed.

    Raises
    ------
    RuntimeError
        If another run has locked the folder, or its disk does not support locks.
    """
    if Path(lock).exists():
        require_regular(lock)
    file = Path(lock).open("a")  # noqa: SIM115
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise RuntimeError("Another run is using this folder. Wait until it has finished, or stop it.") from None
    except OSError as error:
        file.close()
        raise RuntimeError(
            f"This folder cannot be locked ({error}). Choose a --directory on a disk that supports locks."
        ) from error
    return file

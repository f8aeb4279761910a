"""Lock on the folder of a run; unlike Snakemake's own lock, it is released when the run is killed."""

import fcntl
from pathlib import Path
from typing import IO


def reserved(lock: str | Path) -> IO[str]:
    """Open file that locks the folder of a run; the lock is released when the process ends or the file is closed.

    Raises
    ------
    RuntimeError
        If another run has locked the folder, or its disk does not support locks.
    """
    file = Path(lock).open("w")  # noqa: SIM115
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

"""Atomic writing of files: an interrupted run leaves no partly written file."""

import contextlib
import os
import uuid
from collections.abc import Iterator
from pathlib import Path


class DataError(RuntimeError):
    """Error of a file: it is not the expected result or cannot be written. The message includes the remedy."""


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Temporary file next to the target. Replaces the target when complete and is removed on an error.

    Raises
    ------
    DataError
        If the folder cannot be written or the disk is full.
    """
    draft = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        for stale in path.parent.glob(f".{path.name}.*"):  # from a run that was killed
            stale.unlink(missing_ok=True)
        draft.touch()
    except OSError as error:
        raise DataError(f"folder {path.parent} cannot be written ({error}); make it writable") from error
    try:
        yield draft
        with draft.open("rb") as file:
            os.fsync(file.fileno())  # otherwise a power failure can leave an empty file under the final name
        draft.replace(path)
    except (OSError, RuntimeError) as error:
        raise DataError(f"{path} cannot be written ({error}); is the disk full?") from error
    finally:
        draft.unlink(missing_ok=True)


def save_text(text: str, path: str | Path) -> None:
    """Write a text file atomically. Raises the errors of `replacing`."""
    with replacing(Path(path)) as draft:
        draft.write_text(text, encoding="utf-8")


def save_bytes(content: bytes, path: str | Path) -> None:
    """Write a binary file atomically. Raises the errors of `replacing`."""
    with replacing(Path(path)) as draft:
        draft.write_bytes(content)

"""Progress bars of long loops."""

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from tqdm import tqdm

T = TypeVar("T")
#: What users choose in this process.
_CHOSEN = {"shown": True}


def show_progress(shown: bool = True) -> None:
    """Show progress bars of long computations in this process, as by default, or show none."""
    _CHOSEN["shown"] = shown


@contextmanager
def without_progress() -> Iterator[None]:
    """Show no progress bars meanwhile."""
    shown = _CHOSEN["shown"]
    show_progress(False)
    try:
        yield
    finally:
        show_progress(shown)


def progress(steps: Iterable[T], description: str, total: int | None = None) -> Iterator[T]:
    """Iterate over ``steps`` with a progress bar on standard error. Jobs redirect it to their log."""
    off = not _CHOSEN["shown"]
    return tqdm(steps, desc=description, total=total, mininterval=2.0, ascii=True, file=sys.stderr, disable=off)

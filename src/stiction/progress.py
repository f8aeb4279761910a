"""Progress bars of long loops."""

import sys
from collections.abc import Iterable, Iterator
from typing import TypeVar

from tqdm import tqdm

T = TypeVar("T")


def progress(steps: Iterable[T], what: str, total: int | None = None) -> Iterator[T]:
    """Iterate over ``steps`` with a progress bar on standard error, which jobs redirect to their log."""
    return tqdm(steps, desc=what, total=total, mininterval=2.0, ascii=True, file=sys.stderr)

"""The patch of surface that an error is about."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def on_patch(length: float, width: float) -> Iterator[None]:
    """Add the sides of the patch [m] to an error of the force curves of its samples."""
    try:
        yield
    except ValueError as error:
        error.add_note(f"The patch of surface is {1e6 * length:g} x {1e6 * width:g} µm.")
        raise

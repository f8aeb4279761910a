"""The patch of surface that an error is about."""

from collections.abc import Iterator
from contextlib import contextmanager

from stiction.config.units import from_si


@contextmanager
def on_patch(length: float, width: float) -> Iterator[None]:
    """Add the sides of the patch [m] to an error of the force curves of its samples."""
    try:
        yield
    except ValueError as error:
        error.add_note(f"The patch of surface is {from_si(length, 'um'):g} x {from_si(width, 'um'):g} µm.")
        raise

"""Notes in error messages: patch or contact of an error of the force curves."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager

from stiction.config.units import from_si


@contextmanager
def explain_errors(text: str) -> Iterator[None]:
    """Add a sentence to an error."""
    try:
        yield
    except ValueError as error:
        error.add_note(text)
        raise


def on_patch(length: float, width: float) -> AbstractContextManager[None]:
    """Add the sides of the patch [m] to an error of the force curves of its samples."""
    return explain_errors(f"The patch of surface is {from_si(length, 'um'):g} x {from_si(width, 'um'):g} µm.")

"""Limits whose sentences a test chooses, and pages of them."""

from stiction.devices.limits.limit import Limit, Side
from stiction.report.limits import pages
from stiction.stages.beams.pair_warnings import Subject


def noted(text, surface="B2"):
    """Limit with the sentence ``surface B2: text``."""
    return Limit("note", Side.EITHER, False, numbers={"surface": surface, "flag": text})


def save_page(folder, *limits, name="pair b"):
    """Write the page of limits of a pair or device in a folder."""
    paths = {key: folder / file for key, file in pages.FILES.items()}
    pages.save(({Subject(name): list(limits)}, {}), paths)

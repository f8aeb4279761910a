"""Pictures in TIFF whose values are numbers with a decimal point: maps of heights without a unit and a size."""

import io

import numpy as np

from stiction.formats.channel import Channel, numbered
from stiction.formats.limits import require_points

#: First bytes of files, by the order of bytes and the size of addresses.
MAGIC = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
#: Tag of Park, whose files have their own reader, and of the number that stands where nothing is known.
_PARK, _NO_DATA = 50432, 42113


def channels(content: bytes, label: str) -> list[Channel]:
    """Channels of a file: every page of numbers with a decimal point. None for other pictures and files of Park."""
    import tifffile  # comes with the library for files

    with tifffile.TiffFile(io.BytesIO(content)) as file:
        if _PARK in file.pages[0].tags:
            return []
        pages = [page for page in file.pages if page.dtype is not None and page.dtype.kind == "f"]
        return numbered(_channel(page, label) for page in pages if len(page.shape) == 2)


def _channel(page, label):
    """Map of a page."""
    require_points(page.shape, label)
    values = np.asarray(page.asarray(), float)
    if _NO_DATA in page.tags:
        values = np.where(values == float(str(page.tags[_NO_DATA].value).strip("\0 ")), np.nan, values)
    return Channel("Default", "", values.shape[::-1], None, lambda: values.T, unit=None)

"""Limits of files: nothing small may unpack without end, and nothing may lead to another file."""

import io
import math
import zlib
from collections.abc import Sequence

from stiction.errors import ScanError

#: Most bytes of a file and of all that is unpacked from it, and most points of a map. ASSUME: larger than any scan.
MOST_BYTES, MOST_POINTS = 2**30, 2**27
#: First bytes of HDF5, which may follow 512, 1024, … bytes of another program.
HDF5 = b"\x89HDF\r\n\x1a\n"


def require_bytes(number: int, label: str) -> None:
    """Refuse a content of too many bytes. Raises ScanError."""
    if number > MOST_BYTES:
        raise ScanError(label, "files", f"holds more than {MOST_BYTES // 2**20} MB, save the map of heights alone")


def require_points(shape: Sequence[int], label: str) -> None:
    """Refuse an array of too many points before it is read. Raises ScanError."""
    if math.prod(map(int, shape)) > MOST_POINTS:
        raise ScanError(label, "files", f"has more than {MOST_POINTS} points, save a smaller map")


def inflated(content: bytes, label: str, form: int = zlib.MAX_WBITS) -> bytes:
    """Content of a stream of zlib, or of gzip (form 31), up to the limit. Raises ScanError beyond, zlib.error."""
    blocks, compressed = [], content
    while compressed:
        stream = zlib.decompressobj(form)
        blocks.append(stream.decompress(compressed, MOST_BYTES + 1))
        require_bytes(sum(map(len, blocks)), label)
        if not stream.eof:
            raise zlib.error("the stream ends too early")
        compressed = stream.unused_data.lstrip(b"\0")
    return b"".join(blocks)


def require_no_links(content: bytes, label: str) -> None:
    """Refuse a file of HDF5 whose values are in other files. Raises ScanError.

    What lies elsewhere could be any file of this machine, or a pipe that never ends.
    """
    offset = 0
    while offset < len(content) and not content.startswith(HDF5, offset):
        offset = 2 * offset or len(HDF5) * 64
    if offset >= len(content):
        return
    import h5py  # comes with the library for files

    with h5py.File(io.BytesIO(content)) as file:
        outside = file.visititems_links(lambda name, link: name if _leads_out(file, name, link) else None)
    if outside is not None:
        raise ScanError(label, "files", f"keeps {outside} in another file: save all values in one")


def _leads_out(file, name, link):
    """Whether a link of HDF5 leads to another file, or to values kept in one."""
    import h5py

    if isinstance(link, h5py.ExternalLink):
        return True
    item = None if isinstance(link, h5py.SoftLink) else file.get(name)
    return isinstance(item, h5py.Dataset) and bool(item.external or item.is_virtual)

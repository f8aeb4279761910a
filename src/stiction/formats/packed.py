"""Contents of compressed files and of archives, as the library for files reads them."""

import io
import posixpath
import re
import struct
import zipfile
from collections.abc import Mapping

from stiction.errors import ScanError
from stiction.formats.limits import inflated, require_bytes

#: First bytes of files that are packed: by gzip, in an archive, and by Digital Surf.
_GZIP, _ZIP, _COMPRESSED_SURF, _SURF = b"\x1f\x8b", b"PK\x03\x04", b"DSCOMPRESSED", b"DIGITAL SURF"
#: Positions of the sizes of two texts behind the header of Digital Surf, and the size of this header.
_TEXTS, _HEADER = 334, 512
#: Files that may be packed in one another, and the form of gzip for zlib.
_MOST_LEVELS, _GZIP_FORM = 3, 31
#: Files that macOS and Windows add to archives, and the index of an x3p file.
_ADDED, _INDEX = re.compile(r"(?:^|/)(?:__MACOSX/.*|\.DS_Store|\._[^/]*|Thumbs\.db)$"), "main.xml"
#: What some programs write into this index, and what is meant.
_MEANT = {"ISO5436 – 2000".encode(): b"ISO5436 - 2000", b"<Offset/>": b"<Offset>0</Offset>"}


def unpacked(name: str, content: bytes, levels: int = _MOST_LEVELS) -> tuple[str, bytes]:
    """Name and content of the file within a packed one, or of the file itself if it is not packed.

    Raises
    ------
    ScanError
        If the content is larger than `stiction.formats.limits.MOST_BYTES`, or packed more than three times.
    """
    if content.startswith((_GZIP, _ZIP)) and not levels:
        raise ScanError(name, "files", f"is packed more than {_MOST_LEVELS} times: unpack it")
    if content.startswith(_GZIP):
        inner = re.sub(r"\.gz$", "", name, flags=re.IGNORECASE)
        return unpacked(inner, inflated(content, name, _GZIP_FORM), levels - 1)
    if content.startswith(_ZIP):
        return _from_archive(name, content, levels)
    if content.startswith(_COMPRESSED_SURF):
        return name, _surf(content, name)
    return name, content


def _from_archive(name, content, levels):
    """Only file of an archive, or the archive without additions by other programs."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        require_bytes(sum(member.file_size for member in archive.infolist()), name)
        members = [member for member in archive.namelist() if not member.endswith("/")]
        data_files = [member for member in members if not _ADDED.search(member)]
        if len(data_files) == 1:
            return unpacked(posixpath.basename(data_files[0]), archive.read(data_files[0]), levels - 1)
        index = next((member for member in data_files if posixpath.basename(member) == _INDEX), _INDEX)
        folder = index.removesuffix(_INDEX)
        stored = {member.removeprefix(folder): archive.read(member) for member in data_files}
    written = stored | ({_INDEX: _meant(stored[_INDEX])} if _INDEX in stored else {})
    return name, content if data_files == members and not folder and written == stored else _archive(written)


def _meant(index):
    """Index of an x3p file as the library reads it."""
    for written, meant in _MEANT.items():
        index = index.replace(written, meant)
    return index


def _archive(members: Mapping[str, bytes]):
    """Archive of these files."""
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return written.getvalue()


def _surf(content, name):
    """File of Digital Surf without compression: the streams listed in its directory, one after another."""
    start = _HEADER + sum(struct.unpack_from("<2H", content, _TEXTS))
    (count,) = struct.unpack_from("<I", content, start)
    sizes = struct.unpack_from(f"<{2 * count}I", content, start + 4)
    require_bytes(sum(sizes[::2]), name)
    position, streams = start + 4 + 8 * count, []
    for size in sizes[1::2]:
        streams.append(inflated(content[position : position + size], name))
        require_bytes(sum(map(len, streams)), name)
        position += size
    return _SURF + content[len(_SURF) : start] + b"".join(streams)

"""Content of a file without its packing, and readers of formats unknown to the library for files."""

import io
import posixpath
import struct
import zipfile
import zlib
from dataclasses import dataclass

from stiction.errors import ScanError
from stiction.formats import float_tiff, high_speed, jpk, nanonis, netcdf, simple_field
from stiction.formats.channel import Channel
from stiction.formats.limits import HDF5, require_bytes, require_no_links
from stiction.formats.packed import unpacked
from stiction.formats.texts.encoding import decoded
from stiction.formats.texts.table import plain

#: Ending of movies of high-speed microscopes, whose first bytes say nothing.
_HIGH_SPEED = "asd"


@dataclass(frozen=True)
class Content:
    """Content of a file."""

    label: str  #: name of the file
    path: str
    name: str  #: of the file within a packed one
    content: bytes
    text: str | None  #: if it is a text
    changed: bool  #: whether the library gets this content in place of the file

    @property
    def ending(self) -> str:
        """Ending of the name, in lower case."""
        return posixpath.splitext(self.name)[1].lower().removeprefix(".")

    def source(self) -> str | io.BytesIO:
        """Content or path to be opened by a reader."""
        return io.BytesIO(self.content) if self.changed else self.path


def content_of(label: str, path: str, stored: bytes) -> Content:
    """Content of a file, unpacked. Numbers of a text are as the library reads them.

    Raises
    ------
    ScanError
        If it is too large, leads to other files, or has numbers that can be read in two ways.
    """
    require_bytes(len(stored), label)
    try:
        name, content = unpacked(label, stored)
    except ScanError as refusal:
        raise ScanError(label, refusal.key, refusal.reason) from None
    except (OSError, EOFError, ValueError, zlib.error, struct.error, zipfile.BadZipFile):
        name, content = label, stored  # the reader of its format says what is damaged
    require_no_links(content, label)
    text = decoded(content)
    if text is not None:
        text = plain(text, label)
        content = text.encode()
    return Content(label, path, name, content, text, content != stored)


@dataclass(frozen=True)
class OwnReader:
    """Reader of a format unknown to the library, with the used part of its readers' interface."""

    kind: str
    channels: list[Channel]

    def format(self) -> str:
        """Name of the format."""
        return self.kind

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


def own_reader(file: Content) -> OwnReader | None:
    """Reader of a format of this folder, or ``None`` for other formats.

    Raises
    ------
    ValueError, KeyError, struct.error
        If a file of these formats is damaged.
    """
    if file.content.startswith(nanonis.MAGIC):
        return OwnReader("sxm", nanonis.channels(file.content))
    if file.ending == _HIGH_SPEED:
        return OwnReader(_HIGH_SPEED, high_speed.channels(file.content))
    if file.content.startswith(simple_field.MAGIC):
        return OwnReader("gsf", simple_field.channels(file.content))
    if file.content.startswith(HDF5) and (channels := jpk.channels(file.content, file.label)):
        return OwnReader("h5-jpk", channels)
    if file.content.startswith(netcdf.MAGIC) and (channels := netcdf.channels(file.content, file.label)):
        return OwnReader("netcdf", channels)
    if file.content.startswith(float_tiff.MAGIC) and (channels := float_tiff.channels(file.content, file.label)):
        return OwnReader("float-tiff", channels)
    return None

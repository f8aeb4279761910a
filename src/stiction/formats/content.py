"""Content of a file without its packing, and readers of formats unknown to the library for files."""

import io
import posixpath
import struct
import zipfile
import zlib
from dataclasses import dataclass

from stiction.formats import high_speed, jpk, nanonis
from stiction.formats.channel import Channel
from stiction.formats.packed import unpacked
from stiction.formats.text import decoded, plain

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
    """Content of a file, unpacked. Numbers of a text are as the library reads them."""
    try:
        name, content = unpacked(label, stored)
    except (OSError, EOFError, ValueError, zlib.error, struct.error, zipfile.BadZipFile):
        name, content = label, stored  # the reader of its format says what is damaged
    text = decoded(content)
    if text is not None:
        text = plain(text)
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
    """Reader of Nanonis, of high-speed microscopes or of JPK, or ``None`` for other formats.

    Raises
    ------
    ValueError, KeyError, struct.error
        If a file of these formats is damaged.
    """
    if file.content.startswith(nanonis.MAGIC):
        return OwnReader("sxm", nanonis.channels(file.content))
    if file.ending == _HIGH_SPEED:
        return OwnReader(_HIGH_SPEED, high_speed.channels(file.content))
    found = jpk.channels(file.content) if file.content.startswith(jpk.MAGIC) else []
    return OwnReader("h5-jpk", found) if found else None

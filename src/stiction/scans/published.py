"""Published surfaces as files of scans: the maps of a container.

Containers of contact.engineering are read by SurfaceTopography. Each of their maps becomes a file of its own, which a
study names like any other scan: a run needs neither the container nor a network.
"""

import contextlib
import io
import re
import textwrap
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

import yaml

from stiction.errors import ScanError
from stiction.scans.reading import read, silenced

#: Characters of the name of a surface that no key of ``surfaces`` may have, and the longest name.
_NOT_IN_KEYS, _LONGEST_NAME = re.compile(r"[^A-Za-z0-9_-]+"), 32
#: Metadata of a map, and their value if its undefined points were left as they are; longest quoted title.
_FILLED, _AS_THEY_ARE, _LONGEST_TITLE = "fill_undefined_data_mode", "do-not-fill", 100
#: Names of the metadata of a container, their largest size, and that of all files [MiB]; size of a MiB [bytes].
_METADATA, LARGEST_METADATA, LARGEST_FILES, _MIB = ("index.json", "meta.yml"), 5, 4000, 2**20
#: Largest number of entries in the metadata, each counted as often as an alias repeats it.
MOST_ENTRIES = 500_000
#: First bytes of HDF5.
_HDF5 = b"\x89HDF"


@dataclass(frozen=True)
class Published:
    """Surface of a container."""

    name: str  #: as a key of ``surfaces``
    files: tuple[str, ...]  #: names of the files of its maps
    left_out: tuple[str, ...]  #: sentences on its other measurements, and on changed maps


def unpack(content: bytes, source: str, folder: Path) -> list[Published]:
    """Write every map of a container that can be read as a scan into a file of its own.

    Parameters
    ----------
    content : bytes
        Content of the container.
    source : str
        Its name in messages.
    folder : path
        Existing folder for the files.

    Raises
    ------
    ScanError
        If the content is no container, is too large, damaged, or without maps.
    """
    surfaces = []
    for container in _containers(content, source):
        name = _key(_title(container.info.get("name"), ""), [surface.name for surface in surfaces])
        surfaces.append(_unpacked(name, container, folder))
    if not any(surface.files for surface in surfaces):
        why = "".join(f": {surface.left_out[0]}" for surface in surfaces[:1] if surface.left_out)
        raise ScanError(source, "files", f"holds no map of heights{why}")
    return surfaces


def _containers(content, source):
    """Surfaces of a container, each a sequence of measurements."""
    with silenced():
        try:
            from SurfaceTopography.Container.IO import read_container
        except ImportError:
            reason = "needs the library SurfaceTopography to be read: pip install 'SurfaceTopography>=1.27'"
            raise ScanError(source, "files", reason) from None
        try:
            _require_moderate(content, source)
            containers = read_container(io.BytesIO(content))
            for container in containers:  # the library takes whatever the metadata hold
                container.info.get("name")
                [about.get("name") for about in container.info["topographies"]]
            return containers
        except ScanError:
            raise
        except Exception as reason:  # whatever the library raises on a damaged file
            why = f"is no container of contact.engineering, or damaged ({type(reason).__name__})"
            raise ScanError(source, "files", why) from None


def _require_moderate(content, source):
    """Refuse an archive that takes far more memory than its own, and files in it that read others."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        stated = {member.filename: member.file_size for member in archive.infolist()}
        if sum(member.file_size for member in archive.infolist()) > LARGEST_FILES * _MIB:
            raise ScanError(source, "files", f"holds more than {LARGEST_FILES} MiB")
        for name in stated.keys() & {*_METADATA}:
            if stated[name] > LARGEST_METADATA * _MIB:
                raise ScanError(source, "files", f"has more than {LARGEST_METADATA} MiB in {name}")
        if "meta.yml" in stated and _entries(archive.read("meta.yml")) > MOST_ENTRIES:
            raise ScanError(source, "files", f"has more than {MOST_ENTRIES} entries in meta.yml")
        if outside := [name for name in stated if _reads_others(_hdf5_in(archive, name))]:
            raise ScanError(source, "files", f"holds {outside[0]}, which reads files outside of it")


def _entries(text):
    """Number of entries of a text in YAML, each counted as often as an alias repeats it; infinite for a cycle."""
    counted = {}

    def size(node):
        """Entries of a node of the graph."""
        if id(node) not in counted:
            counted[id(node)] = float("inf")  # until known: a node that contains itself has no end
            parts = node.value if isinstance(node.value, list) else []
            inside = (
                node_inside for entry in parts for node_inside in (entry if isinstance(entry, tuple) else (entry,))
            )
            counted[id(node)] = 1 + sum(map(size, inside))
        return counted[id(node)]

    root = yaml.compose(text, Loader=yaml.SafeLoader)  # the loader in C ends the process at a million open brackets
    return size(root) if root else 0


def _hdf5_in(archive, name):
    """Content of a file of HDF5 in an archive, empty for others and for those that cannot be read."""
    with contextlib.suppress(zipfile.BadZipFile, zlib.error, RuntimeError, EOFError), archive.open(name) as file:
        return file.read(len(_HDF5)) == _HDF5 and archive.read(name)
    return b""


def _reads_others(content):
    """Whether a file of HDF5 has links into other files, or datasets in them."""
    if not content:
        return False
    import h5py  # comes with SurfaceTopography

    links = []

    def look(group):
        """Look at the links and datasets of a group."""
        for name in group:
            link = group.get(name, getlink=True)
            if not isinstance(link, h5py.HardLink):
                links.append(name)
            elif isinstance(entry := group[name], h5py.Group):
                look(entry)
            elif isinstance(entry, h5py.Dataset) and (entry.external or entry.is_virtual):
                links.append(name)

    with h5py.File(io.BytesIO(content), "r") as file:
        look(file)
    return bool(links)


def _title(name, otherwise):
    """Name of a user as a short line of signs that can be printed."""
    signs = "".join(sign if sign.isprintable() else " " for sign in str(name or otherwise))
    return textwrap.shorten(signs, _LONGEST_TITLE, placeholder=" ...") or otherwise


def _key(name, keys):
    """Name of a surface as a key, unlike others."""
    stem = _NOT_IN_KEYS.sub("_", name).strip("_-")[: _LONGEST_NAME - 6]
    stem = stem if stem[:1].isalpha() and not stem.startswith("dry_") else f"Surface_{stem}"[: _LONGEST_NAME - 6]
    if stem not in keys:
        return stem
    return next(name for number in count(2) if (name := f"{stem}_{number}") not in keys)


def _unpacked(name, container, folder):
    """Surface with its maps in files, one for every measurement that has one."""
    files, left_out = [], []
    for number, (title, measurement) in enumerate(_measurements(container), start=1):
        path = folder / f"{name}_{number}.nc"
        if why := measurement if isinstance(measurement, str) else _written(measurement, path):
            left_out.append(f"{title} is not used: {why}")
            path.unlink(missing_ok=True)
            continue
        files.append(path.name)
        if (mode := measurement.info.get(_FILLED, _AS_THEY_ARE)) != _AS_THEY_ARE:
            left_out.append(f"{title} has filled gaps ({_title(mode, '')}), which count as measured")
    return Published(name, tuple(files), tuple(left_out))


def _written(measurement, path):
    """Write a map into a file, and return why it is no scan, empty if it is one."""
    with silenced():
        try:
            measurement.to_netcdf(str(path))
        except OSError:  # a full disk
            raise
        except Exception as reason:  # whatever the library does not write
            return f"it cannot be written ({type(reason).__name__})"
    try:
        read(path)
    except ScanError as refusal:
        return f"it {refusal.reason}"
    return ""


def _measurements(container) -> Iterator[tuple[str, Any]]:
    """Title of every measurement of a surface, and its map, or why it has none."""
    for number, about in enumerate(container.info["topographies"]):
        with silenced():
            try:
                heights = container[number]
                heights = heights if heights.dim == 2 and heights.is_uniform else "it is no map of equal distances"
            except Exception as reason:  # whatever a reader raises on a damaged file
                heights = f"it cannot be read ({type(reason).__name__})"
        yield _title(about.get("name"), f"measurement {number + 1}"), heights

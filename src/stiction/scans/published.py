"""Published surfaces as files of scans: the maps of a container file, or of the one behind a DOI.

Containers of contact.engineering are read by SurfaceTopography. Each of their maps becomes a file of its own, which a
study names like any other scan: a run needs neither the container nor a network.
"""

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stiction.errors import ScanError
from stiction.scans.reading import silenced

#: A DOI, and what is in front of it in an address.
_DOI, _RESOLVER = re.compile(r"10\.\d{4,9}/\S+"), "https://doi.org/"
#: Characters of the name of a surface that no key of ``surfaces`` may have, and the longest name.
_NOT_IN_KEYS, _LONGEST_NAME = re.compile(r"[^A-Za-z0-9_-]+"), 32
#: Metadata of a map, and their value if its undefined points were left as they are.
_FILLED, _AS_THEY_ARE = "fill_undefined_data_mode", "do-not-fill"


@dataclass(frozen=True)
class Published:
    """Surface of a container."""

    name: str  #: as a key of ``surfaces``
    files: tuple[str, ...]  #: names of the files of its maps
    left_out: tuple[str, ...]  #: sentences on its other measurements, and on changed maps


def unpack(source: str, folder: Path) -> list[Published]:
    """Write every map of a container into a file of its own.

    Parameters
    ----------
    source : str
        Path of a container, DOI of a published one, or the address of its page.
    folder : path
        Existing folder for the files.

    Raises
    ------
    ScanError
        If there is no such container, it is damaged or without maps, or a file exists already.
    """
    named = {}
    for container in _containers(source):
        named[_key(str(container.info.get("name", "")), named)] = container
    files = {name: [folder / f"{name}_{number + 1}.nc" for number in range(len(named[name]))] for name in named}
    if there := [file for of_surface in files.values() for file in of_surface if file.exists()]:
        raise ScanError(str(there[0]), "files", "exists already: nothing was written")
    surfaces = [_unpacked(name, container, files[name]) for name, container in named.items()]
    if not any(surface.files for surface in surfaces):
        raise ScanError(source, "files", "holds no map of heights")
    return surfaces


def _containers(source):
    """Surfaces of a container, each a sequence of measurements."""
    with silenced():
        try:
            from SurfaceTopography.Container.IO import read_container, read_published_container
        except ImportError:
            reason = "needs the library SurfaceTopography to be read: pip install 'SurfaceTopography>=1.27'"
            raise ScanError(source, "files", reason) from None
        found = Path(source).is_file()
        try:
            if found:
                return read_container(io.BytesIO(Path(source).read_bytes()))  # the library leaves files open
            return read_published_container(_address(source))
        except ScanError:
            raise
        except Exception as reason:  # whatever the library raises on a damaged file, or without a network
            why = "is no container of contact.engineering, or damaged" if found else "cannot be fetched"
            raise ScanError(source, "files", f"{why} ({type(reason).__name__})") from None


def _address(source):
    """Address of the page of a published container."""
    if _DOI.fullmatch(source):
        return _RESOLVER + source
    if source.startswith(("https://", "http://")):
        return source
    raise ScanError(source, "files", "does not exist; give a container file, a DOI, or the address of its page")


def _key(name, others):
    """Name of a surface as a key, unlike others."""
    stem = _NOT_IN_KEYS.sub("_", name).strip("_-")[: _LONGEST_NAME - 3]
    stem = stem if stem[:1].isalpha() and not stem.startswith("dry_") else f"Surface_{stem}"[: _LONGEST_NAME - 3]
    names = (stem, *(f"{stem}_{number}" for number in range(2, 100)))
    return next(each for each in names if each not in others)


def _unpacked(name, container, paths):
    """Surface with its maps in files, one for every measurement that has one."""
    files, left_out = [], []
    for path, (title, measurement) in zip(paths, _measurements(container), strict=True):
        if isinstance(measurement, str):
            left_out.append(f"{title} is not used: {measurement}")
            continue
        measurement.to_netcdf(str(path))
        files.append(path.name)
        if (mode := measurement.info.get(_FILLED, _AS_THEY_ARE)) != _AS_THEY_ARE:
            left_out.append(f"{title} has filled gaps ({mode}), which count as measured")
    return Published(name, tuple(files), tuple(left_out))


def _measurements(container) -> Iterator[tuple[str, Any]]:
    """Title of every measurement of a surface, and its map, or why it has none."""
    described = container.info.get("topographies", [])
    for number, about in enumerate(described):
        with silenced():
            try:
                found = container[number]
                found = found if found.dim == 2 and found.is_uniform else "it is no map of equal distances"
            except Exception as reason:  # whatever a reader raises on a damaged file
                found = f"it cannot be read ({type(reason).__name__})"
        yield str(about.get("name") or f"measurement {number + 1}"), found

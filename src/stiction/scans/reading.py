"""Files of microscopes, read by SurfaceTopography and `stiction.formats`: units, axes, undefined points, and channel.

The library is imported only when a file is read. It regards every channel with a length, and some
without, as heights; the channel is therefore selected by name and unit. What the library prints, logs or raises never
reaches the user: every unusable file is a `stiction.errors.ScanError`.
"""

import contextlib
import io
import logging
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from stiction.errors import ScanError
from stiction.formats.axes import without_axes
from stiction.formats.content import content_of, own_reader
from stiction.formats.heights import STORED, UNITS, height_channel, unit_of
from stiction.formats.limits import require_bytes, require_points
from stiction.formats.no_data import require_no_mark, without_marks
from stiction.formats.texts.lines import COORDINATES, misread, uneven
from stiction.regular_files import require_regular
from stiction.rounding import in_percent
from stiction.scans.scan import PIXELS, Frame, Scan, stored_once

#: Formats that any file of a certain length has: recognised by the ending of the file only.
_WITHOUT_MAGIC = {"hgt", "nms"}
#: Formats of text: maps of lines, and points with their coordinates.
_TEXTS = _LINES, _POINTS = "asc", "xyz"
#: Formats of bare numbers, which may have axes before the heights, and formats with masks drawn by people.
_BARE, _MASKED = {_LINES, "npy", "npz", "h5", "mat", "float-tiff"}, {"gwy"}
#: Metadata of instruments on whether the stored heights are levelled, and their values if they are not.
_LEVELLED = re.compile(r"offline planefit|(?:planefit|flattenorder) (\d+)", re.IGNORECASE)
_NOT_LEVELLED = {"none", "-1", "0", ""}
#: Largest relative difference between the size in the file and the size given, and longest quoted reason.
_SAME_SIZE, _LONGEST_REASON = 0.01, 120


@dataclass(frozen=True)
class Source:
    """Settings for reading the files of a surface. Every item is optional."""

    channel: str | None = None  #: name, or name#2 for the second of equal names
    fast_axis: str = "x"  #: axis of the file along which the microscope scans a line, x or y
    size: tuple[float, float] | None = None  #: along x and y, for files without a size [m]
    height_unit: str | None = None  #: for files without a unit, one of ``UNITS``


@dataclass(frozen=True)
class ScanFile:
    """Content of a file: the scan, its origin, and notes on its limits."""

    scan: Scan
    channel: str  #: identifier of the channel that was read
    unit: str  #: of the heights in the file
    notes: tuple[str, ...]  #: sentences on the choice of the channel and on levelling by the instrument


def read(path: str | Path, source: Source | None = None) -> ScanFile:
    """Read the heights of a file of any format known to SurfaceTopography.

    Parameters
    ----------
    path : path
    source : Source, optional

    Raises
    ------
    ScanError
        If the file has no usable map of heights, or the configuration contradicts it.
    """
    path = Path(path)
    _refuse_empty(path)
    with silenced():
        library = _library(path.name)
        try:
            return _read(library, path, source or Source())
        except ScanError as reason:  # ends here with all that it refers to, so that files are closed in silence
            refused = ScanError(reason.file, reason.key, reason.reason)
        except Exception as reason:  # whatever a reader raises on a damaged file
            refused = _unreadable(library, path.name, reason)
    raise refused


def _read(library, path, source):
    """`ScanFile` of a non-empty file."""
    require_bytes(path.stat().st_size, path.name)
    name, file = path.name, content_of(path.name, str(path), path.read_bytes())
    with _reader_of(library, file) as reader:
        if not reader.channels:
            raise ScanError(
                name,
                "files",
                "holds no map with units of length: set them in the program that wrote it, or the file is damaged",
            )
        channel, notes = height_channel(reader.channels, source.channel, name)
        if channel.dim != 2:
            raise ScanError(name, "files", "is a profile: list it under profiles, in place of scans")
        if reader.format() in (_LINES, _POINTS):
            _require_all_lines(library, file, reader.format(), channel)
        require_points(channel.nb_grid_pts, name)
        unit, (size, resized) = _unit(channel, source, name), _size(channel, source, name)
        heights, remarks = _stored_heights(channel, unit, reader.format(), name)
        heights, times = stored_once(heights)
        notes += _instrument_levelling(channel, name) + _note(channel, name)
        identifier = channel.channel_id
    if source.fast_axis == "y":
        heights, size = heights.T, size[::-1]
    scan = _scan(heights, size, name, source, UNITS[unit])
    _require_no_mark(scan.heights, name, UNITS[unit])
    remarks = resized + remarks + _oddities(scan, times)
    return ScanFile(scan, identifier, unit, notes + tuple(f"{name}: {note}" for note in remarks))


def _oddities(scan, times):
    """Notes on lines that stand there several times, are no part of the scan, and on points that stand out."""
    copies = f"lines stand there {times[0]} times along one axis and {times[1]} times along the other, and count once"
    stopped, out = f"{scan.stopped}, count as undefined", f"{scan.standing_out}: mask them if they are no surface"
    return (copies,) * (max(times) > 1) + (stopped,) * bool(scan.stopped) + (out,) * bool(scan.standing_out)


def _stored_heights(channel, unit, kind, name):
    """Heights [m] without axes and marks of no data, and notes on these."""
    values = _heights(channel, name)
    values, axes = without_axes(values) if kind in _BARE else (values, "")
    delivered = _delivered_unit(channel, unit)
    try:
        stored, marks = without_marks(values * (UNITS[delivered] / UNITS[unit]))
    except ValueError as doubt:
        raise ScanError(name, "files", str(doubt)) from None
    heights = UNITS[delivered] * (np.where(np.isnan(stored), np.nan, values) if marks else values)
    return heights, tuple(note for note in (axes, marks, _undefined(values, kind)) if note)


def _require_no_mark(heights, name, unit):
    """Refuse heights with values that may be marks of no data, in terms of their unit [m]."""
    try:
        require_no_mark(heights / unit)
    except ValueError as doubt:
        raise ScanError(name, "files", str(doubt)) from None


def _undefined(heights, kind):
    """Note on points without a height in the file. Empty if there are none."""
    number = int((~np.isfinite(heights)).sum())
    cause = "under a mask" if kind in _MASKED else "without a height"
    points = f"{number} point{'s' * (number > 1)} ({in_percent(number / heights.size)})"
    return f"{points} {cause} in the file count as undefined" if number else ""


def _scan(heights, size, name, source, unit):
    """Make a scan. Blame marks of no data before the unit [m], and the file for values not set in the configuration."""
    try:
        return Scan(heights, size, name)
    except ScanError as refusal:
        _require_no_mark(heights, name, unit)
        stated = {"size_um": source.size, "height_unit": source.height_unit}
        raise ScanError(name, "files" if stated.get(refusal.key) is None else refusal.key, refusal.reason) from None


def _refuse_empty(path):
    try:
        require_regular(path)
        with path.open("rb") as file:
            first = file.read(1)
    except OSError as reason:
        raise ScanError(path.name, "files", f"cannot be opened: {reason.strerror}") from None
    if not first:
        raise ScanError(path.name, "files", "is empty")


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """Suppress warnings, log records and output of libraries."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(io.StringIO()),
            contextlib.redirect_stderr(io.StringIO()),
        ):
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(before)


def _library(name):
    """Used functions and exceptions of SurfaceTopography. Only the library's own errors are sentences for users."""
    try:
        from SurfaceTopography import IO
    except ImportError:
        raise ScanError(
            name, "files", "needs the library SurfaceTopography to be read: pip install 'SurfaceTopography>=1.27'"
        ) from None
    endings = {}
    for kind in IO.readers:
        for ending in {kind.format(), *(kind.file_extensions() or ())}:
            endings.setdefault(ending, []).append(kind)
    return SimpleNamespace(
        open=IO.open_topography,
        unknown=IO.CannotDetectFileFormat,
        error=IO.ReadFileError,
        endings=endings,
        formats=IO.lookup_reader_by_format,
    )


def _reader_of(library, file):
    """Reader of a file, first by its ending. Refuses a file of no known format."""
    if reader_of_format := own_reader(file):
        return reader_of_format
    kinds = [kind.format() for kind in library.endings.get(file.ending, ()) if kind.format() not in _TEXTS]
    for kind in kinds:
        with contextlib.suppress(Exception):  # whatever a reader raises on a file of another format
            return library.open(file.source(), format=kind)
    try:
        reader = library.open(file.source())
    except library.unknown:
        _require_even_lines(file)
        raise _unreadable(library, file.label, _error_of_its_format(library, file)) from None
    if reader.format() in _WITHOUT_MAGIC and reader.format() not in kinds:
        reader.close()
        raise _unreadable(library, file.label, _error_of_its_format(library, file))
    return reader


def _error_of_its_format(library, file):
    """Error of the reader for the ending of a file, or ``None`` if no format has this ending."""
    errors = (_error_of(kind, file) for kind in reversed(library.endings.get(file.ending, ())))
    return next(errors, None)


def _error_of(kind, file):
    """Error of the reader of a format for a file, or ``None`` if it accepts the file."""
    try:
        kind(file.source()).close()
    except Exception as error:  # whatever a reader raises on a damaged file
        return error
    return None


def _unreadable(library, name, error):
    """Refusal of a file in one sentence, with the reason of the library and a way out."""
    reason = f"cannot be read as any known format, or is damaged{_first_line_of(library, error)}"
    return ScanError(name, "files", f"{reason}; open it in Gwyddion and save it as .gwy")


def _first_line_of(library, error):
    """First line of an error of the library itself, in brackets, if it is short."""
    message = str(error) if isinstance(error, library.error) else ""
    line = next(iter(message.strip().splitlines()), "").rstrip(". ")
    return f" ({line})" if 0 < len(line) <= _LONGEST_REASON else ""


def _require_all_lines(library, file, kind, channel):
    """Refuse a text with lines left out by the library, and with points taken for a map of three columns."""
    wrong = misread(file.text, commas=kind == _POINTS)
    if wrong is not None:
        line, value = wrong
        shown = value if len(value) <= _LONGEST_REASON else value[:_LONGEST_REASON] + " …"
        raise ScanError(
            file.label,
            "files",
            f"has {shown!r} in line {line}, must be a number, or nan where no height is defined",
        )
    if kind == _LINES and channel.nb_grid_pts[0] <= COORDINATES:
        reason = _first_line_of(library, _error_of(library.formats[_POINTS], file))
        raise ScanError(file.label, "files", f"lists points that are on no regular grid{reason}; a map is needed")


def _require_even_lines(file):
    """Refuse a table of numbers whose lines have different numbers of values."""
    uneven_line = uneven(file.text, commas=True) if file.text is not None else None
    if uneven_line is not None:
        line, number, usual = uneven_line
        values = f"{number} value{'s' * (number > 1)} in line {line}, and {usual} in others"
        raise ScanError(file.label, "files", f"has {values}: write nan where no height is defined")


def _unit(channel, source, name):
    """Unit of the heights, from the file or, if it has none, from the configuration."""
    stored = unit_of(channel)
    if stored is None and source.height_unit is None:
        raise ScanError(name, "height_unit", f"has no unit; give one of {', '.join(UNITS)}")
    if stored is not None and stored not in STORED:
        shown = stored if isinstance(stored, str) else "no single unit"
        raise ScanError(name, "channel", f"has channel {channel.channel_id} in {shown}, which is not a length")
    if None not in (stored, source.height_unit) and UNITS[stored] != UNITS[source.height_unit]:
        raise ScanError(name, "height_unit", f"has heights in {stored}, not in {source.height_unit}")
    return stored or source.height_unit


def _delivered_unit(channel, unit):
    """Unit of the heights from the library. It converts lengths to the lateral unit, if that is a length."""
    return channel.unit if channel.unit in STORED and unit_of(channel) is not None else unit


def _size(channel, source, name):
    """Size along x and y [m], from the file or, if it has none, from the configuration, and notes on it."""
    if channel.physical_sizes is None or channel.unit not in STORED:
        if source.size is None:
            raise ScanError(name, "size_um", "has no size in a unit of length; give the size along x and y")
        if channel.physical_sizes is not None and channel.unit is None:
            return _size_of_coordinates(channel, source.size, name), ()
        return source.size, ()
    stored = tuple(float(length) * UNITS[channel.unit] for length in channel.physical_sizes)
    if source.size is None or _same_size(source.size, stored, channel.nb_grid_pts):
        return stored, ()
    shown = " x ".join(f"{length / UNITS['um']:.4g}" for length in stored)
    pixels = Frame(channel.nb_grid_pts, stored).pixel
    if not all(PIXELS[0] <= pixel / UNITS["um"] <= PIXELS[1] for pixel in pixels):
        return source.size, (f"its size of {shown} µm is that of no scan, the stated one was taken",)
    reason = f"has a size of {shown} µm, which differs by more than 1 %"
    raise ScanError(name, "size_um", f"{reason}: leave out size_um, or correct the size in Gwyddion")


def _same_size(size_of_key, extent, points):
    """Whether two sizes agree, the stated one between the outer edges of the points or between their centres."""
    nominal = _between_centres(extent, points)
    return any(np.allclose(size_of_key, size, rtol=_SAME_SIZE, atol=0) for size in (extent, nominal))


def _between_centres(size, points):
    """Distance of the outermost points along both axes, from the number of points times their distance."""
    return tuple(length * (n - 1) / n for length, n in zip(size, points, strict=True))


def _size_of_coordinates(channel, size, name):
    """Stated size of coordinates without a unit [m]. Refuse one that fits them in no unit of length.

    Numbers of points are accepted. A size that fits better between the outermost points is extended by one step.
    """
    extent, points = tuple(map(float, channel.physical_sizes)), channel.nb_grid_pts
    scaled = [tuple(length / unit for length in size) for unit in UNITS.values()]
    errors = [
        min(_difference(size, extent_of) for size in scaled) for extent_of in (extent, _between_centres(extent, points))
    ]
    if _difference(extent, points) <= _SAME_SIZE or errors[0] <= min(_SAME_SIZE, errors[1]):
        return size
    if errors[1] <= _SAME_SIZE:
        return tuple(length * n / (n - 1) for length, n in zip(size, points, strict=True))
    stated_words, found_words = (
        " x ".join(f"{length:.4g}" for length in pair) for pair in (np.array(size) / UNITS["um"], extent)
    )
    raise ScanError(
        name, "size_um", f"has coordinates over {found_words}, which are {stated_words} µm in no unit of length"
    )


def _difference(first, second):
    """Largest relative difference of two sizes."""
    return float(np.max(np.abs(np.divide(first, second) - 1)))


def _heights(channel, name):
    """Heights of a channel, (n_x, n_y) float64, NaN where undefined, in the unit of `_delivered_unit`."""
    size = None if channel.physical_sizes is not None else channel.nb_grid_pts
    topography = channel.topography(physical_sizes=size)
    if not topography.is_uniform:
        raise ScanError(name, "files", "has unequal distances between its points; a regular map is needed")
    return np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)


def _note(channel, name):
    """Note of the reader on the heights."""
    return (f"{name}: {channel.info['note']}",) if "note" in channel.info else ()


def _instrument_levelling(channel, name):
    """Note on heights stored already levelled by the instrument, according to the metadata."""
    levelled = []
    for key, value in channel.info.get("raw_metadata", {}).items():
        match = _LEVELLED.fullmatch(str(key))
        if match and match[1] in (None, str(channel.index)) and str(value).strip().lower() not in _NOT_LEVELLED:
            levelled.append(f"{key}: {value}")
    if not levelled:
        return ()
    return (f"{name}: the instrument has levelled channel {channel.channel_id} already ({', '.join(levelled)})",)

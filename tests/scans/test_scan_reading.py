"""Files written by SurfaceTopography and by hand, read back; files that cannot be used, refused in one sentence."""

import logging
import struct
import subprocess
import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from topographies import SurfaceTopography

from stiction.errors import ScanError
from stiction.formats.heights import height_channel
from stiction.scans import reading
from stiction.scans.reading import Source, read
from stiction.streams import stream

#: Rougher along the second axis; 64 x 40 points of 100 nm.
HEIGHTS = 3e-9 * stream(1, "reading").standard_normal((64, 40)) * np.linspace(0.5, 1.5, 40)
SIZE = (6.4e-6, 4e-6)
GIVEN = Source(size=SIZE, height_unit="nm")


def topography(heights=HEIGHTS, size=SIZE, unit="m"):
    return SurfaceTopography.Topography(heights, size, unit=unit)


def written(folder, ending, surface):
    path = folder / f"scan.{ending}"
    getattr(surface, {"gwy": "to_gwy", "x3p": "to_x3p", "nc": "to_netcdf"}[ending])(str(path))
    return path


@pytest.mark.parametrize(("ending", "lateral"), [("gwy", 1e-12), ("x3p", 1e-12), ("nc", 1e-7)])
def test_heights_size_and_axes_survive_a_round_trip(tmp_path, ending, lateral):
    scan = read(written(tmp_path, ending, topography())).scan
    np.testing.assert_allclose(scan.heights, HEIGHTS, rtol=1e-12)
    np.testing.assert_allclose(scan.size, SIZE, rtol=lateral)
    np.testing.assert_allclose(scan.frame.pixel, (100e-9, 100e-9), rtol=lateral)
    assert scan.name == f"scan.{ending}"


@pytest.mark.parametrize("ending", ["gwy", "x3p"])
def test_pixels_need_not_be_square(tmp_path, ending):
    scan = read(written(tmp_path, ending, topography(size=(6.4e-6, 8e-6)))).scan
    np.testing.assert_allclose(scan.frame.pixel, (100e-9, 200e-9))


def test_the_first_index_runs_along_the_fast_axis(tmp_path):
    ramp = 1e-9 * (np.arange(64.0)[:, None] + np.random.default_rng(1).random(40))
    path = written(tmp_path, "gwy", topography(ramp))
    along_x, along_y = (read(path, Source(fast_axis=axis)).scan for axis in "xy")
    np.testing.assert_allclose(np.diff(along_x.heights, axis=0), 1e-9)
    np.testing.assert_allclose(np.diff(along_y.heights, axis=1), 1e-9)
    np.testing.assert_allclose(along_y.size, SIZE[::-1])


@pytest.mark.parametrize(("unit", "metres"), [("m", 1), ("mm", 1e-3), ("µm", 1e-6), ("um", 1e-6), ("nm", 1e-9)])
def test_units_of_the_file_are_converted(tmp_path, unit, metres):
    scan = read(written(tmp_path, "nc", topography(HEIGHTS / metres, tuple(x / metres for x in SIZE), unit))).scan
    np.testing.assert_allclose(scan.heights, HEIGHTS, rtol=1e-12)
    np.testing.assert_allclose(scan.size, SIZE, rtol=1e-7)


def igor(path, heights, lateral, unit):
    """Write a map of heights as a binary wave of Igor, version 5, with lengths in two units."""
    wave = bytearray(320)
    struct.pack_into("<ih", wave, 12, heights.size, 4)  # 64-bit numbers
    struct.pack_into("<4i", wave, 68, *heights.shape, 1, 0)
    struct.pack_into(
        "<2d", wave, 84, *(x / n / reading.UNITS[lateral] for x, n in zip(SIZE, heights.shape, strict=True))
    )
    for offset, text in ((148, unit), (152, lateral), (156, lateral)):
        struct.pack_into("3s", wave, offset, text.encode())
    head = struct.pack("<hhi14i", 5, 0, len(wave) + 8 * heights.size, *[0] * 14)
    path.write_bytes(head + wave + np.fliplr(heights).tobytes("F"))
    return path


@pytest.mark.parametrize(("lateral", "unit"), [("um", "nm"), ("nm", "um"), ("m", "nm"), ("um", "um")])
def test_heights_in_another_unit_than_the_sides_are_not_scaled_twice(tmp_path, lateral, unit):
    path = igor(tmp_path / "scan.ibw", HEIGHTS / reading.UNITS[unit], lateral, unit)
    found = read(path, Source(channel="no name (1)"))
    np.testing.assert_allclose(found.scan.heights, HEIGHTS, rtol=1e-12)
    np.testing.assert_allclose(found.scan.size, SIZE)
    assert reading.UNITS[found.unit] == reading.UNITS[unit]


def test_an_ampere_in_a_file_is_no_angstrom(tmp_path):
    with pytest.raises(ScanError, match="^channel: scan.ibw has channel no name .* in A, which is not a length"):
        read(igor(tmp_path / "scan.ibw", HEIGHTS, "um", "A"), Source(channel="no name (1)"))


#: Lateral unit and unit of the values of a channel, and the unit in which the library returns its heights.
DELIVERED = [("µm", "nm", "µm"), ("nm", "nm", "nm"), (("um", None), "nm", "nm"), (None, "nm", "nm"), ("V", "m", "m")]


@pytest.mark.parametrize(("lateral", "unit", "expected"), DELIVERED)
def test_the_library_returns_heights_in_the_lateral_unit_if_that_is_a_length(lateral, unit, expected):
    (channel,) = channels(("Height", unit))
    channel.unit = lateral
    assert reading._delivered_unit(channel, unit) == expected


@pytest.mark.parametrize(("unit", "metres"), [("nm", 1e-9), ("um", 1e-6), ("Å", 1e-10), ("pm", 1e-12)])
def test_a_matrix_without_units_takes_those_of_the_configuration(tmp_path, unit, metres):
    np.savetxt(tmp_path / "scan.txt", HEIGHTS.T / metres)
    np.save(tmp_path / "scan.npy", HEIGHTS / metres)
    for name in ("scan.txt", "scan.npy"):
        scan = read(tmp_path / name, Source(size=SIZE, height_unit=unit)).scan
        np.testing.assert_allclose(scan.heights, HEIGHTS, rtol=1e-12)
        assert scan.size == SIZE


@pytest.mark.parametrize("ending", ["gwy", "x3p", "nc"])
def test_undefined_points_are_not_numbers(tmp_path, ending):
    mask = np.zeros(HEIGHTS.shape, bool)
    mask[3:6, 7] = True
    scan = read(written(tmp_path, ending, topography(np.ma.masked_array(HEIGHTS, mask)))).scan
    np.testing.assert_array_equal(~scan.defined, mask)
    np.testing.assert_allclose(scan.heights[~mask], HEIGHTS[~mask], rtol=1e-12)
    assert scan.undefined_share == pytest.approx(3 / 2560)


def test_undefined_points_of_a_matrix_are_not_numbers(tmp_path):
    z = HEIGHTS / 1e-9
    z[0, 0] = np.nan
    np.save(tmp_path / "scan.npy", z)
    assert read(tmp_path / "scan.npy", GIVEN).scan.defined.sum() == z.size - 1


def channels(*named):
    """Channels of a file: (name, unit)."""
    result, seen = [], []
    for index, (name, unit) in enumerate(named):
        seen.append(name)
        double = [other for other, _ in named].count(name) > 1
        identifier = f"{name}#{seen.count(name)}" if double else name
        result.append(
            SimpleNamespace(index=index, name=name, channel_id=identifier, unit="nm", data_unit=unit, info={}, dim=2)
        )
    return result


CHOICES = {
    "Height beside others": ([("Phase", "deg"), ("Height", "nm"), ("AmplitudeError", ("nm", None))], None, "Height"),
    "first of equal names": ([("Height", "nm"), ("Height", "nm")], None, "Height#1"),
    "second of equal names": ([("Height", "nm"), ("Height", "nm")], "Height#2", "Height#2"),
    "first of both directions": ([("PhaseTrace", "m"), ("HeightTrace", "m"), ("HeightRetrace", "m")],
                                 None, "HeightTrace"),
    "one sensor": ([("Deflection", "nm"), ("ZSensor", "nm")], None, "ZSensor"),
    "one of two sensors, named": ([("Scan forward (Z-Axis)", "m"), ("Scan forward (Z-AxisSensor)", "m")],
                                  "Scan forward (Z-AxisSensor)", "Scan forward (Z-AxisSensor)"),
    "in both directions": ([("Z Height Forward", "um"), ("Z Height Backward", "um")], None, "Z Height Forward"),
    "a name beside none": ([("channel 0", "nm"), ("Height", "nm")], None, "Height"),
    "file without names": ([("channel 0", None)], None, "channel 0"),
    "default name": ([("Default", "m")], None, "Default"),
    "measured heights alone": ([("Height (measured)", "m"), ("Height (measured, retrace)", "m")],
                               None, "Height (measured)"),
    "any name that is given": ([("Deflection", "nm"), ("Height", "nm")], "Deflection", "Deflection"),
}  # fmt: skip


@pytest.mark.parametrize(("named", "wanted", "expected"), CHOICES.values(), ids=CHOICES)
def test_the_channel_of_the_heights_is_chosen_by_name(named, wanted, expected):
    chosen, notes = height_channel(channels(*named), wanted, "scan.spm")
    assert chosen.channel_id == expected
    assert bool(notes) == (wanted is None and len([name for name, _ in named if "Height" in name]) > 1)
    assert all(note.startswith(f"scan.spm: channel {expected} was read; the file also has ") for note in notes)


REFUSED_CHANNELS = {
    "none is a height": ([("Phase", "deg"), ("Deflection", "nm")], None, "named as a height, only: Phase, Deflection"),
    "a height without length": ([("Height", ("nm", None))], None, "no channel that is named as a height"),
    "an error of the height": ([("Height Error", "nm"), ("Sensor", "nm")], None, "no channel that is named as"),
    "a height in volts": ([("Height", "V")], None, "no channel that is named as a height"),
    "a height in amperes": ([("Height", "A")], None, "no channel that is named as a height"),
    "a single other channel": ([("Friction", "nm")], None, "no channel that is named as a height"),
    "two kinds of heights": ([("Height", "nm"), ("ZSensor", "nm")], None, "name one of: Height, ZSensor"),
    "heights as commanded and as measured": ([("Height", "m"), ("Height (measured)", "m")],
                                             None, "name one of: Height, Height [(]measured[)]"),
    "raw heights and others": ([("Raw Height", "m"), ("Height", "m")], None, "name one of: Raw Height, Height"),
    "an unknown name": ([("Height", "nm")], "height", "no channel height, only: Height"),
}  # fmt: skip


@pytest.mark.parametrize(("named", "wanted", "reason"), REFUSED_CHANNELS.values(), ids=REFUSED_CHANNELS)
def test_without_one_channel_of_heights_the_file_is_refused_with_the_list(named, wanted, reason):
    with pytest.raises(ScanError, match=reason) as caught:
        height_channel(channels(*named), wanted, "scan.spm")
    assert (caught.value.key, caught.value.file) == ("channel", "scan.spm")


@pytest.mark.parametrize("unit", ["V", "deg", "A", ("um", None)])
def test_a_named_channel_must_be_a_length(unit):
    (channel,) = channels(("Deflection", unit))
    with pytest.raises(ScanError, match="channel: scan.spm has channel Deflection in .*, which is not a length"):
        reading._unit(channel, Source(), "scan.spm")


def test_a_size_in_no_unit_of_length_is_not_a_size():
    (channel,) = channels(("Height", "nm"))
    channel.unit, channel.physical_sizes = ("um", None), (5.0, 5.0)
    with pytest.raises(ScanError, match="size_um: scan.spm has no size in a unit of length"):
        reading._size(channel, Source(), "scan.spm")
    assert reading._size(channel, GIVEN, "scan.spm") == (SIZE, ())


def test_levelling_by_the_instrument_is_told():
    metadata = {"Offline Planefit": "Full", "realtime planefit": "Line", "Planefit 0": "None", "FlattenOrder 1": "2"}
    channel = SimpleNamespace(index=0, channel_id="Height", info={"raw_metadata": metadata})
    (note,) = reading._instrument_levelling(channel, "scan.spm")
    assert note == "scan.spm: the instrument has levelled channel Height already (Offline Planefit: Full)"
    for plain in ({}, {"offline planefit": "None"}, {"FlattenOrder 0": "-1"}):
        channel.info = {"raw_metadata": plain}
        assert reading._instrument_levelling(channel, "scan.spm") == ()
    channel.info, channel.index = {"raw_metadata": metadata}, 1
    assert "FlattenOrder 1: 2" in reading._instrument_levelling(channel, "scan.spm")[0]


def bad_files(folder):
    """Contents of unusable files: name, bytes."""
    whole = {ending: written(folder, ending, topography()).read_bytes() for ending in ("gwy", "x3p", "nc")}
    profile = "\n".join(f"{x} {x**2}" for x in range(40))
    return {
        "empty.spm": b"",
        "nonsense.txt": b"nothing in here is a height\n" * 9,
        "picture.png": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 4,
        "square.spm": bytes(2 * 64 * 64),
        "profile.xyz": profile.encode(),
        "column.txt": "\n".join(map(str, range(40))).encode(),
        "no_units.gwy": whole["gwy"].replace(b"unitstr\x00sm\x00", b"unitstr\x00s?\x00"),
    } | {f"half.{ending}": content[: len(content) // 2] for ending, content in whole.items()}


#: Name of an unusable file: (settings, key, sentence).
BAD = {
    "missing.spm": (Source(), "files", "cannot be opened: No such file or directory"),
    "empty.spm": (GIVEN, "files", "is empty"),
    "nonsense.txt": (GIVEN, "files", "cannot be read as any known format, or is damaged"),
    "picture.png": (GIVEN, "files", "cannot be read as any known format, or is damaged"),
    "square.spm": (GIVEN, "files", "cannot be read as any known format, or is damaged"),
    "half.gwy": (Source(), "files", "cannot be read as any known format, or is damaged [(]The file has .* truncated"),
    "half.x3p": (Source(), "files", "cannot be read as any known format, or is damaged"),
    "half.nc": (Source(), "files", "cannot be read as any known format, or is damaged"),
    "profile.xyz": (GIVEN, "files", "is a profile: list it under profiles, in place of scans"),
    "column.txt": (GIVEN, "files", "is a profile: list it under profiles, in place of scans"),
    "small.npy": (GIVEN, "files", "has 40 x 31 points, needs 32 along each side"),
    "flat.npy": (GIVEN, "files", "has the same height, or none, at all points"),
    "nothing.npy": (GIVEN, "files", "has the same height, or none, at all points"),
    "matrix.npy": (Source(height_unit="nm"), "size_um", "has no size in a unit of length"),
    "scan.npy": (Source(size=SIZE), "height_unit", "has no unit; give one of m, mm"),
    "scan.gwy": (Source(size=(6.5e-6, 4e-6)), "size_um", "has a size of 6.4 x 4 µm, which differs by more than 1 %"),
    "scan.x3p": (Source(height_unit="nm"), "height_unit", "has heights in m, not in nm"),
    "point.npy": (Source(size=(0.0, 1e-6), height_unit="nm"), "size_um", "has a size of 0 x 1e-06 m, must be two"),
    "no_units.gwy": (GIVEN, "files", "holds no map with units of length: set them in the program that wrote it, or"),
}


@pytest.mark.parametrize("name", BAD)
def test_an_unusable_file_is_refused_in_one_sentence_with_key_and_file(tmp_path, capfd, name):
    arrays = {"small.npy": HEIGHTS[:40, :31], "flat.npy": np.ones((40, 40)), "nothing.npy": np.full((40, 40), np.nan)}
    for other, content in bad_files(tmp_path).items():
        (tmp_path / other).write_bytes(content)
    for other in ("small.npy", "flat.npy", "nothing.npy", "matrix.npy", "scan.npy", "point.npy"):
        np.save(tmp_path / other, arrays.get(other, HEIGHTS))
    settings, key, sentence = BAD[name]
    with pytest.raises(ScanError, match=f"^{key}: {name} {sentence}") as caught:
        read(tmp_path / name, settings)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 250
    assert capfd.readouterr() == ("", "")


def test_a_size_given_for_a_file_that_has_one_must_agree(tmp_path):
    path = written(tmp_path, "gwy", topography())
    np.testing.assert_allclose(read(path, Source(size=(6.43e-6, 4e-6), height_unit="m")).scan.size, SIZE)


#: Values that programs write for heights that are not defined, or in another way than the library reads.
TOKENS = ["***", "---", "null", "N/A", "1,5", "1.#QNAN", "-", "1.5nm", "0x"]
LINES = [" ".join(f"{height:.4f}" for height in line) for line in HEIGHTS.T / 1e-9]
POINTS = [
    f"{0.1 * i:.1f} {0.1 * j:.1f} {height:.4f}" for (i, j), height in np.ndenumerate(HEIGHTS / 1e-9)
]  # in µm and nm


def replaced(lines, number, column, token):
    """Lines of a text in which a value takes the place of another one."""
    values = lines[number].split()
    values[column] = token
    return [*lines[:number], " ".join(values), *lines[number + 1 :]]


@pytest.mark.parametrize(
    ("ending", "head", "end"),
    [
        ("txt", [], []),
        ("txt", ["# Channel: Height", "", "# 1 2 3 ---"], ["# 4 x 5"]),
        ("txt", ["Channel: Height", "measured in May"], ["end of the data"]),
        ("xyz", [], []),
        ("xyz", ["x y z"], []),
        ("xyz", ["2560", "x [µm], y [µm], z [nm]"], []),
    ],
)
def test_all_lines_of_a_text_are_read(tmp_path, ending, head, end):
    path = tmp_path / f"scan.{ending}"
    lines = LINES if ending == "txt" else POINTS
    path.write_text("\n".join([*head, *lines, *end, ""]), encoding="utf-8")
    np.testing.assert_allclose(read(path, GIVEN).scan.heights, HEIGHTS, atol=1e-13)


#: The library tries 200 headings before it gives up a list of points whose last one is wrong, which takes two seconds.
WRONG = [(ending, token, place) for ending in ("txt", "xyz") for token in TOKENS for place in (0, 7)]
WRONG += [("txt", token, -1) for token in TOKENS] + [("xyz", "***", -1)]


@pytest.mark.parametrize(("ending", "token", "place"), WRONG)
def test_a_line_with_a_value_that_is_no_number_is_refused_with_both(tmp_path, ending, token, place):
    path = tmp_path / f"scan.{ending}"
    lines = LINES if ending == "txt" else POINTS
    number = range(len(lines))[place]
    path.write_text("\n".join(["# heights", *replaced(lines, number, 2, token), ""]), encoding="utf-8")
    with pytest.raises(ScanError) as caught:
        read(path, GIVEN)
    assert f"has {token!r} in line {number + 2}, must be a number, or nan" in str(caught.value)


def test_a_line_without_any_number_is_not_left_out(tmp_path):
    for place in (0, 7, -1):
        lines = list(LINES)
        lines[place] = " ".join(["---"] * len(HEIGHTS))
        (tmp_path / "scan.txt").write_text("\n".join([*lines, ""]))
        with pytest.raises(ScanError, match=r"has '---' in line \d+, must be a number"):
            read(tmp_path / "scan.txt", GIVEN)


def test_words_for_undefined_heights_are_read_as_such(tmp_path):
    for word in ("nan", "NaN", "bad", "Bad", "inf"):
        (tmp_path / "scan.txt").write_text("\n".join([*replaced(LINES, 3, 5, word), ""]))
        scan = read(tmp_path / "scan.txt", GIVEN).scan
        assert np.argwhere(~scan.defined).tolist() == [[5, 3]]


def test_points_on_no_regular_grid_are_not_called_a_map_of_three_columns(tmp_path):
    scattered = [f"{x:.4f} {y:.4f} {z:.4f}" for x, y, z in stream(1, "points").random((2370, 3))]
    for points in (POINTS[:-5], scattered):
        (tmp_path / "scan.xyz").write_text("\n".join([*points, ""]))
        with pytest.raises(ScanError, match=r"lists points that are on no regular grid.*; a map is needed"):
            read(tmp_path / "scan.xyz", GIVEN)


@pytest.mark.parametrize(
    ("size", "scale", "agrees"),
    [
        (SIZE, 1, True),
        ((6.4e-9, 4e-9), 1, True),
        ((6.4e-9, 4e-9), 10, True),
        ((6.42e-6, 4e-6), 1, True),
        ((3e-6, 9e-6), 10, True),
        ((64e-6, 40e-6), 1, False),
        ((6.4e-6, 6.4e-6), 1, False),
        ((5e-6, 5e-6), 1, False),
    ],
    ids=["in µm", "in nm", "in Å", "rounded", "numbers of the points", "ten times", "square", "another"],
)
def test_coordinates_are_compared_with_the_stated_size(tmp_path, size, scale, agrees):
    heights = size[0] / SIZE[0] * HEIGHTS / 1e-9
    points = [f"{0.1 * scale * i:.5g} {0.1 * scale * j:.5g} {z:.7f}" for (i, j), z in np.ndenumerate(heights)]
    (tmp_path / "scan.xyz").write_text("\n".join([*points, ""]))
    if agrees:
        assert read(tmp_path / "scan.xyz", Source(size=size, height_unit="nm")).scan.size == size
    else:
        with pytest.raises(ScanError, match=r"^size_um: scan.xyz has coordinates over 6.4 x 4, which are .* no unit"):
            read(tmp_path / "scan.xyz", Source(size=size, height_unit="nm"))


@pytest.mark.parametrize(("width", "unit"), [(160, "m"), (15, "mm"), (6.4, "mm"), (0.1, "nm"), (6.4, "Å")])
def test_a_size_that_no_microscope_scans_is_refused(tmp_path, width, unit):
    head = [f"# Width: {width} {unit}", f"# Height: {width} {unit}", "# Value units: nm"]
    (tmp_path / "scan.txt").write_text("\n".join([*head, *LINES, ""]), encoding="utf-8")
    with pytest.raises(ScanError, match=r"^files: scan.txt has .*, must be from .* in another unit than is stated$"):
        read(tmp_path / "scan.txt")


@pytest.mark.parametrize("axis", [0, 1])
def test_lines_that_a_scan_did_not_reach_are_undefined_and_told(tmp_path, axis):
    finished = np.moveaxis(HEIGHTS.copy(), axis, 0)
    for rest in (0.0, 1e-9, finished[20], finished[:10]):
        z = finished.copy()
        z[30:40] = rest
        scanned = read(written(tmp_path, "gwy", topography(np.moveaxis(z, 0, axis))))
        defined = np.moveaxis(scanned.scan.defined, axis, 0)
        assert not defined[30:40].any()
        assert defined[:30].all()
        assert defined[40:].all()
        assert scanned.notes == (
            "scan.gwy: 10 empty, constant or repeated lines, as where a scan was stopped, count as undefined",
        )
    assert read(written(tmp_path, "gwy", topography())).notes == ()


LIBRARY, GWYDDION = reading._library("a.spm"), "; open it in Gwyddion and save it as .gwy"


@pytest.mark.parametrize(
    ("reason", "quoted"),
    [("truncated.\nat byte 7", " (truncated)"), ("x" * 121, ""), ("", ""), ("x" * 120, f" ({'x' * 120})")],
)
def test_an_error_of_the_library_is_quoted_by_its_first_line_if_that_is_short(reason, quoted):
    error = reading._unreadable(LIBRARY, "a.spm", LIBRARY.error(reason))
    assert str(error) == f"files: a.spm cannot be read as any known format, or is damaged{quoted}{GWYDDION}"


@pytest.mark.parametrize("error", [IndexError("list index out of range"), KeyError("wave"), MemoryError(), None])
def test_errors_from_inside_the_library_are_not_quoted(error):
    refused = reading._unreadable(LIBRARY, "a.spm", error)
    assert str(refused) == f"files: a.spm cannot be read as any known format, or is damaged{GWYDDION}"


def test_what_libraries_print_log_and_warn_of_is_not_shown(capfd, caplog):
    with reading.silenced():
        print("printed")  # noqa: T201
        print("printed", file=sys.stderr)  # noqa: T201
        warnings.warn("warned", stacklevel=1)
        logging.getLogger("some.library").error("logged")
    assert capfd.readouterr() == ("", "")
    assert not caplog.records
    logging.getLogger("some.library").error("shown again")
    assert len(caplog.records) == 1


def test_a_folder_is_not_a_file(tmp_path):
    with pytest.raises(ScanError, match="cannot be opened: it is a folder, must be a regular file"):
        read(tmp_path)


class Damaged:
    """Reader and channel of a damaged file, which fails where it is asked for one thing."""

    index, name, channel_id, unit, data_unit = 0, "Height", "Height", "nm", "nm"
    format = staticmethod(lambda: "sur")
    dim, physical_sizes, nb_grid_pts, is_uniform = 2, (64.0, 40.0), (64, 40), True

    def __init__(self, where, error):
        self.where, self.error = where, error

    def __getattribute__(self, name):
        if name == object.__getattribute__(self, "where"):
            raise object.__getattribute__(self, "error")
        return object.__getattribute__(self, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def topography(self, **_):
        return self

    def heights(self):
        return HEIGHTS

    @property
    def channels(self):
        return [self]

    @property
    def info(self):
        return {}


@pytest.mark.parametrize("where", ["channels", "dim", "channel_id", "physical_sizes", "topography", "heights", "info"])
def test_damage_that_shows_only_later_is_told_in_the_same_sentence(tmp_path, monkeypatch, where):
    path = tmp_path / "a.tiff"
    path.write_bytes(b"anything")
    for error, quoted in (
        (IndexError("list index out of range\nin some reader"), ""),
        (SurfaceTopography.Exceptions.CorruptFile("File is too short."), r" [(]File is too short[)]"),
    ):
        monkeypatch.setattr(reading, "_reader_of", lambda *_, error=error: Damaged(where, error))
        with pytest.raises(
            ScanError,
            match=f"^files: a.tiff cannot be read as any .* or is damaged{quoted}{GWYDDION}$",
        ):
            read(path)


def test_without_the_library_the_message_tells_how_to_install_it(tmp_path, monkeypatch):
    path = written(tmp_path, "gwy", topography())
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(
        ScanError, match="needs the library SurfaceTopography to be read: pip install 'SurfaceTopography>=1.27'"
    ):
        read(path)


@pytest.mark.slow
def test_the_library_is_imported_only_to_read_and_its_import_warns_nobody(tmp_path):
    path = written(tmp_path, "gwy", topography())
    code = f"""
import sys
import stiction.scans.reading as reading
assert "SurfaceTopography" not in sys.modules
reading.read({str(path)!r})
assert "SurfaceTopography" in sys.modules
"""
    done = subprocess.run([sys.executable, "-W", "error::ImportWarning", "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")

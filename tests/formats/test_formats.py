"""Formats that people have, in files written here: what is read is what was written, and damage is refused."""

import codecs
import gzip
import io
import struct
import zipfile
import zlib

import numpy as np
import pytest
from topographies import SurfaceTopography

from stiction.errors import ScanError
from stiction.formats import high_speed, packed
from stiction.formats.content import content_of, own_reader
from stiction.formats.texts import encoding
from stiction.formats.texts.table import plain as plain_text
from stiction.scans.reading import Source, read
from stiction.streams import stream

h5py = pytest.importorskip("h5py")

#: Rougher along the second axis; 64 x 40 points of 100 nm.
HEIGHTS = 3e-9 * stream(1, "formats").standard_normal((64, 40)) * np.linspace(0.5, 1.5, 40)
SIZE = (6.4e-6, 4e-6)
GIVEN = Source(size=SIZE, height_unit="nm")


def written(folder, ending):
    path = folder / f"scan.{ending}"
    surface = SurfaceTopography.Topography(HEIGHTS, SIZE, unit="m")
    getattr(surface, {"gwy": "to_gwy", "x3p": "to_x3p", "nc": "to_netcdf"}[ending])(str(path))
    return path


def same(scan, tolerance, turned=False):
    """Whether a scan has the heights, or those upside down, and the size that were written."""
    heights = HEIGHTS[:, ::-1] if turned else HEIGHTS
    np.testing.assert_allclose(scan.heights, heights, atol=tolerance)
    np.testing.assert_allclose(scan.size, SIZE, rtol=1e-6)


# Texts

SEPARATORS = {"comma": (",", "."), "comma and blank": (", ", "."), "semicolon": (";", "."), "tabulator": ("\t", ".")}
SEPARATORS |= {"German spreadsheet": (";", ","), "decimal commas": (" ", ","), "tabulator, decimal commas": ("\t", ",")}
ENCODINGS = ["utf-8", "latin-1", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"]
HEADS = {"none": "", "comment": "# Überhöhung: 1 µm\n", "words": "Rauheit µm\n"}


def table(separator, decimal, end="\n", quote=""):
    rows = [separator.join(f"{quote}{z:.6f}{quote}" for z in line) for line in HEIGHTS.T / 1e-9]
    return end.join(rows).replace(".", decimal) if decimal != "." else end.join(rows)


@pytest.mark.parametrize("ending", ["csv", "txt", "dat"])
@pytest.mark.parametrize(("separator", "decimal"), SEPARATORS.values(), ids=SEPARATORS)
def test_separators_and_decimal_signs_of_a_table_are_found(tmp_path, separator, decimal, ending):
    path = tmp_path / f"scan.{ending}"
    path.write_text(table(separator, decimal))
    same(read(path, GIVEN).scan, 1e-15)


@pytest.mark.parametrize("head", HEADS)
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_encodings_of_a_table_are_found(tmp_path, encoding, head):
    path = tmp_path / "scan.csv"
    path.write_bytes((HEADS[head] + table(";", ",", "\r\n")).encode(encoding))
    same(read(path, GIVEN).scan, 1e-15)


def test_numbers_in_quotes_and_lines_that_end_with_a_separator_are_those_of_a_table(tmp_path):
    path = tmp_path / "scan.csv"
    path.write_text(table(";\n", ",", quote='"').replace(";\n", ";").replace("\n", ";\n") + ";\n")
    same(read(path, GIVEN).scan, 1e-15)


def test_units_in_a_head_with_decimal_commas_are_read(tmp_path):
    path = tmp_path / "scan.txt"
    head = "# Kanal: Höhe\n# Breite: 6,4 µm\n# Höhe: 4,0 µm\n# Einheiten: nm\n"
    path.write_bytes((head + table("\t", ",")).encode("latin-1"))
    same(read(path).scan, 1e-15)


@pytest.mark.parametrize("hole", ["", "nan"])
def test_empty_places_of_a_table_are_undefined(tmp_path, hole):
    rows = table(";", ",").split("\n")
    values = rows[7].split(";")
    values[3:5] = [hole, hole]
    (tmp_path / "scan.csv").write_text("\n".join([*rows[:7], ";".join(values), *rows[8:]]))
    scan = read(tmp_path / "scan.csv", GIVEN).scan
    assert np.argwhere(~scan.defined).tolist() == [[3, 7], [4, 7]]


def test_a_word_in_a_table_is_told(tmp_path):
    rows = table(";", ",").split("\n")
    rows[7] = rows[7].replace(rows[7].split(";")[3], "kein Wert")
    (tmp_path / "scan.csv").write_text("\n".join(rows))
    with pytest.raises(ScanError, match="has 'kein_Wert' in line 8, must be a number, or nan where no height"):
        read(tmp_path / "scan.csv", GIVEN)


def test_points_of_a_spreadsheet_are_points(tmp_path):
    x, y = np.indices(HEIGHTS.shape)
    rows = zip((0.1 * x).ravel(), (0.1 * y).ravel(), (HEIGHTS / 1e-6).ravel(), strict=True)
    lines = "\n".join(";".join(f"{value:.9f}" for value in row) for row in rows).replace(".", ",")
    (tmp_path / "scan.csv").write_text(lines)
    same(read(tmp_path / "scan.csv", Source(size=SIZE, height_unit="um")).scan, 1e-14)


@pytest.mark.parametrize("plain", ["1.5 2 3\n4 5 6\n", "a, b, c\nd, e, f\n", "1\n2\n3\n", "1,2\n3,4\n", ""])
def test_texts_that_the_library_reads_and_those_that_are_no_tables_stay(plain):
    assert plain_text(plain) == plain


@pytest.mark.parametrize("content", [bytes(100), b"\x89PNG\r\n\x1a\n" + bytes(range(256)), codecs.BOM_UTF16_LE + b"1"])
def test_other_files_are_no_texts(content):
    assert encoding.decoded(content) is None


# Packed files


@pytest.mark.parametrize("ending", ["gwy", "x3p", "nc"])
def test_a_file_is_read_as_it_is_packed_in_another(tmp_path, ending):
    content = written(tmp_path, ending).read_bytes()
    packings = {f"scan.{ending}.gz": gzip.compress(content), f"scan.{ending}.zip": zipped({f"scan.{ending}": content})}
    packings["mac.zip"] = zipped({f"scan.{ending}": content, f"__MACOSX/._scan.{ending}": b"\0\5\26\7"})
    for name, packing in packings.items():
        (tmp_path / name).write_bytes(packing)
        found = read(tmp_path / name)
        same(found.scan, 1e-15)
        assert found.scan.name == name


def test_a_packed_table_is_a_table(tmp_path):
    (tmp_path / "scan.csv.gz").write_bytes(gzip.compress(table(";", ",").encode("utf-16")))
    same(read(tmp_path / "scan.csv.gz", GIVEN).scan, 1e-15)


def zipped(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()


INDICES = {"as written": (b"", b""), "dash": (b"ISO5436 - 2000", "ISO5436 – 2000".encode())}
INDICES["empty offset"] = (b"</Increment></CZ>", b"</Increment><Offset/></CZ>")


@pytest.mark.parametrize(("stored", "found"), INDICES.values(), ids=INDICES)
def test_x3p_as_a_folder_is_zipped_by_macos(tmp_path, stored, found):
    with zipfile.ZipFile(written(tmp_path, "x3p")) as archive:
        members = {f"scan/{name}": archive.read(name).replace(stored, found) for name in archive.namelist()}
    members |= {"scan/": b"", "scan/.DS_Store": b"x", "__MACOSX/scan/._main.xml": b"x", "__MACOSX/._scan": b"x"}
    (tmp_path / "mac.x3p").write_bytes(zipped(members))
    same(read(tmp_path / "mac.x3p").scan, 1e-15)


def surf(values, magic, data):
    """File of Digital Surf: heights are integers of 1 pm, sides in µm; undefined ones are 2 below the lowest."""
    units = [name.encode() for name in ("X", "Y", "Z", "µm", "µm", "nm", "µm", "µm", "nm")]
    units = [unit.decode().encode("latin-1") for unit in units]
    layout = "<12s4H30s30s5HIIH4iI3f" + 9 * "16s" + "3f3H3I7Hf2I3H128s3f34s"
    head = [magic, 0, 1, 1, 2, b"", b"", 1, 0, 0, 1, 0, 0, 0, 32, LOWEST, int(values.max())]
    head += [*values.shape, values.size, 0.1, 0.1, 1e-3, *units, 1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0]
    head += [0, 0, 0, 1, 1, 2020, 0, 0.0, 0, 0, 0, 5, 3, b"", 0.0, 0.0, 0.0, b""]
    return struct.pack(layout, *head) + b"notes" + b"own" + data


#: Lowest height of the file.
LOWEST = int(np.round(HEIGHTS.min() / 1e-12))


def surf_streams(data, count):
    """Data in streams: their number, two sizes of each, and the streams."""
    parts = [data[k * len(data) // count : (k + 1) * len(data) // count] for k in range(count)]
    streams = list(map(zlib.compress, parts))
    sizes = [size for part, packing in zip(parts, streams, strict=True) for size in (len(part), len(packing))]
    return struct.pack(f"<{1 + 2 * count}I", count, *sizes) + b"".join(streams)


@pytest.mark.parametrize("streams", [0, 1, 3])
def test_digital_surf_with_and_without_compression(tmp_path, streams):
    values = np.round(HEIGHTS / 1e-12).astype("<i4")
    values[5, 7] = LOWEST - 2
    data = values.T.tobytes()
    packing = surf(values, b"DSCOMPRESSED", surf_streams(data, streams)) if streams else None
    (tmp_path / "scan.sur").write_bytes(packing or surf(values, b"DIGITAL SURF", data))
    scan = read(tmp_path / "scan.sur").scan
    np.testing.assert_allclose(scan.size, SIZE, rtol=1e-6)
    assert np.argwhere(~scan.defined).tolist() == [[5, 7]]
    np.testing.assert_allclose(scan.heights[scan.defined], HEIGHTS[scan.defined], atol=0.6e-12)


# Microscopes


def sxm(direction="down", lines=40, kind="FLOAT            MSBFIRST", names=("Z",)):
    """Scan of Nanonis: forward and backward images of heights and of a current, whose later lines are missing."""
    tags = {"NANONIS_VERSION": "2", "SCANIT_TYPE": f"              {kind}", "SCAN_PIXELS": "       64       40"}
    tags |= {"SCAN_RANGE": "           6.400000E-6           4.000000E-6", "SCAN_DIR": direction, "COMMENT": ""}
    rows = [f"\t{k}\t{name}\tm\tboth\t1.0\t0.0" for k, name in enumerate(names)] + [
        "\t9\tCurrent\tA\tforward\t1.0\t0.0"
    ]
    tags["DATA_INFO"] = "\tChannel\tName\tUnit\tDirection\tCalibration\tOffset\n" + "\n".join(rows) + "\n"
    z = HEIGHTS.copy()
    z[:, : 40 - lines] = np.nan
    image = (z if direction == "up" else z[:, ::-1]).T
    text = "".join(f":{tag}:\n{value}\n" for tag, value in tags.items()) + ":SCANIT_END:\n\n\n"
    images = [image, (image + 1e-9)[:, ::-1]] * len(names) + [image]  # every point in the order of the scan
    return text.encode("latin-1") + b"\x1a\x04" + b"".join(one.astype(">f4").tobytes() for one in images)


@pytest.mark.parametrize("direction", ["up", "down"])
def test_nanonis(tmp_path, direction):
    (tmp_path / "scan.sxm").write_bytes(sxm(direction))
    found = read(tmp_path / "scan.sxm")
    same(found.scan, 1e-14)
    assert found.notes == ("scan.sxm: channel Z (forward) was read; the file also has Z (backward)",)
    again = read(tmp_path / "scan.sxm", Source(channel="Z (backward)")).scan
    np.testing.assert_allclose(again.heights, HEIGHTS + 1e-9, atol=1e-14)


def test_lines_that_nanonis_did_not_scan_are_undefined(tmp_path):
    (tmp_path / "scan.sxm").write_bytes(sxm("down", lines=38))
    assert read(tmp_path / "scan.sxm").scan.undefined_share == pytest.approx(2 / 40)


def asd(version, levels=4096, code=0x00040000, second=b"ER", frames=3):
    """Movie of frames of the same heights, each 1 nm higher, behind those of another channel or before them."""
    points, sides = HEIGHTS.shape, (6400, 4000)
    piezo, range_, texts = (20.0, 2.0), 5.0, (b"me", b"a comment")
    header = {0: [b"TP", second], 1: [second + b"\0\0", b"TP\0\0"]}[min(version, 1)]
    if version == 0:
        values = [0, *header, 0, 32, 2, 4, 9, *points, *sides, 1.0, *piezo, code, 12, False, 1, 0, 2020]
        values += [1, 1, 1, 1, 1, 0, 1.0, 1.0, 0, 0, 0, frames, frames, 1, 1]
        head = (
            struct.pack(high_speed._VERSION_0, *values) + texts[0] + struct.pack("<2fi", 1, 1, 0) + bytes(4) + texts[1]
        )
    else:
        values = [version, 0, 32, 1, 2, 9, *header, frames, frames, 1, 1, *points, *sides, False, 1]
        values += [2020, 1, 1, 1, 1, 1, 0, 0, 1.0, 1.0, 1.0, 0, bytes(12), 1, code, 12, 1.0, 1.0, 1.0, 1.0, *piezo]
        head = struct.pack(high_speed._VERSION_1, *values) + b"".join(texts)
    if version == 2:
        head += struct.pack("<iid2i3i", frames, 0, 1.0, 0, 0, 1, 0, 2) + bytes(8 * 3)
    first, last = (range_, -range_) if code == 0x00040000 else (0.0, -range_)
    heights = [HEIGHTS + k * 1e-9 + (0 if first else -50e-9) for k in range(frames)]
    steps = [np.round((z.T / 1e-9 / np.prod(piezo) - first) / (last - first) * levels).astype("<i2") for z in heights]
    movie = [b"".join(bytes(32) + (frame + shift).tobytes() for frame in steps) for shift in (0, 7)]
    return head + b"".join(movie if version == 0 else movie[::-1])


STEP = 1e-9 * 40 * 10 / 4096  #: of the levels of these heights


@pytest.mark.parametrize("version", [0, 1, 2])
def test_movies_of_high_speed_microscopes(tmp_path, version):
    (tmp_path / "scan.asd").write_bytes(asd(version))
    found = read(tmp_path / "scan.asd")
    same(found.scan, STEP)
    (note,) = found.notes
    assert note == "scan.asd: channel Topography#1 was read; the file also has Topography#2, Topography#3"
    third = read(tmp_path / "scan.asd", Source(channel="Topography#3")).scan
    np.testing.assert_allclose(third.heights, HEIGHTS + 2e-9, atol=STEP)


def test_the_sign_of_levels_that_readers_disagree_about_is_told(tmp_path):
    (tmp_path / "scan.asd").write_bytes(asd(1, code=4, frames=1))
    found = read(tmp_path / "scan.asd")
    np.testing.assert_allclose(found.scan.heights, HEIGHTS - 50e-9, atol=STEP)
    assert found.notes == (f"scan.asd: {high_speed._UNSURE}",)


def jpk(path, channels):
    """Scan of JPK: name of a channel to (unit, heights of its frames), forward and backward."""
    with h5py.File(path, "w") as file:
        scan = file.create_group("Measurement_000")
        sides = {"ilength": 64, "jlength": 40, "ulength": SIZE[0], "vlength": SIZE[1]}
        scan.attrs.update({f"position-pattern.grid.{side}": value for side, value in sides.items()})
        for k, ((name, retrace), (unit, frames)) in enumerate(channels.items()):
            group = scan.create_group(f"Channel_{k:03d}")
            scaling = {"multiplier": 1e-15, "offset": 2e-7, "unit.unit": np.bytes_(unit)}
            group.attrs.update({f"net-encoder.scaling.{part}": value for part, value in scaling.items()})
            group.attrs.update({"channel.name": np.bytes_(name), "retrace": np.bytes_(retrace)})
            levels = [np.round((z.T.ravel() - 2e-7) / 1e-15).astype(int) for z in frames]
            group.create_dataset("thumbnail", data=np.zeros((4, 1)))
            group.create_dataset(name.capitalize(), data=np.column_stack(levels))
    return path


def test_scans_of_jpk_in_hdf5(tmp_path):
    kinds = {("height", "false"): ("m", [HEIGHTS, HEIGHTS + 1e-9]), ("height", "true"): ("m", [HEIGHTS, HEIGHTS])}
    found = read(jpk(tmp_path / "scan.h5-jpk", kinds | {("error", "false"): ("V", [HEIGHTS, HEIGHTS])}))
    same(found.scan, 1e-15)
    assert found.channel == "height (trace)#1"
    second = read(tmp_path / "scan.h5-jpk", Source(channel="height (trace)#2")).scan
    np.testing.assert_allclose(second.heights, HEIGHTS + 1e-9, atol=1e-15)
    both = jpk(tmp_path / "both.h5-jpk", kinds | {("measuredHeight", "false"): ("m", [HEIGHTS, HEIGHTS])})
    with pytest.raises(ScanError, match="name one of: height [(]trace[)]#1, height [(]retrace[)]#1, measuredHeight"):
        read(both)


def test_other_files_of_hdf5_are_read_by_the_library(tmp_path):
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file["heights"] = HEIGHTS / 1e-9
    assert read(tmp_path / "scan.h5", GIVEN).scan.heights.shape == (64, 40)


# Damage

DAMAGED = {
    "half.csv.gz": gzip.compress(table(";", ",").encode())[:900],
    "half.sur": surf(np.ones((64, 40), "<i4"), b"DSCOMPRESSED", surf_streams(bytes(4 * 64 * 40), 2))[:-20],
    "half.sxm": sxm()[:5000],
    "numbers.sxm": sxm(kind="INT16 MSBFIRST"),
    "nothing.sxm": b":NANONIS_VERSION:\n2\n",
    "half.asd": asd(1)[:5000],
    "version.asd": b"\7\0\0\0" + bytes(200),
    "short.asd": b"\1\0\0\0",
    "no_heights.asd": asd(0).replace(b"TP", b"PH", 1),
    "range.asd": asd(1, code=0x80),
    "half.zip": zipped({"scan.gwy": bytes(1000), "other": b""})[:300],
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damage_is_told_in_one_sentence_with_a_way_out(tmp_path, name):
    (tmp_path / name).write_bytes(DAMAGED[name])
    with pytest.raises(
        ScanError, match=f"^files: {name} cannot be read as any known format, or is damaged.*"
    ) as caught:
        read(tmp_path / name, GIVEN)
    assert str(caught.value).endswith("; open it in Gwyddion and save it as .gwy")
    assert "\n" not in str(caught.value)


def test_files_that_are_not_packed_stay_as_they_are(tmp_path):
    for ending in ("gwy", "x3p", "nc"):
        content = written(tmp_path, ending).read_bytes()
        assert packed.unpacked(f"scan.{ending}", content) == (f"scan.{ending}", content)


@pytest.mark.parametrize(("ending", "others"), [("gwy", ["di", "ibw"]), ("x3p", ["nmm"])])
def test_the_reader_of_the_ending_comes_first(tmp_path, monkeypatch, ending, others):
    """A reader before it that takes any file must not get this one."""
    from SurfaceTopography import IO

    greedy = next(kind for kind in IO.readers if kind.format() in others)
    monkeypatch.setattr(greedy, "can_read", classmethod(lambda *_: IO.MagicMatch.MAYBE))
    monkeypatch.setattr(greedy, "__init__", lambda *_, **__: None)
    monkeypatch.setattr(IO, "readers", [greedy, *IO.readers])
    same(read(written(tmp_path, ending)).scan, 1e-15)


@pytest.mark.parametrize("stored", [b"", b":NANONIS", b"\x89HDF", b"GWYP", b"1 2 3"])
def test_a_file_without_the_first_bytes_of_a_format_has_no_reader_of_our_own(stored):
    assert own_reader(content_of("a.dat", "a.dat", stored)) is None

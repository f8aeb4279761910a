"""Tables as people and programs write them: a drawn map is read as it was written, or refused in one sentence.

The writer here is the second route: it knows the numbers that it wrote. No dialect may be read with another rms.
"""

import codecs
from dataclasses import dataclass, replace

import numpy as np
import pytest

from stiction.errors import ScanError
from stiction.formats.texts import table
from stiction.scans import reading
from stiction.scans.reading import Source, read
from stiction.streams import stream

pytest.importorskip("SurfaceTopography")
#: Points of 1 µm, so that large heights are no impossible slopes.
SHAPE = (34, 37)
GIVEN = Source(size=(34e-6, 37e-6), height_unit="nm")

SEPARATORS = (" ", "   ", "\t", ";", "; ", ",", ", ")
#: Decimal sign and separator of thousands.
STYLES = ((".", ""), (",", ""), (".", ","), (",", "."), (".", "'"), (".", "\u2019"), (",", "\xa0"), (",", "\u202f"))
FORMATS = ("{:,.3f}", "{:,.6f}", "{:,.0f}", "{:,.2f}")
#: Rms and mean of the heights [nm].
SCALES = ((3, 0), (309, 0), (309, 1500), (3, 478), (2000, -30000), (0.4, 2))
AXES = ("none", "counts", "counts from 1", "coordinates", "header", "index", "word", "short header", "two indices")
MARKS = ("none", "nan", "NaN", "", "-9999", "-32768", "1e38", "3.4028235e+38", "head -1", "head -9999")
HEADS = ("", "# Überhöhung in nm\n", "Profil 7 vom Mai\n", "\n\n")
ENCODINGS = ("utf-8", "utf-8", "latin-1", "utf-16", "utf-16-le", "utf-16-be")
ENDS = ("\n", "\r\n", "\r")


@dataclass(frozen=True)
class Dialect:
    separator: str
    style: tuple
    form: str
    scale: tuple
    axes: str
    mark: str
    head: str
    encoding: str
    marks: int  #: of the order of bytes at the beginning
    end: str
    quoted: bool
    ended: bool  #: whether a separator ends the lines
    minus: str


def drawn(rng):
    """Dialect in which some program could write."""

    def one_of(values):
        return values[rng.integers(len(values))]

    separator, style = one_of(SEPARATORS), one_of(STYLES)
    if style == (",", ".") and separator.strip(" ") in ("", ","):
        separator = "\t"  # no program separates by blanks and writes 1.234 for 1234
    doubled = separator.strip() == "," and "," in style
    quoted = bool(rng.integers(3) == 0) or (doubled and style != (",", ""))
    encoding = one_of(ENCODINGS)
    minus = "\u2212" if encoding != "latin-1" and rng.integers(6) == 0 else "-"
    if encoding == "latin-1" and set(style) & {"\u2019", "\u202f"}:
        style = (",", "")
    marks = int(rng.integers(3)) if encoding == "utf-8" else 0
    form = one_of(FORMATS)
    scale = one_of(SCALES[: None if "0f" not in form else -1])  # whole numbers of 0.4 nm give equal lines
    parts = [form, scale, one_of(AXES), one_of(MARKS), one_of(HEADS), encoding, marks]
    return Dialect(
        separator, style, *parts, one_of(ENDS), quoted, bool(rng.integers(4) == 0) and not separator.isspace(), minus
    )


def written(values, dialect):
    """Values in a dialect, and the values that they are."""
    signs = str.maketrans({".": dialect.style[0], ",": dialect.style[1], "-": dialect.minus})
    texts = [[dialect.form.format(value).translate(signs) for value in row] for row in values]
    kept = np.array([[float(dialect.form.format(value).replace(",", "")) for value in row] for row in values])
    return texts, kept


def with_axes(texts, dialect):
    """Lines with an axis before them."""
    kind, rows, columns = dialect.axes, len(texts), len(texts[0])
    start, step = {"coordinates": (0, 0.25), "counts from 1": (1, 1)}.get(kind, (0, 1))

    def count(number):
        return [f"{start + step * k:g}".replace(".", dialect.style[0]) for k in range(number)]

    if kind == "none":
        return texts
    if kind == "header":
        return [count(columns), *texts]
    if kind == "two indices":
        return [[k, k, *row] for k, row in zip(count(rows), texts, strict=True)]
    indexed = [[k, *row] for k, row in zip(count(rows), texts, strict=True)]
    corner = {"index": None, "word": ["y/x"], "short header": []}.get(kind, [""])
    return indexed if corner is None else [[*corner, *count(columns)], *indexed]


def file_of(rng, dialect):
    """Content of a file, and the heights that it has [nm], x first."""
    values = dialect.scale[1] + dialect.scale[0] * rng.standard_normal(SHAPE[::-1])
    texts, kept = written(values, dialect)
    head = dialect.head
    if dialect.mark != "none":
        mark = dialect.mark.removeprefix("head ")
        if dialect.mark != mark:  # what the head calls no data is none, wherever it stands
            head, kept = f"{head}NODATA_value {mark}\n", np.where(kept == float(mark), np.nan, kept)
        for place in rng.choice(kept.size, 5, replace=False):
            row, column = np.unravel_index(place, kept.shape)
            texts[row][column], kept[row, column] = mark.replace(".", dialect.style[0]), np.nan
    quote = '"' if dialect.quoted else ""
    rows = with_axes(texts, dialect)
    lines = [dialect.separator.join(f"{quote}{value}{quote}" for value in row) for row in rows]
    lines = [line + dialect.separator.strip() * dialect.ended for line in lines]
    text = dialect.end.join([*head.split("\n")[:-1], *lines, ""])
    return codecs.BOM_UTF8 * dialect.marks + text.encode(dialect.encoding), kept.T


def read_as_written(path, rng, **fixed):
    """Whether a drawn file is read, and not refused. It must have the heights that were written."""
    dialect = replace(drawn(rng), **fixed)
    stored, heights = file_of(rng, dialect)
    path.write_bytes(stored)
    try:
        scan = read(path, GIVEN).scan
    except ScanError as error:
        refusal = str(error)
    else:
        refusal = ""
    if refusal:
        assert "\n" not in refusal
        return False
    assert scan.heights.shape == heights.shape, dialect
    np.testing.assert_array_equal(scan.defined, np.isfinite(heights), str(dialect))
    np.testing.assert_allclose(np.nanstd(scan.heights), np.nanstd(heights) * 1e-9, rtol=1e-6, err_msg=str(dialect))
    np.testing.assert_allclose(scan.heights, heights * 1e-9, rtol=1e-9, atol=1e-15, err_msg=str(dialect))
    return True


def test_a_map_in_any_dialect_is_read_as_it_was_written_or_refused(tmp_path):
    rng = stream(1, "dialects")
    assert sum(read_as_written(tmp_path / "scan.txt", rng) for _ in range(60)) > 36


#: Part of the reading without which some dialect is read with other heights, what it then does, and the dialect.
PLAIN = {"separator": ";", "style": (".", ""), "form": "{:,.3f}", "scale": (3, 0), "axes": "none", "mark": "none"}
PARTS = {
    "axes": (reading, "without_axes", lambda heights: (heights, ""), {"axes": "index"}),
    "doubts": (reading, "require_no_mark", lambda heights: None, {"mark": "-777"}),
    "thousands": (
        table,
        "style_of",
        lambda *_, **__: (".", ""),
        {"style": (",", "."), "form": "{:,.0f}", "scale": (309, 1500)},
    ),
}


@pytest.mark.parametrize(("module", "name", "idle", "fields"), PARTS.values(), ids=PARTS)
def test_without_a_part_of_the_reading_a_map_is_read_with_other_heights(
    tmp_path, monkeypatch, module, name, idle, fields
):
    fixed = PLAIN | fields
    assert read_as_written(tmp_path / "scan.txt", stream(2, "dialects"), **fixed) == (name != "require_no_mark")
    monkeypatch.setattr(module, name, idle)
    with pytest.raises(AssertionError):
        read_as_written(tmp_path / "scan.txt", stream(2, "dialects"), **fixed)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_maps_in_many_dialects_are_read_as_they_were_written_or_refused(tmp_path, number):
    rng = stream(1, "dialects", number)
    ending = ("txt", "csv", "dat", "asc")[number]
    assert sum(read_as_written(tmp_path / f"scan.{ending}", rng) for _ in range(400)) > 240


@pytest.mark.parametrize("value", ["1 2", "12 34", "1 2345", "kein Wert", "1,2.3", "1.2,3", "0x1", "--1", "1-"])
def test_a_value_that_is_no_number_is_never_read_as_one(tmp_path, value):
    heights = [
        [f"{height:.4f}".replace(".", ",") for height in row] for row in stream(1, "odd").standard_normal((40, 36))
    ]
    heights[7][5] = value
    (tmp_path / "scan.csv").write_text("\n".join(map(";".join, heights)))
    with pytest.raises(ScanError, match=r"has '.*' in line 8, must be a number"):
        read(tmp_path / "scan.csv", GIVEN)


@pytest.mark.parametrize("indexed", [False, True])
@pytest.mark.parametrize(("separator", "decimal"), [(",", "."), (";", ","), ("\t", "."), (" ", ".")])
def test_points_are_read_with_and_without_numbers_of_the_points_and_where_some_have_no_height(
    tmp_path, separator, decimal, indexed
):
    heights = stream(1, "points").standard_normal((40, 36))
    heights[0, 0] = heights[7, 5] = np.nan
    empty = "nan" if separator == " " else ""
    rows = [[f"{0.1 * i:.1f}", f"{0.1 * j:.1f}", f"{z:.6f}"] for (i, j), z in np.ndenumerate(heights)]
    rows = [[*row[:2], row[2].replace("nan", empty)] for row in rows]
    rows = [[str(k), *row] for k, row in enumerate(rows)] if indexed else rows
    head = separator.join([""] * indexed + ["x", "y", "z"])
    lines = [head, *(separator.join(row).replace(".", decimal) for row in rows)]
    (tmp_path / "scan.csv").write_text("\n".join(lines) + "\n")
    scan = read(tmp_path / "scan.csv", Source(size=(4e-6, 3.6e-6), height_unit="nm")).scan
    np.testing.assert_allclose(scan.heights, heights * 1e-9, atol=1e-15)

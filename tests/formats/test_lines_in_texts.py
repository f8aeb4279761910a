"""Lines in texts with two columns, as programs and people write them: read as written, or refused in one sentence."""

from itertools import product

import numpy as np
import pytest

from stiction.errors import ScanError
from stiction.formats.texts.profile import profile
from stiction.streams import stream

PLACES = 0.02 * np.arange(150)
HEIGHTS = stream(1, "profile").normal(0, 4, len(PLACES)).round(3)
GIVEN = {"x_unit": "um", "height_unit": "nm"}


def written(separator="\t", decimal=".", head="", columns=None):
    """Text of columns, by default places and heights."""
    rows = zip(*(columns if columns is not None else (PLACES, HEIGHTS)), strict=True)
    text = "\n".join(separator.join(f"{value:.4f}" for value in row) for row in rows)
    return f"{head}{text.replace('.', decimal)}\n"


def changed(number, word):
    """Text with a word in place of one height."""
    lines = written().split("\n")
    lines[number] = f"{lines[number].split(chr(9))[0]}\t{word}"
    return "\n".join(lines)


def refusal(text, units=GIVEN):
    with pytest.raises(ScanError) as error:
        profile(text, "a.txt", units)
    assert "\n" not in str(error.value)
    return str(error.value)


def require_read(text, units=GIVEN):
    heights, step = profile(text, "a.txt", units)
    np.testing.assert_allclose(heights, 1e-9 * HEIGHTS, atol=1e-15)
    assert step == pytest.approx(20e-9, rel=1e-6)


@pytest.mark.parametrize(("separator", "decimal"), sorted({*product("\t;, ", ".,")} - {(",", ",")}))
def test_a_line_is_read_with_any_separator_and_decimal_sign(separator, decimal):
    require_read(written(separator, decimal))
    require_read(written(separator, decimal, "Profil 7\n"))


@pytest.mark.parametrize("head", ["x [µm]\tz [nm]\n", "# x/um z/nm\n", "x (μm);z (nm)\n", "Line 3\nx_um,z_nm\n"])
def test_units_are_those_of_the_head(head):
    require_read(written(head=head), {})
    assert refusal(written(head=head.replace("nm", "mm"))).startswith("height_unit: a.txt has mm in its head, not nm")


def test_a_column_that_counts_the_points_is_left_out():
    require_read(written(columns=(np.arange(len(PLACES)), PLACES, HEIGHTS)))


def test_a_line_from_right_to_left_is_a_line():
    require_read(written(columns=(PLACES[::-1], HEIGHTS)))


@pytest.mark.parametrize("mark", ["nan", "-9999"])
def test_single_points_without_a_height_are_filled_between_their_neighbours(mark):
    heights, _ = profile(changed(7, mark), "a.txt", GIVEN)
    assert heights[7] == pytest.approx(1e-9 * (HEIGHTS[6] + HEIGHTS[8]) / 2)
    np.testing.assert_allclose(np.delete(heights, 7), 1e-9 * np.delete(HEIGHTS, 7), atol=1e-15)


def test_bad_lines_are_refused_in_one_sentence():
    away = np.where(np.arange(len(PLACES)) == 9, 0.7, PLACES)
    mapped = written(columns=(PLACES, HEIGHTS, HEIGHTS))
    holes = written(columns=(PLACES, np.where(PLACES < 0.1, -9999, HEIGHTS)))
    refused = {
        written(columns=(HEIGHTS,)): "has one column; a profile has two",
        mapped: "has 3 columns; a profile has two, places and heights, and maps are listed under scans",
        "nothing\n": "has no numbers in columns",
        changed(7, "***"): "has '***' in line 8, must be a number",
        written(columns=(HEIGHTS, PLACES)): "has places that do not rise all along (point 3): sort them, or swap",
        written(columns=(away, HEIGHTS)): "has places that do not rise all along (point 11)",
        written(columns=(PLACES**1.2, HEIGHTS)): "has unevenly spaced places",
        holes: "has 3.33 % of its points undefined",
    }
    for text, reason in refused.items():
        assert refusal(text).startswith(f"files: a.txt {reason}")
    assert refusal(written(), {}).startswith("x_unit: a.txt has no units in its head; give x_unit, one of m, mm")
    assert refusal(written(), {"x_unit": "um"}).startswith("height_unit: a.txt has no units")

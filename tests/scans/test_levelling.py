import numpy as np
import pytest
from drawn_scans import published
from hypothesis import given
from hypothesis import strategies as st

from stiction.scans.levelling import LEVELS, LINES, Levelling, level, line_jump
from stiction.streams import stream

ROUGH = stream(1, "levelling").standard_normal((60, 40))
X, Y = (np.linspace(-1, 1, n) for n in ROUGH.shape)
#: Shapes and their total degree.
SHAPES = {
    "constant": (np.ones_like(ROUGH), 0),
    "tilt": (X[:, None] - 0.5 * Y, 1),
    "twist": (X[:, None] * Y, 2),
    "bowl": (X[:, None] ** 2 - Y**2, 2),
    "wave": (X[:, None] ** 2 * Y, 3),
}
DEGREES = {"mean": 0, "plane": 1, "quadratic": 2}
#: Degrees of lines.
LINE_DEGREES = {"offset": 0, "tilt": 1, "bow": 2}
LINE_SHAPES = {name: X[:, None] ** degree for name, degree in LINE_DEGREES.items()}


@pytest.fixture
def undefined():
    z = ROUGH.copy()
    z[5:9, 3], z[:, 7] = np.nan, np.nan
    return z


@pytest.mark.parametrize("name", DEGREES)
def test_the_shape_that_is_levelled_has_no_effect_and_higher_ones_have(name):
    flat = level(ROUGH, Levelling(name))
    for shape, (form, degree) in SHAPES.items():
        change = np.abs(level(ROUGH + 100 * form, Levelling(name)) - flat).max()
        assert (change < 1e-10) == (degree <= DEGREES[name]), shape


@pytest.mark.parametrize("name", LINE_SHAPES)
def test_an_error_of_each_line_is_removed_up_to_its_degree(name):
    weight = stream(1, "lines").standard_normal(40)
    flat = level(ROUGH, Levelling("plane", name))
    for shape, form in LINE_SHAPES.items():
        change = np.abs(level(ROUGH + 100 * weight * form, Levelling("plane", name)) - flat).max()
        assert (change < 1e-10) == (LINE_DEGREES[shape] <= LINE_DEGREES[name]), shape


def test_lines_run_along_the_first_index():
    offsets = stream(1, "lines").standard_normal(60)[:, None]
    assert (
        np.abs(level(ROUGH + offsets, Levelling("mean", "offset")) - level(ROUGH, Levelling("mean", "offset"))).max()
        > 1
    )


@pytest.mark.parametrize("name", LEVELS)
@pytest.mark.parametrize("lines", LINES)
def test_undefined_points_stay_undefined_and_do_not_pull(name, lines, undefined):
    form = 100 * SHAPES["constant" if name == "mean" else "tilt"][0]
    flat, tilted = (level(undefined + shift, Levelling(name, lines)) for shift in (0 * form, form))
    np.testing.assert_array_equal(np.isnan(flat), np.isnan(undefined))
    np.testing.assert_allclose(tilted, flat, atol=1e-10)
    assert abs(np.nanmean(flat)) < 1e-14


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_levelling_leaves_nothing_to_level(tilt, bow):
    once = level(ROUGH + tilt * SHAPES["tilt"][0] + bow * SHAPES["bowl"][0], Levelling("quadratic", "bow"))
    np.testing.assert_allclose(level(once, Levelling("quadratic", "bow")), once, atol=1e-12)


def test_residuals_of_a_plane_are_orthogonal_to_it():
    levelled = level(ROUGH, Levelling("plane"))
    for form in (np.ones_like(ROUGH), X[:, None], Y):
        assert abs(np.mean(levelled * form)) < 1e-14


SQUARE = (1.0, 1.0)


def test_jumps_of_lines_stand_out_of_the_steps_along_them():
    slow, fast = line_jump(ROUGH, SQUARE)
    assert 0.5 < slow / fast < 2
    jumps = 5 * stream(1, "lines").standard_normal(40)
    slow, fast = line_jump(ROUGH + jumps, SQUARE)
    np.testing.assert_allclose(slow, np.sqrt(np.mean(np.diff(jumps) ** 2)), rtol=0.1)
    assert slow > 10 * fast


@pytest.mark.parametrize("every", [(1, 3), (3, 1), (2, 5)])
def test_steps_are_compared_at_equal_distance(every):
    (scan,) = published("B2", 5e-6, 1)
    pixel = tuple(20e-9 * n for n in every)
    slow, fast = line_jump(scan.heights[:: every[0], :: every[1]], pixel)
    assert 0.7 < slow / fast < 1.4
    assert not 0.7 < np.divide(*line_jump(scan.heights[:: every[0], :: every[1]], SQUARE)) < 1.4


def test_lines_without_any_height_do_not_count_as_jumps():
    holed = ROUGH.copy()
    holed[:, 7], holed[11] = np.nan, np.nan
    np.testing.assert_allclose(line_jump(holed, SQUARE), line_jump(ROUGH, SQUARE), rtol=0.2)


@pytest.mark.parametrize("name", LINE_DEGREES)
def test_residuals_of_every_line_are_orthogonal_to_its_polynomial_at_the_defined_points(name, undefined):
    levelled = np.nan_to_num(level(5.0 + undefined, Levelling("mean", name)))
    for degree in range(LINE_DEGREES[name] + 1):
        np.testing.assert_allclose(X**degree @ levelled, 0, atol=1e-11)

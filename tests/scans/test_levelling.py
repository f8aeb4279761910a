import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.scans.levelling import LEVELS, LINES, Levelling, level, line_jump
from stiction.streams import stream

ROUGH = stream(1, "levelling").standard_normal((60, 40))
X, Y = (np.linspace(-1, 1, n) for n in ROUGH.shape)
SHAPES = {
    "mean": np.ones_like(ROUGH),
    "plane": X[:, None] * np.ones(40) - 0.5 * Y,
    "quadratic": X[:, None] ** 2 + 0.3 * X[:, None] * Y - Y**2,
}
LINE_SHAPES = {name: X[:, None] ** degree for name, degree in LINES.items() if degree is not None}


@pytest.fixture
def undefined():
    z = ROUGH.copy()
    z[5:9, 3], z[:, 7] = np.nan, np.nan
    return z


@pytest.mark.parametrize("name", LEVELS)
def test_the_shape_that_is_levelled_has_no_effect_and_higher_ones_have(name):
    flat = level(ROUGH, Levelling(name))
    for shape, form in SHAPES.items():
        change = np.abs(level(ROUGH + 100 * form, Levelling(name)) - flat).max()
        assert (change < 1e-10) == (LEVELS[shape] <= LEVELS[name]), shape


@pytest.mark.parametrize("name", LINE_SHAPES)
def test_an_error_of_each_line_is_removed_up_to_its_degree(name):
    weight = stream(1, "lines").standard_normal(40)
    flat = level(ROUGH, Levelling("plane", name))
    for shape, form in LINE_SHAPES.items():
        change = np.abs(level(ROUGH + 100 * weight * form, Levelling("plane", name)) - flat).max()
        assert (change < 1e-10) == (LINES[shape] <= LINES[name]), shape


def test_lines_run_along_the_first_index():
    offsets = stream(1, "lines").standard_normal(60)[:, None]
    assert (
        np.abs(level(ROUGH + offsets, Levelling("mean", "offset")) - level(ROUGH, Levelling("mean", "offset"))).max()
        > 1
    )


@pytest.mark.parametrize("name", LEVELS)
@pytest.mark.parametrize("lines", LINES)
def test_undefined_points_stay_undefined_and_do_not_pull(name, lines, undefined):
    form = 100 * SHAPES[name]
    flat, tilted = (level(undefined + shift, Levelling(name, lines)) for shift in (0 * form, form))
    np.testing.assert_array_equal(np.isnan(flat), np.isnan(undefined))
    np.testing.assert_allclose(tilted, flat, atol=1e-10)
    assert abs(np.nanmean(flat)) < 1e-14


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_levelling_leaves_nothing_to_level(tilt, bow):
    once = level(ROUGH + tilt * SHAPES["plane"] + bow * SHAPES["quadratic"], Levelling("quadratic", "bow"))
    np.testing.assert_allclose(level(once, Levelling("quadratic", "bow")), once, atol=1e-12)


def test_residuals_of_a_plane_are_orthogonal_to_it():
    levelled = level(ROUGH, Levelling("plane"))
    for form in (SHAPES["mean"], X[:, None], Y):
        assert abs(np.mean(levelled * form)) < 1e-14


def test_jumps_of_lines_stand_out_of_the_steps_along_them():
    slow, fast = line_jump(ROUGH)
    assert 0.5 < slow / fast < 2
    jumps = 5 * stream(1, "lines").standard_normal(40)
    slow, fast = line_jump(ROUGH + jumps)
    np.testing.assert_allclose(slow, np.sqrt(np.mean(np.diff(jumps) ** 2)), rtol=0.1)
    assert slow > 10 * fast

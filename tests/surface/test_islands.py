import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from published import SPACING, SURFACES
from scipy import ndimage

from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.islands import find_islands

EIGHT, FOUR = np.ones((3, 3)), ndimage.generate_binary_structure(2, 1)
STEP = 1e-10


def listed(islands):
    """Level, height of the top and number of points of all islands, in order."""
    return sorted(zip(islands.levels.tolist(), islands.tops.tolist(), islands.points.tolist(), strict=True))


def labelled(z, step, numbers, neighbours=EIGHT):
    """The same, one level at a time, by labels of the points above it."""
    found = []
    for level in range(*numbers):
        labels, count = ndimage.label(z >= level * step, neighbours)
        for n, (i, j) in enumerate(ndimage.maximum_position(z, labels, range(1, count + 1)), start=1):
            if 0 < i < z.shape[0] - 1 and 0 < j < z.shape[1] - 1:
                found.append((level, float(z[i, j]), int(np.sum(labels == n))))
    return sorted(found)


def caps(*tops, radius, spacing, points=81):
    """Flat far below, with paraboloids at places (x, y) of these heights, in lengths from the middle [m]."""
    x = (np.arange(points) - points // 2) * spacing
    each = [z - ((x[:, None] - a) ** 2 + (x - b) ** 2) / (2 * radius) for a, b, z in tops]
    return np.maximum(np.max(each, axis=0), 0).astype(np.float32)


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(st.integers(3, 12), st.integers(3, 12)), st.integers(0, 2**32), st.floats(0.6, 9), st.integers(-20, 60)
)
def test_islands_are_the_connected_parts_at_every_level(shape, seed, step, first):
    """Heights are a permutation, because only then is the highest point of an island unique."""
    z = np.random.default_rng(seed).permutation(np.prod(shape)).reshape(shape).astype(np.float32) + 0.314159
    numbers = (first, max(first, 0) + int(z.max() / step) + 3)
    assert listed(find_islands(z, SPACING, step, numbers)) == labelled(z, step, numbers)


def test_islands_of_a_rough_surface_are_those_of_labels():
    z = SURFACES["B1"].on(StripGrid(0.6e-6, 3e-6, SPACING, margin=1e-6)).draw(stream(1))
    numbers = (0, int(z.max() / (5 * STEP)) + 2)
    found = listed(find_islands(z, SPACING, 5 * STEP, numbers))
    assert len(found) > 200
    assert found == labelled(z, 5 * STEP, numbers)
    assert found != labelled(z, 5 * STEP, numbers, FOUR)  # neighbours across a corner count


@pytest.mark.parametrize("turned", [np.fliplr, np.flipud, np.transpose, lambda z: np.roll(z, (3, -5), (0, 1))])
def test_islands_do_not_depend_on_place_and_direction(turned):
    z = caps((-90e-9, 0, 3e-9), (60e-9, 20e-9, 4e-9), radius=4e-7, spacing=SPACING)
    numbers = (1, 45)
    found, again = (find_islands(one, SPACING, STEP, numbers) for one in (z, turned(z)))
    assert listed(again) == listed(found)
    np.testing.assert_allclose(np.sort(again.curvatures), np.sort(found.curvatures))


@pytest.mark.parametrize("spacing", [10e-9, 5e-9, 2.5e-9])
def test_island_of_a_paraboloid_has_its_area_top_and_curvature(spacing):
    """The number of lattice points in a circle of r spacings differs from π r² by less than the length of its rim."""
    radius, top = 4e-7, 4e-9
    z = caps((0, 0, top), radius=radius, spacing=spacing, points=round(800e-9 / spacing) + 1)
    found = find_islands(z, spacing, STEP, (1, 40))
    assert list(found.levels) == list(range(39, 0, -1))
    np.testing.assert_allclose(found.tops, top, rtol=1e-6)
    np.testing.assert_allclose(found.curvatures, 1 / radius, rtol=1e-6 * radius * top / spacing**2 + 1e-6)
    circle = 2 * np.pi * radius * (top - found.levels * STEP) / spacing**2
    rim = 2 * np.sqrt(np.pi * circle)
    assert np.all(np.abs(found.points - circle) < rim + 1)
    assert np.abs(np.mean(found.points / circle) - 1) < 0.03 * (spacing / 5e-9)


@pytest.mark.parametrize("place", [(0.0, 0.0), (3.3e-9, -1.2e-9)])
def test_a_paraboloid_is_fitted_exactly_on_any_grid_from_five_points_on(place):
    radius, top = 4e-7, 4e-9
    z = caps((*place, top), radius=radius, spacing=10e-9)
    found = find_islands(z, 10e-9, STEP, (1, 40), fitted=True)
    enough = found.points >= 5
    assert 0 < np.sum(~enough) < np.sum(enough)
    np.testing.assert_allclose(found.fits[enough], [[top, 1 / radius]] * enough.sum(), rtol=1e-5)
    assert np.all(np.isnan(found.fits[~enough]))
    assert find_islands(z, 10e-9, STEP, (1, 40)).fits.shape == (0, 2)


def test_fits_of_a_rough_surface_are_those_of_linear_least_squares():
    z = SURFACES["B1"].on(StripGrid(0.6e-6, 3e-6, SPACING, margin=1e-6)).draw(stream(1))
    numbers = (2, int(z.max() / (5 * STEP)) + 2)
    found = find_islands(z, SPACING, 5 * STEP, numbers, fitted=True)
    expected = {}
    for level in range(*numbers):
        labels, count = ndimage.label(z >= level * 5 * STEP, EIGHT)
        for n in range(1, count + 1):
            rows, columns = np.nonzero(labels == n)
            expected[level, float(z[rows, columns].max())] = by_least_squares(
                SPACING * rows, SPACING * columns, z[rows, columns]
            )
    fits = np.array([expected[each] for each in zip(found.levels.tolist(), found.tops.tolist(), strict=True)])
    assert 40 < np.isfinite(fits[:, 0]).sum() < 0.9 * len(fits)
    np.testing.assert_allclose(found.fits, fits, rtol=1e-4)


def by_least_squares(x, y, z):
    """Top and curvature of the paraboloid of revolution through these points, NaN if it is none."""
    x, y, z = x - x.mean(), y - y.mean(), z.astype(float)
    terms = np.stack([np.ones(len(x)), x / SPACING, y / SPACING, (x**2 + y**2) / SPACING**2], axis=1)
    (a, b, c, e), _, rank, _ = np.linalg.lstsq(terms, z / STEP, rcond=1e-6)
    if len(z) < 5 or rank < 4 or e >= 0:
        return np.nan, np.nan
    places = -SPACING * b / (2 * e), -SPACING * c / (2 * e)
    inside = all(k.min() <= place <= k.max() for k, place in zip((x, y), places, strict=True))
    return (STEP * (a - (b**2 + c**2) / (4 * e)), -2 * e * STEP / SPACING**2) if inside else (np.nan, np.nan)


def test_two_paraboloids_are_one_island_below_their_saddle_and_two_above_it():
    radius, half, high, low = 4e-7, 60e-9, 8.03e-9, 6.97e-9
    found = find_islands(
        caps((-half, 0, high), (half, 0, low), radius=radius, spacing=2e-9, points=201), 2e-9, STEP, (1, 85)
    )
    numbers = np.bincount(found.levels, minlength=85)
    # Where both paraboloids are equally high, between their tops; a grid point is up to half a spacing away.
    beyond = half + (high - low) * radius / (2 * half)
    saddle, allowed = high - beyond**2 / (2 * radius), beyond / radius * 1e-9
    levels = STEP * np.arange(85)
    assert np.all(numbers[(levels > 0) & (levels < saddle)] == 1)
    assert np.all(numbers[(levels > saddle + allowed) & (levels <= low)] == 2)
    assert np.all(numbers[(levels > low) & (levels <= high)] == 1)
    merged = found.levels * STEP < saddle
    np.testing.assert_allclose(found.tops[merged], high, rtol=1e-6)
    areas = np.bincount(found.levels, found.points)
    assert np.all(np.diff(areas[1:81]) <= 0)


def test_an_island_whose_top_is_on_the_edge_is_left_out():
    z = caps((0, 0, 4e-9), radius=4e-7, spacing=SPACING)
    middle = len(z) // 2
    assert len(find_islands(z[middle:], SPACING, STEP, (1, 50)).levels) == 0
    assert len(find_islands(z[middle - 1 :], SPACING, STEP, (1, 50)).levels) > 0


def test_a_flat_has_no_island_above_it():
    assert len(find_islands(np.zeros((5, 5)), SPACING, STEP, (1, 5)).levels) == 0


def test_more_islands_than_there_is_space_for_at_first():
    z = np.zeros((41, 41), np.float32)
    z[1:-1:2, 1:-1:2] = 1000.0 + np.arange(400).reshape(20, 20)
    found = find_islands(z, SPACING, 1.0, (1, 1001))
    assert np.all(found.points == 1)
    assert np.all(np.bincount(found.levels, minlength=1001)[1:] == 400)

"""Contact of islands: spheres of the area of the connected parts of the surface above the flat."""

import dataclasses

import numpy as np
import pytest
from published import SPACING, SURFACES
from scipy import ndimage

from stiction.contact.asperity import HertzAsperity, MaugisTable, hertz_force, reduced_modulus
from stiction.contact.pair import LEVELS_PER_RMS, Definition, SurfacePair
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.summits import find_summits

POLYSILICON = reduced_modulus(164e9, 0.23)
WATER, NONE = MaugisTable(POLYSILICON, attraction("water")), HertzAsperity(POLYSILICON)
STEP = 0.05e-9


def pair(spacing=SPACING, solid=NONE, side=0.8e-6, step=STEP):
    """Pair a with islands; its own rms, 1.71 nm, is the lowest level at which they are found."""
    strip = StripGrid(side, side, spacing, margin=0.2e-6)
    beam, substrate = (SURFACES[name].on(strip) for name in ("B1", "Sub1"))
    return SurfacePair(beam, substrate, step, definition=Definition.ISLAND, asperity=solid)


def rough(islands):
    return islands.draw(stream(2021, "beam"), stream(2021, "substrate"))


def caps(*tops, radius, spacing=SPACING, side=0.8e-6):
    """Flat far below, with paraboloids at places (x, y) of these heights, in lengths from the middle [m]."""
    x = (np.arange(round(side / spacing)) - round(side / spacing / 2)) * spacing
    each = [z - ((x[:, None] - a) ** 2 + (x - b) ** 2) / (2 * radius) for a, b, z in tops]
    return np.maximum(np.max(each, axis=0), 0).astype(np.float32)


def force(islands, heights):
    """Distances [m] at which islands are found, and the force there [N]."""
    at = islands.distances.solid
    found = islands.contact(heights)[0] * (heights.shape[0] - 2) * (heights.shape[1] - 2) * islands.spacing**2
    return at[at > 1.8e-9], found[at > 1.8e-9]


@pytest.mark.parametrize(("spacing", "allowed"), [(10e-9, 0.05), (5e-9, 0.02), (2.5e-9, 0.006)])
def test_a_paraboloid_is_hertz_and_the_error_falls_with_the_grid(spacing, allowed):
    """Deep overlaps, at which a circle contains at least 70 points of the coarsest grid.

    Half of their area, which is that of contact, would give a force less by 29 %.
    """
    islands, radius, top = pair(spacing), 4e-7, 5e-9
    at, found = force(islands, caps((0, 0, top), radius=radius, spacing=spacing))
    deep = top - at > 2.8e-9
    expected = hertz_force(top - at[deep], radius, POLYSILICON)
    assert abs(np.mean(found[deep] / expected) - 1) < allowed
    np.testing.assert_allclose(found[deep], expected, rtol=2 * allowed)


def test_a_fitted_paraboloid_is_hertz_on_the_coarsest_grid():
    """From 0.7 nm on, where islands have five points and more; spheres of their area miss this by far."""
    by_area, radius, top = pair(), 4e-7, 5e-9
    fitted = dataclasses.replace(by_area, definition=Definition.FITTED)
    heights = caps((0, 0, top), radius=radius)
    (at, found), (_, others) = (force(each, heights) for each in (fitted, by_area))
    deep = top - at > 0.7e-9
    expected = hertz_force(top - at, radius, POLYSILICON)
    np.testing.assert_allclose(found[deep], expected[deep], rtol=1e-4)
    assert np.abs(others[deep] / expected[deep] - 1).max() > 0.05
    few = (at < top) & (top - at < 0.1e-9)
    np.testing.assert_array_equal(found[few], others[few])  # too few points: by their area


@pytest.mark.parametrize("solid", [NONE, WATER])
def test_an_island_of_one_point_that_just_touches_is_a_summit(solid):
    islands, radius = pair(solid=solid), 1e-7
    summits = dataclasses.replace(islands, definition=Definition.SUMMIT)
    top = 100 * STEP + 1e-15  # between two grid distances, just above one
    heights = caps((0, 0, top), radius=radius)
    (at, found), (_, expected) = (force(one, heights) for one in (islands, summits))
    shallow = np.abs(at - 100 * STEP) < 1e-12
    apart = at > top + 1e-12
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found[shallow], expected[shallow], atol=1e-4 * scale)
    np.testing.assert_allclose(found[apart], expected[apart], rtol=1e-12)
    assert (solid is NONE) == np.all(expected[apart] == 0)
    deeper = at < 97 * STEP
    assert np.all(found[deeper] != expected[deeper])


def test_attraction_of_a_sphere_at_first_contact_is_bounded_by_its_pull_off():
    """Without the depth of a cell, the radius and with it the attraction would grow without bound at first contact.

    Levels lie 0.06 nm apart, over which the radius of one point falls by a third.
    """
    radius = 1e-7
    pull_off = 2 * np.pi * WATER.attraction.work_of_adhesion * radius
    at, found = force(pair(solid=WATER, step=1e-11), caps((0, 0, 4e-9), radius=radius))
    assert 0.6 * pull_off < -found.min() < pull_off
    touching = np.abs(at - 4e-9) < 0.1e-9
    assert np.abs(np.diff(found[touching])).max() < 0.25 * pull_off
    assert WATER.force(np.array([1e-11]), SPACING**2 / (2 * np.pi * 1e-11))[0] < -10 * pull_off


def test_islands_of_a_rough_surface_have_the_forces_of_labels():
    """Hertz forces of the connected parts of every level, by labels and the formula of the sphere of equal area."""
    islands = pair()
    z, stride = rough(islands), max(round(islands_rms(islands) / (LEVELS_PER_RMS * STEP)), 1)
    at, found = force(islands, z)
    expected = np.zeros(len(at))
    _, curvatures, _ = find_summits(z, SPACING)
    assert stride == 1
    assert len(curvatures) > 30
    for k, distance in enumerate(at):
        labels, count = ndimage.label(z >= distance, np.ones((3, 3)))
        for n, (i, j) in enumerate(ndimage.maximum_position(z, labels, range(1, count + 1)), start=1):
            if 0 < i < z.shape[0] - 1 and 0 < j < z.shape[1] - 1:
                expected[k] += sphere_of_island(z, (i, j), distance, int(np.sum(labels == n)))
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-12)
    assert np.count_nonzero(expected) > 20


def sphere_of_island(z, place, distance, points):
    """Hertz force of an island with this highest point: n h² = 2πR(δ + s), and h² = 2πs/κ."""
    i, j = place
    curvature = (4 * float(z[i, j]) - z[i, j - 1] - z[i, j + 1] - z[i - 1, j] - z[i + 1, j]) / (2 * SPACING**2)
    overlap = float(z[i, j]) - distance
    depth = SPACING**2 * curvature / (2 * np.pi)
    return hertz_force(overlap, points * SPACING**2 / (2 * np.pi * (overlap + depth)), POLYSILICON)


def islands_rms(islands):
    return float(np.hypot(islands.beam.rms, islands.substrate.rms))


def test_caps_apart_add_up_and_those_that_merge_are_one_sphere_of_their_area():
    """Two equal caps: twice the force above their saddle, and the force of one of twice the area below, less by √2."""
    islands, radius, half, top = pair(5e-9), 4e-7, 40e-9, 5e-9
    near, far = (force(islands, caps((-x, 0, top), (x, 0, top), radius=radius, spacing=5e-9)) for x in (half, 200e-9))
    one = force(islands, caps((0, 0, top), radius=radius, spacing=5e-9))[1]
    saddle = top - half**2 / (2 * radius)
    at, apart, merged = near[0], near[0] > saddle + 0.5e-9, (near[0] < saddle - 1e-9)
    touching = one != 0
    np.testing.assert_allclose(near[1][apart & touching], 2 * one[apart & touching], rtol=1e-9)
    np.testing.assert_allclose(far[1][touching], 2 * one[touching], rtol=1e-9)
    # Overlapping circles of radius a, a distance 2 half apart.
    a = np.sqrt(2 * radius * (top - at[merged]))
    lens = 2 * a**2 * np.arccos(half / a) - 2 * half * np.sqrt(a**2 - half**2)
    share = 2 - lens / (np.pi * a**2)
    np.testing.assert_allclose(near[1][merged] / one[merged], np.sqrt(share), rtol=0.03)
    assert np.all(share > 1.2)


def test_spheres_below_the_rms_are_those_found_there():
    islands, radius, top = pair(5e-9), 4e-7, 5e-9
    heights = caps((0, 0, top), radius=radius, spacing=5e-9)
    area = (heights.shape[0] - 2) ** 2 * 5e-9**2
    deep = islands.distances.solid < 1.7e-9
    found = islands.contact(heights)[0][deep] * area
    expected = hertz_force(top - islands.distances.solid[deep], radius, POLYSILICON)
    ratio = found / expected
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-7)  # of pressures in single precision of heights
    assert abs(ratio[0] - 1) < 0.03


@pytest.mark.parametrize("turned", [np.fliplr, np.flipud, np.transpose])
def test_pressure_of_islands_does_not_depend_on_direction(turned):
    islands = pair(solid=WATER)
    z = rough(islands)
    np.testing.assert_allclose(islands.contact(turned(z))[0], islands.contact(z)[0], rtol=1e-9, atol=1)
    np.testing.assert_array_equal(islands.contact(turned(z))[1], islands.contact(z)[1])


def test_summits_remain_the_default():
    islands = pair(solid=WATER)
    default = SurfacePair(islands.beam, islands.substrate, STEP, asperity=WATER)
    z = rough(islands)
    summits = dataclasses.replace(islands, definition=Definition.SUMMIT)
    np.testing.assert_array_equal(default.contact(z)[0], summits.contact(z)[0])
    assert not np.array_equal(default.contact(z)[0], islands.contact(z)[0])

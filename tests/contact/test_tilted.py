"""Tilted strips: against the strip without slope, smooth wedges, and plain sums over points and summits."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from published import SPACING, SURFACES

from stiction.contact import forcelaw, tilted
from stiction.contact.asperity import HertzAsperity, MaugisTable, reduced_modulus
from stiction.contact.meniscus import film, flooded_energy
from stiction.contact.pair import SurfacePair
from stiction.contact.tilt import Edge, Tilt, length_of_edge
from stiction.contact.tilted import TiltedPair
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface.field import StripGrid

STRIP = StripGrid(0.4e-6, 1.2e-6, SPACING, margin=0.2e-6)
POLYSILICON = reduced_modulus(164e9, 0.23)
WATER, NONE = MaugisTable(POLYSILICON, attraction("water")), HertzAsperity(POLYSILICON)
STEP, REACH, SLOPES = 0.1e-9, 25e-9, (0.05, 0.1, 0.2)
EDGES = pytest.mark.parametrize("edge", Edge)


def pair(edge=Edge.ROUNDED, slopes=SLOPES, asperity=WATER, radius=0.0, strip=STRIP):
    surfaces = SURFACES["B2"].on(strip), SURFACES["Sub1"].on(strip)
    return TiltedPair(*surfaces, STEP, asperity=asperity, tilt=Tilt(slopes, REACH, edge, radius))


def rough(number=0):
    return pair().draw(stream(2021, "beam", number), stream(2021, "substrate", number))


def forces(found, heights, humidity=0.67):
    """Largest attraction per width at every slope [N/m]."""
    solid, bearing = (curve[None] for curve in found.contact(heights))
    starts = found.distances.solid[0], found.distances.bearing[0]
    return forcelaw.largest_attractions(solid, bearing, starts, STEP, film(humidity, 300.0))[0] * found.length


@EDGES
def test_without_slope_the_largest_attraction_is_that_of_the_flat_strip(edge):
    heights, inner = rough(), (STRIP.shape[0] - 2) * SPACING
    flat = SurfacePair(pair().beam, pair().substrate, STEP, asperity=WATER)
    solid = flat.contact(heights)[0][None]
    for humidity in (0.5, 0.9):
        # Pressure on a flat strip refers to its inner rows, and on a tilted one to all that its edge leaves.
        found = pair(edge, (0.0,))
        area = (found.length * found.contact(heights)[1][0])[None]
        starts = 0.0, found.distances.bearing[0] - found.depth
        distance, curve = forcelaw.humid_curves(solid * inner, area, starts, STEP, film(humidity, 300.0))
        largest = forcelaw.extremum(distance, curve(0))[1]
        # The nodes of both curves differ by up to half a step. A square edge has maxima of its own.
        tolerance = 3e-3 if edge == Edge.ROUNDED else 0.2
        assert_allclose(forces(found, heights, humidity), largest, rtol=tolerance)


@EDGES
@pytest.mark.parametrize("humidity", [0.67, 0.92])
def test_a_smooth_flooded_wedge_pulls_with_its_energy_over_its_slope(edge, humidity):
    slopes = (0.05, 0.08, 0.1)
    found = pair(edge, slopes)
    pulls = forces(found, np.full(STRIP.shape, -found.depth, np.float32), humidity)  # nothing would stop it deeper
    height = film(humidity, 300.0)[0]
    wedges = np.divide(height, slopes)
    # Rows count as a whole, and at the edge of the film as half of one at most.
    assert np.all(np.abs(pulls * slopes / flooded_energy(300.0) - 1) < SPACING / wedges)
    assert np.any(np.abs(pulls * slopes / flooded_energy(300.0) - 1) > 0.02 * SPACING / wedges)  # control: not exact


@pytest.mark.parametrize("humidity", [0.67, 0.92])
@pytest.mark.parametrize("radius", [0.1e-6, 1e-6])
def test_a_smooth_flooded_tip_pulls_over_its_wedge_and_its_rounded_edge(radius, humidity):
    slopes = np.array([0.05, 0.1])
    strip = StripGrid(0.4e-6 + Tilt(slopes, REACH, radius=radius).before, 1.2e-6, SPACING, margin=0.2e-6)
    found = pair(slopes=tuple(slopes), radius=radius, strip=strip)
    pulls = forces(found, np.full(strip.shape, -found.depth, np.float32), humidity)
    height, tension = film(humidity, 300.0)
    wet = [height / slope - slope * radius / 2 + length_of_edge(radius, height, slope) for slope in slopes]
    assert_allclose(pulls, tension * np.array(wet), atol=1.1 * SPACING * tension)  # of rows
    assert np.all(pulls > 1.15 * tension * height / slopes)  # control: more than the wedge alone


def test_a_rounded_edge_drops_as_a_circle_and_ends_at_the_reach():
    radius, slopes = 2e-6, (0.05, 0.1)
    tilt = Tilt(slopes, REACH, radius=radius)
    along = np.linspace(-tilt.before, 0.3e-6, 400)
    for slope, ends in zip(slopes, tilt.ends, strict=True):
        circle = radius - np.sqrt(radius**2 - np.minimum(along, 0) ** 2)
        drop = tilt.drop(slope, along)
        assert_allclose(drop - slope**2 * radius / 2, slope * along + circle, atol=0.1 * REACH)
        assert 0 <= drop.min() < 0.01 * REACH
        end = -length_of_edge(radius, REACH, slope)
        near = tilt.drop(slope, end + np.array([-1e-12, 0, 1e-12]))
        assert_allclose(near[1], REACH, rtol=1e-9)
        assert_allclose(ends, 1 / slope + 2e-12 / (near[0] - near[2]), rtol=1e-4)
    assert tilt.before == length_of_edge(radius, REACH, 0.1)
    assert Tilt(slopes, REACH).before == 0
    assert_array_equal(Tilt(slopes, REACH).ends, 1 / np.array(slopes))


def test_a_rounder_edge_holds_harder_by_the_water_before_the_wedge():
    strip, means, radii = StripGrid(0.8e-6, 1.2e-6, SPACING, margin=0.2e-6), [], (0.0, 0.1e-6, 1e-6)
    height, tension = film(0.9, 300.0)
    for radius in radii:
        found = pair(slopes=(0.1,), radius=radius, strip=strip)
        drawn = (found.draw(stream(2021, "beam", k), stream(2021, "substrate", k)) for k in range(12))
        means.append(np.mean([forces(found, heights, 0.9) for heights in drawn]))
    of_edges = tension * np.array([length_of_edge(radius, height, 0.1) for radius in radii])
    assert np.all(0.1 * np.diff(of_edges) < np.diff(means))
    assert np.all(np.diff(means) < 2 * np.diff(of_edges))


def test_a_steep_smooth_tip_is_held_by_the_water_around_its_round_edge_at_any_slope():
    strip, radius = StripGrid(0.8e-6, 1.2e-6, SPACING, margin=0.2e-6), 1e-6
    found = pair(slopes=(0.05, 0.2, 0.3), radius=radius, strip=strip)
    pulls = forces(found, np.full(strip.shape, -found.depth, np.float32), 0.8)
    height, tension = film(0.8, 300.0)
    assert_allclose(pulls[1:], 2 * tension * np.sqrt(2 * radius * height), atol=2 * SPACING * tension)
    assert pulls[0] > 1.1 * pulls[1], "control: the wedge counts at small slopes"


def test_a_tip_whose_roughness_follows_its_slope_holds_harder_than_a_flooded_flat_one():
    found, height, rows = pair(slopes=(0.1,)), film(0.67, 300.0)[0], np.arange(STRIP.shape[0])
    face = np.where(rows < 20, 0.1 * SPACING * rows, -3 * height) - found.depth  # wet as a whole
    (rough,) = forces(found, np.tile(face[:, None], STRIP.shape[1]).astype(np.float32))
    (flat,) = forces(found, np.full(STRIP.shape, -found.depth, np.float32))
    assert rough > 3 * flat > 2 * flooded_energy(300.0) / 0.1


@EDGES
def test_force_and_wet_area_are_sums_over_summits_and_points(edge):
    heights, found = rough(1), pair(edge)
    solid, bearing = found.contact(heights)
    z, below = heights.astype(float), found.distances.below
    for k, slope in enumerate(SLOPES):
        lower = z - slope * SPACING * np.arange(len(z))[:, None]
        judged = lower if edge == Edge.SQUARE else z
        tops, curvatures = [], []
        for i in range(len(z)):
            for j in range(1, z.shape[1] - 1):
                near = judged[max(i - 1, 0) : i + 2, j - 1 : j + 2]
                if np.sum(near >= judged[i, j]) > 1 or i == len(z) - 1 or (i == 0 and edge == Edge.ROUNDED):
                    continue
                along = 2 * z[i, j] - z[i, j - 1] - z[i, j + 1]
                across = 0 if i == 0 else 2 * z[i, j] - z[i - 1, j] - z[i + 1, j]
                tops.append(lower[i, j])
                curvatures.append(max(along / SPACING**2, 5e5) if i == 0 else (along + across) / (2 * SPACING**2))
        for at in (120, 160):
            force = sum(
                WATER.force(top + found.depth - at * STEP, 1 / curvature)
                for top, curvature in zip(tops, curvatures, strict=True)
                if top > -found.depth
            )
            width = (z.shape[1] - 2) * SPACING
            scale = np.pi * WATER.attraction.work_of_adhesion * sum(1 / np.array(curvatures)) / len(tops)
            assert abs(solid[k, at] * found.length * width - force) < 0.02 * abs(force) + 0.1 * scale
            weights = np.ones(len(z))
            weights[0] = 0.5 if edge == Edge.SQUARE else 0
            share = weights @ (lower + found.depth > (at - below) * STEP).sum(axis=1) / (weights.sum() * z.shape[1])
            assert_allclose(bearing[k, at], share, atol=2e-3)


@EDGES
def test_bearing_areas_are_the_sums_of_the_weights_of_all_higher_points(edge):
    found, heights = pair(edge), rough(3)
    grid, (_, bearing) = found.distances, found.contact(heights)
    weights = np.ones((len(heights), 1))
    weights[0] = tilted.first_weight(edge)
    for slope, areas in zip(SLOPES, bearing, strict=True):
        lowered = slope * SPACING * np.arange(len(heights))[:, None] - found.depth
        steps = np.floor((heights - lowered) * (1 / STEP))
        for k in range(0, areas.size, 7):
            higher = np.sum(weights * (steps >= k - grid.below))
            assert areas[k] == higher / (weights.sum() * heights.shape[1])


@EDGES
def test_forces_do_not_depend_on_the_level_of_the_surface_nor_on_its_direction_across_the_beam(edge):
    heights = rough(2)
    expected = forces(pair(edge), heights)
    assert_allclose(forces(pair(edge), heights + np.float32(1e-9)), expected, rtol=2e-3)
    assert_allclose(forces(pair(edge), heights[:, ::-1].copy()), expected, rtol=1e-6)
    towards = forces(pair(edge), heights[::-1].copy())
    assert np.any(np.abs(towards / expected - 1) > 0.01)  # control: another tip


def test_a_square_edge_stands_off_and_holds_less_than_a_rounded_one():
    square, rounded = ([forces(pair(edge), rough(k)) for k in range(8)] for edge in (Edge.SQUARE, Edge.ROUNDED))
    assert np.mean(square, axis=0)[0] < np.mean(rounded, axis=0)[0]


def test_steeper_tips_are_held_less_in_wet_air():
    for k in range(4):
        assert np.all(np.diff(forces(pair(), rough(k), 0.92)) < 0)


def test_radii_on_the_edge_are_capped():
    heights = np.zeros((3, 5), np.float32)
    heights[0] = [0, 1e-12, 2e-12, 1e-12, 0]
    tops, curvatures = tilted.edge_maxima(heights, SPACING, 1e-9)
    assert_allclose((tops, curvatures), ([2e-12], [5e5]), rtol=1e-6)
    tops, _ = tilted.edge_maxima(heights, SPACING, -1e-9)  # the strip rises from the edge
    assert tops.size == 0


def test_points_below_the_reach_count_as_dry_although_the_strip_goes_on():
    heights, found = rough(3), pair(slopes=(0.2,))
    short = dataclasses.replace(found, tilt=dataclasses.replace(found.tilt, reach=5e-9))
    (_, long), (_, cut) = found.contact(heights), short.contact(heights)
    assert_array_equal(long[0, -len(cut[0]) :], cut[0])

"""Contact regions solved alone: against Hertz and full elastic contact, and connected parts against labels."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from published import SPACING, SURFACES
from scipy.ndimage import label

from stiction.contact import forcelaw
from stiction.contact.asperity import MaugisTable, hertz_force, reduced_modulus
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.meniscus import film
from stiction.contact.pair import DistanceGrid, SurfacePair
from stiction.contact.regions import BETWEEN, Strip, alone, solid_pressure, together
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface.field import StripGrid

E, NM, NONE = reduced_modulus(164e9, 0.23), 1e-9, Adhesion(0.0, 0.0)
WATER = attraction("water")
STEP, RADIUS, TOP = 0.05 * NM, 400 * NM, 2 * NM


def caps(*places, shape=(48, 120), spacing=5 * NM):
    """Paraboloids with their tops at some places [m] from the corner, (n1, n2) float32 [m]."""
    x, y = (np.arange(n) * spacing for n in shape)
    each = [TOP - ((x[:, None] - a) ** 2 + (y - b) ** 2) / (2 * RADIUS) for a, b in places]
    return np.max(each, axis=0).astype(np.float32)


def pressures(heights, within, attraction=NONE, films=((0.0, 0.0),)):
    """Distances from 1 nm below the tops [m], and the pressure there [Pa]."""
    grid = DistanceGrid.covering(float(heights.min()), TOP + 0.3 * NM, STEP)
    found = solid_pressure(Strip(heights, grid, films), within, attraction)
    return grid.solid[-len(found) :], found


def space_of(heights, spacing=5 * NM, periodic=False):
    return HalfSpace(heights.shape, spacing, E, periodic)


class Never(Strip):
    """A strip whose pressure is wanted at all distances."""

    pull = np.full(1000, np.inf)


def at_all(heights, within, attraction=NONE):
    grid = DistanceGrid.covering(0.0, TOP + 0.3 * NM, STEP)
    return grid.solid, solid_pressure(Never(heights, grid, ()), within, attraction)


@pytest.mark.parametrize("solids", [None, WATER])
def test_one_sphere_alone_is_in_full_elastic_contact(solids):
    z = caps((120 * NM, 300 * NM))
    space = space_of(z)
    adhesion = Adhesion.from_film((0.0, 0.0), solids, space)
    (distance, one), (_, other) = (at_all(z, within, adhesion) for within in (alone(z, space), together(space)))
    assert_allclose(one, other, atol=3e-3 * np.abs(one).max())
    deep, area = distance < TOP - 0.5 * NM, z.size * (5 * NM) ** 2
    if solids is None:
        assert_allclose(one[deep] * area, hertz_force(TOP - distance[deep], RADIUS, E), rtol=0.01)
    else:  # Maugis' theory is compared in tests/contact/test_elements.py
        assert one.min() < -0.5 * np.pi * WATER.work_of_adhesion * RADIUS / area


def test_regions_do_not_act_on_each_other_and_elements_of_full_contact_do():
    near, far = (caps((120 * NM, 300 * NM - x), (120 * NM, 300 * NM + x)) for x in (70 * NM, 130 * NM))
    single = caps((120 * NM, 300 * NM))
    distance, one = at_all(single, alone(single, space_of(single)))
    above = distance > TOP - 1.1 * NM  # the two are one region below their saddle, 1.5 nm below the tops
    for z in (near, far):
        _, two = at_all(z, alone(z, space_of(z)))
        assert_allclose(two[above], 2 * one[above], rtol=5e-3, atol=1e-4 * one.max())
    _, both = at_all(near, together(space_of(near)))
    assert both[np.flatnonzero(above)[0]] < 1.9 * one[np.flatnonzero(above)[0]]


@pytest.mark.parametrize("periodic", [True, False])
def test_regions_are_the_connected_parts_above_a_level(periodic):
    z = np.random.default_rng(3).standard_normal((30, 40)).astype(np.float32)
    places, regions = alone(z, HalfSpace(z.shape, SPACING, E, periodic))(0.8)
    found = np.split(places, regions.ends[:-1])
    tiled = np.tile(z, (3, 3)) if periodic else z  # the tile in the middle has all its neighbours
    labels, _ = label(tiled > 0.8, np.ones((3, 3)))
    middle = labels[30:60, 40:80] if periodic else labels
    for region in found:
        assert len(np.unique(middle.ravel()[region])) == 1 or periodic
    assert_array_equal(np.sort(places), np.flatnonzero(z > 0.8))
    if not periodic:
        assert len(found) == labels.max()
    else:
        assert len(found) < label(z > 0.8, np.ones((3, 3)))[1]


def test_elements_of_one_region_displace_each_other_as_on_a_half_space():
    z = np.ones((12, 20), np.float32)
    space = space_of(z)
    places, region = alone(z, space)(0.0)
    pressure = np.random.default_rng(1).uniform(0, 1e9, z.shape).astype(np.float32)
    found = np.empty(z.size)
    found[places] = region.displacement(pressure.ravel()[places][None])[0]
    assert_allclose(found.reshape(z.shape), space.displacement(pressure), rtol=1e-4)


# Rough strips


GRID = StripGrid(0.6e-6, 1.2e-6, SPACING, margin=0.2e-6)
PAIR = SurfacePair(SURFACES["B1"].on(GRID), SURFACES["Sub1"].on(GRID), STEP, asperity=MaugisTable(E, WATER))
FILMS = [film(humidity, 300.0) for humidity in (0.45, 0.9)]


@cache
def rough():
    return PAIR.draw(stream(5, "beam"), stream(5, "substrate"))


def test_energies_of_a_strip_are_those_of_its_force_curves():
    solid, bearing = PAIR.contact(rough())
    strip = Strip(rough(), PAIR.distances, FILMS)
    starts = PAIR.distances.solid[0], PAIR.distances.bearing[0]
    for found, each in zip(strip.energies(solid), FILMS, strict=True):
        distance, curve = forcelaw.humid_curves(solid[None], bearing[None], starts, STEP, each)
        assert found == forcelaw.adhesion_energy(distance, curve(0))
        assert np.all(strip.pull >= -(curve(0)[: solid.size] - solid) * (1 - 1e-12))


@pytest.mark.parametrize("periodic", [True, False])
def test_a_shift_of_a_periodic_strip_by_whole_elements_changes_nothing(periodic):
    space = HalfSpace(GRID.shape, SPACING, E, periodic)
    strips = [Strip(z, PAIR.distances, FILMS) for z in (rough(), np.roll(rough(), (21, 50), (0, 1)))]
    one, other = (strip.energies(solid_pressure(strip, alone(strip.heights, space), NONE)) for strip in strips)
    assert np.allclose(one, other, rtol=1e-3) == periodic


def test_the_pressure_is_known_until_it_exceeds_the_pull_of_the_water():
    space, strip = HalfSpace(GRID.shape, SPACING, E), Strip(rough(), PAIR.distances, FILMS)
    found = solid_pressure(strip, alone(rough(), space), NONE)
    pull = strip.pull[-len(found) :]
    nodes = round(BETWEEN / STEP)
    assert found[0] > pull[0]
    assert np.all(found[nodes:] <= pull[nodes:])
    assert len(found) < PAIR.distances.above

"""Attraction across gaps in full elastic contact: laws of the tables, and limits of spheres and rough strips."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_elements import E, by_summits, rough, space_of

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact import gaps
from stiction.contact.environment import Gaps, Water, flooded_law
from stiction.contact.full import elements
from stiction.contact.full.elements import GAPS, Adhesion, equilibrium, separation
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.materials import Solid
from stiction.contact.pair import bearing_area
from stiction.contact.solids import attraction_between
from stiction.contact.vanderwaals import attraction

NM = 1e-9
COATED = Solid(coating=1 * NM, coating_hamaker_constant={"water": 4e-21, "dry": 5e-20})
BARE = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100 * NM))
SPACED = Water(300.0, gaps=replace(BARE.gaps, spacer=1 * NM))
LAYERED = Water(300.0, gaps=replace(BARE.gaps, bodies={"beam": COATED, "substrate": COATED}))
DRY = replace(BARE, gaps=replace(BARE.gaps, summits="dry"))
ALL = {"bare": (BARE, 0.6), "spaced": (SPACED, 0.6), "layered": (LAYERED, 0.6), "dry": (DRY, 0.0)}


def solids_of(water):
    """Attraction of the summits."""
    if water.gaps.bodies:
        return attraction_between(COATED, COATED, water.gaps.summits)
    return attraction(water.gaps.summits, spacer=water.gaps.spacer)


@cache
def adhesion(name, modulus=E, reaches=True):
    water, humidity = ALL[name]
    space = HalfSpace((8, 8), 10 * NM, modulus)
    return Adhesion.from_film(water.film(humidity), solids_of(water), space, water.gaps if reaches else None)


# Tables


@pytest.mark.parametrize("name", ALL)
def test_attraction_is_the_slope_of_the_energy(name):
    """At gaps between the nodes of the tables as well, and nothing attracts beyond them."""
    fine = np.linspace(0, 30 * NM, 60001)
    pull = adhesion(name).traction(fine).astype(float)
    work = np.concatenate([[0], np.cumsum((pull[1:] + pull[:-1]) / 2)]) * fine[1]
    energy = adhesion(name).energy(fine)
    assert_allclose(energy - energy[0], work, atol=5e-3 * -energy[0])  # in the cell where the stress ends
    assert work[-1] == pytest.approx(energy[-1] - energy[0], rel=1e-4)
    assert_allclose(adhesion(name).traction(-fine[:2]), adhesion(name).traction(np.zeros(2)))
    assert np.all(adhesion(name).traction(np.array([301 * NM, 1e-3])) == 0)


@pytest.mark.parametrize("name", ALL)
def test_flats_that_touch_need_the_work_of_flooded_flats_and_farther_ones_that_across_gaps(name):
    water, humidity = ALL[name]
    height, tension = water.film(humidity)
    needed = height * tension + solids_of(water).work_of_adhesion + water.work_across(0.0, height)
    assert -adhesion(name).energy(0.0) == pytest.approx(needed, rel=1e-6)
    if name in ("bare", "dry"):
        assert needed == pytest.approx(flooded_law(humidity, water, 0.0)[0])
    far = np.array([5, 20, 100]) * NM
    assert_allclose(-adhesion(name).energy(far), water.gaps.through("dry").work(far), rtol=1e-3)
    assert np.all(adhesion(name, reaches=False).energy(far) == 0)


@pytest.mark.parametrize("name", ALL)
def test_attraction_of_the_solids_falls_with_the_gap(name):
    """Steep rises would not settle. Tables round off corners by less than a thousandth of the attraction."""
    solids = replace(adhesion(name), tension=0.0).traction(GAPS)
    wet = int(np.searchsorted(GAPS, adhesion(name).height))  # where water ends, the solids attract through air
    for part in (solids[: max(wet - 1, 0)], solids[wet + 2 :]):
        assert np.all(np.diff(part) <= 1e-3 * solids.max())
    assert np.all(solids >= 0)


def test_dry_flats_that_touch_need_the_work_of_eq_10():
    assert -adhesion("dry").energy(0.0) == pytest.approx(attraction("dry").work_of_adhesion, rel=1e-6)


# Spheres


def pull_of_sphere(name, radius, lift, reaches=True):
    """Attraction of a rigid sphere lifted from a flat, up to gaps of 20 nm below its top [N], and the work there."""
    end, stiff, spacing = 20 * NM, 1e4 * E, 1 * NM
    points = 2 * int(np.sqrt(2 * radius * end) / spacing) + 4
    x = (np.arange(points) - points // 2 + 0.5) * spacing
    heights = -(x[:, None] ** 2 + x**2) / (2 * radius)
    own = adhesion(name, stiff, reaches)
    space = HalfSpace((points, points), spacing, stiff, periodic=False)
    state = equilibrium(space, heights.astype(np.float32), float(heights.max()) + lift, own)
    return state.attraction[-heights < end].sum(dtype=float) * spacing**2, -own.energy(lift + end)


@pytest.mark.parametrize("lift", [0.0, 1 * NM, 5 * NM])
@pytest.mark.parametrize("name", ["dry", "bare"])
def test_a_rigid_sphere_attracts_with_two_pi_its_radius_times_the_work_of_flats(name, lift):
    radius = 1000 * NM
    force, beyond = pull_of_sphere(name, radius, lift)
    work = -adhesion(name).energy(lift) - beyond
    assert force == pytest.approx(2 * np.pi * radius * work, rel=0.01)
    if name == "dry" and lift:
        assert pull_of_sphere(name, radius, lift, reaches=False)[0] == 0


# Rough strips


def rough_adhesion(name, reaches=True, modulus=E):
    water, humidity = ALL[name]
    space = space_of(modulus=modulus)
    return space, Adhesion.from_film(water.film(humidity), solids_of(water), space, water.gaps if reaches else None)


def test_rigid_surfaces_apart_attract_each_other_as_undeformed_ones():
    step, top = 0.05 * NM, float(rough().max())
    distances = top + 1 * NM + step * np.arange(3)
    below, above = (int(np.ceil(end / step)) + 1 for end in (-float(rough().min()), top))
    area = bearing_area(rough(), step, below, above + 1)[None]
    expected, _ = gaps.gap_pressures(area, -below * step, distances, step, lambda gap: DRY.gaps.work(gap, 0.0))
    space, stiff = rough_adhesion("dry", modulus=1e4 * E)
    found = equilibrium(space, rough(), distances[1], stiff)
    assert not found.pressure.any()
    assert found.force == pytest.approx(expected[0, 1], rel=0.01)
    _, touching = rough_adhesion("dry", reaches=False, modulus=1e4 * E)
    assert equilibrium(space, rough(), distances[1], touching).force == 0


@cache
def separated(reaches):
    space, own = rough_adhesion("bare", reaches)
    return separation(space, rough(), own, by_summits(0, 0.6)[2]), own


def test_surfaces_hold_more_strongly_where_the_solids_attract_each_other_across_gaps():
    (touching, _), (across, _) = separated(False), separated(True)
    assert across.adhesion_energy > 1.02 * touching.adhesion_energy
    assert across.pull_off > 1.01 * touching.pull_off
    assert across.closed.residual <= 5 * elements.TOLERANCE


def test_the_force_of_deformed_surfaces_is_the_slope_of_their_energy():
    """Between two distances without contact that jumps, with the attraction across gaps that deforms them."""
    (found, own), space = separated(True), space_of()
    step, states = 0.02 * NM, [found.closed]
    for _ in range(6):
        states.append(equilibrium(space, rough(), states[-1].distance + step, own, states[-1]))
    energies = np.array([state.energy(rough(), own) for state in states])
    work = -np.trapezoid([state.force for state in states], dx=step)
    assert energies[-1] - energies[0] == pytest.approx(work, rel=0.05)

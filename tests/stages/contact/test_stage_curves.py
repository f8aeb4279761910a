"""Force curves from stored datasets."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erfc

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.correction import Correction, ElasticChange, TipChanges
from stiction.contact.environment import Gaps, Water, flooded_law
from stiction.contact.pair import DistanceGrid
from stiction.contact.tilt import Tilt, length_of_edge
from stiction.contact.vanderwaals import attraction
from stiction.stages.contact import contact
from stiction.stages.contact.curves import (
    energies,
    fast_tip_forces,
    force_curves,
    pull_offs,
    tip_forces,
    vectors,
)


def test_force_at_a_humidity_is_solid_pressure_less_tension_on_the_wet_area():
    grid = DistanceGrid(0.5e-9, 10, 40)
    solid = np.exp(-grid.solid / 2e-9)[None] * 1e8
    bearing = 1 / (1 + np.exp(grid.bearing / 2e-9))[None]
    dataset = contact.layout(solid, bearing, grid, range(1))
    distance, curve, *_ = force_curves(dataset, 0.65, Water(300.0))
    # Tension 59.7 MPa and height 2.41 nm of water at RH 0.65, 300 K.
    tension, height = 59.7e6, 2.41e-9
    for k in (5, 12):
        wet = np.interp(distance[k] - height, grid.bearing, bearing[0])
        np.testing.assert_allclose((solid[0, k] - curve(0)[k]) / tension, wet, rtol=2e-3)  # inputs have 3 digits


def test_contact_angles_lower_the_film_and_keep_the_tension():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = 1 / (1 + np.exp(grid.bearing / 2e-9))[None]
    dataset = contact.layout(np.zeros((1, 40)), bearing, grid, range(1))
    angles = np.radians([20.0, 60.0])
    distance, curve, *_ = force_curves(dataset, 0.65, Water(300.0, tuple(angles)))
    height = 2.41e-9 * np.cos(angles).sum() / 2
    for k in (5, 12):
        wet = np.interp(distance[k] - height, grid.bearing, bearing[0])
        np.testing.assert_allclose(-curve(0)[k] / 59.7e6, wet, rtol=2e-3)


def tips(solid, bearing, grid):
    """Dataset of the contact of tips at slopes of 0.05 and 0.1, on a strip of 0.3 µm."""
    dataset = contact.layout(solid, bearing, grid, range(len(solid))).assign(length=3e-7)
    return dataset.assign_coords(slope=[0.05, 0.1]).assign(ends=("slope", [20.0, 10.0]))


def changed_tips(ratios, power=1.0, error=0.0):
    """Correction of tips with ratios at both slopes, and of nothing else."""
    change = ElasticChange(np.tile(ratios, (2, 1)), np.full(2, power), np.full((2, 2), error))
    tilted = TipChanges(np.array([0.05, 0.1]), change)
    return Correction(np.array([0.5, 0.8]), ElasticChange(np.ones(2)), ElasticChange(np.ones(2)), tilted)


def test_the_force_of_a_tip_is_the_largest_attraction_of_each_slope_on_the_strip():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.array([[1 / (1 + np.exp(grid.bearing / scale)) for scale in (2e-9, 1e-9)]])
    solid = np.array([[np.exp(-grid.solid / 2e-9) * size for size in (1e8, 9e7)]])
    wet = Water(300.0, (0.3, 0.0))
    slopes, forces = tip_forces(tips(solid, bearing, grid), 0.65, wet)
    np.testing.assert_array_equal(slopes, [0.05, 0.1])
    flat = [contact.layout(solid[:, k], bearing[:, k], grid, range(1)) for k in range(2)]
    np.testing.assert_allclose(forces[0], [3e-7 * pull_offs(one, 0.65, wet)[0] for one in flat], rtol=1e-6)


def test_full_contact_changes_slow_and_fast_tips_by_the_ratio_of_each_slope():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.tile(1 / (1 + np.exp(grid.bearing / 2e-9)), (1, 2, 1))
    found, wet = tips(np.tile(np.exp(-grid.solid / 2e-9) * 1e8, (1, 2, 1)), bearing, grid), Water(300.0)
    for forces_of in (
        lambda water: tip_forces(found, 0.65, water)[1],
        lambda water: fast_tip_forces(found, 0.65, water),
    ):
        changed, summits = forces_of(replace(wet, correction=changed_tips([3.0, 0.7]))), forces_of(wet)
        np.testing.assert_allclose(changed, [3.0, 0.7] * summits, rtol=1e-12)
        assert np.all(summits > 0)


def test_tips_have_the_upper_end_of_the_ratio_that_few_strips_show():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.tile(1 / (1 + np.exp(grid.bearing / 2e-9)), (1, 2, 1))
    found, wet = tips(np.tile(np.exp(-grid.solid / 2e-9) * 1e8, (1, 2, 1)), bearing, grid), Water(300.0)
    few = changed_tips([2.0, 0.5], error=0.1)
    changed, summits = (tip_forces(found, 0.65, water)[1] for water in (replace(wet, correction=few), wet))
    np.testing.assert_allclose(changed, np.exp(1.6449 * 0.1) * summits * [2.0, 0.5], rtol=1e-4)


def test_tips_scatter_as_tilted_strips_do():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.tile(1 / (1 + np.exp(grid.bearing / 2e-9)), (3, 2, 1))
    solid = np.exp(-grid.solid / 2e-9) * 1e8 * np.array([0.8, 1.0, 1.1])[:, None, None] * np.ones((1, 2, 1))
    found, wet = tips(solid, bearing, grid), Water(300.0)
    full = replace(wet, correction=changed_tips([3.0, 1.5], 1.4))
    changed, summits = (tip_forces(found, 0.65, water)[1] for water in (full, wet))
    np.testing.assert_allclose(np.log(changed).std(axis=0), 1.4 * np.log(summits).std(axis=0), rtol=1e-6)
    np.testing.assert_allclose(changed.mean(axis=0), [3, 1.5] * summits.mean(axis=0), rtol=1e-6)
    assert np.all(np.log(summits).std(axis=0) > 0.01)


def test_a_tip_that_no_solid_stops_is_pressed_to_its_mean_plane():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.tile(1 / (1 + np.exp(grid.bearing / 2e-9)), (1, 2, 1))
    _, forces = tip_forces(tips(np.zeros((1, 2, 40)), bearing, grid), 0.65, Water(300.0))
    covered = np.interp(-2.41e-9, grid.bearing, bearing[0, 0])
    np.testing.assert_allclose(forces, 3e-7 * 59.7e6 * covered, rtol=2e-3)


def test_a_film_beyond_the_reach_of_the_tips_is_refused_with_its_humidity():
    grid = DistanceGrid(0.5e-9, 10, 40)
    found = tips(np.zeros((1, 2, 40)), np.zeros((1, 2, 50)), grid)
    with pytest.raises(ValueError, match="of up to 5 nm, and that at a relative humidity of 0.9 is 9.86 nm high"):
        tip_forces(found, 0.9, Water(300.0))


# Attraction across gaps

ACROSS = Gaps(HAMAKER_CONSTANT, "water", 100e-9)


def rough(rms, step=0.05e-9, reach=40e-9):
    """Contact of two samples of Gaussian heights, held at three times their standard deviation by their summits."""
    grid = DistanceGrid.covering(-12e-9, reach, step)
    bearing = np.tile(erfc(grid.bearing / (np.sqrt(2) * rms)) / 2, (2, 1))
    solid = np.tile(1e6 * np.exp((3 * rms - grid.solid) / (0.1 * rms)), (2, 1))
    return contact.layout(solid, bearing, grid, range(2))


def test_without_attraction_across_gaps_the_curves_are_those_of_summits_and_water():
    dataset = rough(2e-9)
    assert force_curves(dataset, 0.6, Water(300.0)).beyond is None
    plain, across = (energies(dataset, 0.6, Water(300.0, gaps=gaps)) for gaps in (None, ACROSS))
    assert np.all(across > 1.01 * plain)


def test_energy_across_gaps_does_not_depend_on_where_the_grid_of_distances_ends():
    water = Water(300.0, gaps=ACROSS)
    near, far = (rough(2e-9, reach=reach) for reach in (14e-9, 60e-9))
    found = energies(near, 0.6, water)
    np.testing.assert_allclose(found, energies(far, 0.6, water), rtol=2e-5)
    missing = [force_curves(dataset, 0.6, water).beyond for dataset in (near, far)]
    assert np.all(missing[0] > 5 * missing[1])
    assert np.all(missing[0] > 1e-3 * found)


def test_vectors_have_the_energies_across_gaps():
    dataset, water = rough(2e-9), Water(300.0, gaps=ACROSS)
    found, limit = vectors(dataset, 0.6, water)
    np.testing.assert_array_equal(found[:, 0], energies(dataset, 0.6, water))
    np.testing.assert_array_equal(found[:, 1], pull_offs(dataset, 0.6, water))
    assert limit == found[:, 1].max()


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_solids_that_attract_through_air_do_so_in_the_film_as_well(medium):
    gaps = Gaps(HAMAKER_CONSTANT, medium, 100e-9)
    counted = {"water": 0.0874, "dry": 0.167}[medium]
    wet, air = (gaps.through(each).work(2e-9) for each in ("water", "dry"))
    expected = 0 if medium == "dry" else air - wet
    assert gaps.work(0.0, 2e-9) == pytest.approx(expected, abs=1e-12)
    # Beyond the range of the Dugdale stress, nothing is subtracted.
    assert gaps.work(1e-9, 0.5e-9) == pytest.approx(gaps.through("dry").work(1e-9), rel=1e-12)
    assert gaps.work(0.1e-9, 2e-9) - gaps.through(medium).work(0.1e-9) < -0.5 * counted


@pytest.mark.parametrize("medium", ["water", "dry"])
@pytest.mark.parametrize("spacer", [0.3e-9, 2.4e-9])
def test_coated_flats_that_touch_need_the_work_at_the_distance_of_their_coatings_in_all(medium, spacer):
    """Through air, with and without a film that fills their coatings' contact; summits count their own share once."""
    gaps, counted = Gaps(HAMAKER_CONSTANT, medium, np.inf, spacer), attraction(medium, spacer=spacer)
    distance = counted.closest_distance
    whole = (
        HAMAKER_CONSTANT["dry"] / (12 * np.pi * distance**2) * (1 - (counted.equilibrium_distance / distance) ** 6 / 4)
    )
    assert gaps.work(0.0, 0.0) + counted.work_of_adhesion == pytest.approx(whole, rel=1e-12)
    wet = whole * HAMAKER_CONSTANT[medium] / HAMAKER_CONSTANT["dry"]
    assert gaps.work(0.0, 1e-5) + counted.work_of_adhesion == pytest.approx(wet, rel=1e-6)
    assert gaps.work(0.0, 0.0) + attraction(medium).work_of_adhesion > 1.2 * whole  # not that of the bare solids


def test_energies_fall_with_the_thickness_of_the_coatings():
    dataset = rough(2e-9)
    found = [
        energies(dataset, 0.4, Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100e-9, spacer)))
        for spacer in (0.0, 0.6e-9, 1.2e-9, 2.4e-9, 5e-9)
    ]
    assert np.all(np.diff(found, axis=0) < 0)
    np.testing.assert_array_equal(found[0], energies(dataset, 0.4, Water(300.0, gaps=ACROSS)))


def test_no_sample_exceeds_the_energy_and_the_pull_off_of_flooded_flats_that_attract_across_gaps():
    dataset, water = rough(0.1e-9), Water(300.0, gaps=ACROSS)
    most, pull = flooded_law(0.6, water, HAMAKER_CONSTANT["water"])
    assert np.all(energies(dataset, 0.6, water) < most)
    assert np.all(pull_offs(dataset, 0.6, water) < pull)
    assert most > flooded_law(0.6, Water(300.0), HAMAKER_CONSTANT["water"])[0]


@pytest.mark.parametrize("radius", [0.0, 0.1e-6, 1e-6])
def test_a_tip_is_held_across_gaps_by_the_whole_wedge_and_its_edge(radius):
    """A smooth wedge of slope θ at a distance d has the force U(d) / θ per width, wherever its stored heights end."""
    water, slopes, length, forces = Water(300.0, gaps=ACROSS), np.array([0.05, 0.1]), 2e-6, []
    for below in (100, 300):
        grid = DistanceGrid(0.01e-9, 5 * below, 500)
        depth = np.maximum(-grid.bearing, 0)
        tip = [  # both ends of what is higher than a depth
            np.maximum(depth / slope - slope * radius / 2, -slope * radius + np.sqrt(2 * radius * depth))
            + [length_of_edge(radius, each, slope) for each in depth]
            for slope in slopes
        ]
        solid = 1e24 * np.maximum(3e-9 - grid.solid, 0) ** 2  # holds the tip 3 nm away, out of reach of the water
        dataset = contact.layout(np.tile(solid, (1, 2, 1)), np.array([tip]) / length, grid, range(1))
        ends = Tilt(tuple(slopes), -grid.bearing[0], radius=radius).ends
        dataset = dataset.assign(length=length, ends=("slope", ends)).assign_coords(slope=slopes)
        forces.append(tip_forces(dataset, 0.6, water)[1][0])
    if not radius:
        np.testing.assert_allclose(forces, [ACROSS.work(3e-9, 0.0) / slopes] * 2, rtol=0.02)
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-5 if not radius else 0.02)

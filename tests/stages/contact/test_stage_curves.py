"""Force curves from stored datasets."""

import numpy as np
import pytest

from stiction.contact.pair import DistanceGrid
from stiction.stages.contact import contact
from stiction.stages.contact.curves import Water, force_curves, pull_offs, tip_forces


def test_force_at_a_humidity_is_solid_pressure_less_tension_on_the_wet_area():
    grid = DistanceGrid(0.5e-9, 10, 40)
    solid = np.exp(-grid.solid / 2e-9)[None] * 1e8
    bearing = 1 / (1 + np.exp(grid.bearing / 2e-9))[None]
    dataset = contact.layout(solid, bearing, grid, range(1))
    distance, curve = force_curves(dataset, 0.65, Water(300.0))
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
    distance, curve = force_curves(dataset, 0.65, Water(300.0, tuple(angles)))
    height = 2.41e-9 * np.cos(angles).sum() / 2
    for k in (5, 12):
        wet = np.interp(distance[k] - height, grid.bearing, bearing[0])
        np.testing.assert_allclose(-curve(0)[k] / 59.7e6, wet, rtol=2e-3)


def tips(solid, bearing, grid):
    """Dataset of the contact of one tip at slopes of 0.05 and 0.1, on a strip of 0.3 µm."""
    dataset = contact.layout(solid, bearing, grid, range(1)).assign(length=3e-7)
    return dataset.assign_coords(slope=[0.05, 0.1])


def test_the_force_of_a_tip_is_the_largest_attraction_of_each_slope_on_the_strip():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.array([[1 / (1 + np.exp(grid.bearing / scale)) for scale in (2e-9, 1e-9)]])
    solid = np.array([[np.exp(-grid.solid / 2e-9) * size for size in (1e8, 9e7)]])
    wet = Water(300.0, (0.3, 0.0))
    slopes, forces = tip_forces(tips(solid, bearing, grid), 0.65, wet)
    np.testing.assert_array_equal(slopes, [0.05, 0.1])
    flat = [contact.layout(solid[:, k], bearing[:, k], grid, range(1)) for k in range(2)]
    np.testing.assert_allclose(forces[0], [3e-7 * pull_offs(one, 0.65, wet)[0] for one in flat], rtol=1e-6)


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

"""Force curves from stored datasets."""

import numpy as np
import pytest

from stiction.contact.meniscus import flooded_energy
from stiction.contact.pair import DistanceGrid
from stiction.stages import contact
from stiction.stages.curves import Water, energies, force_curves, pull_offs, tip_energies, tip_pull_offs


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


def test_a_tip_that_no_solid_stops_is_flooded_and_others_have_the_energy_of_their_curve():
    grid = DistanceGrid(0.5e-9, 10, 40)
    bearing = np.tile(1 / (1 + np.exp(grid.bearing / 2e-9)), (2, 1))
    solid = np.array([np.exp(-grid.solid / 2e-9) * 1e8, np.zeros(40)])
    wet, dataset = Water(300.0, (0.3, 0.0)), contact.layout(solid, bearing, grid, range(2))
    held = energies(dataset.isel(sample=[0]), 0.65, wet)
    np.testing.assert_array_equal(tip_energies(dataset, 0.65, wet), [*held, flooded_energy(300.0, (0.3, 0.0))])
    assert held < flooded_energy(300.0, (0.3, 0.0))
    with pytest.raises(ValueError, match="sample 1: the force does not rise"):
        energies(dataset, 0.65, wet)
    largest = tip_pull_offs(dataset, 0.65, wet)
    assert largest[0] == pull_offs(dataset.isel(sample=[0]), 0.65, wet)
    # The water pulls hardest where its film covers most, at the mean planes: 59.7 MPa within 2.41 nm of angles of zero.
    height = 2.41e-9 * (np.cos(0.3) + 1) / 2
    covered = np.interp(-height, grid.bearing, bearing[1])
    np.testing.assert_allclose(largest[1], 59.7e6 * covered, rtol=2e-3)
    assert largest[1] > largest[0]
    with pytest.raises(ValueError, match="sample 1: the minimum of the force is at an end of its grid"):
        pull_offs(dataset, 0.65, wet)

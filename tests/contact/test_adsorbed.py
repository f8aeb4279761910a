"""Adsorbed films: the height that they add to the water, from grand potentials, and what it does to energies."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose
from scipy.optimize import brentq, minimize_scalar

from stiction.constants import surface_energy
from stiction.contact.environment import Gaps, Water, flooded_law, force_curves
from stiction.contact.meniscus import Isotherm, film, laplace_pressure
from stiction.stages.contact import curves
from stiction.stages.contact.contact import tables

NM = 1e-9
WATER = Water(300.0)
ACROSS = replace(WATER, gaps=Gaps({"water": 9.75e-20, "dry": 18.65e-20}, "water", 100e-9))
HAMAKER_CONSTANT = 1e-20


def potential_of_two_films(tension, binding):
    """Grand potential of two films of the best thickness above that of flooded solids [J/m²]."""
    best = minimize_scalar(lambda log: binding(np.exp(log)) + tension * np.exp(log), bounds=np.log([1e-12, 1e-7]))
    return 2 * (surface_energy(300.0) + best.fun)


@pytest.mark.parametrize("humidity", [0.44, 0.67, 0.9])
def test_films_held_by_van_der_waals_forces_add_three_times_their_thickness(humidity):
    tension = -float(laplace_pressure(humidity, 300.0))
    thickness = (HAMAKER_CONSTANT / (6 * np.pi * tension)) ** (1 / 3)
    films = potential_of_two_films(tension, lambda t: HAMAKER_CONSTANT / (12 * np.pi * t**2))
    bridged = brentq(lambda gap: tension * gap - films, 0, 1e-6)
    assert_allclose(replace(WATER, adsorbed=3 * thickness).film(humidity)[0], bridged, rtol=1e-6)
    assert_allclose(3 * thickness / NM, {0.44: 0.50, 0.67: 0.63, 0.9: 1.00}[humidity], atol=0.01)


def test_layers_of_a_fixed_thickness_add_twice_their_thickness():
    tension, layer = film(0.44, 300.0)[1], 0.3 * NM
    films = potential_of_two_films(tension, lambda t: 1e12 * max(layer - t, 0.0))
    bridged = brentq(lambda gap: tension * gap - films, 0, 1e-6)
    assert_allclose(replace(WATER, adsorbed=2 * layer).film(0.44)[0], bridged, rtol=1e-4)


@pytest.mark.parametrize("water", [WATER, ACROSS])
def test_no_film_gives_the_same_bits(water):
    none = replace(water, adsorbed=0.0)
    assert none == water
    for humidity in (0.44, 0.92):
        assert none.film(humidity) == film(humidity, 300.0)
    assert_allclose(flooded_law(0.44, replace(none, gaps=None), 0.0)[0], 2 * surface_energy(300.0), rtol=1e-12)


def test_the_tension_stays_and_dry_or_repellent_surfaces_have_no_film():
    wet = replace(WATER, adsorbed=0.5 * NM)
    assert wet.film(0.67)[1] == film(0.67, 300.0)[1]
    assert_allclose(wet.film(0.67)[0] - film(0.67, 300.0)[0], 0.5 * NM, rtol=1e-9)
    assert wet.film(0.0) == (0.0, 0.0)
    assert replace(wet, contact_angles=(np.radians(110),) * 2).film(0.67) == (0.0, 0.0)


def test_a_thick_film_lets_no_air_that_is_too_dry_condense_water():
    with pytest.raises(ValueError, match="no liquid"):
        replace(WATER, adsorbed=3 * NM).film(0.2)


def test_flats_in_contact_need_the_work_of_the_films_as_well_and_nothing_more_in_saturated_air():
    wet = replace(WATER, adsorbed=0.5 * NM)
    for humidity in (0.44, 0.67, 0.9):
        added = film(humidity, 300.0)[1] * 0.5 * NM
        assert_allclose(flooded_law(humidity, wet, 0.0)[0], 2 * surface_energy(300.0) + added, rtol=1e-12)
    assert_allclose(flooded_law(1 - 1e-9, wet, 0.0)[0], 2 * surface_energy(300.0), rtol=1e-6)


def test_separating_stiff_flats_takes_the_energy_of_flooded_flats():
    step, wet = 0.05 * NM, replace(WATER, adsorbed=0.5 * NM)
    bearing = np.array([[1.0, 0.0]])
    distance, curve, *_ = force_curves(np.zeros((1, 2)), bearing, (0.0, -step / 2), step, 0.44, wet)
    assert_allclose(
        -np.trapezoid(curve(0), distance), flooded_law(0.44, wet, 0.0)[0], rtol=0.5 * step / wet.film(0.44)[0]
    )


@pytest.mark.parametrize("water", [WATER, ACROSS])
def test_energies_and_pull_off_forces_grow_with_the_film(water):
    contact = small.contact_of_pair()
    for of in (curves.energies, curves.pull_offs, curves.fast_energies):
        found = [of(contact, 0.44, replace(water, adsorbed=add * NM)) for add in (0, 0.1, 0.2, 0.5)]
        assert np.all(np.diff(found, axis=0) > 0)


def test_films_shorten_lengths_most_in_dry_air_and_hardly_in_wet_air():
    slopes = []
    for humidity in (0.44, 0.55, 0.67, 0.92):
        energies = [
            curves.energies(small.contact_of_pair(), humidity, replace(WATER, adsorbed=added)).mean()
            for added in (0.1 * NM, 0.0)
        ]
        slopes.append(100 * ((energies[0] / energies[1]) ** -0.25 - 1))  # [%] per 0.1 nm
    assert np.all(np.diff(slopes) > 0)
    assert -10 < slopes[0] < -5
    assert -1 < slopes[-1] < 0


def test_the_film_is_part_of_the_force_curve_between_contact_and_its_height():
    solid, bearing, starts, step = tables(small.contact_of_pair())
    for humidity in (0.44, 0.9):
        shifted = replace(WATER, adsorbed=4 * step)
        distance, curve, *_ = force_curves(solid * 0, bearing, starts, step, humidity, shifted)
        _, thin, *_ = force_curves(solid * 0, bearing, starts, step, humidity, WATER)
        near = curve(3)[4 : len(thin(3))].copy()
        assert_allclose(near, thin(3)[: len(near)], rtol=1e-6, atol=1e-3)
        assert distance[0] == starts[0]


# Films that grow with the humidity


def test_an_isotherm_of_van_der_waals_films_adds_three_times_their_thickness():
    """The closed form of films in the humidity, measured at many of them up to near saturation."""
    at = 1 - np.geomspace(0.95, 1e-6, 4000)
    thickness = (HAMAKER_CONSTANT / (6 * np.pi * -laplace_pressure(at, 300.0))) ** (1 / 3)
    isotherm = Isotherm(tuple(at), tuple(thickness))
    for humidity in (0.44, 0.67, 0.9):
        tension = -float(laplace_pressure(humidity, 300.0))
        own = (HAMAKER_CONSTANT / (6 * np.pi * tension)) ** (1 / 3)
        assert_allclose(isotherm.height(humidity), 3 * own, rtol=3e-3)
        assert isotherm.height(humidity) > 2.5 * own  # control: twice the thickness there is too little


def test_films_that_go_on_beyond_the_wettest_air_are_higher_by_their_water_there():
    at = 1 - np.geomspace(0.95, 1e-6, 4000)
    thickness = (HAMAKER_CONSTANT / (6 * np.pi * -laplace_pressure(at, 300.0))) ** (1 / 3)
    whole, ended = Isotherm(tuple(at), tuple(thickness)), at <= 0.9
    measured = Isotherm(tuple(at[ended]), tuple(thickness[ended]))
    wettest = at[ended][-1]
    for humidity in (0.44, 0.67, 0.85):
        missing = whole.height(humidity) - measured.height(humidity)
        assert_allclose(missing, thickness[ended][-1] * np.log(wettest) / np.log(humidity), rtol=0.02)


def test_water_has_the_height_of_its_isotherm_and_that_of_other_films():
    isotherm = Isotherm((0.3, 0.75, 0.9), (0.8 * NM, 1.2 * NM, 1.8 * NM))
    grown = replace(WATER, isotherm=isotherm)
    added = [grown.film(humidity)[0] - WATER.film(humidity)[0] for humidity in (0.3, 0.6, 0.9)]
    assert_allclose(added, [isotherm.height(humidity) for humidity in (0.3, 0.6, 0.9)], rtol=1e-9)
    assert added == sorted(added)
    assert_allclose(added[2], 3.6 * NM, rtol=1e-9)  # both films, which grow no further
    assert_allclose(replace(grown, adsorbed=NM).film(0.6)[0] - grown.film(0.6)[0], NM, rtol=1e-9)
    assert grown.film(0.0) == (0.0, 0.0)
    assert grown.film(0.6)[1] == WATER.film(0.6)[1]


def test_below_the_driest_measured_air_a_film_vanishes_with_the_humidity():
    isotherm, x = Isotherm((0.5, 0.8), (1 * NM, 2 * NM)), np.linspace(0.2, 1, 200_001)
    thickness = np.interp(x, [0, 0.5, 0.8], [0, NM, 2 * NM])
    expected = 2 * np.trapezoid(thickness / x, x) / np.log(1 / 0.2)
    assert_allclose(isotherm.height(0.2), expected, rtol=1e-6)

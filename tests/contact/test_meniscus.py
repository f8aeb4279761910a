import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.constants import (
    GAS_CONSTANT,
    WATER_MOLAR_VOLUME,
    WATER_MOLECULE,
    WATER_SURFACE_ENERGY,
    molar_volume,
    surface_energy,
    tabulated_density,
    tabulated_surface_tension,
)
from stiction.contact.meniscus import (
    STRENGTH,
    dry_air,
    film,
    flooded_energy,
    humidity_at,
    kelvin_radius,
    laplace_pressure,
    least_humidity,
    meniscus_height,
    vapour_pressure,
)

ROUNDING = 1e-12  # a dozen operations in double precision, and the logarithm near RH = 1
humidities = st.floats(0.01, 0.999)
liquid = st.floats(0.001, 0.999)  # share of the way from the driest air in which water is a liquid to saturated air
temperatures = st.floats(273, 373)
angles = st.floats(0, 1.5)


@given(humidities, temperatures)
def test_tension_times_height_is_twice_the_surface_energy(humidity, temperature):
    product = abs(laplace_pressure(humidity, temperature)) * meniscus_height(humidity, temperature)
    np.testing.assert_allclose(product, 2 * surface_energy(temperature), rtol=ROUNDING)


def test_water_at_65_percent_has_the_tension_and_the_height_of_the_paper():
    assert round(float(laplace_pressure(0.65, 300)) / 1e6, 1) == -59.7
    assert round(float(meniscus_height(0.65, 300)) * 1e9, 2) == 2.41


@given(liquid, temperatures, angles, angles)
def test_tension_times_height_is_the_surface_energy_times_the_cosines(above, temperature, first, second):
    least = least_humidity(temperature, (first, second))
    humidity = least + above * (1 - least)
    height, tension = film(humidity, temperature, (first, second))
    assert (height, -tension) == (
        meniscus_height(humidity, temperature, (first, second)),
        laplace_pressure(humidity, temperature),
    )
    expected = surface_energy(temperature) * (np.cos(first) + np.cos(second))
    np.testing.assert_allclose(tension * height, expected, rtol=ROUNDING)
    np.testing.assert_allclose(tension * height, flooded_energy(temperature, (first, second)), rtol=ROUNDING)


@given(humidities, temperatures)
def test_perfectly_wetting_flats_are_those_of_the_paper_byte_for_byte(humidity, temperature):
    expected = -2 * kelvin_radius(humidity, temperature)
    assert meniscus_height(humidity, temperature) == expected
    assert meniscus_height(humidity, temperature, (0.0, 0.0)) == expected


def test_solids_may_be_exchanged_and_one_that_does_not_wet_may_be_outweighed():
    heights = [meniscus_height(0.67, 300, pair) for pair in ((0.3, 1.9), (1.9, 0.3))]
    assert heights[0] == heights[1] > 0


@pytest.mark.parametrize("second", [np.radians(120), np.radians(150)])
def test_between_flats_that_do_not_wet_no_water_condenses(second):
    with pytest.raises(ValueError, match=f"angles of 61 and {np.degrees(second):.3g} degrees"):
        meniscus_height(0.67, 300, (np.radians(61), second))


@pytest.mark.parametrize("humidity", [np.nan, -0.5, -1e-9, 1.0, 67, "0.67", None])
@pytest.mark.parametrize("angles", [(0.0, 0.0), (np.pi / 2, np.pi / 2)])
def test_what_is_no_humidity_is_not_that_of_dry_air(humidity, angles):
    with pytest.raises(ValueError, match=f"must be 0, in dry air, or above 0 and below 1, got {humidity}"):
        film(humidity, 300.0, angles)


@pytest.mark.parametrize(("humidity", "angles"), [(0.0, (0.0, 0.0)), (0.9, (np.pi / 2, np.pi / 2)), (0.2, (3.0, 2.0))])
def test_in_dry_air_and_between_flats_that_water_does_not_wet_there_is_no_film(humidity, angles):
    assert film(humidity, 300.0, angles) == (0.0, 0.0)


@given(humidities, temperatures)
def test_vapour_over_the_meniscus_obeys_kelvins_equation(humidity, temperature):
    radius = kelvin_radius(humidity, temperature)
    vapour = np.exp(surface_energy(temperature) * molar_volume(temperature) / (GAS_CONSTANT * temperature * radius))
    np.testing.assert_allclose(vapour, humidity, rtol=ROUNDING)


@given(humidities, humidities, temperatures)
def test_tension_adds_up_when_humidities_multiply(first, second, temperature):
    together = laplace_pressure(first * second, temperature)
    apart = laplace_pressure(first, temperature) + laplace_pressure(second, temperature)
    np.testing.assert_allclose(together, apart, rtol=ROUNDING)


def test_meniscus_grows_and_its_tension_vanishes_as_the_air_saturates():
    humidity = np.linspace(0.05, 0.999, 50)
    assert np.all(np.diff(meniscus_height(humidity, 300)) > 0)
    assert np.all(np.diff(laplace_pressure(humidity, 300)) > 0)
    dryness = 1e-6
    ideal = -GAS_CONSTANT * 300 * dryness / WATER_MOLAR_VOLUME
    np.testing.assert_allclose(laplace_pressure(1 - dryness, 300), ideal, rtol=dryness)  # ln(1 - x) = -x - x²/2


def test_water_always_attracts():
    humidity = np.array([[0.01, 0.5], [0.9, 0.999]])
    assert laplace_pressure(humidity, 300).shape == (2, 2)
    assert np.all(laplace_pressure(humidity, 300) < 0)
    assert np.all(meniscus_height(humidity, 300) > 0)


@pytest.mark.parametrize("humidity", [0.0, 1.0, -0.1, 1.5, float("nan"), [0.5, 1.0]])
def test_humidity_outside_the_open_interval_is_refused_with_its_value(humidity):
    shown = str(np.ravel(humidity)[-1]).removesuffix(".0")
    with pytest.raises(ValueError, match=rf"\(0, 1\), got .*{shown}"):
        laplace_pressure(humidity, 300)


@given(temperatures, angles, angles)
def test_in_the_driest_air_the_film_is_three_molecules_thick(temperature, first, second):
    least = least_humidity(temperature, (first, second))
    np.testing.assert_allclose(meniscus_height(least, temperature, (first, second)), 3 * WATER_MOLECULE, rtol=1e-9)


def test_the_driest_air_is_wetter_where_water_wets_less_and_where_it_is_warm():
    assert round(least_humidity(300), 3) == 0.290  # by hand: exp(-2 x 0.5196 nm / 0.84 nm)
    of_angles = [least_humidity(300, (np.radians(angle), np.radians(angle))) for angle in (0, 40, 60, 80)]
    assert np.all(np.diff(of_angles) > 0.05)
    assert least_humidity(300) < least_humidity(320) < least_humidity(370)


@pytest.mark.parametrize("humidity", [0.001, 0.01, 0.0244])
def test_water_in_air_that_is_too_dry_is_refused_with_the_limit(humidity):
    # Below three molecules the tension of the film exceeds what any experiment found water to bear, 140 to 180 MPa.
    assert laplace_pressure(0.2903, 300) > -180e6
    with pytest.raises(ValueError, match=f"humidity of {humidity} must be at least 0.0245: .* 300 K .* 0 and 0 deg"):
        film(humidity, 300.0)
    assert meniscus_height(0.0245, 300.0) == pytest.approx(WATER_MOLECULE, rel=1e-3)
    assert film(0.0245, 300.0)[1] == STRENGTH
    assert "at least 0.2903" in dry_air(0.0245, 300.0)
    assert dry_air(0.2903, 300.0) is None
    assert "at least 0.8067" in dry_air(0.67, 300.0, (np.radians(80), np.radians(80)))


# Density: CRC Handbook (ITS-90) at atmospheric pressure; surface tension: table of IAPWS R1-76(2014).
@pytest.mark.parametrize(
    ("celsius", "density", "tension"),
    [
        (0.01, 999.84, 75.65),
        (20, 998.21, 72.74),
        (25, 997.05, 71.97),
        (30, 995.65, 71.19),
        (50, 988.04, 67.94),
        (80, 971.80, 62.67),
        (100, 958.36, 58.91),
    ],
)
def test_density_and_surface_tension_are_the_tabulated_ones(celsius, density, tension):
    # Kell's temperatures are those of IPTS-68, up to 0.026 K higher at 100 °C: 0.02 kg/m³.
    assert tabulated_density(celsius + 273.15) == pytest.approx(density, abs=0.02)
    assert 1e3 * tabulated_surface_tension(celsius + 273.15) == pytest.approx(
        tension, abs=0.006
    )  # rounding of the table


def test_water_at_300_kelvin_is_exactly_that_of_the_paper():
    assert surface_energy(300) == WATER_SURFACE_ENERGY
    assert molar_volume(300) == WATER_MOLAR_VOLUME
    # The paper's values are rounded: the correlations agree with them within half a percent.
    assert tabulated_surface_tension(300) == pytest.approx(WATER_SURFACE_ENERGY, rel=0.005)
    assert 18.01528e-3 / tabulated_density(300) == pytest.approx(WATER_MOLAR_VOLUME, rel=0.005)


@given(temperatures, temperatures)
def test_ratios_between_temperatures_are_those_of_the_tables(first, second):
    energies, volumes = ([function(at) for at in (first, second)] for function in (surface_energy, molar_volume))
    tensions, densities = (
        [function(at) for at in (first, second)] for function in (tabulated_surface_tension, tabulated_density)
    )
    assert energies[0] / energies[1] == pytest.approx(tensions[0] / tensions[1], rel=ROUNDING)
    assert volumes[0] / volumes[1] == pytest.approx(densities[1] / densities[0], rel=ROUNDING)


def test_warm_water_pulls_less_and_takes_more_room_beyond_its_greatest_density():
    temperature = np.linspace(273, 373, 201)
    assert np.all(np.diff([surface_energy(at) for at in temperature]) < 0)
    volume = np.array([molar_volume(at) for at in temperature])
    densest = 273.15 + 3.98
    assert temperature[volume.argmin()] == pytest.approx(densest, abs=0.5)
    assert np.all(np.diff(volume[temperature > densest]) > 0)
    assert np.all(np.diff(volume[temperature < densest]) < 0)


@pytest.mark.parametrize("wet", [(0.0, 0.0), (0.3, 0.9)])
def test_flats_in_saturated_air_have_the_surface_energy_times_the_cosines(wet):
    assert flooded_energy(300.0, wet) == pytest.approx(WATER_SURFACE_ENERGY * np.sum(np.cos(wet)), rel=1e-12)


def test_the_pull_of_a_film_on_flats_grows_in_drier_air_beyond_that_of_both_neighbours():
    """Between dry air, without a film, and the driest allowed air, a film would pull harder than either."""
    driest = least_humidity(300.0)
    pull = {humidity: -float(laplace_pressure(humidity, 300.0)) for humidity in (driest / 2, driest, 0.5, 0.9)}
    assert list(pull.values()) == sorted(pull.values(), reverse=True)
    # The second route: work to raise the film's height of water out of its vapour, γ cosθ₁ + γ cosθ₂ for any height.
    for humidity, pressure in pull.items():
        assert pressure * float(meniscus_height(humidity, 300.0)) == pytest.approx(2 * WATER_SURFACE_ENERGY, rel=1e-9)
    assert dry_air(driest, 300.0) is None


#: Vapour pressure of water by temperature [°C, Pa]; CRC Handbook of Chemistry and Physics, steam tables.
STEAM = {0.01: 611.7, 20: 2339.3, 50: 12352, 85: 57867, 100: 101418}


@pytest.mark.parametrize("celsius", STEAM)
def test_vapour_pressure_is_that_of_steam_tables(celsius):
    assert vapour_pressure(celsius + 273.15) == pytest.approx(STEAM[celsius], rel=1e-4)


@given(st.floats(-40, 60))
def test_vapour_pressure_is_that_of_magnus(celsius):
    """Magnus' formula with the constants of the WMO errs by 0.3 % to 0.5 % from -40 to 60 °C."""
    magnus = 611.2 * np.exp(17.62 * celsius / (243.12 + celsius))
    assert vapour_pressure(celsius + 273.15) == pytest.approx(magnus, rel=5e-3)


@given(st.floats(260, 370), st.floats(0.1, 60))
def test_air_at_its_dew_point_is_saturated_and_warmer_air_is_drier(dew_point, warmer):
    assert humidity_at(dew_point, dew_point) == pytest.approx(1, rel=1e-12)
    assert humidity_at(dew_point + warmer, dew_point) < 1 < humidity_at(dew_point - 5, dew_point)
    # Clausius and Clapeyron: a heat of vaporisation of 38 to 48 kJ/mol between 200 and 430 K
    heat = (
        -GAS_CONSTANT * np.log(humidity_at(dew_point + warmer, dew_point)) / (1 / dew_point - 1 / (dew_point + warmer))
    )
    assert 38e3 < heat < 48e3

"""Constants against sources other than the paper: a wrong factor would otherwise enter all results alike."""

import numpy as np
from numpy.testing import assert_allclose
from scipy import constants as codata

from stiction.constants import (
    DENSITY,
    FREE_FALL,
    GAS_CONSTANT,
    HAMAKER_CONSTANT,
    HARDNESS,
    LIQUIDS,
    MOLECULAR_DISTANCE,
    VACUUM_PERMITTIVITY,
    WATER_MOLAR_VOLUME,
    WATER_SURFACE_ENERGY,
)


def test_the_gas_constant_is_that_of_boltzmann_for_a_mole():
    assert_allclose(GAS_CONSTANT, codata.Boltzmann * codata.Avogadro, rtol=1e-15)


def test_water_has_its_density():
    # 18.015 g/mol and 996.5 kg/m³ at 300 K.
    assert_allclose(WATER_MOLAR_VOLUME, 18.015e-3 / 996.5, rtol=0.01)


def test_water_has_its_surface_energy():
    # IAPWS, 300 K: 235.8 mN/m · τ^1.256 · (1 - 0.625 τ) with τ = 1 - T / 647.096 K.
    tau = 1 - 300 / 647.096
    assert_allclose(WATER_SURFACE_ENERGY, 0.2358 * tau**1.256 * (1 - 0.625 * tau), rtol=0.01)


def test_silicon_attracts_itself_as_its_index_of_refraction_says():
    # Tabor and Winterton: an index of 3.42 and electrons that absorb at 4.3 eV, the strongest line of silicon.
    frequency, index = 4.3 * codata.e / codata.h, 3.42**2
    lifshitz = 3 * codata.h * frequency / (16 * np.sqrt(2)) * (index - 1) ** 2 / (index + 1) ** 1.5
    assert_allclose(HAMAKER_CONSTANT["dry"], lifshitz, rtol=0.3)
    assert 0.4 < HAMAKER_CONSTANT["water"] / HAMAKER_CONSTANT["dry"] < 1


def test_molecules_of_silicon_touch_at_about_the_length_of_a_bond():
    assert_allclose(MOLECULAR_DISTANCE, 2.35e-10, rtol=0.2)


def test_silicon_is_as_hard_as_it_is_indented():
    # Indentation of silicon transforms it at 11 to 13 GPa.
    assert 10e9 < HARDNESS < 14e9


def test_liquids_and_silicon_have_the_constants_of_other_sources():
    # IAPWS for water as above. Isopropanol at 298 K, 20.93 mN/m (CRC Handbook): a warmer liquid pulls less.
    assert 0.0209 < LIQUIDS["isopropanol"] < 0.0225
    assert LIQUIDS["water"] == WATER_SURFACE_ENERGY
    # Eight atoms of 28.0855 u in a cell of 0.54310 nm.
    assert_allclose(DENSITY, 8 * 28.0855e-3 / codata.Avogadro / 0.54310e-9**3, rtol=1e-3)
    assert_allclose([VACUUM_PERMITTIVITY, FREE_FALL], [codata.epsilon_0, codata.g], rtol=1e-9)

"""The model of Greenwood and Williamson has its limits: rigid spheres, its scaling with the density, its plasticity."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.analysis.greenwood import GreenwoodWilliamson
from stiction.contact.meniscus import film, flooded_energy

MODEL = GreenwoodWilliamson(density=20.9e12, radius=0.84e-6, rms=3.4e-9, modulus=86.6e9)
WATER = film(0.67, 300.0)


def test_summits_of_equal_height_are_spheres_with_menisci():
    height, tension = WATER
    rigid = replace(MODEL, rms=1e-3 * height, modulus=1e18)
    # Water pulls from contact to the height of the film: N |ΔP| 2πR ∫ (h - g) dg.
    expected = MODEL.density * tension * np.pi * MODEL.radius * height**2
    assert_allclose(rigid.energy(WATER), expected, rtol=0.03)


def test_energy_grows_with_density_humidity_and_softness_and_falls_with_roughness():
    energy = MODEL.energy(WATER)
    assert_allclose(replace(MODEL, density=2 * MODEL.density).energy(WATER), 2 * energy)
    assert MODEL.energy(film(0.8, 300.0)) > energy
    assert replace(MODEL, modulus=MODEL.modulus / 4).energy(WATER) > energy
    assert replace(MODEL, rms=2 * MODEL.rms).energy(WATER) < energy


def test_force_is_that_of_hertz_summed_over_normal_heights():
    distance = np.array([2 * MODEL.rms])
    force = MODEL.force(distance, (0.0, 0.0))[0]
    height = np.random.default_rng(0).normal(0, MODEL.rms, 400_000)
    carried = 4 / 3 * MODEL.modulus * np.sqrt(MODEL.radius) * np.maximum(height - distance, 0) ** 1.5
    error = MODEL.density * carried.std() / np.sqrt(len(height))
    assert abs(force - MODEL.density * carried.mean()) < 4 * error


def test_menisci_never_merge_so_that_the_energy_has_no_upper_limit():
    wet = film(0.97, 300.0)
    assert MODEL.energy(wet) > flooded_energy(300.0)


def test_plasticity_index_is_that_of_the_definition():
    assert MODEL.plasticity_index(12.8e9) == pytest.approx(86.6 / 12.8 * np.sqrt(3.4e-3 / 0.84))

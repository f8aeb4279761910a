"""The model of Greenwood and Williamson has its limits: rigid spheres, its scaling with the density, its plasticity."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm

from stiction.analysis.greenwood import ADHERE, BOND, GreenwoodWilliamson
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


# Adhesion parameter, w = 0.1 J/m²


def test_the_parameter_of_maugis_is_a_power_of_the_adhesion_parameter_and_of_no_other():
    rng, ratios, others = np.random.default_rng(1), [], []
    for _ in range(20):
        radius, rms, modulus, work = np.exp(rng.normal(0, 1, 4)) * [1e-6, 3e-9, 1e11, 0.1]
        # Δc = (4σ/3) (4E* / (3π R^½ Δγ))^⅔; D. Maugis, J. Adhes. Sci. Technol. 10, 161 (1996)
        maugis = 4 * rms / 3 * (4 * modulus / (3 * np.pi * np.sqrt(radius) * work)) ** (2 / 3)
        found = replace(MODEL, radius=radius, rms=rms, modulus=modulus).adhesion_parameter(work)
        ratios.append(maugis / found ** (2 / 3))
        others.append(maugis / found)
    assert_allclose(ratios, 4 / 3 * (4 / (3 * np.pi)) ** (2 / 3))
    assert np.ptp(np.log(others)) > 1  # control


def remaining(model, work):
    """Largest pull of summits of JKR with normal heights, over that of summits of equal height.

    The branch of one summit by its contact radius a: J. A. Greenwood, Tribol. Lett. 65, 159 (2017), Eq. (1).
    """
    radius, modulus = model.radius, model.modulus
    a = np.linspace(1e-4, 12, 6000) * (radius**2 * work / modulus) ** (1 / 3)
    overlap = a**2 / radius - np.sqrt(2 * np.pi * a * work / modulus)
    load = 4 / 3 * modulus * a**3 / radius - np.sqrt(8 * np.pi * modulus * work * a**3)
    stable = slice(int(np.argmin(overlap)), None)
    z = np.linspace(-5, 5, 4001) * model.rms
    weights = norm.pdf(z / model.rms) / norm.pdf(z / model.rms).sum()
    distances = np.linspace(-4, 4, 161) * model.rms
    forces = [weights @ np.interp(z - d, overlap[stable], load[stable], left=0.0) for d in distances]
    return -min(forces) / (1.5 * np.pi * work * radius)


def test_the_adhesion_parameter_alone_decides_how_much_of_the_pull_off_force_remains():
    work = 0.1
    for wanted in (0.1, 1.0, 4.0):
        modulus = wanted / MODEL.adhesion_parameter(work) * MODEL.modulus
        model = replace(MODEL, modulus=modulus)
        other = replace(model, radius=8 * model.radius, rms=2 * model.rms)  # σ³/R is the same
        assert_allclose(other.adhesion_parameter(work), wanted)
        assert_allclose(remaining(other, work), remaining(model, work), rtol=2e-3)
        assert remaining(replace(model, rms=2 * model.rms), work) < 0.98 * remaining(model, work)  # control


def test_wafers_that_bond_keep_most_of_their_adhesion_and_those_that_do_not_adhere_keep_little():
    def at(parameter):
        return remaining(replace(MODEL, modulus=parameter / MODEL.adhesion_parameter(0.1) * MODEL.modulus), 0.1)

    assert at(BOND) > 0.5
    assert at(ADHERE) < 0.05

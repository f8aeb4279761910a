from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, uniform_laws
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.release import crack_length, release
from stiction.contact import forcelaw
from stiction.devices import bridges

BEAM = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 160)


def detachment_length(energy, half):
    """Length of a bridge on uniform ground that is about to come free, two equal cracks [m]."""
    return bridges.sticking_lengths(np.full(2, arrest_length(energy, half)))[0]


def test_without_stress_the_detachment_length_is_that_of_two_s_shapes():
    # Mastrangelo and Hsu: 24 E t³ h² / (W L⁴) = 1, exact for two S-shapes back to back.
    length = detachment_length(6e-3, BEAM)
    assert_allclose(24 * BEAM.young_modulus * BEAM.thickness**3 * BEAM.gap**2 / (6e-3 * length**4), 1, rtol=1e-12)


def test_under_high_stress_the_detachment_length_is_that_of_a_string():
    # G = σ t h² / (2 s²), L = 2 s
    half = bridges.half_of_bridge(BEAM, 1e14)
    length = detachment_length(1e3, half)
    assert_allclose(length, 2 * np.sqrt(1e14 * BEAM.thickness * BEAM.gap**2 / (2 * 1e3)), rtol=0.01)


def test_stress_lets_longer_bridges_come_free():
    lengths = [detachment_length(6.165e-3, bridges.half_of_bridge(BEAM, s)) for s in (0, 10e6, 200e6)]
    assert_allclose(lengths, 2 * np.array([189.03e-6, 199.67e-6, 393.29e-6]), rtol=5e-5)  # G = e solved by hand
    assert lengths[0] < lengths[1] < lengths[2]


def test_tension_is_the_stress_times_the_cross_section():
    assert_allclose(bridges.half_of_bridge(BEAM, 50e6).tension, 50e6 * 60e-12, rtol=1e-14)
    assert bridges.half_of_bridge(BEAM, 0) == BEAM


def test_a_uniform_bridge_by_finite_elements_is_its_closed_form():
    half, laws = bridges.half_of_bridge(BEAM, 50e6), uniform_laws(800)
    crack = crack_length(half, laws, release(half, laws, 60e-6).deflection)
    assert_allclose(2 * crack, detachment_length(float(forcelaw.energy(laws[0])), half), rtol=0.015)


def test_cracks_are_paired_in_their_order():
    assert_array_equal(bridges.sticking_lengths(np.array([1.0, 2.0, 10.0, 20.0])), [3.0, 30.0])


def test_lengths_of_bridges_scatter_like_the_sum_of_two_independent_cracks():
    cracks = np.random.default_rng(0).normal(200, 10, 8000)
    lengths = bridges.sticking_lengths(cracks)
    error = 1 / np.sqrt(2 * len(lengths))
    assert abs(lengths.std() / (10 * np.sqrt(2)) - 1) < 4 * error
    assert abs(lengths.std() / 20 - 1) > 4 * error  # control: twice the same crack


def test_an_odd_number_of_cracks_and_compression_are_refused():
    with pytest.raises(ValueError, match="two cracks each, got 3"):
        bridges.sticking_lengths(np.ones(3))
    with pytest.raises(ValueError, match="-5 MPa is compressive"):
        bridges.half_of_bridge(PAPER, -5e6)
    with pytest.raises(ValueError, match="compressive"):
        bridges.half_of_bridge(replace(PAPER), float("nan"))

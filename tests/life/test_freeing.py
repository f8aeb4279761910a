"""What frees a device: forces as derivatives of energies, shocks, and touchdowns by brute force."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.beam.cantilever import Beam
from stiction.devices.arcs import arc_length, bending_force, tip_slope
from stiction.life.freeing import force_at_contact, freeing_acceleration, probability_for, stuck_after

BEAM = Beam(300e-6, 30e-6, 2e-6, 164e9, 2e-6, 1)


def test_the_force_of_a_cantilever_bends_its_tip_to_the_slope_of_an_arc():
    assert_allclose(force_at_contact(BEAM, 1), BEAM.width * bending_force(tip_slope(BEAM.length, BEAM.gap), BEAM))


@pytest.mark.parametrize("clamps", [1, 2])
def test_the_work_of_the_force_on_the_gap_is_the_energy_of_the_bent_beam(clamps):
    # 3 EI h² / 2 L³ of a cantilever; a bridge under a force in its middle has the stiffness 192 EI / L³.
    energy = {1: 1.5, 2: 96.0}[clamps] * BEAM.bending_stiffness * BEAM.gap**2 / BEAM.length**3
    assert_allclose(force_at_contact(BEAM, clamps) * BEAM.gap / 2, energy, rtol=1e-9)


def test_a_beam_of_the_longest_free_length_is_held_by_a_wedge_of_this_force():
    energy = 5e-3
    beam = replace(BEAM, length=float(arc_length(energy, BEAM)))
    assert_allclose(force_at_contact(beam, 1), beam.width * energy / tip_slope(beam.length, beam.gap), rtol=1e-9)


def test_a_shock_adds_exactly_what_the_spring_lacks():
    force, mass = 20e-6, 2e-9
    for hold in np.linspace(0, 60e-6, 7):
        shock = freeing_acceleration(hold, force, mass)
        assert force + mass * shock >= hold * (1 - 1e-12)
        assert shock == 0 or force + 0.999 * mass * shock < hold


def test_devices_that_meet_other_summits_each_time_stick_as_often_as_the_formula_says():
    rng, touchdowns, devices = np.random.default_rng(5), 30, 20_000
    probability = 0.02
    independent = (rng.random((devices, touchdowns)) < probability).any(axis=1).mean()
    same = (rng.random((devices, 1)) < probability).repeat(touchdowns, axis=1).any(axis=1).mean()
    expected = stuck_after(probability, touchdowns)
    error = (expected * (1 - expected) / devices) ** 0.5
    assert abs(independent - expected) < 4 * error
    assert abs(same - probability) < 4 * error < abs(same - expected)


def test_devices_with_something_in_common_are_between_both_bounds():
    rng, touchdowns, devices, probability = np.random.default_rng(6), 20, 40_000, 0.05
    own, common = rng.standard_normal((devices, touchdowns)), rng.standard_normal((devices, 1))
    level = -1.6448536  # of which a fraction of 0.05 lies below
    stuck = [((c**0.5 * common + (1 - c) ** 0.5 * own) < level).any(axis=1).mean() for c in (0.0, 0.3, 0.7, 1.0)]
    assert np.all(np.diff(stuck) < 0)
    assert_allclose([stuck[0], stuck[-1]], [stuck_after(probability, touchdowns), probability], rtol=0.05)


@pytest.mark.parametrize("touchdowns", [1, 10, 10**9])
@pytest.mark.parametrize("stuck", [1e-9, 1e-3, 0.5])
def test_a_probability_of_one_touchdown_gives_the_fraction_after_all(stuck, touchdowns):
    assert_allclose(stuck_after(probability_for(stuck, touchdowns), touchdowns), stuck, rtol=1e-9)
    assert probability_for(stuck, touchdowns) <= stuck * (1 + 1e-12)


def test_a_device_that_always_sticks_sticks():
    assert stuck_after(1.0, 1) == stuck_after(1.0, 1000) == 1
    assert stuck_after(0.0, 1000) == 0

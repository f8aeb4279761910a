"""Descent in the energy of a strip: the states of turns where they settle, and states where they do not."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from test_deformed_gaps import DRY
from test_elements import NM, NONE, E, by_summits, other_model, rough, space_of

from stiction.contact.full import descent, elements
from stiction.contact.full.elements import Adhesion, separation
from stiction.contact.full.halfspace import SPRINGS, periodic_waves
from stiction.contact.vanderwaals import attraction
from stiction.errors import NotConverged
from stiction.stages.contact.full_contact import StripInAir, separated

SOLIDS = attraction("dry")
#: Half the modulus makes the strip, much shorter than those of stages, as soft as long ones.
SOFT = space_of(modulus=E / 2)


def dry(space, hamaker=1.0):
    """Attraction in dry air, touching and across gaps, with a multiple of the Hamaker constant."""
    constants = {medium: hamaker * each for medium, each in DRY.gaps.hamaker_constant.items()}
    solids = replace(SOLIDS, hamaker_constant=hamaker * SOLIDS.hamaker_constant)
    return Adhesion.from_film((0.0, 0.0), solids, space, replace(DRY.gaps, hamaker_constant=constants))


def smooth(rms):
    """Strip scaled to an rms [nm]."""
    return (rms * NM / rough().std() * rough()).astype(np.float32)


def led(rms):
    """Curve of another model for a strip of an rms [nm]."""
    return other_model(rms * NM, 2 * rms * NM)


@cache
def found(rms=0.6):
    return separation(SOFT, smooth(rms), dry(SOFT), led(rms), descent.equilibrium)


# Beside turns


@pytest.mark.parametrize("rms", [None, 1.0])
def test_descent_finds_the_energy_and_the_force_of_turns_where_they_settle(rms):
    """On a strip of the paper's pair b, and a smoother and softer one."""
    space, z, curve = (SOFT, smooth(rms), led(rms)) if rms else (space_of(), rough(), by_summits(0, 0.45)[2])
    turns = separation(space, z, dry(space), curve)
    by_descent = separation(space, z, dry(space), curve, descent.equilibrium)
    assert by_descent.adhesion_energy == pytest.approx(turns.adhesion_energy, rel=5e-3)
    assert by_descent.pull_off == pytest.approx(turns.pull_off, rel=0.03)
    more = separation(space, z, dry(space, 1.2), curve, descent.equilibrium)
    assert more.adhesion_energy > 1.1 * turns.adhesion_energy
    assert more.pull_off > 1.03 * turns.pull_off


def test_descent_settles_on_a_smooth_strip_where_turns_do_not():
    with pytest.raises(NotConverged, match="full elastic contact does not settle"):
        separation(SOFT, smooth(0.6), dry(SOFT), led(0.6))
    assert 0.3 < found().adhesion_energy / SOLIDS.work_of_adhesion < 0.6
    assert found().pull_off > 5 * abs(found().closed.force)


def test_without_attraction_the_contact_is_that_of_turns_and_nothing_adheres():
    for distance in (1.0 * NM, 3.0 * NM):
        turns = elements.equilibrium(space_of(), rough(), distance)
        by_descent = descent.equilibrium(space_of(), rough(), distance, NONE)
        assert by_descent.force == pytest.approx(turns.force, rel=5e-3)
        assert by_descent.energy(rough(), NONE) > 0
    with pytest.raises(ValueError, match="finds no distance"):
        separation(space_of(), rough(), NONE, led(1.0), descent.equilibrium)


# Equilibrium


def test_a_state_of_descent_is_in_equilibrium():
    state, z = found().closed, smooth(0.6)
    assert np.all(state.gap >= 0)
    assert np.all(state.pressure >= 0)
    assert not np.any(state.pressure * state.gap)
    assert 0.1 < np.mean(state.pressure > 0) < 0.9
    assert state.gap.mean(dtype=float) == pytest.approx(state.distance - z.mean(dtype=float), rel=1e-5)
    assert_array_equal(state.attraction, dry(SOFT).traction(state.gap))
    traction = SOFT.traction(state.gap - (np.float32(state.distance) - z))
    left = np.abs(state.pressure - state.attraction - state.force - traction).mean()
    assert left < 2 * descent.SETTLED * state.attraction.mean()
    wrong = np.abs(state.pressure + state.attraction - state.force - traction).mean()
    assert wrong > 100 * left


def test_the_force_is_the_slope_of_the_energy_over_the_distance():
    """Jumps into other states lower the energy, and lie between a few of the distances."""
    z, own, step = smooth(0.6), dry(SOFT), 0.002 * NM
    states = [found().closed]
    for _ in range(25):
        at = states[-1].distance + step
        states.append(descent.equilibrium(SOFT, z, at, own, states[-1], coarser=0.05))
    energies, forces = np.array([(state.energy(z, own), state.force) for state in states[1:]]).T
    ratios = (energies[2:] - energies[:-2]) / (2 * step) / -forces[1:-1]
    assert np.median(ratios) == pytest.approx(1, abs=0.02)
    assert np.all(ratios < 1.03)
    attracting = np.array([own.energy(state.gap).mean() for state in states[1:]])
    assert np.median((attracting[2:] - attracting[:-2]) / (2 * step) / -forces[1:-1]) > 1.2  # without the elastic one


# Limits


def test_flats_need_the_work_of_flats():
    flat = np.zeros((16, 24), np.float32)
    space = replace(SOFT, shape=flat.shape)
    closed, _ = elements.at_rest(space, flat, dry(space), led(0.1), descent.equilibrium)
    assert -closed.energy(flat, dry(space)) == pytest.approx(SOLIDS.work_of_adhesion, rel=1e-6)
    for distance in (0.1 * NM, 3 * NM):
        state = descent.equilibrium(space, flat, distance, dry(space))
        assert_allclose(state.gap, distance, rtol=1e-6)
        assert state.force == pytest.approx(-float(dry(space).traction(np.array(distance))), rel=1e-5)


@pytest.mark.parametrize("rms", [0.02, 0.05])
def test_very_smooth_surfaces_close_and_store_the_energy_that_flattens_them(rms):
    z, waves = smooth(rms).astype(float), SOFT.unit * periodic_waves(SOFT.shape)
    waves[0, 0] = np.inf
    stored = 0.5 * np.mean(z * np.fft.irfft2(np.fft.rfft2(z) / waves, s=z.shape))
    closed = found(rms).closed
    assert not closed.gap.any()
    assert closed.force == pytest.approx(0, abs=1e-6 * SOLIDS.stress)
    assert found(rms).adhesion_energy == pytest.approx(SOLIDS.work_of_adhesion - stored, rel=1e-5)
    assert stored > 5e-4 * SOLIDS.work_of_adhesion


def test_a_rougher_strip_closes_only_under_a_force():
    z = smooth(0.6)
    state = descent.equilibrium(SOFT, z, float(z.mean()) - 1 * NM, dry(SOFT))
    assert not state.gap.any()
    assert state.force > 0
    assert state.pressure.min() == 0
    near = descent.equilibrium(SOFT, z, float(z.mean(dtype=float)) + 1e-3 * NM, dry(SOFT))
    assert 0.3 * state.force < near.force < state.force


# Steps


def test_a_step_ends_at_the_nearest_gaps_of_the_mean():
    rng = np.random.default_rng(4)
    gap, step, mean = rng.exponential(1.0, (20, 30)), 1.5, 1.2
    down, gradient = rng.normal(0, 1, (2, 20, 30))
    way, slope = descent._way(gap, down, step, gradient, mean)
    ahead = gap + way
    assert ahead.mean() == pytest.approx(mean, rel=1e-8)
    assert np.all(ahead >= 0)
    shifts = gap - step * down - ahead
    shift = shifts[ahead > 0].mean()
    assert_allclose(shifts[ahead > 0], shift, atol=1e-9)
    assert np.all(shifts[ahead == 0] <= shift)
    assert slope == pytest.approx(np.mean(gradient * way))


def test_the_length_of_a_step_is_the_inverse_of_a_constant_curvature():
    """A curvature of 4 that smoothing divides by 2."""
    rng = np.random.default_rng(5)
    moved, rest = rng.normal(0, 1, (2, 20, 30))
    assert descent._step(moved, rest, rest / 2, rest + 4 * moved, (rest + 4 * moved) / 2) == pytest.approx(0.5)
    assert descent._step(moved, rest, rest / 2, rest - 4 * moved, (rest - 4 * moved) / 2) == descent.FIRST
    nearly_flat = rest + 0.01 * moved
    assert descent._step(moved, rest, rest / 2, nearly_flat, nearly_flat / 2) == descent.LONGEST


def test_only_elements_that_are_open_or_about_to_open_move():
    gap = np.array([[1.0, 2.0, 0.0, 0.0]])
    gradient = np.float32([[5.0, -1.0, 3.0, -9.0]])
    free = descent._among_free(gradient, gap, gradient, 2.0)
    assert_allclose(free, [[5 + 5 / 3, -1 + 5 / 3, 0, -9 + 5 / 3]], rtol=1e-6)


def test_the_displacement_on_springs_is_that_of_the_half_space_and_of_the_springs_in_parallel():
    pressure = np.random.default_rng(6).normal(0, 1e6, SOFT.shape).astype(np.float32)
    moved = SOFT.displacement_on_springs(pressure)
    springs = moved / (SPRINGS * SOFT.unit)
    assert_allclose(SOFT.traction(moved) + springs, pressure, atol=1e-3 * np.abs(pressure).max())
    assert moved.std() < SOFT.displacement(pressure).std()
    even = np.full(SOFT.shape, 1e6, np.float32)
    assert_allclose(SOFT.displacement_on_springs(even), SPRINGS * SOFT.unit * even, rtol=1e-5)


def test_a_descent_without_enough_steps_is_refused(monkeypatch):
    monkeypatch.setattr(descent, "STEPS", 3)
    with pytest.raises(NotConverged, match="does not settle by descent") as caught:
        descent.equilibrium(SOFT, smooth(0.6), 0.5 * NM, dry(SOFT))
    assert caught.value.args[1] > descent.SETTLED


# In the study


def test_the_study_descends_where_turns_do_not_settle():
    curve, z = led(0.6), smooth(0.6)
    by_study = separated(SOFT, z, StripInAir(dry(SOFT), curve, 0.0))
    assert by_study.adhesion_energy == found().adhesion_energy
    settles = StripInAir(dry(SOFT), led(1.0), 0.0)
    assert (
        separated(SOFT, smooth(1.0), settles).closed.turns == separation(SOFT, smooth(1.0), *settles[:2]).closed.turns
    )


# Under water


def wet(space):
    """Film of water of 1.5 nm, and solids that touch in it."""
    return Adhesion.from_film((1.5 * NM, 6e7), attraction("water"), space)


@pytest.mark.parametrize("rms", [1.0, 2.0])
def test_under_a_film_descent_finds_the_states_of_turns_where_they_settle(rms):
    z, curve = smooth(rms), led(rms)
    turns = separation(SOFT, z, wet(SOFT), curve)
    by_descent = separation(SOFT, z, wet(SOFT), curve, descent.equilibrium)
    assert by_descent.adhesion_energy == pytest.approx(turns.adhesion_energy, rel=2e-3)
    assert by_descent.pull_off == pytest.approx(turns.pull_off, rel=0.02)


def test_under_a_film_a_smooth_strip_settles_where_turns_do_not():
    z, curve = smooth(0.6), led(0.6)
    with pytest.raises((NotConverged, ValueError), match="full elastic contact"):
        separation(SOFT, z, wet(SOFT), curve)
    found = separated(SOFT, z, StripInAir(wet(SOFT), curve, 0.0))
    work = -float(wet(SOFT).energy(np.zeros(1))[0])
    assert 0.4 < found.adhesion_energy / work < 1
    state = found.closed
    traction = SOFT.traction(state.gap - (np.float32(state.distance) - z))
    left = np.abs(state.pressure - state.attraction - state.force - traction).mean()
    assert left < 2 * descent.SETTLED * state.attraction.mean()

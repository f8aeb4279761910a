"""Slopes and budget of devices on given vectors, and on the contact of a small study."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import small
from beams import PAPER
from numpy.testing import assert_allclose, assert_array_equal
from vectors import sampled_vectors

from stiction.contact import forcelaw
from stiction.designs import budget
from stiction.designs.budget import Input, Settings, State, Uncertainty
from stiction.designs.cracks import Device
from stiction.devices.budget import Budget, log_slope
from stiction.stages import curves, storage
from stiction.streams import stream

WATER = curves.Water(300.0)
VECTORS = sampled_vectors(400, spread=0.2)
C1 = Device("cantilever", "b", PAPER.thickness, PAPER.gap, PAPER.width, PAPER.young_modulus, 1.5e-6)
R1 = Device("bridge", "b", 2e-6, 2e-6, 30e-6, 164e9, 1.5e-6, residual_stress=50e6)
#: Forces and energies are multiplied by what a test passes as contact.
BASE = State(1.0, 0.67, WATER, C1, 9e-12)
BEAMS = partial(budget.of_beams, mesh=PAPER, strips=1000, number=100, address=lambda k: stream(1, k))
SETTINGS = Settings(1, WATER, 0.67, Uncertainty(), 164e9, C1, 24)


@pytest.fixture(autouse=True)
def given(monkeypatch, request):
    """Vectors of a pair as sampled contact, except where a test uses the small study."""
    if "study" in request.fixturenames:
        return

    def vectors(contact, *_):
        found = VECTORS * [contact, contact, 1, 1]
        return found, 1.1 * found[:, 1].max()

    monkeypatch.setattr(curves, "vectors", vectors)
    monkeypatch.setattr(curves, "pull_offs", lambda contact, *_: contact * VECTORS[:, 1])


@pytest.fixture
def study():
    """Contact of the small study."""
    return small.contact_of_pair()


def device(**factors):
    """State with some dimensions of the device multiplied."""
    return replace(BASE, device=replace(C1, **{name: getattr(C1, name) * by for name, by in factors.items()}))


def around(name, step, state):
    """Input whose logarithm is a step below and above."""
    return Input(name, name, (state(np.exp(-step)), state(np.exp(step))), 2 * step)


INPUTS = [
    around("energy", 0.1, lambda factor: replace(BASE, contact=factor)),
    around("thickness", 0.05, lambda factor: device(thickness=factor)),
    around("gap", 0.05, lambda factor: device(gap=factor)),
]


# Slopes


def test_slopes_of_a_beam_are_about_the_powers_of_eq_13():
    values, errors = budget.slopes(INPUTS, BEAMS).T
    assert np.all(np.abs(values - [-0.25, 0.75, 0.5]) < 4 * errors + 0.05)  # a longer crack has more places to stop
    assert np.all(errors < 0.06)


def test_three_joint_shifts_move_the_length_by_the_sum_of_their_effects():
    values, errors = budget.slopes(INPUTS, BEAMS).T
    shifts = np.array([-0.4, 0.08, 0.1])
    energy, thickness, gap = np.exp(shifts)
    both = BEAMS([BASE, replace(device(thickness=thickness, gap=gap), contact=energy)])
    found, error = log_slope(np.mean, *both.values, 1.0)
    error = np.hypot(error, np.linalg.norm(errors * shifts))
    assert abs(found - values @ shifts) < 4 * error
    assert abs(found - values[1:] @ shifts[1:]) > 4 * error  # control


def test_beams_at_several_states_meet_the_same_samples():
    both = BEAMS([BASE, BASE])
    assert_array_equal(both.values[0], both.values[1])
    assert_array_equal(both.shared[0], both.shared[1])
    less, more = BEAMS([BASE, replace(BASE, contact=1.001)]).values
    assert np.median(np.abs(less / more - 1)) < 0.003 < 0.1 * less.std() / less.mean() + 0.003


def test_only_samples_with_a_law_at_all_states_are_met():
    def drawn(spoilt):
        vectors = VECTORS.copy()
        vectors[spoilt, 0] *= 1e-3  # less than the energy of the left branch
        return vectors, 1.1 * VECTORS[:, 1].max()

    laws = budget.shared_laws([drawn(3), drawn(5)])
    assert [len(of_state) for of_state in laws] == [398, 398]
    assert_allclose(forcelaw.energy(laws[0]), np.delete(VECTORS[:, 0], [3, 5]), rtol=1e-12)


def test_the_error_of_a_slope_contains_that_of_the_samples_that_all_beams_share():
    found = BEAMS(INPUTS[0].states)
    scattered = replace(found, shared=found.shared * np.exp(np.random.default_rng(1).normal(size=found.shared.shape)))
    for case in (found, scattered):
        own, common = (log_slope(np.mean, *values, 0.2)[1] for values in (case.values, case.shared))
        assert_allclose(budget.slopes([INPUTS[0]], lambda _, case=case: case)[0, 1], np.hypot(own, 0.25 * common))


def test_stoppers_share_no_samples_and_their_force_is_that_of_their_area():
    area = around("area", 0.1, lambda factor: replace(BASE, area=9e-12 * factor))
    assert_allclose(budget.slopes([area], budget.of_stoppers)[0], [1, 0], atol=1e-12)
    assert_allclose(budget.of_stoppers([BASE]).values[0], 9e-12 * VECTORS[:, 1], rtol=1e-14)


def test_a_choice_of_the_model_changes_the_mean_by_its_effect():
    assert_allclose(budget.effect(BASE, replace(BASE, contact=2.0), budget.of_stoppers), [np.log(2), 0], atol=1e-12)
    assert_allclose(budget.effect(BASE, BASE, BEAMS), [0, 0], atol=1e-12)


def test_lengths_that_are_not_known_leave_the_median():
    assert budget.centre(np.array([1.0, 2, 9])) is np.mean
    assert budget.centre(np.array([1.0, 2, np.inf])) is np.median
    # A short beam on a weak ground has no S-shape.
    assert np.isinf(BEAMS([replace(BASE, contact=0.01)]).values).all()


def test_a_bridge_sticks_where_both_cracks_fit():
    assert_array_equal(budget.of_devices(np.array([1.0, 2, 3, 5]), R1), [3, 8])
    assert_array_equal(budget.of_devices(np.array([1.0, 2]), C1), [1, 2])
    assert_array_equal(budget.of_devices(np.array([1.0, 2]), None), [1, 2])


# Inputs


def inputs(stated, water=WATER, of=C1, modulus=None):
    """Uncertain inputs of a device without those of surfaces: name to its states, step and standard uncertainty."""
    settings = replace(SETTINGS, uncertainty=stated, device=of, water=water)
    state = replace(BASE, water=water, device=of)
    found, covariance = budget.uncertain(state, {}, modulus, {}, settings)
    return {entry.name: (entry, u) for entry, u in zip(found, np.sqrt(np.diag(covariance)), strict=True)}


def test_dimensions_are_changed_alone_and_around_their_values():
    found = inputs(Uncertainty(thickness=0.04e-6, gap=0.5e-6, residual_stress=10e6), of=R1)
    assert set(found) == {"thickness", "gap", "residual stress"}
    thickness, relative = found["thickness"]
    assert_allclose([state.device.thickness for state in thickness.states], [1.9e-6, 2.1e-6])
    assert_allclose([thickness.step, relative], [np.log(2.1 / 1.9), 0.02])
    stress, absolute = found["residual stress"]
    assert_allclose([state.device.residual_stress for state in stress.states], [40e6, 60e6])
    assert_allclose([stress.step, absolute], [20e6, 10e6])
    assert all(state.device.gap == 2e-6 for state in thickness.states)


def test_a_stress_or_an_angle_that_may_be_zero_errs_upwards_only():
    free = replace(R1, residual_stress=0.0)
    stress, deviation = inputs(Uncertainty(residual_stress=10e6), of=free)["residual stress"]
    assert_allclose([state.device.residual_stress for state in stress.states], [0, 10e6])
    assert_allclose([stress.step, deviation], [10e6, 10e6])
    angles, deviation = inputs(Uncertainty(contact_angle=0.2))["contact angles"]
    assert [state.water.contact_angles for state in angles.states] == [(0, 0), (0.2, 0.2)]
    assert_allclose([angles.step, deviation], [0.2, 0.2])
    both, _ = inputs(Uncertainty(contact_angle=0.2), replace(WATER, contact_angles=(0.5, 0.7)))["contact angles"]
    assert_allclose([state.water.contact_angles for state in both.states], [(0.3, 0.5), (0.7, 0.9)])
    assert_allclose(both.step, 0.4)


def test_air_is_changed_in_both_directions():
    found = inputs(Uncertainty(humidity=0.02, temperature=3.0), of=None)
    assert [state.humidity for state in found["humidity"][0].states] == pytest.approx([0.65, 0.69])
    assert [state.water.temperature for state in found["temperature"][0].states] == [297, 303]
    assert_allclose([found["humidity"][0].step, found["temperature"][0].step], [0.04, 6])
    assert_allclose([found["humidity"][1], found["temperature"][1]], [0.02, 3])


def test_youngs_modulus_changes_contact_and_beam_together():
    entry, deviation = inputs(Uncertainty(young_modulus=8.2e9), modulus=(0.9, 1.1))["Young's modulus"]
    assert [state.contact for state in entry.states] == [0.9, 1.1]
    assert_allclose([state.device.young_modulus for state in entry.states], [0.95 * 164e9, 1.05 * 164e9])
    assert_allclose([entry.step, deviation], [np.log(1.05 / 0.95), 0.05])
    stopper, _ = inputs(Uncertainty(young_modulus=8.2e9), of=None, modulus=(0.9, 1.1))["Young's modulus"]
    assert [state.device for state in stopper.states] == [None, None]


def test_a_stopper_has_no_dimensions_of_a_beam():
    assert set(inputs(Uncertainty(thickness=1e-7, gap=1e-7, residual_stress=1.0, humidity=0.01), of=None)) == {
        "humidity"
    }


def test_quantities_of_a_surface_keep_their_covariance_and_their_group(study):
    known = Budget(("mode2", "corner"), np.zeros(2), np.array([[4.0, 1], [1, 9]]))
    pair = tuple(study.assign(difference=((), 0.1)) for _ in range(2))
    shifted = {("B2", name): pair for name in known.names}
    settings = replace(SETTINGS, uncertainty=Uncertainty(humidity=0.1))
    found, matrix = budget.uncertain(BASE, shifted, None, {"B2": known}, settings)
    assert [entry.name for entry in found] == ["mode2 of B2", "corner of B2", "humidity"]
    assert [entry.group for entry in found] == ["the heights of B2", "the spectrum of B2", "the humidity"]
    assert [entry.step for entry in found[:2]] == [0.1, 0.1]
    assert_allclose(matrix, [[4, 1, 0], [1, 9, 0], [0, 0, 0.01]])


def test_one_scan_gives_the_covariance_of_its_closed_form():
    # 10 µm of B2: errors and correlation as of hundreds of drawn scans.
    found = budget.of_one_scan(*small.surfaces()[0], 10e-6)
    errors = np.sqrt(np.diag(found.covariance))
    assert_allclose(errors, [0.0161, 0.0433, 0.1416], rtol=0.02)
    assert_allclose(found.covariance[1, 2] / (errors[1] * errors[2]), -0.868, atol=0.01)
    assert_allclose(budget.of_one_scan(*small.surfaces()[0], 20e-6).covariance, found.covariance / 4, rtol=0.1)


# Whole budgets


def test_wetter_air_shortens_the_cracks_of_a_small_study(study):
    states = tuple(replace(BASE, contact=study, humidity=humidity) for humidity in (0.6, 0.74))
    value, error = budget.slopes([Input("humidity", "humidity", states, 0.14)], BEAMS)[0]
    assert value < -4 * error


def test_a_budget_of_a_small_study_has_the_devices_of_all_its_samples(study):
    stated = Uncertainty(gap=0.5e-6)
    settings = Settings(small.SEED, WATER, 0.67, stated, 164e9, R1, 4)
    changed = study.isel(sample=slice(10))
    found = budget.compute(study, {}, None, {"half": changed}, {}, settings)
    assert list(found.input.values) == ["gap"]
    state = budget.nominal(study, settings)
    cracks = budget.responder(state, settings)([state]).values[0]
    assert len(cracks) == 8
    assert_allclose(found["mean"], cracks.reshape(4, 2).sum(axis=1).mean(), rtol=1e-12)
    assert_allclose(found.effect, 0, atol=1e-12)  # the same samples
    assert found["mean"].attrs["units"] == "m"


def test_the_budget_of_a_stopper_is_one_of_its_forces(study):
    settings = Settings(small.SEED, WATER, 0.67, Uncertainty(humidity=0.01), 164e9, contact=(1.5e-6, 6e-6))
    found = budget.compute(study, {}, None, {}, {}, settings)
    assert found["mean"].attrs["units"] == "N"
    assert_allclose(found["mean"], curves.pull_offs(study, 0.67, WATER).mean() * 9e-12, rtol=1e-12)
    ends = [curves.pull_offs(study, h, WATER).mean() for h in (0.66, 0.68)]
    assert_allclose(found.slope, np.log(ends[1] / ends[0]) / 0.02, rtol=1e-9)


def test_a_budget_comes_back_from_its_file(tmp_path):
    covariance = np.diag([0.1, 0.02, 0.03]) ** 2
    entries = [replace(INPUTS[0], group="surface"), INPUTS[1], replace(INPUTS[2], group="surface")]
    given = np.array([[-0.25, 0.01], [0.75, 0.02], [0.5, 0.03]])
    made = budget.layout(entries, given, covariance, np.array([1.0, 2, 3]), {"dry": (0.04, 0.01)}, "m")
    storage.save(made, tmp_path / "C1.nc", "budget", {})
    found = storage.load(tmp_path / "C1.nc", "budget")
    assert budget.groups_of(found) == {"surface": ["energy", "gap"], "thickness": ["thickness"]}
    assert_allclose(budget.budget_of(found).total, np.sqrt(0.025**2 + 0.015**2 + 0.015**2), rtol=1e-12)
    assert_array_equal(found.slope_error, given[:, 1])
    assert_allclose([found["mean"], found.scatter], [2, 0.5], rtol=1e-12)
    assert_allclose([found.effect.sel(choice="dry"), found.effect_error.sel(choice="dry")], [0.04, 0.01])

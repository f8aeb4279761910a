"""Uncertain inputs of devices: the states around their values, and the covariance of their errors."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest
import small
from beams import PAPER
from numpy.testing import assert_allclose

from stiction.analysis.shifts import STEPS
from stiction.contact.environment import Water
from stiction.stages.devices import uncertain_inputs as inputs
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.devices.uncertain_inputs import InputState, QuantityErrors, Settings, Uncertainty

WATER = Water(300.0)
C1 = DesignedBeam("cantilever", "b", PAPER.thickness, PAPER.gap, PAPER.width, PAPER.young_modulus, 1.5e-6)
R1 = DesignedBeam("bridge", "b", 2e-6, 2e-6, 30e-6, 164e9, 1.5e-6, residual_stress=50e6)
BASE = InputState(1.0, 0.67, WATER, C1, 9e-12)
SETTINGS = Settings(1, WATER, 0.67, Uncertainty(), ("B2", "Sub1"), 164e9)


def uncertain(stated, water=WATER, of=C1, solids=MappingProxyType({}), **more):
    """Uncertain inputs of a device without those of surfaces: name to its states, step and standard uncertainty."""
    settings = replace(SETTINGS, uncertainty=stated, water=water, **more)
    state = replace(BASE, water=water, device=of)
    found, covariance = inputs.uncertain(state, {}, solids, {}, settings)
    return {entry.name: (entry, u) for entry, u in zip(found, np.sqrt(np.diag(covariance)), strict=True)}


def test_dimensions_are_changed_alone_and_around_their_values():
    found = uncertain(Uncertainty(thickness=0.04e-6, gap=0.5e-6, residual_stress=10e6), of=R1)
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
    stress, deviation = uncertain(Uncertainty(residual_stress=10e6), of=free)["residual stress"]
    assert_allclose([state.device.residual_stress for state in stress.states], [0, 10e6])
    assert_allclose([stress.step, deviation], [10e6, 10e6])
    angle, deviation = uncertain(Uncertainty(contact_angle=0.2))["contact angle on the substrate"]
    assert [state.water.contact_angles for state in angle.states] == [(0, 0), (0, 0.2)]
    assert_allclose([angle.step, deviation], [0.2, 0.2])


def test_adsorbed_water_errs_upwards_from_nothing_and_around_its_height():
    none, deviation = uncertain(Uncertainty(adsorbed=0.2e-9))["adsorbed water"]
    assert [state.water.adsorbed for state in none.states] == [0, 0.2e-9]
    assert (none.step, deviation, none.group) == (0.2e-9, 0.2e-9, "the adsorbed water")
    some, _ = uncertain(Uncertainty(adsorbed=0.2e-9), water=replace(WATER, adsorbed=0.5e-9))["adsorbed water"]
    assert_allclose([state.water.adsorbed for state in some.states], [0.3e-9, 0.7e-9])
    moved = [inputs.changed(some.states[0], {"adsorbed water": by}).water.adsorbed for by in (0.1e-9, -1e-9)]
    assert_allclose(moved, [0.4e-9, 0])


def test_contact_angles_err_together_each_over_a_step_of_its_own():
    zero, small_angle, least, middle, most = np.radians([0, 10, 60, 70, 80])
    settings = replace(SETTINGS, uncertainty=Uncertainty(contact_angle=small_angle))
    wet = replace(BASE, water=replace(WATER, contact_angles=(zero, middle)))
    found, covariance = inputs.uncertain(wet, {}, {}, {}, settings)
    assert {entry.group for entry in found} == {"the contact angles"}
    met = np.array([[state.water.contact_angles for state in entry.states] for entry in found])
    assert_allclose(met, [[(zero, middle), (small_angle, middle)], [(zero, least), (zero, most)]])
    # The film is as high as the sum of both cosines.
    slopes = np.diff(np.cos(met).sum(axis=2), axis=1)[:, 0] / [entry.step for entry in found]
    together = (1 - np.cos(small_angle)) + (np.cos(least) - np.cos(most)) / 2
    assert_allclose(np.sqrt(slopes @ covariance @ slopes), together, rtol=1e-12)


def test_air_is_changed_in_both_directions():
    found = uncertain(Uncertainty(humidity=0.02, temperature=3.0), of=None)
    assert [state.humidity for state in found["humidity"][0].states] == pytest.approx([0.65, 0.69])
    assert [state.water.temperature for state in found["temperature"][0].states] == [297, 303]
    assert_allclose([found["humidity"][0].step, found["temperature"][0].step], [0.04, 6])
    assert_allclose([found["humidity"][1], found["temperature"][1]], [0.02, 3])


def test_youngs_modulus_changes_contact_and_beam_together():
    changed = {"modulus": (0.9, 1.1)}
    entry, deviation = uncertain(Uncertainty(young_modulus=8.2e9), solids=changed)["Young's modulus"]
    assert [state.contact for state in entry.states] == [0.9, 1.1]
    assert_allclose([state.device.young_modulus for state in entry.states], [0.95 * 164e9, 1.05 * 164e9])
    assert_allclose([entry.step, deviation], [np.log(1.05 / 0.95), 0.05])
    stopper, _ = uncertain(Uncertainty(young_modulus=8.2e9), of=None, solids=changed)["Young's modulus"]
    assert [state.device for state in stopper.states] == [None, None]


def test_poissons_ratio_and_the_hamaker_constant_change_the_contact_and_leave_the_beam():
    stated = Uncertainty(young_modulus=8.2e9, poisson_ratio=0.02, hamaker_constant=3e-20)
    changed = {"hamaker_constant": (0.7, 1.3), "poisson_ratio": (0.8, 1.2), "modulus": (0.9, 1.1)}
    found = uncertain(stated, solids=changed, hamaker_constant=1e-19)
    assert list(found) == ["Young's modulus", "Poisson's ratio", "Hamaker constant"]
    for name, contacts in (("Poisson's ratio", (0.8, 1.2)), ("Hamaker constant", (0.7, 1.3))):
        assert [(state.contact, state.device) for state in found[name][0].states] == [(one, C1) for one in contacts]
    ratio, constant = found["Poisson's ratio"], found["Hamaker constant"]
    assert_allclose([ratio[0].step, ratio[1]], [0.1, 0.02])
    assert_allclose([constant[0].step, constant[1]], [np.log(1.2 / 0.8), 0.3])


def test_what_counts_as_exact_if_it_is_not_stated_has_the_name_of_its_group():
    stated = Uncertainty(young_modulus=8.2e9, poisson_ratio=0.02, hamaker_constant=3e-20)
    changed = dict.fromkeys(("modulus", "poisson_ratio", "hamaker_constant"), (0.9, 1.1))
    found = uncertain(stated, solids=changed, hamaker_constant=1e-19)
    assert {entry.group for entry, _ in found.values()} < set(inputs.countable((), SETTINGS))


def test_only_a_beam_held_at_both_ends_has_a_residual_stress():
    assert "the residual stress" in inputs.countable(R1.opening.sizes, SETTINGS)
    assert "the residual stress" not in inputs.countable(C1.opening.sizes, SETTINGS)


def test_a_stopper_has_no_dimensions_of_a_beam():
    assert set(uncertain(Uncertainty(thickness=1e-7, gap=1e-7, residual_stress=1.0, humidity=0.01), of=None)) == {
        "humidity"
    }


def test_quantities_of_a_surface_keep_their_covariance_and_their_group():
    known = QuantityErrors(("mode2", "corner"), np.array([[4.0, 1], [1, 9]]))
    differences = {name: 2 * STEPS[name] for name in known.quantities}
    shifted = {
        ("B2", name): tuple(small.contact_of_pair().assign(difference=((), difference)) for _ in range(2))
        for name, difference in differences.items()
    }
    settings = replace(SETTINGS, uncertainty=Uncertainty(humidity=0.1))
    found, matrix = inputs.uncertain(BASE, shifted, {}, {"B2": known}, settings)
    assert [entry.name for entry in found] == ["mode2 of B2", "corner of B2", "humidity"]
    assert [entry.group for entry in found] == ["the heights of B2", "the spectrum of B2", "the humidity"]
    assert [entry.step for entry in found[:2]] == list(differences.values())
    assert_allclose(matrix, [[4, 1, 0], [1, 9, 0], [0, 0, 0.01]])
    assert not any(entry.middle for entry in found)


def test_quantities_that_are_shifted_by_a_large_uncertainty_have_a_middle_with_as_many_samples():
    contact = small.contact_of_pair()
    pair = tuple(contact.isel(strip=slice(8)).assign(difference=((), 1.6)) for _ in range(2))
    known, at = QuantityErrors(("corner",), np.array([[0.64]])), replace(BASE, contact=contact)
    block = inputs.surface_block(at, "B2", {("B2", "corner"): pair}, known)
    (entry,) = block.inputs
    assert entry.middle.contact.sizes["strip"] == 8 < contact.sizes["strip"]
    assert entry.middle.humidity == at.humidity


def test_one_scan_gives_the_covariance_of_its_closed_form():
    # 10 µm of B2: errors and correlation as of hundreds of drawn scans.
    found = inputs.errors_of_one_scan(*small.surfaces()[0], 10e-6)
    errors = np.sqrt(np.diag(found.covariance))
    assert_allclose(errors, [0.0161, 0.0433, 0.1416], rtol=0.02)
    assert_allclose(found.covariance[1, 2] / (errors[1] * errors[2]), -0.868, atol=0.01)
    assert_allclose(inputs.errors_of_one_scan(*small.surfaces()[0], 20e-6).covariance, found.covariance / 4, rtol=0.1)


def test_errors_of_several_causes_add_up_where_they_are_of_the_same_quantity():
    first = QuantityErrors(("rms", "corner"), [[4.0, 1.0], [1.0, 9.0]])  # lists, as settings have them
    second = QuantityErrors(("rms", "skewness"), [[1.0, 0.5], [0.5, 2.0]])
    found = inputs.together([first, second])
    assert found.quantities == ("rms", "skewness", "corner")
    assert_allclose(found.covariance, [[5, 0.5, 1], [0.5, 2, 0], [1, 0, 9]])


def test_what_is_stated_about_a_surface_adds_to_the_error_of_a_scan():
    surfaces, side = {"B2": small.surfaces()[0]}, 10e-6
    of_scan = inputs.errors_of_one_scan(*surfaces["B2"], side).covariance
    stated = replace(SETTINGS, known={"B2": QuantityErrors(("kurtosis", "slope"), [[0.04, 0], [0, 0.25]])})
    alone = inputs.covariances(surfaces, {}, stated)["B2"]
    assert alone.quantities == ("kurtosis", "slope")
    both = inputs.covariances(surfaces, {}, replace(stated, uncertainty=Uncertainty(scan=side)))["B2"]
    assert both.quantities == ("rms", "skewness", "kurtosis", "slope")
    assert_allclose(both.covariance[:3, :3] - of_scan, np.diag([0, 0, 0.04]), atol=1e-12)
    assert_allclose(both.covariance[3], [0, 0, 0, 0.25])

"""Slopes and budgets of devices on given vectors, and on the contact of a small study."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import small
from beams import PAPER
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtri
from vectors import sampled_vectors

from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.devices.arcs import arc_length
from stiction.devices.bridges import least_length, middle_zone
from stiction.devices.budget import log_slope
from stiction.devices.tail import fit_tail
from stiction.run import storage
from stiction.stages.answer import conditions
from stiction.stages.contact import curves
from stiction.stages.devices import budget
from stiction.stages.devices.budget import BeamBudget, PatchBudget, Responses, TipBudget
from stiction.stages.devices.opening import ARC, FORCE, MIDDLE, S_SHAPE, DesignedBeam, arrests
from stiction.stages.devices.uncertain_inputs import Input, InputState, Uncertainty
from stiction.streams import stream

WATER = Water(300.0)
VECTORS = sampled_vectors(400, spread=0.2)
SLOPES = np.geomspace(0.01, 1, 30)
C1 = DesignedBeam("cantilever", "b", PAPER.thickness, PAPER.gap, PAPER.width, PAPER.young_modulus, 1.5e-6)
R1 = DesignedBeam("bridge", "b", 2e-6, 2e-6, 30e-6, 164e9, 0.5e-6, residual_stress=50e6)
#: Forces and energies are multiplied by what a test passes as contact.
BASE = InputState(1.0, 0.67, WATER, C1, 9e-12)
BEAMS = partial(budget.beam_responses, mesh=(PAPER, 1000), number=100, address=lambda k: stream(1, k))
COMMON = 1, WATER, 0.67, Uncertainty(), ("B2", "Sub1"), 164e9
SETTINGS = BeamBudget(*COMMON, device=C1, beams=24)


@pytest.fixture(autouse=True)
def given(monkeypatch, request):
    """Vectors of a pair as sampled contact, except where a test uses the small study."""
    if "study" in request.fixturenames:
        return

    def vectors(contact, *_):
        found = VECTORS * [contact, contact, 1, 1]
        return found, 1.1 * found[:, 1].max()

    monkeypatch.setattr(curves, "vectors", vectors)
    monkeypatch.setattr(curves, "displacements", lambda *_: None)
    monkeypatch.setattr(curves, "pull_offs", lambda contact, *_: contact * VECTORS[:, 1])
    monkeypatch.setattr(curves, "tip_forces", lambda contact, *_: (SLOPES, contact * VECTORS[:, :1] / SLOPES))


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


@pytest.mark.slow
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


def test_a_state_is_released_once_if_it_has_the_same_laws_beside_others(monkeypatch):
    released, stronger, weaker = [], replace(BASE, contact=1.2), replace(BASE, contact=0.8)
    monkeypatch.setattr(budget, "arrests", lambda *all_of: released.append(all_of) or arrests(*all_of))
    remembering = partial(BEAMS, number=20, cache={})
    found = [remembering([BASE, other]).values for other in (stronger, weaker, stronger)]
    assert len(released) == 3
    np.testing.assert_array_equal(found[0], found[2])
    np.testing.assert_array_equal(found[1], partial(BEAMS, number=20)([BASE, weaker]).values)
    assert len(released) == 5  # control: nothing is known without an earlier call
    assert not np.array_equal(found[0][1], found[1][1])


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


def test_the_error_of_the_samples_moves_a_bridge_as_its_closed_form():
    states = [replace(BASE, device=R1, contact=factor) for factor in (np.exp(-0.1), np.exp(0.1))]
    zone, strips = middle_zone(R1.beam, R1.strip, budget.shared_laws([curves.vectors(1.0)])[0])
    found = budget.beam_responses(states, mesh=(zone, strips), number=20, address=lambda k: stream(1, k))
    noise = np.exp(np.random.default_rng(1).normal(size=(2, len(VECTORS), 1)))
    found = replace(found, shared=found.shared * noise)
    own, common = (log_slope(np.mean, *values, 0.2)[1] for values in (found.values, found.shared[..., 0]))
    law = np.mean(found.shared, axis=(0, 1))
    lengths = [least_length(*law * factor, R1.beam) for factor in np.exp([-0.01, 0.01])]
    power = np.log(lengths[0] / lengths[1]) / 0.02
    assert 0.25 < power < 0.67  # between that of bending and that of tension alone
    ((value, error),) = budget.slopes([Input("energy", "energy", tuple(states), 0.2)], lambda _: found)
    assert_allclose(np.sqrt(error**2 - own**2), power * common, rtol=0.1)
    assert_allclose(value, -power, rtol=0.1)


def test_stoppers_share_no_samples_and_their_force_is_that_of_their_area():
    area = around("area", 0.1, lambda factor: replace(BASE, area=9e-12 * factor))
    assert_allclose(budget.slopes([area], budget.stopper_responses)[0], [1, 0], atol=1e-12)
    assert_allclose(budget.stopper_responses([BASE]).values[0], 9e-12 * VECTORS[:, 1], rtol=1e-14)


def test_a_choice_of_the_model_changes_the_mean_by_its_effect():
    assert_allclose(
        budget.effect(BASE, replace(BASE, contact=2.0), budget.stopper_responses), [np.log(2), 0], atol=1e-12
    )
    assert_allclose(budget.effect(BASE, BASE, BEAMS), [0, 0], atol=1e-12)


def test_a_choice_under_which_patches_have_no_bound_has_no_effect_that_is_known():
    def respond(_):
        raise ValueError("sample 9: the force does not rise to zero")

    assert np.isnan(budget.effect_if_known(BASE, BASE, respond)).all()
    assert budget.effect_if_known(BASE, BASE, BEAMS) == budget.effect(BASE, BASE, BEAMS)


def test_lengths_that_are_not_known_leave_the_median():
    assert BEAMS([BASE]).centre is np.mean
    # A short beam on a weak ground has no S-shape.
    unknown = BEAMS([BASE, replace(BASE, contact=0.01)])
    assert np.isinf(unknown.values[1]).all()
    assert unknown.centre is np.median


def test_the_length_that_tips_hold_follows_the_powers_of_the_closed_form():
    # l⁴ = (3/8) E t³ h² / e, exactly, whatever the scatter of e.
    stiffer = around("modulus", 0.05, lambda factor: device(young_modulus=factor))
    found = budget.slopes([*INPUTS, stiffer], partial(budget.tip_responses, share=1e-3))
    assert_allclose(found[:, 0], [-1 / 4, 3 / 4, 1 / 2, 1 / 4], rtol=1e-9)
    assert_allclose(found[:, 1], 0, atol=1e-9)


def test_the_tips_that_hold_best_stand_for_all():
    found = budget.tip_responses([BASE], 1e-3)
    assert_allclose(found.values[0], arc_length(VECTORS[:, 0], C1.beam), rtol=1e-12)
    assert found.centre(found.values[0]) == fit_tail(found.values[0]).length(1e-3)


def drawn_tips(seed):
    """Lengths of 300 tips with less and with more of an input, which moves their mean and their scatter."""
    scores = np.random.default_rng(seed).standard_normal(300)
    return budget.tip_responses([BASE], 1e-3), np.exp([0.25 * scores, 0.26 * scores + 0.02])


def test_slopes_of_few_tips_have_no_bias_and_less_error_than_from_their_shortest_twentieth():
    true = 0.02 + 0.01 * ndtri(1e-3)
    drawn = [drawn_tips(seed) for seed in range(60)]
    found, of_end, of_middle = (
        np.array([log_slope(length(tips), *lengths, 1.0) for tips, lengths in drawn])
        for length in (lambda tips: tips.centre_of_slopes, lambda tips: tips.centre, lambda _: np.median)
    )
    scatter = found[:, 0].std()
    assert abs(found[:, 0].mean() - true) < 4 * scatter / np.sqrt(len(drawn))
    assert abs(of_middle[:, 0].mean() - true) > 10 * scatter / np.sqrt(len(drawn))  # control
    assert scatter < 0.75 * of_end[:, 0].std()
    assert 0.7 * scatter < np.median(found[:, 1]) < 1.4 * scatter


# Whole budgets


def test_wetter_air_shortens_the_cracks_of_a_small_study(study):
    states = tuple(replace(BASE, contact=study, humidity=humidity) for humidity in (0.6, 0.74))
    value, error = budget.slopes([Input("humidity", "humidity", states, 0.14)], BEAMS)[0]
    assert value < -4 * error


def test_a_budget_of_a_small_study_has_the_devices_of_all_its_samples(study):
    settings = replace(SETTINGS, seed=small.SEED, uncertainty=Uncertainty(gap=0.5e-6), device=R1, beams=4)
    changed = study.isel(strip=slice(10))
    found = budget.compute(study, {}, {}, {"half": changed}, {}, settings)
    assert list(found.input.values) == ["gap"]
    state = settings.state(study)
    lengths = settings.responder(state)([state]).values[0]
    assert len(lengths) == 4
    assert_allclose(found.centre, lengths.mean(), rtol=1e-12)
    assert_allclose(found.effect, 0, atol=1e-12)  # the same samples
    assert (found.centre.attrs["units"], budget.response_of(found)) == ("m", (MIDDLE, 0))


def test_the_budget_of_a_stopper_is_one_of_its_forces(study):
    settings = replace(PatchBudget(*COMMON, contact=(1.5e-6, 6e-6)), uncertainty=Uncertainty(humidity=0.01))
    found = budget.compute(study, {}, {}, {}, {}, settings)
    assert (found.centre.attrs["units"], budget.response_of(found)) == ("N", (FORCE, 0))
    assert_allclose(found.centre, curves.pull_offs(study, 0.67, WATER).mean() * 9e-12, rtol=1e-12)
    ends = [curves.pull_offs(study, h, WATER).mean() for h in (0.66, 0.68)]
    assert_allclose(found.slope, np.log(ends[1] / ends[0]) / 0.02, rtol=1e-9)


def test_the_budget_of_tips_is_one_of_their_arcs(study, monkeypatch):
    monkeypatch.setattr(curves, "tip_forces", lambda *air: (SLOPES, curves.energies(*air)[:, None] / SLOPES))
    many = study.isel(strip=np.arange(200) % study.sizes["strip"])
    settings = replace(TipBudget(*COMMON, device=C1, share=0.01), uncertainty=Uncertainty(gap=0.5e-6, humidity=0.01))
    found = budget.compute(many, {}, {}, {}, {}, settings)
    assert (found.centre.attrs["units"], budget.response_of(found)) == ("m", (ARC, 0.01))
    arcs = [arc_length(curves.energies(many, h, WATER), C1.beam) for h in (0.66, 0.67, 0.68)]
    low, _, high = (fit_tail(lengths, 0.25).length(0.01) for lengths in arcs)
    assert_allclose(found.centre, fit_tail(arcs[1]).length(0.01), rtol=1e-12)
    assert_allclose(found.slope, [0.5, np.log(high / low) / 0.02], rtol=1e-9)


def test_what_is_not_uncertain_is_listed(study):
    found = budget.compute(study, {}, {}, {}, {}, replace(SETTINGS, uncertainty=Uncertainty(gap=1e-7), device=R1))
    names = list(found.exact.values)
    assert {"the heights of B2", "the spectrum of Sub1", "the thickness", "Poisson's ratio", "the humidity"} < set(
        names
    )
    assert "the gap" not in names


def test_a_budget_comes_back_from_its_file(tmp_path):
    covariance = np.diag([0.1, 0.02, 0.03]) ** 2
    entries = [replace(INPUTS[0], group="surface"), INPUTS[1], replace(INPUTS[2], group="surface")]
    given = np.array([[-0.25, 0.01], [0.75, 0.02], [0.5, 0.03]])
    devices = Responses(np.array([[1.0, 2, 3]]), np.mean)
    made = budget.layout(entries, given, covariance, devices, {"dry": (0.04, 0.01)}, SETTINGS)
    storage.save(made, tmp_path / "C1.nc", "budget", {})
    found = storage.load(tmp_path / "C1.nc", "budget")
    assert budget.groups_of(found) == {"surface": ["energy", "gap"], "thickness": ["thickness"]}
    assert_allclose(budget.budget_of(found).total, np.sqrt(0.025**2 + 0.015**2 + 0.015**2), rtol=1e-12)
    assert_array_equal(found.slope_error, given[:, 1])
    assert_allclose([found.centre, found.scatter], [2, 0.5], rtol=1e-12)
    assert_allclose([found.effect.sel(choice="dry"), found.effect_error.sel(choice="dry")], [0.04, 0.01])
    assert budget.response_of(found) == (S_SHAPE, 0)


def test_an_error_of_a_changed_contact_names_the_input():
    def respond(_):
        raise ValueError("a sample has no force law")

    with pytest.raises(ValueError, match="no force law") as refused:
        budget.slopes([Input("Young's modulus", "solids", (BASE, BASE), 0.1)], respond)
    assert refused.value.__notes__ == ["This is the contact with less or more of the input Young's modulus."]


# Curvature


def test_bends_are_those_of_the_response_and_of_inputs_with_a_middle_alone():
    def respond(states):
        return Responses(
            np.array([[np.exp(-0.3 * x + 0.07 * x**2)] * 20 for x in (of.contact for of in states)]), np.mean
        )

    at = [replace(BASE, contact=x) for x in (-0.8, 0.0, 0.8)]
    far = Input("corner", "spectrum", (at[0], at[2]), 1.6, at[1])
    near = replace(far, middle=None)
    assert_allclose(budget.bends([far, near], respond), [0.07, 0.0], rtol=1e-9)
    assert_allclose(budget.slopes([far], respond)[0, 0], -0.3, rtol=1e-9)


@pytest.mark.parametrize("settings", [SETTINGS, PatchBudget(*COMMON, contact=(3e-6, 3e-6))], ids=["beam", "stopper"])
def test_a_bend_counts_where_it_makes_beams_shorter_and_forces_larger(settings):
    inputs = [Input("corner", "spectrum", (BASE, BASE), 1.6, BASE)]
    found = budget.layout(inputs, np.array([[0.1, 0.0]]), np.eye(1), Responses(np.ones((1, 9)), np.mean), {}, settings)

    def margin(one):
        """Margin of the errors in an answer."""
        (slopes,) = conditions.of_budgets([one], [0.5]).budgets.values()
        return slopes.margin

    linear = margin(found)
    assert linear == pytest.approx(0.1)
    assert [margin(found.assign(bend=("input", [bend]))) > linear for bend in (-0.1, 0.1)] == (
        [True, False] if settings is SETTINGS else [False, True]
    )

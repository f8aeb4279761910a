"""The life of devices: each answer is that of its form, in the right units, and the parts agree with each other."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from answers import stopper_dataset
from ground import C1, R1, safe_with_tips, safe_without_tips
from legends import covering
from lives import LIQUIDS, OF, STOPPER, UNSTATED
from numpy.testing import assert_allclose
from plans import job_settings

from stiction.answer.data import Answer
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.devices.risk import samples_for
from stiction.devices.stoppers import safe_force
from stiction.life import drying, freeing, holding, touch
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.answer import words
from stiction.report.devices import life as report
from stiction.report.devices.pages import Page, Section, with_life
from stiction.report.format import safe_size
from stiction.report.page import Summary
from stiction.report.style import on_a_page, save, strips
from stiction.run import storage
from stiction.stages.answer.beside import unasked
from stiction.stages.life.answers import QUESTIONS, Name, answers_of, layout
from stiction.stages.life.beams import beam_answers, length_of
from stiction.stages.life.inputs import BeamErrors, BeamKeys, Liquid, StopperKeys
from stiction.stages.life.stoppers import stopper_answers

SECTION = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
MINE = {"mine": {"surface_tension_mN_per_m": 30, "contact_angle_deg": 60}}
SPRING = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "stiffness_N_per_m": 10, "gap_um": 1.899}
SPRING |= {"humidities": [0.44], "mass_ng": 50, "electrode": {"area_um2": 10000, "gap_um": 3}, "touchdowns": 4}


@pytest.fixture(scope="module")
def lengths():
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    return {0.44: safe_with_tips(tips), 0.67: safe_with_tips(1.5 * tips)}


def answers(of, lengths=None, after=None, biased=None):
    """Answers about a beam, or a stopper, by name."""
    if lengths is None:
        return {one.name: one for one in stopper_answers(stopper_dataset(), of, biased)}
    return {one.name: one for one in beam_answers(lengths, after or {}, of, biased)}


def at_voltage(lengths, factor, energy):
    """Datasets of safe lengths at a voltage, shorter by a factor, where the voltage adds an energy [J m⁻²]."""
    gained = {"voltage_energy": energy, "voltage_error": 0.1 * energy}
    return {key: one.assign(safe_length=factor * one.safe_length, **gained) for key, one in lengths.items()}


def test_a_beam_is_asked_at_its_least_safe_length_unless_it_states_one(lengths):
    least = min(float(one.safe_length.isel(share=1).min()) for one in lengths.values())
    assert_allclose(length_of(lengths, OF), least, rtol=1e-12)
    found = answers(OF, lengths)
    beam = replace(OF.beam(1.0), length=least)
    assert_allclose(found["voltage"].low, touch.pull_in_voltage_at_once(beam, 1), rtol=1e-12)
    assert_allclose(found["voltage"].high, touch.pull_in_voltage(beam, 1), rtol=1e-12)
    assert_allclose(found["shock"].high, touch.touching_acceleration(beam, 1, 2330.0), rtol=1e-12)
    assert_allclose(found["shock"].high / found["shock"].low, touch.shock_factor(beam, 1), rtol=1e-12)
    stated = answers(replace(OF, length=2 * least), lengths)
    assert_allclose(found["voltage"].high / stated["voltage"].high, 4, rtol=1e-9)
    assert_allclose(found["shock"].low / stated["shock"].low, 16, rtol=1e-9)
    assert found["collapse_water"] == stated["collapse_water"]


def test_liquids_act_through_their_tension_and_angle(lengths):
    found, beam = answers(OF, lengths), OF.beam(1.0)
    for name, tension, angle in (("water", 0.072, 0.0), ("mine", 0.03, np.pi / 3)):
        adhesion = tension * np.cos(angle)
        bounds = drying.longest_standing_each(beam, 1, tension, angle), drying.longest_standing(beam, 1, adhesion)
        assert_allclose((found[f"collapse_{name}"].low, found[f"collapse_{name}"].high), bounds, rtol=1e-9)
        assert_allclose(found[f"released_{name}"].high, drying.longest_free(beam, 1, adhesion), rtol=1e-9)
    assert answers(replace(OF, liquids={"oil": Liquid(0.03, 2.0)}), lengths)["collapse_oil"].low == np.inf


def test_a_beam_held_by_the_energy_that_is_stated_pulls_with_the_stated_force(lengths):
    found, length = answers(OF, lengths), length_of(lengths, OF)
    beam = replace(OF.beam(1.0), length=length)
    assert_allclose(found["energy"].low, 4 * found["tip"].low, rtol=1e-12)
    # The force at the tip times its slope is the adhesion energy of the tip times the width.
    assert_allclose(found["force"].low * 1.5 * beam.gap / length, found["tip"].low * beam.width, rtol=1e-9)


def test_errors_are_those_of_the_powers_of_the_closed_forms(lengths):
    relative = {"thickness": 0.01, "gap": 0.02, "young_modulus": 0.03}
    errors = BeamErrors(**{name: share * getattr(C1, name) for name, share in relative.items()})
    found = answers(replace(OF, uncertainty=errors, length=300e-6), lengths)
    powers = {"shock": (2, 1, 1), "released_water": (0.75, 0.5, 0.25), "tip": (3, 2, 1)}
    for name, exponents in powers.items():
        expected = np.hypot.reduce(np.array(exponents) * list(relative.values()))
        assert_allclose(found[name].error / found[name].low, expected, rtol=2e-3)
    # Edges, which a larger gap makes wider, and the pull at the end of a beam add less than a third of a power.
    for name, exponents in {"voltage": (1.5, 1.5, 0.5), "collapse_water": (0.75, 0.5, 0.25)}.items():
        expected = np.hypot.reduce(np.array(exponents) * list(relative.values()))
        assert_allclose(found[name].error / found[name].low, expected, rtol=0.2)
    assert np.isnan(answers(OF, lengths)["voltage"].error)


def test_residual_stress_of_a_bridge_has_an_error_and_rigid_clamps_an_upper_bound():
    of = replace(OF, device=R1, liquids={"water": LIQUIDS["water"]}, uncertainty=BeamErrors(residual_stress=5e6))
    found = answers(of, {0.67: safe_without_tips()})
    for name in ("voltage", "shock"):
        assert found[name].low < found[name].high
        assert 0 < found[name].error < 0.1 * found[name].low
    assert np.isnan(found["released_water"].low)
    assert found["released_water"].high > 0
    assert "tip" not in found


def test_many_touchdowns_are_between_other_summits_each_time_and_the_same_ones(lengths):
    rare = {
        h: one.isel(share=[1]).assign(safe_length=0.9 * one.isel(share=[1]).safe_length) for h, one in lengths.items()
    }
    found = answers(replace(OF, touchdowns=50), lengths, rare)
    least = length_of(lengths, OF)
    assert_allclose((found["after"].low, found["after"].high), (0.9 * least, least), rtol=1e-12)
    assert np.isnan(found["stuck_after"].low), "at a safe length at most as many stick, perhaps none"
    assert_allclose(found["stuck_after"].high, freeing.stuck_after(1e-3, 50))
    assert "after" not in answers(OF, lengths)


def test_a_safe_length_without_an_error_has_none_and_says_its_basis(lengths):
    bare = {h: one.assign(beams_error=np.nan * one.beams_error) for h, one in lengths.items()}
    bare = {h: one.assign(surfaces_error=np.nan * one.surfaces_error) for h, one in bare.items()}
    answer = answers(OF, bare)["safe_length_0.67"]
    assert np.isnan(answer.error)
    assert answer.form.endswith(str(lengths[0.67].basis.isel(shape=1).sel(share=1e-3).values))


def test_answers_come_in_the_order_of_the_questions(lengths):
    for found in (answers(OF, lengths), answers(STOPPER)):
        asked = [QUESTIONS.index(one.question) for one in found.values()]
        assert asked == sorted(asked)
        assert len(set(found)) == len(found)
    assert {one.question for one in answers(OF, lengths).values()} == set(QUESTIONS)


# Stoppers


def test_a_stopper_touches_under_its_restoring_force_and_is_freed_by_what_it_lacks():
    found, dataset = answers(STOPPER), stopper_dataset()
    assert_allclose(found["shock"].high, 18.99e-6 / 50e-12, rtol=1e-12)
    assert_allclose(found["shock"].high / found["shock"].low, touch.HALF_SINE, rtol=1e-12)
    electrode = 10.0, 1.899e-6, 1e-8, 3e-6
    assert_allclose(found["voltage"].low, touch.stopper_voltage_at_once(*electrode), rtol=1e-12)
    assert_allclose(found["voltage"].high, touch.stopper_voltage(*electrode), rtol=1e-12)
    force = float(dataset.safe_force.sel(part="safe", share=0.01).max())
    assert_allclose(found["restoring_force"].low, force, rtol=1e-12)
    assert_allclose(found["stiffness"].low, force / 1.899e-6, rtol=1e-12)
    assert_allclose(found["freeing"].low, (force - 18.99e-6) / 50e-12, rtol=1e-9)
    # Without water, which could keep its volume, slow and fast separation are the same.
    assert found["freeing"].high == found["freeing"].low
    low, high = (float(dataset.stuck.sel(bound=bound).max()) for bound in ("low", "high"))
    assert_allclose((found["stuck_after"].low, found["stuck_after"].high), (low, freeing.stuck_after(high, 4)))


def fast_forces(*factors):
    """Dataset of stage separation of a stopper: the forces of `stopper_dataset` times a factor at each humidity."""
    forces = stopper_dataset().pull_off
    return forces.isel(humidity=slice(len(factors))).to_dataset() * np.array(factors)[:, None]


def test_fast_separation_bounds_what_frees_a_stopper_from_above():
    slow = answers(STOPPER)
    fast = {one.name: one for one in stopper_answers(stopper_dataset(), STOPPER, separation=fast_forces(1.5, 2.5))}
    for name in ("restoring_force", "stiffness"):
        assert slow[name].low == slow[name].high == fast[name].low
        assert_allclose(fast[name].high, 1.5 * fast[name].low, rtol=1e-12)
    force = fast["restoring_force"].high
    assert_allclose(fast["freeing"].high, (force - 18.99e-6) / 50e-12, rtol=1e-9)
    assert fast["freeing"].low == slow["freeing"].low
    assert set(slow) == set(fast)
    # The second humidity holds half of the force of the first one, slowly.
    second = {one.name: one for one in stopper_answers(stopper_dataset(), STOPPER, separation=fast_forces(1.0, 3.0))}
    assert_allclose(second["restoring_force"].high, 1.5 * slow["restoring_force"].low, rtol=1e-12)


def test_patches_that_no_summits_stop_leave_fast_separation_without_a_bound():
    flat = fast_forces(1.0, 1.0)
    flat.pull_off[0, -30:] = np.inf
    found = {one.name: one for one in stopper_answers(stopper_dataset(), STOPPER, separation=flat)}
    for name in ("restoring_force", "stiffness", "freeing"):
        assert np.isnan(found[name].high)
        assert found[name].low == answers(STOPPER)[name].low
    flat.pull_off[0] = 1.2 * flat.pull_off[1]
    flat.pull_off[0, -1] = np.inf  # one of 400 is less than the fraction of which the bound is
    assert np.isfinite(stopper_answers(stopper_dataset(), STOPPER, separation=flat)[-1].high)


def factors(values, errors=0.01):
    """Dataset of stage separation of a cantilever: factors of both end states at each humidity."""
    data = {"factor": (("humidity", "shape"), values), "factor_error": (("humidity", "shape"), errors + 0 * values)}
    return xr.Dataset(data, coords={"humidity": [0.44, 0.67][: len(values)], "shape": list(C1.opening.shapes)})


def fast(lengths, values, errors=0.01):
    """Safe length of fast separation, and those of slow separation at all humidities in all end states [m]."""
    found = {one.name: one for one in beam_answers(lengths, {}, OF, separation=factors(np.array(values), errors))}
    return found["fast"], np.array([one.safe_length.sel(share=1e-3).values for one in lengths.values()])


def test_fast_separation_shortens_the_safe_length_of_each_end_state_by_its_factor(lengths):
    for values in ([[0.7, 0.9], [0.8, 1.0]], [[0.2, 0.9], [0.8, 1.0]], [[1.0, 1.0], [0.9, 0.1]]):
        found, slow = fast(lengths, values)
        assert_allclose((found.low, found.high), (np.min(slow * values), slow.min()), rtol=1e-12)
    assert "fast" not in answers(OF, lengths)
    _, alone = fast(lengths, [[0.7, 0.9]])
    assert_allclose(fast(lengths, [[1e-3, 1e-3]])[0].low, 1e-3 * alone[0].min(), rtol=1e-12)
    assert_allclose(fast(lengths, [[1.0, 1.0]])[0].low, alone.min(), rtol=1e-12)  # 0.67 has no water


def test_its_error_has_those_of_the_length_and_of_the_factor(lengths):
    values = [[1.0, 0.5], [1.0, 1.0]]
    (alone, slow), (both, _) = fast(lengths, values, 0.0), fast(lengths, values, 0.1)
    assert_allclose(np.hypot(alone.error, 0.1 * slow[0, 1]), both.error, rtol=1e-9)


def test_strips_that_no_summits_stop_leave_a_beam_without_a_bound(lengths):
    found, slow = fast(lengths, [[0.7, 0.9], [0.0, 0.9]], np.nan)
    assert np.isnan(found.low)
    assert np.isnan(found.error)
    assert found.high == slow.min()


def test_sentences_say_what_fast_separation_needs_if_it_is_more(lengths):
    beam = layout(beam_answers(lengths, {}, OF, separation=factors(np.array([[0.5, 0.5], [0.8, 0.9]]))), OF)
    (said,) = [one for one in report.sentences(beam) if "faster than water" in one]
    assert "simulated limit can fall from" in said
    stopper = layout(stopper_answers(stopper_dataset(), STOPPER, separation=fast_forces(1.5, 1.0)), STOPPER)
    (said,) = [one for one in report.sentences(stopper) if "faster than water" in one]
    assert "it can need a restoring force of" in said
    for none in (fast_forces(1.0, 1.0), None):
        same = layout(stopper_answers(stopper_dataset(), STOPPER, separation=none), STOPPER)
        assert not any("faster than water" in one for one in report.sentences(same))


def test_the_force_for_many_touchdowns_is_that_of_a_smaller_fraction_if_there_are_patches_enough():
    rare = freeing.probability_for(0.01, 1)
    assert samples_for(rare) <= 400 < samples_for(freeing.probability_for(0.01, 4))
    assert "after" not in answers(STOPPER)
    many = stopper_dataset()
    many = many.isel(sample=np.arange(1600) % 400)
    found = {one.name: one for one in stopper_answers(many, STOPPER)}["after"]
    forces = [
        max(safe_force(row, p)[0] for row in many.pull_off.values) for p in (0.01, freeing.probability_for(0.01, 4))
    ]
    assert_allclose((found.low, found.high), forces, rtol=1e-12)


def test_what_is_not_stated_has_no_number():
    found = answers(StopperKeys(**UNSTATED))
    assert not {"stiffness", "stuck_after", "after"} & set(found)
    assert np.isnan([(found[name].low, found[name].high) for name in ("shock", "voltage", "freeing")]).all()


# Voltage


def test_a_voltage_shortens_the_safe_length_of_a_beam_as_its_energy_says(lengths):
    of = replace(OF, voltage=-5.0, offset=0.3, dielectric=Dielectric(100e-9, 4.0))
    found, least = answers(of, lengths), length_of(lengths, OF)
    assert of.potential == 5.3
    added = holding.energy_of_voltage(of.capacitor, C1.gap)
    assert_allclose(found["voltage_energy"].high, added, rtol=1e-12)
    assert_allclose(found["field"].high, 5.3 / 100e-9, rtol=1e-12)
    at = found["at_voltage"]
    shorter, longer = (holding.tip_length_at_voltage(by * least, OF.beam(1.0), added) for by in (1, 1.001))
    assert_allclose(at.low, shorter, rtol=1e-12)
    assert np.isnan([at.high, found["voltage_energy"].low]).all(), "nothing is known of rough surfaces"
    # To first order, the error moves with the derivative of the length.
    of_least = min((one.low, one.error) for name, one in found.items() if name.startswith("safe_length"))[1]
    assert_allclose(at.error, of_least * (longer - shorter) / (1e-3 * least), rtol=1e-2)


def test_a_beam_at_a_voltage_is_between_flats_and_the_gaps_of_its_rough_surfaces(lengths):
    of = replace(OF, voltage=5.0, dielectric=Dielectric(100e-9, 4.0))
    flat, least = answers(of, lengths)["at_voltage"].low, length_of(lengths, OF)
    between, gained = (1 + flat / least) / 2, 0.2 * of.capacitor.work(0.0)
    found = answers(of, lengths, biased=at_voltage(lengths, between, gained))
    assert_allclose((found["at_voltage"].low, found["at_voltage"].high), (flat, between * least), rtol=1e-12)
    energy = found["voltage_energy"]
    assert_allclose((energy.low, energy.error), (gained, 0.1 * gained), rtol=1e-12)
    assert energy.low < energy.high
    # The least length of both bounds is the lower one, with its own error.
    steep = answers(of, lengths, biased=at_voltage(lengths, 0.9 * flat / least, gained))["at_voltage"]
    assert_allclose((steep.low, steep.high), (0.9 * flat, 0.9 * flat), rtol=1e-12)
    assert_allclose(steep.error, min((one.low, one.error) for one in found.values() if one.name.startswith("safe"))[1])


def test_a_bridge_at_a_voltage_has_the_safe_length_on_its_rough_surfaces_alone():
    of = replace(OF, device=R1, liquids={}, voltage=5.0, dielectric=Dielectric(100e-9, 4.0))
    without = {0.67: safe_without_tips()}
    found = answers(of, without, biased=at_voltage(without, 0.9, 1e-4))["at_voltage"]
    assert np.isnan(found.low)
    assert_allclose(found.high, 0.9 * length_of(without, of), rtol=1e-12)
    assert found.error > 0


def test_a_stopper_at_a_voltage_is_held_by_more_on_flats_than_on_rough_patches():
    of = replace(STOPPER, voltage=5.0, dielectric=Dielectric(100e-9, 4.0))
    flat, dataset = answers(of)["at_voltage"].high, stopper_dataset()
    gained = 0.3 * flat * (1 + 0.1 * np.random.default_rng(4).standard_normal(dataset.sizes["sample"]))
    biased = dataset.assign(pull_off=dataset.pull_off + gained, stuck=0 * dataset.stuck + 0.6)
    biased = biased.assign(freeing_potential=0 * dataset.pull_off)
    found = answers(of, biased=biased)
    assert_allclose(found["at_voltage"].low, gained.mean(), rtol=1e-12)
    assert found["at_voltage"].high == flat
    assert_allclose(found["at_voltage"].error, gained.std(ddof=1) / len(gained) ** 0.5, rtol=1e-9)
    assert_allclose((found["stuck_at_voltage"].low, found["stuck_at_voltage"].high), 0.6, rtol=1e-12)
    said = report.sentences(layout(stopper_answers(dataset, of, biased), of))
    assert any(sentence.endswith(f" to {report.significant(1e6 * flat, up=True)} µN.") for sentence in said)


def test_without_voltage_nothing_is_said_of_it_and_a_vanishing_one_changes_nothing(lengths):
    assert not {"at_voltage", "field"} & set(answers(OF, lengths))
    little = answers(replace(OF, voltage=1e-6, dielectric=Dielectric(100e-9, 4.0)), lengths)["at_voltage"]
    assert_allclose(little.low, length_of(lengths, OF), rtol=1e-9)


def test_a_bridge_states_the_energy_of_the_voltage_alone():
    of = replace(OF, device=R1, liquids={}, voltage=5.0, dielectric=Dielectric(100e-9, 4.0))
    found = answers(of, {0.67: safe_without_tips()})
    assert "at_voltage" not in found
    assert found["voltage_energy"].high > 0


def test_sentences_compare_a_stated_shock_with_those_that_bring_a_device_down(lengths):
    limit = answers(OF, lengths)["shock"]
    words = {0.9 * limit.low: "does not bring it down", 1.1 * limit.low: "can bring it", 1.1 * limit.high: "brings it"}
    for shock, said in words.items():
        of = replace(OF, shock=shock)
        dataset = layout(beam_answers(lengths, {}, of), of, length_of(lengths, of))
        (own,) = [one for one in report.sentences(dataset) if "own shock" in one]
        assert said in own
    plain = layout(beam_answers(lengths, {}, OF), OF, length_of(lengths, OF))
    assert "shock" not in plain
    assert not any("own shock" in one for one in report.sentences(plain))
    unknown = replace(STOPPER, mass=0.0, shock=3e4)
    assert not any(
        "own shock" in one for one in report.sentences(layout(stopper_answers(stopper_dataset(), unknown), unknown))
    )


def test_a_voltage_holds_a_stopper_with_the_pressure_of_flats_on_its_area():
    found = answers(replace(STOPPER, voltage=5.0, dielectric=Dielectric(100e-9, 4.0)))
    assert_allclose(found["at_voltage"].high, Capacitor(Dielectric(25e-9, 1.0), 5.0).largest_pressure * 9e-12)
    assert found["restoring_force"] == answers(STOPPER)["restoring_force"]


@pytest.mark.parametrize(("voltage", "breaks", "pulls"), [(5.0, False, False), (120.0, True, False), (4e4, True, True)])
def test_sentences_warn_of_breakdown_and_of_a_voltage_that_pulls_in(lengths, voltage, breaks, pulls):
    of = replace(OF, voltage=voltage, dielectric=Dielectric(100e-9, 4.0))
    said = report.sentences(layout(beam_answers(lengths, {}, of), of, length_of(lengths, of)))
    assert any("break down" in sentence for sentence in said) == breaks
    assert any("pulls it in" in sentence for sentence in said) == pulls
    assert any(f"While {report.significant(voltage)} V are on" in sentence for sentence in said)
    assert any("can stay after grounding" in sentence for sentence in said)
    without = report.sentences(layout(beam_answers(lengths, {}, OF), OF, length_of(lengths, OF)))
    assert not any("grounding" in sentence for sentence in without), "control"


# Configuration, files, report


def test_settings_come_from_the_device_its_material_and_the_liquids():
    gold = {"materials": {"Gold": {"density_kg_per_m3": 19300}}, "surfaces": {"B2": {"material": "Gold"}}}
    one = SECTION | {"length_um": 300, "touchdowns": 9, "uncertainty": {"gap_um": 1}}
    devices = {"devices": {"C1": one, "S1": SPRING, "C2": SECTION | {"pair": "a"}}}
    plan = Plan(load(gold | devices | {"liquids": MINE}))
    of = in_si(BeamKeys, job_settings(plan, "devices/life/C1")["beam"])
    assert (of.density, of.touchdowns, of.uncertainty) == (19300, 9, BeamErrors(gap=1e-6))
    assert_allclose(of.length, 300e-6)
    assert_allclose([one.adhesion for one in of.liquids.values()], [0.072, 0.0217, 0.015], rtol=1e-12)
    stopper = in_si(StopperKeys, job_settings(plan, "devices/life/S1")["stopper"])
    assert_allclose([stopper.restoring_force, stopper.mass, stopper.electrode.area], [18.99e-6, 50e-12, 1e-8])
    shares = job_settings(plan, "devices/touchdowns/C1_rh067")["shares"]
    assert_allclose(shares, [freeing.probability_for(1e-3, 9)])
    assert in_si(BeamKeys, job_settings(plan, "devices/life/C2")["beam"]).density == 2330
    assert list(Graph(plan).job("devices/life/C1").inputs["after"]) == [0.67]
    assert not Graph(plan).job("devices/life/C2").inputs["after"]


@pytest.fixture(scope="module")
def found(lengths):
    many = replace(OF, touchdowns=50)
    return {
        "C1": layout(beam_answers(lengths, lengths, many), many, length_of(lengths, OF)),
        "S1": layout(stopper_answers(stopper_dataset(), STOPPER), STOPPER),
    }


def test_the_dataset_is_stored_and_read_with_all_answers(found, tmp_path):
    for name, dataset in found.items():
        storage.save(dataset, tmp_path / f"{name}.nc", "life", {}, [])
        again = answers_of(storage.load(tmp_path / f"{name}.nc", "life"))
        for one, other in zip(again, answers_of(dataset), strict=True):
            np.testing.assert_equal(one, other)


def test_the_table_has_every_answer_in_its_unit(found):
    frame = report.table(found).frame.set_index(["device", "answer"])
    beam = {one.name: one for one in answers_of(found["C1"])}
    assert len(frame) == sum(one.sizes["answer"] for one in found.values())
    assert_allclose(frame.loc[("C1", "shock"), "at_most"], beam["shock"].high / 9.80665, rtol=1e-12)
    assert_allclose(frame.loc[("C1", "collapse_water"), "at_least"], 1e6 * beam["collapse_water"].low, rtol=1e-12)
    assert_allclose(frame.loc[("C1", "tip"), "at_least"], 1e3 * beam["tip"].low, rtol=1e-12)
    assert set(frame.unit) == {"µm", "V", "g", "µN", "N/m", "mJ/m²", "%"}
    assert frame.form.str.len().min() > 0 < frame.source.str.len().min()


def test_sentences_say_below_which_voltage_and_shock_nothing_touches_and_what_drying_does(found, lengths):
    first, second, third, often, asking = report.sentences(found["C1"])
    assert "does not touch below" in first
    assert " V or a half-sine shock of " in first
    assert "collapses when it is dried from water" in second
    assert "(water)" in third
    assert often.startswith("For 50 touchdowns its simulated limit is ")
    assert asking == "The adhesion energy that a voltage adds is unknown: state voltage_V and dielectric."
    short = layout(beam_answers(lengths, {}, replace(OF, length=60e-6)), OF, 60e-6)
    assert report.sentences(short)[1] == "At 60 µm it stands when it is dried from water and mine."
    between = layout(beam_answers(lengths, {}, replace(OF, length=230e-6)), OF, 230e-6)
    assert (
        "may collapse when it is dried from water, and stands when it is dried from mine"
        in report.sentences(between)[1]
    )
    stopper, _ = report.sentences(found["S1"])
    assert stopper.startswith("It does not touch below ")


def test_no_text_of_a_row_decides_about_a_sentence(found):
    """With a placeholder in place of every text, sentences say the same but for that text."""
    for dataset in found.values():
        texts = sorted(map(str, dataset.what.values), key=len, reverse=True)
        blank = dataset.assign(what=("answer", ["@"] * len(texts)))
        expected = report.sentences(dataset)
        for text in texts:
            expected = [sentence.replace(text, "@") for sentence in expected]
        assert report.sentences(blank) == expected


def test_the_figure_has_a_row_for_every_length_between_its_label_and_its_number(found):
    figure = report.figure(found, dict.fromkeys(found))
    save(figure)  # lays it out
    for panel, dataset, unit in zip(figure.axes, found.values(), "mN", strict=True):
        shown = [one for one in answers_of(dataset) if one.unit == unit and np.isfinite(one.high)]
        labels = [" ".join(label.get_text().split()) for label in panel.get_yticklabels()]
        assert labels == [one.what.partition(":")[0] for one in shown]
        for one, text in zip(shown, panel.texts, strict=True):
            assert text.get_text().split()[-1] == report.significant(one.high * 1e6, up=unit == "N")
        boxes = [text.get_window_extent() for text in panel.texts]
        assert panel.bbox.x1 <= min(box.x0 for box in boxes), "beside the panel"
        assert figure.bbox.x1 >= max(box.x1 for box in boxes)
    assert not covering(figure)


@pytest.mark.parametrize("height", [1.8, 9.0])
def test_the_rows_on_a_page_are_apart_also_where_their_height_is_underestimated(found, monkeypatch, height):
    """A page breaks labels into many lines, and its legend has an entry a line."""

    def closest():
        with on_a_page():
            figure = report.figure({"C1": found["C1"]}, {"C1": None})
        strips(figure)  # lays it out
        labels = [label.get_window_extent() for label in figure.axes[0].get_yticklabels()]
        return min((upper.y0 - lower.y1) / figure.dpi for upper, lower in pairwise(labels))

    monkeypatch.setattr(report.dots, "height", lambda labels: height)
    assert closest() > 0.03
    monkeypatch.setattr(report.dots, "heighten", lambda figure, panels: None)
    assert (closest() < 0) == (height < 2), "a control: they are not by themselves"


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_limits_that_do_not_allow_the_size_to_build_are_red(found, factor):
    """A length is too small below the size to build, a force too large above it."""
    for name, dataset in found.items():
        is_length = np.isfinite(float(dataset.length))
        shown = [one for one in answers_of(dataset) if one.unit == "mN"[not is_length] and np.isfinite(one.high)]
        ends = [one.high if not is_length or np.isnan(one.low) else one.low for one in shown]
        build = factor * min(ends) if is_length else max(ends) / factor
        unit = "mN"[not is_length]
        built = Answer(name, "", 1e-3, unit, build, build, (), ())
        stricter = unasked(dataset, built)
        names = {limit.name for limit in stricter}
        (panel,) = report.figure({name: dataset}, {name: replace(built, unasked=stricter)}).axes
        texts = {round(text.xy[1]): text.get_text() for text in panel.texts}
        for k, one in enumerate(shown):
            assert ("exact: " in texts[k]) == (one.name in names)
            assert ("at most " in texts[k]) == (is_length and np.isnan(one.low)), "no safe length"
        red = [round(text.xy[1]) for text in panel.texts if text.get_color() == report._SHORT]  # noqa: SLF001
        short = [k for k, end in enumerate(ends) if (end < build if is_length else end > build)]
        assert red == [k for k, one in enumerate(shown) if k in short or one.name in names]
        assert {shown[k].name for k in short} <= names, "errors of the inputs make limits stricter"
        if factor > 1:
            assert short
        beside = replace(built, unasked=stricter)
        said = " ".join(report.judged_without(beside))
        assert all(safe_size(limit.size, built.sought) in said for limit in stricter), "said as it is drawn"
        assert ("Several at once can be stricter" in said) == (
            len(words.stricter(replace(built, unasked=stricter))) > 1
        )


def test_beams_of_which_no_length_is_known_to_come_free_may_stay_down_below_its_upper_bound(found):
    dataset = found["C1"]
    is_release = dataset.answer.str.startswith(Name.RELEASED)
    assert is_release.any()
    for lows, may in ((dataset.low, False), (dataset.low.where(~is_release), True)):
        said = " ".join(report.sentences(dataset.assign(low=lows)))
        assert ("; shorter ones may, too" in said) == may


def test_a_page_says_the_life_and_shows_all_answers(found):
    page = Page("C1", {}, ["Build it so.", "Because."], [Section("First"), Section("Last")])
    built = Answer("C1", "cantilever", 1e-3, "m", 5e-5, 6e-5, (), ())
    shown = with_life(page, "C1", found["C1"], built)
    assert shown.answer == [*report.sentences(found["C1"], 5e-5), "Build it so.", "Because."]
    assert shown.answer[0].startswith("The length to build, 50 µm, ")
    assert "50 µm" not in with_life(page, "C1", found["C1"], replace(built, forbidden=("x",))).answer[0]
    first = replace(page, summary=Summary("good", "Length to build", "50 µm.", ["Inside: all."], {}, pd.DataFrame()))
    for build, is_named in ((5e-5, False), (1e-3, True)):
        answer = replace(built, build=build)
        answer = replace(answer, unasked=unasked(found["C1"], answer))
        summary = with_life(first, "C1", found["C1"], answer).summary
        assert summary.basis[1:] == report.judged_without(answer)
        assert any("if water dries on it" in sentence for sentence in summary.basis) == is_named
    assert [section.title for section in shown.sections] == ["First", "From the first contact to the last", "Last"]
    on_a_phone = ["what", "at least", "at most", "±", "unit"]
    assert list(shown.sections[1].cells) == [*on_a_phone, "question", "form", "source"]
    assert len(shown.sections[1].cells) == found["C1"].sizes["answer"]
    assert "does not touch below" in shown.html

"""Voltage that frees stoppers: brute force over voltages, flats, and what life says of it."""

from dataclasses import replace

import numpy as np
import pytest
import small
import xarray as xr
from answers import stopper_dataset
from lives import STOPPER
from numpy.testing import assert_allclose
from test_at_voltage import at

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.environment import Gaps
from stiction.contact.voltage import Capacitor, Dielectric, freeing_potential
from stiction.life.freeing import freeing_potential_of_flats
from stiction.report.devices import life as report
from stiction.stages.contact import curves
from stiction.stages.devices import stoppers
from stiction.stages.life.answers import layout
from stiction.stages.life.stoppers import stopper_answers

AREA = 9e-12
OXIDE = Dielectric(100e-9, 4.0)
ACROSS = Gaps(HAMAKER_CONSTANT, "water", 100e-9)


@pytest.mark.parametrize("gaps", [None, ACROSS], ids=["summits", "gaps"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 1.0])
def test_a_patch_is_stuck_at_a_voltage_where_its_force_exceeds_the_pull(gaps, share):
    contact, water = small.contact_of_pair(), replace(at(1.0), gaps=gaps)
    pull = np.quantile(curves.pull_offs(contact, 0.67, water), share)
    free_below = curves.freeing_potentials(contact, 0.67, water, pull)
    for volts in (0.5, 1.0, 3.0, 10.0, 30.0):
        held = curves.pull_offs(contact, 0.67, replace(water, capacitor=Capacitor(OXIDE, volts)))
        edge = np.isclose(free_below, volts, rtol=1e-5)
        assert np.all((held > pull) == (free_below < volts), where=~edge)
    assert np.any(free_below == 0) == (share < 1)


def test_the_voltage_rises_with_the_pull_and_is_that_at_which_the_force_is_the_pull():
    contact, water = small.contact_of_pair(), at(0.0)
    largest = curves.pull_offs(contact, 0.67, water).max()
    found = [curves.freeing_potentials(contact, 0.67, water, factor * largest) for factor in (1.1, 1.5, 3.0)]
    assert np.all(np.diff(found, axis=0) > 0)
    for k in range(0, len(found[0]), 7):
        volts = Capacitor(OXIDE, found[0][k])
        assert_allclose(curves.pull_offs(contact, 0.67, replace(water, capacitor=volts))[k], 1.1 * largest, rtol=1e-6)


def test_flats_are_freed_at_the_closed_form_and_hold_at_lower_voltages_than_rough_patches():
    capacitor = Capacitor(OXIDE)
    spare = 2e-6
    volts = freeing_potential_of_flats(spare, capacitor, AREA)
    assert_allclose(Capacitor(OXIDE, volts).largest_pressure * AREA, spare, rtol=1e-12)
    assert freeing_potential_of_flats(-spare, capacitor, AREA) == 0
    assert freeing_potential(lambda squared: squared + 1, 5.0) == 0
    contact, water = small.contact_of_pair(), at(0.0)
    alone = curves.pull_offs(contact, 0.67, water)
    for pull in 1.2 * alone.max(), 5 * alone.max():
        flat = [freeing_potential_of_flats((pull - one) * AREA, capacitor, AREA) for one in alone]
        assert np.all(curves.freeing_potentials(contact, 0.67, water, pull) >= flat)


def test_a_stage_at_a_voltage_has_a_potential_for_each_patch_and_humidity():
    own = stoppers.Settings(1, at(2.0), (1.5e-6, 6e-6), (0.67, 0.88), (0.85, 0.9), restoring_force=18e-6)
    found, contact = stoppers.compute_at_voltage(small.contact_of_pair(), own), small.contact_of_pair()
    for humidity in own.humidities:
        expected = curves.freeing_potentials(contact, humidity, own.water, 18e-6 / AREA)
        assert_allclose(found.freeing_potential.sel(humidity=humidity), expected, rtol=1e-12)
    plain = found.drop_vars("freeing_potential")
    xr.testing.assert_identical(plain, stoppers.compute(contact, own))


def biased_dataset(of, factor):
    """Stopper at a voltage, with potentials larger than those of flats by a factor."""
    dataset = stopper_dataset()
    spare = of.restoring_force - dataset.pull_off
    per_area = of.capacitor.per_volt.largest_pressure * AREA
    return dataset.assign(freeing_potential=factor * np.sqrt(np.maximum(spare, 0) / per_area))


@pytest.mark.parametrize("offset", [0.0, -0.5])
def test_life_frees_all_but_a_share_between_flats_and_rough_patches(offset):
    strong = 1.5 * float(stopper_dataset().pull_off.max())
    of = replace(STOPPER, restoring_force=strong, voltage=5.0, offset=offset, dielectric=OXIDE)
    for factor in (1.0, 3.0):
        biased = biased_dataset(of, factor)
        one = {each.name: each for each in stopper_answers(stopper_dataset(), of, biased)}["freeing_voltage"]
        assert_allclose(one.high + abs(offset), factor * (one.low + abs(offset)), rtol=1e-9)
        # At the voltage of flats, at most the share is held by the force of the voltage as well.
        added = Capacitor(OXIDE, one.low + abs(offset)).largest_pressure * AREA
        assert (stopper_dataset().pull_off + added > strong).mean("sample").max() < 0.01
    said = report.sentences(layout(stopper_answers(stopper_dataset(), of, biased), of))
    what = "voltage below which its spring frees all but 1 in 100"
    assert any(sentence.startswith(f"The {what} is ") for sentence in said)
    blank = [each._replace(what="@") for each in stopper_answers(stopper_dataset(), of, biased)]
    assert any(sentence.startswith("The @ is ") for sentence in report.sentences(layout(blank, of))), "no text decides"


def test_a_spring_too_weak_without_voltage_frees_at_none():
    of = replace(STOPPER, restoring_force=1e-9, voltage=5.0, dielectric=OXIDE)
    answers = stopper_answers(stopper_dataset(), of, biased_dataset(of, 2.0))
    one = {each.name: each for each in answers}["freeing_voltage"]
    assert (one.low, one.high) == (0, 0)
    said = report.sentences(layout(answers, of))
    none = "There is no voltage below which its spring frees all but 1 in 100:"
    assert any(sentence.startswith(none) for sentence in said)

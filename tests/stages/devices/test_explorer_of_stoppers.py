"""Views of the page of a stopper: forces, stiffnesses and tilts, as its stages state them."""

from dataclasses import replace

import answered
import numpy as np
import pytest
import small
from lives import STOPPER as LIFE
from numpy.testing import assert_allclose
from test_at_voltage import at
from test_stage_stoppers import SETTINGS

from stiction.contact.voltage import Capacitor, Dielectric
from stiction.report.devices import explorer, voltage_views
from stiction.stages.contact import curves
from stiction.stages.devices import stoppers
from stiction.stages.life.stoppers import stopper_answers

FORCES = 1e-6 * np.exp(0.2 * np.random.default_rng(4).normal(size=4000))
AXIS = np.linspace(0.5, 0.9, 5)
FACTORS = 1 + AXIS
SECTION = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": [0.88, 0.67], "tilt_deg": [0, 0.5]}
SPRING, STATED = {"stiffness_N_per_m": 2.0, "gap_um": 0.5}, {"restoring_force_uN": 1.0}


@pytest.fixture(scope="module")
def stopper():
    chosen = (1 + np.array([SETTINGS.humidities]).T) * FORCES
    return stoppers.layout(replace(SETTINGS, restoring_force=1e-6), chosen, AXIS, FACTORS[:, None] * FORCES)


@pytest.mark.parametrize(("stated", "unit"), [(STATED, 1e-6), (SPRING, 0.5e-6)])
def test_a_stopper_has_at_every_humidity_the_forces_or_stiffnesses_of_its_stage(stopper, stated, unit):
    grid = explorer.stopper_view(SECTION | stated, stopper, answered.of_stopper(stopper)).grid
    key = next(iter(stated))
    assert grid.start[key] == pytest.approx(1e-6 / unit)
    assert grid.start["humidity"] == float(stopper.humidity[1]), "the stated one that holds most"
    for k, humidity in enumerate(AXIS):
        state = grid.start | {"humidity": humidity, "share": 1e-3}
        safe = float(stopper.safe_force_along.sel(share=1e-3)[k]) / unit
        assert grid.safe_size(state) == pytest.approx(safe, rel=1e-9)
        force = FACTORS[k] * np.quantile(FORCES, 0.8)
        share = np.mean(FACTORS[k] * FORCES > force)
        assert grid.stuck(state | {key: force / unit}).share == pytest.approx(share, abs=0.005)
    between = grid.start | {"humidity": 0.65, key: 1.65 * np.median(FORCES) / unit}
    assert grid.stuck(between).share == pytest.approx(0.5, abs=0.02)


def test_a_stopper_with_few_patches_has_fractions_and_no_sufficient_force():
    few = FORCES[:60]
    settings = replace(SETTINGS, restoring_force=1e-6)
    found = stoppers.layout(settings, np.stack([few, 2 * few]), AXIS, FACTORS[:, None] * few)
    with np.errstate(invalid="ignore"):  # no force is bounded
        answer = answered.of_stopper(found)
    grid = explorer.stopper_view(SECTION | STATED, found, answer).grid
    assert np.isnan(grid.safe_size(grid.start))
    assert 0 < grid.stuck(grid.start | {"humidity": 0.5, "restoring_force_uN": 1.5}).share < 1


def test_a_tilted_stopper_is_answered_at_its_tilts_and_humidities_alone(stopper):
    slopes = (0.0, 1e-3, 2e-3)
    settings = stoppers.Tilted(**vars(replace(SETTINGS, restoring_force=1e-6)), slopes=slopes)
    factors = np.array([1, 0.5, 0.25])
    pull_off = factors[:, None, None] * np.stack([FORCES, 2 * FORCES])
    tilted = stoppers.layout_tilted(settings, pull_off, np.array([3e-4, 5e-4]))
    view = explorer.tilted_view("S1", SECTION | STATED, tilted, stopper)
    tilt, humidity = view.grid.axes
    assert view.grid.start["humidity"] == humidity.values[1], "the one that holds most"
    assert_allclose(np.tan(np.radians(tilt.values)), slopes, rtol=1e-5)
    for value, factor in zip(tilt.values, factors, strict=True):
        for k, rh in enumerate(humidity.values):
            force = factor * (1 + k) * np.quantile(FORCES, 0.7)
            state = view.grid.start | {"tilt_deg": value, "humidity": rh, "restoring_force_uN": 1e6 * force}
            assert view.grid.stuck(state).share == pytest.approx(0.3, abs=0.005)
            safe = tilted.safe_force.sel(part="safe", humidity=rh, share=state["share"])
            assert view.grid.safe_size(state) == pytest.approx(1e6 * float(safe[list(factors).index(factor)]), rel=1e-9)
    with pytest.raises(ValueError, match=r"devices\.S1\.tilt_deg changes this"):
        view.grid.safe_size(view.grid.start | {"tilt_deg": 0.01})


OXIDE = {"dielectric": {"thickness_nm": 100, "permittivity": 4.0}, "voltage_V": 5, "offset_V": -0.5}


@pytest.mark.slow
def test_a_stopper_at_a_voltage_has_the_fractions_of_its_stage_at_any_other_one():
    contact = small.contact_of_pair()
    pull = np.quantile(curves.pull_offs(contact, 0.88, at(2.0)), 0.7)
    own = stoppers.Settings(1, at(2.0), (1.5e-6, 6e-6), (0.88, 0.67), (0.85, 0.9), restoring_force=9e-12 * pull)
    biased = stoppers.compute_at_voltage(contact, own)
    view = voltage_views.stopper_view("S1", SECTION | STATED | OXIDE | {"voltage_V": 2}, biased)
    patches, shares = biased.sizes["sample"], []
    assert view.grid.start["voltage_V"] == 2
    for humidity in own.humidities:
        for volts in np.random.default_rng(2).uniform(*view.grid.size.values, 25):
            water = replace(own.water, capacitor=Capacitor(own.water.capacitor.dielectric, volts, -0.5))
            held = np.mean(curves.pull_offs(contact, humidity, water) > pull)
            stuck = view.grid.stuck(view.grid.start | {"humidity": humidity, "voltage_V": volts})
            shares.append(held)
            assert abs(stuck.share - held) < 2 * np.sqrt(held * (1 - held) / patches) + 1 / patches
    assert 0.1 < np.mean(shares) < 0.9
    with pytest.raises(ValueError, match=r"computed at 0\.67, 0\.88 alone"):
        view.grid.stuck(view.grid.start | {"humidity": 0.7})


def biased(stopper, potentials):
    """Dataset of a stopper at a voltage, with potentials that free its patches (n_rh, m)."""
    return stopper.assign(freeing_potential=(("humidity", "sample"), potentials))


def test_the_voltage_that_frees_a_stopper_is_that_of_its_life(stopper):
    potentials = np.stack([12 * FORCES, 10 * FORCES]) * 1e6
    found = biased(stopper, potentials)
    of = replace(LIFE, restoring_force=1e-6, voltage=5.0, offset=-0.5, dielectric=Dielectric(100e-9, 4.0))
    answers = {one.name: one for one in stopper_answers(stopper, of, found)}
    grid = voltage_views.stopper_view("S1", SECTION | STATED | OXIDE, found).grid
    assert grid.start["share"] == 1e-3, "the smallest one with a bound"
    assert grid.safe_size(grid.start) == pytest.approx(answers["freeing_voltage"].high, rel=1e-9)
    assert explorer.stopper_view(SECTION | STATED, stopper, answered.of_stopper(stopper)).grid.share.setting == "", (
        "a stopper has no key of it"
    )


def test_no_voltage_beyond_breakdown_and_none_of_a_spring_that_is_too_weak_has_an_answer(stopper):
    strong = voltage_views.stopper_view(
        "S1", SECTION | STATED | OXIDE, biased(stopper, np.stack([2000 * FORCES / 1e-6] * 2))
    )
    assert strong.grid.size.values[1] <= 1.05 * 99.5
    assert np.isnan(strong.grid.stuck(strong.grid.start).share)
    weak = voltage_views.stopper_view("S1", SECTION | STATED | OXIDE, biased(stopper, np.zeros((2, len(FORCES)))))
    assert np.isnan(weak.grid.safe_size(weak.grid.start))
    assert (weak.grid.stuck(weak.grid.start).beyond, weak.grid.stuck(weak.grid.start).share > 0.99) == (1, True)
    assert "does not free them without voltage" in weak.words["none"]

"""Fast separation of devices on the contact of a small study, without another contact than that of slow separation."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose
from scipy.integrate import trapezoid

from stiction.config.files import load
from stiction.contact.environment import Gaps, Water
from stiction.contact.separation import keep_volume
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.run import storage
from stiction.stages.contact import curves
from stiction.stages.devices import separation

WATER = Water(300.0)
ACROSS = replace(WATER, gaps=Gaps({"water": 9.75e-20, "dry": 18.65e-20}, "water", 100e-9))
PATCH = (1.5e-6, 6e-6)
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0, 0.67]}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44, 0.67]}


@pytest.fixture(scope="module")
def contacts():
    return dict.fromkeys((0.44, 0.67, 0.92), small.contact_of_pair())


def test_every_patch_holds_at_least_as_much_as_slowly(contacts):
    found = separation.compute(contacts, separation.Settings(ACROSS, PATCH)).pull_off
    for humidity in contacts:
        slow = curves.pull_offs(small.contact_of_pair(), humidity, ACROSS) * PATCH[0] * PATCH[1]
        ratio = found.sel(humidity=humidity).values / slow
        assert np.all(ratio >= 1 - 1e-12)
        assert ratio.mean() > 1.01


@pytest.mark.parametrize("water", [WATER, ACROSS])
def test_strips_need_more_energy_and_the_least_in_wet_air(contacts, water):
    found = separation.compute(contacts, separation.Settings(water))
    assert np.all(found.energy_ratio - 4 * found.energy_ratio_error > 1)
    fast, slow = (of(small.contact_of_pair(), 0.44, water) for of in (curves.fast_energies, curves.energies))
    assert np.all(fast > slow)
    assert_allclose(found.energy_ratio.sel(humidity=0.44), fast.mean() / slow.mean(), rtol=1e-12)


def test_what_fast_separation_needs_more_is_the_work_of_the_water_alone():
    contact = small.contact_of_pair()
    slow, layer = curves.force_curves(contact, 0.67, ACROSS), ACROSS.film(0.67)
    more = []
    for k in range(slow.samples):
        force, areas = slow.curve(k).copy(), contact.bearing_area.values[k]
        fast, left = keep_volume(force, slow.distance, areas, float(contact.height[0]), layer)
        more.append(trapezoid(force - fast, slow.distance) + left)
    difference = curves.fast_energies(contact, 0.67, ACROSS) - curves.energies(contact, 0.67, ACROSS)
    assert_allclose(difference, more, rtol=1e-3)


def test_the_error_of_a_ratio_is_the_scatter_of_ratios_on_other_strips():
    rng, contact = np.random.default_rng(1), small.contact_of_pair()
    energies = np.array([of(contact, 0.44, WATER) for of in (curves.fast_energies, curves.energies)])
    again = [energies[:, rng.integers(20, size=20)].mean(axis=1) for _ in range(2000)]
    scatter = np.std([fast / slow for fast, slow in again])
    assert_allclose(separation.energy_ratio(contact, 0.44, WATER)[1], scatter, rtol=0.2)


def test_strips_that_no_summits_stop_have_no_bound():
    flat = small.contact_of_pair().copy(deep=True)
    flat.solid_pressure[0] = 0.0
    assert np.isinf(curves.fast_pull_offs(flat, 0.67, ACROSS)[0])
    assert np.isfinite(curves.fast_pull_offs(flat, 0.67, ACROSS)[1:]).all()
    ratio, error = separation.energy_ratio(flat, 0.67, ACROSS)
    assert np.isinf(ratio)
    assert np.isnan(error)


def test_only_humid_air_has_a_fast_separation_and_on_the_contact_of_the_device():
    coated = {"surfaces": dict.fromkeys(("B2", "Sub1"), {"material": "FDTS"}), "run": {"pairs": ["b"]}}
    for more, humid in (({}, [0.67]), (coated | {"materials": {"FDTS": {"contact_angle_deg": 110}}}, [])):
        graph = Graph(Plan(load({"devices": {"C1": BEAM, "S1": STOPPER}} | more)))
        inputs = graph.job("devices/life/C1").inputs
        assert ("separation" in inputs) == bool(humid)
        if humid:
            contacts = graph.job("devices/separation/C1").inputs["contacts"]
            assert list(contacts) == humid
            assert contacts[0.67] == graph.job("devices/cracks/C1_rh067").inputs["contact"]
    dry = Graph(Plan(load({"devices": {"C1": BEAM | {"humidities": ["dry"]}}})))
    assert "separation" not in dry.job("devices/life/C1").inputs


def test_a_dataset_comes_back_from_its_file(contacts, tmp_path):
    for settings in (separation.Settings(WATER), separation.Settings(WATER, PATCH)):
        found = separation.compute(contacts, settings)
        storage.save(found, tmp_path / "one.nc", "separation", {})
        assert storage.load(tmp_path / "one.nc", "separation").equals(found)

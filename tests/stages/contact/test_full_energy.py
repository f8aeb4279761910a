"""Energies by levels for the beams of devices: of strips, as data, as corrections, and in a plan."""

import numpy as np
import pytest
import small
from answers import CANTILEVER, STOPPER
from numpy.testing import assert_allclose
from plans import job_settings
from test_corrections import study

from stiction.analysis.levels import FINE, SUMMITS, Ratio
from stiction.config.cases import Case
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.correction import NONE
from stiction.errors import NotConverged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.contact import corrections, full_contact, full_energy, pair_model_error
from stiction.stages.devices import device_model_error
from stiction.stages.devices.opening import EITHER, MIDDLE, S_SHAPE, DesignedBeam

SIZE = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
BRIDGE = SIZE | {"kind": "bridge", "gap_um": 2, "thickness_um": 2, "residual_stress_MPa": 50, "humidities": [0.67]}
ENERGY = "studies/full_contact/energy/b_rh044"


def found(ratio, error, power=1.2):
    """Dataset of energies with a ratio and its relative error."""
    strips = {SUMMITS: 64, FINE: 4, 2: 10, 3: 64}
    values = Ratio(ratio, error, power, 0.05, (FINE, 2, 3, SUMMITS), strips, 0.2)
    return full_energy.layout(values, (2e-3, 1e6))


UNKNOWN = full_energy.layout(full_energy.UNKNOWN, (np.nan, np.nan), "it does not settle")
BY_HUMIDITY = {
    ("b", 0.67): found(0.9, 0.02),
    ("b", 0.44): found(0.7, 0.03),
    ("b", 0.8): found(1.1, 0.2),
    ("b", 0.9): UNKNOWN,
}


@pytest.fixture(scope="module")
def strips():
    """Strips of a narrow pair b at RH 0.44."""
    settings = in_si(full_energy.Settings, job_settings(small.PLAN, ENERGY))
    return full_energy.strips_of(small.surfaces(), "b", settings)


@pytest.mark.slow
def test_the_state_from_a_coarse_one_has_the_energy_of_the_whole_separation(strips):
    """The whole separation begins without attraction, on the fine grid alone."""
    level = strips.levels[FINE]
    for place in range(3):
        nested = strips.value(FINE, place)
        heights = strips.heights(strips.resisting[place])
        separated = full_contact.separated(
            level.space, heights, full_contact.InAir(level.adhesion, strips.curves[place], 0.0)
        )
        assert nested == pytest.approx(separated.adhesion_energy, rel=4e-3)


@pytest.mark.slow
def test_a_coarse_grid_scatters_less_about_full_contact_than_summits_do(strips):
    values = {level: np.array([strips.value(level, k) for k in range(6)]) for level in (FINE, 2, 3, SUMMITS)}
    scatter = {level: np.std(np.log(values[FINE] / values[level])) for level in (2, 3, SUMMITS)}
    assert scatter[2] < scatter[3] < scatter[SUMMITS]
    assert scatter[2] < 0.05


@pytest.mark.slow
def test_energies_on_summits_are_those_of_the_contact_of_the_same_strips(strips):
    airs = full_contact._airs(small.surfaces(), "b", strips_settings(), 2)[1][0]
    assert_allclose([strips.value(SUMMITS, k) for k in range(2)], [airs(k).on_summits[0] for k in range(2)], rtol=1e-5)


def strips_settings():
    """Settings of the strips of these tests."""
    return in_si(full_energy.Settings, job_settings(small.PLAN, ENERGY))


def test_energies_that_are_not_found_correct_nothing(monkeypatch):
    def fails(*_):
        raise NotConverged("full elastic contact does not settle", 1.0, 0.1, 3)

    monkeypatch.setattr(full_energy, "strips_of", fails)
    unknown = full_energy.compute([], Case("b_rh044"), strips_settings())
    assert "does not settle" in unknown.reason
    assert not unknown.applied
    assert np.isnan(unknown.ratio)


def test_beams_are_corrected_where_the_error_allows_and_forces_nowhere():
    error = pair_model_error.of_devices(BY_HUMIDITY)
    assert error.applied.values.tolist() == [True, True, False, False]
    changes = corrections.applied(error)
    energy, pull_off = changes.at(0.44)
    assert energy[:3] == pytest.approx((0.7, 1.2, 0.03))
    for humidity in (0.44, 0.5, 0.67, 0.8, 0.9):
        assert changes.at(humidity)[1] == NONE
    assert changes.at(0.8)[0] == changes.at(0.9)[0] == NONE
    assert changes.at(0.43)[0] == energy
    assert pull_off == NONE


def test_dry_air_keeps_its_own_corrections_beside_humid_air():
    dry = study().isel(humidity=[0]).assign_coords(humidity=[0.0])
    joined = corrections.applied(pair_model_error.of_devices(BY_HUMIDITY, dry))
    alone = pair_model_error.compute(dry, pair_model_error.Settings((0.0,), (0.0,)))
    for change, expected in zip(joined.at(0.0), corrections.applied(alone).at(0.0), strict=True):
        assert change == pytest.approx(expected)
    assert joined.at(0.44)[0].ratio == pytest.approx(0.7)


def designed(section):
    """Beam of a section."""
    plan = Plan(load({"devices": {"One": section}}))
    return in_si(DesignedBeam, job_settings(plan, "devices/model_error/One")["device"])


def test_the_change_of_a_length_is_the_fourth_root_of_that_of_the_energy():
    by_levels = pair_model_error.of_devices(BY_HUMIDITY)
    device = in_si(
        DesignedBeam, job_settings(Plan(load({"devices": {"C1": CANTILEVER}})), "devices/model_error/C1")["device"]
    )
    settings = device_model_error.Settings((0.44, 0.9), device, by_levels=True)
    changed = device_model_error.compute(settings, by_levels=by_levels)
    assert float(changed.factor.sel(shape=S_SHAPE, humidity=0.44)) == pytest.approx(0.7**-0.25, rel=1e-6)
    assert float(changed.factor_error.sel(shape=S_SHAPE, humidity=0.44)) == pytest.approx(
        0.7**-0.25 * 0.03 / 4, rel=0.03
    )
    assert np.isnan(changed.factor.sel(shape=EITHER)).all()
    assert np.isnan(changed.factor.sel(humidity=0.9)).all()
    assert changed.applied.values.tolist() == [True, False]


def test_a_bridge_changes_less_than_by_its_energy_because_its_force_stays():
    device = in_si(
        DesignedBeam, job_settings(Plan(load({"devices": {"R1": BRIDGE}})), "devices/model_error/R1")["device"]
    )
    settings = device_model_error.Settings((0.44,), device, by_levels=True)
    changed = device_model_error.compute(settings, by_levels=pair_model_error.of_devices(BY_HUMIDITY))
    assert 1 < float(changed.factor.sel(shape=MIDDLE, humidity=0.44)) < 0.7**-1


@pytest.mark.parametrize(("model", "of_beam"), [(None, "devices"), ("summits", None), ("full", "across")])
def test_by_default_beams_of_devices_have_energies_by_levels_and_stoppers_and_pairs_have_none(model, of_beam):
    contact = {"contact": {"model": model}} if model else {}
    chart = {"thicknesses_um": [2, 2.6], "humidities": [0.5, 0.8]}
    devices = {"C1": CANTILEVER | {"humidities": [0.44, 0.67], "chart": chart}, "R1": BRIDGE, "S1": STOPPER}
    plan = Plan(load(contact | {"devices": devices, "run": {"pairs": ["b"]}}))
    graph = Graph(plan)
    of_ground = graph.job("devices/ground/b_rh067_1500x30000").inputs.get("model_error")
    assert of_ground == (f"studies/model_error/{of_beam}/b" if of_beam else None)
    assert ("model_error" in graph.job("devices/stoppers/S1").inputs) == (model == "full")
    assert ("model_error" in graph.job("forces/b_rh067_NG").inputs) == (model == "full")
    if model is None:
        energies = graph.job("studies/model_error/devices/b").inputs["energies"]
        assert {humidity for _, humidity in energies} == {0.44, 0.67, *plan.devices.axis("C1")}
        assert "study" not in graph.job("studies/model_error/devices/b").inputs

"""Stoppers on the contact of a small study."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal

from stiction.config.files import load
from stiction.contact.correction import Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.devices.risk import samples_for
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.run import storage
from stiction.stages.contact import curves
from stiction.stages.devices import stoppers

WATER = Water(300.0)
AREA = 1.5e-6 * 6e-6
SETTINGS = stoppers.Settings(1, WATER, (1.5e-6, 6e-6), (0.67, 0.88), (0.85, 0.9), restoring_force=18e-6)


@pytest.fixture(scope="module")
def found():
    return stoppers.compute(small.contact_of_pair(), SETTINGS)


def synthetic(samples, restoring=1.0, peak=0.7):
    """Dataset of patches whose forces are the numbers 1, 2, ... over 100, largest at a humidity."""
    forces = np.arange(1, samples + 1) / 100
    axis = np.linspace(0.5, 0.9, 21)
    along = (1 - (axis[:, None] - peak) ** 2) * forces
    return stoppers.layout(replace(SETTINGS, restoring_force=restoring), np.stack([forces, 2 * forces]), axis, along)


def test_the_pull_off_force_is_the_f_max_of_the_force_laws_times_the_area(found):
    for humidity in SETTINGS.humidities:
        vectors, _ = curves.vectors(small.contact_of_pair(), humidity, WATER)
        assert_allclose(found.pull_off.sel(humidity=humidity), vectors[:, 1] * AREA, rtol=1e-12)


def test_a_device_humidity_and_the_same_point_of_the_axis_have_the_same_forces():
    both = stoppers.compute(small.contact_of_pair(), replace(SETTINGS, humidities=(0.9,)))
    assert_allclose(both.mean_along[-1], both.pull_off.sel(humidity=0.9).mean(), rtol=1e-14)
    assert_allclose(both.quantile_along[:, -1], np.quantile(both.pull_off, [0.05, 0.5, 0.95]), rtol=1e-14)


def test_the_worst_humidity_is_sought_at_the_temperature_of_the_conditions(found):
    """Two conditions at 350 K are a stopper whose water has 350 K, also between and beyond them."""
    ends = {"0.67": 50.0, "0.88": 50.0}
    warm = stoppers.compute(small.contact_of_pair(), replace(SETTINGS, water=Water(300.0, warmer=ends)))
    stated = stoppers.compute(small.contact_of_pair(), replace(SETTINGS, water=Water(350.0)))
    for name in ("mean_along", "pull_off", "share_flat", "worst_humidity"):
        assert_allclose(warm[name], stated[name], rtol=1e-12)
    assert (found.mean_along > 1.05 * warm.mean_along).all()  # control: at 300 K the tension is larger


def test_between_two_conditions_the_temperature_follows_the_humidity():
    water = Water(300.0, warmer={"0.4": 25.0, "0.8": -15.0, "0.6": 99.0})  # the last one is of another device
    along = water.between([0.8, 0.4], [0.3, 0.4, 0.5, 0.6, 0.8, 0.9])
    assert_allclose([along.temperature_at(air) for air in (0.3, 0.4, 0.5, 0.6, 0.8, 0.9)],
                    [325, 325, 315, 305, 285, 285])  # fmt: skip
    assert along.temperature_at(0.7) == 300
    assert Water(300.0).between([0.4], [0.5]) == Water(300.0)


def test_the_fine_axis_has_its_ends_and_a_point_at_every_percent():
    assert_allclose(stoppers.fine_axis(0.4, 0.98), np.arange(40, 99) / 100)
    assert_allclose(stoppers.fine_axis(0.9, 0.905), [0.9, 0.9025, 0.905])


def test_the_error_of_the_scatter_in_full_contact_moves_rare_forces_and_no_middle_one():
    correction = Correction(np.array([0.4, 0.99]), ElasticChange(1.0), ElasticChange(1.0, 1.2, 0.0, 0.24))
    wide = replace(SETTINGS, water=replace(WATER, correction=correction))
    forces, axis = np.exp(0.5 * np.random.default_rng(1).normal(size=2000)), np.linspace(0.5, 0.9, 21)
    both = [stoppers.layout(one, np.stack([forces] * 2), axis, np.stack([forces] * 21)) for one in (SETTINGS, wide)]
    rare = both[0].safe_force.isel(humidity=0).sel(share=0.01)
    margins = [
        np.log(one.safe_force.isel(humidity=0).sel(share=0.01, part="safe") / rare.sel(part="estimate")) for one in both
    ]
    moved = 0.2 * np.log(rare.sel(part="estimate") / np.median(forces))
    assert_allclose(margins[1], np.hypot(margins[0], 1.6449 * moved), rtol=1e-4)
    assert_allclose(both[1].mean_along_error, both[0].mean_along_error)
    middle = replace(wide, restoring_force=float(np.median(forces)))
    same = stoppers.layout(middle, np.stack([forces] * 2), axis, np.stack([forces] * 21)).stuck.values[:, 0]
    without = stoppers.layout(replace(middle, water=WATER), *([np.stack([forces] * 2), axis, np.stack([forces] * 21)]))
    assert_array_equal(same, without.stuck.values[:, 0])


@pytest.mark.parametrize("error", [0.0, 0.1])
def test_the_error_of_few_strips_in_full_contact_is_part_of_all_that_is_stated(error):
    """Margins of independent errors add by their squares; the estimates stay."""
    correction = Correction(np.array([0.4, 0.99]), ElasticChange(1.0), ElasticChange(1.0, ratio_error=error))
    plain, changed = SETTINGS, replace(SETTINGS, water=replace(WATER, correction=correction))
    forces, axis = np.arange(1, 401) / 100, np.linspace(0.5, 0.9, 21)
    both = [stoppers.layout(one, np.stack([forces] * 2), axis, np.stack([forces] * 21)) for one in (plain, changed)]
    safe, more = (one.safe_force.isel(humidity=0, share=0) for one in both)
    assert_allclose(more.sel(part="estimate"), safe.sel(part="estimate"))
    margins = [np.log(one.sel(part="safe") / one.sel(part="estimate")) for one in (safe, more)]
    assert_allclose(margins[1], np.hypot(margins[0], 1.6449 * error), rtol=1e-4)
    assert_allclose(both[1].mean_along_error, np.hypot(both[0].mean_along_error, error * both[0].mean_along))
    assert_allclose(both[1].full_contact_error, error)
    at = {"restoring_force": 3.0}
    bands = [
        stoppers.layout(replace(one, **at), np.stack([forces] * 2), axis, np.stack([forces] * 21)).stuck.values[:, 0]
        for one in (plain, changed)
    ]
    assert bands[0][0] == bands[1][0]
    assert (bands[1][1] < bands[0][1], bands[1][2] > bands[0][2]) == (error > 0, error > 0)


def test_the_share_stuck_is_that_of_patches_that_hold_more_than_the_restoring_force():
    at = synthetic(400, restoring=1.005)
    ((_, one, low, high), (_, two, _, _)) = stoppers.shares_stuck(at)
    assert_allclose([one, two], [0.75, 350 / 400], rtol=1e-12)
    assert low < one < high
    assert_allclose(at.stuck_along.sel(bound="estimate")[10], one, rtol=1e-12)


def test_safe_forces_are_stated_for_shares_that_the_patches_can_bound():
    at = synthetic(400)
    safe = at.safe_force.sel(humidity=0.67, part="safe")
    assert samples_for(1e-2) <= 400 < samples_for(1e-3)
    assert 3.9 < float(safe.sel(share=1e-2)) <= 4.0
    assert_allclose(at.safe_force.sel(humidity=0.88), 2 * at.safe_force.sel(humidity=0.67), rtol=1e-12)
    assert list(at.basis.values) == ["sampled", "fitted", "extrapolated", "extrapolated"]
    assert np.all(np.diff(safe.values) > 0), "rarer stoppers hold more"


def test_too_few_patches_state_no_safe_force():
    at = synthetic(100)
    assert np.isnan(at.safe_force).all()
    assert set(at.basis.values) == {""}


def test_safe_forces_do_not_depend_on_the_other_humidities():
    both, forces = synthetic(400), np.arange(1, 401) / 100
    alone = stoppers.layout(
        replace(SETTINGS, humidities=(0.67,)), forces[None], np.array([0.6, 0.7]), np.tile(forces, (2, 1))
    )
    assert_array_equal(alone.safe_force.values[:, 0], both.safe_force.values[:, 0])


def test_the_worst_humidity_is_that_of_the_largest_mean_force_unless_it_is_an_end():
    inside, beyond = synthetic(100, peak=0.7123), synthetic(100, peak=0.95)
    assert_allclose(inside.worst_humidity, 0.7123, atol=1e-9)
    assert not stoppers.is_at_an_end(inside)
    assert float(beyond.worst_humidity) == 0.9
    assert stoppers.is_at_an_end(beyond)


def test_safe_forces_along_the_axis_are_those_at_its_humidities():
    axis = np.linspace(0.5, 0.9, 3)
    forces = np.arange(1, 401) / 100
    weak = replace(SETTINGS, restoring_force=1.0)
    at = stoppers.layout(weak, np.stack([forces, 2 * forces]), axis, np.stack([forces, 3 * forces, 2 * forces]))
    assert_array_equal(at.safe_force_along[[0, 2]], at.safe_force.sel(part="safe"))
    stuck, safe = stoppers.in_any_air(at)
    assert_allclose(safe, 3 * at.safe_force_along[0], rtol=1e-12)
    assert stuck == tuple(map(float, at.stuck_along[:, 1]))


def test_the_error_of_the_worst_humidity_contains_the_step_of_the_axis():
    found = synthetic(100, peak=0.7123)  # without scatter: all patches have their peak there
    assert_allclose(found.worst_humidity_error, 0.02 / np.sqrt(12), rtol=1e-9)


def test_a_stopper_comes_back_from_its_file(found, tmp_path):
    storage.save(found, tmp_path / "S1.nc", "stoppers", {})
    again = storage.load(tmp_path / "S1.nc", "stoppers")
    assert stoppers.shares_stuck(again) == stoppers.shares_stuck(found)
    assert_array_equal(again.mean_along, found.mean_along)


def test_a_spring_restores_a_stopper_like_a_force_of_the_same_size():
    force = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 3.0, "humidities": [0.5]}
    spring = {key: value for key, value in force.items() if key != "restoring_force_uN"}
    asked = {"requirement": {"share": 0.001}, "roughness": {"surface": "B2", "rms_nm": [1, 8]}}
    of_spring, of_force, weaker = (
        Graph(Plan(load({"devices": {"S1": one | asked}})))
        for one in (
            spring | {"stiffness_N_per_m": 2, "gap_um": 1.5},
            force,
            spring | {"stiffness_N_per_m": 1, "gap_um": 1.5},
        )
    )
    for job in ("devices/stoppers/S1", "devices/roughness/points/S1_0"):
        assert of_spring.job(job).settings == of_force.job(job).settings
        assert of_spring.job(job).settings != weaker.job(job).settings

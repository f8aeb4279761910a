"""Tilted stoppers: no tilt, less with more of it, the wedge of smooth surfaces, and what life says of them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small
from answers import stopper_dataset
from lives import STOPPER
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.environment import Gaps, Water
from stiction.contact.pair import DistanceGrid
from stiction.plan.devices import TILTS, tilts_of
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.devices import life as report
from stiction.run import storage
from stiction.stages.contact import contact, curves
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices import stoppers
from stiction.stages.life.answers import layout
from stiction.stages.life.stoppers import stopper_answers

SECTION = {"kind": "stopper", "pair": "b", "contact_um": [1.5, 6], "restoring_force_uN": 18, "humidities": [0.67, 0.88]}
DEGREES = [0, 0.0005, 0.02, 0.1, 0.5]


def plan(**devices):
    """Plan of stoppers, by the keys that they have beside the area and the rest."""
    few = {"run": {"pairs": []}, "contact": {"samples": 20}, "attraction": {"reach": "touching"}}
    return Plan(load(few | {"devices": {name: SECTION | keys for name, keys in devices.items()}}))


@cache
def tilted_contact():
    """Contacts at the tilts, which two stoppers of one area share."""
    tilts = {"S1": {"tilt_deg": DEGREES[1:3]}, "S2": {"tilt_deg": DEGREES[3:]}}
    settings = job_settings(plan(**tilts), "devices/contact/tilted/b_1500x6000")
    return contact.compute(small.surfaces(), "b", "NG", in_si(Settings, settings))


def computed(degrees):
    """Dataset of a stopper at some tilts [°]."""
    slopes = tuple(np.tan(np.radians(degrees)))
    shared = in_si(stoppers.Settings, job_settings(plan(S1={}), "devices/stoppers/S1"))
    data = {"contact": small.contact_of_pair(), "tilted": tilted_contact()}
    return stoppers.compute_tilted(data, stoppers.Tilted(**vars(shared), slopes=slopes)), shared


def test_without_tilt_a_stopper_has_the_same_bits():
    (found, shared), data = computed([0.0]), small.contact_of_pair()
    parallel = stoppers.compute(data, replace(shared, worst_humidities=(0.8, 0.82)))
    for name in ("pull_off", "stuck", "safe_force"):
        assert_array_equal(found[name].isel(tilt=0).squeeze(drop=True), parallel[name])


def test_a_small_tilt_changes_little_and_more_tilt_holds_less():
    mean = computed(DEGREES)[0]["mean"].values
    # A row of points at each edge of a tilted patch has no summits: one of 150 rows.
    assert_allclose(mean[1], mean[0], rtol=0.02)
    assert np.all(np.diff(mean[[1, 3, 4]], axis=0) < 0)
    assert np.all(mean[-1] < 0.5 * mean[0])


def test_each_stopper_has_the_patches_at_its_own_tilts():
    every, some = computed(DEGREES)[0], computed(DEGREES[2:4])[0]
    assert_array_equal(every.pull_off[2:4], some.pull_off)
    assert_allclose(np.degrees(some.tilt), DEGREES[2:4], rtol=1e-12)


def test_the_tilt_of_a_wedge_is_that_at_which_energy_over_slope_is_the_force_on_the_area():
    found, shared = computed([0.0])
    for humidity in shared.humidities:
        energy = curves.energies(small.contact_of_pair(), humidity, shared.water).mean()
        force = float(found["mean"].sel(humidity=humidity)[0])
        assert_allclose(energy * shared.contact[1] / float(found.wedge.sel(humidity=humidity)), force, rtol=1e-12)


@pytest.mark.parametrize("length", [3e-6, 30e-6])
def test_smooth_surfaces_hold_the_whole_area_or_the_energy_over_the_slope(length):
    """Water alone, of height h and tension σ, pulls with σ w times the area that it wets: w a, or w h / s."""
    water, humidity, slopes = Water(300.0), 0.67, np.array([1e-6, 1e-4, 2e-3, 2e-2, 0.1])
    height, tension = water.film(humidity)
    grid = DistanceGrid(0.01e-9, 4000, 200)
    bearing = np.clip(-grid.bearing / (slopes[:, None] * length), 0, 1)
    dataset = contact.layout(np.zeros((1, len(slopes), 200)), bearing[None], grid, range(1))
    dataset = dataset.assign(length=length).assign_coords(slope=slopes)
    forces = curves.tilted_forces(dataset, humidity, water)[0]
    assert_allclose(forces, tension * np.minimum(length, height / slopes), rtol=1e-2)


def test_a_patch_that_ends_has_no_wedge_below_it():
    """The attraction across gaps tends to that of a parallel patch, and not to that of an endless wedge."""
    water = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "dry", 100e-9)).at(0.0)
    grid, slopes, length = DistanceGrid(0.05e-9, 800, 400), np.array([1e-7, 1e-6]), 3e-6
    solid = np.tile(1e6 * np.exp((3e-9 - grid.solid) / 0.3e-9), (1, 2, 1))
    bearing = np.clip(-grid.bearing / (slopes[:, None] * length), 0, 1)[None]
    parallel = contact.layout(solid[:, 0], bearing[:, 0], grid, range(1))
    dataset = (
        contact.layout(solid, bearing, grid, range(1))
        .assign(length=length, ends=("slope", 1 / slopes))
        .assign_coords(slope=slopes)
    )
    forces = curves.tilted_forces(dataset, 0.0, water)[0]
    assert_allclose(forces, length * curves.pull_offs(parallel, 0.0, water)[0], rtol=1e-2)
    assert np.all(curves.tip_forces(dataset, 0.0, water)[1] > 2 * forces)


# Jobs


def test_stoppers_of_one_area_share_the_contact_and_no_tilt_needs_none():
    found = plan(S1={"tilt_deg": [0, 0.1]}, S2={"tilt_deg": [0.05]}, S3={"tilt_deg": [0]}, S4={})
    name = "devices/contact/tilted/b_1500x6000"
    tilt = job_settings(found, name)["tilt"]
    assert_allclose(tilt["slopes"], np.tan(np.radians(0.1 * np.arange(1, 9) / 8)), rtol=1e-12)
    film, rise = 1e9 * Water(300.0).film(0.88)[0], tilt["slopes"][-1] * 1500
    assert tilt["reach_nm"] > film + rise
    graph = Graph(found)
    assert graph.job("devices/tilted/S1").inputs["tilted"] == graph.job("devices/tilted/S2").inputs["tilted"] == name
    assert "tilted" not in graph.job("devices/tilted/S3").inputs
    assert ["tilted" in graph.job(f"devices/life/S{k}").inputs for k in (1, 2, 3, 4)] == [True, True, True, False]


# Life


def tilted_dataset(factors=(1.0, 0.3), degrees=(0.05, 0.1)):
    """Stage tilted_stoppers of the stopper of other tests, with forces smaller by factors."""
    pull_off = stopper_dataset().pull_off.values
    common = {"contact": (3e-6, 3e-6), "restoring_force": STOPPER.restoring_force, "worst_humidities": (0.4, 0.9)}
    settings = stoppers.Tilted(
        1, Water(300.0), humidities=(0.44, 0.67), slopes=tuple(np.tan(np.radians(degrees))), **common
    )
    return stoppers.layout_tilted(settings, np.array([factor * pull_off for factor in factors]), np.array([3e-4, 5e-4]))


def test_life_has_a_band_between_the_tilts():
    tilted, plain = tilted_dataset(), stopper_dataset()
    found = {one.name: one for one in stopper_answers(plain, STOPPER, tilted=tilted)}
    force = plain.pull_off.mean("sample").max()
    assert_allclose((found["force_tilted"].low, found["force_tilted"].high), (0.3 * force, force), rtol=1e-12)
    assert "tilted by 0.05 to 0.1°" in found["force_tilted"].what
    for humidity in (0.44, 0.67):
        stuck = tilted.stuck.sel(humidity=humidity)
        band = found[f"stuck_tilted_{humidity:g}"]
        assert (band.low, band.high) == (stuck.sel(bound="low")[1], stuck.sel(bound="high")[0])
    needed = found["restoring_force_tilted"]
    assert_allclose(needed.low / needed.high, 0.3, rtol=1e-12)
    assert_allclose(needed.high, found["restoring_force"].high, rtol=1e-12)
    assert_allclose((found["wedge"].low, found["wedge"].high), (3e-4, 5e-4), rtol=1e-12)
    assert set(found) - {name for name in found if "tilted" in name or name == "wedge"} == {
        one.name for one in stopper_answers(plain, STOPPER)
    }


def test_a_range_has_the_least_of_its_tilts_and_each_patch_at_its_worst():
    tilted = tilted_dataset((1.0, 0.2, 1.4, 0.9, 0.5), (0.0, 0.025, 0.05, 0.075, 0.1))
    found = {one.name: one for one in stopper_answers(stopper_dataset(), STOPPER, tilted=tilted)}
    assert_allclose(found["force_tilted"].low / found["force_tilted"].high, 0.2 / 1.4, rtol=1e-12)
    assert_allclose(found["restoring_force_tilted"].high, 1.4 * found["restoring_force"].high, rtol=1e-12)
    assert "tilted by 0 to 0.1°" in found["force_tilted"].what
    assert found["force_tilted"].form.startswith("least of 5 tilts, and each patch at its worst; ")
    for humidity in (0.44, 0.67):
        stuck, band = tilted.stuck.sel(humidity=humidity), found[f"stuck_tilted_{humidity:g}"]
        assert (band.low, band.high) == (stuck.sel(bound="low")[1], stuck.sel(bound="high")[2])


def test_stoppers_that_land_at_any_tilt_stick_as_often_as_some_landing_of_theirs_sticks():
    """Second route: patch by patch, whether any of its landings sticks; at one tilt, fewer do."""
    settings, rng = in_si(stoppers.Settings, job_settings(plan(S1={}), "devices/stoppers/S1")), np.random.default_rng(1)
    forces = 18e-6 * rng.lognormal(-0.5, 0.8, (3, 2, 400))
    dataset = stoppers.layout_tilted(stoppers.Tilted(**vars(settings), slopes=(0.0, 1e-4, 2e-4)), forces, np.ones(2))
    sticks = [[any(forces[:, h, k] > settings.restoring_force) for k in range(400)] for h in range(2)]
    assert_allclose(dataset.largest_stuck.sel(bound="estimate"), np.mean(sticks, axis=1), rtol=1e-12)
    assert np.all(dataset.largest_stuck.sel(bound="estimate") > dataset.stuck.sel(bound="estimate").max("tilt") + 0.1)
    assert np.all(dataset.largest_mean > dataset["mean"].max("tilt"))
    safe = {"share": 1e-2, "part": ["safe", "estimate"]}
    assert np.all(dataset.largest_safe_force.sel(safe) >= dataset.safe_force.sel(safe).max("tilt"))
    answers = {one.name: one for one in stopper_answers(stopper_dataset(), STOPPER, tilted=dataset)}
    for humidity in settings.humidities:
        assert answers[f"stuck_tilted_{humidity:g}"].high == dataset.largest_stuck.sel(bound="high", humidity=humidity)


@cache
def of_range(degrees, finer):
    """Forces of a stopper at the tilts that the plan has for a range, and at more between them (tilts, h, m) [N]."""
    slopes = plan(S1={"tilt_deg": list(degrees)}).devices.slopes("S1")
    settings = job_settings(plan(S1={"tilt_deg": list(degrees)}), "devices/contact/tilted/b_1500x6000")
    between = np.interp(np.arange(len(slopes) * finer - finer + 1) / finer, np.arange(len(slopes)), slopes)
    fine = settings | {"tilt": settings["tilt"] | {"slopes": [*map(float, between[1:])]}}
    contacts = contact.compute(small.surfaces(), "b", "NG", in_si(Settings, fine))
    shared = in_si(stoppers.Settings, job_settings(plan(S1={}), "devices/stoppers/S1"))
    every = stoppers.Tilted(**vars(shared), slopes=tuple(between))
    return stoppers.compute_tilted({"contact": small.contact_of_pair(), "tilted": contacts}, every)


@pytest.mark.parametrize("degrees", [(0, 0.1), (0, 2)])
def test_the_tilts_of_a_range_leave_little_between_them(degrees):
    """Brute force: three times as many tilts raise the largest forces of patches by less than tilts raise them."""
    every = of_range(degrees, 3)
    assert_allclose(np.degrees(np.arctan(every.tilt[[0, -1]])), np.degrees(np.arctan(np.radians(degrees))), atol=1e-3)
    chosen = every.pull_off[::3].max("tilt")
    missed = (every.pull_off.max("tilt") / chosen - 1).mean("sample")
    gained = (chosen / every.pull_off[0] - 1).mean("sample")
    assert np.all(missed < 0.03)
    assert gained[0] > 3 * missed[0], "control: a patch at another tilt can hold more than without"


def test_single_patches_hold_more_at_small_tilts_but_their_mean_does_not():
    every = of_range((0, 0.1), 3)
    ratio = every.pull_off / every.pull_off[0]
    assert np.all((ratio[1:10] > 1).mean("sample").isel(humidity=0) > 0.05)
    assert ratio.max() > 1.1
    assert np.all(every["mean"] <= every["mean"][0] + every.mean_error[0])


@pytest.mark.parametrize(("low", "high", "near"), [(0, 0.1, 0.2), (0, 10, 0.1), (0.02, 0.5, 0.1), (1, 1.001, 1e-5)])
def test_tilts_of_a_range_increase_from_one_end_to_the_other_and_crowd_where_other_summits_touch(low, high, near):
    tilts = np.array(tilts_of(low, high, near))
    assert len(tilts) == TILTS
    assert np.all(np.diff(tilts) > 0)
    assert_allclose(tilts[[0, -1]], [low, high], rtol=1e-12)
    crowded = tilts[tilts <= low + near * (1 + 1e-9)]
    assert len(crowded) >= 5
    assert np.diff(crowded).max() <= near / 4 * (1 + 1e-9)


def test_table_and_sentence_state_the_tilt(tmp_path):
    dataset = layout(stopper_answers(stopper_dataset(), STOPPER, tilted=tilted_dataset()), STOPPER)
    storage.save(dataset, tmp_path / "S1.nc", "life", {}, [])
    frame = report.table({"S1": storage.load(tmp_path / "S1.nc", "life")}).frame.set_index("answer")
    assert frame.loc["wedge", "unit"] == "°"
    assert_allclose(frame.loc["wedge", ["at_least", "at_most"]].astype(float), np.degrees([3e-4, 5e-4]), rtol=1e-12)
    (said,) = [sentence for sentence in report.sentences(dataset) if "tilt" in sentence]
    assert said.startswith("Its mean pull-off force tilted by 0.05 to 0.1°, at RH 0.44, is ")
    assert said.endswith("Beyond a tilt of 0.0171 to 0.0287°, a longer side of its area hardly holds more.")
    one = layout(stopper_answers(stopper_dataset(), STOPPER, tilted=tilted_dataset((0.3,), (0.1,))), STOPPER)
    assert any("tilted by 0.1°, at RH 0.44, is " in sentence for sentence in report.sentences(one))

"""Fast separation of devices on the contact of a small study, without another contact than that of slow separation."""

from dataclasses import replace

import numpy as np
import pytest
import small
from ground import C1, R1
from numpy.testing import assert_allclose
from scipy.integrate import trapezoid

from stiction.config.cases import Case
from stiction.config.files import load
from stiction.contact.environment import Gaps, Water
from stiction.contact.pair import DistanceGrid
from stiction.contact.separation import keep_volume
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.run import storage
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import curves
from stiction.stages.devices.contact_names import contact_of, tips_of
from stiction.stages.life import separation

WATER = Water(300.0)
ACROSS = replace(WATER, gaps=Gaps({"water": 9.75e-20, "dry": 18.65e-20}, "water", 100e-9))
PATCH = (1.5e-6, 6e-6)
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0, 0.67]}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44, 0.67]}


@pytest.fixture(scope="module")
def contacts():
    return dict.fromkeys((0.44, 0.67, 0.92), small.contact_of_pair())


def test_every_patch_holds_at_least_as_much_as_slowly(contacts):
    found = separation.of_stopper(contacts, separation.StopperSettings(ACROSS, PATCH)).pull_off
    for humidity in contacts:
        slow = curves.pull_offs(small.contact_of_pair(), humidity, ACROSS) * PATCH[0] * PATCH[1]
        ratio = found.sel(humidity=humidity).values / slow
        assert np.all(ratio >= 1 - 1e-12)
        assert ratio.mean() > 1.01


def fast_strips(contacts, water):
    """Datasets of fast strips by humidity."""
    return {
        humidity: separation.of_strips(one, separation.FastInAir(water, humidity)) for humidity, one in contacts.items()
    }


def fast_tips(contact):
    """Dataset of fast tips at RH 0.67."""
    return separation.of_tips(contact, separation.FastInAir(WATER, 0.67))


@pytest.mark.parametrize("water", [WATER, ACROSS])
def test_strips_need_more_energy_so_that_beams_are_shorter_by_its_fourth_root(contacts, water):
    found = separation.of_beam(fast_strips(contacts, water), {}, R1)
    assert np.all(found.factor + 4 * found.factor_error < 1)
    fast, slow = (of(small.contact_of_pair(), 0.44, water) for of in (curves.fast_energies, curves.energies))
    assert np.all(fast > slow)
    assert_allclose(found.factor.sel(humidity=0.44), [(slow.mean() / fast.mean()) ** 0.25], rtol=1e-12)
    assert list(found["shape"].values) == ["middle"]


def test_strips_never_hold_longer_beams_fast_than_slowly(contacts, monkeypatch):
    monkeypatch.setattr(curves, "fast_energies", lambda *air: 0.9 * curves.energies(*air))
    found = fast_strips(contacts, WATER)
    assert all(float(strips.factor) == 1 for strips in found.values())


def wedges(resisting=3):
    """Contact of three tips that are smooth wedges on stiff ground, at two slopes; some find no ground."""
    grid, slopes, length = DistanceGrid(0.05e-9, 200, 60), np.array([0.05, 0.1]), 3e-7
    area = np.maximum(-grid.bearing, 0.0) / (slopes[:, None] * length)
    solid = np.zeros((3, 2, 60))
    solid[:resisting, :, 0] = 1e9
    dataset = stage_contact.layout(solid, np.tile(area, (3, 1, 1)), grid, range(3)).assign(length=length)
    return dataset.assign_coords(slope=slopes)


def test_smooth_wedges_hold_as_long_beams_fast_as_slowly():
    factor, error = separation.factor_of_tips(fast_tips(wedges()), C1)
    assert_allclose(factor, 1, rtol=1e-2)  # they rest up to one distance above the ground
    assert error < 1e-6
    assert separation.factor_of_tips(fast_tips(wedges(2)), C1)[0] == 0


def test_a_cantilever_has_factors_of_its_beam_and_of_its_tip():
    strips = fast_strips({0.67: small.contact_of_pair()}, WATER)
    found = separation.of_beam(strips, {0.67: fast_tips(wedges())}, C1)
    assert list(found["shape"].values) == ["S-shape", "S-shape or arc"]
    assert_allclose(found.factor[0], [float(strips[0.67].factor), 1], rtol=1e-2)


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


def test_the_error_of_a_factor_is_the_scatter_of_factors_on_other_strips():
    rng, contact = np.random.default_rng(1), small.contact_of_pair()
    energies = np.array([of(contact, 0.44, WATER) for of in (curves.fast_energies, curves.energies)])
    again = [energies[:, rng.integers(20, size=20)].mean(axis=1) for _ in range(2000)]
    scatter = np.std([(slow / fast) ** 0.25 for fast, slow in again])
    assert_allclose(fast_strips({0.44: contact}, WATER)[0.44].factor_error, scatter, rtol=0.2)


def test_strips_that_no_summits_stop_have_no_bound():
    flat = small.contact_of_pair().copy(deep=True)
    flat.solid_pressure[0] = 0.0
    assert np.isinf(curves.fast_pull_offs(flat, 0.67, ACROSS)[0])
    assert np.isfinite(curves.fast_pull_offs(flat, 0.67, ACROSS)[1:]).all()
    found = fast_strips({0.67: flat}, ACROSS)[0.67]
    assert found.factor == 0
    assert np.isnan(found.factor_error)


def test_only_humid_air_has_a_fast_separation_and_on_the_contact_of_the_device():
    coated = {"surfaces": dict.fromkeys(("B2", "Sub1"), {"material": "FDTS"}), "run": {"pairs": ["b"]}}
    for more, humid in (({}, [0.67]), (coated | {"materials": {"FDTS": {"contact_angle_deg": 110}}}, [])):
        graph = Graph(Plan(load({"devices": {"C1": BEAM, "S1": STOPPER}} | more)))
        inputs, case = graph.job("devices/life/C1").inputs, Case("C1_rh067")
        by_levels = {"model_error": "studies/model_error/devices/b"}
        for name, needed in (
            ("fast_strips", {"contact": contact_of(graph.plan, case)} | by_levels),
            ("fast_tips", {"contact": tips_of(graph.plan, case)["tips"]} | by_levels),
        ):
            assert list(inputs[name]) == humid
            if humid:
                assert graph.job(inputs[name][0.67]).inputs == needed
        assert ("separation" in graph.job("devices/life/S1").inputs) == bool(humid)
    assert list(graph.job("devices/separation/S1").inputs["contacts"]) == [0.44, 0.67] if humid else True
    dry = Graph(Plan(load({"devices": {"C1": BEAM | {"humidities": ["dry"]}}})))
    assert not dry.job("devices/life/C1").inputs["fast_strips"]


def test_beams_of_all_sizes_share_their_strips_and_those_of_one_slope_their_tips():
    thick, narrow = BEAM | {"thickness_um": 2.61}, BEAM | {"width_um": 20}
    graph = Graph(Plan(load({"devices": {"C1": BEAM, "C2": thick, "C3": narrow}})))
    first, second, third = (graph.job(f"devices/life/{name}").inputs for name in ("C1", "C2", "C3"))
    for name in ("fast_strips", "fast_tips"):
        assert first[name] == second[name] != third[name]


def test_a_dataset_comes_back_from_its_file(contacts, tmp_path):
    of_stopper = separation.of_stopper(contacts, separation.StopperSettings(WATER, PATCH))
    of_beam = {"fast_strips": fast_strips(contacts, WATER)[0.44], "fast_tips": fast_tips(wedges())}
    for stage, found in ({"separation": of_stopper} | of_beam).items():
        storage.save(found, tmp_path / "one.nc", stage, {})
        assert storage.load(tmp_path / "one.nc", stage).equals(found)

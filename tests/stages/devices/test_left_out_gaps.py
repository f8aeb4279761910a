"""Devices without attraction across gaps: what it would change of them, beside their results."""

import numpy as np
import pytest
import small
import xarray as xr

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.device import Device
from stiction.devices.limits import rules as limits
from stiction.devices.limits.limit import Side
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.limits.words import text, texts
from stiction.stages.contact import curves
from stiction.stages.devices import device_warnings
from stiction.stages.devices.opening import ARC, EITHER, FORCE, S_SHAPE

BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 6, "humidities": [0.44, 0.8]}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [1.5, 6], "restoring_force_uN": 20, "humidities": [0.44, 0.8]}
SIZES = {"devices": {"C1": BEAM, "S1": STOPPER}, "design": {"beams": 200, "budget_beams": 20, "chart_points": 2}}
SIZES |= {"design": SIZES["design"] | {"worst_humidities": [0.44, 0.9]}}
#: Inputs of warnings that say nothing.
NOTHING = {
    "lengths": {},
    "charts": {},
    "plasticity": {},
    "estimates": {},
    "spectra": {},
    "stoppers": {"S1": xr.Dataset({"share_flat": 0.0, "rms": 3e-9})},
}
TOUCHING = Results.of(merged(merged(small.PLAN.config, SIZES), {"contact": {"model": "summits"}}))


def test_the_force_of_a_stopper_would_change_as_that_of_one_with_attraction_across_gaps():
    found = device_warnings.left_out_changes(TOUCHING["devices/left_out_gaps/S1"])
    contact, across = TOUCHING["devices/contact/b_1500x6000"], load({"attraction": {"reach": "all"}})
    waters = [in_si(Water, plan.air_of_devices.water("b")) for plan in (TOUCHING.graph.plan, Plan(across))]
    for humidity in (0.44, 0.8):
        without, with_gaps = (curves.pull_offs(contact, humidity, water).mean() for water in waters)
        assert found[humidity, FORCE][0] == pytest.approx(np.log(with_gaps / without))
    assert found[0.44, FORCE][0] > 2 * found[0.8, FORCE][0] > 0


def test_beams_and_tips_would_stick_at_shorter_lengths_in_drier_air():
    found = device_warnings.left_out_changes(TOUCHING["devices/left_out_gaps/C1"])
    assert set(found) == {(humidity, response) for humidity in (0.44, 0.8) for response in (S_SHAPE, ARC)}
    for humidity in (0.44, 0.8):
        shorter, error = found[humidity, S_SHAPE]
        assert shorter < -2 * error < 0
        assert found[humidity, ARC][0] < 2 * found[humidity, ARC][1]


def test_every_result_has_its_change_as_a_warning():
    graph = TOUCHING.graph
    job = graph.job("devices/warnings/S1.json")
    *_, [[_, said]] = job.compute(NOTHING | {"left_out_gaps": TOUCHING["devices/left_out_gaps/S1"]})
    assert any("across gaps is left out" in one and "RH 0.44" in one and "unsafe" in one for one in texts(said))
    changes = device_warnings.left_out_changes(TOUCHING["devices/left_out_gaps/C1"])
    for shape in (S_SHAPE, EITHER):
        (limit,) = device_warnings.gap_warnings({key: of for key, of in changes.items() if key[0] == 0.44}, shape)
        number = 100 * changes[0.44, ARC if shape == EITHER else shape][0]
        assert f"change the length that holds by {number:+.2g} ±" in text(limit)
    assert device_warnings.gap_warnings({}, S_SHAPE) == []


@pytest.mark.parametrize("device", ["S1", "C1"])
def test_a_device_in_python_has_the_same_warning(device):
    lengths = xr.DataArray([[2e-4], [1e-4]], coords={"shape": [S_SHAPE, EITHER], "share": [0.01]})
    safe = xr.Dataset({"safe_length": lengths, "film": 2e-9, "rms": 4e-9, "longest_strip": 1e-3})
    safe = safe.assign(share_flat=0.0, resampled=0, repetition=0.0, size_error=0.0)
    said = [one for one in Device(device, TOUCHING).warnings(safe) if "across gaps is left out" in one]
    changes = device_warnings.left_out_changes(TOUCHING[f"devices/left_out_gaps/{device}"])
    assert len(said) == len({response for _, response in changes})
    for (humidity, _), (change, _) in changes.items():
        assert any(f"{100 * change:+.2g} ±" in one and f"at RH {humidity:g}" in one for one in said)


@pytest.mark.parametrize(
    ("changes", "is_left_out"),
    [
        ({}, False),
        ({"attraction": {"reach": "all"}}, False),
        ({"attraction": {"reach": "touching"}}, True),
        ({"contact": {"model": "summits"}}, False),
        ({"contact": {"model": "full"}}, False),
        ({"contact": {"model": "full"}, "attraction": {"reach": "touching"}}, True),
        ({"van_der_waals": "none"}, False),  # nothing attracts at all, as the list of what is not in the model says
    ],
)
def test_the_change_is_computed_where_attraction_across_gaps_is_left_out(changes, is_left_out):
    humid = {"devices": {name: section | {"humidities": [0.55, 0.8]} for name, section in SIZES["devices"].items()}}
    graph = Graph(Plan(load(SIZES, humid, {"design": {"worst_humidities": [0.5, 0.9]}}, changes)))
    for device in ("C1", "S1"):
        assert ("left_out_gaps" in graph.job(f"devices/warnings/{device}.json").inputs) == is_left_out
    inputs = graph.job("devices/left_out_gaps/C1").inputs
    assert ("model_error" in inputs) == (changes.get("contact") != {"model": "summits"})


def test_the_side_of_what_is_left_out_is_that_of_lengths_and_forces():
    assert limits.without_gaps({0.5: (-0.03, 0.01)}, shorter=True).side == Side.UNSAFE
    assert limits.without_gaps({0.5: (0.03, 0.01)}, shorter=True).side == Side.SAFE
    both = limits.without_gaps({0.5: (0.1, 0.01), 0.9: (-0.02, 0.01)})
    assert (both.side, both.amount, both.forbids) == (Side.UNSAFE, 0.1, True)
    assert "+10 ± 1 % at RH 0.5, -2 ± 1 % at RH 0.9, which is the unsafe" in text(both)
    assert limits.without_gaps({}) is None

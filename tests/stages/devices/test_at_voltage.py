"""Safe lengths and forces of devices at a voltage: no voltage, flats, monotone, and cracks drawn on stronger laws."""

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
import small
import xarray as xr
from ground import C1, R1, SLOPES, VECTORS, WATER, computed, lognormal_cracks, settings, wanted
from numpy.testing import assert_allclose
from plans import job_settings

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.life import holding
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.contact import curves
from stiction.stages.devices import opening, safe_lengths, stoppers
from stiction.stages.devices.sticking import flooded_lengths

TIPS = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
OXIDE = {"dielectric": {"thickness_nm": 100, "permittivity": 4}}
SECTION = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 19, "humidities": [0.44]}


def at(voltage):
    """Water with a voltage across an oxide."""
    return replace(WATER, capacitor=Capacitor(Dielectric(100e-9, 4.0), voltage))


def added(water):
    """Energy of flats at a voltage [J m⁻²]."""
    return water.capacitor.work(0.0) if water.capacitor else 0.0


def vectors(_contact, _humidity, water):
    """Vectors of smooth surfaces: the voltage adds that of flats."""
    return VECTORS + [added(water), water.capacitor.largest_pressure if water.capacitor else 0.0, 0, 0], 5e6


def tip_forces(_contact, _humidity, water):
    """Forces of smooth tips."""
    return SLOPES, (TIPS[:, None] + added(water)) / SLOPES


def of_device(device, voltage=None):
    """Safe lengths of a device on smooth surfaces, at a voltage if there is one."""
    tips = xr.Dataset() if device is C1 else None
    cracks, own = lognormal_cracks(device), replace(wanted(device), water=at(voltage or 0.0))
    with patch.multiple(curves, vectors=vectors, tip_forces=tip_forces):
        if voltage is None:
            return safe_lengths.compute(cracks, wanted(device), tips)
        return safe_lengths.compute_at_voltage(xr.Dataset(), cracks, own, tips)


@pytest.mark.parametrize("device", [C1, R1], ids=["cantilever", "bridge"])
def test_no_voltage_gives_the_same_bits_and_more_voltage_shorter_lengths(device):
    without, none = of_device(device), of_device(device, 0.0)
    assert float(none.voltage_energy) == float(none.voltage_error) == 0
    xr.testing.assert_identical(without, none.drop_vars(["voltage_energy", "voltage_error"]))
    safe = np.array([of_device(device, voltage).safe_length.values for voltage in (0.0, 1.0, 3.0, 10.0)])
    assert np.all(np.diff(safe, axis=0) < 0)


def test_on_smooth_surfaces_lengths_are_those_of_the_sum_of_both_energies():
    found, without, water = of_device(C1, 5.0), of_device(C1), at(5.0)
    assert_allclose(float(found.voltage_energy), added(water), rtol=1e-9)
    crack, tip = (without.estimate.sel(shape=shape).values for shape in (opening.S_SHAPE, opening.EITHER))
    # Lengths are those of cracks and 2 l_f, which the voltage does not shorten.
    expected = holding.length_at_voltage(crack, C1.beam, added(water))
    assert_allclose(found.estimate.sel(shape=opening.S_SHAPE), expected, rtol=1e-2)
    # The force of smooth tips falls as their slope grows.
    falling = (tip**-4 + added(water) / (3 / 8 * C1.young_modulus * C1.thickness**3 * C1.gap**2)) ** -0.25
    assert_allclose(found.estimate.sel(shape=opening.EITHER), falling, rtol=1e-2)
    assert np.all(holding.tip_length_at_voltage(tip, C1.beam, added(water)) < falling)


def test_flooded_flats_are_held_by_the_voltage_as_well():
    for device in (C1, R1):
        lengths = np.array([flooded_lengths(device, water, 0.67, 0.0) for water in (WATER, at(0.0), at(5.0))])
        assert np.all(lengths[0] == lengths[1])
        assert np.all(lengths[2] < lengths[0])
    wet = 3 / 8 * C1.young_modulus * C1.thickness**3 * C1.gap**2 / flooded_lengths(C1, at(5.0), 0.67, 0.0)[1] ** 4
    dry = 3 / 8 * C1.young_modulus * C1.thickness**3 * C1.gap**2 / flooded_lengths(C1, WATER, 0.67, 0.0)[1] ** 4
    assert_allclose(wet - dry, added(at(5.0)), rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("device", [C1, R1], ids=["cantilever", "bridge"])
def test_lengths_at_a_voltage_are_those_of_beams_released_on_stronger_laws(device):
    gained = np.array([float(VECTORS[:, 0].mean()), 0.0, 0.0, 0.0])
    found = [computed(settings(device, 60), laws) for laws in (VECTORS, VECTORS + gained)]
    without, released = (one[device.opening.length].values for one in found)
    means = (VECTORS[:, :2].mean(axis=0), (VECTORS + gained)[:, :2].mean(axis=0))
    expected = device.opening.at_voltage(without, *means, device.beam)
    assert abs(np.median(expected / released) - 1) < 0.02
    assert abs(np.median(without / released) - 1) > 0.1, "without voltage they are longer"


def test_a_stopper_at_a_voltage_has_the_patches_of_one_without():
    own = stoppers.Settings(1, WATER, (1.5e-6, 6e-6), (0.67,), (0.85, 0.9), restoring_force=18e-6)
    found = [
        stoppers.compute(small.contact_of_pair(), replace(own, water=water)).pull_off
        for water in (WATER, at(0.0), at(2.0), at(5.0))
    ]
    assert_allclose(found[0], found[1], rtol=0)
    gained = np.array([one - found[0] for one in found[2:]])
    assert np.all(gained > 0)
    assert np.all(gained[1] > gained[0])
    assert np.all(gained[1] < at(5.0).capacitor.largest_pressure * 9e-12)


def test_jobs_at_a_voltage_have_the_settings_of_those_without_and_none_beyond_breakdown():
    devices = {"C1": SECTION | OXIDE | {"voltage_V": -5, "offset_V": 0.3}, "S1": STOPPER | OXIDE | {"offset_V": 1}}
    devices |= {"C2": SECTION | OXIDE | {"voltage_V": 101}, "S2": STOPPER | OXIDE | {"voltage_V": 101}, "C3": SECTION}
    plan = Plan(load({"devices": devices}))
    for job, other, volts in (("C1_rh067", "safe_lengths/C1_rh067", 5.3), ("S1", "stoppers/S1", 1.0)):
        biased, without = job_settings(plan, f"devices/at_voltage/{job}"), job_settings(plan, f"devices/{other}")
        water = biased["water"]
        assert in_si(Capacitor, water["capacitor"]).potential == volts
        assert biased | {"water": {key: water[key] for key in water if key != "capacitor"}} == without
    inputs = {name: Graph(plan).job(f"devices/life/{name}").inputs.get("biased") for name in devices}
    assert inputs["C1"] == {0.67: "devices/at_voltage/C1_rh067"}
    assert inputs["S1"] == "devices/at_voltage/S1"
    assert not any(inputs[name] for name in ("C2", "S2", "C3"))

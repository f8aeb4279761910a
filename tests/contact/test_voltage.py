"""Voltage as attraction across gaps: averages over normal heights, flats, no voltage, and more of it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import quad
from scipy.stats import norm

from stiction.constants import HAMAKER_CONSTANT, VACUUM_PERMITTIVITY
from stiction.contact import forcelaw
from stiction.contact.environment import Gaps, Water, flooded_law, force_curves
from stiction.contact.gaps import gap_pressures
from stiction.contact.voltage import Capacitor, Dielectric

NM = 1e-9
RMS, STEP = 3 * NM, 0.1 * NM
BEARING = STEP * np.arange(-300, 301)
AREA = norm.sf(BEARING, scale=RMS)[None].astype(np.float32)
DISTANCE = STEP * np.arange(0, 400)
ACROSS = Gaps(HAMAKER_CONSTANT, "water", 100e-9)
GAPS = pytest.mark.parametrize("gaps", [ACROSS, None], ids=["van der Waals across gaps", "voltage alone"])


def across(distance, voltage=5.0):
    """Voltage across a gap of air [m]."""
    return Capacitor(Dielectric(distance, 1.0), voltage)


def curves(gaps, capacitor, humidity=0.6):
    """Force curves of one sample of normal heights, stopped by summits at three times their standard deviation."""
    solid = 1e6 * np.exp((3 * RMS - DISTANCE[:300]) / (0.1 * RMS))[None]
    water = Water(300.0, gaps=gaps, capacitor=capacitor)
    return force_curves(solid, AREA, (0.0, BEARING[0]), STEP, humidity, water)


@pytest.mark.parametrize("distance", [100 * NM, 8 * NM, 1 * NM])
@pytest.mark.parametrize("between", [9 * NM, 20 * NM])
def test_the_pressure_is_the_mean_of_that_of_all_gaps(distance, between):
    pressure, _ = gap_pressures(AREA, BEARING[0], DISTANCE, STEP, across(distance).work)
    mean = quad(lambda z: norm.pdf(z, scale=RMS) / (between - z + distance) ** 2, -10 * RMS, min(between, 10 * RMS))[0]
    found = np.interp(between, DISTANCE, pressure[0])
    assert_allclose(found, -VACUUM_PERMITTIVITY * 25 / 2 * mean, rtol=2e-3)


def test_rough_surfaces_gain_what_flats_do_if_the_dielectric_is_thick_and_less_if_it_is_thin():
    shares = []
    for distance in (3 * NM, 30 * NM, 3000 * NM):
        capacitor = across(distance)
        without, at = (forcelaw.adhesion_energies(*curves(None, one)) for one in (across(distance, 0.0), capacitor))
        shares.append(float(at[0] - without[0]) / capacitor.work(0.0))
    assert 0 < shares[0] < shares[1] < shares[2] <= 1
    assert_allclose(shares[2], 1, rtol=5e-3)


@GAPS
def test_no_voltage_changes_no_bit(gaps):
    without, at = (curves(gaps, one) for one in (None, across(8 * NM, 0.0)))
    assert_array_equal(without.curve(0).copy(), at.curve(0))
    for of in (forcelaw.pull_offs, forcelaw.adhesion_energies):
        arguments = (at[:3], without[:3]) if of is forcelaw.pull_offs else (at, without)
        assert_array_equal(of(*arguments[0]), of(*arguments[1]))


@GAPS
def test_more_voltage_holds_more_and_never_more_than_flats(gaps):
    energies, pulls = [], []
    for voltage in (0.0, 0.3, 1.0, 3.0, 5.0):
        found = curves(gaps, across(8 * NM, voltage))
        energies.append(float(forcelaw.adhesion_energies(*found)[0]))
        pulls.append(float(forcelaw.pull_offs(*found[:3])[0]))
        limit = across(8 * NM, voltage)
        assert energies[-1] <= energies[0] + limit.work(0.0)
        assert pulls[-1] <= pulls[0] + limit.largest_pressure
    assert np.all(np.diff(energies) > 0)
    assert np.all(np.diff(pulls) > 0)


@GAPS
def test_flooded_flats_gain_the_work_and_the_pressure_of_the_voltage(gaps):
    water, capacitor = Water(300.0, gaps=gaps), across(8 * NM)
    gained = np.subtract(flooded_law(0.6, replace(water, capacitor=capacitor), 0.0), flooded_law(0.6, water, 0.0))
    assert_allclose(gained, (capacitor.work(0.0), capacitor.largest_pressure), rtol=1e-6)


def test_voltage_and_offset_of_either_sign_add_up_across_the_thickness_over_the_permittivity():
    oxide = Capacitor(Dielectric(100 * NM, 4.0), -5.0, 0.3)
    assert oxide.potential == 5.3
    assert_allclose((oxide.field, oxide.dielectric.distance), (5.3 / 1e-7, 25 * NM), rtol=1e-12)
    assert_allclose(oxide.work(10 * NM), across(35 * NM, 5.3).work(0.0), rtol=1e-12)

"""Lengths at a voltage in plain Python: those of the closed form that a run takes for tips."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.estimate.answer import answer
from stiction.estimate.question import Question, questions
from stiction.estimate.state import stiffness_of
from stiction.estimate.table import content, known
from stiction.estimate.voltage import at_voltage, drive_of, energy_of, without_voltage
from stiction.life import holding

MODULUS = 164e9
DEVICE = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
OXIDE = {"thickness_nm": 100, "permittivity": 3.9}


def drive(beam, energy):
    """Drive of an energy on a beam."""
    return drive_of(energy, stiffness_of(MODULUS, beam.thickness, beam.gap), beam.gap)


@given(st.floats(5e-5, 1e-3), st.floats(1, 5), st.floats(1, 30), st.floats(1e-6, 1))
def test_lengths_are_those_of_the_closed_form_and_back(length, thickness, gap, energy):
    beam = Beam(1e-3, 30e-6, 1e-6 * thickness, MODULUS, 1e-6 * gap, 1)
    found = at_voltage(length, drive(beam, energy))
    assert found == pytest.approx(float(holding.tip_length_at_voltage(length, beam, energy)), rel=1e-9)
    assert found < length
    assert found**-4 == pytest.approx(length**-3 / found + drive(beam, energy), rel=1e-9)
    if drive(beam, energy) < 1e3 * length**-4:  # beyond, the length without voltage matters less than rounding
        assert without_voltage(found, drive(beam, energy)) == pytest.approx(length, rel=1e-6)


def test_a_length_that_the_voltage_alone_holds_needs_no_surface():
    beam = Beam(1e-3, 30e-6, 2.6e-6, MODULUS, 20e-6, 1)
    alone = drive(beam, 0.01) ** -0.25
    assert without_voltage(1.001 * alone, drive(beam, 0.01)) == math.inf
    assert math.isfinite(without_voltage(0.999 * alone, drive(beam, 0.01)))


@given(st.floats(-50, 50), st.floats(-5, 5), st.floats(10, 1000), st.floats(1, 10))
def test_the_energy_is_that_of_flats_at_the_distance_of_the_dielectric(voltage, offset, thickness, permittivity):
    device = {"voltage_V": voltage, "offset_V": offset}
    device["dielectric"] = {"thickness_nm": thickness, "permittivity": permittivity}
    capacitor = Capacitor(Dielectric(1e-9 * thickness, permittivity), voltage, offset)
    assert energy_of(device, 2e-6) == pytest.approx(holding.energy_of_voltage(capacitor, 2e-6), rel=1e-9, abs=1e-30)


def at(**keys):
    """Answer about the device with more keys."""
    (question,) = questions({"devices": {"C": DEVICE | keys}}, content()).values()
    assert isinstance(question, Question), question
    return answer(question, *known())


def test_a_device_at_a_voltage_has_the_lengths_of_the_closed_form_with_their_intervals():
    without, driven = at(), at(voltage_V=5, offset_V=0.3, dielectric=OXIDE)
    beam = Beam(1e-3, 30e-6, 2.6e-6, MODULUS, 20e-6, 1)
    added = holding.energy_of_voltage(Capacitor(Dielectric(100e-9, 3.9), 5.3), beam.gap)
    for row, bare in zip(driven.rows, without.rows, strict=True):
        for shown, length in [(row.length, bare.length), *zip(row.intervals["90"], bare.intervals["90"], strict=True)]:
            assert shown == pytest.approx(float(holding.tip_length_at_voltage(length, beam, added)), rel=1e-9)


def test_the_fraction_at_a_length_is_that_of_the_length_without_the_voltage():
    question = questions({"devices": {"C": DEVICE | {"voltage_V": 5, "dielectric": OXIDE}}}, content())["C"]
    row = answer(question, *known()).chosen
    value, low, high = answer(replace(question, length=row.length), *known()).stuck
    assert value == pytest.approx(row.fraction, rel=1e-3)
    assert low < value < high
    bare = answer(replace(question, length=row.length, added=0.0), *known()).stuck[0]
    assert bare < 0.9 * value  # control

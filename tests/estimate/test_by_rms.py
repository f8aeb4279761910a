"""Devices of whose surfaces the rms alone is stated: which true sizes are beyond their end to use, and the table."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stiction.estimate.learning import by_rms, held_out
from stiction.estimate.learning.design import SurfaceLaw, points
from stiction.estimate.learning.rows import patches_of, states_of
from stiction.estimate.length import Lengths
from stiction.estimate.table import content

FOLDER, SET = Path(), "check_typical"
#: Point like a typical surface in a film of 3 nm.
POINT = points(1, 7, SurfaceLaw.TYPICAL)[0]
NUMBERS = {"airs": np.array([[3e-9, 1.0]]), "sides": np.array([2.0, 3.0])}


def given(monkeypatch, size, point=POINT):
    """Give one true length over the gap and one true reciprocal of a force, alike at all fractions."""
    modulus, true = content()["modulus"], Lengths((math.log(size),) * 3, 0.0)
    tip, patch = states_of(point, NUMBERS["airs"], modulus)[0][1], patches_of(point, NUMBERS, modulus)[0]
    monkeypatch.setattr(by_rms, "settled_tips", lambda *_: [(point, tip, true)])
    monkeypatch.setattr(by_rms, "settled_patches", lambda *_: [(point, patch, true)])


def found(monkeypatch, devices, size, point=POINT):
    """One device with a true size over a unit."""
    given(monkeypatch, size, point)
    (device,) = devices(FOLDER, SET)
    return device


@pytest.mark.parametrize("devices", [by_rms.lengths, by_rms.forces])
def test_a_true_size_just_on_the_unsafe_side_of_the_end_is_beyond_it(monkeypatch, devices):
    first = found(monkeypatch, devices, 1.0)
    # Lengths grow with the given number, forces fall with it.
    power = -1 if first.estimate.is_force else 1
    at_end = (first.estimate.use / first.true) ** power
    assert not found(monkeypatch, devices, 1.001 * at_end).is_beyond
    unsafe = found(monkeypatch, devices, 0.999 * at_end)
    assert unsafe.is_beyond
    assert not unsafe.is_inside
    at_estimate = found(monkeypatch, devices, (first.estimate.chosen.size / first.true) ** power)
    assert at_estimate.error == pytest.approx(0, abs=1e-12)
    assert at_estimate.is_inside
    assert found(monkeypatch, devices, 0.999 * at_end).error == pytest.approx(-first.half, abs=2e-3)
    assert first.half > 0


@pytest.mark.parametrize("devices", [by_rms.lengths, by_rms.forces])
def test_nothing_but_the_rms_of_a_surface_is_read(monkeypatch, devices):
    """Other spectra and forms change nothing, another rms does."""
    first = found(monkeypatch, devices, 1.0)
    other = points(2, 8, SurfaceLaw.ANY)[1]
    sides = tuple(section | {"rms_nm": own["rms_nm"]} for section, own in zip(other.sides, POINT.sides, strict=True))
    alike = found(monkeypatch, devices, 1.0, replace(POINT, sides=sides))
    assert alike.estimate.rows == first.estimate.rows
    rougher = tuple(section | {"rms_nm": 1.2 * section["rms_nm"]} for section in POINT.sides)
    assert found(monkeypatch, devices, 1.0, replace(POINT, sides=rougher)).estimate.rows != first.estimate.rows


@pytest.mark.parametrize("devices", [by_rms.lengths, by_rms.forces])
def test_surfaces_beyond_what_was_learnt_have_no_answer(monkeypatch, devices):
    smooth = tuple(section | {"rms_nm": 0.01} for section in POINT.sides)
    assert found(monkeypatch, devices, 1.0, replace(POINT, sides=smooth)).estimate is None


def test_the_table_counts_what_is_beyond_and_refused(monkeypatch):
    end = found(monkeypatch, by_rms.lengths, 1.0).estimate
    devices = [by_rms.ByRms(end, factor * end.use) for factor in (0.9, 0.99, 1.01)] + [by_rms.ByRms(None, 1.0)]
    monkeypatch.setattr(held_out, "_BY_RMS", [("length", lambda folder, name: devices * (name == SET))])  # noqa: ARG005
    *_, row, _ = held_out._of_rms(FOLDER)
    kind, words, number, refused, mean, rms, half, beyond, inside = [each.strip() for each in row.strip("|").split("|")]
    errors = np.array([device.error for device in devices[:3]])
    assert (kind, words, number, refused) == ("length", held_out.SETS[SET], "4", "1")
    assert float(mean) == pytest.approx(100 * errors.mean(), abs=0.06)
    assert float(rms) == pytest.approx(100 * math.sqrt((errors**2).mean()), abs=0.06)
    assert float(half) == pytest.approx(100 * devices[0].half, abs=0.06)
    assert (beyond[:6], inside[:6]) == ("2 of 3", "1 of 3")
    monkeypatch.setattr(held_out, "_BY_RMS", [("length", lambda *_: [])])
    assert not list(held_out._of_rms(FOLDER))

"""Rows of dimples: closed forms, finite elements, tension as a string, and the deflection beside them."""

from dataclasses import replace

import numpy as np
import pytest
from loaded_beams import Elements
from numpy.testing import assert_allclose

from stiction.beam.cantilever import Beam
from stiction.life.dimples import row

BEAM = Beam(200e-6, 30e-6, 2e-6, 164e9, 3e-6, 1)
STRESSES = (0.0, 1e3, 1e6, 50e6, 1e9)


def by_elements(beam, clamps, node):
    """Stiffness at a node and the largest deflection over that there, by finite elements."""
    model = Elements(beam, clamps, number=64)
    bending, slopes = model.stiffness()
    free, matrix = model.free, bending + beam.tension * slopes
    u, load = np.zeros(len(matrix)), np.zeros(len(matrix))
    load[2 * node] = 1.0
    u[free] = np.linalg.solve(matrix[np.ix_(free, free)], load[free])
    return 1 / u[2 * node], u[::2].max() / u[2 * node]


def test_a_cantilever_has_the_stiffness_of_its_part_and_goes_on_straight():
    for at in (40e-6, 100e-6, 190e-6):
        found = row(BEAM, 1, at)
        assert_allclose(found.stiffness, 3 * BEAM.bending_stiffness / at**3, rtol=1e-12)
        assert_allclose(found.deepest, 1 + 1.5 * (BEAM.length - at) / at, rtol=1e-12)


@pytest.mark.parametrize("stress", STRESSES)
@pytest.mark.parametrize("node", [8, 20, 32, 50])
def test_bridges_bend_as_by_finite_elements(stress, node):
    beam = replace(BEAM, tension=stress * BEAM.width * BEAM.thickness)
    found, expected = row(beam, 2, node / 64 * BEAM.length), by_elements(beam, 2, node)
    assert_allclose((found.stiffness, found.deepest), expected, rtol=2e-3)
    assert found.deepest > 1 - 1e-12


def test_a_cantilever_bends_as_by_finite_elements():
    found = row(BEAM, 1, BEAM.length * 24 / 64)
    assert_allclose((found.stiffness, found.deepest), by_elements(BEAM, 1, 24), rtol=1e-6)


def test_a_bridge_has_its_closed_form_and_both_sides_are_alike():
    length, at = BEAM.length, 60e-6
    found = row(BEAM, 2, at)
    expected = 3 * BEAM.bending_stiffness * length**3 / (at * (length - at)) ** 3
    assert_allclose(found.stiffness, expected, rtol=1e-12)
    tense = replace(BEAM, tension=50e6 * BEAM.width * BEAM.thickness)
    for beam in (BEAM, tense):
        one, other = row(beam, 2, at), row(beam, 2, length - at)
        assert_allclose((one.stiffness, one.deepest), (other.stiffness, other.deepest), rtol=1e-9)
    assert_allclose(row(BEAM, 2, length / 2).deepest, 1, rtol=1e-12)


def test_under_much_tension_a_bridge_is_a_string_that_is_deepest_at_its_row():
    at, tension = 60e-6, 1e12 * BEAM.width * BEAM.thickness
    found = row(replace(BEAM, tension=tension), 2, at)
    assert_allclose(found.stiffness, tension * (1 / at + 1 / (BEAM.length - at)), rtol=0.03)
    assert_allclose(found.deepest, 1, rtol=1e-2)

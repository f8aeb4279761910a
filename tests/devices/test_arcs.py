from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.beam.energy import apparent_adhesion_energy, arrest_length
from stiction.beam.release import EndState, released_beam
from stiction.contact import forcelaw
from stiction.devices import arcs

LAW = uniform_laws(1)[0]
ENERGY = float(forcelaw.energy(LAW))


@given(st.floats(1e-4, 2e-3))
def test_the_wedge_of_an_arc_that_is_about_to_let_go_balances_the_bending_of_the_beam(length):
    energy = arcs.arc_energy(length, PAPER)
    bending = 3 * PAPER.bending_stiffness * PAPER.gap / length**3
    assert_allclose(PAPER.width * energy / arcs.tip_slope(length, PAPER), bending, rtol=1e-12)
    assert_allclose(arcs.arc_length(energy, PAPER), length, rtol=1e-12)


def test_arcs_need_a_quarter_of_the_energy_of_eq_13():
    # The peel number of Mastrangelo and Hsu, 3 E t³ h² / (8 W L⁴), against that of the S-shape, 3 E t³ h² / (2 W L⁴).
    assert_allclose(arcs.arc_energy(1e-3, PAPER), apparent_adhesion_energy(1e-3, PAPER) / 4, rtol=1e-12)
    assert_allclose(arcs.arc_length(E_BAR, PAPER) / arrest_length(E_BAR, PAPER), np.sqrt(0.5), rtol=1e-12)


def test_energy_of_an_arc_falls_as_its_end_opens():
    # Release rate -dU/dL / w of a cantilever bent by a force at its tip, U = (3/2) EI h² / L³, is e of a long wedge.
    def bending(length):
        return 1.5 * PAPER.bending_stiffness * PAPER.gap**2 / length**3

    released = (bending(999e-6) - bending(1001e-6)) / (2e-6 * PAPER.width)
    assert_allclose(released, arcs.arc_energy(1e-3, PAPER), rtol=1e-5)


def test_arcs_of_strips_tend_to_the_peel_number_as_the_strips_shrink():
    limit = arcs.arc_length(ENERGY, PAPER)
    wedge = arcs.wedge_length(LAW, limit, PAPER)
    strips = wedge * np.array([10, 3, 1, 0.3, 0.1])
    shares = [arcs.arc_length_of_strips(PAPER, LAW, strip) / limit for strip in strips]
    assert np.all(np.diff(shares) > 0)
    assert shares[0] < 0.6
    assert_allclose(shares[-1], 1, atol=0.005)


def test_a_strip_that_is_longer_than_the_wedge_pulls_with_its_f_max():
    assert_allclose(arcs.pull_of_strips(LAW, 0.05, 1.5e-6), LAW[0] * 1.5e-6, rtol=1e-6)


def test_a_finely_divided_wedge_pulls_with_its_energy_over_its_slope():
    assert_allclose(arcs.pull_of_strips(LAW, 0.05, 5e-10), ENERGY / 0.05, rtol=1e-3)


@pytest.mark.parametrize("strip", [1.5e-6, 0.5e-6])
@pytest.mark.parametrize(("share", "state"), [(0.95, EndState.FREE), (1.05, EndState.ARC)])
def test_finite_elements_let_go_of_the_arc_where_the_wedge_of_strips_does(strip, share, state):
    per_element = 5
    limit = arcs.arc_length_of_strips(PAPER, LAW, strip)
    elements = round(share * limit / strip / per_element)
    beam = replace(PAPER, length=elements * per_element * strip, elements=elements)
    laws = np.tile(LAW, (elements * per_element, 1))
    assert released_beam(beam, laws, ENERGY).state is state


def test_wedge_of_pair_b_is_about_a_tenth_of_a_micrometre():
    # e / f_max of a few nm over a slope of about 0.04.
    assert_allclose(arcs.wedge_length(LAW, 750e-6, PAPER), ENERGY / LAW[0] / 0.04, rtol=1e-12)
    assert arcs.wedge_length(np.tile(LAW, (3, 1)), np.full(3, 750e-6), PAPER).shape == (3,)

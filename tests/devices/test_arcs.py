from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import brentq, minimize_scalar

from stiction.beam.energy import arrest_length
from stiction.beam.release import EndState, released_beam
from stiction.contact import forcelaw
from stiction.devices import arcs

LAW = uniform_laws(1)[0]
ENERGY = float(forcelaw.energy(LAW))


def pull_of_strips(slope, strip):
    """Largest force per width on a wedge whose strips have one point each, in their middles [N/m].

    The tip is lifted from contact; the largest force on the way is taken.
    """
    _, d_max, a_left, a_right = LAW
    rise = slope * strip
    # The law has decayed 40 / a_right beyond d_max, and the repulsion grows within log(2) / a_left of it.
    points = rise * (np.arange(int(np.ceil(40 / (a_right * rise))) + 1) + 0.5)

    def pull(tip):
        return -float(np.sum(forcelaw.pressure(LAW, tip + points))) * strip

    tips = np.linspace(d_max - 3 / a_left - points[0], d_max + 3 / a_right, 61)
    best = int(np.argmax([pull(tip) for tip in tips]))
    bounds = tips[max(best - 1, 0)], tips[min(best + 1, 60)]
    return -minimize_scalar(lambda tip: -pull(tip), bounds=bounds, method="bounded", options={"xatol": 1e-15}).fun


def arc_length_of_strips(strip):
    """Longest arc that comes free on uniform ground whose strips have one point each [m]."""
    limit = arcs.arc_length(ENERGY, PAPER)

    def excess(length):
        bending = 3 * PAPER.bending_stiffness * PAPER.gap / length**3
        return np.log(bending / (PAPER.width * pull_of_strips(arcs.tip_slope(length, PAPER.gap), strip)))

    return brentq(excess, 0.01 * limit, 2 * limit, rtol=1e-6)


@given(st.floats(1e-4, 0.1))
def test_the_wedge_of_an_arc_that_is_about_to_let_go_balances_the_bending_of_the_beam(energy):
    length = arcs.arc_length(energy, PAPER)
    bending = 3 * PAPER.bending_stiffness * PAPER.gap / length**3
    assert_allclose(PAPER.width * energy / arcs.tip_slope(length, PAPER.gap), bending, rtol=1e-12)


def test_arcs_need_a_quarter_of_the_energy_of_eq_13():
    # The peel number of Mastrangelo and Hsu, 3 E t³ h² / (8 W L⁴), against that of the S-shape, 3 E t³ h² / (2 W L⁴).
    assert_allclose(arcs.arc_length(E_BAR / 4, PAPER), arrest_length(E_BAR, PAPER), rtol=1e-12)
    assert_allclose(arcs.arc_length(E_BAR, PAPER) / arrest_length(E_BAR, PAPER), np.sqrt(0.5), rtol=1e-12)


def test_energy_of_an_arc_falls_as_its_end_opens():
    # Release rate -dU/dL / w of a cantilever bent by a force at its tip, U = (3/2) EI h² / L³, is e of a long wedge.
    def bending(length):
        return 1.5 * PAPER.bending_stiffness * PAPER.gap**2 / length**3

    released = (bending(999e-6) - bending(1001e-6)) / (2e-6 * PAPER.width)
    assert_allclose(arcs.arc_length(released, PAPER), 1e-3, rtol=1e-5)


def test_arcs_of_strips_tend_to_the_peel_number_as_the_strips_shrink():
    limit = arcs.arc_length(ENERGY, PAPER)
    wedge = arcs.wedge_length(ENERGY, LAW[0], arcs.tip_slope(limit, PAPER.gap))
    shares = [arc_length_of_strips(strip) / limit for strip in wedge * np.array([10, 3, 1, 0.3, 0.1])]
    assert np.all(np.diff(shares) > 0)
    assert shares[0] < 0.6
    assert_allclose(shares[-1], 1, atol=0.005)


def test_a_strip_that_is_longer_than_the_wedge_pulls_with_its_f_max():
    assert_allclose(pull_of_strips(0.05, 1.5e-6), LAW[0] * 1.5e-6, rtol=1e-6)


def test_a_finely_divided_wedge_pulls_with_its_energy_over_its_slope():
    assert_allclose(pull_of_strips(0.05, 5e-10), ENERGY / 0.05, rtol=1e-3)
    assert_allclose(LAW[0] * arcs.wedge_length(ENERGY, LAW[0], 0.05), ENERGY / 0.05, rtol=1e-12)


@pytest.mark.parametrize("strip", [1.5e-6, 0.5e-6])
@pytest.mark.parametrize(("share", "state"), [(0.95, EndState.FREE), (1.05, EndState.ARC)])
def test_finite_elements_let_go_of_the_arc_where_the_wedge_of_strips_does(strip, share, state):
    per_element = 5
    elements = round(share * arc_length_of_strips(strip) / strip / per_element)
    beam = replace(PAPER, length=elements * per_element * strip, elements=elements)
    laws = np.tile(LAW, (elements * per_element, 1))
    assert released_beam(beam, laws, ENERGY).state is state


def test_wedge_of_pair_b_is_about_a_tenth_of_a_micrometre():
    # e / f_max of a few nm over a slope of about 0.04.
    slope = arcs.tip_slope(np.array([500e-6, 750e-6]), PAPER.gap)
    assert_allclose(slope, [0.06, 0.04], rtol=1e-12)
    wedge = arcs.wedge_length(ENERGY, LAW[0], slope)
    assert_allclose(wedge * slope, ENERGY / LAW[0], rtol=1e-12)
    assert 0.05e-6 < wedge[1] < 0.2e-6

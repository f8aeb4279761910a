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
from stiction.contact.tilt import Tilt
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
    wedge = ENERGY / LAW[0] / arcs.tip_slope(limit, PAPER.gap)
    shares = [arc_length_of_strips(strip) / limit for strip in wedge * np.array([10, 3, 1, 0.3, 0.1])]
    assert np.all(np.diff(shares) > 0)
    assert shares[0] < 0.6
    assert_allclose(shares[-1], 1, atol=0.005)


def test_a_strip_that_is_longer_than_the_wedge_pulls_with_its_f_max():
    assert_allclose(pull_of_strips(0.05, 1.5e-6), LAW[0] * 1.5e-6, rtol=1e-6)


def test_a_finely_divided_wedge_pulls_with_its_energy_over_its_slope():
    assert_allclose(pull_of_strips(0.05, 5e-10), ENERGY / 0.05, rtol=1e-3)


@pytest.mark.parametrize("strip", [1.5e-6, 0.5e-6])
@pytest.mark.parametrize(("share", "state"), [(0.95, EndState.FREE), (1.05, EndState.ARC)])
def test_finite_elements_let_go_of_the_arc_where_the_wedge_of_strips_does(strip, share, state):
    per_element = 5
    elements = round(share * arc_length_of_strips(strip) / strip / per_element)
    beam = replace(PAPER, length=elements * per_element * strip, elements=elements)
    laws = np.tile(LAW, (elements * per_element, 1))
    assert released_beam(beam, laws).state is state


# Forces over the slope

SLOPES = np.geomspace(0.02, 0.3, 12)


def test_tips_whose_force_is_energy_over_slope_have_the_closed_form():
    energies = np.array([1e-3, 5e-3, 0.1])
    held = arcs.longest_free(SLOPES, energies[:, None] / SLOPES, PAPER)
    assert_allclose(held, arcs.arc_length(energies, PAPER), rtol=1e-12)


@given(st.floats(-1.5, 2.5), st.floats(0.03, 0.25))
def test_the_longest_arc_that_comes_free_balances_the_bending_of_the_beam(power, slope):
    # P = c θ^power: the balance is where the line of the logarithms crosses that of the force, at the given slope.
    forces = arcs.bending_force(slope, PAPER) * (SLOPES / slope) ** power
    (length,) = arcs.longest_free(SLOPES, forces[None], PAPER)
    assert_allclose(arcs.tip_slope(length, PAPER.gap), slope, rtol=1e-9)
    bending = 3 * PAPER.bending_stiffness * PAPER.gap / length**3
    assert_allclose(arcs.bending_force(slope, PAPER) * PAPER.width, bending, rtol=1e-9)


# Flats


def attraction_of_smooth_tip(law, slope, radius, far):
    """P/w of a smooth tip that touches, from its drop and f(u), by quadrature [N/m]."""
    tilt = Tilt((slope,), far, radius=radius)
    along = np.linspace(-tilt.before, far / slope, 400_001)
    return np.trapezoid(law(tilt.drop(slope, along)), along)


@pytest.mark.parametrize("radius", [0.0, 0.1e-6, 3e-6])
@pytest.mark.parametrize("slope", [0.02, 0.1, 0.3])
def test_no_attraction_of_an_energy_and_a_largest_value_holds_smooth_tips_harder(slope, radius):
    reach, largest = 1.5e-9, 1e8
    energy = reach * largest
    bound = arcs.flat_force(np.array([slope]), np.array([(energy, largest), (0, 0)]), radius).item()
    constant = attraction_of_smooth_tip(lambda u: largest * (u < reach), slope, radius, 1.1 * reach)
    assert_allclose(constant, bound, rtol=1e-3)
    decaying = attraction_of_smooth_tip(lambda u: largest * np.exp(-u / reach), slope, radius, 40 * reach)
    assert decaying < 1.001 * bound
    if radius:
        assert decaying < 0.99 * bound, "control: it acts farther away"


@given(st.floats(-8, -5), st.floats(-4, 0), st.floats(6, 9))
def test_the_arc_of_flats_balances_wedge_and_edge(of_radius, of_energy, of_largest):
    radius, energy, largest = 10.0 ** np.array([of_radius, of_energy, of_largest])
    parts = np.array([(energy, largest), (0.1 * energy, 10 * largest)])

    def excess(slope):
        return (arcs.bending_force(slope, PAPER) / arcs.flat_force(np.array([slope]), parts, radius)).item() - 1

    slope = brentq(excess, 1e-6, 1e3, xtol=1e-14)
    found = arcs.tip_slope(arcs.flat_length(parts, radius, PAPER), PAPER.gap)
    assert (1 - 1e-9) * slope <= found < 1.005 * slope, "the safe side"
    assert_allclose(arcs.flat_length(parts, 0.0, PAPER), arcs.arc_length(1.1 * energy, PAPER), rtol=1e-9)


def test_of_several_balances_the_shortest_arc_counts():
    forces = 0.5 * arcs.bending_force(SLOPES, PAPER)
    forces[[2, 7]] *= 4
    (length,) = arcs.longest_free(SLOPES, forces[None], PAPER)
    forces[2] /= 4
    assert arcs.longest_free(SLOPES, forces[None], PAPER) == length
    forces[7] /= 4  # control
    assert arcs.longest_free(SLOPES, forces[None], PAPER) > length


def test_below_the_slopes_tips_hold_no_longer_beams_than_smooth_ones_and_those_without_force_none():
    energy = 1e-6
    (length,) = arcs.longest_free(SLOPES, energy / SLOPES[None], PAPER)
    assert arcs.tip_slope(length, PAPER.gap) < SLOPES[0]
    assert_allclose(length, arcs.arc_length(energy, PAPER), rtol=1e-12)
    assert np.isinf(arcs.longest_free(SLOPES, np.zeros((1, 12)), PAPER))


def test_tips_that_hold_the_steepest_beams_hold_shorter_ones_with_the_same_force():
    forces = np.array([1e-3, 100.0])[:, None] / SLOPES
    found = arcs.longest_free(SLOPES, forces, PAPER)
    assert found[0] == arcs.longest_free(SLOPES, forces[:1], PAPER)[0]
    assert_allclose(arcs.bending_force(arcs.tip_slope(found[1], PAPER.gap), PAPER), forces[1, -1], rtol=1e-9)
    # The safe side: P falls on beyond the largest slope.
    wider = np.append(SLOPES, SLOPES[-1] * 2.0 ** np.arange(1, 8))
    assert found[1] < 0.9 * arcs.longest_free(wider, 100.0 / wider[None], PAPER)[0]


def test_slopes_are_common_to_devices_and_cover_lengths_from_two_thirds_to_four_times_those_in_saturated_air():
    one, both = arcs.slopes_of_tips(0.1), arcs.slopes_of_tips(0.1, 0.3)
    assert one[0] <= 0.025
    assert one[-1] >= 0.15
    assert both[-1] >= 0.45
    assert set(one) < set(both)
    assert_allclose(one[1:] / one[:-1], 2**0.25, rtol=1e-4)

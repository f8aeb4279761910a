"""Voltage as adhesion: cracks with the field along the open beam, solved as a boundary value problem, and limits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad, solve_bvp

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.constants import VACUUM_PERMITTIVITY
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.life.holding import energy_of_voltage, length_at_voltage, tip_length_at_voltage

PAPER = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 1)
PER_WIDTH = PAPER.bending_stiffness / PAPER.width  # [N m]
CONTACT = 1.72e-3  # adhesion at contact that arrests the crack near 1001 µm [J m⁻²]
#: Crack lengths by finite elements of a whole beam with unilateral contact, 1.7 mJ/m² within 60 nm, and the field
#: everywhere: two elements between which the crack ends, by voltage [V] and distance [m]; [µm].
BY_ELEMENTS = {
    (0.0, 1e-7): (1001.3, 1004.3),
    (1.0, 1e-7): (994.9, 997.9),
    (3.0, 1e-7): (950.0, 953.0),
    (10.0, 1e-7): (725.5, 729.6),
    (1.0, 25.6e-9): (976.2, 980.3),
}


def energy(voltage, distance, gap=PAPER.gap):
    """Energy that a voltage [V] across a distance [m] adds to flats [J m⁻²]."""
    return energy_of_voltage(Capacitor(Dielectric(distance, 1.0), voltage), gap)


def length_in_field(voltage, distance, ends, x, start, guess):
    """Length of the open part of a beam in the field of a voltage along it, from the conditions at its ends [m].

    Deflections are in units of the gap, lengths in units of ``guess`` [m], and places ``x`` from 0 to 1.
    """

    def bent(_, y, p):
        load = -VACUUM_PERMITTIVITY * voltage**2 / (2 * (np.maximum(y[0], 0) * PAPER.gap + distance) ** 2)
        return np.vstack([y[1:], load * (p[0] * guess) ** 4 / (PER_WIDTH * PAPER.gap)])

    found = solve_bvp(bent, ends, x, start, p=[1.0], tol=1e-6, max_nodes=100_000)
    assert found.success, found.message
    return found.p[0] * guess


def crack_in_field(voltage, distance):
    """Crack length of a beam that adheres at contact, with the attraction of a voltage along its open part [m]."""
    scale = arrest_length(CONTACT, PAPER)

    def ends(clamp, front, p):
        moment = front[2] * PAPER.gap / (p[0] * scale) ** 2
        return np.array([clamp[0] - 1, clamp[1], front[0], front[1], PER_WIDTH * moment**2 / (2 * CONTACT) - 1])

    x = 1 - np.linspace(1, 0, 800) ** 2
    start = np.vstack([1 - 3 * x**2 + 2 * x**3, 6 * (x**2 - x), 12 * x - 6, 12 + 0 * x])
    return length_in_field(voltage, distance, ends, x, start, scale)


@pytest.mark.parametrize(("voltage", "distance"), [(0.0, 1e-7), (1.0, 1e-7), (3.0, 1e-7), (10.0, 1e-7), (1.0, 25.6e-9)])
def test_a_crack_in_the_field_stops_where_the_sum_of_both_energies_says(voltage, distance):
    added = energy(voltage, distance)
    expected = length_at_voltage(arrest_length(CONTACT, PAPER), PAPER, added)
    zone = (distance / (3 * PAPER.gap)) ** 0.5  # of the field, over the length
    assert -1e-3 < crack_in_field(voltage, distance) / expected - 1 < zone / 2


@pytest.mark.parametrize("place", BY_ELEMENTS)
def test_cracks_by_finite_elements_end_where_the_sum_of_both_energies_says(place):
    voltage, distance = place
    zone = (distance / (3 * PAPER.gap)) ** 0.5
    bare, found = np.array(BY_ELEMENTS[0.0, 1e-7]) * 1e-6, np.array(BY_ELEMENTS[place]) * 1e-6
    expected = length_at_voltage(bare, PAPER, energy(voltage, distance))
    assert expected[0] < found[1] * (1 + 1e-3), "the law is safe"
    assert found[0] < expected[1] * (1 + zone / 2)


def test_the_law_of_cracks_refuses_half_and_twice_the_energy():
    found, bare = crack_in_field(10.0, 1e-7), arrest_length(CONTACT, PAPER)
    zone = (1e-7 / (3 * PAPER.gap)) ** 0.5
    for factor in (0.5, 2.0):
        wrong = length_at_voltage(bare, PAPER, factor * energy(10.0, 1e-7))
        assert abs(found / wrong - 1) > zone / 2


def test_the_energy_is_the_integral_of_the_pressure_over_the_gap():
    voltage, distance, gap = 5.0, 25e-9, 2e-6
    pressure = lambda g: Capacitor(Dielectric(distance + g, 1.0), voltage).largest_pressure  # noqa: E731
    assert_allclose(energy(voltage, distance, gap), quad(pressure, 0, gap, points=[1e-8, 1e-7])[0], rtol=1e-9)
    assert_allclose(energy(voltage, distance, 1.0), VACUUM_PERMITTIVITY * voltage**2 / 2 / distance, rtol=1e-6)


def test_no_voltage_changes_nothing_and_more_voltage_shortens_more():
    assert energy(0.0, 1e-8, 1e-6) == 0
    assert length_at_voltage(3e-4, PAPER, 0.0) == 3e-4
    added = [energy(voltage, 1e-8, 1e-6) for voltage in range(1, 30)]
    assert np.all(np.diff([length_at_voltage(3e-4, PAPER, energy) for energy in added]) < 0)


def test_lengths_of_many_beams_are_those_of_each_and_the_voltage_alone_holds_one_without_adhesion():
    lengths, added = np.array([2e-4, 7e-4, np.inf]), energy(5.0, 1e-7)
    found = length_at_voltage(lengths, PAPER, added)
    assert_allclose(found[:2], [length_at_voltage(one, PAPER, added) for one in lengths[:2]], rtol=1e-14)
    assert_allclose(found[2], arrest_length(added, PAPER), rtol=1e-9)
    np.testing.assert_array_equal(length_at_voltage(lengths, PAPER, 0.0), lengths)


def test_where_the_voltage_alone_holds_the_length_is_that_of_its_energy():
    added = 0.05
    assert_allclose(length_at_voltage(1.0, PAPER, added), arrest_length(added, PAPER), rtol=1e-9)


# Tips


def tip_in_field(force, voltage, distance):
    """Length of a beam held at its tip by a force per width, and by a voltage along its open part [m]."""
    scale = (3 * PER_WIDTH * PAPER.gap / force) ** (1 / 3)

    def ends(clamp, tip, p):
        pull = PER_WIDTH * tip[3] * PAPER.gap / (p[0] * scale) ** 3
        return np.array([clamp[0] - 1, clamp[1], tip[0], tip[2], pull / force - 1])

    x = 1 - np.linspace(1, 0, 800) ** 3
    start = np.vstack([1 - 1.5 * x**2 + x**3 / 2, 1.5 * x**2 - 3 * x, 3 * x - 3, 3 + 0 * x])
    return scale, length_in_field(voltage, distance, ends, x, start, scale)


@pytest.mark.parametrize(("voltage", "force"), [(1.0, 0.5), (3.0, 0.5), (10.0, 0.5), (10.0, 3.0)])
def test_a_tip_in_the_field_holds_what_its_force_and_the_wedge_of_the_field_say(voltage, force):
    distance = 5e-8
    without, found = tip_in_field(force, voltage, distance)
    added = energy(voltage, distance)
    expected = tip_length_at_voltage(without, PAPER, added)
    assert -1e-5 < found / expected - 1 < distance / PAPER.gap, "the law is safe, by the part beyond a wedge"
    # The law of a force that falls with the slope is longer: no lower bound.
    falling = (without**-4 + 8 * added / (3 * PAPER.young_modulus * PAPER.thickness**3 * PAPER.gap**2)) ** -0.25
    assert found < falling * (1 - 1e-4)


def test_tips_at_voltages_are_roots_of_their_balance_between_both_limits():
    lengths, scale = np.array([5e-5, 2e-4, 7e-4, 3e-3]), 3 * PAPER.bending_stiffness * PAPER.gap
    for added in 10.0 ** np.arange(-9, 3):
        found = tip_length_at_voltage(lengths, PAPER, added)
        attraction = PAPER.width * 2 * added * found / (3 * PAPER.gap)
        assert_allclose(scale / found**3, scale / lengths**3 + attraction, rtol=1e-12)
        falling = (lengths**-4 + 8 * added / (3 * PAPER.young_modulus * PAPER.thickness**3 * PAPER.gap**2)) ** -0.25
        assert np.all((0.972 * falling < found) & (found <= falling))
    alone = tip_length_at_voltage(np.inf, PAPER, 0.01)
    assert_allclose(alone, tip_length_at_voltage(1.0, PAPER, 0.01), rtol=1e-9)
    assert tip_length_at_voltage(3e-4, PAPER, 0.0) == 3e-4

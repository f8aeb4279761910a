from dataclasses import replace

import numpy as np
import pytest
from beams import bending_energy, scattered_laws, uniform_laws
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam import tension
from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy, arrest_length
from stiction.beam.equilibrium import equilibrate
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.beam.release import EndState, crack_length, release
from stiction.contact import forcelaw
from stiction.streams import stream

#: Half of a bridge of 2 µm over a gap of 2 µm.
HALF = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 160)
stresses = st.floats(1e4, 1e9)


def tensed(stress, beam=HALF):
    """Beam under a residual stress [Pa]."""
    return replace(beam, tension=stress * beam.width * beam.thickness)


def tensed_element(pull):
    """Matrix and unbalanced force of one element by the compiled code, for random unknowns."""
    u, band, force = np.random.default_rng(1).standard_normal(4), np.zeros((4, 4)), np.zeros(4)
    tension.add_tension.py_func(u, band, force, pull, 0)
    matrix = np.zeros((4, 4))
    for k in range(4):
        rows = np.arange(4 - k)
        matrix[rows, rows + k] = matrix[rows + k, rows] = band[: 4 - k, k]
    return u, matrix, force


def test_an_element_under_tension_has_half_the_tension_times_the_square_of_the_slope_as_energy():
    u, matrix, force = tensed_element(7.0)
    s, weights = np.polynomial.legendre.leggauss(4)
    s, weights = (s + 1) / 2, weights / 2
    rates = np.stack([6 * s**2 - 6 * s, 1 - 4 * s + 3 * s**2, 6 * s - 6 * s**2, 3 * s**2 - 2 * s], -1)  # of hermite
    assert_allclose(matrix, 7.0 * rates.T * weights @ rates, atol=1e-14)
    assert_allclose(force, -matrix @ u, rtol=1e-12)


@given(st.floats(1e-6, 1e-3))
def test_without_tension_an_end_is_as_stiff_as_a_clamped_beam(kl):
    assert_allclose(tension.end_stiffness(kl), (12, 6, 4, 2), rtol=kl**2)


@given(st.floats(0.02, 20))
def test_the_stiffness_of_an_end_is_that_of_the_hyperbolic_functions(kl):
    sinh, cosh = np.sinh(kl), np.cosh(kl)
    forces = (kl**3 * sinh, kl**2 * (cosh - 1), kl * (kl * cosh - sinh), kl * (sinh - kl))
    expected = np.array(forces) / (2 - 2 * cosh + kl * sinh)
    # The denominator, kl⁴/12 for short beams, is a difference of numbers near 2.
    assert_allclose(tension.end_stiffness(kl), expected, rtol=1e-12 + 1e-14 / kl**4)


def test_the_open_part_is_one_element_with_the_stiffness_of_its_end():
    u, band, force = np.zeros(12), np.zeros((12, 4)), np.zeros(12)
    first, stiffness, load, kl = 5, 3.0, 0.7, 2.5
    u[10:] = 0.3, -0.2
    tension.add_open_part_in_tension.py_func(u, band, force, first, kl, stiffness, load)
    f, c, m, _ = tension.end_stiffness(kl)
    matrix = np.array([[f / first**3, -c / first**2], [-c / first**2, m / first]]) * stiffness
    assert_allclose([band[10, 0], band[10, 1], band[11, 0]], [matrix[0, 0], matrix[0, 1], matrix[1, 1]], rtol=1e-14)
    # The moment of a uniform load at a clamped end: q L² (x coth x - 1) / (2x)², x = kL/2.
    x = kl / 2
    clamping = load * first**2 * (x / np.tanh(x) - 1) / kl**2
    assert_allclose(force[10:], [load * first / 2, -clamping] - matrix @ u[10:], rtol=1e-13)
    assert not band[:10].any()


@pytest.mark.parametrize("kl", [0.5, 3.0, 12.0])
def test_the_deflection_of_the_open_part_solves_its_equation(kl):
    first, stiffness, load = 30, 3.0, 1e-3
    u = np.zeros(62)
    u[60:] = 0.9, 0.05
    tension.fill_open_part_in_tension.py_func(u, first, kl, stiffness, load)
    s, q = np.arange(30) / first, load * first**4 / stiffness

    def terms(s):
        """Four solutions of the equation without load, and their slopes."""
        sinh, cosh = np.sinh(kl * s), np.cosh(kl * s)
        return np.array([s**0, s, cosh, sinh]), np.array([0 * s, s**0, kl * sinh, kl * cosh])

    ends = np.array([terms(np.array(end)) for end in (0.0, 1.0)]).reshape(4, 4)
    constants = np.linalg.solve(ends, [0, 0, u[60] + q / (2 * kl**2), u[61] * first + q / kl**2])
    value, rate = (constants @ term for term in terms(s))
    assert_allclose(u[:60:2], value - q * s**2 / (2 * kl**2), atol=1e-8)
    assert_allclose(u[1:60:2] * first, rate - q * s / kl**2, atol=1e-8)


@given(st.floats(1e-4, 5e-3), stresses)
def test_release_rate_is_the_closed_form_with_hyperbolic_tangents(crack, stress):
    beam = tensed(stress)
    t = np.tanh(beam.decay * crack / 2)
    expected = beam.tension * beam.gap**2 * t**2 / (2 * beam.width * (crack - 2 / beam.decay * t) ** 2)
    assert_allclose(apparent_adhesion_energy(crack, beam), expected, rtol=1e-9)


def test_release_rate_tends_to_eq_13_without_tension_and_to_a_string_under_high_tension():
    crack = 200e-6
    slack = tensed(1.0)
    assert_allclose(tension.release_rate(crack, slack), apparent_adhesion_energy(crack, HALF), rtol=1e-6)
    string = tensed(1e14)
    expected = 1e14 * string.thickness * string.gap**2 / (2 * crack**2)
    assert_allclose(tension.release_rate(crack, string), expected, rtol=4 * 2 / (string.decay * crack))


@given(st.floats(1e-4, 1.0), stresses)
def test_arrest_under_tension_is_a_round_trip(energy, stress):
    beam = tensed(stress)
    assert_allclose(apparent_adhesion_energy(arrest_length(energy, beam), beam), energy, rtol=1e-10)


def test_arrest_lengths_of_arrays_have_their_shape():
    energies = np.array([[1e-3, 2e-3], [4e-3, 8e-3]])
    found = arrest_length(energies, tensed(10e6))
    assert found.shape == (2, 2)
    assert np.all(np.diff(found.ravel()) < 0)


@given(st.floats(1e-4, 1.0), stresses)
def test_tension_lengthens_the_crack(energy, stress):
    assert arrest_length(energy, tensed(stress)) > arrest_length(energy, HALF)


@pytest.mark.parametrize("stress", [0.0, 10e6, 200e6])
def test_uniform_ground_arrests_a_beam_under_tension_at_the_closed_form(stress):
    beam = tensed(stress)
    laws = uniform_laws(800)
    found = crack_length(beam, laws, release(beam, laws, 60e-6).deflection)
    # The mesh resolves the foundation length of 3 µm (App. C: 2.5 % of Γ); the first contact is before the end.
    assert_allclose(found, arrest_length(float(forcelaw.energy(laws[0])), beam), rtol=0.015)


@pytest.mark.parametrize("stress", [1e2, 1e5, 10e6, 200e6])
@pytest.mark.parametrize(("load", "tip_force"), [(1e-3, 0.0), (0.0, 1e-7), (1e-3, -1e-7)])
def test_the_deflection_of_a_free_beam_under_tension_is_that_of_the_closed_form(stress, load, tip_force):
    beam = replace(tensed(stress), length=200e-6, elements=40)
    found = equilibrate(beam, np.zeros((0, 4)), np.zeros((41, 2)), load, tip_force).deflection
    k, n, x, end = beam.decay, beam.tension, beam.nodes, beam.length
    # EI u'' = M with M'' - k² M = q, M(L) = 0 and M'(0) = -(q L + P), because u'(0) = 0.
    system = [[np.cosh(k * end), np.sinh(k * end)], [0.0, beam.bending_stiffness * k]]
    c1, c2 = np.linalg.solve(system, [load / n, -(load * end + tip_force)])
    u = c1 * (np.cosh(k * x) - 1) / k**2 + c2 * (np.sinh(k * x) - k * x) / k**2 - load * x**2 / (2 * n)
    slope = c1 * np.sinh(k * x) / k + c2 * (np.cosh(k * x) - 1) / k - load * x / n
    accuracy = 3e-5 if k * end < tension.SLACK else 1e-6  # rounding of this test: 1e-16 e^kL
    for values, expected in zip(found.T, (u, slope), strict=True):
        assert_allclose(values, expected, atol=accuracy * np.abs(expected).max())


@pytest.mark.parametrize("stress", [1e6, 200e6])
def test_a_released_beam_under_tension_does_not_depend_on_its_start(stress):
    laws, beam = scattered_laws(np.random.default_rng(5), 800, 0.5), tensed(stress)
    cracks = [crack_length(beam, laws, release(beam, laws, start).deflection) for start in (40e-6, 60e-6, 80e-6)]
    assert_allclose(cracks, cracks[0], rtol=1e-7)


def test_a_crack_that_is_too_long_closes_under_tension():
    # The open part is filled, found too long, and assembled again element by element.
    laws, beam = uniform_laws(800), tensed(50e6)
    opened = crack_length(beam, laws, release(beam, laws, 60e-6).deflection)
    s = np.minimum(beam.nodes / 450e-6, 1)
    start = np.stack([s**2 * (3 - 2 * s), 6 * s * (1 - s) / 450e-6], -1) * (beam.gap - 7e-9)
    closed = crack_length(beam, laws, equilibrate(beam, laws, start).deflection)
    assert_allclose(closed, opened, rtol=0.025 / 4)


def test_many_beams_under_tension_stop_close_to_the_closed_form_and_state_its_energy():
    beam = tensed(50e6)
    experiment = Experiment(beam, 800, lambda n, _: uniform_laws(n))
    ends = columns(list(simulate(experiment, [0, 1], lambda k: stream(1, k))))
    assert_array_equal(ends["state"], EndState.S_SHAPE)
    assert_allclose(ends["energy"], tension.release_rate(ends["crack_length"], beam), rtol=1e-12)


def test_energy_released_by_a_beam_under_tension_is_that_of_bending_and_pulling():
    beam = replace(tensed(20e6), elements=600)
    energies = []
    for crack in (199e-6, 201e-6):
        part = replace(beam, length=crack)
        k = part.decay
        y = part.nodes / crack - 0.5
        q = np.sinh(k * crack * y) / np.sinh(k * crack / 2)
        drop = k * crack / np.tanh(k * crack / 2) - 2
        u = part.gap * (0.5 + y - (q - 2 * y) / drop)
        rate = part.gap / crack * (1 - (k * crack * np.cosh(k * crack * y) / np.sinh(k * crack / 2) - 2) / drop)
        pulled = beam.tension / 2 * np.trapezoid(rate**2, part.nodes)
        energies.append(bending_energy(part, np.stack([u, rate], -1)) + pulled)
    released = (energies[0] - energies[1]) / (2e-6 * beam.width)
    assert_allclose(released, tension.release_rate(200e-6, beam), rtol=1e-3)

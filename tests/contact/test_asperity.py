from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from scipy.integrate import quad
from scipy.optimize import brentq

from stiction.contact.asperity import (
    HertzAsperity,
    MaugisTable,
    asperity,
    deep_load,
    hertz_force,
    hertz_maximum_stress,
    interference_scale,
    maugis_apart,
    maugis_branch,
    maugis_in_contact,
    reduced_modulus,
    touching_radius,
    transition_parameter,
    weak_load,
)
from stiction.contact.vanderwaals import DugdaleAttraction, attraction
from stiction.surface.summits import find_summits

POLYSILICON = reduced_modulus(164e9, 0.23)
WATER = MaugisTable(POLYSILICON, attraction("water"))
interferences, radii, moduli = st.floats(1e-11, 1e-7), st.floats(1e-8, 1e-5), st.floats(1e10, 2e11)


def summits(heights, spacing):
    """Heights and curvatures of the summits of a surface."""
    return find_summits(heights, spacing)[:2]


def test_two_equal_bodies_are_half_as_stiff_as_one_against_a_rigid_one():
    alone = 164e9 / (1 - 0.23**2)
    np.testing.assert_allclose(1 / POLYSILICON, 2 / alone, rtol=1e-14)


@given(interferences, radii, moduli)
def test_hertz_force_is_the_gradient_of_hertz_energy(interference, radius, modulus):
    def energy(overlap):
        return 8 / 15 * modulus * np.sqrt(radius) * overlap**2.5

    step = 1e-4 * interference
    gradient = (energy(interference + step) - energy(interference - step)) / (2 * step)
    np.testing.assert_allclose(hertz_force(interference, radius, modulus), gradient, rtol=1e-7)  # step² / 8


@given(interferences, radii, moduli)
def test_hertz_force_is_the_load_on_a_row_of_springs_under_the_sphere(interference, radius, modulus):
    edge = np.sqrt(radius * interference)
    springs = quad(lambda x: 2 * modulus * interference * edge * (1 - x**2), 0, 1)[0]
    np.testing.assert_allclose(hertz_force(interference, radius, modulus), springs, rtol=1e-10)


@given(interferences, radii, moduli)
def test_largest_hertz_stress_is_three_halves_of_the_mean_stress(interference, radius, modulus):
    mean = hertz_force(interference, radius, modulus) / (np.pi * radius * interference)
    np.testing.assert_allclose(hertz_maximum_stress(interference, radius, modulus), 1.5 * mean, rtol=1e-10)


def test_elastic_bodies_apart_feel_nothing():
    apart = np.array([-1e-9, 0.0])
    np.testing.assert_array_equal(hertz_force(apart, 1e-7, POLYSILICON), 0)
    np.testing.assert_array_equal(hertz_maximum_stress(apart, 1e-7, POLYSILICON), 0)


def dugdale_sphere(contact, adhesive, radius, modulus, stress):
    """Load, interference and work of adhesion of a sphere that touches and is pulled by ``stress`` within two radii.

    By the method of dimensionality reduction: a row of springs with a displacement u(x) that is continuous where the
    contact ends.
    The work is the stress times the gap at the edge of the attraction.
    """

    def pull(x):
        return -2 * stress * np.sqrt(adhesive**2 - x**2) / modulus

    interference = contact**2 / radius + pull(contact)
    angle = np.arcsin(contact / adhesive)

    def spring(t):
        x = adhesive * np.sin(t)
        return interference - x**2 / radius if t < angle else pull(x)

    def over_both_parts(function):
        return quad(function, 0, angle)[0] + quad(function, angle, np.pi / 2)[0]

    load = 2 * modulus * over_both_parts(lambda t: spring(t) * adhesive * np.cos(t))
    gap = adhesive**2 / (2 * radius) - interference + 2 / np.pi * over_both_parts(spring)
    return load, interference, stress * gap


@pytest.mark.parametrize("contact_nm", [1.0, 4.0, 12.0])
@pytest.mark.parametrize("excess", [1.02, 1.5, 6.0])
def test_maugis_in_contact_is_a_sphere_on_springs_pulled_by_a_constant_stress(contact_nm, excess):
    contact, radius, stress = contact_nm * 1e-9, 4e-7, 4e8
    force, interference, work = dugdale_sphere(contact, excess * contact, radius, POLYSILICON, stress)
    unit = (np.pi * work * radius**2 / (4 / 3 * POLYSILICON)) ** (1 / 3)  # of lengths in the plane of contact
    transition = 2 * stress * unit**2 / (np.pi * work * radius)
    load, delta = maugis_in_contact(np.array([np.sqrt(excess**2 - 1)]), transition)
    # Quadrature across the bend of the springs is good to 1e-7 of the force scale.
    np.testing.assert_allclose(load * np.pi * work * radius, force, rtol=0, atol=1e-6 * np.pi * work * radius)
    np.testing.assert_allclose(delta * unit**2 / radius, interference, rtol=1e-6)


@pytest.mark.parametrize("adhesive_nm", [2.0, 9.0])
def test_maugis_apart_is_a_sphere_pulled_by_a_constant_stress_alone(adhesive_nm):
    adhesive, radius, stress = adhesive_nm * 1e-9, 4e-7, 4e8
    # Without contact any height of the sphere is in balance; the edge of the attraction fixes it.
    work = stress * WATER.attraction.range
    force = -np.pi * adhesive**2 * stress
    bulge = 2 / np.pi * quad(lambda t: -2 * stress * adhesive * np.cos(t) / POLYSILICON, 0, np.pi / 2)[0]
    interference = adhesive**2 / (2 * radius) + bulge - WATER.attraction.range
    unit = (np.pi * work * radius**2 / (4 / 3 * POLYSILICON)) ** (1 / 3)
    transition = 2 * stress * unit**2 / (np.pi * work * radius)
    load, delta = maugis_apart(adhesive / unit, transition)
    np.testing.assert_allclose(load * np.pi * work * radius, force, rtol=1e-10)
    np.testing.assert_allclose(delta * unit**2 / radius, interference, rtol=1e-10)


@given(radii, moduli)
def test_scales_of_a_sphere_are_those_of_maugis(radius, modulus):
    pull, stiffness = attraction("dry"), 4 / 3 * modulus
    unit = (np.pi * pull.work_of_adhesion * radius**2 / stiffness) ** (1 / 3)  # of the contact radius
    np.testing.assert_allclose(interference_scale(radius, modulus, pull), unit**2 / radius, rtol=1e-12)
    pull_on_unit = 2 * pull.stress * unit**2 / (np.pi * pull.work_of_adhesion * radius)
    np.testing.assert_allclose(transition_parameter(radius, modulus, pull), pull_on_unit, rtol=1e-12)


@pytest.mark.parametrize(("transition", "golden"), [(0.1, 1.95060), (0.5, 1.71825), (1.0, 1.60074), (5.0, 1.50635)])
def test_pull_off_force_is_that_of_an_independent_solution(transition, golden):
    load, _ = maugis_branch(transition)
    np.testing.assert_allclose(-load.min(), golden, rtol=0, atol=1e-5)


def test_pull_off_force_falls_from_dmt_to_jkr():
    transitions = np.geomspace(1e-3, 30, 25)
    pull_off = np.array([-maugis_branch(x)[0].min() for x in transitions])
    assert np.all(np.diff(pull_off) < 0)
    np.testing.assert_allclose(pull_off[0], 2, atol=1e-3)
    np.testing.assert_allclose(pull_off[-1], 1.5, atol=1e-3)


@pytest.mark.parametrize("transition", [1e-3, 1e-5])
def test_maugis_tends_to_dmt_for_small_hard_spheres(transition):
    load, interference = maugis_branch(transition, points=100_000)
    overlap = np.linspace(0.5, 4, 30)
    # The limit is approached only like the square root of λ.
    np.testing.assert_allclose(np.interp(overlap, interference, load), overlap**1.5 - 2, atol=5 * np.sqrt(transition))


@pytest.mark.parametrize("transition", [10, 50])
def test_maugis_tends_to_jkr_for_large_soft_spheres(transition):
    load, interference = maugis_branch(transition, points=100_000)
    a = np.linspace((1 / 6) ** (1 / 3), 4, 100_000)  # from the least interference on
    jkr_load, jkr_interference = a**3 - a * np.sqrt(6 * a), a**2 - 2 / 3 * np.sqrt(6 * a)
    overlap = np.linspace(-0.9, 8, 200)
    error = np.interp(overlap, interference, load) - np.interp(overlap, jkr_interference, jkr_load)
    assert np.abs(error).max() < 1.3 / transition**2


@given(st.floats(0.02, 20), st.floats(0.02, 100))
def test_gap_closes_at_the_edge_of_the_attraction(transition, spread):
    _, interference = maugis_in_contact(np.array([spread]), transition)
    # One of the two contact radii that δ̄ = ā² - (4/3) λ ā u allows must obey Maugis' closure.
    half = 2 / 3 * transition * spread
    a = half + np.array([-1, 1]) * np.sqrt(half**2 + interference)
    m, t = np.hypot(spread, 1), np.arctan(spread)
    closure = transition * a**2 / 2 * (spread + (m**2 - 2) * t) + 4 / 3 * transition**2 * a * (spread * t - m + 1)
    assert np.abs(closure - 1).min() < 1e-5  # a small radius is the difference of large numbers


@pytest.mark.parametrize("transition", [0.05, 0.3, 1.0, 5.0])
def test_sphere_that_comes_to_touch_carries_on_where_the_free_one_ended(transition):
    touching = maugis_in_contact(np.array([1e7]), transition)
    free = maugis_apart(np.array([touching_radius(transition)]), transition)
    np.testing.assert_allclose(touching, free, rtol=0, atol=1e-5)


@pytest.mark.parametrize("transition", [0.03, 0.2, 0.7, 6.0])
def test_stable_states_are_ordered_by_interference_and_reach_deep_into_contact(transition):
    _, interference = maugis_branch(transition)
    assert np.all(np.diff(interference) > 0)
    assert interference[-1] > 1000


@pytest.mark.parametrize("transition", [0.03, 0.1, 0.3])
def test_hard_sphere_snaps_off_where_its_free_state_loses_stability(transition):
    c = 8 * transition / (3 * np.pi)
    load, interference = maugis_branch(transition)
    np.testing.assert_allclose(interference[0], -(c**2) / 2 - 2 / (np.pi * transition), rtol=1e-12)
    np.testing.assert_allclose(load[0], -np.pi / 2 * transition * c**2, rtol=1e-12)


@pytest.mark.parametrize("transition", [1.0, 3.0, 6.0])
def test_soft_sphere_snaps_off_in_contact_at_a_vertical_tangent(transition):
    load, interference = maugis_branch(transition, points=60_000)
    assert load[0] > load.min() + 1e-3  # beyond the pull-off force
    slope = (load[1] - load[0]) / (interference[1] - interference[0])
    assert abs(slope) > 50


def test_maugis_without_attraction_is_hertz():
    faint = MaugisTable(POLYSILICON, DugdaleAttraction(1e-30))
    interference = np.linspace(1e-10, 5e-9, 20)
    np.testing.assert_allclose(faint.force(interference, 3e-7), hertz_force(interference, 3e-7, POLYSILICON), rtol=1e-4)


@given(st.floats(0.3, 4))
def test_spheres_with_the_same_transition_parameter_are_similar(factor):
    # λ and the scale of interference depend on R / E'² only: twice as stiff and four times as blunt pulls four times
    # as hard.
    similar = MaugisTable(factor * POLYSILICON, WATER.attraction)
    interference = np.linspace(-2e-10, 2e-9, 9)
    np.testing.assert_allclose(
        similar.force(interference, factor**2 * 2e-7), factor**2 * WATER.force(interference, 2e-7), rtol=1e-9
    )


@given(st.floats(1e-8, 1e-5))
def test_sphere_out_of_reach_feels_nothing(radius):
    scale = interference_scale(radius, POLYSILICON, WATER.attraction)
    load, delta = maugis_branch(transition_parameter(radius, POLYSILICON, WATER.attraction), 20_000)
    force = WATER.force(np.array([-1e-8, delta[0] * scale * (1 + 1e-9), delta[0] * scale * (1 - 1e-9)]), radius)
    np.testing.assert_array_equal(force[:2], 0)
    np.testing.assert_allclose(force[2], np.pi * WATER.attraction.work_of_adhesion * radius * load[0], rtol=1e-2)


def test_tabulated_load_is_the_load_of_the_branch():
    roots = np.linspace(*WATER.roots)
    for row in (0, 27, 90, 154, 180):
        load, delta = maugis_branch(WATER.rows[row], 50_000)
        exact = np.interp(roots**2, delta - delta[0], load)
        # Both interpolate: 6000 states against 50 000; the error stays below 1e-4 of the pull-off force or load.
        # Snap-off itself has a vertical tangent.
        np.testing.assert_allclose(WATER.load[row][1:], exact[1:], rtol=1e-4, atol=1e-4)
        assert WATER.load[row][0] == pytest.approx(load[0], abs=5e-3)
        assert WATER.snap_off[row] == pytest.approx(delta[0], abs=1e-6)


def test_dimensional_scales_are_those_of_a_sphere_of_one_metre():
    log_transition, interference, force, first, before, log_step, root_step = WATER.scales
    np.testing.assert_allclose(
        log_transition, np.log(transition_parameter(1.0, POLYSILICON, WATER.attraction)), rtol=1e-14
    )
    np.testing.assert_allclose(interference, interference_scale(1.0, POLYSILICON, WATER.attraction), rtol=1e-14)
    np.testing.assert_allclose(force, np.pi * WATER.attraction.work_of_adhesion, rtol=1e-14)
    low, high, n = WATER.transitions
    np.testing.assert_allclose(np.exp(first + log_step * np.arange(n))[[0, -1]], [low, high], rtol=1e-12)
    np.testing.assert_allclose(np.exp(first + log_step * (np.arange(len(WATER.rows)) - before)), WATER.rows, rtol=1e-12)
    assert root_step * (WATER.load.shape[1] - 1) == pytest.approx(WATER.roots[1], rel=1e-12)


def test_without_attraction_an_asperity_is_hertz_and_with_it_maugis():
    assert asperity(POLYSILICON, attraction("none")) == HertzAsperity(POLYSILICON)
    assert asperity(POLYSILICON, attraction("water")) == WATER
    interference = np.linspace(-1e-9, 5e-9, 7)
    found = HertzAsperity(POLYSILICON).force(interference, 3e-7)
    np.testing.assert_array_equal(found, hertz_force(interference, 3e-7, POLYSILICON))


@pytest.mark.parametrize("model", [HertzAsperity(POLYSILICON), WATER], ids=["Hertz", "Maugis"])
def test_force_of_a_surface_with_one_summit_is_that_of_a_sphere(model):
    radius, spacing, step = 3e-7, 10e-9, 0.05e-9
    x = spacing * np.arange(-3, 4)
    heights = (5e-9 - (x[:, None] ** 2 + x**2) / (2 * radius)).astype(np.float32)
    total = np.ones(150)
    model.add_forces(*summits(heights, spacing), step, total)
    exact = model.force(5e-9 - step * np.arange(150), radius)
    # Single precision of the heights, and the interpolation between rows of λ near the first contact.
    np.testing.assert_allclose(
        total - 1, exact, rtol=2e-3, atol=0.015 * np.pi * WATER.attraction.work_of_adhesion * radius
    )


def test_a_summit_in_deep_contact_has_the_deep_load_of_its_own_radius():
    water, radius, tops = attraction("water"), 3e-7, 8e-9 - 0.05e-9 * np.arange(120)
    weak = SimpleNamespace(work_of_adhesion=water.work_of_adhesion / 200, stress=water.stress)
    found = np.zeros(120)
    MaugisTable(POLYSILICON, weak).add_forces(np.array([tops[0]]), np.array([1 / radius]), 0.05e-9, found)
    interference = tops / interference_scale(radius, POLYSILICON, weak)
    deep = interference > 950  # beyond the table
    unit = np.pi * weak.work_of_adhesion * radius
    load, hertz = (unit * np.array([deep_load(x) + pull for x in interference[deep]]) for pull in (0, 1))
    np.testing.assert_allclose(found[deep], load, rtol=1e-9)
    assert np.all(np.abs(hertz / load - 1) > 1e-8)
    assert 0 < deep.sum() < 120


@pytest.mark.parametrize("model", [HertzAsperity(POLYSILICON), WATER], ids=["Hertz", "Maugis"])
@pytest.mark.parametrize(("height", "feels"), [(-0.1e-9, False), (0.1e-9, True)])
def test_summits_below_the_mean_plane_feel_nothing(model, height, feels):
    radius, spacing = 3e-7, 10e-9
    x = spacing * np.arange(-3, 4)
    force = np.zeros(20)
    cap = (height - (x[:, None] ** 2 + x**2) / (2 * radius)).astype(np.float32)
    model.add_forces(*summits(cap, spacing), 0.05e-9, force)
    assert np.any(force != 0) == feels


def test_another_attraction_of_the_same_work_and_stress_gives_the_same_asperity():
    found = attraction("water")
    other = SimpleNamespace(work_of_adhesion=found.work_of_adhesion, stress=found.stress)
    at = np.linspace(-2e-9, 3e-9, 50)
    assert_array_equal(MaugisTable(POLYSILICON, other).force(at, 1e-6), MaugisTable(POLYSILICON, found).force(at, 1e-6))


def test_rows_beyond_the_first_range_leave_those_inside_unchanged():
    inside = slice(WATER.further[0], -WATER.further[1])
    np.testing.assert_array_equal(WATER.rows[inside], np.geomspace(*WATER.transitions))
    roots = np.linspace(*WATER.roots)
    for transition, load in list(zip(WATER.rows, WATER.load, strict=True))[inside][::21]:
        states, delta = maugis_branch(transition)
        np.testing.assert_array_equal(load, np.interp(roots, np.sqrt(delta - delta[0]), states))


@given(st.floats(np.log(0.01), np.log(1e3)), st.floats(np.log(800), np.log(1e6)))
def test_deep_contact_has_the_load_of_maugis(log_transition, log_interference):
    transition, interference = np.exp(log_transition), np.exp(log_interference)

    def state(log_spread):
        return np.ravel(maugis_in_contact(np.exp([log_spread]), transition))

    spread = brentq(lambda x: state(x)[1] - interference, np.log(1e-7), np.log(10), xtol=1e-13)
    load = state(spread)[0]
    # The closure loses up to half of its digits to cancellation at the smallest spreads.
    assert -1e-6 * load < deep_load(interference) - load < 0.07 + 1e-6 * load


@given(st.floats(30, 1e3))
def test_deep_contact_of_a_large_soft_sphere_is_jkr(a):
    load, interference = a**3 - a * np.sqrt(6 * a), a**2 - 2 / 3 * np.sqrt(6 * a)
    assert deep_load(interference) == pytest.approx(load, abs=0.3 / a**1.5)  # the next order in 1/a


@given(st.floats(5, 12), st.floats(-9, -6.5))
@example(10.9, -6.5)
@example(10.5, -6.8)
def test_any_solid_and_any_height_of_a_summit_have_the_force_of_the_exact_solution(log_modulus, log_height):
    solid, height = MaugisTable(10**log_modulus, WATER.attraction), 10**log_height
    radius, spacing, step = 3e-7, 10e-9, height / 40
    x = spacing * np.arange(-1, 2)
    heights = (height - (x[:, None] ** 2 + x**2) / (2 * radius)).astype(np.float32)
    total = np.zeros(60)
    with patch.object(MaugisTable, "load", WATER.load), patch.object(MaugisTable, "snap_off", WATER.snap_off):
        solid.add_forces(*summits(heights, spacing), step, total)
    exact = solid.force(height - step * np.arange(60), radius)
    pull = np.pi * WATER.attraction.work_of_adhesion * radius
    snap = maugis_branch(transition_parameter(radius, solid.modulus, WATER.attraction))[1][0]
    near = np.abs((height - step * np.arange(60)) / interference_scale(radius, solid.modulus, WATER.attraction) - snap)
    # Single precision of heights; interpolation between rows of λ. The load is vertical at snap-off.
    np.testing.assert_allclose(total[near > 0.02], exact[near > 0.02], rtol=5e-4, atol=0.03 * pull)


@pytest.mark.parametrize("transition", [1e-5, 1e-3, 9e-3])
def test_weak_attraction_is_the_limit_of_maugis_in_contact_and_apart(transition):
    load, delta = maugis_branch(transition, points=100_000)
    apart, contact = np.linspace(0.999 * delta[0], -1, 500), np.linspace(0, 300, 500)
    found = np.array([[weak_load(x, transition) for x in at] for at in (apart, contact)])
    exact = np.interp([apart, contact], delta, load)
    np.testing.assert_allclose(found[0], exact[0], rtol=0, atol=0.003)
    assert np.all(exact[1] > found[1] - 1e-3)
    assert np.all(exact[1] < found[1] + np.minimum(1, 8 * np.sqrt(transition) * (1 + contact) ** 0.5))
    assert weak_load(1.001 * delta[0], transition) == 0


@pytest.mark.parametrize("transition", [1e-4, 3e-3, 9e-3])
def test_summits_before_the_table_have_the_force_of_the_exact_solution(transition):
    radius, step = 3e-7, 0.02e-9
    strong = transition_parameter(radius, POLYSILICON, WATER.attraction)
    # λ grows with the Hamaker constant to the power of two thirds.
    pull = attraction("water", WATER.attraction.hamaker_constant * (transition / strong) ** 1.5)
    solid, total = MaugisTable(POLYSILICON, pull), np.ones(300)
    solid.add_forces(np.array([2e-9, 1e-9]), np.full(2, 1 / radius), step, total)
    exact = sum(solid.force(top - step * np.arange(300), radius) for top in (2e-9, 1e-9))
    scale = np.pi * pull.work_of_adhesion * radius
    np.testing.assert_allclose(total - 1, exact, rtol=2e-4, atol=2 * scale)  # each sphere by its scale at most
    apart = step * np.arange(300) > 2e-9
    assert np.count_nonzero(exact[apart]) > 5
    np.testing.assert_allclose(total[apart] - 1, exact[apart], rtol=0, atol=0.01 * scale)

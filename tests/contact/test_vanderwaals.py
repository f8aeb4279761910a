import numpy as np
import pytest
from scipy.integrate import quad

from stiction.constants import HAMAKER_CONSTANT, MOLECULAR_DISTANCE
from stiction.contact.vanderwaals import DugdaleAttraction, attraction


def half_space_pressure(distance, hamaker_constant):
    """Lennard-Jones repulsion minus attraction of two half spaces [Pa]."""
    return hamaker_constant / (6 * np.pi) * (2 / 15 * MOLECULAR_DISTANCE**6 / distance**9 - distance**-3)


@pytest.mark.parametrize("through", ["water", "dry"])
def test_half_spaces_exert_no_force_at_the_equilibrium_distance(through):
    pull = attraction(through)
    at_rest = half_space_pressure(pull.equilibrium_distance, pull.hamaker_constant)
    assert abs(at_rest) < 1e-9 * abs(half_space_pressure(1.1 * pull.equilibrium_distance, pull.hamaker_constant))


@pytest.mark.parametrize("through", ["water", "dry"])
def test_work_of_adhesion_is_the_work_against_the_lennard_jones_pressure(through):
    pull = attraction(through)
    start = pull.equilibrium_distance
    # In units of the equilibrium distance, where quadrature keeps its relative accuracy.
    work = quad(lambda x: -start * half_space_pressure(x * start, pull.hamaker_constant), 1, np.inf, epsrel=1e-10)[0]
    np.testing.assert_allclose(pull.work_of_adhesion, work, rtol=1e-8)


@pytest.mark.parametrize("through", ["water", "dry"])
def test_dugdale_stress_does_the_work_of_adhesion_over_its_range(through):
    pull = attraction(through)
    np.testing.assert_allclose(pull.stress * pull.range, pull.work_of_adhesion, rtol=1e-14)


def test_distances_and_stress_are_those_of_the_paper():
    pull = attraction("water")
    assert round(pull.equilibrium_distance * 1e10, 2) == 1.49
    assert round(pull.range * 1e10, 2) == 2.28
    # The published values follow from D₀ rounded to 1.49 Å, an error of a quarter of a percent, which enters squared.
    np.testing.assert_allclose(pull.work_of_adhesion, 0.0874, rtol=6e-3)
    np.testing.assert_allclose(pull.stress, 383e6, rtol=6e-3)


def test_water_weakens_the_attraction_by_the_ratio_of_the_hamaker_constants():
    ratio = HAMAKER_CONSTANT["dry"] / HAMAKER_CONSTANT["water"]
    np.testing.assert_allclose(ratio, 18.65 / 9.75, rtol=1e-14)
    np.testing.assert_allclose(attraction("dry").stress / attraction("water").stress, ratio, rtol=1e-14)
    assert attraction("dry").range == attraction("water").range


def test_no_attraction_is_none_and_not_one_of_zero_strength():
    assert attraction("none") is None
    with pytest.raises(ValueError, match="positive Hamaker constant, got 0 J"):
        DugdaleAttraction(0.0)


def test_unknown_medium_is_refused_by_name():
    with pytest.raises(ValueError, match="water, dry or none, got 'oil'"):
        attraction("oil")


@pytest.mark.parametrize("through", ["water", "dry"])
def test_other_solids_attract_in_proportion_to_their_hamaker_constant(through):
    own = attraction(through, 3 * HAMAKER_CONSTANT[through])
    np.testing.assert_allclose(own.stress, 3 * attraction(through).stress, rtol=1e-14)
    assert attraction(through, HAMAKER_CONSTANT[through]) == attraction(through)
    assert attraction("none", 1e-20) is None


# Coatings

THICK = 2.4e-9


@pytest.mark.parametrize("spacer", [0.05e-9, 0.5e-9, THICK])
def test_coated_half_spaces_need_the_work_from_the_distance_at_which_their_coatings_touch(spacer):
    pull = DugdaleAttraction(HAMAKER_CONSTANT["dry"], spacer)
    start = pull.closest_distance
    work = quad(lambda x: -start * half_space_pressure(x * start, pull.hamaker_constant), 1, np.inf, epsrel=1e-10)[0]
    np.testing.assert_allclose(pull.work_of_adhesion, work, rtol=1e-8)
    plain = DugdaleAttraction(pull.hamaker_constant).work_of_adhesion
    assert abs(plain * (DugdaleAttraction(1.0).equilibrium_distance / start) ** 2 / work - 1) > 0.1  # Eq. (10) at D


@pytest.mark.parametrize("spacer", [0.5e-9, THICK])
def test_stress_between_coated_half_spaces_is_their_attraction_where_they_touch(spacer):
    pull = DugdaleAttraction(HAMAKER_CONSTANT["dry"], spacer)
    expected = -half_space_pressure(pull.closest_distance, pull.hamaker_constant)
    np.testing.assert_allclose(pull.stress, expected, rtol=3e-4 + (pull.equilibrium_distance / spacer) ** 6)
    np.testing.assert_allclose(pull.stress * pull.range, pull.work_of_adhesion, rtol=1e-14)


@pytest.mark.parametrize("through", ["water", "dry"])
def test_a_coating_without_thickness_changes_no_bit_and_a_thin_one_little(through):
    bare, none, thin = attraction(through), attraction(through, spacer=0.0), attraction(through, spacer=1e-15)
    constant, at_rest = bare.hamaker_constant, bare.equilibrium_distance
    assert bare.work_of_adhesion == none.work_of_adhesion == constant / (16 * np.pi * at_rest**2)  # Eq. (10)
    assert bare.range == none.range == thin.range == 0.97 * 2 ** (1 / 6) * MOLECULAR_DISTANCE
    np.testing.assert_allclose(thin.work_of_adhesion, bare.work_of_adhesion, rtol=1e-9)


def test_thicker_coatings_leave_less_work_and_less_stress_and_a_longer_reach():
    pulls = [attraction("dry", spacer=spacer) for spacer in np.linspace(0, 5e-9, 40)]
    assert np.all(np.diff([pull.work_of_adhesion for pull in pulls]) < 0)
    assert np.all(np.diff([pull.stress for pull in pulls]) < 0)
    assert np.all(np.diff([pull.range for pull in pulls]) >= 0)
    assert pulls[-1].range > 10 * pulls[0].range


@pytest.mark.parametrize("spacer", [-1e-9, np.nan, np.inf])
def test_impossible_coatings_are_refused(spacer):
    with pytest.raises(ValueError, match="thickness of a coating must not be negative"):
        DugdaleAttraction(1e-19, spacer)

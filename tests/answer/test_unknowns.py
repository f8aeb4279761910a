"""Errors of the inputs in the answer about a device: groups, covariances, whole surfaces and test beams."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_answers import ARC, air, asked, budgets, lognormal, slopes
from numpy.testing import assert_allclose
from scipy.special import ndtri
from scipy.stats import norm, t

from stiction.answer.data import Cause
from stiction.answer.unknowns import Draws, Exact, Members, OfBudgets, OfTestBeams, Slopes, joint

AT, MANY = (0.5, ARC), Draws(100_000, 3)
NONE = frozenset()


def test_the_group_with_the_largest_effect_is_to_measure_and_counts_as_exact_then():
    one = air(lognormal(np.random.default_rng(0)))
    for large in range(3):
        of = np.full(3, 0.02)
        of[large] = 0.2
        found = asked([one], budgets([one], of))
        assert found.measure == f"group of {'abc'[large]}"
        others = np.where(np.arange(3) == large, 0, of)
        assert found.if_measured == pytest.approx(asked([one], budgets([one], others)).build, rel=1e-12)
        assert found.build < found.if_measured < found.exact


def test_a_surface_of_a_kind_is_one_group_beside_its_slopes():
    one = air(lognormal(np.random.default_rng(0)))
    members = (Members("B2", np.array([0.0, 0.5, -0.4, 0.3])),)
    found = asked([one], budgets([one], (0.02,), members=members))
    assert found.measure == "the surface B2"
    assert found.if_measured == pytest.approx(asked([one], budgets([one], (0.02,))).build, rel=1e-12)


@pytest.mark.parametrize("shift", [0.3, -0.3])
def test_what_all_members_of_a_kind_shift_moves_the_size_that_way(shift):
    unknowns = OfBudgets({AT: slopes((0.0,), members=(Members("B2", np.full(4, shift)), Members("Sub1", np.zeros(4))))})
    assert_allclose(unknowns.shift(AT, MANY, NONE), shift)
    assert_allclose(unknowns.shift(AT, MANY, frozenset({"the surface B2"})), 0)


def test_inputs_that_are_all_exact_leave_the_size_of_the_simulation():
    one = air(lognormal(np.random.default_rng(1)))
    unknowns = budgets([one], (0.2, 0.1), 0.02, -0.02)
    assert_allclose(unknowns.shift(AT, MANY, frozenset(unknowns.groups)), 0)
    assert asked([one], unknowns).exact == asked([one]).build


def test_shifts_have_the_variance_and_the_correlation_of_their_budget():
    covariance = np.array([[1.0, -0.8e-9, 0], [-0.8e-9, 1e-18, 0], [0, 0, 4e4]])  # units apart by 11 decades
    budget = Slopes(tuple("abc"), tuple("abc"), np.array([0.3, 0.3e9, 1e-3]), np.zeros(3), np.zeros(3), covariance)
    shift = OfBudgets({AT: budget}).shift(AT, MANY, NONE)
    assert shift.std() == pytest.approx(budget.total, rel=0.01)
    assert budget.total == pytest.approx(np.sqrt(0.09 * 2 * 0.2 + 0.04))
    assert abs(shift.mean()) < 4 * budget.total / np.sqrt(MANY.number)


def test_errors_of_slopes_add_their_products():
    budget = slopes((0.2, 0.0), 0.05)
    shift, exact = (OfBudgets({AT: budget}, own).shift(AT, MANY, NONE) for own in (True, False))
    assert shift.var() == pytest.approx(0.2**2 + 2 * 0.05**2, rel=0.02)
    assert exact.var() == pytest.approx(0.2**2, rel=0.02)


def test_only_what_bends_to_the_unsafe_side_counts():
    for sign in (-1, 1):
        shift = OfBudgets({AT: slopes((0.2,), bend=sign * 0.05)}).shift(AT, MANY, NONE)
        assert shift.mean() == pytest.approx(min(sign * 0.05, 0), abs=4 * 0.22 / np.sqrt(MANY.number))


def test_inputs_of_some_airs_only_err_as_they_do_there():
    """The humidity is no input of dry air: all others have the same errors in both."""
    wet = replace(slopes((0.1, 0.2, 0.3)), covariance=np.array([[1, 0.5, 0], [0.5, 1, 0], [0, 0, 1.0]]))
    dry = replace(slopes((0.1, 0.2)), covariance=wet.covariance[:2, :2])
    for order in ((wet, dry), (dry, wet)):
        names, covariance = joint(order)
        places = [names.index(name) for name in "abc"]
        assert_allclose(covariance[np.ix_(places, places)], wet.covariance)
    unknowns = OfBudgets({(0.5, ARC): wet, (0.0, ARC): dry})
    shifts = [unknowns.shift((rh, ARC), MANY, NONE) for rh in (0.5, 0.0)]
    assert_allclose([shift.std() for shift in shifts], [wet.total, dry.total], rtol=0.01)
    assert np.cov(*shifts)[0, 1] == pytest.approx(dry.total**2, rel=0.02)


def test_a_slope_that_is_not_known_is_that_of_the_most_uncertain_air():
    known = {(0.5, ARC): slopes((0.1,)), (0.8, ARC): slopes((0.3,)), (0.8, "S-shape"): slopes((0.9,))}
    unknowns = OfBudgets(known | {(0.9, ARC): slopes((np.nan,))})
    assert_allclose(unknowns.shift((0.9, ARC), MANY, NONE), unknowns.shift((0.8, ARC), MANY, NONE))
    assert_allclose(unknowns.shift((0.7, ARC), MANY, NONE), 0)


def test_further_members_of_a_kind_follow_student_and_covary_as_the_known_ones():
    shifts = np.array([[0.1, 0.5, -0.2, 0.0], [0.3, 0.2, -0.4, 0.1]])
    drawn = np.array([Members("B2", row).further(MANY) for row in shifts])
    spread = shifts.std(axis=1, ddof=1) * np.sqrt(1 + 1 / 4)
    for row, one, scale in zip(drawn, shifts, spread, strict=True):
        for share in (0.05, 0.3, 0.9):
            at = t(3).ppf(share)
            error = np.sqrt(share * (1 - share) / MANY.number) / t(3).pdf(at)
            assert abs((np.quantile(row, share) - one.mean()) / scale - at) < 4 * error
    # Elliptical distributions with a correlation ρ are on the same side of their centres with 1/2 + asin(ρ) / π.
    same = np.mean(np.prod(drawn - shifts.mean(axis=1, keepdims=True), axis=0) > 0)
    expected = 0.5 + np.arcsin(np.corrcoef(shifts)[0, 1]) / np.pi
    assert abs(same - expected) < 4 * np.sqrt(expected * (1 - expected) / MANY.number)


def test_test_beams_leave_the_quantiles_that_they_state():
    scores = np.linspace(-4, 4, 17)
    quantiles = 0.1 + 0.05 * scores + 0.02 * np.tanh(scores)
    one = air(lognormal(np.random.default_rng(2)))
    unknowns = OfTestBeams(scores, {AT: quantiles})
    drawn = unknowns.shift(AT, MANY, NONE)
    for share in (0.05, 0.5, 0.9):
        expected = np.interp(ndtri(share), scores, quantiles)
        slope = np.gradient(quantiles, scores).max()
        error = slope * np.sqrt(share * (1 - share) / MANY.number) / norm.pdf(ndtri(share))
        assert abs(np.quantile(drawn, share) - expected) < 4 * error
    before = budgets([one], (0.3,))
    found = asked([one], unknowns, before=before)
    assert found.included == (Cause.SIMULATION, Cause.TEST_BEAMS)
    assert found.measure == ""
    assert found.without_test_beams == pytest.approx(asked([one], before).build, rel=1e-12)
    assert found.without_test_beams < found.build
    assert found.exact == asked([one], Exact()).build


@pytest.mark.parametrize("seed", range(3))
def test_errors_of_the_budget_shorten_a_beam(seed):
    """Their size alone is stated: without them, the size is longer by as much."""
    one = air(lognormal(np.random.default_rng(seed)))
    found, known = (asked([one], budgets([one], (0.2,), error)) for error in (0.1, 0.0))
    assert found.build < known.build
    assert found.spread_of_budget == pytest.approx(np.log(known.build / found.build), rel=1e-6)
    assert known.spread_of_budget == 0

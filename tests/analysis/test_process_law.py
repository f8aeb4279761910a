"""Laws of processes: exact polynomials, errors that cover the truth, monotony, contradictions, and their ends."""

import numpy as np
import pytest

from stiction.analysis import process_law
from stiction.analysis.process_law import QUANTITIES, fit, grid, jacobian, scaled, scaled_covariance, unscaled

SETTINGS = np.array([30.0, 50.0, 70.0, 90.0])
SURFACE = np.array([np.log(3.4e-9), -0.7, 3.8, np.log(13e6), -3.8])


@pytest.fixture
def without_scatter(monkeypatch):
    """Runs of a process agree."""
    monkeypatch.setattr(process_law, "SCATTERS", np.array([1e-12]))


def law_of(column, error=0.01, settings=SETTINGS):
    """Law of one quantity with equal errors."""
    return fit(settings, np.asarray(column)[:, None], np.full((len(settings), 1, 1), error**2))


def test_the_scale_of_a_law_is_left_as_it_was_entered_and_keeps_every_value_valid():
    np.testing.assert_allclose(unscaled(scaled(SURFACE)), SURFACE, rtol=1e-14)
    far = unscaled(scaled(SURFACE) + 50 * np.random.default_rng(1).standard_normal((100, 5)))
    assert np.all(far[:, 2] >= 1 + far[:, 1] ** 2)
    assert np.all(far[:, 4] < 0)


def test_the_jacobian_is_the_derivative_of_the_scale():
    step = 1e-6 * np.eye(5)
    central = (unscaled(scaled(SURFACE) + step) - unscaled(scaled(SURFACE) - step)).T / 2e-6
    np.testing.assert_allclose(jacobian(SURFACE), central, atol=1e-7)


def test_errors_in_the_scale_of_a_law_are_those_of_drawn_surfaces():
    covariance = np.diag([0.01, 0.02, 0.05, 0.02, 0.03]) ** 2
    covariance[1, 2] = covariance[2, 1] = -0.8 * 0.02 * 0.05
    drawn = scaled(np.random.default_rng(2).multivariate_normal(SURFACE, covariance, 20_000))
    np.testing.assert_allclose(np.cov(drawn.T), scaled_covariance(SURFACE, covariance), atol=0.04 * 1e-3, rtol=0.05)


@pytest.mark.parametrize("degree", [0, 1, 2])
def test_settings_on_a_polynomial_are_on_their_law_at_every_value(degree):
    column = np.polynomial.Polynomial([-2, 0.03, -0.0006][: degree + 1])
    law = law_of(column(SETTINGS), 1e-6)
    between = np.linspace(30, 90, 13)
    np.testing.assert_allclose(law.at(between)[:, 0], column(between), atol=1e-5)
    assert law.scatter[0] > 0


@pytest.mark.usefixtures("without_scatter")
def test_two_settings_have_a_straight_line_through_both():
    law = law_of([1.0, 3.0], settings=np.array([30.0, 90.0]))
    np.testing.assert_allclose(law.at([30, 60, 90])[:, 0], [1, 2, 3])
    np.testing.assert_allclose(law.covariance_at([30, 60, 90])[:, 0, 0], [1e-4, 0.5e-4, 1e-4])


@pytest.mark.usefixtures("without_scatter")
def test_a_law_covers_the_truth_between_settings_as_often_as_it_says():
    rng, between, inside = np.random.default_rng(3), np.array([40.0, 60.0, 80.0]), []
    for bend in np.tile([0.0, 3e-5, 1e-4], 70):
        truth = np.polynomial.Polynomial([0, 0.02, -bend])
        law = law_of(truth(SETTINGS) + 0.02 * rng.standard_normal(4), 0.02)
        error = np.sqrt(law.covariance_at(between)[:, 0, 0])
        inside.append(np.abs(law.at(between)[:, 0] - truth(between)) < 1.96 * error)
    share = np.mean(inside, axis=0)
    assert np.all(share > 0.93), share
    assert np.mean(share) < 0.995  # control: errors so wide that nothing is ever outside say nothing


def test_settings_scatter_beyond_their_errors_and_the_law_says_by_how_much():
    rng, settings = np.random.default_rng(4), np.linspace(30, 90, 30)
    law = law_of(0.01 * settings + 0.1 * rng.standard_normal(30), 0.001, settings)
    assert 0.07 < law.scatter[0] < 0.14
    assert 0 < law_of(0.01 * settings, 0.001, settings).scatter[0] < 0.001


def test_laws_of_monotone_settings_are_monotone_unless_these_say_otherwise_for_certain():
    nearly_flat = np.array([0.0, 0.5, 0.8, 0.81])
    steps = np.diff(law_of(nearly_flat, 0.1).at(np.linspace(30, 90, 61))[:, 0])
    assert np.all(steps > 0)
    turns = np.diff(law_of(-((SETTINGS - 80.1) ** 2) / 1000, 1e-4).at(np.linspace(30, 90, 61))[:, 0])
    assert turns[0] > 0 > turns[-1]


def test_nothing_is_said_beyond_the_settings():
    with pytest.raises(ValueError, match="known from 30 to 90"):
        law_of([1, 2, 3, 4.0]).at(91)


def test_a_setting_off_the_law_of_the_others_is_named_and_no_other():
    settings = np.linspace(30, 90, 7)
    column = 0.02 * settings
    assert process_law.contradictions(law_of(column, 0.01, settings)) == []
    column[4] += 0.1
    assert process_law.contradictions(law_of(column, 0.01, settings)) == [(4, 0)]


def test_three_settings_check_a_straight_line_but_do_not_tell_which_of_them_is_wrong():
    law = law_of([0.0, 0.7, 2.0], 0.05, np.array([30.0, 60.0, 90.0]))
    assert list(law.degrees) == [1]
    # The middle one is 0.3 off the line of the others, with an error of 0.05 √(3 / 2); the first of equals is named.
    assert np.abs(law.surprise) == pytest.approx(0.3 / (0.05 * 1.5**0.5))
    assert process_law.contradictions(law) == [(0, 0)]
    assert not process_law.is_unique(law, 0)


@pytest.mark.usefixtures("without_scatter")
def test_drawn_laws_have_the_covariance_of_the_law_and_errors_of_quantities_stay_correlated(monkeypatch):
    monkeypatch.setattr(process_law, "LARGEST_DEGREE", 1)  # quantities of different degrees are less correlated
    errors = np.tile(np.array([[4.0, -3.0], [-3.0, 4.0]]) * 1e-4, (4, 1, 1))
    law = fit(SETTINGS, np.column_stack([0.02 * SETTINGS, -0.01 * SETTINGS]), errors)
    drawn = law.draw(20_000, np.random.default_rng(5))[0].reshape(20_000, -1)
    size = law.coefficients.size
    np.testing.assert_allclose(np.cov(drawn.T), law.covariance.reshape(size, size), atol=4e-6)
    at = law.covariance_at([60])[0]
    np.testing.assert_allclose(at[0, 1] / np.sqrt(at[0, 0] * at[1, 1]), -0.75, atol=0.02)


@pytest.mark.usefixtures("without_scatter")
def test_one_more_setting_leaves_the_errors_that_a_law_through_all_has():
    errors = np.full((1, 1), 1e-4)
    law = law_of([1.0, 3.0], settings=np.array([30.0, 90.0]))
    found = law.with_setting(60.0, errors)
    basis = law.basis([30, 60, 90])
    expected = np.linalg.inv(basis.T @ basis) * 1e-4
    np.testing.assert_allclose(found[0, :, 0], expected, atol=1e-12)


def test_a_grid_holds_all_settings():
    for settings in ([30, 90], [30, 60, 90], [1, 2, 5, 6], list(range(10))):
        points = grid(settings)
        assert set(settings) <= set(points)
        assert len(points) >= 7
    assert QUANTITIES == ("rms", "skewness", "kurtosis", "corner", "slope")

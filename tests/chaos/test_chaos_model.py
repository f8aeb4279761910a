from math import comb

import numpy as np
import pytest
from vectors import F_LIMIT, VECTORS, M, reduced

from stiction.chaos.coordinates import PrincipalCoordinates, dimension_error, principal_coordinates, unconstrained
from stiction.chaos.density import conditional_quantiles, kernel_density, quantile_tables
from stiction.chaos.model import (
    ChaosModel,
    draw,
    draw_kernels,
    draw_laws,
    fit,
    fit_report,
    resample_laws,
    statistics,
    truncated,
)
from stiction.chaos.polynomials import multi_indices, project, quadrature
from stiction.contact import forcelaw


@pytest.fixture(scope="module")
def models():
    """Models of order 12 by number of coordinates kept: 3 and 4."""
    return {3: fit(VECTORS, F_LIMIT, 12, 0.04), 4: fit(VECTORS, F_LIMIT, 12, 0.0)}


@pytest.mark.parametrize("kept", [1, 2, 3, 4])
def test_the_smallest_number_of_coordinates_within_the_tolerance_is_kept(kept):
    few = VECTORS[:300]
    error = dimension_error(principal_coordinates(few).variances)[kept - 1]
    assert fit(few, F_LIMIT, 1, error).dimension == kept
    if kept < 4:
        assert fit(few, F_LIMIT, 1, 0.999 * error).dimension == kept + 1


def test_a_coordinate_depends_on_the_variables_up_to_its_own_only(models):
    for dimension, model in models.items():
        for k in range(dimension):
            later = model.indices[:, k + 1 :].any(axis=1)
            assert not model.coefficients[k, later].any()
            assert np.count_nonzero(model.coefficients[k]) == comb(12 + k + 1, 12)


def test_truncating_coefficients_equals_a_fit_of_lower_order(models):
    for order in (2, 5, 8):
        cut, refit = truncated(models[3], order), fit(VECTORS, F_LIMIT, order, 0.04)
        np.testing.assert_array_equal(cut.indices, refit.indices)
        np.testing.assert_allclose(cut.coefficients, refit.coefficients, atol=1e-13)
        assert cut.order == order


def test_truncation_error_falls_with_the_order(models):
    errors = np.array([truncated(models[3], order).truncation_error for order in (2, 4, 8, 12)])
    assert np.all(np.diff(errors, axis=0) < 0)
    assert np.all(errors > 0)


def test_a_constant_adds_no_variance():
    model = ChaosModel(None, np.array([[5.0, 0.6, -0.3]]), multi_indices(2, 1), F_LIMIT)
    np.testing.assert_allclose(model.truncation_error, 1 - 0.6**2 - 0.3**2, rtol=1e-14)


def test_truncation_error_of_nearly_normal_samples_is_that_of_a_normal_quantile():
    # the variance of a normal variable beyond order 12 is 0.00108
    normal = np.random.default_rng(6).standard_normal((M, 3))
    tables = quantile_tables(kernel_density((normal - normal.mean(0)) / normal.std(0)), quadrature()[0])
    first = project(tables, 12)[0]
    assert 0.0006 < 1 - np.sum(first[1:] ** 2) < 0.0025


@pytest.mark.parametrize("dimension", [3, 4])
def test_coordinates_have_the_covariance_of_their_coefficients(models, dimension):
    model, n = models[dimension], 200_000
    eta = model(np.random.default_rng(7).random((n, dimension)))
    products = (eta[:, :, None] - eta.mean(0)[:, None]) * (eta[:, None, :] - eta.mean(0))
    error = products.std(axis=0) / np.sqrt(n)
    own = model.coefficients[:, 1:] @ model.coefficients[:, 1:].T
    assert np.all(np.abs(products.mean(axis=0) - own) < 4 * error)
    assert np.all(np.abs(eta.mean(axis=0) - model.coefficients[:, 0]) < 4 / np.sqrt(n))


@pytest.mark.parametrize("dimension", [3, 4])
def test_coordinates_keep_mean_0_and_covariance_1_up_to_truncation(models, dimension):
    coefficients = models[dimension].coefficients
    np.testing.assert_allclose(coefficients[:, 0], 0, atol=2e-3)  # quadrature of conditional quantiles
    covariance = coefficients[:, 1:] @ coefficients[:, 1:].T
    lost = np.sqrt(models[dimension].truncation_error)
    # by Cauchy and Schwarz a covariance can lose no more than the roots of both lost variances
    assert np.all(np.abs(covariance - np.eye(dimension)) <= np.outer(lost, lost) + 2e-3)
    assert np.all(models[dimension].truncation_error < 0.02)


def exact_map(density, xi):
    """Coordinates (n, N_g) at points xi (n, N_g) from the conditional quantiles themselves."""
    eta = np.empty(xi.shape)
    for row, point in zip(eta, xi, strict=True):
        for k in range(len(point)):
            row[k] = conditional_quantiles(density, row[None, :k], point[k : k + 1])[0, 0]
    return eta


@pytest.mark.parametrize("dimension", [3, 4])
def test_the_truncation_error_is_the_mean_square_distance_from_the_exact_map(models, dimension):
    model, n = models[dimension], 3000
    xi = np.random.default_rng(15).random((n, dimension))
    squares = (model(xi) - exact_map(kernel_density(reduced(VECTORS, dimension)), xi)) ** 2
    standard_error = squares.std(axis=0) / np.sqrt(n)
    assert np.all(np.abs(squares.mean(axis=0) - model.truncation_error) < 4 * standard_error)


@pytest.mark.parametrize("dimension", [3, 4])
def test_chaos_draws_follow_the_kernel_density_which_follows_the_input(models, dimension):
    values, correlations = fit_report(models[dimension], VECTORS, 100_000, np.random.default_rng(8))
    mean, deviation = 0, 1
    spread = values[0, deviation]
    lost = models[dimension].truncation_error.max()
    # means: 4 standard errors, of the input or of the draws, and the effect of exp on the variance lost by truncation
    assert np.all(np.abs(values[1, mean] - values[0, mean]) < 4 * spread / np.sqrt(M))
    assert np.all(np.abs(values[2, mean] - values[1, mean]) < (4 * np.sqrt(2 / 1e5) + lost) * spread)
    assert np.all(np.abs(values[2, deviation] / values[1, deviation] - 1) < 0.01 + lost)
    # order 12 puts the 99 % point of a normal variable 0.10 deviations too far out, of a skewed one 0.16; exp doubles
    assert np.all(np.abs(values[2, 2:] - values[1, 2:]) < 0.35 * spread)
    assert np.abs(correlations[2] - correlations[1]).max() < 0.02
    assert np.all(values[:, 2] < values[:, mean])
    assert np.all(values[:, 3] > values[:, mean])


def test_resampled_laws_are_those_of_the_samples_that_have_one_all_equally_often(models):
    weak = np.column_stack([np.full(300, 1e-9), *np.tile(VECTORS[:1, 1:], (300, 1)).T])
    limit = models[4].f_limit
    laws = resample_laws(np.vstack([weak, VECTORS[:5]]), limit, 5000, np.random.default_rng(3))
    kinds, counts = np.unique(laws, axis=0, return_counts=True)
    np.testing.assert_allclose(kinds, np.unique(forcelaw.coefficients(VECTORS[:5], limit), axis=0))
    assert np.all(np.abs(counts - 1000) < 4 * np.sqrt(800))
    with pytest.raises(ValueError, match="none of 300 samples has a force law"):
        resample_laws(weak, limit, 1, np.random.default_rng(3))


def test_the_report_compares_draws_with_those_of_the_input_that_have_a_law(models):
    weak = np.column_stack([np.full(500, 1e-9), *np.tile(VECTORS[:1, 1:], (500, 1)).T])
    assert not forcelaw.admissible(weak, models[4].f_limit).any()
    values, _ = fit_report(models[4], np.vstack([VECTORS, weak]), 1000, np.random.default_rng(8))
    np.testing.assert_allclose(values[0], statistics(VECTORS)[0], rtol=1e-12)


def test_with_all_coordinates_the_kernel_density_keeps_the_moments_of_the_input(models):
    free = unconstrained(VECTORS)
    draws, _ = draw_kernels(models[4], VECTORS, 200_000, np.random.default_rng(9))
    drawn = unconstrained(draws)
    kurtosis = np.mean(((drawn - drawn.mean(0)) / drawn.std(0)) ** 4, axis=0)
    assert np.all(np.abs(drawn.mean(0) - free.mean(0)) < 4 * free.std(0) / np.sqrt(2e5))
    assert np.all(np.abs(drawn.var(0) / free.var(0) - 1) < 4 * np.sqrt((kurtosis - 1) / 2e5))
    np.testing.assert_allclose(np.corrcoef(drawn.T), np.corrcoef(free.T), atol=4 / np.sqrt(2e5))


def test_draws_do_not_depend_on_how_they_are_batched(models):
    for model in models.values():
        together, _ = draw(model, 300, np.random.default_rng(10))
        rng = np.random.default_rng(10)
        apart = np.concatenate([draw(model, n, rng)[0] for n in (1, 70, 128, 101)])
        np.testing.assert_array_equal(together, apart)


def meagre(model):
    """Model with so little energy that about half of its vectors have no force law."""
    scale, mean = model.coordinates.scale, model.coordinates.mean.copy()
    mean[0] += np.log(0.18) / scale[0]
    coordinates = PrincipalCoordinates(scale, mean, model.coordinates.variances, model.coordinates.axes)
    return ChaosModel(coordinates, model.coefficients, model.indices, model.f_limit)


def test_vectors_without_a_law_are_rejected_counted_and_drawn_anew_from_the_same_stream(models):
    model, rng = meagre(models[3]), np.random.default_rng(11)
    vectors, rejected = draw(model, 500, rng)
    every = model.coordinates.restore(model(np.random.default_rng(11).random((500 + rejected, 3))))
    good = forcelaw.admissible(every, model.f_limit)
    assert rejected > 250
    np.testing.assert_array_equal(vectors, every[good])
    again = np.random.default_rng(11)
    parts = [draw(model, n, again) for n in (123, 377)]
    np.testing.assert_array_equal(vectors, np.concatenate([v for v, _ in parts]))
    assert sum(r for _, r in parts) == rejected


def test_a_model_without_laws_is_an_error():
    model = fit(VECTORS, F_LIMIT, 3, 0.04)
    for _ in range(3):
        model = meagre(model)
    with pytest.raises(ValueError, match="have no force law"):
        draw(model, 10, np.random.default_rng(12))


def test_laws_are_those_of_the_vectors_drawn(models):
    laws = draw_laws(models[3], 1000, np.random.default_rng(13))
    vectors, _ = draw(models[3], 1000, np.random.default_rng(13))
    np.testing.assert_allclose(forcelaw.energy(laws), vectors[:, 0], rtol=1e-12)
    np.testing.assert_allclose(forcelaw.pressure(laws, vectors[:, 3]), F_LIMIT, rtol=1e-10)
    assert np.all(vectors[:, :2] > 0)
    assert np.all(vectors[:, 2] > vectors[:, 3])
    assert np.all(laws[:, 3] > 0)


def test_no_draws_are_an_empty_array(models):
    vectors, rejected = draw(models[3], 0, np.random.default_rng(14))
    assert vectors.shape == (0, 4)
    assert rejected == 0


@pytest.mark.parametrize(("order", "tolerance"), [(0, 0.01), (13, 0.01), (4, -0.1)])
def test_order_and_tolerance_out_of_range_are_errors(order, tolerance):
    with pytest.raises(ValueError, match="need a total order"):
        fit(VECTORS, F_LIMIT, order, tolerance)


def test_one_outlier_in_the_gap_does_not_move_the_draws():
    free, spoilt = unconstrained(VECTORS), VECTORS.copy()
    spoilt[7, 3] = spoilt[7, 2] - np.exp(free[:, 3].mean() + 15 * free[:, 3].std())
    before, after = (draw(fit(v, F_LIMIT, 12, 0.04), 100_000, np.random.default_rng(4))[0] for v in (VECTORS, spoilt))
    quartiles = [np.quantile(unconstrained(v), [0.25, 0.5, 0.75], axis=0) for v in (before, after)]
    # an outlier of 15 sd adds 15² / m = 4.5 % to the variance of its component, 2.3 % to its bandwidth
    np.testing.assert_allclose((quartiles[1] - quartiles[0]) / free.std(axis=0), 0, atol=0.03)

from math import comb

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ndtr, ndtri

from stiction.chaos import model as chaos
from stiction.chaos.model import KernelDensity
from stiction.contact import forcelaw

M = 5000


def sampled_vectors(m=M, spread=0.3, seed=1):
    """Vectors like those of a rough pair: correlated, skewed, not quite linear in each other."""
    z = np.random.default_rng(seed).standard_normal((m, 4))
    log_e = np.log(7e-3) + spread * (z[:, 0] + 0.1 * z[:, 0] ** 2)
    log_f = np.log(2e6) + spread * (0.9 * z[:, 0] + 0.44 * z[:, 1] + 0.1 * z[:, 0] ** 2)
    d_max = 8e-9 + 0.3e-9 * (0.5 * z[:, 0] + 0.87 * z[:, 2] + 0.15 * z[:, 2] ** 2)
    gap = 1.5e-9 * np.exp(0.15 * (0.3 * z[:, 2] + 0.2 * z[:, 0] + 0.9 * z[:, 3] + 0.1 * z[:, 3] ** 2))
    return np.column_stack([np.exp(log_e), np.exp(log_f), d_max, d_max - gap])


VECTORS = sampled_vectors()
F_LIMIT = VECTORS[:, 1].max()


@pytest.fixture(scope="module")
def models():
    """Models of order 12 by number of coordinates kept: 3 and 4."""
    return {3: chaos.fit(VECTORS, F_LIMIT, 12, 0.04), 4: chaos.fit(VECTORS, F_LIMIT, 12, 0.0)}


def reduced(vectors, dimension):
    return chaos.principal_coordinates(vectors).reduce(vectors)[:, :dimension]


# Eqs. (15)-(17)


def test_vectors_return_from_numbers_without_bounds():
    np.testing.assert_allclose(chaos.constrained(chaos.unconstrained(VECTORS)), VECTORS, rtol=1e-13)


def test_any_numbers_become_vectors_that_respect_the_constraints():
    # eight times as far from their middle as the samples ever lie
    free = chaos.unconstrained(VECTORS)
    e, f_max, d_max, d_limit = chaos.constrained(free + 8 * (free - free.mean(axis=0))).T
    assert np.all(e > 0)
    assert np.all(f_max > 0)
    assert np.all(d_max > d_limit)


def test_principal_coordinates_have_mean_0_and_covariance_1_and_lead_back():
    coordinates = chaos.principal_coordinates(VECTORS)
    eta = coordinates.reduce(VECTORS)
    np.testing.assert_allclose(eta.mean(axis=0), 0, atol=1e-10)
    np.testing.assert_allclose(np.cov(eta.T, bias=True), np.eye(4), atol=1e-10)
    np.testing.assert_allclose(coordinates.restore(eta), VECTORS, rtol=1e-11)


def test_q_is_the_logarithm_over_its_standard_deviation():
    coordinates = chaos.principal_coordinates(VECTORS)
    logs = np.log(VECTORS[:, 0])
    np.testing.assert_allclose(coordinates.scale[0], logs.std(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.scale[3], np.log(VECTORS[:, 2] - VECTORS[:, 3]).std(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.mean[0], (logs / logs.std()).mean(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.variances.sum(), 4, rtol=1e-12)  # each q has variance 1


def test_dimension_error_is_the_variance_that_the_coordinates_kept_miss(models):
    coordinates = models[4].coordinates
    q = chaos.unconstrained(VECTORS) / coordinates.scale
    eta = coordinates.reduce(VECTORS)
    for kept in (1, 2, 3, 4):
        back = chaos.unconstrained(coordinates.restore(eta[:, :kept])) / coordinates.scale
        missed = np.sum((q - back) ** 2) / np.sum((q - q.mean(axis=0)) ** 2)
        np.testing.assert_allclose(models[4].dimension_error[kept - 1], missed, atol=1e-12)


@pytest.mark.parametrize("kept", [1, 2, 3, 4])
def test_the_fewest_coordinates_that_meet_the_tolerance_are_kept(kept):
    few = VECTORS[:300]
    error = chaos.dimension_error(chaos.principal_coordinates(few).variances)[kept - 1]
    assert chaos.fit(few, F_LIMIT, 1, error).dimension == kept
    if kept < 4:
        assert chaos.fit(few, F_LIMIT, 1, 0.999 * error).dimension == kept + 1


def test_axes_do_not_depend_on_the_sign_an_eigenvector_happens_to_have():
    axes = chaos.principal_coordinates(VECTORS).axes
    assert np.all(axes[np.abs(axes).argmax(axis=0), range(4)] > 0)


# kernel density


@pytest.mark.parametrize("dimension", [1, 3, 4])
def test_shrunk_kernels_keep_mean_and_covariance_exactly_and_plain_ones_do_not(dimension):
    density = chaos.kernel_density(reduced(VECTORS, dimension))
    own = density.bandwidth**2 * np.eye(dimension)
    np.testing.assert_allclose(density.centres.mean(axis=1), 0, atol=1e-10)
    np.testing.assert_allclose(np.cov(density.centres, bias=True) + own, np.eye(dimension), atol=1e-10)
    plain = chaos.silverman_bandwidth(M, dimension)
    np.testing.assert_allclose(density.bandwidth, plain / np.sqrt(1 + plain**2), rtol=1e-12)


def test_draws_from_shrunk_kernels_have_variance_1_and_the_test_sees_plain_kernels():
    eta, n = reduced(VECTORS, 3), 200_000
    shrunk = chaos.kernel_density(eta)
    plain = KernelDensity(np.ascontiguousarray(eta.T), chaos.silverman_bandwidth(M, 3))

    def excess(density):
        draws = density.draw(n, np.random.default_rng(2))
        squares = (draws - draws.mean(axis=0)) ** 2
        return (squares.mean(axis=0) - 1) / (squares.std(axis=0) / np.sqrt(n))

    assert np.all(np.abs(excess(shrunk)) < 4)
    assert np.all(excess(plain) > 4)


def plain_conditional_cdf(density, given, values):
    """Sum over all kernels: P(η_{k+1} <= value | η_1 ... η_k); given (k,), values (n,)."""
    k = len(given)
    squares = ((given[:, None] - density.centres[:k]) / density.bandwidth) ** 2
    weights = np.exp(-0.5 * squares.sum(axis=0))
    return ndtr((values[:, None] - density.centres[k]) / density.bandwidth) @ weights / weights.sum()


@pytest.mark.parametrize("k", [0, 1, 2, 3])
def test_conditional_quantiles_invert_the_sum_over_all_kernels(k):
    density = chaos.kernel_density(reduced(VECTORS, 4))
    given = density.draw(20, np.random.default_rng(3))[:, :k] if k else np.empty((1, 0))
    probabilities, _ = chaos.quadrature()
    for row, quantiles in zip(given, chaos.conditional_quantiles(density, given, probabilities), strict=True):
        # if a single kernel counted, sharing it between nodes would leave its variance wrong by up to 1/384 and
        # probabilities by 1/384 * max |x φ(x)| / 2 = 3.2e-4
        np.testing.assert_allclose(plain_conditional_cdf(density, row, quantiles), probabilities, atol=3.2e-4)


def test_quantiles_of_a_single_kernel_are_normal_quantiles():
    density = KernelDensity(np.array([[0.3]]), 0.5)
    p = np.array([1e-6, 0.01, 0.3, 0.5, 0.77, 0.999])
    quantiles = chaos.conditional_quantiles(density, np.empty((1, 0)), p)[0]
    # a kernel on a node is not shared, but its variance is lowered all the same, by step² / 6
    np.testing.assert_allclose(quantiles, 0.3 + 0.5 * np.sqrt(1 - 1 / (6 * 8**2)) * ndtri(p), atol=1e-3)


def test_tables_follow_the_chain_of_conditional_quantiles():
    density = chaos.kernel_density(reduced(VECTORS, 3))
    p, _ = chaos.quadrature()
    first, second, third = chaos.quantile_tables(density, p)
    i, j = 20, 9
    np.testing.assert_array_equal(first, chaos.conditional_quantiles(density, np.empty((1, 0)), p)[0])
    np.testing.assert_array_equal(second[i], chaos.conditional_quantiles(density, first[i : i + 1, None], p)[0])
    given = np.array([[first[i], second[i, j]]])
    np.testing.assert_array_equal(third[i, j], chaos.conditional_quantiles(density, given, p)[0])


def test_one_outlier_in_the_gap_does_not_move_the_conditional_quantiles_of_the_rest():
    spoilt = VECTORS.copy()
    free = chaos.unconstrained(VECTORS)
    spoilt[7, 3] = spoilt[7, 2] - np.exp(free[:, 3].mean() + 15 * free[:, 3].std())
    clean = chaos.principal_coordinates(VECTORS)
    p, _ = chaos.quadrature()
    given = np.array([[-1.5], [0.0], [1.5]])
    tables = [
        chaos.conditional_quantiles(chaos.kernel_density(clean.reduce(v)[:, :3]), given, p)[:, 2:-2]
        for v in (VECTORS, spoilt)
    ]
    assert np.abs(clean.reduce(spoilt)[7, 1]) > 9  # an outlier in η_2 indeed
    np.testing.assert_allclose(tables[1], tables[0], atol=0.05)  # 1 of some 100 samples at these conditions

    before, after = (
        chaos.draw(chaos.fit(v, F_LIMIT, 12, 0.04), 100_000, np.random.default_rng(4))[0] for v in (VECTORS, spoilt)
    )
    quartiles = [np.quantile(chaos.unconstrained(v), [0.25, 0.5, 0.75], axis=0) for v in (before, after)]
    # an outlier of 15 sd adds 15² / m = 4.5 % to the variance of its component, 2.3 % to its bandwidth
    np.testing.assert_allclose((quartiles[1] - quartiles[0]) / free.std(axis=0), 0, atol=0.03)


# polynomials


@pytest.mark.parametrize(("order", "dimension"), [(12, 3), (12, 4), (5, 2), (1, 1)])
def test_number_of_polynomials_of_a_total_order(order, dimension):
    indices = chaos.multi_indices(order, dimension)
    assert len(indices) == comb(order + dimension, dimension)
    assert len(np.unique(indices, axis=0)) == len(indices)
    assert indices.sum(axis=1).max() == order
    assert not indices[0].any()


def legendre(points, order):
    values = np.empty((order + 1, len(points)))
    chaos.legendre(points, values)
    return values


def test_polynomials_are_orthonormal_on_the_unit_interval():
    x, w = np.polynomial.legendre.leggauss(13)  # exact up to degree 25
    values = legendre(0.5 * (1 + x), 12)
    np.testing.assert_allclose(values * (w / 2) @ values.T, np.eye(13), atol=1e-13)


def test_polynomials_are_legendre_s():
    xi = np.linspace(0, 1, 7)
    np.testing.assert_allclose(legendre(xi, 1)[1], np.sqrt(3) * (2 * xi - 1), atol=1e-14)
    np.testing.assert_allclose(legendre(np.array([1.0]), 12)[:, 0], np.sqrt(2 * np.arange(13) + 1), rtol=1e-13)


def test_quadrature_keeps_the_polynomials_orthonormal():
    points, weights = chaos.quadrature()
    values = legendre(points, chaos.MAX_ORDER)
    np.testing.assert_allclose(values * weights @ values.T, np.eye(chaos.MAX_ORDER + 1), atol=1e-12)


def on_grid(function, dimension):
    points, _ = chaos.quadrature()
    return [function(*np.meshgrid(*[points] * k, indexing="ij")) for k in range(1, dimension + 1)]


def test_linear_quantiles_of_a_uniform_density_are_recovered_exactly():
    tables = on_grid(lambda *xi: np.sqrt(12) * (xi[-1] - 0.5), 3)
    coefficients, indices = chaos.project(tables, 12), chaos.multi_indices(12, 3)
    for k in range(3):
        expected = np.all(indices == np.eye(3, dtype=int)[k], axis=1)
        np.testing.assert_allclose(coefficients[k], expected, atol=1e-12)


def test_polynomials_of_several_variables_are_recovered_and_evaluated_exactly():
    def function(*xi):
        return 0.2 - xi[0] ** 3 * (1 + sum(j * x**2 for j, x in enumerate(xi, start=1)))

    for dimension in (1, 2, 3, 4):
        coefficients = chaos.project(on_grid(function, dimension), 6)
        model = chaos.ChaosModel(None, coefficients, chaos.multi_indices(6, dimension), F_LIMIT)
        xi = np.random.default_rng(5).random((100, dimension))
        expected = np.column_stack([function(*xi.T[:k]) for k in range(1, dimension + 1)])
        np.testing.assert_allclose(model(xi), expected, atol=1e-11)


def test_coefficients_of_independent_normal_quantiles_are_one_dimensional_integrals():
    coefficients, indices = chaos.project(on_grid(lambda *xi: ndtri(xi[-1]), 2), 12), chaos.multi_indices(12, 2)
    np.testing.assert_allclose(coefficients[0, indices.tolist().index([1, 0])], np.sqrt(3 / np.pi), atol=2e-5)
    for a in range(13):
        exact = quad(lambda u, a=a: u * legendre(np.array([ndtr(u)]), a)[a, 0] * np.exp(-u * u / 2), -9, 9)[0]
        for k, alpha in enumerate([[a, 0], [0, a]]):
            found = coefficients[k, indices.tolist().index(alpha)]
            np.testing.assert_allclose(found, exact / np.sqrt(2 * np.pi), atol=2e-5)
    assert np.abs(coefficients[1, (indices > 0).all(axis=1)]).max() < 1e-12  # η_2 does not depend on ξ_1


def test_a_coordinate_depends_on_the_variables_up_to_its_own_only(models):
    for dimension, model in models.items():
        for k in range(dimension):
            later = model.indices[:, k + 1 :].any(axis=1)
            assert not model.coefficients[k, later].any()
            assert np.count_nonzero(model.coefficients[k]) == comb(12 + k + 1, 12)


def test_cutting_coefficients_off_equals_a_fit_of_lower_order(models):
    for order in (2, 5, 8):
        cut, refit = chaos.truncated(models[3], order), chaos.fit(VECTORS, F_LIMIT, order, 0.04)
        np.testing.assert_array_equal(cut.indices, refit.indices)
        np.testing.assert_allclose(cut.coefficients, refit.coefficients, atol=1e-13)
        assert cut.order == order


def test_truncation_error_falls_with_the_order(models):
    errors = np.array([chaos.truncated(models[3], order).truncation_error for order in (2, 4, 8, 12)])
    assert np.all(np.diff(errors, axis=0) < 0)
    assert np.all(errors > 0)


def test_a_constant_adds_no_variance():
    model = chaos.ChaosModel(None, np.array([[5.0, 0.6, -0.3]]), chaos.multi_indices(2, 1), F_LIMIT)
    np.testing.assert_allclose(model.truncation_error, 1 - 0.6**2 - 0.3**2, rtol=1e-14)


def test_quantiles_of_nearly_normal_samples_need_what_a_normal_quantile_needs():
    # the variance of a normal variable beyond order 12 is 0.00108
    normal = np.random.default_rng(6).standard_normal((M, 3))
    tables = chaos.quantile_tables(
        chaos.kernel_density((normal - normal.mean(0)) / normal.std(0)), chaos.quadrature()[0]
    )
    first = chaos.project(tables, 12)[0]
    assert 0.0006 < 1 - np.sum(first[1:] ** 2) < 0.0025


# draws


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
            row[k] = chaos.conditional_quantiles(density, row[None, :k], point[k : k + 1])[0, 0]
    return eta


@pytest.mark.parametrize("dimension", [3, 4])
def test_the_truncation_error_is_the_mean_square_distance_from_the_exact_map(models, dimension):
    model, n = models[dimension], 3000
    xi = np.random.default_rng(15).random((n, dimension))
    squares = (model(xi) - exact_map(chaos.kernel_density(reduced(VECTORS, dimension)), xi)) ** 2
    standard_error = squares.std(axis=0) / np.sqrt(n)
    assert np.all(np.abs(squares.mean(axis=0) - model.truncation_error) < 4 * standard_error)


@pytest.mark.parametrize("dimension", [3, 4])
def test_chaos_draws_follow_the_kernel_density_and_it_the_input(models, dimension):
    values, correlations = chaos.fit_report(models[dimension], VECTORS, 100_000, np.random.default_rng(8))
    mean, deviation = 0, 1
    spread = values[0, deviation]
    lost = models[dimension].truncation_error.max()
    # means: 4 standard errors, of the input or of the draws, and what exp makes of the variance lost by truncation
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
    laws = chaos.resample_laws(np.vstack([weak, VECTORS[:5]]), limit, 5000, np.random.default_rng(3))
    kinds, counts = np.unique(laws, axis=0, return_counts=True)
    np.testing.assert_allclose(kinds, np.unique(forcelaw.coefficients(VECTORS[:5], limit), axis=0))
    assert np.all(np.abs(counts - 1000) < 4 * np.sqrt(800))
    with pytest.raises(ValueError, match="none of 300 samples has a force law"):
        chaos.resample_laws(weak, limit, 1, np.random.default_rng(3))


def test_the_report_compares_draws_with_those_of_the_input_that_have_a_law(models):
    weak = np.column_stack([np.full(500, 1e-9), *np.tile(VECTORS[:1, 1:], (500, 1)).T])
    assert not forcelaw.admissible(weak, models[4].f_limit).any()
    values, _ = chaos.fit_report(models[4], np.vstack([VECTORS, weak]), 1000, np.random.default_rng(8))
    np.testing.assert_allclose(values[0], chaos.statistics(VECTORS)[0], rtol=1e-12)


def test_with_all_coordinates_the_kernel_density_keeps_the_moments_of_the_input(models):
    free = chaos.unconstrained(VECTORS)
    draws, _ = chaos.draw_kernels(models[4], VECTORS, 200_000, np.random.default_rng(9))
    drawn = chaos.unconstrained(draws)
    kurtosis = np.mean(((drawn - drawn.mean(0)) / drawn.std(0)) ** 4, axis=0)
    assert np.all(np.abs(drawn.mean(0) - free.mean(0)) < 4 * free.std(0) / np.sqrt(2e5))
    assert np.all(np.abs(drawn.var(0) / free.var(0) - 1) < 4 * np.sqrt((kurtosis - 1) / 2e5))
    np.testing.assert_allclose(np.corrcoef(drawn.T), np.corrcoef(free.T), atol=4 / np.sqrt(2e5))


def test_draws_do_not_depend_on_how_they_are_batched(models):
    for model in models.values():
        together, _ = chaos.draw(model, 300, np.random.default_rng(10))
        rng = np.random.default_rng(10)
        apart = np.concatenate([chaos.draw(model, n, rng)[0] for n in (1, 70, 128, 101)])
        np.testing.assert_array_equal(together, apart)


def meagre(model):
    """Model with so little energy that about half of its vectors have no law."""
    scale, mean = model.coordinates.scale, model.coordinates.mean.copy()
    mean[0] += np.log(0.18) / scale[0]
    coordinates = chaos.PrincipalCoordinates(scale, mean, model.coordinates.variances, model.coordinates.axes)
    return chaos.ChaosModel(coordinates, model.coefficients, model.indices, model.f_limit)


def test_vectors_without_a_law_are_rejected_counted_and_drawn_anew_from_the_same_stream(models):
    model, rng = meagre(models[3]), np.random.default_rng(11)
    vectors, rejected = chaos.draw(model, 500, rng)
    every = model.coordinates.restore(model(np.random.default_rng(11).random((500 + rejected, 3))))
    good = forcelaw.admissible(every, model.f_limit)
    assert rejected > 250
    np.testing.assert_array_equal(vectors, every[good])
    again = np.random.default_rng(11)
    parts = [chaos.draw(model, n, again) for n in (123, 377)]
    np.testing.assert_array_equal(vectors, np.concatenate([v for v, _ in parts]))
    assert sum(r for _, r in parts) == rejected


def test_a_model_without_laws_is_an_error():
    model = chaos.fit(VECTORS, F_LIMIT, 3, 0.04)
    for _ in range(3):
        model = meagre(model)
    with pytest.raises(ValueError, match="have no force law"):
        chaos.draw(model, 10, np.random.default_rng(12))


def test_laws_are_those_of_the_vectors_drawn(models):
    laws, _ = chaos.draw_laws(models[3], 1000, np.random.default_rng(13))
    vectors, _ = chaos.draw(models[3], 1000, np.random.default_rng(13))
    np.testing.assert_allclose(forcelaw.energy(laws), vectors[:, 0], rtol=1e-12)
    np.testing.assert_allclose(forcelaw.pressure(laws, vectors[:, 3]), F_LIMIT, rtol=1e-10)
    assert np.all(vectors[:, :2] > 0)
    assert np.all(vectors[:, 2] > vectors[:, 3])
    assert np.all(laws[:, 3] > 0)


def test_no_draws_are_an_empty_array(models):
    vectors, rejected = chaos.draw(models[3], 0, np.random.default_rng(14))
    assert vectors.shape == (0, 4)
    assert rejected == 0


# bad input


@pytest.mark.parametrize(("component", "value"), [(0, 0.0), (1, -1.0), (3, 9e-9), (2, np.nan)])
def test_a_sample_that_breaks_a_constraint_is_an_error_that_names_it(component, value):
    spoilt = VECTORS.copy()
    spoilt[42, component] = value if component != 3 else spoilt[42, 2]
    with pytest.raises(ValueError, match="sample 42 of 5000"):
        chaos.fit(spoilt, F_LIMIT, 4, 0.01)


def test_components_that_do_not_vary_or_repeat_each_other_are_errors():
    still = VECTORS.copy()
    still[:, 1] = 2e6
    with pytest.raises(ValueError, match="does not vary"):
        chaos.fit(still, F_LIMIT, 4, 0.01)
    tied = VECTORS.copy()
    tied[:, 1] = 3e8 * tied[:, 0]
    with pytest.raises(ValueError, match="depend on each other"):
        chaos.fit(tied, F_LIMIT, 4, 0.01)


@pytest.mark.parametrize(("order", "tolerance"), [(0, 0.01), (13, 0.01), (4, -0.1)])
def test_order_and_tolerance_out_of_range_are_errors(order, tolerance):
    with pytest.raises(ValueError, match="need a total order"):
        chaos.fit(VECTORS, F_LIMIT, order, tolerance)

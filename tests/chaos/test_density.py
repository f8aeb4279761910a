import numpy as np
import pytest
from scipy.special import ndtr, ndtri
from vectors import VECTORS, M, reduced

from stiction.chaos.coordinates import principal_coordinates, unconstrained
from stiction.chaos.density import (
    KernelDensity,
    conditional_quantiles,
    kernel_density,
    quantile_tables,
    silverman_bandwidth,
)
from stiction.chaos.polynomials import quadrature


@pytest.mark.parametrize("dimension", [1, 3, 4])
def test_shrunk_kernels_keep_mean_and_covariance_exactly_and_plain_ones_do_not(dimension):
    density = kernel_density(reduced(VECTORS, dimension))
    own = density.bandwidth**2 * np.eye(dimension)
    np.testing.assert_allclose(density.centres.mean(axis=1), 0, atol=1e-10)
    np.testing.assert_allclose(np.cov(density.centres, bias=True) + own, np.eye(dimension), atol=1e-10)
    plain = silverman_bandwidth(M, dimension)
    np.testing.assert_allclose(density.bandwidth, plain / np.sqrt(1 + plain**2), rtol=1e-12)


def test_draws_from_shrunk_kernels_have_variance_1_and_those_from_plain_kernels_do_not():
    eta, n = reduced(VECTORS, 3), 200_000
    shrunk = kernel_density(eta)
    plain = KernelDensity(np.ascontiguousarray(eta.T), silverman_bandwidth(M, 3))

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
def test_conditional_quantiles_invert_the_distribution_of_all_kernels(k):
    density = kernel_density(reduced(VECTORS, 4))
    given = density.draw(20, np.random.default_rng(3))[:, :k] if k else np.empty((1, 0))
    probabilities, _ = quadrature()
    for row, quantiles in zip(given, conditional_quantiles(density, given, probabilities), strict=True):
        # for a single kernel, splitting it between two nodes would change its variance by up to 1/384 and
        # probabilities by 1/384 * max |x φ(x)| / 2 = 3.2e-4
        np.testing.assert_allclose(plain_conditional_cdf(density, row, quantiles), probabilities, atol=3.2e-4)


def test_quantiles_of_a_single_kernel_are_normal_quantiles():
    density = KernelDensity(np.array([[0.3]]), 0.5)
    p = np.array([1e-6, 0.01, 0.3, 0.5, 0.77, 0.999])
    quantiles = conditional_quantiles(density, np.empty((1, 0)), p)[0]
    # a kernel on a node is not split, but its variance is still reduced, by step² / 6
    np.testing.assert_allclose(quantiles, 0.3 + 0.5 * np.sqrt(1 - 1 / (6 * 8**2)) * ndtri(p), atol=1e-3)


def test_tables_hold_the_successive_conditional_quantiles():
    density = kernel_density(reduced(VECTORS, 3))
    p, _ = quadrature()
    first, second, third = quantile_tables(density, p)
    i, j = 20, 9
    np.testing.assert_array_equal(first, conditional_quantiles(density, np.empty((1, 0)), p)[0])
    np.testing.assert_array_equal(second[i], conditional_quantiles(density, first[i : i + 1, None], p)[0])
    given = np.array([[first[i], second[i, j]]])
    np.testing.assert_array_equal(third[i, j], conditional_quantiles(density, given, p)[0])


def test_one_outlier_in_the_gap_does_not_move_the_conditional_quantiles_of_the_rest():
    spoilt = VECTORS.copy()
    free = unconstrained(VECTORS)
    spoilt[7, 3] = spoilt[7, 2] - np.exp(free[:, 3].mean() + 15 * free[:, 3].std())
    clean = principal_coordinates(VECTORS)
    p, _ = quadrature()
    given = np.array([[-1.5], [0.0], [1.5]])
    tables = [
        conditional_quantiles(kernel_density(clean.reduce(v)[:, :3]), given, p)[:, 2:-2] for v in (VECTORS, spoilt)
    ]
    assert np.abs(clean.reduce(spoilt)[7, 1]) > 9  # control: it is an outlier in η_2
    np.testing.assert_allclose(tables[1], tables[0], atol=0.05)  # 1 of about 100 samples under these conditions

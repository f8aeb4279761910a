from math import comb

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ndtr, ndtri

from stiction.chaos import polynomials
from stiction.chaos.polynomials import MAX_ORDER, expand, multi_indices, project, quadrature


@pytest.mark.parametrize(("order", "dimension"), [(12, 3), (12, 4), (5, 2), (1, 1)])
def test_number_of_polynomials_of_a_total_order(order, dimension):
    indices = multi_indices(order, dimension)
    assert len(indices) == comb(order + dimension, dimension)
    assert len(np.unique(indices, axis=0)) == len(indices)
    assert indices.sum(axis=1).max() == order
    assert not indices[0].any()


def legendre(points, order):
    values = np.empty((order + 1, len(points)))
    polynomials.legendre(points, values)
    return values


def test_polynomials_are_orthonormal_on_the_unit_interval():
    x, w = np.polynomial.legendre.leggauss(13)  # exact up to degree 25
    values = legendre(0.5 * (1 + x), 12)
    np.testing.assert_allclose(values * (w / 2) @ values.T, np.eye(13), atol=1e-13)


def test_polynomials_are_those_of_legendre():
    xi = np.linspace(0, 1, 7)
    np.testing.assert_allclose(legendre(xi, 1)[1], np.sqrt(3) * (2 * xi - 1), atol=1e-14)
    np.testing.assert_allclose(legendre(np.array([1.0]), 12)[:, 0], np.sqrt(2 * np.arange(13) + 1), rtol=1e-13)


def test_quadrature_keeps_the_polynomials_orthonormal():
    points, weights = quadrature()
    values = legendre(points, MAX_ORDER)
    np.testing.assert_allclose(values * weights @ values.T, np.eye(MAX_ORDER + 1), atol=1e-12)


def on_grid(function, dimension):
    points, _ = quadrature()
    return [function(*np.meshgrid(*[points] * k, indexing="ij")) for k in range(1, dimension + 1)]


def test_linear_quantiles_of_a_uniform_density_are_recovered_exactly():
    tables = on_grid(lambda *xi: np.sqrt(12) * (xi[-1] - 0.5), 3)
    coefficients, indices = project(tables, 12), multi_indices(12, 3)
    for k in range(3):
        expected = np.all(indices == np.eye(3, dtype=int)[k], axis=1)
        np.testing.assert_allclose(coefficients[k], expected, atol=1e-12)


def test_polynomials_of_several_variables_are_recovered_and_evaluated_exactly():
    def function(*xi):
        return 0.2 - xi[0] ** 3 * (1 + sum(j * x**2 for j, x in enumerate(xi, start=1)))

    for dimension in (1, 2, 3, 4):
        coefficients = project(on_grid(function, dimension), 6)
        xi = np.random.default_rng(5).random((100, dimension))
        expected = np.column_stack([function(*xi.T[:k]) for k in range(1, dimension + 1)])
        found = expand(xi, multi_indices(6, dimension), coefficients)
        np.testing.assert_allclose(found, expected, atol=1e-11)


def test_coefficients_of_independent_normal_quantiles_are_one_dimensional_integrals():
    coefficients, indices = project(on_grid(lambda *xi: ndtri(xi[-1]), 2), 12), multi_indices(12, 2)
    np.testing.assert_allclose(coefficients[0, indices.tolist().index([1, 0])], np.sqrt(3 / np.pi), atol=2e-5)
    for a in range(13):
        exact = quad(lambda u, a=a: u * legendre(np.array([ndtr(u)]), a)[a, 0] * np.exp(-u * u / 2), -9, 9)[0]
        for k, alpha in enumerate([[a, 0], [0, a]]):
            found = coefficients[k, indices.tolist().index(alpha)]
            np.testing.assert_allclose(found, exact / np.sqrt(2 * np.pi), atol=2e-5)
    assert np.abs(coefficients[1, (indices > 0).all(axis=1)]).max() < 1e-12  # η_2 does not depend on ξ_1

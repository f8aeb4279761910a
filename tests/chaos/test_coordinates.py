import numpy as np
import pytest
from vectors import VECTORS

from stiction.chaos.coordinates import constrained, dimension_error, principal_coordinates, unconstrained


def test_unconstrained_is_inverted_by_constrained():
    np.testing.assert_allclose(constrained(unconstrained(VECTORS)), VECTORS, rtol=1e-13)


def test_any_numbers_give_vectors_that_satisfy_the_constraints():
    # eight times as far from the mean as any sample
    free = unconstrained(VECTORS)
    e, f_max, d_max, d_limit = constrained(free + 8 * (free - free.mean(axis=0))).T
    assert np.all(e > 0)
    assert np.all(f_max > 0)
    assert np.all(d_max > d_limit)


def test_principal_coordinates_have_mean_0_and_covariance_1_and_are_invertible():
    coordinates = principal_coordinates(VECTORS)
    eta = coordinates.reduce(VECTORS)
    np.testing.assert_allclose(eta.mean(axis=0), 0, atol=1e-10)
    np.testing.assert_allclose(np.cov(eta.T, bias=True), np.eye(4), atol=1e-10)
    np.testing.assert_allclose(coordinates.restore(eta), VECTORS, rtol=1e-11)


def test_q_is_the_logarithm_over_its_standard_deviation():
    coordinates = principal_coordinates(VECTORS)
    logs = np.log(VECTORS[:, 0])
    np.testing.assert_allclose(coordinates.scale[0], logs.std(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.scale[3], np.log(VECTORS[:, 2] - VECTORS[:, 3]).std(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.mean[0], (logs / logs.std()).mean(), rtol=1e-12)
    np.testing.assert_allclose(coordinates.variances.sum(), 4, rtol=1e-12)  # each q has variance 1


def test_dimension_error_is_the_variance_lost_by_the_coordinates_kept():
    coordinates = principal_coordinates(VECTORS)
    q = unconstrained(VECTORS) / coordinates.scale
    eta = coordinates.reduce(VECTORS)
    for kept in (1, 2, 3, 4):
        back = unconstrained(coordinates.restore(eta[:, :kept])) / coordinates.scale
        missed = np.sum((q - back) ** 2) / np.sum((q - q.mean(axis=0)) ** 2)
        np.testing.assert_allclose(dimension_error(coordinates.variances)[kept - 1], missed, atol=1e-12)


def test_axes_do_not_depend_on_the_signs_of_the_eigenvectors():
    axes = principal_coordinates(VECTORS).axes
    assert np.all(axes[np.abs(axes).argmax(axis=0), range(4)] > 0)


@pytest.mark.parametrize(("component", "value"), [(0, 0.0), (1, -1.0), (3, 9e-9), (2, np.nan)])
def test_a_sample_that_violates_a_constraint_is_an_error_with_its_number(component, value):
    spoilt = VECTORS.copy()
    spoilt[42, component] = value if component != 3 else spoilt[42, 2]
    with pytest.raises(ValueError, match="sample 42 of 5000"):
        principal_coordinates(spoilt)


def test_components_that_are_constant_or_linearly_dependent_are_errors():
    still = VECTORS.copy()
    still[:, 1] = 2e6
    with pytest.raises(ValueError, match="does not vary"):
        principal_coordinates(still)
    tied = VECTORS.copy()
    tied[:, 1] = 3e8 * tied[:, 0]
    with pytest.raises(ValueError, match="linearly dependent"):
        principal_coordinates(tied)

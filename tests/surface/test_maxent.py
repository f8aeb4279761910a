import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from published import SURFACES
from scipy.stats import norm

from stiction.errors import NotConverged
from stiction.surface import maxent

#: λ₁ … λ₄ from an independent solution of the moment equations.
MULTIPLIERS = {
    "B1": (-0.32061, 0.56353, 0.11488, 0.00770),
    "B2": (-0.42225, 0.52785, 0.16097, 0.01996),
    "Sub1": (-0.17026, 0.48390, 0.05968, 0.00707),
    "Sub2": (-0.53937, 0.61325, 0.21436, 0.02357),
}
#: Moments of densities with a single mode, away from the line without solution.
skewnesses, kurtoses = st.floats(-1, 1), st.floats(2.0, 2.9)
published = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)


def integral(function, low=-maxent.SUPPORT, high=maxent.SUPPORT):
    """Integrate by Gauss' rule on 200 panels: independent of the grid of the module, to machine precision."""
    place, weight = np.polynomial.legendre.leggauss(12)
    half = (high - low) / 400
    centres = low + half * np.arange(1, 400, 2)
    return half * np.sum(weight * function(centres[:, None] + half * place))


@pytest.mark.parametrize("name", SURFACES)
def test_multipliers_of_the_published_surfaces_are_those_of_an_independent_solution(name):
    np.testing.assert_allclose(SURFACES[name].density.multipliers, MULTIPLIERS[name], rtol=0, atol=0.5001e-5)


@published
def test_density_has_the_given_moments(surface):
    moments = [integral(lambda z, k=k: z**k * surface.density(z)) for k in range(5)]
    np.testing.assert_allclose(moments, [1, 0, 1, surface.skewness, surface.kurtosis], rtol=0, atol=1e-8)


@published
def test_moment_agrees_with_gaussian_quadrature(surface):
    fifth = integral(lambda z: z**5 * surface.density(z))
    np.testing.assert_allclose(surface.density.moment(5), fifth, rtol=1e-8)


@given(skewnesses, kurtoses)
def test_moments_and_multipliers_are_a_round_trip(skewness, kurtosis):
    density = maxent.solve(skewness, max(kurtosis, skewness**2 + 1.5))
    moments = [density.moment(k) for k in range(5)]
    np.testing.assert_allclose(moments, [1, 0, 1, skewness, max(kurtosis, skewness**2 + 1.5)], rtol=0, atol=1e-9)


@published
def test_no_other_density_with_these_moments_has_more_entropy(surface):
    heights = np.linspace(-maxent.SUPPORT, maxent.SUPPORT, 20_001)
    weight = surface.density(heights) * (heights[1] - heights[0])
    powers = heights ** np.arange(5)[:, None]
    # A disturbance of the density that leaves all moments up to the fourth unchanged.
    ripple = np.sin(2 * heights)
    ripple -= powers.T @ np.linalg.solve((powers * weight) @ powers.T, powers @ (weight * ripple))
    ripple /= np.abs(ripple[weight > 0]).max()

    def entropy(size):
        share = weight * (1 + size * ripple)
        np.testing.assert_allclose(powers @ share, powers @ weight, atol=1e-9)
        share = share[share > 0]
        return -share @ np.log(share)

    assert entropy(0) > entropy(0.5)
    assert entropy(0) > entropy(-0.5)


def test_moments_of_a_gaussian_give_a_gaussian():
    np.testing.assert_allclose(maxent.solve(0, 3).multipliers, (0, 0.5, 0, 0), atol=1e-9)
    heights = np.linspace(-8, 8, 101)
    np.testing.assert_allclose(maxent.GAUSSIAN(heights), norm.pdf(heights), rtol=1e-12)


@published
def test_mirrored_surface_has_the_mirrored_density(surface):
    mirrored = maxent.solve(-surface.skewness, surface.kurtosis)
    signs = (-1, 1, -1, 1)
    np.testing.assert_allclose(mirrored.multipliers, np.multiply(signs, surface.density.multipliers), atol=1e-9)
    score = np.linspace(-7, 7, 29)
    up, down = mirrored.quantile_of_normal(score), surface.density.quantile_of_normal(-score)
    np.testing.assert_allclose(up, -down, atol=1e-8)


@published
@pytest.mark.parametrize("score", [-3.0, 0.0, 2.0, 5.0, 6.0, 7.0])
def test_upper_tail_beyond_the_quantile_is_that_of_the_normal_score(surface, score):
    height = float(surface.density.quantile_of_normal(score))
    tail = integral(surface.density, low=height)
    # The trapezoidal rule of the cumulative density shifts a height by step² / 12 · |d ln p / dz|, below 30 here.
    moved = 30 * 0.005**2 / 12
    np.testing.assert_allclose(np.log(tail), norm.logsf(score), rtol=0, atol=moved * surface.density(height) / tail)


def test_quantile_of_a_gaussian_is_the_score_itself():
    score = np.linspace(-8, 8, 65)
    # The standard deviation of the tables is too large by step² / 12.
    np.testing.assert_allclose(maxent.GAUSSIAN.quantile_of_normal(score), score, rtol=1e-5, atol=1e-9)


@published
def test_quantile_function_increases(surface):
    score = np.linspace(-8, 8, 4001)
    assert np.all(np.diff(surface.density.quantile_of_normal(score)) > 0)


@pytest.mark.parametrize(("skewness", "kurtosis", "least"), [(1.0, 2.0, "2"), (0.0, 0.5, "1"), (-2.0, 4.9, "5")])
def test_moments_that_no_density_has_are_refused_with_the_smallest_kurtosis(skewness, kurtosis, least):
    with pytest.raises(ValueError, match=rf"need kurtosis > skewness² \+ 1 = {least}, got kurtosis {kurtosis}"):
        maxent.solve(skewness, kurtosis)


@pytest.mark.parametrize(("skewness", "kurtosis"), [(0.0, 3.5), (0.01, 3.2), (-1.0, 10.0)])
def test_moments_that_no_surface_has_are_refused_with_both_numbers(skewness, kurtosis):
    with pytest.raises(
        ValueError, match=f"no maximum-entropy density for skewness {skewness} with kurtosis {kurtosis}:"
    ):
        maxent.solve(skewness, kurtosis)


@published
def test_newton_needs_no_more_than_20_steps_for_a_surface(surface):
    assert maxent.solve(surface.skewness, surface.kurtosis, max_iterations=20) == surface.density


def test_tails_beyond_the_support_are_refused_instead_of_truncated():
    heavy = maxent.solve(-0.5, 4.07)
    assert np.isfinite(heavy.quantile_of_normal(6.0))
    with pytest.raises(ValueError, match="15 rms cover normal scores from -6.23"):
        heavy.quantile_of_normal(-8.0)


def test_newton_that_runs_out_of_steps_reports_its_residual():
    with pytest.raises(NotConverged, match=r"skewness -0.78, kurtosis 4.6: residual .* > 1e-10"):
        maxent.solve(-0.78, 4.6, max_iterations=2)
    with pytest.raises(NotConverged, match="residual inf > 1e-10 after 0 iterations"):
        maxent.solve(-0.76, 3.9, max_iterations=0)


def test_upper_tails_beyond_the_support_are_refused_as_well():
    heavy = maxent.solve(0.5, 4.07)
    assert np.isfinite(heavy.quantile_of_normal(-6.0))
    with pytest.raises(ValueError, match="15 rms cover normal scores from -.* to 6.23 only"):
        heavy.quantile_of_normal(8.0)

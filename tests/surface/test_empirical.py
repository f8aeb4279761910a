"""Densities given by quantiles: those of the heights themselves, whatever their form."""

import numpy as np
import pytest
from published import SURFACES
from scipy.special import ndtr

from stiction.surface.empirical import MeasuredDensity
from stiction.surface.translation import Translation

SCORES = np.linspace(-3, 3, 49)
Z = np.linspace(-9, 9, 3601)
B2 = SURFACES["B2"]


@pytest.mark.parametrize("heights", [SCORES, np.exp(0.4 * SCORES), np.sinh(0.4 * SCORES)])
def test_the_probability_density_has_the_moments_of_the_quantiles(heights):
    measured = MeasuredDensity(SCORES, 3e-9 * heights)
    density, step = measured(Z), Z[1] - Z[0]
    power = [np.sum(density * Z**order) * step for order in (0, 1, 2)]
    np.testing.assert_allclose(power, [1, 0, 1], rtol=0, atol=0.01)


def test_the_probability_density_of_published_quantiles_is_the_published_one():
    measured = MeasuredDensity(SCORES, B2.density.quantile_of_normal(SCORES))
    inner = np.linspace(-2.5, 2, 91)
    np.testing.assert_allclose(measured(inner), B2.density(inner), rtol=0.1)
    np.testing.assert_allclose(measured(inner).mean(), B2.density(inner).mean(), rtol=0.005)


def test_equal_heights_of_several_scores_are_a_peak_that_keeps_its_share():
    heights = np.maximum(SCORES, -1.0)  # a floor
    measured = MeasuredDensity(SCORES, heights)
    mean, deviation = measured._mean_and_deviation
    floor = (-1.0 - mean) / deviation
    near = np.linspace(floor - 0.1, floor + 0.1, 2001)
    share = np.sum(measured(near)) * (near[1] - near[0])
    np.testing.assert_allclose(share, ndtr(-1.0) + 0.1 * deviation * 0.242, rtol=0.05)


def test_the_mean_is_zero_and_the_variance_one():
    table = Translation(MeasuredDensity(SCORES, np.exp(SCORES))).table
    share = np.exp(-(np.linspace(-8, 8, 4097) ** 2) / 2)
    np.testing.assert_allclose([share @ table, share @ table**2 / share.sum()], [0, 1], atol=1e-9)


def test_beyond_the_outermost_quantiles_heights_are_straight_lines_in_the_score():
    measured = MeasuredDensity(SCORES, SCORES + 0.05 * SCORES**2)
    far = measured.quantile_of_normal(np.array([3.0, 4.0, 5.0, 6.0]))
    np.testing.assert_allclose(np.diff(far, 2), 0, atol=1e-12)
    near = measured.quantile_of_normal(np.array([2.5, 3.0, -3.0, -2.5]))
    np.testing.assert_allclose(far[1] - far[0], (near[1] - near[0]) / 0.5)
    low = measured.quantile_of_normal(np.array([-5.0, -3.0]))
    np.testing.assert_allclose(np.diff(low) / 2, (near[3] - near[2]) / 0.5)

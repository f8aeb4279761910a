import numpy as np
import pytest
from drawn_scans import Cubic
from published import IDENTITY, SURFACES
from scipy.special import ndtr, ndtri

from stiction.scans.quantiles import (
    COMPARED,
    SCORES,
    compared_slopes,
    correlation_areas,
    feasible,
    goodness,
    measured_density,
    quantiles,
)
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.feasible import largest_kurtosis
from stiction.surface.translation import Translation

B2 = SURFACES["B2"]
#: Of skewness and kurtosis of a Gaussian scan of 10 µm.
COVARIANCE = np.array([[0.036**2, 0.0], [0.0, 0.063**2]])


def test_quantiles_are_standardised_heights_at_normal_scores():
    score = ndtri((np.arange(400_000) + 0.5) / 400_000)
    heights = 2e-9 + 5e-9 * B2.density.quantile_of_normal(score)
    parts = [heights[:100_000].reshape(100, -1), np.r_[heights[100_000:], np.full(100_000, np.nan)].reshape(2, -1)]
    np.testing.assert_allclose(quantiles(parts), B2.density.quantile_of_normal(SCORES), rtol=0, atol=1e-3)


@pytest.mark.parametrize("density", [B2.density, Cubic(-0.76, 3.9), Cubic(1.0, 4.8)], ids=["maxent", "cubic", "skewed"])
def test_a_measured_density_has_the_quantiles_that_were_measured(density):
    true = density.quantile_of_normal(SCORES)
    measured = measured_density(3e-9 * true + 1e-9, 1e9)
    np.testing.assert_allclose(measured.quantile_of_normal(SCORES), true, rtol=0, atol=0.02)


def test_a_measured_density_is_standardised():
    power = Translation(measured_density(4e-9 * np.sinh(SCORES), 1e9)).hermite_coefficients ** 2
    # Slopes jump between the quantiles, so that the series of the coefficients converges slowly.
    np.testing.assert_allclose(power.sum(), 1, rtol=0, atol=2e-3)
    table = Translation(measured_density(np.exp(SCORES), 1e9)).table
    share = np.exp(-(np.linspace(-8, 8, 4097) ** 2) / 2)
    np.testing.assert_allclose([share @ table, share @ table**2 / share.sum()], [0, 1], atol=1e-9)


def test_beyond_the_measured_quantiles_heights_are_straight_lines_in_the_score():
    curved = SCORES + 0.05 * SCORES**2
    measured = measured_density(curved, 2000)
    outermost = measured.scores[-1]
    assert (measured.scores[0], outermost) == (-2.5, 2.5)  # 10 of 2000 areas are beyond a score of 2.58
    far = measured.quantile_of_normal(np.array([2.5, 4.0, 5.5, 7.0]))
    np.testing.assert_allclose(np.diff(far, 2), 0, atol=1e-12)
    near = measured.quantile_of_normal(np.array([2.0, 2.5, -2.5, -2.0]))
    np.testing.assert_allclose(np.diff(far)[0] / 1.5, (near[1] - near[0]) / 0.5)
    low = measured.quantile_of_normal(np.array([-5.0, -2.5]))
    np.testing.assert_allclose(np.diff(low) / 2.5, (near[3] - near[2]) / 0.5)


def test_an_outermost_quantile_with_just_enough_areas_beyond_it_is_used():
    for score in SCORES[SCORES >= 1]:
        assert measured_density(SCORES, 10 / ndtr(-score)).scores[-1] == score


@pytest.mark.parametrize("areas", [0.5, 10, 20, 40, 60])
def test_small_scans_have_the_measured_density_of_their_middle_quantiles(areas):
    found = measured_density(SCORES, areas).scores
    np.testing.assert_array_equal(found, SCORES[np.abs(SCORES) <= 1])
    assert 1 < measured_density(SCORES, 77).scores[-1] < 1.2, "control"


def test_heights_that_are_equal_apart_from_a_few_have_no_measured_density():
    with pytest.raises(ValueError, match="nearly all of the heights are equal"):
        measured_density(np.where(SCORES > 2.9, 50.0, 0.0), 2000)
    measured_density(np.where(SCORES > 2.4, 50.0, 0.0), 2000)


def test_gaussian_quantiles_give_the_gaussian_density():
    np.testing.assert_allclose(Translation(measured_density(SCORES, 1e4)).table, IDENTITY.table, rtol=2e-5, atol=2e-5)


def test_number_of_correlation_areas_of_a_scan_of_10_um():
    assert correlation_areas(B2.spectrum, B2.rms**2, 1e-10) == pytest.approx(2036, rel=1e-3)


def no_covariance():
    raise AssertionError("not needed")


def test_moments_that_have_a_density_keep_it():
    found = feasible(-0.76, 3.9, no_covariance)
    assert (found.skewness, found.kurtosis, found.distance) == (-0.76, 3.9, 0)
    assert found.density == B2.density


def test_moments_without_density_take_the_nearest_in_the_metric_of_their_errors():
    found = feasible(0.0, 3.1, lambda: COVARIANCE)
    assert found.kurtosis == pytest.approx(3, abs=0.01)
    assert 1 < found.distance < 1.7
    np.testing.assert_allclose(found.density.quantile_of_normal(1.0), 1, atol=0.02)
    assert feasible(0.0, 3.1, lambda: 4 * COVARIANCE).distance == pytest.approx(found.distance / 2, rel=0.05)


def test_the_largest_distance_decides_which_moments_are_near():
    assert feasible(0.0, 3.1, lambda: COVARIANCE, 1.0) is None
    assert feasible(0.0, 3.3, lambda: COVARIANCE, np.inf).distance > 3.7


def test_moments_far_from_the_domain_have_no_density():
    assert feasible(0.0, 3.3, lambda: COVARIANCE) is None
    assert feasible(2.0, 4.5, lambda: COVARIANCE) is None  # below the lower bound


@pytest.mark.parametrize("skewness", [-0.76, 0.76])
def test_slopes_of_the_quantiles_are_differences_of_densities(skewness):
    slopes = compared_slopes(skewness, 3.9)
    for shift, step in (((0.03, 0.0), 0), ((0.0, 0.08), 1)):
        more, less = (
            maxent.solve(skewness + sign * shift[0], 3.9 + sign * shift[1]).quantile_of_normal(SCORES[COMPARED])
            for sign in (1, -1)
        )
        np.testing.assert_allclose((more - less) / (2 * sum(shift)), slopes[step], rtol=0.1, atol=0.07)


@pytest.mark.parametrize("skewness", [-1.0, -0.76, -0.3, 0.0, 0.3, 1.0])
def test_slopes_exist_at_the_largest_kurtosis(skewness):
    assert np.isfinite(compared_slopes(skewness, largest_kurtosis(skewness))).all()


def test_compared_scores_reach_far_into_the_upper_tail():
    np.testing.assert_array_equal(SCORES[COMPARED], [-2, 1, 2, 2.5, 3])


@pytest.mark.parametrize("scans", [1, 4])
def test_goodness_is_the_probability_of_a_larger_deviation(scans):
    mixing = stream(1, "mixing").standard_normal((5, 5))

    def likely(k, shift=0.0):
        rng = stream(1, "goodness", k)
        model = rng.standard_normal((10, 5)) @ mixing
        measured = rng.standard_normal(5) @ mixing / np.sqrt(scans) + shift * mixing[0]
        return goodness(measured, model, scans)[1]

    values = np.array([likely(k) for k in range(800)])
    for level in (0.05, 0.5):
        assert np.mean(values < level) == pytest.approx(level, abs=4 * np.sqrt(level * (1 - level) / 800))
    assert np.median([likely(k, 12.0) for k in range(20)]) < 0.01


def test_without_a_density_there_is_no_goodness():
    rows = stream(1).standard_normal((30, 5))
    assert np.isnan(goodness(np.full(5, np.nan), rows, 1)).all()
    some = np.where(np.arange(30)[:, None] < 15, np.nan, rows)
    np.testing.assert_allclose(goodness(rows[0], some, 1), goodness(rows[0], rows[15:], 1))


def test_scores_are_normal_scores_of_equal_steps():
    assert ndtr(SCORES[0]) == pytest.approx(0.00135, abs=1e-5)
    np.testing.assert_allclose(np.diff(SCORES), 0.125)

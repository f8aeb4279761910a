import numpy as np
import pytest
from drawn_scans import Cubic
from published import IDENTITY, SURFACES
from scipy.special import ndtr, ndtri

from stiction.scans import quantiles as form
from stiction.scans.quantiles import (
    COMPARED,
    NEAR,
    SCORES,
    compared_slopes,
    correlation_areas,
    goodness,
    maximum_entropy,
    measured_density,
    nearest,
    quantiles,
)
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.translation import Translation

B2 = SURFACES["B2"]
#: Largest kurtosis of which a skewness has a density that can be drawn, computed independently.
DOMAIN = {0.1: 3.026, 0.2: 3.107, 0.3: 3.242, 0.5: 3.804, 0.76: 5.592, 1.0: 7.78}
COVARIANCE = np.array([[0.036**2, 0.0], [0.0, 0.063**2]])


def test_quantiles_are_standardised_heights_at_normal_scores():
    score = ndtri((np.arange(400_000) + 0.5) / 400_000)
    heights = 2e-9 + 5e-9 * B2.density.quantile_of_normal(score)
    parts = [heights[:100_000].reshape(100, -1), np.r_[heights[100_000:], np.nan, np.nan].reshape(2, -1)]
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


def test_small_scans_have_no_measured_density():
    assert measured_density(SCORES, 70).scores[-1] < 1.2
    with pytest.raises(ValueError, match="heights of 40 independent areas do not give a density"):
        measured_density(SCORES, 40)


def test_gaussian_quantiles_give_the_gaussian_density():
    np.testing.assert_allclose(Translation(measured_density(SCORES, 1e4)).table, IDENTITY.table, rtol=2e-5, atol=2e-5)


def test_number_of_correlation_areas_of_a_scan_of_10_um():
    assert correlation_areas(B2.spectrum, B2.rms**2, 1e-10) == pytest.approx(2036, rel=1e-3)


def test_moments_that_have_a_density_keep_it():
    found = maximum_entropy(-0.76, 3.9)
    assert (found.skewness, found.kurtosis, found.distance) == (-0.76, 3.9, 0)
    assert found.density == B2.density
    assert maximum_entropy(0.1, 3.1) is None


@pytest.mark.parametrize(("skewness", "largest"), DOMAIN.items())
def test_the_domain_ends_where_it_was_found_to_end(skewness, largest):
    found = form._largest_kurtosis(skewness, 10.0)
    assert found == (skewness, pytest.approx(largest, abs=3e-3))


def test_the_nearest_moments_have_a_density_and_none_on_the_way_is_nearer():
    wanted = np.array([0.05, 3.12])
    found = nearest(*wanted, COVARIANCE)
    assert maximum_entropy(found.skewness, found.kurtosis) is not None
    away = (np.array([found.skewness, found.kurtosis]) - wanted) / np.sqrt(np.diag(COVARIANCE))
    assert found.distance == pytest.approx(away @ away)
    direct = (form._largest_kurtosis(wanted[0], wanted[1])[1] - wanted[1]) / np.sqrt(COVARIANCE[1, 1])
    assert 0 < found.distance < direct**2
    assert found.skewness > wanted[0]  # where the domain widens


def test_moments_far_from_the_domain_have_no_density():
    assert nearest(0.0, 3.3, COVARIANCE) is None
    assert nearest(0.0, 3.3, 4 * COVARIANCE).distance < NEAR == pytest.approx(5.99, abs=0.01)


def test_slopes_of_the_quantiles_are_differences_of_densities():
    slopes = compared_slopes(-0.76, 3.9)
    for shift, step in (((0.03, 0.0), 0), ((0.0, 0.08), 1)):
        more, less = (
            maxent.solve(-0.76 + sign * shift[0], 3.9 + sign * shift[1]).quantile_of_normal(SCORES[COMPARED])
            for sign in (1, -1)
        )
        np.testing.assert_allclose((more - less) / (2 * sum(shift)), slopes[step], rtol=0.1, atol=0.02)


def test_compared_scores_reach_far_into_the_upper_tail():
    np.testing.assert_array_equal(SCORES[COMPARED], [-2, 1, 2, 2.5, 3])


@pytest.mark.parametrize("scans", [1, 4])
def test_goodness_is_the_probability_of_a_larger_deviation(scans):
    mixing = stream(1, "mixing").standard_normal((5, 5))

    def likely(k, shift=0.0):
        rng = stream(1, "goodness", k)
        model = rng.standard_normal((30, 5)) @ mixing
        measured = rng.standard_normal(5) @ mixing / np.sqrt(scans) + shift * mixing[0]
        return goodness(measured, model, scans)[1]

    values = np.array([likely(k) for k in range(800)])
    for level in (0.05, 0.5):
        assert np.mean(values < level) == pytest.approx(level, abs=4 * np.sqrt(level * (1 - level) / 800))
    assert np.median([likely(k, 6.0) for k in range(20)]) < 0.01


def test_without_a_density_there_is_no_goodness():
    rows = stream(1).standard_normal((30, 5))
    assert np.isnan(goodness(np.full(5, np.nan), rows, 1)).all()
    some = np.where(np.arange(30)[:, None] < 15, np.nan, rows)
    np.testing.assert_allclose(goodness(rows[0], some, 1), goodness(rows[0], rows[15:], 1))


def test_scores_are_normal_scores_of_equal_steps():
    assert ndtr(SCORES[0]) == pytest.approx(0.00135, abs=1e-5)
    np.testing.assert_allclose(np.diff(SCORES), 0.125)

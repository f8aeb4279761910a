import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtr, ndtri
from scipy.stats import beta
from standard_errors import ALLOWED, errors_off

from stiction.devices import tail


def lognormal(rng, samples, spread=0.025):
    """Lengths whose logarithms are normal, with a median of 700 µm."""
    return 700e-6 * np.exp(spread * rng.standard_normal(samples))


def test_a_line_is_recovered():
    scores = tail.normal_scores(1000)
    lengths = np.concatenate([np.exp(-7 + 0.03 * scores), np.full(1000 - len(scores), np.inf)])
    fit = tail.fit_tail(lengths[::-1])
    assert_allclose([fit.intercept, fit.slope], [-7, 0.03], rtol=1e-12)
    assert_allclose(fit.length(1e-3), np.exp(-7 + 0.03 * ndtri(1e-3)), rtol=1e-12)
    assert fit.samples == 1000


def test_scores_are_the_means_of_normal_order_statistics():
    rng = np.random.default_rng(0)
    drawn = np.sort(rng.standard_normal((4000, 400)), axis=1)[:, :20]
    assert errors_off(drawn, tail.normal_scores(400)) < ALLOWED + 1  # Blom's positions err by 0.003 at the ends
    assert errors_off(drawn, ndtri(np.arange(1, 21) / 400)) > 10  # control


@pytest.mark.parametrize("share", [1e-2, 1e-3, 1e-4])
def test_fitted_lengths_of_a_lognormal_distribution_are_unbiased_and_scatter_as_simulated(share):
    rng, spread = np.random.default_rng(1), 0.025
    found = np.log([tail.fit_tail(lognormal(rng, 1000, spread)).length(share) for _ in range(600)])
    expected = np.log(700e-6) + spread * ndtri(share)
    assert errors_off(found, expected) < ALLOWED
    errors, _ = tail.scaled_errors(1000, share, rng)
    scatter = spread * errors.std()
    assert abs(found.std() / scatter - 1) < 4 * np.sqrt(1 / 1200 + 1 / 8000)
    assert abs(found.std() / (1.4 * scatter) - 1) > 4 * np.sqrt(1 / 1200 + 1 / 8000)  # control


def test_errors_shrink_with_the_root_of_the_samples_and_grow_beyond_them():
    rng = np.random.default_rng(2)
    few, many, far = (tail.scaled_errors(n, p, rng)[0].std() for n, p in ((500, 1e-3), (8000, 1e-3), (500, 1e-6)))
    assert_allclose(few / many, 4, rtol=0.1)
    assert far > 1.5 * few


def test_a_sum_of_exponentials_draws_the_lowest_order_statistics():
    # The same statistic from complete samples of normal numbers.
    rng = np.random.default_rng(3)
    errors, pivots = tail.scaled_errors(400, 1e-3, rng, 3000)
    direct = []
    for _ in range(3000):
        fit = tail.fit_tail(np.exp(rng.standard_normal(400)))
        error = fit.intercept + (fit.slope - 1) * ndtri(1e-3)
        direct.append([error, error / fit.slope])
    for simulated, drawn in zip((errors, pivots), np.transpose(direct), strict=True):
        for level in (0.1, 0.5, 0.95):
            below = np.mean(drawn < np.quantile(simulated, level))
            assert abs(below - level) < 4 * np.sqrt(2 * level * (1 - level) / 3000)


def test_errors_that_are_asked_for_again_are_the_same_and_the_generator_goes_on_behind_them():
    shares = 1e-3, 1e-2, 1e-3
    again, other = ([np.random.default_rng(seed) for _ in shares] for seed in (8, 9))
    of_again, of_other = (
        [tail.scaled_errors(400, share, rng) for share, rng in zip(shares, generators, strict=True)]
        for generators in (again, other)
    )
    assert_array_equal(of_again[0], of_again[2])
    for different in (of_again[1], of_other[0]):  # control
        assert np.all(different != of_again[0])
    following = {rng.random() for rng in again}
    assert len(following) == 1
    assert following != {np.random.default_rng(8).random()}  # control


def test_simulated_errors_have_no_bias_within_the_fitted_part():
    errors, _ = tail.scaled_errors(400, 0.02, np.random.default_rng(5), 20_000)
    assert errors_off(errors, 0) < ALLOWED + 0.002 * np.sqrt(20_000) / errors.std()  # Blom's positions err by 0.002


def test_simulated_errors_where_the_fitted_scores_have_their_mean_are_those_of_normal_order_statistics():
    scores = tail.normal_scores(60)
    errors, _ = tail.scaled_errors(60, ndtr(scores.mean()), np.random.default_rng(6), 100_000)
    expected = np.mean([beta(rank, 61 - rank).expect(ndtri) for rank in (1, 2, 3)])
    assert errors_off(errors, expected - scores.mean()) < ALLOWED


def test_a_heavier_end_is_not_a_line_and_the_fit_follows_its_lowest_part():
    # Control of the method: the fit uses the end only, so that a second mode far above does not change it.
    rng = np.random.default_rng(4)
    one = lognormal(rng, 1000)
    other = np.where(one > np.quantile(one, 0.5), 3 * one, one)
    assert tail.fit_tail(one) == tail.fit_tail(other)


@pytest.mark.parametrize(("known", "message"), [(179, "180 lengths, got 179"), (8, "needs 9 of them, got 8")])
def test_too_few_known_lengths_are_refused(known, message):
    lengths = np.where(np.arange(179 if known == 179 else 1000) < known, 1.0, np.inf)
    with pytest.raises(ValueError, match=message):
        tail.fit_tail(lengths)


def test_a_fit_of_fewer_lengths_is_the_same_line_with_larger_errors():
    scores = tail.normal_scores(1000)
    line = np.exp(-7 + 0.03 * scores)
    few = tail.fit_tail(np.concatenate([line[:12], np.full(988, np.inf)]))
    assert_allclose([few.intercept, few.slope, few.fitted], [-7, 0.03, 12], rtol=1e-12)
    errors = [tail.scaled_errors(1000, 1e-3, np.random.default_rng(7), fitted=fitted)[0].std() for fitted in (12, 50)]
    assert errors[0] > 1.2 * errors[1]

from collections import Counter
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from stiction.beam.middle import outwards
from stiction.devices.strips import in_row, is_narrow, repetition, resampled


def numbers(number, rng):
    """Laws that are all different, in the order of their draws."""
    return np.tile(rng.random() + np.arange(number), (4, 1)).T


@pytest.mark.parametrize("repeats", [0.2, 0.5])
@pytest.mark.parametrize("arms", [1, 2])
def test_strips_any_distance_apart_have_the_same_law_with_the_power_of_the_probability(repeats, arms):
    row = along(in_row(numbers, repeats, arms)(40_000, np.random.default_rng(1))[:, 0], arms)
    for distance in (1, 2, 3):
        same, expected = np.mean(row[distance:] == row[:-distance]), repeats**distance
        assert same == pytest.approx(expected, abs=4 * (expected / (1 - repeats) / 40_000) ** 0.5)


def along(drawn, arms):
    """Strips in their order along a beam, from the order of their draws."""
    return drawn if arms == 1 else drawn[outwards(len(drawn))]


@pytest.mark.parametrize("arms", [1, 2])
def test_a_longer_row_begins_with_the_laws_of_a_shorter_one_that_draws_the_same_numbers(arms):
    repeats = np.random.default_rng(2).random(60)

    def row(number):
        rng = SimpleNamespace(random=lambda n: repeats[:n])
        return in_row(lambda n, _: np.tile(np.arange(n), (4, 1)).T, 0.5, arms)(number, rng)

    assert_array_equal(row(60)[:20], row(20))


def test_rows_without_repetition_are_drawn_as_independent_strips():
    assert in_row(numbers, 0.0, 1) is numbers


def test_the_law_of_one_strip_keeps_its_distribution():
    laws = np.random.default_rng(3).lognormal(0, 0.5, (400, 4))
    drawn = in_row(partial(resampled, laws), 0.5, 1)(100_000, np.random.default_rng(4))[:, 0]
    for power in (1, 2):
        expected, scatter = (laws[:, 0] ** power).mean(), (laws[:, 0] ** power).std()
        assert (drawn**power).mean() == pytest.approx(expected, abs=4 * scatter * (3 / 100_000) ** 0.5)


@pytest.mark.parametrize("correlations", [[0.5, 0.0, -0.1], [0.8, 0.7, 0.6, 0.5, 0.2, 0.0], [0.2, 0.4], [1.0, 1.0]])
def test_means_over_any_number_of_strips_scatter_at_least_as_much_as_mean_heights(correlations):
    """By sums of the correlations; with a little less repetition, one of the sums is smaller."""
    repeats, sums = repetition(np.array(correlations)), np.cumsum(correlations)

    def of_row(repeats):
        return np.cumsum(repeats ** np.arange(1, len(correlations) + 1))

    assert np.all(of_row(repeats) >= sums)
    assert np.any(of_row(repeats - 0.002) < sums)


def test_means_over_strips_scatter_as_the_sums_of_their_correlations_say():
    laws = np.random.default_rng(5).lognormal(0, 0.5, (400, 4))

    def scatter(repeats):
        draw = in_row(partial(resampled, laws), repeats, 1)
        return np.std([draw(120, np.random.default_rng(seed))[:, 0].mean() for seed in range(3000)])

    lag = np.arange(1, 120)
    expected = (1 + 2 * np.sum((1 - lag / 120) * 0.5**lag)) ** 0.5
    assert scatter(0.5) / scatter(0.0) == pytest.approx(expected, rel=4 * 3000**-0.5)


@pytest.mark.parametrize("correlations", [[], [0.05, 0.02], [-0.3, 0.1]])
def test_strips_that_are_hardly_correlated_count_as_independent(correlations):
    assert repetition(np.array(correlations)) == 0


def test_resampled_laws_are_the_samples_with_equal_probability():
    laws = np.arange(20.0).reshape(5, 4)
    counts = Counter(map(tuple, resampled(laws, 5000, np.random.default_rng(3)).tolist()))
    assert set(counts) == set(map(tuple, laws.tolist()))
    assert all(abs(count - 1000) < 4 * 800**0.5 for count in counts.values())


def test_a_rare_strong_strip_that_the_model_lacks_makes_it_narrow():
    rng = np.random.default_rng(4)
    usual = rng.lognormal(0, 0.4, 500)
    assert not is_narrow(rng.lognormal(0, 0.4, 20_000), usual)
    assert not is_narrow(rng.lognormal(0, 0.5, 20_000), usual)
    assert is_narrow(rng.lognormal(0, 0.4, 20_000), np.append(usual, 44 * usual.mean()))
    assert is_narrow(0.97 * rng.permutation(np.tile(usual, 40)), usual)  # of less mean, with the same scatter

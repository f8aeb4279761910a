from collections import Counter

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from stiction.devices.strips import INDEPENDENT, alike, in_blocks, is_narrow, resampled


def numbers(number, rng):
    """Laws that are all different, in the order of their draws."""
    return np.tile(rng.random() + np.arange(number), (4, 1)).T


@pytest.mark.parametrize("block", [2, 3, 7])
def test_neighbours_within_a_block_have_the_same_law_and_others_do_not(block):
    laws = in_blocks(numbers, block)(100, np.random.default_rng(1))
    assert laws.shape == (100, 4)
    ends = np.flatnonzero(np.diff(laws[:, 0])) + 1
    assert_array_equal(np.diff(ends), block)
    assert 1 <= ends[0] <= block


@pytest.mark.parametrize("number", [1, 2, 5])
def test_blocks_longer_than_a_beam_give_as_many_strips_as_asked_for(number):
    sizes = {len(in_blocks(numbers, 9)(number, np.random.default_rng(seed))) for seed in range(40)}
    assert sizes == {number}


def test_blocks_begin_everywhere_with_the_same_probability():
    first = Counter(
        np.flatnonzero(np.diff(in_blocks(numbers, 4)(20, np.random.default_rng(seed))[:, 0]))[0] for seed in range(2000)
    )
    assert set(first) == {0, 1, 2, 3}
    assert all(abs(count - 500) < 4 * (500 * 0.75) ** 0.5 for count in first.values())


def test_single_strips_are_drawn_as_without_blocks():
    assert in_blocks(numbers, 1) is numbers


def test_means_over_blocks_scatter_more_by_the_root_of_their_length():
    laws = np.random.default_rng(2).lognormal(0, 0.5, (400, 4))

    def scatter(block):
        draw = in_blocks(lambda number, rng: resampled(laws, number, rng), block)
        return np.std([draw(120, np.random.default_rng(seed))[:, 0].mean() for seed in range(3000)])

    ratio = scatter(6) / scatter(1)
    assert ratio == pytest.approx(6**0.5, rel=4 * 3000**-0.5)
    assert ratio > 2


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


def test_strips_count_as_alike_beyond_three_of_them_and_up_to_the_whole_correlation():
    strip = 1.5e-6
    assert alike(INDEPENDENT * strip, strip) == 1
    assert alike(1.001 * INDEPENDENT * strip, strip) == INDEPENDENT + 1
    lengths = np.linspace(0.1e-6, 40e-6, 300)
    found = np.array([alike(length, strip) for length in lengths])
    assert np.all(np.diff(found) >= 0)
    assert np.all((found == 1) | (found * strip >= lengths))

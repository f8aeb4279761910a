"""Numbers of beams and strips for an accuracy: fewest with the asked error, and the best there are at their limits."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from stiction.devices.numbers import (
    MEAN_ERROR,
    MOST_BEAMS,
    MOST_STRIPS,
    Spread,
    beams_for,
    quantile_errors,
    strips_for,
    strips_for_mean,
)
from stiction.devices.risk import safe_length, samples_for

spreads = st.lists(st.builds(Spread, st.floats(0.005, 0.2), st.floats(0, 0.5)), min_size=1, max_size=3)
accuracies, shares = st.floats(0.005, 0.1), st.sampled_from([1e-2, 1e-3])


@pytest.mark.parametrize(("beams", "share"), [(200, 1e-2), (400, 1e-2), (400, 1e-3), (3000, 1e-3)])
def test_the_error_of_a_number_of_beams_is_that_of_repeated_safe_lengths(beams, share):
    rng, slope, studies = np.random.default_rng(5), 0.05, 150
    drawn = [safe_length(np.exp(slope * rng.standard_normal(beams)), share, rng) for _ in range(studies)]
    scatter = np.std([np.log(one.estimate) for one in drawn], ddof=1)
    expected = Spread(slope, 0.0).error(beams, 300, share)
    assert abs(np.log(scatter / expected)) < 3 / np.sqrt(2 * studies)
    assert abs(np.log(scatter / Spread(slope, 0.0).error(4 * beams, 300, share))) > 3 / np.sqrt(2 * studies)  # control


@given(spreads, accuracies, shares, st.integers(3, 20))
def test_numbers_are_the_fewest_that_leave_the_accuracy(some, accuracy, share, hundreds):
    beams = beams_for(some, share, accuracy, fewest := 100 * hundreds)
    strips = strips_for(some, share, accuracy, beams, fewest)

    def error(beams, strips):
        return max(one.error(beams, strips, share) for one in some)

    assume(strips < MOST_STRIPS)
    best = quantile_errors(np.arange(200, MOST_BEAMS + 1, 200), share).min()
    if max(one.slope for one in some) * best <= accuracy / np.sqrt(2):
        assert error(beams, strips) <= accuracy * (1 + 1e-9)
        assert beams == 200 or error(beams - 200, fewest) > accuracy
    assert strips == fewest or error(beams, strips - 100) > accuracy


@given(spreads, accuracies, shares)
def test_a_higher_accuracy_takes_no_fewer_beams_and_strips(some, accuracy, share):
    finer, coarser = (beams_for(some, share, at, 300) for at in (accuracy / 2, accuracy))
    assert finer >= coarser or finer == samples_for(share) // 200 * 200
    less, more = (strips_for(some, share, at, 1000, 300) for at in (accuracy, accuracy / 2))
    assert less <= more


def test_beams_that_are_all_equal_need_few_and_strips_that_differ_much_the_most():
    assert beams_for([Spread(0.0, 0.1)], 1e-3, 0.01, 300) == 200
    assert strips_for([Spread(0.0, 0.0)], 1e-3, 0.01, 200, 301) == 400
    assert strips_for([Spread(0.0, 9.0)], 1e-3, 0.01, 200, 300) == MOST_STRIPS


@given(st.floats(0.01, 1), st.integers(5, 1800))
def test_strips_for_a_mean_length_are_the_fewest_hundreds_that_leave_its_error(scatter, fewest):
    error = 0.25 * scatter
    strips = strips_for_mean(error, fewest)
    assert strips % 500 == 0
    assert 500 <= strips <= 5000
    assert strips == 5000 or (strips >= fewest and error / strips**0.5 <= MEAN_ERROR * (1 + 1e-9))
    assert strips == 500 or strips - 500 < fewest or error / (strips - 500) ** 0.5 > MEAN_ERROR
    assert strips_for_mean(2 * error, fewest) >= strips


def test_strips_for_a_mean_length_grow_with_the_square_of_the_scatter():
    numbers = [strips_for_mean(0.25 * scatter, 300) for scatter in (0.3, 0.6, 0.75)]
    assert numbers == [1000, 2500, 4000]
    # Control: with the scatter itself, 0.6 would need twice as many as 0.3, not four times as many.
    assert (0.25 * 0.6 / MEAN_ERROR) ** 2 > 2000


@pytest.mark.parametrize("slope", [0.1, 0.2])
@pytest.mark.parametrize("accuracy", [0.002, 0.005])
def test_at_the_limit_beams_are_as_many_as_have_the_smallest_error(slope, accuracy):
    numbers = np.arange(200, MOST_BEAMS + 1, 200)
    best = numbers[np.argmin(quantile_errors(numbers, 1e-3))]
    assert quantile_errors(np.array([best]), 1e-3)[0] * slope > accuracy
    assert beams_for([Spread(slope, 0.0)], 1e-3, accuracy, 300) == best

"""Intervals contain measured lengths as often as they state, whatever the size of each part of the model's error."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import t

from stiction.analysis.prediction import Discrepancy
from stiction.streams import stream

#: Computed lengths of each of four pairs, over humidities [m].
COMPUTED = [at * np.exp(-width * np.linspace(-0.5, 0.5, 6)) for at, width in ((5e-4, 0.6), (6e-4, 0.8), (5e-4, 1.7))]
COMPUTED.append(7e-4 * np.exp(-0.9 * np.linspace(-0.5, 0.5, 6)))
DRAWS = 400


def place(lengths):
    """u of lengths of a pair."""
    return np.log(lengths) - np.log(lengths).mean()


def measured(rng, factor, slope, rest, bend=0.0):
    """Measured lengths of all pairs, with an error of the model whose lines can be bent."""
    errors = (
        factor * rng.standard_normal() + slope * rng.standard_normal() * place(one) + bend * place(one) ** 2
        + rest * rng.standard_normal(len(one))
        for one in COMPUTED
    )  # fmt: skip
    return [one * np.exp(error) for one, error in zip(COMPUTED, errors, strict=True)]


def contained(is_inside, **sizes):
    """Fraction of draws in which an interval, learnt from three pairs, contains a length of the fourth."""
    found = []
    for k in range(DRAWS):
        lengths = measured(stream(50, "prediction", k), **sizes)
        known = Discrepancy.learnt(list(zip(COMPUTED[:3], lengths[:3], strict=True)))
        at = slice(k % 6, k % 6 + 1)
        found.append(is_inside(known, place(COMPUTED[3])[at], np.abs(np.log(lengths[3] / COMPUTED[3]))[at]))
    return np.mean(found)


def in_the_interval(known, places, differences):
    """Whether the interval of 95 % contains a difference."""
    return known.probability(differences, places, np.zeros(1))[0] < 0.95


def as_if_known(known, places, differences):
    """Whether that of a normal distribution does, with the estimated variances as if three pairs told them exactly."""
    variances = np.mean(known.factors**2), np.mean(known.slopes**2), known.rest / known.freedom
    return differences[0] < 1.96 * np.sqrt(variances[0] + variances[1] * places[0] ** 2 + variances[2])


WRONG = {
    "factor": {"factor": 0.1, "slope": 0.0, "rest": 0.01},
    "all": {"factor": 0.1, "slope": 0.3, "rest": 0.05},
    "bent": {"factor": 0.1, "slope": 0.3, "rest": 0.03, "bend": 0.05},
}


@pytest.mark.parametrize("wrong", WRONG)
def test_intervals_of_95_percent_contain_95_percent_of_lengths_drawn_with_a_wrong_model(wrong):
    assert abs(contained(in_the_interval, **WRONG[wrong]) - 0.95) < 0.03


def test_variances_of_three_pairs_are_not_exact():
    assert contained(as_if_known, **WRONG["factor"]) < 0.92


def test_a_factor_alone_is_predicted_by_students_distribution():
    known = Discrepancy(np.array([0.1, -0.05, 0.02]), np.zeros(3), 1e-12, 12, (0.0, 0.0))
    size = np.sqrt(np.mean(known.factors**2))
    for coverage in (0.68, 0.95):
        width = known.half_widths(np.array([0.7]), np.zeros(1), coverage)
        assert_allclose(width, size * t.ppf((1 + coverage) / 2, 3), rtol=0.01)


def test_an_exact_model_is_as_uncertain_as_its_simulation():
    known = Discrepancy(np.zeros(3), np.zeros(3), 0.0, 12, (0.2, 1.0))
    assert_allclose(known.half_widths(np.array([0.5]), np.array([0.01]), 0.95), 0.0196, rtol=1e-3)


def test_scatter_of_the_rest_alone_does_not_count_as_a_factor():
    rng = stream(50, "rest")
    lengths = [one * np.exp(0.05 * rng.standard_normal(6)) for one in COMPUTED]
    factor, slope, rest = Discrepancy.learnt(list(zip(COMPUTED, lengths, strict=True))).variances()
    assert np.median(factor) < np.median(rest)
    assert np.median(slope) < np.median(rest) / (place(COMPUTED[2])[0] ** 2)


def test_intervals_grow_with_coverage_and_distance_from_the_middle():
    known = Discrepancy(np.array([0.1, -0.05]), np.array([0.3, 0.1]), 0.02, 8, (0.2, 1.0))
    widths = known.half_widths(np.array([0.0, 0.4, 0.8]), np.full(3, 0.01), 0.68)
    assert (np.diff(widths) > 0).all()
    assert (known.half_widths(np.array([0.0, 0.4, 0.8]), np.full(3, 0.01), 0.95) > widths).all()

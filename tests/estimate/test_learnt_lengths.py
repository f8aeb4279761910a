"""Fit, table and intervals of the estimate: on drawn functions whose truth is known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, norm

from stiction.estimate.learning.errors import conformal
from stiction.estimate.learning.fit import DesignRows, Kernel, coefficients, fitted, group
from stiction.estimate.length import SCORES, Lengths, fraction_of, normal_score, score_at
from stiction.estimate.table import Surrogate


def drawn(number, seed, noise=0.0):
    """Rows of a smooth function of three coordinates, three rows of each surface."""
    rng = np.random.default_rng(seed)
    surfaces = rng.uniform(-1, 1, (number, 2)).repeat(3, axis=0)
    coordinates = np.column_stack([surfaces, rng.uniform(-1, 1, 3 * number)])
    x, y, z = coordinates.T
    values = np.sin(2 * x) + y * z + 0.5 * np.cos(2 * y)
    values = values + noise * rng.normal(size=number).repeat(3)
    of_rows = np.arange(number).repeat(3), np.ones(3 * number)
    return DesignRows(coordinates, {"f": values, "g": 2 * values + x}, *of_rows)


def test_a_process_follows_a_smooth_function_and_its_trend_alone_does_not():
    learnt, other = drawn(80, 1), drawn(40, 2)
    found = fitted(learnt, "f", range(3), 100)
    content, process = found.content, Surrogate(**found.content)
    errors = [process.at(row).of["f"] - value for row, value in zip(other.coordinates, other.values["f"], strict=True)]
    scatter = np.std(other.values["f"])
    assert np.std(errors) < 0.04 * scatter  # kernels have a noise of at least 2 %
    assert found.scatter["f"] < 0.08 * scatter
    none = {name: [0.0] * len(content["nodes"]) for name in ("f", "g")}
    trend = Surrogate(**content | {"weights": none})
    alone = [trend.at(row).of["f"] - value for row, value in zip(other.coordinates, other.values["f"], strict=True)]
    assert np.std(alone) > 5 * np.std(errors)


def test_a_node_that_is_given_twice_shares_its_weight():
    """The kernel between the nodes is singular then. Without what is added to it there would be no solution."""
    rows = drawn(40, 1)
    kernel, nodes = Kernel(np.zeros(3), np.ones(3), np.ones(3), 0.1), rows.coordinates[::6]
    (trend, once), (same, twice) = (
        coefficients(kernel, rows, np.vstack(some))["f"] for some in ((nodes,), (nodes, nodes[:5]))
    )
    np.testing.assert_allclose(same, trend, atol=1e-3)
    np.testing.assert_allclose(twice[:5], twice[len(nodes) :], atol=1e-3 * np.abs(once).max())
    np.testing.assert_allclose(twice[:5] + twice[len(nodes) :], once[:5], atol=1e-3 * np.abs(once).max())


def test_noise_of_a_surface_is_not_followed():
    noise = 0.1
    learnt, other = drawn(80, 1, noise), drawn(40, 2)
    process = Surrogate(**fitted(learnt, "f", range(3), 100).content)
    errors = [process.at(row).of["f"] - value for row, value in zip(other.coordinates, other.values["f"], strict=True)]
    assert np.std(errors) < noise


def test_rows_with_less_noise_decide():
    learnt, other = drawn(80, 1), drawn(40, 2)
    loud = learnt.surface % 2 == 0
    wrong = {name: y + 1.0 * loud * np.random.default_rng(4).normal(size=len(y)) for name, y in learnt.values.items()}

    def error(noise):
        """Scatter of the errors of a process that is told the noise."""
        process = Surrogate(
            **fitted(DesignRows(learnt.coordinates, wrong, learnt.surface, noise), "f", range(3), 100).content
        )
        found = [process.at(row).of["f"] for row in other.coordinates]
        return np.std(found - other.values["f"])

    assert error(np.where(loud, 9.0, 1.0)) < 0.7 * error(np.ones(len(loud)))


def test_a_place_beyond_the_design_is_named():
    process = Surrogate(**fitted(drawn(40, 1), "f", range(3), 60).content)
    assert process.at([0.0, 0.0, 0.0]).outside == ()
    assert process.at([0.0, 1.5, -1.5]).outside == (1, 2)
    assert process.at([3.0, 0.0, 0.0]).distance > process.farthest


def test_a_process_is_trusted_up_to_the_farthest_surface_that_was_left_out():
    learnt = drawn(40, 1)
    found = fitted(learnt, "f", range(3), 60)
    groups = group(learnt.surface)
    without = [Surrogate(**found.without[k]) for k in groups]
    left_out = [one.at(row) for one, row in zip(without, learnt.coordinates, strict=True)]
    assert max(one.distance for one in left_out) == pytest.approx(found.content["farthest"])
    errors = [value - one.of["f"] for one, value in zip(left_out, learnt.values["f"], strict=True)]
    np.testing.assert_allclose(errors, found.errors["f"], atol=1e-9)
    learnt_all = [found.without[(k + 1) % len(found.without)] for k in groups]
    other = [Surrogate(**one).at(row) for one, row in zip(learnt_all, learnt.coordinates, strict=True)]
    assert np.std([value - one.of["f"] for one, value in zip(other, learnt.values["f"], strict=True)]) < np.std(errors)


lengths = st.builds(
    lambda start, first, second, slope: Lengths((start, start - first, start - first - second), slope),
    *(st.floats(-10, -7), st.floats(0.01, 0.3), st.floats(0.01, 0.3), st.floats(0.01, 0.3)),
)


@given(lengths, st.floats(-5, 0))
def test_score_is_the_inverse_of_the_length(of_tips, score):
    value = math.log(of_tips.at(score))
    assert score_at(lambda each: math.log(of_tips.at(each)), value) == pytest.approx(score, abs=1e-9)


@given(lengths, st.floats(-5, 0), st.floats(0.01, 1))
def test_fewer_stick_at_shorter_lengths(of_tips, score, less):
    assert of_tips.at(score - less) < of_tips.at(score)


def test_lengths_have_those_at_their_scores():
    of_tips = Lengths((-8.0, -8.1, -8.3), 0.1)
    np.testing.assert_allclose([math.log(of_tips.at(score)) for score in SCORES], of_tips.logarithms)
    assert math.log(of_tips.at(-4)) == pytest.approx(-8.5)


@given(st.floats(1e-7, 0.5))
def test_normal_scores_are_those_of_the_normal_distribution(fraction):
    assert normal_score(fraction) == pytest.approx(norm.ppf(fraction), abs=1e-6)
    assert fraction_of(normal_score(fraction)) == pytest.approx(fraction, rel=1e-6)


@pytest.mark.parametrize(("confidence", "surfaces"), [(0.9, 30), (0.95, 40)])
def test_conformal_intervals_cover_further_errors_and_half_of_them_do_not(confidence, surfaces):
    rng, trials = np.random.default_rng(3), 2000
    errors = rng.standard_t(3, (trials, surfaces + 1))
    halves = np.array([conformal(np.abs(row[:-1]), confidence) for row in errors])
    inside = np.sum(np.abs(errors[:, -1]) <= halves)
    # The exact rate is between the confidence and 1 / (surfaces + 1) above it.
    assert binom.cdf(inside, trials, confidence) > 1e-4
    assert binom.sf(inside - 1, trials, confidence + 1 / (surfaces + 1)) > 1e-4
    assert binom.cdf(np.sum(np.abs(errors[:, -1]) <= halves / 2), trials, confidence) < 1e-4


def test_too_few_surfaces_give_no_interval():
    assert conformal(np.zeros(8), 0.9) == math.inf
    assert conformal(np.zeros(9), 0.9) == 0.0

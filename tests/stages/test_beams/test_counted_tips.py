"""Errors of the model at tips: the same in every case, and what counts of tips say about them, by drawn errors."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import log_ndtr, ndtr
from test_inference_stage import (
    DEVIATIONS,
    ENERGY,
    HUMIDITIES,
    POWER,
    SCATTER,
    STATED,
    as_computed,
    computed,
    counts,
    drawn_lengths,
    mean_lengths_alone,
    shapes,
)

from stiction.report.test_beams import tables
from stiction.stages.devices.opening import ARC
from stiction.stages.test_beams import inference

__all__ = ["mean_lengths_alone", "shapes"]
#: Drawn errors of inputs and model, and tips among the results.
DRAWS, TIPS = 250_000, slice(len(HUMIDITIES), None)
#: Effective numbers of draws: that of the update, and the least of the second route.
KEPT, FEWEST = 4096, 400


def without_errors_at_tips(monkeypatch):
    """The old rule, a control: tips take the model as exact."""
    monkeypatch.setattr(inference, "with_errors_of_cracks", lambda results, responses, own: responses)


def counted(lengths, stuck, of=20):
    return computed([], stuck=counts(lengths, stuck, of))


# The same before any measurement


@pytest.mark.usefixtures("shapes")
def test_what_is_known_without_test_beams_is_the_same_whatever_was_measured_or_counted():
    rng, before, computed_here = np.random.default_rng(1), [], np.array(as_computed())
    for _ in range(2):
        stuck, lengths = rng.integers(0, 21, 3), computed_here * rng.uniform(0.6, 1, 3)
        before += [counted(lengths, stuck), computed(computed_here * rng.uniform(0.8, 1.2, 3))]
    for found in before[1:]:
        for name in ("result_before", "result_of_inputs", "safe"):
            assert_allclose(found[name], before[0][name], rtol=1e-12)


# Counts of tips learn it


def drawn_posterior(lengths, stuck, of, errs=4 / 3):
    """Mean, standard deviation and quantiles at ±2 of ln l of tips of the device, and the effective number of draws.

    Drawn errors of all inputs and of the model are weighted with the binomial probability of the counts. Tips err
    ``errs`` times as much as cracks.
    """
    rng, energies = np.random.default_rng(7), np.array([ENERGY[rh] for rh in HUMIDITIES])
    powers, middle = np.array([POWER[rh] for rh in HUMIDITIES]), np.log(energies).mean()
    shared = DEVIATIONS["rms of B2"] * rng.normal(size=(DRAWS, 1)) * -powers / 4
    shared = shared + DEVIATIONS["Young's modulus"] * rng.normal(size=(DRAWS, 1)) / 4
    model = STATED.factor * rng.normal(size=(DRAWS, 1))
    model = model + STATED.slope * rng.normal(size=(DRAWS, 1)) * (middle - np.log(energies)) / 4

    def errors():
        """Errors of ln l of one owner, without the model and of it."""
        own = DEVIATIONS["thickness"] * rng.normal(size=(DRAWS, 1)) * 3 / 4
        own = own + DEVIATIONS["gap"] * rng.normal(size=(DRAWS, 1)) / 2
        return shared + own, model + STATED.rest * rng.normal(size=(DRAWS, len(HUMIDITIES)))

    of_array, of_model = errors()
    computed_here = np.log(as_computed())
    crack, tip = (
        (np.log(lengths) - computed_here - at) / SCATTER
        for at in (of_array + of_model, of_array + errs * of_model - np.log(2) / 2)
    )
    free = log_ndtr(-crack) + log_ndtr(-tip)
    likelihood = stuck * np.log(-np.expm1(free) + 1e-300) + (of - stuck) * free
    weights = np.exp(likelihood.sum(axis=1) - likelihood.sum(axis=1).max())
    weights /= weights.sum()
    of_inputs, of_cracks = errors()
    return summary(of_inputs + errs * of_cracks, weights), 1 / np.sum(weights**2)


def summary(values, weights):
    """Weighted mean, standard deviation and quantiles at ±2 (4, n)."""
    mean = weights @ values
    rows = [mean, np.sqrt(weights @ (values - mean) ** 2)]
    order = np.argsort(values, axis=0)
    for score in (-2, 2):
        at = [np.searchsorted(np.cumsum(weights[column]), ndtr(score)) for column in order.T]
        rows.append([values[column[k], n] for n, (column, k) in enumerate(zip(order.T, at, strict=True))])
    return np.array(rows)


#: Lengths of counted beams over those of tips as computed, and how many of 8 stick.
COUNTED = [((0.95, 1.1, 1.0), (1, 7, 4)), ((1.2, 1.2, 1.2), (1, 2, 4))]


@pytest.mark.parametrize(("ratios", "stuck"), COUNTED)
@pytest.mark.usefixtures("shapes")
def test_lengths_of_tips_after_counts_are_those_of_drawn_and_weighted_errors(ratios, stuck):
    lengths, stuck = np.array(as_computed()) / np.sqrt(2) * ratios, np.array(stuck)
    found = counted(lengths, stuck, 8).isel(result=TIPS)
    (mean, deviation, low, high), number = drawn_posterior(lengths, stuck, 8)
    assert number > FEWEST
    error = deviation * np.hypot(1 / np.sqrt(number), 1 / np.sqrt(KEPT))
    assert np.all(np.abs(found.result_shift - mean) < 4 * error)
    assert np.all(np.abs(found.result_after / deviation - 1) < 4 * error / deviation)
    for score, quantile in ((-2, low), (2, high)):  # a quantile at ±2 errs 2.8 times as much as a mean
        assert np.all(np.abs(found.result_quantile.sel(score=score) - quantile) < 4 * 2.8 * error)
    (_, exact, *_), _ = drawn_posterior(lengths, stuck, 8, errs=0)
    assert np.all(found.result_after > 1.2 * exact)  # control: tips without an error of the model


@pytest.mark.usefixtures("shapes")
def test_many_tips_that_stick_as_computed_narrow_the_lengths_that_tips_hold():
    tips = np.array(as_computed()) / np.sqrt(2)
    found = counted(tips, [40] * 3, 80).isel(result=TIPS)
    assert np.all(found.result_after < 0.75 * found.result_before)
    # No better than what the dimensions of the device and its own rest leave.
    own = np.hypot(DEVIATIONS["thickness"] * 3 / 4, DEVIATIONS["gap"] / 2)
    assert np.all(found.result_after > np.hypot(own, 4 / 3 * STATED.rest))


# Drawn truths


def intervals(repeats):
    """Shares of drawn lengths of tips in the interval of 95 %, below its quantile at -2, and of refused counts."""
    inside, below, refused = [], [], []
    for k in range(repeats):
        rng = np.random.default_rng(k)
        cracks, tips, truth = drawn_lengths(rng, 20)
        lengths = np.array(as_computed()) * rng.uniform(0.6, 0.9, 3)
        found = counted(lengths, (np.minimum(cracks, tips) < lengths).sum(axis=0)).isel(result=TIPS)
        assert np.all(found.response == ARC)
        off = np.log(truth[TIPS] / found.centre.values)
        low, high = (found.result_quantile.sel(score=score).values for score in (-2, 2))
        inside.append((low < off) & (off < high))
        below.append(off < low)
        refused.append(not tables.is_reliable(found))
    return np.mean(inside), np.mean(below), np.mean(refused)


@pytest.mark.nightly
@pytest.mark.usefixtures("shapes", "mean_lengths_alone")
def test_intervals_after_counts_of_tips_that_err_contain_the_drawn_lengths():
    inside, below, refused = intervals(150)
    # 4 standard errors of 150 draws, whose three humidities nearly agree.
    assert abs(inside - 0.954) <= 4 * np.sqrt(0.954 * 0.046 / 150)
    assert below <= 0.023 + 4 * np.sqrt(0.023 / 150)
    assert refused <= 0.05 + 4 * np.sqrt(0.05 / 150)


@pytest.mark.slow
@pytest.mark.usefixtures("shapes", "mean_lengths_alone")
def test_with_tips_that_take_the_model_as_exact_they_do_not(monkeypatch):
    without_errors_at_tips(monkeypatch)
    inside, below, refused = intervals(20)
    assert inside < 0.6
    assert below > 0.2
    assert refused > 0.2

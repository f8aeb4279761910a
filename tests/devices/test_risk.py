from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, scattered_laws
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtr, ndtri
from scipy.stats import binom

from stiction.beam.foundation import foundation_length
from stiction.beam.release import EndState, released_beam
from stiction.devices import arcs, risk
from stiction.devices.risk import Basis, LengthBounds
from stiction.devices.tail import fit_tail, scaled_errors
from stiction.streams import stream

SPREAD, MEDIAN = 0.025, 700e-6


def lognormal(rng, samples):
    return MEDIAN * np.exp(SPREAD * rng.standard_normal(samples))


def true_length(share):
    return MEDIAN * np.exp(SPREAD * ndtri(share))


# Shares and their bounds


def test_the_upper_bound_is_the_share_at_which_so_few_are_found_in_one_of_twenty_cases():
    bounds = risk.upper_bound(np.arange(6), 50)
    assert_allclose(binom.cdf(np.arange(6), 50, bounds), 0.05, rtol=1e-9)
    assert_allclose(risk.upper_bound(0, 50), 1 - 0.05 ** (1 / 50), rtol=1e-12)
    assert risk.upper_bound(50, 50) == 1


def test_bands_contain_the_true_share_as_often_as_they_say():
    rng, lengths = np.random.default_rng(1), true_length(np.array([0.02, 0.3, 0.9]))
    inside = []
    for _ in range(600):
        _, low, high = risk.stuck_share(lengths, lognormal(rng, 200))
        inside.append((low <= [0.02, 0.3, 0.9]) & (high >= [0.02, 0.3, 0.9]))
    coverage = np.mean(inside, axis=0)
    assert np.all(coverage > 0.95 - 4 * np.sqrt(0.95 * 0.05 / 600))  # at least, because shares are discrete
    assert np.all(coverage < 0.999)


def test_shares_are_those_of_shorter_sticking_lengths():
    share, low, high = risk.stuck_share(np.array([0.5, 1.0, 2.5, 9.0]), np.array([3.0, 1.0, 2.0, np.inf]))
    assert_array_equal(share, [0, 0, 0.5, 0.75])
    assert np.all((low <= share) & (share <= high))
    assert low[0] == 0


@pytest.mark.parametrize(("samples", "share"), [(299, 0.01), (473, 0.01), (1000, 0.02), (2500, 0.003), (200, 0.05)])
def test_the_sampled_bound_is_the_largest_order_statistic_that_so_many_devices_allow(samples, share):
    bound = risk.sampled_bound(np.arange(float(samples)), share)[0]
    # The k-th smallest value is below the quantile unless k values or fewer are: binomials by summation.
    assert binom.cdf(bound, samples, share) <= 0.05 < binom.cdf(bound + 1, samples, share)


@pytest.mark.parametrize("share", [0.3, 0.05, 0.01, 0.0123, 1e-3])
def test_one_sample_fewer_does_not_bound_a_share(share):
    samples = risk.samples_for(share)
    assert binom.pmf(0, samples, share) <= 0.05 < binom.pmf(0, samples - 1, share)
    with pytest.raises(ValueError, match=f"needs {samples} samples, got {samples - 1}"):
        risk.sampled_bound(np.arange(float(samples - 1)), share)
    assert risk.sampled_bound(np.arange(float(samples)), share)[0] == 0


def test_both_ends_of_a_band_leave_one_of_forty_cases():
    sticking, stuck = np.arange(60.0), np.arange(1, 60)
    share, low, high = risk.stuck_share(stuck - 0.5, sticking)
    assert_allclose(share, stuck / 60)
    assert_allclose(binom.sf(stuck - 1, 60, low), 0.025, rtol=1e-9)
    assert_allclose(binom.cdf(stuck, 60, high), 0.025, rtol=1e-9)


def test_a_fitted_bound_is_exceeded_by_the_estimate_of_one_of_twenty_simulated_studies():
    sticking = lognormal(np.random.default_rng(9), 500)
    found = risk.safe_length(sticking, 1e-3, stream(0))
    errors, pivots = scaled_errors(500, 1e-3, stream(0))
    slope = fit_tail(sticking).slope
    above = pivots * slope > np.log(found.estimate / found.length)
    assert_allclose(np.mean(above), 0.05, atol=1 / len(pivots))
    assert_allclose(found.error, found.estimate * slope * np.std(errors))


def test_wilks_smallest_of_so_many_bounds_the_length():
    for share, samples in ((1e-2, 299), (1e-3, 2995), (1e-4, 29956)):
        assert risk.samples_for(share) == samples
        assert 1 - (1 - share) ** samples >= 0.95 > 1 - (1 - share) ** (samples - 1)


def test_the_smallest_of_299_is_the_safe_length_for_one_percent():
    sticking = lognormal(np.random.default_rng(2), 299)
    assert risk.safe_length(sticking, 0.01, stream(0)).length == sticking.min()


# Safe lengths


@pytest.mark.parametrize(
    ("samples", "share", "basis"),
    [
        (1000, 1e-2, Basis.SAMPLED),
        (1000, 1e-3, Basis.FITTED),
        (1000, 1e-4, Basis.FITTED),
        (1000, 1e-5, Basis.EXTRAPOLATED),
        (500, 1e-4, Basis.EXTRAPOLATED),
        (10_000, 1e-3, Basis.SAMPLED),
        (10_000, 1e-5, Basis.EXTRAPOLATED),
    ],
)
def test_a_safe_length_states_what_it_rests_on(samples, share, basis):
    assert risk.safe_length(lognormal(np.random.default_rng(3), samples), share, stream(0)).basis is basis


@pytest.mark.parametrize(
    ("samples", "share"),
    [(600, 1e-2), (600, 1e-3), pytest.param(600, 1e-4, marks=pytest.mark.slow), (3000, 1e-3)],
)
def test_safe_lengths_are_safe_in_95_of_100_studies(samples, share):
    rng, repeats = np.random.default_rng(4), 400
    found = [risk.safe_length(lognormal(rng, samples), share, rng) for _ in range(repeats)]
    coverage = np.mean([safe.length <= true_length(share) for safe in found])
    error = np.sqrt(0.95 * 0.05 / repeats)
    assert coverage > 0.95 - 3 * error
    if found[0].basis is not Basis.SAMPLED:  # order statistics are discrete, and cover more
        assert coverage < 0.95 + 3 * error
    assert np.mean([safe.estimate <= true_length(share) for safe in found]) < 0.7  # control: estimates are not bounds


@pytest.mark.parametrize(("samples", "share"), [(600, 1e-2), (600, 1e-3)])
def test_standard_errors_are_the_scatter_of_repeated_studies(samples, share):
    rng, repeats = np.random.default_rng(5), 400
    found = [risk.safe_length(lognormal(rng, samples), share, rng) for _ in range(repeats)]
    scatter = np.std([safe.estimate for safe in found])
    # The standard error of a quantile from its neighbours is itself uncertain, and biased by a tenth.
    assert_allclose(np.mean([safe.error for safe in found]), scatter, rtol=0.1 + 3 / np.sqrt(2 * repeats))
    assert (
        abs(np.mean([safe.estimate for safe in found]) - true_length(share))
        < 4 * scatter / np.sqrt(repeats) + 0.1 * scatter
    )


def test_the_sampled_estimate_is_the_quantile_of_evenly_spaced_lengths():
    # Steps at i/n, between which the weights of Harrell and Davis have the mean p: 1000 p + 1/2 on average.
    found = risk.safe_length(np.arange(1.0, 1001.0), 0.02, stream(0))
    assert_allclose(found.estimate, 20.5, atol=0.02)
    assert_allclose(found.error, np.sqrt(1000 * 0.02 * 0.98), rtol=0.01)  # binomial


def test_the_larger_the_share_the_longer_the_beam_and_the_bound_is_below_the_estimate():
    sticking = lognormal(np.random.default_rng(6), 2000)
    found = [risk.safe_length(sticking, share, stream(1)) for share in (1e-4, 1e-3, 1e-2, 4e-2)]
    assert np.all(np.diff([safe.length for safe in found]) > 0)
    assert all(safe.length < safe.estimate for safe in found)


@pytest.mark.parametrize("share", [0.0, 0.051, np.nan])
def test_shares_outside_of_the_fit_are_refused(share):
    with pytest.raises(ValueError, match=str(share)):
        risk.safe_length(lognormal(np.random.default_rng(7), 400), share, stream(0))


def test_beams_that_do_not_end_s_shaped_stick_at_no_known_length():
    sticking = risk.sticking_lengths(np.array([1.0, 2.0]), np.array([True, False]), 0.1)
    assert_array_equal(sticking, [1.2, np.inf])


def test_a_beam_sticks_in_the_shape_that_sticks_at_the_shorter_length():
    tips = arcs.arc_length(np.array([1e-3, 50e-3]), PAPER)
    sticking = risk.with_arcs(np.array([700e-6, 700e-6]), tips)
    assert_array_equal(sticking, [700e-6, tips[1]])


# The end of the distribution of beams


@pytest.mark.slow
def test_the_fit_of_few_beams_is_the_brute_force_of_many():
    # 10 000 beams: the 10th shortest bounds 1e-3. Fits of ten times 1000 beams must agree with it.
    cracks = []
    for k in range(10_000):
        laws = scattered_laws(stream(6, "tail", k), 1000, 0.24)
        cracks.append(released(laws, 1000)[1])
    cracks = np.array(cracks)
    whole = risk.safe_length(cracks, 1e-3, stream(0))
    parts = [risk.safe_length(part, 1e-3, stream(0)) for part in cracks.reshape(10, -1)]
    assert {part.basis for part in parts} == {Basis.FITTED}
    estimates = np.array([part.estimate for part in parts])
    error = np.hypot(whole.error, estimates.std(ddof=1) / np.sqrt(10))
    assert abs(estimates.mean() - whole.estimate) < 4 * error
    assert abs(np.quantile(cracks, 1e-2) - whole.estimate) > 4 * error  # control
    assert_allclose(estimates.std(ddof=1), np.mean([part.error for part in parts]), rtol=3 / np.sqrt(18))


# Long beams and beams that are cut


def released(laws, points):
    """End state and crack length of the beam cut to some points of its ground."""
    beam = replace(PAPER, length=points * 1.5e-6, elements=points // 5)
    end = released_beam(beam, laws[:points])
    return end.state is EndState.S_SHAPE, end.crack_length


@pytest.mark.slow
def test_one_monte_carlo_of_long_beams_answers_all_lengths():
    n, grounds = 240, [scattered_laws(stream(5, "cut", k), 1000, 0.3) for k in range(240)]
    s_shaped, cracks = np.transpose([released(laws, 1000) for laws in grounds])
    sticking = risk.sticking_lengths(cracks, s_shaped == 1, foundation_length(PAPER, np.concatenate(grounds)))
    predicted, neglected, found = [], [], []
    for share in (0.05, 0.5, 0.95):
        points = 5 * round(np.quantile(sticking, share) / 7.5e-6)
        predicted.append(risk.stuck_share(np.array([points * 1.5e-6]), sticking)[0][0])
        neglected.append(np.mean(cracks < points * 1.5e-6))
        found.append(np.mean([released(laws, points)[0] for laws in grounds]))
    error = np.sqrt(np.multiply(predicted, 1 - np.array(predicted)) / n)
    assert np.all(np.abs(np.subtract(found, predicted)) < 3 * error)
    assert neglected[1] - found[1] > 3 * error[1]  # control: without the hold of 2 l_f the shares differ


@pytest.mark.parametrize("medians", [(1, 1, 1), (1, 1.02, 1.5)])
def test_the_least_of_several_safe_lengths_is_safe_in_all_airs_with_its_confidence_but_not_each_in_its_own(medians):
    # It is unsafe in one of them only if that of the worst air is; every one of n is safe with 1 - 0.05 n alone.
    share, trials, rng = 0.01, 1000, np.random.default_rng(2)
    lengths = np.array(medians)[:, None, None] * lognormal(rng, (len(medians), trials, 299))
    safe = np.array([[risk.sampled_bound(one, share)[0] for one in of_air] for of_air in lengths])
    true = true_length(share) * np.array(medians)[:, None]
    scatter = np.sqrt(0.05 * 0.95 / trials)
    assert np.mean(safe.min(axis=0) > true.min()) < 0.05 + 3 * scatter
    each = np.mean((safe > true).any(axis=0))
    assert each > 0.05 + 10 * scatter  # control
    assert each < 0.15 + 3 * scatter


# Few devices stick


def drawn_until(reach, samples, rng):
    """Lognormal sticking lengths, infinite beyond a reach [m]."""
    lengths = lognormal(rng, samples)
    return np.where(lengths < reach, lengths, np.inf)


@pytest.mark.parametrize(
    ("samples", "stuck"),
    [(200, 1), (200, 4), (200, 9), *(pytest.param(1000, k, marks=pytest.mark.slow) for k in (6, 12, 30))],
)
@pytest.mark.parametrize("share", [0.02, 1e-3])
def test_safe_lengths_hold_in_95_of_100_studies_however_few_devices_stick(samples, stuck, share):
    rng, repeats, reach = np.random.default_rng(stuck), 400, true_length(stuck / samples)
    flat = true_length(1e-9)
    found = [
        risk.safe_length(drawn_until(reach, samples, rng), share, rng, LengthBounds(reach, flat))
        for _ in range(repeats)
    ]
    lengths = np.array([one.length for one in found])
    safe = np.mean(lengths <= true_length(share))
    assert safe > 0.95 - 4 * np.sqrt(0.95 * 0.05 / repeats)
    assert np.all(lengths <= reach)
    beyond = np.array([one.basis is Basis.LONGEST for one in found])
    assert np.all(np.isinf([one.estimate for one in found])[beyond])
    # Control: a line through so few lengths, without its errors, is too long in half of the studies.
    naive = [one.estimate for one in found if one.basis in (Basis.FITTED, Basis.EXTRAPOLATED)]
    assert len(naive) < 50 or np.mean(np.array(naive) <= true_length(share)) < 0.8


def test_where_none_sticks_the_longest_simulated_length_is_safe_as_far_as_so_many_devices_say():
    never, known = np.full(1000, np.inf), LengthBounds(reach=3e-3, flat=1e-4)
    found = [risk.safe_length(never, share, stream(0), known) for share in (0.01, 1e-3)]
    assert [(one.length, one.basis) for one in found] == [(3e-3, Basis.LONGEST), (1e-4, Basis.FLAT)]
    assert_allclose(risk.most_stuck(never, 3e-3), 1 - 0.05 ** (1 / 1000), rtol=1e-12)


def test_the_bound_of_stuck_devices_covers_the_true_share_in_95_of_100_studies():
    rng, repeats, reach = np.random.default_rng(8), 2000, true_length(0.02)
    most = np.array([risk.most_stuck(drawn_until(reach, 200, rng), reach) for _ in range(repeats)])
    assert np.mean(most >= 0.02) > 0.95 - 4 * np.sqrt(0.95 * 0.05 / repeats)
    assert np.mean(most / 2 >= 0.02) < 0.95 - 4 * np.sqrt(0.95 * 0.05 / repeats)  # control


def test_tips_that_hold_longer_beams_than_were_simulated_do_not_prolong_a_safe_length():
    # Cracks of 1 mm are beyond the simulated 0.8 mm, and tips hold 2 mm at least: only flat surfaces bound the cracks.
    tips = 2e-3 * np.exp(np.abs(np.random.default_rng(1).standard_normal(400)))
    found = risk.safe_length(tips, 1e-3, stream(0), LengthBounds(reach=0.8e-3, flat=1e-4))
    assert (found.length, found.basis) == (1e-4, Basis.FLAT)
    strong = risk.safe_length(tips / 100, 1e-3, stream(0), LengthBounds(reach=0.8e-3, flat=1e-4))
    alone = risk.safe_length(tips / 100, 1e-3, stream(0))
    assert repr(strong) == repr(alone)  # an unknown error is NaN, which differs from itself


def test_devices_that_did_not_stick_may_do_so_beyond_the_simulated_length():
    share, low, high = risk.stuck_share(np.array([0.5, 2.0]), np.array([0.3, np.inf, np.inf]), reach=1.0)
    assert_array_equal(share, [1 / 3, 1 / 3])
    assert low[0] == low[1]
    assert high[0] < high[1] == 1


def test_quantiles_are_those_of_the_distribution_as_far_as_the_samples_and_their_reach_show():
    rng, samples, shares = np.random.default_rng(11), 100_000, ndtr(risk.SCORES)
    found = risk.quantiles(np.exp(0.1 * rng.normal(size=samples)))
    errors = np.sqrt(shares * (1 - shares) / samples) * np.sqrt(2 * np.pi) * np.exp(risk.SCORES**2 / 2)
    assert np.all(abs(np.log(found) / 0.1 - risk.SCORES) < 4 * errors)
    few = risk.quantiles(rng.random(20))
    assert np.isfinite(few).sum() == np.sum(abs(risk.SCORES) < 1.96)
    cut = risk.quantiles(rng.random(10_000), reach=0.5)
    assert np.isnan(cut[risk.SCORES > 0.05]).all()
    assert_allclose(cut[risk.SCORES < -0.05], ndtr(risk.SCORES[risk.SCORES < -0.05]), atol=0.02)


@pytest.mark.parametrize("fraction", [0.1, 0.5, 0.9])
def test_as_many_samples_are_below_a_quantile_as_it_says(fraction):
    values = np.random.default_rng(2).normal(size=400)
    score = risk.SCORES[np.argmin(abs(ndtr(risk.SCORES) - fraction))]
    quantile = risk.quantiles(values)[risk.SCORES.searchsorted(score)]
    assert np.mean(values < quantile) == pytest.approx(ndtr(score), abs=1 / 400)

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import ks_2samp, kstest, kstwobign, norm
from standard_errors import ALLOWED

from stiction.analysis import convergence
from stiction.chaos.density import silverman_bandwidth
from stiction.streams import stream


def test_kolmogorovs_constants_are_those_of_his_distribution():
    assert_allclose(convergence.KOLMOGOROV_MEAN, kstwobign.mean(), rtol=1e-9)
    assert_allclose(convergence.KOLMOGOROV_DEVIATION, kstwobign.std(), rtol=1e-6)


def test_distances_are_the_statistics_of_scipy():
    one, other = stream(1).standard_normal(500), stream(2).standard_normal(700)
    assert_allclose(convergence.distance_to(one, norm.cdf), kstest(one, "norm").statistic, rtol=1e-12)
    assert_allclose(convergence.distance_between(one, other), ks_2samp(one, other).statistic, rtol=1e-12)


@pytest.mark.parametrize("sample", [0.1, 0.9])
def test_a_single_sample_is_as_far_off_as_the_longer_side_of_its_step(sample):
    assert_allclose(convergence.distance_to(np.array([sample]), lambda x: x), 0.9)


def test_distance_of_samples_from_their_distribution_is_as_expected_and_that_of_others_larger():
    n, repeats = 400, 300
    found = [convergence.distance_to(stream(3, k).standard_normal(n), norm.cdf) for k in range(repeats)]
    error = convergence.KOLMOGOROV_DEVIATION / np.sqrt(n * repeats)
    # For n samples the mean of √n D is below its limit by about 1/(6 √n).
    assert abs(np.mean(found) - convergence.sampling_distance(n)) < ALLOWED * error + 1 / (6 * n)
    shifted = [convergence.distance_to(0.2 + stream(3, k).standard_normal(n), norm.cdf) for k in range(repeats)]
    assert np.mean(shifted) > 1.5 * convergence.sampling_distance(n)


def test_parts_of_independent_samples_follow_kolmogorovs_law_and_those_of_a_drifting_series_do_not():
    samples = stream(4).standard_normal(6000)
    for size in (100, 500, 1500):
        distance, error = convergence.distance_of_parts(samples, size)
        expected = convergence.KOLMOGOROV_MEAN * np.sqrt(1 / size - 1 / 6000)
        assert abs(distance - expected) < ALLOWED * error + 1 / (6 * size)
        drifting, _ = convergence.distance_of_parts(np.sort(samples), size)
        assert drifting > 5 * expected
    assert convergence.distance_of_parts(samples, 6000) == (0.0, 0.0)


@pytest.mark.parametrize("parts", [2, 3, 10])
def test_the_standard_error_of_a_distance_is_the_scatter_of_repeated_studies(parts):
    studies = [convergence.distance_of_parts(stream(7, k).standard_normal(2000), 2000 // parts) for k in range(600)]
    distances, errors = np.transpose(studies)
    # The limit distribution is a little wider than that of 200 samples.
    assert distances.std(ddof=1) == pytest.approx(errors[0], rel=ALLOWED / np.sqrt(2 * 599) + 0.05)


def test_more_samples_than_there_are_cannot_be_compared():
    with pytest.raises(ValueError, match="10 samples have no part of 11"):
        convergence.distance_of_parts(np.arange(10.0), 11)


def test_kernels_widen_a_normal_sample_by_their_width():
    centres = stream(5).standard_normal(20_000)
    smooth = convergence.kernel_distribution(centres, 0.5)
    at = np.linspace(-3, 3, 13)
    # The sampling error of 20 000 centres.
    assert_allclose(smooth(at), norm.cdf(at / np.hypot(1, 0.5)), atol=ALLOWED * 0.5 / np.sqrt(20_000))


def test_kernel_estimates_of_a_density_contain_all_samples_and_follow_their_unit():
    samples, at = stream(6).standard_normal(40_000), np.linspace(-6, 6, 241)
    density = convergence.kernel_estimate(samples, at)
    assert_allclose(np.trapezoid(density, at), 1, atol=1e-6)
    assert_allclose(convergence.kernel_estimate(1e-3 * samples, 1e-3 * at), 1e3 * density, rtol=1e-9)
    width = silverman_bandwidth(40_000, 1)
    expected = norm.pdf(at / np.hypot(1, width)) / np.hypot(1, width)
    error = np.sqrt(expected.max() / (2 * np.sqrt(np.pi) * 40_000 * width))
    assert_allclose(density, expected, atol=ALLOWED * error)


def test_an_order_has_converged_when_no_higher_one_is_worse_than_the_samples():
    far, near = 2 * convergence.sampling_distance(100), 0.5 * convergence.sampling_distance(100)
    assert convergence.converged_order([2, 4, 8], [far, near, near], 100, 10_000) == 4
    assert convergence.converged_order([2, 4, 8], [near, far, near], 100, 10_000) == 8
    assert convergence.converged_order([2, 4, 8], [near, near, near], 100, 10_000) == 2
    assert convergence.converged_order([2, 4, 8], [near, near, far], 100, 10_000) == 0


def test_few_draws_from_the_target_itself_are_no_reason_to_reject_an_order():
    samples, draws = 5000, 2000
    distances = [convergence.distance_to(stream(8, k).standard_normal(draws), norm.cdf) for k in range(200)]
    mean = np.mean(distances)
    assert mean > convergence.sampling_distance(samples)
    assert convergence.converged_order([1], [mean], samples, draws) == 1

import numpy as np
import pytest

from stiction.estimates import jackknife, mean_on_shared_samples, mean_with_error


def test_jackknife_of_a_mean_is_the_textbook_standard_error():
    samples = np.random.default_rng(1).exponential(size=(50, 1))
    value, error = jackknife(lambda mean: mean[0], samples)
    mean, expected = mean_with_error(samples[:, 0])
    np.testing.assert_allclose([value, error], [mean, expected], rtol=1e-12)


def test_jackknife_error_covers_the_scatter_of_a_ratio():
    rng = np.random.default_rng(2)

    def experiment():
        samples = np.column_stack([rng.normal(3, 1, 200), rng.normal(5, 1, 200)])
        return jackknife(lambda mean: mean[0] / mean[1], samples)

    values, errors = np.transpose([experiment() for _ in range(200)])
    # The standard deviation of 200 values is known to 5 %.
    np.testing.assert_allclose(errors.mean(), values.std(ddof=1), rtol=0.2)


@pytest.mark.parametrize("power", [1, -0.25])
def test_errors_of_own_and_of_shared_samples_together_cover_the_scatter(power):
    rng = np.random.default_rng(3)

    def experiment():
        shared = rng.normal(10, 2, 100)
        values = shared.mean() ** power * rng.normal(1, 0.2 * abs(power), 100)
        return mean_on_shared_samples(values, shared, power)

    values, own, common = np.transpose([experiment() for _ in range(400)])
    scatter, allowed = values.std(ddof=1), 4 / np.sqrt(2 * 399)
    assert abs(np.hypot(own, common).mean() / scatter - 1) < allowed
    assert max(own.mean(), common.mean()) / scatter < 1 - allowed


@pytest.mark.parametrize("estimate", [mean_with_error, lambda x: jackknife(lambda mean: mean, x)])
def test_one_sample_has_no_standard_error(estimate):
    with pytest.raises(ValueError, match="two samples, got 1"):
        estimate(np.ones((1, 1)))

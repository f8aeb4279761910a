"""Rank of a measured pull-off force: against normal forces, whose answer is a closed form."""

import numpy as np
import pytest
from scipy.stats import beta, norm

from stiction.devices import probes

EXACT = np.zeros(1)


@pytest.mark.parametrize("measured", [0.6, 1.0, 1.5])
def test_errors_of_the_measurement_add_to_the_scatter_by_their_squares(measured):
    forces = norm.ppf((np.arange(4000) + 0.5) / 4000, 1.0, 0.15)
    for error in (0.0, 0.1, 0.3):
        expected = norm.cdf(measured, 1.0, np.hypot(0.15, error))
        assert probes.shares_below(forces, EXACT, measured, error)[0] == pytest.approx(expected, abs=2e-3)


def test_errors_of_the_inputs_move_the_logarithm_of_all_forces():
    shifts = norm.ppf((np.arange(4000) + 0.5) / 4000)
    for error in (0.1, 0.3, 1.0):
        found = probes.shares_below(np.ones(1), error * shifts, 1.5)
        assert set(found) <= {0.0, 1.0}
        assert found.mean() == pytest.approx(norm.cdf(np.log(1.5), scale=error), abs=1e-3)


def test_equal_forces_are_on_both_sides():
    assert probes.shares_below(np.array([1.0, 2.0, 2.0, 3.0]), EXACT, 2.0) == pytest.approx(0.5)


def test_a_fraction_of_places_has_the_error_of_their_number():
    for count, places in ((0, 100), (3, 100), (50, 100), (100, 100)):
        low, high = (float(probes.counted(count / places, places, score)) for score in norm.ppf([0.025, 0.975]))
        jeffreys = beta(count + 0.5, places - count + 0.5)
        assert low == (0 if count == 0 else pytest.approx(jeffreys.ppf(0.025)))
        assert high == (1 if count == places else pytest.approx(jeffreys.ppf(0.975)))
    assert probes.counted(np.array([0.0, 1.0]), 10, np.array([0.5, -0.5])) == pytest.approx(
        [beta(0.5, 10.5).ppf(norm.cdf(0.5)), beta(10.5, 0.5).ppf(norm.cdf(-0.5))]
    )


def test_both_sides_count_alike():
    assert probes.two_sided(np.array([0.0, 0.01, 0.5, 0.98])) == pytest.approx([0.0, 0.02, 1.0, 0.04])


def test_bands_of_quantiles_contain_them_as_often_as_they_say():
    """Bands of sets of 100 normal forces; half the scores fail."""
    rng, scores = np.random.default_rng(5), np.linspace(-1.96, 1.96, 2)
    for share in (0.05, 0.5, 0.95):
        true, inside, narrow = norm.ppf(share, 10, 1), 0, 0
        for _ in range(400):
            forces = rng.normal(10, 1, 100)
            low, high = probes.quantile(forces, share, np.zeros(2), scores)
            inside += low <= true <= high
            low, high = probes.quantile(forces, share, np.zeros(2), scores / 2)
            narrow += low <= true <= high
        assert abs(inside - 380) < 4 * np.sqrt(400 * 0.95 * 0.05)
        assert abs(narrow - 380) > 4 * np.sqrt(400 * 0.95 * 0.05)
    assert probes.quantile(np.arange(1.0, 4.0), 0.5, np.log([1.0, 2.0]), np.zeros(2)) == pytest.approx([2.0, 1.0])

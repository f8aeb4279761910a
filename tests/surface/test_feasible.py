import numpy as np
import pytest
from published import SURFACES
from scipy.stats import kurtosis as kurtosis_of
from scipy.stats import skew

from stiction.streams import stream
from stiction.surface import feasible, maxent
from stiction.surface.feasible import (
    LARGEST_DISTANCE,
    LARGEST_DISTANCE_OF_SCANS,
    is_feasible,
    largest_kurtosis,
    nearest_feasible,
)

#: |skewness| and the largest kurtosis, found by hand with solutions on a grid of moments.
BORDER = {0: 3.000, 0.05: 3.006, 0.1: 3.026, 0.2: 3.107, 0.3: 3.242, 0.4: 3.454, 0.5: 3.804, 0.6: 4.362, 1.0: 7.78}
#: Measured moments of nearly Gaussian surfaces, all of them infeasible.
NEARLY_GAUSSIAN = [(-0.1, 3.05), (0.05, 3.02), (-0.3, 3.5), (-0.5, 4.0), (1e-9, 3.0)]


@pytest.mark.parametrize(("skewness", "kurtosis"), BORDER.items())
def test_largest_kurtosis_is_that_found_on_a_grid(skewness, kurtosis):
    for sign in (-1, 1):
        assert largest_kurtosis(sign * skewness) == pytest.approx(kurtosis, abs=0.002)
    assert is_feasible(skewness, largest_kurtosis(skewness))
    assert not is_feasible(skewness, largest_kurtosis(skewness) + 2e-5)


@pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)
def test_published_moments_stay_as_they_are(surface):
    assert nearest_feasible(surface.skewness, surface.kurtosis) == (surface.skewness, surface.kurtosis, 0.0)


def test_moments_of_a_gaussian_stay_as_they_are():
    assert nearest_feasible(0.0, 3.0) == (0.0, 3.0, 0.0)


def distance_to_border(skewness, measured, covariance):
    """Distance from measured moments to the largest kurtosis at a skewness [standard errors]."""
    off = np.subtract((skewness, largest_kurtosis(float(skewness))), measured)
    return np.sqrt(off @ np.linalg.solve(covariance, off))


@pytest.mark.parametrize(
    ("skewness", "kurtosis"),
    [pytest.param(*row, marks=[pytest.mark.slow] * (row[0] != -0.1)) for row in NEARLY_GAUSSIAN],
)
def test_no_point_of_the_border_is_nearer(skewness, kurtosis):
    found = nearest_feasible(skewness, kurtosis)
    assert is_feasible(found.skewness, found.kurtosis)
    errors = np.sqrt([6 / feasible.SAMPLE, 24 / feasible.SAMPLE])
    off = np.subtract(found[:2], (skewness, kurtosis)) / errors
    assert 0 < found.distance == pytest.approx(np.linalg.norm(off), rel=1e-9)
    for trial in skewness + np.linspace(-2.4, 2.4, 13) * errors[0]:
        border = distance_to_border(trial, (skewness, kurtosis), np.diag(errors**2))
        assert border >= found.distance - 1e-4


@pytest.mark.parametrize(
    ("skewness", "kurtosis"),
    [(0.05, 3.6), (0.0, 4.6), (-0.2, 4.0)],
)
@pytest.mark.parametrize("correlation", [-0.8, 0.0, 0.8])
@pytest.mark.slow
def test_without_a_limit_the_nearest_moments_are_found_at_any_distance_on_either_side(skewness, kurtosis, correlation):
    errors = np.array([0.06, 0.12])
    covariance = np.outer(errors, errors) * [[1, correlation], [correlation, 1]]
    found = nearest_feasible(skewness, kurtosis, covariance, np.inf)
    assert found.distance > LARGEST_DISTANCE
    trials = skewness + np.linspace(-0.9, 0.9, 37)
    assert min(distance_to_border(t, (skewness, kurtosis), covariance) for t in trials) >= found.distance - 1e-3


def test_large_errors_lead_to_near_moments():
    # Moments below the lower bound of the kurtosis are within these errors as well.
    found = nearest_feasible(0.05, 3.3, np.diag([0.2, 0.7]) ** 2, LARGEST_DISTANCE_OF_SCANS)
    assert found.distance < 0.5


def test_mirrored_moments_have_mirrored_neighbours():
    left, right = nearest_feasible(-0.1, 3.05), nearest_feasible(0.1, 3.05)
    np.testing.assert_allclose(right, np.multiply(left, (-1, 1, 1)), atol=1e-3)


@pytest.mark.slow
def test_distance_is_in_the_errors_of_the_measurement():
    exact_kurtosis = nearest_feasible(-0.3, 3.3, np.diag([0.05, 1e-3]) ** 2)
    exact_skewness = nearest_feasible(-0.3, 3.3, np.diag([1e-3, 0.05]) ** 2)
    assert exact_kurtosis.kurtosis == pytest.approx(3.3, abs=0.005)
    assert exact_skewness.skewness == pytest.approx(-0.3, abs=0.005)
    assert exact_skewness.distance == pytest.approx((3.3 - largest_kurtosis(-0.3)) / 0.05, rel=0.01)


@pytest.mark.slow
def test_correlated_errors_move_both_moments_alike():
    # If skewness and kurtosis err in opposite directions, the way to more skewness and less kurtosis is short.
    apart = np.array([[1, -0.9], [-0.9, 1]]) * 0.05**2
    along = np.array([[1, 0.9], [0.9, 1]]) * 0.05**2
    assert nearest_feasible(0.3, 3.35, along).distance > 2 * nearest_feasible(0.3, 3.35, apart).distance


def test_default_errors_are_those_of_independent_gaussian_heights():
    heights = stream(1, "feasible").standard_normal((4000, 500))
    moments = np.stack([skew(heights, axis=1), kurtosis_of(heights, axis=1)])
    # Terms of the next order are 4 % at 500 heights; 4 standard errors of 4000 variances are 9 %.
    np.testing.assert_allclose(np.diag(np.cov(moments)), np.diag(feasible.sampling_covariance(500)), rtol=0.13)


@pytest.mark.slow
def test_measured_gaussian_surfaces_are_feasible_within_their_error_and_not_within_a_tenth_of_it():
    heights = stream(2, "feasible").standard_normal((8, feasible.SAMPLE))
    measured = np.column_stack([skew(heights, axis=1), kurtosis_of(heights, axis=1) + 3])
    beyond = [moments for moments in measured if not is_feasible(*map(float, moments))]
    assert 2 <= len(beyond) <= 6  # every other one
    distances = [nearest_feasible(*map(float, moments)).distance for moments in beyond]
    assert max(distances) <= LARGEST_DISTANCE
    farthest = beyond[int(np.argmax(distances))]
    with pytest.raises(ValueError, match="standard errors"):
        nearest_feasible(*map(float, farthest), feasible.sampling_covariance(100 * feasible.SAMPLE))


@pytest.mark.parametrize(("skewness", "kurtosis"), [(0.0, 4.6), (-0.1, 3.5), (-1.0, 10.0)])
def test_distant_moments_are_refused_with_the_largest_kurtosis(skewness, kurtosis):
    largest = f"{largest_kurtosis(skewness):.4g}"
    with pytest.raises(ValueError, match=f"within 2.45 standard errors .* the largest kurtosis is {largest}"):
        nearest_feasible(skewness, kurtosis)


@pytest.mark.parametrize(("largest", "likely"), [(LARGEST_DISTANCE, 0.05), (LARGEST_DISTANCE_OF_SCANS, 0.001)])
def test_the_largest_distance_is_that_of_one_measurement_in_twenty_and_of_one_scan_in_a_thousand(largest, likely):
    drawn = stream(3, "feasible").standard_normal((100_000, 2))
    share = np.mean(np.linalg.norm(drawn, axis=1) > largest)
    assert share == pytest.approx(likely, abs=4 * np.sqrt(likely * (1 - likely) / 1e5))


@pytest.mark.parametrize("kurtosis", [3.3, pytest.param(3.4, marks=pytest.mark.slow)])
def test_the_limit_decides_what_is_too_far(kurtosis):
    covariance = feasible.sampling_covariance(feasible.SAMPLE)
    distance = nearest_feasible(0.0, kurtosis, covariance, np.inf).distance
    assert LARGEST_DISTANCE < distance < LARGEST_DISTANCE_OF_SCANS
    assert nearest_feasible(0.0, kurtosis, covariance, LARGEST_DISTANCE_OF_SCANS).distance == distance
    with pytest.raises(ValueError, match="within 2.45 standard errors"):
        nearest_feasible(0.0, kurtosis, covariance)


def test_moments_that_no_density_has_are_never_replaced():
    with pytest.raises(ValueError, match="need kurtosis > skewness² "):
        nearest_feasible(-0.76, 1.5)


def test_tails_that_do_not_cover_all_scores_are_infeasible():
    assert maxent.solve(-0.5, 4.07)
    assert not is_feasible(-0.5, 4.07)

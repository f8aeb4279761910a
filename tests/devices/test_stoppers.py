import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtri
from standard_errors import ALLOWED, errors_off

from stiction.contact import forcelaw
from stiction.contact.meniscus import laplace_pressure, meniscus_height
from stiction.devices import stoppers
from stiction.devices.risk import Basis


def safe_force(forces, share):
    """Safe force of one row: force, estimate, error and basis."""
    (found,) = stoppers.safe_forces(forces[None], share, np.random.default_rng(0))
    return found.force, found.estimate, found.error, found.basis


def test_the_pull_off_force_is_the_largest_attraction_over_the_patch():
    # The largest attraction of a law, by brute force over the distance.
    law = forcelaw.coefficients(np.array([[7e-3, 2e6, 8e-9, 6.5e-9]]), 3e6)[0]
    pull = -9e-12 * forcelaw.pressure(law, np.linspace(5e-9, 20e-9, 100_001)).min()
    assert_allclose(stoppers.pull_off_force(law[0], 9e-12), pull, rtol=1e-8)


def test_a_patch_sticks_if_it_holds_more_than_the_restoring_force():
    share, low, high = stoppers.stuck_patches(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.5, 2.0, 3.5, 9.0]))
    assert_array_equal(share, [1.0, 0.5, 0.25, 0.0])
    assert np.all((low <= share) & (share <= high))


def test_bands_of_patches_contain_the_true_share():
    rng, force = np.random.default_rng(0), np.array([1.0])
    inside = [
        (lambda band: band[1][0] <= np.exp(-1) <= band[2][0])(stoppers.stuck_patches(rng.exponential(size=100), force))
        for _ in range(600)
    ]
    assert np.mean(inside) > 0.95 - 4 * np.sqrt(0.95 * 0.05 / 600)


def test_patches_twice_as_large_in_area_hold_twice_the_force():
    f_max = np.random.default_rng(1).lognormal(size=50)
    one = stoppers.stuck_patches(stoppers.pull_off_force(f_max, 1.0), np.array([1.0, 2.0]))
    two = stoppers.stuck_patches(stoppers.pull_off_force(f_max, 2.0), np.array([2.0, 4.0]))
    assert_array_equal(one, two)


def test_the_peak_of_a_parabola_is_found_between_points():
    x = np.array([0.3, 0.5, 0.6, 0.85, 0.9])
    for top in (0.51, 0.6, 0.7):
        assert_allclose(stoppers.peak(x, 3 - 7 * (x - top) ** 2), top, rtol=1e-12)


@pytest.mark.parametrize("sign", [1, -1])
def test_without_a_peak_the_worst_humidity_is_an_end_of_the_axis(sign):
    x = np.linspace(0.3, 0.9, 7)
    assert stoppers.peak(x, sign * x) == x[-1 if sign > 0 else 0]


def flooded(humidity, samples):
    """f_max of surfaces with normal heights of scattered rms, under the water alone: σ A(d - h_C) at d = 2 rms."""
    rms = 1.5e-9 * (1 + 0.1 * np.random.default_rng(2).standard_normal(samples)[:, None])
    film = meniscus_height(humidity, 300)
    wetted = 0.5 * (1 + np.tanh((film - 4 * rms) / rms))
    return -laplace_pressure(humidity, 300) * wetted


def test_the_worst_humidity_of_a_stopper_is_not_the_wettest():
    axis = np.linspace(0.4, 0.95, 56)
    worst, error = stoppers.worst_humidity(axis, flooded(axis, 300))
    fine = np.linspace(0.4, 0.95, 5501)
    assert abs(worst - fine[np.argmax(flooded(fine, 300).mean(axis=0))]) < 1e-3
    assert axis[1] < worst < axis[-2]
    assert 0 < error < 0.01


def test_the_error_of_the_worst_humidity_is_the_scatter_of_repeated_studies():
    axis, rng, found = np.linspace(0, 1, 21), np.random.default_rng(3), []
    for _ in range(150):
        tops = rng.normal(0.6, 0.1, (60, 1))
        found.append(stoppers.worst_humidity(axis, 1 - (axis - tops) ** 2))
    worst, errors = np.transpose(found)
    assert_allclose(errors.mean(), worst.std(ddof=1), rtol=4 / np.sqrt(2 * 149))
    assert abs(worst.mean() - 0.6) < 4 * worst.std() / np.sqrt(150)


def test_the_safe_force_bounds_the_true_force_of_a_share_in_95_of_100_studies():
    true, rng = -np.log(0.02), np.random.default_rng(4)  # of exponential forces, exceeded by 2 %
    found = np.array([safe_force(rng.exponential(size=300), 0.02)[:3] for _ in range(500)])
    covered, error = np.mean(found[:, 0] >= true), np.sqrt(0.95 * 0.05 / 500)
    assert covered > 0.95 - 4 * error
    assert np.mean(found[:, 1] >= true) < 0.95 - 4 * error  # control: the estimate bounds nothing
    assert abs(found[:, 1].mean() - true) < 0.05 * true  # an order statistic, biased by less than its spacing
    assert_allclose(found[:, 2].mean(), found[:, 1].std(), rtol=0.25)


def test_too_few_patches_bound_no_share():
    with pytest.raises(ValueError, match="needs 180 lengths, got 179"):
        safe_force(np.ones(179), 1e-3)


@pytest.mark.parametrize("share", [1e-3, 1e-4, 1e-6])
def test_fitted_forces_of_lognormal_patches_bound_the_true_one_in_95_of_100_studies(share):
    rng, spread = np.random.default_rng(5), 0.5
    rows = 2e-6 * np.exp(spread * rng.standard_normal((400, 800)))
    true = 2e-6 * np.exp(-spread * ndtri(share))
    found = stoppers.safe_forces(rows, share, rng)
    forces, estimates, errors = np.transpose([(one.force, one.estimate, one.error) for one in found])
    allowed = 4 * np.sqrt(0.95 * 0.05 / 400 + 0.95 * 0.05 / 2000)  # of the studies, and of the simulated errors
    assert abs(np.mean(forces >= true) - 0.95) < allowed
    assert np.mean(estimates >= true) < 0.95 - allowed  # control: the estimate bounds nothing
    assert errors_off(np.log(estimates), np.log(true)) < ALLOWED
    assert_allclose((errors / estimates).mean(), np.log(estimates).std(), rtol=4 / np.sqrt(800))
    assert {one.basis for one in found} == {Basis.FITTED if 800 * share >= 0.1 else Basis.EXTRAPOLATED}


def test_a_share_that_enough_patches_bound_is_not_fitted():
    forces = np.random.default_rng(6).exponential(size=(1, 3000))
    (found,) = stoppers.safe_forces(forces, 1e-3, np.random.default_rng(0))
    assert found.basis is Basis.SAMPLED
    assert found.force in forces


def test_a_scaled_force_has_scaled_bounds():
    forces = np.random.default_rng(7).gamma(3, size=500)
    one, two = (safe_force(scale * forces, 1e-4) for scale in (1, 1e-6))
    assert_allclose(1e-6 * np.array(one[:3]), two[:3], rtol=1e-9)

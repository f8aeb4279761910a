"""White noise of a microscope: its floor in the spectrum, and moments without it."""

import numpy as np
import pytest
from drawn_scans import published, truth
from published import SPACING, SURFACES
from scipy import stats

from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.noise import can_be_noise, without_noise
from stiction.scans.scan import Scan
from stiction.streams import stream
from stiction.surface.field import StripGrid

SIDE = 5e-6


def noisy(scan, rms, seed=0):
    """Scan with white noise [m]."""
    rng = stream(1, "white noise", seed)
    return Scan(scan.heights + rms * rng.standard_normal(scan.heights.shape), scan.size, scan.name)


def fine(name, seed, side=SIDE):
    """Scan of a published surface with 10 nm between its points."""
    surface = SURFACES[name].on(StripGrid(side, side, SPACING, 1e-6))
    return Scan(surface.draw(stream(1, "fine", name, seed)).astype(float), (side, side))


def test_moments_without_noise_are_those_of_the_surface():
    rng = stream(1, "cumulants")
    z = rng.gamma(4.0, size=400_000)
    both = z + 1.5 * rng.standard_normal(z.size)

    def of(x):
        return np.array([np.log(x.std()), stats.skew(x), stats.kurtosis(x) + 3])

    found = without_noise(of(both), 1.5**2)
    np.testing.assert_allclose(found, of(z), atol=0.08)
    assert np.abs(of(both) - of(z)).max() > 0.5
    np.testing.assert_array_equal(without_noise(of(z), 0.0), of(z))


def test_heights_that_no_surface_has_without_noise_have_none():
    assert can_be_noise(np.array([0.0, 0.1, 1.2]), 0.02)
    assert not can_be_noise(np.array([0.0, 0.1, 1.2]), 0.1)
    assert not can_be_noise(np.array([0.0, 0.0, 3.0]), 1.0)


def test_a_floor_that_heights_cannot_have_stays_in_them_and_is_kept():
    (drawn,) = published("B2", SIDE, 1)
    steps = 5e-9 * np.sign(drawn.heights)
    two, one = (inspect([noisy(Scan(z, drawn.size), rms)], Settings()).largest
                for z, rms in ((steps, 3e-9), (drawn.heights, 0.3e-9)))  # fmt: skip
    assert two.floor_left.density > two.floor.density == 0
    np.testing.assert_array_equal(two.moments, two.noisy_moments)
    assert one.floor.density > one.floor_left.density == 0, "control: the noise of other heights is subtracted"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["B2", "Sub1"])
def test_without_noise_nothing_changes(name):
    for seed in range(2):
        maps = inspect([fine(name, seed)], Settings()).largest
        np.testing.assert_allclose(maps.moments, maps.noisy_moments, atol=1e-4)
        assert np.sqrt(np.diag(maps.noise_covariance)).max() < 1e-4


def test_aliases_are_no_noise():
    for scan in published("Sub1", SIDE, 3, "aliases"):  # has waves up to 1.7 times the Nyquist wave number
        maps = inspect([scan], Settings()).largest
        np.testing.assert_allclose(maps.moments[0], maps.noisy_moments[0], atol=0.002)


@pytest.mark.parametrize(
    ("name", "every"), [("B1", 3), ("B2", 8), ("B2", 10)]
)  # corners at 0.6 and 0.8 of the Nyquist one
def test_a_surface_whose_power_law_pixels_do_not_resolve_is_no_noise(name, every):
    for seed in range(4):
        heights = SURFACES[name].on(StripGrid(12e-6, 12e-6, 20e-9, 1e-6)).draw(stream(1, "coarse", name, seed))
        points = len(heights) // every
        coarse = heights.astype(float)[: every * points : every, : every * points : every]
        maps = inspect([Scan(coarse, (every * points * 20e-9,) * 2)], Settings()).largest
        np.testing.assert_allclose(maps.moments, maps.noisy_moments, atol=1e-3)


@pytest.mark.parametrize(
    ("name", "rms"), [("Sub1", 50e-12), pytest.param("B2", 30e-12, marks=pytest.mark.slow), ("B2", 300e-12)]
)
def test_noise_is_found_and_leaves_moments_and_spectrum_as_they_are(name, rms):
    clean = fine(name, 1)
    without, found = (inspect([scan], Settings()) for scan in (clean, noisy(clean, rms)))
    assert found.largest.noise == pytest.approx(rms, rel=0.03)
    errors = np.sqrt(np.diag(found.fit.covariance))[1:]
    change = np.log(found.fit.corner / without.fit.corner), found.fit.slope - without.fit.slope
    assert np.all(np.abs(change) < 2 * errors)
    assert found.reach.end == pytest.approx(without.reach.end, rel=0.03)
    assert np.all(np.abs(found.moments - without.moments) < 0.2 * np.array([0.023, 0.059, 0.12])), "errors of Sub1"


def test_an_end_of_the_spectrum_is_found_below_noise():
    (scan,) = published("B2", 2 * SIDE, 1)  # ends at 125 rad/µm, where the noise is a third of it
    found = inspect([noisy(scan, 0.1e-9)], Settings())
    assert found.reach.end == pytest.approx(SURFACES["B2"].spectrum.cutoff, rel=0.02)
    assert found.largest.noise == pytest.approx(0.1e-9, rel=0.05)


def test_rounded_heights_have_the_noise_of_their_step():
    scan, step = fine("B2", 2), 0.2e-9
    found = inspect([Scan(np.round(scan.heights / step) * step, scan.size)], Settings())
    assert found.largest.noise == pytest.approx(step / np.sqrt(12), rel=0.05)


@pytest.mark.slow
def test_noise_is_named_and_its_error_is_part_of_that_of_the_moments():
    found = estimate([noisy(fine("Sub1", 3), 50e-12)], 2, model_scans=4)
    assert any(flag.startswith("white noise of 0.05 nm in scans of 5 x 5 µm, ") for flag in found.flags)
    assert not any(flag.startswith("white noise") for flag in estimate([fine("B2", 3)], 2, model_scans=4).flags)
    maps = found.inspection.largest
    variance, error = maps.floor.variance(maps.frame.pixel)
    step = 1e-3 * variance
    slopes = (without_noise(maps.moments, step) - without_noise(maps.moments, -step)) / (2 * step)
    np.testing.assert_allclose(maps.noise_covariance, error**2 * np.outer(slopes, slopes), rtol=1e-4)


@pytest.mark.nightly
def test_rms_of_noisy_scans_has_no_bias_beyond_its_error():
    scans = [fine("Sub1", seed) for seed in range(10)]
    found = [estimate([noisy(scan, 50e-12, k)], 2, model_scans=8) for k, scan in enumerate(scans)]
    deviation = np.array([(one.moments - truth("Sub1")) / one.errors for one in found])
    assert np.all(np.abs(deviation.mean(axis=0)) < 4 / np.sqrt(len(scans)))
    raw = np.array([one.inspection.largest.noisy_moments[0] - truth("Sub1")[0] for one in found])
    assert raw.mean() > 0.03, "control: noise adds 4 % to the rms"

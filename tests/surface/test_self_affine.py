"""Spectra from what papers state: Hurst exponent, correlation length, rms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.streams import stream
from stiction.surface import self_affine
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.spectrum import autocovariance
from stiction.surface.translation import Translation

POINTS, SPACING, FIELDS = 512, 5e-9, 8
CUTOFF = 0.95 * np.pi / SPACING
rms, hurst = st.floats(1e-10, 1e-7), st.floats(0, 1)
lengths, cutoffs = st.floats(20e-9, 1e-6), st.floats(2e8, 1e9)


@given(rms, hurst, st.floats(1e6, 1e8), cutoffs)
def test_the_spectrum_has_the_variance_the_slope_and_the_ends_that_are_stated(rms, hurst, corner, cutoff):
    found = self_affine.spectrum(rms, self_affine.slope_of(hurst), corner, cutoff)
    assert_allclose(found.variance, rms**2, rtol=1e-9)
    assert_allclose(self_affine.hurst_of(found.slope), hurst, atol=1e-9)
    assert (found.corner, found.cutoff) == (corner, cutoff)


@settings(max_examples=10)
@given(hurst, lengths, cutoffs)
def test_the_autocovariance_at_the_correlation_length_is_one_over_e(hurst, length, cutoff):
    slope = self_affine.slope_of(hurst)
    corner = self_affine.corner_of(length, slope, cutoff)
    assert_allclose(self_affine.correlation_at(length, slope, corner, cutoff), np.exp(-1), rtol=1e-6)
    assert self_affine.correlation_at(length, slope, 1.2 * corner, cutoff) < np.exp(-1) - 0.01


@settings(max_examples=10)
@given(hurst, lengths, st.floats(0.02, 0.9), cutoffs)
def test_the_autocovariance_is_that_of_the_spectrum(hurst, lag, corner, cutoff):
    shape = self_affine.slope_of(hurst), corner * cutoff, cutoff
    covariance = autocovariance(self_affine.spectrum(1e-9, *shape), np.array([0, lag]), panels=20_000)
    assert_allclose(self_affine.correlation_at(lag, *shape), covariance[1] / covariance[0], atol=1e-4)


@pytest.mark.parametrize("hurst", [0, 0.5, 1])
def test_the_longest_correlation_at_the_finest_cutoff_of_a_configuration_takes_no_time(hurst):
    slope = self_affine.slope_of(hurst)
    corner = self_affine.corner_of(1e-4, slope, 1e11)
    assert_allclose(self_affine.correlation_at(1e-4, slope, corner, 1e11), np.exp(-1), rtol=1e-6)


def test_a_correlation_length_below_that_of_a_plateau_is_refused_with_the_least_one():
    slope, least = self_affine.slope_of(0.8), 2.58384 / 1e8
    assert self_affine.corner_of(1.001 * least, slope, 1e8) < 1e8
    with pytest.raises(ValueError, match="need a correlation length above 0.0258 µm"):
        self_affine.corner_of(0.999 * least, slope, 1e8)


def drawn(slope, corner):
    """Autocovariances of drawn fields at lags along both axes over their variance, (fields, points / 2)."""
    grid = StripGrid.periodic(POINTS * SPACING, SPACING)
    surface = RoughSurface(self_affine.spectrum(5e-9, slope, corner, CUTOFF), Translation(GAUSSIAN), 5e-9, grid)
    found = []
    for number in range(FIELDS):
        heights = surface.draw(stream(3, "self-affine", number)).astype(float)
        power = np.abs(np.fft.fft2(heights / 5e-9)) ** 2 / heights.size
        covariance = np.fft.ifft2(power).real
        found.append((covariance[0, : POINTS // 2] + covariance[: POINTS // 2, 0]) / 2)
    return np.array(found)


@pytest.mark.parametrize("hurst", [0.4, 0.8])
def test_a_drawn_surface_has_the_correlation_length_and_another_one_is_told_apart(hurst):
    length, slope = 60e-9, self_affine.slope_of(hurst)
    found = drawn(slope, self_affine.corner_of(length, slope, CUTOFF))
    mean, error = found.mean(0), found.std(0, ddof=1) / np.sqrt(FIELDS)
    lag = round(length / SPACING)
    assert abs(mean[lag] - np.exp(-1)) < 4 * error[lag]
    for other in (lag - 3, lag + 3):
        assert abs(mean[other] - np.exp(-1)) > 4 * error[other]


def growth(structure):
    """Exponent with which mean square differences of the heights grow over twice the distance, halved."""
    return np.log2(structure[..., 1] / structure[..., 0]) / 2


@pytest.mark.parametrize("hurst", [0.3, 0.5, 0.7])
def test_height_differences_grow_with_the_hurst_exponent_far_from_both_ends_of_the_power_law(hurst):
    """They are corner · τ = 0.01 and cut-off · τ = 100 away, which bends the law by their 2 - 2 H and 2 H-th powers."""
    slope = self_affine.slope_of(hurst)
    structure = 1 - np.array([self_affine.correlation_at(lag, slope, 1e5, 1e9) for lag in (1e-7, 2e-7)])
    assert abs(growth(structure) - hurst) < 0.02


def test_height_differences_of_drawn_surfaces_grow_as_those_of_the_spectrum():
    slope, lags = self_affine.slope_of(0.7), np.array([8, 16])
    covariance = drawn(slope, 3e6)
    found = growth(covariance[:, :1] - covariance[:, lags])
    structure = 1 - np.array([self_affine.correlation_at(lag * SPACING, slope, 3e6, CUTOFF) for lag in lags])
    error = found.std(ddof=1) / np.sqrt(FIELDS)
    assert abs(found.mean() - growth(structure)) < 4 * error
    assert error < 0.02  # it tells Hurst exponents apart

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from published import IDENTITY, SPACING, SURFACES
from scipy import fft

from stiction.errors import NotConverged
from stiction.surface.maxent import HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import (
    LARGEST_SCORE,
    Translation,
    _on_one_half,
    spectrum_of_heights,
    underlying_spectrum,
)

published = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)
#: The standard deviation of the tabulated heights is off by step² / 12 · |d ln p / dz| in each tail.
TABLES = 2e-5
#: The 24 terms of the Hermite series omit less than this share of the variance.
SERIES = 5e-6
#: Width of the rings on which the transforms average [rad m⁻¹].
RING = 2 * np.pi / (1024 * SPACING)
score, weight = np.polynomial.hermite_e.hermegauss(60)
weight = weight / np.sqrt(2 * np.pi)


@published
def test_variance_of_the_heights_is_the_sum_of_the_squared_coefficients(surface):
    power = surface.translation.hermite_coefficients**2
    np.testing.assert_allclose(power.sum(), 1, rtol=0, atol=TABLES + SERIES)
    assert 0.9 < power[0] < 1  # mostly the Gaussian field itself
    assert power[-4:].sum() < SERIES


@published
def test_coefficients_are_projections_on_hermite_polynomials(surface):
    heights = surface.translation(score)
    for k in range(1, 7):
        hermite = np.polynomial.hermite_e.HermiteE.basis(k)(score) / np.sqrt(np.prod(np.arange(1.0, k + 1)))
        # 60 Gauss points resolve the bend of the quantile function to a few 1e-5.
        np.testing.assert_allclose(
            surface.translation.hermite_coefficients[k - 1], weight @ (heights * hermite), rtol=0, atol=2e-4
        )


@published
def test_translated_scores_have_the_moments_of_the_heights(surface):
    u = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 40_001)
    share = np.exp(-(u**2) / 2) * (u[1] - u[0]) / np.sqrt(2 * np.pi)
    moments = [share @ surface.translation(u) ** k for k in range(1, 5)]
    np.testing.assert_allclose(
        moments, [0, 1, surface.skewness, surface.kurtosis], rtol=0, atol=4 * TABLES * surface.kurtosis
    )


@published
def test_higher_scores_are_higher_points(surface):
    assert np.all(np.diff(surface.translation.table) > 0)


def test_translation_of_gaussian_heights_changes_nothing():
    u = np.linspace(-7, 7, 1001)
    np.testing.assert_allclose(IDENTITY(u), u, rtol=TABLES, atol=TABLES)
    np.testing.assert_allclose(IDENTITY.hermite_coefficients, np.eye(24)[0], atol=TABLES)
    rho = np.linspace(-1, 1, 21)
    np.testing.assert_allclose(IDENTITY.autocorrelation(rho), rho, atol=1e-9)


def test_field_underlying_a_gaussian_surface_has_the_spectrum_of_the_surface():
    target = SURFACES["B1"].spectrum
    underlying, defect = underlying_spectrum(target, IDENTITY, SPACING)
    zeta = in_band(target, 0.02, 0.98)
    np.testing.assert_allclose(underlying(zeta) * target.variance, target(zeta), rtol=2e-3)  # mean |ζ| of a ring
    assert defect < 1e-6


@published
def test_autocorrelation_maps_one_to_one_and_zero_to_zero(surface):
    np.testing.assert_allclose(surface.translation.autocorrelation(np.array([0.0, 1.0])), [0, 1], atol=1e-12)


@published
@pytest.mark.parametrize("rho", [-0.6, 0.3, 0.9])
def test_autocorrelation_is_the_mean_product_of_two_translated_heights(surface, rho):
    first, second = np.meshgrid(score, score)
    product = surface.translation(first) * surface.translation(rho * first + np.sqrt(1 - rho**2) * second)
    np.testing.assert_allclose(surface.translation.autocorrelation(rho), weight @ product @ weight, rtol=0, atol=1e-4)


@published
def test_underlying_autocorrelation_is_recovered_from_that_of_the_heights(surface):
    rho = np.linspace(-0.5, 1, 31)
    heights = surface.translation.autocorrelation(rho)
    np.testing.assert_allclose(surface.translation.underlying_autocorrelation(heights), rho, atol=1e-10)
    assert np.all(np.abs(heights) <= np.abs(rho) + 1e-12)  # a translation can only reduce the correlation


def test_mirrored_surface_has_the_same_autocorrelation():
    surface = SURFACES["Sub2"]
    signs = (-1, 1, -1, 1)
    mirrored = Translation(HeightDensity(tuple(np.multiply(signs, surface.density.multipliers))))
    rho = np.linspace(-1, 1, 21)
    np.testing.assert_allclose(mirrored.autocorrelation(rho), surface.translation.autocorrelation(rho), atol=1e-9)


def test_skewed_heights_cannot_be_perfectly_anticorrelated():
    translation = SURFACES["Sub2"].translation
    assert translation.autocorrelation(-1.0) > -0.95
    with pytest.raises(ValueError, match="at least -0.8962, got -0.95"):
        translation.underlying_autocorrelation(np.array([0.5, -0.95]))


def test_inversion_that_runs_out_of_steps_reports_its_residual():
    for steps in (0, 1):
        with pytest.raises(NotConverged, match=f"underlying autocorrelation: residual .* after {steps} iterations"):
            SURFACES["B1"].translation.underlying_autocorrelation(0.5, max_iterations=steps)


@pytest.mark.parametrize("function", [underlying_spectrum, spectrum_of_heights])
def test_a_grid_that_does_not_resolve_the_spectrum_is_refused(function):
    surface = SURFACES["B2"]
    finest = np.pi / surface.spectrum.cutoff
    function(surface.spectrum, surface.translation, finest * (1 + 1e-12), points=64)  # the same in other units
    with pytest.raises(
        ValueError, match=r"cut-off 1.25e[+]08 rad/m is beyond the Nyquist wave number of the grid, 1.249"
    ):
        function(surface.spectrum, surface.translation, 1.001 * finest, points=64)
    for spacing in (-10e-9, 0.0, np.nan, np.inf):
        with pytest.raises(ValueError, match=f"a distance of the points above 0, got {spacing:.4g} m"):
            function(surface.spectrum, surface.translation, spacing, points=64)


def in_band(target, low, high):
    """Wave numbers between two shares of the cut-off, without the rings that contain both sides of the corner."""
    zeta = target.cutoff * np.linspace(low, high, 150)
    return zeta[np.abs(zeta - target.corner) > 2 * RING]


def misfit(surface, underlying, zeta):
    """Relative error of the spectrum of the heights translated from a field with this spectrum."""
    heights = spectrum_of_heights(underlying, surface.translation, SPACING)
    return np.abs(heights(zeta) * surface.spectrum.variance / surface.spectrum(zeta) - 1)


@pytest.mark.parametrize("name", ["B1", "B2", "Sub1"])
def test_translated_field_has_the_target_spectrum_up_to_its_cutoff(name):
    surface = SURFACES[name]
    band = in_band(surface.spectrum, 0.02, 0.98)
    reached = misfit(surface, surface.underlying, band)
    assert reached.max() < 0.012  # the mean |ζ| of a narrow ring differs from its nominal |ζ|
    untreated = misfit(surface, surface.spectrum, band)
    assert np.median(untreated) > 2 * np.median(reached)


def test_spectrum_of_sub2_falls_faster_than_a_translation_allows_at_the_top_of_its_band():
    surface = SURFACES["Sub2"]
    assert misfit(surface, surface.underlying, in_band(surface.spectrum, 0.02, 0.6)).max() < 0.012
    top = misfit(surface, surface.underlying, in_band(surface.spectrum, 0.66, 0.98))
    assert top.min() > 0.2
    assert 0.6 < top.max() < 0.8
    assert 1e-3 < surface.defect < 3e-3


@published
def test_share_of_the_variance_that_no_gaussian_field_provides_is_small(surface):
    assert 0 <= surface.defect < 3e-3


@published
def test_underlying_field_has_unit_variance_and_no_negative_power(surface):
    axis = np.fft.fftfreq(1024, 1 / 1024)
    number = np.hypot(axis[:, None], axis)
    waves_on_ring = np.bincount(np.rint(number).astype(int)[number * RING <= surface.spectrum.cutoff])
    assert surface.underlying.density.min() >= 0
    np.testing.assert_allclose(waves_on_ring @ surface.underlying.density * RING**2, 1, rtol=1e-9)
    assert surface.underlying(1.001 * surface.spectrum.cutoff) == 0


def test_products_of_waves_fill_the_tail_so_that_the_field_has_less_power_there_than_the_heights():
    surface = SURFACES["B1"]
    top, flat = in_band(surface.spectrum, 0.5, 0.95), in_band(surface.spectrum, 0.02, 0.2)
    assert np.all(surface.underlying(top) < 0.97 * surface.spectrum(top) / surface.spectrum.variance)
    assert np.all(surface.underlying(flat) > surface.spectrum(flat) / surface.spectrum.variance)


@pytest.mark.parametrize("points", [8, 9])
def test_autocorrelations_are_even_so_that_half_of_them_give_all_bit_for_bit(points):
    density = np.random.default_rng(1).random((points, points))
    turned = np.roll(density[::-1, ::-1], 1, axis=(0, 1))
    even = fft.fft2(density + turned).real
    np.testing.assert_array_equal(_on_one_half(np.exp, even), np.exp(even))
    assert not np.array_equal(_on_one_half(np.exp, density), np.exp(density))


@given(st.floats(0.2, 5))
def test_scale_of_the_target_has_no_effect(factor):
    target = CutoffSelfAffine(1e-33, 1e-35, 3e7, 1.2e8)
    louder = CutoffSelfAffine(factor * target.plateau, factor * target.floor, target.corner, target.cutoff)
    zeta = in_band(target, 0.05, 0.95)
    first, second = (
        underlying_spectrum(s, SURFACES["B1"].translation, SPACING, points=128)[0] for s in (target, louder)
    )
    np.testing.assert_allclose(first(zeta), second(zeta), rtol=1e-9)

import numpy as np
import pytest
from drawn_scans import published, truth
from published import IDENTITY, SPACING, SURFACES
from scipy import stats
from scipy.special import erf

from stiction.scans.moments import (
    covariance,
    homogeneity,
    influence,
    mode_covariance,
    moments,
    moments_of,
    overlap_integrals,
    powers,
    tile_errors,
    tiles,
)
from stiction.streams import stream
from stiction.surface.spectrum import TabulatedSpectrum
from stiction.surface.translation import underlying_spectrum

HEIGHTS = 2.0 + 3.0 * stream(1, "moments").gamma(4.0, size=(50, 40))
SIDE = 10e-6
#: Standard errors of ln rms, skewness and kurtosis of scans of 10 x 10 µm, and correlations of the pairs, computed
#: independently: another implementation, with the two-dimensional transform.
CLOSED_FORM = {
    "B1": ((0.0065, 0.0265, 0.1296), (-0.53, 0.40, -0.917)),
    "B2": ((0.0161, 0.0433, 0.1416), (-0.34, 0.13, -0.868)),
    "Sub1": ((0.0117, 0.0295, 0.0614), (-0.20, 0.06, -0.669)),
    "Sub2": ((0.0052, 0.0152, 0.0630), (-0.44, 0.19, -0.902)),
}
#: Its numbers are rounded to this much, and agree to 2 %.
ROUNDED = {"errors": 5e-5, "correlations": 5e-3}


def test_moments_are_those_of_the_definition():
    expected = [np.log(HEIGHTS.std()), stats.skew(HEIGHTS, axis=None), stats.kurtosis(HEIGHTS, axis=None) + 3]
    np.testing.assert_allclose(moments(powers(HEIGHTS)), expected, rtol=1e-10)


def test_undefined_heights_do_not_count():
    z = HEIGHTS.copy()
    z[3], z[:, 7] = np.nan, np.nan
    np.testing.assert_allclose(powers(z), powers(z[np.isfinite(z)]))


def test_influence_is_the_derivative_of_the_moments_with_respect_to_the_share_of_a_height():
    known = powers((HEIGHTS - HEIGHTS.mean()) / HEIGHTS.std())
    _, skewness, kurtosis = moments(known)
    share = 1e-5
    for z in (-2.0, -0.5, 0.7, 3.0):
        own = z ** np.arange(1, 5)
        more, less = (moments((1 - s) * known + s * own) for s in (share, -share))
        np.testing.assert_allclose(influence(own, skewness, kurtosis), (more - less) / (2 * share), rtol=1e-5)


@pytest.mark.parametrize("name", SURFACES)
def test_moments_of_a_translation_are_those_of_its_density(name):
    np.testing.assert_allclose(moments_of(SURFACES[name].translation)[1:], truth(name)[1:], rtol=0, atol=1e-3)


@pytest.mark.parametrize("length", [0.2, 0.7])
def test_overlap_integrals_of_a_gaussian_autocorrelation_are_in_closed_form(length):
    zeta = np.linspace(0, 10 / length, 2001)
    spectrum = TabulatedSpectrum(zeta, np.exp(-((zeta * length) ** 2) / 2), zeta[-1])
    sides, k = np.array([[4.0], [7.0]]), np.arange(1, 5)
    width = length / np.sqrt(k)
    factor = width * np.sqrt(2 * np.pi) * erf(sides / width / np.sqrt(2)) - 2 * width**2 / sides * (
        1 - np.exp(-((sides / width) ** 2) / 2)
    )
    found = overlap_integrals(spectrum, (4.0, 7.0), 10.0, 4)
    np.testing.assert_allclose(found, np.prod(factor / sides, axis=0), rtol=2e-4)


@pytest.mark.parametrize("name", CLOSED_FORM)
def test_standard_errors_and_correlations_of_the_published_surfaces(name):
    surface = SURFACES[name]
    found = covariance(surface.translation, surface.underlying, (SIDE, SIDE), 512 * SPACING)
    errors, correlations = CLOSED_FORM[name]
    computed = np.sqrt(np.diag(found))
    np.testing.assert_allclose(computed, errors, rtol=0.02, atol=ROUNDED["errors"])
    pairs = (found / np.outer(computed, computed))[np.triu_indices(3, 1)]
    np.testing.assert_allclose(pairs, correlations, rtol=0.02, atol=ROUNDED["correlations"])


def test_gaussian_heights_have_smaller_errors_and_uncorrelated_skewness():
    found = covariance(IDENTITY, SURFACES["B2"].spectrum, (SIDE, SIDE), SIDE)
    np.testing.assert_allclose(np.sqrt(np.diag(found)), (0.0133, 0.0364, 0.0626), rtol=0.02)
    np.testing.assert_allclose(found[1, [0, 2]], 0, atol=1e-8)


def test_errors_decrease_with_the_root_of_the_area():
    surface = SURFACES["Sub2"]
    small, large = (
        covariance(surface.translation, surface.underlying, (side, 2 * side), 512 * SPACING) for side in (5e-6, 20e-6)
    )
    np.testing.assert_allclose(small / large, 16, rtol=0.08)


def test_scatter_of_drawn_scans_is_the_closed_form():
    surface = SURFACES["B2"]
    side, count = 4e-6, 120
    found = np.array([moments(powers(scan.heights)) for scan in published("B2", side, count)])
    underlying = underlying_spectrum(surface.spectrum, surface.translation, SPACING)[0]
    errors = np.sqrt(np.diag(covariance(surface.translation, underlying, (side, side), 512 * SPACING)))
    ratio = found.std(axis=0, ddof=1) / errors
    # The tails of single estimates widen the error of a standard deviation, 1 / sqrt(2 n) = 6.5 %.
    np.testing.assert_allclose(ratio, 1, rtol=0, atol=0.25)


def test_equal_scans_are_homogeneous_and_different_ones_are_not():
    errors = np.array([0.02, 0.05, 0.15])
    drawn = stream(1, "homogeneity").standard_normal((3000, 5, 3)) * errors
    values, likely = zip(*(homogeneity(x, np.diag(errors**2)) for x in drawn), strict=True)
    np.testing.assert_allclose(np.mean(values, axis=0), 4, rtol=0, atol=4 * np.sqrt(8 / 3000))
    np.testing.assert_allclose(np.mean(np.array(likely) < 0.05, axis=0), 0.05, rtol=0, atol=0.016)
    other = drawn[0] + np.eye(5)[:, :1] * [10, 0, 0] * errors
    assert homogeneity(other, np.diag(errors**2))[1][0] < 1e-6


def test_one_scan_cannot_be_compared():
    chi2, likely = homogeneity(np.ones((1, 3)), np.eye(3))
    assert np.isnan(chi2).all()
    assert np.isnan(likely).all()


def test_tiles_cover_the_map_once():
    parts = tiles(np.arange(41.0 * 24).reshape(41, 24), 4)
    assert {part.shape for part in parts} == {(10, 6)}
    assert len(np.unique(parts)) == 960
    np.testing.assert_array_equal(parts[1][0], np.arange(6.0, 12.0))


def test_errors_by_tiles_are_those_of_independent_heights():
    n = 64
    drawn = [[stream(1, "tiles", k, j).standard_normal((n, n)) for j in range(2)] for k in range(60)]
    found = np.mean([tile_errors(pair, 4) ** 2 for pair in drawn], axis=0)
    np.testing.assert_allclose(np.sqrt(found), np.sqrt(np.array([0.5, 6, 24]) / (2 * n**2)), rtol=0.1)


def test_modes_of_the_heights_are_uncorrelated_and_correlated_with_the_rms_as_its_hermite_series():
    surface = SURFACES["B2"]
    overlaps = overlap_integrals(surface.underlying, (10e-6, 10e-6), 5e-6, 24)
    found = mode_covariance(surface.translation, overlaps, range(1, 25))
    full = covariance(surface.translation, surface.underlying, (10e-6, 10e-6), 5e-6)
    np.testing.assert_allclose(found[0, 0], full[0, 0], rtol=1e-9)
    np.testing.assert_allclose(np.diag(found)[1:], overlaps)
    np.testing.assert_allclose(found[1:, 1:], np.diag(overlaps), atol=1e-15)
    # All of the error of the rms is that of the modes.
    explained = found[0, 1:] @ np.linalg.solve(found[1:, 1:], found[0, 1:])
    np.testing.assert_allclose(explained, found[0, 0], rtol=1e-9)
    few = mode_covariance(surface.translation, overlaps, [2, 5])
    np.testing.assert_allclose(few, found[np.ix_([0, 2, 5], [0, 2, 5])])

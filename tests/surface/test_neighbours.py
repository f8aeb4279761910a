"""Mean heights of neighbouring strips: closed form, integrals over lags, and drawn surfaces."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.neighbours import mean_height_correlations
from stiction.surface.spectrum import CutoffSelfAffine, autocovariance
from stiction.surface.translation import Translation

LONG = CutoffSelfAffine(1e-32, 1e-38, 1e6, 20e6)
SHORT = CutoffSelfAffine(1e-32, 1e-35, 12e6, 100e6)


def by_lags(spectrum, sides, lags):
    """Correlations by integrals of the autocovariance of the heights over both strips."""
    length, width = sides
    along, across = np.linspace(0, (lags + 1) * length, 1201), np.linspace(0, width, 601)
    lag = np.linspace(0, np.hypot(along[-1], width), 3000)
    field = np.interp(np.hypot(along[:, None], across), lag, autocovariance(spectrum, lag))
    over = np.trapezoid(field * (1 - across / width), across, axis=1)
    both, all_over = np.r_[-along[:0:-1], along], np.r_[over[:0:-1], over]
    found = [np.trapezoid(np.maximum(length - abs(both - k * length), 0) * all_over, both) for k in range(lags + 1)]
    return np.array(found[1:]) / found[0]


@pytest.mark.parametrize("sides", [(1.5e-6, 5e-6), (0.5e-6, 2e-6)])
@pytest.mark.parametrize("spectrum", [LONG, SHORT])
def test_correlations_are_those_of_the_integrals_over_lags(spectrum, sides):
    assert_allclose(mean_height_correlations([(spectrum, 1.0)], sides, 3), by_lags(spectrum, sides, 3), atol=2e-3)


def test_the_sum_of_two_surfaces_lies_between_them_by_their_variances():
    sides = 1.5e-6, 5e-6
    alone = [mean_height_correlations([(spectrum, 1.0)], sides, 1)[0] for spectrum in (LONG, SHORT)]
    assert alone[0] > 0.4 > 0.03 > abs(alone[1])
    (both,) = mean_height_correlations([(LONG, 1e-9), (SHORT, 5e-9)], sides, 1)
    assert alone[1] < both < alone[0]
    assert_allclose(mean_height_correlations([(LONG, 1e-9), (SHORT, 0.0)], sides, 1)[0], alone[0], atol=1e-4)


def test_wide_strips_tend_to_waves_along_the_beam_alone():
    wide, infinite = (mean_height_correlations([(LONG, 1.0)], (1.5e-6, width), 4) for width in (1e-3, np.inf))
    assert_allclose(wide, infinite, atol=2e-3)


def test_mean_heights_of_drawn_strips_are_correlated_as_in_closed_form():
    """Wide fields cut in strips; fields cut in strips of another length are a control."""
    sides, strips, spacing = (1.5e-6, 5e-6), 20, 0.1e-6
    grid = StripGrid(strips * sides[0], sides[1], spacing, margin=9e-6)
    surface = RoughSurface(LONG, Translation(GAUSSIAN), 1e-9, grid)
    rng = np.random.default_rng(7)
    drawn = np.array([surface.draw(rng).reshape(strips, -1).mean(axis=1, dtype=float) for _ in range(400)])
    found = [np.mean(drawn[:, k:] * drawn[:, :-k]) / np.mean(drawn**2) for k in (1, 2)]
    expected, control = (mean_height_correlations([(LONG, 1.0)], (length, sides[1]), 2) for length in (1.5e-6, 2e-6))
    assert_allclose(found, expected, atol=0.04)
    assert abs(found[0] - control[0]) > 0.08

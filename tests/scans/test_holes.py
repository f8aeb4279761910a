import dataclasses
import functools

import numpy as np
import pytest
from drawn_scans import published
from hypothesis import given
from hypothesis import strategies as st

from stiction.scans import inspection
from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.holes import filled
from stiction.streams import stream

SIDE = 5e-6
(WHOLE,) = published("B2", SIDE, 1, "holes")
PIXEL = (3.0, 2.0)
X, Y = np.arange(40)[:, None] * PIXEL[0], np.arange(50) * PIXEL[1]


def holed(heights, *parts):
    z = np.array(heights, float)
    for part in parts:
        z[part] = np.nan
    return z


def scattered(scan, share):
    return dataclasses.replace(
        scan, heights=np.where(stream(1, "holes").random(scan.heights.shape) < share, np.nan, scan.heights)
    )


def test_a_complete_map_is_itself():
    assert filled(WHOLE.heights, PIXEL) is WHOLE.heights


@pytest.mark.parametrize("form", [X + 0 * Y, 2 * Y - X, X * Y, X**2 - Y**2])
def test_harmonic_heights_are_restored_in_holes_of_any_form(form):
    parts = (5, 7), (slice(10, 20), slice(10, 14)), (30, slice(3, 30)), (slice(18, 25), 40)
    np.testing.assert_allclose(filled(holed(form, *parts), PIXEL), form, atol=1e-9 * np.abs(form).max())


def test_distances_of_the_points_count():
    saddle = X**2 - Y**2
    square = filled(holed(saddle, (slice(10, 20), slice(10, 14))), (1.0, 1.0))
    assert np.abs(square - saddle).max() > 1


def test_points_at_the_edge_have_the_mean_of_their_neighbours():
    z = filled(holed(X**2 + Y, (0, 0), (39, 20)), PIXEL)
    near, far = PIXEL[1] ** -2, PIXEL[0] ** -2
    np.testing.assert_allclose(z[0, 0], (near * Y[1] + far * X[1, 0] ** 2) / (near + far))
    around = near * (2 * X[39, 0] ** 2 + Y[19] + Y[21]) + far * (X[38, 0] ** 2 + Y[20])
    np.testing.assert_allclose(z[39, 20], around / (2 * near + far))


@given(st.integers(0, 30), st.integers(0, 40), st.integers(1, 9), st.integers(1, 9))
def test_filled_points_lie_within_the_rim_of_their_hole_and_others_stay(i, j, rows, columns):
    z = WHOLE.heights[:40, :50]
    complete = filled(holed(z, (slice(i, i + rows), slice(j, j + columns))), PIXEL)
    inside = np.zeros(z.shape, bool)
    inside[i : i + rows, j : j + columns] = True
    np.testing.assert_array_equal(complete[~inside], z[~inside])
    rim = z[max(i - 1, 0) : i + rows + 1, max(j - 1, 0) : j + columns + 1]
    assert rim.min() <= complete[inside].min()
    assert complete[inside].max() <= rim.max()


def at_the_level(heights, _):
    """Holes as they would be without filling."""
    return np.nan_to_num(heights)


@functools.cache
def of_whole():
    return estimate([WHOLE], 1, model_scans=8)


@pytest.mark.parametrize("share", [0.001, 0.009])
def test_scattered_holes_change_neither_spectrum_nor_statistics(share, monkeypatch):
    scan = scattered(WHOLE, share)
    found, whole = inspect([scan], Settings()), of_whole().inspection
    assert found.reach == whole.reach
    errors = np.sqrt(np.diag(whole.fit.covariance))
    assert np.all(np.abs(parameters(found) - parameters(whole)) < 0.3 * errors)
    assert np.all(np.abs(found.moments - whole.moments) < 0.1 * of_whole().errors)
    monkeypatch.setattr(inspection, "filled", at_the_level)
    before = inspect([scan], Settings())
    noise, white = (end_of_spectrum(one) - end_of_spectrum(whole) for one in (found, before))
    assert 0 < noise < 0.02 * white, "holes at the level are white noise"


def end_of_spectrum(found):
    """Mean spectrum of the waves that the surface does not have, with the floor of noise that they show."""
    return found.rings.between(1.3e8, found.reach.nyquist).density.mean() + found.largest.floor.density


def parameters(found):
    """Logarithms of plateau and corner, and slope."""
    return np.array([np.log(found.fit.plateau), np.log(found.fit.corner), found.fit.slope])


def test_summits_beside_holes_count_and_the_share_is_named():
    found = estimate([scattered(WHOLE, 0.009)], 1, model_scans=8)
    assert np.all(np.abs(found.summits - of_whole().summits) < 1.0 * of_whole().summit_errors)
    share = found.inspection.filled_share
    assert share == pytest.approx(0.009, rel=0.2)
    sentence = f"{100 * share:.2g} % of the points were undefined and are filled from their neighbours"
    assert sentence in found.flags
    assert not any("undefined" in flag for flag in of_whole().flags)
    assert np.isnan(found.inspection.largest.levelled[0]).mean() == share, "moments leave the holes out"

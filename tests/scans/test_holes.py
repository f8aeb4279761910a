import dataclasses
import functools

import numpy as np
import pytest
from drawn_scans import published
from hypothesis import given
from hypothesis import strategies as st

from stiction.errors import ScanError
from stiction.scans import inspection
from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.holes import filled, whole_part
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


# Many undefined points: moments of the others, spectrum of the largest whole part


@given(st.integers(0, 10**6), st.integers(1, 4))
def test_the_whole_part_has_no_wide_hole_and_none_has_a_longer_shorter_side(seed, number):
    """Against all squares, of which the largest is as wide as the shorter side of the part."""
    rng = stream(seed, "holes")
    z = np.zeros((24, 30))
    for _ in range(number):
        i, j = rng.integers(0, 20), rng.integers(0, 26)
        z[i : i + 5, j : j + 6] = np.nan
    part = z[whole_part(z)]
    assert np.isfinite(part).all()
    free = np.isfinite(z)
    sides = [
        next((n for n in range(24, 0, -1) if i + n <= 24 and j + n <= 30 and free[i : i + n, j : j + n].all()), 0)
        for i in range(24)
        for j in range(30)
    ]
    assert min(part.shape) == max(sides)


def test_narrow_holes_are_no_border_of_the_whole_part():
    z = np.zeros((40, 50))
    z[stream(1, "narrow").random(z.shape) < 0.1] = np.nan
    z[10:40, 20:23] = np.nan
    assert z[whole_part(z)].shape == z.shape
    z[10:40, 20:24] = np.nan
    assert z[whole_part(z)].shape != z.shape


def discs(shape, share):
    """Holes of radii from a twentieth to a tenth of the side, near the borders, that have a share of the points."""
    rng, (x, y) = stream(2, "discs"), np.indices(shape)
    mask = np.zeros(shape, bool)
    while mask.mean() < share:
        place, radius = (rng.random(), rng.choice([0.02, 0.98])), shape[0] * rng.uniform(0.05, 0.1)
        i, j = np.array(place)[:: rng.choice([1, -1])] * shape
        mask |= (x - i) ** 2 + (y - j) ** 2 < radius**2
    return mask


@functools.cache
def large():
    """Scan of B2 of 10 µm and what it shows without holes."""
    (scan,) = published("B2", 10e-6, 1, "holed")
    return scan, inspect([scan], Settings())


@pytest.mark.parametrize(("kind", "share"), [("random", 0.03), ("random", 0.1), ("discs", 0.03), ("discs", 0.12)])
def test_many_holes_leave_moments_and_corner(kind, share):
    scan, whole = large()
    shape = scan.heights.shape
    mask = stream(1, "many").random(shape) < share if kind == "random" else discs(shape, share)
    found = inspect([dataclasses.replace(scan, heights=np.where(mask, np.nan, scan.heights))], Settings())
    closed_form = np.array([0.0161, 0.0433, 0.1416])  # standard errors of the moments of B2 on 10 x 10 µm
    assert np.all(np.abs(found.moments - whole.moments) < closed_form * (0.25 if kind == "random" else 1.5))
    errors = np.sqrt(np.diag(found.fit.covariance) + (kind != "random") * np.diag(whole.fit.covariance))
    off = (parameters(found) - parameters(whole)) / errors
    assert np.all(np.abs(off[:2]) < (1 if kind == "random" else 2.5))
    part = found.largest.complete_frame.shape
    assert (part == shape) == (kind == "random")
    assert found.largest.area == pytest.approx((1 - mask.mean()) * 1e-10)


@pytest.mark.parametrize(("share", "bias"), [(0.03, -0.022), (0.1, -0.073), (0.3, -0.22)])
def test_the_slope_of_scans_with_scattered_holes_errs_as_the_docs_state(share, bias):
    """The waves of 4 to 10 pixels lose power between the points: 8 scans err by -0.0216, -0.0735 and -0.219 ± 0.002."""
    scan, whole = large()
    mask = stream(1, "many").random(scan.heights.shape) < share
    found = inspect([dataclasses.replace(scan, heights=np.where(mask, np.nan, scan.heights))], Settings())
    assert found.fit.slope - whole.fit.slope == pytest.approx(bias, abs=0.02)


@pytest.mark.slow
def test_holes_are_named_with_the_part_that_gives_the_spectrum():
    scan, _ = large()
    mask = discs(scan.heights.shape, 0.12)
    holed_scan = dataclasses.replace(scan, heights=np.where(mask, np.nan, scan.heights))
    found = estimate([holed_scan], 1, model_scans=8)
    (flag,) = (flag for flag in found.flags if "undefined" in flag)
    assert flag.startswith(f"{100 * mask.mean():.2g} % of the points are undefined: moments are those of the others")
    assert found.inspection.largest.part_in_words in flag
    errors = estimate([scan], 1, model_scans=8).closed_form_errors / np.sqrt(1 - mask.mean())
    np.testing.assert_allclose(found.closed_form_errors, errors, rtol=0.25)


def test_scans_with_many_holes_stand_alone():
    scan, _ = large()
    mask = discs(scan.heights.shape, 0.12)
    holed_scan = dataclasses.replace(scan, heights=np.where(mask, np.nan, scan.heights), name="holes")
    found = inspect([holed_scan, scan], Settings())
    assert [maps.names for maps in found.sizes] == [(scan.name,), ("holes",)]
    assert found.names == ("holes", scan.name)


@pytest.mark.parametrize("rest", [np.nan, 0.0, 2e-9])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_scan_that_was_stopped_is_the_scan_of_its_lines(rest, axis):
    z = np.moveaxis(WHOLE.heights.copy(), axis, 0)
    z[180:] = rest
    stopped = dataclasses.replace(WHOLE, heights=np.moveaxis(z, 0, axis))
    size = tuple(SIDE * (180 / len(z) if k == axis else 1) for k in range(2))
    lines = dataclasses.replace(WHOLE, heights=np.moveaxis(z[:180], 0, axis), size=size)
    found, expected = (inspect([scan], Settings()) for scan in (stopped, lines))
    assert found.largest.complete_frame.shape == lines.heights.shape
    np.testing.assert_allclose(found.moments, expected.moments, rtol=1e-9)
    np.testing.assert_allclose(parameters(found), parameters(expected), rtol=1e-9)


def test_a_scan_without_any_whole_part_is_refused():
    z = WHOLE.heights.copy()
    z[::30, :], z[:, ::30] = np.nan, np.nan
    for shift in range(4):
        z[shift::30, :], z[:, shift::30] = np.nan, np.nan
    with pytest.raises(ScanError, match="points undefined .*, and no part without holes that has 32 points along each"):
        inspect([dataclasses.replace(WHOLE, heights=z)], Settings())

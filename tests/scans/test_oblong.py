"""Scans that are not square and pixels that are not: the same laws as for square ones, on drawn surfaces."""

import dataclasses

import numpy as np
import pytest
from drawn_scans import PIXELS, published
from published import SURFACES

from stiction.estimates import mean_with_error
from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.levelling import Levelling, level, line_jump
from stiction.scans.model_scans import SurfaceModel, summits_of_map
from stiction.scans.moments import moments, powers, tiles
from stiction.scans.periodogram import periodogram, rings
from stiction.scans.scan import Frame, Scan
from stiction.scans.whittle import reach, tip_reach
from stiction.streams import stream

B2 = SURFACES["B2"]
SIDE = 5e-6
SQUARE = published("B2", SIDE, 8, "oblong")
#: Parts of square scans of 250 x 250 points: lines and columns used.
PARTS = {
    "long lines": (slice(None), slice(0, 150)),
    "short lines": (slice(0, 150), slice(None)),
    "wide pixels along the lines": (slice(None, None, 2), slice(None)),
    "wide pixels across the lines": (slice(None), slice(None, None, 2)),
    "all at once": (slice(0, 240, 2), slice(0, 150)),
}


def cut(name, scans=SQUARE):
    """Parts of the scans, with their sizes."""
    part = PARTS[name]
    for scan in scans:
        steps = [p * (piece.step or 1) for p, piece in zip(PIXELS, part, strict=True)]
        heights = scan.heights[part]
        size = tuple(n * step for n, step in zip(heights.shape, steps, strict=True))
        yield Scan(heights, size, scan.name)


def turned(scan):
    """The same scan with the other axis as the fast one."""
    return dataclasses.replace(scan, heights=scan.heights.T, size=scan.size[::-1])


def test_a_frame_has_pixels_and_an_area():
    frame = Frame((200, 100), (4e-6, 3e-6))
    assert frame.pixel == pytest.approx((20e-9, 30e-9))
    assert frame.area == pytest.approx(12e-12)
    assert not frame.square
    assert Frame((200, 150), (4e-6, 3e-6)).square
    assert Frame((2000, 1000), (2.001, 1.0)).square
    assert not Frame((2000, 1000), (2.003, 1.0)).square


def band_density(scan, low, high):
    """Mean of the spectrum over that of B2 between two wave numbers."""
    found = rings(periodogram([level(scan.heights, Levelling())], scan.size)).between(low, high)
    return np.average(found.density / B2.spectrum(found.wavenumber), weights=found.weight)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("band", [(6e6, 12e6), (14e6, 35e6)])
def test_the_spectrum_is_that_of_the_whole_square(name, band):
    ratio = [
        np.log(band_density(part, *band) / band_density(whole, *band))
        for part, whole in zip(cut(name), SQUARE, strict=True)
    ]
    mean, error = mean_with_error(np.array(ratio))
    assert abs(mean) < 4 * error + 0.01
    assert error < 0.1


@pytest.mark.parametrize("name", PARTS)
def test_the_reach_is_that_of_the_shorter_side_and_the_wider_pixel(name):
    (scan, *_) = cut(name)
    within = reach(scan.size, scan.frame.pixel)
    assert within.low == pytest.approx(1.5 * 2 * np.pi / min(scan.size))
    assert within.nyquist == pytest.approx(np.pi / max(scan.frame.pixel))
    assert within.high == pytest.approx(within.nyquist / 2)
    found = inspect([scan], Settings())
    assert found.wavelengths == pytest.approx(found.fit.corner * min(scan.size) / (2 * np.pi))
    expected = scan.size[0] * scan.size[1] * np.exp(2 * found.moments[0]) / (4 * np.pi**2 * found.spectrum(0.0))
    assert found.areas == pytest.approx(expected)


def test_the_tip_is_felt_along_the_fast_axis():
    (scan, *_) = cut("wide pixels across the lines")
    (whole, *_) = SQUARE
    radius = 100e-9
    near = tip_reach([whole.heights], PIXELS[0], radius)
    assert tip_reach([scan.heights], scan.frame.pixel[0], radius) == pytest.approx(near, rel=0.1)
    assert inspect([scan], Settings(tip_radius=radius)).reach.tip == tip_reach(
        [level(scan.heights, Levelling())], scan.frame.pixel[0], radius
    )


@pytest.mark.parametrize("name", PARTS)
def test_errors_of_the_moments_are_the_scatter_of_drawn_scans(name):
    cutout = list(cut(name, published("B2", SIDE, 48, "oblong errors")))
    model = SurfaceModel(B2.density, B2.spectrum, 1e-6, B2.rms, cutout[0].frame)
    found = np.array([moments(powers(scan.heights)) for scan in cutout])
    ratio = found.std(axis=0, ddof=1) / np.sqrt(np.diag(model.covariance))
    np.testing.assert_allclose(ratio[:2], 1, rtol=0, atol=3.5 / np.sqrt(2 * len(found)))


@pytest.mark.parametrize("name", PARTS)
def test_model_scans_have_the_correlation_of_the_surface_along_both_axes(name):
    (scan, *_) = cut(name)
    model = SurfaceModel(B2.density, B2.spectrum, 1e-6, B2.rms, scan.frame)
    drawn = np.array([model.draw(stream(1, "oblong", k)) for k in range(40)])
    assert drawn.shape[1:] == scan.heights.shape
    lag = 80e-9
    rows, columns = (round(lag / p) for p in scan.frame.pixel)
    along, across = drawn[:, rows:] - drawn[:, :-rows], drawn[:, :, columns:] - drawn[:, :, :-columns]
    first, second = (mean_with_error(np.mean(step**2, axis=(1, 2))) for step in (along, across))
    assert abs(first[0] - second[0]) < 4 * np.hypot(first[1], second[1])
    same = np.array([scan.heights for scan in cut(name)])
    measured, error = mean_with_error(np.mean((same[:, rows:] - same[:, :-rows]) ** 2, axis=(1, 2)))
    assert abs(first[0] - measured) < 4 * np.hypot(first[1], error)


def test_turning_a_scan_swaps_its_axes_only():
    (scan, *_) = cut("long lines")
    found, other = (estimate([z], 1, model_scans=8) for z in (scan, turned(scan)))
    np.testing.assert_allclose(other.inspection.moments, found.inspection.moments, rtol=1e-9)
    np.testing.assert_allclose(other.tile_errors, found.tile_errors, rtol=1e-9)
    np.testing.assert_allclose(other.summits, found.summits, rtol=1e-6)
    np.testing.assert_allclose(other.summit_errors, found.summit_errors, rtol=1e-6)
    np.testing.assert_allclose(other.errors, found.errors, rtol=0.1)
    np.testing.assert_allclose(other.line_jump, found.line_jump[::-1], rtol=1e-9)
    np.testing.assert_allclose(other.model_summits, found.model_summits, rtol=0.1)


def test_summits_of_tiles_are_those_of_the_scan():
    (scan, *_) = cut("long lines")
    whole = summits_of_map(scan.heights, scan.frame)
    found = estimate([scan], 1, model_scans=8)
    np.testing.assert_allclose(found.summits[1], whole[0], rtol=0.1)
    assert np.isnan(estimate([next(cut("wide pixels along the lines"))], 1, model_scans=8).summits).all()


def test_tiles_have_the_proportions_of_the_scan():
    assert {tile.shape for tile in tiles(np.zeros((250, 100)), 4)} == {(62, 25)}


@pytest.mark.parametrize(("pixel", "steps"), [((1.0, 1.0), (1, 1)), ((1.0, 3.0), (3, 1)), ((2.0, 1.0), (1, 2))])
def test_jumps_are_medians_over_the_points_of_a_line(pixel, steps):
    z = stream(1, "jumps").gamma(0.5, size=(41, 67))
    along = [np.median(z[i + steps[0]] - z[i]) for i in range(41 - steps[0])]
    across = [np.median(z[:, j + steps[1]] - z[:, j]) for j in range(67 - steps[1])]
    expected = [np.sqrt(np.mean(np.square(jumps))) for jumps in (across, along)]
    np.testing.assert_allclose(line_jump(z, pixel), expected)


@pytest.mark.parametrize("size", [(2.0, 5.0), (5.0, 2.0)])
def test_two_waves_along_the_lines_are_near_the_slow_axis_whatever_the_other_side(size):
    found = periodogram([np.ones((40, 64))], size)
    np.testing.assert_array_equal(np.flatnonzero(found.near_slow_axis), [0, 1, 2, 38, 39])

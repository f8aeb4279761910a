"""Maps whose lines are copies of each other, and points that are no part of a surface."""

import numpy as np
import pytest

from stiction.errors import ScanError
from stiction.scans.reading import Source, read
from stiction.scans.scan import Scan, stored_once

SIZE = (3.2e-6, 4e-6)


def surface(seed, shape=(48, 60)):
    """Rough map with a correlation of some points [m]."""
    wave = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.fftfreq(shape[1]))
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal(shape))
    rough = np.fft.ifft2(noise / (1 + (20 * wave) ** 3)).real
    return 3e-9 * rough / rough.std()


@pytest.mark.parametrize("times", [(1, 1), (2, 2), (3, 1), (1, 4)])
def test_an_enlarged_map_is_the_map_that_was_enlarged(times, tmp_path):
    heights = surface(sum(times))
    file = tmp_path / "map.txt"
    np.savetxt(file, 1e9 * np.kron(heights, np.ones(times)).T)
    found = read(file, Source(size=SIZE, height_unit="nm"))
    np.testing.assert_allclose(found.scan.heights, heights, atol=1e-15)
    assert found.scan.frame.pixel == pytest.approx((SIZE[0] / 48, SIZE[1] / 60))
    assert any("count once" in note for note in found.notes) == (max(times) > 1)


def test_a_map_whose_lines_stand_there_unequally_often_is_refused():
    heights = np.repeat(surface(1), [2] * 47 + [3], axis=0)
    assert stored_once(heights)[1] == stored_once(surface(1))[1] == (1, 1)
    with pytest.raises(ScanError, match="its lines repeat each other: it is a profile or a pattern"):
        Scan(heights, SIZE)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("period", [2, 7, 60])
def test_a_pattern_of_equal_lines_is_refused(axis, period):
    line = np.resize(np.random.default_rng(period).standard_normal(period), 60)
    heights = 1e-9 * np.tile(line, (60, 1))
    with pytest.raises(ScanError, match="the same height, or none, at all points of different lines"):
        Scan(heights if axis else heights.T, SIZE)


def test_single_points_far_from_all_neighbours_are_named_and_steep_surfaces_have_none():
    heights = surface(2)
    assert Scan(heights, SIZE).standing_out == ""
    assert Scan(np.exp(heights / 3e-9) * 1e-9, SIZE).standing_out == "", "rare high summits have flanks"
    assert Scan(np.random.default_rng(3).normal(0, 1e-9, (200, 200)), SIZE).standing_out == "", "white noise"
    heights[5, 5], heights[20, 30] = 3e-7, -2e-7
    assert Scan(heights, SIZE).standing_out.startswith("2 points stand out of all their neighbours by up to 3")

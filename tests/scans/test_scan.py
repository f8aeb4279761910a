"""A scan: what counts as a height, and what no surface has."""

import numpy as np
import pytest

from stiction.errors import ScanError
from stiction.scans.inspection import Settings, inspect
from stiction.scans.scan import Scan
from stiction.streams import stream

HEIGHTS = 3e-9 * stream(1, "scan").standard_normal((48, 64))
SIZE = (0.96e-6, 1.28e-6)


def refused(heights=HEIGHTS, size=SIZE):
    with pytest.raises(ScanError) as caught:
        Scan(heights, size, "a.spm")
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_masked_infinite_and_missing_heights_are_undefined():
    masked = np.ma.masked_array(HEIGHTS, np.zeros(HEIGHTS.shape, bool))
    masked[3, 4] = np.ma.masked
    infinite = HEIGHTS.copy()
    infinite[3, 4] = np.inf
    missing = HEIGHTS.copy()
    missing[3, 4] = np.nan
    for heights in (masked, infinite, missing, missing.tolist(), missing.astype(np.float32)):
        scan = Scan(heights, SIZE)
        assert type(scan.heights) is np.ndarray
        assert scan.heights.dtype == float
        assert np.argwhere(~scan.defined).tolist() == [[3, 4]]
        assert np.isnan(scan.heights[3, 4])
        assert scan.stopped == ""
    assert masked.mask.sum() == 1
    assert np.isinf(infinite[3, 4])


def test_a_scan_keeps_its_own_copy():
    heights = HEIGHTS.copy()
    scan = Scan(heights, SIZE)
    heights[:] = 0
    np.testing.assert_array_equal(scan.heights, HEIGHTS)


@pytest.mark.parametrize("shape", [(), (3072,), (3, 32, 32), (48, 31), (0, 64)])
def test_what_is_no_map_is_refused(shape):
    shown = " x ".join(map(str, shape)) or "no"
    assert refused(np.resize(HEIGHTS, shape)) == f"files: a.spm has {shown} points, needs 32 along each side of a map"


@pytest.mark.parametrize("size", [(-1e-6, 1e-6), (1e-6, 0), (np.nan, 1e-6), (1e-6, np.inf), (1e-6,), 1e-6, (1e-6,) * 3])
def test_a_size_is_two_lengths(size):
    assert refused(size=size).startswith("size_um: a.spm has a size of ")


#: Factors of the heights and of the size that only a wrong unit gives.
WRONG_UNITS = [(1e9, 1), (1e6, 1), (1e3, 1), (1e-9, 1), (1e-6, 1), (1, 1e3), (1, 1e6), (1, 1e9), (1, 1e-3), (1, 1e-6)]
WRONG_UNITS += [(1e9, 1e9), (1e6, 1e6), (1e3, 1e3), (1e-6, 1e-6), (1e-9, 1e-9)]


@pytest.mark.parametrize(("vertical", "lateral"), WRONG_UNITS)
def test_sizes_heights_and_slopes_in_a_wrong_unit_are_refused(vertical, lateral):
    size = tuple(lateral * length for length in SIZE)
    coarse = 20e-9 * lateral > 10e-6  # 20 nm between points
    cause = "it is too coarse for what touches, or its size is" if coarse else "its size or its heights are"
    assert refused(vertical * HEIGHTS, size).endswith(f": {cause} in another unit than is stated")


@pytest.mark.parametrize(
    ("rms", "pixel"), [(3e-11, 2e-11), (1e-10, 1e-6), (17e-9, 20e-9), (1e-6, 1e-6), (5e-6, 1e-5), (1e-9, 2e-9)]
)
def test_maps_of_all_microscopes_are_scans(rms, pixel):
    tilted = HEIGHTS / HEIGHTS.std() * rms + 0.1 * pixel * np.arange(64)
    assert Scan(tilted, (48 * pixel, 64 * pixel)).undefined_share == 0


@pytest.mark.parametrize("rest", ["zero", "constant", "last line", "earlier lines", "missing"])
@pytest.mark.parametrize("axis", [0, 1])
def test_lines_that_were_not_scanned_are_undefined(rest, axis):
    z = np.moveaxis(HEIGHTS.copy(), axis, 0)
    lines = {"zero": 0.0, "constant": 2e-9, "last line": z[19], "earlier lines": z[:13], "missing": np.nan}[rest]
    z[20:33] = lines
    scan = Scan(np.moveaxis(z, 0, axis), SIZE, "a.spm")
    expected = np.ones(z.shape, bool)
    expected[20:33] = False
    np.testing.assert_array_equal(np.moveaxis(scan.defined, axis, 0), expected)
    assert scan.stopped == "13 empty, constant or repeated lines, as where a scan was stopped"
    words = r"a.spm has (27.1|20.3) % of its points undefined \(13 empty, .* stopped\), and no part without holes that"
    with pytest.raises(ScanError, match=words):
        inspect([scan], Settings())


def test_lines_of_a_finished_scan_are_defined_however_coarse_its_steps_are():
    coarse = np.round(HEIGHTS / 1e-9) * 1e-9
    assert Scan(coarse, SIZE).defined.all()
    assert Scan(coarse[:, :1] + HEIGHTS, SIZE).defined.all()


def test_a_scan_of_a_scan_is_the_same():
    z = HEIGHTS.copy()
    z[:, 60:] = z[:, 59:60]
    once = Scan(z, SIZE)
    np.testing.assert_array_equal(Scan(once.heights, once.size).heights, once.heights)

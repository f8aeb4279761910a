"""A surface in Python: labelled maps, moments and spectrum."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import stiction

CONFIG = stiction.load({"surfaces": {"Mine": {"rms_nm": 5, "like": "B2"}}})


@pytest.fixture(scope="module")
def mine():
    return stiction.Surface.of(CONFIG, "Mine")


def test_a_surface_has_the_stated_moments_and_a_spectrum_whose_integral_is_its_variance(mine):
    assert (mine.rms, mine.skewness, mine.kurtosis) == (5e-9, -0.76, 3.9)
    spectrum, zeta = mine.spectrum, mine.spectrum.wavenumber
    assert spectrum.units == "m4"
    assert_allclose(2 * np.pi * np.trapezoid(zeta * spectrum, zeta), mine.rms**2, rtol=0.01)


def test_drawn_strips_are_labelled_and_numbered(mine):
    strip = mine.draw(2, length=2e-6, width=1e-6)
    assert strip.dims == ("x", "y")
    assert (strip.units, strip.x.units, strip.y.units) == ("m", "m", "m")
    assert_allclose([float(strip.x[-1]), float(strip.y[-1])], [1.99e-6, 0.99e-6])
    xr.testing.assert_identical(strip, mine.draw(2, length=2e-6, width=1e-6))
    assert not np.array_equal(strip, mine.draw(3, length=2e-6, width=1e-6))
    assert mine.draw().shape == (150, 3000)  # strips of the configuration


def test_many_strips_have_the_rms_of_the_surface_and_another_one_is_told_apart(mine):
    squares = np.array([np.mean(mine.draw(k, width=4e-6).values.astype(float) ** 2) for k in range(40)])
    error = squares.std(ddof=1) / np.sqrt(len(squares))
    assert abs(squares.mean() - mine.rms**2) < 4 * error
    assert abs(squares.mean() - (1.3 * mine.rms) ** 2) > 4 * error


def test_a_surface_is_drawn_and_described(mine):
    assert [panel.get_xlabel() for panel in mine.plot().axes[:3]] == [
        "$x_1$ [µm]",
        "height $z$ [nm]",
        "wave number [rad/µm]",
    ]
    assert repr(mine) == "Surface Mine: rms 5 nm, skewness -0.76, kurtosis 3.9"
    with pytest.raises(ValueError, match="there is no surface Yours; the configuration has B1, B2, Mine, Sub1, Sub2"):
        stiction.Surface.of(CONFIG, "Yours")


def test_the_map_of_a_scan_has_its_heights_its_axes_and_its_rms():
    heights = np.random.default_rng(1).normal(0, 2e-9, (40, 50))
    heights[3, 4] = np.nan
    found = stiction.height_map(stiction.Scan(heights, (2e-6, 1e-6), "mine.gwy"))
    np.testing.assert_array_equal(found, heights)
    assert_allclose([float(found.x[1]), float(found.y[1])], [50e-9, 20e-9])
    assert found.attrs["long_name"] == "height of mine.gwy"
    assert_allclose(found.attrs["rms"], np.nanstd(heights))

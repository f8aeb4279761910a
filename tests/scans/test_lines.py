"""Surfaces from lines across them: drawn surfaces whose moments and spectrum are known."""

from functools import cache

import numpy as np
import pytest
from published import SURFACES
from scipy.integrate import quad
from scipy.ndimage import gaussian_filter1d

from stiction.errors import ScanError
from stiction.scans.estimate import Settings as MapSettings
from stiction.scans.inspection import inspect
from stiction.scans.lines.estimate import Settings, estimate_lines
from stiction.scans.lines.spectrum import line_spectrum, waves
from stiction.scans.moments import moments, powers
from stiction.scans.scan import Scan
from stiction.scans.whittle import shape
from stiction.streams import stream
from stiction.surface import self_affine
from stiction.surface.field import StripGrid

RMS, SLOPE, CORNER, STEP = 3e-9, -3.6, 12e6, 25e-9
#: Gaussian surface of Eq. (7) up to the Nyquist wave number of its lines.
SURFACE = self_affine.spectrum(RMS, SLOPE, CORNER, np.pi / STEP)
TRUTH = np.array([np.log(RMS), 0, 3, np.log(CORNER), SLOPE])


def drawn(number, shape=(1024, 512), address="map", spectrum=SURFACE):
    """Periodic Gaussian surface by its definition: waves of random phase, (n1, n2) [m]."""
    first, second = (2 * np.pi * np.fft.fftfreq(n, STEP) for n in shape)
    density = spectrum(np.hypot(first[:, None], second)) * (2 * np.pi / STEP) ** 2 / np.prod(shape)
    rng = stream(1, address, number)
    white = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    return np.fft.fft2(np.sqrt(density) * white).real


def cut(z, count=4):
    """Lines out of a map, far apart."""
    return [z[:, k] for k in range(0, z.shape[1], z.shape[1] // count)]


@pytest.mark.parametrize("slope", [-1.6, -2.2, -3.6, -5])
def test_the_spectrum_along_a_line_is_the_projection_of_that_of_the_surface(slope):
    def projected(k):
        """Integral across the line, from the corner of the plateau on and before it."""
        flat = np.sqrt(max(CORNER**2 - k**2, 0)) / CORNER
        beyond = quad(lambda q: shape(np.hypot(k, q * CORNER), np.log(CORNER), slope), flat, np.inf, limit=500)[0]
        return 2 * CORNER * (flat + beyond)

    wavenumbers = CORNER * np.array([1e-3, 0.3, 0.999, 1, 1.001, 3, 40])
    np.testing.assert_allclose(line_spectrum(wavenumbers, CORNER, slope), list(map(projected, wavenumbers)), rtol=1e-6)


def test_a_power_law_along_a_line_is_flatter_by_one():
    k = CORNER * np.array([10.0, 100.0])
    falls = np.diff(np.log(line_spectrum(k, CORNER, SLOPE))) / np.diff(np.log(k))
    assert falls == pytest.approx(SLOPE + 1, rel=1e-12)


def test_the_periodogram_of_lines_is_the_spectrum_along_them():
    known = waves([line for number in range(6) for line in cut(drawn(number), 8)], STEP)
    ratio = known.power / (SURFACE.plateau * line_spectrum(known.wavenumber, CORNER, SLOPE))
    low = known.wavenumber < 0.25 * np.pi / STEP  # the cut-off takes 3 % at a quarter of it, and more beyond
    error = 1 / np.sqrt(known.weight[low].sum())
    assert abs(np.average(ratio[low], weights=known.weight[low]) - 1) < 4 * error


def estimated(lines, name="lines", settings=None):
    return estimate_lines(lines, STEP, 1, settings, name)


@cache
def of_a_map():
    """A map and the estimate of lines cut out of it."""
    z = drawn(3, (1024, 1024))
    return z, estimated(cut(z))


def test_lines_and_the_map_that_they_are_cut_from_agree():
    z, of_lines = of_a_map()
    of_map = inspect([Scan(z, (1024 * STEP, 1024 * STEP))], MapSettings())
    values = np.array([*of_map.moments, np.log(of_map.fit.corner), of_map.fit.slope])
    assert np.all(np.abs(of_lines.values - values) < 3.5 * of_lines.errors)


def test_the_spectrum_along_a_line_is_no_cut_through_that_of_the_surface():
    """Control: taken as a cut, it gives a slope flatter by 1, far beyond the errors."""
    z, found = of_a_map()
    known = waves(cut(z), STEP)
    steep = known.wavenumber > 2 * CORNER
    as_cut = np.polyfit(np.log(known.wavenumber[steep]), np.log(known.power[steep]), 1, w=np.sqrt(known.weight[steep]))
    assert abs(found.values[4] - SLOPE) < 3.5 * found.errors[4] < abs(as_cut[0] - SLOPE)


@pytest.mark.slow
def test_white_noise_is_found_and_leaves_rms_and_slope():
    lines, noise = cut(drawn(5)), 1e-9
    noisy = [line + noise * stream(1, "noise", k).standard_normal(len(line)) for k, line in enumerate(lines)]
    found = estimated(noisy)
    assert found.noise == pytest.approx(noise, rel=0.2)
    assert np.all(np.abs(found.values - estimated(lines).values) < 2 * found.errors)
    assert moments(powers(np.concatenate(noisy)))[0] > found.values[0] + found.errors[0]
    assert estimated(lines).noise < noise / 2


@pytest.mark.slow
def test_levelling_of_a_bow_leaves_no_bias():
    lines = cut(drawn(6))
    bowed = [line + 20e-9 * np.linspace(-1, 1, len(line)) ** 2 for line in lines]
    bow, plain = estimated(bowed, settings=Settings("bow")), estimated(lines)
    assert np.all(np.abs(bow.values - plain.values) < plain.errors)
    assert estimated(bowed).values[0] > plain.values[0] + 3 * plain.errors[0]


@pytest.mark.nightly
def test_estimates_err_by_their_errors():
    """Errors include another place: their mean square deviation is at most 1, but for the scatter of 24 draws."""
    found = [estimated(cut(drawn(number, address="coverage")), f"coverage-{number}") for number in range(24)]
    ratio = np.mean([((one.values - TRUTH) / one.errors) ** 2 for one in found], axis=0)
    largest = 1 + 3 * np.sqrt(2 / 24)
    assert np.all(ratio < largest)
    assert np.all(3**2 * ratio > largest), "errors of a third would fail"


@pytest.mark.nightly
def test_estimates_of_skewed_heights_err_by_their_errors():
    step = np.pi / SURFACES["B2"].spectrum.cutoff
    surface = SURFACES["B2"].on(StripGrid(30e-6, 2e-6, step, margin=1e-6))
    b2 = SURFACES["B2"]
    truth = [np.log(b2.rms), b2.skewness, b2.kurtosis, np.log(b2.spectrum.corner), b2.spectrum.slope]
    deviations = []
    for number in range(12):
        z = surface.draw(stream(1, "skewed", number)).astype(float)
        found = estimate_lines(cut(z, 3), step, 1, surface=f"skewed-{number}")
        deviations.append((found.values - truth) / found.errors)
    assert np.all(np.mean(np.square(deviations), axis=0) < 1 + 3 * np.sqrt(2 / 12))


@pytest.mark.slow
def test_lines_without_their_short_waves_are_refused_until_these_are_left_out():
    long = self_affine.spectrum(RMS, SLOPE, 3e6, np.pi / STEP)
    filtered = [gaussian_filter1d(line, 1) for line in cut(drawn(8, (8192, 256), spectrum=long))]
    with pytest.raises(ScanError, match="times the χ² of drawn lines: give a longer shortest_nm"):
        estimated(filtered)
    found = estimated(filtered, settings=Settings(shortest=12 * STEP))
    assert abs(found.values[4] - SLOPE) < 3.5 * found.errors[4]


def test_lines_without_a_plateau_are_refused():
    long = self_affine.spectrum(RMS, SLOPE, 1e5, np.pi / STEP)
    with pytest.raises(ScanError, match="too short to show the longest waves"):
        estimated(cut(drawn(7, spectrum=long)))

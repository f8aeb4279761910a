import warnings

import numpy as np
import pytest
from drawn_scans import published
from published import SURFACES
from scipy.signal.windows import tukey

from stiction.scans import periodogram as spectra
from stiction.scans.levelling import Levelling, level
from stiction.scans.periodogram import periodogram, rings, sectors
from stiction.scans.whittle import fit, reach
from stiction.streams import stream

SIDE = 5e-6
SIZE = (SIDE, SIDE)
MAPS = [level(scan.heights, Levelling()) for scan in published("B2", SIDE, 10)]
ISOTROPIC = periodogram(MAPS, SIZE)


def true_spectrum(wavenumber):
    surface = SURFACES["B2"]
    return surface.spectrum(wavenumber) * surface.rms**2 / surface.spectrum.variance


def band_ratios(found):
    """Measured over true spectrum in bands of |ζ| [rad/µm], with standard errors."""
    for low, high in ((4, 8), (8, 14), (14, 25), (25, 50), (50, 100)):
        inside = (found.wavenumber > 1e6 * low) & (found.wavenumber < 1e6 * high)
        ratio = found.density[inside] / true_spectrum(found.wavenumber[inside])
        yield np.average(ratio, weights=found.modes[inside]), 1 / np.sqrt(found.modes[inside].sum())


def test_the_spectrum_of_drawn_scans_is_unbiased():
    # Waves shorter than the corner are harmonics of non-Gaussian heights, with 1.15 times the Gaussian errors.
    assert all(abs(ratio - 1) < 4 * 1.15 * error for ratio, error in band_ratios(rings(ISOTROPIC)))


def test_without_taper_the_edges_add_to_short_waves(monkeypatch):
    monkeypatch.setattr(spectra, "_TAPERED", 0.0)
    ratio, error = list(band_ratios(rings(periodogram(MAPS, SIZE))))[-1]
    assert ratio > 1.3


def test_the_integral_of_the_spectrum_is_the_variance_under_the_window():
    z = stream(1, "white").standard_normal((60, 40))
    found = periodogram([z], (3.0, 5.0))
    window = np.outer(*(tukey(n + 1, 0.5)[:n] for n in z.shape))
    cell = 4 * np.pi**2 / 15
    np.testing.assert_allclose(found.power.sum() * cell, np.mean((z * window) ** 2) / np.mean(window**2), rtol=1e-12)


def test_a_wave_along_the_fast_axis_is_at_its_wave_number():
    x = np.arange(64) * 0.1
    found = periodogram([np.cos(2 * np.pi * 10 / 6.4 * x)[:, None] * np.ones(32)], (6.4, 3.2))
    i, j = np.unravel_index(np.argmax(found.power), found.power.shape)
    first, second = found.wavenumbers
    np.testing.assert_allclose([abs(first[i, 0]), second[0, j]], [2 * np.pi * 10 / 6.4, 0])


@pytest.mark.parametrize("tapered", [0.0, 0.5])
@pytest.mark.slow
def test_rings_of_independent_heights_are_flat_with_the_stated_numbers_of_independent_values(monkeypatch, tapered):
    monkeypatch.setattr(spectra, "_TAPERED", tapered)
    size, count = (2.0, 3.0), 2000
    found = [rings(periodogram([stream(1, "white", k).standard_normal((48, 32))], size)) for k in range(count)]
    density = np.array([ring.density for ring in found])
    expected = 6.0 / (48 * 32) / (4 * np.pi**2)
    inner = slice(3, 16)
    np.testing.assert_allclose(
        density.var(axis=0)[inner] / expected**2 * found[0].modes[inner], 1, rtol=0, atol=5 * np.sqrt(2 / count)
    )
    total = np.average(density[:, inner], weights=found[0].weight[inner], axis=1)
    np.testing.assert_allclose(total.mean(), expected, rtol=4 * total.std() / expected / np.sqrt(count))
    np.testing.assert_allclose(
        total.var() / expected**2 * found[0].weight[inner].sum(), 1, rtol=0, atol=4 * np.sqrt(2 / count)
    )
    neighbours = np.corrcoef(density[:, 9], density[:, 10])[0, 1]
    assert (neighbours > 0.1) == (tapered > 0), "only the taper makes neighbouring rings dependent"


def test_several_scans_have_the_mean_spectrum_and_the_modes_of_all():
    single = [rings(periodogram([z], SIZE)) for z in MAPS]
    found = rings(ISOTROPIC)
    np.testing.assert_allclose(found.density, np.mean([one.density for one in single], axis=0))
    for name in ("modes", "weight"):
        np.testing.assert_allclose(getattr(found, name), len(MAPS) * getattr(single[0], name))


def test_rings_between_two_wave_numbers_keep_their_values():
    found = rings(ISOTROPIC)
    some = found.between(found.wavenumber[3], found.wavenumber[7])
    for name in ("wavenumber", "density", "modes", "weight"):
        np.testing.assert_array_equal(getattr(some, name), getattr(found, name)[3:8])


def test_offsets_and_tilts_of_lines_stay_in_the_band_near_the_slow_axis():
    n = len(MAPS[0])
    offset, tilt = 0.2 * SURFACES["B2"].rms * stream(1, "lines").standard_normal((2, n))
    disturbed = periodogram([z + offset + tilt * np.linspace(-1, 1, n)[:, None] for z in MAPS], SIZE)
    within = reach(SIZE, (20e-9, 20e-9))
    before, after = (fit(rings(found), within) for found in (ISOTROPIC, disturbed))
    np.testing.assert_allclose([after.corner / before.corner, after.slope / before.slope], 1, rtol=0, atol=0.01)
    with_band = fit(rings(disturbed, np.full((n, n), True)), within)
    assert with_band.slope / before.slope < 0.9


def test_pixels_need_not_be_square():
    oblong, square = rings(periodogram([z[:, ::2] for z in MAPS], SIZE)), rings(ISOTROPIC)
    np.testing.assert_allclose(oblong.density[6:24] / square.density[6:24], 1, rtol=0, atol=0.1)


@pytest.mark.parametrize("size", [(SIDE, SIDE), (2 * SIDE, SIDE)])
def test_there_are_no_empty_rings_and_their_wave_numbers_increase(size):
    found = rings(periodogram(MAPS[:1], size))
    assert np.all(np.diff(found.wavenumber) > 0)
    assert np.median(np.diff(found.wavenumber)) == pytest.approx(2 * np.pi / min(size), rel=0.05)
    assert found.modes.min() > 0


def sectors_of(scans, size, low, high):
    found = periodogram(scans, size)
    return sectors(found, rings(found), low, high)


def test_sectors_of_isotropic_surfaces_are_equal_within_their_errors():
    found, error = sectors_of(MAPS, SIZE, 5e6, 80e6)
    np.testing.assert_allclose(found, 1, atol=0.1)
    single, errors = zip(*(sectors_of([z], SIZE, 5e6, 80e6) for z in MAPS), strict=True)
    np.testing.assert_allclose(np.sqrt(10) * error, errors[0])
    scatter = np.std(single, axis=0, ddof=1) / errors[0]
    np.testing.assert_allclose(np.sqrt(np.mean(scatter**2)), 1, rtol=0, atol=4 / np.sqrt(2 * 72))


@pytest.mark.parametrize(("stretch", "along"), [((1.25, 1.0), {3, 4}), ((1.0, 1.25), {0, 7})])
def test_a_stretched_surface_has_more_short_waves_across_the_stretch(stretch, along):
    size = tuple(SIDE * factor for factor in stretch)
    found, _ = sectors_of(MAPS, size, 5e6, 60e6)
    assert found.max() / found.min() > 1.8
    assert set(np.argsort(found)[-2:]) == along


def test_sectors_turn_with_the_waves():
    x = np.arange(128) * 1.0
    angle = np.deg2rad(33.75)  # centre of the second sector
    wave = np.cos(0.8 * (np.cos(angle) * x[:, None] + np.sin(angle) * x))
    noise = 0.01 * stream(1, "white").standard_normal((128, 128))
    assert np.argmax(sectors_of([wave + noise], (128.0, 128.0), 0.3, 1.5)[0]) == 1


def test_levelling_and_spectrum_agree_with_those_of_the_library(monkeypatch):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        library = pytest.importorskip("SurfaceTopography")
    raw = [z + 1e-9 * np.arange(len(z)) for z in MAPS[:2]]
    theirs = [library.Topography(z, SIZE, unit="m").detrend("rms-tilt") for z in raw]
    for z, surface in zip(raw, theirs, strict=True):
        np.testing.assert_allclose(level(z, Levelling("plane")), surface.heights(), rtol=0, atol=1e-9 * z.std())
    monkeypatch.setattr(spectra, "_TAPERED", 0.0)
    periodic = library.Topography(MAPS[0], SIZE, unit="m", periodic=True)  # without a window
    *_, power = periodic.power_spectrum_from_area(return_map=True)
    found = periodogram(MAPS[:1], SIZE).power
    np.testing.assert_allclose(found, power / (4 * np.pi**2), rtol=1e-9, atol=1e-12 * found.max())

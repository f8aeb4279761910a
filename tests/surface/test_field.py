import dataclasses

import numpy as np
import pytest
from published import IDENTITY, SPACING, SURFACES
from scipy import fft
from scipy.stats import norm
from standard_errors import ALLOWED, errors_off

from stiction.streams import stream
from stiction.surface.field import RoughSurface, StripGrid, add_heights, radial_periodogram
from stiction.surface.maxent import GAUSSIAN
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum, autocovariance, correlation_length
from stiction.surface.translation import LARGEST_SCORE, Translation, spectrum_of_heights

#: Whole periodic fields, without edges.
FIELD = StripGrid(1.28e-6, 1.28e-6, SPACING, margin=0)
OBLONG = StripGrid(0.8e-6, 1.6e-6, SPACING, margin=0)
STRIP = StripGrid(0.6e-6, 0.8e-6, SPACING, margin=0.2e-6)
PAPER = StripGrid(1.5e-6, 30e-6, SPACING, margin=1e-6)
published = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)


def draws(surface, count, name="draw"):
    """Independent strips in units of the rms, float64."""
    return np.array([surface.draw(stream(2021, name, k)) / surface.rms for k in range(count)], float)


def moments(heights):
    """First four moments of every strip, (n, 4)."""
    square = heights * heights
    return np.stack([power.mean(axis=(1, 2)) for power in (heights, square, square * heights, square * square)], axis=1)


@published
def test_heights_have_the_moments_of_table_1(surface):
    found = moments(draws(surface.on(FIELD), 200))
    assert errors_off(found, [0, 1, surface.skewness, surface.kurtosis]) < ALLOWED


def test_moments_of_gaussian_heights_differ_significantly_from_those_of_table_1():
    surface = SURFACES["Sub2"]
    found = moments(draws(surface.with_gaussian_heights(FIELD), 200))
    assert errors_off(found, [0, 1, 0, 3]) < ALLOWED
    for moment, wrong in ((0, 0.02), (1, 1.05), (2, surface.skewness), (3, surface.kurtosis)):
        assert errors_off(found[:, moment], wrong) > ALLOWED


@published
def test_share_of_high_points_is_that_of_the_height_density(surface):
    heights = draws(surface.on(FIELD), 200)
    for score in (1.0, 2.0, 3.0):
        above = np.mean(heights > surface.density.quantile_of_normal(score), axis=(1, 2))
        assert errors_off(above, norm.sf(score)) < ALLOWED


def test_negative_skewness_removes_the_highest_points():
    surface = SURFACES["Sub2"]
    skewed, gaussian = (draws(kind(FIELD), 100) for kind in (surface.on, surface.with_gaussian_heights))
    assert errors_off(np.mean(gaussian > 2, axis=(1, 2)), norm.sf(2)) < ALLOWED
    assert errors_off(np.mean(skewed > 2, axis=(1, 2)), norm.sf(2)) > ALLOWED
    assert skewed.max() < gaussian.max()


def test_twice_the_rms_doubles_every_height():
    surface = SURFACES["B1"].on(STRIP)
    doubled = dataclasses.replace(surface, rms=2 * surface.rms)
    np.testing.assert_array_equal(doubled.draw(stream(1)), 2 * surface.draw(stream(1)))


def test_heights_are_translated_scores():
    surface = SURFACES["B2"].on(STRIP)
    scores = dataclasses.replace(surface, translation=IDENTITY, rms=1.0).draw(stream(1)).astype(float)
    expected = surface.rms * surface.translation(scores)
    np.testing.assert_allclose(surface.draw(stream(1)), expected, rtol=0, atol=1e-5 * surface.rms)  # single precision


def test_add_heights_adds_the_heights_interpolated_in_the_table():
    table = SURFACES["Sub2"].translation.table.astype(np.float32)
    scores = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 3000, dtype=np.float32).reshape(30, 100)[:, :99]
    heights = np.ones(scores.shape, np.float32)
    add_heights(scores, table, heights)
    places = np.linspace(-LARGEST_SCORE, LARGEST_SCORE, len(table))
    expected = 1 + np.interp(scores, places, table)
    np.testing.assert_allclose(heights, expected, rtol=0, atol=1e-5)  # |z| < 20 in single precision


def test_scores_outside_the_table_get_the_heights_at_its_ends():
    table = np.linspace(-3, 5, 17, dtype=np.float32)
    scores = np.array([[-9, 9, -np.inf, np.inf, 0]], np.float32)[:, :4]
    heights = np.zeros((1, 4), np.float32)
    add_heights(scores, table, heights)
    np.testing.assert_allclose(heights, [[-3, 5, -3, 5]], rtol=1e-3)


def on_rings(spectrum, grid):
    """Spectrum of unit variance on a square periodic field, averaged over the rings 1, 2, … of wave numbers."""
    n, step = grid.field_shape[0], grid.wavenumber_steps[0]
    axis = fft.fftfreq(n, 1 / n)
    number = np.hypot(axis[:, None], axis)
    plane = spectrum(step * number)
    ring = np.rint(number).astype(int).ravel()
    mean = np.bincount(ring, plane.ravel()) / np.bincount(ring)
    return mean[1 : n // 2 + 1] / (plane.sum() * step**2)


def periodograms(surface, count, name="draw"):
    return np.array([radial_periodogram(z, surface.grid.spacing)[1] for z in draws(surface, count, name)])


def test_periodogram_of_a_plane_wave_is_its_variance_on_the_ring_of_its_wave_number():
    n, amplitude = 32, 3.0
    x = np.arange(n) * SPACING
    step = 2 * np.pi / (n * SPACING)
    wave = amplitude * np.cos(step * (4 * x[:, None] + 3 * x))
    wavenumber, spectrum = radial_periodogram(wave, SPACING)
    np.testing.assert_allclose(wavenumber, step * np.arange(1, 17), rtol=1e-14)
    axis = np.arange(-16, 16)
    points_on_ring = np.sum(np.rint(np.hypot(axis[:, None], axis)) == 5)
    np.testing.assert_allclose(spectrum[4] * points_on_ring * step**2, amplitude**2 / 2, rtol=1e-12)
    assert np.delete(spectrum, 4).max() < 1e-20 * spectrum[4]


@published
def test_spectrum_of_gaussian_surfaces_is_the_target_with_a_control_that_fails(surface):
    found = periodograms(surface.with_gaussian_heights(FIELD), 200)
    expected = on_rings(surface.spectrum, FIELD)
    inside = expected > 0
    assert errors_off(found[:, inside], expected[inside]) < ALLOWED
    assert found[:, ~inside].max(initial=0) < 1e-9 * expected.max()  # single precision
    other = dataclasses.replace(surface.spectrum, corner=1.1 * surface.spectrum.corner)
    assert errors_off(found[:, inside], on_rings(other, FIELD)[inside]) > ALLOWED


@pytest.mark.parametrize("points", [128, 101])
def test_a_periodic_square_has_the_whole_spectrum_with_a_control_that_leaks(points):
    side = points * SPACING
    steep = CutoffSelfAffine(1e-32, 1e-40, 4 * 2 * np.pi / side, np.pi / SPACING)

    def off(grid):
        found = periodograms(RoughSurface(steep, Translation(GAUSSIAN), 1e-9, grid), 100)
        inside = slice(0, int(0.9 * found.shape[1]))  # single precision limits the spectrum in the corners
        return errors_off(found[:, inside], on_rings(steep, grid)[: found.shape[1]][inside])

    grid = StripGrid.periodic(side, SPACING)
    assert grid.shape == grid.field_shape
    assert side < 1.001 * grid.length < 1.1 * side
    assert off(grid) < ALLOWED < off(StripGrid(side - 7 * SPACING, side - 7 * SPACING, SPACING, 7 * SPACING))


@published
def test_spectrum_of_non_gaussian_surfaces_is_that_of_the_translated_field(surface):
    found = periodograms(surface.on(FIELD), 200)
    points = FIELD.field_shape[0]
    heights = spectrum_of_heights(surface.underlying, surface.translation, FIELD.spacing, points)
    inside = slice(0, int(surface.spectrum.cutoff / FIELD.wavenumber_steps[0]) - 1)
    assert errors_off(found[:, inside], heights.density[1:][inside]) < ALLOWED


def iterated_spectrum(surface, grid, strips, iterations=3):
    """Find the spectrum of the Gaussian field by Eq. (6), with periodograms averaged over rings and strips."""
    step, cutoff = grid.wavenumber_steps[0], surface.spectrum.cutoff
    target = on_rings(surface.spectrum, grid)[: int(cutoff / step) - 1]
    correction = np.ones_like(target)
    for _ in range(iterations):
        density = target * correction
        underlying = TabulatedSpectrum(step * np.arange(len(target) + 1), np.r_[density[0], density], cutoff)
        field = RoughSurface(underlying, surface.translation, 1.0, grid)
        correction *= target / periodograms(field, strips, "iterate").mean(axis=0)[: len(target)]
    return underlying


@pytest.mark.parametrize("name", ["B1", "B2"])
def test_iteration_of_fig_4_converges_to_the_spectrum_of_the_hermite_series(name):
    surface, strips = SURFACES[name], 100
    grid = StripGrid(2.56e-6, 2.56e-6, SPACING, margin=0)
    ring = np.arange(
        4, int(surface.spectrum.cutoff / grid.wavenumber_steps[0]) - 1
    )  # of many waves, inside the cut-off
    spectra = (iterated_spectrum(surface, grid, strips), surface.underlying, surface.spectrum)
    iterated, at_once, unchanged = (on_rings(s, grid)[ring - 1] for s in spectra)
    # A ring holds 2πn waves, half of them independent, each with 100 % scatter of its power.
    scatter = 1 / np.sqrt(np.pi * ring * strips)
    off, off_before = (np.sqrt(np.mean(((iterated / s - 1) / scatter) ** 2)) for s in (at_once, unchanged))
    assert off < 2  # the scatter of the variance is common to all rings
    assert off_before > 4


def covariance_along(heights, shift):
    """Mean product of every field with itself, shifted around its period."""
    return np.mean(heights * np.roll(heights, shift, axis=(1, 2)), axis=(1, 2))


def test_surface_is_isotropic_with_a_control_that_fails():
    surface = SURFACES["B1"]
    heights = draws(surface.with_gaussian_heights(OBLONG), 300)
    shifts = [(7, 0), (0, 7), (5, 5), (5, -5)]
    along = np.stack([covariance_along(heights, shift) for shift in shifts], axis=1)
    distance = SPACING * np.array([np.hypot(*shift) for shift in shifts])
    expected = autocovariance(surface.spectrum, distance) / surface.spectrum.variance
    assert errors_off(along, expected) < ALLOWED
    stretched = np.stack([covariance_along(heights, (2 * a, b)) for a, b in shifts], axis=1)
    assert errors_off(stretched, expected) > ALLOWED


def test_non_gaussian_surface_is_isotropic_with_the_translated_autocovariance():
    surface = SURFACES["B1"]
    heights = draws(surface.on(OBLONG), 300)
    along = np.stack([covariance_along(heights, shift) for shift in [(7, 0), (0, 7), (5, 5)]], axis=1)
    distance = SPACING * np.array([7, 7, np.hypot(5, 5)])
    assert errors_off(along, autocovariance(surface.spectrum, distance) / surface.spectrum.variance) < ALLOWED


def test_roughness_is_homogeneous_with_a_control_that_fails():
    heights = draws(SURFACES["B1"].on(STRIP), 400)
    quarters = np.stack(
        [np.mean(q**2, axis=(1, 2)) for half in np.split(heights, 2, 1) for q in np.split(half, 2, 2)], axis=1
    )
    assert errors_off(quarters, 1) < ALLOWED
    edges = np.stack([np.mean(heights[:, i] ** 2, axis=1) for i in (0, -1)], axis=1)
    assert errors_off(edges, 1) < ALLOWED
    assert errors_off(quarters * [1, 1, 1.1, 1.1], 1) > ALLOWED


def test_both_parts_of_every_wave_are_independent_with_a_control_that_fails():
    waves = fft.rfft2(draws(SURFACES["B1"].with_gaussian_heights(FIELD), 20))[:, 1:40, 1:40]
    waves /= np.abs(waves).mean(axis=0)  # all waves count alike
    products = np.stack([waves.real * waves.imag, waves.real * (waves.real + waves.imag)], axis=-1)
    independent, control = (errors_off(part.mean(axis=(1, 2)), 0) for part in np.moveaxis(products, -1, 0))
    assert independent < ALLOWED < control


@published
def test_opposite_edges_of_a_strip_are_uncorrelated(surface):
    margin = correlation_length(surface.spectrum)
    apart = StripGrid(margin, 0.4e-6, SPACING, margin)
    heights = draws(surface.on(apart), 300)
    assert errors_off(np.mean(heights[:, 0] * heights[:, -1], axis=1), 0) < ALLOWED
    closed = dataclasses.replace(apart, margin=0)
    heights = draws(surface.on(closed), 100)
    assert errors_off(np.mean(heights[:, 0] * heights[:, -1], axis=1), 0) > ALLOWED


@pytest.mark.parametrize("translation", [IDENTITY, SURFACES["B1"].translation], ids=["Gaussian", "B1"])
def test_same_stream_gives_the_same_surface_on_a_finer_grid(translation):
    spectrum = SURFACES["B1"].spectrum
    coarse, fine = (
        RoughSurface(spectrum, translation, 1.0, dataclasses.replace(STRIP, spacing=spacing)).draw(stream(1))
        for spacing in (10e-9, 5e-9)
    )
    np.testing.assert_allclose(fine[::2, ::2], coarse, rtol=0, atol=2e-5)  # single precision, heights of a few rms
    assert np.abs(fine[1::2, 1::2] - coarse).max() > 0.01


@pytest.mark.parametrize("spacing", [10e-9, 5e-9, 2.5e-9])
def test_strip_of_the_paper_is_cut_from_the_same_field_on_finer_grids(spacing):
    sizes = [n * spacing for n in dataclasses.replace(PAPER, spacing=spacing).field_shape]
    np.testing.assert_allclose(sizes, [2.5e-6, 31.25e-6], rtol=1e-12)


def test_strip_is_a_part_of_its_field():
    surface = SURFACES["B2"].on(STRIP)
    whole = dataclasses.replace(surface, grid=StripGrid(0.8e-6, 1.0e-6, SPACING, margin=0))
    assert surface.grid.field_shape == whole.grid.shape
    np.testing.assert_array_equal(surface.draw(stream(1)), whole.draw(stream(1))[:60, :80])


def test_field_is_periodic_and_the_strip_is_not():
    heights = SURFACES["B1"].with_gaussian_heights(FIELD).draw(stream(1)).astype(float)
    step = np.abs(np.diff(heights, axis=0)).mean()
    assert np.abs(heights[0] - heights[-1]).mean() < 1.5 * step
    strip = SURFACES["B1"].with_gaussian_heights(PAPER).draw(stream(1)).astype(float)
    assert np.abs(strip[0] - strip[-1]).mean() > 3 * step


def test_strip_of_the_paper_has_150_by_3000_points():
    assert PAPER.shape == (150, 3000)
    for field, strip in zip(PAPER.field_shape, PAPER.shape, strict=True):
        assert field * SPACING >= strip * SPACING + 0.999 * PAPER.margin
    np.testing.assert_allclose(PAPER.wavenumber_steps, 2 * np.pi / (np.array(PAPER.field_shape) * SPACING), rtol=1e-14)


def test_different_streams_give_different_surfaces():
    surface = SURFACES["B1"].on(STRIP)
    first, second = (surface.draw(stream(1, "strip", k)) for k in range(2))
    assert np.abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.3
    np.testing.assert_array_equal(first, surface.draw(stream(1, "strip", 0)))


def test_grid_too_coarse_for_the_waves_is_refused_with_both_numbers():
    coarse = dataclasses.replace(FIELD, spacing=20e-9)
    with pytest.raises(ValueError, match=r"cut-off 2.64e[+]08 rad/m is beyond .* 1.571e[+]08"):
        RoughSurface(SURFACES["Sub1"].spectrum, IDENTITY, 1.0, coarse)


def test_waves_up_to_the_nyquist_number_are_drawn():
    nyquist = CutoffSelfAffine(1e-33, 1e-33, 1e8, np.pi / SPACING)
    heights = draws(RoughSurface(nyquist, IDENTITY, 1.0, FIELD), 50)
    assert errors_off(moments(heights)[:, 1], 1) < ALLOWED


@pytest.mark.parametrize(
    "change",
    [
        *({"spacing": value} for value in (0.0, 1e-6, -10e-9, np.nan)),
        *({side: value} for side in ("length", "width") for value in (-1e-6, np.inf, np.nan)),
    ],
)
def test_grid_without_points_is_refused(change):
    with pytest.raises(ValueError, match="0 < spacing <= strip, got"):
        dataclasses.replace(STRIP, **change)


@pytest.mark.parametrize(("side", "spacing"), [(1e-6, -10e-9), (1e-6, 0.0), (-1e-6, 10e-9), (1e-9, 10e-9)])
def test_a_period_without_points_is_refused(side, spacing):
    with pytest.raises(ValueError, match="0 < spacing <= strip, got"):
        StripGrid.periodic(side, spacing)


@pytest.mark.parametrize("margin", [-1.0, -1e-12, np.nan, np.inf])
def test_a_margin_is_no_negative_length(margin):
    with pytest.raises(ValueError, match=f"a margin of at least 0, got {margin:.3g} m"):
        dataclasses.replace(STRIP, margin=margin)


@pytest.mark.parametrize("rms", [0.0, -1e-9, np.nan, np.inf])
def test_a_rough_surface_has_an_rms(rms):
    with pytest.raises(ValueError, match=f"an rms above 0, got {rms:.3g} m"):
        RoughSurface(SURFACES["B2"].spectrum, IDENTITY, rms, FIELD)

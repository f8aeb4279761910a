import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from published import SURFACES
from scipy import fft
from scipy.special import j1

from stiction.surface.spectrum import (
    CutoffSelfAffine,
    NayakSummits,
    TabulatedSpectrum,
    autocovariance,
    correlation_length,
    radial_spectrum,
    ring_means,
    uncorrelated_beyond,
)

#: Flat up to the cut-off: a disc, for which closed forms exist.
DISC = CutoffSelfAffine(plateau=1e-33, floor=1e-33, corner=1e6, cutoff=1e8)
published = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES)
spectra = st.builds(
    lambda corner, width, decades: CutoffSelfAffine(1e-33, 1e-33 * 10**-decades, corner, width * corner),
    corner=st.floats(1e6, 1e8),
    width=st.floats(1.1, 30),
    decades=st.floats(0, 5),
)


def rings(spectrum):
    """Nodes |ζ| and weights of Gauss' rule: on the plateau, and on 20 panels of ln ζ beyond it."""
    place, weight = np.polynomial.legendre.leggauss(12)
    flat = spectrum.corner * (1 + place) / 2
    edges = np.linspace(np.log(spectrum.corner), np.log(spectrum.cutoff), 21)
    half = (edges[1] - edges[0]) / 2
    tail = np.exp((edges[:-1] + half)[:, None] + half * place)
    return np.r_[flat, tail.ravel()], np.r_[spectrum.corner * weight / 2, (tail * half * weight).ravel()]


def radial_moment(spectrum, order):
    """∫ s ζ^(order + 1) dζ by quadrature."""
    zeta, weight = rings(spectrum)
    return weight @ (spectrum(zeta) * zeta ** (order + 1))


@published
def test_spectrum_is_a_plateau_then_a_power_law_then_zero(surface):
    s = surface.spectrum
    np.testing.assert_allclose(s(np.array([0, 0.5 * s.corner, s.corner])), s.plateau)
    np.testing.assert_allclose(s(s.cutoff), s.floor, rtol=1e-12)
    middle = np.sqrt(s.corner * s.cutoff)
    np.testing.assert_allclose(s(middle), np.sqrt(s.plateau * s.floor), rtol=1e-12)
    assert s(np.nextafter(s.cutoff, np.inf)) == 0


@given(spectra)
def test_power_law_is_straight_in_logarithms_with_the_stated_slope(s):
    zeta = np.geomspace(s.corner, 0.999 * s.cutoff, 7)
    slopes = np.diff(np.log(s(zeta))) / np.diff(np.log(zeta))
    np.testing.assert_allclose(slopes, s.slope, atol=1e-9)


@given(spectra, st.sampled_from([0, 2, 4]))
def test_moment_in_closed_form_equals_quadrature(s, order):
    np.testing.assert_allclose(s.moment(order), radial_moment(s, order), rtol=1e-9)


@pytest.mark.parametrize("order", [0, 2, 4])
def test_moment_is_correct_where_the_power_law_integrates_to_a_logarithm(order):
    slope = -(order + 2)
    s = CutoffSelfAffine(1e-33, 1e-33 * 10.0**slope, 1e7, 1e8)
    np.testing.assert_allclose(s.slope, slope, rtol=1e-14)
    np.testing.assert_allclose(s.moment(order), radial_moment(s, order), rtol=1e-12)


@pytest.mark.parametrize(("name", "rms_nm"), [("B1", 1.74), ("B2", 3.39), ("Sub1", 0.170), ("Sub2", 5.58)])
def test_table_2_with_its_two_corrected_plateaus_gives_the_roughness_of_table_1(name, rms_nm):
    rms = np.sqrt(SURFACES[name].spectrum.variance) * 1e9
    assert float(f"{rms:.3g}") == rms_nm
    np.testing.assert_allclose(rms * 1e-9, SURFACES[name].rms, rtol=0.03)  # parameters of one or two digits


@pytest.mark.parametrize(("name", "rms_nm"), [("B2", 1.20), ("Sub1", 0.0684)])
def test_table_2_as_published_contradicts_table_1(name, rms_nm):
    corrected = SURFACES[name].spectrum
    uncorrected = dataclasses.replace(corrected, plateau=corrected.plateau / 10)
    rms = np.sqrt(uncorrected.variance)
    np.testing.assert_allclose(rms, rms_nm * 1e-9, rtol=5e-3)
    assert rms < 0.5 * SURFACES[name].rms


@published
def test_variance_is_the_integral_over_the_plane_of_wave_numbers(surface):
    s = surface.spectrum
    axis = np.linspace(-1, 1, 2001) * s.cutoff
    plane = s(np.hypot(axis[:, None], axis)).sum() * (axis[1] - axis[0]) ** 2
    np.testing.assert_allclose(s.variance, plane, rtol=1e-4)  # the cut-off circle crosses cells of the sum


@published
def test_autocovariance_at_zero_distance_is_the_variance(surface):
    at_zero = autocovariance(surface.spectrum, np.zeros(1))[0]
    np.testing.assert_allclose(at_zero, surface.spectrum.variance, rtol=1e-5)  # 4000 trapezoids, second order


def test_autocovariance_of_a_disc_is_the_airy_function():
    lag = np.linspace(1e-9, 5e-7, 200)
    airy = 2 * np.pi * DISC.plateau * DISC.cutoff * j1(DISC.cutoff * lag) / lag
    np.testing.assert_allclose(autocovariance(DISC, lag), airy, atol=1e-5 * DISC.variance)


@published
def test_autocovariance_is_the_fourier_transform_of_the_spectrum_in_the_plane(surface):
    points, spacing = 1024, 10e-9
    axis = 2 * np.pi * fft.fftfreq(points, spacing)
    along_x = fft.fft2(surface.spectrum(np.hypot(axis[:, None], axis)) * axis[1] ** 2).real[:50, 0]
    radial = autocovariance(surface.spectrum, spacing * np.arange(50))
    # The cut-off circle crosses cells of the plane, which miss or add some of the variance at the floor.
    np.testing.assert_allclose(along_x, radial, atol=2e-3 * surface.spectrum.variance)


@given(st.floats(0.2, 5))
def test_shorter_waves_compress_the_autocovariance(factor):
    squeezed = CutoffSelfAffine(DISC.plateau, DISC.floor, factor * DISC.corner, factor * DISC.cutoff)
    lag = np.linspace(0, 2e-7, 20)
    np.testing.assert_allclose(
        autocovariance(squeezed, lag), factor**2 * autocovariance(DISC, factor * lag), atol=1e-12 * squeezed.variance
    )


def test_heights_farther_apart_than_the_correlation_length_are_nearly_uncorrelated():
    surface = SURFACES["B2"]
    length = correlation_length(surface.spectrum)
    variance = surface.spectrum.variance
    # Ten points per shortest wave; the steps of the search are half a percent of the corner's wavelength.
    beyond = autocovariance(
        surface.spectrum, np.arange(1.02 * length, 5 * length, 0.2 * np.pi / surface.spectrum.cutoff)
    )
    assert beyond.max() < 0.01 * variance
    np.testing.assert_allclose(autocovariance(surface.spectrum, [length]), 0.01 * variance, rtol=0.05)


def test_search_that_ends_while_heights_are_correlated_is_an_error():
    with pytest.raises(ValueError, match=r"µm apart, 0\.2 wavelengths of the corner"):
        correlation_length(SURFACES["B2"].spectrum, reach=0.2)


def test_heights_that_never_become_uncorrelated_count_as_correlated_up_to_the_end_of_the_search():
    wave = TabulatedSpectrum(np.array([0.99e7, 1e7, 1.01e7]), np.array([0.0, 1e-32, 0.0]), 1.01e7)
    with pytest.raises(
        ValueError, match="3.73 µm apart, 6 wavelengths of the corner of their spectrum, are still corr"
    ):
        correlation_length(wave)
    assert uncorrelated_beyond(wave) == pytest.approx(6 * 2 * np.pi / wave.corner)
    for surface in SURFACES.values():
        assert uncorrelated_beyond(surface.spectrum) == correlation_length(surface.spectrum)


def test_autocovariance_of_a_pure_plateau_decays_most_slowly():
    spectrum = CutoffSelfAffine(DISC.plateau, DISC.floor, 0.999 * DISC.cutoff, DISC.cutoff)
    # The envelope of the Airy function, 2 (2/π)^½ x^(-3/2), falls to 1 % at x = 29.4.
    assert correlation_length(spectrum) * DISC.cutoff < 29.4 < 4.7 * 2 * np.pi


def test_waves_half_as_long_halve_the_correlation_length():
    shorter = CutoffSelfAffine(DISC.plateau, DISC.floor, 2 * DISC.corner, 2 * DISC.cutoff)
    lengths = [correlation_length(s, threshold=0.05, reach=0.2) for s in (DISC, shorter)]
    np.testing.assert_allclose(lengths[0], 2 * lengths[1], rtol=1e-9)


@published
def test_profile_moments_of_nayak_are_moments_along_one_axis_of_the_plane(surface):
    zeta, weight = rings(surface.spectrum)
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)  # exact for powers of the cosine below 16
    along = zeta[:, None] * np.cos(angle)
    density = weight * surface.spectrum(zeta) * zeta
    expected = [2 * np.pi * density @ np.mean(along**order, axis=1) for order in (0, 2, 4)]
    np.testing.assert_allclose(NayakSummits(surface.spectrum).profile_moments, expected, rtol=1e-9)


def test_summits_of_a_disc_are_known_in_closed_form():
    nayak = NayakSummits(DISC)
    m0 = np.pi * DISC.plateau * DISC.cutoff**2
    m4 = np.pi / 8 * DISC.plateau * DISC.cutoff**6
    np.testing.assert_allclose(nayak.bandwidth, 2, rtol=1e-12)
    np.testing.assert_allclose(nayak.density, DISC.cutoff**2 / (12 * np.pi * np.sqrt(3)), rtol=1e-12)
    np.testing.assert_allclose(nayak.mean_curvature, 8 / 3 * np.sqrt(m4 / np.pi), rtol=1e-12)
    np.testing.assert_allclose(DISC.variance, m0, rtol=1e-12)


@given(spectra)
def test_no_isotropic_spectrum_has_a_bandwidth_below_three_halves(s):
    assert NayakSummits(s).bandwidth >= 1.5


def test_tabulated_spectrum_is_linear_between_its_points_and_zero_beyond_its_cutoff():
    s = TabulatedSpectrum(np.array([0.0, 1.0, 2.0]), np.array([4.0, 2.0, 1.0]), cutoff=1.75)
    np.testing.assert_array_equal(s(np.array([0, 0.5, 1, 1.5, 1.75, 1.8, 5])), [4, 3, 2, 1.5, 1.25, 0, 0])


@pytest.mark.parametrize("slope", [-3.0, -4.6, -7.0])
def test_a_table_of_eq_7_has_its_variance_corner_and_correlation(slope):
    corner, cutoff = 1.2e7, 1.25e8
    psd = CutoffSelfAffine(1e-32, 1e-32 * (cutoff / corner) ** slope, corner, cutoff)
    wavenumber = np.linspace(0, 1.5 * cutoff, 4001)
    table = TabulatedSpectrum(wavenumber, psd.plateau * np.maximum(wavenumber / corner, 1) ** slope, cutoff)
    np.testing.assert_allclose(table.variance, psd.variance, rtol=1e-3)
    np.testing.assert_allclose(table.corner, corner * 2 ** (-1 / slope), atol=wavenumber[1])
    np.testing.assert_allclose(correlation_length(table), correlation_length(psd), rtol=0.01)


def test_a_table_without_decay_has_its_corner_at_the_cutoff():
    wavenumber = np.linspace(0, 2e7, 2001)
    table = TabulatedSpectrum(wavenumber, np.full(2001, 1e-32), cutoff=1e7)
    assert table.corner == pytest.approx(1e7, abs=wavenumber[1])
    assert TabulatedSpectrum(wavenumber, table.density, cutoff=2e7).corner == 2e7
    flat = CutoffSelfAffine(1e-32, 1e-32, 0.999e7, 1e7)
    np.testing.assert_allclose(correlation_length(table), correlation_length(flat), rtol=0.01)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"corner": 2e8}, "0 < corner < cutoff, got 2e[+]08, 1e[+]08"),
        ({"corner": -1.0}, "0 < corner < cutoff, got -1"),
        ({"floor": 2e-33}, "0 < floor <= plateau, got 2e-33, 1e-33"),
        ({"floor": 0.0}, "0 < floor <= plateau, got 0"),
        ({"cutoff": np.inf}, "0 < corner < cutoff, got 1e[+]06, inf"),
        ({"cutoff": np.nan}, "0 < corner < cutoff, got 1e[+]06, nan"),
        ({"plateau": np.nan}, "0 < floor <= plateau, got 1e-33, nan"),
        ({"plateau": np.inf}, "plateau <= 1e-12, got inf"),
        ({"plateau": 525.0, "floor": 0.8}, "plateau <= 1e-12, got 525 m⁴: convert nm⁴ by the factor 1e-36"),
        ({"plateau": 0.002, "floor": 0.001}, "convert nm⁴ by the factor 1e-36"),
    ],
)
def test_impossible_spectrum_is_refused_with_its_numbers(change, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(DISC, **change)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wavenumber": [0.0, 2.0, 1.0]}, "wave numbers from 0 on that increase, got 1 rad/m"),
        ({"wavenumber": [0.0, 1.0, 1.0]}, "that increase, got 1 rad/m"),
        ({"wavenumber": [-1.0, 1.0, 2.0]}, "that increase, got -1 rad/m"),
        ({"wavenumber": [0.0, np.nan, 2.0]}, "that increase, got nan rad/m"),
        ({"wavenumber": [0.0, 1.0, np.inf]}, "that increase, got inf rad/m"),
        ({"wavenumber": [0.0, 1.0]}, "a density for each of two or more wave numbers"),
        ({"wavenumber": 1.0, "density": 1.0}, "a density for each of two or more wave numbers"),
        ({"density": [4.0, -1e-9, 1.0]}, "densities of 0 or more, got -1e-09"),
        ({"density": [4.0, np.nan, 1.0]}, "densities of 0 or more, got nan"),
        ({"density": [4.0, 2.0, np.inf]}, "densities of 0 or more, got inf"),
        ({"density": [0.0, 0.0, 1.0]}, "a density above 0 below the cut-off, 1.5 rad/m"),
        ({"cutoff": 0.0}, "a density above 0 below the cut-off, 0 rad/m"),
        ({"cutoff": np.inf}, "a density above 0 below the cut-off, inf rad/m"),
        ({"cutoff": np.nan}, "a density above 0 below the cut-off, nan rad/m"),
    ],
)
def test_an_impossible_table_is_refused_with_its_numbers(change, message):
    table = {"wavenumber": [0.0, 1.0, 2.0], "density": [4.0, 2.0, 1.0], "cutoff": 1.5}
    given = {name: np.array(value) if name != "cutoff" else value for name, value in (table | change).items()}
    with pytest.raises(ValueError, match=message):
        TabulatedSpectrum(**given)


@pytest.mark.parametrize("n", [8, 9])
def test_ring_means_are_plain_means_over_equal_wave_numbers(n):
    values = np.random.default_rng(1).random((n, n))
    numbers = np.fft.fftfreq(n) * n
    radius = np.rint(np.hypot(numbers[:, None], numbers))
    inside = values < 0.7
    for counted, found in ((np.ones((n, n), bool), ring_means(values)), (inside, ring_means(values, inside))):
        for ring, mean in enumerate(found):
            of_ring = values[(radius == ring) & counted]
            np.testing.assert_allclose(mean, of_ring.mean() if of_ring.size else 0.0, rtol=1e-14)
    wavenumber, rings = radial_spectrum(values, 0.5)
    np.testing.assert_array_equal(wavenumber, 0.5 * np.arange(1, n // 2 + 1))
    np.testing.assert_array_equal(rings, ring_means(values)[1 : n // 2 + 1])


def test_waves_far_shorter_than_those_of_the_corner_do_not_change_the_correlation_length():
    lengths = [correlation_length(CutoffSelfAffine(1.0e-30, 1.0e-30 * (cut / 1e6) ** -4.6, 1e6, cut)) for cut in
               (2e7, 2.9e7, 3.1e7, 1e9, 1e12)]  # fmt: skip
    np.testing.assert_allclose(lengths, lengths[0], rtol=0.02)


def test_white_noise_is_correlated_over_its_shortest_waves_alone():
    # r/m₂ = 2 J₁(x)/x with x = cut-off · distance is below 0.01 beyond x = 27.
    cut = np.array([2e6, 2e7, 2.9e7, 3.1e7, 1e8, 1e9, 1e12])
    lengths = np.array([correlation_length(CutoffSelfAffine(1.0e-30, 1.0e-30, 1e6, end)) for end in cut])
    assert np.all(np.diff(lengths) <= 0)
    assert np.all(cut * lengths < 30)
    assert lengths[-1] == 0

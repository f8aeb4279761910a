import dataclasses
import warnings

import numpy as np
import pytest
from drawn_scans import PIXELS, grid, published
from hypothesis import given, settings
from hypothesis import strategies as st
from published import SPACING, SURFACES

from stiction.estimates import mean_with_error
from stiction.scans import whittle
from stiction.scans.inspection import Settings, inspect
from stiction.scans.levelling import Levelling, level
from stiction.scans.periodogram import Rings, periodogram, rings
from stiction.scans.scan import Scan
from stiction.scans.whittle import fit, fit_to_the_end, reach, spectrum, tabulated, tip_reach
from stiction.streams import stream
from stiction.surface.field import StripGrid

SIDE = 10e-6
SIZE = (SIDE, SIDE)
REACH = reach(SIZE, PIXELS)
WAVENUMBER = 2 * np.pi / SIDE * np.arange(1.0, 250)
#: Modes of the rings of one scan of 10 µm.
MODES = 0.6 * np.pi * np.arange(1.0, 250)
B2 = SURFACES["B2"].spectrum


def measured(rng, spectrum=B2, modes=MODES):
    """Rings of one scan of Gaussian heights that are independent of each other: χ² variables about the spectrum."""
    wavenumber = WAVENUMBER[: len(modes)]
    return Rings(wavenumber, spectrum(wavenumber) * rng.gamma(modes) / modes, modes, modes)


def rings_of(scans):
    """Rings of all scans together."""
    return rings(periodogram([level(scan.heights, Levelling()) for scan in scans], scans[0].size))


def parameters(found):
    return np.array([np.log(found.plateau), np.log(found.corner), found.slope])


TRUTH = np.array([np.log(B2.plateau), np.log(B2.corner), B2.slope])


def test_the_reach_ends_at_half_of_the_nyquist_number_and_begins_within_the_scan():
    assert REACH.nyquist == pytest.approx(np.pi / 20e-9)
    assert REACH.high == pytest.approx(REACH.nyquist / 2)
    assert REACH.low == pytest.approx(1.5 * 2 * np.pi / SIDE)
    oblong = reach((SIDE, 2 * SIDE), (20e-9, 40e-9))
    assert (oblong.nyquist, oblong.low) == (pytest.approx(REACH.nyquist / 2), pytest.approx(REACH.low))


def test_a_shortest_wave_and_a_blunt_tip_limit_the_reach():
    assert reach(SIZE, PIXELS, shortest=160e-9).high == pytest.approx(REACH.high / 2)
    assert reach(SIZE, PIXELS, shortest=1e-9).high == REACH.nyquist
    assert reach(SIZE, PIXELS, tip=3e7).high == 3e7
    assert reach(SIZE, PIXELS, tip=3e9).high == REACH.high


@settings(max_examples=15)
@given(st.floats(4, 30), st.floats(-8, -1), st.floats(-2, 2))
def test_an_exact_spectrum_is_found_again(corner, slope, scale):
    exact = dataclasses.replace(
        fit(measured(stream(1)), REACH), plateau=1e-33 * np.exp(scale), corner=1e6 * corner, slope=slope
    )
    density = exact.spectrum(REACH.nyquist)(WAVENUMBER)
    found = fit(Rings(WAVENUMBER, np.where(density > 0, density, 1e-33), MODES, MODES), REACH)
    np.testing.assert_allclose(parameters(found), parameters(exact), rtol=1e-3, atol=1e-3)
    assert found.chi2 < 1e-3


@pytest.mark.slow
def test_errors_are_those_of_the_scatter_and_chi_square_is_one_per_degree_of_freedom():
    found = [fit(measured(stream(1, "whittle", k)), REACH) for k in range(300)]
    values = np.array([parameters(one) for one in found])
    covariance = found[0].covariance / max(found[0].chi2 / found[0].freedom, 1)
    errors = np.sqrt(np.diag(covariance)) / 1.15  # of Gaussian heights
    np.testing.assert_allclose(values.std(axis=0, ddof=1) / errors, 1, rtol=0, atol=4 / np.sqrt(600))
    correlation = covariance / np.outer(*[np.sqrt(np.diag(covariance))] * 2)
    np.testing.assert_allclose(np.corrcoef(values.T), correlation, atol=4 / np.sqrt(300))
    assert np.abs(correlation[np.triu_indices(3, 1)]).max() > 8 / np.sqrt(300)  # control: another sign shows
    assert np.all(np.abs(values.mean(axis=0) - TRUTH) < 4 * errors / np.sqrt(300))
    correlation = np.corrcoef(values.T)[0, 1] - covariance[0, 1] / 1.15**2 / np.prod(errors[:2])
    assert abs(correlation) < 0.2
    assert np.mean([one.chi2 / one.freedom for one in found]) == pytest.approx(1, abs=0.06)


def test_a_smooth_knee_has_a_large_chi_square_and_larger_errors():
    def knee(wavenumber):
        return (1 + (wavenumber / B2.corner) ** 2) ** (B2.slope / 2)

    exact, smooth = (fit(measured(stream(1, "knee"), spectrum, 3 * MODES), REACH) for spectrum in (B2, knee))
    ratio = smooth.chi2 / smooth.freedom
    assert ratio > 3
    errors = [np.sqrt(np.diag(found.covariance))[0] for found in (smooth, exact)]
    assert errors[0] / errors[1] == pytest.approx(np.sqrt(ratio), rel=0.25)


def test_the_fitted_spectrum_is_that_of_drawn_scans():
    found = fit(rings_of(published("B2", SIDE, 3)), REACH)
    scale = SURFACES["B2"].rms ** 2 / B2.variance
    errors = np.sqrt(np.diag(found.covariance))
    assert np.all(np.abs(parameters(found) - TRUTH - [np.log(scale), 0, 0]) < 3.5 * errors)


def test_errors_cover_the_truth_of_drawn_scans_and_chi_square_is_one_per_degree_of_freedom():
    found = [fit(rings_of([scan]), reach(scan.size, PIXELS)) for scan in published("B2", 5e-6, 60, "coverage")]
    off = np.array([(parameters(one) - TRUTH)[1:] / np.sqrt(np.diag(one.covariance))[1:] for one in found])
    within = np.mean(np.abs(off) < 1, axis=0)
    assert np.all((within > 0.56) & (within < 0.86)), within
    assert np.all(np.mean(np.abs(off) < 2, axis=0) > 0.88)
    mean, error = mean_with_error([one.chi2 / one.freedom for one in found])
    assert abs(mean - 1) < 4 * error < 0.12


def test_the_end_of_a_measured_spectrum_is_found():
    ring = rings_of(published("B2", SIDE, 1))  # ends at 125 rad/µm, the Nyquist wave number is 157 rad/µm
    found, within = fit_to_the_end(ring, REACH)
    assert within.end == pytest.approx(B2.cutoff, rel=0.01)
    assert (within.high, found.slope) == (REACH.high, fit(ring, REACH).slope)


def test_a_spectrum_that_ends_within_the_reach_is_fitted_up_to_its_end():
    surface = SURFACES["B2"].on(StripGrid(5e-6, 5e-6, SPACING, 1e-6))
    fine = rings_of([Scan(surface.draw(stream(1, "fine")).astype(float), (5e-6, 5e-6))])
    whole = reach((5e-6, 5e-6), (10e-9, 10e-9))  # up to 157 rad/µm
    found, within = fit_to_the_end(fine, whole)
    assert within.high == within.end == pytest.approx(B2.cutoff, rel=0.01)
    errors = np.sqrt(np.diag(found.covariance))
    assert np.all(np.abs(parameters(found) - TRUTH)[1:] < 3.5 * errors[1:])
    assert abs(fit(fine, whole).slope - B2.slope) > 10 * errors[2]


@pytest.mark.parametrize("name", ["Sub1", "Sub2"])
def test_a_spectrum_that_goes_on_has_no_end(name):
    assert fit_to_the_end(rings_of(published(name, SIDE, 1)), REACH)[1] == REACH


def empty_beyond(spectrum, rng, pixel):
    """Rings of a scan with a pixel [m], and its reach; beyond its end, the spectrum falls as that of drawn scans."""
    within = reach(SIZE, (pixel, pixel))
    wavenumber = 2 * np.pi / SIDE * np.arange(1.0, round(SIDE / (2 * pixel)))
    modes, end = 0.6 * np.pi * np.arange(1.0, len(wavenumber) + 1), spectrum.cutoff
    beyond = 0.1 * float(spectrum(end)) * np.maximum(wavenumber / end, 1.0) ** -20
    density = np.where(wavenumber <= end, spectrum(wavenumber), beyond)
    return Rings(wavenumber, density * rng.gamma(modes) / modes, modes, modes), within


def up_to(end, spectrum=B2):
    """Spectrum with another end [rad m⁻¹]."""
    floor = spectrum.plateau * (end / spectrum.corner) ** spectrum.slope
    return dataclasses.replace(spectrum, floor=floor, cutoff=end)


@pytest.mark.parametrize("pixel", [10e-9, 5e-9, 2.5e-9])
@pytest.mark.parametrize("end", [30e6, 60e6, 125e6])
def test_waves_that_a_surface_does_not_have_change_nothing(end, pixel):
    rings_, within = empty_beyond(up_to(end), stream(1, "empty", round(end)), pixel)
    found, seen = fit_to_the_end(rings_, within)
    errors = np.sqrt(np.diag(found.covariance))
    assert seen.end == pytest.approx(end, rel=0.02)
    assert not found.contradicted
    assert np.all(np.abs(parameters(found) - TRUTH) < 4 * errors)
    whole = fit(rings_, dataclasses.replace(within, high=3 * end))
    assert np.abs(parameters(whole) - TRUTH).max() > 10 * errors.max(), "control: empty rings bend a fit"


def test_a_spectrum_that_becomes_steeper_has_no_end():
    for bend in (1.5, 2, 4):

        def steeper(wavenumber, bend=bend):
            return up_to(1e9)(wavenumber) / (1 + (wavenumber / 3e7) ** bend)

        found, within = fit_to_the_end(measured(stream(1, "steeper", round(2 * bend)), steeper, 10 * MODES), REACH)
        assert (found.contradicted, within.high) == (True, REACH.high)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_a_finer_pixel_of_the_same_map_gives_the_same_spectrum(seed):
    drawn = SURFACES["B2"].on(StripGrid(SIDE, SIDE, 5e-9, 1e-6)).draw(stream(1, "pixels", seed)).astype(float)
    coarse, *finer = (
        fit_to_the_end(rings_of([Scan(drawn[::every, ::every], SIZE)]), reach(SIZE, (every * 5e-9,) * 2))
        for every in (4, 2, 1)
    )
    errors = np.sqrt(np.diag(coarse[0].covariance))
    for found, within in finer:
        assert np.all(np.abs(parameters(found) - parameters(coarse[0])) < 1.5 * errors)
        assert within.end == pytest.approx(coarse[1].end, rel=0.01)


def test_a_spectrum_that_rings_contradict_is_the_measured_one():
    knee = measured(stream(1), lambda wavenumber: B2(wavenumber) / (1 + (wavenumber / 3e7) ** 2), 10 * MODES)
    exact, smooth = (fit(ring, REACH) for ring in (measured(stream(1)), knee))
    assert (exact.contradicted, smooth.contradicted) == (False, True)
    assert spectrum("fitted", exact, knee, REACH, 1e8) == exact.spectrum(1e8)
    np.testing.assert_array_equal(
        spectrum("fitted", smooth, knee, REACH, 1e8).density, tabulated(knee, REACH, smooth.slope, 1e8).density
    )


@pytest.mark.slow
def test_chance_is_no_end_even_in_few_rings():
    within = dataclasses.replace(REACH, nyquist=16.5 * 2e6 * np.pi / 10, high=11.5 * 2e6 * np.pi / 10)
    for k in range(300):
        drawn = measured(stream(1, "chance", k), up_to(1e9), MODES[:16] / 3)
        assert fit_to_the_end(drawn, within)[1].end == within.nyquist


def test_aliases_bias_a_fit_beyond_half_of_the_nyquist_number():
    # Sub1 has roughness up to 264 rad/µm, the Nyquist wave number is 157 rad/µm.
    ring = rings_of(published("Sub1", SIDE, 4))
    half, most = (fit(ring, reach(SIZE, PIXELS, shortest=pixels * 20e-9)) for pixels in (4, 8 / 3))
    true = SURFACES["Sub1"].spectrum.slope
    assert abs(half.slope / true - 1) < 0.015 < 0.02 < abs(most.slope / true - 1)


def test_too_few_rings_are_refused():
    with pytest.raises(ValueError, match="8 rings are needed within the reach of the scan, there are 5"):
        fit(measured(stream(1)), dataclasses.replace(REACH, high=6.5 * 2 * np.pi / SIDE))


def test_a_fitted_spectrum_ends_at_the_cut_off_that_is_asked_for():
    found = fit(measured(stream(1)), REACH)
    near, far = (found.spectrum(cutoff) for cutoff in (1e8, 2e8))
    np.testing.assert_allclose(near(5e7), far(5e7))
    assert (near(1.5e8), near.cutoff, near.slope) == (0, 1e8, pytest.approx(found.slope))


def test_a_tabulated_spectrum_follows_the_rings_within_the_reach():
    ring, within = measured(stream(1)), reach(SIZE, PIXELS, shortest=81e-9)
    found = tabulated(ring, within, -4.0, 1.5e8)
    inside = np.clip(WAVENUMBER, within.low, within.high) == WAVENUMBER
    # Linear interpolation between 2000 points.
    np.testing.assert_allclose(found(WAVENUMBER[inside]), ring.density[inside], rtol=0.05)
    first, last = (ring.density[inside][i] for i in (0, -1))
    np.testing.assert_allclose(found(np.array([0.0, 5e5])), first)
    end = WAVENUMBER[inside][-1]
    np.testing.assert_allclose(found(1.7 * end), last * 1.7**-4, rtol=1e-3)
    assert found(1.6e8) == 0


@pytest.mark.parametrize(("name", "radius"), [("B2", 10e-9), ("B2", 200e-9), ("Sub2", 30e-9), ("Sub2", 100e-9)])
def test_the_reach_of_the_tip_is_that_of_the_library(name, radius):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImportWarning)
        library = pytest.importorskip("SurfaceTopography")
    (scan,) = published(name, 5e-6, 1)
    expected = library.Topography(scan.heights, scan.size, unit="m").scanning_probe_reliability_cutoff(radius)
    found = tip_reach([scan.heights], 20e-9, radius)
    assert found == (np.inf if expected is None else pytest.approx(2 * np.pi / expected, rel=0.1))


def test_a_sharp_point_on_one_of_the_scans_limits_the_reach():
    ripple = 1e-9 * np.cos(2e7 * 20e-9 * np.arange(256))[:, None] * np.ones(8)  # curvature 0.4 per µm
    sharp = ripple.copy()
    sharp[100, 3] += 5e-9
    assert tip_reach([ripple], 20e-9, 1e-6) == np.inf
    assert tip_reach([ripple, sharp], 20e-9, 1e-6) < 1.6e8


@pytest.mark.parametrize(("name", "coarse", "fine"), [("B1", (3, 5, 8), (1,)), ("B2", (8, 12), (1, 3))])
def test_pixels_that_do_not_resolve_the_power_law_are_known_and_leave_smoother_surfaces(name, coarse, fine):
    truth = SURFACES[name].spectrum
    heights = SURFACES[name].on(grid(12e-6)).draw(stream(1, "resolved", name))[::2, ::2].astype(float)

    def inspected(every):
        points = len(heights) // every
        part = heights[: every * points : every, : every * points : every]
        return inspect([Scan(part, (every * points * 20e-9,) * 2)], Settings())

    assert all(inspected(every).is_resolved for every in fine), "control"
    for every in coarse:
        found = inspected(every)
        assert not found.is_resolved
        curvature = [spectrum.moment(4) / spectrum.moment(0) for spectrum in (found.spectrum, truth)]
        assert curvature[0] < curvature[1], "of surfaces of the same rms"


def few_waves(wavelengths, number):
    """Fit to a drawn scan of 64 x 64 points, in which so many wavelengths of the corner fit, and the truth."""
    side = wavelengths * 2 * np.pi / B2.corner
    modes, wavenumber = 0.6 * np.pi * np.arange(1.0, 32), 2 * np.pi / side * np.arange(1.0, 32)
    truth = dataclasses.replace(B2, cutoff=1e12, floor=B2.plateau * (1e12 / B2.corner) ** B2.slope)
    density = truth(wavenumber) * stream(1, "few waves", number).gamma(modes) / modes
    return fit(Rings(wavenumber, density, modes, modes), reach((side, side), (side / 64, side / 64)))


@pytest.mark.parametrize(("wavelengths", "shown"), [(0.4, False), (0.7, False), (1, False), (4, True), (30, False)])
def test_errors_cover_the_truth_of_scans_without_plateau_or_without_power_law(wavelengths, shown):
    found = [few_waves(wavelengths, number) for number in range(60)]
    off = np.array([parameters(one) - TRUTH for one in found])
    assert np.all(np.mean(np.abs(off) < 2 * np.array([one.errors for one in found]), axis=0) >= 0.9)
    # Control: those of the information alone, along all that it shows, miss a corner that no ring shows.
    information = [np.sqrt(np.diag(_by_information(one, wavelengths))) for one in found]
    assert (np.mean(np.abs(off) < 2 * np.array(information), axis=0)[1] >= 0.9) == shown


def _by_information(found, wavelengths):
    """Covariance of a fit by the information of its rings at the best corner."""
    side = wavelengths * 2 * np.pi / B2.corner
    wavenumber = 2 * np.pi / side * np.arange(2.0, 17)
    information = whittle._information(wavenumber, 0.6 * np.pi * np.arange(2.0, 17), np.log(found.corner), found.slope)
    return max(found.misfit, 1) * whittle.NON_GAUSSIAN**2 * np.linalg.pinv(information, hermitian=True)


def test_a_corner_that_no_ring_shows_moves_along_the_power_law_that_they_show():
    found = few_waves(0.5, 3)
    variances, axes = np.linalg.eigh(found.covariance)
    along = axes[:, -1] / axes[1, -1]
    np.testing.assert_allclose(along, [found.slope, 1, 0], atol=1e-2)
    assert variances[-1] > 100 * variances[-2]


def test_an_error_of_all_that_rings_show_is_that_of_their_information():
    found = fit(measured(stream(1)), REACH)
    known = measured(stream(1)).between(REACH.low, REACH.high)
    information = whittle._information(known.wavenumber, known.weight, np.log(found.corner), found.slope)
    scale = whittle.NON_GAUSSIAN**2 * max(found.misfit, 1)
    np.testing.assert_allclose(found.covariance, scale * np.linalg.inv(information), rtol=1e-6, atol=1e-12)

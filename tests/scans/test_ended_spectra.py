"""Maps whose spectrum ends below the Nyquist wave number: drawn with a cut-off, filtered or interpolated.

All are drawn here by filtering white noise with one FFT, without the package.
"""

import dataclasses
import functools

import numpy as np
import pytest
from scipy import ndimage

from stiction.errors import ScanError
from stiction.scans import whittle
from stiction.scans.estimate import estimate
from stiction.scans.inspection import Settings, inspect
from stiction.scans.levelling import Levelling, level
from stiction.scans.periodogram import periodogram, rings, sectors
from stiction.scans.scan import Scan

PIXEL, RMS = 20e-9, 3e-9
NYQUIST = np.pi / PIXEL
NOISES = (0.0, 1e-15, 1e-12, 1e-10)


@dataclasses.dataclass(frozen=True)
class Truth:
    """One drawn map: shape (n1, n2), Eq. (7) [rad/m], noise [m], and whether it is periodic."""

    shape: tuple[int, int]
    corner: float
    slope: float
    cutoff: float
    noise: float
    periodic: bool


def truth(number, longest=12.0):
    """Truth of a number: power laws from 2.5 times the corner to ``longest`` times it."""
    rng = np.random.default_rng([7, number])
    corner = rng.uniform(7e6, 14e6)
    cutoff = min(corner * np.exp(rng.uniform(np.log(2.5), np.log(longest))), 0.6 * NYQUIST)
    shape = ((256, 256), (320, 200), (200, 320), (300, 300))[rng.integers(4)]
    return Truth(shape, corner, rng.uniform(-6, -3), cutoff, NOISES[number % 4], bool(rng.integers(2)))


def field(shape, pixel, spectrum, rng):
    """White noise through a filter, of unit rms on average, (n1, n2)."""
    first, second = (2 * np.pi * np.fft.fftfreq(n, pixel) for n in shape)
    power = spectrum(np.hypot(first[:, None], second))
    power[0, 0] = 0.0
    waves = np.fft.fft2(rng.standard_normal(shape))
    return np.fft.ifft2(np.sqrt(power / power.mean()) * waves).real


def with_end(of, number):
    """Scan of a truth."""
    rng = np.random.default_rng([8, number])
    period = of.shape if of.periodic else tuple(2 * n for n in of.shape)

    def spectrum(wavenumber):
        return np.where(wavenumber <= of.cutoff, np.maximum(wavenumber / of.corner, 1.0) ** of.slope, 0.0)

    z = RMS * field(period, PIXEL, spectrum, rng)[: of.shape[0], : of.shape[1]]
    return Scan(z + of.noise * rng.standard_normal(of.shape), tuple(n * PIXEL for n in of.shape), f"{number}.spm")


def off(found, of):
    """Deviations of corner, slope and end from the truth: in standard errors, and in rings."""
    fit, ring = found.fit, 2 * np.pi / min(found.largest.frame.size)
    deviations = np.array([np.log(fit.corner / of.corner), fit.slope - of.slope]) / fit.errors[1:]
    return *np.abs(deviations), abs(found.reach.end - of.cutoff) / ring


def require_right(number):
    """Require the truth within the errors; or, where a fit is contradicted, the variance of the measured spectrum."""
    of = truth(number)
    found = inspect([with_end(of, number)], Settings())
    if found.fit.contradicted:
        assert found.spectrum_in(found.largest).variance == pytest.approx(np.exp(2 * found.moments[0]), rel=0.25), of
        return False
    corner, slope, end = off(found, of)
    assert max(corner, slope) < 4.5, of
    assert end < 2.5 or of.noise == NOISES[-1], of  # the strongest noise may hide the end
    return True


@functools.cache
def trial_fits():
    """Fits to parts of a periodic map without noise, and the scan."""
    of = Truth((256, 256), 8e6, -4.4, 31e6, 0.0, True)
    scan = with_end(of, 0)
    found = rings(periodogram([level(scan.heights, Levelling())], scan.size))
    reach = whittle.reach(scan.size, scan.frame.pixel)
    highs = np.linspace(of.cutoff, reach.high, 20)
    return of, scan, [whittle.fit(found, dataclasses.replace(reach, high=high)) for high in highs]


def test_trial_fits_beyond_an_end_are_those_of_no_surface_and_stay_trials():
    of, scan, fits = trial_fits()
    refused = 0
    for fit in fits:
        try:
            fit.spectrum(NYQUIST)
        except ValueError:
            refused += 1
        assert np.all(np.isfinite(fit.density(np.linspace(1e6, NYQUIST, 9))))
    assert refused, "control: this map does give fits that the validated class refuses"
    assert max(off(inspect([scan], Settings()), of)) < 3


@pytest.mark.parametrize("number", range(4))
def test_an_end_below_the_nyquist_number_is_found_or_the_measured_spectrum_used(number):
    require_right(number)


@pytest.mark.nightly
def test_ends_of_a_hundred_drawn_maps_are_found_or_the_measured_spectrum_used():
    assert np.mean([require_right(number) for number in range(100, 200)]) > 0.8, "most have an answer by Eq. (7)"


def interpolated(z):
    """Map with twice the points along each side, by zeros around its transform."""
    waves = np.pad(np.fft.fftshift(np.fft.fft2(z)), [(n // 2, n // 2) for n in z.shape])
    return 4 * np.fft.ifft2(np.fft.ifftshift(waves)).real


FILTERS = {
    "Gaussian": lambda z: ndimage.gaussian_filter(z, 2.5, mode="wrap"),
    "mean": lambda z: ndimage.uniform_filter(z, 5, mode="wrap"),
    "FFT": lambda z: interpolated(z[::2, ::2]),
    "splines": lambda z: ndimage.zoom(z[::2, ::2], 2, order=3, mode="grid-wrap", grid_mode=True),
    "lines": lambda z: ndimage.zoom(z[::2, ::2], 2, order=1, mode="grid-wrap", grid_mode=True),
}


@pytest.mark.slow
@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("name", FILTERS)
def test_filtered_and_interpolated_maps_have_the_rms_of_their_heights_and_no_flag_without_number(name, noise):
    rng = np.random.default_rng([9, *name.encode()])
    z = FILTERS[name](RMS * field((360, 360), PIXEL, lambda k: np.maximum(k / 9e6, 1.0) ** -4.2, rng))[:240, :200]
    z = z + noise * rng.standard_normal(z.shape)
    found = estimate([Scan(z, (240 * PIXEL, 200 * PIXEL))], 1, model_scans=6)
    surface = np.sqrt(np.var(z) - found.inspection.largest.noise**2)
    assert abs(found.moments[0] - np.log(surface)) < 3 * found.errors[0]
    assert found.inspection.spectrum_in(found.inspection.largest).variance == pytest.approx(surface**2, rel=0.25)
    assert not any("nan" in sentence for sentence in found.flags)


def test_sectors_leave_out_waves_that_noise_hides():
    of = truth(0)
    scan = with_end(dataclasses.replace(of, noise=1e-10, cutoff=2.5 * of.corner), 0)
    maps = inspect([scan], Settings()).largest
    assert np.any(maps.rings.density == 0), "control: noise hides rings"
    ratio, errors = sectors(maps.periodogram, maps.rings, maps.reach.low, NYQUIST)
    assert np.isfinite([ratio, errors]).all()
    assert abs(ratio.mean() - 1) < 4 * np.sqrt(np.sum(errors**2)) / len(errors)


def test_heights_without_a_spectrum_are_refused_in_one_sentence():
    scan = with_end(Truth((40, 40), 9e6, -4.0, 60e6, 0.0, True), 1)
    with pytest.raises(ScanError, match=r"cannot give a spectrum: 8 rings are needed"):
        inspect([scan], Settings(shortest=400e-9))

"""A surface that follows another, at random offsets."""

import dataclasses

import numpy as np
import pytest
from published import SPACING, SURFACES, streams
from standard_errors import ALLOWED, errors_off

from stiction.surface.field import StripGrid, radial_periodogram
from stiction.surface.replica import Coherence, Replica
from stiction.surface.spectrum import ring_means
from stiction.surface.translation import spectrum_of_heights

FIELD = StripGrid(1.28e-6, 1.28e-6, SPACING, margin=0)
GAUSSIAN = SURFACES["B2"].with_gaussian_heights(FIELD)
PLAY = 15e-9


def sums(stated, surface=GAUSSIAN, count=200):
    """Heights of z₁ + z₂ (count, n1, n2) [nm]."""
    replica = Replica(surface, surface, stated)
    return 1e9 * np.array([replica.draw(*streams(k)) for k in range(count)], float)


def spectrum_of_sum(zeta, coherence, factor):
    """Spectrum of z₁ + z₂ [nm² m²], with a factor of the cross spectrum."""
    one = spectrum_of_heights(GAUSSIAN.underlying, GAUSSIAN.translation, SPACING)(zeta)
    return (1e9 * GAUSSIAN.rms) ** 2 * 2 * one * (1 - coherence * factor)


def test_without_play_nothing_changes():
    np.testing.assert_array_equal(sums(Coherence(0.9, play=0.0), count=2), sums(Coherence(0.9), count=2))
    assert np.any(sums(Coherence(0.9, play=1e-9), count=2) != sums(Coherence(0.9), count=2))


def test_over_normal_offsets_the_cross_spectrum_falls_by_their_characteristic_function():
    """Mean of cos ζ·s over normal s is exp(-ζ²σ²/2): the mean spectrum is isotropic again."""
    power = np.array([radial_periodogram(z, SPACING)[1][1:20] for z in sums(Coherence(0.9, play=PLAY))])
    n = FIELD.shape[0]
    zeta = 2 * np.pi * np.hypot(*np.meshgrid(*[np.fft.fftfreq(n, SPACING)] * 2))
    expected, in_register, uniform = (
        ring_means(spectrum_of_sum(zeta, 0.9, factor), zeta >= 0)[2:21]
        for factor in (np.exp(-((zeta * PLAY) ** 2) / 2), 1.0, np.sinc(zeta * PLAY * np.sqrt(3) / np.pi))
    )
    assert errors_off(power, expected) < ALLOWED
    assert errors_off(power, in_register) > ALLOWED
    assert errors_off(power, uniform) > ALLOWED  # of equal standard deviation, in one direction


def test_variance_grows_with_play_to_that_of_independent_surfaces():
    wide = dataclasses.replace(GAUSSIAN, grid=StripGrid(0.6e-6, 0.8e-6, SPACING, margin=3e-6))
    plays = [0, 10e-9, 30e-9, 100e-9, 20e-6]
    variances = np.array([(sums(Coherence(0.95, play=play), wide) ** 2).mean(axis=(1, 2)) for play in plays])
    assert np.all(np.diff(variances.mean(axis=1)) > 0)
    independent = 2 * (1e9 * wide.rms) ** 2
    assert errors_off(variances[-1], independent) < ALLOWED
    assert errors_off(variances[-2], independent) > ALLOWED


def test_offsets_of_a_sample_depend_neither_on_its_surfaces_nor_on_the_coherence():
    """One number of beams is compared at several coherences with the same offsets."""
    stated = [Coherence(c, play=PLAY) for c in (0.5, 0.9)]
    offsets = [Replica(GAUSSIAN, GAUSSIAN, each)._play(streams(3)[0]) for each in stated]
    np.testing.assert_array_equal(*offsets)
    rng, _ = streams(3)
    GAUSSIAN.draw(rng)
    np.testing.assert_array_equal(Replica(GAUSSIAN, GAUSSIAN, stated[0])._play(rng), offsets[0])


def test_strips_are_off_their_register_by_offset_and_play_together():
    """The mean square is s² + 2σ²."""
    offset = Coherence(0.9, offset=40e-9)
    assert Replica(GAUSSIAN, GAUSSIAN, offset).displacement(streams(0)[0]) == 40e-9
    with_play = Replica(GAUSSIAN, GAUSSIAN, dataclasses.replace(offset, play=PLAY))
    squares = 1e18 * np.array([[with_play.displacement(streams(k)[0]) ** 2] for k in range(400)])
    assert errors_off(squares, 40**2 + 2 * 15**2) < ALLOWED
    assert errors_off(squares, 2 * 15**2) > ALLOWED  # of play alone


@pytest.mark.parametrize("play", [-1e-9, np.inf])
def test_impossible_plays_are_refused(play):
    with pytest.raises(ValueError, match="lengths of 0 or more"):
        Coherence(0.5, play=play)

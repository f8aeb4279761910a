import dataclasses

import numpy as np
import pytest
from published import IDENTITY, SPACING, SURFACES, streams
from scipy import fft
from standard_errors import ALLOWED, errors_off

from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.replica import Coherence, Replica
from stiction.surface.spectrum import ring_means
from stiction.surface.translation import spectrum_of_heights

#: A whole period, without edges.
FIELD = StripGrid(1.28e-6, 1.28e-6, SPACING, margin=0)
STRIP = StripGrid(0.6e-6, 0.8e-6, SPACING, margin=0.4e-6)
B1, B2, SUB1 = (SURFACES[name].on(FIELD) for name in ("B1", "B2", "Sub1"))
GAUSSIAN = SURFACES["B2"].with_gaussian_heights(FIELD)
OFFSET = 55e-9


def drawn(replica, count=100):
    """Heights of beam and substrate in units of their rms, (count, 2, n1, n2)."""
    pairs = []
    for k in range(count):
        substrate = replica.substrate.draw(streams(k)[1])
        pairs.append([(replica.draw(*streams(k)) - substrate) / replica.beam.rms, substrate / replica.substrate.rms])
    return np.array(pairs, float)


def heights_spectrum(surface, zeta):
    """Spectrum of the drawn heights, of unit variance."""
    return spectrum_of_heights(surface.underlying, surface.translation, SPACING)(zeta)


def wave_numbers():
    zeta = 2 * np.pi * fft.fftfreq(FIELD.shape[0], SPACING)
    return zeta[:, None] + 0 * zeta, np.hypot(zeta[:, None], zeta)


def spectra_of(heights):
    """Power of each wave, and cross power of both surfaces (count, n1, n2), in the convention of spectra."""
    one, other = np.moveaxis(fft.fft2(heights) / heights[0, 0].size, 1, 0)
    step = 2 * np.pi / (FIELD.shape[0] * SPACING)
    return np.abs(one) ** 2 / step**2, one * other.conj() / step**2


@pytest.mark.parametrize("surfaces", [(B1, SUB1), (GAUSSIAN, GAUSSIAN)], ids=["skewed", "Gaussian"])
@pytest.mark.parametrize("stated", [Coherence(0.0), Coherence(0.0, above=1e-7, offset=OFFSET)], ids=["all", "long"])
def test_surfaces_without_coherence_are_bit_for_bit_the_independent_ones(surfaces, stated):
    beam, substrate = (dataclasses.replace(surface, grid=STRIP) for surface in surfaces)
    together = Replica(beam, substrate, stated).draw(*streams(3))
    alone = beam.draw(streams(3)[0])
    substrate.add_to(alone, streams(3)[1])
    np.testing.assert_array_equal(together, alone)
    assert np.any(Replica(beam, substrate, Coherence(0.1)).draw(*streams(3)) != alone)


@pytest.mark.parametrize("stated", [Coherence(0.5), Coherence(0.9, offset=OFFSET), Coherence(0.85, above=150e-9)])
def test_a_beam_that_follows_keeps_its_own_moments_and_spectrum(stated):
    heights = drawn(Replica(B1, SUB1, stated))
    z = heights[:, 0]
    surface = SURFACES["B1"]
    moments = np.stack([(z**k).mean(axis=(1, 2)) for k in (1, 2, 3, 4)], axis=1)
    assert errors_off(moments, [0, 1, surface.skewness, surface.kurtosis]) < ALLOWED
    _, zeta = wave_numbers()
    power = [ring_means(one, zeta <= B1.underlying.cutoff)[2:26] for one in spectra_of(heights)[0]]
    expected = ring_means(heights_spectrum(B1, zeta), zeta <= B1.underlying.cutoff)[2:26]
    assert errors_off(np.array(power), expected) < ALLOWED


@pytest.mark.parametrize("surfaces", [(B1, SUB1), (B2, B1), (GAUSSIAN, GAUSSIAN)], ids=["rough", "skewed", "Gaussian"])
@pytest.mark.parametrize("stated", [Coherence(0.8), Coherence(0.8, offset=OFFSET), Coherence(0.7, above=150e-9)])
def test_heights_have_the_stated_coherence_at_every_wave(surfaces, stated):
    along, zeta = wave_numbers()
    _, crossed = spectra_of(drawn(Replica(*surfaces, stated)))
    inside = zeta <= 0.9 * min(surface.underlying.cutoff for surface in surfaces)
    root = np.sqrt(np.prod([heights_spectrum(surface, zeta) for surface in surfaces], axis=0))
    in_register = (crossed * np.exp(1j * along * stated.offset)).real
    rings = np.array([ring_means(one, inside)[2:22] for one in in_register])
    assert errors_off(rings, ring_means(-stated(zeta) * root, inside)[2:22]) < ALLOWED
    if stated.above == 0:  # one that is lower by a tenth is told apart
        assert errors_off(rings, ring_means(-0.9 * stated(zeta) * root, inside)[2:22]) > ALLOWED


def test_coherence_of_heights_is_not_that_of_gaussian_waves_of_skewed_surfaces():
    skewed = dataclasses.replace(B1, translation=SURFACES["Sub2"].translation)
    heights = drawn(Replica(skewed, skewed, Coherence(0.6)))
    correlation = heights.prod(axis=1).mean(axis=(1, 2))
    scores = np.interp(heights, skewed.translation.table, np.linspace(-8, 8, 4097))
    assert errors_off(correlation, -0.6) < ALLOWED
    assert errors_off(scores.prod(axis=1).mean(axis=(1, 2)), -0.6) > ALLOWED


@pytest.mark.parametrize("coherence", [0.0, 0.5, 0.9, 0.99])
def test_sum_of_equal_gaussian_surfaces_has_the_variance_of_the_rest(coherence):
    replica = Replica(GAUSSIAN, GAUSSIAN, Coherence(coherence))
    assert replica.rms**2 == pytest.approx(2 * GAUSSIAN.rms**2 * (1 - coherence), rel=1e-6)
    variances = [np.mean(replica.draw(*streams(k)).astype(float) ** 2) for k in range(200)]
    assert errors_off(np.array(variances), replica.rms**2) < ALLOWED
    assert errors_off(np.array(variances), 1.2 * replica.rms**2) > ALLOWED


def test_waves_along_the_offset_add_up_where_it_is_half_of_them():
    """Spectrum s₁ + s₂ - 2 c √(s₁ s₂) cos(ζ₁ s), of all waves together with the same ζ₁."""
    replica = Replica(GAUSSIAN, GAUSSIAN, Coherence(0.9, offset=OFFSET))
    along, zeta = wave_numbers()
    heights = drawn(replica).sum(axis=1, keepdims=True)
    power = spectra_of(np.repeat(heights, 2, axis=1))[0].sum(axis=2)[:, 1:20]
    expected = 2 * heights_spectrum(GAUSSIAN, zeta) * (1 - 0.9 * np.cos(along * OFFSET))
    assert errors_off(power, expected.sum(axis=1)[1:20]) < ALLOWED
    isotropic = 2 * heights_spectrum(GAUSSIAN, zeta) * (1 - 0.9 * np.cos(zeta * OFFSET))
    assert errors_off(power, isotropic.sum(axis=1)[1:20]) > ALLOWED


def test_a_beam_far_beside_its_register_is_as_rough_as_an_independent_one():
    wide = dataclasses.replace(GAUSSIAN, grid=StripGrid(0.6e-6, 0.8e-6, SPACING, margin=3e-6))
    apart = Replica(wide, wide, Coherence(0.95, offset=1.5e-6))
    variances = np.array([np.mean(apart.draw(*streams(k)).astype(float) ** 2) for k in range(200)])
    assert errors_off(variances, 2 * wide.rms**2) < ALLOWED
    near = Replica(wide, wide, Coherence(0.95, offset=50e-9))
    variances = np.array([np.mean(near.draw(*streams(k)).astype(float) ** 2) for k in range(200)])
    assert errors_off(variances, 2 * wide.rms**2) > ALLOWED


def test_a_full_replica_needs_the_opposite_skewness():
    with pytest.raises(ValueError, match=r"is 0.97, must be at most 0\.\d+ for .* opposite skewness"):
        Replica(B2, B2, Coherence(0.97)).require_feasible()
    Replica(B2, B2, Coherence(0.85)).require_feasible()
    turned = dataclasses.replace(B2, translation=_Opposite(B2.translation))
    replica = Replica(turned, B2, Coherence(0.999))
    replica.require_feasible()
    assert replica.rms**2 == pytest.approx(2 * B2.rms**2 * (1 - 0.999), rel=0.01)


@dataclasses.dataclass(frozen=True)
class _Opposite:
    """Heights -g(-u) of a translation g: the same surface upside down."""

    original: object

    @property
    def table(self):
        return -self.original.table[::-1]

    @property
    def hermite_coefficients(self):
        return self.original.hermite_coefficients * (-1.0) ** np.arange(24)

    def autocorrelation(self, underlying):
        return self.original.autocorrelation(underlying)


@pytest.mark.parametrize("wrong", [{"coherence": 1.1}, {"coherence": -0.1}, {"above": -1e-9}, {"offset": np.inf}])
def test_impossible_coherences_are_refused(wrong):
    with pytest.raises(ValueError, match="need a coherence from 0 to 1 and lengths of 0 or more"):
        Coherence(**{"coherence": 0.5} | wrong)


def test_surfaces_on_different_grids_cannot_follow_each_other():
    with pytest.raises(ValueError, match="on the same grid"):
        Replica(B1, dataclasses.replace(SUB1, grid=STRIP), Coherence(0.5))


def test_waves_that_one_surface_alone_has_are_its_own():
    """Beyond the cut-off of one surface, the sum has the spectrum of the other."""
    rough = RoughSurface(SURFACES["Sub1"].spectrum, IDENTITY, 1e-9, FIELD)
    _, zeta = wave_numbers()
    beyond = (zeta > 1.05 * B1.underlying.cutoff) & (zeta <= rough.underlying.cutoff)
    gaussian = SURFACES["B1"].with_gaussian_heights(FIELD)
    together = spectra_of(drawn(Replica(rough, gaussian, Coherence(0.9)), 20))[0][:, beyond]
    alone = spectra_of(drawn(Replica(rough, gaussian, Coherence(0.0)), 20))[0][:, beyond]
    np.testing.assert_allclose(together, alone, rtol=2e-3)

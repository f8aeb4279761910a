r"""Two facing surfaces, one of which follows the other: a beam deposited on a film that lay on its substrate.

Heights point towards the other surface, so that a full replica is z₁ = -z₂. Waves of both have the cross spectrum

.. math:: -c(\zeta) \sqrt{s_1 s_2} \, e^{-i \zeta_1 s},

with the coherence c and the offset s along the beam, and z₁ + z₂ has the spectrum
:math:`s_1 + s_2 - 2 c \sqrt{s_1 s_2} \cos \zeta_1 s`. Both surfaces keep their own spectra and moments.

With play, every strip comes down at an offset of its own. ASSUME: its components along and across the beam are normal,
of equal standard deviation σ, and added to s. Averaged over strips, the cosine has a factor
:math:`e^{-\zeta^2 \sigma^2 / 2}`. A beam moves as one body: `stiction.devices.strips` puts strips with nearly equal
displacements under one beam.

The underlying Gaussian waves are correlated. With orthonormal Hermite polynomials :math:`g_1 = \sum a_k h_k` and
:math:`g_2 = \sum b_k h_k`, the cross-correlation of the heights is :math:`\sum a_k b_k \rho^k`, where ρ is that of the
Gaussian fields. It increases with ρ, so that its inverse gives the coherence of the Gaussian waves.
"""

from bisect import bisect_left
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import fft

from stiction.surface.field import RoughSurface
from stiction.surface.spectrum import ring_means
from stiction.surface.translation import on_square, square

#: Points along each side of the periodic square of the transforms, as in `stiction.surface.translation`.
_POINTS = 1024
#: Correlations ρ at which that of the heights is tabulated: linear interpolation errs by 1e-9.
_CORRELATIONS = np.linspace(-1, 1, 20001)
#: ASSUME: relative error of the rms of z₁ + z₂ that an unfeasible coherence of some waves may cause: 2 % of a length.
ALLOWED = 0.05


@dataclass(frozen=True)
class Coherence:
    """Coherence of the heights of two surfaces that face each other, by wave."""

    coherence: float  #: c of the waves that are copied [-]
    above: float = 0.0  #: wavelength above which waves are copied; all by default [m]
    offset: float = 0.0  #: distance along the beam by which it lies beside its register [m]
    play: float = 0.0  #: standard deviation of a random offset in each direction, added to this one [m]

    def __post_init__(self):
        lengths = self.above, self.offset, self.play
        if not (0 <= self.coherence <= 1 and all(0 <= length < np.inf for length in lengths)):
            raise ValueError(
                f"need a coherence from 0 to 1 and lengths of 0 or more, got {self.coherence:.4g}, {self.above:.4g}, "
                f"{self.offset:.4g} and {self.play:.4g} m"
            )

    def __call__(self, wavenumber: np.ndarray) -> np.ndarray:
        """Coherence at |ζ| [-], shape of ``wavenumber`` [rad m⁻¹]."""
        return np.where(self.copies(wavenumber), self.coherence, 0.0)

    def copies(self, wavenumber: np.ndarray) -> np.ndarray:
        """Whether waves are copied, bool of the shape of ``wavenumber`` [rad m⁻¹]."""
        return wavenumber * self.above < 2 * np.pi


@dataclass(frozen=True)
class Replica:
    """Beam whose waves follow those of its substrate."""

    beam: RoughSurface
    substrate: RoughSurface
    of_heights: Coherence

    def __post_init__(self):
        if self.beam.grid != self.substrate.grid:
            raise ValueError("surfaces that follow each other must be drawn on the same grid")

    @property
    def rms(self) -> float:
        """Root mean square of z₁ + z₂, as far as the stated coherence is feasible [m]."""
        return self._rms_of_sum(self._waves.reached)

    def refusal(self, allowed: float = ALLOWED) -> str | None:
        """Refusal of a coherence that two surfaces with these moments cannot have, the end of a sentence about it.

        They have it if z₁ + z₂ is rougher than stated by at most ``allowed`` of its rms. Unless they have opposite
        skewness, no surface is the negative of the other.
        """
        if self._reaches(allowed):
            return None
        return (
            f"must be at most {self._largest(allowed):g} for surfaces with these moments: their sum would have an rms "
            f"of {1e9 * self.rms:.3g} in place of {1e9 * self._rms_of_sum(self._waves.correlation):.3g} nm; a full "
            "replica has the opposite skewness of its original"
        )

    def require_feasible(self) -> None:
        """Raise a `refusal` as ``ValueError``."""
        if refusal := self.refusal():
            raise ValueError(f"coherence of heights is {self.of_heights.coherence:g}, {refusal}")

    def _reaches(self, allowed):
        """Whether z₁ + z₂ is rougher than stated by at most a share of its rms."""
        return self.rms <= (1 + allowed) * self._rms_of_sum(self._waves.correlation)

    def _largest(self, allowed):
        """Largest coherence that these surfaces reach, in steps of 0.01 below the stated one [-]."""
        steps = range(int(100 * self.of_heights.coherence) + 1)
        lower = [replace(self, of_heights=replace(self.of_heights, coherence=k / 100)) for k in steps]
        return max(bisect_left(lower, True, key=lambda other: not other._reaches(allowed)) - 1, 0) / 100

    def _rms_of_sum(self, correlation):
        """Root mean square of z₁ + z₂ with this correlation of the heights in register [m]."""
        upper, lower = self.beam.rms, self.substrate.rms
        return float(np.hypot(upper - lower, np.sqrt(2 * max(1 + correlation, 0.0) * upper * lower)))

    @cached_property
    def _waves(self):
        return _gaussian_waves(self.beam, self.substrate, self.of_heights)

    @cached_property
    def _mixing(self):
        """Waves that both surfaces have: places, share of own ones, factor of the substrate's, and components.

        Components ζ₁ and ζ₂ are (2, n) [rad m⁻¹].
        """
        (beam_waves, amplitude, _), (other, amplitude_of_other, _) = self.beam.modes, self.substrate.modes
        places, of_own, of_other = np.intersect1d(beam_waves, other, assume_unique=True, return_indices=True)
        n1, _ = self.beam.grid.field_shape
        step1, step2 = self.beam.grid.wavenumber_steps
        zeta1, zeta2 = step1 * ((places + n1 // 2) % n1 - n1 // 2), step2 * (places // n1)
        coherence = self._waves.coherence(np.hypot(zeta1, zeta2))
        ratio = amplitude[of_own] / amplitude_of_other[of_other]
        factor = -coherence * ratio * np.exp(-1j * zeta1 * self.of_heights.offset)
        return places, np.sqrt(1 - coherence**2).astype(np.float32), factor.astype(np.complex64), (zeta1, zeta2)

    def draw(self, beam_rng: np.random.Generator, substrate_rng: np.random.Generator) -> np.ndarray:
        """Draw one strip of z₁ + z₂, (n1, n2) float32 [m]. Without coherence it is that of independent surfaces."""
        substrate_waves = self.substrate.waves(substrate_rng)
        heights = self._beam_above(substrate_waves, beam_rng)
        self.substrate.add_waves(heights, substrate_waves)
        return heights

    def draw_beam(self, beam_rng: np.random.Generator, substrate_rng: np.random.Generator) -> np.ndarray:
        """Draw one strip of z₁, (n1, n2) float32 [m]."""
        return self._beam_above(self.substrate.waves(substrate_rng), beam_rng)

    def displacement(self, beam_rng: np.random.Generator) -> float:
        """Distance from the register of the strip of a stream [m]."""
        return float(np.hypot(*(self._play(beam_rng) + (self.of_heights.offset, 0))))

    def _beam_above(self, substrate_waves, rng):
        """Draw one strip of z₁ above a substrate with these waves, (n1, n2) float32 [m]."""
        waves, heights = self.beam.waves(rng), np.zeros(self.beam.grid.shape, np.float32)
        places, share, factor, zeta = self._mixing
        if self.of_heights.play:
            factor = factor * np.exp(-1j * (self._play(rng) @ zeta)).astype(np.complex64)
        waves[places] = share * waves[places] + factor * substrate_waves[places]
        self.beam.add_waves(heights, waves)
        return heights

    def _play(self, rng):
        """Draw a random offset, along and across the beam (2,) [m], from a stream of its own.

        Surfaces half a period apart are independent. Farther ones would near the next period.
        """
        grid, offset = self.beam.grid, np.array([self.of_heights.offset, 0.0])
        half = np.array(grid.field_shape) * grid.spacing / 2
        moved = offset + self.of_heights.play * rng.spawn(1)[0].standard_normal(2)
        return np.clip(moved, -half, half) - offset


@dataclass(frozen=True)
class _GaussianWaves:
    """Coherence of the Gaussian waves of two surfaces, and the correlation of their heights in register."""

    of_heights: Coherence
    tables: tuple  #: wave numbers (n,) [rad m⁻¹] and coherences (n,) [-] of waves that are copied, and of the others
    correlation: float  #: of the heights, as stated [-]
    reached: float  #: correlation of the drawn heights [-]

    def coherence(self, wavenumber):
        """Coherence at |ζ| [-], shape of ``wavenumber`` [rad m⁻¹]."""
        return _tabulated(self.of_heights, self.tables, wavenumber)


def _tabulated(coherence, tables, wavenumber):
    """Coherence at |ζ| from the tables of copied and other waves, between which it is not continuous."""
    copied, others = (np.interp(wavenumber, *table) if len(table[0]) else 0.0 for table in tables)
    return np.where(coherence.copies(wavenumber), copied, others)


def _gaussian_waves(beam, substrate, coherence):
    """Coherence of the Gaussian waves for a stated one of the heights, as far as it is feasible."""
    zeta, _ = square(beam.grid.spacing, _POINTS)
    gaussian, heights = zip(*(_spectra(surface, zeta) for surface in (beam, substrate)), strict=True)
    upper, lower = (surface.translation.hermite_coefficients for surface in (beam, substrate))
    powers = np.r_[0.0, upper * lower / np.sqrt(np.sum(upper**2) * np.sum(lower**2))]
    of_heights = np.polynomial.polynomial.polyval(_CORRELATIONS, powers)
    target = fft.fft2(-coherence(zeta) * np.sqrt(heights[0] * heights[1])).real
    crossed = fft.ifft2(np.interp(target, of_heights, _CORRELATIONS)).real
    inside = zeta <= min(beam.underlying.cutoff, substrate.underlying.cutoff)
    joint, copied = np.where(inside, np.sqrt(gaussian[0] * gaussian[1]), 0.0), coherence.copies(zeta)
    tables = [_table(-crossed, joint, inside & waves, zeta[0, 1]) for waves in (copied, ~copied)]
    correlation = -np.sum(_tabulated(coherence, tables, zeta) * joint)
    return _GaussianWaves(coherence, tables, target[0, 0], float(np.interp(correlation, _CORRELATIONS, of_heights)))


def _table(crossed, joint, inside, step):
    """Wave numbers of the rings with some waves [rad m⁻¹], and their ratio of spectra (n, n), from 0 to 1 [-]."""
    across, along = ring_means(crossed, inside), ring_means(joint, inside)
    rings = np.flatnonzero(along)
    return step * rings, np.clip(across[rings] / along[rings], 0, 1)


def _spectra(surface, zeta):
    """Spectra on a square (n, n) of the Gaussian field and of the heights of a surface, each of unit sum."""
    gaussian = on_square(surface.underlying, zeta)
    gaussian = gaussian / gaussian.sum()
    heights = fft.ifft2(surface.translation.autocorrelation(fft.fft2(gaussian).real)).real
    return gaussian, np.maximum(heights, 0)  # rounding may make it negative

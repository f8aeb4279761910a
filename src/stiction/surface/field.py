"""Random rough surfaces on a grid (Sec. II-B): strips cut from periodic fields. The fields are drawn by FFT."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from stiction.kernels import kernel
from stiction.rounding import is_at_most
from stiction.surface.normals import standard_normal
from stiction.surface.spectrum import Spectrum, radial_spectrum, require_resolved
from stiction.surface.translation import LARGEST_SCORE, TranslationMap


@dataclass(frozen=True)
class StripGrid:
    """Points of a strip of surface, l_meso x w, and of the wider periodic field around it."""

    length: float  #: along the beam, l_meso [m]
    width: float  #: across the beam, w [m]
    spacing: float  #: of the grid points [m]
    margin: float  #: smallest distance between opposite edges of a strip across the period of its field [m]

    def __post_init__(self):
        sides = self.length, self.width
        if not (self.spacing > 0 and all(is_at_most(self.spacing, side) and side < np.inf for side in sides)):
            raise ValueError(
                f"need 0 < spacing <= strip, got {self.spacing:.3g} and {self.length:.3g} x {self.width:.3g} m"
            )
        if not 0 <= self.margin < np.inf:
            raise ValueError(f"need a margin of at least 0, got {self.margin:.3g} m")

    @classmethod
    def periodic(cls, side: float, spacing: float) -> "StripGrid":
        """Square of about a side [m], a whole period, so its spectrum has no leakage."""
        points, _ = cls(side, side, spacing, margin=0.0).shape
        length = fft.next_fast_len(points, real=True) * spacing
        return cls(length, length, spacing, margin=0.0)

    @property
    def shape(self) -> tuple[int, int]:
        """Points of the strip (along the beam, across)."""
        return round(self.length / self.spacing), round(self.width / self.spacing)

    @property
    def field_shape(self) -> tuple[int, int]:
        """Points of the periodic field, of a size fast in the FFT."""
        return tuple(fft.next_fast_len(n + round(self.margin / self.spacing), real=True) for n in self.shape)

    @property
    def wavenumber_steps(self) -> tuple[float, float]:
        """Δζ₁, Δζ₂ of the field [rad m⁻¹]."""
        return tuple(2 * np.pi / (n * self.spacing) for n in self.field_shape)


@dataclass(frozen=True)
class RoughSurface:
    """Stationary rough surface: underlying Gaussian spectrum, translation and rms.

    ASSUME: the rms of Table I sets the heights, Table II only the shape of the spectrum; they differ by 2.5 % in rms at
    most.
    """

    underlying: Spectrum  #: of the Gaussian field; its scale has no effect
    translation: TranslationMap  #: Eq. (5)
    rms: float  #: [m]
    grid: StripGrid

    def __post_init__(self):
        require_resolved(self.underlying.cutoff, self.grid.spacing)
        if not 0 < self.rms < np.inf:
            raise ValueError(f"need an rms above 0, got {self.rms:.3g} m")

    @cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray, int]:
        """Waves of the half plane ζ₂ >= 0 up to the cut-off.

        Position in the (ζ₂, ζ₁) array and amplitude, (n,) int and float32, and the number of rows ζ₂ of that array.

        The order of the waves depends on the size of the field, not on its spacing, so that the same stream gives the
        same surface on a finer grid.
        """
        n1, n2 = self.grid.field_shape
        step1, step2 = self.grid.wavenumber_steps
        far1, far2 = (
            min(int(self.underlying.cutoff / step1), (n1 - 1) // 2),
            min(int(self.underlying.cutoff / step2), (n2 - 1) // 2),
        )
        k2, k1 = np.mgrid[0 : far2 + 1, -far1 : far1 + 1]
        # A wave with ζ₂ > 0 also represents its mirror image: half of the variance each, twice the amplitude.
        share = np.where(k2 == 0, 1.0, 0.5) * self.underlying(np.hypot(k1 * step1, k2 * step2))
        variance = share / np.sum(share * np.where(k2 == 0, 1, 4))
        inside = np.hypot(k1 * step1, k2 * step2) <= self.underlying.cutoff
        return (k2 * n1 + k1 % n1)[inside], np.sqrt(variance[inside]).astype(np.float32), far2 + 1

    @cached_property
    def table(self) -> np.ndarray:
        """Heights of equally spaced normal scores, (n,) float32 [m]."""
        return (self.rms * self.translation.table).astype(np.float32)

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        """Draw one strip of heights z = rms · g(u), Eq. (5), (n1, n2) float32 [m]."""
        heights = np.zeros(self.grid.shape, np.float32)
        self.add_to(heights, rng)
        return heights

    def add_to(self, heights: np.ndarray, rng: np.random.Generator) -> None:
        """Draw one strip and add it to ``heights`` (n1, n2) float32 [m]."""
        self.add_waves(heights, self.waves(rng))

    def waves(self, rng: np.random.Generator) -> np.ndarray:
        """Draw the waves of the standard Gaussian field at all places of `modes`, (n,) complex64."""
        position, amplitude, columns = self.modes
        waves = np.zeros(columns * self.grid.field_shape[0], np.complex64)
        _scatter(standard_normal(rng, 2 * len(position)), amplitude, position, waves.view(np.float32))
        return waves

    def add_waves(self, heights: np.ndarray, waves: np.ndarray) -> None:
        """Add the strip with these `waves`, which are overwritten, to ``heights`` (n1, n2) float32 [m]."""
        field = fft.irfft(self._waves_across(waves), n=self.grid.field_shape[1], axis=1, norm="forward")
        add_heights(field, self.table, heights)

    def _waves_across(self, waves):
        """Waves ζ₂ >= 0 across each line of the strip, up to the Nyquist wave number, complex64.

        The inverse transform would copy an input that is not contiguous or shorter.
        """
        n1, n2 = self.grid.field_shape
        along = fft.ifft(waves.reshape(-1, n1), axis=1, norm="forward", overwrite_x=True)
        across = np.zeros((self.grid.shape[0], n2 // 2 + 1), np.complex64)
        across[:, : len(along)] = along.T[: len(across)]
        return across


@kernel
def _scatter(normals, amplitude, position, parts):
    """Write the waves to their places: real and imaginary parts (2 n,), from normal numbers (2 n,) and amplitudes."""
    for k in range(position.size):
        real = np.uint64(2 * position[k])  # without a sign, so that it cannot count from the end
        parts[real] = normals[2 * k] * amplitude[k]
        parts[real + np.uint64(1)] = normals[2 * k + 1] * amplitude[k]


@kernel
def add_heights(scores: np.ndarray, table: np.ndarray, heights: np.ndarray) -> None:
    """Add the heights of normal scores, by interpolation in a table over ±``LARGEST_SCORE``.

    ``scores`` (n1, n2 or more) float32 are used in the columns of ``heights`` (n1, n2) float32.
    """
    cells, fractions = np.empty(heights.shape[1], np.int32), np.empty(heights.shape[1], np.float32)
    for i in range(heights.shape[0]):
        _locate(scores[i], table.size, cells, fractions)
        _add_row(cells, fractions, table, heights[i])


# Two loops, because only one without a look-up computes several points at a time.


@kernel
def _locate(scores, points, cells, fractions):
    """Cells of normal scores in a table of this number of points, and their positions within the cells."""
    scale, offset = np.float32((points - 1) / (2 * LARGEST_SCORE)), np.float32((points - 1) / 2)
    last = np.float32(points - 1.001)
    for j in range(cells.size):
        position = min(max(scores[j] * scale + offset, np.float32(0)), last)
        cells[j] = np.int32(position)
        fractions[j] = position - np.float32(cells[j])


@kernel
def _add_row(cells, fractions, table, heights):
    """Add the heights at these places of a table."""
    for j in range(heights.size):
        k = np.uint32(cells[j])  # without a sign, so that it cannot count from the end of the table
        heights[j] += table[k] + fractions[j] * (table[k + np.uint32(1)] - table[k])


def radial_periodogram(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Spectrum of one periodic field, averaged over rings of equal |ζ|. Convention of `stiction.surface.spectrum`.

    Parameters
    ----------
    heights : (n, n) array
        One period [m].
    spacing : float
        [m]

    Returns
    -------
    wavenumber, spectrum : (n // 2,) arrays
        From the first ring around 0 to the Nyquist wave number [rad m⁻¹], [m⁴].
    """
    step = 2 * np.pi / (len(heights) * spacing)
    return radial_spectrum(np.abs(fft.fft2(heights) / heights.size) ** 2 / step**2, step)

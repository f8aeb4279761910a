"""Surfaces that follow each other, and beams on them, by other code than that of the package.

Fields are periodic squares of sums of waves with independent normal amplitudes. The surface that is met at an offset is
the other one moved by the phases of its waves, so that one pair of surfaces meets at many offsets. Cracks are found in
the energy of a beam that is cut at every strip, without finite elements.
"""

import numpy as np
from scipy import fft

#: Points along each side of a square, their distance [m], and points along a strip and across it.
POINTS, SPACING, STRIP = 2048, 10e-9, (150, 2000)


def spectrum(zeta, rms=3.4e-9, plateau=14380.0, floor=0.3, corner=12e6, cutoff=125e6):
    """Eq. (7) at wave numbers (n, m) [rad/m], of a variance [m²] that is the sum of all its waves."""
    power = np.log(floor / plateau) / np.log(cutoff / corner)
    form = np.where(zeta <= cutoff, np.maximum(zeta / corner, 1.0) ** power, 0.0)
    return rms**2 * form / form.sum()


class Meeting:
    """Two Gaussian surfaces with a coherence, of which the upper one can be moved; squares of some points."""

    def __init__(self, coherence, rng, points=POINTS):
        first = 2 * np.pi * fft.fftfreq(points, SPACING)
        self.points = points
        self.zeta = first[:, None], first
        amplitude = np.sqrt(spectrum(np.hypot(*self.zeta))).astype(np.float32)
        lower, independent = (
            amplitude * fft.fft2(rng.standard_normal((points, points), np.float32)) / points for _ in range(2)
        )
        self.lower, self.upper = lower, np.sqrt(1 - coherence**2) * independent - coherence * lower

    def heights(self, offset):
        """Sum of both surfaces at an offset (2,) [m], (points, points) [m]."""
        phases = np.exp(-1j * (offset[0] * self.zeta[0] + offset[1] * self.zeta[1])).astype(np.complex64)
        return fft.ifft2((self.lower + phases * self.upper) * self.points**2).real.astype(np.float32)


def strips(heights, along=STRIP[0], across=STRIP[1]):
    """Strips of a square field (n, along, across)."""
    return [np.ascontiguousarray(heights[k : k + along, :across]) for k in range(0, len(heights) - along + 1, along)]


def crack_lengths(energies, strip, device, spread):
    r"""Length of the first crack of beams on strips of energies (beams, n) [J/m²], from the clamp on (beams,) [m].

    The beam of modulus E, thickness t and gap h comes free where its energy release :math:`3 E t^3 h^2 / (2 l^4)` is at
    least that of the strips, averaged over a ``spread`` of a foundation length of the crack tip [m]. The crack of a
    released beam grows from its clamp, as in Sec. IV of the paper. Infinite where it passes all strips.
    """
    length = strip * (np.arange(energies.shape[1]) + 0.5)
    weights = np.exp(-strip * np.arange(np.ceil(3 * spread / strip)) / spread)
    held = np.array([np.convolve(row, weights / weights.sum())[len(weights) - 1 :][: len(row)] for row in energies])
    release = 1.5 * device.young_modulus * device.thickness**3 * device.gap**2 / length**4
    arrests = held > release
    return np.where(arrests.any(axis=1), length[np.argmax(arrests, axis=1)], np.inf)

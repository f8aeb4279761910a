r"""Displacement of an elastic half-space under pressures on square elements (not in the paper).

The two bodies act as one half-space of modulus E' against a rigid equivalent surface. Its points, at the spacing Δ, are
the centres of square elements of uniform pressure. Pressures press the bodies apart, and displacements are positive
where they open the gap. The displacement by one element is the solution of A. E. H. Love, Phil. Trans. R. Soc. A 228,
377 (1929), in units of p Δ/E' a function of the distance alone.

The strip repeats in both directions, and displacements are measured from their mean; or it is alone on an infinite
half-space, and displacements vanish at infinity.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

#: Displacement of the centre of an element under its own pressure, in units of p Δ/E': 4 ln(1 + √2)/π.
OWN_DISPLACEMENT = 4 / np.pi * np.log(1 + np.sqrt(2))
#: Displacement of a spring under an element, in units of p Δ/E': that of the longest waves of strips.
SPRINGS = 300.0
#: Waves of a square element beyond the grid, in each direction. Those left out are 3e-4 of the displacement of an
#: element under its own pressure.
_ALIASES = 6


@dataclass(frozen=True)
class HalfSpace:
    """Elements of a strip under mutual displacement."""

    shape: tuple[int, int]  #: number of elements
    spacing: float  #: Δ [m]
    modulus: float  #: E' of the two bodies [Pa]
    periodic: bool = True  #: whether the strip repeats; otherwise it is alone

    @property
    def unit(self) -> float:
        """Displacement Δ/E' per pressure, the unit of the displacement by an element [m Pa⁻¹]."""
        return self.spacing / self.modulus

    @property
    def _padded(self):
        """Size of the Fourier transforms: without periods, elements of one end must not reach around to the other."""
        return self.shape if self.periodic else tuple(fft.next_fast_len(2 * n, real=True) for n in self.shape)

    @cached_property
    def _waves(self):
        """Fourier transform of the displacement by one element, float32 [m Pa⁻¹]."""
        if self.periodic:
            return (self.unit * periodic_waves(self.shape)).astype(np.float32)
        i, j = (np.minimum(np.arange(n), n - np.arange(n)) for n in self._padded)
        return (self.unit * fft.rfft2(love(i[:, None], j)).real).astype(np.float32)

    def displacement(self, pressure: np.ndarray) -> np.ndarray:
        """Displacement of all elements (n1, n2) float32 [m] under pressures on them (n1, n2) float32 [Pa]."""
        n1, n2 = self.shape
        return fft.irfft2(fft.rfft2(pressure, s=self._padded) * self._waves, s=self._padded)[:n1, :n2]

    @cached_property
    def _inverse(self):
        """Inverse of the waves, float32 [Pa m⁻¹], 0 for the mean."""
        waves = self._waves.copy()
        waves[0, 0] = np.inf  # rounding leaves a little of the mean
        return 1 / waves

    def traction(self, displacement: np.ndarray) -> np.ndarray:
        """Pressures of mean 0 that displace the elements of a periodic strip so, from their mean (n1, n2) float32 [Pa].

        Displacements (n1, n2) float32 [m], of which the mean is left out.
        """
        return fft.irfft2(fft.rfft2(displacement) * self._inverse, s=self.shape)

    @cached_property
    def _on_springs(self):
        """Waves of `displacement_on_springs`, float32 [m Pa⁻¹]."""
        return (1 / (self._inverse + 1 / (SPRINGS * self.unit))).astype(np.float32)

    def displacement_on_springs(self, pressure: np.ndarray) -> np.ndarray:
        """Displacement of a periodic strip that stands on springs under all elements (n1, n2) float32 [m].

        Pressures (n1, n2) float32 [Pa]. A spring alone is displaced by `SPRINGS` units.
        """
        return fft.irfft2(fft.rfft2(pressure) * self._on_springs, s=self.shape)


def love(i: np.ndarray, j: np.ndarray) -> np.ndarray:
    r"""Displacement of an infinite half-space at offsets from a square element of uniform pressure, in units of p Δ/E'.

    .. math:: u = \frac{1}{\pi} \sum_{s, t = \pm 1} s t \Bigl[ x_s \ln(y_t + r_{st}) + y_t \ln(x_s + r_{st}) \Bigr] ,
              \quad x_s = i + \tfrac s2, \quad y_t = j + \tfrac t2

    Parameters
    ----------
    i, j : arrays that broadcast
        Offsets from the centre of the element, not negative [Δ].
    """
    total = 0.0
    for s in (1, -1):
        for t in (1, -1):
            x, y = i + s / 2, j + t / 2
            # x ln(y + r) = x arsinh(y/|x|) + x ln|x|: for negative y without cancellation, and the second terms cancel.
            total = total + s * t * (x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y)))
    return total / np.pi


def periodic_waves(shape: tuple[int, int]) -> np.ndarray:
    r"""Fourier transform of the displacement by one element, periodic with the strip, in units of p Δ/E'.

    .. math:: \hat u = \sum_{\mathbf g} \frac{2}{|\mathbf k|} \operatorname{sinc} \frac{k_1}{2}
              \operatorname{sinc} \frac{k_2}{2} , \quad \mathbf k = 2 \pi (\mathbf n / \mathbf N + \mathbf g) / \Delta

    The sum over integers g takes the displacement at the centres of the elements. The mean is 0.

    Returns
    -------
    (n1, n2 // 2 + 1) array
        As ``scipy.fft.rfft2`` orders the waves.
    """
    first, second = fft.fftfreq(shape[0])[:, None], fft.rfftfreq(shape[1])
    total = np.zeros((shape[0], shape[1] // 2 + 1))
    for g in range(-_ALIASES, _ALIASES + 1):
        for h in range(-_ALIASES, _ALIASES + 1):
            wave = 2 * np.pi * np.hypot(first + g, second + h)
            wave[wave == 0] = np.inf
            total += 2 / wave * np.sinc(first + g) * np.sinc(second + h)
    return total

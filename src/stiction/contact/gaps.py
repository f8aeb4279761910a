r"""Van der Waals attraction of two rough surfaces across the gaps between them (not in the paper).

Maugis' theory of the summits ends the attraction 0.23 nm from a summit. Here the solids attract each other across every
gap g = d - z of the equivalent surface z at the distance d between the mean planes, as flats at this gap would:

.. math:: p(d) = \int U'(d - z) \, dA(z)

with U(g) the work per area to separate two flats from the gap g to infinity, and A the bearing area. What the summits
have already, the work of their Dugdale stress, is subtracted from U, so that nothing counts twice: two flats that touch
need the work of Eq. (10) in all, whatever the summits were computed with.

ASSUME: gaps are those of the undeformed surfaces, and forces between their elements add up (Derjaguin).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import fft

from stiction.contact.vanderwaals import DugdaleAttraction

#: Strength b of the retardation of flats [-]; J. Gregory, J. Colloid Interface Sci. 83, 138 (1981).
RETARDATION = 5.32
#: Most points of bearing areas that are convolved at once.
_BLOCK = 2**20


@dataclass(frozen=True)
class FlatAttraction:
    r"""Work to separate two flats across a medium: the Lennard-Jones pair potential of Eq. (10), retarded.

    .. math:: U(g) = \frac{\mathfrak{H}}{12 \pi} \Bigl( \frac{1}{D^2 (1 + b g / \lambda)} - \frac{D_0^6}{4 D^8} \Bigr),
              \quad D = D_0 + g

    It is the work of Eq. (10) at g = 0, where the flats exert no force. Light needs time to cross a gap, which weakens
    the attraction beyond a few nanometres. Gregory's factor on the energy of flats, 1 / (1 + b g / λ), is within 9 % of
    molecules with one frequency of absorption (Casimir and Polder) added up, for gaps up to λ. His expression with a
    logarithm, 1 - (b g / λ) ln(1 + λ / (b g)), is its integral over a sphere, and up to 44 % too small for flats.
    """

    hamaker_constant: float  #: ℌ [J]
    wavelength: float = np.inf  #: λ of the absorption that dominates the attraction [m]; infinite without retardation
    spacer: float = 0.0  #: thickness of both coatings, which keep the solids apart [m]

    def __post_init__(self):
        if not self.wavelength > 0:
            raise ValueError(f"the wavelength of the retardation must be positive, got {self.wavelength:.3g} m")
        DugdaleAttraction(self.hamaker_constant, self.spacer)  # refuses what no solids have

    @property
    def largest_pressure(self) -> float:
        """Bound of the tension between the flats at any gap, positive: without retardation and spacer [Pa]."""
        return self.hamaker_constant / (6 * np.pi * self._at_rest**3) * 2 / np.sqrt(27)

    @property
    def _at_rest(self):
        return DugdaleAttraction(self.hamaker_constant).equilibrium_distance

    def work(self, gap: float | np.ndarray) -> float | np.ndarray:
        """Work per area to separate the flats from a gap to infinity [J m⁻²]. Gap >= 0 [m], any shape."""
        at_rest, gap = self._at_rest, np.asarray(gap) + self.spacer
        near = at_rest / (at_rest + gap)
        scale = self.hamaker_constant / (12 * np.pi * at_rest**2)
        return scale * (near**2 / (1 + RETARDATION * gap / self.wavelength) - near**8 / 4)


@dataclass(frozen=True)
class LayeredFlats:
    """Attraction of coated flats: all pairs of their interfaces, `stiction.contact.solids.interfaces`, added up."""

    pairs: tuple[FlatAttraction, ...]

    @property
    def largest_pressure(self) -> float:
        """Bound of the tension between the flats at any gap, positive [Pa]."""
        return sum(pair.largest_pressure for pair in self.pairs)

    def work(self, gap: float | np.ndarray) -> float | np.ndarray:
        """Work per area to separate the flats from a gap to infinity [J m⁻²]. Gap >= 0 [m], any shape."""
        return sum(pair.work(gap) for pair in self.pairs)


def work_across_film(
    gap: float | np.ndarray, height: float, wet: FlatAttraction | LayeredFlats, dry: FlatAttraction | LayeredFlats
) -> float | np.ndarray:
    """Work to separate flats from a gap [m] with water in gaps up to the ``height`` [m] and air beyond [J m⁻²]."""
    return np.where(gap < height, wet.work(gap) + (dry.work(height) - wet.work(height)), dry.work(gap))


def gap_pressures(
    bearing: np.ndarray, first: float, distance: np.ndarray, step: float, work: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Pressure across the gaps of every sample, and the energy left beyond the last distance.

    The bearing area is linear between nodes, and the work is integrated over each of its steps exactly. Points that
    the flat has passed, with negative gaps, attract nothing; neither do those below the first node.

    Parameters
    ----------
    bearing : (..., n_b) array
        Bearing area A of the samples [-]; it is zero at its last node.
    first : float
        Height at its first node [m].
    distance : (n_d,) array
        Distances d between the mean planes, one step apart [m].
    step : float
        Spacing of the distances, and of the nodes of the bearing area [m].
    work : callable
        ``work(g)`` is the work per area that the gap g still needs [J m⁻²], for gaps >= 0 [m].

    Returns
    -------
    pressure : (..., n_d) float32 array
        Negative in attraction [Pa].
    beyond : (...) float64 array
        Work from the last distance to infinity [J m⁻²].

    Raises
    ------
    ValueError
        If the distances are not one step apart.
    """
    if not np.allclose(np.diff(distance), step, rtol=1e-6, atol=0):
        raise ValueError(f"distances must be {step:.3g} m apart, as the nodes of the bearing area are")
    steps, number = bearing.shape[-1] - 1, len(distance)
    # Every gap between a distance and a node, increasing: those of all steps at one distance are a window of them.
    works = work(np.maximum(distance[0] - first + step * np.arange(-steps, number), 0.0))
    size = fft.next_fast_len(steps + number - 1, real=True)
    waves = fft.rfft(np.diff(works) / step, size)
    energy = 0.5 * (works[number:] + works[number - 1 : -1])[::-1]
    samples, rows = bearing.reshape(-1, steps + 1), max(_BLOCK // size, 1)
    pressure, beyond = np.empty((len(samples), number), np.float32), np.empty(len(samples))
    for start in range(0, len(samples), rows):
        block = slice(start, start + rows)
        shares = -np.diff(samples[block].astype(float), axis=-1)  # single precision would lose small pressures
        pressure[block] = fft.irfft(fft.rfft(shares, size) * waves, size)[:, steps - 1 : steps + number - 1]
        beyond[block] = shares @ energy
    return pressure.reshape(*bearing.shape[:-1], number), beyond.reshape(bearing.shape[:-1])

r"""Adhesion of the model of Greenwood and Williamson with menisci, the baseline of the paper.

Summits of one radius R and a density N have normal heights z with the rms of the surfaces. At the distance d between
the mean planes, each touching summit carries a Hertz force, and each summit within the height h_C of the water has a
meniscus of its own, :math:`2 \pi R (z - d + h_C)`:

.. math::

   f(d) = N \int \left[\tfrac43 E' \sqrt{R} (z - d)_+^{3/2} - |\Delta P| \, 2 \pi R (z - d + h_C)_+ \right] \phi(z) dz

The surface is endless, so that nothing scatters, and menisci never merge, so that energies have no upper limit.
"""

from dataclasses import dataclass

import numpy as np

from stiction.contact.asperity import hertz_force

#: Adhesion parameters below which wafers bond, and below which they adhere; C. Gui, M. Elwenspoek, N. Tas and J. G. E.
#: Gardeniers, J. Appl. Phys. 85, 7448 (1999), read in its abstract.
BOND, ADHERE = 1, 12
#: Heights and distances are followed to this many rms; points of both.
_REACH, _HEIGHTS, _DISTANCES = 8.0, 1500, 1500


@dataclass(frozen=True)
class GreenwoodWilliamson:
    """Summits of one radius with normal heights."""

    density: float  #: N [m⁻²]
    radius: float  #: R [m]
    rms: float  #: of the heights of both surfaces [m]
    modulus: float  #: reduced modulus E' [Pa]

    def force(self, distance: np.ndarray, film: tuple[float, float]) -> np.ndarray:
        """Force per area f at distances (n,) [m] with a film of some height [m] and tension [Pa], (n,) [Pa]."""
        score = np.linspace(-_REACH, _REACH, _HEIGHTS)
        weights = np.exp(-(score**2) / 2)
        height, tension = film
        above = self.rms * score - distance[:, None]
        carried = hertz_force(np.maximum(above, 0.0), self.radius, self.modulus)
        wet = 2 * np.pi * self.radius * np.maximum(above + height, 0.0)
        return self.density * (carried - tension * wet) @ (weights / weights.sum())

    def energy(self, film: tuple[float, float]) -> float:
        """Adhesion energy: the integral of the attraction beyond its zero crossing [J m⁻²]."""
        distance = np.linspace(-_REACH * self.rms, _REACH * self.rms + film[0], _DISTANCES)
        force = np.concatenate([self.force(distances, film) for distances in np.array_split(distance, 10)])
        return float(np.trapezoid(np.maximum(-force, 0.0), distance))

    def plasticity_index(self, hardness: float) -> float:
        """Plasticity index E'/H √(rms/R) [-]. Contact is elastic below 0.6 and mostly plastic above 1."""
        return self.modulus / hardness * np.sqrt(self.rms / self.radius)

    def adhesion_parameter(self, work: float) -> float:
        r"""Adhesion parameter θ of summits with the work of adhesion w [J m⁻²], [-].

        .. math:: \theta = \frac{E'}{w} \sqrt{\frac{\sigma^3}{R}}

        It alone decides how much of the pull-off force of level summits remains (K. N. G. Fuller and D. Tabor, Proc. R.
        Soc. Lond. A 345, 327, 1975), and wafers with less than `BOND` bond. Theirs have short attraction: menisci reach
        higher summits, and hold more than it says. ASSUME: σ of the summits is the rms of both surfaces.
        """
        return self.modulus / work * np.sqrt(self.rms**3 / self.radius)

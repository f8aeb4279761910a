r"""Pair of surfaces in humid air under a beam, as the estimate knows them. Plain Python, SI units.

The tip of a beam of the length L has the slope :math:`\theta = 3h / 2L` and releases below an attraction

.. math:: \frac{P(\theta)}{w} = \frac{2}{27} K \theta^3 , \quad K = \frac{E t^3}{h^2} ,

so that a beam enters by its stiffness K and its width alone. Flooded flats would hold it up to the slope
:math:`\theta_0 = (27 \, \Gamma / 2 K)^{1/4}`, with the energy :math:`\Gamma = p \, h_C` of the water.
"""

import math
from dataclasses import dataclass

from stiction.constants import GAS_CONSTANT
from stiction.estimate.statistics import Heights

#: Names of the coordinates, for messages.
COORDINATES = (
    "rms of the heights over the film of water",
    "tension of the water",
    "breadth of the spectrum",
    "correlation length",
    "skewness",
    "kurtosis",
    "stiffness of the beam",
    "width of the beam",
    "humidity",
    "curvature of the summits",
)


@dataclass(frozen=True)
class Film:
    """Water between two solids."""

    height: float  #: h_C [m]
    energy: float  #: Γ = γ (cos θ₁ + cos θ₂) [J m⁻²]


def film(humidity: float, temperature: float, wetting: float, water: tuple[float, float]) -> Film:
    """Film at a humidity [-] and temperature [K], with cos θ₁ + cos θ₂ [-].

    ``water`` has surface energy [N m⁻¹] and molar volume [m³ mol⁻¹]. See `stiction.contact.meniscus`.
    """
    energy, volume = water[0] * wetting, water[1]
    return Film(energy * volume / (-GAS_CONSTANT * temperature * math.log(humidity)), energy)


@dataclass(frozen=True)
class TipState:
    """Surfaces, water and beam."""

    heights: Heights  #: of the sum of both surfaces
    film: Film
    stiffness: float  #: K = E t³ / h² [N m⁻¹]
    width: float  #: [m]
    modulus: float  #: E of the solids [Pa]

    @property
    def flooded_slope(self) -> float:
        """θ₀, up to which flooded flats hold a tip [-]."""
        return (13.5 * self.film.energy / self.stiffness) ** 0.25

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which the slope of a stuck tip depends, by `COORDINATES`, logarithms but for heights' form."""
        low, second, fourth = self.heights.moments
        tension, summits = self.film.energy / self.film.height, math.sqrt(fourth / second)
        return (
            math.log(self.heights.rms / self.film.height),
            math.log(tension / (self.modulus * self.heights.slope)),
            math.log(fourth / second**2),
            math.log(low**2 * second),
            self.heights.skewness,
            self.heights.kurtosis,
            math.log(self.flooded_slope / self.heights.slope),
            math.log(self.width * summits),
            math.log(self.film.height),
            math.log(summits),
        )


def stiffness_of(modulus: float, thickness: float, gap: float) -> float:
    """K = E t³ / h² of a beam [N m⁻¹], from its modulus [Pa], thickness and gap [m]."""
    return modulus * thickness**3 / gap**2

r"""Pair of surfaces in humid air under a beam or a stopper, as the estimate knows them. Plain Python, SI units.

The tip of a beam of the length L has the slope :math:`\theta = 3h / 2L` and releases below an attraction

.. math:: \frac{P(\theta)}{w} = \frac{2}{27} K \theta^3 , \quad K = \frac{E t^3}{h^2} ,

so that a beam enters by its stiffness K and its width alone. Flooded flats would hold it up to the slope
:math:`\theta_0 = (27 \, \Gamma / 2 K)^{1/4}`, with the energy :math:`\Gamma = p \, h_C` of the water.
Flooded flats of the area A would hold a stopper with the force :math:`p A`.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

from stiction.constants import GAS_CONSTANT, WATER_MOLECULE, molar_volume, surface_energy
from stiction.contact.air import MOLECULES
from stiction.estimate.solids import OF_POLYSILICON, BesideWater
from stiction.estimate.statistics import Heights

#: Names of the coordinates, for messages: of both, of a beam and of a stopper.
_OF_CONTACT = (
    "rms of the heights over the film of water (from rms and humidity)",
    "tension of the water over slopes of the surface (from humidity, rms and spectrum)",
    "breadth of the spectrum (from Hurst exponent, corner and cut-off)",
    "correlation length (from corner and Hurst exponent)",
    "skewness",
    "kurtosis",
)
COORDINATES = (
    *_OF_CONTACT,
    "softness of the beam over slopes of the surface (from thickness, gap and rms)",
    "width of the beam in summits",
    "humidity",
    "curvature of the summits (from Hurst exponent, corner and cut-off)",
)
OF_PATCHES = (
    *_OF_CONTACT,
    "area in contact in summits",
    "humidity",
    "curvature of the summits (from Hurst exponent, corner and cut-off)",
)
#: Names of the coordinates of other solids beside these.
OF_SOLIDS = (
    "attraction of the solids beside that of the water (from Hamaker constant and contact angles)",
    "attraction of the solids through air beside that through water (from Hamaker constants and contact angles)",
    "stiffness of the solids beside that of the water (from moduli and contact angles)",
)

#: Height of the thinnest film that is a liquid [m]. A run bounds thinner ones, which are not learnt.
THINNEST = MOLECULES * WATER_MOLECULE


@dataclass(frozen=True)
class Film:
    """Water between two solids."""

    height: float  #: h_C [m]
    energy: float  #: Γ = γ (cos θ₁ + cos θ₂) [J m⁻²]


def film(humidity: float, temperature: float, wetting: float) -> Film:
    """Film at a humidity [-] and temperature [K], with cos θ₁ + cos θ₂ [-]. See `stiction.contact.meniscus`."""
    energy, volume = surface_energy(temperature) * wetting, molar_volume(temperature)
    return Film(energy * volume / (-GAS_CONSTANT * temperature * math.log(humidity)), energy)


def _tension(water):
    """Tension p of a film [Pa]."""
    return water.energy / water.height


def curvature(heights: Heights) -> float:
    """Root of the ratio of the spectrum's moments of fourth and second order, which sets the size of summits [1/m]."""
    _, second, fourth = heights.moments
    return math.sqrt(fourth / second)


def _of_contact(state):
    """Coordinates of the contact of surfaces in a film, of solids as stiff beside its water as polysilicon.

    Only of these were they learnt: rms, film and spectrum give their tension. What stiffness changes is learnt beside
    it. ASSUME: on summits alone. At 2.5 times the stiffness, full contact changes tips by a ratio of 1.02 ± 0.02 more.
    """
    heights, water = state.heights, state.film
    low, second, fourth = heights.moments
    modulus = state.modulus / state.beside_water.stiffness
    return (
        math.log(heights.rms / water.height),
        math.log(_tension(water) / (modulus * heights.slope)),
        math.log(fourth / second**2),
        math.log(low**2 * second),
        heights.skewness,
        heights.kurtosis,
    )


@dataclass(frozen=True)
class TipState:
    """Surfaces, water and beam."""

    heights: Heights  #: of the sum of both surfaces
    film: Film
    stiffness: float  #: K = E t³ / h² [N m⁻¹]
    width: float  #: [m]
    modulus: float  #: E of the solids [Pa]
    beside_water: BesideWater = OF_POLYSILICON
    names: ClassVar[tuple[str, ...]] = COORDINATES

    @property
    def flooded_slope(self) -> float:
        """θ₀, up to which flooded flats hold a tip [-]."""
        return (13.5 * self.film.energy / self.stiffness) ** 0.25

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which the slope of a stuck tip depends, by ``COORDINATES``, logarithms but for heights' form."""
        summits = curvature(self.heights)
        return (
            *_of_contact(self),
            math.log(self.flooded_slope / self.heights.slope),
            math.log(self.width * summits),
            math.log(self.film.height),
            math.log(summits),
        )


@dataclass(frozen=True)
class PatchState:
    """Surfaces, water and area of a stopper. ASSUME: the ratio of its sides does not matter."""

    heights: Heights  #: of the sum of both surfaces
    film: Film
    area: float  #: [m²]
    modulus: float  #: E of the solids [Pa]
    beside_water: BesideWater = OF_POLYSILICON
    names: ClassVar[tuple[str, ...]] = OF_PATCHES

    @property
    def flooded_force(self) -> float:
        """Force p A with which flooded flats hold [N]."""
        return _tension(self.film) * self.area

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Numbers on which the pull-off force depends, by ``OF_PATCHES``, as those of `TipState`."""
        summits = curvature(self.heights)
        return (
            *_of_contact(self),
            math.log(self.area * summits**2),
            math.log(self.film.height),
            math.log(summits),
        )


def held_by(rigidity: float, gap: float) -> float:
    """Product e f L⁸ with which a bridge without stress is held, from E t³ [N m] and the gap [m] [N² m⁵]."""
    return 768 * rigidity**2 * gap**3


def stiffness_of(modulus: float, thickness: float, gap: float) -> float:
    """K = E t³ / h² of a beam [N m⁻¹], from its modulus [Pa], thickness and gap [m]."""
    return modulus * thickness**3 / gap**2

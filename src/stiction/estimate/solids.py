r"""SolidPair of a pair and how water wets them, as the estimate knows them. Plain Python, SI units.

Contact depends on both moduli by E' alone, so that two bodies with the Poisson ratio ν of polysilicon and the modulus

.. math:: E = 2 (1 - \nu^2) E' , \quad \frac{1}{E'} = \frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}

stand for both. Contact angles and temperature are in height and energy Γ of the film. What remains of other solids in
humid air are their attractions through water and, beyond the film, through air, beside that of the water,

.. math:: r = \frac{\mathfrak{H}}{\mathfrak{H}_0} \frac{\Gamma_0}{\Gamma} ,

1 for polysilicon that water wets perfectly at 300 K. Through air, r is :math:`s \, c(r)` with the part c that follows
from that through water by the combining relation, c(1) = 1. Nor is their modulus beside the energy of a film of some
height what it is on polysilicon,

.. math:: q = \frac{E}{E_0} \frac{\Gamma_0}{\Gamma} .

The changes of lengths and forces by r, s and q are learnt.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from stiction.config.units import to_si
from stiction.constants import HAMAKER_CONSTANT, POISSON_RATIO, WATER_SURFACE_ENERGY, YOUNG_MODULUS
from stiction.contact.air import DRY, ROUNDING

#: Medium between solids in humid air.
_WATER = "water"
#: Hamaker constant of water [J]; J. N. Israelachvili, Intermolecular and Surface Forces.
OF_WATER = to_si(37.0, "zJ")


def following(through_water: float) -> float:
    r"""Hamaker constant of two solids through air [J] that follows from that through water [J].

    By the combining relation, :math:`\bigl( \sqrt{\mathfrak{H}} + \sqrt{\mathfrak{H}_w} \bigr)^2`. As
    `stiction.contact.vanderwaals.combined`.

    Examples
    --------
    >>> round(1e21 * following(4.6e-21)), round(1e21 * following(250e-21))  # silica, gold [zJ]
    (68, 479)
    """
    return (math.sqrt(through_water) + math.sqrt(OF_WATER)) ** 2


@dataclass(frozen=True)
class BesideWater:
    """Two solids beside the water between them, over polysilicon."""

    through_water: float = 1.0  #: attraction r
    through_air: float = 1.0  #: attraction s, beside what follows from r
    stiffness: float = 1.0  #: q

    @property
    def logarithms(self) -> tuple[float, float, float]:
        """Logarithms of r, s and q."""
        return math.log(self.through_water), math.log(self.through_air), math.log(self.stiffness)


#: Of polysilicon that water wets perfectly at 300 K.
OF_POLYSILICON = BesideWater()


@dataclass(frozen=True)
class SolidPair:
    """SolidPair of both sides. Polysilicon that water wets perfectly, unless stated otherwise."""

    modulus: float = YOUNG_MODULUS  #: E of two bodies like polysilicon that are as stiff in contact [Pa]
    beam_modulus: float = YOUNG_MODULUS  #: [Pa]
    through_water: float = HAMAKER_CONSTANT[_WATER]  #: Hamaker constant of both [J]
    in_dry_air: float = HAMAKER_CONSTANT[DRY]  #: the same through dry air [J]
    wetting: float = 2.0  #: cos θ₁ + cos θ₂

    @classmethod
    def of(cls, beam: Mapping[str, Any], substrate: Mapping[str, Any]) -> "SolidPair":
        """SolidPair of the materials of both sides, in the units of files. Other keys change nothing.

        Examples
        --------
        >>> oxide = {"young_modulus_GPa": 73.1, "poisson_ratio": 0.17, "contact_angle_deg": 60}
        >>> pair = SolidPair.of(oxide, {})
        >>> round(pair.modulus / 1e9, 1), pair.beam_modulus / 1e9, round(pair.wetting, 3)
        (99.4, 73.1, 1.5)
        """
        both, polysilicon = (beam, substrate), cls()
        first, second = map(_stiffness, both)
        of_polysilicon = dict.fromkeys(HAMAKER_CONSTANT, 1.0)
        relative = [_relative_constants(side) if "hamaker_constant_zJ" in side else of_polysilicon for side in both]
        water, dry = (math.prod(side[medium] for side in relative) ** 0.5 for medium in (_WATER, DRY))
        angles = (to_si(side.get("contact_angle_deg", 0), "deg") for side in both)
        return cls(
            modulus=first * (2 * second / (first + second)),
            beam_modulus=_modulus(beam),
            through_water=polysilicon.through_water * water,
            in_dry_air=polysilicon.in_dry_air * dry,
            wetting=sum(map(math.cos, angles)),
        )

    @property
    def is_wetted(self) -> bool:
        """Whether water condenses between them, as `stiction.contact.meniscus.is_wetted`."""
        return self.wetting > ROUNDING

    def beside_water(self, energy: float) -> BesideWater:
        """Ratios beside a film of an energy [J m⁻²]."""
        polysilicon = SolidPair()
        by_water = polysilicon.wetting * WATER_SURFACE_ENERGY / energy
        through_water = self.through_water / polysilicon.through_water * by_water
        combined = following(through_water * polysilicon.through_water) / following(polysilicon.through_water)
        through_air = self.in_dry_air / polysilicon.in_dry_air * by_water / combined
        return BesideWater(through_water, through_air, self.modulus / polysilicon.modulus * by_water)


def _modulus(material):
    """Young's modulus of a material [Pa]."""
    return to_si(material["young_modulus_GPa"], "GPa") if "young_modulus_GPa" in material else YOUNG_MODULUS


def _stiffness(material):
    """Modulus of a body like polysilicon that is as stiff in contact [Pa]."""
    return _modulus(material) * ((1 - POISSON_RATIO**2) / (1 - material.get("poisson_ratio", POISSON_RATIO) ** 2))


def _relative_constants(material):
    """Hamaker constants of two bodies of a material over those of polysilicon, by medium."""
    return {
        medium: to_si(value, "zJ") / HAMAKER_CONSTANT[medium]
        for medium, value in material["hamaker_constant_zJ"].items()
    }

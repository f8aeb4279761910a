r"""Two bodies of different material in contact: elasticity, hardness, attraction and wetting of the pair.

Each body is a `Solid`; the default is polysilicon as in the paper. Two equal bodies give exactly the paper's formulas.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from stiction.constants import HAMAKER_CONSTANT, HARDNESS
from stiction.contact.asperity import Asperity, asperity, reduced_modulus
from stiction.contact.vanderwaals import DugdaleAttraction, LayeredAttraction, attraction, combined


@dataclass(frozen=True)
class Solid:
    """Material of one body. Polysilicon unless stated otherwise."""

    young_modulus: float = 164e9  #: E [Pa]
    poisson_ratio: float = 0.23  #: ν [-]
    hardness: float = HARDNESS  #: σ_H [Pa]
    #: Hamaker constant of two bodies of this material through each medium [J]
    hamaker_constant: Mapping[str, float] = field(default_factory=lambda: dict(HAMAKER_CONSTANT))
    contact_angle: float = 0.0  #: of water θ on the body, or on its coating [rad]
    coating: float = 0.0  #: thickness of its coating [m]
    #: Hamaker constant of two thick coatings through each medium [J]; without it, coatings attract as the medium does
    coating_hamaker_constant: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self):
        constants = {f"Hamaker constant ({medium})": value for medium, value in self.hamaker_constant.items()}
        positive = {"Young's modulus": self.young_modulus, "hardness": self.hardness} | constants
        for name, value in positive.items():
            if not (value > 0 and np.isfinite(value)):
                raise ValueError(f"{name} of a solid must be positive, got {value}")
        if not -1 < self.poisson_ratio <= 0.5:
            raise ValueError(f"Poisson's ratio of a solid must be in (-1, 0.5], got {self.poisson_ratio}")
        if not 0 <= self.contact_angle <= np.pi:
            raise ValueError(f"the contact angle of a solid must be in [0, π] rad, got {self.contact_angle}")
        if not 0 <= self.coating < np.inf:
            raise ValueError(f"the coating of a solid must not be thinner than nothing, got {self.coating} m")
        for medium, value in self.coating_hamaker_constant.items():
            if not 0 <= value <= self.hamaker_constant[medium]:
                raise ValueError(
                    f"the Hamaker constant of a coating ({medium}) must be from 0 to that of its solid, got {value} J"
                )

    def attracting(self, factor: float) -> "Solid":
        """Solid with a factor of its Hamaker constants. Those of its coating stay."""
        scaled = {medium: factor * constant for medium, constant in self.hamaker_constant.items()}
        return replace(self, hamaker_constant=scaled)


def composite_modulus(first: Solid, second: Solid) -> float:
    r"""Modulus E' of two bodies in contact [Pa].

    .. math:: \frac{1}{E'} = \frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}
    """
    one, other = (reduced_modulus(solid.young_modulus, solid.poisson_ratio) for solid in (first, second))
    return one * (2 * other / (one + other))  # in this order, equal bodies give exactly their reduced modulus


def softer_hardness(first: Solid, second: Solid) -> float:
    """Hardness of the softer body [Pa]."""
    return min(first.hardness, second.hardness)


def hamaker_constant(first: Solid, second: Solid, medium: str) -> float:
    """Hamaker constant of two bodies through a medium, see `stiction.contact.vanderwaals.combined` [J].

    Raises
    ------
    ValueError
        If the constant of a body through this medium is not stated.
    """
    for solid in (first, second):
        if medium not in solid.hamaker_constant:
            stated = ", ".join(solid.hamaker_constant)
            raise ValueError(f"the Hamaker constant of a solid through {medium} is not stated, only through {stated}")
    return combined(first.hamaker_constant[medium], second.hamaker_constant[medium])


def interfaces(first: Solid, second: Solid, medium: str) -> tuple[tuple[float, float], ...]:
    r"""Hamaker constant of each pair of interfaces [J], and how much farther apart they are than the coatings [m].

    The attraction of layered half spaces with sharp interfaces is the sum over all pairs of an interface of one and one
    of the other, each as that of half spaces at its own distance (J. N. Israelachvili, Intermolecular and Surface
    Forces, adsorbed layers; V. A. Parsegian, Van der Waals Forces). With Berthelot's combination, a pair has the
    constant √(A B). A bare solid has one interface with :math:`A = A_{131}`; one with a coating of the thickness t has
    that of the coating, :math:`A_{232}`, and that between coating and solid, :math:`(\sqrt{A_{131}} -
    \sqrt{A_{232}})^2`, a distance t below. Equal coatings on equal solids thus have

    .. math:: U(g) = \frac{1}{12 \pi} \biggl( \frac{A_{232}}{D^2}
              + \frac{2 \sqrt{A_{232}} (\sqrt{A_{131}} - \sqrt{A_{232}})}{(D + t)^2}
              + \frac{(\sqrt{A_{131}} - \sqrt{A_{232}})^2}{(D + 2t)^2} \biggr), \quad D = D_0 + g

    ASSUME: a coating attracts no more than its solid through the same medium, and retardation and repulsion are those
    of one wavelength and one molecular distance. Then all terms attract, and the truth is between a spacer and no
    coating at all.
    """
    hamaker_constant(first, second, medium)  # refuses a medium that is not stated
    pairs = product(_interfaces(first, medium), _interfaces(second, medium))
    return tuple((combined(a, b), s + t) for (a, s), (b, t) in pairs if a * b > 0)


def _interfaces(solid, medium):
    """Hamaker constant of the interfaces of a solid [J], and their depth below its coating [m]."""
    whole, outer = solid.hamaker_constant[medium], solid.coating_hamaker_constant.get(medium, 0.0)
    ratio = np.sqrt(outer / whole)
    inner = (whole - outer) * (1 - ratio) / (1 + ratio)  # (√whole - √outer)², exact if there is one interface alone
    return (outer, 0.0), (inner, solid.coating)


def asperity_between(first: Solid, second: Solid, medium: str) -> Asperity:
    """Model of one asperity between two bodies, with attraction through a stated medium or ``"none"``."""
    return asperity(composite_modulus(first, second), attraction_between(first, second, medium))


def attraction_between(first: Solid, second: Solid, medium: str) -> DugdaleAttraction | LayeredAttraction | None:
    """Van der Waals attraction of two solids through a stated medium, ``None`` for ``"none"``."""
    if medium == "none":
        return None
    pairs = tuple(attraction(medium, *pair) for pair in interfaces(first, second, medium))
    return pairs[0] if len(pairs) == 1 else LayeredAttraction(pairs)

r"""Two bodies of different material in contact: elasticity, hardness and attraction of the pair.

Each body is a `stiction.contact.materials.Solid`. Two equal bodies give exactly the paper's formulas.
"""

from itertools import product

import numpy as np

from stiction.contact.asperity import Asperity, asperity, reduced_modulus
from stiction.contact.materials import Solid
from stiction.contact.vanderwaals import DugdaleAttraction, LayeredAttraction, attraction, combined


def composite_modulus(first: Solid, second: Solid) -> float:
    r"""Modulus E' of two bodies in contact [Pa].

    .. math:: \frac{1}{E'} = \frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}
    """
    e1, e2 = (reduced_modulus(solid.young_modulus, solid.poisson_ratio) for solid in (first, second))
    return e1 * (2 * e2 / (e1 + e2))  # in this order, equal bodies give exactly their reduced modulus


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
            media = ", ".join(solid.hamaker_constant)
            raise ValueError(f"the Hamaker constant of a solid through {medium} is not stated, only through {media}")
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
    total, outer = solid.hamaker_constant[medium], solid.coating_hamaker_constant.get(medium, 0.0)
    ratio = np.sqrt(outer / total)
    inner = (total - outer) * (1 - ratio) / (1 + ratio)  # (√total - √outer)², exact if there is one interface alone
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

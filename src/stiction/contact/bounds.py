"""Bounds of the force laws that follow from heights and water alone, without computing a contact (Sec. III-A)."""

import numpy as np

from stiction.contact.vanderwaals import DugdaleAttraction


def least_law(heights: np.ndarray, highest: float, film: tuple[float, float]) -> tuple[float, float]:
    r"""Lower bounds of f_max and a_left of Eq. (12) for a strip whose highest point is known.

    At the distance :math:`d_0` of the highest points no solids touch and the water film pulls alone:
    :math:`f_\mathrm{max} \ge \sigma A(d_0 - h_C)`. Farther away it pulls less, :math:`d_\mathrm{max} \le d_0`. With
    :math:`f_\mathrm{limit} \ge f_\mathrm{max}` and :math:`d_\mathrm{limit} \ge 0` follows
    :math:`a_\mathrm{left} \ge \ln(1 + \sqrt 2) / d_0`.

    ASSUME: the mean planes stay apart under the largest pressure, d_limit >= 0.

    Parameters
    ----------
    heights : array of any shape
        Equally probable sums of the heights of both surfaces [m].
    highest : float
        Sum that no point of the strip exceeds, d₀ [m].
    film : tuple of 2 floats
        Height h_C and tension σ = -ΔP of the water [m], [Pa].

    Returns
    -------
    f_max, a_left : float
        [Pa], [m⁻¹]
    """
    height, tension = film
    return tension * float(np.mean(heights > highest - height)), float(np.log(1 + np.sqrt(2)) / highest)


def flooded_law(film: tuple[float, float], hamaker_constant: float) -> tuple[float, float]:
    """Upper bounds of e [J m⁻²] and f_max [Pa] of any surfaces at a humidity: those of flooded flats that touch.

    Water pulls nowhere harder or farther than between flats, and neither do the solids.

    Parameters
    ----------
    film : tuple of 2 floats
        Height h_C and tension -ΔP of the water [m], [Pa].
    hamaker_constant : float
        Of the two solids [J]; 0 without van der Waals forces.
    """
    height, tension = film
    if not hamaker_constant:
        return height * tension, tension
    solid = DugdaleAttraction(hamaker_constant)
    return height * tension + solid.work_of_adhesion, tension + solid.stress

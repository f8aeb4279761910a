r"""Release of tips: beams after their crack has run to the tip.

A beam of length L that adheres as an arc, with its tip only, has the slope θ = 3h/2L there, and touches as a wedge. It
comes free if the largest attraction P(θ) of the tilted tip is below the force :math:`3 EI h / L^3` that bends it.

On uniform surfaces the wedge pulls with :math:`w \int f(\theta x) dx = w e / \theta`, and the balance is the peel
number of Mastrangelo and Hsu,

.. math:: e = \frac{3 E t^3 h^2}{8 L^4} .

On rough ones P follows from tilted strips, `stiction.contact.tilted`. The wedge is less than 0.2 µm long, far shorter
than the strips of a beam, so that the end state ``ARC`` of the finite elements depends on their length and is not used
here.

ASSUME: the surface at the tip is drawn independently of the strips of the crack.
"""

import numpy as np

from stiction.beam.cantilever import Beam

#: Power with which the length that a tip holds falls with its attraction. ASSUME: that of an attraction P that is the
#: same at all slopes, the safe end. On smooth surfaces P grows as 1/θ, and it is -1/4; rough ones are between.
LENGTH_POWER = -1 / 3
#: Slopes between which the force of smooth tips is interpolated.
_STEPS = 65


def tip_slope(length: float | np.ndarray, gap: float | np.ndarray) -> float | np.ndarray:
    """Slope of an arc at its tip, 3h/2L [-]. Length of the beam and gap [m] broadcast."""
    return 1.5 * gap / length


def arc_length(energy: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Longest releasing arc at an adhesion energy of its tip [J m⁻²], (3Et³h² / 8e)^(1/4) [m], any shape.

    It is 2^(-1/2) = 0.7071 of the crack length of Eq. (13).
    """
    return (3 / 8 * beam.young_modulus * beam.thickness**3 * beam.gap**2 / energy) ** (1 / 4)


def flat_force(slope: np.ndarray, attractions: np.ndarray, radius: float) -> np.ndarray:
    r"""Largest attraction of smooth tips with a rounded edge, an upper bound (s,) [N m⁻¹].

    An attraction of the energy e and of at most q adds

    .. math:: \frac P w = \frac e \theta + q \frac{\theta R}{2} + \sqrt{2 R e q}

    over wedge and edge (`stiction.contact.tilt`), and :math:`2 \sqrt{2 R e q}` where the edge has dropped by e/q before
    the wedge begins. These are exact for an attraction of q up to e/q. Any other one acts farther away, where tips are
    steeper.

    Parameters
    ----------
    slope : (s,) array
        θ [-].
    parts : (k, 2) array
        e [J m⁻²] and q [Pa] of each attraction, both zero or neither.
    radius : float
        R of the edge [m]; 0 leaves the wedge alone.
    """
    energy, largest = attractions[attractions[:, 0] > 0].T[..., np.newaxis]
    edge = np.sqrt(2 * radius * energy * largest)
    on_wedge = slope**2 * radius / 2 < energy / largest
    return np.where(on_wedge, energy / slope + largest * slope * radius / 2 + edge, 2 * edge).sum(axis=0)


def flat_length(attractions: np.ndarray, radius: float, beam: Beam) -> float:
    """Longest releasing arc with a smooth tip that has a rounded edge, a lower bound [m]. Arguments as of `flat_force`.

    The root lies between the slope of a sharp edge and the slope at which the force there bends the beam.
    """
    sharp = np.atleast_1d(tip_slope(arc_length(attractions[:, 0].sum(), beam), beam.gap))
    steepest = (flat_force(sharp, attractions, radius) / bending_force(sharp, beam)) ** (1 / 3)
    slopes = sharp * np.geomspace(1 / 2, 2 * steepest.item(), _STEPS)
    return float(longest_free(slopes, flat_force(slopes, attractions, radius)[np.newaxis], beam)[0])


def longest_free(slopes: np.ndarray, forces: np.ndarray, beam: Beam) -> np.ndarray:
    r"""Longest arcs to release from the largest attraction P(θ) of their tips (m,) [m].

    At the slope θ the length is 3h/2θ, so that the tip comes free if

    .. math:: \frac{P(\theta)}{w} < \frac{8 EI \theta^3}{9 w h^2} .

    Between the slopes, the logarithm of P is interpolated in the logarithm of the slope. Where a longer arc would come
    free of a tip that holds a shorter one, the shorter one counts.

    ASSUME: below the smallest slope, P grows as 1/θ, as on smooth surfaces. On rough ones it grows less, because a long
    wedge touches higher summits: this is the safe side. Beyond the largest one P stays what it is there, the safe side
    as well: so steep a wedge touches with its edge.

    Parameters
    ----------
    slopes : (s,) array
        Increasing [-].
    forces : (m, s) array
        P/w of every tip [N m⁻¹]; zero where it does not attract.
    beam : Beam
    """
    with np.errstate(divide="ignore"):
        # Logarithm of P/w over the force that frees the tip: positive at the slopes at which it holds the beam.
        excess = np.log(forces / bending_force(slopes, beam))
    holds, logarithms, last = excess >= 0, np.log(slopes), len(slopes) - 1
    above = np.where(holds.any(axis=1), len(slopes) - np.argmax(holds[:, ::-1], axis=1), 0)
    below, row, ahead = np.maximum(above - 1, 0), np.arange(len(forces)), np.minimum(above, last)
    step = logarithms[ahead] - logarithms[below]
    with np.errstate(invalid="ignore", divide="ignore"):
        inverse = np.where(above > 0, step / (excess[row, below] - excess[row, ahead]), 1 / 4)
        inverse[above > last] = 1 / 3
        return 1.5 * beam.gap / np.exp(logarithms[below] + inverse * excess[row, below])


def bending_force(slope: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Force at the tip to bend a beam to a slope there, 3 EI h / L³ per width, slope of any shape [-] [N m⁻¹]."""
    return 3 * beam.bending_stiffness * beam.gap / (beam.width * (1.5 * beam.gap / slope) ** 3)


#: Slopes at which tips are computed: those of tips in saturated air times this, at least; and the largest ratio of
#: neighbours, for an error of the lengths below 0.2 %. Slopes are powers of the ratio, so that devices share them.
_FLATTEST, _STEEPEST, _RATIO = 1 / 4, 1.5, 2**0.25


def slopes_of_tips(*saturated: float) -> np.ndarray:
    """Slopes for the computation of the tips of several beams, increasing (s,) [-].

    ``saturated`` are their slopes at the lengths that hold in saturated air [-], where tips are steepest.

    Examples
    --------
    >>> slopes_of_tips(0.128)[[0, -1]].round(3)
    array([0.031, 0.21 ])
    """
    first = np.floor(np.log(_FLATTEST * min(saturated)) / np.log(_RATIO))
    last = np.ceil(np.log(_STEEPEST * max(saturated)) / np.log(_RATIO))
    return np.round(_RATIO ** np.arange(first, last + 1), 6)  # the same on all machines

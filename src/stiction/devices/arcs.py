r"""Beams whose crack has run to the tip: whether the tip comes free (peel number of Mastrangelo and Hsu).

A beam of length L that adheres as an arc, with its tip only, has the slope θ = 3h/2L there, and the adhesion acts on a
wedge. The wedge pulls with :math:`w \int f(\theta x) dx = w e / \theta`. Equal to the force :math:`3 EI h / L^3` that
bends the beam, this is

.. math:: e_\mathrm{tip} = \frac{3 E t^3 h^2}{8 L^4} :

the tip comes free if its adhesion energy is smaller. The wedge is less than 0.1 µm long, far shorter than the strips of
a beam, so that the end state ``ARC`` of the finite elements depends on their length and is not used here.

ASSUME: the adhesion energy of the tip is that of a strip about as long as the wedge, drawn independently of the strips
of the crack.
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from stiction.beam.cantilever import Beam
from stiction.contact import forcelaw


def tip_slope(length: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Slope of an arc at its tip, 3h/2L [-]; length of the beam [m], any shape."""
    return 1.5 * beam.gap / length


def arc_energy(length: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Adhesion energy of the tip below which an arc comes free, 3Et³h²/(8L⁴) [J m⁻²]; length [m], any shape."""
    return 3 / 8 * beam.young_modulus * beam.thickness**3 * beam.gap**2 / length**4


def arc_length(energy: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Longest arc that comes free of an adhesion energy at its tip [m]; `arc_energy` inverted; any shape.

    It is 2^(-1/2) = 0.7071 of the crack length of Eq. (13).
    """
    return (3 / 8 * beam.young_modulus * beam.thickness**3 * beam.gap**2 / energy) ** (1 / 4)


def wedge_length(law: np.ndarray, length: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Length of the wedge on which a law acts at the tip of an arc, e / f_max over the slope [m].

    Law [f_max, d_max, a_left, a_right], lengths of the beam [m]; laws (..., 4) and lengths broadcast.
    """
    return forcelaw.energy(law) / np.asarray(law)[..., 0] / tip_slope(length, beam)


def pull_of_strips(law: np.ndarray, slope: float, strip: float) -> float:
    """Largest force per width on a wedge whose strips have one point each [N m⁻¹].

    The tip is lifted from contact; the largest force on the way is taken. As the strips shrink it tends to e / slope.

    Parameters
    ----------
    law : (4,) array
        [f_max, d_max, a_left, a_right], SI, of every strip.
    slope : float
        Of the wedge [-].
    strip : float
        Length of the strips [m]; the points are in their middles.
    """
    f_max, d_max, a_left, a_right = law
    rise = slope * strip
    # A law has decayed 40 / a_right beyond d_max, and the repulsion grows within log(2) / a_left of it.
    points = rise * (np.arange(int(np.ceil(40 / (a_right * rise))) + 1) + 0.5)

    def pull(tip):
        return -float(np.sum(forcelaw.pressure(law, tip + points))) * strip

    lowest, highest = d_max - 3 / a_left - points[0], d_max + 3 / a_right
    tips = np.linspace(lowest, highest, 61)
    best = int(np.argmax([pull(tip) for tip in tips]))
    bounds = tips[max(best - 1, 0)], tips[min(best + 1, 60)]
    return -minimize_scalar(lambda tip: -pull(tip), bounds=bounds, method="bounded", options={"xatol": 1e-15}).fun


def arc_length_of_strips(beam: Beam, law: np.ndarray, strip: float) -> float:
    """Longest arc that comes free on uniform ground whose strips have one point each [m].

    As the strips shrink it tends to `arc_length`; on longer strips one point stands for the whole wedge and holds more
    of the beam, so that arcs let go at shorter lengths.
    """
    limit = arc_length(float(forcelaw.energy(law)), beam)

    def excess(length):
        bending = 3 * beam.bending_stiffness * beam.gap / length**3
        return np.log(bending / (beam.width * pull_of_strips(law, tip_slope(length, beam), strip)))

    return brentq(excess, 0.01 * limit, 2 * limit, rtol=1e-6)

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

from stiction.beam.cantilever import Beam


def tip_slope(length: float | np.ndarray, gap: float | np.ndarray) -> float | np.ndarray:
    """Slope of an arc at its tip, 3h/2L [-]; length of the beam and gap [m] broadcast."""
    return 1.5 * gap / length


def arc_length(energy: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Longest arc that comes free of an adhesion energy at its tip [J m⁻²], (3Et³h² / 8e)^(1/4) [m]; any shape.

    It is 2^(-1/2) = 0.7071 of the crack length of Eq. (13).
    """
    return (3 / 8 * beam.young_modulus * beam.thickness**3 * beam.gap**2 / energy) ** (1 / 4)


def wedge_length(energy: float, pull_off: float, slope: float | np.ndarray) -> float | np.ndarray:
    """Length of the wedge on which adhesion acts at the tip of an arc, e / f_max over its slope, any shape [m].

    Adhesion energy e [J m⁻²], largest attraction f_max [Pa].
    """
    return energy / pull_off / slope

"""Adhesion energy from a crack length: energy release rate of an S-shaped beam (Sec. IV, Eq. 13).

The beam is clamped at the height h and flat on the substrate beyond the crack length l.
"""

import numpy as np

from stiction.beam import tension
from stiction.beam.cantilever import Beam

#: Power with which the crack length of a beam without tension depends on the adhesion energy: l_s ~ Γ^(-1/4), Eq. (13).
CRACK_LENGTH_POWER = -1 / 4


def apparent_adhesion_energy(crack_length: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    r"""Apparent adhesion energy Γ from a crack length, Eq. (13): energy release rate of the S-shape.

    .. math:: \Gamma = \frac{3}{2} E \frac{h^2 t^3}{l_s^4} = -\frac{1}{w} \frac{dU}{dl_s}

    The elastic energy U of the S-shape is 6 E I h² / l_s³. For a beam under tension,
    `stiction.beam.tension.release_rate`.

    Parameters
    ----------
    crack_length : float or array, any shape
        l_s [m].
    beam : Beam

    Returns
    -------
    float or array, shape of ``crack_length``
        Γ [J m⁻²].

    Examples
    --------
    >>> beam = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 200)
    >>> round(float(apparent_adhesion_energy(710e-6, beam)) * 1e3, 2)  # mJ/m²
    6.81
    """
    if beam.tension:
        return tension.release_rate(crack_length, beam)
    return 1.5 * beam.young_modulus * beam.gap**2 * beam.thickness**3 / crack_length**4


def arrest_length(energy: float | np.ndarray, beam: Beam) -> float | np.ndarray:
    """Crack length [m] of an S-shaped beam at the adhesion energy Γ [J m⁻²], inverse of Eq. (13), any shape."""
    if beam.tension:
        return tension.arrest_length(energy, beam)
    return (energy / (1.5 * beam.young_modulus * beam.gap**2 * beam.thickness**3)) ** CRACK_LENGTH_POWER

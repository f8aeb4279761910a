"""Readings of an asperity: deviation of the crack lengths that they give, Eq. (13), from a reference."""

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.estimates import jackknife


def rms_deviation(energies: np.ndarray, others: np.ndarray, relative: float | np.ndarray = 1.0) -> tuple[float, float]:
    """Root mean square deviation of crack lengths from a reference, over humidities, and its jackknife error [-].

    Parameters
    ----------
    energies, others : (n, h) arrays
        Adhesion energies e of the same n strips at h humidities, by two models of the contact [J m⁻²].
    relative : (h,) array, optional
        Crack lengths of the other model over those of the reference [-]; the other model itself is the reference by
        default.
    """

    def rms(means):
        return np.sqrt(np.mean((relative * np.divide(*np.split(means, 2)) ** CRACK_LENGTH_POWER - 1) ** 2))

    return jackknife(rms, np.hstack([energies, others]))

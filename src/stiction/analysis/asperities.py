"""Readings of an asperity: deviation of their crack lengths, Eq. (13), from a reference."""

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.estimates import jackknife


def rms_deviation(energies: np.ndarray, others: np.ndarray, relative: float | np.ndarray = 1.0) -> tuple[float, float]:
    """Root mean square deviation of crack lengths from a reference, over humidities, and its jackknife error [-].

    Energies e (n, h) are those of the same strips at h humidities by two models of the contact [J m⁻²]. The other model
    is the reference, unless its crack lengths ``relative`` to those of the reference are given (h,) [-].
    """

    def rms(means):
        """Root mean square of the relative deviations of the crack lengths [-]."""
        return np.sqrt(np.mean((relative * np.divide(*np.split(means, 2)) ** CRACK_LENGTH_POWER - 1) ** 2))

    return jackknife(rms, np.hstack([energies, others]))

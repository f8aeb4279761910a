r"""Error of the model of the contact: the sum over summits against full elastic contact of the same strips.

The ratio of the mean adhesion energies changes crack lengths by its power -1/4, Eq. (13). It is one-sided and no random
error: it is stated beside a prediction and not added to its standard error.
"""

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.estimates import jackknife


def energy_ratios(full: np.ndarray, summits: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ratio of the mean energies and its jackknife error, (h,) each [-].

    The ratio of the means, and not the mean ratio, because single strips have ratios that scatter with small energies.

    Parameters
    ----------
    full, summits : (n, h) arrays
        Adhesion energies e of the same n strips at h humidities, by full contact and by the sum over summits [J m⁻²].
    """
    return jackknife(lambda means: np.divide(*np.split(means, 2)), np.hstack([full, summits]))


def length_factors(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Factor of the crack length under full contact at some humidities, and its jackknife error (k,) each [-].

    ASSUME: between the computed humidities, the logarithm of the ratio of the energies is linear in the humidity. It is
    not extrapolated: beyond them, the factor is NaN.

    Parameters
    ----------
    full, summits : (n, h) arrays
        As in `energy_ratios`.
    humidities : (h,) array
        Increasing [-].
    at : (k,) array
        [-]
    """

    def factors(means):
        logarithms = np.log(np.divide(*np.split(means, 2)))
        return np.exp(CRACK_LENGTH_POWER * np.interp(at, humidities, logarithms, left=np.nan, right=np.nan))

    return jackknife(factors, np.hstack([full, summits]))

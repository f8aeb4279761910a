r"""Error of the model of the contact: the sum over summits against full elastic contact of the same strips.

The ratio of the mean adhesion energies changes crack lengths by its power -1/4, Eq. (13), and that of the mean largest
attractions changes forces. It is one-sided and no random error: it is stated beside a prediction and not added to its
standard error.
"""

from collections.abc import Callable

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.contact.correction import interpolated
from stiction.estimates import jackknife


def factors(
    response: Callable[[np.ndarray], np.ndarray],
    full: np.ndarray,
    summits: np.ndarray,
    humidities: np.ndarray,
    at: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Factor of a response under full contact at some humidities, and its jackknife error (k,) each [-].

    That of the means, and not the mean factor, because single strips have ratios that scatter with small energies. The
    response leads from the means over the strips (h, ...) to what follows from them at each humidity (h,). ``full`` and
    ``summits`` are of the same strips (n, h, ...) by both models [SI], at increasing humidities (h,) [-]; beyond these,
    the factor is NaN.
    """
    shape = (2, *full.shape[1:])

    def of_means(means):
        changed, base = map(response, means.reshape(shape))
        return interpolated(changed / base, humidities, at)

    return jackknife(of_means, np.stack([full, summits], axis=1).reshape(len(full), -1))


def mean_ratios(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Ratio of the means at some humidities and its jackknife error; parameters and errors as in `factors`."""
    return factors(lambda means: means, full, summits, humidities, at)


def length_factors(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Factor of the crack length by Eq. (13), from adhesion energies (n, h) [J m⁻²]; otherwise as `mean_ratios`."""
    return factors(lambda energies: energies**CRACK_LENGTH_POWER, full, summits, humidities, at)

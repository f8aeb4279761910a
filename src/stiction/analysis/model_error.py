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
    """Factor of a response under full contact at some humidities, and its standard error (k,) each [-].

    That of the means, and not the mean factor, because single strips have ratios that scatter with small energies. The
    response leads from the means over the strips (h, ...) to what follows from them at each humidity (h,). ``full`` and
    ``summits`` are of the same strips (n, h, ...) by both models [SI], at increasing humidities (h,) [-]; beyond these,
    the factor is NaN. The error is that of the strips, by the jackknife, and that of the interpolation.
    """
    shape = (2, *full.shape[1:])

    def computed(means):
        changed, base = map(response, means.reshape(shape))
        return changed / base

    both = np.stack([full, summits], axis=1).reshape(len(full), -1)
    values, errors = jackknife(lambda means: interpolated(computed(means), humidities, at), both)
    between = values * interpolation_error(np.log(computed(both.mean(axis=0))), humidities, at)
    return values, np.hypot(errors, between)


def interpolation_error(logarithms: np.ndarray, humidities: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Standard error of the linear interpolation of logarithms of factors (h,) between humidities, (k,) [-].

    ASSUME: it is the difference to the polynomial that also has the factor 1 in saturated air, where water decides
    alone. On pair a, with three humidities, this is the error itself within a tenth for energies, and within a half for
    largest attractions. No three humidities show what a rougher curve does between them, such as that of the largest
    attraction on pair c.
    """
    nodes, values = np.append(humidities, 1.0), np.append(logarithms, 0.0)
    smooth = np.polynomial.Polynomial.fit(nodes, values, len(humidities))
    return np.abs(smooth(at) - np.interp(at, humidities, logarithms))


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

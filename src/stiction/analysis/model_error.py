r"""Error of the model of the contact: the sum over summits against full elastic contact of the same strips.

The ratio of the mean adhesion energies changes crack lengths by its power -1/4, Eq. (13), and that of the mean largest
attractions changes forces. It is one-sided and no random error: it is stated beside a prediction and not added to its
standard error.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from stiction.analysis.levels import half_of_two
from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.contact.air import is_humid
from stiction.contact.correction import interpolated
from stiction.estimates import jackknife

#: Share of the strips that exceed what `error_of_largest` is about.
RARE = 1e-3
#: ASSUME: fewer strips for each slope of a regression say too little about it. With 4 in all its error was a hundred
#: times that without it, or more (0.8 nm rms in dry air).
STRIPS_PER_SLOPE = 10


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
        """Ratio of the responses to both means [-]."""
        changed, base = map(response, means.reshape(shape))
        return changed / base

    samples = np.stack([full, summits], axis=1).reshape(len(full), -1)
    values, errors = jackknife(lambda means: interpolated(computed(means), humidities, at), samples)
    between = values * interpolation_error(np.log(computed(samples.mean(axis=0))), humidities, at)
    return values, np.hypot(errors, between)


def interpolation_error(logarithms: np.ndarray, humidities: np.ndarray, at: np.ndarray) -> np.ndarray:
    r"""Standard error of the linear interpolation of logarithms of factors (h,) between humidities, (k,) [-].

    The error of linear interpolation between :math:`x_i` and :math:`x_{i+1}` is exactly
    :math:`(x - x_i)(x_{i+1} - x)` times the second divided difference of the curve at these three points.

    ASSUME: this difference is of the size of the largest one of three neighbouring humidities, saturated air among
    them, where water decides alone and the factor is 1. On the pairs of the paper, true errors are within twice this
    standard error; curves that bend several times between two humidities are not. Dry air, humidity 0, is no point of
    these curves.
    """
    humid = is_humid(humidities)
    if not humid.any():
        return np.zeros(np.shape(at))
    nodes, values = np.append(humidities[humid], 1.0), np.append(logarithms[humid], 0.0)
    differences = np.diff(np.diff(values) / np.diff(nodes)) / (nodes[2:] - nodes[:-2])
    above = np.clip(np.searchsorted(nodes, at, side="right"), 1, len(nodes) - 1)
    error = np.abs(differences).max(initial=0.0) * (at - nodes[above - 1]) * (nodes[above] - at)
    return np.where(is_humid(at), error, 0.0)


def mean_ratios(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Ratio of the means at some humidities and its jackknife error. Parameters and errors as in `factors`."""
    return factors(lambda means: means, full, summits, humidities, at)


def beside_more(full: np.ndarray, summits: np.ndarray, more: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    r"""Values of strips by both models (n, k), moved to the mean of more strips on summits (N, k), N >= n.

    The regression estimator of two samples (W. G. Cochran, Sampling Techniques, 1977, ch. 12). With the mean M of all
    strips on summits, the n among them, and the slopes b of the linear regression of full contact F on the k columns S,

    .. math:: S_i' = M + \sqrt{n / N} \, (S_i - \bar S) , \quad F_i' = \bar F + (S_i' - \bar S) b + r_i ,

    so that both means have the errors and the correlation that they have over the two samples. The rest r_i is that of
    strip i from a regression without it, centred. Fewer than `STRIPS_PER_SLOPE` k strips are not moved.
    """
    (n, columns), mean, average = summits.shape, summits.mean(axis=0), full.mean(axis=0)
    if n < STRIPS_PER_SLOPE * columns:
        return full, summits
    off = summits - mean
    inverse = np.linalg.pinv(off)
    slopes, leverage = inverse @ (full - average), np.sum(off * inverse.T, axis=1, keepdims=True)
    residuals = (full - average - off @ slopes) / (1 - leverage * n / (n - 1))
    moved = more.mean(axis=0) + np.sqrt(n / len(more)) * off
    return average + (moved - mean) @ slopes + residuals - residuals.mean(axis=0), moved


def scatter_ratios(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Ratio of the standard deviations of the logarithms of positive values. Otherwise as `mean_ratios`."""

    def scatter(means):
        """Standard deviations, from the means of the logarithms and of their squares."""
        return np.sqrt(np.maximum(means[..., 1] - means[..., 0] ** 2, 0.0))

    logarithms = (np.log(values / values.mean(axis=0)) for values in (full, summits))
    with np.errstate(divide="ignore", invalid="ignore"):
        return factors(scatter, *(np.stack([values, values**2], axis=-1) for values in logarithms), humidities, at)


def error_of_largest(
    full: np.ndarray, summits: np.ndarray, moved: tuple[np.ndarray, np.ndarray] | None = None
) -> np.ndarray:
    r"""Relative standard error, by the strips, of the largest values after `stiction.contact.correction.ElasticChange`.

    Values of the same strips by both models, (n, h) each, and ``moved`` by `beside_more` if the ratio of the means is
    that of moved ones; NaN if some are zero. ASSUME: those on summits are log-normal with a known standard deviation s
    of the logarithm. The one that a share of `RARE` exceeds, z standard deviations above the mean, becomes

    .. math:: c \, x^b \propto r \exp(b s z - b^2 s^2 / 2) ,

    with the ratio r of the means and the power b >= 1, the ratio of the standard deviations.
    """
    shape = (6, full.shape[1])

    def largest(means):
        """Logarithm of the changed value (h,) [-]."""
        ratio, moments = means.reshape(shape)[:2], means.reshape(shape)[2:].reshape(2, 2, -1)
        deviations = np.sqrt(np.maximum(moments[:, 1] - moments[:, 0] ** 2, 0.0))
        exponent = scatter * np.maximum(deviations[0] / deviations[1], 1.0)
        return np.log(ratio[0] / ratio[1]) - exponent * ndtri(RARE) - exponent**2 / 2

    with np.errstate(divide="ignore", invalid="ignore"):
        logarithms = [np.log(values / values.mean(axis=0)) for values in (full, summits)]
        scatter = logarithms[1].std(axis=0)
        means = (full, summits) if moved is None else moved
        columns = [*means, *(power for values in logarithms for power in (values, values**2))]
        return jackknife(largest, np.stack(columns, axis=1).reshape(len(full), -1))[1]


class TipRatios(NamedTuple):
    """Ratios of both models for tips at humidities and slopes, and their standard error by the strips."""

    means: np.ndarray  #: ratios of the means (h, s) [-]
    error: np.ndarray  #: relative, of what one tip in 1000 exceeds after the change (h, s) [-]
    powers: np.ndarray  #: ratios of the standard deviations of the logarithms at all slopes (h,) [-]


def tip_ratios(full: np.ndarray, summits: np.ndarray) -> TipRatios:
    r"""Ratios of the largest attractions of tips in full contact and on summits (n, h, s), independent at each slope.

    ASSUME: they are log-normal, with a variance of the logarithm from mean and variance of the forces,

    .. math:: s^2 = \ln \frac{\overline{P^2}}{\bar P^2} ,

    because tips that hold next to nothing, and matter to no beam, decide that of the logarithms. It is averaged over
    the slopes. The error is as in `error_of_largest`.
    """
    shape, columns = full.shape[1:], np.stack([full, summits, full**2, summits**2], axis=1)

    def ratios(means):
        """Ratio of the means, logarithm of the changed value, and power, alike at all slopes (3, h, s) [-]."""
        first, second = np.split(means.reshape(4, *shape), 2)
        deviations = np.sqrt(np.log(second / first**2).mean(axis=-1, keepdims=True))
        ratio, power = first[0] / first[1], deviations[0] / deviations[1]
        exponent = scatter * np.maximum(power, 1.0)
        largest = np.log(ratio) - exponent * ndtri(RARE) - exponent**2 / 2
        return np.stack([ratio, largest, np.broadcast_to(power, shape)])

    scatter = np.sqrt(np.log(np.mean(summits**2, axis=0) / summits.mean(axis=0) ** 2).mean(axis=-1, keepdims=True))
    (means, _, powers), (_, error, _) = jackknife(ratios, columns.reshape(len(full), -1))
    return TipRatios(means, error, powers[:, 0])


def few_tip_ratios(full: np.ndarray, summits: np.ndarray, power_error: float) -> tuple[np.ndarray, np.ndarray]:
    """Ratios of the means of few tips in full contact (n, h, s) and more on summits (N, h, s), and their errors (h, s).

    Where both models are hardly correlated, as on pair b at RH 0.44, no regression on the same strips helps. The error
    is relative, that of what one tip in 1000 exceeds for a power of 1 with a standard error, and the part of the means
    half of what covers two of it by Student's t.
    """
    means, squares = (np.array([(each**power).mean(axis=0) for each in (full, summits)]) for power in (1, 2))
    numbers = np.array([len(full), len(summits)])
    variances = np.moveaxis((squares / means**2 - 1).reshape(2, -1) / (numbers - 1)[:, None], 0, -1)
    of_means = np.array([half_of_two(each, numbers - 1) for each in variances]).reshape(full.shape[1:])
    scatter = np.sqrt(np.log(squares[1] / means[1] ** 2).mean(axis=-1, keepdims=True))
    return means[0] / means[1], np.hypot(of_means, power_error * scatter * (-ndtri(RARE) - scatter))


def length_factors(
    full: np.ndarray, summits: np.ndarray, humidities: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Factor of the crack length by Eq. (13), from adhesion energies (n, h) [J m⁻²]. Otherwise as `mean_ratios`."""
    return factors(lambda energies: energies**CRACK_LENGTH_POWER, full, summits, humidities, at)


def rms_deviation(
    energies: np.ndarray, reference: np.ndarray, relative: float | np.ndarray = 1.0
) -> tuple[float, float]:
    """Root mean square deviation of crack lengths from a reference, over humidities, and its jackknife error [-].

    Energies e (n, h) are those of the same strips at h humidities by two models of the contact [J m⁻²]. The other model
    is the reference, unless its crack lengths ``relative`` to those of the reference are given (h,) [-].
    """

    def rms(means):
        """Root mean square of the relative deviations of the crack lengths [-]."""
        return np.sqrt(np.mean((relative * np.divide(*np.split(means, 2)) ** CRACK_LENGTH_POWER - 1) ** 2))

    return jackknife(rms, np.hstack([energies, reference]))

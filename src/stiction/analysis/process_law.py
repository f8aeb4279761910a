r"""Law from a process variable, such as an etch time, to the description of a surface, through measured settings.

Each quantity :math:`y` of the surface, in a scale in which all values are valid, is a polynomial of the variable. Its
degree is the one whose polynomials through all settings but one predict that one best. Settings weigh by their errors
and by a scatter beyond them, which a process has from run to run. Errors of quantities measured on the same scans are
correlated, and so are those of their polynomials.

A few settings hardly show the scatter. It is never taken as known: each scatter of a grid is as likely as its
restricted likelihood and a prior say, which widens the law as Student's t does, and what is built is one more run.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.special import logsumexp, softmax

from stiction.models import MOMENT_QUANTITIES, SPECTRUM_QUANTITIES

#: Quantities of a surface, in the order of all arrays.
QUANTITIES = MOMENT_QUANTITIES + SPECTRUM_QUANTITIES
#: Largest degree of a polynomial. ASSUME: no process turns more often within the measured settings.
LARGEST_DEGREE = 3
#: Standard errors between a setting and the law of the others that contradict each other.
CONTRADICTS = 3.0
#: Values of the variable at which a polynomial must be monotone.
_CHECKED = np.linspace(-1, 1, 41)
#: Standard deviations from run to run that are tried, in the scale of the law.
SCATTERS = np.geomspace(1e-4, 1.0, 30)
#: Scale of their prior, a half-Cauchy one. ASSUME: runs of a process differ by the order of 10 %; many times as much is
#: not excluded.
TYPICAL = 0.1


# Scale of the quantities


def scaled(values: np.ndarray) -> np.ndarray:
    """Quantities (..., 5) in the scale of the law: the kurtosis as ln(κ - 1 - γ²), the slope as ln(-slope).

    The quantities are ln rms, skewness, kurtosis, ln corner and slope.

    Examples
    --------
    >>> scaled(np.array([0.0, -0.5, 3.25, 0.0, -4.0])).round(3)
    array([ 0.   , -0.5  ,  0.693,  0.   ,  1.386])
    """
    rms, skewness, kurtosis, corner, slope = np.moveaxis(np.asarray(values, float), -1, 0)
    return np.stack([rms, skewness, np.log(kurtosis - 1 - skewness**2), corner, np.log(-slope)], axis=-1)


def unscaled(values: np.ndarray) -> np.ndarray:
    """Quantities (..., 5) back from the scale of the law. The kurtosis is above its bound, the slope is negative."""
    rms, skewness, excess, corner, steepness = np.moveaxis(np.asarray(values, float), -1, 0)
    return np.stack([rms, skewness, 1 + skewness**2 + np.exp(excess), corner, -np.exp(steepness)], axis=-1)


def jacobian(values: np.ndarray) -> np.ndarray:
    """Derivatives of the unscaled quantities by the scaled ones, at unscaled values (..., 5): (..., 5, 5)."""
    values = np.asarray(values, float)
    slopes = np.zeros((*values.shape, values.shape[-1]))
    for k in (0, 1, 3):
        slopes[..., k, k] = 1.0
    slopes[..., 2, 1] = 2 * values[..., 1]
    slopes[..., 2, 2] = values[..., 2] - 1 - values[..., 1] ** 2
    slopes[..., 4, 4] = values[..., 4]
    return slopes


def scaled_covariance(values: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """Covariance (..., 5, 5) of unscaled quantities (..., 5), in the scale of the law."""
    inverse = np.linalg.inv(jacobian(values))
    return inverse @ covariance @ np.swapaxes(inverse, -1, -2)


# Law


@dataclass(frozen=True)
class Parts:
    """Polynomials of q quantities, of d degrees and with each of t scatters, and how likely each is."""

    likely: np.ndarray  #: (q, d, t), a sum of 1 for each quantity
    coefficients: np.ndarray  #: (q, d, t, c)
    weights: np.ndarray  #: of the n settings in them (q, d, t, c, n)
    errors: np.ndarray  #: covariance of the errors of the settings (n, q, q)
    scatters: np.ndarray  #: (t,)


@dataclass(frozen=True)
class Law:
    """Polynomials of the scaled quantities, with the covariance of all their coefficients.

    Coefficients are those of Legendre polynomials on the range of the settings, with zeros beyond the degree.
    """

    settings: np.ndarray  #: (n,) values of the variable, increasing
    coefficients: np.ndarray  #: (q, c)
    covariance: np.ndarray  #: (q, c, q, c)
    degrees: np.ndarray  #: (q,)
    scatter: np.ndarray  #: (q,) standard deviation of runs beyond the errors of their settings, root of its mean square
    surprise: np.ndarray  #: (n, q) of each setting from the law of the others [standard errors], NaN if it has none
    parts: Parts

    @property
    def ends(self) -> tuple[float, float]:
        """Range of the settings. The law says nothing beyond it."""
        return float(self.settings[0]), float(self.settings[-1])

    def basis(self, values: np.ndarray) -> np.ndarray:
        """Legendre polynomials at values of the variable (n,), (n, c). Raises ValueError beyond the settings."""
        low, high = self.ends
        values = np.atleast_1d(np.asarray(values, float))
        if values.min() < low or values.max() > high:
            raise ValueError(f"a process is known from {low:g} to {high:g}, got {values.min():g} to {values.max():g}")
        return legvander(_position(values, low, high), self.coefficients.shape[1] - 1)

    def at(self, values: np.ndarray) -> np.ndarray:
        """Scaled quantities at values of the variable (n,), (n, q)."""
        return self.basis(values) @ self.coefficients.T

    def covariance_at(self, values: np.ndarray) -> np.ndarray:
        """Covariance of the scaled quantities at values of the variable (n,), (n, q, q)."""
        basis = self.basis(values)
        return np.einsum("nc,qcrd,nd->nqr", basis, self.covariance, basis)

    def draw(self, number: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """Errors of some laws as likely as this one, and the next run of each beyond it.

        Returns the errors of the coefficients (number, q, c), and the deviations of one run (number, q).
        """
        parts, (settings, quantities) = self.parts, self.parts.errors.shape[:2]
        values, vectors = np.linalg.eigh(parts.errors)
        measured = rng.standard_normal((number, settings, quantities)) * np.sqrt(np.maximum(values, 0))
        errors, drawn, runs = np.einsum("nqr,mnr->mnq", vectors, measured), [], []
        for quantity, likely in enumerate(parts.likely):
            degree, scatter = np.unravel_index(rng.choice(likely.size, number, p=likely.ravel()), likely.shape)
            wide = parts.scatters[scatter]
            of_settings = errors[:, :, quantity] + wide[:, None] * rng.standard_normal((number, settings))
            away = parts.coefficients[quantity, degree, scatter] - self.coefficients[quantity]
            drawn.append(away + np.einsum("mcn,mn->mc", parts.weights[quantity, degree, scatter], of_settings))
            runs.append(wide * rng.standard_normal(number))
        return np.stack(drawn, axis=1), np.stack(runs, axis=1)

    def with_setting(self, value: float, errors: np.ndarray) -> np.ndarray:
        """Covariance of the coefficients after one more setting with errors of the covariance (q, q)."""
        (basis,) = self.basis(value)
        covariance = self.covariance
        column = np.einsum("qcrd,d->qcr", covariance, basis)
        expected = np.einsum("c,qcr->qr", basis, column) + errors + np.diag(self.scatter**2)
        return covariance - np.einsum("qcr,rs,tds->qctd", column, np.linalg.inv(expected), column)


def fit(settings: np.ndarray, values: np.ndarray, covariances: np.ndarray) -> Law:
    """Law through measured settings.

    Parameters
    ----------
    settings : (n,) array
        Values of the variable, increasing, at least two.
    values : (n, q) array
        Scaled quantities of the surface at each.
    covariances : (n, q, q) array
        Covariance of their errors at each.

    Returns
    -------
    Law
        ASSUME: with two settings it is a straight line, which nothing checks.
    """
    position, errors = _position(settings, settings[0], settings[-1]), np.sqrt(np.einsum("nqq->nq", covariances))
    columns = list(zip(np.transpose(values), errors.T, strict=True))
    parts = Parts(
        *map(np.array, zip(*(_parts(position, *column) for column in columns), strict=True)), covariances, SCATTERS
    )
    coefficients = np.einsum("qdt,qdtc->qc", parts.likely, parts.coefficients)
    degrees = parts.likely.sum(axis=2).argmax(axis=1)
    scatter = np.sqrt(np.einsum("qdt,t->q", parts.likely, SCATTERS**2))
    surprise = [_surprise(position, *column, degree) for column, degree in zip(columns, degrees, strict=True)]
    covariance = _covariance(parts, coefficients)
    return Law(np.asarray(settings, float), coefficients, covariance, degrees, scatter, np.transpose(surprise), parts)


def _covariance(fits, coefficients):
    """Covariance of all coefficients (q, c, q, c), within and between the parts."""
    mean = np.einsum("qdt,qdtcn->qcn", fits.likely, fits.weights)
    covariance = np.einsum("qcn,nqr,rdn->qcrd", mean, fits.errors, mean)
    variances = np.einsum("nqq->qn", fits.errors)[:, None, None] + (fits.scatters**2)[:, None]
    away = fits.coefficients - coefficients[:, None, None]
    numbers = np.arange(len(coefficients))
    covariance[numbers, :, numbers] = np.einsum(
        "qdt,qdtan,qdtn,qdtbn->qab",
        fits.likely,
        fits.weights,
        np.broadcast_to(variances, (*fits.likely.shape, variances.shape[-1])),
        fits.weights,
    ) + np.einsum("qdt,qdta,qdtb->qab", fits.likely, away, away)
    return covariance


def contradictions(law: Law) -> list[tuple[int, int]]:
    """Settings and quantities (numbers of both) in contradiction to the law of the others, the worst of each quantity.

    With one setting more than coefficients, all are equally far from the law of the others: then the first is named.
    """
    worst = []
    for quantity, column in enumerate(np.abs(law.surprise).T):
        if np.isfinite(column).any() and np.nanmax(column) > CONTRADICTS:
            worst.append((int(np.nanargmax(column.round(6))), quantity))
    return worst


def is_unique(law: Law, quantity: int) -> bool:
    """Whether the settings determine the contradicting one in a quantity."""
    return len(law.settings) - 1 - law.degrees[quantity] > 1


def _position(values, low, high):
    """Values of the variable from -1 to 1."""
    return 2 * (np.asarray(values, float) - low) / (high - low) - 1


def _parts(position, values, errors):
    """Polynomials of all degrees with all scatters.

    Returns how likely they are (d, t), their coefficients (d, t, c), and weights of the values in them (d, t, c, n).
    """
    size = min(max(len(position) - 2, 1), LARGEST_DEGREE) + 1
    fits = [_fitted(position, values, errors, degree) for degree in range(size)]
    likely = np.array([probability for probability, *_ in fits])
    scores = np.array([_prediction(position, values, errors, *fit) for fit in enumerate(likely)])
    shares = softmax(
        _of_possible(scores, [probability @ coefficients for probability, coefficients, _ in fits], values)
    )
    weights, coefficients = np.zeros((size, len(SCATTERS), size, len(position))), np.zeros((size, len(SCATTERS), size))
    for degree, (_, of_degree, weights_of_degree) in enumerate(fits):
        coefficients[degree, :, : degree + 1], weights[degree, :, : degree + 1] = of_degree, weights_of_degree
    return shares[:, None] * likely, coefficients, weights


def _of_possible(scores, coefficients, values):
    """Scores of all degrees, that of those which settings cannot show without end below.

    Two settings are on a straight line. If the settings are monotone, so are the polynomials, unless another predicts
    far better.
    """
    changes = np.diff(values)
    if len(values) == 2:
        return np.array([-np.inf, 0.0])
    if (changes > 0).all() or (changes < 0).all():
        monotone = np.array([_is_monotone(polynomial) for polynomial in coefficients])
        return np.where(monotone | (scores > scores[monotone].max() + CONTRADICTS**2 / 2), scores, -np.inf)
    return scores


def _is_monotone(coefficients):
    """Whether a polynomial does not turn within the settings."""
    steps = np.diff(legvander(_CHECKED, len(coefficients) - 1) @ coefficients)
    return bool((steps >= 0).all() or (steps <= 0).all())


def _fitted(position, values, errors, degree):
    """How likely each scatter is (t,), coefficients with it (t, c), and weights of the values in these (t, c, n).

    The likelihood is the restricted one, of what the polynomial leaves.
    """
    wide, basis = np.hypot(errors, SCATTERS[:, None]), legvander(position, degree)
    weights = _weights(position, wide, degree)
    coefficients = weights @ values
    squares = np.sum(((values - coefficients @ basis.T) / wide) ** 2, axis=1)
    information = np.linalg.slogdet(np.einsum("na,tn,nb->tab", basis, wide**-2, basis))[1]
    restricted = -(squares + 2 * np.log(wide).sum(axis=1) + information) / 2
    prior = np.log(SCATTERS) - np.log1p((SCATTERS / TYPICAL) ** 2)  # of logarithms, which are evenly spaced
    return np.maximum(softmax(restricted + prior), np.finfo(float).tiny), coefficients, weights


def _prediction(position, values, errors, degree, likely):
    """Logarithm of the density of all settings, each under the law of the others, with scatters as likely as given."""
    if len(position) == 2:
        return 0.0
    total = 0.0
    for left_out in range(len(position)):
        residual, variance = _left_out(position, values, np.hypot(errors, SCATTERS[:, None]), degree, left_out)
        total += logsumexp(np.log(likely) - (np.log(variance) + residual**2 / variance) / 2)
    return total


def _left_out(position, values, errors, degree, left_out):
    """Residual of a setting from the law of the others, and its variance, for errors (..., n)."""
    others = np.arange(len(position)) != left_out
    weights = _weights(position[others], errors[..., others], degree)
    (basis,) = legvander(position[[left_out]], degree)
    along = basis @ weights
    variance = np.sum((along * errors[..., others]) ** 2, axis=-1) + errors[..., left_out] ** 2
    return values[left_out] - along @ values[others], variance


def _surprise(position, values, errors, degree):
    """Residual of each setting from the law of the others, by the stated errors alone."""
    if len(position) < degree + 2:
        return np.full(len(position), np.nan)
    parts = [_left_out(position, values, errors, degree, k) for k in range(len(position))]
    return np.array([residual / np.sqrt(variance) for residual, variance in parts])


def _weights(position, errors, degree):
    """Weights (..., c, n) of values with these errors (..., n) in the coefficients of a polynomial."""
    root = 1 / errors
    return np.linalg.pinv(root[..., None] * legvander(position, degree)) * root[..., None, :]


def grid(settings: Sequence[float], intervals: int = 6) -> np.ndarray:
    """Settings and evenly spaced values between neighbours, in at least so many intervals.

    Examples
    --------
    >>> grid([30, 60, 90]).tolist()
    [30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0]
    """
    parts = -(-intervals // (len(settings) - 1))
    between = [np.linspace(low, high, parts + 1)[:-1] for low, high in zip(settings, settings[1:], strict=False)]
    return np.append(np.concatenate(between), settings[-1]).astype(float).round(9)

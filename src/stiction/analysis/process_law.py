r"""Law from a process variable, such as an etch time, to the description of a surface, through measured settings.

Each quantity :math:`y` of the surface, in a scale in which all values are valid, is a polynomial of the variable. Its
degree is the one whose polynomials through all settings but one predict that one best. Settings weigh by their errors
and by a scatter beyond them, which a process has from run to run. Errors of quantities measured on the same scans are
correlated, and so are those of their polynomials.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.optimize import brentq
from scipy.special import chdtrc

from stiction.models import MOMENT_QUANTITIES, SPECTRUM_QUANTITIES

#: Quantities of a surface, in the order of all arrays.
QUANTITIES = MOMENT_QUANTITIES + SPECTRUM_QUANTITIES
#: Largest degree of a polynomial. ASSUME: no process turns more often within the measured settings.
LARGEST_DEGREE = 3
#: Standard errors between a setting and the law of the others that contradict each other.
CONTRADICTS = 3.0
#: Values of the variable at which a polynomial must be monotone.
_CHECKED = np.linspace(-1, 1, 41)


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
class Law:
    """Polynomials of the scaled quantities, with the covariance of all their coefficients.

    Coefficients are those of Legendre polynomials on the range of the settings, with zeros beyond the degree.
    """

    settings: np.ndarray  #: (n,) values of the variable, increasing
    coefficients: np.ndarray  #: (q, c)
    covariance: np.ndarray  #: (q, c, q, c)
    degrees: np.ndarray  #: (q,)
    scatter: np.ndarray  #: (q,) standard deviation of the settings beyond their errors
    surprise: np.ndarray  #: (n, q) of each setting from the law of the others [standard errors], NaN if it has none

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

    def drawn(self, number: int, rng: np.random.Generator) -> np.ndarray:
        """Errors of the coefficients of some laws as likely as this one, (number, q, c)."""
        size = self.coefficients.size
        values, vectors = np.linalg.eigh(self.covariance.reshape(size, size))
        errors = rng.standard_normal((number, size)) * np.sqrt(np.maximum(values, 0))
        return (errors @ vectors.T).reshape(number, *self.coefficients.shape)

    def with_setting(self, value: float, errors: np.ndarray) -> np.ndarray:
        """Covariance of the coefficients after one more setting with errors of the covariance (q, q)."""
        (basis,) = self.basis(value)
        known = self.covariance
        column = np.einsum("qcrd,d->qcr", known, basis)
        expected = np.einsum("c,qcr->qr", basis, column) + errors + np.diag(self.scatter**2)
        return known - np.einsum("qcr,rs,tds->qctd", column, np.linalg.inv(expected), column)


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
    means = [_mean(position, *column) for column in columns]
    coefficients, weights, between, scatter, degrees = (np.array(part) for part in zip(*means, strict=True))
    total = covariances + np.eye(len(columns)) * np.square(scatter)
    covariance = np.einsum("qcn,nqr,rdn->qcrd", weights, total, weights)
    own = np.arange(len(columns))
    covariance[own, :, own] += between
    surprise = [_surprise(position, *column, degree) for column, degree in zip(columns, degrees, strict=True)]
    return Law(np.asarray(settings, float), coefficients, covariance, degrees, scatter, np.transpose(surprise))


def contradictions(law: Law) -> list[tuple[int, int]]:
    """Settings and quantities (numbers of both) in contradiction to the law of the others, the worst of each quantity.

    With one setting more than coefficients, all are equally far from the law of the others: then the first is named.
    """
    found = []
    for quantity, column in enumerate(np.abs(law.surprise).T):
        if np.isfinite(column).any() and np.nanmax(column) > CONTRADICTS:
            found.append((int(np.nanargmax(column.round(6))), quantity))
    return found


def is_unique(law: Law, quantity: int) -> bool:
    """Whether the settings determine the contradicting one in a quantity."""
    return len(law.settings) - 1 - law.degrees[quantity] > 1


def _position(values, low, high):
    """Values of the variable from -1 to 1."""
    return 2 * (np.asarray(values, float) - low) / (high - low) - 1


def _mean(position, values, errors):
    """Mean of polynomials of all degrees, as likely as they predict settings that are left out.

    Returns its coefficients (c,), weights of the values in them (c, n), covariance between the polynomials (c, c),
    scatter, and the most likely degree.
    """
    size = min(max(len(position) - 2, 1), LARGEST_DEGREE) + 1
    degrees, scores = _degrees(position, values, errors)
    likely = np.exp((scores.min() - scores) / 2) / np.sum(np.exp((scores.min() - scores) / 2))
    coefficients, weights, scatter = np.zeros((len(degrees), size)), np.zeros((len(degrees), size, len(position))), []
    for k, degree in enumerate(degrees):
        coefficients[k, : degree + 1], weights[k, : degree + 1], beyond = _fitted(position, values, errors, degree)
        scatter.append(beyond)
    mean = likely @ coefficients
    between = np.einsum("k,kc,kd->cd", likely, coefficients - mean, coefficients - mean)
    beyond = float(np.sqrt(likely @ np.square(scatter)))
    return mean, np.einsum("k,kcn->cn", likely, weights), between, beyond, degrees[int(np.argmax(likely))]


def _degrees(position, values, errors):
    """Degrees that settings can tell from each other, and how well each predicts those left out, as by `_prediction`.

    If the settings are monotone, so are the polynomials, unless another predicts far better.
    """
    number, changes = len(position), np.diff(values)
    degrees = [1] if number == 2 else list(range(min(number - 2, LARGEST_DEGREE) + 1))
    scores = np.array([_prediction(position, values, errors, degree) for degree in degrees])
    if (changes > 0).all() or (changes < 0).all():
        monotone = np.array([_is_monotone(_fitted(position, values, errors, degree)[0]) for degree in degrees])
        kept = monotone | (scores < scores[monotone].min() - CONTRADICTS**2)
        degrees, scores = [degree for degree, keep in zip(degrees, kept, strict=True) if keep], scores[kept]
    return degrees, scores


def _is_monotone(coefficients):
    """Whether a polynomial does not turn within the settings."""
    steps = np.diff(legvander(_CHECKED, len(coefficients) - 1) @ coefficients)
    return bool((steps >= 0).all() or (steps <= 0).all())


def _prediction(position, values, errors, degree):
    """Twice the negative logarithm of the density of all settings, each under the law of the others."""
    if len(position) == 2:
        return 0.0
    scatter, total = _fitted(position, values, errors, degree)[2], 0.0
    for left_out in range(len(position)):
        residual, variance = _left_out(position, values, np.hypot(errors, scatter), degree, left_out)
        total += np.log(variance) + residual**2 / variance
    return total


def _left_out(position, values, errors, degree, left_out):
    """Residual of a setting from the law of the others, and its variance."""
    others = np.arange(len(position)) != left_out
    weights = _weights(position[others], errors[others], degree)
    (basis,) = legvander(position[[left_out]], degree)
    variance = (basis @ weights) ** 2 @ errors[others] ** 2 + errors[left_out] ** 2
    return values[left_out] - basis @ weights @ values[others], variance


def _surprise(position, values, errors, degree):
    """Residual of each setting from the law of the others, by the stated errors alone."""
    if len(position) < degree + 2:
        return np.full(len(position), np.nan)
    parts = [_left_out(position, values, errors, degree, k) for k in range(len(position))]
    return np.array([residual / np.sqrt(variance) for residual, variance in parts])


def _weights(position, errors, degree):
    """Weights (c, n) of values with these errors in the coefficients of a polynomial."""
    root = 1 / errors
    return np.linalg.pinv(root[:, None] * legvander(position, degree)) * root


def _fitted(position, values, errors, degree):
    """Coefficients (c,), weights (c, n) of the values in them, and scatter beyond the errors.

    The scatter is the smallest one with which the settings agree with their polynomial as they should.
    """
    freedom, scatter = len(position) - degree - 1, 0.0

    def excess(scatter):
        """Chi squared with a scatter, beyond the degrees of freedom."""
        wide = np.hypot(errors, scatter)
        left = values - legvander(position, degree) @ _weights(position, wide, degree) @ values
        return float(np.sum((left / wide) ** 2)) - freedom

    if freedom and excess(0.0) > 0:
        scatter = float(brentq(excess, 0.0, np.ptp(values) * np.sqrt(len(values))))
    weights = _weights(position, np.hypot(errors, scatter), degree)
    return weights @ values, weights, scatter


def fit_probability(law: Law, values: np.ndarray, errors: np.ndarray, quantity: int) -> float:
    """Probability of a worse agreement of the settings (n,) with their law, by their errors (n,) alone [-]."""
    residuals = (values - law.at(law.settings)[:, quantity]) / errors
    freedom = len(values) - 1 - law.degrees[quantity]
    return float(chdtrc(freedom, np.sum(residuals**2))) if freedom else float("nan")


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

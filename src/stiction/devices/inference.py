r"""Inputs of a device from test beams: evidence of measured crack lengths, or counts of stuck beams.

As in `stiction.devices.budget`, logarithms of lengths are linear in their inputs, :math:`\ln l = \ln l_0 + h^T x`,
where x are the errors of the inputs, normal with covariance C before the test beams are measured. The model errs as
well; its *discrepancy* is

.. math:: \delta = \alpha + \beta (u - \bar u) + \varepsilon, \qquad u = \ln l - \ln l(1\,\mathrm{J/m^2}),

with one factor and one slope for all beams, and a rest of its own for every array and humidity. Measured from the
length at an adhesion energy of 1 J/m², u is -1/4 of the logarithm of the energy, so that beams of other dimensions
share α and β. They are inputs like all others here. With the differences d = ln(measured / computed) of n test beams,
their responses H (n, k) and the covariance R of their errors, the knowledge after the measurement is

.. math:: \bar x = C H^T S^{-1} d, \qquad C' = C - C H^T S^{-1} H C, \qquad S = H C H^T + R .

Counts are no logarithms of lengths. Of beams of length L, a shape holds the share :math:`\Phi(z_i(\ln L - h_i^T x))`,
where :math:`z_i` is the normal score of its lengths as computed, and a beam sticks if any shape holds it,
:math:`P = 1 - \prod_i \Phi(-z_i)`. Where all or none of the beams stick, the knowledge after the measurement is nearly
a box, and its curvature at the most probable errors says little about its width. Counts depend on few combinations of
the inputs, the ln l of the counted beams: these are drawn and weighted (`stiction.devices.draws`), and with each of
them all inputs are normal.
"""

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator, PPoly, make_interp_spline
from scipy.linalg import block_diag
from scipy.optimize import minimize
from scipy.special import chdtrc, log_ndtr, logsumexp, ndtr, xlogy

from stiction.devices.draws import weighted
from stiction.devices.tail import fit_tail

#: Names of the discrepancy of the model among the inputs: of its factor and of its slope.
FACTOR, SLOPE = "factor of the model", "slope of the model"
#: Normal scores at which quantiles of a result are given.
SCORES = np.linspace(-4, 4, 17)
#: Number of draws that stand for the knowledge after counts, and halvings of the interval in which a quantile is.
_KEPT, _HALVINGS = 4096, 40
#: Step of second derivatives, in standard deviations.
_STEP = 1e-4
#: Standard deviation that is added to the knowledge of a logarithm, so that its quantiles are apart.
_APART = 1e-12
#: Normal scores at which the lengths of a shape are tabulated: on the fitted line, as quantiles, and beyond them.
_SHORT, _QUANTILES, _FAR = (-8.0, -4.0, -2.0), np.linspace(-1.5, 2.0, 8), 8.0
#: Variance below which a direction of the prior counts as exactly known, relative to that of single inputs.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class NormalMixture:
    """Equally probable normal distributions of the errors of inputs. Together they are their distribution."""

    centres: np.ndarray  #: (m, k)
    covariance: np.ndarray  #: of each of them (k, k)

    def quantiles(self, response: np.ndarray, scores: np.ndarray) -> np.ndarray:
        """Quantiles of the linear response of a result (k,) at normal scores (s,), (s,)."""
        centres = self.centres @ response
        deviation = max(np.sqrt(max(response @ self.covariance @ response, 0.0)), np.finfo(float).tiny)
        reach = (np.abs(scores).max() + 1) * deviation
        low, high = (np.full(len(scores), end) for end in (centres.min() - reach, centres.max() + reach))
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            is_low = ndtr((middle[:, None] - centres) / deviation).mean(axis=1) < ndtr(scores)
            low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
        return (low + high) / 2


@dataclass(frozen=True)
class KnownInputs:
    """Distribution of the errors of inputs, normal unless there are draws."""

    names: tuple[str, ...]  #: of the inputs
    mean: np.ndarray  #: (k,), zero before a measurement, in the units of the inputs
    covariance: np.ndarray  #: (k, k)
    draws: NormalMixture | None = None

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviation of every input (k,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    def response_moments(self, response: np.ndarray) -> tuple[float | np.ndarray, float | np.ndarray]:
        """Mean and standard deviation of the linear response of some results to the inputs, (..., k) -> (...)."""
        variance = np.einsum("...i,ij,...j->...", response, self.covariance, response)
        return response @ self.mean, np.sqrt(np.maximum(variance, 0.0))

    def quantiles(self, responses: np.ndarray, scores: np.ndarray = SCORES) -> np.ndarray:
        """Quantiles of the linear responses of some results (n, k) at normal scores (s,), (n, s)."""
        if self.draws is None:
            mean, deviation = self.response_moments(responses)
            return mean[:, None] + deviation[:, None] * scores
        rows = [self.draws.quantiles(response, scores) for response in responses]
        return np.reshape(rows, (len(responses), len(scores)))


@dataclass(frozen=True)
class CrackData:
    """Mean crack lengths of test beams beside the computed ones."""

    responses: np.ndarray  #: d ln l / dx (n, k)
    differences: np.ndarray  #: ln(measured / computed) (n,) [-]
    errors: np.ndarray  #: standard errors of these (n,) [-]


@dataclass(frozen=True)
class Counts:
    """Numbers of stuck test beams of given lengths, each able to stick in any of s shapes."""

    responses: np.ndarray  #: d ln l / dx of every shape (n, s, k)
    lengths: np.ndarray  #: of the beams that every shape could hold (n, s) [m]
    scores: Sequence[Sequence[PPoly]]  #: normal score of every shape over ln l, `score` or `lognormal`; n times s
    stuck: np.ndarray  #: (n,)
    beams: np.ndarray  #: stuck and free together (n,)

    def __len__(self):
        return len(self.stuck)

    def scored(self, errors: np.ndarray, order: int = 0) -> np.ndarray:
        """Normal scores of all shapes at errors of inputs, or their derivatives by ln l, (..., k) -> (..., n, s)."""
        at = np.log(self.lengths) - np.tensordot(errors, self.responses, (-1, -1))
        scores = [score(at[..., i, j], order) for i, shapes in enumerate(self.scores) for j, score in enumerate(shapes)]
        return np.reshape(np.moveaxis(scores, 0, -1), at.shape)

    def logarithms(self, errors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Logarithms of P(stuck) and P(free) at errors of the inputs, (..., k) -> (..., n) each."""
        scores = self.scored(errors)
        free = log_ndtr(-scores).cumsum(axis=-1)
        # The first shape that holds a beam: no difference of nearly equal numbers.
        before = np.concatenate([np.zeros_like(free[..., :1]), free[..., :-1]], axis=-1)
        return logsumexp(log_ndtr(scores) + before, axis=-1), free[..., -1]

    def share(self, errors: np.ndarray) -> np.ndarray:
        """P(stuck) at errors of the inputs (k,), (n,) [-]."""
        return np.exp(self.logarithms(errors)[0])

    def deviance(self, errors: np.ndarray) -> float | np.ndarray:
        """Deviance of errors: twice the log of the likelihood ratio to the counted fractions, (..., k) -> (...)."""
        stuck, free = self.logarithms(errors)
        released = self.beams - self.stuck
        best = xlogy(self.stuck, self.stuck / self.beams) + xlogy(released, released / self.beams)
        return 2 * np.sum(best - self.stuck * stuck - released * free, axis=-1)

    def slope(self, errors: np.ndarray) -> np.ndarray:
        """Derivative of the deviance by the errors of the inputs (k,), (k,)."""
        stuck, free = self.logarithms(errors)
        scores = self.scored(errors)
        # d ln P(free) = -φ(z) / Φ(-z) dz, and P(stuck) is the rest of 1.
        of_free = -(scores**2 + np.log(2 * np.pi)) / 2 - log_ndtr(-scores)
        of_stuck = of_free + (free - stuck)[:, None]
        by_score = (self.beams - self.stuck)[:, None] * np.exp(of_free) - self.stuck[:, None] * np.exp(of_stuck)
        return -2 * np.einsum("ns,nsk->k", by_score * self.scored(errors, 1), self.responses)


def lognormal(centre: float, scatter: float) -> PPoly:
    """Normal score over ln l of lognormal lengths with a median [m] and a standard deviation of ln l."""
    return PchipInterpolator(np.log(centre) + scatter * np.array([-1, 1]), [-1, 1])


def score(lengths: np.ndarray) -> PPoly:
    """Normal score over ln l of any lengths (m,) [m]: between quantiles, and at their short end on the fitted line.

    ASSUME: the long end goes on as straight as the last two quantiles.
    """
    tail, inner = fit_tail(lengths), np.log(np.quantile(lengths, ndtr(_QUANTILES)))
    last_slope = (inner[-1] - inner[-2]) / (_QUANTILES[-1] - _QUANTILES[-2])
    ends = [np.log(tail.length(ndtr(z))) for z in _SHORT], [inner[-1] + (_FAR - _QUANTILES[-1]) * last_slope]
    return PchipInterpolator(np.concatenate([ends[0], inner, ends[1]]), [*_SHORT, *_QUANTILES, _FAR])


# Discrepancy of the model


@dataclass(frozen=True)
class DiscrepancyOfModel:
    """Standard deviations of the discrepancy of the model in ln l, before test beams are measured."""

    factor: float  #: of α [-]
    slope: float  #: of β [-]
    rest: float  #: of ε [-]


def rest(condition: Hashable) -> str:
    """Name of the rest of the model under a condition among the inputs."""
    return f"rest of the model, {condition}"


def with_discrepancy(
    prior: KnownInputs,
    responses: np.ndarray,
    reduced: np.ndarray,
    conditions: Sequence[Hashable | None],
    discrepancy: DiscrepancyOfModel,
) -> tuple[KnownInputs, np.ndarray]:
    """Prior of the inputs and of the discrepancy, and the responses of all results to both.

    Parameters
    ----------
    prior : Knowledge
        Of k inputs.
    responses : (n, k) array
        d ln l / dx of all results, of test beams and of devices.
    reduced : (n,) array
        u less the place about which the slope is [-].
    conditions : sequence of n
        Results under equal conditions have the same rest; those under none have no discrepancy at all.
    stated : Discrepancy

    Returns
    -------
    Knowledge
        Of k + 2 + m inputs for m different conditions.
    (n, k + 2 + m) array
    """
    rests = [condition for condition in dict.fromkeys(conditions) if condition is not None]
    has_rest = np.array([[condition == other for other in rests] for condition in conditions], float)
    has_rest = has_rest.reshape(len(conditions), len(rests))
    errs = np.array([condition is not None for condition in conditions], float)
    variances = np.array([discrepancy.factor, discrepancy.slope, *[discrepancy.rest] * len(rests)]) ** 2
    mean = np.concatenate([prior.mean, np.zeros(len(variances))])
    names = (*prior.names, FACTOR, SLOPE, *map(rest, rests))
    widened = KnownInputs(names, mean, block_diag(prior.covariance, np.diag(variances)))
    return widened, np.column_stack([responses, errs, errs * reduced, has_rest])


# Update


def given_lengths(prior: KnownInputs, data: CrackData) -> KnownInputs:
    """Knowledge after mean crack lengths were measured."""
    shared = prior.covariance @ data.responses.T
    gain = np.linalg.solve(_spread(prior, data), shared.T).T
    mean = prior.mean + gain @ (data.differences - data.responses @ prior.mean)
    covariance = prior.covariance - gain @ shared.T
    return KnownInputs(prior.names, mean, (covariance + covariance.T) / 2)


def _spread(prior, data):
    """Covariance of the differences before they are measured, S (n, n)."""
    return data.responses @ prior.covariance @ data.responses.T + np.diag(data.errors**2)


def update(
    prior: KnownInputs, lengths: CrackData, counts: Counts | None = None, rng: np.random.Generator | None = None
) -> KnownInputs:
    """Knowledge after measured crack lengths and counts of stuck beams. For counts, errors are drawn.

    Raises
    ------
    NotConverged
        If too few draws are probable.
    """
    after_lengths = given_lengths(prior, lengths)
    if counts is None or not len(counts):
        return after_lengths
    gain = _counted_directions(after_lengths, counts)
    misfit = _Misfit(after_lengths.mean, gain, counts)
    mode = misfit.most_probable()
    errors, weights = weighted(misfit.log_likelihood, mode, misfit.curvature(mode), rng)
    mean, residual = weights @ errors, after_lengths.covariance - gain @ gain.T
    spread = (errors - mean).T @ ((errors - mean) * weights[:, None])
    resampled = np.searchsorted(np.cumsum(weights), (np.arange(_KEPT) + 0.5) / _KEPT)
    draws = NormalMixture(after_lengths.mean + errors[resampled] @ gain.T, residual)
    return KnownInputs(prior.names, after_lengths.mean + gain @ mean, residual + gain @ spread @ gain.T, draws)


def _counted_directions(knowledge, counts):
    """Expected inputs per independent standard normal error (k, r). Counts depend on these errors alone."""
    *shape, inputs = counts.responses.shape
    responses = counts.responses.reshape(math.prod(shape), inputs)
    shared = knowledge.covariance @ responses.T
    variances, axes = np.linalg.eigh(responses @ shared)
    uncertain = variances > _ROUNDING * variances.max()
    return shared @ (axes[:, uncertain] / np.sqrt(variances[uncertain]))


@dataclass(frozen=True)
class _Misfit:
    """Half the sum of the squares of independent standard normal errors, and of the deviance of counts."""

    mean: np.ndarray  #: inputs without errors (k,)
    gain: np.ndarray  #: inputs per error (k, r)
    counts: Counts

    def log_likelihood(self, errors: np.ndarray) -> np.ndarray:
        """Logarithm of the probability of the counts, up to a constant, (..., r) -> (...)."""
        return -self.counts.deviance(self.mean + errors @ self.gain.T) / 2

    def __call__(self, errors: np.ndarray) -> float:
        return errors @ errors / 2 - self.log_likelihood(errors)

    def slope(self, errors: np.ndarray) -> np.ndarray:
        """Derivative by the errors (r,), (r,)."""
        return errors + self.counts.slope(self.mean + errors @ self.gain.T) @ self.gain / 2

    def curvature(self, errors: np.ndarray) -> np.ndarray:
        """Second derivatives by the errors (r,), (r, r)."""
        steps = _STEP * np.eye(len(errors))
        rows = [(self.slope(errors + step) - self.slope(errors - step)) / (2 * _STEP) for step in steps]
        return np.reshape(np.add(rows, np.transpose(rows)) / 2, steps.shape)

    def most_probable(self) -> np.ndarray:
        """Errors with the least misfit (r,)."""
        start = np.zeros(self.gain.shape[1])
        return minimize(self, start, jac=self.slope, method="BFGS").x if start.size else start


# What the data say


def least_misfits(prior: KnownInputs, lengths: CrackData, counts: Counts | None = None) -> list[tuple[float, int]]:
    r"""Least misfits of lengths, and of counts after these, each with its number of data.

    :math:`d^T S^{-1} d` is the least sum of the squares of all pulls, on the data and on the inputs. Of counts, their
    deviance takes the place of a pull.
    """
    away = lengths.differences - lengths.responses @ prior.mean
    misfits = [(float(away @ np.linalg.solve(_spread(prior, lengths), away)), len(away))]
    if counts is not None and len(counts):
        after_lengths = given_lengths(prior, lengths)
        misfit = _Misfit(after_lengths.mean, _counted_directions(after_lengths, counts), counts)
        misfits.append((2 * misfit(misfit.most_probable()), len(counts)))
    return misfits


def p_value(prior: KnownInputs, lengths: CrackData, counts: Counts | None = None) -> float:
    """Probability of differences at least as large as the measured ones, before these are used [-].

    Each of the `least_misfits` has a chi-squared distribution if inputs and discrepancy err as stated: data that no
    input explains have a small p value. Those of lengths and of counts are independent, and the smaller p value counts.
    In a sum, counts that anything explains would hide a contradiction between lengths.
    ASSUME: the prior predictive one; after an update, the data would be used twice, and hide what they contradict. The
    chi-squared distribution of deviances is that of many beams; that of few, all or none of them stuck, is narrower.
    """
    values = [chdtrc(number, misfit) for misfit, number in least_misfits(prior, lengths, counts) if number]
    least = min(values, default=1.0)
    return float(-np.expm1(len(values) * np.log1p(-least))) if least < 1 else 1.0


@dataclass(frozen=True)
class Combination:
    """Combination of the errors of inputs, independent of all others before and after the measurement."""

    correlations: np.ndarray  #: of every input with the combination before the measurement (k,) [-]
    remaining: float  #: its standard deviation after the measurement, that before being 1 [-]


def combinations(prior: KnownInputs, posterior: KnownInputs) -> list[Combination]:
    """Independent combinations of the errors of all inputs, the best determined by the data first.

    Data determine as many of them as there are independent data. Inputs that are correlated with the same combination
    are not told apart.
    """
    scale = np.where(prior.deviations > 0, prior.deviations, 1)
    variances, axes = np.linalg.eigh(prior.covariance / np.outer(scale, scale))
    uncertain = variances > _ROUNDING
    root = axes[:, uncertain] * np.sqrt(variances[uncertain])
    inverse = root / variances[uncertain]
    ratios, directions = np.linalg.eigh(inverse.T @ (posterior.covariance / np.outer(scale, scale)) @ inverse)
    deviations = np.sqrt(np.maximum(ratios, 0.0))
    return [Combination(_signed(axis), float(at)) for axis, at in zip((root @ directions).T, deviations, strict=True)]


def _signed(values):
    """Values with the sign of a positive largest one."""
    return values * np.sign(values[np.argmax(np.abs(values))])


def expected_share(margins: np.ndarray, weights: np.ndarray, quantiles: np.ndarray) -> float:
    """P(stuck) of devices if ln of the stuck lengths has a shift with these quantiles at normal scores `SCORES`.

    The margins are ln(length of the devices / length that sticks), as computed, and the weights the shares of the
    devices with each of these (n,) [-]; the others never stick. Beyond the quantiles, their distances stay as they are.
    NaN if the quantiles are not known.
    """
    if np.isnan(quantiles).any():
        return np.nan
    score = make_interp_spline(quantiles + _APART * SCORES, SCORES, k=1)
    return float(weights @ ndtr(score(margins)))


def further_beams(knowledge: KnownInputs, target: np.ndarray, response: np.ndarray, error: float) -> float:
    """Standard deviation of a result after the mean length of further test beams is measured [-].

    The responses of the result, ``target``, and of the further test beams are (k,); the error is that of their ln l
    [-].
    """
    data = CrackData(response[None], np.zeros(1), np.array([error]))
    return float(given_lengths(knowledge, data).response_moments(target)[1])

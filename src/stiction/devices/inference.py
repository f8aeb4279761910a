r"""From test beams to a device: what measured crack lengths, or counts of stuck beams, say about the inputs.

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
:math:`P = 1 - \prod_i \Phi(-z_i)`. Newton steps on the probit of P find the most probable errors of the inputs.
"""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator, PPoly
from scipy.linalg import block_diag
from scipy.special import chdtrc, log_ndtr, logsumexp, ndtr, ndtri_exp, xlogy

from stiction.devices.tail import fit_tail
from stiction.errors import NotConverged

#: Names of the discrepancy of the model among the inputs: of its factor and of its slope.
FACTOR, SLOPE = "factor of the model", "slope of the model"
#: Newton steps for counts, and the change in prior standard deviations at which they end.
_STEPS, _CLOSE = 50, 1e-7
#: Curvature of the logarithm of a probability that tells nothing.
_NOTHING = 1e-12
#: Normal scores at which the lengths of a shape are tabulated: on the fitted line, as quantiles, and beyond them.
_SHORT, _QUANTILES, _FAR = (-8.0, -4.0, -2.0), np.linspace(-1.5, 2.0, 8), 8.0
#: Variance below which a direction of the prior counts as exactly known, relative to that of single inputs.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Knowledge:
    """Normal distribution of the errors of inputs."""

    names: tuple[str, ...]  #: of the inputs
    mean: np.ndarray  #: (k,), zero before a measurement, in the units of the inputs
    covariance: np.ndarray  #: (k, k)

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviation of every input (k,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    def of(self, response: np.ndarray) -> tuple[float | np.ndarray, float | np.ndarray]:
        """Mean and standard deviation of the linear response of some results to the inputs, (..., k) -> (...)."""
        variance = np.einsum("...i,ij,...j->...", response, self.covariance, response)
        return response @ self.mean, np.sqrt(np.maximum(variance, 0.0))


@dataclass(frozen=True)
class Lengths:
    """Mean crack lengths of test beams beside those that were computed."""

    responses: np.ndarray  #: d ln l / dx (n, k)
    differences: np.ndarray  #: ln(measured / computed) (n,) [-]
    errors: np.ndarray  #: standard errors of these (n,) [-]


@dataclass(frozen=True)
class Counts:
    """Numbers of stuck test beams of given lengths, each of which may be held in any of s shapes."""

    responses: np.ndarray  #: d ln l / dx of every shape (n, s, k)
    lengths: np.ndarray  #: of the beams that every shape could hold (n, s) [m]
    scores: Sequence[Sequence[PPoly]]  #: normal score of every shape over ln l, `score` or `lognormal`; n times s
    stuck: np.ndarray  #: (n,)
    beams: np.ndarray  #: stuck and free together (n,)

    def __len__(self):
        return len(self.stuck)

    def scored(self, errors: np.ndarray, order: int = 0) -> np.ndarray:
        """Normal scores of all shapes at errors of the inputs (k,), or their derivatives by ln l (n, s)."""
        at = np.log(self.lengths) - self.responses @ errors
        scores = [[s(x, order) for s, x in zip(*shapes, strict=True)] for shapes in zip(self.scores, at, strict=True)]
        return np.reshape(scores, self.lengths.shape)

    def logarithms(self, errors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Logarithms of P(stuck) and P(free) at errors of the inputs (k,), (n,) each."""
        scores = self.scored(errors)
        free = log_ndtr(-scores).cumsum(axis=1)
        # The first shape that holds a beam: no difference of nearly equal numbers.
        before = np.column_stack([np.zeros(len(scores)), free[:, :-1]])
        return logsumexp(log_ndtr(scores) + before, axis=1), free[:, -1]

    def share(self, errors: np.ndarray) -> np.ndarray:
        """P(stuck) at errors of the inputs (k,), (n,) [-]."""
        return np.exp(self.logarithms(errors)[0])

    def deviance(self, errors: np.ndarray) -> float:
        """Twice the logarithm by which shares equal to those that were counted are more probable [-]."""
        stuck, free = self.logarithms(errors)
        others = self.beams - self.stuck
        best = xlogy(self.stuck, self.stuck / self.beams) + xlogy(others, others / self.beams)
        return float(2 * np.sum(best - self.stuck * stuck - others * free))


def lognormal(centre: float, scatter: float) -> PPoly:
    """Normal score over ln l of lognormal lengths with a median [m] and a standard deviation of ln l."""
    return PchipInterpolator(np.log(centre) + scatter * np.array([-1, 1]), [-1, 1])


def score(lengths: np.ndarray) -> PPoly:
    """Normal score over ln l of any lengths (m,) [m]: between quantiles, and at their short end on the fitted line.

    ASSUME: the long end goes on as straight as the last two quantiles.
    """
    tail, inner = fit_tail(lengths), np.log(np.quantile(lengths, ndtr(_QUANTILES)))
    ends = [np.log(tail.length(ndtr(z))) for z in _SHORT], [inner[-1] + (_FAR - _QUANTILES[-1]) * _last_slope(inner)]
    return PchipInterpolator(np.concatenate([ends[0], inner, ends[1]]), [*_SHORT, *_QUANTILES, _FAR])


def _last_slope(inner):
    """Of ln l over the score."""
    return (inner[-1] - inner[-2]) / (_QUANTILES[-1] - _QUANTILES[-2])


# Discrepancy of the model


@dataclass(frozen=True)
class Discrepancy:
    """Standard deviations of the discrepancy of the model in ln l, before test beams are measured."""

    factor: float  #: of α [-]
    slope: float  #: of β [-]
    rest: float  #: of ε [-]


def rest(condition: Hashable) -> str:
    """Name of the rest of the model under a condition among the inputs."""
    return f"rest of the model, {condition}"


def with_discrepancy(
    prior: Knowledge,
    responses: np.ndarray,
    reduced: np.ndarray,
    conditions: Sequence[Hashable | None],
    stated: Discrepancy,
) -> tuple[Knowledge, np.ndarray]:
    """Prior of the inputs and of the discrepancy, and the responses of all results to both.

    Parameters
    ----------
    prior : Knowledge
        Of k inputs.
    responses : (n, k) array
        d ln l / dx of all results, of test beams and of devices.
    reduced : (n,) array
        u less its mean over the test beams [-].
    conditions : sequence of n
        Results under equal conditions have the same rest; those under none have no discrepancy at all.
    stated : Discrepancy

    Returns
    -------
    Knowledge
        Of k + 2 + m inputs for m different conditions.
    (n, k + 2 + m) array
    """
    rests = [one for one in dict.fromkeys(conditions) if one is not None]
    has_rest = np.array([[one == other for other in rests] for one in conditions], float).reshape(-1, len(rests))
    errs = np.array([one is not None for one in conditions], float)
    variances = np.array([stated.factor, stated.slope, *[stated.rest] * len(rests)]) ** 2
    mean = np.concatenate([prior.mean, np.zeros(len(variances))])
    names = (*prior.names, FACTOR, SLOPE, *map(rest, rests))
    widened = Knowledge(names, mean, block_diag(prior.covariance, np.diag(variances)))
    return widened, np.column_stack([responses, errs, errs * reduced, has_rest])


# Update


def given_lengths(prior: Knowledge, data: Lengths) -> Knowledge:
    """Knowledge after mean crack lengths were measured."""
    shared = prior.covariance @ data.responses.T
    gain = np.linalg.solve(_spread(prior, data), shared.T).T
    mean = prior.mean + gain @ (data.differences - data.responses @ prior.mean)
    covariance = prior.covariance - gain @ shared.T
    return Knowledge(prior.names, mean, (covariance + covariance.T) / 2)


def _spread(prior, data):
    """Covariance of the differences before they are measured, S (n, n)."""
    return data.responses @ prior.covariance @ data.responses.T + np.diag(data.errors**2)


def given(prior: Knowledge, lengths: Lengths, counts: Counts | None = None) -> Knowledge:
    """Knowledge after crack lengths were measured and stuck beams counted.

    With counts, it is the normal distribution around the most probable errors of the inputs that has their curvature
    (Laplace), but for the curvature of the probit of several shapes (Gauss and Newton). Steps are halved as long as
    that leads to more probable errors: where counts contradict the prior, whole steps may lead away from them.

    Raises
    ------
    NotConverged
        If the steps do not reach the most probable errors.
    """
    known = given_lengths(prior, lengths)
    if counts is None or not len(counts):
        return known
    mean, scale = known.mean, _scale(prior)
    for _ in range(_STEPS):
        known = given_lengths(prior, _joined(lengths, linearised(counts, mean)))
        step = known.mean - mean
        change = np.abs(step / scale).max()
        if change < _CLOSE:
            return known
        left = [_misfit(prior, lengths, counts, mean + share * step) for share in (1.0, 0.5)]
        while left[-1] < left[-2]:
            left.append(_misfit(prior, lengths, counts, mean + step / 2 ** len(left)))
        mean = mean + step / 2 ** (len(left) - 2)
    raise NotConverged("errors of the inputs, in standard deviations", change, _CLOSE, _STEPS)


def _scale(prior):
    """Standard deviations of the inputs, 1 for those that are known."""
    return np.where(prior.deviations > 0, prior.deviations, 1)


def _misfit(prior, lengths, counts, errors):
    """Sum of the squares of all pulls, on the data and on the inputs, at errors of the inputs; deviance of counts."""
    pulls, scale = (lengths.differences - lengths.responses @ errors) / lengths.errors, _scale(prior)
    moved = (errors - prior.mean) / scale
    inverse = np.linalg.pinv(prior.covariance / np.outer(scale, scale), rcond=_ROUNDING, hermitian=True)
    return pulls @ pulls + moved @ inverse @ moved + counts.deviance(errors)


def linearised(counts: Counts, errors: np.ndarray) -> Lengths:
    """Lengths whose normal likelihood has slope and curvature of that of the counts, at errors of the inputs (k,).

    The slope is that of the probit of P(stuck), which is z for one shape.
    """
    stuck, free = counts.logarithms(errors)
    scores, slopes = counts.scored(errors), counts.scored(errors, 1)
    probit = np.where(stuck < free, ndtri_exp(np.minimum(stuck, free)), -ndtri_exp(np.minimum(stuck, free)))
    # dΦ(-probit) = Σ_i Φ(-z_1) … φ(z_i) … Φ(-z_s) dz_i
    weights = np.exp(_log_density(scores) - log_ndtr(-scores) + (free - _log_density(probit))[:, None])
    responses = np.einsum("ns,nsk->nk", weights * slopes, counts.responses)
    above, below = np.exp(_log_density(probit) - stuck), np.exp(_log_density(probit) - free)
    others = counts.beams - counts.stuck
    slope = counts.stuck * above - others * below
    curvature = counts.stuck * above * (above + probit) + others * below * (below - probit)
    curvature = np.maximum(curvature, _NOTHING)  # beams of which it was certain that all, or none, would stick
    return Lengths(responses, responses @ errors - slope / curvature, 1 / np.sqrt(curvature))


def _log_density(score):
    """Logarithm of φ."""
    return -(score**2 + np.log(2 * np.pi)) / 2


def _joined(one, other):
    """Both sets of lengths."""
    fields = ("responses", "differences", "errors")
    return Lengths(*(np.concatenate([getattr(one, name), getattr(other, name)]) for name in fields))


# What the data say


def p_value(prior: Knowledge, lengths: Lengths, counts: Counts | None = None) -> float:
    r"""Probability of differences at least as large as the measured ones, before these are used [-].

    :math:`d^T S^{-1} d` has a chi-squared distribution if inputs and discrepancy err as stated. It also is the least
    sum of the squares of all pulls, on the data and on the inputs: data that no input explains have a small p value.
    Of counts, their deviance takes the place of a pull.
    ASSUME: the prior predictive one; after an update, the data would be used twice, and hide what they contradict. The
    chi-squared distribution of deviances is that of many beams; that of few, all or none of them stuck, is narrower.
    """
    if counts is None or not len(counts):
        away = lengths.differences - lengths.responses @ prior.mean
        return float(chdtrc(len(away), away @ np.linalg.solve(_spread(prior, lengths), away)))
    total = _misfit(prior, lengths, counts, given(prior, lengths, counts).mean)
    return float(chdtrc(len(lengths.differences) + len(counts), total))


@dataclass(frozen=True)
class Combination:
    """Combination of the errors of inputs, independent of all others before and after the measurement."""

    correlations: np.ndarray  #: of every input with the combination before the measurement (k,) [-]
    remaining: float  #: its standard deviation after the measurement, that before being 1 [-]


def combinations(prior: Knowledge, posterior: Knowledge) -> list[Combination]:
    """Independent combinations of the errors of all inputs, that which the data determine best first.

    Data determine as many of them as there are independent data. Inputs that are correlated with the same combination
    are not told apart.
    """
    scale = _scale(prior)
    variances, axes = np.linalg.eigh(prior.covariance / np.outer(scale, scale))
    uncertain = variances > _ROUNDING
    root = axes[:, uncertain] * np.sqrt(variances[uncertain])
    inverse = root / variances[uncertain]
    left, directions = np.linalg.eigh(inverse.T @ (posterior.covariance / np.outer(scale, scale)) @ inverse)
    deviations = np.sqrt(np.maximum(left, 0.0))
    return [Combination(_signed(axis), float(at)) for axis, at in zip((root @ directions).T, deviations, strict=True)]


def _signed(values):
    """Values with the sign with which the largest one is positive."""
    return values * np.sign(values[np.argmax(np.abs(values))])


def expected_share(margins: np.ndarray, weights: np.ndarray, shift: float, deviation: float) -> float:
    """P(stuck) of devices if ln of the lengths that stick has a shift that is normal, with a standard deviation [-].

    The margins are ln(length of the devices / length that sticks), as computed, and the weights the shares of the
    devices with each of these (n,) [-]; the others never stick.
    """
    return float(weights @ ndtr((margins - shift) / max(deviation, np.finfo(float).tiny)))


def further_beams(knowledge: Knowledge, target: np.ndarray, response: np.ndarray, error: float) -> float:
    """Standard deviation of a result after the mean length of further test beams is measured [-].

    The responses of the result, ``target``, and of the further test beams are (k,); the error is that of their ln l
    [-].
    """
    data = Lengths(response[None], np.zeros(1), np.array([error]))
    return float(given_lengths(knowledge, data).of(target)[1])

"""Answer of a probe without a spring: the pull-off forces of places, and whether a measured one fits them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from stiction.answer.data import Answer, AnswerInAir, Cause, Probability, PullOff, Step, band
from stiction.answer.sought import PULL_OFF
from stiction.answer.unknowns import Draws, Unknowns, normal
from stiction.devices import probes
from stiction.devices.risk import CONFIDENCE

#: Fractions of the places at whose forces the distribution is told.
SHARES = (0.05, 0.5, 0.95)
#: Points of the curve of places that hold more, its reach beyond all forces in ln force, and draws at each of them.
_POINTS, _BEYOND, _FEWER = 41, 0.25, 400
#: Normal scores of the ends of a two-sided band.
_ENDS = ndtri([(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])


@dataclass(frozen=True)
class Places:
    """Pull-off forces of sampled places in an air."""

    forces: np.ndarray  #: (n,) [N]
    error: float = 0.0  #: common relative standard error of all forces by the simulation [-]


@dataclass(frozen=True)
class ProbeQuestion:
    """Question about a probe."""

    device: str
    kind: str
    shape: str  #: end state
    source: str  #: dataset of the forces
    measured: float = np.nan  #: force, NaN without one [N]
    error: float = np.nan  #: its standard error [N]
    left_out: tuple[str, ...] = ()  #: inputs that are stated but not inside
    forbidden: tuple[str, ...] = ()  #: kinds of the limits that forbid a number


def answer(question: ProbeQuestion, places: Mapping[float, Places], unknowns: Unknowns, draws: Draws) -> Answer:
    """Answer from places by humidity. The air of its steps is the one that holds most."""
    sizes = _sizes(question, places)
    distributions = [
        (pull_off(question, *air, unknowns, draws), _curve(question, *air, unknowns, draws, sizes))
        for air in places.items()
    ]
    airs = tuple(
        AnswerInAir(
            distribution.humidity,
            np.nan,
            np.nan,
            distribution.more,
            curve,
            float(places[distribution.humidity].forces.max()),
        )
        for distribution, curve in distributions
    )
    most = max(range(len(airs)), key=lambda k: distributions[k][0].quantiles[1, 0])
    causes = [Cause.ESTIMATE, Cause.SIMULATION, *([Cause.INPUTS] if unknowns.groups else [])]
    return Answer(
        question.device,
        question.kind,
        np.nan,
        PULL_OFF.unit,
        build=np.nan,
        exact=np.nan,
        steps=tuple(Step(cause, np.nan, 1.0, airs[most].humidity, question.shape, question.source) for cause in causes),
        airs=airs,
        size=question.measured,
        stuck=airs[most].stuck,
        left_out=question.left_out,
        forbidden=question.forbidden,
        measure=_to_measure(question, airs[most].humidity, unknowns, draws),
        sizes=sizes,
        curve=airs[most].curve,
        pull_offs=tuple(distribution for distribution, _ in distributions),
    )


def _shifts(question, humidity, places, unknowns, draws):
    """Errors of ln force by the inputs and by the simulation of all forces, with the opposite sign (draws,)."""
    of_inputs = unknowns.shift((humidity, question.shape), draws, frozenset())
    return of_inputs + places.error * normal(draws, "surfaces")


def pull_off(question: ProbeQuestion, humidity: float, places: Places, unknowns: Unknowns, draws: Draws) -> PullOff:
    """Forces of the places in one air, and the measured one among them."""
    forces, shifts = places.forces, _shifts(question, humidity, places, unknowns, draws)
    rows = []
    for share in SHARES:
        value = float(np.quantile(forces, share))
        low, high = band(probes.quantile(forces, share, shifts, normal(draws, "counts")))
        rows.append([value, min(low, value), max(high, value)])
    if np.isnan(question.measured):
        return PullOff(humidity, np.array(rows))
    more = _more(forces, shifts, question.measured, question.error, draws)
    less = Probability(1 - more.value, 1 - more.high, 1 - more.low)
    return PullOff(humidity, np.array(rows), question.error, less, more, _two_sided(less.value, len(forces)))


def _more(forces, shifts, measured, error, draws):
    """Probability that a measurement gives more, with a band of all that is unknown."""
    below = probes.shares_below(forces, shifts, measured, error)
    value = float(1 - below.mean())
    low, high = band(1 - probes.counted(below, len(forces), normal(draws, "counts")))
    return Probability(value, min(low, value), max(high, value))


def _two_sided(less, number):
    """Two-sided probability, with the error of the number of sampled places."""
    ends = probes.counted(less, number, _ENDS)
    low, high = np.sort(probes.two_sided(ends))
    high = 1.0 if ends[0] <= 1 / 2 <= ends[1] else high
    return Probability(float(probes.two_sided(less)), float(low), float(high))


def _sizes(question, places):
    """Forces at which curves are known, decreasing from above all forces to below them (n,) [N]."""
    forces = np.concatenate([sample.forces for sample in places.values()])
    positive = np.append(forces, question.measured)
    positive = positive[positive > 0]
    if not len(positive):
        return np.empty(0)
    return np.exp(np.linspace(np.log(positive.max()) + _BEYOND, np.log(positive.min()) - _BEYOND, _POINTS))


def _curve(question, humidity, places, unknowns, draws, sizes):
    """Probability that a measurement gives more than some forces, and the ends of its band (3, n) [-]."""
    few = draws._replace(number=min(draws.number, _FEWER))
    shifts, error = _shifts(question, humidity, places, unknowns, few), np.nan_to_num(question.error)
    probabilities = [_more(places.forces, shifts, size, error, few) for size in sizes]
    return np.array([[p.value, p.low, p.high] for p in probabilities]).reshape(-1, 3).T


def _to_measure(question, humidity, unknowns, draws):
    """Group of inputs without whose error the forces are known best, empty without uncertain ones."""
    at = humidity, question.shape
    spreads = {group: float(np.std(unknowns.shift(at, draws, frozenset({group})))) for group in unknowns.groups}
    return min(spreads, key=spreads.get, default="")

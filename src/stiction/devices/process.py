r"""Risk over a process variable: settings that leave few enough devices stuck, the best one, and the next to measure.

The margin of a device to its requirement (`stiction.devices.roughness.margins`) is known on the law of the process at
some settings, with its slopes by the quantities of the surfaces. Off the law, it is linear in them. The margin of
several devices is their smallest one. Laws as likely as the law itself are drawn, and so are the errors of the
simulation and of the model, each common to all settings of a curve: every draw has its own margins and best setting.

These are the margins of the mean process. What is built is one run, the next one, which scatters about it: settings
suffice if the next run does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from stiction.analysis.process_law import Law
from stiction.devices.roughness import LARGEST, Crossing, crossings, sufficient

#: Number of drawn laws, and of settings at which their margins are compared.
DRAWS, SETTINGS = 1000, 301
#: Number of settings of each of two processes at which pairs are compared.
PAIRS = 61
#: Ends of the 95 % interval of the best setting, and confidence of the settings that suffice.
INTERVAL, CONFIDENCE = (0.025, 0.975), 0.95


@dataclass(frozen=True)
class Curve:
    """Margin of a device, at one humidity and against one end state, over settings on a law."""

    settings: np.ndarray  #: (p,) values of the variable, increasing
    margin: np.ndarray  #: (p,) [-]
    slopes: np.ndarray  #: (p, q) by the scaled quantities of all laws, one law after the other
    error: np.ndarray  #: (p,) standard error of the margin on the law: of the simulation and of the model
    second: float | None = None  #: setting of a second process, whose law is the second one

    def at(self, values: np.ndarray) -> "Curve":
        """Curve at other settings within its own."""
        margin = np.clip(Akima1DInterpolator(self.settings, self.margin)(values), -LARGEST, LARGEST)
        return Curve(
            values, margin, _between(self.settings, self.slopes, values), np.interp(values, self.settings, self.error)
        )

    def places(self, number: int) -> np.ndarray:
        """Settings of the process of a law, (p,)."""
        return np.full(len(self.settings), self.second) if number and self.second is not None else self.settings


@dataclass(frozen=True)
class Map:
    """Margins as of `Curve`, over the settings of two processes on their laws."""

    settings: np.ndarray  #: (p,) of the first process, increasing
    seconds: np.ndarray  #: (r,) of the second process, increasing
    margin: np.ndarray  #: (r, p) [-]
    slopes: np.ndarray  #: (r, p, q)
    error: np.ndarray  #: (r, p)

    def at(self, values: np.ndarray, seconds: np.ndarray) -> list[Curve]:
        """Curves along the first process at settings of the second one."""
        margin = Akima1DInterpolator(self.seconds, self.margin)(seconds)
        slopes, error = (_between(self.seconds, one, seconds) for one in (self.slopes, self.error))
        rows = zip(margin, slopes, error, seconds, strict=True)
        return [replace(Curve(self.settings, *row).at(values), second=float(second)) for *row, second in rows]


@dataclass(frozen=True)
class Recommendation:
    """Settings for some devices together."""

    settings: np.ndarray  #: (n,) values of the variable
    margin: np.ndarray  #: (n,) smallest margin of all devices [-]
    band: np.ndarray  #: (2, n) ends of the 95 % band of the mean process
    safe: np.ndarray  #: (n,) margin of the next run with 95 % confidence
    safe_mean: np.ndarray  #: (n,) margin of the mean process with 95 % confidence
    sufficient: list[tuple[float, float]]  #: ranges of settings with a safe margin above zero
    sufficient_mean: list[tuple[float, float]]  #: ranges with a safe margin of the mean process above zero
    crossings: list[Crossing]  #: settings with a margin of zero
    best: float  #: setting of the largest margin
    error: float  #: standard error of the best setting
    interval: tuple[float, float]  #: its 95 % interval
    next: float  #: setting whose measurement shrinks an error most, NaN if none does
    again: bool  #: whether all surfaces are measured there already
    subject: str  #: what errs less then: the ``best`` setting, or else the length of the ``range`` that suffices
    before: float  #: standard error of the subject
    after: float  #: expected standard error after that measurement


def recommended(
    curves: Sequence[Curve], laws: Sequence[Law], errors: Sequence[np.ndarray], rng: np.random.Generator
) -> Recommendation:
    """Settings that suffice for all devices, the best one, and the next to measure.

    Parameters
    ----------
    curves : sequence of Curve
        Of all devices, humidities and end states.
    laws : sequence of Law
        Of all surfaces of the process.
    errors : sequence of (q, q) array
        Covariance of the errors of one setting, of each law.
    rng : numpy.random.Generator
    """
    low, high = max(curve.settings[0] for curve in curves), min(curve.settings[-1] for curve in curves)
    values = np.linspace(low, high, SETTINGS)
    parts, runs = _drawn(laws, rng)
    drawn, here = np.concatenate(parts, axis=1), [curve.at(values) for curve in curves]
    margin = np.min([curve.margin for curve in here], axis=0)
    of_mean = [_drawn_margins(curve, laws, drawn, rng.standard_normal((DRAWS, 1))) for curve in here]
    of_run = [one + runs @ curve.slopes.T for one, curve in zip(of_mean, here, strict=True)]
    margins = np.min(of_mean, axis=0)
    best = np.array([_best(values, one) for one in margins])
    safe, safe_mean = (np.quantile(np.min(each, axis=0), 1 - CONFIDENCE, axis=0) for each in (of_run, of_mean))
    subject = "best" if best.std() else "range"
    wanted = best if best.std() else (margins >= 0).mean(axis=1) * (high - low)
    following, after = _next(laws, errors, drawn, wanted)
    return Recommendation(
        settings=values,
        margin=margin,
        band=np.quantile(margins, INTERVAL, axis=0),
        safe=safe,
        safe_mean=safe_mean,
        sufficient=sufficient(values, safe),
        sufficient_mean=sufficient(values, safe_mean),
        crossings=crossings(values, margin, margins.std(axis=0)),
        best=_best(values, margin),
        error=float(best.std()),
        interval=tuple(map(float, np.quantile(best, INTERVAL))),
        next=following,
        again=all(following in law.settings for law in laws),
        subject=subject,
        before=float(wanted.std()),
        after=after,
    )


@dataclass(frozen=True)
class Pairs:
    """Pairs of settings of two processes for one device."""

    settings: np.ndarray  #: (n,) of the first process
    seconds: np.ndarray  #: (m,) of the second process
    margin: np.ndarray  #: (m, n) smallest margin at all humidities and against all end states [-]
    safe: np.ndarray  #: (m, n) margin of the next runs with 95 % confidence
    safe_mean: np.ndarray  #: (m, n) margin of the mean processes with 95 % confidence
    best: np.ndarray  #: (2,) pair of the largest margin
    error: np.ndarray  #: (2,) its standard errors
    interval: np.ndarray  #: (2, 2) ends of the 95 % interval of each of its settings
    next: np.ndarray  #: (2,) setting of each process whose measurement shrinks its error most, NaN if none does
    again: np.ndarray  #: (2,) whether its surface is measured there already
    after: np.ndarray  #: (2,) expected standard error after that measurement


def recommended_pairs(
    maps: Sequence[Map], laws: Sequence[Law], errors: Sequence[np.ndarray], rng: np.random.Generator
) -> Pairs:
    """Pairs of settings that suffice for a device, the best one, and the settings to measure next.

    Parameters
    ----------
    maps : sequence of Map
        At all humidities and against all end states.
    laws : sequence of Law
        Of both processes.
    errors : sequence of (q, q) array
        Covariance of the errors of one setting, of each law.
    rng : numpy.random.Generator
    """
    values, steps = (np.linspace(*law.ends, PAIRS) for law in laws)
    seconds = np.union1d(steps, laws[1].settings)
    parts, runs = _drawn(laws, rng)
    drawn, margin, margins, of_run = np.concatenate(parts, axis=1), np.inf, np.inf, np.inf
    for one in maps:
        rows, common = one.at(values, seconds), rng.standard_normal((DRAWS, 1))
        margin = np.minimum(margin, [row.margin for row in rows])
        of_mean = np.stack([_drawn_margins(row, laws, drawn, common) for row in rows], axis=1)
        margins = np.minimum(margins, of_mean)
        of_run = np.minimum(of_run, of_mean + np.stack([runs @ row.slopes.T for row in rows], axis=1))
    best = np.array([_best_pair(values, seconds, one) for one in margins])
    of_each = zip(laws, errors, parts, best.T, strict=True)
    following, after = np.transpose([_next([law], [error], part, wanted) for law, error, part, wanted in of_each])
    return Pairs(
        settings=values,
        seconds=seconds,
        margin=margin,
        safe=np.quantile(of_run, 1 - CONFIDENCE, axis=0),
        safe_mean=np.quantile(margins, 1 - CONFIDENCE, axis=0),
        best=_best_pair(values, seconds, margin),
        error=best.std(axis=0),
        interval=np.quantile(best, INTERVAL, axis=0).T,
        next=following,
        again=np.array([value in law.settings for value, law in zip(following, laws, strict=True)]),
        after=after,
    )


def _best_pair(values, seconds, margin):
    """Pair of settings of the largest margin, the middle of several."""
    rows, columns = np.nonzero(margin >= margin.max() - 1e-12)
    return np.array([values[columns].mean(), seconds[rows].mean()])


def unknown(settings: np.ndarray, seconds: np.ndarray | None = None) -> Recommendation | Pairs:
    """Recommendation for devices of which too little is known, at settings (n,) of one process.

    Over two processes, it is that of the pairs with the settings (m,) of the second one.
    """
    none = float("nan")
    if seconds is not None:
        nothing = np.full((len(seconds), len(settings)), none)
        best, error, interval, following, after = (np.full(shape, none) for shape in (2, 2, (2, 2), 2, 2))
        again = np.zeros(2, bool)
        return Pairs(settings, seconds, nothing, nothing, nothing, best, error, interval, following, again, after)
    nothing = np.full(len(settings), none)
    arrays = {"settings": settings, "band": np.array([nothing, nothing])}
    arrays |= dict.fromkeys(("margin", "safe", "safe_mean"), nothing) | {"sufficient": [], "sufficient_mean": []}
    numbers = dict.fromkeys(("best", "error", "next", "before", "after"), none)
    return Recommendation(**arrays, **numbers, interval=(none, none), crossings=[], again=False, subject="best")


def law_error(curve: Curve, laws: Sequence[Law]) -> np.ndarray:
    """Standard error of the margins of a curve due to the laws, (p,) [-]."""
    variance, first = np.zeros(len(curve.settings)), 0
    for number, law in enumerate(laws):
        slopes = curve.slopes[:, first : first + len(law.coefficients)]
        variance += np.einsum("pq,pqr,pr->p", slopes, law.covariance_at(curve.places(number)), slopes)
        first += len(law.coefficients)
    return np.sqrt(variance)


def run_error(curve: Curve, laws: Sequence[Law]) -> np.ndarray:
    """Standard deviation of the margins of one run about those of the mean process, (p,) [-]."""
    return np.sqrt(curve.slopes**2 @ np.concatenate([law.scatter for law in laws]) ** 2)


def _drawn(laws, rng):
    """Errors of the coefficients of drawn laws (draws, all) of each law, and deviations of the next runs (draws, q)."""
    drawn = [law.drawn(DRAWS, rng) for law in laws]
    return [errors.reshape(DRAWS, -1) for errors, _ in drawn], np.concatenate([runs for _, runs in drawn], axis=1)


def _between(places, values, others):
    """Values (p, ...) at places (p,), linearly between them at others (n,), (n, ...)."""
    flat = np.reshape(values, (len(places), -1))
    return np.transpose([np.interp(others, places, column) for column in flat.T]).reshape(-1, *values.shape[1:])


def _drawn_margins(curve, laws, drawn, common):
    """Margins of a curve on drawn laws, whose coefficients differ by ``drawn`` (draws, all), (draws, n).

    Errors ``common`` (draws, 1) are those of simulation and model [standard errors].
    """
    sizes = np.cumsum([len(law.coefficients) for law in laws])[:-1]
    slopes = enumerate(zip(laws, np.split(curve.slopes, sizes, axis=1), strict=True))
    parts = [(of[:, :, None] * law.basis(curve.places(k))[:, None]).reshape(len(of), -1) for k, (law, of) in slopes]
    return curve.margin + drawn @ np.concatenate(parts, axis=1).T + common * curve.error


def _best(values, margin):
    """Setting of the largest margin, the middle of several."""
    return float(values[margin >= margin.max() - 1e-12].mean())


def _next(laws, errors, drawn, wanted):
    """Setting whose measurement shrinks the error of a wanted number most, and the error then.

    The number, one of each draw, is taken as linear in the coefficients of the laws, as far as the draws show.
    """
    before, ends = float(wanted.std()), [law.ends for law in laws]
    slopes, *_ = np.linalg.lstsq(drawn, wanted - wanted.mean(), rcond=1e-9)
    parts = np.split(slopes, np.cumsum([law.coefficients.size for law in laws])[:-1])
    settings = np.unique(np.concatenate([law.settings for law in laws]))
    candidates = np.sort([*settings, *(settings[1:] + settings[:-1]) / 2])
    low, high = max(end[0] for end in ends), min(end[1] for end in ends)
    candidates = candidates[(candidates >= low) & (candidates <= high)]
    gained = [
        sum(
            _gain(law, part.reshape(law.coefficients.shape), value, error)
            for law, part, error in zip(laws, parts, errors, strict=True)
        )
        for value in candidates
    ]
    most = int(np.argmax(gained))
    if not before or gained[most] <= 0:
        return float("nan"), before
    return float(candidates[most]), float(np.sqrt(max(before**2 - gained[most], 0.0)))


def _gain(law, slopes, value, error):
    """Variance of a number, linear in the coefficients of a law, that one more setting takes away."""
    return float(np.einsum("qc,qcrd,rd", slopes, law.covariance - law.with_setting(value, error), slopes))

r"""Risk over a process variable: settings that leave few enough devices stuck, the best one, and the next to measure.

The margin of a device to its requirement (`stiction.devices.roughness.margins`) is known on the law of the process at
some settings, with its slopes by the quantities of the surfaces. Off the law, it is linear in them. The margin of
several devices is their smallest one. Laws as likely as the law itself are drawn, and so are the errors of the
simulation and of the model, each common to all settings of a curve: every draw has its own margins and best setting.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from stiction.analysis.process_law import Law
from stiction.devices.roughness import LARGEST, Crossing, crossings, sufficient

#: Number of drawn laws, and of settings at which their margins are compared.
DRAWS, SETTINGS = 1000, 301
#: Ends of the 95 % interval of the best setting, and confidence of the settings that suffice.
INTERVAL, CONFIDENCE = (0.025, 0.975), 0.95


@dataclass(frozen=True)
class Curve:
    """Margin of a device, at one humidity and against one end state, over settings on a law."""

    settings: np.ndarray  #: (p,) values of the variable, increasing
    margin: np.ndarray  #: (p,) [-]
    slopes: np.ndarray  #: (p, q) by the scaled quantities of all laws, one law after the other
    error: np.ndarray  #: (p,) standard error of the margin on the law: of the simulation and of the model

    def at(self, values: np.ndarray) -> "Curve":
        """Curve at other settings within its own."""
        margin = np.clip(Akima1DInterpolator(self.settings, self.margin)(values), -LARGEST, LARGEST)
        slopes = np.transpose([np.interp(values, self.settings, column) for column in self.slopes.T])
        return Curve(values, margin, slopes, np.interp(values, self.settings, self.error))


@dataclass(frozen=True)
class Recommendation:
    """Settings for some devices together."""

    settings: np.ndarray  #: (n,) values of the variable
    margin: np.ndarray  #: (n,) smallest margin of all devices [-]
    band: np.ndarray  #: (2, n) ends of its 95 % band
    safe: np.ndarray  #: (n,) margin with 95 % confidence
    sufficient: list[tuple[float, float]]  #: ranges of settings with a safe margin above zero
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
    drawn = np.concatenate([law.drawn(DRAWS, rng).reshape(DRAWS, -1) for law in laws], axis=1)
    here = [curve.at(values) for curve in curves]
    margin = np.min([curve.margin for curve in here], axis=0)
    margins = np.min([_drawn(curve, laws, drawn, rng) for curve in here], axis=0)
    best = np.array([_best(values, one) for one in margins])
    safe = np.quantile(margins, 1 - CONFIDENCE, axis=0)
    subject = "best" if best.std() else "range"
    wanted = best if best.std() else (margins >= 0).mean(axis=1) * (high - low)
    following, after = _next(laws, errors, drawn, wanted)
    return Recommendation(
        settings=values,
        margin=margin,
        band=np.quantile(margins, INTERVAL, axis=0),
        safe=safe,
        sufficient=sufficient(values, safe),
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


def unknown(values: np.ndarray) -> Recommendation:
    """Recommendation for devices of which too little is known, at settings (n,)."""
    nothing, none = np.full(len(values), np.nan), float("nan")
    numbers = {"best": none, "error": none, "interval": (none, none), "next": none, "before": none, "after": none}
    arrays = {"settings": values, "margin": nothing, "band": np.array([nothing, nothing]), "safe": nothing}
    return Recommendation(**arrays, **numbers, sufficient=[], crossings=[], again=False, subject="best")


def law_error(curve: Curve, laws: Sequence[Law]) -> np.ndarray:
    """Standard error of the margins of a curve due to the laws, (p,) [-]."""
    variance, first = np.zeros(len(curve.settings)), 0
    for law in laws:
        slopes = curve.slopes[:, first : first + len(law.coefficients)]
        variance += np.einsum("pq,pqr,pr->p", slopes, law.covariance_at(curve.settings), slopes)
        first += len(law.coefficients)
    return np.sqrt(variance)


def _drawn(curve, laws, drawn, rng):
    """Margins of a curve on drawn laws, whose coefficients differ by ``drawn`` (draws, all), (draws, n)."""
    sizes = np.cumsum([len(law.coefficients) for law in laws])[:-1]
    slopes = zip(laws, np.split(curve.slopes, sizes, axis=1), strict=True)
    parts = [(of[:, :, None] * law.basis(curve.settings)[:, None]).reshape(len(of), -1) for law, of in slopes]
    common = rng.standard_normal((len(drawn), 1))
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

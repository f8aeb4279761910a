r"""Risk over a process variable: settings that leave few enough devices stuck, the best one, and the next to measure.

The margin of a device to its requirement (`stiction.devices.roughness.margins`) is known on the law of the process at
some settings, or on the laws of two processes at pairs of settings, with its slopes by the quantities of the surfaces.
Off the law, it is linear in them. The margin of several devices is their smallest one. Laws as likely as the law itself
are drawn, and so are the errors of the simulation and of the model, each common to all settings of a device: every draw
has its own margins and best setting.

These are the margins of the mean process. What is built is one run, the next one, which scatters about it: settings
suffice if the next run does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

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
class Margins:
    """Margin of a device, at one humidity and against one end state, over settings on laws.

    The last axis has the settings of the first process. A second process has the axis before it; without one, further
    laws are those of other surfaces at the same settings.
    """

    axes: tuple[np.ndarray, ...]  #: values of the variables, increasing
    margin: np.ndarray  #: (axes...) [-]
    slopes: np.ndarray  #: (axes..., q) by the scaled quantities of all laws, one law after the other
    error: np.ndarray  #: (axes...) standard error of the margin on the laws: of the simulation and of the model

    def at(self, axes: Sequence[np.ndarray]) -> "Margins":
        """Margins at other settings within their own."""
        margin, slopes, error = self.margin, self.slopes, self.error
        for axis, points in enumerate(zip(self.axes, axes, strict=True)):
            margin = np.apply_along_axis(_smooth, axis, margin, *points)
            slopes, error = (np.apply_along_axis(_linear, axis, values, *points) for values in (slopes, error))
        return Margins(tuple(axes), np.clip(margin, -LARGEST, LARGEST), slopes, error)

    def settings(self, number: int) -> np.ndarray:
        """Settings of the process of a law, (axes...)."""
        return np.meshgrid(*self.axes, indexing="ij")[max(-1 - number, -len(self.axes))]


def _smooth(values, points, targets):
    """Values (n,) at places (n,), smoothly between them at others (m,)."""
    return Akima1DInterpolator(points, values)(targets)


def _linear(values, points, targets):
    """Values (n,) at places (n,), linearly between them at others (m,)."""
    return np.interp(targets, points, values)


@dataclass(frozen=True)
class Recommendation:
    """Settings of one process for some devices together, or of two processes for one."""

    axes: tuple[np.ndarray, ...]  #: values of the variables, in the order of `Margins`
    margin: np.ndarray  #: (axes...) smallest margin of all devices [-]
    spread: np.ndarray  #: (axes...) standard error of the margin of the mean process
    band: np.ndarray  #: (2, axes...) ends of its 95 % band
    safe: np.ndarray  #: (axes...) margin of the next run with 95 % confidence
    safe_mean: np.ndarray  #: (axes...) margin of the mean process with 95 % confidence
    best: np.ndarray  #: (processes,) setting of each process with the largest margin
    error: np.ndarray  #: (processes,) standard error of the best setting
    interval: np.ndarray  #: (processes, 2) its 95 % interval
    next: np.ndarray  #: (processes,) setting whose measurement shrinks an error most, NaN if none does
    again: np.ndarray  #: (processes,) whether all surfaces are measured there already
    subject: str  #: what errs less then: the ``best`` setting, or else the length of the ``range`` that suffices
    before: np.ndarray  #: (processes,) standard error of the subject
    after: np.ndarray  #: (processes,) expected standard error after that measurement

    @property
    def sufficient(self) -> list[tuple[float, float]]:
        """Ranges of settings of one process with a safe margin above zero."""
        return sufficient(*self.axes, self.safe)

    @property
    def sufficient_mean(self) -> list[tuple[float, float]]:
        """Ranges with a safe margin of the mean process above zero."""
        return sufficient(*self.axes, self.safe_mean)

    @property
    def crossings(self) -> list[Crossing]:
        """Settings of one process with a margin of zero."""
        return crossings(*self.axes, self.margin, self.spread)


def recommended(
    devices: Sequence[Margins], laws: Sequence[Law], errors: Sequence[np.ndarray], rng: np.random.Generator
) -> Recommendation:
    """Settings that suffice for all devices, the best one, and the next to measure.

    Parameters
    ----------
    devices : sequence of Margins
        Of all devices, humidities and end states.
    laws : sequence of Law
        Of all surfaces of the process, or of both processes.
    errors : sequence of (q, q) array
        Covariance of the errors of one setting, of each law.
    rng : numpy.random.Generator
    """
    axes, (deviations, runs) = _compared(devices, laws), _drawn(laws, rng)
    together, margin, margins, of_run = np.concatenate(deviations, axis=1), np.inf, np.inf, np.inf
    for device in devices:
        on_grid = device.at(axes)
        of_mean, of_next = _drawn_margins(on_grid, laws, together, runs, rng.standard_normal((DRAWS, 1)))
        margin, margins = np.minimum(margin, on_grid.margin), np.minimum(margins, of_mean)
        of_run = np.minimum(of_run, of_next)
    best = np.array([_best(axes, values) for values in margins])
    subject, targets = _wanted(axes, margins, best)
    following, again, before, after = _advice(laws, errors, deviations, targets)
    return Recommendation(
        axes=axes,
        margin=margin,
        spread=margins.std(axis=0),
        band=np.quantile(margins, INTERVAL, axis=0),
        safe=np.quantile(of_run, 1 - CONFIDENCE, axis=0),
        safe_mean=np.quantile(margins, 1 - CONFIDENCE, axis=0),
        best=_best(axes, margin),
        error=best.std(axis=0),
        interval=np.quantile(best, INTERVAL, axis=0).T,
        next=following,
        again=again,
        subject=subject,
        before=before,
        after=after,
    )


def unknown(*axes: np.ndarray) -> Recommendation:
    """Recommendation for devices of which too little is known, at settings in the order of `Margins`."""
    grid, each = np.full(list(map(len, axes)), np.nan), np.full(len(axes), np.nan)
    numbers = dict.fromkeys(("margin", "spread", "safe", "safe_mean"), grid)
    numbers |= dict.fromkeys(("best", "error", "next", "before", "after"), each)
    ends = {"band": np.array([grid, grid]), "interval": np.stack([each, each], axis=-1)}
    return Recommendation(axes, **numbers, **ends, again=np.zeros(len(axes), bool), subject="best")


def law_error(margins: Margins, laws: Sequence[Law]) -> np.ndarray:
    """Standard error of margins due to the laws, (axes...) [-]."""
    variance, first = np.zeros(margins.margin.size), 0
    for number, law in enumerate(laws):
        slopes = margins.slopes[..., first : first + len(law.coefficients)].reshape(len(variance), -1)
        covariance = law.covariance_at(margins.settings(number).ravel())
        variance += np.einsum("pq,pqr,pr->p", slopes, covariance, slopes)
        first += len(law.coefficients)
    return np.sqrt(variance).reshape(margins.margin.shape)


def run_error(margins: Margins, laws: Sequence[Law]) -> np.ndarray:
    """Standard deviation of the margins of one run about those of the mean process, (axes...) [-]."""
    return np.sqrt(margins.slopes**2 @ np.concatenate([law.scatter for law in laws]) ** 2)


def _compared(devices, laws):
    """Settings at which margins are compared, in the order of `Margins`: of a second process also the measured ones."""
    of_axes = zip(*(device.axes for device in devices), strict=True)
    spans = [(max(values[0] for values in axis), min(values[-1] for values in axis)) for axis in of_axes]
    if len(spans) == 1:
        return (np.linspace(*spans[0], SETTINGS),)
    seconds, values = (np.linspace(*span, PAIRS) for span in spans)
    return np.union1d(seconds, laws[1].settings), values


def _drawn(laws, rng):
    """Errors of the coefficients of drawn laws (draws, all) of each law, and deviations of the next runs (draws, q)."""
    draws = [law.draw(DRAWS, rng) for law in laws]
    return [errors.reshape(DRAWS, -1) for errors, _ in draws], np.concatenate([runs for _, runs in draws], axis=1)


def _drawn_margins(margins, laws, deviations, runs, common):
    """Margins on laws whose coefficients differ by ``deviations`` (draws, all): of mean and run, (draws, axes...).

    A run differs by ``runs`` (draws, q). Errors ``common`` (draws, 1) are those of simulation and model [standard
    errors].
    """
    sizes, shape = np.cumsum([len(law.coefficients) for law in laws])[:-1], margins.margin.shape
    products = []
    for number, (law, slopes) in enumerate(zip(laws, np.split(margins.slopes, sizes, axis=-1), strict=True)):
        basis = law.basis(margins.settings(number).ravel()).reshape(*shape, -1)
        products.append((slopes[..., None] * basis[..., None, :]).reshape(*shape, -1))
    by_coefficients = np.concatenate(products, axis=-1)
    of_mean, of_run = np.empty((2, DRAWS, *shape))
    for row in np.ndindex(shape[:-1]):
        at = (slice(None), *row)
        of_mean[at] = margins.margin[row] + deviations @ by_coefficients[row].T + common * margins.error[row]
        of_run[at] = of_mean[at] + runs @ margins.slopes[row].T
    return of_mean, of_run


def _best(axes, margin):
    """Setting of each process with the largest margin, the middle of several, (processes,)."""
    positions = np.nonzero(margin >= margin.max() - 1e-12)
    return np.array([axis[at].mean() for axis, at in zip(axes, positions, strict=True)][::-1])


def _wanted(axes, margins, best):
    """Numbers that the next measurement improves (draws, processes): best settings, or the length of a range."""
    if len(axes) > 1 or best.std():
        return "best", best
    return "range", (margins >= 0).mean(axis=1)[:, None] * np.ptp(axes[0])


def _advice(laws, errors, deviations, targets):
    """Settings of each process to measure next, as by `_next`: of all surfaces of one process, or of one each."""
    groups = [slice(number, number + 1) for number in range(len(laws))] if targets.shape[1] > 1 else [slice(None)]
    advice = [
        _next(laws[group], errors[group], deviations[group], column)
        for group, column in zip(groups, targets.T, strict=True)
    ]
    return map(np.array, zip(*advice, strict=True))


def _next(laws, errors, deviations, target):
    """Setting whose measurement shrinks the error of a wanted number most.

    Returns the setting, whether it is measured already, and the errors before and after. The number, one of each draw,
    is taken as linear in the coefficients of the laws, as far as the draws show.
    """
    before, ends = float(target.std()), [law.ends for law in laws]
    slopes, *_ = np.linalg.lstsq(np.concatenate(deviations, axis=1), target - target.mean(), rcond=1e-9)
    of_laws = np.split(slopes, np.cumsum([law.coefficients.size for law in laws])[:-1])
    law_slopes = [of_law.reshape(law.coefficients.shape) for law, of_law in zip(laws, of_laws, strict=True)]
    settings = np.unique(np.concatenate([law.settings for law in laws]))
    candidates = np.sort([*settings, *(settings[1:] + settings[:-1]) / 2])
    low, high = max(end[0] for end in ends), min(end[1] for end in ends)
    candidates = candidates[(candidates >= low) & (candidates <= high)]
    gained = [  # variance that one more setting takes away
        sum(
            float(np.einsum("qc,qcrd,rd", slopes, law.covariance - law.with_setting(value, error), slopes))
            for law, slopes, error in zip(laws, law_slopes, errors, strict=True)
        )
        for value in candidates
    ]
    most = int(np.argmax(gained))
    if not before or gained[most] <= 0:
        return float("nan"), False, before, before
    following = float(candidates[most])
    again = all(following in law.settings for law in laws)
    return following, again, before, float(np.sqrt(max(before**2 - gained[most], 0.0)))

"""Answer about a device as data: the size to build, the steps that lead to it, and the probability at its own size.

Numbers, sides and causes are fields. Pages, tables and sentences are made from them (`stiction.report.answer`).
"""

from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from stiction.answer.sought import PULL_OFF, SOUGHT, Sought
from stiction.devices.probes import UNLIKELY
from stiction.devices.risk import CONFIDENCE

#: Kind of the limit that inputs are too uncertain. It leaves no size to build, but a device may stick for certain.
INPUTS = "inputs"


class Verdict(StrEnum):
    """Judgement of a stated size, or of none, or of a measured pull-off force."""

    BUILD = "build"  #: no size is stated: a size to build is known
    SAFE = "safe"  #: the stated size is within the size to build
    OPEN = "open"  #: neither shown to be safe nor to stick too often
    BAD = "bad"  #: even the lower end of the band sticks more often than allowed
    NONE = "none"  #: a limit forbids a number, or nothing bounds it
    FITS = "fits"  #: a measured force is not among the rare ones
    MISFIT = "misfit"  #: it is, also with the error of the simulation
    UNDECIDED = "undecided"  #: the error of the simulation, or that of the inputs, leaves it open
    PLACES = "places"  #: no force is measured: their distribution is known


class Cause(StrEnum):
    """Cause of a step from the estimate to the size to build, in the order of the steps."""

    ESTIMATE = "estimate"  #: sampled devices, in the worst stated air
    SIMULATION = "simulation"  #: finite numbers of devices and of sampled surfaces
    FAST = "fast"  #: separation that is faster than evaporation
    TOUCHDOWNS = "touchdowns"  #: all stated touchdowns, each on other summits
    TILT = "tilt"  #: worst of the stated tilts
    VOLTAGE = "voltage"  #: stated voltage while the device touches
    DRYING = "drying"  #: liquids that are stated
    INPUTS = "inputs"  #: stated and assumed inputs
    TEST_BEAMS = "test_beams"  #: inputs and model, as test beams leave them


@dataclass(frozen=True)
class Step:
    """Step from the estimate to the size to build."""

    cause: Cause
    size: float  #: after this step [m, N]
    factor: float  #: change of the size by this step [-]
    humidity: float  #: air that decides after this step [-]
    shape: str  #: end state that decides
    source: str  #: dataset that it comes from
    stated: bool = True  #: whether the user stated the cause; other steps stand beside and change nothing


@dataclass(frozen=True)
class Probability:
    """Expected fraction of stuck devices, and a band of the fraction that contains all that is unknown.

    Where no simulated device sticks, the upper end is a bound with 95 % confidence. It is the allowed fraction at the
    size to build, and a few draws of which many devices stick can raise the expected fraction above it.
    """

    value: float
    low: float
    high: float
    none_seen: bool = False  #: whether no simulated device sticks, so that the upper end alone is known


@dataclass(frozen=True)
class AnswerInAir:
    """Answer for one of the stated airs alone."""

    humidity: float  #: [-]
    build: float  #: [m, N]
    without_tip: float  #: length of a cantilever whose tip cannot touch, NaN for others [m]
    stuck: Probability | None  #: at the stated size
    #: Expected fraction stuck, and ends of its band, at `Answer.sizes` (3, n) [-].
    curve: np.ndarray = field(default_factory=lambda: np.empty((3, 0)), compare=False)
    first: float = field(default=np.nan, compare=False)  #: size from which a lower end is known [m, N]
    temperature: float = np.nan  #: of the water of a mission, NaN in dry air and without a mission [K]


@dataclass(frozen=True)
class PullOff:
    """Pull-off force of the places under a probe in one of the stated airs, and a measured one among them."""

    humidity: float  #: [-]
    #: Forces that 5, 50 and 95 % of the places hold at most, with the ends of their bands (3, 3) [N].
    quantiles: np.ndarray = field(compare=False)
    error: float = np.nan  #: standard error of the measured force, NaN without one [N]
    less: Probability | None = None  #: that a measurement gives the measured force or less, none without one
    more: Probability | None = None  #: that it gives this force or more
    two_sided: Probability | None = None  #: twice the smaller of both, with the error of the simulation alone

    @property
    def verdict(self) -> Verdict:
        """Judgement by the band of the two-sided probability."""
        if self.two_sided is None:
            return Verdict.PLACES
        if self.two_sided.low >= UNLIKELY:
            return Verdict.FITS
        return Verdict.MISFIT if self.two_sided.high < UNLIKELY else Verdict.UNDECIDED


@dataclass(frozen=True)
class Stay:
    """Part of a mission: touchdowns in the worst of some airs."""

    humidities: tuple[float, ...]  #: [-]
    touchdowns: float  #: at least one


@dataclass(frozen=True)
class Between:
    """Strictest size to build of the computed airs between the stated ones. It is interpolated."""

    humidity: float  #: [-]
    size: float  #: [m, N]
    safe: float  #: in all of these airs, if every cause counts as in the worse of the stated airs around [m, N]


@dataclass(frozen=True)
class Unasked:
    """Simulated limit that is stricter than the size to build, of what nothing that is stated asks for."""

    name: str  #: of its row in the life of the device
    what: str
    size: float  #: [m, N]


@dataclass(frozen=True)
class Answer:
    """Size to build of a device and what leads to it: the source of pages, tables and pictures."""

    device: str
    kind: str
    share: float  #: allowed fraction of stuck devices [-]
    unit: str  #: of sizes, m or N
    build: float  #: size to build, NaN if none is known
    exact: float  #: the same if all inputs were exact
    steps: tuple[Step, ...]
    airs: tuple[AnswerInAir, ...]
    size: float = np.nan  #: stated, NaN without one
    stuck: Probability | None = None  #: at the stated size, in the worst stated air
    touchdowns: int = 1
    stays: tuple[Stay, ...] = ()  #: airs of the touchdowns; without these, all count in the worst air
    extrapolated: bool = False  #: whether the size rests on a line beyond what was verified, on either side
    left_out: tuple[str, ...] = ()  #: conditions that are stated but not inside
    forbidden: tuple[str, ...] = ()  #: kinds of the limits that forbid a number
    measure: str = ""  #: group of inputs that costs most
    if_measured: float = np.nan  #: size to build if this group were exact
    spread_of_budget: float = 0.0  #: part of the size that the errors of the budget itself take [-]
    without_test_beams: float = np.nan  #: size to build without test beams, NaN if none say anything
    sizes: np.ndarray = field(default_factory=lambda: np.empty(0), compare=False)  #: of the curves (n,) [m, N]
    #: As those of airs, in the worst of them (3, n) [-].
    curve: np.ndarray = field(default_factory=lambda: np.empty((3, 0)), compare=False)
    #: Pull-off forces by air, of a device that is asked for them. Its size is the measured force, none is to build, and
    #: what sticks are places that hold more.
    pull_offs: tuple[PullOff, ...] = ()
    between: Between | None = None  #: if it is stricter than the size to build, which holds in the stated airs
    unasked: tuple[Unasked, ...] = ()

    @property
    def sought(self) -> Sought:
        """Number that sizes are of."""
        return PULL_OFF if self.pull_offs else SOUGHT[self.unit]

    def in_words(self, size: float) -> str:
        """Size with its unit."""
        return self.sought.in_words(size)

    @property
    def pull_off(self) -> PullOff:
        """Pull-off forces in the air where places hold most, of a device that is asked for them."""
        return next(force for force in self.pull_offs if force.humidity == self.stated_steps[-1].humidity)

    @property
    def is_enough(self) -> bool:
        """Whether the stated size is within the size to build."""
        return self.sought.sign * self.size <= self.sought.sign * self.build

    @property
    def is_enough_between(self) -> bool:
        """Whether the stated size is also on the safe side of all computed airs between the stated ones."""
        sign = self.sought.sign
        return self.is_enough and (self.between is None or sign * self.size <= sign * self.between.safe)

    @property
    def verdict(self) -> Verdict:
        """Judgement by fields alone."""
        if set(self.forbidden) - {INPUTS}:
            return Verdict.NONE
        if self.pull_offs:
            is_open = self.forbidden and self.pull_off.verdict is not Verdict.PLACES
            return Verdict.UNDECIDED if is_open else self.pull_off.verdict
        if self.stuck is not None and not self.is_enough and self.stuck.low > self.share:
            return Verdict.BAD
        if self.forbidden or not np.isfinite(self.build):
            return Verdict.NONE
        if self.stuck is None:
            return Verdict.BUILD
        return Verdict.SAFE if self.is_enough else Verdict.OPEN

    @property
    def known_steps(self) -> tuple[Step, ...]:
        """Steps of known sizes: first those inside, to the size to build, then that size with each further cause.

        ASSUME: a cause that is not stated changes the size to build as it changes the size before its step.
        """
        beside = (replace(step, size=self.build * step.factor) for step in self.steps if not step.stated)
        return tuple(step for step in (*self.stated_steps, *beside) if np.isfinite(step.size))

    @property
    def stated_steps(self) -> tuple[Step, ...]:
        """Steps inside the size to build."""
        return tuple(step for step in self.steps if step.stated)

    def touchdowns_in(self, humidity: float) -> float:
        """Touchdowns in an air or in one that bounds it with others."""
        return sum(stay.touchdowns for stay in self.stays if humidity in stay.humidities)

    @property
    def largest_step(self) -> Step:
        """Step inside the size to build that changes it most."""
        return max(self.stated_steps[1:], key=lambda step: abs(np.log(step.factor)))

    @property
    def together(self) -> AnswerInAir:
        """Answer for all stated airs, under the humidity of the one that decides."""
        first = min((air.first for air in self.airs), key=lambda size: self.sought.sign * size, default=np.nan)
        return AnswerInAir(self.stated_steps[-1].humidity, self.build, np.nan, self.stuck, self.curve, first)

    def at_most(self, air: AnswerInAir) -> tuple[np.ndarray, np.ndarray]:
        """Sizes, and fractions that bound P(stuck) in an air with 95 % confidence, also at the size to build.

        There the bound is the allowed fraction, and up to there no more: the size to build is a quantile of the draws,
        and P(stuck) increases beyond it in each of them. Beyond it, the upper end of the band is a bound as well.

        Returns
        -------
        sizes : array (n,) or (n + 1,)
            Those of the curves, and the size to build if there is one [m, N].
        fractions : array, the same shape
        """
        v, upper, build = self.sought.sign * np.log(self.sizes), air.curve[2], self.sought.sign * np.log(air.build)
        if not np.isfinite(build):
            return self.sizes, upper
        k = int(np.searchsorted(v, build))
        upper = np.where(v <= build, np.minimum(upper, self.share), upper)
        return np.insert(self.sizes, k, air.build), np.insert(upper, k, self.share)

    @property
    def is_by_tip(self) -> bool:
        """Whether the tip holds devices in the air that decides: without it, they may be longer by over 1 %."""
        decides = [air for air in self.airs if air.humidity == self.stated_steps[-1].humidity]
        return any(air.without_tip > 1.01 * air.build for air in decides)

    @property
    def included(self) -> tuple[Cause, ...]:
        """Causes inside the size to build."""
        return tuple(step.cause for step in self.stated_steps[1:])


def band(fractions: np.ndarray) -> tuple[float, float]:
    """Ends of the band of drawn fractions (draws,) [-]."""
    low, high = np.quantile(fractions, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)

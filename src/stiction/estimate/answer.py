r"""Answer to a question: lengths or forces for fractions of stuck devices, with intervals. Plain Python.

Of a stopper, the reciprocal of a force stands for a length.

The interval of a length has two parts. The estimate errs by a factor that is known from surfaces that were not learnt:
split conformal prediction of errors over their `difficulty`. Where a surface is partly assumed, the logarithm of the
length has on m typical surfaces the mean :math:`\bar v` and the scatter s, and on another one
:math:`\bar v + s \sqrt{1 + 1/m} \, t_{m-1}`, as in `stiction.answer.unknowns`.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from stiction.estimate.bridge import Bridge, Stretched
from stiction.estimate.closed.flats import FlatBound, worst
from stiction.estimate.closed.life import BeamLife, Dried, StopperLife, Touching
from stiction.estimate.force import ForceRow, Stopper
from stiction.estimate.length import Impossible, LengthRow, Lengths, NotLearnt, after, normal_score, score_at
from stiction.estimate.promise import promise
from stiction.estimate.question import Question
from stiction.estimate.state import THINNEST, film
from stiction.estimate.table import Surrogate
from stiction.estimate.voltage import Driven, Pulled

#: Fractions of stuck devices in the answer.
FRACTIONS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: Fraction for the length to build.
CHOSEN = FRACTIONS[2]
#: Key of the margins of other solids than polysilicon, beside those of polysilicon.
OF_OTHER_SOLIDS = "margins_of_other_solids"
#: Key of the margin towards the end to use, beside those by confidence.
TO_USE = "to_use"
#: Confidences of the intervals, and quantiles of Student's distribution with three degrees of freedom for them.
CONFIDENCES = ("90", "95")
_STUDENT = {"90": 2.353363, "95": 3.182446}
#: Keys of the margins on the unsafe side and on the other one, by confidence. The end of 90 % is that to use.
MARGINS = {"90": (TO_USE, "90"), "95": ("95", "95")}


@dataclass(frozen=True)
class Estimate:
    """Estimate of one device."""

    question: Question | Stopper | Bridge
    rows: tuple[LengthRow | ForceRow, ...]
    stuck: tuple[float, float, float] | None  #: fraction at the stated length or force, and its ends of 95 %
    humidity: float  #: air that decides
    life: BeamLife | StopperLife  #: closed forms beside what was learnt

    @property
    def chosen(self) -> LengthRow | ForceRow:
        """Row of the length or force to build."""
        return next(row for row in self.rows if row.fraction == CHOSEN)

    @cached_property
    def dried(self) -> dict[str, Dried]:
        """Lengths of beams that dry, by liquid."""
        return self.life.dried()

    @property
    def is_force(self) -> bool:
        """Whether its sizes are forces, of which more is safer."""
        return isinstance(self.question, Stopper)

    @property
    def _learnt(self):
        """End of its interval on the safe side [SI]."""
        least, most = self.chosen.intervals[CONFIDENCES[0]]
        return most if self.is_force else least

    @property
    def drying(self) -> str | None:
        """Liquid whose drying asks for a shorter beam than that end, none without one."""
        liquid = min(self.dried, key=lambda name: self.dried[name].stands, default=None)
        return liquid if liquid and self.dried[liquid].stands < self._learnt else None

    @property
    def use_if_slow(self) -> float:
        """Largest length or smallest force if it separates slowly [SI]. As in a run, no stated liquid collapses it."""
        return self.dried[self.drying].stands if self.drying else self._learnt

    @property
    def use(self) -> float:
        """Largest length or smallest force to use, NaN where a run alone knows it, see `is_fast` [SI]."""
        return math.nan if self.is_fast else self.use_if_slow

    @property
    def promise(self) -> str | None:
        """Sentence on what the size to use promises, none where a run alone knows this size."""
        return None if self.is_fast else promise(CONFIDENCES[0], self.is_force)

    @property
    def is_unsafe(self) -> bool:
        """Whether its stated size is beyond that to use even if it separates slowly."""
        size = self.question.size
        return size is not None and (size < self.use_if_slow if self.is_force else size > self.use_if_slow)

    @property
    def is_fast(self) -> bool:
        """Whether a shock can separate it faster than its water evaporates, which the estimate does not know."""
        return self.question.surroundings.shock > 0 and not all(map(self.question.is_dry, self.question.humidities))

    @cached_property
    def flat(self) -> FlatBound:
        """What flat surfaces in contact hold in the worst of its airs, without its voltage, as column *bound* of a run.

        No surface holds a shorter beam, or a larger force of a stopper. Its tip is another matter: see its field.
        """
        asked = self.question
        return worst([asked.on_flats(asked.attractions(air)) for air in asked.humidities], self.is_force)

    @cached_property
    def touching(self) -> Touching:
        """Causes of its contact, at its own size or that to use if it separates slowly."""
        return self.life.touching(self.question.size or self.use_if_slow)


def answer(
    question: Question | Stopper | Bridge | NotLearnt, table: Mapping[str, Any], tips: Surrogate, full: Surrogate | None
) -> Estimate:
    """Answer to a question.

    Raises
    ------
    NotLearnt
        If the estimate does not know it.
    """
    if isinstance(question, NotLearnt):
        raise question
    in_airs = {air: _in_air(question, air, table, tips, full) for air in question.humidities}
    of_once = {p: -math.expm1(math.log1p(-p) / question.touchdowns) for p in FRACTIONS}
    worst = (_worst([in_air.row(p, normal_score(of_once[p])) for in_air in in_airs.values()]) for p in FRACTIONS)
    rows = tuple(map(question.row, worst))
    decides = min(in_airs, key=lambda air: in_airs[air].length(normal_score(of_once[CHOSEN])))
    stuck = None if question.stated is None else _stuck(question, list(in_airs.values()))
    return Estimate(question, rows, stuck, decides, question.life)


def in_one_air(
    question: Question | Stopper | Bridge, air: float, fractions: Sequence[float], *learnt: Any
) -> list[LengthRow | ForceRow]:
    """Lengths or forces for some fractions, at one touchdown in one air. Learnt as of `answer`.

    Raises
    ------
    NotLearnt
        If the estimate does not know it.
    """
    in_air = _in_air(question, air, *learnt)
    return [question.row(in_air.row(p, normal_score(p))) for p in fractions]


@dataclass(frozen=True)
class LengthsInAir:
    """Lengths of a device in one air."""

    errors: Mapping[str, Any]  #: part of the table
    stated: Lengths
    members: tuple[Lengths, ...]  #: on typical surfaces in place of a partly assumed one
    averaged: bool  #: as of `stiction.estimate.question.Question`
    closed: Driven | Pulled | Stretched  #: form of a length from the bare one, without voltage or stress

    def centre(self, score: float) -> tuple[float, float]:
        """Mean and scatter of the logarithm of a length [m] over surfaces like those that are assumed."""
        if not self.members:
            return math.log(self.stated.at(score)), 0.0
        values = [math.log(member.at(score)) for member in self.members]
        m, mean = len(values), sum(values) / len(values)
        scatter = math.sqrt(sum((value - mean) ** 2 for value in values) / (m - 1))
        return mean, scatter * math.sqrt(1 + 1 / m)

    def logarithm(self, score: float) -> float:
        """Logarithm of the bare length at a normal score."""
        return self.centre(score)[0] if self.averaged else math.log(self.stated.at(score))

    def ends(self, score: float, confidence: str) -> tuple[float, float]:
        """Ends of the interval of that of a bare length."""
        mean, scatter = self.centre(score)
        below, above = (
            math.hypot(_margin(self.errors, key, score, self.stated.slope), _STUDENT[confidence] * scatter)
            for key in MARGINS[confidence]
        )
        return mean - below, mean + above

    def length(self, score: float) -> float:
        """Length at a normal score [m]."""
        return self.closed.length(math.exp(self.logarithm(score)))

    def scores(self, length: float) -> tuple[float, float, float]:
        """Normal scores at which a length, and the upper and the lower end of 95 %, is a length [m]."""
        value = math.log(self.closed.bare(length))
        upper, lower = (score_at(lambda score, k=k: self.ends(score, "95")[k], value) for k in (1, 0))
        return score_at(self.logarithm, value), upper, lower

    def row(self, fraction: float, score: float) -> LengthRow:
        """Length and intervals at a normal score."""
        ends = {
            confidence: tuple(self.closed.length(math.exp(end)) for end in self.ends(score, confidence))
            for confidence in CONFIDENCES
        }
        return LengthRow(fraction, self.length(score), ends)


def difficulty(slope: float, rest: float) -> float:
    """Size of errors of a length [-], in any unit.

    From the slope of its logarithm by the normal score, because few tips differ, and a rest where all tips are alike.
    """
    return math.hypot(slope, rest)


def _margin(errors, key, score, slope):
    """Part of the interval of the logarithm of a length by the error of the estimate.

    ASSUME: beyond the score that was tested, it grows in proportion to the score.
    """
    return errors["margins"][key] * difficulty(slope, errors["rest"]) * max(1.0, score / errors["tested_score"])


def _worst(rows):
    """Shortest length and ends of some rows of one fraction."""
    ends = {key: tuple(min(row.intervals[key][side] for row in rows) for side in (0, 1)) for key in CONFIDENCES}
    return LengthRow(rows[0].fraction, min(row.length for row in rows), ends)


def _stuck(question, airs):
    """Fraction stuck at the stated length or force in the worst air, with the ends of 95 %, after all touchdowns."""
    fractions = ([after(score, question.touchdowns) for score in air.scores(question.stated)] for air in airs)
    return tuple(max(column) for column in zip(*fractions, strict=True))


def _in_air(question, air, table, tips, full):
    """Lengths at one humidity, as stated and on typical surfaces in place of each that is partly assumed.

    ASSUME: where both surfaces are partly assumed, both are like the same typical surface.
    """
    beam, substrate = question.surfaces
    names = dict.fromkeys(name for members in question.members for name in members)
    pairs = [beam + substrate]
    pairs += [question.members[0].get(name, beam) + question.members[1].get(name, substrate) for name in names]
    stated, *members = (_lengths(question, heights, air, table, tips, full) for heights in pairs)
    errors = _errors(question, table["dry"] if question.is_dry(air) else table)
    closed = question.closed_on(dict(zip(pairs, (stated, *members), strict=True)), air, table)
    return LengthsInAir(errors, stated, tuple(members), question.averaged, closed)


def _errors(question, learnt):
    """Numbers about the errors of its lengths in a part of the table. In dry air, other solids are exactly similar."""
    errors = question.errors(learnt)
    if question.is_of_polysilicon or OF_OTHER_SOLIDS not in errors:
        return errors
    return {**errors, "margins": errors[OF_OTHER_SOLIDS]}


def _lengths(question, heights, air, table, tips, full):
    """Lengths on the sum of two surfaces at one humidity."""
    try:
        if question.is_dry(air):
            return question.in_dry_air(heights, table)
        water = film(air, question.temperature, question.solids.wetting)
        if water.height < THINNEST:
            raise NotLearnt("the film of water is too thin to be a liquid: state a higher humidity, or dry")
        return question.lengths(heights, water, table, tips, full)
    except (ArithmeticError, ValueError) as impossible:  # such as the logarithm of a negative number
        raise Impossible("its numbers contradict each other") from impossible

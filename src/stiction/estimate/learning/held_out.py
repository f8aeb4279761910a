"""Table of the errors of the estimate: on drawn surfaces that were not learnt, and beside runs of devices.

python -m stiction.estimate.learning.held_out FOLDER [SAFE_LENGTHS.csv STOPPERS.csv DEVICES.yaml ...]
"""

import csv
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stiction.config.reading import read
from stiction.config.units import from_si
from stiction.contact.air import Air
from stiction.estimate.answer import CHOSEN, CONFIDENCES, MARGINS, OF_OTHER_SOLIDS, TO_USE, answer, difficulty
from stiction.estimate.learning import by_rms, dry_bridges, dry_rows
from stiction.estimate.learning.design import SurfaceLaw
from stiction.estimate.learning.dry import CONSTANTS, DryEffort
from stiction.estimate.learning.errors import (
    Tested,
    coverage,
    noise_of,
    scores,
    tested,
    tested_bridges,
    tested_forces,
)
from stiction.estimate.learning.other_solids import rows as of_solids
from stiction.estimate.learning.other_solids.points import RANGES, TEMPERATURES
from stiction.estimate.length import NotLearnt
from stiction.estimate.promise import kept
from stiction.estimate.question import questions
from stiction.estimate.table import Surrogate, content, known, processes
from stiction.rounding import bounding
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER, MIDDLE

#: Sets of drawn surfaces in words.
SETS = {
    "decide_typical": "like a typical surface, they decide the intervals",
    "decide_any": "any surface, they decide the intervals",
    "check_paper": "of the paper, in no decision",
    "check_typical": "like a typical surface, in no decision",
    "check_any": "any surface, in no decision",
}


#: Those of other solids.
OTHER_SOLIDS = {name: words for name, words in SETS.items() if not name.endswith(SurfaceLaw.PAPER)}
#: Rule and head of the tables of drawn surfaces.
_RULE = "|---|---|---|---|---|---|---|---|---|"
_HEAD = "| surfaces | number | refused | mean [%] | rms [%] | half [%] | beyond the end | inside 90 % | inside 95 % |"
#: Words before both tables of drawn surfaces.
_OF_LENGTHS = (
    "`stiction estimate` knows cantilevers, bridges and stoppers in humid and dry air, and "
    "refuses all else. Below are lengths for 1 in 1000, of polysilicon at 300 K, beside those of drawn surfaces that "
    "it has not learnt, with tips changed by full contact as in a run, on strips of at most 12 µm. The error is the "
    "logarithm of the latter over the estimate, negative on the unsafe side. The end: that of 90 % which is the size "
    "to use. Half: median from the estimate to this end. In brackets: 95 % range of the fraction. "
    "Drying, shock and pull-in are closed forms of [the life](../life.md). Where water condenses, the estimate of a "
    "device with `shock_g` leaves the size to a run."
)
_OF_BRIDGES = (
    "The same for bridges, beside finite elements of their middle on force laws as of a run. Errors and halves are of "
    "the length without stress that is held as well: stress multiplies both by a factor from 1 to 8/3. Left out are "
    "those of which nine of ten come free of two cracks: all are longer than 1 mm."
)
_OF_FORCES = (
    "The same for forces of stoppers, of the logarithm of 1/force, so that it is negative on the unsafe side here too:"
)
_IN_DRY_AIR = (
    "Lengths in dry air, at Hamaker constants of {:g} to {:g} zJ, beside tips changed by {} strips in full contact at "
    "each slope, with the error that a run would reach:"
)
_OF_SOLIDS = (
    "{} of other solids, with moduli of {:g} to {:g} GPa, Hamaker constants through water of {:g} to {:g} zJ and "
    "contact angles of {:g} to {:g}° on either side, at {:g} to {:g} K. Half of them decide how much wider intervals "
    "of other solids are, as all intervals. The control takes them as polysilicon that water wets perfectly:"
)
_OTHER_BRIDGES = (
    "Three changes of other solids are learnt: by their attraction through water, by that through air, and by their "
    "stiffness, each beside that of the water. Intervals of bridges of other solids are wider by the larger of both "
    "factors. No such bridge was tested in full contact. In dry air other moduli are exactly similar, and intervals "
    "are those above."
)
_BRIDGES_IN_DRY_AIR = (
    "Lengths of bridges in dry air, by the closed form with the pull-off pressure of the estimate of stoppers. A "
    "factor is learnt from {} points, without bridges that come free of two cracks:"
)
_OF_RMS = (
    "Cantilevers and stoppers in humid air once more, with only the rms of both sides stated. The estimate takes "
    "the rest from the typical surfaces, and errors are beside their mean. The end to use makes the same promise:"
)
#: Devices of whose surfaces the rms alone is stated, by their kind in words.
_BY_RMS = (("length", by_rms.lengths), ("force", by_rms.forces))
_FORCES_IN_DRY_AIR = "Forces in dry air, beside patches changed by {} strips of 3 µm in full contact:"


def lines(folder: Path) -> Iterator[str]:
    """Lines of the tables of drawn surfaces."""
    table = content()
    tables = [*_of_polysilicon(folder, table), *_of_other_solids(folder, table)]
    for words, rows in tables:
        yield from (words, "", _HEAD, _RULE, *(row.line for row in rows), "")
    yield from (_OTHER_BRIDGES, "")
    yield from _beyond([row for _, rows in tables for row in rows if row.is_checked])
    yield from _of_noise(folder, table["tested_score"])
    yield from _of_rms(folder)


def _of_polysilicon(folder, table):
    """Words and rows of the tables of polysilicon."""
    dry, (of_tips, of_patches) = table["dry"], DryEffort.strips
    of_bridges, of_forces = _BRIDGES_IN_DRY_AIR.format(_points(dry_bridges.SETS)), ("forces", "full")
    for words, test, errors, names in (
        (_OF_LENGTHS, tested, table, ("tips", "full")),
        (_OF_BRIDGES, tested_bridges, table["bridges"], ("middle", "full")),
        (_OF_FORCES, tested_forces, table["stoppers"], of_forces),
        (_IN_DRY_AIR.format(*CONSTANTS, of_tips), dry_rows.tested, dry, ("tips", "full")),
        (_FORCES_IN_DRY_AIR.format(of_patches), dry_rows.tested_forces, dry["stoppers"], of_forces),
        (of_bridges, dry_rows.tested_bridges, dry["stoppers"] | dry["bridges"], ("middle", *of_forces)),
    ):
        of_part = [Surrogate(**errors[name]) for name in names]
        learnt = table["modulus"], errors["tested_score"], lambda _, of_part=of_part: of_part
        yield words, _rows_of(SETS, errors, lambda name, test=test, learnt=learnt: test(folder, name, *learnt))


def _points(sets):
    """Number of the points of all sets to learn from."""
    return sum(effort.points for name, effort in sets.items() if name.startswith("learn"))


def _of_other_solids(folder, table):
    """Words and rows of the tables of other solids."""
    ranges = [end for name in ("modulus", "hamaker", "angle") for end in RANGES[name]]
    for words, test, errors, first in (
        ("Lengths", of_solids.tested, table, "tips"),
        ("Forces", of_solids.tested_forces, table["stoppers"], "forces"),
    ):
        learnt = errors["tested_score"], processes(errors, first, "full")
        wider = {**errors, "margins": errors[OF_OTHER_SOLIDS]}

        def found(name, as_polysilicon=False, test=test, learnt=learnt):
            """Surfaces of a set."""
            return test(folder, name, *learnt, as_polysilicon=as_polysilicon)

        rows = _rows_of(OTHER_SOLIDS, wider, found)
        control = [surface for name in OTHER_SOLIDS if _is_checked(name) for surface in found(name, True)]
        rows += [RowOfSurfaces("in no decision, control", control, wider)] if control else []
        yield _OF_SOLIDS.format(words, *ranges, *TEMPERATURES), rows


def _is_checked(name):
    """Whether a set decides nothing."""
    return name.startswith("check")


def _rows_of(sets, errors, found):
    """Rows of some sets of which surfaces are found, with the errors of a part of the table."""
    surfaces = {name: list(found(name)) for name in sets}
    return [RowOfSurfaces(sets[name], each, errors, _is_checked(name)) for name, each in surfaces.items() if each]


def _beyond(rows):
    """Lines about the surfaces beyond the end to use in some rows."""
    beyond = np.concatenate([row.is_beyond for row in rows]) if rows else np.zeros(0)
    if len(beyond):
        yield (
            f"Of all surfaces in no decision, {beyond.sum()} of {len(beyond)} lie beyond the end to use: "
            f"{100 * beyond.mean():.1f} %, where the promise allows {100 - kept(CONFIDENCES[0]):g} %."
        )
        yield ""


def _of_rms(folder):
    """Lines of the table of devices of whose surfaces the rms alone is stated."""
    found = {
        (kind, name): list(devices(folder, name)) for kind, devices in _BY_RMS for name in SETS if _is_checked(name)
    }
    if any(found.values()):
        yield from (_OF_RMS, "", f"| size {_HEAD.rpartition('| inside')[0]}|", f"|---{_RULE.removesuffix('---|')}")
        yield from (_line_by_rms(kind, SETS[name], devices) for (kind, name), devices in found.items() if devices)
        yield ""


def _line_by_rms(kind, words, devices):
    """Row of the table of a kind of devices on some surfaces."""
    answered = [device for device in devices if device.estimate]
    errors = np.array([device.error for device in answered])
    numbers = np.mean(errors), np.sqrt(np.mean(errors**2)), np.median([device.half for device in answered])
    cells = [kind, words, len(devices), len(devices) - len(answered), *(f"{100 * number:.1f}" for number in numbers)]
    cells += [_counted(np.array([getattr(each, key) for each in answered])) for key in ("is_beyond", "is_inside")]
    return f"| {' | '.join(map(str, cells))} |"


def _of_noise(folder, score):
    """Lines about the parts of the errors of lengths that are noise of the run."""
    if len(noise := noise_of(folder, f"decide_{SurfaceLaw.TYPICAL}", score)):
        rms, exact = 100 * np.sqrt((noise**2).mean(axis=0)), 100 * _HALF * np.median(noise[:, 0])
        yield (
            f"Of the errors of lengths in the first row of all, {rms[0]:.1f} % rms are noise of the eight strips in "
            f"full contact of a run, and {rms[1]:.1f} % of the drawn tips, by the bootstrap. An exact estimate would "
            f"still have half an interval of {exact:.0f} %, for it errs beside a run that errs. Intervals are in "
            "proportion to the scatter of the tips: they are narrow in wet air and on smooth surfaces."
        )
        yield ""


#: Half of an interval of 90 % of a normal value, in standard errors.
_HALF = 1.645


def of_runs(lengths: str, forces: str, devices: str) -> Iterator[str]:
    """Lines of the table beside runs, whose safe lengths and forces and devices are in files. They touch down once."""
    asked = {
        name: question
        for name, question in questions(read(devices), content()).items()
        if not isinstance(question, NotLearnt)
    }
    yield f"Beside the run of [{devices}](../../{devices}): lengths by beam, tip or middle, and"
    yield "of stoppers the simulated limit with 95 % confidence, which is above the estimate of the run:"
    yield ""
    yield "| run | RH | 1 in | size of the run | estimate | 90 % |"
    yield "|---|---|---|---|---|---|"
    rows = list(_rows(lengths, forces, asked))
    yield from (row.line for row in rows)
    chosen = [row for row in rows if row.share == CHOSEN and row.is_known]
    inside, beyond = (sum(each) for each in zip(*((row.is_inside, row.is_beyond) for row in chosen), strict=True))
    yield ""
    yield (
        f"At 1 in {1 / CHOSEN:.0f}, {inside} of {len(chosen)} sizes of the run are inside the interval of 90 %, "
        f"and {beyond} of {len(chosen)} lie beyond the end to use."
    )
    yield ""


class RowBesideRun(NamedTuple):
    """Row of the table beside a run."""

    line: str
    share: float
    is_known: bool = False  #: whether the estimate does not refuse
    is_inside: bool = False  #: whether the size of the run is in the interval of 90 %
    is_beyond: bool = False  #: whether it is beyond the end to use


def _rows(lengths, forces, asked):
    """Rows of lengths and forces of a run, in files, by the questions about their devices."""
    for row in _read(lengths):
        if row["device"] in asked and row["held_by"] in _HELD_BY:
            yield _beside(row, float(row["share"]), float(row["estimate_um"]), asked[row["device"]])
    for row in _read(forces):
        for share in _SHARES if row["device"] in asked and row["relative_humidity"] else ():
            safe = float(row[f"safe_force_uN_{share:g}"])
            yield _beside(row, share, safe, asked[row["device"]])


#: Ways to hold beams in the table.
_HELD_BY = [END_STATES[state].by for state in (EITHER, MIDDLE)]
#: Fractions of stoppers in the table, and units in words.
_SHARES = (1e-2, 1e-3)
_WORDS = {"um": "µm", "uN": "µN"}


def _read(path):
    """Rows of a file."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def _beside(row, share, of_run, question):
    """Row of one length or force of a run, in the unit of the question."""
    humidity = float(row["relative_humidity"])
    once, cells = replace(question, touchdowns=1, humidities=(humidity,)), [row["device"], Air(humidity).name]
    cells += [f"{1 / share:.0f}", f"{_three_digits(of_run)} {_WORDS[question.unit]}"]
    try:
        estimate = answer(once, *known())
    except NotLearnt:
        return RowBesideRun(f"| {' | '.join([*cells, 'refused', ''])} |", share)
    estimated = next(each for each in estimate.rows if np.isclose(each.fraction, share))
    low, high = (from_si(end, question.unit) for end in estimated.intervals["90"])
    size = _three_digits(from_si(estimated.size, question.unit))
    ends = f"{bounding(low, 3, up=False)} to {bounding(high, 3, up=True)}"
    is_beyond = of_run > high if estimate.is_force else of_run < low
    return RowBesideRun(f"| {' | '.join([*cells, size, ends])} |", share, True, low <= of_run <= high, is_beyond)


def _three_digits(number):
    """Number with three digits, and without an exponent."""
    return f"{float(f'{number:.3g}'):g}"


@dataclass(frozen=True)
class RowOfSurfaces:
    """Row of a table of drawn surfaces."""

    words: str
    surfaces: Sequence[Tested]
    of_part: Mapping[str, Any]  #: part of the table with their errors
    is_checked: bool = False  #: whether they decide nothing, and are estimated as what they are

    @property
    def _answered(self):
        """Surfaces that the estimate does not refuse."""
        return [surface for surface in self.surfaces if surface.is_known]

    @property
    def _scores(self):
        """Their errors over their difficulties (n,)."""
        return scores(self.surfaces, self.of_part["rest"])

    @property
    def is_beyond(self) -> np.ndarray:
        """Whether their sizes are on the unsafe side of the end to use (n,)."""
        return self._scores < -self.of_part["margins"][TO_USE]

    @property
    def line(self) -> str:
        """Row as a text."""
        answered, margins = self._answered, self.of_part["margins"]
        errors = np.array([surface.error for surface in answered])
        halves = [margins[TO_USE] * difficulty(surface.slope, self.of_part["rest"]) for surface in answered]
        numbers = [np.mean(errors), np.sqrt(np.mean(errors**2)), np.median(halves)]
        cells = [self.words, len(self.surfaces), len(self.surfaces) - len(answered)]
        cells += [*(f"{100 * number:.1f}" for number in numbers), _counted(self.is_beyond)]
        cells += [
            _counted((-margins[unsafe] <= self._scores) & (self._scores <= margins[safe]))
            for unsafe, safe in MARGINS.values()
        ]
        return f"| {' | '.join(map(str, cells))} |"


def _counted(are):
    """Number of surfaces of which something is true (n,), with the range of their fraction."""
    low, high = coverage(int(are.sum()), len(are))
    return f"{are.sum()} of {len(are)} ({100 * low:.0f} to {100 * high:.0f} %)"


if __name__ == "__main__":
    folder, *files = sys.argv[1:]
    beside = chain.from_iterable(of_runs(*files[k : k + 3]) for k in range(0, len(files), 3))
    sys.stdout.writelines(f"{line}\n" for line in chain(lines(Path(folder)), beside))

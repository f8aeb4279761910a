"""Table of the errors of the estimate: on drawn surfaces that were not learnt, and beside runs of devices.

python -m stiction.estimate.held_out FOLDER SAFE_LENGTHS.csv DEVICES.yaml
"""

import csv
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np

from stiction.config.reading import read
from stiction.config.units import from_si
from stiction.estimate.answer import CONFIDENCES, answer, difficulty
from stiction.estimate.errors import coverage, scores, tested
from stiction.estimate.question import Question, questions
from stiction.estimate.table import content, known
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER

#: Sets of drawn surfaces in words.
SETS = {
    "decide_typical": "like a typical surface, they decide the intervals",
    "decide_any": "any surface, they decide the intervals",
    "check_paper": "of the paper, in no decision",
    "check_typical": "like a typical surface, in no decision",
    "check_any": "any surface, in no decision",
}


def lines(folder: Path) -> Iterator[str]:
    """Lines of the table of drawn surfaces."""
    yield (
        "`stiction estimate` knows cantilevers of polysilicon in humid air at 300 K, and refuses all else. Bridges and "
        "stoppers depend on energies and forces of parallel surfaces, and its table has tilted tips alone. Dry air has "
        "no film, and full contact of its own. Below are its lengths for 1 in 1000 beside those of drawn surfaces that "
        "it has not learnt, with tips changed by full contact as in a run, on strips of at most 12 µm. The error is "
        "the logarithm of the latter over the estimate, negative on the unsafe side. It contains the noise of the "
        "drawn tips, and of the eight strips in full contact of a run. Half: median of half of the interval of 90 %. "
        "In brackets: 95 % range of the share inside."
    )
    yield ""
    yield "| surfaces | number | refused | mean [%] | rms [%] | largest [%] | half [%] | inside 90 % | inside 95 % |"
    yield "|---|---|---|---|---|---|---|---|---|"
    table, *processes = known()
    for name, words in SETS.items():
        found = list(tested(folder, name, table["modulus"], table["tested_score"], lambda _: processes))
        if found:
            yield _row(words, found)


def of_runs(lengths: str, devices: str) -> Iterator[str]:
    """Lines of the table beside runs, whose safe lengths and devices are in two files. They touch down once."""
    asked = {name: one for name, one in questions(read(devices), content()).items() if isinstance(one, Question)}
    yield ""
    yield "Beside the run of [examples/devices.yaml](../../examples/devices.yaml), beam or tip:"
    yield ""
    yield "| run | RH | 1 in | length of the run [µm] | estimate [µm] | 90 % [µm] |"
    yield "|---|---|---|---|---|---|"
    with Path(lengths).open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["device"] in asked and row["held_by"] == END_STATES[EITHER].by:
                yield _beside(row, asked[row["device"]])


def _beside(row, question):
    """Row of one length of a run."""
    once = replace(question, touchdowns=1, humidities=(float(row["relative_humidity"]),))
    found = next(one for one in answer(once, *known()).rows if np.isclose(one.fraction, float(row["share"])))
    numbers = [found.length, *found.intervals["90"]]
    shown, low, high = (f"{from_si(number, 'um'):.0f}" for number in numbers)
    cells = [row["device"], row["relative_humidity"], f"{1 / found.fraction:.0f}", f"{float(row['estimate_um']):.0f}"]
    return f"| {' | '.join([*cells, shown, f'{low} to {high}'])} |"


def _row(words, found):
    """Row of one set."""
    known, rest, margins = [one for one in found if one.is_known], content()["rest"], content()["margins"]
    errors = np.array([one.error for one in known])
    halves = [margins["90"] * difficulty(one.slope, rest) for one in known]
    numbers = [np.mean(errors), np.sqrt(np.mean(errors**2)), np.abs(errors).max(), np.median(halves)]
    cells = [words, len(found), len(found) - len(known), *(f"{100 * number:.1f}" for number in numbers)]
    cells += [_inside(scores(known, rest) <= margins[name]) for name in CONFIDENCES]
    return f"| {' | '.join(map(str, cells))} |"


def _inside(is_inside):
    """Share of surfaces whose errors are within a margin (n,), with its range."""
    low, high = coverage(int(is_inside.sum()), len(is_inside))
    return f"{is_inside.sum()} of {len(is_inside)} ({100 * low:.0f} to {100 * high:.0f} %)"


if __name__ == "__main__":
    folder, *files = sys.argv[1:]
    sys.stdout.writelines(f"{line}\n" for line in chain(lines(Path(folder)), of_runs(*files)))

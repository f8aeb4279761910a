"""Table of the errors of the estimate: on drawn surfaces that were not learnt, and beside runs of devices.

python -m stiction.estimate.held_out FOLDER SAFE_LENGTHS.csv DEVICES.yaml
"""

import csv
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np

from stiction.config.reading import read
from stiction.config.units import from_si
from stiction.estimate.answer import CONFIDENCES, answer, difficulty
from stiction.estimate.errors import Tested, tested
from stiction.estimate.question import Question, questions
from stiction.estimate.table import content, known
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER

#: Sets of drawn surfaces in words.
SETS = {
    "test_typical": "like a typical surface, they decide the intervals",
    "test_any": "any surface, they decide the intervals",
    "check_paper": "of the paper, in no decision",
    "check_typical": "like a typical surface, in no decision",
}


def lines(folder: Path) -> Iterator[str]:
    """Lines of the table of drawn surfaces."""
    yield (
        "`stiction estimate` knows cantilevers of polysilicon in humid air at 300 K, and refuses all else. Below are "
        "its lengths for 1 in 1000 beside those of tips on drawn surfaces that it has not learnt. The error is the "
        "logarithm of their ratio. It contains the noise of the drawn tips, and of the eight strips in full contact "
        "that a run draws as well. Half: median of half of the interval of 90 %."
    )
    yield ""
    yield "| surfaces | number | refused | rms error [%] | largest [%] | half [%] | inside 90 % | inside 95 % |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, words in SETS.items():
        found = list(tested(folder, name, content(), content()["tested_score"], changed=True))
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
    known = [one for one in found if not math.isnan(one.estimate)]
    errors = np.array([one.error for one in known])
    surfaces = {one.surface for one in known}
    halves = [content()["margins"]["90"] * difficulty(one.slope) for one in known]
    numbers = [np.sqrt(np.mean(errors**2)), np.abs(errors).max(), np.median(halves)]
    cells = [words, len(found), len(found) - len(known), *(f"{100 * number:.1f}" for number in numbers)]
    cells += [f"{_inside(known, content()['margins'][name])} of {len(surfaces)}" for name in CONFIDENCES]
    return f"| {' | '.join(map(str, cells))} |"


def _inside(known: Sequence[Tested], margin: float) -> int:
    """Number of surfaces whose errors are all within a margin."""
    outside = {one.surface for one in known if one.score > margin}
    return len({one.surface for one in known} - outside)


if __name__ == "__main__":
    folder, *files = sys.argv[1:]
    sys.stdout.writelines(f"{line}\n" for line in chain(lines(Path(folder)), of_runs(*files)))

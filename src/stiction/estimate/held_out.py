"""Table of the errors of the estimate: on drawn surfaces that were not learnt, and beside runs of devices.

python -m stiction.estimate.held_out FOLDER
"""

import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from stiction.estimate.answer import CONFIDENCES, difficulty
from stiction.estimate.errors import Tested, tested
from stiction.estimate.table import content

#: Sets of drawn surfaces in words.
SETS = {
    "test_typical": "like a typical surface, they decide the intervals",
    "test_any": "any surface, they decide the intervals",
    "check_paper": "of the paper, in no decision",
    "check_typical": "like a typical surface, in no decision",
    "check_any": "any surface, in no decision",
}


def lines(folder: Path) -> Iterator[str]:
    """Lines of the table."""
    yield (
        "Lengths for 1 in 1000 of drawn surfaces by their own tips and by the estimate. Error: ln of the ratio; it "
        "has the errors of these tips. Inside: surfaces of which all lengths are within the interval."
    )
    yield ""
    yield "| surfaces | number | refused | rms error [%] | largest [%] | half of 90 % [%] | inside 90 % | inside 95 % |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, words in SETS.items():
        found = list(tested(folder, name, content(), content()["tested_score"], changed=True))
        if found:
            yield _row(words, found)


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
    sys.stdout.write("".join(f"{line}\n" for line in lines(Path(sys.argv[1]))))

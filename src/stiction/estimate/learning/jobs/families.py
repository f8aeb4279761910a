"""Families of points from which the estimate is learnt and by which it is tested, in chunks of one job each.

A chunk is a folder. The command runs in the folder of all of them, and computes one:

    python -m stiction.estimate.learning.jobs.families dry/patches/learn_any/0016
"""

import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from stiction.contact.air import DRY
from stiction.estimate.learning import bridges, dry, dry_bridges, dry_patches, patches, training
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.files import CHUNK, save
from stiction.estimate.learning.other_solids import points, ratios
from stiction.estimate.learning.training import TrainingEffort
from stiction.progress import without_progress


@dataclass(frozen=True)
class Family:
    """Sets of points with the same numbers."""

    folder: str
    sets: Mapping[str, TrainingEffort]
    base: Callable[[], dict[str, Any]]  #: valid configuration of all points
    compute: Callable[[Point, str, dict[str, Any]], dict[str, Any]]  #: numbers of one point of a set
    every: Mapping[str, int] = field(
        default_factory=dict
    )  #: one of so many points of a set has numbers, by default all
    after: str = ""  #: family of which it reads the same points

    def numbers(self, name: str) -> range:
        """Numbers of the points of a set."""
        return range(0, self.sets[name].points, self.every.get(name, 1))

    def chunks(self) -> Iterator[str]:
        """Chunks of all sets that the table needs."""
        for name in self.sets:
            if name != "control":
                yield from (f"{self.folder}/{name}/{first:04}" for first in range(0, self.sets[name].points, CHUNK))

    def save(self, name: str, first: int) -> None:
        """Compute the points of a chunk of a set."""
        valid = self.base()
        for point in self.sets[name].all[first : first + CHUNK]:
            if point.number in self.numbers(name):
                save(Path(self.folder) / name, point.number, self.compute(point, name, valid))


def _of_ratio(ratio):
    """Families of one ratio of other solids."""
    tips = partial(ratios.computed, ratio=ratio)
    middles = partial(ratios.computed_bridges, ratio=ratio)
    return (
        Family(ratio.folder, ratio.sets, training.base, tips),
        Family(f"{ratio.folder}/{bridges.FOLDER}", ratio.of_bridges, bridges.base, middles, bridges.EVERY),
    )


_IN_DRY_AIR = partial(bridges.base, [DRY])
_ALL = (
    Family(training.FOLDER, training.SETS, training.base, training.computed),
    Family(patches.FOLDER, training.SETS, patches.base, patches.computed),
    Family(bridges.FOLDER, training.SETS, bridges.base, bridges.computed, bridges.EVERY, after=patches.FOLDER),
    Family(dry.FOLDER, dry.SETS, dry.base, dry.computed),
    Family(dry_patches.FOLDER, dry_patches.SETS, dry_patches.base, dry_patches.computed),
    Family(dry_bridges.FOLDER, dry_bridges.SETS, _IN_DRY_AIR, dry_bridges.computed),
    *(family for ratio in ratios.ALL for family in _of_ratio(ratio)),
    Family(points.FOLDER, points.SETS, training.base, points.computed),
    Family(f"{points.FOLDER}/{patches.FOLDER}", points.SETS, patches.base, points.computed_patches),
)
#: Families by folder.
FAMILIES = {family.folder: family for family in _ALL}


def main(chunk: str) -> None:
    """Compute a chunk."""
    folder, name, first = chunk.rsplit("/", 2)
    with without_progress():
        FAMILIES[folder].save(name, int(first))


if __name__ == "__main__":
    main(sys.argv[1])

"""Answers about drawn devices of whose surfaces the rms alone is stated, beside their true sizes.

All else counts as that of the typical surfaces. No such device decides an interval.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stiction.config.units import from_si, to_si
from stiction.estimate.answer import CHOSEN, CONFIDENCES, Estimate, answer
from stiction.estimate.learning.design import Point
from stiction.estimate.learning.errors import settled_patches, settled_tips
from stiction.estimate.learning.training import PAIR, air_of
from stiction.estimate.length import NotLearnt, normal_score
from stiction.estimate.question import questions
from stiction.estimate.state import Film
from stiction.estimate.table import content, known

#: Thickness of the cantilevers [m]: the estimate knows E t³ / h² alone.
_THICKNESS = to_si(2.6, "um")
#: Typical surface that each side names before all of them are averaged.
_LIKE = {"S": "B2", "T": "Sub1"}


@dataclass(frozen=True)
class ByRms:
    """Answer about one device, and its true size."""

    estimate: Estimate | None  #: none where it refuses
    true: float  #: by all that is known of its surfaces [SI]

    @property
    def error(self) -> float:
        """Logarithm of the true size over the estimate, negative on the unsafe side."""
        return self._sign * math.log(self.true / self.estimate.chosen.size)

    @property
    def half(self) -> float:
        """Logarithm of the estimate over its end to use, of a force its negative."""
        return self._sign * math.log(self.estimate.chosen.size / self.estimate.use)

    @property
    def is_beyond(self) -> bool:
        """Whether the true size is on the unsafe side of the end to use."""
        return self._sign * (self.true - self.estimate.use) < 0

    @property
    def is_inside(self) -> bool:
        """Whether it is in the interval of 90 %."""
        low, high = self.estimate.chosen.intervals[CONFIDENCES[0]]
        return low <= self.true <= high

    @property
    def _sign(self):
        """Side on which a size is safe."""
        return -1 if self.estimate.is_force else 1


def lengths(folder: Path, name: str) -> Iterator[ByRms]:
    """Cantilevers of a set."""
    table = content()
    for point, state, true in settled_tips(folder, name, table["modulus"]):
        gap = math.sqrt(table["modulus"] * _THICKNESS**3 / point.stiffness)
        sizes = {"thickness_um": from_si(_THICKNESS, "um"), "gap_um": from_si(gap, "um"), "width_um": point.width}
        answered = _answered(point, state.film, {"kind": "cantilever", **sizes})
        yield ByRms(answered, gap * true.at(normal_score(CHOSEN)))


def forces(folder: Path, name: str) -> Iterator[ByRms]:
    """Stoppers of a set."""
    for point, patch, true in settled_patches(folder, name, content()["modulus"]):
        side = from_si(math.sqrt(patch.area), "um")
        answered = _answered(point, patch.film, {"kind": "stopper", "contact_um": [side, side]})
        yield ByRms(answered, 1 / true.at(normal_score(CHOSEN)))


def _answered(point: Point, film: Film, device: Mapping[str, Any]) -> Estimate | None:
    """Answer about a device of a point in a film, by the rms of its surfaces alone."""
    table = content()
    humidity, _ = air_of(film.height, 1.0, table["temperature"])
    sides = zip(_LIKE.items(), point.sides, strict=True)
    surfaces = {name: {"rms_nm": section["rms_nm"], "like": like} for (name, like), section in sides}
    pairs = {PAIR: {"beam": "S", "substrate": "T"}}
    devices = {"D": {**device, "pair": PAIR, "humidities": [humidity]}}
    asked = questions({"surfaces": surfaces, "pairs": pairs, "devices": devices}, table)["D"]
    try:
        return answer(replace(asked, averaged=True), *known())
    except NotLearnt:
        return None

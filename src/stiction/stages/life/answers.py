"""Answers about a device: their names, and the dataset that keeps them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.stages.life.inputs import Stated

#: Questions of a designer, in their order.
QUESTIONS = TOUCH, STICK, HOLD, FREE = "touch", "stick", "hold", "free"
#: Names of answers that sentences are about.
VOLTAGE, SHOCK, COLLAPSE, RELEASED, AFTER = "voltage", "shock", "collapse", "released", "after"
AT_VOLTAGE, VOLTAGE_ENERGY, FIELD, FREEING = "at_voltage", "voltage_energy", "field", "freeing_voltage"
FAST, RESTORING, FREED = "fast", "restoring_force", "freeing"
HELD, PULL = "energy", "force"
#: Begins the names of safe lengths, which end with their humidity.
SAFE = "safe_length_"
TILTED, WEDGE = "force_tilted", "wedge"
ON_DIMPLES, BESIDE, DIMPLES, PULLED = "stuck_dimples", "beside_dimples", "dimples", "dimples_force"
VOLTAGE_BESIDE, TENSION_BESIDE = "voltage_dimples", "tension_dimples"


#: Fields of an answer that are texts.
_TEXTS = ("name", "question", "what", "unit", "form", "source", "needs")


class Answer(NamedTuple):
    """One answer to a question, with numbers in SI."""

    name: str
    question: str
    what: str
    low: float  #: at least; NaN if no such bound is known
    high: float  #: at most; NaN if no such bound is known
    error: float  #: standard uncertainty of the lower bound, or of the upper one alone; NaN if none is known
    unit: str
    form: str
    source: str
    needs: str = ""  #: keys that give the number; empty if it is there


def in_order(answers: Sequence[Answer]) -> list[Answer]:
    """Answers in the order of the questions."""
    return sorted(answers, key=lambda answer: QUESTIONS.index(answer.question))


def layout(answers: Sequence[Answer], of: Stated, length: float = np.nan) -> xr.Dataset:
    """Dataset of the answers about a device; ``length`` is that at which a beam is asked for voltage and shock [m]."""
    columns = dict(zip(Answer._fields, zip(*answers, strict=True), strict=True))
    numbers = {"low": "at least", "high": "at most", "error": "standard uncertainty"}
    return xr.Dataset(
        {name: ("answer", list(columns[name])) for name in _TEXTS[1:]}
        | {name: ("answer", list(columns[name]), {"long_name": text}) for name, text in numbers.items()}
        | {"length": ((), length, {"units": "m"}), "touchdowns": ((), of.touchdowns, {"units": "1"})}
        | {"potential": ((), of.potential, {"units": "V"})},
        coords={"answer": list(columns["name"])},
    )


def answers_of(dataset: xr.Dataset) -> list[Answer]:
    """Answers about a device from its dataset."""
    rows = zip(*(dataset["answer" if name == "name" else name].values for name in Answer._fields), strict=True)
    return [
        Answer(
            *(str(value) if name in _TEXTS else float(value) for name, value in zip(Answer._fields, row, strict=True))
        )
        for row in rows
    ]

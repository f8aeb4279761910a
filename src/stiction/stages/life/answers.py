"""Answers about a device: their names, and the dataset that keeps them."""

from collections.abc import Iterable, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.stages.life.inputs import DeviceKeys

#: Questions of a designer, in their order.
QUESTIONS = TOUCH, STICK, HOLD, FREE = "touch", "stick", "hold", "free"


class Name(StrEnum):
    """Names of answers that sentences are about; those of liquids and airs end with these."""

    VOLTAGE = "voltage"
    SHOCK = "shock"
    COLLAPSE = "collapse"
    RELEASED = "released"
    AFTER = "after"
    AT_VOLTAGE = "at_voltage"
    VOLTAGE_ENERGY = "voltage_energy"
    FIELD = "field"
    FREEING = "freeing_voltage"
    FAST = "fast"
    RESTORING = "restoring_force"
    FREED = "freeing"
    HELD = "energy"
    PULL = "force"
    SAFE = "safe_length_"
    TILTED = "force_tilted"
    WEDGE = "wedge"
    ON_DIMPLES = "stuck_dimples"
    BESIDE = "beside_dimples"
    DIMPLES = "dimples"
    PULLED = "dimples_force"
    VOLTAGE_BESIDE = "voltage_dimples"
    TENSION_BESIDE = "tension_dimples"


#: Fields of an answer that are texts.
_TEXTS = ("name", "question", "what", "unit", "form", "source", "needs")


class LifeRow(NamedTuple):
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


def in_order(answers: Sequence[LifeRow]) -> list[LifeRow]:
    """Answers in the order of the questions."""
    return sorted(answers, key=lambda answer: QUESTIONS.index(answer.question))


def layout(answers: Sequence[LifeRow], keys: DeviceKeys, length: float = np.nan) -> xr.Dataset:
    """Dataset of the answers about a device; ``length`` is that at which a beam is asked for voltage and shock [m]."""
    columns = dict(zip(LifeRow._fields, zip(*answers, strict=True), strict=True))
    shock = {"shock": ((), keys.shock)} if keys.shock else {}
    return xr.Dataset(
        {name: ("answer", list(columns[name])) for name in (*_TEXTS[1:], "low", "high", "error")}
        | {"length": ((), length), "touchdowns": ((), keys.touchdowns)}
        | {"potential": ((), keys.potential)}
        | shock,
        coords={"answer": list(columns["name"])},
    )


def answers_of(dataset: xr.Dataset) -> list[LifeRow]:
    """Answers about a device from its dataset."""
    rows = zip(*(dataset["answer" if name == "name" else name].values for name in LifeRow._fields), strict=True)
    return [
        LifeRow(
            *(str(value) if name in _TEXTS else float(value) for name, value in zip(LifeRow._fields, row, strict=True))
        )
        for row in rows
    ]


# What answers about beams and stoppers have in common

#: Keys for the effect of a voltage on a device in contact, and its source.
BY_VOLTAGE, HELD_BY = "voltage_V and dielectric", "stage at_voltage, stiction.life.holding"


def missing(answers: Sequence[LifeRow], rows: Iterable[tuple[str, str, str, str, str]]) -> list[LifeRow]:
    """Answers without a number for those rows (name, question, what, unit, keys) that no answer has."""
    names = {answer.name for answer in answers}
    no_numbers = np.nan, np.nan, np.nan
    return [
        LifeRow(name, question, subject, *no_numbers, unit, "–", "–", keys)
        for name, question, subject, unit, keys in rows
        if name not in names
    ]


def field_in_dielectric(keys: DeviceKeys) -> LifeRow:
    """Field in the dielectric of a device whose surfaces touch."""
    subject, form = "field in the dielectric in contact", "V / t; thin oxides break down near 1 V/nm"
    return LifeRow(
        Name.FIELD, HOLD, subject, np.nan, keys.capacitor.field, np.nan, "V m-1", form, "stiction.contact.voltage"
    )


def pulses(sine: float, rectangle: float) -> str:
    """Lower bound of the peak of a half-sine, and of a rectangular pulse, in parts of a slow one."""
    return f"at least: / {sine:.3g}, any half-sine (a rectangular pulse: / {rectangle:.3g})"

"""Answers about a device that wait for a key: rows with the key in place of the number."""

from collections.abc import Iterable, Sequence

import numpy as np

from stiction.devices.risk import samples_for
from stiction.stages.life.answers import (
    AT_VOLTAGE,
    FREE,
    FREED,
    HELD,
    HOLD,
    PULL,
    RESTORING,
    SHOCK,
    TOUCH,
    VOLTAGE,
    VOLTAGE_ENERGY,
    Answer,
)
from stiction.stages.life.inputs import OfStopper

#: Keys for the effect of a voltage on a device in contact.
_AT_VOLTAGE = "voltage_V and dielectric"


def beam_unknown(answers: Sequence[Answer]) -> list[Answer]:
    """Rows for everything that a beam does not say of its voltages, shocks and forces, with the keys that say it."""
    rows = (
        (VOLTAGE, TOUCH, "voltage that pulls it in", "V", "length_um"),
        (SHOCK, TOUCH, "peak of a shock that brings it down", "m s-2", "length_um"),
        (HELD, HOLD, "adhesion energy that holds it along the beam", "J m-2", "length_um"),
        (PULL, FREE, "force with which it pulls at its contact", "N", "length_um"),
        (VOLTAGE_ENERGY, HOLD, "adhesion energy that a voltage adds", "J m-2", _AT_VOLTAGE),
    )
    return _missing(answers, rows)


def stopper_unknown(answers: Sequence[Answer], of: OfStopper, share: float) -> list[Answer]:
    """Rows for everything that a stopper does not say, with the keys that say it.

    ``share`` is the largest fraction of stuck stoppers that its forces are asked for.
    """
    samples = f"contact.samples of {samples_for(share)} or more"
    spring = "" if of.stiffness else ", stiffness_N_per_m and gap_um"
    rows = (
        (SHOCK, TOUCH, "peak of a shock that brings it into contact", "m s-2", "mass_ng"),
        (VOLTAGE, TOUCH, "voltage on its electrode that brings it into contact", "V", f"electrode{spring}"),
        (AT_VOLTAGE, HOLD, "force that a voltage adds", "N", _AT_VOLTAGE),
        (RESTORING, FREE, "restoring force that frees nearly all", "N", samples),
        (FREED, FREE, "shock that frees nearly all", "m s-2", samples if of.mass else "mass_ng"),
    )
    return _missing(answers, rows)


def _missing(answers: Sequence[Answer], rows: Iterable[tuple[str, str, str, str, str]]) -> list[Answer]:
    """Answers without a number for those rows (name, question, what, unit, keys) that no answer has."""
    known = {answer.name for answer in answers}
    nothing = np.nan, np.nan, np.nan
    return [
        Answer(name, question, what, *nothing, unit, "–", "–", keys)
        for name, question, what, unit, keys in rows
        if name not in known
    ]

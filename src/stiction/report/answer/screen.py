"""First screen of the page of a device: one number, its probability, what it contains, and what to do."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from stiction.answer.data import Answer
from stiction.answer.sought import FORCE, LENGTH, PULL_OFF
from stiction.report.answer import places, words
from stiction.report.format import MISSING, UM
from stiction.report.page import Summary

#: Powers of thickness and gap in the length that sticks at an adhesion energy, of beams without tension; Eq. (13).
_OF_THICKNESS, _OF_GAP = 3 / 4, 1 / 2


def screen(answer: Answer, section: Mapping[str, Any], forbidding: Sequence[str], of_model: str) -> Summary:
    """First screen of a device.

    Its section of the configuration, the sentences of the limits that forbid a number, and one on the error of the
    model.
    """
    face = _FACES[answer.sought.name]
    points, cells = face.points(answer, section), face.cells(answer)
    if words.is_forbidden(answer):
        reason = " ".join(forbidding)
        cells = cells.assign(**dict.fromkeys(cells.columns[1:], MISSING))
        points = {"What to measure": points["What to measure"]}
        missing = "the warning above forbids to rely on one"
        return Summary("bad", words.NO_NUMBER, reason, (), points, cells, missing, is_forbidden=True)
    basis = [*face.basis(answer), of_model]
    return Summary(*words.sign_of(answer), face.headline(answer), list(filter(None, basis)), points, cells)


class _Face(NamedTuple):
    """Parts of a first screen, by functions of an answer."""

    headline: Callable[[Answer], str]
    basis: Callable[[Answer], list[str]]
    points: Callable[[Answer, Mapping[str, Any]], dict[str, str]]
    cells: Callable[[Answer], pd.DataFrame]


def headline(answer: Answer) -> str:
    """Answer in one sentence."""
    return _FACES[answer.sought.name].headline(answer)


def _basis_of_size(answer):
    """What a size to build promises and rests on."""
    basis = [words.contains(answer), *words.by_test_beams(answer)]
    return [words.promise(answer), *basis] if np.isfinite(answer.build) and not words.reasons(answer) else basis


def _points_of_size(answer, section):
    """What decides about a size, what to change and what to measure."""
    points = {"What decides": words.decides(answer), "What to change": change(answer, section)}
    return points | {"What to measure": words.measure(answer)}


def change(answer: Answer, section: Mapping[str, Any]) -> str:
    """Sizes for a safe given length, or the effect of sizes on the length."""
    if answer.sought.more_is_better:
        if not np.isfinite(answer.build):
            return "Compute more patches: contact.samples."
        if answer.is_enough and not answer.is_enough_between:
            safe, air = answer.in_words(answer.between.safe), f"{answer.between.humidity:.2g}"
            return f"A restoring force of {safe} suffices between these airs, too; add RH {air} to know it better."
        return "Nothing." if answer.is_enough else f"A restoring force of {words.to_build(answer)}."
    if section.get("residual_stress_MPa", 0):
        return (
            "A thicker beam, a wider gap or more tension lets longer bridges release; key chart computes the first two."
        )
    if np.isnan(answer.size) or answer.is_enough or words.reasons(answer):
        thicker, wider = (100 * (1.1**power - 1) for power in (_OF_THICKNESS, _OF_GAP))
        return f"10 % more thickness allow {thicker:.0f} % more length, 10 % more gap {wider:.0f} %."
    thickness, gap = (
        section[key] * (answer.size / answer.build) ** (1 / power)
        for key, power in (("thickness_um", _OF_THICKNESS), ("gap_um", _OF_GAP))
    )
    return (
        f"For {answer.size / UM:g} µm, by the power law of Eq. (13): a thickness of {thickness:.3g} µm or a gap of "
        f"{gap:.3g} µm. Compute the new device before you build it."
    )


_OF_SIZE = _Face(words.headline, _basis_of_size, _points_of_size, lambda answer: pd.DataFrame(words.of_airs(answer)))
#: By the number that is sought.
_FACES = {
    LENGTH.name: _OF_SIZE,
    FORCE.name: _OF_SIZE,
    PULL_OFF.name: _Face(places.headline, places.basis, places.points, places.cells),
}

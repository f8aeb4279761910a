"""First screen of the page of a device: one number, its probability, what it contains, and what to do."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from stiction.answer.data import Answer
from stiction.report.answer import words
from stiction.report.format import MISSING, UM
from stiction.report.page import Summary

#: Powers of thickness and gap in the length that sticks at an adhesion energy, of beams without tension; Eq. (13).
_OF_THICKNESS, _OF_GAP = 3 / 4, 1 / 2


def screen(answer: Answer, section: Mapping[str, Any], forbidding: Sequence[str], of_model: str) -> Summary:
    """First screen of a device.

    Its section of the configuration, the sentences of the limits that forbid a number, and one on the error of the
    model.
    """
    points = {"What decides": words.decides(answer)}
    points |= {} if "measured_nN" in section else {"What to change": change(answer, section)}
    points["What to measure"] = words.measure(answer)
    cells = pd.DataFrame(words.of_airs(answer))
    if words.is_forbidden(answer):
        said = " ".join(forbidding)
        cells = cells.assign(**dict.fromkeys(cells.columns[1:], MISSING))
        points = {"What to measure": points["What to measure"]}
        missing = "the warning above forbids to rely on one"
        return Summary("bad", words.NO_NUMBER, said, (), points, cells, missing, is_forbidden=True)
    basis = [words.contains(answer), *words.by_test_beams(answer), of_model]
    basis = [words.promise(answer), *basis] if np.isfinite(answer.build) and not words.reasons(answer) else basis
    return Summary(*words.sign_of(answer), words.headline(answer), list(filter(None, basis)), points, cells)


def change(answer: Answer, section: Mapping[str, Any]) -> str:
    """Sizes for a safe given length, or the effect of sizes on the length."""
    if answer.sought.more_is_better:
        if not np.isfinite(answer.build):
            return "Compute more patches: contact.samples."
        return "Nothing." if answer.is_enough else f"A restoring force of {answer.in_words(answer.build)}."
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

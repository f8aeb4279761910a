"""Answer about a probe without a spring in words: what places hold, and whether a measured force fits them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from stiction.answer.data import Answer, Probability, PullOff, Verdict
from stiction.devices.probes import UNLIKELY
from stiction.report.answer import words
from stiction.report.format import MISSING, NN, airs, humidity_text, with_error
from stiction.rounding import in_percent

#: What to do about each verdict.
_CHANGE = {
    Verdict.PLACES: "State measured_nN and measured_error_nN to ask whether a measurement fits.",
    Verdict.FITS: "Nothing.",
    Verdict.UNDECIDED: "More places, contact.samples, or inputs that are known better.",
    Verdict.MISFIT: "Look for the cause: radius, surfaces, air, coating. State what you do not know as uncertainty.",
}
_TOO_UNCERTAIN = "The inputs are too uncertain to decide."


def headline(answer: Answer) -> str:
    """Rank of the measured force among places, or what these hold."""
    if answer.verdict is Verdict.PLACES:
        return _distribution(answer.pull_off, len(answer.pull_offs) > 1)
    forces = answer.pull_off
    measured = f"{with_error(answer.size / NN, forces.error / NN)} nN"
    too_uncertain = f" {_TOO_UNCERTAIN}" * bool(answer.forbidden)
    return (
        f"Measured {measured}: {in_words(forces.less)} of such measurements give this or less, {in_words(forces.more)} "
        f"this or more; two-sided, {in_words(forces.two_sided)}.{too_uncertain}"
    )


def basis(answer: Answer) -> list[str]:
    """What the answer rests on."""
    sentences = [] if answer.verdict is Verdict.PLACES else [_distribution(answer.pull_off)]
    return [*sentences, words.contains(answer)]


def points(answer: Answer, _section: Mapping[str, Any]) -> dict[str, str]:
    """What decides, what to change and what to measure."""
    points_in_words = {"What to change": _CHANGE[answer.verdict]}
    if answer.verdict is not Verdict.PLACES:
        decides = (
            f"A force does not fit if its two-sided probability is below {in_percent(UNLIKELY)}, with the whole band"
        )
        points_in_words = {
            "What decides": f"{decides} of the simulation. Bands of the others contain the errors of the inputs."
        } | points_in_words
    return points_in_words | {"What to measure": words.measure(answer)}


def cells(answer: Answer) -> pd.DataFrame:
    """Table of the first screen, a row for each air."""
    return pd.DataFrame([_row(forces) for forces in answer.pull_offs])


def _row(forces):
    """Row of one air."""
    low, median, high = forces.quantiles / NN
    row = {"RH": humidity_text(forces.humidity), "median [nN]": with_band(*median)}
    row |= {"5 % [nN]": with_band(*low), "95 % [nN]": with_band(*high)}
    ranks = {"P(measured or less)": forces.less, "P(measured or more)": forces.more, "two-sided": forces.two_sided}
    return row | {title: in_words(rank) for title, rank in ranks.items() if rank}


def _distribution(forces: PullOff, is_worst: bool = False) -> str:
    """Forces of the places in one air."""
    where = f"{airs([forces.humidity])}{', where they hold most' * is_worst}"
    low, median, high = (with_band(*force).replace(" (", " nN (") for force in forces.quantiles / NN)
    return f"Half of all places hold more than {median} {where}; nine of ten between {low} and {high}."


def in_words(probability: Probability) -> str:
    """Probability with its band, of none or all that were sampled the band alone."""
    if probability.value < words.LEAST:
        return f"at most {words.percent(probability.high, 'high')}"
    if probability.value > 1 - words.LEAST:
        return f"at least {words.percent(probability.low, 'low')}"
    return words.stuck_in_words(probability)


def with_band(*numbers: float) -> str:
    """Force with the ends of its band, all in one unit, – without one.

    Examples
    --------
    >>> with_band(1636.2, 1500.1, 1799.7), with_band(*[float("nan")] * 3)
    ('1640 (1500 to 1800)', '–')
    """
    if np.isnan(numbers).any():
        return MISSING
    return "{} ({} to {})".format(*(f"{float(f'{number:.3g}'):g}" for number in numbers))

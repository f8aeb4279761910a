"""First screen of the page of a device: answer, its cause, advice on changes and measurements, and one table."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from stiction.config.cases import Air
from stiction.devices import limits
from stiction.devices.risk import one_in
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import sentences
from stiction.report.format import MISSING, UM, UN, airs, fraction_with_band, humidity_text, number, with_error
from stiction.report.page import FORBIDDEN, Summary
from stiction.report.test_beams.tables import contradiction, is_reliable, updated_size
from stiction.rounding import in_percent
from stiction.stages.devices.budget import budget_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import EITHER, S_SHAPE
from stiction.stages.devices.stoppers import shares_stuck

#: Powers of thickness and gap in the length that sticks at an adhesion energy, of beams without tension; Eq. (13).
_OF_THICKNESS, _OF_GAP = 3 / 4, 1 / 2
_MEASURE = "What to measure"
#: How to learn what to measure where no uncertainty is stated.
_UNSTATED = "State the uncertainties of the inputs in section uncertainty: the budget then says what to measure better."


def beam_screen(
    section: Mapping[str, Any],
    safe_lengths: Mapping[float, xr.Dataset],
    budgets: Mapping[tuple, xr.Dataset],
    warnings: Sequence[str],
    test_beams: xr.Dataset | None = None,
) -> Summary:
    """First screen of a cantilever or bridge.

    Section of the configuration, humidity to the dataset of stage safe_lengths, budgets as on its page, all warnings
    and, if there are test beams, the dataset of stage test_beams_rerun, whose length then is the answer.
    """
    least, total, safe = sentences.length_to_build(safe_lengths, budgets)
    updated = updated_size(test_beams)
    safe = updated[1] * UM if updated else safe
    humidity, worst = min(safe_lengths.items(), key=lambda case: float(_middle_lengths(case[1]).safe_length.min()))
    point = _middle_lengths(worst).isel(shape=-1)
    verdict, margin = _verdict(section.get("length_um"), safe / UM, safe_lengths), _subtracted(total, safe / least)
    if not updated and not sentences.is_bounded(total):
        verdict = _unbounded(verdict, sentences.unbounded_sentence(least, total))
        margin, safe = _subtracted(0.0, 1.0), least
    estimate = with_error(float(point.estimate) / UM, float(np.hypot(point.beams_error, _finite(point))) / UM)
    where = Air(humidity).where + ", the worst" * (len(safe_lengths) > 1)
    basis = [
        f"At most {one_in(float(point.share))} sticks {airs(safe_lengths)}, with 95 % confidence, from "
        f"{int(worst.beams)} simulated beams at each humidity.",
        f"Estimate {where}: {estimate} µm (standard error of the simulation)."
        if np.isfinite(point.estimate)
        else f"{where[0].upper()}{where[1:]}, too few beams stick for an estimate.",
        _by_test_beams(updated, "µm", ".0f") if updated else margin,
    ]
    points = {
        "What decides": " ".join(_decides_beam(humidity, worst, budgets, section)),
        "What to change": _change_beam(section, safe / UM),
        _MEASURE: _measure(sentences.shortest_budgets(safe_lengths, budgets).values()),
    }
    summary = Summary(*verdict, basis, points, _table_of_beam(safe_lengths, budgets, test_beams))
    return _unless_forbidden(summary, warnings, test_beams)


def _subtracted(total, left):
    """What is left of the safe length for an uncertainty of the measurements."""
    if not total:
        return "Nothing is subtracted for the measurements."
    return f"Subtracted for the measurements: {in_percent(1 - left)}, twice their standard uncertainty."


def _added(total, times):
    """What is added to the sufficient force for an uncertainty of the measurements, as in `_subtracted`."""
    if not total:
        return "Nothing is added for the measurements."
    return f"Added for the measurements: {in_percent(times - 1)}, twice their standard uncertainty."


def _by_test_beams(updated, unit, form):
    """What the answer from test beams contains, and the answer without them."""
    return (
        "By the test beams, with twice the uncertainty of the inputs and of the model, as far as they show it. Without "
        f"the test beams: {number(updated[0], form)} {unit}."
    )


def _air(humidity):
    """Air, for the beginning of a sentence."""
    return Air(humidity).words if humidity else "Dry air"


def _middle_lengths(dataset):
    """Lengths for the middle one of the shares, by shape."""
    return dataset.isel(share=dataset.sizes["share"] // 2)


def _finite(point):
    """Standard error due to the number of surfaces, zero if it is part of the beams' error."""
    return point.surfaces_error.fillna(0)


def _verdict(length, safe, safe_lengths):
    """Tone, sign and answer for a device of a length, or for any [µm]."""
    answer = f"Safe up to {safe:.0f} µm"
    if length is None:
        return "good", "Length to build", f"{answer}."
    cases = {humidity: dataset.isel(shape=-1) for humidity, dataset in safe_lengths.items()}
    humidity, worst = max(cases.items(), key=lambda case: float(case[1].stuck_at_length.sel(end="high")))
    stuck, low, high = map(float, worst.stuck_at_length)
    if length <= safe:
        sign = "good", "Safe"
    else:
        sign = ("bad", "Too long") if low > float(_middle_lengths(worst).share) else ("open", "Not shown to be safe")
    return *sign, f"{answer}; your {length:g} µm: {_stuck_with_band(stuck, low, high)} {Air(humidity).where}."


def _unbounded(verdict, sentence):
    """Verdict with a sentence in place of the length to build. A length that is too long stays too long."""
    tone, sign, answer = verdict
    own = answer.partition("; ")[-1]
    return *((tone, sign) if tone == "bad" else ("open", "Not known")), f"{sentence} {own[:1].upper()}{own[1:]}".strip()


def _stuck_with_band(stuck, low, high):
    """Fraction stuck with its band of 95 % confidence."""
    return f"{fraction_with_band(stuck, low, high, ' %')} stick"


def _decides_beam(humidity, worst, budgets, section):
    """Humidity and end state of the shortest safe length, and a decisive assumed input."""
    lengths = _middle_lengths(worst).safe_length
    shape = str(lengths["shape"].values[int(lengths.argmin("shape"))])
    yield f"{_air(humidity)}, held by the {END_STATES[shape].by}."
    if shape == EITHER:
        yield f"If the tip could not touch: {sentences.built_in_words(worst, budgets, 0).rstrip(',')}."
    yield from tables_budget.first_to_measure(budgets.values(), section.get("assumed", ()))


def _change_beam(section, safe):
    """Sizes for a safe given length, or the effect of sizes on the safe length [µm]."""
    length = section.get("length_um")
    if section.get("residual_stress_MPa", 0):
        return (
            "A thicker beam, a wider gap or more tension lets longer bridges release; key chart computes the first two."
        )
    if length is None or length <= safe:
        thicker, wider = (100 * (1.1**power - 1) for power in (_OF_THICKNESS, _OF_GAP))
        return f"10 % more thickness allow {thicker:.0f} % more length, 10 % more gap {wider:.0f} %."
    thickness, gap = (
        section[key] * (length / safe) ** (1 / power)
        for key, power in (("thickness_um", _OF_THICKNESS), ("gap_um", _OF_GAP))
    )
    return (
        f"For {length:g} µm, by the power law of Eq. (13): a thickness of {thickness:.3g} µm or a gap of {gap:.3g} µm. "
        "Compute the new device before you build it."
    )


def _measure(budgets: Iterable[xr.Dataset]) -> str:
    """Advice of the most uncertain budget."""
    stated = [dataset for dataset in budgets if budget_of(dataset).total != 0]
    if not stated:
        return _UNSTATED
    return tables_budget.what_to_measure(max(stated, key=lambda dataset: np.nan_to_num(budget_of(dataset).total)))


def _table_of_beam(safe_lengths, budgets, test_beams):
    """Safe lengths by humidity, with and without tip and test beams, and P(stuck) at the stated length.

    They are less the margin for the measurements.
    """
    rows = []
    for humidity, dataset in safe_lengths.items():
        lengths = sentences.lengths_to_build(dataset, budgets)
        row = {"RH": humidity_text(humidity), "safe length [µm]": number(float(lengths[-1]) / UM, ".0f")}
        if EITHER in lengths["shape"].values:
            row["if the tip cannot touch [µm]"] = number(float(lengths.sel(shape=S_SHAPE)) / UM, ".0f")
        if test_beams is not None:
            row["with test beams [µm]"] = number(_with_test_beams(test_beams, humidity) / UM, ".0f")
        if "length_of_device" in dataset:
            at = f"P(stuck) at {float(dataset.length_of_device) / UM:g} µm [%]"
            row[at] = fraction_with_band(*map(float, dataset.isel(shape=-1).stuck_at_length))
        rows.append(row)
    return pd.DataFrame(rows)


def _with_test_beams(update, humidity):
    """Safe length after test beams, less as much as the answer is [m]; NaN if none is stated."""
    if not (updated := updated_size(update)) or humidity not in update.humidity:
        return np.nan
    lengths = _middle_lengths(update).updated_safe
    return float(lengths.sel(humidity=humidity).min()) * updated[1] * UM / float(lengths.min())


def stopper_screen(
    section: Mapping[str, Any],
    stopper: xr.Dataset,
    budgets: Mapping[tuple, xr.Dataset],
    warnings: Sequence[str],
    test_beams: xr.Dataset | None = None,
) -> Summary:
    """First screen of a stopper: its section, dataset of stage stoppers, budgets, warnings, and perhaps test beams."""
    force, share = float(stopper.restoring_force), sentences.bounded_share(stopper)
    humidity, *stuck = max(shares_stuck(stopper), key=lambda row: row[1:])
    least, total, needed = sentences.force_to_build(stopper, budgets)
    updated = None if share is None else updated_size(test_beams)
    needed = updated[1] * UN if updated else needed
    own = f"with {force / UN:g} µN, {_stuck_with_band(*stuck)} {Air(humidity).where}"
    verdict, margin = (
        _verdict_on_force(force, needed, share, stuck[1], own),
        _added(total if share else 0.0, needed / least),
    )
    if not updated and share and not sentences.is_bounded(total):
        verdict = _unbounded(verdict, sentences.unbounded_force_sentence(least, total))
        margin, needed = _added(0.0, 1.0), least
    basis = [
        f"At most {one_in(share)} sticks {airs(stopper.humidity.values)}, with 95 % confidence." if share else "",
        f"From {stopper.sizes['sample']} simulated patches at each humidity.",
        _by_test_beams(updated, "µN", ".3g") if updated else margin,
    ]
    change = f"A restoring force of at least {needed / UN:.3g} µN." if force < needed else "Nothing in these airs."
    points = {
        "What decides": " ".join(
            [
                f"{_air(sentences.worst_air(stopper))}, where it is held most.",
                *tables_budget.first_to_measure(budgets.values(), section.get("assumed", ())),
            ]
        ),
        "What to change": change if share else "Compute more patches: contact.samples.",
        _MEASURE: _measure(budgets.values()),
    }
    cells = _table_of_stopper(stopper, share)
    return _unless_forbidden(Summary(*verdict, list(filter(None, basis)), points, cells), warnings, test_beams)


def _verdict_on_force(force, needed, share, least_stuck, own):
    """Tone, sign and answer for a restoring force, if ``needed`` leaves at most a share stuck [N]."""
    if share is None:
        return "open", "Not known", f"There are too few patches to bound a force; {own}."
    weak = ("bad", "Too weak") if least_stuck > share else ("open", "Not shown to suffice")
    sign = ("good", "Suffices") if force >= needed else weak
    return *sign, f"At least {needed / UN:.3g} µN needed; {own}."


def _table_of_stopper(stopper, share):
    """P(stuck) and the force needed by humidity."""
    rows = []
    for humidity, *stuck in shares_stuck(stopper):
        row = {"RH": humidity_text(humidity), "P(stuck) [%]": fraction_with_band(*stuck)}
        if share is not None:
            safe = stopper.safe_force.sel(part="safe", share=share, humidity=humidity)
            row[f"force for {one_in(share)} [µN]"] = number(float(safe) / UN, ".3g")
        rows.append(row)
    return pd.DataFrame(rows)


def _unless_forbidden(summary: Summary, warnings: Sequence[str], test_beams: xr.Dataset | None) -> Summary:
    """Summary with a warning in place of its number, if one forbids relying on it, or test beams contradict it."""
    contradicted = test_beams is not None and not is_reliable(test_beams)
    forbidding = [contradiction(test_beams)] if contradicted else []
    forbidding += filter(limits.forbids, warnings)
    if not forbidding:
        return summary
    points = {_MEASURE: summary.points[_MEASURE]}
    cells = summary.cells.assign(**dict.fromkeys(summary.cells.columns[1:], MISSING))
    return Summary(
        "bad", FORBIDDEN, " ".join(forbidding), (), points, cells, "the warning above forbids to rely on one"
    )

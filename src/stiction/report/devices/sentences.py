"""Sentences on the pages of devices: the length to build, the sufficient force, and devices stuck in each air."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.config.units import to_si
from stiction.devices import limits
from stiction.devices.budget import LARGEST, SUBTRACTED, part_left
from stiction.devices.risk import Basis, one_in, samples_for
from stiction.report.format import UM, UN, airs, fraction_with_band, with_error
from stiction.rounding import in_percent
from stiction.stages.devices.budget import budget_of, margin_of_shape
from stiction.stages.devices.opening import BEAMS, EITHER, S_SHAPE
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import bounded_share, ends, in_any_air, is_at_an_end, shares_stuck


def length_to_build(
    safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]
) -> tuple[float, float, float]:
    """Least safe length [m], uncertainty of its logarithm due to the measurements, and the length less twice it [m].

    Of all end states, the one with the shortest length after its margin decides: what holds a beam in one holds it in
    the last. The uncertainty is that which takes as much of the least length, unless its own is too large.
    """
    each = xr.concat(map(safe_lengths_of, safe_lengths.values()), "humidity", join="exact").min("humidity")
    totals = np.array([margin_of_shape(budgets, shape) for shape in map(str, each["shape"].values)])
    built, least = each.values * np.exp(-SUBTRACTED * totals), float(each.min())
    length, own = float(built.min()), float(totals[built.argmin()])
    total = float(np.log(least / length)) / SUBTRACTED if is_bounded(own) else own
    return least, total, float(np.exp(-SUBTRACTED * total)) * least


def lengths_to_build(dataset: xr.Dataset, budgets: Mapping[tuple, xr.Dataset]) -> xr.DataArray:
    """Safe lengths for the chosen share, by shape, less the margin of `length_to_build`, NaN where it is too large [m].

    A beam is no longer than what any end state before its own allows.
    """
    lengths, left = safe_lengths_of(dataset), parts_left(dataset, budgets)
    return lengths.copy(data=np.fmin.accumulate(lengths.values * list(left.values())))


def parts_left(dataset: xr.Dataset, budgets: Mapping[tuple, xr.Dataset]) -> dict[str, float]:
    """Parts of the safe lengths of a dataset that the margin leaves, by shape, NaN where it is too large [-]."""
    return {shape: part_left(margin_of_shape(budgets, shape)) for shape in map(str, dataset["shape"].values)}


def is_bounded(total: float) -> bool:
    """Whether an uncertainty of the logarithm of a length allows a length to build."""
    return total <= LARGEST


def unbounded_sentence(least: float, total: float) -> str:
    """Safe length [m] without a margin, where the uncertainty due to the measurements allows none."""
    return (
        f"If the measurements were exact, {least / UM:.0f} µm would be safe. They leave it uncertain by "
        f"{in_percent(total)}, too much for a length to build: first measure better."
    )


def build_sentence(safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]) -> str:
    """Length to build for all humidities of a device, for the middle fraction.

    It is the least safe length, less twice the largest uncertainty of what holds the shortest devices, if any is known.

    Parameters
    ----------
    safe_lengths, budgets : dict
        As in `stiction.report.devices.pages.beam_page`.
    """
    least, total, length = length_to_build(safe_lengths, budgets)
    totals = [budget_of(budget).total for budget in shortest_budgets(safe_lengths, budgets).values()]
    few = one_in(chosen_share(_any(safe_lengths)))
    if not is_bounded(total):
        return unbounded_sentence(least, total)
    sentence = (
        f"Build it no longer than {length / UM:.0f} µm: then at most {few} sticks "
        f"{airs(safe_lengths)} (95 % confidence)."
    )
    if not np.isfinite(totals).all():
        sentence += " What the measurements leave uncertain is not known, because too few of the simulated beams stick."
    elif total == 0:
        sentence += " No uncertainty of the measurements is subtracted, because none is stated."
    if total == 0:
        return sentence
    less = in_percent(1 - length / least)
    return (
        f"{sentence} The shortest safe length, {least / UM:.0f} µm, is reduced by {less}, twice the uncertainty due to "
        "the measurements."
    )


def shortest_warnings(
    section: Mapping[str, Any],
    safe_lengths: Mapping[float, xr.Dataset],
    budgets: Mapping[tuple, xr.Dataset],
    with_test_beams: float | None = None,
) -> list[str]:
    """Warnings about the shortest length that a page states, if it is below all safe lengths, whose warnings it has.

    It is the length to build, that with test beams [m] in its place, or the device's own.
    """
    least, total, built = length_to_build(safe_lengths, budgets)
    own = to_si(section.get("length_um", math.inf), "um")
    stated = with_test_beams or (built if is_bounded(total) else least)
    if (shortest := min(stated, own)) >= least:
        return []
    sizes = (to_si(section[key], "um") for key in ("gap_um", "width_um", "thickness_um"))
    return limits.length_warnings(*sizes, shortest / BEAMS[section["kind"]].arms)


def _any(safe_lengths):
    """One of the datasets of a device. All have the same shares and shapes."""
    return next(iter(safe_lengths.values()))


def force_to_build(stopper: xr.Dataset, budgets: Mapping[tuple, xr.Dataset]) -> tuple[float, float, float]:
    """Sufficient force at all humidities of a stopper [N], uncertainty of its logarithm, and the force with twice it.

    For the smallest fraction with a bound from its patches; NaN without one. As `length_to_build`.
    """
    share = bounded_share(stopper)
    needed = np.nan if share is None else float(stopper.safe_force.sel(part="safe", share=share).max(skipna=False))
    total = max(filter(np.isfinite, (budget_of(budget).total for budget in budgets.values())), default=0.0)
    return needed, total, float(np.exp(2 * total)) * needed


def worst_air(stopper: xr.Dataset) -> float:
    """Stated humidity of the largest sufficient force, or of the largest mean force without a bound [-]."""
    share = bounded_share(stopper)
    stated = stopper.pull_off.mean("sample") if share is None else stopper.safe_force.sel(part="safe", share=share)
    return float(stopper.humidity[int(np.argmax(stated.values))])


def unbounded_force_sentence(needed: float, total: float) -> str:
    """Sufficient force [N] without a margin, where the uncertainty due to the measurements allows none."""
    return (
        f"If the measurements were exact, {needed / UN:.3g} µN would suffice. They leave it uncertain by "
        f"{in_percent(total)}, too much for a force to build: first measure better."
    )


def safe_lengths_of(dataset: xr.Dataset) -> xr.DataArray:
    """Safe lengths for the chosen share, by shape [m]."""
    return dataset.safe_length.sel(share=chosen_share(dataset))


def shortest_budgets(
    safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]
) -> dict[tuple, xr.Dataset]:
    """Budgets of the shortest stuck devices: of tips, if there are tips."""
    of_tips = EITHER in _any(safe_lengths)["shape"].values
    return {key: budget for key, budget in budgets.items() if ("tip" in key) == of_tips}


def verdict(stopper: xr.Dataset, budgets: Mapping[tuple, xr.Dataset]) -> str:
    """Answer on the restoring force of a stopper, for the smallest fraction with a bound from its patches.

    It has to exceed what is needed by twice the uncertainty due to the measurements.
    """
    force, where, share = float(stopper.restoring_force), airs(stopper.humidity.values), bounded_share(stopper)
    if share is None:
        return _verdict_of_few(stopper)
    needed, total, enough = force_to_build(stopper, budgets)
    head = f"The restoring force of {force / UN:g} µN"
    tail = f"at most {one_in(share)} sticks (95 % confidence, given the drawn surfaces)."
    if force < needed:
        return f"{head} does not suffice {where}: a larger one is needed if {tail}"
    if not is_bounded(total):
        return unbounded_force_sentence(needed, total)
    more = f" {in_percent(enough / needed - 1)} are added, twice the uncertainty due to the measurements." * (total > 0)
    if force < enough:
        return f"{head} is not shown to suffice {where}: {enough / UN:.3g} µN are needed if {tail}{more}"
    tail += more
    if force < enough / needed * float(in_any_air(stopper)[1].sel(share=share)):
        return f"{head} suffices {where}, but not at all{_range(stopper)}: {tail}"
    if not ends(stopper):
        return f"{head} suffices {where}: {tail}"
    dry = "in dry air and " * bool(stopper.axis[0] == 0)
    return f"{head} suffices {dry}at all relative humidities{_range(stopper)}: {tail}"


def _verdict_of_few(stopper):
    """Answer with too few patches to bound any of the fractions from above."""
    (humidity, _, low, _), share = max(shares_stuck(stopper), key=lambda row: row[2]), float(stopper.share.max())
    if low <= share:
        return "There are too few patches to say whether the restoring force suffices."
    where, force = airs([humidity]), float(stopper.restoring_force)
    return (
        f"The restoring force of {force / UN:g} µN does not suffice {where}: at least {100 * low:.3g} % of the "
        "stoppers stick (95 % confidence, given the drawn surfaces)."
    )


def safe_sentence(humidity: float, dataset: xr.Dataset, budgets: Mapping[tuple, xr.Dataset]) -> str:
    """Safe lengths of a device at one humidity in words, for the middle fraction, less the margin of its budgets."""
    shortest, few = built_in_words(dataset, budgets, -1), one_in(chosen_share(dataset))
    sentence = (
        f"{_at(humidity)}, devices of up to {shortest} come free after they were pressed down, except for at most "
        f"{few} (95 % confidence)."
    )
    alone, safe = built_in_words(dataset, budgets, 0), safe_lengths_of(dataset)
    if alone != shortest:
        sentence += f" If the tip cannot hold them, this is true of up to {alone}."
    if lengths_to_build(dataset, budgets).equals(safe):
        return sentence
    return f"{sentence} Twice the uncertainty due to the measurements is subtracted."


def built_in_words(dataset: xr.Dataset, budgets: Mapping[tuple, xr.Dataset], shape: int) -> str:
    """Safe length against an end state, by its place, less its margin, or without one that is too large."""
    built = float(lengths_to_build(dataset, budgets)[shape])
    if np.isfinite(built):
        return f"{built / UM:.0f} µm"
    return f"{float(safe_lengths_of(dataset)[shape]) / UM:.0f} µm, if the measurements were exact,"


def prediction_sentences(safe_lengths: Mapping[float, xr.Dataset]) -> list[str]:
    """Prediction interval of the shortest length held by the beam, for the middle fraction, or nothing without one."""
    held = {
        humidity: one.sel(shape=S_SHAPE, share=chosen_share(one))
        for humidity, one in safe_lengths.items()
        if "prediction_low" in one
    }
    known = {humidity: one for humidity, one in held.items() if np.isfinite(one.prediction_low)}
    if not known:
        return []
    humidity, one = min(known.items(), key=lambda case: float(case[1].estimate))
    low, high = (f"{float(end) / UM:.0f}" for end in (one.prediction_low, one.prediction_high))
    error = np.hypot(one.beams_error, one.surfaces_error.fillna(0))
    estimate = with_error(float(one.estimate) / UM, float(error) / UM)
    return [
        f"{_at(humidity)}, {one_in(float(one.share))} sticks along its beam at a length of {estimate} µm (standard "
        "error of the simulation). If this model errs on your pair as it does on the paper's, this length lies between "
        f"{low} and {high} µm (95 %). No safe length is changed by it. The paper measured no tips, bridges or stoppers "
        "and nothing in dry air."
    ]


def few_sentences(safe_lengths: Mapping[float, xr.Dataset]) -> list[str]:
    """Largest fractions of stuck devices, at each humidity with hardly any stuck."""
    return [few_sentence(humidity, one) for humidity, one in safe_lengths.items() if _few_stick(one)]


def _few_stick(dataset):
    """Whether the safe length of the chosen fraction is as long as the simulated devices, or as on flat surfaces."""
    return dataset.basis.sel(share=chosen_share(dataset)).values[-1] in (Basis.LONGEST, Basis.FLAT)


def few_sentence(humidity: float, dataset: xr.Dataset) -> str:
    """Largest fraction of stuck devices at one humidity, in words, if so few stick that no smaller one is known."""
    held, number, share = dataset.isel(shape=-1), int(dataset.beams), chosen_share(dataset)
    shortest, most, reach = float(held.shortest), float(held.most_stuck), float(held.reach)
    none = f"shorter than {shortest / UM:.0f} µm " if np.isfinite(shortest) else ""
    sentence = (
        f"{_at(humidity)}, hardly any device sticks: none of the {number} simulated ones {none}does, and at most "
        f"{in_percent(most)} of those of {reach / UM:.0f} µm (95 % confidence, given the drawn surfaces)."
    )
    if str(held.basis.sel(share=share).values) == Basis.LONGEST:
        return sentence
    return (
        f"{sentence} For {one_in(share)}, the length that sticks on flat surfaces counts; {samples_for(share)} "
        "devices in design.beams show whether longer ones are safe."
    )


def stuck_sentence(humidity: float, stuck: float, low: float, high: float, force: float) -> str:
    """P(stuck) of a stopper at one humidity in words, with its restoring force [N].

    Examples
    --------
    >>> stuck_sentence(0.67, 0.012, 0.01, 0.015, 20e-6)
    'At a relative humidity of 0.67, 1.2 % (1 to 1.5 %) of the stoppers hold more than the restoring force of 20 µN.'
    """
    share = fraction_with_band(stuck, low, high, " %")
    return f"{_at(humidity)}, {share} of the stoppers hold more than the restoring force of {force / UN:g} µN."


#: What a safe force rests on.
_ON = {
    Basis.SAMPLED: "95 % confidence",
    Basis.FITTED: "95 % confidence, by a line through the largest 5 % of the forces",
    Basis.EXTRAPOLATED: "extrapolated, by a line through the largest 5 % of the forces beyond what was verified",
}


def safe_force_sentences(stopper: xr.Dataset) -> list[str]:
    """Sufficient restoring forces at the humidities of a stopper, and in any air of its fine axis.

    For the shares that its patches can bound.
    """
    stated = stopper.safe_force.sel(part="safe").max("humidity").assign_coords(basis=stopper.basis)
    where = "At all these humidities" if stopper.sizes["humidity"] > 1 else _at(float(stopper.humidity[0]))
    return [
        f"{where}, a restoring force of {float(force) / UN:.3g} µN leaves at most "
        f"{one_in(float(force.share))} stuck ({_ON[str(force.basis.values)]})"
        + (f"; at any humidity{_range(stopper)}, {float(more) / UN:.3g} µN are needed." if ends(stopper) else ".")
        for force, more in zip(stated, in_any_air(stopper)[1], strict=True)
        if np.isfinite(force)
    ]


def worst_sentence(stopper: xr.Dataset) -> str:
    """Worst humidity of a stopper in words."""
    worst = float(stopper.worst_humidity)
    share, *band = in_any_air(stopper)[0]
    stuck = f" In the worst air of this range, {fraction_with_band(share, *band, ' %')} stick." if share < 1 else ""
    if is_at_an_end(stopper):
        low, high = ends(stopper)
        return f"Between relative humidities of {low:g} and {high:g}, the stopper holds most at {worst:g}.{stuck}"
    if not worst:
        return f"The stopper holds most in dry air; humid air{_range(stopper)} is less critical.{stuck}"
    return (
        f"The stopper holds most at a relative humidity of {worst:.2f}; drier and wetter air,{_range(stopper)}, "
        f"are less critical.{stuck}"
    )


def _range(stopper):
    """Range of humidities in the search of the worst, in words."""
    low, high = ends(stopper)
    return f" from {low:g} to {high:g}"


def _at(humidity):
    """One humidity, for the beginning of a sentence."""
    return airs([humidity]).capitalize()

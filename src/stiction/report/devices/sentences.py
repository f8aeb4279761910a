"""Sentences on the pages of devices: the length to build, the sufficient force, and devices stuck in each air."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.answer.data import Answer, Cause
from stiction.config.units import to_si
from stiction.contact.air import is_humid
from stiction.devices.limits import rules
from stiction.devices.limits.limit import Limit
from stiction.devices.risk import Basis, one_in, samples_for
from stiction.life.freeing import probability_for
from stiction.report.answer.words import CAUSES
from stiction.report.format import UM, UN, airs, bounding, fraction_with_band, listed, safe_size, with_error
from stiction.rounding import grouped
from stiction.stages.devices.opening import BEAMS, S_SHAPE
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import ends, in_any_air, is_at_an_end


def shortest_warnings(section: Mapping[str, Any], answer: Answer) -> list[Limit]:
    """Limits of the length to build of a beam, or the stated one, if it is below all simulated limits.

    Those have limits of their own.
    """
    least = next(step.size for step in answer.steps if step.cause is Cause.SIMULATION)
    shortest = np.nanmin([answer.build, to_si(section.get("length_um", math.inf), "um")])
    if not shortest < least * (1 - 1e-9):
        return []
    sizes = (to_si(section[key], "um") for key in ("gap_um", "width_um", "thickness_um"))
    return rules.length_warnings(*sizes, shortest / BEAMS[section["kind"]].arms)


def prediction_sentences(safe_lengths: Mapping[float, xr.Dataset]) -> list[str]:
    """Prediction interval of the shortest length held by the beam, for the middle fraction, or nothing without one."""
    held = {
        humidity: dataset.sel(shape=S_SHAPE, share=chosen_share(dataset))
        for humidity, dataset in safe_lengths.items()
        if "prediction_low" in dataset
    }
    with_interval = {humidity: dataset for humidity, dataset in held.items() if np.isfinite(dataset.prediction_low)}
    if not with_interval:
        return []
    humidity, dataset = min(with_interval.items(), key=lambda case: float(case[1].estimate))
    low, high = (f"{float(end) / UM:.0f}" for end in (dataset.prediction_low, dataset.prediction_high))
    error = np.hypot(dataset.beams_error, dataset.surfaces_error.fillna(0))
    estimate = with_error(float(dataset.estimate) / UM, float(error) / UM)
    return [
        f"{_at(humidity)}, {one_in(float(dataset.share))} sticks along its beam at a length of {estimate} µm (standard "
        "error of the simulation). If this model errs on your pair as it does on the paper's, this length lies between "
        f"{low} and {high} µm (95 %). It is no part of the answer. The paper measured no tips, bridges or stoppers "
        "and nothing in dry air."
    ]


def few_sentences(safe_lengths: Mapping[float, xr.Dataset]) -> list[str]:
    """Largest fractions of stuck devices, at each humidity with hardly any stuck."""
    bases = {rh: dataset.basis.sel(share=chosen_share(dataset)).values[-1] for rh, dataset in safe_lengths.items()}
    return [few_sentence(rh, safe_lengths[rh]) for rh, basis in bases.items() if basis in (Basis.LONGEST, Basis.FLAT)]


def few_sentence(humidity: float, dataset: xr.Dataset) -> str:
    """Largest fraction of stuck devices at one humidity, in words, if so few stick that no smaller one is known."""
    held, number, share = dataset.isel(shape=-1), int(dataset.beams), chosen_share(dataset)
    shortest, most, reach = float(held.shortest), float(held.most_stuck), float(held.reach)
    none = f"shorter than {shortest / UM:.0f} µm " if np.isfinite(shortest) else ""
    sentence = (
        f"{_at(humidity)}, hardly any device sticks: none of the {number} simulated ones {none}does, and at most "
        f"{bounding(100 * most, 2, up=True)} % of those of {reach / UM:.0f} µm (95 % confidence, given "
        "the drawn surfaces)."
    )
    if str(held.basis.sel(share=share).values) == Basis.LONGEST:
        return sentence
    return (
        f"{sentence} For {one_in(share)}, the length that sticks on flat surfaces counts; {samples_for(share)} "
        "devices in design.beams show whether longer ones release."
    )


#: Relative difference of fractions at one touchdown that are read as the same.
_SAME = 0.01
#: What a simulated limit of a force rests on.
_ON = {
    Basis.SAMPLED: "95 % confidence",
    Basis.FITTED: "95 % confidence, by a line through the largest 5 % of the forces",
    Basis.EXTRAPOLATED: "extrapolated, by a line through the largest 5 % of the forces beyond what was verified",
}


def safe_force_sentences(stopper: xr.Dataset, answer: Answer) -> list[str]:
    """Simulated restoring forces that suffice at the humidities of a stopper, and in any air of its fine axis.

    For the shares that its patches can bound. That of the answer at each touchdown stands beside the force to build.
    """
    stated = stopper.safe_force.sel(part="safe").max("humidity").assign_coords(basis=stopper.basis)
    where = "at all these humidities" if stopper.sizes["humidity"] > 1 else airs([float(stopper.humidity[0])])
    return [
        f"By simulation alone, {where}, a restoring force of {_needed(force)} leaves at most "
        f"{one_in(float(force.share))} stuck at one touchdown ({_ON[str(force.basis.values)]})"
        + (f"; at any humidity{_range(stopper)}, {_needed(more)} are needed." if ends(stopper) else ".")
        + _beside_the_force_to_build(float(force.share), answer)
        for force, more in zip(stated, in_any_air(stopper)[1], strict=True)
        if np.isfinite(force)
    ]


def _beside_the_force_to_build(share, answer):
    """How a simulated limit for a fraction at one touchdown differs from the force to build, if this allows as many."""
    further = [CAUSES[cause][1] for cause in answer.included if cause not in (Cause.SIMULATION, Cause.TOUCHDOWNS)]
    is_same = math.isclose(share, probability_for(answer.share, answer.touchdowns), rel_tol=_SAME)
    if not is_same or answer.stays or answer.forbidden or not further or not np.isfinite(answer.build):
        return ""
    between = f" ({safe_size(answer.between.size, answer.sought)} between the stated airs)" if answer.between else ""
    each = f" at each of {grouped(answer.touchdowns)} touchdowns" * (answer.touchdowns > 1)
    build = f" The force to build, {safe_size(answer.build, answer.sought)}{between},"
    return f"{build} allows the same {one_in(share)}{each}, and counts {listed(further)} as well."


def _needed(force):
    """Restoring force that suffices, rounded up."""
    return f"{bounding(float(force) / UN, 3, up=True)} µN"


#: Reservation of the air of the largest mean.
_RARE = "The strictest air can be another one: the few places that hold most decide."


def worst_sentence(stopper: xr.Dataset) -> str:
    """Humidity of the largest mean force on a stopper, and the largest fraction stuck, in words."""
    worst = float(stopper.worst_humidity)
    share, *band = in_any_air(stopper)[0]
    stuck = (
        f" Where most stick in this range, {fraction_with_band(share, *band, ' %')} do at one touchdown."
        if share < 1
        else ""
    )
    if is_at_an_end(stopper):
        low, high = ends(stopper)
        between = f"Between relative humidities of {low:g} and {high:g}"
        return f"{between}, its mean force is largest at {worst:g}. {_RARE}{stuck}"
    if not is_humid(worst):
        return f"Its mean force is largest in dry air: larger than in humid air{_range(stopper)}. {_RARE}{stuck}"
    return (
        f"Its mean force is largest at a relative humidity of {worst:.2f}: larger than in drier and wetter air,"
        f"{_range(stopper)}. {_RARE}{stuck}"
    )


def _range(stopper):
    """Range of humidities in the search of the worst, in words."""
    low, high = ends(stopper)
    return f" from {low:g} to {high:g}"


def _at(humidity):
    """One humidity, for the beginning of a sentence."""
    return airs([humidity]).capitalize()

"""Sentences on sufficient settings of one process, and on sufficient pairs of settings of two."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from stiction.devices.risk import one_in
from stiction.devices.roughness import sufficient
from stiction.report.axes import axis
from stiction.report.axes.axis import axes_of
from stiction.stages.axes.recommended import ALL, settings_of_processes


def notes(curves: xr.Dataset, laws: Sequence[xr.Dataset]) -> list[str]:
    """Sentences on settings in contradiction to a law, and on points not computed or flagged."""
    sentences = [sentence for law in laws for sentence in str(law.flags.item()).splitlines()]
    if "second" not in curves.dims:
        return sentences + list(axis.notes(curves))
    second = axes_of(curves)[1]
    for value in second.values:
        begins = f"{second.words.capitalize()} {value:.6g}{second.unit}: "
        sentences += [begins + sentence for sentence in axis.notes(curves.sel(second=value))]
    return sentences


# One process


def answers(recommended: xr.Dataset, who: str) -> list[str]:
    """Sentences on the sufficient settings for a device or for all, the best one and the next to measure."""
    advice = recommended.sel(who=who)
    sentences = [briefly(recommended, who)]
    if np.isnan(float(advice.best)):
        return sentences
    along, crossed = axes_of(advice)[0], zip(advice.crossing.values, advice.crossing_error.values, strict=True)
    if places := [along.at(*crossing) for crossing in crossed if np.isfinite(crossing[0])]:
        sentences.append(f"The estimate meets the requirement exactly at {' and at '.join(places)}.")
    return sentences + best(advice) + following(advice)


def briefly(recommended: xr.Dataset, who: str) -> str:
    """Sentence on the sufficient settings and the best one."""
    advice = recommended.sel(who=who)
    along, ranges = axes_of(advice)[0], axes_of(advice)[0].ranges(advice.sufficient.values)
    if np.isnan(float(advice.best)):
        return (
            f"{_subject(who, 'Settings')} of the {along.words} that suffice are not known: too few could be computed."
        )
    share = "the allowed share of every device" if who == ALL else one_in(float(advice.share))
    most, of_mean = along.at(advice.best, advice.best_error), _mean_process(advice)
    if not ranges:
        span = f"{along.values[0]:g} to {along.values[-1]:g}{along.unit}"
        none = f"{_subject(who, 'No setting')} of the {along.words} from {span} is sure to leave at most {share} stuck"
        return f"{none} in the next run ({of_mean}); the best is {most}."
    settings = f"{_subject(who, 'Settings')} of the {along.words} from {' or '.join(ranges)}"
    return f"{settings} leave at most {share} stuck in the next run (95 % confidence; {of_mean}), best {most}."


def _mean_process(advice):
    """Settings that suffice for the mean process, beside those for the next run."""
    return f"mean process: {' or '.join(axes_of(advice)[0].ranges(advice.sufficient_mean.values)) or 'none'}"


def _subject(who, begins):
    """Beginning of a sentence, on all devices together or on one."""
    return f"All devices together: {begins[:1].lower()}{begins[1:]}" if who == ALL else begins


def best(advice: xr.Dataset) -> list[str]:
    """Interval of the best setting, and the reasons of its ends."""
    along, (low, high) = axes_of(advice)[0], map(float, advice.best_interval)
    first, last = along.values[[0, -1]]
    if low == high and low in (first, last) and not along.ranges(advice.sufficient.values):
        side = "below" if low == first else "above"
        return [f"The best setting is the end of the measured range: measure settings {side} {low:g}{along.unit}."]
    sentences = []
    if low < high:
        sentences.append(f"The best setting lies between {along.text(low)} and {along.at(high)} (95 %).")
    ends = [f"{end:g}{along.unit}" for end, near in ((first, low == first), (last, high == last)) if near]
    if ends:
        sentences.append(
            f"It may lie beyond {' or '.join(ends)}, where nothing was measured: nothing is said about settings there."
        )
    return sentences


def following(advice: xr.Dataset) -> list[str]:
    """Setting to measure next, or nothing if none shrinks an error."""
    if np.isnan(float(advice.next)):
        return []
    along = axes_of(advice)[0]
    subject = {"best": "the best setting", "range": "the length of the range that suffices"}[
        str(advice.next_subject.values)
    ]
    errors = f"from {float(advice.next_before):.2g} to {float(advice.next_after):.2g}{along.unit}"
    when = "again" if bool(advice.next_again) else "next"
    return [f"Measure {along.at(advice.next)} {when}: this is expected to shrink the error of {subject} {errors}."]


# Two processes


def answers_of_pairs(pairs: xr.Dataset) -> list[str]:
    """Sentences on the sufficient pairs of settings for a device, and on the best pair."""
    if np.isnan(pairs.best.values).any():
        return [pairs_briefly(pairs)]
    views = settings_of_processes(pairs)
    sentences = [pairs_briefly(pairs), *(_at_settings(pairs) if views[1].sufficient.size else [])]
    for view in views:
        words = axes_of(view)[0].words.capitalize()
        sentences += [f"{words}: {sentence[:1].lower()}{sentence[1:]}" for sentence in (*best(view), *following(view))]
    return sentences


def pairs_briefly(pairs: xr.Dataset) -> str:
    """Range of the second process with sufficient settings of the first one, and the best pair, in a sentence."""
    views, axes = settings_of_processes(pairs), axes_of(pairs)
    names = " and the ".join(along.words for along in axes)
    if np.isnan(pairs.best.values).any():
        return f"Pairs of the {names} that suffice are not known: not all could be computed."
    most = (along.at(view.best, view.best_error) for along, view in zip(axes, views, strict=True))
    share, most, of_mean = one_in(float(pairs.share)), " with ".join(most), _mean_process(views[1])
    ranges = axes[1].ranges(views[1].sufficient.values)
    if not ranges:
        measured = " and ".join(f"the {along.words} from {along.ranges([along.values[[0, -1]]])[0]}" for along in axes)
        none = f"No pair of {measured} is sure to leave at most {share} stuck in the next runs"
        return f"{none} ({axes[1].words}, {of_mean}); the best is {most}."
    return (
        f"Pairs of the {names} leave at most {share} stuck in the next runs (95 % confidence) where the "
        f"{axes[1].words} is {' or '.join(ranges)} ({of_mean}), best {most}."
    )


def _at_settings(pairs):
    """Settings of the first process that suffice at the measured settings of the second one."""
    first, second = axes_of(pairs)
    for value in pairs.second_settings.values:
        where = f"Where the {second.words} is {second.at(value)}"
        ranges = first.ranges(sufficient(first.values, pairs.safe.sel(second=value).values))
        article = "an" if first.words[0] in "aeiou" else "a"
        yield (
            f"{where}, {article} {first.words} of {' or '.join(ranges)} suffices."
            if ranges
            else f"{where}, no {first.words} is sure to suffice."
        )

"""Sentences on sufficient roughnesses of a surface."""

import numpy as np
import xarray as xr

from stiction.devices.risk import VERIFIED, one_in, samples_for
from stiction.report.axes.axis import Axis, axes_of, notes, subjects
from stiction.report.format import UM, airs, fraction_with_band
from stiction.run.stored_limits import of_text
from stiction.stages.axes.requirement import SMOOTHER, margins_of, sought_of
from stiction.stages.axes.roughness import KURTOSIS, OF_COPIES, curves_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import MIDDLE, S_SHAPE

#: End states that no surface holds below the bound of flat ones. Tips can be held below it.
_BOUNDED = (S_SHAPE, MIDDLE)
#: Standard errors beyond which two forces count as different.
DIFFERENT = 3


def form(*datasets: xr.Dataset) -> str:
    """Constants while the quantities of some curves and maps are varied, and their changes."""
    if all(axis.name in OF_COPIES for dataset in datasets for axis in axes_of(dataset)):
        return "Varied is how one surface follows the other. Both surfaces stay as they are given."
    varied = (
        "Two quantities of one surface are varied."
        if any("other" in dataset.dims for dataset in datasets)
        else "One quantity of one surface is varied."
    )
    stays = "The form of its heights and the shape of its spectrum stay"
    if any(KURTOSIS in dataset for dataset in datasets):
        stays = (
            "A skewness comes with the kurtosis of the surface. If no density of maximum entropy has both, it comes "
            "with the largest kurtosis of such a density, shown beside it. All else of the form of its heights and the "
            "shape of its spectrum stays"
        )
    return f"{varied} {stays}; a process that changes one of them usually changes all."


def answers(dataset: xr.Dataset) -> list[str]:
    """Sufficient roughnesses, one sentence for each humidity and end state, and reasons against others.

    Those of a map are about each of its curves.
    """
    sentences = []
    for curve in curves_of(dataset):
        of_curve = [*(_answer(curve, *subject) for subject in subjects(curve)), *notes(curve)]
        sentences += [_at_other(curve) + sentence for sentence in of_curve]
    return sentences + note_on_extrapolation(dataset)


def briefly(dataset: xr.Dataset) -> list[str]:
    """Places of sufficient roughness, one sentence for each humidity and end state, of a map at its given value."""
    curves = [curve for curve in curves_of(dataset) if not _is_changed(curve)]
    sentences = [f"{_enough(curve, *subject)}." for curve in curves for subject in subjects(curve)]
    return sentences + note_on_extrapolation(dataset)


def note_on_extrapolation(dataset: xr.Dataset) -> list[str]:
    """Note on an extrapolated fraction, beyond the bound from the devices and beyond verification."""
    share, samples = float(dataset.share), int(dataset.samples)
    if share >= VERIFIED or samples >= samples_for(share):
        return []
    return [
        f"The result for {one_in(share)} is extrapolated from {samples} simulated devices, by a line through the 5 % "
        f"that stick most easily. The line was verified down to {one_in(VERIFIED)}."
    ]


def _at_other(curve):
    """Beginning of the sentences on a curve of a map, nothing for others."""
    if "other" not in curve.coords:
        return ""
    other, as_given = axes_of(curve)[1], "" if _is_changed(curve) else ", as given"
    kurtosis = f" and the kurtosis {float(curve[KURTOSIS][0]):.3g}" if other.name == "skewness" else ""
    return f"Where the {other.words} is {other.at(curve.other)}{kurtosis}{as_given}: "


def _is_changed(curve):
    """Whether the second quantity of a curve differs from the surface's."""
    return "other" in curve.coords and float(curve.other) != float(curve.other_given)


def _answer(curve, humidity, shape):
    """Sufficient roughness at a humidity against one end state."""
    rows = _rows(curve, "crossing", humidity, shape)
    places = [axes_of(curve)[0].at(*row) for row in zip(rows.crossing_place, rows.crossing_error, strict=True)]
    exactly = f"; exactly {one_in(float(curve.share))} sticks at {' and at '.join(places)}" if places else ""
    more = _worst(curve, humidity, shape) + _stuck_as_given(curve, humidity, shape)
    return f"{_enough(curve, humidity, shape)}{exactly}. {more}"


def _enough(curve, humidity, shape):
    """Place of the requirement on the simulated limits at a humidity against one end state."""
    sought = sought_of(curve)
    required = f"{float(curve.required) / UM:g} {sought.shown}"
    by_beam = f"a {sought.name} of {required} ({END_STATES[shape].by})"
    requirement = f"a {sought.required} of {required}" if sought.more_is_better else by_beam
    ranges = axes_of(curve)[0].ranges(ranges_of(curve, humidity, shape))
    where = _where(curve.sel(humidity=humidity, shape=shape), axes_of(curve)[0], ranges)
    return f"For {requirement}, {airs([humidity])}, {where}"


def _where(curve, axis: Axis, ranges):
    """Roughness whose simulated limit meets the requirement."""
    computed = axis.values[curve.safe.notnull().values]
    if not len(computed):
        return "nothing is computed"
    share, (span,) = one_in(float(curve.share)), axis.ranges([(computed[0], computed[-1])])
    if not ranges:
        return f"no {axis.words} of {span} suffices: nowhere there is it certain that at most {share} sticks"
    # Bounds of beams allow for the number of drawn surfaces.
    drawn = ", given the drawn surfaces" * sought_of(curve).more_is_better
    sure = f"by simulation alone, 95 % confidence{drawn}"
    if ranges == [span]:
        return f"at most {share} sticks at any {axis.words} of {span} ({sure})"
    return f"at most {share} sticks where the {axis.words} is {' or '.join(ranges)} ({sure}; computed for {span})"


def _worst(curve, humidity, shape):
    """Roughness of strongest adhesion of a stopper if it is inside the range, beyond the errors of both ends."""
    points, axis = curve.sel(humidity=humidity, shape=shape).dropna("roughness", subset=["estimate"]), axes_of(curve)[0]
    forces, errors = points.estimate.values, points.error.values
    if not sought_of(curve).more_is_better or not len(forces):
        return ""
    most = int(np.argmax(forces))
    apart = [forces[most] - forces[end] > DIFFERENT * np.hypot(errors[most], errors[end]) for end in (0, -1)]
    if not all(apart):
        return ""
    worst = axis.at(points.roughness[most])
    return f"The worst {axis.words} is inside this range, near {worst}: less and more of it hold less. "


def _stuck_as_given(curve, humidity, shape):
    """P(stuck) on the surfaces as they are given, if it is known."""
    as_given, axis = curve.sel(humidity=humidity, shape=shape, roughness=float(curve.given)), axes_of(curve)[0]
    stuck = as_given.stuck.values.tolist()
    where = f"At the given {axis.words}" if _is_changed(curve) else "On the surfaces as they are given"
    if np.isnan(stuck[0]):
        return f"{where}, it is not computed."
    return f"{where}, at {axis.at(curve.given)}, {fraction_with_band(*stuck, ' %')} stick."


def crossings_of(curve: xr.Dataset, humidity: float, shape: str) -> xr.Dataset:
    """Crossings of a curve with its required value, at a humidity and against one end state.

    There are none where full contact is unknown on the unsafe side.
    """
    rows = _rows(curve, "crossing", humidity, shape)
    if (ends := _unknown(curve)) is None:
        return rows
    return rows.isel(crossing=(rows.crossing_place.values < ends[0]) | (rows.crossing_place.values > ends[1]))


def smoother_than_known(data: xr.Dataset) -> tuple[float, float] | None:
    """Ends of the roughness in its unit of which full contact is unknown on the unsafe side, none if it is known.

    They lead from the smoothest surface to the given one.
    """
    if (ends := _unknown(data)) is None:
        return None
    low, high = sorted(map(float, map(axes_of(data)[0].in_unit, ends)))
    return low, high


def _unknown(data):
    """Ends as of `smoother_than_known` [SI]."""
    if (furthest := _smoothest_unknown(data)) is None:
        return None
    return tuple(sorted((furthest, float(data.given))))


def is_unknown(data: xr.Dataset) -> xr.DataArray:
    """Whether full contact is unknown on the unsafe side at each point, of the dimensions of its flags."""
    return xr.apply_ufunc(np.vectorize(lambda flag: SMOOTHER in of_text(flag), otypes=[bool]), data.flagged)


def _smoothest_unknown(data):
    """Roughness of the smoothest surface whose full contact is unknown on the unsafe side, none if all is known."""
    over_others = [dim for dim in data.flagged.dims if dim != "roughness"]
    places = data.roughness.values[is_unknown(data).any(over_others).values]
    return places[np.argmax(np.abs(places - float(data.given)))] if places.size else None


def flats_suffice(curve: xr.Dataset, shape: str) -> bool:
    """Whether even flat surfaces meet the requirement against an end state at all humidities, in any contact."""
    return shape in _BOUNDED and bool((margins_of(curve.sel(shape=shape), "bound") >= 0).all())


def ranges_of(curve: xr.Dataset, humidity: float, shape: str) -> np.ndarray:
    """Ranges of a curve in which its simulated limit meets the requirement, as `crossings_of`, (n, 2).

    They end at the given surface where full contact of smoother ones is unknown on the unsafe side, unless even flat
    surfaces meet the requirement.
    """
    rows = _rows(curve, "range", humidity, shape)
    ranges = np.stack([rows.range_low, rows.range_high], axis=-1)
    if (unknown := _smoothest_unknown(curve)) is None or flats_suffice(curve, shape):
        return ranges
    end = float(curve.given)
    clipped = np.clip(ranges, *((end, None) if unknown < end else (None, end)))
    return clipped[(ranges >= end).any(axis=1) if unknown < end else (ranges <= end).any(axis=1)]


def sure_in_short(curve: xr.Dataset, humidity: float, shape: str) -> str:
    """Where the simulated limit of a curve meets the requirement, in a few words for a picture.

    Nothing is sure where a stricter end state decides: the words then have the condition under which it does not.
    """
    axis, ranges = axes_of(curve)[0], ranges_of(curve, humidity, shape)
    computed = axis.values[curve.safe.sel(humidity=humidity, shape=shape).notnull().values]
    parts = [_range(axis, ends, computed) for ends in ranges]
    if not parts:
        return "nowhere sure"
    where, only_if = " or ".join(parts), END_STATES[shape].only_if
    return f"enough {where}, {only_if}" if only_if else f"sure {where}"


def _range(axis: Axis, ends, computed):
    """Range in words, without an end that is one of all known values."""
    (low, high), is_open = ends, np.isclose(ends, computed[[0, -1]], rtol=1e-9, atol=0)
    if is_open.all():
        return "everywhere"
    if is_open[1]:
        return f"from {axis.at(low)}"
    return f"up to {axis.at(high)}" if is_open[0] else f"from {axis.text(low)} to {axis.at(high)}"


def _rows(curve, dimension, humidity, shape):
    """Crossings or ranges of a humidity and end state."""
    names = [f"{dimension}_humidity", f"{dimension}_shape"]
    is_subject = (curve[names[0]].values == humidity) & (curve[names[1]].values == shape)
    return curve.isel({dimension: np.flatnonzero(is_subject)})

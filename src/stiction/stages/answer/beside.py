"""Stricter sizes beside the size to build: of airs between the stated ones, and of what nothing stated asks for."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.special import ndtri

from stiction.answer.data import Answer, Between, Cause, Unasked
from stiction.answer.sought import SOUGHT
from stiction.contact.air import is_humid
from stiction.devices.risk import CONFIDENCE
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.life.answers import LifeRow, Name, answers_of

#: Relative difference of sizes that rounding makes.
_ROUNDED = 0.1 / 100
#: Limits of a separation that is faster than evaporation.
_IF_FAST = (Name.FAST, Name.RESTORING)


def of_lengths(
    lengths: Mapping[float, xr.Dataset], charts: Mapping[float, xr.Dataset], device: DesignedBeam, share: float
) -> dict[float, float]:
    """Simulated limits of a beam in its own airs and, if its chart has the beam itself, in those of the chart [m]."""
    in_airs = {humidity: dataset.isel(shape=-1) for humidity, dataset in lengths.items()}
    at = {"thickness": device.thickness, "gap": device.gap}
    for humidity, chart in charts.items():
        if all(np.isclose(chart[name], size, rtol=1e-9).any() for name, size in at.items()):
            in_airs[humidity] = chart.isel(shape=-1).sel(at, method="nearest")
    return {humidity: float(dataset.safe_length.sel(share=share)) for humidity, dataset in in_airs.items()}


def of_forces(stopper: xr.Dataset, share: float) -> dict[float, float]:
    """Simulated limits of a stopper in its own airs and along the fine axis of humidities [N]."""
    along, at_airs = stopper.safe_force_along.sel(share=share), stopper.safe_force.sel(part="safe", share=share)
    limits = zip((along.axis, along), (at_airs.humidity, at_airs), strict=True)
    humidities, forces = (np.concatenate([array.values for array in pair]) for pair in limits)
    return dict(zip(map(float, humidities), map(float, forces), strict=True))


def between(answer: Answer, limits: Mapping[float, float]) -> Between | None:
    """Strictest size to build between the humid airs of an answer, none within rounding of the size to build.

    Parameters
    ----------
    answer
        In its airs.
    limits
        Simulated limits by humidity, those of the answer among them [m, N].

    Notes
    -----
    ASSUME: all causes inside change the simulated limit between two stated airs by what they do in these, interpolated
    in the logarithm, as the controls of a page do. In the air that decides, it is the size for all airs. The stopper of
    examples/devices.yaml then needs 171 µN at a relative humidity of 0.83, and 180 µN if it is stated: the safe size of
    241 µN takes what causes do in the worse of both airs around.
    """
    builds = {air.humidity: air.build for air in answer.airs} | {answer.together.humidity: answer.build}
    builds = {humidity: build for humidity, build in sorted(builds.items()) if is_humid(humidity)}
    factors = {
        rh: np.log(build / limits[rh]) for rh, build in builds.items() if build > 0 and 0 < limits.get(rh, 0) < np.inf
    }
    inside = [rh for rh, limit in limits.items() if factors and min(builds) < rh < max(builds) and np.isfinite(limit)]
    sizes = {rh: limits[rh] * float(np.exp(np.interp(rh, list(factors), list(factors.values())))) for rh in inside}
    sign = answer.sought.sign
    worst = min(sizes, key=lambda humidity: sign * sizes[humidity], default=None)
    if worst is None or not _is_beyond(sizes[worst], answer.build, answer.sought):
        return None
    return Between(worst, sizes[worst], sign * min(sign * limits[rh] * _strictest(factors, rh, sign) for rh in inside))


def _strictest(factors, humidity, sign):
    """Stricter one of the factors in the stated airs around a humidity, from their logarithms by humidity."""
    stated = list(factors)
    position = float(np.interp(humidity, stated, range(len(stated))))
    around = (factors[stated[int(end(position))]] for end in (np.floor, np.ceil))
    return float(np.exp(sign * min(sign * factor for factor in around)))


def unasked(life: xr.Dataset, answer: Answer) -> tuple[Unasked, ...]:
    """Limits that do not allow the size to build of an answer, the strictest first, with the errors of the inputs.

    A mission asks for its touchdowns in their own airs, not for all of them in the worst one.
    """
    sought, inside = answer.sought, {Name.AFTER} if answer.stays else set()
    limits = [
        Unasked(row.name, row.what, _with_inputs(row, answer))
        for row in answers_of(life)
        if row.unit == answer.unit and row.name not in inside and np.isfinite(row.high)
    ]
    stricter = [limit for limit in limits if _is_beyond(limit.size, answer.build, sought)]
    return tuple(sorted(stricter, key=lambda limit: sought.sign * limit.size))


def _with_inputs(row, answer):
    """Size that a limit of a life allows with all that is inside an answer [m, N].

    ASSUME: a separation that is faster than evaporation changes the size to build as it changes the simulated limit.
    Sizes for which liquids dry or have dried are closed forms: errors of their inputs have a confidence of 95 %.
    """
    fast = [step.factor for step in answer.steps if step.cause is Cause.FAST and not step.stated]
    if row.name in _IF_FAST and fast:
        return answer.build * fast[0]
    error = row.error if row.name.startswith((Name.COLLAPSE, Name.RELEASED)) and np.isfinite(row.error) else 0.0
    return unsafe_end(row) - answer.sought.sign * ndtri(CONFIDENCE) * error


def unsafe_end(row: LifeRow) -> float:
    """End of a length or a force that decides about a size: its lower or, of a force, its upper bound [m, N]."""
    return row.high if SOUGHT[row.unit].more_is_better or np.isnan(row.low) else row.low


def is_short(row: LifeRow, build: float) -> bool:
    """Whether a length or a force does not allow a size to build, beyond rounding."""
    return _is_beyond(unsafe_end(row), build, SOUGHT[row.unit])


def _is_beyond(limit, build, sought):
    """Whether a limit is stricter than a size to build, beyond rounding."""
    low, high = (build, limit) if sought.more_is_better else (limit, build)
    return low * (1 + _ROUNDED) < high

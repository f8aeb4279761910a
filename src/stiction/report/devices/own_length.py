"""Sentences on P(stuck) of a beam at the length of its device."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from stiction.devices.risk import CONFIDENCE, one_in, upper_bound
from stiction.report.devices.sentences import built_in_words
from stiction.report.format import UM, airs, fraction_between, fraction_with_band
from stiction.rounding import in_percent
from stiction.stages.devices.budget import budget_of
from stiction.stages.devices.safe_lengths import chosen_share


def sentences(safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]) -> list[str]:
    """P(stuck) at the length of a device in each of its airs, the worst first, none without a given length.

    Parameters
    ----------
    safe_lengths : dict
        Humidity to the dataset of stage safe_lengths.
    budgets : dict
        Humidity and more to the dataset of stage budget, of what holds the shortest devices; may be empty.
    """
    stated = [(humidity, one.isel(shape=-1)) for humidity, one in safe_lengths.items() if "length_of_device" in one]
    worst_first = sorted(stated, key=lambda case: -float(case[1].stuck_at_length.sel(end="high")))
    return [
        _sentence(humidity, one, _total(humidity, budgets), built_in_words(safe_lengths[humidity], budgets, -1))
        for humidity, one in worst_first
    ]


def effect_of_measurements(safe_lengths: Mapping[float, xr.Dataset], budgets: Mapping[tuple, xr.Dataset]) -> list[str]:
    """Effect of the measurements on P(stuck) at the length of a device, in each of its airs where it is known."""
    said = []
    for humidity, one in safe_lengths.items():
        total = _total(humidity, budgets)
        if "length_of_device" in one and total:
            held = one.isel(shape=-1)
            low, high = _stuck_if_shifted(held, float(held.length_of_device), total)
            said.append(
                f"With the measurements one standard uncertainty off, {in_percent(total)} of the length, "
                f"{fraction_between(low, high, ' %')} of devices of {float(held.length_of_device) / UM:g} µm stick "
                f"{airs([humidity])}."
            )
    return said


def _total(humidity, budgets):
    """Relative uncertainty of the length at a humidity due to the measurements, 0 without any [-]."""
    totals = [budget_of(budget).total for key, budget in budgets.items() if key[0] == humidity]
    return max(filter(np.isfinite, totals), default=0.0)


def _sentence(humidity, held, total, built):
    """P(stuck) at one humidity in words, with the length to build for the middle one of the shares."""
    length, (stuck, low, high) = float(held.length_of_device), map(float, held.stuck_at_length)
    error, reach = float(held.stuck_surfaces_error), float(held.reach)
    surfaces = f", ± {in_percent(error)} by the number of drawn surfaces" if error > 0 else ""
    what, how = fraction_with_band(stuck, low, high, " %"), f" with 95 % confidence{surfaces}"
    if length > reach:
        what = fraction_between(low, high, " %")
        how = f" (devices were simulated up to {reach / UM:.0f} µm; longer ones may all stick)"
    safe = f"{built} are safe for {one_in(chosen_share(held))}"
    left = _remaining_uncertainty(held, length, total)
    return f"Of devices of {length / UM:g} µm, {what} stick {airs([humidity])}{how}; {safe}.{left}"


def _remaining_uncertainty(held: xr.Dataset, length: float, total: float) -> str:
    """Uncertainty of P(stuck) left by the measurements: stuck lengths change by a relative amount ``total``."""
    if total == 0:
        return ""
    low, high = _stuck_if_shifted(held, length, total)
    return (
        f" With the measurements one standard uncertainty off, {in_percent(total)} of the length, it is "
        f"{fraction_between(low, high, ' %')}."
    )


def _stuck_if_shifted(held, length, total):
    """P(stuck) at a length [m] if stuck lengths are longer or shorter by a relative amount.

    Where none sticks in the end, its upper bound.
    """
    at: Sequence[float] = length / np.array([1 + total, max(1 - total, 0.01)])
    low, high = np.interp(at, held.length.values, held.stuck.values, left=0.0)
    none = float(upper_bound(0, int(held.beams), (1 + CONFIDENCE) / 2))
    return float(low), float(high) or none

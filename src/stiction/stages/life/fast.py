"""Safe length of a beam that separates faster than water evaporates."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.config.cases import Air
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import FAST, FREE, Answer
from stiction.stages.life.lengths import length_and_error


def separated_fast(lengths: Mapping[float, xr.Dataset], separation: xr.Dataset) -> list[Answer]:
    """Safe length of a beam that separates faster than water evaporates, by humidity and end state, in the worst one.

    It is at most that of slow separation.
    """
    slow, fast = [], []
    for humidity, dataset in lengths.items():
        one = dataset.sel(share=chosen_share(dataset))
        for shape in map(str, one["shape"].values):
            length, spread = length_and_error(one.sel(shape=shape))
            factor, error = _factor(separation, humidity, shape)
            slow.append(length)
            shorter = length * factor if factor else 0.0
            fast.append((shorter, float(np.hypot(spread * factor, length * error)), factor, Air(humidity).where))
    shorter, error, factor, air = min(fast)
    form = f"L x {factor:.3g} {air}, by (e / e_V)^(1/4) of strips or lengths of tips (at least); slow (at most)"
    what = "simulated limit if it separates faster than water evaporates"
    numbers = (shorter, min(slow), error) if 0 < shorter < np.inf else (np.nan, min(slow), np.nan)
    return [Answer(FAST, FREE, what, *numbers, "m", form, "stage separation")]


def _factor(separation, humidity, shape):
    """Factor of the length by fast separation and its standard error [-]; 1 in air without water."""
    if humidity not in separation.humidity.values:
        return 1.0, 0.0
    one = separation.sel(humidity=humidity, shape=shape)
    return float(one.factor), float(one.factor_error)

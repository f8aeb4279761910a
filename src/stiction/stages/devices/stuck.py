"""P(stuck) of a device in one layout, for users: of a beam over its length, of a stopper over its restoring force.

The dataset has the variables ``stuck``, and ``low`` and ``high``, the ends of the band of 95 %, along one axis:
``length`` [m] or ``force`` [N].
"""

import numpy as np
import xarray as xr

from stiction.devices.risk import stuck_share
from stiction.stages.devices.opening import EITHER


def stuck_beams(safe_lengths: xr.Dataset) -> xr.Dataset:
    """P(stuck) over the length of a beam, whatever holds it, from the dataset of stage safe_lengths."""
    shapes = list(map(str, safe_lengths["shape"].values))
    held = safe_lengths.sel(shape=EITHER if EITHER in shapes else shapes[0])
    low, high = held.stuck_band.values
    return _layout("length", held.length.values, "m", (held.stuck.values, low, high))


def stuck_stoppers(stopper: xr.Dataset, humidity: float) -> xr.Dataset:
    """P(stuck) over the restoring force of a stopper at a humidity, from the dataset of stage stoppers."""
    forces = stopper.pull_off.sel(humidity=humidity).values
    at = np.sort(forces)
    return _layout("force", at, "N", stuck_share(-at, -forces))


def _layout(axis, values, unit, stuck):
    """Dataset of P(stuck) and of the ends of its band along an axis."""
    words = {"stuck": "P(stuck)", "low": "P(stuck), lower end of the 95 % band", "high": "P(stuck), upper end"}
    variables = {
        name: (axis, part, {"units": "1", "long_name": words[name]}) for name, part in zip(words, stuck, strict=True)
    }
    label = {"length": "length of the device", "force": "restoring force"}[axis]
    return xr.Dataset(variables, {axis: (axis, values, {"units": unit, "long_name": label})})

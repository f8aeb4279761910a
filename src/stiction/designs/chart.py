"""Stage chart: safe lengths of beams of other thicknesses and gaps than those of a device, at one humidity of an axis.

Beams are computed by finite elements. Between the smallest and the largest thickness and gap, a power law is used if it
predicts a beam in the middle, to which it was not fitted, within 1 %.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import xarray as xr

from stiction.beam.foundation import foundation_length
from stiction.chaos.model import Truncation, draw_laws
from stiction.designs import cracks, safe_lengths
from stiction.designs.cracks import Device
from stiction.devices.chart import checked_power_law, flooded_length
from stiction.stages import curves


@dataclass(frozen=True)
class Settings:
    """Everything that a chart depends on at one humidity apart from the contact of strips and tips."""

    seed: int
    chaos: Truncation
    water: curves.Water
    humidity: float  #: [-]
    device: Device
    beams: int
    shares: tuple[float, ...]  #: [-]
    tip: float  #: length of the strips of tips [m]
    thicknesses: tuple[float, ...]  #: increasing [m]
    gaps: tuple[float, ...]  #: increasing [m]


def compute(contact: xr.Dataset, tips: xr.Dataset | None, settings: Settings) -> xr.Dataset:
    """Safe lengths of all thicknesses and gaps; inputs as in the stages cracks and safe_lengths."""
    model = cracks.fitted(*curves.vectors(contact, settings.humidity, settings.water), settings)
    laws = draw_laws(model, cracks.LAWS, cracks.addresses(settings)("mesh"))
    sizes = np.array(list(product(settings.thicknesses, settings.gaps)))

    def by_elements(size):
        """Safe lengths of beams of one size (shapes, shares) [m]."""
        device = replace(settings.device, thickness=float(size[0]), gap=float(size[1]))
        return _safe_lengths(device, model, laws, tips, settings)

    lengths, computed, error = filled(sizes, by_elements)
    shapes = [safe_lengths.S_SHAPE] if tips is None else [safe_lengths.S_SHAPE, safe_lengths.EITHER]
    limits = [_limit(settings, *size) for size in sizes]
    return layout(lengths, computed, error, limits, shapes, settings)


def _safe_lengths(device, model, laws, tips, settings):
    """Safe lengths of a device, (shapes, shares) [m]."""
    of_size = replace(settings, device=device)
    beam, points = cracks.long_beam(device, laws)
    number, address = settings.beams * device.cracks, cracks.addresses(settings)
    found = cracks.crack_lengths(model, beam, points, number, address)
    held = None if tips is None else safe_lengths.tip_arcs(tips, of_size)
    sticking = safe_lengths.sticking_lengths(found, foundation_length(beam, laws), device, held)
    return np.array(
        [[one.length for one in safe_lengths.safe_lengths(values, of_size)] for values in sticking.values()]
    )


def _limit(settings, thickness, gap):
    """Crack length, of a bridge detachment length, at the adhesion energy of flooded flats [m]."""
    device, water = replace(settings.device, thickness=float(thickness), gap=float(gap)), settings.water
    return device.cracks * flooded_length(device.beam, water.temperature, water.contact_angles)


def filled(sizes: np.ndarray, by_elements: Callable) -> tuple[np.ndarray, np.ndarray, float]:
    """Lengths of beams of all sizes: computed by finite elements where a power law is not good enough.

    Parameters
    ----------
    sizes : (n, 2) array
        Thickness and gap of every beam [m]; products of two axes, in their order.
    by_elements : callable
        Lengths of beams of one size by finite elements, (2,) -> array of any shape [m].

    Returns
    -------
    lengths : (n, ...) array
        [m]
    computed : (n,) bool
        Whether each size was computed by finite elements.
    error : float
        Largest error of the power laws at the size that was left out [-]; 0 if none is used.
    """
    extreme = np.all((sizes == sizes.min(axis=0)) | (sizes == sizes.max(axis=0)), axis=1)
    test = np.arange(len(sizes)) == len(sizes) // 2
    found = {k: by_elements(sizes[k]) for k in np.flatnonzero(extreme | test)}
    error = 0.0
    if len(found) < len(sizes):
        known = list(found)
        columns = np.array([found[k] for k in known]).reshape(len(known), -1).T
        try:
            laws = [checked_power_law(*sizes[known].T, column, test[known]) for column in columns]
        except ValueError:  # the power law errs too much
            found |= {k: by_elements(sizes[k]) for k in range(len(sizes)) if k not in found}
        else:
            error = max(error for _, error in laws)
            values = np.array([law(*sizes.T) for law, _ in laws]).T
            shape = found[known[0]].shape
            found = {k: values[k].reshape(shape) for k in range(len(sizes))} | found
            return np.array([found[k] for k in range(len(sizes))]), extreme | test, error
    return np.array([found[k] for k in range(len(sizes))]), np.full(len(sizes), True), error


def layout(
    lengths: np.ndarray, computed: np.ndarray, error: float, limits: list[float], shapes: list[str], settings: Settings
) -> xr.Dataset:
    """Dataset of safe lengths over thickness and gap at one humidity.

    Parameters
    ----------
    lengths : (sizes, shapes, shares) array
        [m]
    computed : (sizes,) bool
        Whether each was computed by finite elements.
    error : float
        Largest error of the power laws [-].
    limits : (sizes,) array
        Lengths of saturated air [m].
    shapes : sequence of str
    settings : Settings
    """
    grid, size = (len(settings.thicknesses), len(settings.gaps)), ("thickness", "gap")
    metres = {"units": "m"}
    return xr.Dataset(
        {
            "safe_length": ((*size, "shape", "share"), lengths.reshape(*grid, *lengths.shape[1:]), metres),
            "flooded_length": (size, np.reshape(limits, grid), metres),
            "by_elements": (size, np.reshape(computed, grid).astype(np.int8), {"units": "1"}),
            "power_law_error": ((), error, {"units": "1"}),
            "humidity": ((), settings.humidity, {"units": "1"}),
        },
        coords={
            "thickness": ("thickness", list(settings.thicknesses), metres),
            "gap": ("gap", list(settings.gaps), metres),
            "shape": shapes,
            "share": list(settings.shares),
        },
    )

"""Sticking lengths of a device at a humidity and its safe lengths, shared by stage safe_lengths and charts.

Separate from `stiction.designs.safe_lengths`, so that a change of the dataset of that stage does not rerun charts.
"""

from typing import Protocol

import numpy as np
import xarray as xr

from stiction.contact.meniscus import flooded_energy
from stiction.designs.releases import DesignedBeam
from stiction.devices import arcs, bridges, risk
from stiction.devices.chart import flooded_length
from stiction.devices.risk import SafeLength
from stiction.stages import curves
from stiction.streams import stream

#: Shapes in which a device may stick: cracks stop on the way, or the tip holds as well. A bridge has no tip.
S_SHAPE, EITHER = "S-shape", "S-shape or arc"


class Settings(Protocol):
    """Settings of any job that computes safe lengths."""

    seed: int
    water: curves.Water
    humidity: float  #: [-]
    shares: tuple[float, ...]  #: p [-]


def shapes(device: DesignedBeam) -> list[str]:
    """Shapes in which a device may stick."""
    return [S_SHAPE] if device.kind == "bridge" else [S_SHAPE, EITHER]


def flooded_lengths(device: DesignedBeam, water: curves.Water) -> list[float]:
    """Lengths that stick in saturated air, one for each of the `shapes`: at the energy of flooded flats [m]."""
    wet = water.temperature, water.contact_angles
    alone = device.cracks * flooded_length(device.beam, *wet)
    return [alone] if device.kind == "bridge" else [alone, arcs.arc_length(flooded_energy(*wet), device.beam)]


def mean_wedge(tips: xr.Dataset, slope: float | np.ndarray, settings: Settings) -> float | np.ndarray:
    """Length of the wedge at a tip with a slope, any shape, from mean energy and mean pull-off force [m]."""
    energies = curves.tip_energies(tips, settings.humidity, settings.water)
    pulls = curves.tip_pull_offs(tips, settings.humidity, settings.water)
    return arcs.wedge_length(energies.mean(), pulls.mean(), slope)


def sticking_lengths(
    cracks: np.ndarray, foundation: float, device: DesignedBeam, held: np.ndarray | None
) -> dict[str, np.ndarray]:
    """Sticking lengths of devices by shape, (n,) each [m].

    Parameters
    ----------
    cracks : (n,) or, for bridges, (2n,) array
        Crack lengths, infinite for beams that are not S-shaped [m].
    foundation : float
        Foundation length [m].
    device : DesignedBeam
    held : (n,) array or None
        Longest arcs that come free [m].
    """
    if device.kind == "bridge":
        return {S_SHAPE: bridges.sticking_lengths(cracks)}
    alone = risk.sticking_lengths(cracks, np.isfinite(cracks), foundation)
    return {S_SHAPE: alone, EITHER: risk.with_arcs(alone, held)}


def safe_lengths(sticking: np.ndarray, settings: Settings) -> list[SafeLength]:
    """Safe length for every share, from sticking lengths (n,) [m]."""
    return [risk.safe_length(sticking, share, stream(settings.seed, "safe length")) for share in settings.shares]

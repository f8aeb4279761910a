"""Sticking lengths of a device at a humidity and its safe lengths, shared by stage safe_lengths and charts.

Separate from stage safe_lengths, so that a change of the dataset of that stage does not rerun charts.
"""

from typing import Protocol

import numpy as np

from stiction.contact.environment import Water, flooded_law
from stiction.contact.meniscus import flooded_energy
from stiction.devices import arcs, bridges, risk
from stiction.devices.chart import flooded_length
from stiction.devices.risk import SafeLength
from stiction.stages.devices.releases import DesignedBeam
from stiction.streams import stream


class Settings(Protocol):
    """Settings of any job that computes safe lengths."""

    seed: int
    water: Water
    humidity: float  #: [-]
    shares: tuple[float, ...]  #: p [-]


def flooded_lengths(device: DesignedBeam, water: Water, humidity: float) -> list[float]:
    """Bounds of the lengths that stick, one for each end state, by flooded flats [m].

    A cantilever has the length that sticks in saturated air. The worst air of a bridge is not the wettest: it has the
    length below which its middle comes free of flats in contact at this humidity.
    """
    wet = water.temperature, water.contact_angles
    if not device.opening.has_tip:
        law = flooded_law(humidity, water, device.hamaker_constant)
        return [bridges.least_length(*law, device.beam)]
    return [flooded_length(device.beam, *wet), arcs.arc_length(flooded_energy(*wet), device.beam)]


def sticking_lengths(
    cracks: np.ndarray, foundation: float, device: DesignedBeam, held: np.ndarray | None
) -> dict[str, np.ndarray]:
    """Sticking lengths of devices by shape, (n,) each [m].

    Parameters
    ----------
    cracks : (n,) array
        Crack lengths, infinite for beams that are not S-shaped, or lengths of bridges that their middle holds [m].
    foundation : float
        Foundation length [m].
    device : DesignedBeam
    held : (n,) array or None
        Longest arcs that come free [m]; ``None`` without a tip.
    """
    if held is None:
        return dict.fromkeys(device.opening.shapes, cracks)
    alone = risk.sticking_lengths(cracks, np.isfinite(cracks), foundation)
    return dict(zip(device.opening.shapes, (alone, risk.with_arcs(alone, held)), strict=True))


def safe_lengths(sticking: np.ndarray, settings: Settings) -> list[SafeLength]:
    """Safe length for every share, from sticking lengths (n,) [m]."""
    return [risk.safe_length(sticking, share, stream(settings.seed, "safe length")) for share in settings.shares]

"""Stage safe_lengths: P(stuck) over the length of a device at a humidity, and its safe lengths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.meniscus import meniscus_height
from stiction.designs import cracks as stage_cracks
from stiction.designs.cracks import Device
from stiction.devices import arcs, bridges, chart, risk
from stiction.devices.risk import SafeLength
from stiction.stages import curves
from stiction.streams import stream

#: Shapes in which a device may stick: cracks stop on the way, or the tip holds as well. A bridge has no tip.
S_SHAPE, EITHER = "S-shape", "S-shape or arc"
#: Points along the axis of the lengths.
_POINTS = 300


@dataclass(frozen=True)
class Settings:
    """Everything that the safe lengths depend on apart from the cracks and the contact of the tips."""

    seed: int
    water: curves.Water
    humidity: float  #: [-]
    device: Device
    shares: tuple[float, ...]  #: p [-]
    tip: float  #: length of the strips of tips [m]


def compute(cracks: xr.Dataset, tips: xr.Dataset | None, settings: Settings) -> xr.Dataset:
    """P(stuck) and safe lengths.

    Parameters
    ----------
    cracks : Dataset
        Of stage cracks.
    tips : Dataset or None
        Contact of the strips that hold the tips, one for each beam; ``None`` for a bridge.
    settings : Settings
    """
    found, of_group, foundation = stage_cracks.lengths(cracks)
    held = None if tips is None else tip_arcs(tips, settings)
    sticking = sticking_lengths(found, foundation, settings.device, held)
    groups = [sticking_lengths(one, foundation, settings.device, held) for one in of_group]
    safe = {shape: safe_lengths(values, settings) for shape, values in sticking.items()}
    estimates = {
        shape: [[one.estimate for one in safe_lengths(group[shape], settings)] for group in groups] for shape in safe
    }
    errors = {shape: risk.error_of_surfaces(found) for shape, found in estimates.items()}
    wedge = np.nan if tips is None else mean_wedge(tips, float(np.median(held)), settings)
    return layout(sticking, safe, errors, wedge, float(cracks.rms), settings)


def tip_arcs(tips: xr.Dataset, settings: Settings) -> np.ndarray:
    """Longest arcs that come free of each strip of tips (n,) [m]."""
    return arcs.arc_length(curves.energies(tips, settings.humidity, settings.water), settings.device.beam)


def mean_wedge(tips: xr.Dataset, length: float, settings: Settings) -> float:
    """Length of the wedge at the tip of a beam of a length [m], from mean energy and mean pull-off force [m]."""
    _, curve = curves.force_curves(tips, settings.humidity, settings.water)
    pull_off = np.mean([-curve(k).min() for k in range(tips.sizes["sample"])])
    energy = curves.energies(tips, settings.humidity, settings.water).mean()
    return float(energy / pull_off / arcs.tip_slope(length, settings.device.beam))


def sticking_lengths(
    cracks: np.ndarray, foundation: float, device: Device, held: np.ndarray | None
) -> dict[str, np.ndarray]:
    """Sticking lengths of devices by shape, (n,) each [m].

    Parameters
    ----------
    cracks : (n,) or, for bridges, (2n,) array
        Crack lengths, infinite for beams that are not S-shaped [m].
    foundation : float
        Foundation length [m].
    device : Device
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


def layout(
    sticking: Mapping[str, np.ndarray],
    safe: Mapping[str, Sequence[SafeLength]],
    surfaces: Mapping[str, np.ndarray],
    wedge: float,
    rms: float,
    settings: Settings,
) -> xr.Dataset:
    """Dataset of P(stuck) and of the safe lengths.

    Parameters
    ----------
    sticking : dict
        Sticking lengths by shape, (n,) each [m].
    safe : dict
        Safe lengths by shape, one for every share.
    surfaces : dict
        Standard errors due to the finite number of sampled surfaces by shape, (shares,) each [m].
    wedge : float
        Length of the wedge at the tip of a beam [m].
    rms : float
        Of the sum of both surfaces [m].
    settings : Settings
    """
    device, water = settings.device, settings.water
    known = np.concatenate([values[np.isfinite(values)] for values in sticking.values()])
    axis = np.linspace(0.9 * known.min(), 1.02 * known.max(), _POINTS)
    stuck = np.array([risk.stuck_share(axis, values) for values in sticking.values()])
    shaped, metres = ("shape", "share"), {"units": "m"}
    columns = {
        "safe_length": ([[one.length for one in rows] for rows in safe.values()], "one-sided 95 % bound of estimate"),
        "estimate": ([[one.estimate for one in rows] for rows in safe.values()], "length with P(stuck) = share"),
        "beams_error": ([[one.error for one in rows] for rows in safe.values()], "standard error, number of beams"),
        "surfaces_error": (list(surfaces.values()), "standard error, number of sampled surfaces"),
    }
    flooded = chart.flooded_length(device.beam, water.temperature, water.contact_angles) * device.cracks
    scalars = {
        "film": float(meniscus_height(settings.humidity, water.temperature, water.contact_angles)),
        "wedge": wedge,
        "rms": rms,
        "flooded_length": flooded,
    }
    return xr.Dataset(
        {
            "stuck": (("shape", "length"), stuck[:, 0], {"units": "1"}),
            "stuck_band": (("shape", "bound", "length"), stuck[:, 1:], {"units": "1"}),
            "basis": (shaped, [[str(one.basis) for one in rows] for rows in safe.values()]),
        }
        | {name: (shaped, values, metres | {"long_name": text}) for name, (values, text) in columns.items()}
        | {name: ((), value, metres) for name, value in scalars.items()},
        coords={
            "shape": list(sticking),
            "share": list(settings.shares),
            "bound": ["lower", "upper"],
            "length": ("length", axis, metres),
        },
    )

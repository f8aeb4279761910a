"""Stage safe_lengths: P(stuck) over the length of a device at a humidity, and its safe lengths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.contact.environment import Water
from stiction.devices import arcs, risk
from stiction.devices.risk import SafeLength
from stiction.plan.stage import Stage, select
from stiction.stages.contact import curves
from stiction.stages.devices import cracks as stage_cracks
from stiction.stages.devices.contact_names import tips_of
from stiction.stages.devices.opening import DesignedBeam, settings_of_beam
from stiction.stages.devices.sticking import bound, flooded_lengths, safe_lengths, sticking_lengths

#: Points along the axis of the lengths.
_POINTS = 300


@dataclass(frozen=True)
class Settings:
    """Everything that the safe lengths depend on apart from the cracks and the contact of the tips."""

    seed: int
    water: Water
    humidity: float  #: [-]
    device: DesignedBeam
    shares: tuple[float, ...]  #: p [-]


def compute(cracks: xr.Dataset, tips: xr.Dataset | None, settings: Settings) -> xr.Dataset:
    """P(stuck) and safe lengths; each beam has one of the tips, and a bridge has none."""
    lengths, of_group, foundation = stage_cracks.lengths(cracks)
    device, held = settings.device, None
    if tips is not None:
        held = arcs.longest_free(*curves.tip_forces(tips, settings.humidity, settings.water), device.beam)
    sticking = sticking_lengths(lengths, foundation, device, held)
    groups = [sticking_lengths(one, foundation, device, held) for one in of_group]
    least = bound(device, settings.water, settings.humidity)
    safe = {shape: safe_lengths(values, settings, least) for shape, values in sticking.items()}
    estimates = {
        shape: [[one.estimate for one in safe_lengths(group[shape], settings)] for group in groups] for shape in safe
    }
    errors = {shape: risk.error_of_surfaces(lengths) for shape, lengths in estimates.items()}
    return layout(sticking, safe, errors, float(cracks.rms), settings)


def layout(
    sticking: Mapping[str, np.ndarray],
    safe: Mapping[str, Sequence[SafeLength]],
    surfaces: Mapping[str, np.ndarray],
    rms: float,
    settings: Settings,
) -> xr.Dataset:
    """Dataset of P(stuck) and of the safe lengths, by shape.

    Sticking lengths (n,) [m], safe lengths for every share, standard errors due to the finite number of sampled
    surfaces (shares,) [m], rms of the sum of both surfaces [m].
    """
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
    scalars = {"film": settings.water.film(settings.humidity)[0], "rms": rms}
    flooded = flooded_lengths(settings.device, settings.water, settings.humidity)
    return xr.Dataset(
        {
            "stuck": (("shape", "length"), stuck[:, 0], {"units": "1"}),
            "stuck_band": (("shape", "bound", "length"), stuck[:, 1:], {"units": "1"}),
            "flooded_length": ("shape", flooded, metres | {"long_name": "bound by flooded flats"}),
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


STAGES = (
    Stage.writing(
        "safe_lengths",
        "devices/safe_lengths/{case}",
        inputs=lambda plan, at: {"cracks": f"devices/cracks/{at.case}"} | tips_of(plan, at.case),
        settings=lambda plan, at: select(Settings, settings_of_beam(plan, at.case)),
        kind=Settings,
        compute=lambda data, settings: compute(data["cracks"], data.get("tips"), settings),
        message="Safe lengths of {case}.",
    ),
)

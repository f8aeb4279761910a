"""Stage cracks: arrest of the cracks of long beams of a device at a humidity, and the error of few surfaces.

Of a bridge, the stage finds the shortest length that its middle holds instead.
A simulation of long beams gives P(stuck) at every length (`stiction.devices.risk`). The error due to the number of
sampled surfaces follows from the samples (`stiction.devices.sampling`).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.contact import forcelaw
from stiction.devices.sampling import SampledSurfaces
from stiction.plan.stage import Running, Stage, select
from stiction.stages.devices.ground import ground_from, ground_inputs
from stiction.stages.devices.opening import BEAMS, DesignedBeam, ground_of, settings_of_beam
from stiction.stages.devices.sticking import Released, release_beams


@dataclass(frozen=True)
class Settings:
    """Settings of the cracks, without the ground."""

    seed: int
    device: DesignedBeam
    beams: int  #: number of beams


def compute(ground: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Release long beams on the force laws of a ground."""
    device, met = settings.device, ground_from(ground, settings)
    dataset = layout(release_beams(device, met, settings), ground_of(device, met.laws)[0], met.laws, float(ground.rms))
    return dataset.assign(
        longest_strip=((), device.opening.longest_strip(device, met.laws), {"units": "m"}),
        **ground[["share_flat", "resampled", "repetition"]],
    )


def layout(beams: Released, part: Beam, laws: np.ndarray, rms: float) -> xr.Dataset:
    """Dataset of the lengths of arrest of the cracks of a device at a humidity.

    Released beams, the part of the device that finite elements resolve, a sample (k, 4) of its force laws [SI], and rms
    of the sum of both surfaces [m].
    """
    opening, metres = beams.device.opening, {"units": "m"}
    lengths = {
        "foundation_length": beams.foundation,
        "beam_length": part.length,
        "element_length": part.element_length,
        "rms": rms,
    }
    return xr.Dataset(
        {
            opening.length: ("device", beams.arrested, metres | {"long_name": opening.words}),
            "uniform_length": ((), beams.surfaces.length, metres | {"long_name": "length on ground without scatter"}),
            "surfaces_covariance": (("of", "with"), beams.surfaces.covariance, {"units": "1"}),
            "reach": ((), beams.reach, metres | {"long_name": "longest simulated length, if not all devices stick"}),
            "mean_energy": ((), float(forcelaw.energy(laws).mean()), {"units": "J m-2"}),
        }
        | {name: ((), value, metres) for name, value in lengths.items()},
        coords={"of": ["mean", "scatter"], "with": ["mean", "scatter"]},
    )


def lengths(cracks: xr.Dataset) -> np.ndarray:
    """Crack or held lengths (n,) [m]."""
    return cracks[_name(cracks)].values


def surfaces_of(cracks: xr.Dataset) -> SampledSurfaces:
    """Errors of lengths due to the number of sampled surfaces."""
    return SampledSurfaces(float(cracks.uniform_length), cracks.surfaces_covariance.values)


def beams_of(cracks: xr.Dataset, device: DesignedBeam, held: np.ndarray | None) -> Released:
    """Released beams of a dataset, with the longest arcs that come free of tips (n,) [m], ``None`` without tips."""
    foundation, reach = float(cracks.foundation_length), float(cracks.reach)
    return Released(device, lengths(cracks), reach, foundation, surfaces_of(cracks), held)


def with_lengths(cracks: xr.Dataset, changed: Callable[[np.ndarray], np.ndarray]) -> xr.Dataset:
    """Dataset with other lengths, a function of those of any shape [m]."""
    names = _name(cracks), "uniform_length"
    return cracks.assign({name: cracks[name].copy(data=changed(cracks[name].values)) for name in names})


def _name(cracks):
    """Name of the length at which beams are arrested."""
    return next(opening.length for opening in BEAMS.values() if opening.length in cracks)


STAGES = (
    Stage.writing(
        "cracks",
        "devices/cracks/{case}",
        inputs=lambda plan, at: ground_inputs(plan, at.case),
        settings=lambda plan, at: select(Settings, settings_of_beam(plan, at.case)),
        kind=Settings,
        compute=compute,
        message="Release long beams of {case}.",
        running=Running(minutes=120),
    ),
)

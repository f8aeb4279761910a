"""Stage cracks: arrest of the cracks of long beams of a device at a humidity, and the error of few surfaces.

Of a bridge, the stage finds the shortest length that its middle holds instead. Many cantilevers on one ground have the
lengths of a few sizes, of stage sizes, and power laws between them (`stiction.devices.sizes`).
A simulation of long beams gives P(stuck) at every length (`stiction.devices.risk`). The error due to the number of
sampled surfaces follows from the samples (`stiction.devices.sampling`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.cases import Case, case_id
from stiction.contact import forcelaw
from stiction.devices.sampling import SampledSurfaces
from stiction.devices.sizes import PowerLaws, fitted
from stiction.devices.strips import in_register
from stiction.plan.stage import At, Running, Stage, select
from stiction.stages.devices.contact_names import name_of_ground
from stiction.stages.devices.ground import ground_from, ground_inputs
from stiction.stages.devices.opening import BEAMS, DesignedBeam, addresses, arrests, ground_of, settings_of_beam
from stiction.stages.devices.sticking import Released, release_beams, released


@dataclass(frozen=True)
class Settings:
    """Settings of the cracks, without the ground."""

    seed: int
    device: DesignedBeam
    beams: int  #: number of beams
    by_sizes: bool = False  #: whether lengths follow those of a few sizes, if their power laws hold


@dataclass(frozen=True)
class OfSizes:
    """Settings of the beams of a few sizes, without the ground."""

    seed: int
    device: DesignedBeam  #: one of them
    beams: int
    thicknesses: tuple[float, ...]  #: increasing [m]
    gaps: tuple[float, ...]  #: increasing [m]


def compute(ground: xr.Dataset, settings: Settings, of_sizes: xr.Dataset | None = None) -> xr.Dataset:
    """Release long beams on the force laws of a ground, or take their lengths from those of a few sizes."""
    device, below = settings.device, ground_from(ground, settings)
    laws = (
        None if of_sizes is None else PowerLaws(of_sizes.powers.values, float(of_sizes.error), float(of_sizes.excess))
    )
    by_laws = laws is not None and laws.holds
    if by_laws:  # which know all lengths
        beams = released(device, below, laws.lengths(device.thickness, device.gap), np.inf)
    else:
        beams = release_beams(device, below, settings)
    dataset = layout(beams, ground_of(device, below.laws)[0], below.laws, float(ground.rms))
    dataset = dataset.assign(_in_register(below, settings))
    return dataset.assign(
        longest_strip=((), device.opening.longest_strip(device, below.laws)),
        size_error=((), laws.error if by_laws else 0.0),
        **ground[["share_flat", "resampled", "repetition"]],
    )


def _in_register(below, settings):
    """Variable with the lengths of the same beams in register [m], none without play."""
    device, laws = settings.device, below.strips
    if laws.displacements is None:
        return {}
    draw = in_register(laws.sampled, laws.displacements)
    arrested = arrests(device, ground_of(device, below.laws), draw, settings.beams, addresses(settings))
    return {"register_length": ("device", arrested)}


def compute_sizes(ground: xr.Dataset, settings: OfSizes) -> xr.Dataset:
    """Power laws of the lengths of beams on a ground, and their error. They are NaN if a length is not known."""
    below = ground_from(ground, settings)
    axes = settings.thicknesses, settings.gaps
    devices = [replace(settings.device, thickness=thickness, gap=gap) for thickness, gap in product(*axes)]
    laws = fitted(*axes, [release_beams(device, below, settings).arrested for device in devices])
    powers = xr.Dataset({"powers": (("of", "device"), laws.powers)})
    return powers.assign({name: ((), getattr(laws, name)) for name in ("error", "excess")})


def layout(beams: Released, beam: Beam, laws: np.ndarray, rms: float) -> xr.Dataset:
    """Dataset of the lengths of arrest of the cracks of a device at a humidity.

    Released beams, the part of the device that finite elements resolve, a sample (k, 4) of its force laws [SI], and rms
    of the sum of both surfaces [m].
    """
    opening = beams.device.opening
    lengths = {
        "foundation_length": beams.foundation,
        "beam_length": beam.length,
        "element_length": beam.element_length,
        "rms": rms,
    }
    return xr.Dataset(
        {
            opening.length: ("device", beams.arrested),
            "uniform_length": ((), beams.surfaces.length),
            "surfaces_covariance": (("of", "with"), beams.surfaces.covariance),
            "reach": ((), beams.reach),
            "mean_energy": ((), float(forcelaw.energy(laws).mean())),
        }
        | {name: ((), value) for name, value in lengths.items()},
        coords={"of": ["mean", "scatter"], "with": ["mean", "scatter"]},
    )


def lengths(cracks: xr.Dataset) -> np.ndarray:
    """Crack or held lengths (n,) [m]."""
    return cracks[_name(cracks)].values


def surfaces_of(cracks: xr.Dataset) -> SampledSurfaces:
    """Errors of lengths due to the number of sampled surfaces."""
    return SampledSurfaces(float(cracks.uniform_length), cracks.surfaces_covariance.values)


def beams_of(cracks: xr.Dataset, device: DesignedBeam, arc_lengths: np.ndarray | None) -> Released:
    """Released beams of a dataset, with the longest arcs that come free of tips (n,) [m], ``None`` without tips."""
    foundation, reach = float(cracks.foundation_length), float(cracks.reach)
    return Released(device, lengths(cracks), reach, foundation, surfaces_of(cracks), arc_lengths)


def with_lengths(cracks: xr.Dataset, changed: Callable[[np.ndarray], np.ndarray]) -> xr.Dataset:
    """Dataset with other lengths, a function of those of any shape [m]."""
    names = [name for name in (_name(cracks), "uniform_length", "register_length") if name in cracks]
    return cracks.assign({name: cracks[name].copy(data=changed(cracks[name].values)) for name in names})


def _name(cracks):
    """Name of the length at which beams are arrested."""
    return next(opening.length for opening in BEAMS.values() if opening.length in cracks)


def _inputs(plan: Any, at: At) -> dict[str, str]:
    """Ground of a device, and the power laws of its lengths where many devices are on it."""
    sizes = {"of_sizes": f"devices/sizes/{name_of_ground(plan, at.case)}"} if _sizes(plan, at.case) else {}
    return ground_inputs(plan, at.case) | sizes


def _sizes(plan, case):
    """Sizes from which the lengths of a case follow, if there are any."""
    return plan.devices.sizes(case.device, case.humidity)


def _case_of_sizes(plan, at):
    """Case of the first cantilever on a ground.

    Raises
    ------
    KeyError
        If there is none.
    """
    ground = (at.case.pair, int(at.length), int(at.width))
    return Case(case_id(plan.devices.cantilevers_on[ground, at.case.humidity][0], at.case.humidity))


def _settings_of_sizes(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the sizes of all cantilevers on a ground."""
    case = _case_of_sizes(plan, at)
    sizes, settings = _sizes(plan, case), settings_of_beam(plan, case)
    first = {"thickness_um": sizes["thicknesses_um"][0], "gap_um": sizes["gaps_um"][0]}
    return select(OfSizes, settings | sizes | {"device": settings["device"] | first})


STAGES = (
    Stage.writing(
        "cracks",
        "devices/cracks/{case}",
        inputs=_inputs,
        settings=lambda plan, at: select(
            Settings, settings_of_beam(plan, at.case) | ({"by_sizes": True} if _sizes(plan, at.case) else {})
        ),
        kind=Settings,
        compute=lambda data, settings: compute(data["ground"], settings, data.get("of_sizes")),
        message="Release long beams of {case}.",
        running=Running(minutes=120, priority=1),
    ),
    Stage.writing(
        "sizes",
        "devices/sizes/{case}_{length}x{width}",
        inputs=lambda plan, at: ground_inputs(plan, _case_of_sizes(plan, at)),
        settings=_settings_of_sizes,
        kind=OfSizes,
        compute=compute_sizes,
        message="Release beams of a few sizes on {case}, strips of {length} x {width} nm.",
        running=Running(minutes=120, priority=1),
    ),
)

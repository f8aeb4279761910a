"""Stage cracks: arrest of the cracks of long beams of a device at a humidity, and the error of few surfaces.

Of a bridge, the stage finds the shortest length that its middle holds instead.
A simulation of long beams gives P(stuck) at every length (`stiction.devices.risk`). For the error due to the number of
sampled surfaces, force laws are fitted to each of some groups of the samples alone, and the beams are released again
with the same random numbers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.beam.foundation import foundation_length
from stiction.chaos.model import Truncation, draw_laws
from stiction.contact import forcelaw
from stiction.contact.environment import Water
from stiction.plan.stage import Stage, select
from stiction.stages.contact import curves
from stiction.stages.contact.contact import surface_rms
from stiction.stages.contact.corrections import corrected
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices.contact_names import contact_of, corrections_of
from stiction.stages.devices.opening import (
    BEAMS,
    LAWS,
    DesignedBeam,
    Opening,
    addresses,
    arrests,
    fitted,
    reach,
    settings_of_beam,
)

#: Most groups of the samples of contact, and the least number of samples in each, but always two groups.
GROUPS, PER_GROUP = 10, 50


@dataclass(frozen=True)
class Settings:
    """Settings of the cracks, without the contact."""

    seed: int
    chaos: Truncation
    water: Water
    humidity: float  #: [-]
    device: DesignedBeam
    beams: int  #: number of beams


def compute(contact: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Fit the force laws and release long beams, with all samples and with each group of them alone.

    Raises
    ------
    ValueError
        If the strips of the device do not resolve its cracks.
    """
    with on_patch(settings.device.strip, settings.device.width):
        vectors, limit = curves.vectors(contact, settings.humidity, settings.water)
    model = fitted(vectors, limit, settings.chaos)
    address = addresses(settings)
    laws = draw_laws(model, LAWS, address("mesh"))
    device, ground = settings.device, settings.device.opening.resolved(settings.device, laws)
    groups = max(2, min(GROUPS, len(vectors) // PER_GROUP))
    models = [model, *(fitted(vectors[k::groups], limit, settings.chaos) for k in range(groups))]
    released = [arrests(device, ground, partial(draw_laws, of), settings.beams, address) for of in models]
    tried = reach(device, ground, partial(draw_laws, model), released[0], address)
    dataset = layout(device.opening, released[0], released[1:], ground[0], laws, surface_rms(contact))
    return dataset.assign(
        reach=((), tried, {"units": "m", "long_name": "longest simulated length, if not all devices stick"}),
        share_flat=((), curves.share_flat(contact, settings.humidity, settings.water), {"units": "1"}),
    )


def layout(
    opening: Opening, arrested: np.ndarray, of_group: list[np.ndarray], beam: Beam, laws: np.ndarray, rms: float
) -> xr.Dataset:
    """Dataset of the lengths of arrest of the cracks of a device at a humidity.

    Lengths with all samples of contact (n,), as from `stiction.stages.devices.opening.arrests`, and with each group of
    them alone [m]; the part of the device that finite elements resolve; a sample (k, 4) of the force laws [SI]; rms of
    the sum of both surfaces [m].
    """
    name, note = opening.length, {"units": "m", "long_name": opening.words}
    lengths = {
        "foundation_length": foundation_length(beam, laws),
        "beam_length": beam.length,
        "element_length": beam.element_length,
        "rms": rms,
    }
    return xr.Dataset(
        {
            name: ("device", arrested, note),
            f"{name}_of_group": (("group", "device"), np.array(of_group), note),
            "mean_energy": ((), float(forcelaw.energy(laws).mean()), {"units": "J m-2"}),
        }
        | {name: ((), value, {"units": "m"}) for name, value in lengths.items()}
    )


def lengths(cracks: xr.Dataset) -> tuple[np.ndarray, np.ndarray, float]:
    """Crack or held lengths with all samples (n,), with each group alone (g, n), and the foundation length [m]."""
    name = next(opening.length for opening in BEAMS.values() if opening.length in cracks)
    return cracks[name].values, cracks[f"{name}_of_group"].values, float(cracks.foundation_length)


def with_lengths(cracks: xr.Dataset, changed: Callable[[np.ndarray], np.ndarray]) -> xr.Dataset:
    """Dataset with other lengths, a function of those of any shape [m]."""
    name = next(opening.length for opening in BEAMS.values() if opening.length in cracks)
    return cracks.assign(
        {key: cracks[key].copy(data=changed(cracks[key].values)) for key in (name, f"{name}_of_group")}
    )


STAGES = (
    Stage.writing(
        "cracks",
        "devices/cracks/{case}",
        inputs=lambda plan, at: {"contact": contact_of(plan, at.case)} | corrections_of(plan, at.case.device),
        settings=lambda plan, at: select(Settings, settings_of_beam(plan, at.case)),
        kind=Settings,
        compute=lambda data, settings: compute(data["contact"], corrected(settings, data)),
        message="Release long beams of {case}.",
        cluster=True,
        repeats=1 + GROUPS,
        minutes=120,
    ),
)

"""Study resampling (App. B): beams on force laws resampled from the contact samples, to assess the chaos model."""

from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray as xr

from stiction.chaos.model import resample_laws
from stiction.plan.stage import Running, Stage
from stiction.stages.beams import releases
from stiction.stages.laws.forces import vectors
from stiction.streams import stream


@dataclass(frozen=True, kw_only=True)
class Settings(releases.OnStrips):
    """Settings of the beams, without the forces."""

    beams: int  #: number of beams


def compute(forces: xr.Dataset, case: str, settings: Settings) -> xr.Dataset:
    """Draw the force laws of every beam from the samples, with replacement, and release the beam."""
    draw = partial(resample_laws, *vectors(forces))
    beams = releases.without_scatter(settings, settings.beams)
    address = partial(stream, settings.seed, "resampling", case)
    return layout(releases.released_on(draw, case, beams, address))


def layout(columns: dict[str, np.ndarray]) -> xr.Dataset:
    """Dataset of the end state of every beam on resampled force laws. As `stiction.stages.beams.beams.layout`."""
    return xr.Dataset(
        {
            "state": ("beam", np.asarray(columns["state"], np.int8), releases.FLAGS),
            "crack_length": ("beam", columns["crack_length"]),
        },
        coords={"beam": columns["sample"]},
    )


STAGES = (
    Stage.writing(
        "resampling",
        "studies/resampling/{case}",
        inputs=lambda plan, at: {"forces": f"forces/{at.case}_NG"},
        settings=lambda plan, at: (
            releases.sections(plan, at.case) | {"beams": plan.config["studies"]["resampling"]["beams"]}
        ),
        kind=Settings,
        compute=compute,
        message="Release the beams of {case} on force laws resampled from the contact samples (App. B).",
        running=Running(minutes=10),
    ),
)

"""Contact of a pair with one moment of the beam's surface slightly decreased or increased (Fig. 13).

The dataset is that of stage contact with an additional variable, the value of the moment.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from stiction.analysis.sensitivity import shifted
from stiction.stages import contact as stage_contact
from stiction.stages import heights as stage_heights
from stiction.stages import parameters
from stiction.stages import spectrum as stage_spectrum
from stiction.stages.pairs import Contact, Solid
from stiction.stages.surfaces import Sampling, Width


@dataclass(frozen=True)
class Settings:
    """Settings of `stiction.stages.contact.Settings`, and the step of the moment."""

    seed: int
    sampling: Sampling
    solid: Solid
    van_der_waals: str
    contact: Contact
    beam: Width
    surfaces: tuple[str, ...]
    step: float  #: relative change of the moment [-]


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, moment: str, side: str, settings: Settings
) -> xr.Dataset:
    """Contact with a shifted moment; the samples have the same random numbers at both values of the moment.

    Parameters
    ----------
    surfaces : sequence
        Datasets (heights, spectrum) of the surfaces of beam and substrate.
    pair : str
        Name of the pair, part of the addresses of random numbers.
    moment : str
        ``rms``, ``skewness`` or ``kurtosis``.
    side : str
        ``less`` or ``more``: decreased or increased moment.
    settings : Settings
    """
    (heights, spectrum), substrate = surfaces
    moments = stage_heights.moments(heights)
    less, more = shifted(getattr(moments, moment), settings.step)
    moments = replace(moments, **{moment: less if side == "less" else more})
    # ASSUME: the spectrum of the heights keeps its shape when a moment changes.
    changed = stage_heights.compute(moments)
    shape = stage_spectrum.Settings(settings.sampling.spacing, parameters.spectrum_of(spectrum))
    beam = changed, stage_spectrum.compute(changed, None, shape)
    found = stage_contact.compute((beam, substrate), pair, "NG", settings)
    return found.assign(moment=getattr(moments, moment))


def moment(dataset: xr.Dataset) -> float:
    """Value of the shifted moment [SI]."""
    return float(dataset.moment)

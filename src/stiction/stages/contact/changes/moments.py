"""Contacts of a pair with each moment of the beam's surface slightly decreased and increased (Fig. 13).

The datasets are those of stage contact with an additional variable, the value of the moment.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import xarray as xr

from stiction.analysis.sensitivity import shifted
from stiction.models import SHIFTS
from stiction.plan.stage import Running
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import PatchChange
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import sides_of


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, the moments and their step."""

    moments: tuple[str, ...]  #: of ``rms``, ``skewness`` and ``kurtosis``
    step: float  #: relative change of a moment [-]


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> list[xr.Dataset]:
    """Contact with less and with more of each moment, in this order. All samples have the same random numbers."""
    beam, substrate = surfaces
    surface = description(*beam)
    # ASSUME: the spectrum of the heights keeps its shape when a moment changes.
    at = [(moment, value) for moment in settings.moments for value in shifted(getattr(surface, moment), settings.step)]
    changed = [drawn_as(replace(surface, **{moment: value}), settings.sampling.spacing) for moment, value in at]
    contacts = stage_contact.compute_each([(other, substrate) for other in changed], pair, "NG", settings)
    return [contact.assign(moment=value) for contact, (_, value) in zip(contacts, at, strict=True)]


def from_surfaces(data: Mapping[str, Any], pair: str, settings: Settings) -> list[xr.Dataset]:
    """Compute from the datasets of both surfaces by stage."""
    return compute(sides_of(data), pair, settings)


def moment(dataset: xr.Dataset) -> float:
    """Value of the shifted moment [SI]."""
    return float(dataset.moment)


def _with_moments(plan, at, patch_kind):
    """Settings with the number of samples, the moments and their step of Fig. 13."""
    study = plan.config["studies"]["sensitivity"]
    return patch_kind.settings(plan, at, study["samples"]) | {"moments": plan.shifted_moments, "step": study["step"]}


#: Each moment of the surface of the beam. The longest job begins early, so that no core waits for it at the end.
MOMENTS = PatchChange(
    words="with less and more of each moment (Fig. 13)",
    end="_{each}",
    each=lambda plan: [f"{moment}_{shift}" for moment in plan.shifted_moments for shift in SHIFTS],
    settings=_with_moments,
    kind=Settings,
    compute=from_surfaces,
    running=Running(minutes=30, priority=2),
)

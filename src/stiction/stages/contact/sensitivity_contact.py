"""Contact of a pair with each moment of the beam's surface slightly decreased and increased (Fig. 13).

The datasets are those of stage contact with an additional variable, the value of the moment.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from stiction.analysis.sensitivity import shifted
from stiction.models import SHIFTS
from stiction.plan.stage import Stage, select
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import both, of_pair


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, the moments and their step."""

    moments: tuple[str, ...]  #: of ``rms``, ``skewness`` and ``kurtosis``
    step: float  #: relative change of a moment [-]


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> list[xr.Dataset]:
    """Contact with less and with more of each moment, in this order; all samples have the same random numbers."""
    beam, substrate = surfaces
    surface = description(*beam)
    # ASSUME: the spectrum of the heights keeps its shape when a moment changes.
    at = [(moment, value) for moment in settings.moments for value in shifted(getattr(surface, moment), settings.step)]
    changed = [drawn_as(replace(surface, **{moment: value}), settings.sampling.spacing) for moment, value in at]
    contacts = stage_contact.compute_each([(other, substrate) for other in changed], pair, "NG", settings)
    return [contact.assign(moment=value) for contact, (_, value) in zip(contacts, at, strict=True)]


def names(settings: Settings) -> list[str]:
    """Names of the contacts in the order of `compute`, such as ``rms_less``."""
    return [f"{moment}_{shift}" for moment in settings.moments for shift in SHIFTS]


def moment(dataset: xr.Dataset) -> float:
    """Value of the shifted moment [SI]."""
    return float(dataset.moment)


def _settings(plan, at):
    """As those of the contact, with the number of samples, the moments and the step of Fig. 13."""
    study = plan.config["studies"]["sensitivity"]
    shifts = {"moments": plan.shifted_moments, "step": study["step"]}
    return select(Settings, plan.seen_by(at.pair, samples=study["samples"]) | shifts)


STAGES = (
    Stage.writing(
        "sensitivity_contact",
        "studies/sensitivity/contact/{pair}_{each}",
        each=lambda plan: [f"{moment}_{shift}" for moment in plan.shifted_moments for shift in SHIFTS],
        inputs=lambda plan, at: of_pair(plan, at.pair),
        settings=_settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(both(data), at.pair, settings),
        label="contact",
        message="Contact of pair {pair} with less and more of each moment (Fig. 13).",
        # The longest job; it begins early, so that no core waits for it at the end.
        priority=1,
        cluster=True,
        minutes=30,
    ),
)

"""Contact of a pair under a variant, i.e. one changed model choice; independent of humidity, as in stage contact."""

from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from stiction.contact.pair import solid_pressure
from stiction.contact.solids import Solid
from stiction.plan.stage import Stage
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import variant_summits
from stiction.stages.contact.pairs import SolidBySide, asperity_of


@dataclass(frozen=True)
class Settings:
    """The solids of a pair; everything else about the contact is determined by the summits."""

    solid: Solid
    van_der_waals: str
    materials: SolidBySide = field(default_factory=dict)


def compute(summits: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Contact of the summits of a pair, from stage variant_summits, under the settings of the variant."""
    model, grid = asperity_of(settings), variant_summits.distances(summits)
    pressures = [solid_pressure(model, sample, grid) for sample in variant_summits.samples_of(summits)]
    areas = summits.bearing_area.values
    return stage_contact.layout(np.array(pressures), areas, grid, range(len(areas)))


CONTACT = Stage.writing(
    "variant_contact",
    "studies/variants/contact/{pair}_{variant}",
    inputs=lambda plan, at: {
        "summits": f"studies/variants/summits/{at.pair}_{plan.variants.with_summits_of(at.pair, at.variant)}"
    },
    settings=lambda plan, at: plan.variants.solids(at.pair, at.variant),
    kind=Settings,
    compute=lambda data, at, settings: compute(data["summits"], settings),
    label="contact",
    message="Contact of pair {pair} under variant {variant}.",
)
STAGES = (CONTACT,)

"""Contacts of a pair with one quantity of one surface slightly decreased and increased.

The datasets are those of stage contact with an additional variable, the difference of the quantity between both sides.
Every slope with common random numbers uses them: of energies in `stiction.stages.laws.slopes`, of results of the laws.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import xarray as xr

from stiction.analysis.shifts import STEPS, bracketed
from stiction.models import MODE_QUANTITIES, SHIFTS
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import PatchChange
from stiction.stages.surfaces import measured_heights
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs


@dataclass(frozen=True)
class Settings(pairs.Settings):
    """Settings of the contact, and the standard uncertainty of the quantity if it is stated or assumed."""

    deviation: float = 0.0  #: [-]; of ln rms, skewness, kurtosis, ln corner or slope


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]],
    pair: str,
    surface: str,
    quantity: str,
    settings: Settings,
    estimate: xr.Dataset | None = None,
) -> list[xr.Dataset]:
    """Contact with less and with more of a quantity, in this order. The samples have the same random numbers.

    The two surfaces and the pair are as in stage contact. The named surface has the quantity, a key of
    `stiction.analysis.shifts.STEPS`, shifted; on both sides of the pair if both have this surface. With an estimate,
    its heights are the measured ones, around which their modes are shifted.
    """
    heights, spectrum = surfaces[settings.surfaces.index(surface)]
    if estimate is not None:
        heights = measured_heights.compute(estimate, surface, "measured")
    shifted, difference = bracketed(description(heights, spectrum), quantity, settings.deviation)
    changed = [drawn_as(surface, settings.sampling.spacing) for surface in shifted]
    alternatives = [
        [other if name == surface else same for name, same in zip(settings.surfaces, surfaces, strict=True)]
        for other in changed
    ]
    contacts = stage_contact.compute_each(alternatives, pair, "NG", settings)
    return [contact.assign(difference=((), difference)) for contact in contacts]


def from_surfaces(
    data: Mapping[str, Any], pair: str, surface: str, quantity: str, settings: Settings
) -> list[xr.Dataset]:
    """Compute from the datasets of both surfaces by stage, and from the estimate if there is one."""
    return compute(sides_of(data), pair, surface, quantity, settings, data.get("estimate"))


def difference(contact: xr.Dataset) -> float:
    """Difference of the quantity between both sides, see `stiction.analysis.shifts.bracketed`."""
    return float(contact.difference)


def is_large(contact: xr.Dataset, quantity: str) -> bool:
    """Whether both sides are farther apart than for a slope: as far around the surface as its uncertainty."""
    return difference(contact) > 2 * STEPS[quantity] * (1 + 1e-9)


def _with_estimate(plan, at, _name_of):
    """Two surfaces, and the estimate of the surface if one of its modes is shifted.

    Modes are those of the measured heights, which the surface may not have.
    """
    estimate = {"estimate": f"estimate/{at.surface}"} if at.quantity in MODE_QUANTITIES[1:] else {}
    return surface_inputs(plan, at.pair) | estimate


def _settings(plan, at, patch_kind):
    """Settings of a patch, with an uncertainty that is larger than the step of the quantity."""
    deviation = plan.deviation(at.surface, at.quantity)
    larger_step = {"deviation": deviation} if deviation > STEPS[at.quantity] else {}
    return patch_kind.settings(plan, at, patch_kind.changed(plan, at)) | larger_step


#: A quantity of one surface.
QUANTITY = PatchChange(
    words="with less and more {quantity} of {surface}",
    end="_{surface}_{quantity}_{each}",
    each=lambda plan: SHIFTS,
    inputs=_with_estimate,
    settings=_settings,
    kind=Settings,
    compute=from_surfaces,
)

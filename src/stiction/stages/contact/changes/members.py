"""Contact of a pair with a whole typical surface in place of one that is partly assumed.

The member has what is stated of the surface, and all that is assumed from one typical surface
(`stiction.config.surfaces.members`). The other surface has the same random numbers, and so has the member if its
cut-off is that of the surface.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import xarray as xr

from stiction.analysis.shifts import like
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import pairs
from stiction.stages.contact.changes.patches import TIPS, PatchChange, PatchKind
from stiction.stages.surfaces.descriptions import description, drawn_as
from stiction.stages.surfaces.rough_surfaces import sides_of

#: Tips on members, as a multiple of those for slopes: they show the lengths that few tips hold. README's lever needs
#: 300: its sizes to build by 100, 180, 240 and 300 are 159.8, 157.4, 161.3 and 162.9 µm.
_TIPS = 3


@dataclass(frozen=True)
class AssumedQuantities:
    """Assumed quantities of a member."""

    rms: float | None = None  #: [m]
    skewness: float | None = None  #: [-]
    kurtosis: float | None = None  #: [-]
    corner: float | None = None  #: [rad m⁻¹]
    slope: float | None = None  #: [-]
    cutoff: float | None = None  #: [rad m⁻¹]

    @property
    def values(self) -> dict[str, float]:
        """Quantities with a value, by name."""
        return {name: value for name, value in vars(self).items() if value is not None}


@dataclass(frozen=True)
class Settings(pairs.Settings):
    """Settings of the contact, and the member."""

    whole: AssumedQuantities = AssumedQuantities()


def compute(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, surface: str, settings: Settings
) -> xr.Dataset:
    """Contact with the member in place of the named surface, on both sides of the pair if both have this surface.

    The two surfaces and the pair are as in stage contact.
    """
    original = description(*surfaces[settings.surfaces.index(surface)])
    member = drawn_as(like(original, settings.whole.values), settings.sampling.spacing)
    sides = [member if name == surface else same for name, same in zip(settings.surfaces, surfaces, strict=True)]
    return stage_contact.compute(sides, pair, "NG", settings)


def from_surfaces(data: Mapping[str, Any], pair: str, surface: str, settings: Settings) -> xr.Dataset:
    """Compute from the datasets of both surfaces by stage."""
    return compute(sides_of(data), pair, surface, settings)


#: Keys of settings by the words of assumed quantities.
_KEYS = {
    "rms": "rms_nm",
    "skewness": "skewness",
    "kurtosis": "kurtosis",
    "corner": "corner_rad_per_um",
    "hurst": "slope",
    "cutoff": "cutoff_rad_per_um",
}


def samples_on(patch_kind: PatchKind, plan: Any, at: Any) -> int:
    """Number of samples on a member: of tips more than on changed surfaces, but no more than on the unchanged one."""
    fewer = patch_kind.fewer(plan, at)
    return min(_TIPS * fewer, patch_kind.samples(plan, at)) if patch_kind is TIPS else fewer


def _settings(plan, at, patch_kind):
    """Settings of a patch, and the numbers of the member with as many digits as those of surfaces in normal form."""
    member = plan.devices.members_of(at.surface)[at.member]
    quantities = {_KEYS[word]: float(f"{value:.9g}") for word, value in member.items()}
    return patch_kind.settings(plan, at, samples_on(patch_kind, plan, at)) | {"whole": quantities}


#: A whole typical surface in place of one surface.
MEMBER = PatchChange(
    words="with {member} in place of the partly assumed {surface}",
    end="_{surface}_like_{member}",
    settings=_settings,
    kind=Settings,
    compute=from_surfaces,
)

"""Contact of a pair under a variant, i.e. one changed model choice; independent of humidity, as in stage contact."""

from collections.abc import Mapping
from dataclasses import dataclass

import xarray as xr

from stiction.stages import contact as stage_contact
from stiction.stages import heights as stage_heights
from stiction.stages import spectrum as stage_spectrum
from stiction.stages.pairs import Contact, Solid
from stiction.stages.surfaces import Sampling, Width
from stiction.surface.spectrum import CutoffSelfAffine


@dataclass(frozen=True)
class Surface:
    """Description of one surface from which it is drawn."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: [-]
    psd: str  #: source of the spectrum, ``published`` or ``identified``
    published_psd: CutoffSelfAffine | None = None  #: Eq. (7)


@dataclass(frozen=True)
class Sides:
    """Names of the two surfaces of a pair."""

    beam: str
    substrate: str


@dataclass(frozen=True)
class Settings:
    """Everything that the contact of a pair depends on, including its surfaces."""

    seed: int
    sampling: Sampling
    solid: Solid
    van_der_waals: str
    contact: Contact
    beam: Width
    pairs: dict[str, Sides]
    surfaces: dict[str, Surface]


def compute(identifications: Mapping[str, xr.Dataset], pair: str, base: Settings, changed: Settings) -> xr.Dataset:
    """Contact under the changed settings, of the same surfaces as the base, even if drawn on a different grid.

    Parameters
    ----------
    identifications : dict
        Datasets of stage identification by name, of the surfaces whose spectrum is identified.
    pair : str
    base, changed : Settings
        Settings without and with the change of the variant.

    Raises
    ------
    ValueError
        If an identified spectrum must not be used, see `stiction.stages.spectrum.refuse_misuse`.
    """
    for name, identification in identifications.items():
        stage_spectrum.refuse_misuse(
            identification, stage_spectrum.Use(name, changed.sampling.strip_length, changed.sampling.margin)
        )
    surfaces = surfaces_of(base.pairs[pair], base.surfaces, base.sampling.spacing, identifications)
    return stage_contact.compute(surfaces, pair, "NG", changed)


def surfaces_of(
    sides: Sides, surfaces: Mapping[str, Surface], spacing: float, identifications: Mapping[str, xr.Dataset]
) -> list[tuple[xr.Dataset, xr.Dataset]]:
    """Datasets (heights, spectrum) of the surfaces of beam and substrate, computed by their stages.

    Parameters
    ----------
    sides : Sides
    surfaces : dict
        Descriptions of the surfaces by name.
    spacing : float
        Of the grid of the surfaces [m].
    identifications : dict
        Datasets of stage identification by name, of the surfaces whose spectrum is identified.
    """
    return [_datasets(surfaces[name], spacing, identifications.get(name)) for name in (sides.beam, sides.substrate)]


def _datasets(surface, spacing, identification):
    """Datasets of stages heights and spectrum of one surface."""
    heights = stage_heights.compute(stage_heights.Settings(surface.rms, surface.skewness, surface.kurtosis))
    psd = surface.published_psd if surface.psd == "published" else "identified"
    return heights, stage_spectrum.compute(heights, identification, stage_spectrum.Settings(spacing, psd))

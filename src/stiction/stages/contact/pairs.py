"""Pairs of rough surfaces in contact, from the datasets of stages heights and spectrum.

Contacts, full contact, plasticity and variants draw their samples from the same pairs.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

import numpy as np
import xarray as xr

from stiction.config.cases import PairInAir
from stiction.contact.asperity import Asperity
from stiction.contact.materials import Solid
from stiction.contact.pair import Definition, EquivalentSurface, SurfacePair
from stiction.contact.probes.pair import ProbedPair
from stiction.contact.probes.shape import Probe
from stiction.contact.solids import asperity_between
from stiction.contact.tilt import Tilt
from stiction.contact.tilted import TiltedPair
from stiction.models import SIDES
from stiction.stages.surfaces.rough_surfaces import Sampling, Width, rough_surface
from stiction.streams import stream
from stiction.surface.replica import Coherence, Replica

#: Materials of beam and substrate by side, where section ``solid`` does not hold for both.
SolidBySide = dict[str, Solid]


@dataclass(frozen=True)
class Contact:
    """Discretisation of the contact (Sec. III-A)."""

    distance_step: float  #: step of the distance between the mean planes [m]
    every: int  #: n: contact is computed on every n-th point of the grid
    samples: int | None = None  #: number of surface pairs
    asperity: str = "summit"  #: what an asperity is, see `stiction.contact.pair.Definition`


class Surfaces(Protocol):
    """Sections of the settings of any job with drawn pairs of surfaces."""

    sampling: Sampling
    contact: Contact
    beam: Width
    replica: Coherence | None


class Solids(Protocol):
    """Sections of the settings of any job with forces of summits."""

    solid: Solid
    van_der_waals: str
    materials: SolidBySide


@dataclass(frozen=True)
class Settings:
    """Settings of the contact of a pair, without its surfaces and independent of humidity."""

    seed: int
    sampling: Sampling
    solid: Solid
    van_der_waals: str
    contact: Contact
    beam: Width
    surfaces: tuple[str, ...] = ()  #: names of the two surfaces; they do not affect the results
    materials: SolidBySide = field(default_factory=dict)
    tilt: Tilt | None = None  #: of the tips of beams, with the step of their distances; none for surfaces without slope
    replica: Coherence | None = None  #: of the beam's underside and the substrate, if one follows the other
    probe: Probe | None = None  #: in place of a flat


def sides_of_strip(settings: Surfaces) -> tuple[float, float]:
    """Length along the beam and width of a strip [m]."""
    return settings.sampling.strip_length, settings.beam.width


def bodies(settings: Solids) -> tuple[Solid, Solid]:
    """Materials of beam and substrate: as stated by side, otherwise section ``solid``."""
    return tuple(settings.materials.get(side, settings.solid) for side in SIDES)


def asperity_of(settings: Solids) -> Asperity:
    """Model of one summit of the two bodies."""
    return asperity_between(*bodies(settings), settings.van_der_waals)


def equivalent_surface(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], model: str, settings: Surfaces
) -> EquivalentSurface:
    """Sum of two surfaces from their (heights, spectrum) datasets, the beam's first."""
    grid = settings.sampling.strips(settings.beam.width)
    beam, substrate = (rough_surface(heights, spectrum, model, grid) for heights, spectrum in surfaces)
    return EquivalentSurface(
        beam, substrate, *_discretisation(settings.contact), replica=_replica(beam, substrate, settings.replica)
    )


def _replica(beam, substrate, coherence):
    """Both surfaces drawn together, if the beam's follows the substrate's."""
    return Replica(beam, substrate, coherence) if coherence else None


def _discretisation(contact):
    """Step of the distances, every n-th point, and the definition of an asperity."""
    return contact.distance_step, contact.every, Definition(contact.asperity)


def surface_pair(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], model: str, settings: Settings) -> SurfacePair:
    """Pair of surfaces from their (heights, spectrum) datasets, the beam's first."""
    return surface_pairs([surfaces], model, settings)[0]


def surface_pairs(
    alternatives: Sequence[Sequence[tuple[xr.Dataset, xr.Dataset]]], model: str, settings: Settings
) -> list[SurfacePair]:
    """Pairs of surfaces from datasets as of `surface_pair`. Equal tuples of datasets give the same object."""
    grid, solid = settings.sampling.strips(settings.beam.width), asperity_of(settings)
    distinct = {id(datasets): datasets for surfaces in alternatives for datasets in surfaces}
    built = {key: rough_surface(*datasets, model, grid) for key, datasets in distinct.items()}
    build = partial(SurfacePair, asperity=solid)
    if settings.tilt:
        build = partial(TiltedPair, asperity=solid, tilt=settings.tilt)
    if settings.probe:
        build = partial(ProbedPair, asperity=solid, probe=settings.probe)
    sides_of_pairs = ([built[id(datasets)] for datasets in surfaces] for surfaces in alternatives)
    return [
        build(*sides, *_discretisation(settings.contact), replica=_replica(*sides, settings.replica))
        for sides in sides_of_pairs
    ]


def require_feasible(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], model: str, settings: Settings) -> None:
    """Refuse a coherence that these surfaces cannot have. ASSUME: slightly changed ones have as much as is feasible."""
    if settings.replica:
        surface_pair(surfaces, model, settings).replica.require_feasible()


def streams_of_sides(seed: int, pair: str) -> Callable[[int], tuple[np.random.Generator, ...]]:
    """Streams of the two surfaces of one sample of a pair, in any air: ``(sample) -> (beam, substrate)``."""
    return lambda sample: tuple(stream(seed, "contact", PairInAir(pair).pair, side, sample) for side in SIDES)

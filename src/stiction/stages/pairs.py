"""Pairs of rough surfaces in contact, from the datasets of stages heights and spectrum.

Separate from `stiction.stages.contact`, because studies use the same pairs for other purposes.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import xarray as xr

from stiction.contact.asperity import asperity, reduced_modulus
from stiction.contact.pair import SurfacePair
from stiction.contact.vanderwaals import attraction
from stiction.models import SIDES
from stiction.stages.surfaces import Sampling, Width, rough_surface
from stiction.streams import stream


@dataclass(frozen=True)
class Solid:
    """Elastic constants of both bodies."""

    young_modulus: float  #: E [Pa]
    poisson_ratio: float  #: ν [-]


@dataclass(frozen=True)
class Contact:
    """Discretisation of the contact (Sec. III-A)."""

    distance_step: float  #: step of the distance between the mean planes [m]
    every: int  #: n: contact is computed on every n-th point of the grid
    samples: int | None = None  #: number of surface pairs


class Settings(Protocol):
    """Sections of the settings of any job that draws pairs of surfaces."""

    sampling: Sampling
    solid: Solid
    van_der_waals: str
    contact: Contact
    beam: Width


def surface_pair(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], model: str, settings: Settings) -> SurfacePair:
    """Pair of surfaces from two (heights, spectrum) datasets, that of the beam first."""
    grid = settings.sampling.strips(settings.beam.width)
    beam, substrate = (rough_surface(heights, spectrum, model, grid) for heights, spectrum in surfaces)
    modulus = reduced_modulus(settings.solid.young_modulus, settings.solid.poisson_ratio)
    solid = asperity(modulus, attraction(settings.van_der_waals))
    return SurfacePair(beam, substrate, solid, settings.contact.distance_step, settings.contact.every)


def streams_of_sides(seed: int, pair: str) -> Callable[[int], tuple[np.random.Generator, ...]]:
    """Streams of the two surfaces of one sample of a pair: ``(sample) -> (beam, substrate)``."""
    return lambda sample: tuple(stream(seed, "contact", pair, side, sample) for side in SIDES)

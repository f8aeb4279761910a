"""Nominal beams from the settings of a job."""

from dataclasses import dataclass
from typing import Any

from stiction.beam.cantilever import Beam
from stiction.plan.stage import select


@dataclass(frozen=True)
class Stiffness:
    """Section ``solid``: part for beams."""

    young_modulus: float  #: E [Pa]


@dataclass(frozen=True)
class Dimensions:
    """Nominal cantilever and its mesh."""

    length: float  #: L [m]
    width: float  #: w [m]
    thickness: float  #: t [m]
    elements: int  #: N_e
    samples: int | None = None  #: number of beams


@dataclass(frozen=True)
class Gap:
    """Section of a pair: part for beams."""

    gap: float  #: h [m]
    young_modulus: float | None = None  #: E of the beam, if it is not that of section ``solid`` [Pa]


@dataclass(frozen=True)
class StripLength:
    """Section ``sampling``: part for beams."""

    strip_length: float  #: l_meso [m]


@dataclass(frozen=True, kw_only=True)
class Cantilevers:
    """Sections of the settings of any job with beams: sources of the nominal beams of some pairs."""

    solid: Stiffness
    beam: Dimensions
    pairs: dict[str, Gap]


def cantilever(settings: Cantilevers, pair: str) -> Beam:
    """Nominal beam of a pair."""
    size, of_pair = settings.beam, settings.pairs[pair]
    return Beam(
        length=size.length,
        width=size.width,
        thickness=size.thickness,
        young_modulus=of_pair.young_modulus or settings.solid.young_modulus,
        gap=of_pair.gap,
        elements=size.elements,
    )


def strips_along(beam: Dimensions, sampling: StripLength) -> int:
    """Number of force laws along a beam, N_p."""
    return round(beam.length / sampling.strip_length)


def sections(plan: Any, *pairs: str) -> dict[str, Any]:
    """Sections of the configuration for `cantilever`, the nominal beams of pairs."""
    sizes = select(Dimensions, plan.config["beam"])
    gaps = {pair: select(Gap, plan.config["pairs"][pair] | plan.materials.stated_modulus(pair)) for pair in pairs}
    del sizes["samples"]  # the number of beams does not affect a nominal beam
    return {"solid": select(Stiffness, plan.config["solid"]), "beam": sizes, "pairs": gaps}

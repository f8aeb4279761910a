"""Rough surfaces for drawing samples, from the datasets of stages heights and spectrum."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import xarray as xr

from stiction.stages.surfaces.heights import density, moments
from stiction.stages.surfaces.spectrum import underlying
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.translation import Translation


@dataclass(frozen=True)
class Sampling:
    """Grid of the generated surfaces (Sec. II-B)."""

    spacing: float  #: of the heights [m]
    strip_length: float  #: l_meso [m]
    margin: float  #: width of the periodic field beyond the strip [m]

    def strips(self, width: float) -> StripGrid:
        """Grid of strips l_meso x ``width`` [m]."""
        return StripGrid(self.strip_length, width, self.spacing, self.margin)


@dataclass(frozen=True)
class Width:
    """Section ``beam``: part for surfaces and contact."""

    width: float  #: w [m]


def rough_surface(heights: xr.Dataset, spectrum: xr.Dataset, model: str, grid: StripGrid) -> RoughSurface:
    """Rough surface of model ``NG`` or ``G`` on a grid."""
    return RoughSurface(underlying(spectrum, model), Translation(density(heights, model)), moments(heights).rms, grid)


def surface_inputs(plan: Any, pair: str) -> dict[str, list[str]]:
    """Names of the datasets of both surfaces of a pair, by stage, for `sides_of`."""
    return {stage: [f"{stage}/{name}" for name in plan.sides(pair)] for stage in ("heights", "spectrum")}


def sides_of(data: Mapping[str, Sequence[xr.Dataset]]) -> list[tuple[xr.Dataset, xr.Dataset]]:
    """Datasets (heights, spectrum) of beam and substrate. A surface on both sides is one tuple."""
    pairs = {
        id(heights): (heights, spectrum) for heights, spectrum in zip(data["heights"], data["spectrum"], strict=True)
    }
    return [pairs[id(heights)] for heights in data["heights"]]

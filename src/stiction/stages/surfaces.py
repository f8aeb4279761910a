"""Rough surfaces, from which samples are drawn, from the datasets of stages heights and spectrum."""

from dataclasses import dataclass

import xarray as xr

from stiction.stages.heights import density, moments
from stiction.stages.spectrum import underlying
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
    """The part of section ``beam`` on which surfaces and contact depend."""

    width: float  #: w [m]


def rough_surface(heights: xr.Dataset, spectrum: xr.Dataset, model: str, grid: StripGrid) -> RoughSurface:
    """Rough surface of model ``NG`` or ``G`` on a grid."""
    return RoughSurface(underlying(spectrum, model), Translation(density(heights, model)), moments(heights).rms, grid)

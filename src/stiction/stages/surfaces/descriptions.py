"""Surfaces described by numbers, to be changed and drawn again."""

import xarray as xr

from stiction.analysis.shifts import Description
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import parameters
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.surface.empirical import MeasuredDensity


def description(heights: xr.Dataset, spectrum: xr.Dataset) -> Description:
    """Heights and spectrum of a surface from its datasets of stages heights and spectrum."""
    moments, density = stage_heights.moments(heights), stage_heights.density(heights, "NG")
    form = density if isinstance(density, MeasuredDensity) else None
    return Description(moments.rms, moments.skewness, moments.kurtosis, parameters.spectrum_of(spectrum), form)


def drawn_as(surface: Description, spacing: float) -> tuple[xr.Dataset, xr.Dataset]:
    """Datasets of stages heights and spectrum of a surface on a grid of this spacing [m]."""
    moments = stage_heights.Settings(surface.rms, surface.skewness, surface.kurtosis)
    measured = surface.form is not None
    heights = stage_heights.layout(surface.form, moments) if measured else stage_heights.compute(moments)
    return heights, stage_spectrum.on_grid(surface.spectrum, heights, spacing)

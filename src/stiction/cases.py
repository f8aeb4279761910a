"""Rough surfaces from the configuration and from datasets: the way back into the theory."""

from stiction.maxent import GAUSSIAN, HeightDensity
from stiction.spectrum import CutoffSelfAffine, TabulatedSpectrum
from stiction.surfaces import RoughSurface, StripGrid
from stiction.translation import Translation
from stiction.units import si


def density(heights, model):
    """Height density of model ``NG`` (from the dataset of stage heights) or ``G``."""
    return HeightDensity(tuple(map(float, heights.multiplier))) if model == "NG" else GAUSSIAN


def target_spectrum(spectrum):
    """Eq. (7) from the dataset of stage spectrum."""
    return CutoffSelfAffine(**{name: float(spectrum[name]) for name in ("plateau", "floor", "corner", "cutoff")})


def rough_surface(heights, spectrum, model, grid):
    """Surface of model ``NG`` or ``G`` from the datasets of stages heights and spectrum, on a grid."""
    underlying = target_spectrum(spectrum)
    if model == "NG":
        underlying = TabulatedSpectrum(spectrum.wavenumber.values, spectrum.underlying.values, underlying.cutoff)
    return RoughSurface(underlying, Translation(density(heights, model)), float(heights.rms), grid)


def strip_grid(sampling, beam_width):
    """Grid of the strips l_meso x w, from sections sampling and beam."""
    entry = si(sampling)
    return StripGrid(entry["strip_length"], beam_width, entry["spacing"], entry["margin"])

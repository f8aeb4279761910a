"""Rough surfaces from the configuration and from datasets: the way back into the theory."""

from stiction.config.units import si
from stiction.stages import data
from stiction.surface import maxent
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.maxent import GAUSSIAN, HeightDensity
from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum
from stiction.surface.translation import Translation, spectrum_of_heights, underlying_spectrum

SIDES = ("beam", "substrate")
MOMENTS = ("rms", "skewness", "kurtosis")


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


def surface(moments, target, spacing):
    """One rough surface, as the datasets of stages heights and spectrum (Sec. II-A and II-B).

    Parameters
    ----------
    moments : dict
        rms [m], skewness, kurtosis.
    target : CutoffSelfAffine
        Spectrum of the heights; only its shape counts.
    spacing : float
        Of the grid on which the surface will be drawn [m].
    """
    density = maxent.solve(moments["skewness"], moments["kurtosis"])
    return data.heights(density, moments), spectrum(density, target, spacing)


def spectrum(density, target, spacing):
    """Dataset of stage spectrum of a surface with this density (Sec. II-B); the rest as in `surface`."""
    translation = Translation(density)
    underlying, defect = underlying_spectrum(target, translation, spacing)
    achieved = spectrum_of_heights(underlying, translation, spacing)
    return data.spectrum(target, underlying, achieved, defect)


def surfaces_of(config, pair, identified=()):
    """Datasets (heights, spectrum) of the beam's and of the substrate's surface of a pair.

    Parameters
    ----------
    config : dict
        Sections sampling, pairs and surfaces.
    pair : str
    identified : dict
        Spectra of the surfaces whose psd is not the published one, by name.

    Raises
    ------
    ValueError
        If one of these is missing.
    """
    spacing, surfaces = si(config["sampling"])["spacing"], []
    for name in (config["pairs"][pair][side] for side in SIDES):
        entry = si(config["surfaces"][name])
        published = entry["psd"] == "published"
        if not published and name not in identified:
            raise ValueError(f"the spectrum of {name} has to be identified first, see stiction.stages.identifications")
        target = CutoffSelfAffine(**si(entry["published_psd"])) if published else identified[name]
        surfaces.append(surface({key: entry[key] for key in MOMENTS}, target, spacing))
    return tuple(surfaces)

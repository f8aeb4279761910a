"""Spectra from summits (Sec. II-C) as the configuration asks for them."""

from stiction.config.units import si
from stiction.stages import data
from stiction.stages.cases import MOMENTS, SIDES, density, target_spectrum
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.field import StripGrid
from stiction.surface.identify import SummitTarget, identify
from stiction.surface.translation import Translation


def identification(name, heights, settings):
    """Stage identification: Eq. (7) fitted to radius and density of a surface's summits (Sec. II-C).

    Parameters
    ----------
    name : str
        Of the surface, part of the addresses of random numbers.
    heights : Dataset
        Stage heights.
    settings : dict
        seed, section identification, target with mean_summit_radius_um and summit_density_per_um2, and the spacings of
        the grid of the patches, spacing_nm, and of that on which summits were measured, target_spacing_nm.
    """
    wanted, patch, spacing = (
        si(settings["target"]),
        si(settings["identification"]),
        si({key: settings[key] for key in ("spacing_nm", "target_spacing_nm")}),
    )
    target = SummitTarget(
        float(heights.rms), wanted["mean_summit_radius"], wanted["summit_density"], spacing["target_spacing"]
    )
    grid = StripGrid(patch["patch"], patch["patch"], spacing["spacing"], margin=0.0)

    def patches(*address):
        return lambda: (stream(settings["seed"], "identification", name, *address, k) for k in range(patch["patches"]))

    found = identify(target, Translation(density(heights, "NG")), grid, patches(), patches("control"))
    return data.identification(found, target)


def identified_spectra(config, pair):
    """Spectra of those surfaces of a pair whose psd is to be identified, by name.

    Parameters
    ----------
    config : dict
        Sections seed, sampling, identification, character, pairs and surfaces.
    pair : str
    """
    entries = {name: config["surfaces"][name] for name in (config["pairs"][pair][side] for side in SIDES)}
    return {name: _spectrum(name, entry, config) for name, entry in entries.items() if entry["psd"] == "identified"}


def _spectrum(name, entry, config):
    """Spectrum of one surface from its section of the configuration."""
    moments = {key: si(entry)[key] for key in MOMENTS}
    heights = data.heights(maxent.solve(moments["skewness"], moments["kurtosis"]), moments)
    settings = {
        "seed": config["seed"],
        "identification": config["identification"],
        "spacing_nm": config["sampling"]["spacing_nm"],
        "target_spacing_nm": config["character"]["spacing_nm"],
        "target": {key: entry[key] for key in ("mean_summit_radius_um", "summit_density_per_um2")},
    }
    return target_spectrum(identification(name, heights, settings))

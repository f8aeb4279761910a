"""Stage identification (Sec. II-C): Eq. (7) fitted to the radius and density of the summits of a surface."""

from collections.abc import Mapping
from dataclasses import dataclass

import xarray as xr

from stiction.stages import parameters
from stiction.stages.heights import density, moments
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.identify import Identification, SummitTarget, identify
from stiction.surface.spectrum import CutoffSelfAffine, correlation_length
from stiction.surface.translation import Translation


@dataclass(frozen=True)
class Patches:
    """Square patches of surface on which a trial spectrum is evaluated."""

    patches: int  #: number of patches
    patch: float  #: side [m]


@dataclass(frozen=True)
class Summits:
    """Measured summit statistics."""

    mean_summit_radius: float  #: [m]
    summit_density: float  #: [m⁻²]


@dataclass(frozen=True)
class Settings:
    """Everything that an identification depends on apart from the height density."""

    seed: int
    identification: Patches
    target: Summits
    spacing: float  #: of the patches [m]
    target_spacing: float  #: at which the summits were measured [m]


def compute(heights: xr.Dataset, surface: str, settings: Settings) -> xr.Dataset:
    """Parameters of Eq. (7), simulated summit statistics and their targets.

    Parameters
    ----------
    heights : Dataset
        Dataset of stage heights.
    surface : str
        Name of the surface, part of the addresses of random numbers.
    settings : Settings

    Raises
    ------
    ValueError
        If a patch is no longer than the correlation length of the identified spectrum.
    """
    patch, summits = settings.identification.patch, settings.target
    wanted = summits.mean_summit_radius, summits.summit_density
    target = SummitTarget(moments(heights).rms, *wanted, settings.target_spacing)
    grid = StripGrid(patch, patch, settings.spacing, margin=0.0)

    def patches(*address):
        address = (settings.seed, "identification", surface, *address)
        return lambda: (stream(*address, k) for k in range(settings.identification.patches))

    found = identify(target, Translation(density(heights, "NG")), grid, patches(), patches("control"))
    refuse_long_correlation(surface, found.spectrum, {"identification.patch_um": patch})
    return layout(found, target)


def refuse_long_correlation(surface: str, spectrum: CutoffSelfAffine, lengths: Mapping[str, float]) -> None:
    """Raise a ValueError if the heights are correlated over any of the lengths, by key of the configuration [m].

    The same law as for published spectra, see `stiction.config.relations.length_exceeds_the_correlation`.
    """
    bound = correlation_length(spectrum)
    for key, length in lengths.items():
        if length <= bound:
            raise ValueError(
                f"{key} is {1e6 * length:.4g}, must be above the correlation length of surface {surface}, "
                f"{1e6 * bound:.3g} µm for the spectrum identified from its summits"
            )


def misfits(identification: xr.Dataset) -> dict[str, tuple[float, float]]:
    """Radius and density of the summits of the identified spectrum relative to the measured ones.

    Returns
    -------
    dict
        ``radius`` and ``density``: the relative deviation and its standard error [-].
    """
    names = {"radius": "mean_radius", "density": "summit_density"}
    return {
        word: tuple(
            float(part / identification[f"target_{name}"])
            for part in (identification[name] - identification[f"target_{name}"], identification[f"{name}_error"])
        )
        for word, name in names.items()
    }


def layout(found: Identification, target: SummitTarget) -> xr.Dataset:
    """Dataset of the parameters of Eq. (7), simulated summit statistics and those asked for."""
    return parameters.variables(found.spectrum).assign(
        mean_radius=((), found.mean_radius, {"units": "m"}),
        mean_radius_error=((), found.mean_radius_error, {"units": "m"}),
        summit_density=((), found.density, {"units": "m-2"}),
        summit_density_error=((), found.density_error, {"units": "m-2"}),
        target_mean_radius=((), target.mean_radius, {"units": "m"}),
        target_summit_density=((), target.density, {"units": "m-2"}),
        target_rms=((), target.rms, {"units": "m"}),
        evaluations=((), found.evaluations),
    )

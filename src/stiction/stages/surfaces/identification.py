"""Stage identification (Sec. II-C): Eq. (7) fitted to the radius and density of the summits of a surface."""

from dataclasses import dataclass

import xarray as xr

from stiction.plan.stage import Running, Stage, select
from stiction.stages.surfaces import parameters
from stiction.stages.surfaces.heights import density, moments
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.identify import Identification, SummitTarget, identify
from stiction.surface.translation import Translation


@dataclass(frozen=True)
class Patches:
    """Square patches of surface for the evaluation of a trial spectrum."""

    patches: int  #: number of patches
    patch: float  #: side [m]


@dataclass(frozen=True)
class SummitTargets:
    """Measured summit statistics."""

    mean_summit_radius: float  #: [m]
    summit_density: float  #: [m⁻²]


@dataclass(frozen=True)
class Settings:
    """Settings of an identification, without the height density."""

    seed: int
    identification: Patches
    target: SummitTargets
    spacing: float  #: of the patches [m]
    target_spacing: float  #: at which the summits were measured [m]


def compute(heights: xr.Dataset, surface: str, settings: Settings) -> xr.Dataset:
    """Parameters of Eq. (7), simulated summit statistics and their targets.

    Raises
    ------
    ValueError
        If a patch is no longer than the correlation length of the identified spectrum.
    """
    patch, summits = settings.identification.patch, settings.target
    statistics = summits.mean_summit_radius, summits.summit_density
    target = SummitTarget(moments(heights).rms, *statistics, settings.target_spacing)
    grid = StripGrid(patch, patch, settings.spacing, margin=0.0)

    def patches(*address):
        """Streams of the random numbers of all patches, the same at every call."""
        numbers = range(settings.identification.patches)
        return lambda: (stream(settings.seed, "identification", surface, *address, k) for k in numbers)

    identified = identify(target, Translation(density(heights, "NG")), grid, patches(), patches("control"))
    parameters.refuse_long_correlation(surface, identified.spectrum, {"identification.patch_um": patch})
    return layout(identified, target)


def layout(identified: Identification, target: SummitTarget) -> xr.Dataset:
    """Dataset of the parameters of Eq. (7), simulated summit statistics and those asked for."""
    return parameters.variables(identified.spectrum).assign(
        mean_radius=((), identified.mean_radius),
        mean_radius_error=((), identified.mean_radius_error),
        summit_density=((), identified.density),
        summit_density_error=((), identified.density_error),
        target_mean_radius=((), target.mean_radius),
        target_summit_density=((), target.density),
        target_rms=((), target.rms),
        evaluations=((), identified.evaluations),
    )


STAGES = (
    Stage.writing(
        "identification",
        "identification/{surface}",
        inputs=lambda plan, at: {"heights": f"heights/{at.surface}"},
        settings=lambda plan, at: select(
            Settings,
            plan.config,
            spacing_nm=plan.config["sampling"]["spacing_nm"],
            target_spacing_nm=plan.config["character"]["spacing_nm"],
            target=select(SummitTargets, plan.config["surfaces"][at.surface]),
        ),
        kind=Settings,
        compute=compute,
        message="Identify the spectrum of {surface} from its summits (Sec. II-C).",
        running=Running(minutes=10),
    ),
)

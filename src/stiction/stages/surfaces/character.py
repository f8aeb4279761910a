"""Stage character (Table I): statistics of simulated surfaces, sampled at the interval of the microscope."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.estimates import jackknife
from stiction.models import FIELD
from stiction.plan.stage import Running, Stage, select
from stiction.progress import progress
from stiction.scans.moments import central_moments
from stiction.stages.surfaces.rough_surfaces import Sampling, Width, rough_surface
from stiction.streams import stream
from stiction.surface.field import RoughSurface, StripGrid, radial_periodogram
from stiction.surface.summits import find_summits

#: Number of periodic fields for the spectrum, and points along a side of the patch for the figures.
_FIELDS, _PATCH = 8, 300
#: Number of summits stored for the joint density of height and radius.
_KEPT = 20_000


@dataclass(frozen=True)
class StripSample:
    """Sample for the surface statistics."""

    strips: int  #: number of strips
    spacing: float  #: of the heights among which summits are detected [m]


@dataclass(frozen=True)
class Settings:
    """Settings of the statistics, without the surface."""

    seed: int
    sampling: Sampling
    character: StripSample
    beam: Width


def compute(heights: xr.Dataset, spectrum: xr.Dataset, surface: str, model: str, settings: Settings) -> xr.Dataset:
    """Draw strips and store their moments and summits. Draw periodic fields and store their spectra and a patch."""
    grid = settings.sampling.strips(settings.beam.width)
    rough = rough_surface(heights, spectrum, model, grid)
    strips, summits = _strips(rough, surface, settings)
    field = rough_surface(heights, spectrum, model, StripGrid.periodic(FIELD, grid.spacing))
    fields = [field.draw(stream(settings.seed, "character", surface, "field", k)) for k in range(_FIELDS)]
    wavenumbers, densities = zip(*(radial_periodogram(z, grid.spacing) for z in fields), strict=True)
    patch = grid.spacing, fields[0][:_PATCH, :_PATCH]
    return layout(strips, (wavenumbers[0], list(densities)), np.hstack(summits)[:, :_KEPT], patch)


def layout(
    strips: dict, fields: tuple[np.ndarray, Sequence], summits: Sequence[np.ndarray], patch: tuple[float, np.ndarray]
) -> xr.Dataset:
    """Dataset of the statistics of simulated surfaces.

    Strips have powers of the heights (n, 4) [m^k], summit_density (n,) [m⁻²] and mean_curvature (n,) [m⁻¹], NaN in a
    strip without a summit. Periodic fields have wave numbers (n_ζ,) [rad m⁻¹] and periodograms (n_f, n_ζ) [m⁴], some
    summits heights [m] and curvatures [m⁻¹], (n_s,) each, and one patch a spacing [m] and heights (n_x, n_y) [m].
    """
    wavenumber, periodogram = fields
    spacing, heights = patch
    x, y = (np.arange(n) * spacing for n in heights.shape)
    return xr.Dataset(
        {
            "power": (("strip", "order"), strips["power"]),
            "summit_density": ("strip", strips["summit_density"]),
            "mean_curvature": ("strip", strips["mean_curvature"]),
            "periodogram": (("field", "wavenumber"), periodogram),
            "summit_height": ("summit", np.asarray(summits[0], np.float32)),
            "summit_curvature": ("summit", np.asarray(summits[1], np.float32)),
            "elevation": (("x", "y"), np.asarray(heights, np.float32)),
        },
        coords={
            "order": [1, 2, 3, 4],
            "wavenumber": ("wavenumber", wavenumber),
            "x": ("x", x),
            "y": ("y", y),
        },
    )


def statistics(character: xr.Dataset, units: Sequence[float] = (1, 1, 1, 1, 1)) -> tuple[np.ndarray, np.ndarray]:
    """Statistics of Table I of the simulated strips and their standard errors by the jackknife over these.

    Parameters
    ----------
    character : Dataset
    units : sequence of 5 numbers
        Units of the statistics [SI].

    Returns
    -------
    values, errors : (5,) arrays
        Rms [m], skewness [-], kurtosis [-], mean radius [m] and density [m⁻²] of the summits, over the units. The
        radius is that of the strips with a summit; it is NaN without any, and its error with a single one.
    """

    def estimate(mean):
        """Statistics from the means of powers of the heights and of summits, in the units of the tables."""
        *powers, density, curvature, with_summit = mean
        variance, third, fourth = central_moments(*powers)
        rms = np.sqrt(variance)
        radius = with_summit / curvature if with_summit else np.nan
        return np.array([rms, third / rms**3, fourth / rms**4, radius, density]) / units

    density, curvature = character.summit_density.values, character.mean_curvature.values
    with_summit = np.isfinite(curvature)
    # The share of strips with a summit makes the mean curvature over all strips that over these.
    columns = [density, np.where(with_summit, curvature, 0), with_summit]
    return jackknife(estimate, np.column_stack([character.power.values, *columns]))


def _strips(surface: RoughSurface, name: str, settings: Settings):
    """Powers of the heights, density and mean curvature of the summits, and all summits, of every strip."""
    spacing = settings.character.spacing
    every = round(spacing / surface.grid.spacing)
    statistics, summits = {"power": [], "summit_density": [], "mean_curvature": []}, []
    for k in progress(range(settings.character.strips), "strips"):
        z = surface.draw(stream(settings.seed, "character", name, k))[::every, ::every]
        height, curvature, density = find_summits(z, spacing)
        statistics["power"].append([np.mean(z.astype(float) ** order) for order in (1, 2, 3, 4)])
        statistics["summit_density"].append(density)
        statistics["mean_curvature"].append(curvature.mean() if len(curvature) else np.nan)
        summits.append((height, curvature))
    return statistics, summits


STAGES = (
    Stage.writing(
        "character",
        "character/{surface}_{model}",
        inputs=lambda plan, at: {stage: f"{stage}/{at.surface}" for stage in ("heights", "spectrum")},
        settings=lambda plan, at: select(Settings, plan.config),
        kind=Settings,
        compute=compute,
        message="Statistics of simulated {model} surfaces {surface} (Table I).",
        running=Running(minutes=10),
    ),
)

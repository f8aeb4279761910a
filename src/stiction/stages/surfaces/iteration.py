"""Study iteration (Sec. II-B2, Figs. 4 and 10): the iterative algorithm, for comparison with the closed form."""

from dataclasses import dataclass
from itertools import islice

import numpy as np
import xarray as xr

from stiction.models import FIELD
from stiction.plan.stage import Running, Stage, select
from stiction.progress import progress
from stiction.stages.surfaces import parameters
from stiction.stages.surfaces.heights import density
from stiction.stages.surfaces.spectrum import achieved
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.iteration import iterate, misfit, sampling_misfit, target_rings
from stiction.surface.translation import Translation


@dataclass(frozen=True)
class Steps:
    """Size of the study."""

    iterations: int  #: number of iterations
    fields: int  #: periodic fields on which each spectrum is estimated


@dataclass(frozen=True)
class Settings:
    """Settings of the study, without the surface."""

    seed: int
    iteration: Steps
    spacing: float  #: of the fields [m]


def compute(heights: xr.Dataset, spectrum: xr.Dataset, surface: str, settings: Settings) -> xr.Dataset:
    """Run the number of iterations of the settings. Store all spectra, of unit variance, and their misfits."""
    target, numbers = parameters.spectrum_of(spectrum), settings.iteration
    translation = Translation(density(heights, "NG"))
    grid = StripGrid.periodic(FIELD, settings.spacing)
    steps = iterate(target, translation, grid, numbers.fields, stream(settings.seed, "iteration", surface))
    iterations = list(progress(islice(steps, numbers.iterations), "iterations", total=numbers.iterations))
    underlying, periodograms = (np.array(column) for column in zip(*iterations, strict=True))
    zeta, rings = target_rings(target, grid)
    misfits = {
        "misfit": misfit(periodograms.mean(axis=1), rings),
        "sampling_misfit": sampling_misfit(periodograms),
        "closed_form_misfit": misfit(achieved(spectrum, zeta), rings),
    }
    return layout((zeta, rings), (underlying, periodograms), misfits)


def layout(rings: tuple, steps: tuple, misfits: dict) -> xr.Dataset:
    """Dataset of the spectra of the algorithm of Fig. 4, of unit variance, and of their misfits to the target.

    Wave numbers (n,) [rad m⁻¹] with the target (n,) [m²]; per iteration, Gaussian spectra (k, n) and periodograms of
    translated fields (k, fields, n) [m²]; mean errors |ln(s / s_Z)| of a ring: misfit of the estimated spectra (k,),
    sampling_misfit of exact spectra (k,), closed_form_misfit [-].
    """
    (wavenumber, target), (underlying, periodogram) = rings, steps
    return xr.Dataset(
        {
            "target": ("wavenumber", target),
            "underlying": (("iteration", "wavenumber"), underlying),
            "periodogram": (("iteration", "field", "wavenumber"), periodogram),
        }
        | {name: (("iteration",)[: np.ndim(values)], values) for name, values in misfits.items()},
        coords={
            "iteration": np.arange(1, len(underlying) + 1),
            "wavenumber": ("wavenumber", wavenumber),
        },
    )


STAGES = (
    Stage.writing(
        "iteration",
        "iteration/{surface}",
        inputs=lambda plan, at: {stage: f"{stage}/{at.surface}" for stage in ("heights", "spectrum")},
        settings=lambda plan, at: select(
            Settings,
            plan.config,
            iteration=plan.config["studies"]["iteration"],
            spacing_nm=plan.config["sampling"]["spacing_nm"],
        ),
        kind=Settings,
        compute=compute,
        message="Iterative spectrum of {surface}, for comparison with the closed form (Fig. 4).",
        running=Running(minutes=10),
    ),
)

"""Release of the beams of a case: settings, computation and columns of results.

Stage beams, the studies of resampling and of variants, and their figures and tables share it.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.montecarlo import Experiment, released_beams
from stiction.beam.release import EndState
from stiction.beam.resolution import longest, resolved
from stiction.chaos.model import ChaosModel, draw_laws
from stiction.config.cases import Case
from stiction.plan.stage import select
from stiction.stages.beams import cantilevers
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever, strips_along
from stiction.streams import stream

#: Number of force laws from which the elements of the beams of a case are chosen.
_LAWS = 10_000
#: End states of a beam, in the order of their numbers in datasets.
STATES = tuple(state.label for state in EndState)


@dataclass(frozen=True, kw_only=True)
class OnStrips(Cantilevers):
    """Settings of beams on random strips, without their number, their scatter and the force laws."""

    seed: int
    sampling: StripLength
    refined: bool = False  #: whether the elements follow the force laws, as in `stiction.beam.resolution.resolved`


@dataclass(frozen=True, kw_only=True)
class Settings(OnStrips):
    """Settings of the beams of a case, without the force laws."""

    samples: int  #: number of beams
    scatter: float  #: relative standard deviation of each dimension [-]


def without_scatter(settings: OnStrips, samples: int) -> Settings:
    """Settings of this number of beams of nominal dimensions."""
    common = {field.name: getattr(settings, field.name) for field in fields(OnStrips)}
    return Settings(**common, samples=samples, scatter=0)


def released(model: ChaosModel, case: Case, settings: Settings, threads: int = 1, shapes: int = 0) -> dict:
    """Release beams of a case on force laws drawn from a chaos model. Arrays of `stiction.beam.montecarlo.columns`."""
    return released_on(partial(draw_laws, model), case, settings, _streams(settings, case), threads, shapes)


def _streams(settings, case):
    """Streams of the beams of a case by number, and of their mesh."""
    return partial(stream, settings.seed, "beams", case)


def released_on(
    draw: Callable, case: Case, settings: Settings, address: Callable, threads: int = 1, shapes: int = 0
) -> dict:
    """Release beams of a case on force laws drawn by ``draw(n, rng)``. Beam k has the stream ``address(k)``.

    Raises
    ------
    ValueError
        If the strips are too long for the force laws.
    """
    beam, strips = cantilever(settings, case.pair), strips_along(settings.beam, settings.sampling)
    if settings.refined:
        beam = _resolved(beam, strips, draw(_LAWS, address("mesh")), case)
    experiment = Experiment(beam, strips, draw, settings.scatter)
    return released_beams(experiment, settings.samples, address, threads, shapes)


def _resolved(beam, strips, laws, case):
    """`resolved`, with the name of the case added to an error."""
    try:
        return resolved(beam, strips, laws)
    except ValueError as error:
        error.add_note(f"in case {case}")
        raise


def longest_strip(model: ChaosModel, case: Case, settings: OnStrips) -> float:
    """Longest strip for the cracks of a case, on the laws of the mesh of `released` [m]."""
    laws = draw_laws(model, _LAWS, _streams(settings, case)("mesh"))
    return longest(cantilever(settings, case.pair), laws)[0]


def ended(beams: xr.Dataset, state: str) -> np.ndarray:
    """Mark the beams of a dataset by their final state, ``S-shape``, ``arc`` or ``free``, (n,) bool."""
    return beams.state.values == STATES.index(state)


def stuck_lengths(beams: xr.Dataset) -> np.ndarray:
    """Crack lengths of the S-shaped beams of a dataset (m,) [m]. Those of others have no meaning."""
    return beams.crack_length.values[ended(beams, "S-shape")]


def stuck_energies(beams: xr.Dataset) -> np.ndarray:
    """Apparent adhesion energies Γ, Eq. (13), of the S-shaped beams of stage beams (m,) [J m⁻²]."""
    return beams.adhesion_energy.values[ended(beams, "S-shape")]


def sections(plan: Any, case: Case) -> dict[str, Any]:
    """Sections of the configuration for the beams of a case, without their number."""
    strips = select(StripLength, plan.config["sampling"])
    nominal = {"seed": plan.config["seed"], "sampling": strips} | cantilevers.sections(plan, case.pair)
    return nominal | ({} if plan.paper.has_mesh(case) else {"refined": True})

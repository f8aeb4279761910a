"""Release of the beams of a case: settings, computation and columns of results.

Stage beams, the studies of resampling and of variants, and their figures and tables share it.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.energy import apparent_adhesion_energy, arrest_length
from stiction.beam.foundation import LONGER
from stiction.beam.montecarlo import Experiment, Outcome, columns, released_beams, scattered_beam
from stiction.beam.release import EndState, s_shape
from stiction.beam.resolution import longest, resolved
from stiction.chaos.model import ChaosModel, draw_laws
from stiction.config.cases import Case
from stiction.contact import forcelaw
from stiction.plan.stage import select, subsection
from stiction.stages.beams import cantilevers
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever, strips_along
from stiction.streams import stream

#: Number of force laws from which the elements of the beams of a case are chosen.
_LAWS = 10_000
#: End states of a beam, in the order of their numbers in datasets.
STATES = tuple(state.label for state in EndState)
#: Attributes of the numbers of end states, as in the CF conventions.
FLAGS = {"flag_values": np.arange(len(STATES), dtype=np.int8), "flag_meanings": " ".join(STATES)}


@dataclass(frozen=True, kw_only=True)
class OnStrips(Cantilevers):
    """Settings of beams on random strips, without their number, their scatter and the force laws."""

    seed: int
    sampling: StripLength
    coarser_mesh: float = 1.0  #: allowed elements and strips are longer, see `stiction.beam.resolution.resolved` [-]


@dataclass(frozen=True, kw_only=True)
class Settings(OnStrips):
    """Settings of the beams of a case, without the force laws."""

    samples: int  #: number of beams
    scatter: float  #: relative standard deviation of each dimension [-]


def without_scatter(settings: OnStrips, samples: int) -> Settings:
    """Settings of this number of beams of nominal dimensions."""
    common = {field.name: getattr(settings, field.name) for field in fields(OnStrips)}
    return Settings(**common, samples=samples, scatter=0)


def release_beams(model: ChaosModel, case: Case, settings: Settings, threads: int = 1, shapes: int = 0) -> dict:
    """Release beams of a case on force laws drawn from a chaos model. Arrays of `stiction.beam.montecarlo.columns`."""
    return released_on(partial(draw_laws, model), case, settings, _streams(settings, case), threads, shapes)


def _streams(settings, case):
    """Streams of the beams of a case by number, and of their mesh."""
    return partial(stream, settings.seed, "beams", case)


def released_on(
    draw: Callable, case: Case, settings: Settings, address: Callable, threads: int = 1, shapes: int = 0
) -> dict:
    """Release beams of a case on force laws drawn by ``draw(n, rng)``. Beam k has the stream ``address(k)``.

    Where strips are far too long for the force laws, a patch that counts as a flat surface may be much stiffer than all
    others. Then the ground of all beams is everywhere like its strongest patch, the safe side.
    """
    beam, strips = cantilever(settings, case.pair), strips_along(settings.beam, settings.sampling)
    laws = draw(_LAWS, address("mesh"))
    if beam.length / strips > LONGER * longest(beam, laws)[0]:
        strongest = partial(_on_uniform_ground, beam, float(forcelaw.energy(laws).max()), settings.scatter)
        return columns([strongest(k, address(k)) for k in range(settings.samples)], shapes)
    resolving = resolved(beam, strips, laws, settings.coarser_mesh)
    experiment = Experiment(resolving, strips, draw, settings.scatter)
    return released_beams(experiment, settings.samples, address, threads, shapes)


def _on_uniform_ground(beam, energy, scatter, sample, rng):
    """Outcome of one beam by Eq. (13) on ground with one adhesion energy [J m⁻²]."""
    scattered = scattered_beam(beam, scatter, rng)
    crack = min(float(arrest_length(energy, scattered)), scattered.length)
    state = EndState.S_SHAPE if crack < scattered.length else EndState.FREE
    depth = scattered.gap if state is EndState.S_SHAPE else 0.0
    apparent = apparent_adhesion_energy(crack, beam)
    return Outcome(sample, state, crack, apparent, s_shape(scattered, depth, crack)[:, 0], imbalance=0.0, iterations=0)


def longest_strip(model: ChaosModel, case: Case, settings: OnStrips) -> float:
    """Longest strip for the cracks of a case, on the laws of the mesh of `release_beams` [m]."""
    laws = draw_laws(model, _LAWS, _streams(settings, case)("mesh"))
    return longest(cantilever(settings, case.pair), laws)[0]


def ends_as(beams: xr.Dataset, state: str) -> np.ndarray:
    """Mark the beams of a dataset by their final state, ``S-shape``, ``arc`` or ``free``, (n,) bool."""
    return beams.state.values == STATES.index(state)


def stuck_lengths(beams: xr.Dataset) -> np.ndarray:
    """Crack lengths of the S-shaped beams of a dataset (m,) [m]. Those of others have no meaning."""
    return beams.crack_length.values[ends_as(beams, "S-shape")]


def stuck_energies(beams: xr.Dataset) -> np.ndarray:
    """Apparent adhesion energies Γ, Eq. (13), of the S-shaped beams of stage beams (m,) [J m⁻²]."""
    return beams.apparent_energy.values[ends_as(beams, "S-shape")]


def sections(plan: Any, case: Case) -> dict[str, Any]:
    """Sections of the configuration for the beams of a case, without their number."""
    strips = select(StripLength, plan.config["sampling"])
    nominal = {"seed": plan.config["seed"], "sampling": strips} | cantilevers.sections(plan, case.pair)
    return nominal | subsection(plan.config["pairs"][case.pair], ("coarser_mesh",))

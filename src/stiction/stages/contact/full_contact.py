"""Study full_contact: the first samples of stage contact under full elastic contact, beside the sum over summits."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.plasticity import ONSET
from stiction.contact import elements, forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.halfspace import HalfSpace
from stiction.devices.materials import ELASTIC
from stiction.plan.stage import At, Stage, select
from stiction.progress import progress
from stiction.stages.contact import contact, pairs
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs

#: Variables of a sample at a humidity: unit and meaning.
_VARIABLES = {
    "adhesion_energy": ("J m-2", "e under full elastic contact"),
    "pull_off": ("Pa", "f_max under full elastic contact"),
    "summit_energy": ("J m-2", "e of the sum over summits"),
    "summit_pull_off": ("Pa", "f_max of the sum over summits"),
    "contact_share": ("1", "share of the elements in contact, without force"),
    "onset_share": ("1", "share of them above the pressure at which a summit begins to yield"),
    "hardness_share": ("1", "share of them above the hardness"),
    "residual": ("m", "largest gap or overlap of an element in contact"),
    "states": ("1", "number of distances"),
}


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, water, humidities and number of strips."""

    water: Water
    humidities: tuple[float, ...]  #: [-]
    strips: int  #: number of pairs of strips: the first samples of stage contact


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Separate every strip at every humidity, by both models of the contact.

    Raises
    ------
    ValueError
        If the solids attract each other across gaps, the grid is too coarse, or a strip does not come to rest.
    """
    hardness = solids.softer_hardness(*bodies(settings))
    rows = [
        [_both_models(*curve, (space, heights, adhesion), hardness) for adhesion, curve in cases]
        for space, heights, cases in strips(surfaces, pair, settings)
    ]
    return layout(np.array(rows), settings.humidities, surface_pair(surfaces, "NG", settings).spacing)


def strips(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings
) -> Iterator[tuple[HalfSpace, np.ndarray, list[tuple[elements.Adhesion, tuple[np.ndarray, np.ndarray]]]]]:
    """Strips one after the other: elements, heights z (n1, n2) [m], and for each humidity the attraction and the curve.

    The curve is that of the sum over summits: distances [m] and forces [Pa].
    """
    if settings.water.gaps is not None:
        raise ValueError("full elastic contact has no attraction across gaps: it needs attraction.reach: touching")
    drawn = surface_pair(surfaces, "NG", settings)
    streams, materials = streams_of_sides(settings.seed, pair), bodies(settings)
    summits = contact.compute(surfaces, pair, "NG", settings, range(settings.strips))
    curves = [force_curves(summits, humidity, settings.water) for humidity in settings.humidities]
    shape = tuple(len(range(0, points, drawn.every)) for points in drawn.beam.grid.shape)
    space = HalfSpace(shape, drawn.spacing, solids.composite_modulus(*materials))
    attraction = solids.attraction_between(*materials, settings.van_der_waals)
    adhesions = [elements.Adhesion.of(settings.water.film(each), attraction, space) for each in settings.humidities]
    for k in progress(range(settings.strips), "strips"):
        found = [(each.distance, each.curve(k)) for each in curves]
        yield space, drawn.draw(*streams(k)), list(zip(adhesions, found, strict=True))


def _both_models(distance, force, strip, hardness):
    """Variables of one strip at one humidity. ``distance``, ``force``: curve of the sum over summits."""
    found = elements.separation(*strip, (distance, force))
    pressure = found.closed.pressure
    touching = pressure[pressure > 0] / hardness
    shares = [float((touching > level).sum() / max(touching.size, 1)) for level in (ONSET, 1)]
    summits = forcelaw.adhesion_energy(distance, force), forcelaw.extremum(distance, force)[1]
    return [
        found.adhesion_energy,
        found.pull_off,
        *summits,
        touching.size / pressure.size,
        *shares,
        found.closed.residual,
        found.states,
    ]


def layout(values: np.ndarray, humidities: Sequence[float], spacing: float) -> xr.Dataset:
    """Variables (n, n_humidity, n_variables) of every sample at every humidity, in the order of this module [SI].

    Spacing of the elements [m].
    """
    columns = {
        name: (("sample", "humidity"), values[..., i], {"units": unit, "long_name": meaning})
        for i, (name, (unit, meaning)) in enumerate(_VARIABLES.items())
    }
    return xr.Dataset(
        columns | {"spacing": ((), spacing, {"units": "m"})},
        coords={
            "sample": np.arange(len(values), dtype=np.int32),
            "humidity": ("humidity", list(humidities), {"units": "1"}),
        },
    )


def energies(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Humidities (h,) [-], and energies e of full contact and of the sum over summits, (n, h) each [J m⁻²]."""
    return study.humidity.values, study.adhesion_energy.values, study.summit_energy.values


def pull_offs(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Humidities (h,) [-], and largest attractions f_max of full contact and of the sum over summits, (n, h) [Pa]."""
    return study.humidity.values, study.pull_off.values, study.summit_pull_off.values


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the contact, with the lowest, the middle and the highest humidity of the pair.

    ASSUME: attraction across gaps is left out, so that both models have the same forces.
    """
    all_of_pair = sorted(plan.air.humid(at.pair))
    chosen = dict.fromkeys(all_of_pair[k] for k in (0, (len(all_of_pair) - 1) // 2, -1))
    study = {"humidities": list(chosen), "strips": plan.config["studies"]["full_contact"]["samples"]}
    seen = plan.seen_by(at.pair, (*ELASTIC, "hardness_GPa"), samples=None)
    return select(Settings, seen | study | {"water": plan.air.without_gaps(at.pair)})


STAGES = (
    Stage.writing(
        "full_contact",
        "studies/full_contact/{pair}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=settings_of,
        kind=Settings,
        compute=lambda data, at, settings: compute(both(data), at.pair, settings),
        message="Full elastic contact of pair {pair}, beside the sum over summits.",
        cluster=True,
        minutes=30,
    ),
)

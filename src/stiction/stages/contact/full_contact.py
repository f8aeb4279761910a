"""Study full_contact: the first samples of stage contact under full elastic contact, beside the sum over summits.

Both models have the same forces. Force laws without attraction across gaps are compared without it, others with it.

In dry air, where forces are corrected, strips are drawn until their error counts little, and the sum over summits
of more strips says how far their means are from those of all.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.analysis.model_error import beside_more, error_of_largest, mean_ratios
from stiction.analysis.plasticity import ONSET
from stiction.config.reading import is_stated
from stiction.contact import forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.full import descent, elements
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.materials import ELASTIC, Solid
from stiction.contact.pair import EquivalentSurface
from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage, select
from stiction.progress import progress
from stiction.stages.contact import contact, pairs
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

#: Relative standard errors, by the strips, of the ratios of the means, and of the values that one in 1000 exceeds, at
#: which no more strips are drawn.
OF_RATIOS, OF_LARGEST = 0.03, 0.1
#: ASSUME: beyond this number of strips, accuracy costs too much: one takes 0.4 to 14 s.
MOST = 120
#: Strips in dry air whose sum over summits is computed, 7 ms each.
ON_SUMMITS = 500
#: Variables of a sample at a humidity.
VARIABLES = (
    "adhesion_energy",
    "pull_off",
    "summit_energy",
    "summit_pull_off",
    "contact_share",
    "onset_share",
    "hardness_share",
    "residual",
    "states",
)


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, water, humidities and number of strips."""

    water: Water  #: with the attraction across gaps, if there is any
    humidities: tuple[float, ...]  #: [-]
    strips: int  #: number of pairs of strips: the first samples of stage contact
    most: int = 0  #: strips until which more are drawn, half as many at a time, while errors count
    on_summits: int = 0  #: number of strips on summits, these among them, to whose mean the others are moved


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Separate strips at every humidity, by both models, until their means are accurate or the most are drawn.

    Strips whose summits do not resist the adhesion are left out: they count as flat, on the safe side, and have no sum
    over summits that could be corrected.

    Raises
    ------
    ValueError
        If the grid is too coarse, a strip does not come to rest, or not two of them have summits that resist.
    """
    hardness = solids.softer_hardness(*bodies(settings))
    more = _on_summits(surfaces, pair, settings) if settings.on_summits else None
    spacing = surface_pair(surfaces, "NG", settings).spacing
    study_of = partial(layout, humidities=settings.humidities, spacing=spacing, more=more)
    rows, most = [], max(settings.most, settings.strips)
    numbers = range(settings.strips, most, max(settings.strips // 2, 1))
    for space, heights, cases in strips(surfaces, pair, replace(settings, strips=most)):
        if not all(forcelaw.resists(case.curve[1]) for case in cases):
            continue
        rows.append([_both_models((space, heights), case, hardness) for case in cases])
        if len(rows) in numbers and _are_enough(study_of(np.array(rows))):
            break
    if len(rows) < min(2, most):
        raise ValueError(
            f"the summits of {len(rows)} of {most} strips resist the adhesion, too few for full elastic contact: use "
            "rougher surfaces or a stiffer solid, or contact.model summits"
        )
    return study_of(np.array(rows))


def _are_enough(study):
    """Whether the energies and the largest attractions of a study are known to `OF_RATIOS` and `OF_LARGEST`."""
    moved = np.moveaxis(moved_models(study), -1, 0)
    for (at, *models), means in zip((energies(study), pull_offs(study)), moved, strict=True):
        ratios, errors = mean_ratios(*means, at, at)
        if np.any(errors > OF_RATIOS * ratios) or not np.all(error_of_largest(*models, means) <= OF_LARGEST):
            return False
    return True


class StripInAir(NamedTuple):
    """Attraction of a strip at a humidity, and the curve of the sum over its summits."""

    adhesion: elements.Adhesion
    curve: tuple[np.ndarray, np.ndarray]  #: distances [m] and forces [Pa]
    beyond: float  #: energy beyond the last distance [J m⁻²]

    @property
    def on_summits(self) -> tuple[float, float]:
        """Energy e [J m⁻²] and largest attraction f_max [Pa] of the sum over summits."""
        return forcelaw.adhesion_energy(*self.curve, self.beyond), forcelaw.extremum(*self.curve)[1]


def strips(
    surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings
) -> Iterator[tuple[HalfSpace, np.ndarray, list[StripInAir]]]:
    """Strips one after the other: elements, heights z (n1, n2) [m], and what acts on them at each humidity."""
    rough_pair = surface_pair(surfaces, "NG", settings)
    streams = streams_of_sides(settings.seed, pair)
    space, airs = _airs(surfaces, pair, settings, settings.strips)
    for k in progress(range(settings.strips), "strips"):
        yield space, rough_pair.under_flat(rough_pair.draw(*streams(k))), [of_strip(k) for of_strip in airs]


def _airs(surfaces, pair, settings, number):
    """Elements of a strip, and at each humidity what acts on each of a number of strips."""
    materials = bodies(settings)
    space = elements_of(surface_pair(surfaces, "NG", settings), materials)
    media = [medium(settings, humidity) for humidity in settings.humidities]
    summits = {
        each: contact.compute(surfaces, pair, "NG", replace(settings, van_der_waals=each), range(number))
        for each in dict.fromkeys(media)
    }
    return space, [
        _in_air(
            summits[each], humidity, settings.water.at(humidity), solids.attraction_between(*materials, each), space
        )
        for each, humidity in zip(media, settings.humidities, strict=True)
    ]


def elements_of(pair: EquivalentSurface, materials: tuple[Solid, Solid]) -> HalfSpace:
    """Elements of the strips of a pair of bodies."""
    shape = tuple(len(range(0, points, pair.every)) for points in pair.beam.grid.shape)
    return HalfSpace(shape, pair.spacing, solids.composite_modulus(*materials))


def require_fine_elements(settings: Settings) -> None:
    """Raise the error of `stiction.contact.full.elements.Adhesion.from_film` unless elements resolve the attraction."""
    materials = bodies(settings)
    spacing = settings.sampling.spacing * settings.contact.every
    space = HalfSpace((1, 1), spacing, solids.composite_modulus(*materials))
    for each in {medium(settings, humidity) for humidity in settings.humidities}:
        elements.Adhesion.from_film((0.0, 0.0), solids.attraction_between(*materials, each), space)


def medium(settings: Settings, humidity: float) -> str:
    """Medium through which solids attract each other at a humidity."""
    return settings.van_der_waals if settings.water.film(humidity)[0] else "dry"


def _on_summits(surfaces, pair, settings):
    """Energies e [J m⁻²] and largest attractions f_max [Pa] of strips whose summits resist (N, n_humidity, 2)."""
    number = max(settings.on_summits, settings.most, settings.strips)
    _, airs = _airs(surfaces, pair, settings, number)
    cases_of_strips = ([of_strip(k) for of_strip in airs] for k in range(number))
    return np.array(
        [
            [case.on_summits for case in each]
            for each in cases_of_strips
            if all(forcelaw.resists(case.curve[1]) for case in each)
        ]
    )


def _in_air(summits, humidity, water, attraction, space) -> Callable[[int], StripInAir]:
    """What acts on each strip at a humidity, by its number. ``summits`` is the dataset of their contact."""
    adhesion = elements.Adhesion.from_film(water.film(humidity), attraction, space, water.gaps)
    curves = force_curves(summits, humidity, water)
    beyond = np.zeros(curves.samples) if curves.beyond is None else curves.beyond
    return lambda k: StripInAir(adhesion, (curves.distance, curves.curve(k)), float(beyond[k]))


def separated(space: HalfSpace, heights: np.ndarray, case: StripInAir, end: float = 0.0) -> elements.Separation:
    """Separate a strip of heights z (n1, n2) [m], at least up to a distance [m]: by descent where turns do not settle.

    On rough strips, turns are up to ten times as fast.

    Raises
    ------
    NotConverged
        If neither settles.
    ValueError
        If the strip does not come to rest.
    """
    try:
        return elements.separation(space, heights, case.adhesion, case.curve, end=end)
    except (NotConverged, ValueError):
        return elements.separation(space, heights, case.adhesion, case.curve, descent.equilibrium, end)


def _both_models(strip, case, hardness):
    """Variables of one strip, elements and heights, at one humidity."""
    separation = separated(*strip, case)
    pressure = separation.closed.pressure
    touching = pressure[pressure > 0] / hardness
    shares = [float((touching > level).sum() / max(touching.size, 1)) for level in (ONSET, 1)]
    return [
        separation.adhesion_energy,
        separation.pull_off,
        *case.on_summits,
        touching.size / pressure.size,
        *shares,
        separation.closed.residual,
        separation.states,
    ]


def layout(
    values: np.ndarray, humidities: Sequence[float], spacing: float, more: np.ndarray | None = None
) -> xr.Dataset:
    """Variables (n, n_humidity, n_variables) of every sample at every humidity, in the order of this module [SI].

    Spacing of the elements [m], and energies and largest attractions of more samples on summits (N, n_humidity, 2).
    """
    columns = {name: (("strip", "humidity"), values[..., i]) for i, name in enumerate(VARIABLES)}
    if more is not None:
        columns["more"] = ("more_samples", "humidity", "quantity"), more
    return xr.Dataset(
        columns | {"spacing": ((), spacing)},
        coords={
            "strip": np.arange(len(values), dtype=np.int32),
            "humidity": ("humidity", list(humidities)),
        },
    )


def energies(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Humidities (h,) [-], and energies e of full contact and of the sum over summits, (n, h) each [J m⁻²]."""
    return study.humidity.values, study.adhesion_energy.values, study.summit_energy.values


def pull_offs(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Humidities (h,) [-], and largest attractions f_max of full contact and of the sum over summits, (n, h) [Pa]."""
    return study.humidity.values, study.pull_off.values, study.summit_pull_off.values


def moved_models(study: xr.Dataset) -> np.ndarray:
    """Energies and largest attractions by both models, whose means are compared (2, n, n_humidity, 2) [J m⁻²], [Pa].

    They are moved to the mean of more strips on summits, where those were computed.
    """
    names = ("adhesion_energy", "pull_off"), ("summit_energy", "summit_pull_off")
    models = np.array([np.stack([study[name].values for name in of_model], axis=-1) for of_model in names])
    if "more" not in study:
        return models
    of_humidities = zip(*np.moveaxis(models, 2, 1), study.more.transpose("humidity", ...).values, strict=True)
    return np.stack([beside_more(*each) for each in of_humidities], axis=2)


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the contact without attraction across gaps, at three humidities of the pair.

    They are the lowest, the middle and the highest one at which water condenses, that of its figures among them.
    """
    humid = sorted(plan.air.wet(at.pair, plan.humidities_of_full_contact(at.pair)))
    airs = dict.fromkeys(humid[k] for k in (0, (len(humid) - 1) // 2, -1)) if humid else ()
    study = {"humidities": list(airs), "strips": plan.config["studies"]["full_contact"]["samples"]}
    sections = plan.seen_by(at.pair, (*ELASTIC, "hardness_GPa"), samples=None)
    return select(Settings, sections | study | {"water": plan.air.without_gaps(at.pair)})


def settings_across(plan: Any, at: At) -> dict[str, Any]:
    """Settings with attraction across gaps, also in dry air if the pair has any."""
    touching = settings_of(plan, at)
    is_dry = any(plan.air.is_dry(at.pair, humidity) for humidity in plan.humidities_of_full_contact(at.pair))
    humidities = [0.0] * is_dry + touching["humidities"]
    return touching | {"water": plan.air.across_gaps(at.pair), "humidities": humidities}


def settings_in_dry_air(plan: Any, at: At) -> dict[str, Any]:
    """Settings with attraction across gaps in dry air alone. A number of strips that is not stated may grow."""
    more = {} if is_stated(plan.config, "studies", "full_contact") else {"most": MOST}
    return settings_across(plan, at) | {"humidities": [0.0], "on_summits": ON_SUMMITS} | more


def _stage(name, folder, settings, forces):
    """Stage of the strips of a pair under some forces."""
    return Stage.writing(
        name,
        f"{folder}/{{pair}}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(sides_of(data), at.pair, settings),
        message=f"Full elastic contact of pair {{pair}}{forces}, beside the sum over summits.",
        running=Running(minutes=120, priority=1),
    )


STAGES = (
    _stage("full_contact", "studies/full_contact", settings_of, ""),
    _stage("full_contact_across", "studies/full_contact/across", settings_across, " with attraction across gaps"),
    _stage("full_contact_dry", "studies/full_contact/dry", settings_in_dry_air, " in dry air"),
)

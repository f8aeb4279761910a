"""Energies of a pair in full elastic contact at one humidity, by levels, for the beams of devices.

The state at rest alone has the energy. Strips without summits that resist are left out, as in
`stiction.stages.contact.full_contact`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis import levels
from stiction.analysis.levels import FINE, POOL, SUMMITS, Ratio
from stiction.config.cases import Case
from stiction.contact import forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.levels import Level, refined
from stiction.contact.materials import ELASTIC
from stiction.contact.pair import SurfacePair
from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage, select
from stiction.stages.contact import contact, full_contact
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.full_contact import Settings
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs
from stiction.streams import stream

#: Largest relative error of the ratio of energies with which predictions are corrected: 1 % of a length.
ALLOWED = 0.04
#: Coarse grids: every n-th point.
GRIDS = (2, 3)


@dataclass(frozen=True)
class Strips:
    """Strips of a pair at one humidity, on all levels."""

    pair: SurfacePair
    streams: Any  #: of both surfaces, by the number of a strip
    levels: dict[int, Level]  #: by their every n-th point
    water: Water
    humidity: float  #: [-]
    resisting: list[int] = field(default_factory=list)  #: numbers of the first strips with summits that resist
    curves: list[tuple] = field(default_factory=list)  #: their distances [m] and forces [Pa] on summits
    values: dict[tuple[int, int], float] = field(default_factory=dict)  #: energies by level and place [J m⁻²]
    pull_offs: list[float] = field(default_factory=list)  #: largest attractions on summits [Pa]
    last: dict[int, np.ndarray] = field(default_factory=dict)  #: heights of the last strip by its number [m]

    def heights(self, number: int) -> np.ndarray:
        """Heights of a strip (n1, n2) [m], drawn again unless it is the last one."""
        if number not in self.last:
            self.last.clear()
            self.last[number] = self.pair.draw(*self.streams(number))
        return self.last[number]

    def value(self, level: int, place: int) -> float:
        """Energy of a strip that resists, by its place among these, NaN if a coarse level finds none [J m⁻²]."""
        while len(self.resisting) <= place:
            self._draw_another()
        if (level, place) not in self.values:
            self._compute(level, place)
        return self.values[level, place]

    def _draw_another(self):
        """Draw the next strip, and keep its number and its curve if it resists."""
        number = self.resisting[-1] + 1 if self.resisting else 0
        while True:
            if number > 2 * (len(self.resisting) + POOL):
                raise ValueError("too few strips have summits that resist the adhesion for full elastic contact")
            of_strip = (values[None] for values in self.pair.contact(self.heights(number)))
            on_summits = contact.layout(*of_strip, self.pair.distances, range(1))
            distance, curve, _, beyond, _ = force_curves(on_summits, self.humidity, self.water)
            if forcelaw.resists(force := curve(0).copy()):
                break
            number += 1
        self.values[SUMMITS, len(self.resisting)] = forcelaw.adhesion_energy(
            distance, force, 0.0 if beyond is None else float(beyond[0])
        )
        self.resisting.append(number)
        self.curves.append((distance, force))
        self.pull_offs.append(forcelaw.extremum(distance, force)[1])

    def _compute(self, level, place):
        """Energy of a strip on a grid, on the fine one from the state on the next coarser one."""
        heights, start = self.heights(self.resisting[place]), None
        for every in (2, FINE) if level == FINE and 2 in self.levels else (level,):
            try:
                state = self.levels[every].at_rest(heights, self.curves[place], start)
            except (KeyError, NotConverged, ValueError):
                if every == FINE:
                    raise
                self.values[every, place] = np.nan
                continue
            self.values[every, place] = self.levels[every].energy(state, heights)
            start = refined(state, 2, self.levels[FINE].space.shape) if every == 2 else None


def strips_of(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> Strips:
    """Strips of a pair at the first humidity of the settings.

    Raises
    ------
    ValueError
        If the fine grid is too coarse for the attraction of the solids.
    """
    (humidity,), materials = settings.humidities, bodies(settings)
    medium = full_contact.medium(settings, humidity)
    drawn, water = surface_pair(surfaces, "NG", settings), settings.water.at(humidity)
    adhesion = partial(
        Adhesion.of, water.film(humidity), solids.attraction_between(*materials, medium), across=water.gaps
    )
    fine, grids = full_contact.elements_of(drawn, materials), {}
    grids[FINE] = Level.of(FINE, fine, adhesion)
    for every in GRIDS:
        try:
            grids[every] = Level.of(every, fine, adhesion)
        except ValueError:  # no control
            continue
    return Strips(drawn, streams_of_sides(settings.seed, pair), grids, water, humidity)


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], case: Case, settings: Settings) -> xr.Dataset:
    """Ratio and power of the energies in full contact to those on summits, unknown where strips do not settle."""
    rng = stream(settings.seed, "full_energy", case.pair)
    try:
        strips = strips_of(surfaces, case.pair, settings)
        found = levels.ratio_of_energies(strips.value, GRIDS, ALLOWED, rng)
    except (NotConverged, ValueError) as reason:
        return layout(UNKNOWN, (np.nan, np.nan), str(reason))
    count = len(strips.resisting)
    energies = [strips.values[SUMMITS, k] for k in range(count)]
    return layout(found, (float(np.mean(energies)), float(np.mean(strips.pull_offs))))


#: Ratio of energies that are not found.
UNKNOWN = Ratio(np.nan, np.nan, np.nan, np.nan, (FINE, SUMMITS), {}, np.nan)


def layout(found: Ratio, on_summits: tuple[float, float], reason: str = "") -> xr.Dataset:
    """Dataset of a ratio, of the means of e [J m⁻²] and f_max [Pa] on summits, and why it is not known."""
    known = {name: ((), getattr(found, name), {"units": "1"}) for name in ("ratio", "power", "power_error")}
    means = (((), mean, {"units": unit}) for mean, unit in zip(on_summits, ("J m-2", "Pa"), strict=True))
    every = [SUMMITS, FINE, *GRIDS]
    return xr.Dataset(
        known
        | {"ratio_error": ((), found.ratio * found.error, {"units": "1"})}
        | dict(zip(("summit_energy", "summit_pull_off"), means, strict=True))
        | {
            "strips": ("every", [found.strips.get(level, 0) for level in every]),
            "in_chain": ("every", [level in found.chain for level in every]),
            "largest_residual": ((), found.largest, {"units": "1"}),
            "applied": ((), bool(found.error <= ALLOWED)),
        },
        coords={"every": every},
        attrs={"reason": reason},
    )


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the strips of a pair in the air of devices."""
    seen = plan.seen_by(at.case.pair, ELASTIC, samples=None)
    own = {"humidities": [at.case.humidity], "strips": levels.PILOT}
    return select(Settings, seen | own | {"water": plan.air_of_devices.water(at.case.pair)})


STAGES = (
    Stage.writing(
        "full_energy",
        "studies/full_contact/energy/{case}",
        inputs=lambda plan, at: surface_inputs(plan, at.case.pair),
        settings=settings_of,
        kind=Settings,
        compute=lambda data, at, settings: compute(both(data), at.case, settings),
        message="Energies of {case} in full elastic contact.",
        running=Running(minutes=120, priority=1),
    ),
)

"""Energies and largest attractions of a pair in full elastic contact at one humidity, by levels, for devices.

The state at rest alone has the energy. Where devices need forces, each strip is separated from there. Strips without
summits that resist are left out, as in `stiction.stages.contact.full_contact`.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from stiction.analysis import levels
from stiction.analysis.levels import COARSE, COSTS, FINE, PILOT, POOL, SUMMITS, Ratio
from stiction.config.cases import Case
from stiction.config.merging import merged
from stiction.config.units import NM_PER_UM
from stiction.contact import forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.full.effort import CountedHalfSpace, Effort, TooLong
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.levels import Level, refined
from stiction.contact.materials import ELASTIC
from stiction.contact.pair import SurfacePair
from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage, select
from stiction.stages.contact import contact, full_contact
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs
from stiction.streams import stream

#: Largest relative error of the ratio of energies with which predictions are corrected: 1 % of a length.
ALLOWED = 0.04
#: Relative error of the ratio of forces for which strips are drawn, and the largest with which forces are corrected.
OF_FORCES, ALLOWED_OF_FORCES = 0.04, 0.1
#: Coarse grids: every n-th point.
GRIDS = (2, 3)
#: Points of a strip, those of 1.5 x 30 µm on 10 nm. ASSUME: longer strips may be narrower, down to a width [µm].
POINTS, NARROWEST = 450_000, 2.0
#: ASSUME: beyond this many displaced elements, about two minutes of a core, the ratio costs too much. Pair b needs 4e8
#: to 2e9 of them, by humidity, and pairs of heavy tails, whose strips have no control, 7e9.
EFFORT = 8e9
#: Effort that follows a pilot on coarse grids, over that of this pilot: one on the fine grid, and more coarse strips.
_AFTER_PILOT = (COSTS[FINE] + COARSE / PILOT * COSTS[max(GRIDS)]) / sum(COSTS[every] for every in GRIDS)


@dataclass(frozen=True, kw_only=True)
class Settings(full_contact.Settings):
    """Settings of the strips of a pair, at one humidity."""

    forces: bool = False  #: whether devices need forces as well


class StripQuantities(NamedTuple):
    """Energy e and largest attraction f_max of a strip, NaN if they are not found or not wanted."""

    energy: float  #: [J m⁻²]
    pull_off: float  #: [Pa]


NOT_FOUND = StripQuantities(np.nan, np.nan)


@dataclass(frozen=True)
class Strips:
    """Strips of a pair at one humidity, on all levels."""

    pair: SurfacePair
    streams: Any  #: of both surfaces, by the number of a strip
    levels: dict[int, Level]  #: by their every n-th point
    water: Water
    humidity: float  #: [-]
    effort: Effort  #: displaced elements on all levels
    forces: bool = False  #: whether strips are separated
    resisting: list[int] = field(default_factory=list)  #: numbers of the first strips with summits that resist
    curves: list[tuple] = field(default_factory=list)  #: their distances [m] and forces [Pa] on summits
    values: dict[tuple[int, int], StripQuantities] = field(default_factory=dict)  #: by level and place
    last: dict[int, np.ndarray] = field(default_factory=dict)  #: heights of the last strip by its number [m]

    def heights(self, number: int) -> np.ndarray:
        """Heights of a strip (n1, n2) [m], drawn again unless it is the last one."""
        if number not in self.last:
            self.last.clear()
            self.last[number] = self.pair.draw(*self.streams(number))
        return self.last[number]

    def energy(self, level: int, index: int) -> float:
        """Energy of a strip that resists, by its place among these, NaN if a coarse level finds none [J m⁻²]."""
        return self._value(level, index).energy

    def pull_off(self, level: int, index: int) -> float:
        """Largest attraction [Pa], as `energy`.

        Raises
        ------
        ValueError
            If the fine level finds none.
        TooLong
            If there is too much effort.
        """
        largest = self._value(level, index).pull_off
        if level == FINE and np.isnan(largest):
            raise ValueError("the largest attraction of a strip in full elastic contact was not found")
        return largest

    def _value(self, level, index):
        """Quantities of a strip that resists."""
        while len(self.resisting) <= index:
            self._draw_another()
        if (level, index) not in self.values:
            self._compute(level, index)
        return self.values[level, index]

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
        energy = forcelaw.adhesion_energy(distance, force, 0.0 if beyond is None else float(beyond[0]))
        self.values[SUMMITS, len(self.resisting)] = StripQuantities(energy, forcelaw.extremum(distance, force)[1])
        self.resisting.append(number)
        self.curves.append((distance, force))

    def _compute(self, level, index):
        """Quantities of a strip on a grid, on the fine one from the state on the next coarser one."""
        if level == FINE and (FINE, 0) not in self.values:
            self.effort.require(self.effort.spent * (1 + _AFTER_PILOT))
        heights, curve, start = self.heights(self.resisting[index]), self.curves[index], None
        for every in (2, FINE) if level == FINE and 2 in self.levels else (level,):
            try:
                on_grid = self.levels[every]
                state = on_grid.at_rest(heights, curve, start)
            except (KeyError, NotConverged, ValueError):
                if every == FINE:
                    raise
                self.values[every, index] = NOT_FOUND
                continue
            largest = self._largest(on_grid, heights, curve, state) if self.forces else np.nan
            self.values[every, index] = StripQuantities(on_grid.energy(state, heights), largest)
            start = refined(state, 2, self.levels[FINE].space.shape) if every == 2 else None

    @staticmethod
    def _largest(on_grid, heights, curve, state):
        """Largest attraction of a strip from its state at rest, NaN if it is not found [Pa]."""
        try:
            return on_grid.pull_off(heights, curve, state)
        except (NotConverged, ValueError):
            return np.nan


def strips_of(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> Strips:
    """Strips of a pair at the first humidity of the settings.

    Raises
    ------
    ValueError
        If the fine grid is too coarse for the attraction of the solids.
    """
    (humidity,), materials = settings.humidities, bodies(settings)
    medium = full_contact.medium(settings, humidity)
    rough_pair, water = surface_pair(surfaces, "NG", settings), settings.water.at(humidity)
    adhesion = partial(
        Adhesion.from_film, water.film(humidity), solids.attraction_between(*materials, medium), across=water.gaps
    )
    effort, grids = Effort(EFFORT), {}
    fine = CountedHalfSpace.from_space(full_contact.elements_of(rough_pair, materials), effort)
    grids[FINE] = Level.from_fine(FINE, fine, adhesion)
    for every in GRIDS:
        try:
            grids[every] = Level.from_fine(every, fine, adhesion)
        except ValueError:  # no control
            continue
    return Strips(rough_pair, streams_of_sides(settings.seed, pair), grids, water, humidity, effort, settings.forces)


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], case: Case, settings: Settings) -> xr.Dataset:
    """Ratios and powers of full contact to summits, of energies and if wanted of forces, unknown without rest."""
    energy, pull_off, means, reason = UNKNOWN, UNKNOWN, NOT_FOUND, ""
    try:
        strips = strips_of(surfaces, case.pair, settings)
        energy = ratio_of_energies(strips, ALLOWED, settings.seed, case.pair)
        means = StripQuantities(*np.mean([strips.values[SUMMITS, k] for k in range(len(strips.resisting))], axis=0))
        if settings.forces:
            pull_off = ratio_of_forces(strips, OF_FORCES, settings.seed, case.pair)
    except (NotConverged, TooLong, ValueError) as failed:
        reason = str(failed)
    of_forces = _ratio(pull_off, ALLOWED_OF_FORCES, "pull_off_") if settings.forces else {}
    return layout(energy, means, reason).assign(of_forces)


def ratio_of_energies(strips: Strips, error: float, seed: int, pair: str | int) -> Ratio:
    """Ratio of the mean energy in full contact to that on summits, as `ratio_of_forces`."""
    return levels.ratio_of_means(strips.energy, GRIDS, error, stream(seed, "full_energy", pair))


def ratio_of_forces(strips: Strips, error: float, seed: int, pair: str | int) -> Ratio:
    """Ratio of the mean pull-off in full contact to that on summits, within an error, by name or number of a pair."""
    return levels.ratio_of_means(strips.pull_off, GRIDS, error, stream(seed, "full_force", pair))


#: Ratio that is not found.
UNKNOWN = Ratio(np.nan, np.nan, np.nan, np.nan, (FINE, SUMMITS), {}, np.nan)


def layout(ratio: Ratio, on_summits: StripQuantities, reason: str = "") -> xr.Dataset:
    """Dataset of the ratio of energies, the means on summits, and why it is not known."""
    means = {f"summit_{name}": ((), getattr(on_summits, name)) for name in ("energy", "pull_off")}
    every = [SUMMITS, FINE, *GRIDS]
    return xr.Dataset(_ratio(ratio, ALLOWED) | means, coords={"every": every}, attrs={"reason": reason})


def _ratio(ratio, allowed, prefix=""):
    """Variables of a ratio, which corrects predictions with at most an allowed error."""
    every = [SUMMITS, FINE, *GRIDS]
    numbers = {name: getattr(ratio, name) for name in ("ratio", "power", "power_error")}
    numbers |= {"ratio_error": ratio.ratio * ratio.error, "largest_residual": ratio.largest}
    columns = {name: ((), value) for name, value in numbers.items()} | {
        "strips": ("every", [ratio.strips.get(level, 0) for level in every]),
        "in_chain": ("every", [level in ratio.chain for level in every]),
        "applied": ((), bool(ratio.error <= allowed)),
    }
    return {f"{prefix}{name}": column for name, column in columns.items()}


def settings_of(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the strips of a pair in the air of devices."""
    sections = plan.seen_by(at.case.pair, ELASTIC, samples=None)
    sections = merged(sections, {"beam": {"width_um": _width(sections)}})
    air = {"humidities": [at.case.humidity], "strips": PILOT}
    air |= {"forces": True} if at.case.humidity in plan.devices.airs_of_forces(at.case.pair) else {}
    return select(Settings, sections | air | {"water": plan.air_of_devices.water(at.case.pair)})


def _width(sections):
    """Width of strips of about `POINTS` at most [µm], from the settings of a contact: whole, for fast transforms."""
    point = sections["sampling"]["spacing_nm"] * sections["contact"]["every"] / NM_PER_UM
    affordable = POINTS * point**2 / sections["sampling"]["strip_length_um"]
    return min(sections["beam"]["width_um"], max(NARROWEST, float(math.floor(affordable))))


STAGES = (
    Stage.writing(
        "full_energy",
        "studies/full_contact/energy/{case}",
        inputs=lambda plan, at: surface_inputs(plan, at.case.pair),
        settings=settings_of,
        kind=Settings,
        compute=lambda data, at, settings: compute(sides_of(data), at.case, settings),
        message="Energies of {case} in full elastic contact.",
        running=Running(minutes=120, priority=1),
    ),
)

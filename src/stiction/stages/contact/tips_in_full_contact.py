"""Tips of beams in full elastic contact, beside the sum over summits: tilted strips with the edge of the tips.

Both models hold strips that end where they have dropped by the reach of the tips.

ASSUME: strips as wide as the narrowest beam of a pair say how both models differ, and three slopes how that depends on
the slope. The half-space ends nowhere, although a beam is softer at its edge.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from stiction.analysis.model_error import tip_ratios
from stiction.config.merging import merged
from stiction.config.reading import is_stated
from stiction.contact import forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.full import elements
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.materials import ELASTIC
from stiction.contact.tilted import TiltedPair
from stiction.errors import NotConverged
from stiction.plan.stage import At, Running, Stage, select
from stiction.progress import progress
from stiction.stages.contact import contact, curves, full_contact
from stiction.stages.contact.full_contact import Settings, StripInAir
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

#: Relative standard error, by the strips, of the force that one tip in 1000 exceeds, at which no more are drawn.
ACCURACY = 0.15
#: ASSUME: beyond this number of strips at each slope, accuracy costs too much: one takes 0.1 to 4 s.
MOST = 60
#: Strips at each slope in humid air, and those on summits alone. ASSUME: more cost too much: the error of the ratio of
#: pair b at RH 0.44 is 0.13 to 0.26 with 8 strips, 0.11 to 0.21 with 24, of a factor of 0.3 to 0.45.
IN_HUMID_AIR = {"strips": 8, "on_summits": 64}
#: Distances around the one at which the highest point touches [m], and a force that falls there [Pa], for strips whose
#: summits have no force that leads to rest.
_TOUCHING = np.linspace(-1e-9, 3e-9, 5), np.array([1.0, 0.0, -1.0, -0.5, 0.0])


@dataclass(frozen=True)
class TipsAtSlope:
    """Tips at one slope and one humidity."""

    pair: TiltedPair
    space: HalfSpace
    adhesion: elements.Adhesion
    water: Water
    humidity: float  #: [-]

    def draw(self, *streams: np.random.Generator) -> np.ndarray:
        """Heights of a strip before it is tilted (n1, n2) [m]."""
        return self.pair.draw(*streams)

    def _contact(self, heights):
        """Contact of a strip (n1, n2) [m]."""
        of_strip = (curve[None] for curve in self.pair.contact(heights))
        return contact.tip_dataset(contact.layout(*of_strip, self.pair.distances, range(1)), self.pair)

    def on_summits(self, heights: np.ndarray) -> float:
        """Largest attraction of a strip (n1, n2) [m] per width, on summits [N/m]."""
        return float(curves.tilted_forces(self._contact(heights), self.humidity, self.water)[0, 0])

    def both_models(self, heights: np.ndarray) -> tuple[float, float]:
        """Largest attraction of a strip (n1, n2) [m] per width, in full contact and on summits [N/m]."""
        tip = self._contact(heights)
        full = self.separated(self.tilted(heights), curves.curve_of_tip(tip, self.humidity, self.water))
        ((on_summits,),) = curves.tilted_forces(tip, self.humidity, self.water)
        return full.pull_off * self.space.spacing * len(heights), float(on_summits)

    def tilted(self, heights: np.ndarray) -> np.ndarray:
        """Heights of a strip (n1, n2) after it is tilted [m]."""
        (slope,) = self.pair.tilt.slopes
        return heights - (self.pair.drop(slope, len(heights)) - self.pair.depth).astype(np.float32)[:, None]

    def separated(self, tilted: np.ndarray, curve: tuple[np.ndarray, np.ndarray]) -> elements.Separation:
        """Separate a tilted strip (n1, n2) [m], with the curve of its summits, until its highest point is free."""
        highest = float(tilted.max())
        if not (curve[1].min() < 0 and forcelaw.resists(curve[1])):
            curve = highest + _TOUCHING[0], _TOUCHING[1]
        return full_contact.separated(self.space, tilted, StripInAir(self.adhesion, curve, 0.0), highest)


def _at_slope(surfaces, settings, slope):
    """Tips at one slope, at each humidity."""
    tilt = replace(settings.tilt, slopes=(slope,))
    sampling = replace(settings.sampling, strip_length=tilt.before + tilt.reach / slope)
    materials, tips = bodies(settings), []
    for humidity in settings.humidities:
        water, medium = settings.water.at(humidity), full_contact.medium(settings, humidity)
        at_slope = replace(settings, tilt=tilt, sampling=sampling, van_der_waals=medium)
        pair = surface_pair(surfaces, "NG", at_slope)
        space = full_contact.elements_of(pair, materials)
        attraction = solids.attraction_between(*materials, medium)
        adhesion = elements.Adhesion.from_film(water.film(humidity), attraction, space, water.gaps)
        tips.append(TipsAtSlope(pair, space, adhesion, water, humidity))
    return tips


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Largest attractions of tips at each humidity and slope, by both models, of as many strips as `ACCURACY` needs.

    Raises
    ------
    ValueError
        If the grid is too coarse, or a strip does not come to rest.
    """
    at_slopes = [_at_slope(surfaces, settings, slope) for slope in settings.tilt.slopes]
    streams, rows, most = streams_of_sides(settings.seed, pair), [], max(settings.most, settings.strips)
    numbers = range(settings.strips, most, max(settings.strips // 2, 1))

    def row(k, force):
        """Forces of strip k at every slope and humidity."""
        heights_of_slopes = [airs[0].draw(*streams(len(at_slopes) * k + i)) for i, airs in enumerate(at_slopes)]
        return [
            [force(tips, heights) for tips in airs] for airs, heights in zip(at_slopes, heights_of_slopes, strict=True)
        ]

    for k in progress(range(most), "tips"):
        rows.append(row(k, TipsAtSlope.both_models))
        if len(rows) in numbers and np.all(tip_ratios(*models(study := layout(rows, settings))).error <= ACCURACY):
            return study
    more = [row(k, TipsAtSlope.on_summits) for k in range(len(rows), settings.on_summits)]
    return layout(rows, settings).assign(_of_more(rows, more))


def layout(rows: Sequence, settings: Settings) -> xr.Dataset:
    """Dataset of largest attractions per width by both models, full contact first, (n, slopes, humidities, 2) [N/m]."""
    over = "strip", "slope", "humidity"
    full, summits = np.moveaxis(np.array(rows, float), -1, 0)
    return xr.Dataset(
        {
            "force": (over, full),
            "summit_force": (over, summits),
        },
        coords={
            "slope": ("slope", list(settings.tilt.slopes)),
            "humidity": ("humidity", list(settings.humidities)),
        },
    )


def compute_for_devices(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Dataset of `compute`, of unknown forces where a strip does not settle."""
    try:
        return compute(surfaces, pair, settings)
    except (NotConverged, ValueError):
        return layout(np.full((settings.strips, len(settings.tilt.slopes), 1, 2), np.nan), settings)


def _of_more(rows, more):
    """Forces on summits of all strips (N, slopes, humidities), if there are more than those in full contact."""
    forces = [*np.array(rows)[..., 1], *more]
    return {"more": (("more_samples", "slope", "humidity"), forces)} if more else {}


def models_of_devices(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """As `models`, with more strips on summits, those in full contact first (N, humidities, slopes) [N/m]."""
    full, summits = models(study)
    return full, study.more.transpose("more_samples", "humidity", "slope").values if "more" in study else summits


def models(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Largest attractions in full contact and on summits, (n, humidities, slopes) each [N/m]."""
    return tuple(study[name].transpose("strip", "humidity", "slope").values for name in ("force", "summit_force"))


def settings_of_devices(plan: Any, at: At) -> dict[str, Any]:
    """Settings of the tips of devices on a pair in humid air, at one humidity."""
    pair = at.case.pair
    sections = merged(plan.seen_by(pair, ELASTIC, samples=None), plan.devices.all_tips(pair)) | IN_HUMID_AIR
    return select(Settings, sections | {"humidities": [at.case.humidity], "water": plan.air_of_devices.water(pair)})


def _stage(name, between, of_strips, forces):
    """Stage of the tips of a pair under some forces. ``of_strips`` are the settings of its strips without slope."""

    def settings(plan, at):
        """Settings of the strips, with slopes and edge of the tips. A number that is not stated may grow."""
        sections = merged(of_strips(plan, at), plan.devices.all_tips(at.pair))
        few = is_stated(plan.config, "studies", "full_contact")
        return select(Settings, sections | {"most": 0 if few else MOST, "on_summits": 0})

    return Stage.writing(
        name,
        f"studies/full_contact/tips/{between}{{pair}}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(sides_of(data), at.pair, settings),
        message=f"Full elastic contact of the tips of beams of pair {{pair}}{forces}, beside the sum over summits.",
        running=Running(minutes=120, priority=1),
    )


STAGES = (
    _stage("tips_in_full_contact", "", full_contact.settings_of, ""),
    _stage("tips_in_full_contact_across", "across/", full_contact.settings_across, " with attraction across gaps"),
    _stage("tips_in_full_contact_dry", "dry/", full_contact.settings_in_dry_air, " in dry air"),
    Stage.writing(
        "tips_of_devices",
        "studies/full_contact/tips/devices/{case}",
        inputs=lambda plan, at: surface_inputs(plan, at.case.pair),
        settings=settings_of_devices,
        kind=Settings,
        compute=lambda data, at, settings: compute_for_devices(sides_of(data), at.case.pair, settings),
        message="Full elastic contact of the tips of devices of {case}, beside the sum over summits.",
        running=Running(minutes=120, priority=1),
    ),
)

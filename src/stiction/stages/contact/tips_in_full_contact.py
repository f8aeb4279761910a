"""Tips of beams in full elastic contact, beside the sum over summits: tilted strips with the edge of the tips.

Both models hold strips that end where they have dropped by the reach of the tips.

ASSUME: strips as wide as the narrowest beam of a pair say how both models differ, and three slopes how that depends on
the slope. The half-space ends nowhere, although a beam is softer at its edge.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.analysis.model_error import tip_ratios
from stiction.config.merging import merged
from stiction.config.reading import is_stated
from stiction.contact import forcelaw, solids
from stiction.contact.environment import Water
from stiction.contact.full import elements
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.tilted import TiltedPair
from stiction.plan.stage import Running, Stage, select
from stiction.progress import progress
from stiction.stages.contact import contact, curves, full_contact
from stiction.stages.contact.full_contact import InAir, Settings
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs

#: Relative standard error, by the strips, of the force that one tip in 1000 exceeds, at which no more are drawn.
ACCURACY = 0.15
#: ASSUME: beyond this number of strips at each slope, accuracy costs too much: one takes 0.1 to 4 s.
MOST = 60
#: Distances around the one at which the highest point touches [m], and a force that falls there [Pa], for strips whose
#: summits have no force that leads to rest.
_TOUCHING = np.linspace(-1e-9, 3e-9, 5), np.array([1.0, 0.0, -1.0, -0.5, 0.0])


@dataclass(frozen=True)
class Tips:
    """Tips at one slope and one humidity."""

    pair: TiltedPair
    space: HalfSpace
    adhesion: elements.Adhesion
    water: Water
    humidity: float  #: [-]

    def draw(self, *streams: np.random.Generator) -> np.ndarray:
        """Heights of a strip before it is tilted (n1, n2) [m]."""
        return self.pair.draw(*streams)

    def both_models(self, heights: np.ndarray) -> tuple[float, float]:
        """Largest attraction of a strip (n1, n2) [m] per width, in full contact and on summits [N/m]."""
        (slope,), rows = self.pair.tilt.slopes, len(heights)
        of_strip = (curve[None] for curve in self.pair.contact(heights))
        tip = contact.tip_dataset(contact.layout(*of_strip, self.pair.distances, range(1)), self.pair)
        tilted = heights - (self.pair.drop(slope, rows) - self.pair.depth).astype(np.float32)[:, None]
        distance, force = curves.curve_of_tip(tip, self.humidity, self.water)
        highest = float(tilted.max())
        if not (force.min() < 0 and forcelaw.resists(force)):
            distance, force = highest + _TOUCHING[0], _TOUCHING[1]
        full = full_contact.separated(self.space, tilted, InAir(self.adhesion, (distance, force), 0.0), highest)
        ((on_summits,),) = curves.tilted_forces(tip, self.humidity, self.water)
        return full.pull_off * self.space.spacing * rows, float(on_summits)


def _at_slope(surfaces, settings, slope):
    """Tips at one slope, at each humidity."""
    tilt = replace(settings.tilt, slopes=(slope,))
    sampling = replace(settings.sampling, strip_length=tilt.before + tilt.reach / slope)
    materials, found = bodies(settings), []
    for humidity in settings.humidities:
        water, medium = settings.water.at(humidity), full_contact.medium(settings, humidity)
        own = replace(settings, tilt=tilt, sampling=sampling, van_der_waals=medium)
        pair = surface_pair(surfaces, "NG", own)
        space = full_contact.elements_of(pair, materials)
        attraction = solids.attraction_between(*materials, medium)
        adhesion = elements.Adhesion.of(water.film(humidity), attraction, space, water.gaps)
        found.append(Tips(pair, space, adhesion, water, humidity))
    return found


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Largest attractions of tips at each humidity and slope, by both models, of as many strips as `ACCURACY` needs.

    Raises
    ------
    ValueError
        If the grid is too coarse, or a strip does not come to rest.
    """
    at_slopes = [_at_slope(surfaces, settings, slope) for slope in settings.tilt.slopes]
    streams, rows, most = streams_of_sides(settings.seed, pair), [], max(settings.most, settings.strips)
    tried = range(settings.strips, most, max(settings.strips // 2, 1))
    for k in progress(range(most), "tips"):
        row = []
        for i, airs in enumerate(at_slopes):
            heights = airs[0].draw(*streams(len(at_slopes) * k + i))
            row.append([tips.both_models(heights) for tips in airs])
        rows.append(row)
        if len(rows) in tried and np.all(tip_ratios(*models(study := layout(rows, settings))).error <= ACCURACY):
            return study
    return layout(rows, settings)


def layout(rows: Sequence, settings: Settings) -> xr.Dataset:
    """Dataset of largest attractions per width by both models, full contact first, (n, slopes, humidities, 2) [N/m]."""
    over = "strip", "slope", "humidity"
    full, summits = np.moveaxis(np.array(rows, float), -1, 0)
    return xr.Dataset(
        {
            "force": (over, full, {"units": "N m-1", "long_name": "largest attraction in full elastic contact"}),
            "summit_force": (over, summits, {"units": "N m-1", "long_name": "largest attraction on summits"}),
        },
        coords={
            "slope": ("slope", list(settings.tilt.slopes), {"units": "1"}),
            "humidity": ("humidity", list(settings.humidities), {"units": "1"}),
        },
    )


def models(study: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Largest attractions in full contact and on summits, (n, humidities, slopes) each [N/m]."""
    return tuple(study[name].transpose("strip", "humidity", "slope").values for name in ("force", "summit_force"))


def _stage(name, between, of_strips, forces):
    """Stage of the tips of a pair under some forces. ``of_strips`` are the settings of its strips without slope."""

    def settings(plan, at):
        """Settings of the strips, with slopes and edge of the tips. A number that is not stated may grow."""
        own = merged(of_strips(plan, at), plan.devices.all_tips(at.pair))
        few = is_stated(plan.config, "studies", "full_contact")
        return select(Settings, own | {"most": 0 if few else MOST, "on_summits": 0})

    return Stage.writing(
        name,
        f"studies/full_contact/tips/{between}{{pair}}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(both(data), at.pair, settings),
        message=f"Full elastic contact of the tips of beams of pair {{pair}}{forces}, beside the sum over summits.",
        running=Running(minutes=120, priority=1),
    )


STAGES = (
    _stage("tips_in_full_contact", "", full_contact.settings_of, ""),
    _stage("tips_in_full_contact_across", "across/", full_contact.settings_across, " with attraction across gaps"),
    _stage("tips_in_full_contact_dry", "dry/", full_contact.settings_in_dry_air, " in dry air"),
)

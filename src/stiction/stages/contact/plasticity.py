"""Study plasticity (App. A, Fig. 16): stress of every touching summit of a pair at a small distance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.analysis import plasticity
from stiction.constants import HARDNESS
from stiction.contact import solids
from stiction.contact.asperity import hertz_force, hertz_maximum_stress
from stiction.contact.materials import ELASTIC
from stiction.plan.stage import Running, Stage, select
from stiction.progress import progress
from stiction.stages.contact import pairs
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs


@dataclass(frozen=True, kw_only=True)
class Settings(pairs.Settings):
    """Settings of the contact, number of strips and distance."""

    strips: int  #: number of pairs of strips
    distance: float  #: between the mean planes [m]


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Find the touching summits of all strips, the yielding fraction of their contact area, and the mean pressure."""
    rough_pair = surface_pair(surfaces, "NG", settings)
    streams = streams_of_sides(settings.seed, pair)
    touching = []
    for k in progress(range(settings.strips), "strips"):
        height, curvature, area_of_strip, _ = rough_pair.summits(rough_pair.draw(*streams(k)))
        interference, radius = plasticity.touching(height, curvature, settings.distance)
        touching.append((interference, radius, np.full(len(radius), k)))
    interference, radius, strip = np.hstack(touching)
    materials = bodies(settings)
    modulus = solids.composite_modulus(*materials)
    stress = hertz_maximum_stress(interference, radius, modulus)
    area = plasticity.contact_area(interference, radius)
    hardness = solids.softer_hardness(*materials)
    share = plasticity.plastic_share(area, stress, strip.astype(int), settings.strips, hardness)
    summits = {"interference": interference, "radius": radius, "stress": stress, "strip": strip.astype(int)}
    pressure = hertz_force(interference, radius, modulus).sum() / (settings.strips * area_of_strip)
    return layout(summits, share, settings.distance, pressure, hardness)


def layout(
    summits: dict[str, np.ndarray],
    share: tuple[float, float],
    distance: float,
    pressure: float,
    hardness: float = HARDNESS,
) -> xr.Dataset:
    """Stress of every touching summit, the yielding fraction of the contact area, and the pressure of yielding.

    The summits have an interference [m], radius [m], stress [Pa] and strip, (n,) each; the share A_P / A comes with its
    standard error [-]. At the distance of the mean planes [m], the pressure is the mean of the surfaces without
    attraction [Pa]; the hardness is that of the softer body [Pa].
    """
    names = ("interference", "radius", "stress")
    columns = {name: ("summit", np.asarray(summits[name], np.float32)) for name in names}
    return xr.Dataset(
        columns
        | {
            "strip": ("summit", np.asarray(summits["strip"], np.int32)),
            "plastic_share": ((), share[0]),
            "plastic_share_error": ((), share[1]),
            "separation": ((), distance),
            "pressure": ((), pressure),
            "hardness": ((), hardness),
        }
    )


def _settings(plan, at):
    """Settings of the contact, with the number of strips and the distance of App. A, and with the hardness."""
    study = plan.config["studies"]["plasticity"]
    size = {"strips": study["strips"], "distance_nm": study["distance_nm"][at.pair]}
    return select(Settings, plan.seen_by(at.pair, (*ELASTIC, "hardness_GPa"), samples=None) | size)


STAGES = (
    Stage.writing(
        "plasticity",
        "studies/plasticity/{pair}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=_settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(sides_of(data), at.pair, settings),
        message="Stress of the touching summits of pair {pair} (App. A).",
        running=Running(minutes=10),
    ),
)

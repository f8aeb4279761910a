"""Study asperities: adhesion energies of the same strips under several definitions of an asperity."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from time import process_time
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.config.units import in_si
from stiction.contact import solids
from stiction.contact.asperity import Asperity
from stiction.contact.environment import Water
from stiction.contact.full.elements import Adhesion
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.pair import Definition, EquivalentSurface
from stiction.contact.pair import solid_pressure as pressure_of_spheres
from stiction.contact.regions import Strip, alone, solid_pressure
from stiction.contact.vanderwaals import DugdaleAttraction
from stiction.plan.stage import At, Running, Stage
from stiction.progress import progress
from stiction.stages.contact.changes import variants
from stiction.stages.contact.pairs import bodies, streams_of_sides

#: A sphere on every summit, one of the area of every island, one fitted to it; every island with its true shape.
READINGS = (*map(str, Definition), "shape")


@dataclass(frozen=True)
class Settings:
    """Solids, water, humidities and numbers of strips."""

    solids: variants.SolidsOfPair
    water: Water
    humidities: tuple[float, ...]  #: [-]
    strips: int  #: number of pairs of strips: the first samples of stage contact
    shapes: int  #: number of them in which islands have their true shape

    @property
    def attractions(self) -> tuple[str, ...]:
        """Media of the compared attractions of the solids: the configuration's, and none."""
        return tuple(dict.fromkeys((self.solids.van_der_waals, "none")))


def compute(grids: Sequence[EquivalentSurface], pair: str, seed: int, settings: Settings) -> xr.Dataset:
    """Energies of all strips on every grid, under every reading and attraction, and their computing time.

    Islands have their true shape on the first grid alone: on one that is twice as fine they take minutes per strip.

    Raises
    ------
    ValueError
        If the solids attract each other across gaps.
    """
    if settings.water.gaps is not None:
        raise ValueError(
            "readings of asperities are compared without attraction across gaps: attraction.reach: touching"
        )
    streams, films = streams_of_sides(seed, pair), [settings.water.film(each) for each in settings.humidities]
    media = [_Medium.from_settings(settings.solids, name) for name in settings.attractions]
    energies = np.full((len(grids), len(READINGS), settings.strips, len(media), len(films)), np.nan)
    seconds = np.full(energies.shape[:-1], np.nan)
    for i, surface in enumerate(grids):
        for k in progress(range(settings.strips), "surface pairs"):
            strip = Strip(surface.draw(*streams(k)), surface.distances, films)
            for (j, reading), (n, medium) in product(enumerate(READINGS), enumerate(media)):
                if reading != "shape" or (i == 0 and k < settings.shapes):
                    start = process_time()
                    pressure = _pressure(strip, surface, reading, medium)
                    seconds[i, j, k, n] = process_time() - start
                    energies[i, j, k, n] = strip.energies(pressure)
    return layout(energies, seconds, [surface.spacing for surface in grids], settings.attractions, settings.humidities)


class _Medium(NamedTuple):
    """Both solids with one medium between them."""

    modulus: float  #: E' [Pa]
    sphere: Asperity
    attraction: DugdaleAttraction | None

    @classmethod
    def from_settings(cls, settings, name):
        """Both solids of the settings with a medium between them."""
        upper, lower = bodies(settings)
        pair = (between(upper, lower, name) for between in (solids.asperity_between, solids.attraction_between))
        return cls(solids.composite_modulus(upper, lower), *pair)


def _pressure(strip, surface, reading, medium):
    """Pressure of the solids of a strip under a reading."""
    if reading != "shape":
        spheres = replace(surface, definition=Definition(reading)).asperities(strip.heights)
        return pressure_of_spheres(medium.sphere, spheres, strip.grid)
    space = HalfSpace(strip.heights.shape, surface.spacing, medium.modulus)
    attraction = Adhesion.from_film((0.0, 0.0), medium.attraction, space)
    return solid_pressure(strip, alone(strip.heights, space), attraction)


def layout(
    energies: np.ndarray,
    seconds: np.ndarray,
    spacings: Sequence[float],
    attractions: Sequence[str],
    humidities: Sequence[float],
) -> xr.Dataset:
    """Dataset of the energies of all strips and of the time of a strip.

    Energies e are (n_grid, n_reading, n, n_attraction, n_humidity), NaN where not computed [J m⁻²]; seconds, without
    the last axis, are those at all humidities without drawing the strip [s]. Spacings of the grids [m]; attractions are
    media.
    """
    over = ("spacing", "reading", "strip", "attraction")
    return xr.Dataset(
        {
            "adhesion_energy": ((*over, "humidity"), energies),
            "seconds": (over, seconds),
        },
        coords={
            "spacing": ("spacing", list(spacings)),
            "reading": list(READINGS),
            "strip": np.arange(energies.shape[2], dtype=np.int32),
            "attraction": list(attractions),
            "humidity": ("humidity", list(humidities)),
        },
    )


def energies_of_readings(study: xr.Dataset) -> Iterator[tuple[dict, np.ndarray]]:
    """Yield every reading, attraction and grid, and e of its computed strips (n, h) [J m⁻²].

    The first is that of a sphere on every summit, on the grid of the contact, with attraction of the solids.
    """
    for attraction, reading, spacing in product(study.attraction.values, study.reading.values, study.spacing.values):
        labels = {"spacing": float(spacing), "reading": str(reading), "attraction": str(attraction)}
        values = study.adhesion_energy.sel(labels).transpose("strip", "humidity").values
        if len(computed := values[np.isfinite(values).all(axis=1)]):
            yield labels, computed


def cost(study: xr.Dataset, spacing: float, reading: str, attraction: str) -> float:
    """Median processor time of a strip under a reading and attraction, relative to the first reading [-]."""
    seconds = study.seconds.sel(reading=reading, spacing=spacing, attraction=attraction)
    return float(seconds.median() / study.seconds[0, 0, :, 0].median())


def _settings(plan, at):
    """Surfaces of the pair, on the grid of the contact and on one twice as fine. Solids, water and sizes.

    ASSUME: attraction across gaps is left out, as in `stiction.stages.contact.full_contact.settings_of`.
    """
    study, surfaces = plan.config["studies"]["asperities"], plan.variants.summits(at.pair, "base")
    del surfaces["base"]["contact"]["samples"]  # of the variants
    return {
        "surfaces": surfaces | {"changes": {"sampling": {"spacing_nm": plan.config["sampling"]["spacing_nm"] / 2}}},
        "study": {
            "solids": plan.variants.solids(at.pair, "base"),
            "water": plan.air.without_gaps(at.pair),
            "humidities": sorted(plan.air.humid(at.pair)),
            "strips": study["samples"],
            "shapes": min(study["shapes"], study["samples"]),
        },
    }


def _compute(data, pair, settings):
    """Study of the surfaces on both grids."""
    *leading, base, fine, measured = variants.arguments(data, pair, settings["surfaces"])
    grids = [variants.equivalent_under(*leading, base, changed, measured) for changed in (base, fine)]
    return compute(grids, pair, base.seed, in_si(Settings, settings["study"]))


STAGES = (
    Stage.writing(
        "readings",
        "studies/asperities/{pair}",
        inputs=lambda plan, at: variants.inputs(plan, At(pair=at.pair, variant="base")),
        settings=_settings,
        compute=_compute,
        message="Readings of an asperity, pair {pair}.",
        running=Running(minutes=60),
    ),
)

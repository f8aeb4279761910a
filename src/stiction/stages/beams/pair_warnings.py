"""Results of pairs beyond the limits of the model, by the rules of `stiction.devices.limits.rules`."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.contact.air import Air
from stiction.contact.environment import Water
from stiction.devices.limits import rules
from stiction.devices.limits.limit import Limit, restored
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever
from stiction.stages.beams.releases import ends_as, stuck_lengths
from stiction.stages.surfaces import surface_flags
from stiction.surface.replica import Coherence


class Subject(NamedTuple):
    """Results that limits are about: of a pair or device, and which of them."""

    name: str
    which: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Words of a list, such as ``pair b, RH 0.67, G``."""
        return ", ".join((self.name, *self.which))


#: Limits by their subject.
Limits = dict[Subject, list[Limit]]
#: Names of materials, each with the properties that are stated.
StatedProperties = Sequence[tuple[str, Sequence[str]]]
#: Plastic share of the contact area of a pair [-], and the mean pressure of its surfaces at which it is plastic [Pa].
Plastic = tuple[float, float]
NOT_STUDIED = (np.nan, np.nan)


@dataclass(frozen=True, kw_only=True)
class OfPairs(Cantilevers):
    """Nominal beams of all pairs, and their strips."""

    sampling: StripLength
    water: dict[str, Water]  #: by pair
    replicas: dict[str, Coherence] = field(default_factory=dict)  #: of pairs whose beams follow their substrate


def beam_warnings(beams: xr.Dataset, nominal: Beam, strip: float) -> list[Limit]:
    """Limits of the beams of a case of the main line: dataset of stage beams, length of the strips [m]."""
    s_shaped = ends_as(beams, "S-shape")
    limits = [rules.arcs_of_elements(float(ends_as(beams, "arc").mean()), strip)]
    if "longest_strip" in beams:
        limits.append(rules.long_strips(strip, float(beams.longest_strip)))
    if s_shaped.any():
        mean = float(stuck_lengths(beams).mean())
        limits += [
            rules.cut_off_mean(float(s_shaped.mean()), mean, nominal.length),
            rules.large_rotation(nominal.gap, mean),
            rules.stubby_beam(mean, nominal.thickness),
            rules.wide_beam(nominal.gap, nominal.width, nominal.thickness, mean),
        ]
    return rules.triggered(*limits)


def contact_warnings(
    plastic: Plastic, materials: StatedProperties, is_stopper: bool = False, is_listed: bool = True
) -> list[Limit | None]:
    """Limits, or None, of the contact of a pair. ``is_listed`` says whether the list of studies admits plasticity."""
    about = (limit(*material) for material in materials for limit in (rules.default_material, rules.spacer))
    return [rules.plastic_contact(*plastic, is_stopper, is_listed), *about]


def plastic_contact(plasticity: Mapping[str, xr.Dataset], pair: str) -> Plastic:
    """Plastic fraction of the contact of a pair and its pressure, from the datasets of study plasticity."""
    if pair not in plasticity:
        return NOT_STUDIED
    return float(plasticity[pair].plastic_share), float(plasticity[pair].pressure)


def main_line_warnings(
    beams: Mapping[tuple[str, float, str], xr.Dataset],
    plasticity: Mapping[str, xr.Dataset],
    materials: Mapping[str, StatedProperties],
    settings: OfPairs,
    plasticity_is_listed: bool = True,
) -> Limits:
    """Limits of the main line, with the plasticity of studied pairs.

    Each pair has the names of its materials, each with the properties that are stated.
    """
    limits = {
        Subject(f"pair {pair}"): rules.triggered(
            _without_water(pair, beams, settings.water[pair]),
            *contact_warnings(plastic_contact(plasticity, pair), materials[pair], is_listed=plasticity_is_listed),
            rules.strips_move_alone(settings.replicas[pair].play if pair in settings.replicas else 0.0),
        )
        for pair in settings.pairs
    }
    for (pair, humidity, model), dataset in beams.items():
        nominal = cantilever(settings, pair)
        film = rules.triggered(rules.thin_film(settings.water[pair].film(humidity)[0]))
        subject = Subject(f"pair {pair}", (Air(humidity).words, model))
        limits[subject] = film + beam_warnings(dataset, nominal, settings.sampling.strip_length)
    return limits


def _without_water(pair, cases, water):
    """Limit, or None, of a pair without water. All cases give pair, humidity and model."""
    wettest = max((humidity for name, humidity, _ in cases if name == pair), default=0.0)
    return rules.no_water(water.film(wettest)[0], wettest)


def film_warnings(cases: Collection[tuple[str, float, str]], water: Mapping[str, Water]) -> Limits:
    """Limits of pairs without water, and of films too thin for a liquid, at each humidity of a pair.

    The cases are pair, humidity and model.
    """
    by_subject = {Subject(f"Pair {pair}"): _without_water(pair, cases, film) for pair, film in water.items()}
    for pair, humidity, _ in cases:
        film = water[pair].film(humidity)[0]
        by_subject[Subject(f"Pair {pair}", (Air(humidity).words,))] = rules.thin_film(film)
    return {subject: [limit] for subject, limit in by_subject.items() if limit}


def surface_notes(
    data: Mapping[str, Mapping[str, xr.Dataset]],
    surfaces: Mapping[str, Sequence[str]],
    assumed: Mapping[str, Sequence[Mapping]] = {},
) -> dict[str, list[Limit]]:
    """Flags of the measured surfaces of every pair, and limits of the assumed ones, which settings hold as stored.

    Datasets of ``surface_flags.inputs``, measured surfaces and stored limits by pair.
    """
    flags = surface_flags.limits_of(data)
    return {
        pair: [*(flag for name in names for flag in flags[name]), *map(restored, assumed.get(pair, ()))]
        for pair, names in surfaces.items()
    }

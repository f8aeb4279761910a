"""Relations for all places of contact: pairs in the run, devices, and test beams in their place."""

import math
import operator
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from stiction.config.cases import TOO_LITTLE
from stiction.config.keys import Keys, Relations
from stiction.config.kinds import KINDS
from stiction.config.materials import material_of
from stiction.config.messages import ConfigError, Problem, is_number, one_line
from stiction.config.mission.adsorption import adsorbed_heights
from stiction.config.mission.conditions import CONDITIONS, humidity_of_air, temperatures
from stiction.config.reading import is_stated
from stiction.config.units import NM_PER_UM, from_si, to_si
from stiction.constants import ZERO_CELSIUS
from stiction.contact.air import MOLECULES, has_dry, humid
from stiction.contact.materials import COATING
from stiction.contact.meniscus import BRIDGE, dry_air, is_wetted, meniscus_height
from stiction.devices.limits import rules
from stiction.models import SIDES
from stiction.rounding import is_at_most

#: Relations between what meets, its gaps and the air between.
relation = Relations()

TEMPERATURE, ADSORBED, _SHOWN = "water.temperature_K", "water.adsorbed_nm", "figures.humidity"
#: Key of air by its dew point.
_DEW_POINT = "dew_point_C"
#: Humidity in place of one that follows from other keys, where the schema looks.
ANY = 0.5
#: Levels above ``test_beams.T.crack_lengths[0].humidity``, the deepest humidity.
_LEVELS = 5


@dataclass(frozen=True)
class Meeting:
    """Two surfaces in contact, over some gaps and in some air."""

    config: Keys
    pair: str
    airs: list[str]  #: keys of humidities
    gaps: list[tuple[str, str]]  #: keys of gaps, each with that of the humidities at this gap
    stated: list[str]  #: keys that say what meets
    asked: tuple[str, ...] = ()  #: key that says whether it is computed
    deviation: str = ""  #: key of the uncertainty of the humidities
    others: tuple[tuple[str, float], ...] = ()  #: surfaces with another rms [nm] than in their sections
    bracketed: str = ""  #: key of the humidities that have what bounds thin films beside them

    def keys_behind(self, *more: str) -> list[str]:
        """List the keys behind a refusal, ``more`` among them."""
        return [*self.asked, *more, *self.stated]

    @cached_property
    def surfaces(self) -> list[str]:
        """Names of both surfaces."""
        return surfaces_of(self.pair, self.config)

    @cached_property
    def sides(self) -> list[dict]:
        """Sections of both surfaces."""
        return [self.config["surfaces"][name] for name in self.surfaces]

    @property
    def rms(self) -> float:
        """Rms of both surfaces together [nm]."""
        stated = zip(self.surfaces, self.sides, strict=True)
        return math.hypot(*(dict(self.others).get(name, side["rms_nm"]) for name, side in stated))

    @cached_property
    def materials(self) -> list[dict]:
        """Stated properties of the material of each surface. Empty for the solid of both bodies."""
        return [material_of(self.config["materials"], side) for side in self.sides]

    def wetting(self, more: float = 0) -> tuple[float, ...]:
        """Contact angles [rad], empty without water. ``more`` degrees are added to both angles."""
        angles = [to_si(material.get("contact_angle_deg", 0) + more, "deg") for material in self.materials]
        return tuple(angles) if is_wetted(angles) else ()

    @property
    def is_wetted(self) -> bool:
        """Whether water condenses in humid air."""
        return bool(self.wetting())

    @cached_property
    def _temperatures(self):
        """Temperatures of the conditions of devices by humidity [K]."""
        return temperatures(self.config.config, self.pair) if self.bracketed else {}

    def temperature(self, humidity: float) -> float:
        """Temperature of the water at a humidity [K]."""
        return self._temperatures.get(humidity, self.config[TEMPERATURE])

    def molecules(self, key: str) -> int:
        """Fewest molecules across a film at the humidities of a key: fewer than a liquid where other airs bound it."""
        return BRIDGE if key == self.bracketed else MOLECULES

    def too_dry(
        self, humidities: float | list, more: float = 0, warmer: float = 0, molecules: int = MOLECULES
    ) -> str | None:
        """Refusal of a humidity if its film has too few molecules, at larger angles [degrees] or warmer [K]."""
        angles, wet = self.wetting(more), sorted(humid(humidities)) if self.wetting(more) else []
        refusals = (dry_air(air, self.temperature(air) + warmer, angles, molecules) for air in wet)
        return next(filter(None, refusals), None)


def surfaces_of(pair: str, config: Keys) -> list[str]:
    """Names of the surfaces of a pair. A pair that is not defined, which another relation reports, is an error."""
    return [config[f"pairs.{pair}.{side}"] for side in SIDES]


def meetings(config: Keys) -> Iterator[Meeting]:
    """Yield all meetings."""
    yield from pair_meetings(config)
    for name, _ in config.entries("devices", "pair"):
        yield device_meeting(name, config)


def pair_meetings(config: Keys) -> Iterator[Meeting]:
    """Yield the meetings of the pairs in the run."""
    for pair, *surfaces in config.entries("pairs", *SIDES):
        if pair in config["run.pairs"]:
            section = f"pairs.{pair}"
            listed, shown = (dict(config.given_items(key)).get(key) for key in (f"{section}.humidities", _SHOWN))
            airs = [f"{section}.humidities", *([_SHOWN] if shown not in (listed or ()) else [])]
            stated = [*(f"{section}.{side}" for side in SIDES), *config.scanned(*surfaces)]
            yield Meeting(config, pair, airs, [(f"{section}.gap_um", air) for air in airs], stated, ("run.pairs",))


def device_meeting(name: str, config: Keys) -> Meeting:
    """Meeting at a device, also along its chart, and for a stopper at the humidities of its search."""
    section = f"devices.{name}"
    pair, humidities = config[f"{section}.pair"], f"{section}.humidities"
    airs, gaps = [humidities], [(f"{section}.gap_um", humidities)]
    for _, chart in config.given_items(f"{section}.chart"):
        airs.append(f"{section}.chart.humidities")
        gaps.append((f"{section}.{'chart.gaps_um' if 'gaps_um' in chart else 'gap_um'}", airs[-1]))
    if KINDS[config[f"{section}.kind"]].release.in_any_air and humid(config[humidities]):
        airs.append("design.worst_humidities")
    scanned = config.scanned(*surfaces_of(pair, config))
    deviation, bracketed = f"{section}.uncertainty.humidity", humidities if config.bounds_films else ""
    return Meeting(config, pair, airs, gaps, scanned, deviation=deviation, bracketed=bracketed)


def shown_humidity(config: Keys) -> float:
    """Humidity of the figures: as stated, otherwise the usual one or one in which all pairs in the run can touch.

    The nearest humidity of the pair of the figures takes the place of one in which the contact of a pair is refused.
    """
    pairs, usual = config["run.pairs"], config[_SHOWN]
    of_pairs = list(pair_meetings(config))
    if is_stated(config.config, *_SHOWN.split(".")) or not any(_refusal(meeting, usual) for meeting in of_pairs):
        return usual
    shown = config["figures.pair"] if config["figures.pair"] in pairs else pairs[0]
    stated = sorted(config[f"pairs.{shown}.humidities"], key=lambda humidity: abs(humidity - usual))
    return next((air for air in stated if not any(_refusal(meeting, air) for meeting in of_pairs)), stated[0])


def _refusal(meeting, humidity):
    """Refusal of a humidity for a pair of surfaces: no liquid film, or a film that fills the gap."""
    (gap, _), *_ = meeting.gaps
    least, refusal = least_gap(humidity, meeting)
    return meeting.too_dry(humidity) or (refusal if meeting.config[gap] < least else None)


def with_any_humidity(config: Any) -> Any:
    """Configuration, valid or not, with some humidity for each dew point. A schema wants numbers there."""
    return _at_dew_points(config, lambda _value, _path: ANY)


def at_dew_points(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration with the humidity at the temperature of the water for each dew point.

    ``humidities: [{dew_point_C: 10}]`` is the humidity, to four decimals, of air with this dew point.

    Raises
    ------
    ConfigError
        If water condenses at the temperature.
    """
    return _at_dew_points(config, partial(_humidity_of_dew_point, temperature=Keys(config)[TEMPERATURE]))


def _at_dew_points(value, humidity, path=()):
    """Part of a configuration, valid or not, at a path. A function of dew points and their paths gives humidities."""
    if _is_dew_point(value, path):
        return humidity(value, path)
    if isinstance(value, dict) and len(path) <= _LEVELS:
        return {key: _at_dew_points(inner, humidity, (*path, key)) for key, inner in value.items()}
    if isinstance(value, list) and len(path) <= _LEVELS:
        return [_at_dew_points(inner, humidity, (*path, k)) for k, inner in enumerate(value)]
    return value


def _is_dew_point(value, path):
    """Whether a value at a path is the dew point in place of a humidity."""
    is_humidity = "humidities" in path[-2:] or path[-1:] == ("humidity",)
    is_air = is_humidity and not {"uncertainty", CONDITIONS} & {*path}
    return is_air and isinstance(value, dict) and {*value} == {_DEW_POINT} and is_number(value[_DEW_POINT])


def _humidity_of_dew_point(value, path, temperature):
    """Humidity of a dew point. Refuses air from which water condenses on the surfaces."""
    humidity = humidity_of_air(temperature, value[_DEW_POINT] + ZERO_CELSIUS)
    if humidity is None:
        words = (
            f"is {one_line(value)}, must be below the temperature of the water, {temperature - ZERO_CELSIUS:.4g} °C: "
            "water condenses on colder surfaces, which is not in the model, and unsafe "
            f"(given {TEMPERATURE} = {temperature:g})"
        )
        raise ConfigError(str(Problem(path, words)))
    return humidity


@relation
def gaps_are_far_above_the_film(config):
    """Require a gap far above the water film and the peaks of the substrate along most of a crack.

    A gap is refused once, in the air that needs the largest.
    """
    for meeting in meetings(config):
        refused = {}
        for gap, air in meeting.gaps:
            values = dict(config.given_items(gap, air))
            if len(values) == 2:
                adsorbed = dict(config.given_items(ADSORBED))
                least, refusal = least_gap(values[air], meeting)
                refusal_at_air = least, gap, refusal, air, *meeting.keys_behind(TEMPERATURE, *adsorbed)
                if np.min(values[gap]) < least:
                    largest = refused.get(gap, refusal_at_air)
                    refused[gap] = max(largest, refusal_at_air, key=operator.itemgetter(0))
        yield from (refusal[1:] for refusal in refused.values())


def with_rms(config: Keys, device: str, rms: Mapping[str, float]) -> Meeting:
    """Meeting at a device with another rms of some surfaces [nm]."""
    return replace(device_meeting(device, config), others=tuple(rms.items()))


def least_gap(humidities: float | list, meeting: Meeting) -> tuple[float, str]:
    """Smallest gap [µm] far above the film at the highest humidity, and its message."""
    height, rms = max(films(humidities, meeting), default=0.0), to_si(meeting.rms, "nm")
    least = from_si(rules.least_gap(height, rms), "um")
    return least, (
        f"must be at least {least:.4g} µm, {rules.FILMS} times the sum of the height of the water film, "
        f"{from_si(height, 'nm'):.5g} nm, and the rms of the surfaces, {from_si(rms, 'nm'):.3g} nm"
    )


def films(humidities: float | list, meeting: Meeting) -> list[float]:
    """Heights of the water at those of some humidities at which it condenses, with what adsorbs [m]."""
    adsorbed = to_si(sum(value for _, value in meeting.config.given_items(ADSORBED)), "nm")
    angles, wet = meeting.wetting(), humid(humidities) if meeting.wetting() else []
    grown = adsorbed_heights(meeting.config["water"], wet)
    heights = (meniscus_height(air, meeting.temperature(air), angles) for air in wet)
    return [float(height) + adsorbed + more for height, more in zip(heights, grown, strict=True)]


@relation
def coatings_leave_a_gap(config):
    """Require both coatings together to be thinner than the gap."""
    for meeting in meetings(config):
        coatings = sum(material.get(COATING, 0) for material in meeting.materials)
        for key, gap in config.given_items(*dict.fromkeys(gap for gap, _ in meeting.gaps)):
            if np.min(gap) * NM_PER_UM <= coatings:
                message = f"must be above the thickness of the coatings of both surfaces, {coatings:g} nm"
                yield key, message, *meeting.keys_behind()


@relation
def water_is_a_liquid(config):
    """Require air humid enough for a film of liquid water. The humidity of the figures is refused once."""
    refused = {}
    for meeting in meetings(config):
        for key, humidities in config.given_items(*meeting.airs):
            if refusal := meeting.too_dry(humidities, molecules=meeting.molecules(key)):
                refused.setdefault(key, (key, refusal, *meeting.keys_behind(TEMPERATURE)))
    yield from refused.values()


#: Values with which attraction ends where surfaces touch, and those that have it across gaps.
_TOO_SHORT = {
    "attraction.reach": ("touching", "all"),
    "van_der_waals": ("none", "water or dry"),
}


@relation
def attraction_reaches_across_dry_gaps(config):
    """Require attraction across gaps in dry air. There surfaces attract each other mostly out of contact."""
    for meeting in meetings(config):
        dry = [key for key, humidities in config.given_items(*meeting.airs) if has_dry(humidities)]
        if meeting.is_wetted and not dry:
            continue
        angles = " and ".join(f"{material.get('contact_angle_deg', 0):g}" for material in meeting.materials)
        why = "in dry air" if meeting.is_wetted else f"where no water condenses at contact angles of {angles} degrees"
        for key, value in config.given_items(*_TOO_SHORT):
            refused, allowed = _TOO_SHORT[key]
            if value == refused:
                yield (
                    key,
                    f"must be {allowed} for pair {meeting.pair}, {why}: {TOO_LITTLE}",
                    *dry,
                    *meeting.keys_behind(),
                )


@relation
def corrections_are_not_extrapolated(config):
    """Require devices in full elastic contact within the humidities of their pair and of its figures."""
    if config["contact"].get("model") != "full":
        return
    for name, _ in config.entries("devices", "pair"):
        meeting = device_meeting(name, config)
        of_pair, (stated, *others) = f"pairs.{meeting.pair}.humidities", meeting.airs
        shown = [config["figures.humidity"]] * (meeting.pair in config["run.pairs"])
        covered, uncertain = [*config[of_pair], *shown], dict(config.given_items(meeting.deviation))
        for key, humidities in config.given_items(stated, *others):
            more = sum(uncertain.values()) if key == stated else 0
            if not meeting.is_wetted or _is_within(humidities, more, covered):
                continue
            words = ", with its uncertainty," if more else ""
            restricted = "to which the correction of contact.model full is restricted"
            yield key, f"must be{words} within the humidities of pair {meeting.pair}, {restricted}", of_pair


def _is_within(humidities, more, covered):
    """Whether humidities, with their uncertainty, are within covered ones: dry air is one of these or not."""
    wet, of_pair = humid(humidities), humid(covered)
    if has_dry(humidities) and not has_dry(covered) or wet and not of_pair:
        return False
    return not wet or is_at_most(min(of_pair), min(wet) - more) and is_at_most(max(wet) + more, max(of_pair))

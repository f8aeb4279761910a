"""Air around the pairs of a configuration: condensation of water, and the medium of attraction.

Decides which contact a pair has at each humidity. The names of airs, and the words of a user for its
humidities, are in `stiction.config.cases`.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any

from stiction.config.cases import TOO_LITTLE, PairInAir
from stiction.config.materials import Materials, hamaker_constant, hamaker_constants
from stiction.config.mission.conditions import temperatures
from stiction.config.units import to_si
from stiction.contact.air import Air, humid
from stiction.contact.materials import COATING, COATING_ATTRACTION, OF_COATINGS
from stiction.contact.meniscus import is_wetted, least_humidity, require_humidity
from stiction.contact.vanderwaals import combined
from stiction.models import SIDES
from stiction.plan.stage import subsection


@dataclass(frozen=True)
class Environment:
    """Contacts of the pairs at the humidities of a configuration, and the forces in them."""

    config: dict  #: complete and valid
    of_devices: bool = False  #: whether devices stick in it, none of which is a case of the paper

    def reach(self, contact: str) -> str:
        """Range of attraction between the solids of a contact, ``touching`` or ``all``: as stated.

        ASSUME: otherwise across all gaps, which is the safe side. A pair can state another range for its beams in humid
        air, as those of the paper do. It does not hold for devices.
        """
        if reach := self.config["attraction"].get("reach"):
            return reach
        in_humid_air = contact == PairInAir(contact).pair and self.is_wetted(contact)
        of_pair = in_humid_air and not self.of_devices
        return self.config["pairs"][contact].get("attraction", "all") if of_pair else "all"

    @property
    def _materials(self):
        return Materials(self.config)

    def contact(self, pair: str, humidity: float) -> PairInAir:
        """Contact of a pair at a humidity. Without condensation, it is the contact in dry air.

        Its solids attract each other through air, across all gaps. One contact is enough if they do so at any humidity.

        Raises
        ------
        ValueError
            If no air has this humidity, or no water condenses and attraction does not reach across gaps.
        """
        require_humidity(humidity)
        if not self.is_dry(pair, humidity):
            return PairInAir(pair)
        if self.config["attraction"].get("reach") == "touching":
            raise ValueError(f"pair {pair} in dry air needs attraction.reach: all: {TOO_LITTLE}")
        is_same = self.config["van_der_waals"] == "dry" and self.reach(pair) == "all"
        return PairInAir(pair) if is_same else PairInAir.in_dry_air(pair)

    def is_wetted(self, pair: str) -> bool:
        """Whether water condenses between the surfaces of a pair at some humidity."""
        return bool(self.wetting(pair))

    def wetting(self, pair: str) -> tuple[float, ...]:
        """Contact angles between the surfaces of a pair [rad], empty without water."""
        angles = tuple(to_si(angle, "deg") for angle in self._contact_angles(pair))
        return angles if is_wetted(angles) else ()

    def humid(self, pair: str) -> list[float]:
        """Humidities of a pair with condensation of water: studies against humidity leave out dry air."""
        return self.wet(pair, self.config["pairs"][pair]["humidities"])

    def wet(self, pair: str, humidities: Iterable[float]) -> list[float]:
        """Humidities, among some, at which water condenses between the surfaces of a pair."""
        return humid(humidities) if self.is_wetted(pair) else []

    def is_dry(self, pair: str, humidity: float) -> bool:
        """Whether no water condenses between the surfaces of a pair at a humidity."""
        return not self.wet(pair, [humidity])

    def corrected(self, pair: str, humidities: Iterable[float], config: dict | None = None) -> list[float]:
        """Humidities, among some, at which predictions are corrected to full elastic contact.

        ASSUME: by default those in dry air, where the sum over summits is on the unsafe side by up to a factor of 3.5.
        Devices are corrected in humid air as well, see `by_levels`.
        Another configuration may be given, such as that of a variant.
        """
        model = (config or self.config)["contact"].get("model")
        return [rh for rh in humidities if model == "full" or model is None and self.is_dry(pair, rh)]

    def by_levels(self, pair: str, humidities: Iterable[float]) -> list[float]:
        """Humidities, among some, at which devices are corrected if the error of a change allows.

        ASSUME: by default in humid air, where the sum over summits errs by up to 10 % of a length and 80 % of a force,
        and tips of rough pairs hold up to four times less.
        """
        is_default = "model" not in self.config["contact"]
        return self.wet(pair, humidities) if is_default and self.of_devices else []

    def not_modelled(self, cases: Iterable[tuple[str, float]]) -> dict[str, Any]:
        """Effects missing in the results of some cases, each a pair and a humidity, by keys and for which pairs."""
        cases = list(cases)
        pairs = list(dict.fromkeys(pair for pair, _ in cases))
        humid = {pair for pair, humidity in cases if not self.is_dry(pair, humidity)}
        touching = [pair for pair in pairs if pair in humid and self.reach(pair) == "touching"]
        nothing_attracts = self.config["van_der_waals"] == "none"
        left_out = ["van_der_waals"] if nothing_attracts else ["gaps"] * bool(touching)
        uncorrected = [
            case for case in cases if not (self.corrected(case[0], case[1:]) or self.by_levels(case[0], case[1:]))
        ]
        dry = {self.is_dry(*case) for case in uncorrected}
        left_out += ["summits"] * (False in dry) + ["bent"] * (True in dry)
        follows = {"copied": True} if pairs and all("replica" in self.config["pairs"][pair] for pair in pairs) else {}
        of_some = {"pairs": touching} if "gaps" in left_out and len(touching) < len(pairs) else {}
        return {"left_out": left_out, "humid": not all(self.is_dry(*case) for case in cases)} | of_some | follows

    def around(self, contact: str, config: dict | None = None) -> dict[str, Any]:
        """Configuration with attraction of the summits of a contact through its own medium."""
        medium, config = PairInAir(contact).medium, config or self.config
        return config | {"van_der_waals": medium} if medium else config

    def water(self, contact: str, config: dict | None = None) -> dict[str, Any]:
        """Section ``water`` of a contact, without zeros: with the contact angles, and the attraction across gaps.

        Another configuration may be given for water and attraction, such as that of a variant.
        """
        angles = self._contact_angles(contact)
        gaps = self._gaps(contact, self.around(contact, config))
        water = {key: value for key, value in (config or self.config)["water"].items() if value}
        further = self._warmer(contact) | self._bounded(contact, angles)
        return water | further | ({"contact_angles_deg": angles} if any(angles) else {}) | gaps

    def temperature(self, pair: str, humidity: float) -> float:
        """Temperature of the water of a pair at a humidity: that of a condition of its devices where they stick [K]."""
        by_humidity = self._temperatures.get(PairInAir(pair).pair, {}) if self.of_devices else {}
        return by_humidity.get(humidity, self.config["water"]["temperature_K"])

    @cached_property
    def _on_pairs(self):
        """Devices by pair and name."""
        devices = {}
        for name, device in self.config.get("devices", {}).items():
            devices.setdefault(device["pair"], {})[name] = device
        return devices

    @cached_property
    def _temperatures(self):
        """Temperatures of the water in conditions of devices, by pair and humidity [K]."""
        return {pair: temperatures({"devices": devices}, pair) for pair, devices in self._on_pairs.items()}

    @cached_property
    def _airs(self):
        """Humidities of devices in humid air, by pair."""
        return {
            pair: set(humid(chain.from_iterable(device["humidities"] for device in devices.values())))
            for pair, devices in self._on_pairs.items()
        }

    def _warmer(self, contact):
        """How much warmer the water of a pair is in conditions of its devices."""
        by_humidity = self._temperatures.get(PairInAir(contact).pair, {}) if self.of_devices else {}
        differences = {
            Air(air).name: round(at - self.config["water"]["temperature_K"], 6) for air, at in by_humidity.items()
        }
        warmer = {air: differences[air] for air in sorted(differences) if differences[air]}
        return {"warmer_K": warmer} if warmer else {}

    def _bounded(self, contact, angles):
        """Whether films of a pair that are no liquid have what bounds them beside them, as those of devices."""
        pair, wetting = PairInAir(contact).pair, tuple(to_si(angle, "deg") for angle in angles)
        if not (self.of_devices and is_wetted(wetting)):
            return {}
        thin = [air for air in self._airs.get(pair, ()) if air < least_humidity(self.temperature(pair, air), wetting)]
        return {"bounded": True} if thin else {}

    def across_gaps(self, contact: str) -> dict[str, Any]:
        """Settings of `water`, with attraction across gaps."""
        return self.water(contact, self.config | {"attraction": self.config["attraction"] | {"reach": "all"}})

    def without_gaps(self, contact: str) -> dict[str, Any]:
        """Settings of `water`, without attraction across gaps."""
        return {key: value for key, value in self.water(contact).items() if key != "gaps"}

    def _contact_angles(self, pair):
        """Contact angles on both surfaces of a pair [°]."""
        return [material.get("contact_angle_deg", 0) for material in self._materials.bodies(pair)]

    def _gaps(self, pair, config):
        """Attraction across the gaps between the solids of a pair, if there is any."""
        across, summits = config["attraction"], config["van_der_waals"]
        if across.get("reach", self.reach(pair)) == "touching" or summits == "none":
            return {}
        constants = {medium: self._hamaker_constant(pair, medium) for medium in (summits, "dry")}
        retarded = {"wavelength_nm": across["wavelength_nm"]} if across["retarded"] else {}
        materials = self._materials.bodies(pair)
        spacer = sum(material.get(COATING, 0) for material in materials)
        coated = {"spacer_nm": spacer} if spacer else {}
        if any(COATING_ATTRACTION in material for material in materials):
            bodies = (subsection(material, ("hamaker_constant_zJ", *OF_COATINGS)) for material in materials)
            coated["bodies"] = dict(zip(SIDES, bodies, strict=True))
        return {"gaps": {"hamaker_constant_zJ": constants, "summits": summits} | retarded | coated}

    def _hamaker_constant(self, pair, medium):
        """Hamaker constant of the two bodies of a pair through a medium [zJ]."""
        return combined(*(hamaker_constants(material)[medium] for material in self._materials.bodies(pair)))

    def hamaker_constant(self, contact: str) -> float:
        """Hamaker constant of the two bodies of a contact, zero without van der Waals forces [zJ]."""
        medium = self.around(contact)["van_der_waals"]
        return 0.0 if medium == "none" else self._hamaker_constant(contact, medium)

    def beam_hamaker_constant(self, pair: str) -> float:
        """Hamaker constant of two bodies like the beam of a pair, through the medium between the solids [zJ]."""
        return hamaker_constant(self._materials.bodies(pair)[0], self.config["van_der_waals"])

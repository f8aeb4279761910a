"""Plan of a configuration: the surfaces, cases, variants and figures to be computed.

The rules of the workflow and the library use the same plan and therefore the same cases. Densities are imported where
they are needed, because a repeated plan takes what it needs of them from `stiction.run.disk_cache`.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from stiction.config.cases import IN_HUMID_AIR, Case, PairInAir, case_id
from stiction.config.materials import Materials
from stiction.config.merging import values
from stiction.config.mission.adsorption import unmeasured
from stiction.config.reading import paper
from stiction.config.scans import is_measured, preliminary_estimates, quantities
from stiction.config.surfaces.knowledge import knowledge, uncertain
from stiction.config.surfaces.members import limits
from stiction.config.surfaces.moments import nearest_shape
from stiction.config.test_beams import as_cantilevers
from stiction.contact.air import DRY_AIR, has_dry, humid, is_humid
from stiction.contact.materials import ELASTIC
from stiction.models import BEAM_MODELS, FAR_QUANTITIES, MODE_QUANTITIES, SURFACE_MODELS
from stiction.plan.devices import DevicePlan
from stiction.plan.environment import Environment
from stiction.plan.paper import SUMMITS, PaperCase
from stiction.plan.scans import Scans
from stiction.plan.stage import subsection
from stiction.plan.variants import Variants


@dataclass(frozen=True)
class Plan:
    """Names of all results for one configuration."""

    config: dict  #: complete, valid and in normal form
    preliminary: dict[str, dict] = field(default_factory=dict)  #: numbers of measured surfaces, computed if missing

    @cached_property
    def devices(self) -> DevicePlan:
        """Plan of the devices."""
        return DevicePlan(self.config)

    @cached_property
    def materials(self) -> Materials:
        """Materials of surfaces and pairs."""
        return Materials(self.config)

    @cached_property
    def air(self) -> Environment:
        """Air around the pairs."""
        return Environment(self.config)

    @cached_property
    def air_of_devices(self) -> Environment:
        """Air around devices, and around test beams."""
        return Environment(self.config, of_devices=True)

    @cached_property
    def scans(self) -> Scans:
        """Surfaces described by scans."""
        return Scans(self.config)

    @cached_property
    def paper(self) -> PaperCase:
        """Parts of this configuration equal to the paper's."""
        return PaperCase(self)

    @cached_property
    def variants(self) -> Variants:
        """Variants of the model."""
        return Variants(self)

    @cached_property
    def with_test_beams(self) -> "Plan":
        """Plan with the arrays of test beams as devices."""
        return replace(self, config=self.config | {"devices": as_cantilevers(self.config)})

    @property
    def pairs(self) -> list[str]:
        """Pairs in the run."""
        return self.config["run"]["pairs"]

    def sides(self, pair: str) -> list[str]:
        """Sides of a pair, see `stiction.config.materials.Materials.sides`."""
        return self.materials.sides(pair)

    def contact(self, case: Case) -> PairInAir:
        """Contact of the pair of a case."""
        return self.air.contact(case.pair, case.humidity)

    def contact_of_device(self, case: Case) -> PairInAir:
        """Contact of a case of a device, see `contact`."""
        return self.air_of_devices.contact(self.config["devices"][case.device]["pair"], case.humidity)

    @cached_property
    def surfaces(self) -> list[str]:
        """Surfaces of the pairs in the run, in the order of the configuration."""
        names = {name for pair in self.pairs for name in self.sides(pair)}
        return [name for name in self.config["surfaces"] if name in names]

    def is_drawn(self, surface: str) -> bool:
        """Whether a surface is drawn for a pair in the run, a device or test beams."""
        users = (*self.config.get("devices", {}).values(), *self.config.get("test_beams", {}).values())
        pairs = [*self.pairs, *(user["pair"] for user in users if "pair" in user)]
        return any(surface in self.sides(pair) for pair in pairs)

    # The configuration as the jobs of a pair see it

    def seen_by(self, pair: str, properties: Sequence[str] = ELASTIC, **contact: Any) -> dict[str, Any]:
        """Configuration with the surfaces, the water and some properties of the materials of a pair.

        Keys of section ``contact`` may be given; those that are ``None`` are left out.
        """
        changed = {key: value for key, value in (self.config["contact"] | contact).items() if value is not None}
        of_pair = {"surfaces": self.sides(pair), "water": self.air.water(pair), "contact": changed}
        sections = {key: value for key, value in self.air.around(pair).items() if key != "materials"}
        return sections | of_pair | self.materials.settings(pair, properties) | self.replica(pair)

    def replica(self, pair: str) -> dict[str, dict]:
        """Setting ``replica`` of a pair, empty if its surfaces are independent."""
        return subsection(self.config["pairs"][PairInAir(pair).pair], ["replica"])

    def at(self, case: Case) -> dict[str, Any]:
        """Configuration of `seen_by`, with the humidity of a case."""
        return self.seen_by(self.contact(case)) | {"humidity": case.humidity}

    def over_humidities(self, pair: str) -> dict[str, Any]:
        """Configuration of `seen_by`, with the humidities of a pair."""
        return self.seen_by(pair) | {"humidities": self.air.humid(pair)}

    @property
    def humid_pairs(self) -> list[str]:
        """Pairs in the run with condensation between their surfaces at some humidity."""
        return [pair for pair in self.pairs if self.air.humid(pair)]

    @property
    def humid_cases(self) -> list[Case]:
        """Cases with condensation of water."""
        return [case_id(pair, humidity) for pair in self.pairs for humidity in self.air.humid(pair)]

    @property
    def surfaces_with_scans(self) -> list[str]:
        """Surfaces of the pairs in the run described by scans."""
        return [name for name in self.surfaces if name in self.scans.surfaces]

    @property
    def surfaces_by_numbers(self) -> list[str]:
        """Surfaces of the pairs in the run described by numbers."""
        return [name for name in self.surfaces if name not in self.scans.surfaces]

    @cached_property
    def scanned_pairs(self) -> list[str]:
        """Pairs with a surface described by scans, and condensation between their surfaces."""
        return [pair for pair in self.humid_pairs if self.scans.sides(pair)]

    def quantities(self, surface: str) -> tuple[str, ...]:
        """Quantities of a surface with slopes, see `stiction.analysis.shifts`. Those of scans include modes."""
        modes = MODE_QUANTITIES if surface in self.scans.surfaces else ()
        return tuple(dict.fromkeys((*quantities(self.config["surfaces"][surface]), *modes)))

    def deviation(self, surface: str, quantity: str) -> float:
        """Standard uncertainty of a quantity of a surface, stated or assumed, that its slope spans, otherwise 0 [-]."""
        entry = self.config["surfaces"][surface]
        if is_measured(entry) or quantity not in FAR_QUANTITIES or quantity not in uncertain(entry):
            return 0.0
        errors = knowledge(entry, paper()["surfaces"]).section
        index = errors["quantities"].index(quantity)
        return float(errors["covariance"][index][index] ** 0.5)

    def assumptions(self, *pairs: str) -> dict[str, list[dict[str, Any]]]:
        """Stored limits by assumed properties of the surfaces of some pairs, by pair, without empty ones."""
        library, entries = paper()["surfaces"], self.config["surfaces"]
        end = self.devices.nyquist
        by_surface = {name: limits(name, entries[name], library, end) for name in self.scans.described_by_numbers}
        surfaces_of_pairs = {pair: dict.fromkeys(self.sides(pair)) for pair in pairs}
        by_pair = {
            pair: [limit.stored() for name in names for limit in by_surface.get(name, ())]
            for pair, names in surfaces_of_pairs.items()
        }
        return {pair: of_pair for pair, of_pair in by_pair.items() if of_pair}

    def limits_of_pairs(self) -> dict[str, list[dict[str, Any]]]:
        """Stored limits of the pairs in the run by pair, without empty ones: of `assumptions`, and of films."""
        assumed, pairs = self.assumptions(*self.pairs), self.config["pairs"]
        films = {pair: self.unmeasured_films(self.air.wet(pair, pairs[pair]["humidities"])) for pair in self.pairs}
        by_pair = {pair: assumed.get(pair, []) + films[pair] for pair in self.pairs}
        return {pair: of_pair for pair, of_pair in by_pair.items() if of_pair}

    def unmeasured_films(self, wet: Iterable[float]) -> list[dict[str, Any]]:
        """Stored limit by films at humidities at which water condenses, see `stiction.config.mission.adsorption`."""
        return [limit.stored() for limit in unmeasured(self.config["water"], wet)]

    @cached_property
    def with_summits(self) -> list[str]:
        """Surfaces with measured summits, for the identification of their spectrum."""
        return [name for name in self.surfaces if self.has_summits(name)]

    def has_summits(self, surface: str) -> bool:
        """Whether the summits of a surface are given."""
        return all(key in self.config["surfaces"][surface] for key in SUMMITS)

    @cached_property
    def cases(self) -> list[Case]:
        """Cases of every pair at each of its humidities."""
        return [case_id(pair, humidity) for pair in self.pairs for humidity in self.config["pairs"][pair]["humidities"]]

    @cached_property
    def laws(self) -> list[tuple[Case, str]]:
        """Case and model of all force laws."""
        return [(case, model) for case in self.cases for model in SURFACE_MODELS]

    @cached_property
    def outcomes(self) -> list[tuple[Case, str]]:
        """Case and model of all beams."""
        return [(case, model) for case in self.cases for model in BEAM_MODELS]

    # Figures that show one pair, one case or one humidity

    @property
    def figure_pair(self) -> str:
        """Pair of the figures: the configuration's if it is in the run, otherwise the first one."""
        pair = self.config["figures"]["pair"]
        return pair if pair in self.pairs else self.pairs[0]

    @property
    def figure_pairs(self) -> list[str]:
        """Pairs of figures of several: the pair of the figures, with the other copies of section ``compare``."""
        end = next((end for end in values(self.config) if self.figure_pair.endswith(end)), "")
        original = self.figure_pair.removesuffix(end)
        copies = {original + other for other in values(self.config)} if end else {self.figure_pair}
        return [pair for pair in self.pairs if pair in copies]

    @property
    def figure_case(self) -> Case:
        """Case of the figures: their pair at their humidity."""
        return case_id(self.figure_pair, self.config["figures"]["humidity"])

    @property
    def figure_settings(self) -> dict[str, Any]:
        """Pair and humidity of the figures, as their captions state them."""
        return {"pair": self.figure_pair, "humidity": self.config["figures"]["humidity"]}

    @property
    def figure_cases(self) -> dict[str, Case]:
        """Case of every pair at the humidity of the figures, by pair."""
        return {pair: case_id(pair, self.config["figures"]["humidity"]) for pair in self.pairs}

    @property
    def figure_surface(self) -> str:
        """Surface of the beam in the pair of the figures."""
        return self.config["pairs"][self.figure_pair]["beam"]

    @property
    def figure_outcomes(self) -> list[tuple[Case, str]]:
        """Case and model of the beams of the pair of the figures on non-Gaussian surfaces."""
        return [(case, model) for case, model in self.outcomes if case.pair == self.figure_pair and model != "G"]

    @property
    def other_surfaces(self) -> list[str]:
        """Surfaces other than the figures'."""
        return [name for name in self.surfaces if name != self.figure_surface]

    # Studies

    @property
    def studies(self) -> list[str]:
        """Studies in the run, by their section: by default those of the paper.

        Those over the humidity need pairs that water wets.
        """
        of_paper = [name for name in self.config["studies"] if name != "full_contact"]
        names = self.config["run"].get("studies", of_paper)
        pairs = {"sensitivity": self.figure_pairs} if self.pairs else {}
        pairs |= dict.fromkeys(IN_HUMID_AIR, self.pairs)
        return [name for name in names if name not in pairs or any(map(self.air.humid, pairs[name]))]

    def states_model_error(self, pair: str, humidities: Iterable[float]) -> bool:
        """Whether the error of the model is stated beside predictions for a pair at some humidities."""
        return self.has_humid_full_contact or bool(self.variants.corrected(pair, humidities))

    def states_error_of_device(self, device: str) -> bool:
        """Whether the error of the model is stated beside predictions for a device."""
        section = self.devices.sections[device]
        pair, humidities = section["pair"], section["humidities"]
        return bool(self.air_of_devices.by_levels(pair, humidities)) or self.states_model_error(pair, humidities)

    def airs_of_beams(self, pair: str) -> list[float]:
        """Humidities of all beams of devices and test beams on a pair, and of their charts, increasing."""
        arrays = self.with_test_beams.devices if "test_beams" in self.config else self.devices
        airs = {
            humidity
            for devices in (self.devices, arrays)
            for name in devices.beams
            if devices.sections[name]["pair"] == pair
            for humidity in (
                *devices.sections[name]["humidities"],
                *(devices.axis(name) if name in devices.with_chart else ()),
            )
        }
        return sorted(airs)

    @property
    def has_humid_full_contact(self) -> bool:
        """Whether full contact is computed in humid air, too: for its study, or to correct predictions."""
        return "full_contact" in self.studies or self.config["contact"].get("model") == "full"

    def humidities_of_full_contact(self, pair: str) -> list[float]:
        """Humidities of a pair, that of its figures if these show corrected laws beyond them, its devices' dry air."""
        humidities, shown = self.config["pairs"][pair]["humidities"], self.config["figures"]["humidity"]
        wet = humid(humidities)
        within = shown in humidities or is_humid(shown) and wet and min(wet) <= shown <= max(wet)
        corrected = pair in self.pairs and self.variants.corrected(pair, [shown])
        devices = [*self.devices.sections.values(), *as_cantilevers(self.config).values()]
        dry = [DRY_AIR.humidity] * any(has_dry(section["humidities"]) for section in devices if section["pair"] == pair)
        return list(dict.fromkeys([*humidities, *([shown] if corrected and not within else []), *dry]))

    @property
    def pressed_pairs(self) -> list[str]:
        """Pairs in the study of plasticity."""
        distances = self.config["studies"]["plasticity"]["distance_nm"]
        return [pair for pair in self.pairs if pair in distances and "plasticity" in self.studies]

    @property
    def sensitivities(self) -> dict[tuple[str, str], str]:
        """Datasets of the sensitivities of the pairs of the figures in humid air, by pair and moment."""
        pairs = filter(self.air.humid, self.figure_pairs)
        return {(pair, name): f"studies/sensitivity/{pair}_{name}" for pair in pairs for name in self.shifted_moments}

    @cached_property
    def shifted_moments(self) -> list[str]:
        """Moments with sensitivities: movable in all pairs of the figures."""
        return ["rms", *filter(self._can_be_shifted, ("skewness", "kurtosis"))] if self.pairs else []

    def _can_be_shifted(self, moment):
        """Whether surfaces with the moment slightly decreased and slightly increased exist."""
        surfaces = dict.fromkeys(self.config["pairs"][pair]["beam"] for pair in self.figure_pairs)
        return all(self._has_shifted(self._feasible_shape(surface), moment) for surface in surfaces)

    def _has_shifted(self, shape, moment):
        """Whether the moment of a surface of this skewness and kurtosis, if they are known, can be shifted."""
        from stiction.analysis.sensitivity import shifted
        from stiction.surface.feasible import is_feasible

        if shape is None:
            return False
        at = shifted(shape[moment], self.config["studies"]["sensitivity"]["step"])
        exists = all(is_feasible(**shape | {moment: value}) for value in at)
        return at[0] * at[1] > 0 and exists

    def _feasible_shape(self, surface):
        """Skewness and kurtosis of the maximum-entropy density of a surface, ``None`` if its heights are measured."""
        entry, names = self.config["surfaces"][surface], ("skewness", "kurtosis")
        if not is_measured(entry):
            return dict(zip(names, nearest_shape(**subsection(entry, names)), strict=True))
        if entry["heights"] == "measured":
            return None
        estimates = self.preliminary or preliminary_estimates(self.config)[0]
        return dict(zip(names, estimates[surface]["feasible"], strict=True))

"""Variants of a configuration: one changed model choice each, left open by the paper."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from stiction.config.cases import Case, PairInAir, case_id
from stiction.config.merging import merged
from stiction.contact.materials import ELASTIC
from stiction.models import SIDES
from stiction.plan.names import CHANGED, CORRECTED, FINER
from stiction.plan.paper import MOMENTS
from stiction.plan.stage import subsection

#: Sections of what is between the solids, which does not affect their contact.
_BETWEEN = {"attraction", "water"}
#: Sections of the solids, which do not affect the summits.
_SOLIDS = ("solid", "van_der_waals")


@dataclass(frozen=True)
class Variants:
    """Variants of a plan, and their changes."""

    plan: Any  #: a `stiction.plan.plan.Plan`

    @property
    def config(self) -> dict:
        """Configuration of the plan."""
        return self.plan.config

    def corrected(self, pair: str, humidities: Iterable[float], variant: str = "base") -> list[float]:
        """Humidities at which predictions are corrected, see `stiction.plan.environment.Environment.corrected`."""
        contact = self.config["contact"] | self.changes[variant].get("contact", {})
        return self.plan.air.corrected(pair, humidities, {"contact": contact})

    @cached_property
    def finer_beams(self) -> dict[str, dict]:
        """Changes of the variants with only a finer mesh. Surfaces and contact are the base's."""
        length, strip = self.config["beam"]["length_um"], self.config["sampling"]["strip_length_um"]
        strips = self.config["studies"]["variants"][FINER]
        meshes = {f"{FINER}_{n}": round(length / (strip * n)) for n in strips}
        same = self.config["beam"]["elements"]
        return {name: {"elements": elements} for name, elements in meshes.items() if elements != same}

    @cached_property
    def changes(self) -> dict[str, dict]:
        """Changes of every variant, ``base`` first."""
        studied = self.config["studies"]["variants"]
        changes = {
            f"{key}_{value}": {section: {key: value}} if section else {key: value}
            for key, section in CHANGED.items()
            for value in studied.get(key, [])
        }
        full = {CORRECTED: {"contact": {"model": "full"}}} if "full_contact" in self.plan.studies else {}
        return {"base": {}} | changes | {name: {"beam": mesh} for name, mesh in self.finer_beams.items()} | full

    def surface(self, variant: str, surface: str) -> dict:
        """Description of a surface under a variant, for drawing it."""
        entry, psd = self.config["surfaces"][surface], self._psd_under(variant, surface)
        keys = [*MOMENTS, "published_psd"] if psd == "published" else MOMENTS
        return subsection(entry, keys) | {"psd": psd}

    def water(self, pair: str, variant: str) -> dict:
        """Section ``water`` of a pair under a variant."""
        return self.plan.air.water(pair, merged(self.config, self.changes[variant]))

    def _psd_under(self, variant, surface):
        """Source of the spectrum of a surface: the variant's if available, otherwise unchanged."""
        entry = self.config["surfaces"][surface]
        sources = {"published": "published_psd" in entry, "identified": self.plan.has_summits(surface)}
        source = self.changes[variant].get("psd", entry["psd"])
        return source if sources[source] else entry["psd"]

    def summits(self, pair: str, variant: str) -> dict:
        """Settings of the summits of a pair without the variant, and the changes of the variant.

        A measured surface is that of the base: no variant changes its heights or its spectrum.
        """
        pair, scanned = PairInAir(pair).pair, self.plan.scans.surfaces
        contact = subsection(self.config["contact"], ("distance_step_nm", "every", "asperity"))
        base = (
            subsection(self.config, ("seed", "sampling"))
            | self.plan.replica(pair)
            | {
                "contact": contact | {"samples": self.config["studies"]["variants"]["samples"]},
                "beam": subsection(self.config["beam"], ["width_um"]),
                "pairs": {pair: subsection(self.config["pairs"][pair], SIDES)},
                "surfaces": {
                    name: self.surface(variant, name) for name in self.plan.sides(pair) if name not in scanned
                },
            }
        )
        changes = {} if variant == CORRECTED else subsection(self.changes[variant], ("sampling", "contact"))
        identified = sorted(name for name, entry in base["surfaces"].items() if entry["psd"] == "identified")
        return {"base": base, "changes": changes, "identified": identified}

    def solids(self, pair: str, variant: str) -> dict:
        """Solids of a pair under a variant: the settings of the contact, given the summits."""
        sections = merged(subsection(self.config, _SOLIDS), subsection(self.changes[variant], _SOLIDS))
        return self.plan.air.around(pair, sections) | self.plan.materials.settings(pair, ELASTIC, sections["solid"])

    def with_summits_of(self, pair: str, variant: str) -> str:
        """First variant with the same summits of a pair: solids do not change them."""
        summits = self._all_summits(pair, variant)
        return next(name for name in self.changes if self._all_summits(pair, name) == summits)

    def has_islands(self, variant: str) -> bool:
        """Whether the asperities are islands under a variant. Their contact depends on more than the summits."""
        changed = self.changes[variant].get("contact", {})
        return (self.config["contact"] | changed).get("asperity", "summit") != "summit"

    def contact_under(self, variant: str) -> str:
        """Variant with the contact of a variant: the base's if only later steps differ."""
        after = variant in self.finer_beams or variant == CORRECTED or bool(_BETWEEN & self.changes[variant].keys())
        return "base" if after else variant

    @property
    def has_samples(self) -> bool:
        """Whether the first samples of the main line are those of the base of the variants."""
        return self.config["contact"]["samples"] >= self.config["studies"]["variants"]["samples"]

    def _all_summits(self, pair, variant):
        """Settings of the summits of a pair under a variant."""
        summits = self.summits(pair, variant)
        return merged(summits["base"], summits["changes"])

    def _under(self, pair, variant):
        """All settings by which the variants of a pair differ."""
        contact = self.solids(pair, variant)
        if "materials" in contact:  # of both sides, with all properties of section solid
            del contact["solid"]
        corrected = self.corrected(pair, self.plan.air.humid(PairInAir(pair).pair), variant)
        after = self.water(pair, variant), self.finer_beams.get(variant), corrected
        return self._all_summits(pair, variant), contact, *after

    def choices(self, pair: str) -> list[str]:
        """Variants with another contact of a pair, in the run or not. Devices have summits under all of them."""
        contacts = [
            name for name in self.changes if self.contact_under(name) == name != "base" and not self.has_islands(name)
        ]
        return [name for name in contacts if self._under(pair, name) != self._under(pair, "base")]

    def choices_of_solids(self, pair: str) -> list[str]:
        """Variants of `choices` with unchanged surfaces, on patches of any size."""
        return [name for name in self.choices(pair) if self.with_summits_of(pair, name) == "base"]

    def choices_of_device(self, case: Case) -> list[str]:
        """Variants of `choices` for a device at a humidity: short strips have those of the solids, probes none."""
        if self.plan.devices.kind(case.device).shape:
            return []
        of_pair = self.choices_of_solids if self.plan.devices.kind(case.device).has_short_strips else self.choices
        return of_pair(self.plan.contact_of_device(case))

    def water_of_choices(self, contact: str, choices: Sequence[str]) -> dict[str, dict]:
        """Section ``water`` of a contact of devices under `choices` with other attraction across gaps."""
        air = self.plan.air_of_devices
        waters = {name: air.water(contact, merged(self.config, self.changes[name])) for name in choices}
        return {name: water for name, water in waters.items() if water != air.water(contact)}

    @cached_property
    def pairs(self) -> list[tuple[str, str]]:
        """Pairs and their variants, without those equal to the base for the pair."""
        return [
            (pair, variant)
            for pair in self.plan.humid_pairs
            for variant in self.changes
            if variant == "base" or self._under(pair, variant) != self._under(pair, "base")
        ]

    @property
    def cases(self) -> list[tuple[Case, str]]:
        """Cases of the pairs and their variants."""
        humid = self.plan.air.humid
        return [(case_id(pair, humidity), variant) for pair, variant in self.pairs for humidity in humid(pair)]

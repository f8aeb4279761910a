"""Plan of a configuration: the surfaces, cases, variants and figures to be computed.

The rules of the workflow and the library use the same plan and therefore the same cases. Densities are imported where
they are needed, because a repeated plan takes what it needs of them from `stiction.run.disk_cache`.
"""

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from stiction.config.arrays import as_cantilevers
from stiction.config.cases import TOO_LITTLE, case_id, humidity_of, in_any_air, in_dry_air, is_in_dry_air, pair_of
from stiction.config.designs import Designs, hamaker_constant, hamaker_constants
from stiction.config.files import paper
from stiction.config.measured import digest, evaluation, is_measured, preliminary_estimates, quantities, source
from stiction.config.merging import merged
from stiction.config.units import to_si
from stiction.contact.meniscus import is_wetted
from stiction.devices.materials import COATED, COATING, ELASTIC, PROPERTIES
from stiction.models import BEAM_MODELS, MODE_QUANTITIES, SIDES, SURFACE_MODELS

#: Keys of the measured statistics of a surface: moments of the heights and summit statistics.
MOMENTS = ("rms_nm", "skewness", "kurtosis")
SUMMITS = ("mean_summit_radius_um", "summit_density_per_um2")
#: Key that a variant changes, and its section; the source of the spectrum is a key of each surface.
_CHANGED = {
    **{"van_der_waals": None, "psd": None, "asperity": "contact", "every": "contact", "spacing_nm": "sampling"},
    **{"poisson_ratio": "solid", "reach": "attraction"},
}
#: Sections of the solids, which do not affect the summits.
_SOLIDS = ("solid", "van_der_waals")
#: Keys that define the beam that the paper measured and simulated.
_OF_BEAM = {"beam": ("length_um", "width_um", "thickness_um"), "solid": ("young_modulus_GPa",)}
#: Keys that define the mesh of the paper and, with Young's modulus and the force laws, how fine it is; it has no width.
_OF_MESH = {"beam": ("length_um", "thickness_um", "elements"), "sampling": ("strip_length_um",)}


#: Variant that corrects the base case to full elastic contact.
CORRECTED = "contact_full"
#: ASSUME: a solid is polysilicon if its Young's modulus differs from that of the paper by no more than this share.
_POLYSILICON = 0.1


def chosen(section: dict[str, Any], names: Iterable[str]) -> dict[str, Any]:
    """Section reduced to the named keys, as far as it contains them."""
    return {name: section[name] for name in names if name in section}


def _in_its_air(pair, config):
    """Configuration in which the summits of a pair attract each other through the air that its name says."""
    return config | {"van_der_waals": "dry"} if is_in_dry_air(pair) else config


def _same(section, other, only=None, but=()):
    """Whether two sections agree in some keys, by default in all; ``False`` if the other section is ``None``."""
    if other is None:
        return False
    keys = only or {*section, *other} - set(but)
    return all(section.get(key) == other.get(key) for key in keys)


@dataclass(frozen=True)
class Plan:
    """Names of everything that is computed for one configuration."""

    config: dict  #: complete, valid and in normal form
    preliminary: dict[str, dict] = field(default_factory=dict)  #: numbers of measured surfaces, computed if missing

    @cached_property
    def designs(self) -> Designs:
        """Plan of the devices."""
        return Designs(self.config)

    @cached_property
    def of_test_beams(self) -> "Plan":
        """Plan in which the arrays of test beams are the devices."""
        return replace(self, config=self.config | {"devices": as_cantilevers(self.config)})

    @property
    def pairs(self) -> list[str]:
        """Pairs that run."""
        return self.config["run"]["pairs"]

    def sides(self, pair: str) -> list[str]:
        """Names of the surfaces of a pair, in any air, that of the beam first."""
        return [self.config["pairs"][in_any_air(pair)][side] for side in SIDES]

    def in_air(self, pair: str, humidity: float) -> str:
        """Name of the contact of a pair at a humidity: that in dry air where no water condenses.

        Its summits attract each other through air. One contact is enough if they do so at any humidity.

        Raises
        ------
        ValueError
            If no water condenses and attraction does not reach across gaps.
        """
        if humidity > 0 and self.is_wetted(pair):
            return pair
        if self.config["attraction"]["reach"] == "touching":
            raise ValueError(f"pair {pair} in dry air needs attraction.reach: all: {TOO_LITTLE}")
        return pair if self.config["van_der_waals"] == "dry" else in_dry_air(pair)

    def is_wetted(self, pair: str) -> bool:
        """Whether water condenses between the surfaces of a pair at some humidity."""
        return is_wetted(tuple(to_si(angle, "deg") for angle in self._contact_angles(pair)))

    def in_air_of(self, case: str) -> str:
        """As `in_air`, of a case."""
        return self.in_air(pair_of(case), humidity_of(case))

    def in_air_of_device(self, case: str) -> str:
        """As `in_air`, of the pair of a device at a humidity."""
        return self.in_air(self.config["devices"][pair_of(case)]["pair"], humidity_of(case))

    def humid(self, pair: str) -> list[float]:
        """Humidities of a pair at which water condenses: studies over the humidity leave out dry air."""
        return [rh for rh in self.config["pairs"][pair]["humidities"] if rh > 0 and self.is_wetted(pair)]

    def _stated(self, pair):
        """Stated properties of the materials of both surfaces of a pair."""
        named = self.config.get("materials", {})
        return [named.get(self.config["surfaces"][surface].get("material"), {}) for surface in self.sides(pair)]

    def materials(self, pair: str, properties: Sequence[str], solid: dict | None = None) -> dict[str, dict]:
        """Some properties of the materials of a pair by side; empty if those of section solid and polysilicon hold.

        What a material does not state is taken from section ``solid``, by default that of the configuration.
        """
        stated = [chosen(material, properties) for material in self._stated(pair)]
        if not any(stated):
            return {}
        others = solid or self.config["solid"]
        return {"materials": {side: others | material for side, material in zip(SIDES, stated, strict=True)}}

    def stated_properties(self, pair: str) -> list:
        """Names of the materials of a pair, each with its stated properties in words; section solid if it is one."""
        named, solid = self.config.get("materials", {}), self.config["solid"]
        words = {one.key: one.words for one in PROPERTIES.values()} | {COATING: COATED}
        if abs(solid["young_modulus_GPa"] / paper()["solid"]["young_modulus_GPa"] - 1) > _POLYSILICON:
            named = named | {"the solid": solid}
        surfaces = self.config["surfaces"]
        used = dict.fromkeys(surfaces[surface].get("material", "the solid") for surface in self.sides(pair))
        return [
            [name, [words[key] for key, value in named[name].items() if key != COATING or value]]
            for name in used
            if name in named
        ]

    def water(self, pair: str, variant: str = "base") -> dict:
        """Section ``water`` of a pair: with the contact angles if one is not zero, and the attraction across gaps."""
        angles = self._contact_angles(pair)
        gaps = self._gaps(pair, _in_its_air(pair, merged(self.config, self.variants[variant])))
        return self.config["water"] | ({"contact_angles_deg": angles} if any(angles) else {}) | gaps

    def _contact_angles(self, pair):
        """Contact angles on both surfaces of a pair [°]."""
        return [material.get("contact_angle_deg", 0) for material in self._stated(pair)]

    def _gaps(self, pair, config):
        """Attraction across the gaps between the solids of a pair, if there is any."""
        reach, summits = config["attraction"], config["van_der_waals"]
        if reach["reach"] == "touching" or summits == "none":
            return {}
        both = [hamaker_constants(material) for material in self._stated(pair)]
        constants = {medium: math.sqrt(math.prod(one[medium] for one in both)) for medium in (summits, "dry")}
        retarded = {"wavelength_nm": reach["wavelength_nm"]} if reach["retarded"] else {}
        spacer = sum(material.get(COATING, 0) for material in self._stated(pair))
        coated = {"spacer_nm": spacer} if spacer else {}
        return {"gaps": {"hamaker_constant_zJ": constants, "summits": summits} | retarded | coated}

    def beam_modulus(self, pair: str) -> dict:
        """Young's modulus of the beam of a pair if its material states one, otherwise empty."""
        return chosen(self._stated(pair)[0], ["young_modulus_GPa"])

    def hamaker_constant(self, pair: str) -> float:
        """Hamaker constant of the two bodies of a pair, zero without van der Waals forces [zJ]."""
        medium = _in_its_air(pair, self.config)["van_der_waals"]
        if medium == "none":
            return 0.0
        return math.sqrt(math.prod(hamaker_constants(material)[medium] for material in self._stated(pair)))

    def beam_hamaker_constant(self, pair: str) -> float:
        """Hamaker constant of two bodies like the beam of a pair, through the medium between the solids [zJ]."""
        return hamaker_constant(self._stated(pair)[0], self.config["van_der_waals"])

    @cached_property
    def surfaces(self) -> list[str]:
        """Surfaces of the pairs that run, in the order of the configuration."""
        used = {name for pair in self.pairs for name in self.sides(pair)}
        return [name for name in self.config["surfaces"] if name in used]

    # The configuration as the jobs of a pair see it

    def seen_by(self, pair: str, properties: Sequence[str] = ELASTIC, **contact: Any) -> dict[str, Any]:
        """Configuration with the surfaces, the water and some properties of the materials of a pair.

        Keys of section ``contact`` may be given; those that are ``None`` are left out.
        """
        changed = {key: value for key, value in (self.config["contact"] | contact).items() if value is not None}
        own = {"surfaces": self.sides(pair), "water": self.water(pair), "contact": changed}
        others = {key: value for key, value in _in_its_air(pair, self.config).items() if key != "materials"}
        return others | own | self.materials(pair, properties)

    def at(self, case: str) -> dict[str, Any]:
        """As `seen_by`, with the humidity of a case."""
        return self.seen_by(self.in_air_of(case)) | {"humidity": humidity_of(case)}

    def over_humidities(self, pair: str) -> dict[str, Any]:
        """As `seen_by`, with the humidities of a pair."""
        return self.seen_by(pair) | {"humidities": self.humid(pair)}

    @property
    def humid_pairs(self) -> list[str]:
        """Pairs that run between whose surfaces water condenses at some humidity."""
        return [pair for pair in self.pairs if self.humid(pair)]

    @property
    def humid_cases(self) -> list[str]:
        """Those of `cases` in which water condenses."""
        return [case_id(pair, humidity) for pair in self.pairs for humidity in self.humid(pair)]

    @property
    def samples_of_slopes(self) -> int:
        """Number of samples of a contact that is compared with the first samples of the contact itself."""
        return min(self.config["studies"]["slopes"]["samples"], self.config["contact"]["samples"])

    # Surfaces described by scans

    @property
    def unscanned(self) -> list[str]:
        """All surfaces of the configuration that are described by numbers."""
        return [name for name in self.config["surfaces"] if name not in self.scanned]

    def scan_path(self, surface: str, number: str) -> str:
        """File of a scan, relative to the working directory, so that a moved folder changes nothing."""
        return os.path.relpath(self.scan_files(surface)[number])

    def scan(self, surface: str, number: str) -> dict[str, Any]:
        """File of a scan by its content, and how it is read; the folder of the file does not affect the result."""
        path = self.scan_files(surface)[number]
        return {"file": Path(path).name, "sha256": digest(path), "source": source(self.config["surfaces"][surface])}

    def estimate(self, surface: str) -> dict[str, Any]:
        """How the scans of a surface are evaluated, with the names of the files."""
        how = evaluation(self.config["surfaces"][surface], self.config["scans"])
        files = [Path(path).name for path in self.scan_files(surface).values()]
        return {
            "seed": self.config["seed"],
            "evaluation": how,
            "model_scans": self.config["scans"]["model_scans"],
            "files": files,
        }

    @property
    def scanned(self) -> list[str]:
        """All surfaces of the configuration that are described by scans."""
        return [name for name, entry in self.config["surfaces"].items() if is_measured(entry)]

    @property
    def estimated(self) -> list[str]:
        """Surfaces of the pairs that run that are described by scans."""
        return [name for name in self.surfaces if name in self.scanned]

    @property
    def described(self) -> list[str]:
        """Surfaces of the pairs that run that are described by numbers."""
        return [name for name in self.surfaces if name not in self.scanned]

    def scan_files(self, surface: str) -> dict[str, str]:
        """Files of the scans of a surface, by number; none if it is described by numbers."""
        files = self.config["surfaces"][surface].get("scans", {}).get("files", ())
        return {str(number): file for number, file in enumerate(files)}

    def scanned_sides(self, pair: str) -> list[str]:
        """Surfaces of a pair that are described by scans, each once."""
        return [name for name in dict.fromkeys(self.sides(pair)) if name in self.scanned]

    @cached_property
    def scanned_pairs(self) -> list[str]:
        """Pairs with a surface described by scans, between whose surfaces water condenses."""
        return [pair for pair in self.humid_pairs if self.scanned_sides(pair)]

    def quantities(self, surface: str) -> tuple[str, ...]:
        """Quantities of a surface that have slopes, see `stiction.analysis.shifts`; those of scans include modes."""
        modes = MODE_QUANTITIES[1:] if surface in self.scanned else ()
        return tuple(dict.fromkeys((*quantities(self.config["surfaces"][surface]), *modes)))

    @cached_property
    def with_summits(self) -> list[str]:
        """Surfaces with measured summits, whose spectrum can therefore be identified."""
        return [name for name in self.surfaces if self._has_summits(name)]

    def _has_summits(self, surface):
        """Whether the summits of a surface are given."""
        return all(key in self.config["surfaces"][surface] for key in SUMMITS)

    @cached_property
    def cases(self) -> list[str]:
        """Every pair at each of its humidities."""
        return [case_id(pair, humidity) for pair in self.pairs for humidity in self.config["pairs"][pair]["humidities"]]

    @cached_property
    def laws(self) -> list[tuple[str, str]]:
        """Case and model of all force laws."""
        return [(case, model) for case in self.cases for model in SURFACE_MODELS]

    @cached_property
    def outcomes(self) -> list[tuple[str, str]]:
        """Case and model of all beams."""
        return [(case, model) for case in self.cases for model in BEAM_MODELS]

    # Comparison with published values

    @cached_property
    def paper_surfaces(self) -> list[str]:
        """Surfaces of the paper: measured statistics and published spectrum as in its case study."""
        known = paper()["surfaces"]
        return [name for name in self.surfaces if _same(self.config["surfaces"][name], known.get(name), but=["psd"])]

    @cached_property
    def paper_pairs(self) -> list[str]:
        """Pairs of the paper: same surfaces, gap and beam."""
        known = paper()
        beam = all(_same(self.config[section], known[section], only=keys) for section, keys in _OF_BEAM.items())
        return [
            pair
            for pair in self.pairs
            if beam
            and _same(self.config["pairs"][pair], known["pairs"].get(pair), but=["humidities"])
            and set(self.sides(pair)) <= set(self.paper_surfaces)
        ]

    def has_mesh_of_paper(self, case: str) -> bool:
        """Whether the beams of a case have the elements of the paper, whatever their force laws.

        ASSUME: the mesh of the paper belongs to its beam, strips and pairs, up to the highest humidity of each pair. It
        is kept under other model choices, so that variants differ by their choice alone.
        """
        return humidity_of(case) <= self._highest_on_mesh.get(pair_of(case), 0)

    @cached_property
    def _highest_on_mesh(self):
        """Highest humidity of the paper of each pair whose beams may have the elements of the paper."""
        known = paper()
        if not all(_same(self.config[section], known[section], only=keys) for section, keys in _OF_MESH.items()):
            return {}
        return {
            pair: max(of_paper["humidities"])
            for pair, of_paper in known["pairs"].items()
            if _same(of_paper, self.config["pairs"].get(pair), but=["humidities"])
            and self._has_modulus_of_paper(pair)
            and all(self._has_heights_of_paper(name) for name in self.sides(pair))
        }

    def _has_modulus_of_paper(self, pair):
        """Whether the beam of a pair has the Young's modulus of the paper."""
        return _same(self.config["solid"] | self.beam_modulus(pair), paper()["solid"], only=["young_modulus_GPa"])

    def _has_heights_of_paper(self, surface):
        """Whether a surface has the moments of the paper, and the published spectrum or the summits that give it."""
        entry = self.config["surfaces"][surface]
        spectrum = ["published_psd"] if entry["psd"] == "published" else SUMMITS
        return _same(entry, paper()["surfaces"].get(surface), only=[*MOMENTS, *spectrum])

    # Figures that show one pair, one case or one humidity

    @property
    def figure_pair(self) -> str:
        """Pair of the figures: that of the configuration if it runs, otherwise the first that runs."""
        wanted = self.config["figures"]["pair"]
        return wanted if wanted in self.pairs else self.pairs[0]

    @property
    def figure_case(self) -> str:
        """Case of the figures: their pair at their humidity."""
        return case_id(self.figure_pair, self.config["figures"]["humidity"])

    @property
    def figure_cases(self) -> dict[str, str]:
        """Case of every pair at the humidity of the figures, by pair."""
        return {pair: case_id(pair, self.config["figures"]["humidity"]) for pair in self.pairs}

    @property
    def figure_surface(self) -> str:
        """Surface of the beam in the pair of the figures."""
        return self.config["pairs"][self.figure_pair]["beam"]

    @property
    def figure_outcomes(self) -> list[tuple[str, str]]:
        """Case and model of the beams of the pair of the figures on non-Gaussian surfaces."""
        return [(case, model) for case, model in self.outcomes if pair_of(case) == self.figure_pair and model != "G"]

    @property
    def other_surfaces(self) -> list[str]:
        """All surfaces except that of the figures."""
        return [name for name in self.surfaces if name != self.figure_surface]

    # Studies

    @property
    def studies(self) -> list[str]:
        """Studies that run, by their section: by default those of the paper.

        Those over the humidity need pairs that water wets.
        """
        of_paper = [name for name in self.config["studies"] if name != "full_contact"]
        wanted = self.config["run"].get("studies", of_paper)
        needed = {"sensitivity": [self.figure_pair]} if self.pairs else {}
        needed |= dict.fromkeys(("full_contact", "asperities", "pressing", "variants"), self.pairs)
        return [name for name in wanted if name not in needed or any(map(self.humid, needed[name]))]

    @property
    def states_model_error(self) -> bool:
        """Whether the error of the model is stated beside every prediction."""
        return "full_contact" in self.studies or self.is_corrected()

    def is_corrected(self, variant: str = "base") -> bool:
        """Whether predictions are corrected to full elastic contact."""
        return (self.config["contact"] | self.variants[variant].get("contact", {})).get("model") == "full"

    @property
    def pressed_pairs(self) -> list[str]:
        """Pairs whose plasticity is studied."""
        known = self.config["studies"]["plasticity"]["distance_nm"]
        return [pair for pair in self.pairs if pair in known and "plasticity" in self.studies]

    @cached_property
    def shifted_moments(self) -> list[str]:
        """Moments of the surface of the figures for which a sensitivity is computed: those that can be shifted."""
        return ["rms", *filter(self._can_be_shifted, ("skewness", "kurtosis"))] if self.pairs else []

    def _can_be_shifted(self, moment):
        """Whether surfaces with the moment slightly decreased and slightly increased exist."""
        from stiction.analysis.sensitivity import shifted
        from stiction.surface.feasible import is_feasible

        shape = self._feasible_shape(self.figure_surface)
        if shape is None:
            return False
        at = shifted(shape[moment], self.config["studies"]["sensitivity"]["step"])
        exists = all(is_feasible(**shape | {moment: value}) for value in at)
        return at[0] * at[1] > 0 and exists

    def _feasible_shape(self, surface):
        """Skewness and kurtosis of the maximum-entropy density of a surface; ``None`` if its heights are measured."""
        from stiction.surface.feasible import nearest_feasible

        entry, names = self.config["surfaces"][surface], ("skewness", "kurtosis")
        if not is_measured(entry):
            return chosen(nearest_feasible(**chosen(entry, names))._asdict(), names)
        if entry["heights"] == "measured":
            return None
        known = self.preliminary or preliminary_estimates(self.config)[0]
        return dict(zip(names, known[surface]["feasible"], strict=True))

    # Variants: one changed model choice each, where the paper leaves the choice open

    @cached_property
    def finer_beams(self) -> dict[str, dict]:
        """Changes of the variants that refine only the mesh; surfaces and contact are those of the base."""
        length, strip = self.config["beam"]["length_um"], self.config["sampling"]["strip_length_um"]
        strips = self.config["studies"]["variants"]["strips_per_element"]
        meshes = {f"strips_per_element_{n}": round(length / (strip * n)) for n in strips}
        same = self.config["beam"]["elements"]
        return {name: {"elements": elements} for name, elements in meshes.items() if elements != same}

    @cached_property
    def variants(self) -> dict[str, dict]:
        """Changes of every variant, ``base`` first."""
        wanted = self.config["studies"]["variants"]
        changes = {
            f"{key}_{value}": {section: {key: value}} if section else {key: value}
            for key, section in _CHANGED.items()
            for value in wanted.get(key, [])
        }
        full = {CORRECTED: {"contact": {"model": "full"}}} if "full_contact" in self.studies else {}
        return {"base": {}} | changes | {name: {"beam": mesh} for name, mesh in self.finer_beams.items()} | full

    def surface_under(self, variant: str, surface: str) -> dict:
        """Description of a surface under a variant, from which it is drawn."""
        entry, psd = self.config["surfaces"][surface], self._psd_under(variant, surface)
        used = [*MOMENTS, "published_psd"] if psd == "published" else MOMENTS
        return chosen(entry, used) | {"psd": psd}

    def _psd_under(self, variant, surface):
        """Source of the spectrum of a surface: that of the variant where available, otherwise unchanged."""
        entry = self.config["surfaces"][surface]
        known = {"published": "published_psd" in entry, "identified": self._has_summits(surface)}
        wanted = self.variants[variant].get("psd", entry["psd"])
        return wanted if known[wanted] else entry["psd"]

    def variant_summits(self, pair: str, variant: str) -> dict:
        """Settings of the summits of a pair without the variant, and the changes of the variant.

        A measured surface is that of the base: no variant changes its heights or its spectrum.
        """
        pair = in_any_air(pair)
        contact = chosen(self.config["contact"], ("distance_step_nm", "every", "asperity"))
        base = chosen(self.config, ("seed", "sampling")) | {
            "contact": contact | {"samples": self.config["studies"]["variants"]["samples"]},
            "beam": chosen(self.config["beam"], ["width_um"]),
            "pairs": {pair: chosen(self.config["pairs"][pair], SIDES)},
            "surfaces": {
                name: self.surface_under(variant, name) for name in self.sides(pair) if name not in self.scanned
            },
        }
        changes = {} if variant == CORRECTED else chosen(self.variants[variant], ("sampling", "contact"))
        identified = sorted(name for name, entry in base["surfaces"].items() if entry["psd"] == "identified")
        return {"base": base, "changes": changes, "identified": identified}

    def variant_contact(self, pair: str, variant: str) -> dict:
        """Solids of a pair under a variant: the settings of the contact, given the summits."""
        found = merged(chosen(self.config, _SOLIDS), chosen(self.variants[variant], _SOLIDS))
        return _in_its_air(pair, found) | self.materials(pair, ELASTIC, found["solid"])

    def summits_under(self, pair: str, variant: str) -> str:
        """First variant with the same summits of a pair: solids do not change them."""
        wanted = self._summits(pair, variant)
        return next(name for name in self.variants if self._summits(pair, name) == wanted)

    def has_islands(self, variant: str) -> bool:
        """Whether the asperities are islands under a variant; their contact depends on more than the summits."""
        changed = self.variants[variant].get("contact", {})
        return (self.config["contact"] | changed).get("asperity") == "island"

    def contact_under(self, variant: str) -> str:
        """Variant whose contact a variant has: that of the base if only what follows from it differs."""
        after = variant in self.finer_beams or variant == CORRECTED or "attraction" in self.variants[variant]
        return "base" if after else variant

    @property
    def has_samples_of_variants(self) -> bool:
        """Whether the first samples of the main line are those of the base of the variants."""
        return self.config["contact"]["samples"] >= self.config["studies"]["variants"]["samples"]

    def _summits(self, pair, variant):
        """Settings of the summits of a pair under a variant."""
        found = self.variant_summits(pair, variant)
        return merged(found["base"], found["changes"])

    def _under(self, pair, variant):
        """All settings that distinguish the variants of a pair."""
        contact = self.variant_contact(pair, variant)
        if "materials" in contact:  # of both sides, with all properties of section solid
            del contact["solid"]
        after = self.water(pair, variant), self.finer_beams.get(variant), self.is_corrected(variant)
        return self._summits(pair, variant), contact, *after

    def choices(self, pair: str) -> list[str]:
        """Variants that change the contact of a pair, which need not run; devices have summits under all of them.

        Those with other forces across gaps are left out: a budget has the same water under all of its choices.
        """
        contacts = [
            name for name in self.variants if self.contact_under(name) == name != "base" and not self.has_islands(name)
        ]
        contacts = [name for name in contacts if self.water(pair, name) == self.water(pair)]
        return [name for name in contacts if self._under(pair, name) != self._under(pair, "base")]

    def choices_of_solids(self, pair: str) -> list[str]:
        """Those of `choices` that leave the surfaces as they are, on patches of any size."""
        return [name for name in self.choices(pair) if self.summits_under(pair, name) == "base"]

    def choices_of_device(self, case: str) -> list[str]:
        """Those of `choices` for a device at a humidity: short strips have those of the solids alone."""
        of_pair = self.choices_of_solids if self.designs.kind(pair_of(case)).has_short_strips else self.choices
        return of_pair(self.in_air_of_device(case))

    @cached_property
    def studied(self) -> list[tuple[str, str]]:
        """Pairs and their variants, without those that change nothing for the pair."""
        return [
            (pair, variant)
            for pair in self.humid_pairs
            for variant in self.variants
            if variant == "base" or self._under(pair, variant) != self._under(pair, "base")
        ]

    @property
    def studied_cases(self) -> list[tuple[str, str]]:
        """Cases of the pairs and their variants."""
        return [(case_id(pair, humidity), variant) for pair, variant in self.studied for humidity in self.humid(pair)]

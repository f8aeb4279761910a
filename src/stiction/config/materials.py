"""Materials of a configuration: stated properties of the material of a surface, and those of both surfaces of a pair.

The properties themselves are in `stiction.contact.materials`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from stiction.config.cases import PairInAir
from stiction.config.units import from_si
from stiction.constants import DENSITY, HAMAKER_CONSTANT
from stiction.contact.materials import COATING, ELASTIC, OF_COATINGS, PROPERTIES, Solid
from stiction.models import SIDES

#: ASSUME: a solid is polysilicon if its Young's modulus differs from that of the paper by no more than this share.
_POLYSILICON = 0.1
_MODULUS = PROPERTIES["modulus"].key


@cache
def sourced_properties() -> dict[str, dict[str, dict[str, Any]]]:
    """Value and source of each property of the materials by name: ``materials.yaml`` next to this module."""
    return yaml.safe_load(Path(__file__).with_name("materials.yaml").read_text(encoding="utf-8"))


def with_named(config: dict[str, Any]) -> dict[str, Any]:
    """Configuration with the materials by name that its surfaces use, and with those in key ``like`` of others.

    Own materials of the same name remain.
    """
    named = {
        name: {key: entry["value"] for key, entry in properties.items()}
        for name, properties in sourced_properties().items()
    }
    stated = config.get("materials", {})
    used = dict.fromkeys(surface.get("material") for surface in config["surfaces"].values())
    materials = {name: named[name] for name in used if name in named} | {
        name: named.get(material.get("like"), {}) | {key: value for key, value in material.items() if key != "like"}
        for name, material in stated.items()
    }
    return config | {"materials": materials} if materials != stated else config


def material_of(materials: dict, surface: dict) -> dict[str, Any]:
    """Stated properties of the material of a surface, from section ``materials`` and the section of the surface."""
    return materials.get(surface.get("material"), {})


def hamaker_constants(material: dict) -> dict[str, float]:
    """Hamaker constant of two bodies of a material by medium [zJ]: as stated, or polysilicon's."""
    polysilicon = {medium: from_si(constant, "zJ") for medium, constant in HAMAKER_CONSTANT.items()}
    return material.get("hamaker_constant_zJ", polysilicon)


def hamaker_constant(material: dict, medium: str) -> float:
    """Hamaker constant through a medium [zJ]. Without van der Waals forces it is the one through dry air.

    Examples
    --------
    >>> hamaker_constant({}, "water"), hamaker_constant({"hamaker_constant_zJ": {"water": 5, "dry": 65}}, "none")
    (97.5, 65)
    """
    constants = hamaker_constants(material)
    return constants.get(medium, constants["dry"])


@dataclass(frozen=True)
class Materials:
    """Materials of the surfaces of a configuration. A pair may be named by its contact in some air."""

    config: dict  #: complete and valid

    def stated(self, surface: str) -> dict[str, Any]:
        """Stated properties of the material of a surface."""
        return material_of(self.config.get("materials", {}), self.config["surfaces"][surface])

    def sides(self, pair: str) -> list[str]:
        """Names of the surfaces of a pair, the beam's first."""
        return [self.config["pairs"][PairInAir(pair).pair][side] for side in SIDES]

    def bodies(self, pair: str) -> list[dict]:
        """Stated properties of the materials of both surfaces of a pair."""
        return list(map(self.stated, self.sides(pair)))

    def settings(self, pair: str, properties: Sequence[str], solid: dict | None = None) -> dict[str, dict]:
        """Some properties of the materials of a pair by side. Empty if those of section solid and polysilicon hold.

        What a material does not state is taken from section ``solid``, by default that of the configuration.
        """
        stated = [{key: material[key] for key in properties if key in material} for material in self.bodies(pair)]
        if not any(stated):
            return {}
        others = solid or self.config["solid"]
        return {"materials": {side: others | material for side, material in zip(SIDES, stated, strict=True)}}

    def alike(self, pair: str) -> list[str]:
        """Sides of a pair with the material of the beam."""
        bodies = self.settings(pair, ELASTIC).get("materials", {})
        return [side for side in SIDES if bodies.get(side) == bodies.get("beam")]

    def in_words(self, pair: str) -> list:
        """Names of the materials of a pair, each with its stated properties in words. Section solid if it is one."""
        named, solid = self.config.get("materials", {}), self.config["solid"]
        words = {entry.key: entry.words for entry in PROPERTIES.values()} | OF_COATINGS
        if abs(solid[_MODULUS] / from_si(Solid.young_modulus, "GPa") - 1) > _POLYSILICON:
            named = named | {"the solid": solid}
        surfaces = self.config["surfaces"]
        used = dict.fromkeys(surfaces[surface].get("material", "the solid") for surface in self.sides(pair))
        return [
            [name, [words[key] for key, value in named[name].items() if key in words and (key != COATING or value)]]
            for name in used
            if name in named
        ]

    def stated_modulus(self, pair: str) -> dict[str, float]:
        """Young's modulus of the beam of a pair by its key if its material states one, otherwise empty."""
        material = self.bodies(pair)[0]
        return {_MODULUS: material[_MODULUS]} if _MODULUS in material else {}

    def modulus(self, pair: str) -> dict[str, float]:
        """Young's modulus of the beam of a pair by its key: of its material, or of section solid."""
        return {_MODULUS: self.config["solid"][_MODULUS]} | self.stated_modulus(pair)

    def density(self, pair: str) -> float:
        """Density of the beam of a pair: of its material, or polysilicon's [kg m⁻³]."""
        return self.bodies(pair)[0].get("density_kg_per_m3", DENSITY)

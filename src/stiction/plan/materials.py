"""Materials of the surfaces of the pairs of a configuration, in the view of the jobs of a pair."""

from collections.abc import Sequence
from dataclasses import dataclass

from stiction.config.cases import PairInAir
from stiction.config.materials import material_of
from stiction.config.reading import paper
from stiction.devices.properties import COATING, ELASTIC, OF_COATINGS, PROPERTIES
from stiction.models import SIDES
from stiction.plan.stage import subsection

#: ASSUME: a solid is polysilicon if its Young's modulus differs from that of the paper by no more than this share.
_POLYSILICON = 0.1


@dataclass(frozen=True)
class PairMaterials:
    """Materials of both surfaces of a pair, named by itself or by its contact in some air."""

    config: dict  #: complete and valid

    def sides(self, pair: str) -> list[str]:
        """Names of the surfaces of a pair, the beam's first."""
        return [self.config["pairs"][PairInAir(pair).pair][side] for side in SIDES]

    def properties_of(self, pair: str) -> list[dict]:
        """Stated properties of the materials of both surfaces of a pair."""
        return [material_of(self.config, surface) for surface in self.sides(pair)]

    def settings(self, pair: str, properties: Sequence[str], solid: dict | None = None) -> dict[str, dict]:
        """Some properties of the materials of a pair by side. Empty if those of section solid and polysilicon hold.

        What a material does not state is taken from section ``solid``, by default that of the configuration.
        """
        stated = [subsection(material, properties) for material in self.properties_of(pair)]
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
        if abs(solid["young_modulus_GPa"] / paper()["solid"]["young_modulus_GPa"] - 1) > _POLYSILICON:
            named = named | {"the solid": solid}
        surfaces = self.config["surfaces"]
        used = dict.fromkeys(surfaces[surface].get("material", "the solid") for surface in self.sides(pair))
        return [
            [name, [words[key] for key, value in named[name].items() if key in words and (key != COATING or value)]]
            for name in used
            if name in named
        ]

    def beam_modulus(self, pair: str) -> dict:
        """Young's modulus of the beam of a pair if its material states one, otherwise empty."""
        return subsection(self.properties_of(pair)[0], ["young_modulus_GPa"])

"""Materials of the surfaces of a configuration: their stated properties, and Hamaker constants."""

from typing import Any

from stiction.config.units import from_si
from stiction.constants import HAMAKER_CONSTANT


def material_of(config: dict[str, Any], surface: str) -> dict[str, Any]:
    """Stated properties of the material of a surface."""
    return config.get("materials", {}).get(config["surfaces"][surface].get("material"), {})


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

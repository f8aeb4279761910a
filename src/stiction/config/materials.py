"""Materials of the surfaces of a configuration: what it states of them, and Hamaker constants."""

from typing import Any

from stiction.config.units import from_si
from stiction.constants import HAMAKER_CONSTANT


def material_of(config: dict[str, Any], surface: str) -> dict[str, Any]:
    """Stated properties of the material of a surface."""
    return config.get("materials", {}).get(config["surfaces"][surface].get("material"), {})


def hamaker_constants(material: dict) -> dict[str, float]:
    """Hamaker constant of two bodies of a material by medium [zJ]: as stated, or that of polysilicon."""
    polysilicon = {medium: from_si(constant, "zJ") for medium, constant in HAMAKER_CONSTANT.items()}
    return material.get("hamaker_constant_zJ", polysilicon)


def hamaker_constant(material: dict, medium: str) -> float:
    """That through a medium [zJ]; without van der Waals forces, where none acts, that through dry air.

    Examples
    --------
    >>> hamaker_constant({}, "water"), hamaker_constant({"hamaker_constant_zJ": {"water": 5, "dry": 65}}, "none")
    (97.5, 65)
    """
    constants = hamaker_constants(material)
    return constants.get(medium, constants["dry"])

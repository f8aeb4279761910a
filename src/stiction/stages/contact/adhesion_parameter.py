"""Adhesion parameter of a pair from the stated summits of its rougher surface. Not a stage."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from stiction.analysis.greenwood import GreenwoodWilliamson
from stiction.config.units import in_si, to_si
from stiction.contact.environment import Water, flooded_law
from stiction.contact.solids import composite_modulus
from stiction.models import SUMMIT_KEYS
from stiction.plan.stage import select
from stiction.stages.contact.pairs import Settings, bodies


def summits(plan: Any, pair: str) -> GreenwoodWilliamson | None:
    """Summits of a pair of independent surfaces, ``None`` if its rougher surface states none.

    ASSUME: summits are those of the rougher surface, with heights of the rms of both.
    """
    sides = [plan.config["surfaces"][name] for name in plan.sides(pair)]
    rougher = max(sides, key=lambda side: side.get("rms_nm", np.inf))
    if "replica" in plan.config["pairs"][pair] or not {"rms_nm", *SUMMIT_KEYS} <= rougher.keys():
        return None
    radius, density = (to_si(rougher[key], unit) for key, unit in zip(SUMMIT_KEYS, ("um", "per_um2"), strict=True))
    solids = bodies(in_si(Settings, select(Settings, plan.seen_by(pair))))
    rms = to_si(float(np.hypot(*(side["rms_nm"] for side in sides))), "nm")
    return GreenwoodWilliamson(density, radius, rms, composite_modulus(*solids))


def adhesion_parameters(plan: Any, air: Any, pair: str, humidities: Iterable[float]) -> dict[float, float]:
    """Adhesion parameters of a pair by humidity [-], empty without stated summits. ``air`` is one of the plan's."""
    if (model := summits(plan, pair)) is None:
        return {}
    return {rh: float(model.adhesion_parameter(_work(air, air.contact(pair, rh), rh))) for rh in humidities}


def _work(air, contact, humidity):
    """Work to separate flats in contact at a humidity [J m⁻²]."""
    water = in_si(Water, air.water(contact)).at(humidity)
    return flooded_law(humidity, water, to_si(air.hamaker_constant(contact), "zJ"))[0]

"""Less and more of a property of the solids in contact, or of how their surfaces follow each other: settings alone.

A body that is not of the material of the beam keeps its properties.
"""

from collections.abc import Callable
from typing import Any

from stiction.config.materials import hamaker_constants
from stiction.contact.materials import OF_CONTACT, OF_REPLICAS, InputStep
from stiction.models import SHIFTS, SIDES
from stiction.stages.contact import contact
from stiction.stages.contact.changes.patches import PatchChange
from stiction.stages.surfaces.rough_surfaces import sides_of


def less_or_more(settings: dict[str, Any], name: str, shift: str, step: InputStep) -> dict[str, Any]:
    """Settings of a contact with less or more of a property, a key of ``OF_PAIRS`` in ``contact.materials``."""
    return with_property(settings, name, lambda value: step.ends(value)[SHIFTS.index(shift)])


def with_property(settings: dict[str, Any], name: str, change: Callable[[float], float]) -> dict[str, Any]:
    """Settings of a contact with another replica, or value of a property of the beam's material in both bodies."""
    if name in OF_REPLICAS:
        key, replica = OF_REPLICAS[name].key, settings["replica"]
        return settings | {"replica": replica | {key: change(replica.get(key, 0.0))}}
    key, solid = OF_CONTACT[name].key, settings["solid"]
    if "materials" not in settings and key in solid:
        return settings | {"solid": _with_other(solid, name, change)}
    bodies = settings.get("materials", dict.fromkeys(SIDES, solid))
    of_beam = _with_other(bodies["beam"], name, change)
    changed = {body: of_beam if material == bodies["beam"] else material for body, material in bodies.items()}
    return settings | {"materials": changed}


def _with_other(material, name, change):
    """Material with another value of a property. Its Hamaker constants through all media change by the same factor."""
    key = OF_CONTACT[name].key
    value = (material | {"hamaker_constant_zJ": hamaker_constants(material)})[key]
    if isinstance(value, dict):
        return material | {key: {medium: change(constant) for medium, constant in value.items()}}
    return material | {key: change(value)}


def _changed(data, at, settings):
    """Contact under a change. ASSUME: surfaces have as much of a slightly larger coherence as is feasible."""
    return contact.compute(sides_of(data), at.pair, "NG", settings)


#: A property of the material of the beam, or of surfaces that follow each other.
SOLID = PatchChange(
    words="with {side} {solid_property}",
    end="_{side}",
    compute=_changed,
    settings=lambda plan, at, patch_kind: less_or_more(
        patch_kind.settings(plan, at, patch_kind.fewer(plan, at)),
        at.solid_property,
        at.side,
        plan.devices.step(at.pair, at.solid_property),
    ),
)
#: The solids of a variant of the model, on surfaces drawn for it.
VARIANT_OF_SOLIDS = PatchChange(
    words="under variant {variant}",
    end="_{variant}",
    settings=lambda plan, at, patch_kind: (
        patch_kind.settings(plan, at, patch_kind.fewer(plan, at)) | plan.variants.solids(at.pair, at.variant)
    ),
)

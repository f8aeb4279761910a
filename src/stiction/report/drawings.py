"""Drawings of devices with their own sizes, as SVG from templates."""

from collections.abc import Mapping
from typing import Any

from stiction.config.kinds import KEYS, KINDS, kind_of
from stiction.report import html

#: Template of a cantilever that its tip holds.
_BY_TIP = "tip.svg"
#: Files of all templates.
FILES = tuple(
    {file: None for name in (_BY_TIP, *(kind.drawing for kind in KINDS.values())) for file in html.files(name)}
)
#: Words of sizes that are not stated.
_WORDS = {
    "gap_um": "gap",
    "thickness_um": "thickness",
    "length_um": "length",
    "restoring_force_uN": "pulls up",
    "contact_um": "area in contact",
}


def device_drawing(section: Mapping[str, Any], by_tip: bool = False) -> str:
    """Draw a device with its own sizes, from its section of the configuration, perhaps stuck by its tip alone."""
    words = _WORDS | {key: _label(key, section[key]) for key in KEYS if key in section}
    return html.rendered(_BY_TIP if by_tip else kind_of(section).drawing, words=words)


def _label(key, value):
    """Size with its name and unit."""
    (name, unit), values = KEYS[key], value if isinstance(value, list) else [value]
    size = f"{' x '.join(f'{value:g}' for value in values)} {unit}"
    return f"{name} {size}" if key in ("thickness_um", "length_um") else size

"""Less and more of the radius of the edge of tips: other settings, and nothing else.

The same points of the surface are on wedge and edge as in the unchanged contact. ASSUME: the end of a rounder edge may
be missing, where only the highest summits touch.
"""

from typing import Any

from stiction.contact.tilt import EDGE_RADIUS
from stiction.models import SHIFTS
from stiction.stages.contact.changes.patches import Change


def _with_radius(plan: Any, at: Any, place: Any) -> dict[str, Any]:
    """Settings of a contact of tips with less or more of the radius of their edge."""
    settings = place.settings(plan, at, place.fewer(plan, at))
    radius = settings["tilt"]["radius_um"]
    changed = EDGE_RADIUS.step.ends(radius)[SHIFTS.index(at.side)]
    return settings | {"tilt": settings["tilt"] | {"radius_um": changed, "room_um": radius}}


#: The radius of a rounded edge.
EDGE = Change(words="with {side} round edges", end="_{side}", settings=_with_radius)

"""Tips with a sharper or a rounder edge: other settings, and nothing else.

The strips have room for the rounder one. The same points of their surfaces are on both, so that the difference is that
of the edges.
"""

import math
from typing import Any

from stiction.config.merging import merged
from stiction.config.units import NM_PER_UM
from stiction.contact.tilt import EDGE_RADIUS, length_of_edge
from stiction.models import SHIFTS
from stiction.stages.contact.changes.patches import PatchChange


def _with_radius(plan: Any, at: Any, patch_kind: Any) -> dict[str, Any]:
    """Settings of a contact of tips with less or more of the radius of their edge."""
    settings = patch_kind.settings(plan, at, patch_kind.fewer(plan, at))
    tilt, sampling = settings["tilt"], settings["sampling"]
    ends, reach = EDGE_RADIUS.step.ends(tilt["radius_um"]), tilt["reach_nm"] / NM_PER_UM
    now, room = (length_of_edge(radius, reach, tilt["slopes"][-1]) for radius in (tilt["radius_um"], ends[1]))
    point = sampling["spacing_nm"] * settings["contact"]["every"] / NM_PER_UM
    longer = round(sampling["strip_length_um"] + point * math.ceil((room - now) / point), 6)
    edge = {"radius_um": ends[SHIFTS.index(at.side)], "room_um": ends[1]}
    return merged(settings, {"sampling": {"strip_length_um": longer}, "tilt": edge})


#: The radius of a rounded edge.
EDGE = PatchChange(words="with {side} round edges", end="_{side}", settings=_with_radius)

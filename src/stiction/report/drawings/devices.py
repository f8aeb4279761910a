"""Drawings of devices and of their places of adhesion."""

from collections.abc import Callable, Mapping

import numpy as np

from stiction.config.kinds import KEYS
from stiction.report.drawings.canvas import (
    MARGIN,
    WIDTH,
    Drawing,
    area,
    arrow,
    line,
    measure,
    profile,
    shape,
    text,
)

#: Clamp, free end, and end of the open crack of a beam along the drawing; its thickness and its gap [px].
_CLAMP, _END, _CRACK, _THICK, _GAP = 84.0, 596.0, 396.0, 16.0, 88.0
_ALONG = np.linspace(0, 1, 60)
#: Height of a beam above the ground, in gaps, along an open crack and along a beam that its tip holds.
_S_SHAPE = 1 - 3 * _ALONG**2 + 2 * _ALONG**3
_ARC = 1 - (3 * _ALONG**2 - _ALONG**3) / 2
#: Beside what a label is.
_NONE: Mapping[str, str] = {}


def _ground(y: float) -> str:
    """Substrate, below a line."""
    return area([(MARGIN, y), (WIDTH - MARGIN, y), (WIDTH - MARGIN, y + 20), (MARGIN, y + 20)], "ground")


def _clamp(y: float, x: float, inwards: float) -> str:
    """Support of an end of a beam above a ground. The beam starts at ``x``."""
    top = y - _GAP - _THICK - 12
    return area([(x, top), (x - 44 * inwards, top), (x - 44 * inwards, y), (x, y)], "ground")


def _beam(x: np.ndarray, underside: np.ndarray, look: str = "solid") -> str:
    """Beam by its underside, with its thickness upwards."""
    below = list(zip(x, underside, strict=True))
    above = [(at, height - _THICK) for at, height in reversed(below)]
    return area(below + above, look)


def _sizes(y: float, words: Mapping[str, str]) -> list[str]:
    """Gap and thickness of a beam with a clamp on the left of the drawing."""
    top = y - _GAP - _THICK
    return [
        *measure((_CLAMP + 40, y - _GAP + 9), (_CLAMP + 40, y - 1), words.get("gap_um", "gap"), (10, 32)),
        arrow((_CLAMP + 14, top - 26), (_CLAMP + 14, top)),
        arrow((_CLAMP + 14, y - _GAP + 26), (_CLAMP + 14, y - _GAP)),
        text((_CLAMP + 24, top - 14), words.get("thickness_um", "thickness"), "quiet"),
    ]


def stuck_along(y: float, words: Mapping[str, str] = _NONE) -> list[str]:
    """Cantilever stuck along its underside, on a ground at ``y``."""
    return [
        _ground(y),
        _clamp(y, _CLAMP, 1),
        _beam(*(np.append(_CLAMP + _ALONG * (_CRACK - _CLAMP), _END), np.append(y - _GAP * _S_SHAPE, y))),
        *_sizes(y, words),
        *measure((_CLAMP, y + 40), (_CRACK, y + 40), "open crack"),
        *measure((_CRACK, y + 40), (_END, y + 40), "in contact"),
        *measure((_CLAMP, y + 86), (_END, y + 86), words.get("length_um", "length")),
    ]


def held_by_tip(y: float, words: Mapping[str, str] = _NONE) -> list[str]:
    """Cantilever stuck at its tip alone, with its sizes."""
    own = [*_sizes(y, words), *measure((_CLAMP, y + 86), (_END, y + 86), words.get("length_um", "length"))]
    return [*stuck_at_tip(y), *own]


def stuck_at_tip(y: float) -> list[str]:
    """Cantilever stuck at its tip alone, on a ground at ``y``."""
    return [
        _ground(y),
        _clamp(y, _CLAMP, 1),
        _beam(*(_CLAMP + _ALONG * (_END - _CLAMP), y - _GAP * _ARC)),
        arrow((_END - 2, y - 76), (_END - 2, y - _THICK - 6)),
        text((_END, y - 84), "only the tip touches", "quiet", "end"),
    ]


def held_by_middle(y: float, words: Mapping[str, str] = _NONE) -> list[str]:
    """Bridge stuck at its middle, on a ground at ``y``."""
    middle, half = WIDTH / 2, 12
    x = _CLAMP + _ALONG * (middle - half - _CLAMP)
    below = y - _GAP * _S_SHAPE
    return [
        _ground(y),
        _clamp(y, _CLAMP, 1),
        _clamp(y, WIDTH - _CLAMP, -1),
        _beam(np.append(x, WIDTH - x[::-1]), np.append(below, below[::-1])),
        *_sizes(y, words),
        *measure((_CLAMP, y + 40), (middle - half, y + 40), "crack"),
        *measure((middle + half, y + 40), (WIDTH - _CLAMP, y + 40), "crack"),
        text((middle, y + 64), "held", "quiet", "middle"),
        *measure((_CLAMP, y + 86), (WIDTH - _CLAMP, y + 86), words.get("length_um", "length")),
    ]


def held_by_area(y: float, words: Mapping[str, str] = _NONE) -> list[str]:
    """Stopper stuck with its whole area against a spring, on a ground at ``y``."""
    left, right, top = 240.0, 400.0, y - 122
    spring = [(WIDTH / 2 + 14 * (-1) ** k * (0 < k < 9), top - 62 + 62 * k / 9) for k in range(10)]
    return [
        _ground(y),
        line([(left - 40, top - 62), (right + 40, top - 62)]),
        line(spring),
        area([(left - 52, top), (right + 52, top), (right + 52, y - 44), (right, y - 44), (right, y), (left, y),
              (left, y - 44), (left - 52, y - 44)], "solid"),
        text((WIDTH / 2, y - 68), "stopper", anchor="middle"),
        arrow((right + 84, y - 40), (right + 84, top - 40), "pull", 14),
        text((right + 98, top + 6), "spring", "warn"),
        text((right + 98, top + 30), words.get("restoring_force_uN", "pulls up"), "quiet"),
        arrow((left - 84, top - 40), (left - 84, y - 40), "pull", 14),
        text((left - 98, top + 6), "contact", "warn", "end"),
        text((left - 98, top + 30), "pulls down", "quiet", "end"),
        *measure((left, y + 40), (right, y + 40), words.get("contact_um", "area in contact")),
    ]  # fmt: skip


def _strip(top: float, bottom: float) -> list[str]:
    """Strip of the contact: rough surfaces, touching summits, and water in narrow gaps."""
    x = np.linspace(MARGIN, WIDTH - MARGIN, 600)
    lower = bottom - 0.34 * (bottom - top) + profile(x, 2, 2.0)
    gap = lower - profile(x, 17, 2.6)
    gap = np.maximum(gap - np.quantile(gap, 0.04), 0)  # summits are flattened where they touch
    upper = lower - gap
    water = [area([*_along(x, upper, part), *_along(x, lower, part)[::-1]], "water") for part in _runs(gap < 15)]
    (first, *_), (*_, last) = _runs(gap == 0)[0], _runs(gap < 15)[-1]
    return [
        area([(x[0], top), *zip(x, upper, strict=True), (x[-1], top)], "solid"),
        area([(x[0], bottom), *zip(x, lower, strict=True), (x[-1], bottom)], "ground"),
        *water,
        text((MARGIN + 10, top + 36), "asperity in contact"),
        arrow((x[first], top + 46), (x[first], upper[first] - 4), "line"),
        text((WIDTH - MARGIN - 10, bottom - 12), "meniscus of condensed water", anchor="end"),
        arrow((x[last] - 6, bottom - 32), (x[last] - 6, lower[last] + 4), "line"),
    ]


def _along(x, heights, part):
    """Points of a part of a line."""
    return list(zip(x[part], heights[part], strict=True))


def _runs(true: np.ndarray) -> list[np.ndarray]:
    """Numbers of the points of every part of a line with a true value."""
    points = np.flatnonzero(true)
    return np.split(points, np.flatnonzero(np.diff(points) > 1) + 1)


def beam() -> Drawing:
    """Draw a cantilever stuck along its underside, a strip of its contact, and a cantilever stuck at its tip."""
    spot = (540.0, 196.0)
    return Drawing(
        "beam",
        "How a beam sticks to its ground",
        "Three parts. First, a beam clamped on the left bends down over a gap. Behind an open crack it lies flat on "
        "the ground (S-shape). Second, a strip of this contact, magnified: summits of the rough underside touch the "
        "ground, and condensed water fills the narrow gaps around them. Third, a beam of which only the tip touches "
        "(arc).",
        870,
        [
            text((MARGIN, 42), "Stuck along its underside (S-shape)", "title"),
            *stuck_along(206),
            shape("circle", "line", cx=spot[0], cy=spot[1] + 10, r=16),
            text((spot[0], spot[1] - 24), "A", "title", "middle"),
            text((MARGIN, 358), "A: a strip of this contact, magnified", "title"),
            *_strip(376, 566),
            *measure((MARGIN, 588), (WIDTH - MARGIN, 588), "strip, about a micrometre"),
            text((MARGIN, 668), "Held by its tip alone (arc)", "title"),
            *stuck_at_tip(832),
        ],
    )


def stopper_and_bridge() -> Drawing:
    """Draw a bridge stuck at its middle, and a stopper stuck with its area."""
    return Drawing(
        "stopper_and_bridge",
        "How a bridge and a stopper stick",
        "Two parts. First, a beam clamped at both ends bends down to the ground, where a short part of its middle "
        "holds it between two open cracks. Second, a stopper below a spring touches the ground with its whole area: "
        "the contact pulls it down, the spring pulls it up.",
        680,
        [
            text((MARGIN, 42), "A bridge, held by its middle", "title"),
            *held_by_middle(206),
            text((MARGIN, 368), "A stopper, held by its whole area", "title"),
            *held_by_area(590),
        ],
    )


#: What draws the devices of a kind: parts for a ground at a place, its height, and a text alternative.
_OF_KINDS: Mapping[str, tuple[Callable[..., list[str]], float, str]] = {
    "cantilever": (
        stuck_along,
        154,
        "A beam clamped on the left bends down over a gap. Behind an open crack it lies flat on the ground.",
    ),
    "bridge": (
        held_by_middle,
        154,
        "A beam clamped at both ends bends down to the ground, where its middle holds it between two open cracks.",
    ),
    "stopper": (
        held_by_area,
        212,
        "A stopper below a spring touches the ground with its whole area: the contact pulls it down, the spring up.",
    ),
}


#: The same for a cantilever that its tip holds.
_BY_TIP = held_by_tip, 166, "A beam clamped on the left bends down over a gap. Only its free end touches the ground."


def device_drawing(section: Mapping, by_tip: bool = False) -> Drawing:
    """Draw a device with its own sizes, from its section of the configuration, perhaps stuck by its tip alone."""
    parts, y, description = _BY_TIP if by_tip else _OF_KINDS[section["kind"]]
    words = {key: _label(key, section[key]) for key in KEYS if key in section}
    return Drawing(section["kind"], "The device, stuck", description, y + 124, parts(y, words))


def _label(key, value):
    """Size with its name and unit."""
    (name, unit), values = KEYS[key], value if isinstance(value, list) else [value]
    size = f"{' x '.join(f'{value:g}' for value in values)} {unit}"
    return f"{name} {size}" if key in ("thickness_um", "length_um") else size

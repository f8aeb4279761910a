"""Drawing as SVG: shapes and texts, a style for light and dark, and a text alternative.

The text of an SVG is written directly. Matplotlib would draw every letter as a path, which no screen reader reads, and
with one fixed set of colours.

Lengths are in pixels of a drawing that is 640 wide, with y downwards. On a phone of 390 pixels a text of 20 is still 12
high.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from string import Template

import numpy as np

#: Width of every drawing, its margin, and the size of its texts [px].
WIDTH, MARGIN, TEXT = 640, 24, 20
#: Colours by what they show, in light and in dark.
LIGHT = {
    "paper": "#ffffff",
    "ink": "#1f2328",
    "quiet": "#57606a",
    "body": "#b6cbe0",
    "ground": "#dcd5c8",
    "water": "#4aa8e0",
    "mark": "#0b5cad",
    "warn": "#a63f00",
}
DARK = {
    "paper": "#14181d",
    "ink": "#e8edf2",
    "quiet": "#a5b0bb",
    "body": "#3c5a78",
    "ground": "#4c463d",
    "water": "#2f8fca",
    "mark": "#7cc0ff",
    "warn": "#ffa066",
}
#: Looks of shapes and texts. Colours are written out, because not every viewer of SVG knows variables of CSS.
_LOOKS = Template("""
.drawing rect.paper { fill: $paper }
.drawing .solid { fill: $body; stroke: $ink; stroke-width: 2; stroke-linejoin: round }
.drawing .ground { fill: $ground; stroke: $ink; stroke-width: 2; stroke-linejoin: round }
.drawing .water { fill: $water }
.drawing .line { fill: none; stroke: $ink; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round }
.drawing .ghost { fill: none; stroke: $quiet; stroke-width: 2; stroke-dasharray: 7 6 }
.drawing .curve { fill: none; stroke: $mark; stroke-width: 3; stroke-linejoin: round; stroke-linecap: round }
.drawing .faint { fill: none; stroke: $mark; stroke-width: 2; opacity: .55 }
.drawing .bar { fill: $mark }
.drawing .measure { fill: none; stroke: $quiet; stroke-width: 1.5 }
.drawing .head { fill: $quiet }
.drawing .ink-head { fill: $ink }
.drawing .pull { fill: none; stroke: $warn; stroke-width: 3 }
.drawing .pull-head { fill: $warn }
.drawing text { font: ${size}px system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif }
.drawing text { fill: $ink }
.drawing text.title { font-weight: 600 }
.drawing text.quiet { fill: $quiet }
.drawing text.mark { fill: $mark; font-weight: 600 }
.drawing text.warn { fill: $warn; font-weight: 600 }
""")

#: A point, or a displacement.
Point = tuple[float, float]


@dataclass(frozen=True)
class Drawing:
    """Drawing with its text alternative."""

    name: str  #: of its file
    title: str
    description: str  #: what it shows, for readers who do not see it
    height: float
    parts: Sequence[str]

    @property
    def svg(self) -> str:
        """Drawing as SVG, for a file or a part of a page."""
        inside = [
            f"<title>{escape(self.title)}</title>",
            f"<desc>{escape(self.description)}</desc>",
            f"<style>{_style()}</style>",
            shape("rect", "paper", width=WIDTH, height=self.height, rx=8),
            *self.parts,
        ]
        size = f'viewBox="0 0 {WIDTH} {_text(self.height)}" width="{WIDTH}" height="{_text(self.height)}"'
        opened = f'<svg xmlns="http://www.w3.org/2000/svg" class="drawing" role="img" {size}>'
        return "\n".join([opened, *inside, "</svg>", ""])


def _style():
    """Looks in light and in dark."""
    light, dark = (_LOOKS.substitute(colours, size=TEXT) for colours in (LIGHT, DARK))
    return f"{light}@media (prefers-color-scheme: dark) {{{dark}}}\n"


def _text(number: float) -> str:
    """Coordinate to a tenth of a pixel."""
    return f"{number:.1f}".removesuffix(".0")


def _points(points: Iterable[Point]) -> str:
    return " ".join(f"{_text(x)},{_text(y)}" for x, y in points)


def shape(tag: str, look: str, **attributes: float) -> str:
    """Element of SVG with numbers as attributes."""
    stated = " ".join(f'{name}="{_text(value)}"' for name, value in attributes.items())
    return f'<{tag} class="{look}" {stated}/>'


def line(points: Iterable[Point], look: str = "line") -> str:
    """Lines from point to point."""
    return f'<polyline class="{look}" points="{_points(points)}"/>'


def area(points: Iterable[Point], look: str) -> str:
    """Area within points."""
    return f'<polygon class="{look}" points="{_points(points)}"/>'


def text(place: Point, words: str, look: str = "", anchor: str = "start") -> str:
    """Words on a base line. The anchor says if the place is their start, middle or end."""
    x, y = map(_text, place)
    return f'<text class="{look}" x="{x}" y="{y}" text-anchor="{anchor}">{escape(words)}</text>'


def arrow(start: Point, end: Point, look: str = "measure", size: float = 9) -> str:
    """Arrow from one point to another."""
    tip, back = np.array(end), np.array(start) - np.array(end)
    along = size * back / np.hypot(*back)
    across = np.array([-along[1], along[0]]) / 2.4
    head = {"pull": "pull-head", "line": "ink-head"}.get(look, "head")
    return line([start, tuple(tip + along)], look) + area(
        [end, tuple(tip + along + across), tuple(tip + along - across)], head
    )


def measure(start: Point, end: Point, words: str, beside: Point = (0, 24)) -> list[str]:
    """Distance of two points with its name, ``beside`` its middle: above or below, or to the right."""
    middle = tuple((np.array(start) + np.array(end)) / 2)
    anchor = "start" if beside[0] > 0 else "middle"
    said = text((middle[0] + beside[0], middle[1] + beside[1]), words, "quiet", anchor)
    return [arrow(middle, start), arrow(middle, end), said]


def profile(x: np.ndarray, rms: float, start: float = 0.0) -> np.ndarray:
    """Heights of a rough line: a sum of waves without a common multiple of their lengths."""
    lengths = np.array([173.0, 109.0, 67.0, 43.0])
    waves = np.sin(2 * np.pi * x[:, None] / lengths + start * np.arange(1, 5)) * lengths
    return rms * waves.sum(axis=1) / np.sqrt((lengths**2).sum() / 2)

"""Drawings are complete SVG with a text alternative, legible in light and dark, and their texts lie apart."""

import re
import xml.etree.ElementTree as ET
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from hostile import HOSTILE
from matplotlib.path import Path as Outline

from stiction.config.kinds import KINDS
from stiction.report import html
from stiction.report.drawings import FILES, device_drawing

SVG = "{http://www.w3.org/2000/svg}"
#: Width of every drawing, its margin, and the size of its texts [px].
WIDTH, MARGIN, TEXT = 640, 24, 20
PICTURES = Path(__file__).parents[2] / "docs" / "pictures"
SECTIONS = {
    "cantilever": {"thickness_um": 2.6, "gap_um": 20, "width_um": 30, "length_um": 1234.5},
    "bridge": {"thickness_um": 2, "gap_um": 0.12, "width_um": 30, "residual_stress_MPa": 50},
    "stopper": {"contact_um": [3, 12.5], "restoring_force_uN": 18.99},
    "probe": {"radius_um": 12.5, "restoring_force_uN": 0.0899},
}
DRAWINGS = {name: (PICTURES / f"{name}.svg").read_text("utf-8") for name in ("beam", "stopper_and_bridge", "method")}
DRAWINGS |= {kind: device_drawing({"kind": kind} | section) for kind, section in SECTIONS.items()}
DRAWINGS["tip"] = device_drawing({"kind": "cantilever"} | SECTIONS["cantilever"], by_tip=True)
each_drawing = pytest.mark.parametrize("drawing", DRAWINGS.values(), ids=list(DRAWINGS))


def colours_of(drawing):
    """Colours of all shapes and texts by their class: in light and in dark."""
    style = ET.fromstring(drawing).find(f"{SVG}style").text
    assert "var(" not in style, "librsvg would draw it black"
    parts = style.split("@media (prefers-color-scheme: dark)")
    return [dict(re.findall(r"\.drawing \.?(\S+) { [^}]*?(#[0-9a-f]{6})", part)) for part in parts]


def height(drawing):
    """Height of a drawing [px]."""
    return float(ET.fromstring(drawing).get("height"))


def texts(drawing):
    """Words of a drawing, with the box that a wide font fills: 0.62 of the size for each letter."""
    for element in ET.fromstring(drawing).iter(f"{SVG}text"):
        width = 0.62 * TEXT * len(element.text)
        start = float(element.get("x")) - width * {"start": 0, "middle": 0.5, "end": 1}[element.get("text-anchor")]
        line = float(element.get("y"))
        yield element.text, (start, line - 0.8 * TEXT, start + width, line + 0.2 * TEXT)


@each_drawing
def test_a_drawing_has_a_text_alternative_and_needs_nothing_else(drawing):
    root = ET.fromstring(drawing)
    assert root.get("role") == "img"
    assert root.find(f"{SVG}title").text
    assert len(root.find(f"{SVG}desc").text) > 60
    assert {element.tag.removeprefix(SVG) for element in root.iter()} <= {
        *("svg", "title", "desc", "style", "rect", "circle", "polyline", "polygon", "text")
    }
    assert "url(" not in drawing
    assert "href" not in drawing


@each_drawing
def test_texts_lie_within_the_drawing_and_apart(drawing):
    boxes = list(texts(drawing))
    for words, (left, top, right, bottom) in boxes:
        assert MARGIN / 2 <= left < right <= WIDTH - MARGIN / 2, words
        assert 0 <= top < bottom <= height(drawing), words
    for (words, one), (others, other) in combinations(boxes, 2):
        apart = one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]
        assert apart, f"{words} / {others}"


def test_texts_that_meet_are_found():
    drawing = device_drawing({"kind": "stopper", "contact_um": [3, 12.5]}).replace(">spring<", ">spring that is long<")
    with pytest.raises(AssertionError):
        test_texts_lie_within_the_drawing_and_apart(drawing)


@each_drawing
def test_texts_lie_within_a_body_or_outside(drawing):
    bodies = [element.get("points").split() for element in ET.fromstring(drawing).iter(f"{SVG}polygon")]
    outlines = [Outline([list(map(float, point.split(","))) for point in points]) for points in bodies]
    for words, (left, top, right, bottom) in texts(drawing):
        box = np.stack(np.meshgrid(np.linspace(left, right, 20), np.linspace(top, bottom, 5)), axis=-1).reshape(-1, 2)
        for outline in outlines:
            assert len(set(outline.contains_points(box))) == 1, words


@each_drawing
def test_points_lie_within_the_drawing(drawing):
    for element in ET.fromstring(drawing).iter():
        for point in element.get("points", "").split():
            x, y = map(float, point.split(","))
            assert 0 <= x <= WIDTH
            assert 0 <= y <= height(drawing)


@each_drawing
def test_every_shape_has_its_own_colour_in_light_and_dark(drawing):
    shapes = {element.get("class") for element in ET.fromstring(drawing).iter() if element.tag != f"{SVG}text"}
    light, dark = ({name.rpartition(".")[2]: colour for name, colour in of.items()} for of in colours_of(drawing))
    assert (shapes - {None, "drawing"}) | {"text"} <= light.keys() == dark.keys()
    assert not set(light.values()) & set(dark.values())


def luminance(colour):
    """Relative luminance of a colour such as ``#1f2328``, as WCAG defines it."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(factor * part for factor, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    low, high = sorted(map(luminance, (one, other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("colours", colours_of(DRAWINGS["beam"]), ids=["light", "dark"])
def test_texts_contrast_with_what_is_behind_them(colours):
    for words in ("text", "text.quiet", "text.mark", "text.warn"):
        assert contrast(colours[words], colours["rect.paper"]) >= 4.5, words
    for behind in ("solid", "ground"):
        assert contrast(colours["text"], colours[behind]) >= 4.5, behind
    assert contrast("#777777", "#ffffff") < 4.5, "the law can fail"


def test_every_kind_of_device_has_a_drawing_with_its_own_sizes():
    assert SECTIONS.keys() == KINDS.keys()
    said = {kind: " ".join(words for words, _ in texts(DRAWINGS[kind])) for kind in SECTIONS}
    assert "thickness 2.6 µm" in said["cantilever"]
    assert "length 1234.5 µm" in said["cantilever"]
    assert "0.12 µm" in said["bridge"]
    assert "3 x 12.5 µm" in said["stopper"]
    assert "18.99 µN" in said["stopper"]
    assert "radius 12.5 µm" in said["probe"]
    assert "0.0899 µN" in said["probe"]


def test_words_are_shown_as_their_characters():
    drawing = html.rendered("bridge.svg", words=dict.fromkeys(("gap_um", "thickness_um", "length_um"), HOSTILE))
    assert [words for words, _ in texts(drawing)].count(HOSTILE) == 3


def test_a_change_of_any_template_draws_again():
    assert {Path(file).name for file in FILES} == {f"{name}.svg" for name in ("drawing", "tip", *KINDS)}

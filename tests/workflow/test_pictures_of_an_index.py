"""Pictures on the index of a run are whole, however tall or wide they are."""

import numpy as np
import pytest
from browser import missing
from PIL import Image

from stiction.report import html

pytestmark = [
    pytest.mark.slow,
    pytest.mark.browser,
    pytest.mark.skipif(bool(missing()), reason=missing()),
]

SHAPES = {"tall": (2000, 300), "square": (400, 400), "wide": (300, 2000)}
#: Whether each picture is whole: its box has its shape, or leaves room for it.
WHOLE = """
return [...document.querySelectorAll('.pictures img')].map(one => {
  const box = one.getBoundingClientRect(), shape = one.naturalWidth / one.naturalHeight;
  const same = Math.abs(box.width / box.height / shape - 1) < 0.02;
  return one.naturalWidth > 0 && (same || getComputedStyle(one).objectFit === 'contain');
});
"""


def index(folder):
    """Index with a picture of each shape."""
    for name, shape in SHAPES.items():
        Image.fromarray(np.zeros((*shape, 3), np.uint8)).save(folder / f"{name}.png")
    drawn = [{"shown": f"{name}.png", "title": name, "files": {}} for name in SHAPES]
    nothing = dict.fromkeys(("devices", "pairs", "surfaces", "tables", "checks", "warnings", "provenance"), ())
    texts = dict.fromkeys(("title", "made", "verdict", "changes"), "")
    figures = {"Devices": drawn}
    return html.rendered("index.html", **nothing, **texts, figures=figures, length=1, models={}, judged=True)


@pytest.mark.parametrize("width", [1440, 390])
def test_a_picture_is_not_cut(browser, tmp_path, width):
    page = index(tmp_path).replace('loading="lazy"', "")
    for style, is_whole in ((page, True), (page.replace("object-fit: contain", "object-fit: cover"), False)):
        (tmp_path / "index.html").write_text(style, encoding="utf-8")
        browser.open(tmp_path / "index.html")
        browser.resize(width)
        found = dict(zip(SHAPES, browser.run(WHOLE), strict=True))
        assert found["tall"] == is_whole, "the control is cut"
        assert found["wide"]

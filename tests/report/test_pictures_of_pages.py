"""Pictures of a page: each panel, and each legend, in a file of its own, with few levels of each colour."""

import io

import numpy as np
import pytest
from PIL import Image

from stiction.report.style import columns_of_panels, legend_outside, on_a_page, picture, strips, styled

RNG = np.random.default_rng(11)


def decoded(content):
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"), int)


@pytest.mark.parametrize("colours", [2, 100, 5000])
def test_no_colour_of_a_picture_changes_by_more_than_half_a_level(colours):
    drawn = RNG.integers(0, 256, (colours, 3), dtype=np.uint8)[RNG.integers(0, colours, (80, 90))]
    drawn[:2] = 0
    drawn[2:4] = 255
    shown = decoded(picture(drawn))
    assert np.abs(shown - drawn).max() <= 255 / 7 / 2 + 0.5
    assert (shown[:2] == 0).all()
    assert (shown[2:4] == 255).all()


def test_colours_of_areas_and_lines_stay():
    drawn = np.full((100, 100, 3), 255, np.uint8)
    drawn[10:40] = 211, 231, 230
    drawn[50, :20] = 0, 114, 178
    drawn[70, 3] = 100, 100, 100
    shown = decoded(picture(drawn))
    assert (shown[:60] == drawn[:60]).all()
    assert (shown[70, 3] == 109).all(), "a single pixel has the nearest level"


@styled
@on_a_page()
def figure_of(panels, place):
    figure, columns, _ = columns_of_panels(panels, 1, lambda across: across, 2.0)
    for panel in columns[:, 0]:
        panel.plot([0, 1], [0, 1], color="black")
    lines = columns[0, 0].plot([], [], color="#ff0000", linewidth=6)
    legend_outside(figure, (lines, ["all"]), place, 1)
    return figure


@pytest.mark.parametrize(("place", "owner"), [("upper", 0), ("lower", -1)])
def test_a_legend_is_a_picture_of_its_own_so_that_panels_side_by_side_are_aligned(place, owner):
    parts = strips(figure_of(3, place))
    pictures = [decoded(part.content) for part in parts]
    has_legend = [bool(((picture[..., 0] > 250) & (picture[..., 1] < 5)).any()) for picture in pictures]
    assert len(parts) == 4
    assert has_legend == [part.is_legend for part in parts], "not on a panel"
    assert has_legend.index(True) == range(4)[owner]
    heights = {len(picture) for picture, part in zip(pictures, parts, strict=True) if not part.is_legend}
    (of_legend,) = (len(picture) for picture, part in zip(pictures, parts, strict=True) if part.is_legend)
    assert max(heights) - min(heights) < of_legend / 5, "of equal panels"

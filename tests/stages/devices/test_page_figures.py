"""Figures of pages: one picture for each panel, with text that a phone shows at a size to read, and nothing cut."""

import io

import numpy as np
import pytest
from answers import BEAMS, BUDGETS, STOPPERS, safe
from charted import charted
from drawn_curves import etched, law_of, mapped, rough
from matplotlib.image import imread
from matplotlib.text import Text
from test_stage_life import OF

from stiction.report.axes import figures as of_axes
from stiction.report.budget import figures as of_budgets
from stiction.report.devices import figures as of_devices
from stiction.report.devices import life
from stiction.report.style import PAGE, on_a_page, panels, strips, styled
from stiction.stages.life.answers import layout
from stiction.stages.life.beams import beam_answers

pytestmark = pytest.mark.slow

#: Width of a phone without its margins, and least height of text there [pixels].
PHONE, LEAST = 358, 11
FIGURES = {
    "risk": (1, lambda: of_devices.simulated({("C1", rh): safe() for rh in (0.44, 0.67, 0.92)}, {})),
    "chart": (4, lambda: of_devices.chart({("C1", rh): charted(rh) for rh in (0.4, 0.5, 0.6)}, {})),
    "stoppers": (2, lambda: of_budgets.stoppers({"S1": STOPPERS["S1"]}, {})),
    "budget": (4, lambda: of_budgets.budget(BEAMS | {key: one for key, one in BUDGETS.items() if "tip" in key})),
    "life": (1, lambda: life.figure({"C1": layout(beam_answers({0.67: safe()}, {}, OF), OF)}, {"C1": 1e-4})),
    "roughness": (1, lambda: of_axes.roughness(rough())),
    "map": (2, lambda: of_axes.roughness_map(rough(others=(0.0, -0.5, 0.5)))),
    "process": (1, lambda: of_axes.devices(*etched(), "D")),
    "process map": (1, lambda: of_axes.process_map(*mapped())),
    "law": (1, lambda: of_axes.laws(law_of())),
}


@pytest.mark.parametrize("name", FIGURES)
def test_a_page_has_a_picture_of_every_panel_readable_on_a_phone_and_not_cut(name):
    count, draw = FIGURES[name]
    with on_a_page():
        figure = draw()
    pictures = [imread(io.BytesIO(strip))[..., :3] for strip in strips(figure)]
    assert len(pictures) == count, "a legend belongs to its panel"
    assert {picture.shape[1] for picture in pictures} == {round(PAGE * figure.dpi)}
    for picture in pictures:
        assert (picture[:, [0, -1]] == 1).all(), "nothing reaches beyond the sides"
    shown = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    assert min(text.get_fontsize() for text in shown) / 72 * PHONE / PAGE >= LEAST


@styled
def drawn(title):
    """Figure of four panels with a title and a label."""
    figure, axes = panels(2, 2, (7, 4))
    for panel in axes.flat:
        panel.set(title=title, xlabel=title)
    return figure


def test_what_is_too_long_for_a_panel_is_broken_on_a_page_and_other_figures_stay():
    figure = drawn("long")
    assert len({panel.get_position().x0 for panel in figure.axes}) == 2
    with on_a_page():
        short, broken = drawn("short"), drawn("a title that is longer than any page of this width has room for " * 2)
    heights = [[imread(io.BytesIO(strip)).shape[0] for strip in strips(one)] for one in (short, broken)]
    assert [len(one) for one in heights] == [4, 4]
    assert np.all(imread(io.BytesIO(strips(broken)[0]))[:, [0, -1]] == 1)
    assert len({panel.get_position().x0 for panel in short.axes}) == 1

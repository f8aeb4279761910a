"""Figures of pages: one picture for each panel, with text that a phone shows at a size to read, and nothing cut."""

import io

import numpy as np
import pytest
from answers import BEAMS, BUDGETS, STOPPERS, safe
from charted import charted
from drawn_curves import etched, law_of, mapped, rough
from lives import OF
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from stiction.answer.data import Answer, Between, Unasked
from stiction.answer.sought import FORCE, LENGTH
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


def to_build(size, **stricter):
    """Answer about a cantilever with a size to build [m]."""
    return Answer("C1", "cantilever", 1e-3, "m", size, size, (), (), **stricter)


FIGURES = {
    "risk": (2, lambda: of_devices.simulated({("C1", rh): safe() for rh in (0.44, 0.67, 0.92)}, {})),
    "chart": (4, lambda: of_devices.chart({("C1", rh): charted(rh) for rh in (0.4, 0.5, 0.6)}, {})),
    "stoppers": (2, lambda: of_budgets.stoppers({"S1": STOPPERS["S1"]}, {})),
    "budget": (4, lambda: of_budgets.budget(BEAMS | {key: one for key, one in BUDGETS.items() if "tip" in key})),
    "life": (1, lambda: life.figure({"C1": layout(beam_answers({0.67: safe()}, {}, OF), OF)}, {"C1": to_build(1e-4)})),
    "roughness": (1, lambda: of_axes.roughness(rough())),
    "map": (2, lambda: of_axes.roughness_map(rough(others=(0.0, -0.5, 0.5)))),
    "process": (1, lambda: of_axes.devices(*etched(), "D")),
    "process map": (1, lambda: of_axes.process_map(*mapped())),
    "law": (1, lambda: of_axes.laws(law_of())),
}


def decoded(content):
    """Pixels of a picture, (rows, columns, 3)."""
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"))


@pytest.mark.parametrize("name", FIGURES)
def test_a_page_has_a_picture_of_every_panel_readable_on_a_phone_and_not_cut(name):
    count, draw = FIGURES[name]
    with on_a_page():
        figure = draw()
    drawn_strips = strips(figure)
    pictures = [decoded(strip.content) for strip in drawn_strips]
    assert sum(not strip.is_legend for strip in drawn_strips) == count, "a legend has a line of its own"
    assert {picture.shape[1] for picture in pictures} == {round(PAGE * figure.dpi)}
    for picture in pictures:
        assert (picture[:, [0, -1]] == 255).all(), "nothing reaches beyond the sides"
    shown = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    assert min(text.get_fontsize() for text in shown) / 72 * PHONE / PAGE >= LEAST


@pytest.mark.parametrize(("build", "short"), [(1e-6, False), (1e-2, True)])
def test_the_legend_of_a_life_names_what_is_drawn_alone(build, short):
    answers = layout(beam_answers({0.67: safe()}, {}, OF), OF, length=250e-6)
    figure = life.figure({"C1": answers}, {"C1": to_build(build)})
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert not any("hold" in name for name in names), "no row of a beam that is a length is about what holds it"
    assert "with all that is stated inside" not in names, "nothing stricter is known"
    assert "stick: whether it then sticks" in names, "a limit that is too short keeps the colour of its question"
    red = [text for panel in figure.axes for text in panel.texts if text.get_color() == life._SHORT]
    assert bool(red) == short


@pytest.mark.parametrize("size", [80e-6, 90e-6])
def test_a_limit_with_errors_has_a_mark_at_its_size_and_is_the_first_number_of_its_row(size):
    answers = layout(beam_answers({0.67: safe()}, {}, OF), OF, length=250e-6)
    row = next(answer for answer in life.answers_of(answers) if answer.unit == "m")
    answer = to_build(100e-6, unasked=(Unasked(row.name, row.what, size),))
    figure = life.figure({"C1": answers}, {"C1": answer})
    panel = figure.axes[0]
    assert [line.get_xdata()[0] for line in panel.lines if line.get_marker() == "D"] == pytest.approx([1e6 * size])
    assert sum(text.get_text().startswith(f"{1e6 * size:.0f}\nexact: ") for text in panel.texts) == 1
    title = " ".join(panel.get_title(loc="left").split())
    assert title == f"C1: build 100 µm, but {1e6 * size:.0f} µm if water dries on it"
    assert "with all that is stated inside" in [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.mark.parametrize(("sought", "allowed"), [(LENGTH, 90.0), (FORCE, 110.0)])
def test_sizes_that_the_strictest_row_does_not_allow_are_shaded(sought, allowed):
    panel = Figure().add_subplot(xlim=(50.0, 150.0))
    build = 100.0 + (100.0 - allowed) / 2
    life._shade(panel, sought, [sought.scale * size for size in (100.0, build)])
    for patch, end in zip(panel.patches, (100.0, build), strict=True):
        low, high = patch.get_x(), patch.get_x() + patch.get_width()
        assert low < 200.0 - allowed < high
        assert not low < allowed < high, "control: the safe side"
        assert end in (pytest.approx(low), pytest.approx(high))
    ends = panel.get_xlim()
    assert ends[0] <= low < high <= ends[1]
    assert (ends[0] < low) != (ends[1] > high), "room on the safe side alone"


@pytest.mark.parametrize(("size", "said"), [(90e-6, ["90"]), (100.2e-6, [])])
def test_a_life_has_a_stricter_size_between_airs_in_red_unless_it_reads_as_the_size_to_build(size, said):
    answers = layout(beam_answers({0.67: safe()}, {}, OF), OF, length=250e-6)
    figure = life.figure({"C1": answers}, {"C1": to_build(100e-6, between=Between(0.83, size, size))})
    red = [text.get_text() for text in figure.axes[0].texts if text.get_color() == life._SHORT]
    rows = [label.get_text().replace("\n", " ") for label in figure.axes[0].get_yticklabels()]
    assert red == said
    assert ("length to build at RH 0.83, between stated airs, interpolated" in rows) == bool(said)


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
    heights = [[len(decoded(strip.content)) for strip in strips(one)] for one in (short, broken)]
    assert [len(one) for one in heights] == [4, 4]
    assert np.all(decoded(strips(broken)[0].content)[:, [0, -1]] == 255)
    assert len({panel.get_position().x0 for panel in short.axes}) == 1

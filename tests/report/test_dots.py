"""Rows of a dot plot are apart, whatever their labels, the title and the legend of their figure are."""

from itertools import pairwise

import pytest

from stiction.report import dots
from stiction.report.style import legend_outside, panels, save, styled

NUMBERS = {"a": "3", "b\nb": "1 to 2\nexact: 1", "c\nc\nc\nc\nc": "4", "d": "5\n6\n7", "e\ne\ne": "8"}


@styled
def drawn(devices, *, rows_of=lambda k: NUMBERS, title="", entries=1, height=1.5):
    """Figure of one panel for each device, each of a height with its surroundings, before its rows are apart."""
    figure, axes = panels(devices, 1, (4.0, height * devices))
    for k, panel in enumerate(axes[:, 0]):
        rows = {label: [dots.Mark(1, 2, "black", text)] for label, text in rows_of(k).items()}
        dots.draw(panel, rows, column="")
        panel.set_title(title, loc="left")
    handles = [axes[0, 0].plot([], [])[0] for _ in range(entries)]
    legend_outside(figure, (handles, [f"entry {k}" for k in range(entries)]), "lower", 1)
    return figure, axes[:, 0]


def distances(figure):
    """Distances of the texts of neighbouring rows of all panels [in]."""
    save(figure)  # lays it out
    for panel in figure.axes:
        labels = [label for label in panel.get_yticklabels() if label.get_text()]
        numbers = [text for text in panel.texts if text.get_text()]
        for column in (labels, numbers):
            boxes = sorted((text.get_window_extent() for text in column), key=lambda box: -box.y0)
            yield from ((upper.y0 - lower.y1) / figure.dpi for upper, lower in pairwise(boxes))


@pytest.mark.parametrize("devices", [1, 3])
@pytest.mark.parametrize(("title", "entries", "height"), [("", 1, 1.5), ("one\ntwo\nthree\nfour\nfive", 12, 3.0)])
def test_rows_are_apart_whatever_the_lines_of_labels_title_and_legend(devices, title, entries, height):
    figure, axes = drawn(devices, title=title, entries=entries, height=height)
    before, _ = drawn(devices, title=title, entries=entries, height=height)
    assert min(distances(before)) < 0, "a control: without, they overlap"
    dots.heighten(figure, axes)
    assert min(distances(figure)) == pytest.approx(dots._APART, abs=0.02), "no higher than it must be"  # noqa: SLF001


def test_panels_for_which_their_surroundings_leave_no_room_get_it():
    figure, axes = drawn(2, title="one\ntwo", entries=30, height=1.0)
    dots.heighten(figure, axes)
    assert min(distances(figure)) > 0.9 * dots._APART  # noqa: SLF001


def test_each_panel_grows_by_what_its_own_rows_lack():
    few, many = {"a": "1", "b": "2"}, {f"{k}\nk\nk": "1" for k in range(9)}
    figure, axes = drawn(2, rows_of=lambda k: (few, many)[k])
    dots.heighten(figure, axes)
    assert min(distances(figure)) > 0.9 * dots._APART  # noqa: SLF001
    before, axes_before = drawn(2, rows_of=lambda k: (few, many)[k])
    save(before)
    first, second = (panel.bbox.height / old.bbox.height for panel, old in zip(axes, axes_before, strict=True))
    assert first == pytest.approx(1, abs=0.01), "has apart rows"
    assert second > 2


def test_a_figure_whose_rows_are_apart_keeps_its_size():
    for rows in ({"a": "1"}, {"a": "1", "b": "2", "c": "3"}):
        figure, axes = drawn(1, rows_of=lambda k, rows=rows: rows)
        dots.heighten(figure, axes)
        assert figure.get_figheight() == pytest.approx(1.5, abs=1e-9)

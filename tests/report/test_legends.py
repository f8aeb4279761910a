"""Legends below a panel cover nothing and have the columns that fit."""

import pytest
from legends import covering

from stiction.report import style


@style.styled
def labelled(label):
    """Figure of two panels whose legends have five entries each."""
    figure, axes = style.panels(1, 2, (style.DOUBLE, 3.0))
    for panel in axes.flat:
        entries = [panel.plot([0, 1], [0, k], label=f"{label} {k}")[0] for k in range(5)]
        panel.set_xlabel("length")
        style.legend_below(panel, entries)
    return figure


@pytest.mark.parametrize(("label", "columns"), [("x", 5), ("a rather long label", 2), (20 * " ab", 1)])
def test_a_legend_below_a_panel_covers_nothing_and_has_the_columns_that_fit(label, columns):
    figure = labelled(label)
    assert {panel.get_legend()._ncols for panel in figure.axes} == {columns}
    assert covering(figure) == []

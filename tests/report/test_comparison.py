"""Values of one key side by side: rows of the copies alone, by their originals, with errors of both kinds."""

import numpy as np
import pandas as pd
import pytest

from stiction.report.comparison import SOURCES, comparison_figure, comparison_table, rows

KEYS, ENDS = ["surfaces.B2.rms_nm"], {"Rms3": [3], "Rms10": [10]}
TABLE_3, LENGTHS, STOPPERS = SOURCES
BEAMS = pd.DataFrame(
    [
        {
            "pair": pair,
            "relative_humidity": humidity,
            "model": "NG",
            "crack_length_um": length,
            "crack_length_se_um": 2.0,
        }
        for pair, length in {"bRms10": 900.0, "bRms3": 600.0, "a": 500.0}.items()
        for humidity in (0.67, 0.44)
    ]
)
SAFE = pd.DataFrame(
    {
        "device": ["C1Rms3", "C1Rms10"],
        "relative_humidity": 0.67,
        "held_by": "beam",
        "share": 0.001,
        "safe_length_um": [90.0, 190.0],
        "estimate_um": [100.0, 200.0],
        "estimate_se_beams_um": [3.0, 6.0],
        "estimate_se_surfaces_um": [4.0, np.nan],
    }
)


def test_rows_are_those_of_copies_under_the_names_of_their_originals():
    found = rows(BEAMS, TABLE_3, ENDS)
    assert list(found.pair) == 4 * ["b"]
    assert list(zip(found.relative_humidity, found.value, found.crack_length_um, strict=True)) == [
        *((0.44, 3, 600), (0.44, 10, 900), (0.67, 3, 600), (0.67, 10, 900)),
    ]


def test_errors_of_beams_and_of_surfaces_are_combined():
    assert list(rows(SAFE, LENGTHS, ENDS).estimate_se_um) == pytest.approx([5, 6])
    cells = comparison_table(SAFE, LENGTHS, KEYS, ENDS).cells
    assert list(cells["surfaces.B2.rms_nm"]) == ["3", "10"]
    assert list(cells["RH"]) == ["0.67", "0.67"]
    assert list(cells["length that a share p holds [µm]"]) == ["100.0 ± 5.0", "200.0 ± 6.0"]


def test_the_figure_has_a_line_over_the_values_for_each_humidity():
    (panel,) = comparison_figure(BEAMS, TABLE_3, KEYS, ENDS).axes
    lines = [container.lines[0] for container in panel.containers]
    assert [list(line.get_xdata()) for line in lines] == 2 * [[3, 10]]
    assert [list(line.get_ydata()) for line in lines] == 2 * [[600, 900]]
    assert panel.get_xlabel() == "surfaces.B2.rms_nm"
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["RH 0.44", "RH 0.67"]
    (panel,) = comparison_figure(BEAMS.replace({"relative_humidity": {0.44: 0.0}}), TABLE_3, KEYS, ENDS).axes
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["dry", "RH 0.67"]


@pytest.mark.parametrize("reverse", [False, True])
def test_of_several_fractions_the_figure_has_the_middle_one(reverse):
    shares = sorted([1e-4, 0.001, 0.01, 0.05, 0.5], reverse=reverse)
    several = pd.concat(
        [SAFE.assign(share=p, estimate_um=SAFE.estimate_um * (1 + p)) for p in shares], ignore_index=True
    )
    figure = comparison_figure(several, LENGTHS, KEYS, ENDS)
    (panel,) = figure.axes
    (line,) = [container.lines[0] for container in panel.containers]
    assert list(line.get_ydata()) == pytest.approx([101.0, 202.0])
    assert panel.get_ylabel().endswith(", p = 0.01")


def test_keys_that_change_together_have_a_column_each_and_one_place_on_the_axis():
    keys = ["surfaces.B2.kurtosis", "surfaces.B2.skewness"]
    ends = {"Rms3": [3.0, 0.0], "Rms10": [3.0, -0.5]}
    table = comparison_table(BEAMS, TABLE_3, keys, ends)
    assert list(table.cells[keys[0]]) == ["3", "3", "3", "3"]
    assert list(table.cells[keys[1]]) == ["-0.5", "0", "-0.5", "0"]
    assert list(table.frame.crack_length_um) == [900, 600, 900, 600]
    (panel,) = comparison_figure(BEAMS, TABLE_3, keys, ends).axes
    assert [text.get_text() for text in panel.get_xticklabels()] == ["3, -0.5", "3, 0"]
    assert [list(container.lines[0].get_ydata()) for container in panel.containers] == 2 * [[900, 600]]
    assert all(key in table.caption for key in keys)

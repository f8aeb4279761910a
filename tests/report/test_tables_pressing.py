import numpy as np
import pytest

from stiction.report import style
from stiction.report.contact import pressing
from stiction.stages.contact.pressing import layout


def study(strips=5):
    """Strips that stick more by 0.1 % after adhesion alone, and by 20 and 50 % after being pressed, in dry air."""
    fresh = np.random.default_rng(1).uniform(1e-4, 2e-4, strips)[:, None] * [1.0, 10.0]
    ratios = np.array([[1, 1], [1.001, 1], [1.2, 1.0], [1.5, 1.01]])
    presses = np.tile([[2e7, 1.1e-8, 0.01, 0.001, 1e-10], [7.3e7, 9e-9, 0.02, 0.01, 1e-9]], (strips, 1, 1))
    presses[:, :, 0] *= np.linspace(0.9, 1.1, strips)[:, None]
    return layout(fresh[:, None] * ratios, presses, [0.6, 0.9])


DATA = {"c": study()}


def test_ratios_of_each_press_with_adhesion_alone_first():
    frame = pressing.table(DATA).frame
    dry = frame[frame.relative_humidity == 0.6]
    assert dry.energy_ratio.tolist() == pytest.approx([1.001, 1.2, 1.5])
    assert dry.pressure_MPa.tolist() == pytest.approx([0, 20, 73])
    assert dry.pressure_MPa_se.iloc[1] == pytest.approx(20 * np.std(np.linspace(0.9, 1.1, 5), ddof=1) / np.sqrt(5))
    assert dry.distance_nm.iloc[2] == pytest.approx(9)
    assert dry.at_hardness_percent.tolist()[1:] == pytest.approx([0.1, 1])
    assert np.all(frame.energy_ratio_se < 1e-9)


def test_each_press_has_a_line():
    cells = pressing.table(DATA).cells
    assert cells["pressure [MPa]"].tolist() == ["adhesion alone", "20.00 ± 0.71", "73.0 ± 2.6"]
    ratios = [float(cell.split(" ± ")[0]) for cell in cells["ē after / before, RH 0.6"]]
    assert ratios == pytest.approx([1.001, 1.2, 1.5])
    assert cells["distance [nm]"][0] == "–"


def test_the_figure_has_a_curve_for_each_humidity_and_equal_bytes():
    figure = pressing.figure(DATA)
    (panel,) = figure.axes
    assert [text.get_text() for text in panel.get_legend().texts] == ["RH 0.6", "RH 0.9"]
    assert panel.get_legend().get_title().get_text() == "bars: ± standard error, shifted"
    assert style.png(figure) == style.png(pressing.figure(DATA))

"""Tables and figures of stoppers and budgets show the numbers of their datasets."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.designs import budget as study_budget
from stiction.designs import figures_budget, tables_budget
from stiction.designs import stoppers as study_stoppers
from stiction.designs.budget import Input, State
from stiction.report.style import save
from stiction.stages.curves import Water

STATE = State(None, 0.5, Water(300.0))
NAMES = {"rms of B2": "heights of B2", "skewness of B2": "heights of B2", "thickness": "thickness"}
COVARIANCE = np.array([[4e-4, -1e-4, 0], [-1e-4, 4e-4, 0], [0, 0, 1e-4]])


def budget_dataset(factor=1.0, unit="m"):
    """Budget of three inputs, two of them correlated, and one choice."""
    inputs = [Input(name, group, (STATE, STATE), 0.1) for name, group in NAMES.items()]
    slopes = np.array([[1.0, 0.02], [1.0, 0.03], [0.8, 0.01]]) * [factor, 1]
    lengths = np.array([690e-6, 700e-6, 710e-6])
    return study_budget.layout(inputs, slopes, COVARIANCE, lengths, {"van_der_waals_dry": (-0.042, 0.003)}, unit)


def stopper_dataset(peak=0.7):
    """400 patches that hold 0.05, 0.1, ..., 20 µN."""
    settings = study_stoppers.Settings(Water(300.0), (3e-6, 3e-6), 18.99e-6, (0.44, 0.67), (0.4, 0.9))
    forces, axis = 5e-8 * np.arange(1, 401), np.linspace(0.4, 0.9, 11)
    peaks = peak + 0.04 * np.where(np.arange(400) % 2, 1, -1)
    along = (1 - (axis[:, None] - peaks) ** 2) * 5e-6
    return study_stoppers.layout(settings, np.stack([forces, 0.5 * forces]), axis, along)


BUDGETS = {("C1", 0.44): budget_dataset(2.0), ("C1", 0.67): budget_dataset(), ("S1", 0.67): budget_dataset(1, "N")}
WARNINGS = {"S1": [], "S2": ["Beware."]}
STOPPERS = {"S1": stopper_dataset(), "S2": stopper_dataset(peak=1.0)}


def part(frame, name, humidity=0.67, device="C1"):
    chosen = frame[(frame.part == name) & (frame.relative_humidity == humidity) & (frame.device == device)]
    return chosen.set_index("name")


def test_effects_are_those_of_the_covariance():
    frame = tables_budget.budget(BUDGETS).frame
    effects = part(frame, "measurement").effect_percent
    assert_allclose(effects["heights of B2"], 100 * np.sqrt(6e-4), rtol=1e-12)
    assert_allclose(effects["thickness"], 0.8, rtol=1e-12)
    assert_allclose(part(frame, "measurement", 0.44).effect_percent, 2 * effects, rtol=1e-12)
    inputs = part(frame, "input")
    assert_allclose(inputs.standard_uncertainty, [0.02, 0.02, 0.01], rtol=1e-12)
    assert_allclose(inputs.effect_percent, np.abs(inputs.slope) * 100 * inputs.standard_uncertainty, rtol=1e-12)


def test_the_total_has_the_correlations_and_leaves_out_scatter_and_choices():
    frame = tables_budget.budget(BUDGETS).frame
    totals = part(frame, "total").effect_percent
    assert_allclose(totals[tables_budget.TOTAL], 100 * np.sqrt(6e-4 + 0.64e-4), rtol=1e-12)
    assert_allclose(totals[tables_budget.INDEPENDENT], 100 * np.sqrt(8e-4 + 0.64e-4), rtol=1e-12)
    assert_allclose(part(frame, "scatter").effect_percent.iloc[0], 100 * 10 / 700, rtol=1e-9)
    assert_allclose(part(frame, "choice").effect_percent["van_der_waals_dry"], -4.2, rtol=1e-12)


def test_what_remains_is_the_rest_of_the_total():
    frame = tables_budget.budget(BUDGETS).frame
    left = part(frame, "measurement").remaining_percent
    assert_allclose([left["heights of B2"], left["thickness"]], [0.8, 100 * np.sqrt(6e-4)], rtol=1e-9)


def test_the_text_names_what_to_measure_better():
    table = tables_budget.budget(BUDGETS)
    assert "C1, RH 0.67: Measure heights of B2 better" in table.caption
    assert "uncertainty of the mean pull-off force would fall from 2.6 to 0.8 %" in table.caption
    assert "rms of B2" not in set(table.cells.what)
    assert "choice: vdW: dry" in set(table.cells.what)
    row = table.cells[(table.cells.what == "choice: vdW: dry") & (table.cells.device == "C1")].iloc[0]
    assert row["effect [%]"] == "-4.20 ± 0.30"


def test_without_uncertainties_no_advice_is_given():
    exact = BUDGETS["C1", 0.67].assign(covariance=0 * BUDGETS["C1", 0.67].covariance)
    assert tables_budget.advised(exact) == "No uncertainty of an input is stated."


def test_numbers_of_stoppers_are_those_of_the_dataset():
    frame = tables_budget.stoppers(STOPPERS, WARNINGS).frame.set_index(["device", "relative_humidity"])
    row = frame.loc["S1", 0.44]
    assert_allclose(
        [row.pull_off_uN, row.pull_off_std_uN], [0.05 * 200.5, 0.05 * np.arange(400).std(ddof=1)], rtol=1e-9
    )
    assert_allclose(row.share_stuck, 21 / 400, rtol=1e-12)  # 19 µN and more
    assert row.share_stuck_low < row.share_stuck < row.share_stuck_high
    assert frame.loc["S1", 0.67].share_stuck == 0
    assert 19.5 < row["safe_force_uN_0.01"] <= 20
    assert np.isnan(row["safe_force_uN_0.001"])


def test_the_last_row_of_a_stopper_bounds_all_humidities_of_the_axis():
    dataset = STOPPERS["S1"].assign(stuck_along=STOPPERS["S1"].stuck_along + 0.01 * np.arange(11))
    table = tables_budget.stoppers({"S1": dataset}, WARNINGS)
    row = table.frame.iloc[2]
    assert np.isnan(row.relative_humidity)
    assert table.cells.RH[2] == "0.4 to 0.9"
    assert_allclose(row.share_stuck, 0.1, rtol=1e-12)
    assert_allclose(row.pull_off_uN, 1e6 * dataset.mean_along.max(), rtol=1e-12)
    assert_allclose(row["safe_force_uN_0.01"], 1e6 * dataset.safe_force_along.sel(share=1e-2).max(), rtol=1e-12)
    assert np.isnan(row["safe_force_uN_0.001"])


def test_a_worst_humidity_at_the_end_of_the_axis_may_lie_beyond_it():
    cells = tables_budget.stoppers(STOPPERS, WARNINGS).cells
    assert list(cells["worst RH"]) == ["0.700 ± 0.015"] * 3 + ["0.9 or beyond"] * 3
    assert set(cells["safe force, 0.001 [µN]"]) == {"–"}


def test_bars_of_a_tornado_are_the_effects_the_largest_first():
    figure = figures_budget.budget(BUDGETS)
    first, second = figure.axes
    names = [text.get_text() for text in first.get_yticklabels()]
    assert names[:2] == ["heights of B2", "thickness"]
    assert names[-1] == "choice: vdW: dry"
    widths = [bar.get_width() for bar in first.patches]
    assert_allclose(widths[:2], [4 * 100 * np.sqrt(6e-4), 2 * 100 * np.sqrt(6e-4)], rtol=1e-9)
    choice = first.patches[-1]
    assert_allclose([choice.get_x(), choice.get_x() + choice.get_width()], [-4.2, 0], atol=1e-12)
    assert "mean sticking length" in first.get_xlabel()
    assert "mean pull-off force" in second.get_xlabel()


def test_a_stopper_shows_the_share_of_patches_over_the_restoring_force():
    figure = figures_budget.stoppers(STOPPERS, WARNINGS)
    line = figure.axes[0].lines[0]
    assert figure._supxlabel.get_text() == "(1) S2: Beware."
    force, share = line.get_data()
    assert_allclose(share, 1 - np.arange(1, 401) / 400, atol=1e-12)
    assert_allclose(force, 0.05 * np.arange(1, 401), rtol=1e-12)


@pytest.mark.parametrize(
    "draw", [lambda: figures_budget.budget(BUDGETS), lambda: figures_budget.stoppers(STOPPERS, WARNINGS)]
)
def test_equal_data_give_equal_files(draw, tmp_path):
    for name in ("one", "two"):
        save(draw(), tmp_path / f"{name}.png")
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()


def test_one_case_and_many_cases_are_drawn():
    for cases in ({("C1", 0.67): BUDGETS["C1", 0.67]}, {(f"C{k}", 0.5): budget_dataset() for k in range(4)}):
        assert len(figures_budget.budget(cases).axes) == len({device for device, _ in cases})

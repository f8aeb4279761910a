"""Tables and figures of stoppers and budgets show the numbers of their datasets."""

from dataclasses import replace

import numpy as np
import pytest
from answers import BEAMS, BUDGETS, STOPPERS, TIPS, budget_dataset, stopper_answer, stopper_dataset
from legends import covering
from matplotlib.lines import Line2D
from noted import noted
from numpy.testing import assert_allclose

from stiction.answer.data import Between, Unasked
from stiction.config.files import load
from stiction.contact.correction import Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.devices.stoppers import stuck_patches
from stiction.plan.plan import Plan
from stiction.report.budget import figures as figures_budget
from stiction.report.budget import tables as tables_budget
from stiction.report.devices import pages
from stiction.report.format import safe_size
from stiction.report.style import BUILD, DOUBLE, humidity_colours, legend_below, panels, save, styled
from stiction.stages.devices.stoppers import Settings, layout, stuck_over
from stiction.stages.life.answers import Name

WARNINGS = {"S1": [], "S2": [noted("Beware.")]}


def part(frame, name, humidity=0.67, device="C1", held_by="beam"):
    case = (frame.relative_humidity == humidity) & (frame.device == device) & (frame.held_by == held_by)
    return frame[(frame.part == name) & case].set_index("name")


def test_effects_are_those_of_the_covariance():
    frame = tables_budget.budget(BUDGETS).frame
    effects = part(frame, "measurement").effect_percent
    assert_allclose(effects["heights of B2"], 100 * np.sqrt(6e-4), rtol=1e-12)
    assert_allclose(effects["thickness"], 0.8, rtol=1e-12)
    assert_allclose(part(frame, "measurement", 0.44).effect_percent, 2 * effects, rtol=1e-12)
    assert_allclose(part(frame, "measurement", held_by="tip").effect_percent, effects / 2, rtol=1e-12)
    assert_allclose(part(frame, "measurement", device="S1", held_by="whole area").effect_percent, effects, rtol=1e-12)
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


def test_the_total_of_a_page_is_the_root_of_the_squares_above_it_and_has_no_rival():
    whole, cells = tables_budget.budget(BUDGETS), tables_budget.cells_of_page(BUDGETS)
    rivals = whole.cells.what.str.contains("without correlations")
    assert rivals.sum() == len(BUDGETS)
    assert whole.cells[~rivals].reset_index(drop=True).equals(cells)
    of_one = cells[(cells.device == "C1") & (cells.RH == "0.67") & (cells["held by"] == "beam")]
    rows = of_one.set_index("what")["effect [%]"].map(lambda text: float(text.split()[0]))
    totals = [name for name in rows.index if name.startswith("total")]
    assert totals == ["total: all measurements together"]
    above = rows.iloc[: rows.index.get_loc(totals[0])]
    assert rows[totals[0]] == pytest.approx(np.hypot(*above), rel=0.01)
    assert list(rows.index).index("scatter between devices, not in the total") == len(above) + 1


@pytest.mark.parametrize("device", ["C1", "S1"])
def test_what_holds_a_device_has_a_column_of_its_page_if_it_is_several_things(device):
    budgets = {key: dataset for key, dataset in BUDGETS.items() if key[0] == device}
    cells = pages._side_by_side(tables_budget.cells_of_page(budgets))  # noqa: SLF001
    assert cells.columns[0] == "what"
    assert ("held by" in cells) == (device == "C1")


def test_what_remains_is_the_rest_of_the_total():
    frame = tables_budget.budget(BUDGETS).frame
    left = part(frame, "measurement").remaining_percent
    assert_allclose([left["heights of B2"], left["thickness"]], [0.8, 100 * np.sqrt(6e-4)], rtol=1e-9)


def test_the_text_names_what_to_measure_better():
    table = tables_budget.budget(BUDGETS)
    assert "\n- C1, RH 0.67: Measure heights of B2 better" in table.caption
    assert "uncertainty of the mean pull-off force would fall from 2.6 to 0.8 %" in table.caption
    assert "uncertainty of the mean length at which beams stick (S-shape) would fall from 2.6 to 0.8 %" in table.caption
    assert "uncertainty of the length that 1 in 1000 tips hold (arc) would fall from 1.3 to 0.4 %" in table.caption
    assert "rms of B2" not in set(table.cells.what)
    assert "choice: van der Waals in dry gaps" in set(table.cells.what)
    row = table.cells[(table.cells.what == "choice: van der Waals in dry gaps") & (table.cells.device == "C1")].iloc[0]
    assert row["effect [%]"] == "-4.20 ± 0.30"


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_every_choice_of_the_model_has_a_label_in_words(medium):
    config = {"van_der_waals": medium, "studies": {"variants": {"van_der_waals": ["water", "dry", "none"]}}}
    choices = Plan(load(config)).variants.choices("b")
    labels = [tables_budget.choice_label(name) for name in choices]
    assert len(set(labels)) == len(choices) > 5
    assert {"spectrum from summits", "1 in 2 grid points", "grid of 5 nm", "Poisson's ratio 0.18"} < set(labels)


def test_the_text_lists_once_for_each_device_what_counts_as_exact():
    caption = tables_budget.budget(BUDGETS).caption
    assert caption.count("C1: Counted as exact: the heights of B2, ") == 1
    assert "S1: Counted as exact: " in caption
    assert tables_budget.counted_as_exact(BEAMS["C1", 0.67]).endswith(", the contact angles, the adsorbed water.")


def test_what_counts_as_exact_is_listed_once_for_the_beam_and_its_tip():
    beam = BEAMS["C1", 0.67]
    tip = beam.drop_vars("exact").assign_coords(exact=["the radius of the edge", *beam.exact.values])
    assert tables_budget.counted_as_exact(beam, tip) == tables_budget.counted_as_exact(tip)
    caption = tables_budget.budget({("C1", 0.67): beam, ("C1", 0.67, "tip"): tip}).caption
    assert caption.count("Counted as exact") == caption.count("the radius of the edge") == 1


def test_an_exact_slope_is_shown_without_an_error():
    exact = BEAMS["C1", 0.67].assign(slope_error=("input", [0.02, 0.03, 0.0]))
    cells = tables_budget.budget({("C1", 0.67): exact}).cells.set_index("what")["effect [%]"]
    assert cells["thickness"] == "0.8"
    assert "±" in cells["heights of B2"]


def test_without_uncertainties_no_advice_is_given():
    exact = BUDGETS["C1", 0.67].assign(covariance=0 * BUDGETS["C1", 0.67].covariance)
    said = tables_budget.what_to_measure(exact)
    assert said == f"No input with a stated uncertainty acts on the {tables_budget.response_text(exact)}."


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
    for share, basis in zip(("0.01", "0.001", "0.0001", "1e-06"), STOPPERS["S1"].basis.values, strict=True):
        safe = STOPPERS["S1"].safe_force.sel(humidity=0.44, share=float(share), part="safe")
        assert (row[f"safe_force_uN_{share}"], row[f"safe_force_basis_{share}"]) == (1e6 * float(safe), basis)


def test_the_last_row_of_a_stopper_bounds_all_humidities_of_the_axis():
    dataset = STOPPERS["S1"].assign(stuck_along=STOPPERS["S1"].stuck_along + 0.01 * np.arange(11))
    table = tables_budget.stoppers({"S1": dataset}, WARNINGS)
    row = table.frame.iloc[2]
    assert np.isnan(row.relative_humidity)
    assert table.cells.RH[2] == "0.4 to 0.9"
    assert_allclose(row.share_stuck, 0.1, rtol=1e-12)
    assert_allclose(row.pull_off_uN, 1e6 * dataset.mean_along.max(), rtol=1e-12)
    assert_allclose(row["safe_force_uN_0.01"], 1e6 * dataset.safe_force_along.sel(share=1e-2).max(), rtol=1e-12)
    assert_allclose(row["safe_force_uN_1e-06"], 1e6 * dataset.safe_force_along.sel(share=1e-6).max(), rtol=1e-12)


def test_a_worst_humidity_at_the_end_of_the_axis_may_lie_beyond_it():
    cells = tables_budget.stoppers(STOPPERS, WARNINGS).cells
    assert list(cells["RH of largest mean"]) == ["0.700 ± 0.015"] * 3 + ["0.9 or beyond"] * 3


def test_a_safe_force_that_is_fitted_or_extrapolated_says_so():
    table = tables_budget.stoppers(STOPPERS, WARNINGS)
    texts = {
        share: list(table.cells[f"simulated limit, {share} [µN]"]) for share in ("0.01", "0.001", "0.0001", "1e-06")
    }
    assert all("(" not in text for text in texts["0.01"])
    assert all(text.endswith(" (fitted)") for text in texts["0.001"])
    assert all(text.endswith(" (extrapolated)") for share in ("0.0001", "1e-06") for text in texts[share])
    few = STOPPERS["S1"].assign(safe_force=STOPPERS["S1"].safe_force * np.nan, basis=("share", [""] * 4))
    assert tables_budget.stoppers({"S1": few}, WARNINGS).cells["simulated limit, 1e-06 [µN]"][0] == "–"


def drawn(panel):
    """Names of the rows of a panel from top to bottom, and the bars [%]."""
    return [text.get_text() for text in panel.get_yticklabels()], panel.patches


def test_bars_of_a_budget_are_shares_of_the_variance_and_total_and_scatter_are_above_them():
    figure = figures_budget.budget(BEAMS)
    measured, chosen = figure.axes
    names, bars = drawn(measured)
    heights, thickness = 6e-4, 0.64e-4  # variances at the first humidity
    assert names == ["heights of B2", "thickness"]
    shares = [[100 * heights / (heights + thickness)] * 2, [100 * thickness / (heights + thickness)] * 2]
    assert_allclose(np.reshape([bar.get_width() for bar in bars], (2, 2)), shares, rtol=1e-9)
    assert {bar.get_x() for bar in bars} == {0}
    middles = [bar.get_y() + bar.get_height() / 2 for bar in bars]
    assert_allclose(np.reshape(middles, (2, 2)).mean(axis=1), range(2), atol=1e-12)
    totals = [f"{100 * scale * np.sqrt(heights + thickness):.2g}" for scale in (2, 1)]
    title = " ".join(measured.get_title(loc="left").replace("\u00a0", " ").split())
    assert title.endswith(f"total: standard uncertainty ± {totals[0]}, {totals[1]} % devices scatter ± 1.4, 1.4 %")
    (alone,) = (panel for panel in figures_budget.budget({("C1", 0.67): BEAMS["C1", 0.67]}).axes[:1])
    assert f"standard uncertainty ± {totals[1]} %" in alone.get_title(loc="left").replace("\u00a0", " "), (
        "a single air has no name"
    )
    names, bars = drawn(chosen)
    assert names == ["van der Waals in dry gaps"]
    assert_allclose([bars[0].get_x(), bars[0].get_x() + bars[0].get_width()], [-4.2, 0], atol=1e-12)
    ((low, high),) = (segment[:, 0] for segment in chosen.containers[1][2][0].get_segments())
    assert_allclose([low, high], [-4.5, -3.9])  # the error is drawn at the end away from zero
    assert "mean length at which beams stick" in measured.get_title(loc="left").replace("\n", " ")


def test_beam_and_tip_have_panels_of_their_own():
    figure = figures_budget.budget(BEAMS | {("C1", rh, "tip"): budget_dataset(0.5, TIPS) for rh in (0.44, 0.67)})
    titles = [panel.get_title(loc="left").partition("\ntotal: standard")[0].replace("\n", " ") for panel in figure.axes]
    assert titles[::2] == [
        "(a) mean length at which beams stick (S-shape)",
        "(c) length that 1 in 1000 tips hold (arc)",
    ]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "RH 0.44",
        "RH 0.67",
        "± standard error",
        "in titles: airs in this order",
    ]


def test_text_of_a_budget_can_be_read_on_a_phone():
    figure = figures_budget.budget(BEAMS)
    smallest = min(text.get_fontsize() for text in figure.axes[0].get_yticklabels())
    assert smallest / 72 * 390 / figure.get_figwidth() > 11  # pixels if the figure is 390 pixels wide


def test_errors_of_shares_end_at_none_and_at_all_of_the_variance_and_no_bar_is_cut():
    wide = {key: one.assign(slope_error=50 + one.slope_error) for key, one in BEAMS.items()}
    measured = figures_budget.budget(wide).axes[0]
    ends = [line for held in measured.containers if hasattr(held, "has_xerr") for line in held[2][0].get_segments()]
    assert_allclose([line[:, 0] for line in ends], [[0, 100]] * 4, atol=1e-9)
    assert measured.get_xlim() == (0, 100)
    covariance = BEAMS["C1", 0.67].covariance.copy()
    deviations = np.sqrt(np.diag(covariance))
    covariance[...] = covariance - 0.3 * np.outer(deviations, deviations) * (1 - np.eye(3))
    measured = figures_budget.budget({("C1", 0.67): BEAMS["C1", 0.67].assign(covariance=covariance)}).axes[0]
    longest = max(bar.get_width() for bar in measured.patches)
    assert 100 < longest <= measured.get_xlim()[1]


@pytest.mark.parametrize(("factors", "names"), [([0.1, 0.1], ["thickness", "others"]), ([1, 0.1], None)])
def test_measurements_that_are_small_in_all_airs_share_a_row_and_a_single_one_keeps_its_own(factors, names):
    one = BEAMS["C1", 0.67].assign(group=("input", ["the gap", "the humidity", "the thickness"]))
    covariance = one.covariance * np.eye(3)
    one = one.assign(covariance=covariance, slope=one.slope * [*factors, 5])
    rows, bars = drawn(figures_budget.budget({("C1", 0.67): one}).axes[0])
    assert rows == (names or ["thickness", "gap", "humidity"])
    assert_allclose(sum(bar.get_width() for bar in bars), 100)


def test_six_humidities_fit_a_screen_with_bars_that_darken_and_do_not_meet():
    humidities = np.linspace(0.4, 0.9, 6)
    cases = {("C1", h): budget_dataset(1 + h) for h in humidities}
    cases |= {("C1", h, "tip"): budget_dataset(h, TIPS) for h in humidities}
    figure = figures_budget.budget(cases)
    assert figure.get_figheight() < 8
    bars = figure.axes[0].patches
    places = [bar.get_y() for bar in bars]
    assert_allclose(places, np.sort(places))
    assert np.all(np.diff(places) > 0.99 * bars[0].get_height())
    light = [sum(bar.get_facecolor()[:3]) for bar in bars[:6]]
    assert np.all(np.diff(light) < 0)
    (legend,) = figure.legends
    assert [patch.get_facecolor() for patch in legend.get_patches()] == [bar.get_facecolor() for bar in bars[:6]]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_no_legend_of_stoppers_covers_a_panel_or_a_text(count):
    datasets = {f"S{k}": stopper_dataset() for k in range(count)}
    assert covering(figures_budget.stoppers(datasets, {"S0": [noted("Beware.")]})) == []


@pytest.mark.parametrize(
    ("name", "unknown"),
    [("effect", np.inf), *((name, np.nan) for name in ("effect", "effect_error", "slope", "slope_error"))],
)
def test_effects_that_are_not_known_have_no_bar_and_leave_the_others(name, unknown):
    few = BEAMS["C1", 0.67].copy(deep=True)
    few[name][:1] = unknown
    whole, part = (figures_budget.budget({("C1", 0.67): one}) for one in (BEAMS["C1", 0.67], few))
    drawn = [sum(len(panel.patches) for panel in figure.axes) for figure in (whole, part)]
    assert 0 < drawn[1] <= drawn[0]
    for panel, before in zip(part.axes, whole.axes, strict=True):
        assert np.isfinite(panel.get_xlim()).all()
        assert panel.get_xlim()[1] <= before.get_xlim()[1] or name == "slope"
    everything = budget_dataset(np.nan)
    figures_budget.budget({("C1", 0.67): everything.assign(effect=everything.effect * np.nan)})


@pytest.mark.parametrize("count", [2, 6, pytest.param(30, marks=pytest.mark.slow)])
def test_every_panel_has_the_name_of_its_stopper_in_a_figure_that_is_not_too_tall(count):
    datasets = {f"S{k}": stopper_dataset(peak=1 + k) for k in range(count)}
    figure = figures_budget.stoppers(datasets, {name: [noted("Beware.")] for name in datasets})
    forces = [panel for panel in figure.axes if panel.get_xlabel().startswith("relative humidity")]
    tops = {panel.get_title("left").split()[1].strip(":"): max(panel.lines[0].get_ydata()) for panel in forces}
    expected = {name: 1e6 * float(dataset.mean_along.max()) for name, dataset in datasets.items()}
    assert tops == pytest.approx(expected)
    assert figure.get_figheight() <= 24
    assert figure._supxlabel.get_text() == "Some results are beyond limits of the model."


def test_a_shorter_label_leaves_room_for_more_columns():
    _, axes = styled(panels)(1, 2, (DOUBLE, 3))
    for panel, label in zip(axes.flat, ("mean", "5 to 95 % of the patches"), strict=True):
        styled(legend_below)(panel, [Line2D([], [], label=label) for _ in range(6)])
    short, long = (panel.get_legend()._ncols for panel in axes.flat)
    assert short > long > 1


def test_every_legend_of_stoppers_explains_its_own_panel_and_humidities_have_one_colour():
    figure = figures_budget.stoppers({"S1": STOPPERS["S1"]}, {})
    above, below = figure.axes
    assert figure.legends == []
    assert [text.get_text() for text in below.get_legend().get_texts()][:2] == ["mean", "5 to 95 % of the patches"]
    colours = humidity_colours(STOPPERS["S1"].humidity.values.tolist())
    drawn = [line.get_color() for line in above.get_legend().get_lines()[:2]]
    np.testing.assert_array_equal(drawn, list(colours.values()))
    bars = figures_budget.budget(BEAMS).legends[0].get_patches()
    of_bars = humidity_colours(humidity for _, humidity, *_ in BEAMS)
    np.testing.assert_array_equal([bar.get_facecolor() for bar in bars], list(of_bars.values()))


def test_a_stopper_shows_the_share_of_patches_over_the_restoring_force():
    figure = figures_budget.stoppers(STOPPERS, WARNINGS)
    line = figure.axes[0].lines[0]
    assert figure._supxlabel.get_text() == "Some results are beyond limits of the model."
    force, share = line.get_data()
    assert_allclose(share, 1 - np.arange(1, 401) / 400, atol=1e-12)
    assert_allclose(force, 0.05 * np.arange(1, 401), rtol=1e-12)


def with_errors(ratio=0.04, power=0.1, restoring=18.99e-6):
    """Stopper with errors of its forces by full elastic contact."""
    change = ElasticChange(ratio_error=ratio, power_error=power)
    of_all = ElasticChange(*(np.full(3, value) for value in change))
    correction = Correction(np.array([0.3, 0.6, 0.99]), of_all, of_all)
    water = Water(300.0, correction=correction)
    settings = Settings(1, water, (3e-6, 3e-6), (0.44, 0.67), (0.4, 0.9), restoring_force=restoring)
    forces = np.exp(np.random.default_rng(4).normal(np.log(10e-6), 0.5, 4000))
    return layout(settings, np.stack([forces, 0.5 * forces]), np.array([0.4, 0.9]), np.stack([forces, 0.5 * forces]))


def ends_of_band(collection, at):
    """Lower and upper end of a filled band at one of its places."""
    corners = collection.get_paths()[0].vertices
    there = corners[np.isclose(corners[:, 0], at, rtol=1e-9), 1]
    return [there.min(), there.max()]


@pytest.mark.parametrize("restoring", [12e-6, 18.99e-6])
def test_the_band_of_a_stopper_is_that_of_its_table_and_not_of_the_patches_alone(restoring):
    dataset = with_errors(restoring=restoring)
    panel = figures_budget.stoppers({"S1": dataset}, {}).axes[0]
    rows = tables_budget.stoppers({"S1": dataset}, {"S1": []}).frame
    forces = dataset.pull_off.values
    for k, band in enumerate(panel.collections):
        drawn = ends_of_band(band, 1e6 * restoring)
        assert_allclose(drawn, rows.loc[k, ["share_stuck_low", "share_stuck_high"]].to_list(), rtol=1e-12)
        _, *alone = (float(values[0]) for values in stuck_patches(forces[k], np.array([restoring])))
        assert drawn[0] < 0.98 * alone[0]
        assert drawn[1] > 1.02 * alone[1]


def test_marks_of_a_stopper_are_the_limits_of_its_table_inside_its_band():
    dataset = with_errors()
    panel = figures_budget.stoppers({"S1": dataset}, {}).axes[0]
    marks = [line.get_data() for line in panel.lines if line.get_marker() == "|" and len(line.get_xdata())]
    for humidity, (force, share), band in zip((0.44, 0.67), marks, panel.collections, strict=True):
        limits = dataset.safe_force.sel(humidity=humidity, part="safe", share=share)
        assert_allclose(share, [1e-2, 1e-3])
        assert_allclose(force, 1e6 * limits)
        assert band.get_paths()[0].vertices[:, 0].max() >= max(force)
        _, _, upper = stuck_over(dataset, humidity, limits.values)
        assert np.all(upper >= share), "the upper end of two sides is above the limit of one side"


@pytest.mark.parametrize("is_allowed", [True, False])
def test_a_stopper_shows_the_force_to_build_unless_a_limit_forbids_it(is_allowed):
    known = stopper_answer(STOPPERS["S1"], BUDGETS)
    answer = replace(known, forbidden=() if is_allowed else ("gap",))
    force = safe_size(known.build, known.sought)
    above, below = figures_budget.stoppers({"S1": STOPPERS["S1"]}, {}, {"S1": answer}).axes
    texts = [[text.get_text() for text in panel.get_legend().get_texts()] for panel in (above, below)]
    diamonds = [line.get_xydata() for line in below.lines if line.get_marker() == "D"]
    assert_allclose(diamonds, [[[known.together.humidity, 1e6 * known.build]]] if is_allowed else [])
    assert [panel.get_title("left") for panel in (above, below)] == [
        "(a) S1: share stuck after one touchdown",
        "(b) S1: force against humidity",
    ]
    assert (f"to build, {force}" in texts[0]) == (f"to build for all stated airs, {force}" in texts[1]) == is_allowed
    assert "95 % band" in texts[0]


@pytest.mark.parametrize("is_allowed", [True, False])
def test_a_stopper_shows_the_larger_force_to_build_between_its_airs(is_allowed):
    known = stopper_answer(STOPPERS["S1"], BUDGETS)
    answer = replace(
        known, between=Between(0.6, 1.5 * known.build, known.build), forbidden=() if is_allowed else ("gap",)
    )
    shares, panel = figures_budget.stoppers({"S1": STOPPERS["S1"]}, {}, {"S1": answer}).axes
    label = f"strictest air, RH 0.6, interpolated: to build {safe_size(1.5 * known.build, known.sought)}"
    marks = [line.get_xydata() for line in panel.lines if line.get_label() == label]
    assert_allclose(marks, [[[0.6, 1.5e6 * known.build]]] if is_allowed else [])
    texts = [text.get_text() for text in panel.get_legend().get_texts()]
    assert sum("strictest" in text for text in texts) == is_allowed, "the largest mean and limit are called so"
    assert [text.startswith("largest ") for text in texts].count(True) == 2
    label = f"stricter: {safe_size(1.5 * known.build, known.sought)}"
    lines = [line.get_xdata()[0] for line in shares.lines if line.get_label() == label]
    assert_allclose(lines, [1.5e6 * known.build] if is_allowed else [])


def test_a_stopper_shows_all_forces_that_are_stricter_and_no_others():
    known = stopper_answer(STOPPERS["S1"], BUDGETS)
    less, more = (Unasked(Name.FAST, "", factor * known.build) for factor in (0.8, 1.2))
    answer = replace(known, between=Between(0.6, 1.5 * known.build, known.build), unasked=(less, more))
    above, below = figures_budget.stoppers({"S1": STOPPERS["S1"]}, {}, {"S1": answer}).axes
    lines = [line.get_xdata()[0] for line in above.lines if line.get_linestyle() == "--" and line.get_color() == BUILD]
    assert_allclose(lines, [1.2e6 * known.build, 1.5e6 * known.build])
    first, second = (safe_size(factor * known.build, known.sought) for factor in (1.2, 1.5))
    assert f"stricter: {first}, {second}" in [text.get_text() for text in above.get_legend().get_texts()]
    to_build = f"to build for all stated airs, {safe_size(known.build, known.sought)}, but {first} if it separates fast"
    assert to_build in [" ".join(text.get_text().split()) for text in below.get_legend().get_texts()]


def test_the_largest_limit_of_a_stopper_is_marked_where_the_table_has_it():
    dataset = STOPPERS["S1"]
    moved = dataset.assign(safe_force_along=dataset.safe_force_along * (1 - (dataset.axis - 0.5) ** 2))
    places = []
    for one in (dataset, moved):
        panel = figures_budget.stoppers({"S1": one}, {}).axes[1]
        (mark,) = (line for line in panel.lines if line.get_marker() == "^")
        limit = one.safe_force_along.sel(share=0.01)
        assert_allclose([mark.get_xdata()[0], mark.get_ydata()[0]], [limit.idxmax("axis"), 1e6 * limit.max()])
        places.append(mark.get_xdata()[0])
    assert places[0] > places[1]


@pytest.mark.parametrize("restoring", [1e-6, 19e-6, 60e-6])
def test_the_name_of_the_restoring_force_is_inside_its_panel(restoring):
    figure = figures_budget.stoppers({"S1": STOPPERS["S1"].assign(restoring_force=restoring)}, {"S1": []})
    figure.draw_without_rendering()
    (text,), panel = figure.axes[0].texts, figure.axes[0].bbox
    assert panel.x0 <= text.get_window_extent().x0 <= text.get_window_extent().x1 <= panel.x1


@pytest.mark.parametrize(
    "draw", [lambda: figures_budget.budget(BEAMS), lambda: figures_budget.stoppers(STOPPERS, WARNINGS)]
)
def test_equal_data_give_equal_files(draw, tmp_path):
    for name in ("one", "two"):
        save(draw(), tmp_path / f"{name}.png")
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()


def test_a_budget_without_other_choices_of_the_model_has_no_empty_panel():
    whole = figures_budget.budget(BEAMS)
    alone = figures_budget.budget({key: one.isel(choice=[]) for key, one in BEAMS.items()})
    assert len(alone.axes) == len(whole.axes) / 2
    assert all(panel.patches for panel in (*whole.axes, *alone.axes))


def test_the_worst_humidity_in_a_figure_is_by_the_mean():
    legend = figures_budget.stoppers({"S1": STOPPERS["S1"]}, {}).axes[1].get_legend()
    assert [text.get_text() for text in legend.get_texts()][-1] == "largest mean, RH 0.70"

"""Tables and figures of devices show the numbers of their datasets; equal data give equal files."""

from itertools import product

import numpy as np
import pytest
import xarray as xr
from charted import EITHER, S_SHAPE, charted
from ground import exactly, safe_with_tips, safe_without_tips
from legends import covering
from matplotlib.colors import to_hex
from noted import noted

from stiction.answer.data import Answer, AnswerInAir, Cause, Step, Unasked
from stiction.devices.chart import error_between
from stiction.report.devices import figures as figures_devices
from stiction.report.devices import tables as tables_devices
from stiction.report.style import BUILD, save
from stiction.stages.devices import safe_lengths

WARNINGS = {("C1", 0.44, S_SHAPE): [noted("Too wet.")], ("C1", 0.44, EITHER): [noted("Too wet."), noted("Too thin.")]}
WARNINGS |= {("C1", 0.67, S_SHAPE): [], ("C1", 0.67, EITHER): [noted("Too thin.")], ("R1", 0.67, "middle"): []}


@pytest.fixture(scope="module")
def found():
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    return {
        ("C1", 0.44): safe_with_tips(tips),
        ("C1", 0.67): safe_with_tips(1.5 * tips),
        ("R1", 0.67): safe_without_tips(),
    }


CHARTS = {("C1", humidity): charted(humidity, factor) for humidity, factor in ((0.5, 1.0), (0.4, 2.0), (0.6, 0.5))}
CURVES = list(product(("C1",), (2e-6, 3e-6), (10e-6, 20e-6), (S_SHAPE, EITHER)))
STEEP = dict.fromkeys(CURVES, []) | {
    CURVES[2]: [noted("Too steep.")],
    CURVES[3]: [noted("Too steep."), noted("Too short.")],
}


def test_the_table_has_a_row_per_shape_and_share_with_the_numbers_of_the_dataset(found):
    table = tables_devices.safe_lengths(found, WARNINGS)
    assert len(table.frame) == 2 * 4 + 2 == len(table.cells)
    row = table.frame[(table.frame.device == "C1") & (table.frame.relative_humidity == 0.67)].iloc[3]
    one = found["C1", 0.67].isel(shape=1, share=1)
    assert (row.held_by, row.share, row.basis) == ("beam or tip", 1e-3, "fitted")
    stated = row.safe_length_um, row.estimate_um, row.estimate_se_beams_um, row.estimate_se_surfaces_um
    held = one.safe_length, one.estimate, one.beams_error, one.surfaces_error
    assert stated == pytest.approx([1e6 * float(value) for value in held], rel=1e-12, nan_ok=True)
    assert row.bound_um == pytest.approx(1e6 * float(one.flooded_length), rel=1e-12)
    assert 0 <= row.bound_um - float(table.cells["bound [µm]"].iloc[7]) < 0.1


def test_arcs_have_no_error_of_surfaces_of_their_own(found):
    cells = tables_devices.safe_lengths(found, WARNINGS).cells
    assert set(cells["se, surfaces"][cells["held by"] == "beam or tip"]) == {"–"}
    assert "–" not in set(cells["se, surfaces"][cells["held by"] == "beam"])


def test_warnings_are_numbered_in_the_cells_and_written_out_in_caption_and_csv(found):
    table = tables_devices.safe_lengths(found, WARNINGS, not_modelled="Not all.")
    assert table.caption.endswith("Not all. Warnings:\n\n- (1) surface B2: Too wet.\n- (2) surface B2: Too thin.")
    assert list(table.cells.warnings) == ["1"] * 2 + ["1, 2"] * 2 + [""] * 2 + ["2"] * 2 + [""] * 2
    assert "surface B2: Too wet. surface B2: Too thin." in table.csv


def test_a_table_without_warnings_does_not_speak_of_them(found):
    table = tables_devices.safe_lengths(found, dict.fromkeys(WARNINGS, []))
    assert "Warnings" not in table.caption


def test_the_risk_shows_shares_bands_and_safe_lengths_of_every_device(found):
    figure = figures_devices.simulated(found, WARNINGS)
    first, tip, second = figure.axes
    lines = [line for line in first.lines if len(line.get_xdata()) > 1]
    one = found["C1", 0.44].isel(shape=0)
    known = one.stuck.values > 0
    np.testing.assert_allclose(lines[0].get_ydata(), one.stuck.values[known])
    np.testing.assert_allclose(lines[0].get_xdata(), 1e6 * one.length.values[known])
    points = {
        (round(float(line.get_xdata()[0]), 6), float(line.get_ydata()[0]))
        for line in (*first.lines, *tip.lines)
        if len(line.get_xdata()) == 1
    }
    for dataset in (found["C1", 0.44], found["C1", 0.67]):
        for shape in dataset["shape"].values:
            for share in dataset.share.values:
                assert (round(1e6 * float(dataset.safe_length.sel(shape=shape, share=share)), 6), share) in points
    assert first.get_ylabel() == "P(stuck), simulated [–]"
    assert [len(panel.collections) for panel in figure.axes] == [2, 2, 1]
    assert [panel.get_title(loc="left") for panel in (first, tip)] == [
        "(a) C1, beam, only if its tip cannot touch",
        "(b) C1, beam or tip",
    ]
    assert second.get_ylabel() == ""
    assert [text.get_text() for text in first.get_legend().get_texts()] == ["RH 0.44 (1) (2)", "RH 0.67 (2)"]
    assert figure._supxlabel.get_text().startswith("(1)")
    # A humidity is a line, so that it cannot be taken for a safe length.
    assert {(line.get_linestyle(), line.get_marker()) for line in first.get_legend().get_lines()} == {("-", "None")}


def test_a_humidity_has_one_colour_in_all_panels(found):
    figure = figures_devices.simulated(
        {("C1", 0.44): found["C1", 0.44], ("C1", 0.67): found["C1", 0.67], ("R1", 0.67): found["C1", 0.67]}, {}
    )
    first, _, second, _ = ([line.get_color() for line in panel.get_legend().get_lines()] for panel in figure.axes)
    np.testing.assert_array_equal(first[1], second[0])
    assert not np.array_equal(first[0], first[1])


def looks(legend):
    """What the entries of a legend look like."""
    return [(str(line.get_color()), line.get_linestyle(), line.get_marker()) for line in legend.get_lines()]


def test_entries_of_a_legend_look_different(found):
    (legend,) = figures_devices.simulated(found, WARNINGS).legends
    assert len(set(looks(legend))) == len(looks(legend)) > 3
    assert "held by beam or tip / the middle" in [text.get_text() for text in legend.get_texts()]


def test_the_risk_can_be_read_at_the_length_of_the_device(found):
    own = safe_lengths.at_length(exactly(np.linspace(200e-6, 400e-6, 100)), 300e-6)
    figure = figures_devices.simulated({("C1", 0.44): found["C1", 0.44].assign(own)}, WARNINGS)
    *_, panel = figure.axes
    share = 100 * float(own["stuck_at_length"][1][-1, 0])
    assert panel.get_legend().get_texts()[0].get_text() == f"RH 0.44: {share:.3g} % at 300 µm (1) (2)"
    assert [300, 300] in [list(line.get_xdata()) for line in panel.lines if line.get_linestyle() == ":"]
    assert "length of the device" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert covering(figure) == []


def test_the_table_of_charts_has_every_length_and_where_it_is_from():
    table = tables_devices.chart(CHARTS, STEEP)
    assert len(table.frame) == 3 * 16
    assert len(table.cells) == 3 * 8
    chosen = (table.frame.thickness_um == 2) & (table.frame.gap_um == 20) & (table.frame.held_by == "beam or tip")
    rows = table.frame[chosen & (table.frame.share == 1e-3)]
    assert list(rows.relative_humidity) == [0.4, 0.5, 0.6]
    np.testing.assert_allclose(rows.safe_length_um, [214, 107, 53.5])
    assert list(rows["from"].unique()) == ["power law"]
    np.testing.assert_allclose(rows.power_law_error_percent, 0.4)
    np.testing.assert_allclose(rows.bound_um, 53)
    computed = table.frame[table.frame.thickness_um == 3]
    assert list(computed["from"].unique()) == ["finite elements"]
    assert computed.power_law_error_percent.isna().all()


def test_a_line_of_a_chart_has_all_shares_and_its_warnings():
    table = tables_devices.chart(CHARTS, STEEP)
    line = table.cells.iloc[3 * 3 + 1]  # fourth curve, second humidity
    assert dict(line) == {
        "device": "C1",
        "thickness [µm]": "2",
        "gap [µm]": "20",
        "held by": "beam or tip",
        "RH": "0.5",
        "p = 0.01 [µm]": "106.0",
        "p = 0.001 [µm]": "107.0",
        "from": "power law, ± 0.4 %",
        "bound [µm]": "53.0",
        "warnings": "1, 2",
    }
    assert table.caption.endswith("Warnings:\n\n- (1) surface B2: Too steep.\n- (2) surface B2: Too short.")
    assert "surface B2: Too steep. surface B2: Too short." in table.csv
    assert table.cells["from"].iloc[0] == "finite elements"


def charts():
    """Figure of the charts and its panels by gap [µm] and shape."""
    figure = figures_devices.chart(CHARTS, STEEP)
    return figure, dict(zip(product((10, 20), (EITHER, S_SHAPE)), figure.axes, strict=True))


def test_the_chart_shows_the_middle_share_of_every_thickness_gap_and_shape():
    figure, panels = charts()
    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        "(a) C1, gap 10 µm, beam or tip",
        "(b) C1, gap 10 µm, beam, only if its\ntip cannot touch",
        "(c) C1, gap 20 µm, beam or tip",
        "(d) C1, gap 20 µm, beam, only if its\ntip cannot touch",
    ]
    for shape, length in ((S_SHAPE, 105), (EITHER, 107)):  # p = 0.001, thin, wide gap
        curve = next(line for line in panels[20, shape].lines if len(line.get_xdata()) == 3)
        np.testing.assert_allclose(curve.get_xdata(), [0.4, 0.5, 0.6])
        np.testing.assert_allclose(curve.get_ydata(), np.array([2, 1, 0.5]) * length)


def answer_in(builds, build=80e-6, forbidden=()):
    """Answer for C1 with sizes to build alone in some airs. The last of these decides."""
    known = {"share": 1e-3, "unit": "m", "build": build, "exact": build, "size": build, "forbidden": forbidden}
    steps = (Step(Cause.ESTIMATE, build, 1.0, list(builds)[-1], "S-shape", "safe_lengths"),)
    dries = Unasked("collapse_water", "longest beam that does not collapse while water dries", 70e-6)
    airs = tuple(AnswerInAir(humidity, size, np.nan, None) for humidity, size in builds.items())
    return Answer("C1", "cantilever", steps=steps, airs=airs, unasked=(dries,), **known)


WHOLE = "to build C1: 80 µm, but 70 µm if water dries on it"


def diamonds(panel):
    """Places of the sizes to build in a panel, by whether they are of an air alone."""
    marks = [line for line in panel.lines if line.get_marker() == "D" and len(line.get_xdata())]
    return {
        alone: [tuple(mark.get_xydata()[0]) for mark in marks if (mark.get_label() != WHOLE) == alone]
        for alone in (False, True)
    }


@pytest.mark.parametrize(("gap", "forbidden"), [(20e-6, ()), (20e-6, ("gap",)), (15e-6, ())])
def test_the_sizes_to_build_are_in_the_panel_of_the_own_gap_and_of_all_that_holds_the_device(gap, forbidden):
    answer = answer_in({0.4: 90e-6, 0.6: np.nan, 0.5: 81e-6}, forbidden=forbidden)
    panels = figures_devices.chart(CHARTS, STEEP, {"C1": (2e-6, gap, answer)}).axes
    marked = {panel.get_title(loc="left"): found for panel in panels if any((found := diamonds(panel)).values())}
    shown = {
        "(c) C1, gap 20 µm, beam or tip: build\ndiamonds": {
            False: [(0.5, pytest.approx(80))],
            True: [(0.4, pytest.approx(90))],
        }
    }
    assert marked == (shown if gap == 20e-6 and not forbidden else {})


@pytest.mark.parametrize(("thickness", "limits"), [(2e-6, [214, 107]), (3e-6, [230, 115]), (2.5e-6, [])])
def test_a_line_leads_to_a_size_to_build_from_the_limit_of_the_own_thickness(thickness, limits):
    answer = answer_in({0.4: 90e-6, 0.5: 81e-6})
    panel = figures_devices.chart(CHARTS, STEEP, {"C1": (thickness, 20e-6, answer)}).axes[2]
    lines = [line.get_xydata() for line in panel.lines if line.get_label() == FROM_LIMIT]
    expected = [[(rh, size), (rh, top)] for rh, size, top in zip((0.4, 0.5), (90, 80), limits, strict=False)]
    assert len(lines) == len(limits)
    np.testing.assert_allclose(lines, np.reshape(expected, np.shape(lines)))
    numbers = [" ".join(text.get_text().split()) for text in sizes_in(panel)]
    assert numbers == ["C1: 90", "C1: 80, but 70 µm if water dries on it"]
    thick = [line for line in panel.lines if line.get_linewidth() == 2 and len(line.get_xdata()) > 2]
    own, hung = (
        {to_hex(line.get_color()) for line in drawn}
        for drawn in (thick, [line for line in panel.lines if line.get_label() == FROM_LIMIT])
    )
    assert own == hung, "a mark hangs from the curve of its own thickness"
    assert len(own) == len(limits[:1])


FROM_LIMIT = "from the curve of C1 down to its size to build"


def sizes_in(panel):
    """Words on sizes to build in a panel."""
    return [text for text in panel.texts if to_hex(text.get_color()) == BUILD.lower()]


def crossed(panel, text):
    """Number of lines of a panel that run through a text."""
    box, count = text.get_window_extent(), 0
    for line in (line for line in panel.lines if len(line.get_xdata())):
        points = line.get_transform().transform(line.get_xydata())
        fine = np.concatenate(
            [np.linspace(one, other, 200) for one, other in zip(points, points[1:], strict=False)] or [points]
        )
        count += bool(box.count_contains(fine))
    return count


@pytest.mark.parametrize("sizes", [(100e-6, 95e-6), (160e-6, 60e-6), (199e-6, 106e-6)])
def test_words_on_a_size_to_build_are_on_no_line_and_beside_its_own(sizes):
    answer = answer_in({0.4: sizes[0], 0.5: sizes[1]}, build=sizes[1])
    panel = figures_devices.chart(CHARTS, STEEP, {"C1": (2e-6, 20e-6, answer)}).axes[2]
    for text, at, size, limit in zip(sizes_in(panel), (0.4, 0.5), sizes, (214, 107), strict=True):
        assert crossed(panel, text) == 0
        box = text.get_window_extent().transformed(panel.transData.inverted())
        apart = np.abs(text.get_window_extent().intervalx - panel.transData.transform((at, size))[0])
        assert 72 * apart.min() / panel.figure.dpi == pytest.approx(5, abs=1), "points"
        poles = [line.get_ydata() for line in panel.lines if line.get_linewidth() < 0.7 and line.get_xdata()[0] == at]
        poles = [pole for pole in poles if pole[0] == pytest.approx(limit)]
        assert len(poles) == (box.y0 > limit), "a pole leads up to words above the limit"
        assert poles or 1e6 * size < (box.y0 + box.y1) / 2 < limit or box.y1 < 1e6 * size
    text.set(position=(0, 0), ha="center", va="center")
    text.xy = 0.45, np.interp(0.45, (0.4, 0.5), (214, 107))
    assert crossed(panel, text), "a control"


def test_words_on_a_size_to_build_are_below_it_where_nothing_is_clear():
    figure = figures_devices.chart(CHARTS, STEEP)
    panel = figure.axes[2]
    for length in np.linspace(*panel.get_ylim(), 200):
        panel.axhline(length)
    figures_devices._name_size(panel, "90", 0.5, (90, 107))
    (text,) = sizes_in(panel)
    box = text.get_window_extent().transformed(panel.transData.inverted())
    assert box.y1 < 90
    assert not [line for line in panel.lines if to_hex(line.get_color()) == BUILD.lower()], "no pole"


def test_the_size_to_build_is_named_with_the_stricter_ones_below_the_panels():
    figure = figures_devices.chart(CHARTS, STEEP, {"C1": (2e-6, 20e-6, answer_in({0.4: 90e-6, 0.5: 81e-6}))})
    alone = "to build C1 in this air alone, " + WHOLE[WHOLE.index("but ") :]
    assert [WHOLE in named(figure), alone in named(figure)] == [True, True]
    single = figures_devices.chart(CHARTS, STEEP, {"C1": (2e-6, 20e-6, answer_in({0.5: 80e-6}))})
    assert not any("in this air alone" in text for text in named(single))
    assert covering(figure) == []


def test_words_say_that_more_stick_above_each_line():
    _, panels = charts()
    for panel in panels.values():
        assert "one touchdown" in panel.get_ylabel()
        assert len([text for text in panel.texts if text.get_text() == "above each line: more stick"]) == 1


NINE = {("C1", round(rh, 2)): charted(round(rh, 2), 2 - rh**2) for rh in np.linspace(0.4, 0.8, 9)}


def test_a_chart_at_enough_humidities_has_a_cubic_between_its_dots_with_its_error():
    figure = figures_devices.chart(NINE, {})
    panel = figure.axes[0]
    axis, lengths = np.array([rh for _, rh in NINE]), 100 * np.array([2 - rh**2 for _, rh in NINE])
    stated = f"± {100 * error_between(axis, lengths):.2g} %"
    dots = [line for line in panel.lines if line.get_marker() == "."]
    assert [len(line.get_xdata()) for line in dots[:2]] == [9, 9]
    assert sum(len(line.get_xdata()) == 200 for line in panel.lines) == 4  # lengths and bounds of two thicknesses
    assert "error between the dots" in named(figure)
    band = panel.collections[0].get_paths()[0].vertices
    ends = band[np.abs(band[:, 0] - 0.4) < 1e-9, 1]
    assert np.ptp(ends) / (ends.min() + ends.max()) == pytest.approx(error_between(axis, lengths))
    assert stated.removeprefix("± ") in tables_devices.chart(NINE, {case: [] for case in CURVES}).caption
    few = figures_devices.chart(CHARTS, STEEP)
    assert "error between the dots" not in named(few)
    assert "cubic" not in tables_devices.chart(CHARTS, STEEP).caption
    assert covering(few) == covering(figures_devices.chart(NINE, {})) == []


def test_a_ragged_curve_of_a_chart_has_a_band_as_wide_as_its_noise():
    ragged = {case: one.copy() for case, one in NINE.items()}
    for k, one in enumerate(ragged.values()):  # the first thickness alone
        one["safe_length"] = one.safe_length * xr.DataArray([1 + 0.05 * (-1) ** k, 1], dims="thickness")
    panel = figures_devices.chart(ragged, {}).axes[0]
    bands = [band.get_paths()[0].vertices for band in panel.collections]
    ends = [band[np.abs(band[:, 0] - 0.6) < 0.002, 1] for band in bands]
    widths = [np.ptp(lengths) / np.mean(lengths) for lengths in ends]
    assert len(bands) == 2
    assert 0.1 < widths[0] < 0.3  # twice the noise, and that of the neighbours
    assert widths[1] < 0.01
    assert not figures_devices.chart(CHARTS, STEEP).axes[0].collections, "too few humidities to know"


def test_the_axis_of_a_chart_is_that_of_its_own_lengths():
    found = {("C1", 0.5): charted(0.5).assign_coords(shape=[S_SHAPE, EITHER])}
    found["C1", 0.5]["safe_length"] = found["C1", 0.5].safe_length * xr.DataArray([10, 1], dims="shape")
    tip, alone, *_ = figures_devices.chart(found, STEEP).axes
    for panel, low, high in ((alone, 50, 1090), (tip, 51, 111)):  # limits of saturated air and longest curves
        bottom, top = panel.get_ylim()
        assert 0.9 * low < bottom < low
        assert high < top < 1.1 * high


@pytest.mark.parametrize("count", [1, 2, pytest.param(5, marks=pytest.mark.slow)])
def test_no_legend_covers_a_panel_a_text_or_another_legend(found, count):
    cases = {(f"C{k}", rh): found["C1", 0.44 if rh == 0.44 else 0.67] for k in range(count) for rh in (0.44, 0.67, 0.9)}
    bases = np.resize(["sampled", "fitted", "extrapolated"], found["C1", 0.44].basis.shape)
    cases = {case: one.assign(basis=one.basis.copy(data=bases)) for case, one in cases.items()}
    warned = dict.fromkeys(
        product(*map(dict.fromkeys, zip(*cases, strict=True)), (S_SHAPE, EITHER)), [noted("Too wet.")]
    )
    assert covering(figures_devices.simulated(cases, warned)) == []
    axes = {(f"C{k}", rh): charted(rh) for k in range(count) for rh in (0.4, 0.5)}
    assert covering(figures_devices.chart(axes, {})) == []


@pytest.mark.slow
def test_many_warnings_leave_the_panels_their_place_and_keep_their_numbers(found):
    dataset = found["C1", 0.44].sel(shape=[EITHER])
    cases = {(f"C{k}", rh): dataset for k in range(20) for rh in (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)}
    warned = {(*case, EITHER): [noted(f"{case} is too wet.")] for case in cases}
    figure = figures_devices.simulated(cases, warned)
    assert len(figure.axes) == 20
    assert figure._supxlabel.get_text() == "(1) to (120): note (either side)"
    assert figure.axes[0].get_legend().get_texts()[1].get_text() == "RH 0.5 (2)"
    assert "(2) surface B2: ('C0', 0.5) is too wet." in tables_devices.safe_lengths(cases, warned).caption
    assert figure.get_figheight() <= 24
    assert covering(figure) == []
    assert sum(panel.get_position().height for panel in figure.axes[::4]) > 0.5


def test_a_legend_within_a_panel_is_found(found):
    figure = figures_devices.simulated(found, WARNINGS)
    panel = figure.axes[0]
    panel.legend(handles=panel.get_legend().legend_handles, labels=["first", "second"], loc="lower right")
    assert covering(figure) == ["first"]


def named(figure):
    """Entries of the legend below a figure."""
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()]


def beside(panel):
    """Names of the curves beside a panel, from below."""
    outside = [text for text in panel.texts if text.xycoords == "axes fraction" and "thick" in text.get_text()]
    return [text.get_text() for text in sorted(outside, key=lambda text: text.xy[1])]


def test_flat_surfaces_are_named_at_the_first_point_of_the_longest_ones_unless_it_is_not_known():
    name = next(text for text in charts()[1][20, S_SHAPE].texts if text.get_text() == "flat surfaces")
    assert name.xy == pytest.approx((0.4, 56))
    unknown = {case: one.assign(flooded_length=one.flooded_length * np.nan) for case, one in NINE.items()}
    assert not any(text.get_text() == "flat surfaces" for text in figures_devices.chart(unknown, {}).axes[0].texts)


def test_the_chart_shows_the_limit_of_saturated_air_of_its_shape():
    for shape, limits in ((S_SHAPE, [52, 56]), (EITHER, [53, 57])):
        panel = charts()[1][20, shape]
        dotted = (line for line in panel.lines if line.get_linestyle() in (":", "-.") and len(line.get_xdata()))
        shown = [float(line.get_ydata()[0]) for line in dotted]
        np.testing.assert_allclose(shown, limits)


def test_the_chart_marks_what_a_power_law_gave_and_how_far_it_errs():
    for (gap, shape), panel in charts()[1].items():
        marked = [line for line in panel.lines if line.get_marker() == "o" and len(line.get_xdata())]
        assert len(marked) == (gap == 20)
        assert ("by a power law, ± 0.4 %" in panel.get_legend_handles_labels()[1]) == (gap == 20)
        if marked:
            length = {S_SHAPE: 105, EITHER: 107}[shape]
            np.testing.assert_allclose(marked[0].get_ydata(), np.array([2, 1, 0.5]) * length)


def test_a_chart_explains_its_lines_once_below_all_panels():
    figure, panels = charts()
    assert named(figure) == [
        "1 in 1000 stick by beam or tip",
        "1 in 1000 stick by beam",
        "by a power law, ± 0.4 %",
        "axes of panels differ",
        "(1) to (2): note (either side)",
    ]
    assert all(panel.get_legend() is None for panel in panels.values())


def test_names_of_close_curves_are_apart_and_a_curve_without_a_length_has_none():
    close = {case: one.copy() for case, one in NINE.items()}
    for one in close.values():
        one["safe_length"] = one.safe_length.isel(thickness=0, drop=True) * xr.DataArray([1, 1.001], dims="thickness")
    texts = figures_devices.chart(close, {}).axes[0].texts
    low, high = (text.xy[1] for text in texts if "thick" in text.get_text())
    assert high - low == pytest.approx(0.05)
    for one in close.values():
        one["safe_length"] = one.safe_length * xr.DataArray([1, np.nan], dims="thickness")
    assert beside(figures_devices.chart(close, {}).axes[0]) == ["2 µm thick"]


def test_the_chart_has_numbers_of_warnings_beside_the_thickness():
    figure, panels = charts()
    assert beside(panels[20, S_SHAPE]) == ["2 µm thick (1)", "3 µm thick"]
    assert beside(panels[20, EITHER]) == ["2 µm thick (1) (2)", "3 µm thick"]
    assert beside(panels[10, EITHER]) == ["2 µm thick", "3 µm thick"]
    assert named(figure)[-1] == "(1) to (2): note (either side)", "below the panels, also on a page"
    assert figure._supxlabel is None is figure._suptitle


@pytest.mark.slow
def test_equal_data_give_equal_files(found, tmp_path):
    for name in ("one", "two"):
        save(figures_devices.simulated(found, WARNINGS), tmp_path / f"{name}.png", tmp_path / f"{name}.pdf")
    for kind in ("png", "pdf"):
        assert (tmp_path / f"one.{kind}").read_bytes() == (tmp_path / f"two.{kind}").read_bytes()

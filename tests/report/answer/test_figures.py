"""The pictures of an answer show its numbers: curves, the size to build, and no number where one is forbidden."""

from dataclasses import replace

import numpy as np
import pytest
from legends import covering
from matplotlib.colors import to_rgb
from scipy.special import ndtr

from stiction.answer.data import Answer, AnswerInAir, Between, Cause, Step, Unasked
from stiction.report.answer import tables
from stiction.report.answer.figures import ladder, risk
from stiction.report.style import humidity_colour
from stiction.stages.life.answers import Name

SIZES = np.linspace(100e-6, 300e-6, 41)
DECIDES = "all airs; RH 0.92 decides"


def curve(median):
    """P(stuck) and its band of lognormal lengths."""
    return np.array([ndtr(np.log(SIZES / median) / 0.1 + shift) for shift in (0, -0.5, 0.5)])


def answered(**changed):
    airs = tuple(AnswerInAir(rh, np.nan, np.nan, None, curve(m)) for rh, m in ((0.44, 260e-6), (0.92, 200e-6)))
    sizes = {Cause.ESTIMATE: 160e-6, Cause.SIMULATION: 155e-6, Cause.INPUTS: 140e-6}
    steps = tuple(Step(cause, size, 0.9, 0.92, "S-shape", "safe_lengths") for cause, size in sizes.items())
    known = {"share": 1e-3, "unit": "m", "build": 140e-6, "exact": 155e-6, "size": 250e-6}
    return Answer("C1", "cantilever", steps=steps, airs=airs, sizes=SIZES, curve=curve(199e-6), **known | changed)


def lines_of(panel):
    """Curves of a panel by their label."""
    return {line.get_label(): line for line in panel.lines if len(line.get_xdata()) > 2}


def test_what_decides_is_in_full_colour_and_the_other_airs_are_dashed():
    answer = answered()
    (panel,) = risk({"C1": answer}).axes
    found = lines_of(panel)
    decides, other = found[DECIDES], found["RH 0.44 alone"]
    (mean,) = (line for line in panel.lines if line.get_linewidth() < 1 and len(line.get_xdata()) > 2)
    np.testing.assert_allclose(mean.get_xydata(), np.transpose([1e6 * SIZES, answer.curve[0]]))
    for line, air in ((decides, answer.together), (other, answer.airs[0])):
        sizes, bound = answer.at_most(air)
        is_shown, lowest = np.isfinite(line.get_ydata()), bound == bound.min()
        np.testing.assert_allclose(line.get_xdata(), 1e6 * sizes)
        np.testing.assert_allclose(line.get_ydata()[is_shown], bound[is_shown])
        assert np.all(is_shown | lowest)
        assert (is_shown & lowest).sum() == 1
    assert len(found) == 3, "the air that decides is the curve of all"
    assert mean.get_color() == decides.get_color()
    for line, humidity in ((decides, 0.92), (other, 0.44)):
        assert to_rgb(line.get_color()) == humidity_colour(humidity)[:3]
    assert (other.get_linestyle(), decides.get_linestyle()) == ("--", "-")
    three = replace(answer, airs=(*answer.airs, replace(answer.airs[0], humidity=0.67)))
    dashes = [line._unscaled_dash_pattern for line in risk({"C1": three}).axes[0].lines if "alone" in line.get_label()]
    assert len(dashes) == 2
    assert dashes[0] != dashes[1], "two airs alone are told apart without their colours"
    assert other.get_linewidth() < decides.get_linewidth()
    assert panel.get_yscale() == "log"
    assert panel.get_title(loc="left") == "C1, cantilever"


def test_a_bound_that_stays_level_at_safer_sizes_ends_where_it_begins_to():
    """A level line would say that as many stick at all of them."""
    answer = replace(answered(), curve=np.array([[0.5] * len(SIZES)] * 3), build=1.001 * SIZES[3], share=1e-3)
    (panel,) = risk({"C1": answer}).axes
    thick = lines_of(panel)[DECIDES]
    sizes, bound = answer.at_most(answer.together)
    assert (bound == 1e-3).sum() > 3, "control: the bound is level at all safer sizes"
    is_shown = np.isfinite(thick.get_ydata())
    assert sizes[is_shown].min() == answer.build
    np.testing.assert_allclose(thick.get_ydata()[is_shown], bound[sizes >= answer.build])


def test_the_simulated_limit_and_the_size_to_build_are_lines_and_the_latter_is_stated():
    (panel,) = risk({"C1": answered()}).axes
    assert not panel.patches, "no colour mixes with that of the band"
    lines = {line.get_label(): line for line in panel.lines}
    names = "limit by simulation, exact inputs", "to build: thick line at allowed"
    limit, build = (lines[name] for name in names)
    assert [limit.get_xdata()[0], build.get_xdata()[0]] == pytest.approx([155, 140])
    assert [limit.get_linestyle(), build.get_linestyle()] == ["--", "-"]
    (said,) = (text for text in panel.texts if text.get_text() == "build 140 µm")
    assert said.get_ha() == "right", "a shorter beam sticks less: the curve is on the other side"
    upright = [line.get_xdata()[0] for line in panel.lines if len(set(line.get_xdata())) == 1]
    assert sorted(upright) == pytest.approx([140, 155, 250]), "to build, by simulation, and stated"


def at(line, size):
    """Value of a curve where it has a size [µm]."""
    return dict(line.get_xydata().round(9).tolist())[size]


@pytest.mark.parametrize(
    ("build", "seen"), [(140e-6, False), (151e-6, True), (171e-6, True)]
)  # none is seen to stick at the first; at the last the upper end of the band is far above
def test_the_thick_line_is_at_the_allowed_fraction_at_the_size_to_build(build, seen):
    drawn = answered(build=build)
    assert (np.interp(build, SIZES, drawn.curve[2]) > 2 * drawn.share) == seen
    for unit, sign in (("m", 1), ("N", -1)):
        sizes = SIZES[::sign]
        answer = replace(drawn, unit=unit, sizes=sizes)
        (panel,) = risk({"C1": answer}).axes
        line = lines_of(panel)[DECIDES]
        assert at(line, 1e6 * build) == answer.share
        safe = sign * line.get_xdata() <= sign * 1e6 * build + 1e-6
        assert line.get_ydata()[safe].max() == answer.share
        beyond = answer.curve[2][sign * sizes > sign * build]
        np.testing.assert_allclose(line.get_ydata()[~safe], beyond)
        mean = np.interp(1e6 * build, 1e6 * SIZES, answer.curve[0][::sign])
        assert mean != pytest.approx(answer.share, rel=0.1), "the control: the mean does not meet it"


def test_the_band_ends_where_the_simulation_no_longer_resolves_it():
    expected, low, high = curve(199e-6)
    floored = np.array([expected, low, np.maximum(high, 1e-3)])
    last = SIZES[np.argmax(high > 1e-3) - 1]  # next to the first size with a resolved end
    unknown = answered(build=np.nan)
    for drawn, first in ((replace(unknown, curve=floored), last), (unknown, SIZES[0])):
        (panel,) = risk({"C1": drawn}).axes
        (band,) = panel.collections
        assert band.get_paths()[0].vertices[:, 0].min() == pytest.approx(1e6 * first)


def test_legends_are_below_all_panels_and_name_what_is_drawn_once():
    figure = risk({"C1": answered(), "C2": answered(build=np.nan, size=np.nan)})
    (common,) = figure.legends
    assert [text.get_text() for text in common.get_texts()] == [
        "at most so many stick (95 %)",
        "mean over all cases",
        "limit by simulation, exact inputs",
        "to build: thick line at allowed",
        "stated size",
        "mean",
    ]
    for panel, band in zip(figure.axes, ([], ["its 95 % band"]), strict=True):
        airs = [text.get_text() for text in panel.get_legend().get_texts()]
        assert airs == ["RH 0.44 alone", DECIDES, *band]
        for drawn, shown in zip(panel.collections, panel.get_legend().legend_handles[2:], strict=True):
            np.testing.assert_array_equal(shown.get_facecolor(), drawn.get_facecolor()[0])


def test_stricter_sizes_are_marked_at_the_allowed_fraction_and_stated_in_the_title():
    between, dried = Between(0.8, 138e-6, 137e-6), Unasked(f"{Name.COLLAPSE}_water", "longest beam that stands", 90e-6)
    (panel,) = risk({"C1": answered(between=between, unasked=(dried,))}).axes
    (marks,) = (line for line in panel.lines if line.get_label() == "stricter sizes, in the titles")
    np.testing.assert_allclose(marks.get_xydata(), [[138, 1e-3], [90, 1e-3]])
    assert panel.get_xlim()[0] < 90 < 1e6 * SIZES[0], "the axis reaches them"
    assert panel.get_title(loc="left").splitlines() == [
        "C1, cantilever",
        "stricter: 138 µm between these airs",
        "(interpolated at RH\N{NO-BREAK SPACE}0.8: compute it)",
        "stricter: 90 µm if water dries on it",
    ]
    (without,) = risk({"C1": answered(between=Between(0.8, 140.4e-6, 140e-6))}).axes  # reads as the size to build
    assert not any(line.get_marker() == "v" for line in without.lines)


def test_the_ladder_which_has_no_titles_names_stricter_sizes_in_its_legend():
    dried = Unasked(f"{Name.COLLAPSE}_water", "longest beam that stands", 90e-6)
    for unasked, said in (((dried,), ["stricter: 90 µm if water dries on it"]), ((), [])):
        figure = ladder(answered(unasked=unasked))
        steps, stuck = figure.axes
        names = [text.get_text() for text in stuck.get_legend().get_texts()]
        assert [name for name in names if "stricter" in name] == said
        assert {"at most so many stick (95 %)", "limit by simulation, exact inputs"} < set(names)
        assert (steps.get_legend(), figure.legends, covering(figure)) == (None, [], []), "below its own panel"


def test_the_axis_of_a_force_begins_at_zero_and_fractions_are_in_words():
    force, length = risk({"S1": answered(unit="N"), "C1": answered()}).axes
    assert (force.get_xlim()[0], length.get_xlim()[0]) == pytest.approx((0, 1e6 * SIZES[0]))
    form = length.yaxis.get_major_formatter()
    assert (form(1), form(0.1), form(1e-3)) == ("all", "1 in 10", "1 in 1000")


def test_a_forbidden_number_is_not_drawn():
    (panel,) = risk({"C1": answered(forbidden=("gap",))}).axes
    assert not panel.lines
    assert [text.get_text() for text in panel.texts] == ["Do not rely on a number"]


def beside(panel):
    """Labels of the rows of a ladder."""
    return [" ".join(text.get_text().split()) for text in panel.get_yticklabels()]


@pytest.mark.parametrize(
    ("size", "said"), [(20e-6, ["← yours: 20 µm"]), (900e-6, ["yours: 900 µm →"]), (250e-6, []), (np.nan, [])]
)
def test_a_stated_size_beyond_the_steps_is_named_at_the_edge(size, said):
    panel = ladder(answered(size=size)).axes[0]
    assert [text.get_text() for text in panel.texts] == said
    dotted = [line.get_xdata()[0] for line in panel.lines if line.get_linestyle() == ":"]
    assert dotted == pytest.approx([1e6 * size] if size == 250e-6 else [])


def test_the_ladder_has_a_row_for_each_step_and_the_curve_beside_it():
    steps, stuck = ladder(answered()).axes
    assert beside(steps) == [
        "estimate 160 µm",
        "error of the simulation 155 µm (−10.0 %)",
        "uncertainty of the inputs: to build 140 µm (−10.0 %)",
    ]
    assert not steps.texts, "nothing lies on bars and lines"
    assert DECIDES in lines_of(stuck)


def test_a_step_that_is_not_stated_begins_at_the_size_to_build():
    whole = answered()
    fast = Step(Cause.FAST, 150e-6, 0.8, 0.92, "S-shape", "fast_strips", stated=False)
    steps = (*whole.steps[:2], fast, whole.steps[2])
    panel = ladder(replace(whole, steps=steps)).axes[0]
    assert beside(panel)[2:] == [
        "uncertainty of the inputs: to build 140 µm (−10.0 %)",
        "fast separation, as in a shock (not stated) 112 µm (−20.0 %)",
    ]
    bars = [line.get_xdata() for line in panel.lines if line.get_linewidth() == 5]
    np.testing.assert_allclose(bars[2:], [[155, 140], [140, 112]])


@pytest.mark.parametrize("known", [3, 1])
def test_the_ladder_has_the_known_steps_alone(known):
    whole = answered()
    steps = tuple(replace(step, size=step.size if k < known else np.nan) for k, step in enumerate(whole.steps))
    panel = ladder(replace(whole, steps=steps, build=np.nan if known < 3 else whole.build)).axes[0]
    assert len(beside(panel)) == known
    assert not any("nan" in text for text in beside(panel))
    assert len(tables.steps(replace(whole, steps=steps))) == known

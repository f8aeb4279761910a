"""Every length that a page calls safe is less the margin for the measurements: few drawn truths are shorter."""

import re

import numpy as np
import pytest
import xarray as xr
from answers import CANTILEVER, TIPS, budget_dataset, of_length, safe
from test_stage_life import OF

from stiction.report.devices import first_screen, life, own_length, sentences, tables
from stiction.stages.devices.budget import budget_of
from stiction.stages.devices.opening import EITHER, S_SHAPE
from stiction.stages.life.answers import layout
from stiction.stages.life.table import beam_answers

LENGTHS = {0.44: safe(longest=500e-6), 0.67: safe(longest=450e-6)}
SILENT = {("D", 0.67, shape): [] for shape in (S_SHAPE, EITHER)}
BUDGETS = {(0.67,): budget_dataset(4.0), (0.67, "tip"): budget_dataset(2.0, TIPS)}
TOTALS = {shape: budget_of(BUDGETS[key]).total for shape, key in ((S_SHAPE, (0.67,)), (EITHER, (0.67, "tip")))}


def with_total(budget, total):
    """Budget of another total."""
    return budget.assign(covariance=budget.covariance * (total / budget_of(budget).total) ** 2)


def named(text, pattern):
    """Numbers of a text after some words [µm]."""
    return [float(number) for number in re.findall(pattern, text)]


def printed(budgets):
    """Lengths that are called safe, at RH 0.67 if they are of one air, by their end state [µm]."""
    screen = first_screen.beam_screen(CANTILEVER, LENGTHS, budgets, [])
    said = sentences.safe_sentence(0.67, LENGTHS[0.67], budgets)
    (own,) = own_length.sentences({0.67: of_length(300e-6, longest=450e-6)}, budgets)
    row, answers = screen.cells.iloc[1], layout(beam_answers(LENGTHS, {}, OF), OF)
    shown = life.table({"D": life.less_margin(answers, sentences.length_to_build(LENGTHS, budgets)[1])}).frame
    left = sentences.parts_left(LENGTHS[0.67], budgets) if budgets else None
    beside = tables.safe_lengths({("D", 0.67): LENGTHS[0.67]}, SILENT, left=left).frame
    column = "to_build_um" if budgets else "safe_length_um"
    at = beside[beside.share == 1e-3].set_index("held_by")[column]
    return {
        EITHER: [
            *named(screen.answer, r"Safe up to (\d+) µm"),
            *named(sentences.build_sentence(LENGTHS, budgets), r"no longer than (\d+) µm"),
            *named(said, r"devices of up to (\d+) µm"),
            *named(own, r"; (\d+) µm are safe"),
            float(row["safe length [µm]"]),
            float(shown[shown.answer == "safe_length_0.67"].at_most.iloc[0]),
            at["beam or tip"],
        ],
        S_SHAPE: [
            *named(screen.points["What decides"], r"could not touch: (\d+) µm"),
            *named(said, r"this is true of up to (\d+) µm"),
            float(row["if the tip cannot touch [µm]"]),
            at["beam"],
        ],
    }


def test_every_length_that_is_called_safe_is_less_its_margin():
    exact, built = printed({}), printed(BUDGETS)
    assert [len(numbers) for numbers in built.values()] == [len(numbers) for numbers in exact.values()] == [7, 4]
    for shape, lengths in built.items():
        limit = 1e6 * float(LENGTHS[0.67].safe_length.sel(share=1e-3, shape=shape)) * np.exp(-2 * TOTALS[shape])
        assert np.all(np.array(lengths) <= limit + 0.5)
        assert np.all(np.array(exact[shape]) > limit + 0.5)


@pytest.mark.parametrize("shape", [S_SHAPE, EITHER])
def test_few_drawn_truths_are_shorter_than_what_is_printed(shape):
    # The second route: inputs as wrong as stated move the true safe length, on a logarithmic scale.
    budget = BUDGETS[(0.67,) if shape == S_SHAPE else (0.67, "tip")]
    errors = np.random.default_rng(5).multivariate_normal(np.zeros(budget.sizes["input"]), budget.covariance, 20_000)
    truth = 1e6 * float(LENGTHS[0.67].safe_length.sel(share=1e-3, shape=shape)) * np.exp(errors @ budget.slope.values)
    allowed = 0.0228 + 4 * np.sqrt(0.0228 / len(truth))
    assert max(np.mean(truth < length - 0.5) for length in printed(BUDGETS)[shape]) < allowed
    assert min(np.mean(truth < length - 0.5) for length in printed({})[shape]) > 0.4  # control: without a margin


def test_no_length_is_called_safe_where_the_measurements_leave_it_too_uncertain():
    wide = {key: with_total(one, 0.6) for key, one in BUDGETS.items()}
    said = sentences.safe_sentence(0.67, LENGTHS[0.67], wide)
    assert said.count("if the measurements were exact") == 2
    row = first_screen.beam_screen(CANTILEVER, LENGTHS, wide, []).cells.iloc[1]
    assert row["safe length [µm]"] == row["if the tip cannot touch [µm]"] == "–"
    answers = layout(beam_answers(LENGTHS, {}, OF), OF)
    kept = life.less_margin(answers, 0.6)
    xr.testing.assert_equal(kept.low, answers.low)
    assert str(kept.form.sel(answer="safe_length_0.67").values).endswith("; if measurements were exact")


def test_a_beam_is_never_longer_than_its_crack_allows_after_the_margin():
    # Cracks that are much less certain than tips decide, although tips hold shorter beams.
    key = (0.67,)
    wide = BUDGETS | {key: with_total(BUDGETS[key], 0.45)}
    least, total, built = sentences.length_to_build(LENGTHS, wide)
    alone = min(float(one.safe_length.sel(share=1e-3, shape=S_SHAPE)) for one in LENGTHS.values()) * np.exp(-0.9)
    np.testing.assert_allclose(built, min(alone, least * np.exp(-2 * TOTALS[EITHER])), rtol=1e-12)
    assert alone < least * np.exp(-2 * TOTALS[EITHER])
    np.testing.assert_allclose(least * np.exp(-2 * total), built, rtol=1e-12)

"""Devices on drawn surfaces end in an answer, or in sentences before the first job; draws that failed once."""

import pytest
from drawn_devices import drawn, outcome

#: Draws that are refused, in humid and in dry air.
REFUSED = [19, 84]
#: Laws with d_max < 0, strips longer than they allow, ground that differs by tens of lengths 1/a, no beam that sticks,
#: a chart of such beams, a budget of which nothing is known, and bridges that stick just within their reach. Number 2
#: holds in its own air, and not at a humidity that nobody stated.
ANSWERED = [1, 2, 3, 5, 51, 101, 102, 199]
#: Those that take least; the others are tests of the night.
BY_DAY = {101}


@pytest.mark.parametrize("number", REFUSED)
def test_what_the_model_does_not_hold_for_is_refused_in_one_sentence_before_the_first_job(number):
    found = outcome(drawn(number))
    assert found.startswith("refused ")
    assert found.count(", must ") == 1
    assert ("water and" in found) == (drawn(number).humidity != "dry")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    "number",
    [pytest.param(draw, marks=pytest.mark.slow if draw in BY_DAY else pytest.mark.nightly) for draw in ANSWERED],
)
def test_drawn_surfaces_end_in_an_answer(number):
    found = outcome(drawn(number))
    assert found.startswith("answer ")
    assert len(found) > len("answer ")

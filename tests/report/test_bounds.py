"""Every printed bound is rounded to its safe side: sizes to build, ends of bands, and bounds of a life."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.answer.data import Probability
from stiction.answer.sought import FORCE, LENGTH
from stiction.report.answer import words
from stiction.report.devices import life
from stiction.report.format import bounding, fraction_between, percent_bound, safe_size
from stiction.rounding import lower_to

FRACTIONS = st.floats(1e-4, 0.9999)
SIZES = st.floats(1e-8, 1e-2)
UNITS = LENGTH.shown, FORCE.shown
#: Relative error that a number has if it was computed in other units.
COMPUTED = 1e-8


def number(text):
    """First number of a text."""
    return float(text.split()[0].replace("\N{NO-BREAK SPACE}", ""))


@given(SIZES, SIZES)
def test_sizes_to_build_are_never_longer_or_weaker_than_computed(size, other):
    assert number(safe_size(size, LENGTH)) * 1e-6 <= size * (1 + COMPUTED)
    assert number(safe_size(size, FORCE)) * 1e-6 >= size * (1 - COMPUTED)
    assert number(safe_size(size, LENGTH)) * 1e-6 == pytest.approx(size, rel=1.01e-2)
    if size < other:
        assert number(safe_size(size, LENGTH)) <= number(safe_size(other, LENGTH))


@given(FRACTIONS)
def test_ends_of_bands_of_a_fraction_are_rounded_outwards(fraction):
    for digits in (2, 3):
        assert float(percent_bound(fraction, digits, up=True)) >= 100 * fraction * (1 - COMPUTED)
        assert float(percent_bound(fraction, digits, up=False)) <= 100 * fraction * (1 + COMPUTED)
    assert number(words.percent(fraction, "high")) >= 100 * fraction * (1 - COMPUTED)
    assert number(words.percent(fraction, "low")) <= 100 * fraction * (1 + COMPUTED)


@given(FRACTIONS)
def test_the_most_that_can_stick_is_said_in_words_and_tables(fraction):
    in_words = words.stuck_in_words(Probability(1e-9, 0.0, fraction, none_seen=True))
    for text in (in_words, fraction_between(0.0, fraction, " %")):
        if text.startswith("at most "):
            assert number(text.removeprefix("at most ")) >= 100 * fraction * (1 - COMPUTED)
        else:
            assert text == "0 to 100 %"


def test_rounding_to_the_nearest_would_be_found():
    """The control: what formats did is on the unsafe side for each of these."""
    assert float(f"{200.66:.0f}") > 200.66 >= float(bounding(200.66, 3, up=False)) == 200
    assert float(f"{142.41:.3g}") < 142.41 <= float(bounding(142.41, 3, up=True)) == 143
    assert float(f"{219.37:.1f}") > 219.37 >= float(lower_to(1)(219.37)) == 219.3
    assert words.percent(0.000994) == "0.099 %", "a mean"
    assert words.percent(0.000994, "high") == words.percent(0.000961, "high") == "0.1 %", "bounds"


@given(st.floats(1e-3, 1e6), st.floats(1, 10))
def test_bounds_of_a_life_are_rounded_outwards_and_sizes_to_their_safe_side(low, factor):
    least, most = (float(text.replace(" ", "")) for text in life.bounds_in_words(low, factor * low, "V"))
    if not np.isclose(factor, 1, rtol=1e-9):  # what is known exactly is rounded to the nearest
        assert least <= low * (1 + COMPUTED)
        assert most >= factor * low * (1 - COMPUTED)
    for bound, length, force in zip(
        (low, factor * low), *(life.bounds_in_words(low, factor * low, unit) for unit in UNITS), strict=True
    ):
        assert float(length.replace(" ", "")) <= bound * (1 + COMPUTED)
        assert float(force.replace(" ", "")) >= bound * (1 - COMPUTED)


@pytest.mark.parametrize("stated", [250.0, 20.0, 2.6, 0.1, 1500.0])
def test_what_is_stated_stays_in_any_unit(stated):
    for sought in (LENGTH, FORCE):
        assert number(safe_size(stated * 1e-6, sought)) == stated

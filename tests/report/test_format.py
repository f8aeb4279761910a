"""Numbers as text: digits by the error, no negative zero, no zero error."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.report import format as text


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (12.34, 0.5, "12.34 ± 0.50"),
        (1234.0, 30.0, "1234 ± 30"),
        (0.5, 0.0, "0.5 ± 0"),
        (2.0, 0.1, "2.00 ± 0.10"),
        (0.0012, 0.001, "0.0012 ± 0.0010"),
        (3.4, 0.0996, "3.40 ± 0.10"),
        (-0.04, 3.0, "0.0 ± 3.0"),
        (-0.04, 30.0, "0 ± 30"),
        (700.0, np.nan, "700 ± –"),
        (np.nan, 1.0, "–"),
    ],
)
def test_a_number_has_the_digits_that_its_error_allows(value, error, shown):
    assert text.with_error(value, error) == shown


@given(st.floats(-1e6, 1e6), st.floats(1e-9, 1e6))
def test_value_and_error_have_equal_decimals_and_are_close_to_the_numbers(value, error):
    number, shown_error = text.with_error(value, error, "+").split(" ± ")
    assert number[0] in "+-"
    assert len(number.partition(".")[2]) == len(shown_error.partition(".")[2])
    assert abs(float(number) - value) <= 0.5 * error + 1e-9 * abs(value)
    assert_allclose(float(shown_error), error, rtol=0.05)
    assert float(shown_error) > 0
    assert not re.fullmatch(r"-0\.?0*", number)


def test_units_and_factors_of_axes_are_inverse():
    units = [text.NM, text.UM]
    assert_allclose(np.multiply(units, [text.TO_NM, text.TO_UM]), 1)
    assert_allclose((text.TO_MPA, text.TO_GPA, text.TO_MJ), (1e-6, 1e-9, 1e3))

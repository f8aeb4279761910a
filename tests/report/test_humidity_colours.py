"""Colour of a humidity: by its value alone, never too faint, and told apart from its neighbours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib import colormaps

from stiction.report.style import humidity_colour, humidity_colours, shades

HUMIDITIES = st.floats(0, 1)


def luminance(colour):
    """Relative luminance of WCAG 2."""
    parts = np.asarray(colour[:3], float)
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(colour):
    """Contrast to white of WCAG 2."""
    return 1.05 / (luminance(colour) + 0.05)


@given(HUMIDITIES)
def test_the_colour_of_a_humidity_has_a_contrast_of_three_to_white(humidity):
    assert contrast(humidity_colour(humidity)) >= 3


def test_the_whole_scale_would_be_too_faint():
    assert contrast(colormaps["viridis_r"](0.0)) < 1.3
    assert contrast(shades(4)[0]) >= 3, "sizes and numbers have the darker part, too"


@given(st.lists(HUMIDITIES, min_size=1), HUMIDITIES)
def test_the_colour_of_a_humidity_does_not_depend_on_the_others(others, humidity):
    assert humidity_colours([*others, humidity])[humidity] == humidity_colour(humidity)


@given(HUMIDITIES, HUMIDITIES)
def test_more_humid_air_is_not_brighter(one, other):
    low, high = sorted((one, other))
    if low > 0:
        assert luminance(humidity_colour(high)) <= luminance(humidity_colour(low)) + 1e-6


@pytest.mark.parametrize(("one", "other"), [(0, 0.4), (0, 0.98), (0.44, 0.67), (0.67, 0.92), (0.9, 0.98)])
def test_airs_of_the_paper_and_dry_air_differ(one, other):
    assert np.abs(np.subtract(humidity_colour(one), humidity_colour(other))).max() > 0.06

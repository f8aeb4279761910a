"""Where a curve over the roughness meets what is required: closed forms, and scatter of curves with known errors."""

import numpy as np
import pytest
from scipy.stats import norm

from stiction.devices.roughness import LARGEST, crossings, margins, sufficient

AXIS = np.log(np.geomspace(1, 8, 8))


def dip(x):
    """Margin of a device that holds most at a roughness inside the range; zero at ln x = 0.5 and 1.5."""
    return (x - 0.5) * (x - 1.5) * (2 + np.sin(x))


def test_a_power_law_meets_what_is_required_where_its_closed_form_does():
    forces = 1e-3 * np.exp(-3 * AXIS)
    (found,) = crossings(AXIS, margins(forces, 3e-5, more_is_better=False), np.full(8, 0.03))
    np.testing.assert_allclose(found.coordinate, np.log(1e-3 / 3e-5) / 3, rtol=1e-9)
    np.testing.assert_allclose(found.error, 0.03 / 3, rtol=1e-9)


def test_both_sides_of_the_worst_roughness_are_found_within_the_error_of_the_cubic():
    exact = crossings(AXIS, dip(AXIS), np.zeros(8))
    assert [abs(one.coordinate - place) < 3 * one.error for one, place in zip(exact, (0.5, 1.5), strict=True)] == [
        True
    ] * 2
    assert max(one.error for one in exact) < 0.02
    ranges = sufficient(AXIS, dip(AXIS))
    np.testing.assert_allclose(ranges, [(0, exact[0].coordinate), (exact[1].coordinate, AXIS[-1])])


@pytest.mark.parametrize("margin", [0.1 + AXIS, -0.1 - AXIS])
def test_a_curve_on_one_side_has_no_crossing_and_suffices_everywhere_or_nowhere(margin):
    assert crossings(AXIS, margin, np.full(8, 0.1)) == []
    assert sufficient(AXIS, margin) == ([(0.0, AXIS[-1])] if margin[0] > 0 else [])


def test_a_curve_that_touches_what_is_required_does_not_cross_it():
    margin = np.abs(AXIS - AXIS[3])
    assert crossings(AXIS, margin, np.full(8, 0.1)) == []
    assert sufficient(AXIS, margin)[0][0] == 0.0


def test_where_nothing_sticks_only_the_computed_points_are_sure():
    axis, margin = np.arange(5.0), np.array([-0.5, -0.4, LARGEST, LARGEST, 0.5])
    ((low, high),) = sufficient(axis, margin)
    assert (round(low, 4), high) == (2, 4)
    (crossing,) = crossings(axis, margin, np.full(5, 0.01))
    assert 1 < crossing.coordinate < 2
    assert crossing.error > 1 / np.sqrt(12)
    ((low, _),) = sufficient(axis, np.minimum(margin, 0.5))  # control: known margins
    assert 1 < low < 1.9
    (crossing,) = crossings(axis, np.minimum(margin, 0.5), np.full(5, 0.01))
    assert crossing.error < 0.2


def test_nothing_is_said_between_points_that_are_not_known():
    margin = np.where(np.arange(8) == 3, np.nan, AXIS - AXIS[3])
    assert crossings(AXIS, margin, np.full(8, 0.1)) == []
    assert sufficient(AXIS, margin) == [(AXIS[4], AXIS[-1])]
    alone = np.where(np.arange(8) == 5, 1.0, np.nan)
    assert crossings(AXIS, alone, alone) == sufficient(AXIS, alone) == []


def test_more_length_and_less_force_suffice_and_what_sticks_nowhere_suffices_most():
    assert margins(np.array([2.0]), 1.0, more_is_better=True) == np.log(2)
    assert margins(np.array([2.0]), 1.0, more_is_better=False) == -np.log(2)
    np.testing.assert_array_equal(margins(np.array([np.inf, np.nan]), 1.0, more_is_better=True), [LARGEST, np.nan])
    np.testing.assert_array_equal(margins(np.array([0.0]), 1.0, more_is_better=False), [LARGEST])


def test_crossings_of_curves_with_common_random_numbers_scatter_as_their_errors_say():
    rng, deviation, number = np.random.default_rng(3), 0.1, 400
    found = [
        crossings(AXIS, 1 - AXIS + deviation * rng.standard_normal(), np.full(8, deviation)) for _ in range(number)
    ]
    places = np.array([one.coordinate for (one,) in found])
    assert abs(places.mean() - 1) < 4 * deviation / np.sqrt(number)
    coverage = np.mean(np.abs(places - 1) < np.array([one.error for (one,) in found]))
    expected, error = 2 * norm.cdf(1) - 1, np.sqrt(0.68 * 0.32 / number)
    assert abs(coverage - expected) < 4 * error
    halved = np.mean(np.abs(places - 1) < 0.5 * np.array([one.error for (one,) in found]))
    assert abs(halved - expected) > 4 * error

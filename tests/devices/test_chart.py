from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, scattered_laws
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.energy import arrest_length
from stiction.beam.release import released_beam
from stiction.devices import chart, risk

GRID = np.array([(t, h) for t in (1e-6, 3e-6, 6e-6) for h in (1e-6, 10e-6, 40e-6)]).T


def eq_13(thickness, gap):
    return np.array(
        [arrest_length(E_BAR, replace(PAPER, thickness=t, gap=h)) for t, h in zip(thickness, gap, strict=True)]
    )


def test_uniform_ground_has_the_powers_of_eq_13():
    law = chart.fit_power_law(*GRID, eq_13(*GRID))
    assert_allclose([law.thickness_power, law.gap_power], [3 / 4, 1 / 2], rtol=1e-12)
    between = np.array([2e-6, 4.5e-6]), np.array([3e-6, 25e-6])
    assert_allclose(law(*between), eq_13(*between), rtol=1e-10)


def test_a_length_that_is_no_power_law_is_refused():
    bent = eq_13(*GRID) * (1 + 0.05 * (GRID[0] == 3e-6))
    with pytest.raises(ValueError, match=r"errs by [34]\.\d% .* more than 1%"):
        chart.checked_power_law(*GRID, bent, GRID[0] == 3e-6)


def test_the_error_is_the_largest_of_the_beams_that_were_left_out():
    law = chart.fit_power_law(*GRID, eq_13(*GRID))
    wrong = eq_13(*GRID)
    wrong[4] /= 1.007
    assert_allclose(chart.largest_error(law, *GRID, wrong), 0.007, rtol=1e-6)


def test_a_dimension_that_does_not_vary_has_no_power_and_no_other_value():
    thickness, gap = np.array([1e-6, 2e-6, 4e-6]), np.full(3, 20e-6)
    law = chart.fit_power_law(thickness, gap, eq_13(thickness, gap))
    assert law.gap_power == 0
    assert_allclose(law(3e-6, 20e-6), eq_13([3e-6], [20e-6])[0], rtol=1e-10)
    with pytest.raises(ValueError, match="gap of 2.1e-05 m is outside of the computed 2e-05 to 2e-05 m"):
        law(2e-6, 21e-6)


@pytest.mark.parametrize(("thickness", "gap"), [(0.9e-6, 10e-6), (6.1e-6, 10e-6), (2e-6, 0.9e-6), (2e-6, 41e-6)])
def test_a_power_law_is_not_extrapolated(thickness, gap):
    with pytest.raises(ValueError, match="is outside of the computed"):
        chart.fit_power_law(*GRID, eq_13(*GRID))(thickness, gap)


def test_beams_that_vary_together_do_not_determine_a_power_law():
    size = np.array([1.0, 2.0, 4.0])
    with pytest.raises(ValueError, match="3 beams do not determine"):
        chart.fit_power_law(size, size, size)


def test_a_power_law_between_beams_on_rough_ground_predicts_those_that_were_left_out():
    # The same ground for all beams; thickness and gap vary, and the powers differ from those of Eq. (13).
    grounds = [scattered_laws(np.random.default_rng(k), 800, 0.24) for k in range(12)]
    dimensions = np.array([(t, h) for t in (2e-6, 2.6e-6, 3.4e-6) for h in (10e-6, 20e-6, 40e-6)])
    lengths = []
    for t, h in dimensions:
        beam = replace(PAPER, length=1600e-6, elements=400, thickness=t, gap=h)
        beam = replace(beam, length=2.2 * arrest_length(E_BAR, beam))
        ends = [released_beam(beam, laws) for laws in grounds]
        lengths.append(np.mean([end.crack_length for end in ends]))
    middle = np.all(dimensions == [2.6e-6, 20e-6], axis=1)
    law, error = chart.checked_power_law(*dimensions.T, np.array(lengths), middle)
    assert 0 < error < chart.ALLOWED
    assert_allclose([law.thickness_power, law.gap_power], [0.75, 0.5], atol=0.06)


# Between humidities

AXIS = np.linspace(0.44, 0.95, 9)
FINE = np.linspace(0.44, 0.95, 400)
CURVES = {
    "saturated": lambda rh: 7e-4 * (1 - rh) ** 0.25,
    "bent": lambda rh: 1e-3 - 6e-4 * (rh - 0.7) ** 2,
    "wave": lambda rh: 6e-4 * np.exp(0.1 * np.sin(6 * rh)),
}


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)
def test_the_stated_error_between_humidities_is_at_least_the_true_one_and_below_that_of_lines(curve):
    true, lengths = curve(FINE), curve(AXIS)
    error = np.max(np.abs(chart.between(AXIS, lengths, FINE) / true - 1))
    stated = chart.error_between(AXIS, lengths)
    assert error < stated < 0.03
    assert np.max(np.abs(np.interp(FINE, AXIS, lengths) / true - 1)) > error  # control


def test_between_humidities_lengths_stay_between_those_of_their_neighbours_and_pass_through_them():
    lengths = 6e-4 * np.array([1.0, 1.0, 0.9, 0.3, 0.3, 0.35, 0.2, 0.1, 0.1])
    assert_allclose(chart.between(AXIS, lengths, AXIS), lengths, rtol=1e-12)
    found, cell = chart.between(AXIS, lengths, FINE), np.clip(np.searchsorted(AXIS, FINE) - 1, 0, 7)
    ends = np.sort([lengths[cell], lengths[cell + 1]], axis=0)
    assert np.all((found >= ends[0] * (1 - 1e-9)) & (found <= ends[1] * (1 + 1e-9)))


def test_a_jump_between_humidities_is_stated_and_few_humidities_have_no_error():
    lengths = np.where(AXIS < 0.7, 6e-4, 3e-4)
    assert chart.error_between(AXIS, lengths) > 0.3
    assert np.isnan(chart.error_between(AXIS[:4], lengths[:4]))
    assert np.isnan(chart.error_between(AXIS, np.append(lengths[:8], np.inf)))


@pytest.mark.parametrize("number", [5, 6, 9, 10])
def test_both_ends_are_kept_by_the_check_whatever_the_number_of_humidities(number):
    axis = np.linspace(0.4, 0.9, number)
    assert chart.error_between(axis, np.exp(axis)) < 1e-3


# Sizes between humidities


def test_all_sizes_are_computed_at_the_driest_the_middle_and_the_wettest_humidity():
    assert chart.of_sizes(list(AXIS)) == [AXIS[0], AXIS[4], AXIS[8]]
    assert chart.of_sizes([0.4, 0.5]) == [0.4, 0.5]
    assert chart.of_sizes([0.4]) == [0.4]


#: Power of the thickness against humidity: 0.75 to 0.81 on the paper's pair b.
POWERS = {
    "saturated": lambda rh: 0.75 + 0.06 * np.exp(-6 * (rh - 0.44)),
    "bent": lambda rh: 0.81 - 0.06 * ((rh - 0.44) / 0.51) ** 2,
    "peak": lambda rh: 0.75 + 0.06 * np.exp(-(((rh - 0.7) / 0.2) ** 2)),
}


@pytest.mark.parametrize("power", POWERS.values(), ids=POWERS)
def test_ratios_of_sizes_between_humidities_err_by_less_than_stated_and_than_those_of_one_humidity(power):
    nodes, ratio = AXIS[[0, 4, 8]], np.log(4 / 2.6)
    found, stated = zip(*(chart.parabola(nodes, ratio * power(nodes), at) for at in FINE), strict=True)
    error = np.max(np.abs(found - ratio * power(FINE)))
    assert error < min(stated) < np.ptp(ratio * power(FINE))
    assert np.max(np.abs(ratio * (power(nodes[1]) - power(FINE)))) > 1.5 * error  # control: the power of one humidity
    assert_allclose([chart.parabola(nodes, ratio * power(nodes), at)[0] for at in nodes], ratio * power(nodes))


def test_a_line_has_no_error_wherever_its_middle_is():
    nodes = np.array([0.44, 0.5, 0.95])
    found, error = chart.parabola(nodes, 2 - 3 * nodes, 0.6)
    assert (found, error) == (pytest.approx(0.2), pytest.approx(0, abs=1e-12))


def test_a_jump_of_the_ratios_is_stated_and_what_is_not_known_remains_so():
    ratios = np.array([[0.0, 0.3, np.nan], [0.0, 0.3, 0.2], [0.0, 0.5, 0.2]])
    found, errors = chart.parabola(AXIS[[0, 4, 8]], ratios, 0.6)
    assert found[0] == errors[0] == 0
    assert errors[1] == pytest.approx(0.1)
    assert np.isnan([found[2], errors[2]]).all()


def drawn(median, scatter, power=1.0):
    """Lengths of 4000 beams whose logarithms are bent above their median [m]."""
    z = np.random.default_rng(3).standard_normal(4000)
    return median * np.exp(scatter * (z + 0.3 * np.maximum(z, 0) ** 2)) ** power


def test_lengths_follow_median_and_scatter_of_another_size_down_to_the_shortest():
    own, true = drawn(6e-4, 0.05), drawn(8e-4, 0.05, 0.8)
    spreads = [chart.spread_of(risk.quantiles(lengths), risk.SCORES) for lengths in (own, true)]
    found = chart.rescaled(own, spreads[0], spreads[1] - spreads[0])
    assert_allclose(found, true, rtol=2e-3)
    wrong = own * np.exp(spreads[1][0] - spreads[0][0])  # control: the median alone
    assert abs(wrong.min() / true.min() - 1) > 0.02


def test_lengths_beyond_the_simulation_remain_so_and_many_of_them_leave_no_spread():
    lengths = drawn(6e-4, 0.05)
    few, many = (np.where(lengths > np.quantile(lengths, at), np.inf, lengths) for at in (0.8, 0.4))
    spread = chart.spread_of(risk.quantiles(few), risk.SCORES)
    assert_allclose(spread, chart.spread_of(risk.quantiles(lengths), risk.SCORES))
    assert_array_equal(np.isinf(chart.rescaled(few, spread, np.array([0.2, 0.1]))), np.isinf(few))
    assert np.isnan(chart.spread_of(risk.quantiles(many), risk.SCORES)).all()

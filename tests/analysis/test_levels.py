"""Ratios by levels: populations with known ratios, coverage of the stated errors, and a plain choice that misses it."""

from dataclasses import replace

import numpy as np
import pytest

from stiction.analysis import levels
from stiction.analysis.levels import FINE, SUMMITS, by_levels, in_proportion, link, numbers, ratio_of_means

#: Scatter of ln e on summits, of full contact about it, and of grids of 20 and 30 nm about full contact, with the mean
#: ratio of each grid: pairs a at RH 0.45, b at 0.44 and c at 0.72, as 8 to 60 strips show them.
LIKE = {
    "a": (0.06, 0.044, {2: (0.007, 0.93), 3: (0.023, 0.80)}),
    "b": (0.50, 0.30, {2: (0.010, 0.98), 3: (0.028, 0.92)}),
    "c": (0.80, 0.27, {2: (0.30, 0.77), 3: (0.50, 0.50)}),
}


def drawn(pair, rng, size, power=1.0):
    """Values of strips like those of a pair by level, whose ratio of means is 0.7."""
    of_summits, scatter, grids = LIKE[pair]
    normal = rng.standard_normal((4, size))
    summits = np.exp(of_summits * normal[0])
    full = summits**power * np.exp(scatter * normal[1] - scatter**2 / 2)
    full *= 0.7 * np.exp((1 - power**2) * of_summits**2 / 2)
    coarse = {grid: full / ratio * np.exp(s * normal[grid]) for grid, (s, ratio) in grids.items()}
    return {SUMMITS: summits, FINE: full} | coarse


def reader(strips):
    """Values of strips by level and number."""
    return lambda level, k: strips[level][k]


def coverage(ratios):
    """Fractions of ratios within one and within two of their errors of the true ratio."""
    off = np.array([abs(each.ratio / 0.7 - 1) / each.error for each in ratios])
    return np.mean(off <= 1), np.mean(off <= 2)


@pytest.mark.parametrize(("pair", "target"), [("a", 0.02), ("b", 0.04)])
def test_errors_by_levels_hold_the_true_ratio_and_reach_the_target(pair, target):
    rng = np.random.default_rng(1)
    found = [by_levels(reader(drawn(pair, rng, 256)), (2, 3), target) for _ in range(100)]
    one, two = coverage(found)
    assert one >= 0.60
    assert two >= 0.92
    assert max(each.error for each in found) <= target
    assert np.median([each.strips[FINE] for each in found]) <= 16  # summits alone need 0.3² / 0.02² = 225


def test_the_plain_choice_of_the_luckiest_of_four_strips_misses_its_errors():
    rng, inside = np.random.default_rng(2), []
    for _ in range(1000):
        strips = {level: values[:4] for level, values in drawn("b", rng, 4).items()}
        plain = {
            grid: np.std(strips[FINE] / strips[grid] / np.mean(strips[FINE] / strips[grid]), ddof=1) for grid in (2, 3)
        }
        luckiest = min(plain, key=plain.get)
        ratio = strips[FINE].mean() / strips[luckiest].mean()
        inside.append(abs(ratio / LIKE["b"][2][luckiest][1] - 1) <= 2 * plain[luckiest] / 2)
    assert np.mean(inside) < 0.92  # 0.954 for a normal value


def test_strips_in_proportion_hold_the_true_ratio_where_grids_are_no_control():
    rng = np.random.default_rng(3)
    found = [ratio_of_means(reader(drawn("c", rng, 500)), (2, 3), 0.04, rng) for _ in range(100)]
    one, two = coverage(found)
    assert np.mean([each.chain == (FINE, SUMMITS) and each.strips[FINE] >= levels.FEWEST for each in found]) > 0.9
    assert one >= 0.60
    assert two >= 0.92


def test_errors_of_strips_in_proportion_have_those_of_a_small_pool(monkeypatch):
    monkeypatch.setattr(levels, "POOL", 40)
    rng = np.random.default_rng(12)
    found = [in_proportion(reader(drawn("c", rng, 40)), 0.0, rng) for _ in range(200)]
    assert coverage(found)[1] >= 0.88
    of_drawn = np.sqrt(1 + found[0].strips[FINE] / 40)  # many of few strips: their own errors are small
    assert coverage([replace(each, error=each.error / of_drawn) for each in found])[1] < 0.75


def test_strips_in_proportion_have_no_error_where_full_contact_is_proportional_to_summits():
    strips = drawn("b", np.random.default_rng(4), 500)
    strips[FINE] = 0.6 * strips[SUMMITS]
    found = in_proportion(reader(strips), 0.04, np.random.default_rng(5))
    assert found.ratio == pytest.approx(0.6, rel=1e-12)
    assert found.power == pytest.approx(1, rel=1e-9)
    assert found.strips[FINE] == levels.FEWEST


@pytest.mark.parametrize("power", [1.0, 1.3])
def test_the_power_is_that_of_the_population(power):
    rng = np.random.default_rng(6)
    of_summits, scatter, _ = LIKE["b"]
    true = np.hypot(power * of_summits, scatter) / of_summits
    found = [by_levels(reader(drawn("b", rng, 256, power)), (2, 3), 0.04) for _ in range(100)]
    off = np.array([(each.power - true) / each.power_error for each in found])
    assert abs(np.mean([each.power for each in found]) / true - 1) < 0.05
    assert np.mean(abs(off) <= 2) >= 0.85  # of 32 strips and more, whose errors themselves err


def test_the_numbers_of_strips_have_the_least_cost():
    """Brute force over all numbers that reach the target, of two links whose numbers are not bounded by the pilot."""
    chain, scatters, target = (FINE, 3, SUMMITS), np.array([0.1, 0.4]), 0.02
    found = numbers(chain, scatters, target)
    costs = levels.COSTS[FINE], levels.COSTS[3]
    least = min(
        costs[0] * fine + costs[1] * coarse
        for fine in range(4, 200)
        for coarse in range(fine, 3000)
        if scatters[0] ** 2 / fine + scatters[1] ** 2 / coarse <= target**2
    )
    assert costs[0] * found[FINE] + costs[1] * found[3] == pytest.approx(least, rel=0.01)


def test_few_strips_lean_on_what_is_believed():
    rng = np.random.default_rng(7)
    lower = np.exp(0.3 * rng.standard_normal(4))
    lucky = link(0.7 * lower, lower, 0.1)
    assert lucky.scatter == pytest.approx(0.1 * np.sqrt(4 / 7))
    assert lucky.freedom == 7


def test_a_grid_that_fails_on_a_strip_is_no_control():
    strips = drawn("b", np.random.default_rng(8), 256)
    strips[3][10] = np.nan
    found = by_levels(reader(strips), (2, 3), 0.04)
    assert 3 not in found.strips


def test_one_strip_with_all_of_the_scatter_has_it():
    strips = drawn("c", np.random.default_rng(9), 500)
    strips[FINE] = 0.7 * strips[SUMMITS]
    strips[FINE][np.argmax(strips[SUMMITS])] *= 0.2
    rng = np.random.default_rng(10)
    assert in_proportion(reader(strips), 0.04, rng).largest > 0.9
    assert in_proportion(reader(drawn("c", rng, 500)), 0.04, rng).largest < 1 / 3

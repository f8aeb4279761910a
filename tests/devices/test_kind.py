"""A further surface of the kind of a few whole surfaces: drawn truths are the second route."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm, t

from stiction.devices.budget import Budget, Kind, joined

#: Drawn kinds of m surfaces, each with one further surface as the truth.
KINDS, M = 2000, 4
LEVEL = 0.95
#: Share of normal numbers beyond two standard deviations.
BEYOND = norm.sf(2)


def drawn(rng, m=M):
    """Shifts of m surfaces and of a further one, of a normal kind with any mean and scatter."""
    mean, scatter = rng.normal(), rng.uniform(0.05, 2.0)
    shifts = rng.normal(mean, scatter, m + 1)
    return Kind(shifts[:m]), shifts[m]


@pytest.fixture(scope="module")
def truths():
    """Drawn kinds, each with its truth."""
    rng = np.random.default_rng(5)
    return [drawn(rng) for _ in range(KINDS)]


def covered(truths, half):
    """Share of the truths within a half width of the mean."""
    return np.mean([abs(truth - kind.mean) < half(kind) for kind, truth in truths])


def test_students_law_covers_drawn_further_surfaces_and_a_normal_one_with_the_same_scatter_does_not(truths):
    error = np.sqrt(LEVEL * (1 - LEVEL) / KINDS)
    law = t.ppf((1 + LEVEL) / 2, M - 1)
    assert abs(covered(truths, lambda kind: law * kind.scale) - LEVEL) < 4 * error
    assert covered(truths, lambda kind: norm.ppf((1 + LEVEL) / 2) * kind.scale) < LEVEL - 10 * error  # control


@pytest.mark.parametrize("m", [2, 3, 4, 9])
def test_draws_follow_the_law(m):
    kind = Kind(np.random.default_rng(m).normal(0.3, 0.2, m))
    scores = (kind.draws(np.random.default_rng(0), 20_000) - kind.mean) / kind.scale
    for level in (0.025, 0.3, 0.8, 0.975):
        assert abs(np.mean(scores < t.ppf(level, m - 1)) - level) < 4 * np.sqrt(level * (1 - level) / 20_000)
    assert_allclose(kind.scale, np.std(kind.shifts, ddof=1) * np.sqrt(1 + 1 / m), rtol=1e-12)


def test_equal_surfaces_have_no_scatter_and_one_is_no_kind():
    same = Kind(np.full(4, 0.3))
    assert same.scale == pytest.approx(0, abs=1e-12)
    assert_allclose(same.draws(np.random.default_rng(0), 5), 0.3, rtol=1e-9)
    assert budget_of(same).total == pytest.approx(0, abs=1e-8)
    assert budget_of(same).unsafe_total(np.zeros(4), 1) == pytest.approx(0.15)
    with pytest.raises(ValueError, match="two surfaces or more, got 1"):
        Kind(np.array([0.3]))


def budget_of(kind, name="Mine"):
    """Budget of surfaces of a kind alone."""
    names = tuple(f"{name}{k}" for k in range(len(kind.shifts)))
    return Budget(names, kind.shifts, Kind.weights(len(names)), (names,))


@pytest.mark.parametrize("side", [-1, 1])
def test_a_margin_covers_drawn_further_surfaces_as_it_covers_normal_inputs(truths, side):
    taken = [2 * budget_of(kind).unsafe_total(np.zeros(M), side) for kind, _ in truths]
    beyond = np.mean([side * truth > margin for (_, truth), margin in zip(truths, taken, strict=True) if margin > 0])
    assert beyond < BEYOND + 4 * np.sqrt(BEYOND / KINDS)
    normal = [2 * kind.scale + side * kind.mean for kind, _ in truths]
    assert np.mean([side * truth > one for (_, truth), one in zip(truths, normal, strict=True)]) > 2 * BEYOND  # control


@pytest.mark.parametrize("scales", [(0.3, 0.1), (0.1, 0.3), (0.2, 0.2)])
def test_independent_errors_of_a_kind_and_of_an_input_add_up_by_their_quantiles(scales):
    """Exact for normal errors; for Student's t with 3 degrees of freedom within 4 % of the quantile of drawn sums."""
    of_kind, of_input = scales
    shifts = np.array([-1.0, 0.0, 0.5, 1.5])
    kind = Kind(0.2 + of_kind * (shifts - shifts.mean()) / Kind(shifts).scale)
    both = joined([Budget(("gap",), np.array([-1.0]), np.array([[of_input**2]])), budget_of(kind)])
    rng = np.random.default_rng(3)
    sums = kind.draws(rng, 400_000) + of_input * rng.standard_normal(400_000)
    margin = 2 * both.unsafe_total(np.zeros(5), 1)
    assert margin - 0.2 == pytest.approx(np.quantile(sums, 1 - BEYOND) - 0.2, rel=0.04)
    assert both.total == pytest.approx(np.hypot(of_input, of_kind))


def test_surfaces_of_a_kind_are_one_input_for_effects_and_advice():
    kind, other = Kind(np.array([0.5, 0.0, 0.6, 0.4])), Kind(np.array([0.1, -0.1, 0.0]))
    both = joined([budget_of(kind), budget_of(other, "Other")])
    first, second = both.kinds
    assert_allclose([both.effect(first), both.effect(second)], [kind.scale, other.scale])
    assert_allclose(both.remaining(first), other.scale)
    assert both.remaining([*first, *second]) == 0
    assert_allclose(both.uncorrelated.total, both.total)  # control: independent weights would not
    assert Budget(both.names, both.slopes, both.covariance).uncorrelated.total > 1.2 * both.total


def test_a_kind_on_the_safe_side_lengthens_nothing():
    safe = budget_of(Kind(np.array([5.0, 5.1, 4.9])))
    assert safe.unsafe_total(np.zeros(3), -1) == 0
    assert safe.unsafe_total(np.zeros(3), 1) > 2.5

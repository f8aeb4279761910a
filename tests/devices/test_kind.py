"""Surfaces of a kind among the inputs of a budget: weights of their shifts. `test_unknowns` has their distribution."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.devices.budget import Budget, joined, weights_of_kind


def budget_of(shifts, name="Mine"):
    """Budget of surfaces of a kind alone, from their shifts."""
    names = tuple(f"{name}{k}" for k in range(len(shifts)))
    return Budget(names, np.array(shifts), weights_of_kind(len(names)), (names,))


def scale(shifts):
    """Scale of Student's t of a further surface."""
    return np.std(shifts, ddof=1) * np.sqrt(1 + 1 / len(shifts))


def test_weights_of_surfaces_have_the_scale_of_a_further_one():
    for m in (2, 3, 4, 9):
        shifts = np.random.default_rng(m).normal(0.3, 0.2, m)
        assert_allclose(budget_of(shifts).total, scale(shifts), rtol=1e-12)
        assert_allclose(weights_of_kind(m).sum(axis=0), 0, atol=1e-15)
    assert budget_of(np.full(4, 0.3)).total == pytest.approx(0, abs=1e-8)
    with pytest.raises(ValueError, match="two surfaces or more, got 1"):
        weights_of_kind(1)


def test_surfaces_of_a_kind_are_one_input_for_effects_and_advice():
    kind, other = [0.5, 0.0, 0.6, 0.4], [0.1, -0.1, 0.0]
    both = joined([budget_of(kind), budget_of(other, "Other")])
    first, second = both.kinds
    assert_allclose([both.effect(first), both.effect(second)], [scale(kind), scale(other)])
    assert_allclose(both.remaining(first), scale(other))
    assert both.remaining([*first, *second]) == 0
    assert_allclose(both.uncorrelated.total, both.total)  # control: independent weights would not
    assert Budget(both.names, both.slopes, both.covariance).uncorrelated.total > 1.2 * both.total

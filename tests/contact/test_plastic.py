"""Elements that yield: pressures up to the hardness, and flattening that remains."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stiction.contact.asperity import hertz_force, hertz_maximum_stress, reduced_modulus
from stiction.contact.full.elements import TOLERANCE, equilibrium
from stiction.contact.full.halfspace import HalfSpace

E, NM = reduced_modulus(164e9, 0.23), 1e-9
HARDNESS, RADIUS, SPACING, POINTS = 12.8e9, 100 * NM, 5 * NM, 60
SPACE = HalfSpace((POINTS, POINTS), SPACING, E, periodic=False)


@cache
def sphere():
    x = (np.arange(POINTS) - POINTS // 2) * SPACING
    return (-(x[:, None] ** 2 + x**2) / (2 * RADIUS)).astype(np.float32)


@cache
def pressed(overlap, hardness=HARDNESS):
    return equilibrium(SPACE, sphere(), -overlap, hardness=hardness)


def test_no_element_presses_with_more_than_the_hardness():
    state, elastic = pressed(10 * NM), pressed(10 * NM, np.inf)
    assert elastic.pressure.max() == pytest.approx(hertz_maximum_stress(10 * NM, RADIUS, E), rel=0.03)
    assert elastic.pressure.max() > 1.2 * HARDNESS
    assert state.pressure.max() == np.float32(HARDNESS)
    assert state.residual <= TOLERANCE
    assert state.force < elastic.force


def test_elements_overlap_only_at_the_hardness():
    state = pressed(10 * NM)
    yielding = state.pressure == np.float32(HARDNESS)
    assert 10 < yielding.sum() < np.sum(state.pressure > 0)
    assert np.all(state.gap[~yielding] >= -TOLERANCE)
    assert_array_equal(state.flattening > 0, yielding & (state.gap < 0))
    assert state.flattening.max() > 0.5 * NM


def test_an_infinite_hardness_is_elastic_contact_bit_for_bit():
    elastic = equilibrium(SPACE, sphere(), -10 * NM)
    for hardness in (np.inf, 1e30):
        state = pressed(10 * NM, hardness)
        assert_array_equal(state.pressure, elastic.pressure)
        assert_array_equal(state.gap, elastic.gap)
        assert not state.flattening.any()
    assert not np.array_equal(pressed(10 * NM).pressure, elastic.pressure)


def test_a_sphere_below_the_hardness_is_elastic():
    """Hertz at 2 nm: 7.8 GPa."""
    state = pressed(2 * NM)
    assert not state.flattening.any()
    assert state.force * (POINTS * SPACING) ** 2 == pytest.approx(hertz_force(2 * NM, RADIUS, E), rel=0.01)


def test_it_shakes_down_the_flattened_surface_carries_the_same_pressures_elastically():
    state = pressed(10 * NM)
    flat = sphere() - state.flattening
    for hardness in (HARDNESS, np.inf):
        second = equilibrium(SPACE, flat, -10 * NM, hardness=hardness)
        assert_allclose(second.pressure, state.pressure, atol=2e-3 * HARDNESS)
        assert second.flattening.max() < 0.01 * state.flattening.max()
    for overlap in (9 * NM, 8 * NM):  # the second approach is the first separation, and no longer the first approach
        again, first = (equilibrium(SPACE, z, -overlap, hardness=HARDNESS) for z in (flat, sphere()))
        elastic = equilibrium(SPACE, flat, -overlap)
        assert again.force == pytest.approx(elastic.force, rel=1e-3)
        assert again.force < 0.99 * first.force


def test_a_softer_solid_is_flattened_more():
    worn = [pressed(10 * NM, hardness).flattening.sum() for hardness in (9e9, HARDNESS, 15e9, 20e9)]
    assert np.all(np.diff(worn) < 0)
    assert worn[-1] == 0


def test_far_beyond_the_hardness_the_load_is_that_of_the_area_in_contact():
    state = pressed(10 * NM, 1e9)
    assert state.force == pytest.approx(1e9 * np.mean(state.pressure > 0), rel=0.1)

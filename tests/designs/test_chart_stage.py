from dataclasses import replace
from itertools import product
from unittest.mock import patch

import numpy as np
import pytest
from beams import E_BAR, PAPER
from ground import C1, R1, UM, VECTORS, WATER, settings
from numpy.testing import assert_allclose

from stiction.beam.energy import arrest_length
from stiction.chaos.model import Truncation
from stiction.designs import chart, cracks, safe_lengths
from stiction.devices.chart import ALLOWED
from stiction.stages import curves

SIZES = np.array(list(product([2e-6, 2.6e-6, 3e-6, 4e-6], [10e-6, 20e-6, 40e-6])))


def eq_13(size):
    return np.array([[arrest_length(E_BAR, replace(PAPER, thickness=size[0], gap=size[1]))]])


def test_where_lengths_are_a_power_law_only_corners_and_one_test_are_computed():
    asked = []
    lengths, computed, error = chart.filled(SIZES, lambda size: asked.append(tuple(size)) or eq_13(size))
    assert len(asked) == computed.sum() == 5
    assert_allclose(lengths, [eq_13(size) for size in SIZES], rtol=1e-9)
    assert lengths.shape == (12, 1, 1)
    assert error < 1e-9


def test_where_the_power_law_errs_all_beams_are_computed():
    def bent(size):
        return eq_13(size) * (1 + 0.04 * (2e-6 < size[0] < 4e-6))

    lengths, computed, error = chart.filled(SIZES, bent)
    assert computed.all()
    assert error == 0
    assert_allclose(lengths, [bent(size) for size in SIZES], rtol=1e-12)


def test_a_power_law_that_is_used_errs_by_the_largest_of_all_shapes_and_shares():
    def nearly(size):
        off = 2e-6 < size[0] < 4e-6
        return np.hstack([eq_13(size), eq_13(size) * (1 + 0.005 * off)])

    lengths, computed, error = chart.filled(SIZES, nearly)
    assert not computed.all()
    assert error == pytest.approx(0.005, rel=0.02)
    assert error <= ALLOWED
    assert_allclose(lengths[computed], [nearly(size) for size in SIZES[computed]], rtol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_sizes_are_all_computed(count):
    sizes = SIZES[::3][:count]
    lengths, computed, _ = chart.filled(sizes, eq_13)
    assert computed.all()
    assert_allclose(lengths, [eq_13(size) for size in sizes], rtol=1e-12)


def test_a_chart_has_the_safe_lengths_of_its_device_and_longer_ones_for_thicker_beams():
    wanted = chart.Settings(
        2021, Truncation(3, 0.001), WATER, 0.67, R1, 200, (1e-2,), 0.15e-6, (1.6 * UM, 2 * UM), (2 * UM,)
    )
    vectors, limit = VECTORS, 1.2 * VECTORS[:, 1].max()
    with patch.object(curves, "vectors", lambda *_: (vectors, limit)):
        found = chart.compute(None, None, wanted)
    model = cracks.fitted(vectors, limit, settings())
    address = cracks.addresses(settings())
    beam, points = cracks.long_beam(R1, cracks.draw_laws(model, cracks.LAWS, address("mesh")))
    lengths = cracks.crack_lengths(model, beam, points, 400, address)
    sticking = safe_lengths.sticking_lengths(lengths, 0.0, R1, None)
    (expected,) = safe_lengths.safe_lengths(sticking[safe_lengths.S_SHAPE], wanted)
    thin, thick = found.safe_length.values[:, 0, 0, 0]
    assert thick == expected.length
    assert thin < thick
    assert list(found["shape"]) == [safe_lengths.S_SHAPE]
    assert found.by_elements.values.tolist() == [[1], [1]]
    assert_allclose(found.flooded_length[1, 0], 2 * chart.flooded_length(R1.beam, 300.0), rtol=1e-12)
    assert float(found.humidity) == 0.67
    assert C1.pair == R1.pair

from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER
from numpy.testing import assert_allclose


def test_bending_stiffness_of_the_beam_of_the_paper_by_hand():
    assert_allclose(PAPER.bending_stiffness, 164e9 * 30e-6 * (2.6e-6) ** 3 / 12, rtol=1e-14)
    assert_allclose(PAPER.bending_stiffness, 7.206e-12, rtol=1e-3)  # N m²
    assert_allclose(PAPER.element_length, 7.5e-6, rtol=1e-14)  # App. C


@pytest.mark.parametrize("field", ["length", "width", "thickness", "young_modulus", "gap", "elements"])
@pytest.mark.parametrize("value", [0, -1, np.nan, np.inf])
def test_a_beam_has_positive_dimensions(field, value):
    with pytest.raises(ValueError, match=f"{field}.*{value}"):
        replace(PAPER, **{field: value})


def test_bending_decays_under_tension_with_the_root_of_tension_by_stiffness():
    beam = replace(PAPER, tension=1e-3)
    assert_allclose(beam.decay**2 * beam.bending_stiffness, 1e-3, rtol=1e-14)
    assert PAPER.decay == 0


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_compression_is_refused(value):
    with pytest.raises(ValueError, match=f"tension.*{value}"):
        replace(PAPER, tension=value)

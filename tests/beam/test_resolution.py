from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from numpy.testing import assert_allclose

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
from stiction.beam.release import released_beam
from stiction.beam.resolution import ALONG_SHORTEST, longest, resolved

LAW = uniform_laws(1)
LENGTH = foundation_length(PAPER, LAW)


def test_elements_are_the_fewest_that_the_laws_allow():
    for factor in (1, 2, 5):
        laws = uniform_laws(1, factor * E_BAR, factor * 2e6)
        beam = resolved(replace(PAPER, elements=2), 3000, laws)
        longest = ELEMENT * foundation_length(PAPER, laws)
        assert beam == replace(PAPER, elements=beam.elements)
        assert 3000 % beam.elements == 0
        coarser = max(n for n in range(1, beam.elements) if 3000 % n == 0)
        assert beam.element_length <= longest < PAPER.length / coarser


def test_a_beam_keeps_its_elements_if_they_are_short_enough():
    assert resolved(replace(PAPER, elements=500), 1000, LAW).elements == 500


def test_strips_that_are_far_too_long_are_refused_with_the_longest_allowed():
    weak, strong = (uniform_laws(1, factor * E_BAR, factor * 2e6) for factor in (1, 50))
    assert resolved(PAPER, 1000, weak).elements >= 200
    allowed = 1e6 * STRIP * foundation_length(PAPER, strong)
    with pytest.raises(ValueError, match=rf"strips of {2.1 * allowed:.3g} µm .* at most {allowed:.3g} µm"):
        resolved(replace(PAPER, length=2.1e-3 * allowed), 1000, strong)
    assert resolved(PAPER, round(1500 / allowed) + 1, strong).element_length <= ELEMENT / STRIP * allowed * 1e-6


@pytest.mark.parametrize("longer", [1.01, 1.5, 1.99])
def test_strips_that_are_too_long_have_an_element_each(longer):
    strip = longer * longest(PAPER, LAW)[0]
    assert resolved(replace(PAPER, length=1000 * strip), 1000, LAW).elements == 1000


def test_the_crack_from_which_a_beam_is_released_has_several_elements():
    # At a small gap the crack is short; only the number of elements along it bounds them.
    beam = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 0.3e-6, 2)
    found = resolved(beam, 3000, LAW)
    start = arrest_length(E_BAR, beam) / 3
    coarser = max(n for n in range(1, found.elements) if 3000 % n == 0)
    assert start / ALONG_SHORTEST < ELEMENT * LENGTH
    assert found.element_length <= start / ALONG_SHORTEST < beam.length / coarser
    end = released_beam(found, np.tile(LAW, (3000, 1)))
    assert_allclose(end.crack_length, arrest_length(E_BAR, beam), atol=LENGTH)


def test_a_weak_law_leaves_elements_no_longer_than_a_twelfth_of_the_beam():
    beam = resolved(replace(PAPER, elements=2), 1000, uniform_laws(1, 1e-9, 1.0))
    assert beam.element_length <= PAPER.length / 12

from dataclasses import replace

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from numpy.testing import assert_allclose

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.release import released_beam
from stiction.beam.resolution import ACCURACY, ALONG_START, ELEMENT, STRIP, foundation_length, resolved
from stiction.contact import forcelaw

LAW = uniform_laws(1)
LENGTH = foundation_length(PAPER, LAW)


def test_a_beam_on_springs_of_the_slope_of_eq_12_decays_within_the_foundation_length():
    f_max, d_max, a_left, _ = LAW[0]
    rest, step = d_max - np.log(2) / a_left, 1e-14
    slope = (forcelaw.pressure(LAW[0], rest - step) - forcelaw.pressure(LAW[0], rest + step)) / (2 * step)
    # EI u⁗ + k w u = 0 has the solutions exp(-x/l) cos(x/l) and exp(-x/l) sin(x/l) with (4 EI / k w)^(1/4) = l.
    rate = (-1 + 1j) / LENGTH
    assert_allclose(PAPER.bending_stiffness * rate**4, -slope * PAPER.width, rtol=1e-4)


def test_foundation_length_is_that_of_the_mean_stiffness():
    laws = LAW * np.array([[1], [15]]) ** np.array([1, 0, 0, 0])
    assert_allclose(foundation_length(PAPER, laws), LENGTH / 8**0.25, rtol=1e-12)


def crack(strip, element, beam=PAPER):
    """Crack length on uniform ground for strips and elements in foundation lengths."""
    elements = round(beam.length / (element * LENGTH))
    fitted = replace(beam, length=elements * element * LENGTH, elements=elements)
    laws = np.tile(LAW, (elements * round(element / strip), 1))
    return released_beam(fitted, laws, E_BAR).crack_length


def test_allowed_strips_and_elements_find_the_crack_to_one_per_cent_and_longer_ones_do_not():
    fine = crack(0.15, 0.3)
    assert_allclose(crack(0.075, 0.15), fine, rtol=ACCURACY / 20)
    for strip, parts in ((STRIP, 1), (STRIP, 2), (STRIP, 3), (ELEMENT / 4, 4), (ELEMENT / 6, 6), (ELEMENT / 11, 11)):
        assert abs(crack(strip, parts * strip) / fine - 1) < ACCURACY
    assert crack(2 * STRIP, 2 * STRIP) < (1 - 4 * ACCURACY) * fine
    assert crack(3 * ELEMENT / 22, 3 * ELEMENT) < (1 - 4 * ACCURACY) * fine


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


def test_strips_that_are_too_long_are_refused_with_the_longest_allowed():
    weak, strong = (uniform_laws(1, factor * E_BAR, factor * 2e6) for factor in (1, 50))
    assert resolved(PAPER, 1000, weak).elements >= 200
    allowed = 1e6 * STRIP * foundation_length(PAPER, strong)
    with pytest.raises(ValueError, match=rf"strips of 1.5 µm .* at most {allowed:.3g} µm"):
        resolved(PAPER, 1000, strong)
    assert resolved(PAPER, round(1500 / allowed) + 1, strong).element_length <= ELEMENT / STRIP * allowed * 1e-6


def test_the_crack_from_which_a_beam_is_released_has_several_elements():
    # At a small gap the crack is short; only the number of elements along it bounds them.
    beam = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 0.3e-6, 2)
    found = resolved(beam, 3000, LAW)
    start = arrest_length(E_BAR, beam) / 3
    coarser = max(n for n in range(1, found.elements) if 3000 % n == 0)
    assert start / ALONG_START < ELEMENT * LENGTH
    assert found.element_length <= start / ALONG_START < beam.length / coarser
    end = released_beam(found, np.tile(LAW, (3000, 1)), E_BAR)
    assert_allclose(end.crack_length, arrest_length(E_BAR, beam), atol=LENGTH)


def test_a_weak_law_leaves_elements_no_longer_than_a_twelfth_of_the_beam():
    beam = resolved(replace(PAPER, elements=2), 1000, uniform_laws(1, 1e-9, 1.0))
    assert beam.element_length <= PAPER.length / 12

from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, uniform_laws
from numpy.testing import assert_allclose

from stiction.beam.foundation import ACCURACY, ELEMENT, LONGER, STRIP, TOO_EARLY, foundation_length
from stiction.beam.release import released_beam
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
    return released_beam(fitted, laws).crack_length


@pytest.mark.parametrize(("thickness", "error"), [(0.5e-6, -0.115), (1e-6, -0.011), (1.5e-6, 0.0), (2.6e-6, 0.0)])
def test_the_mesh_of_the_paper_stops_the_cracks_of_thin_beams_too_early(thickness, error):
    # Elements of 7.5 µm with 5 strips each, on a uniform law; mean over gaps, because a front stops within elements.
    # An independent study found -12 % at 0.5 µm and less than 1 % at 1.5 µm and above.
    def relative(gap):
        beam = replace(PAPER, length=900e-6, thickness=thickness, gap=gap)
        coarse, fine = (
            released_beam(replace(beam, elements=n), np.tile(LAW, (5 * n, 1))).crack_length for n in (120, 1800)
        )
        return coarse / fine - 1

    errors = [relative(gap) for gap in np.linspace(15e-6, 25e-6, 5)]
    assert_allclose(np.mean(errors), error, atol=0.007)
    assert np.ptp(errors) < 0.035


def test_allowed_strips_and_elements_find_the_crack_to_one_per_cent_and_longer_ones_do_not():
    # The front stops within an element, at another place for each gap.
    beams = [replace(PAPER, gap=gap) for gap in (17e-6, 18e-6, 21e-6, 23e-6)]
    fine = [crack(0.15, 0.3, beam) for beam in beams]
    assert_allclose(crack(0.075, 0.15, beams[0]), fine[0], rtol=ACCURACY / 20)

    def errors(strip, parts):
        return np.array([crack(strip, parts * strip, beam) for beam in beams]) / fine - 1

    for strip, parts in ((STRIP, 1), (STRIP, 2), (STRIP, 3), (ELEMENT / 4, 4), (ELEMENT / 6, 6), (ELEMENT / 11, 11)):
        assert np.abs(errors(strip, parts)).max() < ACCURACY
    for longer in (errors(2 * STRIP, 1), errors(3 * ELEMENT / 22, 22)):
        assert longer.max() < -3 * ACCURACY  # control


def test_longer_strips_stop_cracks_too_early_by_no_more_than_is_said():
    # Laws that reach less far to the right than to the left are left out: on them, allowed strips err by 3 %.
    for a_right in (0.25, 0.6, 1.0):
        law = LAW * [1, 1, 1, a_right * LAW[0, 2] / LAW[0, 3]]
        length = foundation_length(PAPER, law)

        def stopped(strip, law=law, length=length):
            elements = round(900e-6 / (strip * length))
            fitted = replace(PAPER, length=elements * strip * length, elements=elements)
            return released_beam(fitted, np.tile(law, (elements, 1))).crack_length

        fine = stopped(0.3)
        early = [1 - stopped(longer * STRIP) / fine for longer in (1, (1 + LONGER) / 2, LONGER)]
        assert early[0] < ACCURACY < early[2] < TOO_EARLY
        assert early[1] < early[2]

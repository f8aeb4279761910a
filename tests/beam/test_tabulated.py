"""The beam on tabulated force curves, by which laws of Eq. (12) are compared with the curves: ``make tails``."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import E_BAR, PAPER, uniform_laws
from benchmarks import tails

from stiction.beam.energy import arrest_length
from stiction.beam.release import released_beam
from stiction.contact import forcelaw

STEP, POINTS = 0.05e-9, 400


def lengths(factor=1.0):
    """Crack length on laws of Eq. (12), and on a table of them with all forces times a factor [m]."""
    beam = replace(PAPER, length=1e-3, elements=POINTS // 5)
    laws = uniform_laws(POINTS, energy=4 * E_BAR)
    table = factor * forcelaw.pressure(laws[:1, None], STEP * np.arange(2000))
    curve = partial(tails.pressures_and_slopes, table, np.zeros(POINTS, int), STEP)
    start = arrest_length(4 * E_BAR, beam) / 3
    return released_beam(beam, laws, 4 * E_BAR).crack_length, tails.crack_length(beam, laws, curve, start)


def test_on_a_table_of_eq_12_the_crack_is_that_of_the_law():
    law, table = lengths()
    assert table == pytest.approx(law, rel=1e-5)


def test_a_table_with_a_tenth_less_force_has_a_crack_that_is_longer_as_the_fourth_root():
    law, table = lengths(factor=0.9)
    assert table / law == pytest.approx(0.9**-0.25, rel=0.01)

"""Attraction across gaps in full elastic contact, which judges the sum over undeformed gaps: ``make deformed``."""

import numpy as np
import pytest
from benchmarks.deformed import GAPS, across_gaps

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.elements import Adhesion
from stiction.contact.environment import Gaps, Water
from stiction.contact.halfspace import HalfSpace
from stiction.contact.vanderwaals import attraction

WATER = Water(300.0, gaps=Gaps(HAMAKER_CONSTANT, "water", 100e-9))
SOLIDS = attraction("water")
TOUCHING = Adhesion.of(WATER.film(0.6), SOLIDS, HalfSpace((8, 8), 10e-9, 1e11))
ACROSS = across_gaps(TOUCHING, WATER)


def test_attraction_is_the_slope_of_the_energy():
    energy = ACROSS.energy(GAPS)
    pulled = np.concatenate([[0], np.cumsum((ACROSS.traction(GAPS)[1:] + ACROSS.traction(GAPS)[:-1]) / 2)]) * GAPS[1]
    np.testing.assert_allclose(energy - energy[0], pulled, atol=0.02 * -energy[0])


def test_flats_that_touch_have_no_more_than_the_work_of_eq_10_and_of_the_film_and_farther_ones_have_all_across_gaps():
    film = TOUCHING.height * TOUCHING.tension
    more = WATER.gaps.work(0.0, TOUCHING.height)
    assert -ACROSS.energy(np.zeros(1))[0] == pytest.approx(film + SOLIDS.work_of_adhesion + more, rel=0.02)
    far = np.array([20e-9])
    assert -ACROSS.energy(far)[0] == pytest.approx(WATER.gaps.through("dry").work(20e-9), rel=1e-3)
    assert TOUCHING.energy(far)[0] == 0

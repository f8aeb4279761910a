"""Levels of full contact: solvers in the order of their success, and a limit of the effort."""

from dataclasses import replace

import numpy as np
import pytest
from test_descent import dry, led, smooth
from test_elements import space_of

from stiction.contact.full import descent, elements
from stiction.contact.full.effort import CountedHalfSpace, Effort, TooLong
from stiction.contact.full.elements import separation
from stiction.contact.full.levels import Level, refined
from stiction.errors import NotConverged

TURNS, DESCENT = elements.equilibrium, descent.equilibrium
SPACE = space_of()


def counted(most=np.inf):
    """Elements of strips with a limit."""
    return CountedHalfSpace.from_space(SPACE, Effort(most))


def calls(level):
    """Names of the solvers in the order in which a level calls them."""
    names = []

    def noting(name, settle):
        def noted(*args, **options):
            names.append(name)
            return settle(*args, **options)

        return noted

    level.solvers = noting("turns", TURNS), noting("descent", DESCENT)
    return names


@pytest.mark.parametrize(("rms", "first"), [(1.0, "turns"), (0.3, "descent")])
def test_the_solver_that_settled_last_comes_first_on_other_strips(rms, first):
    level = Level.from_fine(1, counted(), dry)
    names = calls(level)
    level.at_rest(smooth(rms), led(rms))
    before = list(names)
    level.at_rest(smooth(rms), led(rms))
    again = names[len(before) :]
    assert set(again) == {first}
    assert (len(again) < len(before)) == (first == "descent"), "control: turns come first on the first strip"


def test_the_state_of_a_coarse_grid_leads_both_solvers_to_the_rest_that_they_find_without_it():
    for rms, solvers in ((1.0, (TURNS,)), (0.3, (DESCENT,))):
        fine, coarse = (Level.from_fine(every, SPACE, dry) for every in (1, 2))
        fine.solvers = coarse.solvers = solvers
        heights, curve = smooth(rms), led(rms)
        without = fine.energy(fine.at_rest(heights, curve), heights)
        start = refined(coarse.at_rest(heights, curve), 2, SPACE.shape)
        assert fine.energy(fine.at_rest(heights, curve, start), heights) == pytest.approx(without, rel=4e-3)


def test_counted_elements_have_the_states_of_others_and_count_every_displacement():
    space, z = counted(), smooth(1.0)
    plain = separation(SPACE, z, dry(SPACE), led(1.0))
    assert separation(space, z, dry(space), led(1.0)).adhesion_energy == plain.adhesion_energy
    assert space.effort.spent % z.size == 0
    assert space.effort.spent > plain.states * z.size


def test_coarse_grids_spend_from_the_same_effort():
    space = counted()
    coarse = Level.from_fine(2, space, dry).space
    coarse.displacement(np.zeros(coarse.shape, np.float32))
    assert space.effort.spent == np.prod(coarse.shape)
    assert coarse.spacing == 2 * space.spacing


@pytest.mark.parametrize("solvers", [(TURNS, DESCENT), (DESCENT, TURNS)])
def test_no_solver_goes_on_beyond_the_effort(solvers):
    level = replace(Level.from_fine(1, counted(20 * smooth(1.0).size), dry), solvers=solvers)
    with pytest.raises(TooLong, match="takes too long"):
        level.at_rest(smooth(1.0), led(1.0))
    assert level.space.effort.spent == 21 * smooth(1.0).size
    assert not issubclass(TooLong, NotConverged | ValueError), "solvers that take over catch these"

"""Laws of P(stuck) over the life of a mission, whose conditions have shares of the touchdowns."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_answers import SHARE, air, asked, budgets, lognormal
from numpy.testing import assert_allclose

from stiction.answer.data import Cause, Stay
from stiction.answer.unknowns import Draws, Exact
from stiction.answer.worlds import Condition, World
from stiction.life.freeing import stuck_after

CAUSES = frozenset(Cause) - {Cause.FAST}
TOUCHDOWNS = 1000


def drawn(seed, touchdowns=TOUCHDOWNS):
    """Conditions in dry, moist and wet air, which hold more and more."""
    values = lognormal(np.random.default_rng(seed))
    less = {0.0: 0.0, 0.5: 0.05, 0.8: 0.15}
    return [air(values - shift, rh, touchdowns=touchdowns) for rh, shift in less.items()]


def world(conditions, shares, touchdowns=TOUCHDOWNS, unknowns=None, share=SHARE):
    """World of conditions with shares of the touchdowns by humidity, in an order."""
    stays = tuple(Stay((air,), part * touchdowns) for air, part in shares)
    return World(tuple(conditions), unknowns or Exact(), CAUSES, share, touchdowns, Draws(2000, 0), stays=stays)


def size(*args, **kwargs):
    """Size to build as v."""
    return world(*args, **kwargs).size


@pytest.mark.parametrize("seed", range(3))
def test_all_touchdowns_in_one_condition_are_those_without_shares(seed):
    conditions = drawn(seed)
    for one in conditions:
        alone = size([one], [])
        assert_allclose(size(conditions, [(one.humidity, 1)]), alone, atol=1e-6)
        halves = [(one.humidity, 0.5), (one.humidity, 0.5)]
        assert_allclose(size([one], halves), alone, atol=1e-6)
        assert size([one], halves, touchdowns=10 * TOUCHDOWNS) < alone - 0.05  # control


def test_two_equal_conditions_with_half_the_touchdowns_are_one_with_all():
    first, *_ = drawn(0)
    second = replace(first, humidity=0.9)
    both = size([first, second], [(first.humidity, 0.5), (0.9, 0.5)])
    assert_allclose(both, size([first], []), atol=1e-6)
    assert both < size([first, second], [(first.humidity, 0.5)]) - 0.01  # control: half of them


@pytest.mark.parametrize("seed", range(3))
def test_touchdowns_in_several_airs_count_in_the_worst_of_them(seed):
    """Air whose film is bounded by two others has the touchdowns of the one that holds most."""
    conditions = drawn(seed)
    bounded = replace(world(conditions, []), stays=(Stay((0.0, 0.5, 0.8), TOUCHDOWNS),))
    assert_allclose(bounded.size, size(conditions, [(0.8, 1)]), atol=1e-6)
    assert bounded.size < size(conditions, [(0.5, 1)]) - 0.01  # control
    assert_allclose(bounded.stuck(-0.3), world(conditions, [(0.8, 1)]).stuck(-0.3))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("errors", [False, True])
def test_a_mission_is_between_all_touchdowns_in_the_worst_condition_and_the_own_ones_of_each(seed, errors):
    conditions, shares = drawn(seed), [(0.0, 0.6), (0.5, 0.3), (0.8, 0.1)]
    unknowns = budgets(conditions, (0.1,), 0.02) if errors else Exact()
    mission = size(conditions, shares, unknowns=unknowns)
    assert size(conditions, [], unknowns=unknowns) < mission
    for one in shares:
        assert mission <= size(conditions, [one], unknowns=unknowns) + 1e-6


@pytest.mark.parametrize("seed", range(3))
def test_one_more_condition_or_bound_never_allows_a_longer_beam(seed):
    conditions, shares = drawn(seed), [(0.0, 0.6), (0.5, 0.3), (0.8, 0.1)]
    sizes = [size(conditions[:k], shares[:k]) for k in (1, 2, 3)]
    liquid = Condition(0.8, "collapse_x", Cause.DRYING, "life", bound=sizes[-1] - 0.1)
    sizes.append(size([*conditions, liquid], shares))
    assert (np.diff(sizes) <= 1e-6).all()
    assert_allclose(sizes[-1], liquid.bound, atol=1e-6)
    for more in (0.2, 0.5):  # the same touchdowns in wetter air
        shares = [(0.0, 0.6 - more), (0.5, 0.3), (0.8, 0.1 + more)]
        assert size(conditions, shares) < sizes[2]


def test_the_fraction_stuck_over_the_life_is_that_of_drawn_touchdowns():
    """Devices stick if any of their touchdowns meets summits that hold them."""
    rng, centres, scatter, number = np.random.default_rng(7), {0.0: 0.0, 0.8: -0.1}, 0.15, 40_000
    touchdowns, shares, v = 20, [(0.0, 0.75), (0.8, 0.25)], -0.35
    conditions = [air(lognormal(rng, centre, number=number), rh) for rh, centre in centres.items()]
    drawn = [lognormal(rng, centres[rh], scatter, (number, int(part * touchdowns))).min(axis=1) for rh, part in shares]
    stuck = np.minimum(*drawn) < v
    error = np.sqrt(stuck.mean() * (1 - stuck.mean()) / number)
    found = world(conditions, shares, touchdowns).stuck(v)
    errors = np.hypot(error, found.std())
    assert abs(found.mean() - stuck.mean()) < 4 * errors
    worst = stuck_after(world(conditions[1:], [], 1).stuck(v), touchdowns)
    assert abs(worst.mean() - stuck.mean()) > 10 * errors  # control: all touchdowns in the wet air


def test_the_size_to_build_is_that_of_the_required_fraction_over_the_life():
    conditions, shares = drawn(1), [(0.0, 0.6), (0.5, 0.3), (0.8, 0.1)]
    without = replace(world(conditions, shares), causes=frozenset({Cause.TOUCHDOWNS}))
    assert_allclose(without.stuck(without.size).mean(), SHARE, rtol=1e-4)
    assert without.stuck(without.size - 0.01).mean() < 0.9 * SHARE
    assert replace(without, causes=frozenset()).size == replace(without, causes=frozenset(), stays=()).size


def test_air_without_enough_sticking_devices_takes_its_bound_and_nothing_below_flat_ground():
    """In dry air no device sticks: it is safe up to the length of flat surfaces, beyond it nothing is known."""
    _, wet = drawn(2)[1:]
    free = air(np.full(1000, np.inf), 0.0, touchdowns=TOUCHDOWNS, flat=np.exp(-0.6))
    shares = [(0.0, 0.9), (0.8, 0.1)]
    assert_allclose(size([free, wet], shares), min(size([wet], [(0.8, 0.1)]), -0.6), atol=1e-6)
    shorter = replace(free, sampled=replace(free.sampled, flat=-2.0))
    assert -1.5 < size([shorter, wet], shares) <= size([wet], [(0.8, 0.1)])  # what is stated for all touchdowns holds
    nothing = replace(shorter, sampled=replace(shorter.sampled, stated_sizes=()))
    assert_allclose(size([nothing, wet], shares), -2.0, atol=1e-6)


def test_an_answer_names_the_condition_that_decides():
    conditions = drawn(0)
    stays = (Stay((0.0,), 600.0), Stay((0.0, 0.5), 399.0), Stay((0.8,), 1.0))
    found = asked(conditions, touchdowns=TOUCHDOWNS, stays=stays, size=0.3)
    assert [found.touchdowns_in(air) for air in (0.0, 0.5, 0.8)] == [999, 399, 1]
    assert found.build <= min(one.build for one in found.airs) * (1 + 1e-6)
    assert found.build > asked(conditions, touchdowns=TOUCHDOWNS).build
    for dry, wet, decides in ((999.9, 1e-1, 0.0), (1.0, 999.0, 0.8)):
        mission = asked(conditions, touchdowns=TOUCHDOWNS, stays=(Stay((0.0,), dry), Stay((0.8,), wet)))
        assert mission.stated_steps[-1].humidity == decides

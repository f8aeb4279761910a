"""Upper end of P(stuck) where no simulated device sticks: monotone in the size, and true as often as it says."""

import re

import numpy as np
import pytest
from drawn_answers import DEVICES, SCATTER, SHARE, air, asked, budgets, lognormal
from scipy.special import ndtri
from scipy.stats import binom

from stiction.answer.data import Cause
from stiction.answer.ladder import probability
from stiction.answer.unknowns import Draws, Exact
from stiction.answer.worlds import World
from stiction.devices.risk import VERIFIED, upper_bound
from stiction.life.freeing import stuck_after
from stiction.report.answer.words import stuck_in_words


def few(rng, share):
    """Thresholds of devices of which a fraction sticks at 0, and the others do not."""
    return np.where(rng.uniform(size=DEVICES) < share, 0.0, np.inf)


REACH = 20.0
#: Conditions of drawn devices: with a line through their tail, and with flat surfaces as a bound.
CASES = {
    "line": lambda rng: air(lognormal(rng)),
    "line of two states": lambda rng: air(np.minimum(lognormal(rng), lognormal(rng, 0.2, 0.3))),
    "few stick": lambda rng: air(few(rng, 2 / DEVICES), reach=REACH, flat=0.5),
    "none sticks": lambda rng: air(few(rng, 0.0), reach=REACH, flat=0.5),
}


@pytest.mark.parametrize("touchdowns", [1, 300])
@pytest.mark.parametrize("name", CASES)
def test_the_upper_end_never_falls_along_the_size_and_jumps_by_one_device_at_most(name, touchdowns):
    one = CASES[name](np.random.default_rng(len(name)))
    of_one = stuck_after(upper_bound(1, DEVICES, 0.975), touchdowns)
    least = stuck_after(min(VERIFIED, 1 - (1 - SHARE) ** (1 / touchdowns)), touchdowns)
    for unknowns in (Exact(), budgets([one], (0.3,), 0.02)):
        found = asked([one], unknowns, 500, touchdowns=touchdowns)
        assert (np.diff(found.curve[2]) >= 0).all()
        assert found.curve[2].min() >= least * (1 - 1e-9)
        for size in (found.build, found.airs[0].first)[: 1 + bool(np.isfinite(one.sampled.values[0]))]:
            below, above = (
                asked([one], unknowns, 500, touchdowns=touchdowns, size=size * (1 + step)).stuck
                for step in (-1e-9, 1e-9)
            )
            assert 0 <= above.high - below.high <= of_one
        assert not re.search(r"(^|\D)0 %", stuck_in_words(below))


def test_a_lower_end_begins_where_one_device_of_the_air_with_the_fewest_would_stick():
    rng = np.random.default_rng(2)
    airs = air(lognormal(rng)), air(lognormal(rng, 0.1, number=DEVICES // 5), 0.8)
    world = World(airs, budgets(airs, (0.1,)), frozenset(Cause), SHARE, 1, Draws(1000, 0))
    upper_end = np.quantile(world.stuck(world.first), 0.975)
    assert world.first < min(one.sampled.values[0] for one in airs)
    assert upper_end == pytest.approx(upper_bound(1, DEVICES // 5, 0.975), rel=1e-6)
    assert upper_end > 2 * upper_bound(1, DEVICES, 0.975)  # control


@pytest.mark.parametrize("touchdowns", [1, 300])
@pytest.mark.parametrize("name", CASES)
def test_the_upper_end_is_the_allowed_fraction_at_the_size_to_build(name, touchdowns):
    """Both are the same statement, also where more are expected to stick on average."""
    one = CASES[name](np.random.default_rng(len(name)))
    for unknowns in (Exact(), budgets([one], (0.05,))):
        build = asked([one], unknowns, 500, touchdowns=touchdowns).build
        stuck = asked([one], unknowns, 500, touchdowns=touchdowns, size=build).stuck
        assert stuck.none_seen
        assert stuck.high <= SHARE * (1 + 1e-9)
        if name.startswith("line"):
            assert stuck.high >= SHARE * (1 - 1e-9)


RUNS = 300


@pytest.mark.slow
@pytest.mark.parametrize("expected", [0.3, 1.0, 2.0, 3.5])
def test_upper_ends_hold_for_repeated_simulations(expected):
    """A number of devices expected to stick, among those simulated; with a line, and with a bound by flats."""
    share, rng = expected / DEVICES, np.random.default_rng(5)
    least = binom.ppf(0.01, RUNS, 0.95) / RUNS
    for draw, v in ((lognormal, SCATTER * ndtri(share)), (lambda rng: few(rng, share), 0.1)):
        known = {} if draw is lognormal else {"reach": REACH, "flat": 0.5}
        worlds = [
            World((air(draw(rng), **known),), Exact(), frozenset({Cause.SIMULATION}), SHARE, 1, Draws(500, 0))
            for _ in range(RUNS)
        ]
        found = [probability(world, v) for world in worlds]
        assert np.mean([one.high >= share for one in found]) >= least
        assert expected < 1 or np.mean([one.value >= share for one in found]) < least, "expectations are no bounds"

"""How often statements of the answer hold for drawn truths: sizes, bands, and sizes by the simulation alone."""

import numpy as np
import pytest
from drawn_answers import ALONG, ARC, DEVICES, SCATTER, SHARE, air, budgets, lognormal
from scipy.optimize import brentq
from scipy.special import ndtr
from scipy.stats import binom

from stiction.answer.data import Cause, band
from stiction.answer.unknowns import Draws, Exact, Members
from stiction.answer.worlds import World
from stiction.life.freeing import stuck_after

pytestmark = pytest.mark.slow

TRUTHS, AT, ERROR = 600, np.log(0.75), 0.03
#: Fewest of the truths that hold with a probability of 1 % or more if 93 % do.
FEWEST = binom.ppf(0.01, TRUTHS, 0.93) / TRUTHS


def rms(power):
    """Logarithm of a length that follows a power of an rms known to 30 %, in standard errors."""
    return lambda x: power * np.log(np.maximum(1 + 0.3 * x, 0.02))


def statements(conditions, unknowns, touchdowns=1):
    """Size to build as v, and the band of P(stuck)."""
    world = World(tuple(conditions), unknowns, frozenset(Cause), SHARE, touchdowns, Draws(2000, 0))
    return world.size, band(world.stuck(AT))


def known(response, rng):
    """Slope with its error, and curvature, as a budget finds them from states one standard error away."""
    slope, bend = (response(1.0) - response(-1.0)) / 2, (response(1.0) + response(-1.0)) / 2 - response(0.0)
    return (slope + ERROR * rng.standard_normal(),), ERROR, bend


def held(seed, response, of_kind=0.0, with_inputs=True, touchdowns=1):
    """Fractions of drawn truths for which the size and the band hold.

    The true input errs by a normal number, and the true surface is a further one of a kind with a standard deviation.
    """
    rng, count = np.random.default_rng(seed), np.zeros(2)
    for _ in range(TRUTHS):
        true = response(rng.standard_normal()) + of_kind * rng.standard_normal()
        members = (Members("B2", of_kind * rng.standard_normal(4)),) if of_kind else ()
        one = air(lognormal(rng), touchdowns=touchdowns)
        unknowns = budgets([one], *known(response, rng), members=members) if with_inputs else Exact()
        size, (low, high) = statements([one], unknowns, touchdowns)
        stuck = [stuck_after(ndtr((v - true) / SCATTER), touchdowns) for v in (size, AT)]
        count += stuck[0] <= SHARE, low <= stuck[1] <= high
    return count / TRUTHS


#: Responses in standard errors of an input, scatter of the surfaces of a kind, and touchdowns.
CASES = {
    "linear": (lambda x: 0.2 * x, 0.0, 1),
    "after touchdowns": (lambda x: 0.2 * x, 0.0, 1000),
    "bent": (lambda x: 0.2 * x - 0.04 * x**2, 0.0, 1),
    "bent much": (lambda x: 0.2 * x - 0.08 * x**2, 0.0, 1),
    "an rms known to 30 %": (rms(1.0), 0.0, 1),
    "a surface of a kind": (lambda x: 0.05 * x, 0.3, 1),
}


@pytest.mark.parametrize("name", CASES)
def test_statements_hold_for_drawn_truths(name):
    response, of_kind, touchdowns = CASES[name]
    assert (held(3, response, of_kind, touchdowns=touchdowns) >= FEWEST).all()


def test_statements_fail_without_the_inputs():
    size, within = held(3, CASES["linear"][0], with_inputs=False)
    assert size < 0.8
    assert within < 0.3


def test_what_bends_to_the_safe_side_leaves_the_size_safe():
    assert held(4, lambda x: 0.2 * x + 0.08 * x**2)[0] >= 0.97


# Simulation alone

#: Centres and scatters of tips in three airs, and of S-shapes, of which the first ones are as short as tips.
AIRS = {0.4: (0.0, 0.15), 0.6: (-0.02, 0.14), 0.9: (-0.15, 0.1)}
RUNS = 400


def released(rng, alike, along):
    """Conditions of a cantilever whose tips err alike in all airs by a correlation."""
    common, cracks = rng.standard_normal((2, DEVICES))
    found = []
    for humidity, (centre, scatter) in AIRS.items():
        own = rng.standard_normal(DEVICES)
        tips = centre + scatter * (alike * common + np.sqrt(1 - alike**2) * own)
        of_cracks = along + 0.05 * cracks
        found += [air(of_cracks, humidity, ALONG), air(np.minimum(tips, of_cracks), humidity, ARC)]
    return found


def truth(along):
    """Least true length of all airs for the allowed fraction, as v."""

    def excess(v, centre, scatter):
        """Fraction of devices stuck in either state, less the allowed one."""
        return 1 - ndtr((centre - v) / scatter) * ndtr((along - v) / 0.05) - SHARE

    return min(brentq(excess, -2, 1, args=of) for of in AIRS.values())


@pytest.mark.parametrize(("alike", "along"), [(1.0, 1.0), (0.9, 1.0), (0.9, -0.3), (0.0, 1.0)])
def test_the_least_bound_of_all_airs_holds_with_its_confidence(alike, along):
    """No bound is below the truth more often than it says, whatever the airs have in common."""
    rng, least = np.random.default_rng(7), truth(along)
    sizes = [World(tuple(released(rng, alike, along)), Exact(), frozenset(Cause), SHARE, 1, Draws(500, 0)).size
             for _ in range(RUNS)]  # fmt: skip
    held = np.mean(np.array(sizes) <= least)
    assert held >= 0.93
    assert held <= 0.97 or alike < 1

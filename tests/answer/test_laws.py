"""Laws of the answer about a device: conditions, steps, bounds, probabilities and verdicts, over drawn devices."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_answers import ALONG, ARC, SCATTER, SHARE, air, asked, budgets, lognormal, sampled, slopes
from numpy.testing import assert_allclose
from scipy.special import ndtri

from stiction.answer.data import Answer, Cause, Probability, Verdict
from stiction.answer.unknowns import Draws, Exact, OfBudgets, OfTestBeams
from stiction.answer.worlds import Condition, Sampled, World
from stiction.life.freeing import probability_for, stuck_after
from stiction.report.answer.words import stuck_in_words

CAUSES = frozenset(Cause) - {Cause.FAST}


def drawn(seed, touchdowns=1):
    """Conditions of a drawn cantilever: both end states in two airs, at a voltage, and in a liquid."""
    rng = np.random.default_rng(seed)
    along, arcs = lognormal(rng, 0.5, 0.05), lognormal(rng, rng.normal(0, 0.2))
    airs = [
        air(np.minimum(values, arcs + shift) if shape == ARC else values, rh, shape, touchdowns=touchdowns)
        for rh, shift in ((0.5, 0.0), (0.8, rng.normal(0, 0.1)))
        for shape, values in ((ALONG, along + shift), (ARC, along + shift))
    ]
    volts = [replace(one, cause=Cause.VOLTAGE, shift=-abs(rng.normal(0, 0.1)), error=0.01) for one in airs]
    liquid = [
        Condition(rh, "collapse_x", Cause.DRYING, "life", bound=rng.normal(-0.5, 0.2), error=0.03) for rh in (0.5, 0.8)
    ]
    return airs, volts, liquid


def built(conditions, unknowns, touchdowns=1):
    """Size to build as v."""
    return World(tuple(conditions), unknowns, CAUSES, SHARE, touchdowns, Draws(2000, 0)).size


@pytest.mark.parametrize("seed", range(4))
def test_one_more_condition_never_allows_a_longer_beam(seed):
    airs, volts, liquid = drawn(seed)
    some = [airs[:2], airs, [*airs, *volts], [*airs, *volts, *liquid]]
    for unknowns in (Exact(), budgets(airs, (0.1, 0.05), 0.02, -0.01)):
        sizes = [built(conditions, unknowns) for conditions in some]
        sizes += [built(some[-1], unknowns, touchdowns=n) for n in (10, 1000)]
        assert (np.diff(sizes) <= 0).all()
        assert built(some[-1], budgets(airs)) < built(some[-1], Exact())


@pytest.mark.parametrize(("seed", "unit"), [(0, "m"), (1, "N")])
def test_steps_multiply_to_the_size_to_build_and_fast_separation_stands_beside(seed, unit):
    airs, volts, liquid = drawn(seed)
    fast = [replace(one, cause=Cause.FAST, shift=-1.0, error=0.02, is_stated=False) for one in airs]
    conditions = [*airs, *volts, *liquid, *fast]
    found = asked(conditions, budgets(airs, error=0.02), unit=unit, touchdowns=100)
    sign = -1 if unit == "N" else 1
    factors = [step.factor**sign for step in found.steps[1:]]
    assert_allclose(found.steps[0].size * np.prod([step.factor for step in found.stated_steps[1:]]), found.build)
    assert max(factors) <= 1
    assert min(factors) < 1
    assert [step.cause for step in found.steps if not step.stated] == [Cause.FAST]
    assert found.build == asked([*airs, *volts, *liquid], budgets(airs, error=0.02), unit=unit, touchdowns=100).build
    stated = [replace(one, is_stated=True) for one in fast]
    with_fast, without = (asked(these, Exact(), unit=unit).build for these in ([*airs, *stated], [*airs, *fast]))
    assert with_fast**sign < without**sign


@pytest.mark.parametrize(("seed", "touchdowns"), [(0, 1), (1, 1), (2, 1000)])
def test_where_nothing_else_is_stated_the_size_is_the_least_stated_bound(seed, touchdowns):
    airs, *_ = drawn(seed, touchdowns)
    bounds = [one.sampled.stated_sizes[-1].bound for one in airs]
    estimates = [one.sampled.stated_sizes[-1].estimate for one in airs]
    found = asked(airs, touchdowns=touchdowns)
    assert_allclose(np.log(found.build), min(bounds), atol=1e-9)
    start = World(tuple(airs), Exact(), frozenset({Cause.TOUCHDOWNS}), SHARE, touchdowns, Draws(2000, 0))
    assert_allclose(start.size, min(estimates), atol=1e-9)
    assert found.exact == found.build
    for one in found.airs:
        own = [each.sampled.stated_sizes[-1].bound for each in airs if each.humidity == one.humidity]
        assert_allclose(np.log([one.build, one.without_tip]), [min(own), own[0]], atol=1e-9)


def test_equal_bounds_by_fits_of_other_numbers_of_devices_are_the_size():
    """Whatever errors of two conditions have in common, both bounds hold if each does."""
    values = lognormal(np.random.default_rng(12))
    reach = float(np.sort(values)[19]) + 1e-6
    few = np.where(values <= reach, values, np.inf)
    first, second = air(values), air(few, 0.8, reach=float(np.exp(reach)))
    assert (first.sampled.tail.fitted, second.sampled.tail.fitted) == (50, 20)
    second = replace(
        second, sampled=replace(second.sampled, stated_sizes=first.sampled.stated_sizes, surfaces_error=0.05)
    )
    assert_allclose(built([first, second], Exact()), first.sampled.stated_sizes[0].bound, atol=1e-9)


def test_a_bound_of_order_statistics_or_of_drier_air_is_kept():
    one = air(lognormal(np.random.default_rng(1)))
    (own,) = one.sampled.stated_sizes
    for bound in (own.bound - 0.3, own.bound + 0.5 * (own.estimate - own.bound), own.estimate):
        moved = replace(one, sampled=replace(one.sampled, stated_sizes=(replace(own, bound=bound),)))
        assert_allclose(np.log(asked([moved]).build), bound, atol=1e-9)
        assert_allclose(np.log(asked([moved]).steps[0].size), own.estimate, atol=1e-9)
        # Nothing is stated after touchdowns: the line counts, unless it passes the bound for one.
        after = np.log(asked([moved], touchdowns=100).build)
        unmoved = np.log(asked([one], touchdowns=100).build)
        assert after < bound
        assert after < unmoved + 0.01
        if bound >= own.bound:
            assert_allclose(after, unmoved, atol=0.01)


def test_no_size_is_below_the_floor_before_the_inputs_count():
    values = lognormal(np.random.default_rng(2))
    (own,) = sampled(values).stated_sizes
    for floor in (own.bound + 0.1, own.bound - 0.1):
        one = air(values, shape="middle")
        at = replace(one.sampled, floor=floor, stated_sizes=(replace(own, bound=max(own.bound, floor)),))
        found = asked([replace(one, sampled=at)], budgets([one]), touchdowns=10**6, size=float(np.exp(floor - 1e-6)))
        assert np.log(found.exact) >= floor - 1e-9
        assert found.build < found.exact
        assert asked([replace(one, sampled=at)], size=float(np.exp(floor - 1e-6))).stuck.value == 0


def test_a_voltage_moves_thresholds_and_their_bounds_alike():
    one = air(lognormal(np.random.default_rng(3)), touchdowns=10)
    at = one.sampled.moved(lambda v: v - 0.1 - 0.05 * np.tanh(v))
    volts = replace(one, cause=Cause.VOLTAGE, sampled=at)
    for touchdowns, stated in zip((1, 10), one.sampled.stated_sizes, strict=True):
        bound = stated.bound - 0.1 - 0.05 * np.tanh(stated.bound)
        assert_allclose(np.log(asked([one, volts], touchdowns=touchdowns).build), bound, atol=1e-9)


# Probability


@pytest.mark.parametrize(("seed", "unit"), [(0, "m"), (1, "N")])
def test_the_probability_rises_with_the_size_and_with_touchdowns_and_its_band_contains_it(seed, unit):
    airs, *_ = drawn(seed)
    for unknowns in (Exact(), budgets(airs, (0.15,), 0.02, -0.02)):
        known = None
        for touchdowns in (1, 20):
            world = World(tuple(airs), unknowns, frozenset(Cause), SHARE, touchdowns, Draws(2000, 0))
            fractions = np.array([world.stuck(v) for v in np.linspace(-1.5, 1, 60)])
            assert (np.diff(fractions, axis=0) >= 0).all()
            assert known is None or (fractions.mean(axis=1) >= known - 2e-3).all()
            known = fractions.mean(axis=1)
        found = asked(airs, unknowns, unit=unit, size=0.8)
        for one in (found.stuck, *(each.stuck for each in found.airs)):
            assert 0 <= one.low <= one.value <= one.high <= 1


def test_the_fraction_is_the_counted_one_where_many_stick_and_that_of_the_line_where_few_do():
    one = air(lognormal(np.random.default_rng(4), number=4000))
    for v in (-0.2, 0.0, 0.3):
        counted = np.mean(one.sampled.values < v)
        stuck = asked([one], size=float(np.exp(v))).stuck
        assert abs(stuck.value - counted) < 0.3 * np.sqrt(counted * (1 - counted) / 4000)
        assert stuck.low < counted < stuck.high
    found = asked([one], size=float(np.exp(SCATTER * ndtri(1e-4)))).stuck
    assert found.low < 1e-4 < found.high
    assert asked([one], size=float(np.exp(one.sampled.values[0] - 1e-6))).stuck.none_seen


def test_the_fraction_is_continuous_where_the_line_ends():
    one = air(lognormal(np.random.default_rng(5)))
    end = one.sampled.values[49]
    at = [asked([one], size=float(np.exp(end + step)), number=20_000).stuck.value for step in (-1e-6, 1e-6)]
    assert 0 <= at[1] - at[0] < 0.006
    assert abs(np.mean(at) - 0.05) < 0.006


def test_devices_beyond_the_simulation_may_all_stick():
    values = lognormal(np.random.default_rng(6))
    reach = float(np.quantile(values, 0.3))
    one = air(np.where(values <= reach, values, np.inf), reach=np.exp(reach), flat=np.exp(-1))
    inside, beyond = (asked([one], size=float(np.exp(reach + step))).stuck for step in (-0.001, 0.001))
    assert inside.high < 0.4
    assert beyond.high == 1
    assert beyond.low == pytest.approx(inside.low, rel=0.05)


@pytest.mark.parametrize("touchdowns", [1, 1000])
def test_where_none_sticks_the_probability_has_an_upper_end_and_no_lower_one(touchdowns):
    one = air(np.full(1000, np.inf), reach=1.0, flat=0.5)
    found = asked([one], size=0.9, touchdowns=touchdowns).stuck
    assert found.none_seen
    assert found.low == 0
    assert_allclose(found.high, stuck_after(-np.expm1(np.log(0.05) / 1000), touchdowns), rtol=1e-6)
    assert 0 < found.value <= found.high


def test_a_size_as_long_as_the_one_to_build_is_within_the_allowed_fraction():
    one = air(lognormal(np.random.default_rng(7)), touchdowns=100)
    for n in (1, 100):
        build = asked([one], touchdowns=n).build
        found = asked([one], touchdowns=n, size=build)
        assert found.verdict is Verdict.SAFE
        assert found.stuck.none_seen
        assert SHARE / 3 < found.stuck.high <= SHARE


def test_the_expectation_by_a_few_draws_of_which_all_stick_is_inside_the_band_or_said_beside_the_bound():
    one = air(lognormal(np.random.default_rng(8)))
    heavy = OfTestBeams(np.array([-4.0, -2.4, -2.3, 4.0]), {(0.5, ARC): np.array([-9.0, -9.0, 0.0, 0.0])})
    found, longer = (asked([one], heavy, size=size, number=20_000).stuck for size in (0.5, 0.75))
    assert found.none_seen
    assert found.high < SHARE < found.value
    said = "at most 0.01 % (95 % confidence; 0.97 % on average, as many stick in the worst 5 %)"
    assert stuck_in_words(found) == said
    assert not longer.none_seen
    assert longer.low <= longer.value <= longer.high


@pytest.mark.parametrize("unit", ["m", "N"])
@pytest.mark.parametrize("share", [SHARE, 0.01, 0.2])
def test_a_fraction_that_no_more_than_5_percent_of_the_draws_exceed_meets_the_allowed_one_at_the_size_to_build(
    share, unit
):
    airs, *_ = drawn(3)
    conditions = [replace(one, sampled=replace(one.sampled, stated_sizes=())) for one in airs]
    found = asked(conditions, budgets(airs, error=0.02), share=share, unit=unit)
    sizes, fractions = found.at_most(found.together)
    assert fractions[sizes == found.build].max() == share
    assert np.diff(fractions).min() >= 0
    v = found.sought.sign * np.log(sizes)
    causes = frozenset(found.included)
    world = World(tuple(conditions), budgets(airs, error=0.02), causes, share, 1, Draws(2000, 0))
    exceeding = np.array(
        [(world.stuck(at) > bound * (1 + 1e-9)).mean() for at, bound in zip(v, fractions, strict=True)]
    )
    most = 0.05 + 4 * np.sqrt(0.05 * 0.95 / 2000)
    assert exceeding.max() <= most
    means = np.array([world.stuck(at).mean() for at in v])
    assert max((world.stuck(at) > mean).mean() for at, mean in zip(v, means, strict=True)) > most, "a mean does not"


# Verdict

STUCK = {Verdict.OPEN: Probability(0.1, SHARE, 0.5), Verdict.BAD: Probability(0.1, 2 * SHARE, 0.5)}


def answered(**fields):
    """Answer about a beam to build of 1 m."""
    return Answer("D", "cantilever", SHARE, "m", fields.pop("build", 1.0), 1.0, (), (), **fields)


@pytest.mark.parametrize(
    ("fields", "verdict"),
    [
        ({}, Verdict.BUILD),
        ({"build": np.nan}, Verdict.NONE),
        ({"forbidden": ("inputs",)}, Verdict.NONE),
        ({"size": 1.0, "stuck": STUCK[Verdict.BAD]}, Verdict.SAFE),
        ({"size": 1.1, "stuck": STUCK[Verdict.OPEN]}, Verdict.OPEN),
        ({"size": 1.1, "stuck": STUCK[Verdict.BAD]}, Verdict.BAD),
        ({"size": 1.1, "stuck": STUCK[Verdict.BAD], "build": np.nan}, Verdict.BAD),
        ({"size": 1.1, "stuck": STUCK[Verdict.OPEN], "build": np.nan}, Verdict.NONE),
        ({"size": 0.9, "stuck": STUCK[Verdict.OPEN], "forbidden": ("test_beams",)}, Verdict.NONE),
    ],
)
def test_the_verdict_follows_from_fields(fields, verdict):
    assert answered(**fields).verdict is verdict
    if "size" in fields:  # forces are sufficient where lengths are too long
        of_force = replace(answered(**fields), unit="N", size=2 - fields["size"])
        assert of_force.verdict is verdict


# What bounds nothing, and what nothing moves


@pytest.mark.parametrize("touchdowns", [1, 1000])
@pytest.mark.parametrize("unit", ["m", "N"])
def test_without_a_bound_there_is_no_size(unit, touchdowns):
    one = Condition(0.5, "force", Cause.ESTIMATE, "x", Sampled(np.zeros(100), (), is_bounded=False))
    found = asked([one], budgets([one]), unit=unit, touchdowns=touchdowns, size=0.5 if unit == "m" else 2.0)
    assert np.isnan([found.build, found.exact, *(step.size for step in found.steps)]).all()
    assert found.verdict is Verdict.NONE
    assert found.stuck.high > 0.01


def test_patches_that_hold_nothing_need_no_force():
    one = air(np.full(1000, np.inf), flat=1.0)
    stated = (replace(one.sampled.stated_sizes[0], estimate=np.inf, bound=np.inf),)
    never = replace(one, shape="force", sampled=replace(one.sampled, stated_sizes=stated))
    found = asked([never], budgets([never]), unit="N", size=1e-6)
    assert found.build == 0
    assert found.verdict is Verdict.SAFE
    assert found.stuck.none_seen


@pytest.mark.parametrize(("number", "verdict"), [(0, Verdict.OPEN), (5, Verdict.BAD)])
def test_where_too_few_stick_flats_bound_the_length_also_after_touchdowns(number, verdict):
    values = np.append(np.full(number, -0.5), np.full(1000 - number, np.inf))
    one = air(values, reach=1.0, flat=0.3)
    assert asked([one]).build == pytest.approx(0.3)
    assert asked([one], touchdowns=1000).build == pytest.approx(0.3)
    found = asked([one], budgets([one]), size=0.9)
    assert found.build < 0.3
    assert found.verdict is verdict


def test_devices_that_are_all_alike_stick_at_their_length():
    one = air(np.zeros(1000))
    found = asked([one], budgets([one]), size=1.01)
    assert found.exact == pytest.approx(1)
    assert found.build == pytest.approx(np.exp(-0.2 * 1.645), rel=0.02)
    assert asked([one], size=0.99).stuck.value < 1e-3
    assert asked([one], size=1.01).stuck.value > 0.99


def test_a_size_is_extrapolated_beyond_the_fractions_that_were_verified():
    one = air(lognormal(np.random.default_rng(9)), touchdowns=1000)
    assert not asked([one]).extrapolated
    assert asked([one], touchdowns=1000).extrapolated
    flat = air(np.full(1000, np.inf), reach=1.0, flat=0.3)
    assert not asked([flat], touchdowns=1000).extrapolated


def test_a_liquid_bounds_all_airs_but_moves_no_probability():
    airs, *_ = drawn(1)
    liquid = [Condition(rh, "collapse_x", Cause.DRYING, "life", bound=-3.0, error=0.1) for rh in (0.5, 0.8)]
    found, dry = (asked(some, budgets(airs), size=0.9) for some in ([*airs, *liquid], airs))
    assert found.exact == pytest.approx(np.exp(-3))
    assert_allclose([np.log(one.build) for one in found.airs], -3 - 1.645 * 0.1, atol=0.02)
    assert_allclose([np.log(one.without_tip) for one in found.airs], -3 - 1.645 * 0.1, atol=0.02)
    assert found.stuck == dry.stuck
    assert found.largest_step.cause is Cause.DRYING
    bridge = asked([replace(one, shape="middle") for one in airs[1::2]] + liquid)
    assert np.isnan([one.without_tip for one in bridge.airs]).all()


def test_touchdowns_ask_for_the_fraction_of_one():
    one = air(lognormal(np.random.default_rng(10)), touchdowns=50)
    at = one.sampled.stated_sizes[1]
    assert at.share == probability_for(SHARE, 50)
    world = World((one,), OfBudgets({}), frozenset(Cause), SHARE, 50, Draws(4000, 0))
    assert np.mean(world.stuck(world.size) <= SHARE * (1 + 1e-9)) == pytest.approx(0.95, abs=0.001)


def test_budgets_of_no_known_slopes_move_nothing():
    one = air(lognormal(np.random.default_rng(11)))
    unknown = OfBudgets({(0.5, ARC): slopes((np.nan,))})
    assert asked([one], unknown).build == pytest.approx(asked([one]).build)

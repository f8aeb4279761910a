"""Laws of the answer about a probe: measurements of drawn places fit as often as they should."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stiction.answer.data import INPUTS, Cause, Probability, PullOff, Verdict
from stiction.answer.places import Places, ProbeQuestion, answer, pull_off
from stiction.answer.unknowns import Draws, Exact, OfBudgets, Slopes
from stiction.stages.answer.answer import answer_of, layout

DRAWS = Draws(800, 3)
ASKED = ProbeQuestion("P", "probe", "force", "stoppers")
INPUT, ERROR, SCATTER = 0.3, 0.15, 0.4


def slopes(*errors):
    """Inputs that move the logarithm of all forces by some standard errors."""
    k, names = len(errors), tuple(f"input {number}" for number in range(len(errors)))
    return OfBudgets({(0.5, "force"): Slopes(names, names, np.ones(k), np.zeros(k), np.zeros(k), np.diag(errors) ** 2)})


def forces(number, seed=1, factor=1.0):
    """Lognormal forces of drawn places."""
    return factor * np.exp(SCATTER * np.random.default_rng(seed).standard_normal(number))


def measured(force, error, places, unknowns=None):
    """Answer about a measured force."""
    return answer(replace(ASKED, measured=force, error=error), {0.5: places}, unknowns or Exact(), DRAWS)


@pytest.mark.parametrize(("factor", "low", "high"), [(1.0, 0.0, 0.05), (4.0, 0.5, 1.0)])
def test_few_measurements_of_the_surfaces_do_not_fit_them_and_most_of_another_radius_do_not(factor, low, high):
    """Of 200 drawn places, inputs and errors of measurements; a radius four times as large is the control."""
    rng, misfits, fits = np.random.default_rng(7), 0, 0
    for k in range(200):
        force = factor * np.exp(SCATTER * rng.standard_normal() + INPUT * rng.standard_normal())
        known = ERROR * force
        force = max(force + known * rng.standard_normal(), 1e-3)
        asked = replace(ASKED, measured=force, error=known)
        verdict = pull_off(asked, 0.5, Places(forces(400, k)), slopes(INPUT), DRAWS).verdict
        misfits, fits = misfits + (verdict is Verdict.MISFIT), fits + (verdict is Verdict.FITS)
    assert low <= misfits / 200 <= high + 4 * np.sqrt(high * (1 - high) / 200)
    assert (fits / 200 > 0.85) == (factor == 1)


def test_the_band_of_more_contains_the_errors_of_the_inputs_and_the_rank_those_of_the_places():
    places = Places(forces(400))
    exact, uncertain = (measured(1.5, 0.1, places, unknowns).pull_off for unknowns in (None, slopes(INPUT)))
    assert exact.more.low < exact.more.value < exact.more.high
    assert uncertain.more.high - uncertain.more.low > 3 * (exact.more.high - exact.more.low)
    for one in (exact, uncertain):
        assert one.less.value == pytest.approx(1 - one.more.value)
        assert (one.less.low, one.less.high) == pytest.approx((1 - one.more.high, 1 - one.more.low))
        assert one.two_sided.value == pytest.approx(2 * min(one.less.value, one.more.value))
        assert 0 < one.two_sided.low < one.two_sided.value < one.two_sided.high
    more = measured(1.5, 0.1, replace(places, error=INPUT)).pull_off
    assert more.more.value == pytest.approx(uncertain.more.value, abs=0.02)
    middle = measured(float(np.median(places.forces)), 0.0, places).pull_off.two_sided
    assert middle.high == 1
    assert middle.low < 1


def test_quantiles_of_the_places_have_bands_that_widen_with_the_inputs():
    places = Places(forces(400))
    exact, wide = (measured(1.0, 0.1, places, unknowns).pull_off.quantiles for unknowns in (None, slopes(INPUT)))
    assert_allclose(exact[:, 0], np.quantile(places.forces, [0.05, 0.5, 0.95]))
    assert (exact[:, 1] < exact[:, 0]).all()
    assert (exact[:, 0] < exact[:, 2]).all()
    assert_allclose(np.log(wide[1, 2] / wide[1, 1]), 2 * 1.96 * np.hypot(INPUT, 1.25 * SCATTER / 20), rtol=0.1)


def test_curves_pass_through_the_measured_force_and_fall():
    found = measured(1.5, 0.1, Places(forces(400)), slopes(0.05))
    assert (np.diff(found.sizes) < 0).all()
    assert (np.diff(found.curve, axis=1) >= 0).all()
    at = [np.interp(np.log(1.5), np.log(found.sizes[::-1]), row[::-1]) for row in found.curve]
    assert_allclose(at, [found.stuck.value, found.stuck.low, found.stuck.high], atol=0.04)
    assert found.sizes[0] > found.airs[0].first > found.sizes[-1]
    assert_array_equal(found.curve, found.airs[0].curve)
    assert measured(1.5, 0.1, Places(np.zeros(10))).pull_off.more.value == 0


def test_what_to_measure_is_what_leaves_least_and_causes_say_what_is_inside():
    found = measured(1.0, 0.1, Places(forces(400)), slopes(0.1, 0.3, 0.2))
    assert found.measure == "input 1"
    assert found.included == (Cause.SIMULATION, Cause.INPUTS)
    exact = measured(1.0, 0.1, Places(forces(400)))
    assert (exact.measure, exact.included) == ("", (Cause.SIMULATION,))


def test_without_a_measurement_the_air_is_the_one_where_places_hold_most():
    airs = {0.5: Places(forces(100)), 0.0: Places(forces(100, 2, 3.0)), 0.8: Places(forces(100, 3))}
    found = answer(ASKED, airs, Exact(), DRAWS)
    assert found.verdict is Verdict.PLACES
    assert (found.pull_off.humidity, found.together.humidity, found.stuck) == (0.0, 0.0, None)
    assert [one.humidity for one in found.pull_offs] == [0.5, 0.0, 0.8]
    assert found.sought.shown == "nN"
    assert not found.is_by_tip


@pytest.mark.parametrize(
    ("band", "verdict"),
    [
        ((0.2, 0.05, 0.4), Verdict.FITS),
        ((0.2, 0.049, 0.4), Verdict.UNDECIDED),
        ((0.02, 0.0, 0.05), Verdict.UNDECIDED),
        ((0.02, 0.0, 0.049), Verdict.MISFIT),
    ],
)
def test_the_verdict_follows_from_the_band(band, verdict):
    rank = Probability(*band)
    found = measured(1.0, 0.1, Places(forces(50)))
    judged = replace(found, pull_offs=(PullOff(0.5, found.pull_off.quantiles, 0.1, rank, rank, rank),))
    assert judged.verdict is verdict
    assert replace(judged, forbidden=(INPUTS,)).verdict is Verdict.UNDECIDED
    assert replace(judged, forbidden=(INPUTS, "spacer")).verdict is Verdict.NONE


def test_places_without_a_measured_force_are_stated_for_uncertain_inputs_as_well():
    found = answer(ASKED, {0.5: Places(forces(100))}, slopes(3.0), DRAWS)
    assert replace(found, forbidden=(INPUTS,)).verdict is found.verdict is Verdict.PLACES


@pytest.mark.parametrize("force", [np.nan, 1.5])
def test_an_answer_is_that_of_its_dataset(force):
    found = measured(force, 0.1, Places(forces(50)), slopes(0.1))
    again = answer_of(layout(found))
    assert again.pull_offs == found.pull_offs or np.isnan(force)
    assert (again.stuck, again.measure, again.verdict) == (found.stuck, found.measure, found.verdict)
    assert_array_equal(again.pull_off.quantiles, found.pull_off.quantiles)
    assert_array_equal(again.curve, found.curve)

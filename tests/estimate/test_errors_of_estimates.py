"""Errors of the estimate beside lengths as of a run, and what intervals follow from them."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from stiction.analysis.model_error import few_tip_ratios
from stiction.config.units import to_si
from stiction.estimate.answer import TO_USE
from stiction.estimate.learning import errors as of_estimates
from stiction.estimate.learning.design import FILMS
from stiction.estimate.learning.errors import coverage, margins_of, rest_of, scores
from stiction.estimate.learning.training import FACTORS, SETS, TrainingTips, base, changes_of, plan_of
from stiction.estimate.length import most
from stiction.estimate.promise import kept
from stiction.estimate.table import content, known
from stiction.progress import without_progress
from stiction.stages.contact.pair_model_error import POWER_ERROR

FILM = to_si(FILMS[0], "nm")
(POINT,) = SETS["control"].all
#: Slopes of tips in full contact, which scatter by 10 %.
CHANGED = 0.1 * np.exp(0.1 * np.random.default_rng(3).normal(size=200))


@pytest.fixture(scope="module")
def tips():
    with without_progress():
        return TrainingTips.of(POINT, plan_of(POINT, base()), 3, 1)


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_full_contact_changes_tips_as_the_stiffness_of_their_beam(tips, ratio):
    summits = np.full((64, 3), 0.2)
    changes = changes_of(np.array([0.01, 0.1, 0.3]), ratio * summits[:8], summits)
    own, changed = tips.slopes(FILM, 1.0), tips.slopes(FILM, 1.0, changes)
    middle = FACTORS.index(1.0)
    np.testing.assert_allclose(changed[FACTORS.index(ratio)], own[middle], rtol=1e-6)
    assert np.all(np.abs(np.log(changed[middle] / own[middle])) > 0.05)  # control


def test_few_strips_that_scatter_leave_the_upper_end_of_their_ratio(tips):
    rng = np.random.default_rng(2)
    full, summits = (np.exp(0.3 * rng.normal(size=(n, 3))) for n in (8, 64))
    changes = changes_of(np.array([0.01, 0.1, 0.3]), full, summits)
    ratio, error = few_tip_ratios(full[:, None], summits[:, None], POWER_ERROR)
    np.testing.assert_allclose(changes.change.ratio[0], full.mean(axis=0) / summits.mean(axis=0))
    np.testing.assert_array_equal(changes.change.ratio_error, error)
    alike = 1 + 1e-4 * rng.normal(size=(64, 3))
    exact = changes_of(changes.slopes, ratio * alike[:8], alike)
    assert np.all(tips.slopes(FILM, 1.0, changes) > tips.slopes(FILM, 1.0, exact))


@pytest.mark.parametrize("scatter", [0.1, 0.2, 0.4])
def test_the_upper_end_is_that_of_a_run_for_forces_that_scatter_four_times_as_lengths(scatter):
    rng = np.random.default_rng(5)
    drawn = [[np.exp(scatter * rng.normal(size=(n, 1, 3))) for n in (8, 64)] for _ in range(400)]
    of_run = math.sqrt(np.mean([few_tip_ratios(*each, POWER_ERROR)[1] ** 2 for each in drawn]))
    assert math.log(most(1.0, scatter / 4)) == pytest.approx(1.645 * of_run, rel=0.1)
    assert math.log(most(1.0, scatter / 3)) > 1.2 * 1.645 * of_run  # control
    assert most(0.4, scatter / 4) == pytest.approx(0.4 * most(1.0, scatter / 4))


def of_learnt(monkeypatch, changed):
    """Tested length of a surface from the slopes of its tips in full contact, two points without them beside it."""
    airs = np.array([[3e-9, 1.0]])
    unsettled = {"airs": airs, "changed": np.full_like(changed, np.nan)}
    points = [(POINT, {"airs": airs}), (POINT, unsettled), (POINT, {"airs": airs, "changed": changed})]
    monkeypatch.setattr(of_estimates, "stored", lambda *_: points)
    table, *processes = known()
    (found,) = of_estimates.tested(Path(), "any", table["modulus"], -3.0, lambda _: processes)
    return found


def test_a_tested_length_is_that_of_its_tips_in_full_contact(monkeypatch):
    one, other = (of_learnt(monkeypatch, factor * CHANGED) for factor in (1.0, 2.0))
    assert one.is_known
    assert one.true == pytest.approx(1.5 / 0.1 * math.exp(-0.3), rel=0.1)
    assert other.true == pytest.approx(one.true / 2)
    assert other.estimate == one.estimate
    assert one.error == pytest.approx(math.log(one.true / one.estimate))


def test_a_surface_that_is_refused_has_no_error(monkeypatch):
    monkeypatch.setitem(content(), "modulus", 1e3)
    found = of_learnt(monkeypatch, CHANGED)
    assert not found.is_known
    assert len(scores([found], 0.1)) == 0


def of_errors(slopes, errors):
    """Tested lengths with errors."""
    return [of_estimates.Tested(k, s, math.exp(e), 1.0) for k, (s, e) in enumerate(zip(slopes, errors, strict=True))]


@pytest.mark.parametrize("rest", [0.02, 0.06, 0.2])
def test_the_rest_of_the_difficulty_is_that_of_normal_errors_of_any_size(rest):
    rng = np.random.default_rng(1)
    slopes = np.exp(rng.uniform(math.log(0.005), math.log(0.25), 4000))
    errors = 0.7 * np.hypot(slopes, rest) * rng.normal(size=4000)
    refused = of_estimates.Tested(-1, math.nan, 1.0, math.nan)
    assert rest_of([*of_errors(slopes, errors), refused]) == pytest.approx(rest, rel=0.15)
    assert rest_of(of_errors(slopes, 3 * errors)) == pytest.approx(rest, rel=0.15)
    assert scores(of_errors(slopes, errors), rest).std() == pytest.approx(0.7, rel=0.05)
    assert np.all(np.sign(scores(of_errors(slopes, errors), rest)) == np.sign(errors))


@pytest.mark.parametrize("law", ["normal", "laplace", "exponential"])
@pytest.mark.parametrize("surfaces", [20, 50])
def test_the_end_to_use_keeps_its_promise_for_errors_of_any_law_and_half_of_an_interval_does_not(law, surfaces):
    rng, beyond = np.random.default_rng(6), {TO_USE: [], "90": []}

    def drawn(number):
        """Errors over their difficulties, negative on the unsafe side."""
        return -getattr(rng, law)(size=number)

    for _ in range(600):
        margins, further = margins_of(drawn(surfaces)), drawn(400)
        assert margins["90"] <= margins[TO_USE] <= margins["95"]
        for name, of_name in beyond.items():
            of_name.append(np.mean(further < -margins[name]))
    allowed = 1 - kept("90") / 100
    assert np.mean(beyond[TO_USE]) < allowed + 3 * np.std(beyond[TO_USE]) / math.sqrt(600)
    if law == "exponential":  # all errors are on the unsafe side
        assert np.mean(beyond["90"]) > 1.5 * allowed, "control"


def test_the_end_to_use_is_no_nearer_than_half_of_the_interval():
    errors = np.abs(np.random.default_rng(1).normal(size=50))
    assert margins_of(errors)[TO_USE] == margins_of(errors)["90"]
    assert margins_of(-errors)[TO_USE] > margins_of(errors)[TO_USE], "control"


@pytest.mark.parametrize(("inside", "number"), [(9, 10), (47, 50), (1, 30)])
def test_a_range_of_coverage_ends_where_the_number_inside_has_a_tail_of_a_fortieth(inside, number):
    low, high = coverage(inside, number)
    assert binom.sf(inside - 1, number, low) == pytest.approx(0.025)
    assert binom.cdf(inside, number, high) == pytest.approx(0.025)


def test_none_or_all_inside_have_one_end_without_a_tail():
    assert coverage(0, 10)[0] == 0
    assert coverage(10, 10)[1] == 1
    assert coverage(10, 10)[0] == pytest.approx(0.025**0.1)


def noise_of(monkeypatch, strips, tips):
    """Noise of a length by strips and by tips that scatter so, and of a point that does not settle."""
    rng = np.random.default_rng(5)
    full, summits = (np.exp(strips * rng.normal(size=(n, 3))) for n in (8, 64))
    changed = 0.1 * np.exp(tips * rng.normal(size=200))
    slopes = changed * np.array([0.5, 1.0, 2.0])[:, None] ** -0.3
    point = {"slope": np.array([0.01, 0.1, 0.3]), "full": full, "summits": summits, "changed": changed}
    unsettled = {"changed": np.full(200, np.nan)}
    monkeypatch.setattr(of_estimates, "stored", lambda *_: [(POINT, point | {"slopes": [slopes]}), (POINT, unsettled)])
    (found,) = of_estimates.noise_of(Path(), "any", -3.0)
    return found


def test_noise_of_a_length_is_that_of_its_strips_and_of_its_tips(monkeypatch):
    of_strips, of_tips = noise_of(monkeypatch, 0.3, 0.1)
    alike, of_more = noise_of(monkeypatch, 1e-6, 0.2)
    assert alike < 1e-6 < of_strips
    assert of_more == pytest.approx(2 * of_tips, rel=0.05)
    # Eight strips leave 0.3 / 8^(1/2) of their ratio, whose upper end scatters more, and 0.3 of it in a length.
    assert 0.3 * 0.3 / math.sqrt(8) < of_strips < 2.5 * 0.3 * 0.3 / math.sqrt(8)

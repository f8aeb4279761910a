"""Uncertain play of two surfaces that follow each other: its step, its contacts, and what its errors change."""

import numpy as np
import pytest
from test_uncertain_coherence import errors_between, study

from stiction.answer.unknowns import Draws, OfBudgets, Slopes
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.messages import ConfigError
from stiction.contact.materials import PLAY
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.stages.answer import conditions

COPY, REGISTER = {"coherence": 0.9}, (0.45, "S-shape")


@pytest.mark.parametrize("play", [0.0, 20.0, 50.0, 80.0])
def test_its_errors_are_standard_uncertainties_and_leave_no_play_below_zero(play):
    step = PLAY.step.by(50.0)
    less, more = step.ends(play)
    assert (less, more) == (max(play - 50, 0), play + 50)
    assert step.around(play) == pytest.approx((more - less) / 50)
    assert step.error(play, 50.0) == 1
    assert step.moved(play, -0.1) == max(play - 5, 0)
    assert [step.moved(play, by) for by in (-9, *step.limits(play), 9)] == pytest.approx([0, 0, more, more])


def contacts(plan):
    """Plays of the contacts with less and with more of it of all budgets [nm]."""
    graph = Graph(plan)
    budgets = [graph.job(f"devices/budget/{name}").inputs for name in plan.devices.budgets()]
    names = [budget[key].get("play") for budget in budgets for key in ("properties_less", "properties_more")]
    return [graph.job(name).settings["replica"]["play_nm"] for name in names if name]


def test_a_budget_has_contacts_with_less_and_with_more_of_it():
    assert contacts(Plan(load(study(COPY | {"play_nm": 20}, {"play_nm": 5})))) == [15, 25] * 2
    assert contacts(Plan(load(study(COPY, {"play_nm": 30})))) == [0, 30] * 2, "in register as stated"
    assert not contacts(Plan(load(study(COPY | {"play_nm": 20}, {"coherence": 0.03})))), "control"


def test_it_needs_a_replica_and_is_that_of_its_pair():
    with pytest.raises(ConfigError, match="has no replica"):
        load(study(None, {"play_nm": 20}))
    lever = study(COPY, {"play_nm": 20})["devices"]["Lever"]
    others = {
        play: merged(study(COPY, {"play_nm": 20}), {"devices": {"Other": merged(lever, {"uncertainty": stated})}})
        for play, stated in {20: {}, 30: {"play_nm": 30}, 0: {"play_nm": 0}}.items()
    }
    with pytest.raises(ConfigError, match="is 30, must be that of device Lever on pair r"):
        load(others[30])
    assert all(load(others[play]) for play in (0, 20))


def test_test_beams_of_an_uncertain_replica_are_on_the_same():
    beams = {"pair": "r", "thickness_um": 4, "gap_um": 2, "width_um": 20, "length_um": 900}
    beams |= {"crack_lengths": [{"humidity": 0.45, "mean_um": 300, "std_um": 9, "beams": 9}]}
    file = study(COPY, {"play_nm": 20, "coherence": 0.03})
    file["devices"]["Lever"]["test_beams"] = ["T"]
    load(merged(file, {"test_beams": {"T": beams}}))
    file["pairs"]["other"] = {key: value for key, value in file["pairs"]["r"].items() if key != "replica"}
    with pytest.raises(ConfigError, match="pair other of its test beams has another replica"):
        load(merged(file, {"test_beams": {"T": beams | {"pair": "other"}}}))


def slopes(slope, limits):
    """Slopes of ln l of a play whose errors have limits, and of a gap."""
    limits = None if limits is None else np.array([limits, [-np.inf, np.inf]])
    names, rest = ("play", "gap"), (np.zeros(2), np.zeros(2), np.diag([1.0, 1e-4]), ())
    return Slopes(names, names, np.array([slope, 0.75]), *rest, limits)


def test_answers_are_between_those_in_register_and_far_away():
    draws = Draws(4000, 1)

    def shift(limits, slope=0.8):
        """Shifts of ln l by the play alone."""
        return OfBudgets({REGISTER: slopes(slope, limits)}).shift(REGISTER, draws, frozenset(["gap"]))

    at_zero = shift((0.0, 1.0))
    assert (at_zero.min(), at_zero.max()) == (0, 0.8)
    assert (at_zero == 0).mean() == pytest.approx(0.5, abs=0.04)
    assert shift((-0.4, 1.0)).min() == pytest.approx(-0.32)
    assert shift(None).min() < -2, "control"


def test_nothing_is_subtracted_for_a_play_that_cannot_be_less():
    exact = slopes(0.0, None).margin
    assert slopes(0.8, (0.0, 1.0)).margin == pytest.approx(exact)
    assert slopes(0.8, (-1.0, 1.0)).margin == pytest.approx(np.hypot(exact, 0.4))
    assert slopes(0.8, (-2.5, 1.0)).margin == pytest.approx(slopes(0.8, None).margin), "control"


@pytest.fixture(scope="module")
def budgets():
    """Budgets of a lever whose play is uncertain by some lengths [nm], in register or at a play."""

    def budget(replica, play):
        """Budget along the beam, on summits alone."""
        file = merged(study(replica, {"play_nm": play} if play else {"gap_um": 0.1}), {"contact": {"model": "summits"}})
        return Results(Graph(Plan(load(file))))["devices/budget/Lever_rh045"]

    return budget


@pytest.mark.slow
def test_a_large_uncertainty_spans_lengths_in_register_and_on_independent_surfaces(budgets):
    wide, small = budgets(COPY, 20_000), budgets(COPY, 10)
    register, independent = (budgets(replica, 0) for replica in (COPY, None))
    centres = [(float(np.log(one.centre)), float(one.scatter) / np.sqrt(40)) for one in (register, independent)]
    span = centres[1][0] - centres[0][0], np.hypot(centres[0][1], centres[1][1])
    effect = [(float(one.slope[0]), float(one.slope_error[0])) for one in (wide, small)]
    assert wide.covariance.item() == 1
    assert wide.limit.values.tolist() == [[0, 1]]
    assert errors_between(effect[0], span) < 4
    assert errors_between(effect[1], span) > 4, "control"
    found = conditions.of_budgets([wide], [0.45]).shift((0.45, "beam"), Draws(1000, 0), frozenset())
    assert found.max() <= 1.5 * span[0]

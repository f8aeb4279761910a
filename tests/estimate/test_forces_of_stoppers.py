"""Forces of stoppers in the estimate: closed forms, what a run changes, files and options, and refusals."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm

from stiction.contact.correction import ElasticChange
from stiction.estimate.answer import answer
from stiction.estimate.force import Stopper, reciprocals
from stiction.estimate.learning import errors as of_estimates
from stiction.estimate.learning import patches
from stiction.estimate.learning.design import SIDES, SurfaceLaw
from stiction.estimate.learning.rows import of_forces, patches_of
from stiction.estimate.learning.training import SETS
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import questions
from stiction.estimate.state import OF_PATCHES, PatchState, film
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate, content, known
from stiction.life.freeing import stuck_after

STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": [0.67], "restoring_force_uN": 60}
WATER = film(0.67, 300.0, 2.0)
(POINT,) = SETS["control"].all
AREA = "area in contact in summits"


def asked(**keys):
    """Question about the stopper with other keys."""
    return questions({"devices": {"S": STOPPER | keys}}, content())["S"]


def found(**keys):
    """Answer about the stopper with other keys."""
    return answer(asked(**keys), *known())


def patch_on(sides, area=9e-12):
    """Patch on two surfaces."""
    return PatchState(of_pair(sides), WATER, area, 164e9)


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


def forces_at(first, step=0.2, slope=0.3):
    """Process of forces that grow by a step between scores."""
    return process_of(at_0=first, at_1=first - step, at_2=first - 2 * step, slope=slope)


def test_flooded_flats_hold_with_the_tension_of_the_water():
    patch = patch_on(POINT.sides)
    assert patch.flooded_force == pytest.approx(-8.314462618 * 300 * math.log(0.67) / 1.8e-5 * 9e-12, rel=1e-9)


def test_an_area_moves_its_own_coordinate_alone():
    small, large = (patch_on(POINT.sides, area).coordinates for area in (9e-12, 36e-12))
    moved = np.subtract(large, small)
    assert moved[OF_PATCHES.index(AREA)] == pytest.approx(math.log(4))
    np.testing.assert_allclose(np.delete(moved, OF_PATCHES.index(AREA)), 0, atol=1e-12)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.3])
def test_full_contact_changes_forces_by_its_ratio(ratio):
    patch = patch_on(POINT.sides)
    lengths = reciprocals(patch, forces_at(1.5), process_of(ratio=math.log(ratio), power=0.9))
    assert 1 / lengths.at(0.0) == pytest.approx(ratio * patch.flooded_force * math.exp(-1.5))
    assert 1 / lengths.at(-3.0) == pytest.approx(ratio * patch.flooded_force * math.exp(-1.5 + 0.4 + 0.3))


@pytest.mark.parametrize("power", [1.0, 1.3])
def test_lognormal_forces_change_as_in_a_run(power):
    patch, scatter = patch_on(POINT.sides), 0.25
    forces = patch.flooded_force * np.exp(-1.5 + scatter * np.random.default_rng(1).normal(size=2_000_000))
    changed = np.sort(ElasticChange(0.8, power).of(forces)(forces))
    lengths = reciprocals(patch, forces_at(1.5, scatter, scatter), process_of(ratio=math.log(0.8), power=power))
    for score in (0.0, -0.5, -1.0, -2.0, -3.0):
        assert 1 / lengths.at(score) == pytest.approx(np.quantile(changed, norm.sf(score)), rel=0.01)


@pytest.mark.parametrize("power", [0.8, 1.2])
def test_a_tested_force_is_that_of_its_patches_changed_as_a_run_does(monkeypatch, power):
    rng = np.random.default_rng(3)
    pressures = 1e6 * np.exp(0.3 * rng.normal(size=4000))
    numbers = {"airs": np.array([[3e-9, 1.0]]), "sides": np.array([2.0, 3.0]), "forces": pressures[None]}
    numbers |= {"ratio": 0.7, "power": power}
    points = [(POINT, numbers), (POINT, numbers | {"ratio": np.nan}), (POINT, {"airs": numbers["airs"]})]
    monkeypatch.setattr(of_estimates, "stored", lambda *_: points)
    processes = forces_at(0.5), process_of(ratio=0.0, power=1.0)
    (one,) = of_estimates.tested_forces(Path(), "any", 164e9, -3.0902, lambda _: processes)
    changed = ElasticChange(0.7, max(power, 1.0)).of(pressures)(pressures)
    assert 1 / one.true == pytest.approx(6e-12 * np.quantile(changed, 0.999), rel=0.08)
    assert changed.mean() == pytest.approx(0.7 * pressures.mean(), rel=0.01)
    (patch,) = patches_of(POINT, numbers, 164e9)
    assert 1 / one.estimate == pytest.approx(patch.flooded_force * math.exp(-0.5 + 0.4 + 0.3 * 1.0902))
    assert one.error == pytest.approx(math.log(one.true / one.estimate))


def test_quantities_of_forces_are_those_of_their_reciprocals():
    patch = patch_on(POINT.sides)
    pressures = patch.flooded_force / patch.area * np.exp(-2 + 0.25 * np.random.default_rng(1).normal(size=20_000))
    quantities = of_forces(pressures, patch)
    for name, value in {"at_0": 2.0, "at_1": 1.75, "at_2": 1.5, "slope": 0.25}.items():
        assert quantities[name] == pytest.approx(value, abs=0.03), name


def test_more_force_leaves_fewer_stuck_within_intervals_and_touchdowns_need_more():
    once, often = found(), found(touchdowns=100)
    forces = [row.force for row in once.rows]
    assert forces == sorted(forces)
    for row in once.rows:
        (low90, high90), (low95, high95) = row.intervals["90"], row.intervals["95"]
        assert low95 <= low90 < row.force < high90 <= high95
    assert all(more.force > row.force for row, more in zip(once.rows, often.rows, strict=True))


def test_the_fraction_at_a_force_is_that_of_its_row_after_all_touchdowns():
    row = found().chosen
    value, low, high = answer(replace(asked(), force=row.force), *known()).stuck
    assert value == pytest.approx(row.fraction, rel=1e-3)
    assert low < value < high
    often = answer(replace(asked(touchdowns=50), force=row.force), *known()).stuck[0]
    assert often == pytest.approx(float(stuck_after(row.fraction, 50)), rel=1e-3)
    assert answer(replace(asked(), force=1e-9), *known()).stuck[0] == asked().most == 0.5
    assert asked(touchdowns=2).most == 0.75


def test_a_larger_area_holds_more_and_the_driest_of_two_airs_does_not_decide():
    assert found(contact_um=[4, 4]).chosen.force > found().chosen.force
    both, wetter = found(humidities=[0.5, 0.85]), found(humidities=[0.85])
    assert both.chosen == wetter.chosen
    assert both.humidity == 0.85


def test_a_spring_has_the_force_of_its_gap():
    stated = {key: value for key, value in STOPPER.items() if key != "restoring_force_uN"}
    spring = questions({"devices": {"S": stated | {"stiffness_N_per_m": 30, "gap_um": 2}}}, content())["S"]
    assert spring.force == pytest.approx(60e-6)
    assert isinstance(spring, Stopper)


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"contact_um": [3, 30]}, "from 1 to 6 µm"),
        ({"contact_um": [0.5, 3]}, "from 1 to 6 µm"),
        ({"restoring_force_uN": 0}, "restoring_force_uN must be above 0, got 0"),
        ({"tilt_deg": [0.1]}, "tilt_deg"),
        ({"voltage_V": 3}, "its file is not complete, at 'dielectric'"),
        ({"humidities": [0.999]}, "beyond what was learnt"),
        ({"kind": "probe", "radius_um": 5}, "only cantilevers, bridges and stoppers"),
    ],
)
def test_a_stopper_that_was_not_learnt_has_no_number(keys, reason):
    with pytest.raises(NotLearnt, match=reason):
        found(**keys)


def test_sides_of_a_point_are_within_their_range_and_its_own():
    drawn = np.array([patches.sides_of(point, 3, SurfaceLaw.ANY) for point in SETS["learn_any"].all])
    assert drawn.min() >= SIDES[0]
    assert drawn.max() <= SIDES[1]
    assert len(np.unique(drawn, axis=0)) > 0.9 * len(drawn)
    assert np.median(drawn) == pytest.approx(math.sqrt(SIDES[0] * SIDES[1]), rel=0.15)
    assert patches.sides_of(POINT, 3, SurfaceLaw.PAPER) == (3.0, 3.0)


def test_numbers_of_a_point_have_full_contact_where_the_set_has_it(monkeypatch):
    changes = {"ratio": 0.8, "ratio_error": 0.05, "power": 1.1}
    monkeypatch.setattr(patches, "plan_of", lambda *_: None)
    monkeypatch.setattr(
        patches, "forces_of", lambda _point, _plan, heights, number, _seed: np.ones((len(heights), number))
    )
    monkeypatch.setattr(patches, "change_of", lambda *_: changes)
    of = SETS["learn_any"]
    with_it, without = (patches.computed(replace(POINT, number=number), "learn_any", {}) for number in (2, 3))
    assert with_it["forces"].shape == without["forces"].shape == (of.states, of.patches)
    assert {key: with_it[key] for key in changes} == changes
    assert not set(changes) & set(without)

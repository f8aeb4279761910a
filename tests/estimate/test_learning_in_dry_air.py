"""Learning of the estimate in dry air: points, contacts that scale with the solids, rows, and errors."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm

from stiction.analysis.model_error import tip_ratios
from stiction.config.units import to_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.correction import ElasticChange
from stiction.estimate import dry as of_dry_air
from stiction.estimate.learning import dry, dry_patches, dry_rows, training
from stiction.estimate.learning.design import SurfaceLaw
from stiction.estimate.learning.training import FACTORS
from stiction.estimate.table import Surrogate
from stiction.plan.plan import Plan
from stiction.progress import without_progress
from stiction.stages.contact import tips_in_full_contact

(POINT,) = dry.SETS["control"].all
RNG = np.random.default_rng(2)
#: Attractions of tips at three slopes in full contact and on summits.
FULL, SUMMITS = (np.exp(0.3 * RNG.normal(size=(20, 3))) for _ in range(2))


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


def pressures_of(constant, modulus=164):
    """Pull-off pressures of patches of the control point with a Hamaker constant [J] and a modulus [GPa]."""
    plan = dry_patches.patches.plan_of(POINT, (1.0, 1.0), dry_patches.base())
    plan = Plan(plan.config | {"solid": plan.config["solid"] | {"young_modulus_GPa": modulus}})
    with without_progress():
        return dry_patches.forces_of(dry.with_constant(plan, constant), "control", POINT.number)


def test_forces_of_solids_grow_with_their_modulus_if_they_attract_as_much_more():
    own, scaled, alone = pressures_of(1e-19), pressures_of(2e-19, 328), pressures_of(2e-19)
    np.testing.assert_allclose(scaled, 2 * own, rtol=1e-4)
    assert np.all(np.abs(np.log(alone / scaled)) > 0.02), "the control: the constant alone"


def test_constants_of_points_are_within_their_range_and_of_the_paper_polysilicons():
    drawn = np.array([dry.constants(point, "learn_any") for point in dry.SETS["learn_any"].all])
    assert drawn.shape == (dry.SETS["learn_any"].points, dry.SETS["learn_any"].states)
    low, high = to_si(np.array(dry.CONSTANTS), "zJ")
    assert np.all((low <= drawn) & (drawn <= high))
    assert np.median(drawn) == pytest.approx(math.sqrt(low * high), rel=0.2)
    assert len(np.unique(drawn)) > 0.9 * drawn.size
    assert dry.constants(POINT, "check_paper").tolist() == [HAMAKER_CONSTANT["dry"]]


def test_points_in_dry_air_are_the_first_of_those_in_humid_air():
    for name, effort in dry.SETS.items():
        assert effort.all == training.SETS[name].all[: effort.points]
        assert effort.seed == training.SETS[name].seed


@pytest.mark.parametrize(("error", "strips"), [(0.1, 20), (0.18, 30), (0.3, 60), (2.0, 60)])
def test_a_run_draws_strips_until_the_error_is_small(error, strips):
    errors = np.array([0.5, 1.0]) * error
    np.testing.assert_allclose(dry.in_run(errors, 20), errors * math.sqrt(20 / strips))
    assert strips == tips_in_full_contact.MOST or np.all(dry.in_run(errors, 20) <= tips_in_full_contact.ACCURACY)
    np.testing.assert_allclose(dry.in_run(errors * 2, 5), dry.in_run(errors, 20))


def test_changes_are_those_of_a_run_with_a_power_of_at_least_one():
    slopes = np.array([0.03, 0.08, 0.2])
    changes, ratios = dry.changes_of(slopes, FULL, SUMMITS**2), tip_ratios(FULL[:, None], SUMMITS[:, None] ** 2)
    np.testing.assert_allclose(changes.change.ratio, ratios.means)
    assert ratios.powers < 1
    assert changes.change.power == 1
    assert dry.changes_of(slopes, FULL**2, SUMMITS).change.power > 1.5
    np.testing.assert_allclose(changes.change.ratio_error, dry.in_run(ratios.error, 20))


def stored_tips(monkeypatch, **more):
    """One computed point of tips on the control point, and the same with numbers that do not settle."""
    slopes = 0.05 * np.exp(0.1 * RNG.normal(size=(1, 3, 200)))
    numbers = {"constants": np.array([1.5e-19]), "slopes": slopes, "slope": np.array([0.03, 0.08, 0.2])}
    numbers |= {"full": FULL, "summits": SUMMITS, "changed": 0.06 * np.exp(0.1 * RNG.normal(size=2000))} | more
    lost = numbers | {"full": np.full_like(FULL, np.nan), "changed": np.array([np.nan])}
    monkeypatch.setattr(dry_rows, "stored", lambda *_: [(POINT, numbers), (POINT, lost)])
    return numbers


def test_rows_of_tips_are_slopes_over_those_of_flats(monkeypatch):
    numbers = stored_tips(monkeypatch)
    rows = dry_rows.rows_of_tips(Path(), "learn", 164e9)
    tips = dry_rows.tips_of(POINT, 1.5e-19, 164e9)
    assert len(rows.surface) == 2 * len(FACTORS)
    for k, tip in enumerate(tips):
        np.testing.assert_allclose(rows.coordinates[k], tip.coordinates)
        expected = np.median(np.log(tip.flat_slope / numbers["slopes"][0, k]))
        assert rows.values["at_0"][k] == pytest.approx(expected, abs=1e-6)
    assert tips[0].stiffness == pytest.approx(FACTORS[0] * POINT.stiffness)


def test_rows_of_full_contact_are_what_a_run_applies_at_each_slope(monkeypatch):
    numbers = stored_tips(monkeypatch)
    rows, changes = dry_rows.rows_of_full(Path(), "learn", 164e9), dry.changes_of(numbers["slope"], FULL, SUMMITS)
    assert len(rows.surface) == 3
    upper = changes.change.ratio * np.exp(norm.ppf(0.95) * changes.change.ratio_error)
    np.testing.assert_allclose(rows.values["ratio"], np.log(upper[0]), rtol=1e-6)
    np.testing.assert_allclose(rows.values["power"], changes.change.power[0])
    softness = next(k for k, name in enumerate(of_dry_air.OF_TIPS) if name.startswith("softness"))
    slope = dry_rows.tips_of(POINT, 1.5e-19, 164e9)[0].heights.slope
    np.testing.assert_allclose(rows.coordinates[:, softness], np.log(numbers["slope"] / slope))


def test_a_tested_length_is_that_of_its_changed_tips(monkeypatch):
    numbers = stored_tips(monkeypatch)
    processes = process_of(at_0=1.0, at_1=0.9, at_2=0.8, slope=0.1), process_of(ratio=0.0, power=1.0)
    (one,) = dry_rows.tested(Path(), "any", 164e9, -3.0, lambda _: processes)
    assert one.true == pytest.approx(np.quantile(1.5 / numbers["changed"], 0.00135), rel=0.05)
    tip = dry_rows.tips_of(POINT, 1.5e-19, 164e9)[FACTORS.index(1.0)]
    assert one.estimate == pytest.approx(1.5 / tip.flat_slope * math.exp(0.7))


@pytest.mark.parametrize("power", [0.9, 1.3])
def test_a_tested_force_and_its_rows_are_those_of_its_patches(monkeypatch, power):
    pressures = 2e5 * np.exp(0.4 * RNG.normal(size=(1, 4000)))
    numbers = {"constants": np.array([1.5e-19]), "sides": np.array([2.0, 3.0]), "forces": pressures}
    numbers |= {"ratio": 1.4, "ratio_error": 0.05, "power": power}
    monkeypatch.setattr(dry_rows, "stored", lambda *_: [(POINT, numbers), (POINT, numbers | {"ratio": math.nan})])
    processes = process_of(at_0=5.0, at_1=4.6, at_2=4.2, slope=0.4), process_of(ratio=0.0, power=1.0)
    (one,) = dry_rows.tested_forces(Path(), "any", 164e9, -3.0902, lambda _: processes)
    changed = ElasticChange(1.4, max(power, 1.0)).of(pressures[0])(pressures[0])
    assert 1 / one.true == pytest.approx(6e-12 * np.quantile(changed, 0.999), rel=0.1)
    patch = dry_rows.patches_of(POINT, numbers, 164e9)[0]
    assert patch.area == pytest.approx(6e-12)
    assert 1 / one.estimate == pytest.approx(patch.flat_force * math.exp(-4.2 + 0.4 * 1.0902))
    rows, ratios = (of(Path(), "learn", 164e9) for of in (dry_rows.rows_of_patches, dry_rows.rows_of_ratios))
    expected = np.median(np.log(patch.flat_force / (6e-12 * pressures)))
    np.testing.assert_allclose(rows.values["at_0"], expected, atol=1e-3)
    assert ratios.values["ratio"] == pytest.approx([math.log(1.4)])
    assert ratios.values["power"] == pytest.approx([max(power, 1.0)])
    assert ratios.noise == pytest.approx([0.05])
    np.testing.assert_allclose(ratios.coordinates, [patch.coordinates])


def test_full_contact_that_is_not_found_has_no_ratio(monkeypatch):
    def refuse(*_):
        raise ValueError("no strip resists")

    monkeypatch.setattr(dry_patches.full_contact, "compute", refuse)
    monkeypatch.setattr(dry_patches, "surfaces_of", lambda _: [])
    plan = dry.with_constant(dry_patches.patches.plan_of(POINT, (2.0, 2.0), dry_patches.base()), 1e-19)
    assert all(map(math.isnan, dry_patches.change_of(plan, "control", 0).values()))


def test_numbers_of_a_point_have_all_its_constants_and_full_contact_at_the_first(monkeypatch):
    seen = []
    monkeypatch.setattr(dry, "drawn", lambda plan, *_: plan)
    monkeypatch.setattr(dry, "slopes_of", lambda plan, changes=None: np.full((3, 4), 2.0 if changes else 1.0))
    monkeypatch.setattr(
        dry,
        "full_contact_of",
        lambda plan, *_: seen.append(plan) or {"slope": np.ones(3), "full": FULL, "summits": SUMMITS},
    )
    point = replace(POINT, number=3)
    numbers = dry.computed(point, "learn_any", dry.base())
    assert numbers["slopes"].shape == (2, 3, 4)
    np.testing.assert_array_equal(numbers["changed"], 2.0)
    first = seen[0].config["materials"]["OfS"]["hamaker_constant_zJ"]["dry"]
    assert first == pytest.approx(1e21 * dry.constants(point, "learn_any")[0])
    assert dry.SETS["check_paper"].law is SurfaceLaw.PAPER

"""Stage answer on small datasets: never beyond what stage life says of stated conditions, and what it leaves out."""

from dataclasses import astuple, replace
from functools import cache
from unittest.mock import patch

import numpy as np
import pytest
import xarray as xr
from ground import C1, R1, SLOPES, VECTORS, WATER, lognormal_cracks, wanted
from numpy.testing import assert_allclose, assert_equal
from plans import job_settings

from stiction.answer.data import Cause, Verdict
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.life.freeing import probability_for
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.answer import tables, words
from stiction.report.format import safe_size
from stiction.stages.answer import answer, beside, conditions
from stiction.stages.contact import curves
from stiction.stages.devices import safe_lengths, stoppers
from stiction.stages.devices.opening import ARC, EITHER, FORCE, S_SHAPE
from stiction.stages.life import beams
from stiction.stages.life.answers import answers_of
from stiction.stages.life.inputs import BeamErrors, BeamKeys, Liquid, StopperKeys
from stiction.stages.life.stoppers import stopper_answers

TIPS = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
AIRS, OXIDE = {0.44: 1.0, 0.67: 1.5}, Dielectric(100e-9, 4.0)
LIQUIDS = {"water": Liquid(0.072), "mine": Liquid(0.6)}
SIGMA = 0.04


@pytest.fixture(autouse=True)
def few_draws(monkeypatch):
    """Draws that leave 2 % in a size, or nothing where a stated bound decides."""
    monkeypatch.setattr(answer, "DRAWS", 1000)


@cache
def of_device(device, factor, shares=(1e-2, 1e-3), voltage=None, tips=1.0):
    """Safe lengths of a device on smooth surfaces with energies times factors, at a voltage if there is one."""
    water = WATER if voltage is None else replace(WATER, capacitor=Capacitor(OXIDE, voltage))

    def added(water):
        """Energy of flats at the voltage [J m⁻²]."""
        return water.capacitor.work(0.0) if water.capacitor else 0.0

    drawn = {
        "vectors": lambda _, __, water: (VECTORS + [added(water), 0, 0, 0], 5e6),
        "tip_forces": lambda _, __, water: (SLOPES, (tips * factor * TIPS[:, None] + added(water)) / SLOPES),
    }
    own, tips_of = replace(wanted(device, shares), water=water), xr.Dataset() if device is C1 else None
    with patch.multiple(curves, **drawn):
        if voltage is None:
            return safe_lengths.compute(lognormal_cracks(device), own, tips_of)
        return safe_lengths.compute_at_voltage(xr.Dataset(), lognormal_cracks(device), own, tips_of)


def budget(response, slopes=(0.5, 1.0), names=("thickness", "gap")):
    """Budget of two inputs known to 4 %."""
    k = len(slopes)
    values = {"slope": slopes, "slope_error": np.full(k, 0.02), "bend": np.zeros(k), "group": list(names)}
    return xr.Dataset(
        {name: ("input", list(value)) for name, value in values.items()}
        | {"covariance": (("input", "other"), SIGMA**2 * np.eye(k))}
        | {"centre": ((), 1e-4, {"response": response, "share": 1e-3})},
        coords={"input": list(names), "other": list(names)},
    )


def data_of_beam(device=C1, airs=AIRS, voltage=0.0, touchdowns=1, budgets=(), **more):
    """Datasets of a beam, and the settings of its answer."""
    lengths = {rh: of_device(device, factor, **more) for rh, factor in airs.items()}
    rare = (probability_for(1e-3, touchdowns),)
    after = {rh: of_device(device, factor, rare, **more) for rh, factor in airs.items()} if touchdowns > 1 else {}
    biased = {rh: of_device(device, factor, voltage=voltage, **more) for rh, factor in airs.items()} if voltage else {}
    stated = {"voltage": voltage, "dielectric": OXIDE} if voltage else {}
    errors = BeamErrors(thickness=SIGMA * device.thickness) if budgets else BeamErrors()
    of = BeamKeys(device=device, density=2330.0, liquids=LIQUIDS, uncertainty=errors, touchdowns=touchdowns, **stated)
    life = beams.layout(beams.beam_answers(lengths, after, of, biased or None), of)
    names = [rh for rh in airs for _ in budgets]
    data = {"lengths": lengths, "after": after, "biased": biased, "life": life, "budgets": list(budgets) * len(airs)}
    return data, answer.Settings(1, "D", of.device.kind, touchdowns=touchdowns, beam=device, budgets=tuple(names))


def rows(data):
    """Rows of stage life by name."""
    return {row.name: row for row in answers_of(data["life"])}


CANTILEVER = (budget(S_SHAPE), budget(ARC))
BEAMS = {
    "cantilever": {},
    "liquid": {},
    "touchdowns": {"touchdowns": 100},
    "voltage": {"voltage": 3.0},
    "all": {"voltage": 3.0, "touchdowns": 100, "budgets": CANTILEVER},
    "bridge": {"device": R1, "airs": {0.67: 1.0}, "touchdowns": 20, "voltage": 3.0},
    "dry": {"airs": {0.0: 1.0}, "touchdowns": 100},
}


@pytest.mark.parametrize("name", BEAMS)
def test_a_beam_is_within_all_that_stage_life_says_of_stated_conditions(name):
    data, settings = data_of_beam(**BEAMS[name])
    settings, of_life = replace(settings, liquids=("mine",) * (name == "liquid")), rows(data)
    found = answer.compute(data, settings)
    stated = [row.low for key, row in of_life.items() if key.startswith("safe_length_")]
    stated += [of_life[key].low for key in ("after", "at_voltage") if key in of_life]
    stated += [of_life["collapse_mine"].low] if settings.liquids else []
    stated = [low for low in stated if np.isfinite(low)]
    assert 0 < found.build <= min(stated) * (1 + 1e-9)
    assert found.exact <= min(stated) * (1 + 1e-9)
    expected = [Cause.SIMULATION] + [Cause.TOUCHDOWNS] * (settings.touchdowns > 1)
    expected += (
        [Cause.VOLTAGE] * bool(data["biased"])
        + [Cause.DRYING] * len(settings.liquids)
        + [Cause.INPUTS] * bool(data["budgets"])
    )
    assert found.included == tuple(expected)
    if not (settings.touchdowns > 1 and data["biased"]):
        assert found.exact == pytest.approx(min(stated), rel=1e-9)
    assert_equal(astuple(answer.answer_of(answer.layout(found))), astuple(found))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_no_drawn_beam_is_longer_than_what_stage_life_says_of_its_stated_conditions(seed):
    rng = np.random.default_rng(seed)
    airs = dict(zip((0.45, 0.67, 0.9), rng.uniform(0.5, 2.0, rng.integers(1, 4)), strict=False))
    stated = {"touchdowns": int(10 ** rng.integers(0, 5)), "voltage": float(rng.choice([0.0, rng.uniform(1, 6)]))}
    budgets = CANTILEVER if rng.uniform() < 0.5 else ()
    device = {} if budgets or rng.uniform() < 0.5 else {"device": R1}
    data, settings = data_of_beam(airs=airs, budgets=budgets, **device, **stated)
    settings, of_life = replace(settings, liquids=("mine",)), rows(data)
    names = ("after", "at_voltage", "collapse_mine")
    limits = [row.low for key, row in of_life.items() if key.startswith("safe_length_") or key in names]
    found, most = answer.compute(data, settings), np.nanmin(limits)
    assert 0 < found.build <= most * (1 + 1e-9)
    assert found.steps[0].size > most, "control: the estimate is longer"


def test_no_margin_is_twice_in_the_length_at_a_voltage_and_after_touchdowns():
    """The inputs alone take what they do without these conditions."""
    plain, more = (
        answer.compute(*data_of_beam(budgets=CANTILEVER, **stated))
        for stated in ({}, {"voltage": 3.0, "touchdowns": 100})
    )
    assert more.build < 0.9 * plain.build
    parts = [found.build / found.exact for found in (plain, more)]
    assert parts[0] < 0.97
    assert parts[1] == pytest.approx(parts[0], abs=0.015)


def test_only_stated_liquids_count():
    data, settings = data_of_beam()
    without, with_mine = (answer.compute(data, replace(settings, liquids=some)) for some in ((), ("mine",)))
    assert without.build > with_mine.build == pytest.approx(rows(data)["collapse_mine"].low)
    assert with_mine.largest_step.cause is Cause.DRYING
    assert all(one.build == with_mine.build for one in with_mine.airs)


def test_a_stated_length_is_judged():
    data, settings = data_of_beam(budgets=CANTILEVER)
    build = answer.compute(data, settings).build
    for factor, verdict in ((0.99, Verdict.SAFE), (1.05, Verdict.OPEN), (2.0, Verdict.BAD)):
        assert answer.compute(data, replace(settings, length=factor * build)).verdict is verdict


def test_tips_that_never_hold_leave_the_bound_of_flats():
    data, settings = data_of_beam(tips=1e-9, airs={0.67: 1.0})
    with np.errstate(all="raise"):
        found = answer.compute(data, settings)
    assert found.build == pytest.approx(rows(data)["safe_length_0.67"].low)
    assert found.verdict is Verdict.BUILD


def test_inputs_of_no_known_effect_are_left_out():
    unknown = (budget(S_SHAPE), budget(ARC, (np.nan, np.nan)))
    data, settings = data_of_beam(budgets=unknown)
    assert "inputs" in answer.compute(data, settings).left_out
    data, settings = data_of_beam(budgets=CANTILEVER)
    assert answer.compute(data, settings).left_out == ()


def test_a_requirement_of_fewer_stuck_devices_than_the_answer_allows_is_left_out():
    data, settings = data_of_beam()
    share = answer.compute(data, settings).share
    for required, left_out in ((share / 10, ("requirement",)), (share, ()), (5 * share, ())):
        found = answer.compute(data, replace(settings, required=required))
        assert found.left_out == left_out
        assert ("the smaller fraction that it requires" in words.contains(found)) == bool(left_out)


def test_a_voltage_that_nothing_bounds_is_left_out_by_name():
    for device, left_out in ((R1, ("voltage",)), (C1, ())):
        data, settings = data_of_beam(device, airs={0.67: 1.0}, voltage=3.0)
        at_breakdown = answer.compute(data | {"biased": {}}, settings)
        assert at_breakdown.left_out == left_out
        assert (Cause.VOLTAGE in at_breakdown.included) is not bool(left_out)
        assert answer.compute(data, settings).left_out == ()


def test_whole_surfaces_of_a_budget_are_members_of_their_kind():
    shifts, of = [0.0, 0.4, -0.5, 0.3, 0.0, 0.1, 0.05], ["B2"] * 4 + ["Sub1"] * 3
    members = {"member_shift": ("member", shifts), "member_error": ("member", np.zeros(len(shifts)))}
    budgets = [one.assign(members).assign_coords(member_of=("member", of)) for one in CANTILEVER]
    found = answer.compute(*data_of_beam(budgets=budgets))
    assert found.measure == "the surface B2"
    assert found.build < found.if_measured
    unknowns = conditions.of_budgets(budgets, (0.67, 0.67))
    assert unknowns.groups == ("the surface B2", "the surface Sub1", "thickness", "gap")
    (first, second) = unknowns.budgets[0.67, EITHER].members
    assert_allclose([*first.shifts, *second.shifts], shifts)


def test_inputs_that_are_too_uncertain_forbid_a_number():
    large = (budget(S_SHAPE), budget(ARC, (8.0, 10.0)))
    found = answer.compute(*data_of_beam(budgets=large))
    assert found.forbidden == ("inputs",)
    assert found.verdict is Verdict.NONE


def test_dry_and_humid_air_have_inputs_of_their_own():
    data, settings = data_of_beam(airs={0.0: 1.0, 0.67: 1.2}, budgets=CANTILEVER)
    wet = [budget(of, (0.5, 1.0, 3.0), ("thickness", "gap", "humidity")) for of in (S_SHAPE, ARC)]
    same, more = (answer.compute(data | {"budgets": [*CANTILEVER, *some]}, settings) for some in (CANTILEVER, wet))
    assert [one.humidity for one in more.airs] == [0.0, 0.67]
    assert more.airs[0].build == pytest.approx(same.airs[0].build, rel=1e-12)
    assert more.airs[1].build < same.airs[1].build
    assert more.measure == "humidity"


# Test beams


def update(p_value, humidities=AIRS, responses=(S_SHAPE, ARC), spread=0.02):
    """Dataset of test beams that shorten lengths by 5 %."""
    places = [(humidity, response) for humidity in humidities for response in responses]
    scores = np.linspace(-4, 4, 17)
    return xr.Dataset(
        {
            "p_value": p_value,
            "result_after": ("result", np.full(len(places), spread)),
            "result_quantile": (("result", "score"), np.tile(-0.05 + spread * scores, (len(places), 1))),
        },
        coords={
            "score": scores,
            "humidity_of_result": ("result", [humidity for humidity, _ in places]),
            "response": ("result", [response for _, response in places]),
        },
    )


def test_reliable_test_beams_take_the_place_of_the_inputs_and_contradicted_ones_forbid_a_number():
    data, settings = data_of_beam(budgets=CANTILEVER)
    without = answer.compute(data, settings)
    found = answer.compute(data | {"test_beams": update(0.5)}, settings)
    assert found.included == (Cause.SIMULATION, Cause.TEST_BEAMS)
    assert found.without_test_beams == pytest.approx(without.build, rel=1e-9)
    assert np.exp(-0.05 - 2 * 0.02) < found.build / found.exact < np.exp(-0.05)
    against = answer.compute(data | {"test_beams": update(0.01)}, settings)
    assert against.forbidden == ("test_beams_contradict",)
    assert against.verdict is Verdict.NONE
    assert against.included == without.included


def test_test_beams_of_a_stopper_move_its_force():
    data, settings = data_of_stopper()
    found = answer.compute(data | {"test_beams": update(0.5, responses=(FORCE,))}, settings)
    exact = answer.compute(data, settings)
    # Forces that are 5 % smaller, with an error of 2 %.
    assert np.exp(-0.05) < found.build / exact.build < np.exp(-0.05 + 2 * 0.02)


# Stoppers

TILTS = (0.0, 0.001, 0.01)


def data_of_stopper(patches=4000, touchdowns=1, voltage=0.0, tilted=False, force=18.99e-6, scale=5e-6):
    """Datasets of a stopper with lognormal forces, and the settings of its answer."""
    rng = np.random.default_rng(5)
    own = stoppers.Settings(1, WATER, (3e-6, 3e-6), tuple(AIRS), (0.4, 0.9), restoring_force=force)
    axis = np.linspace(0.4, 0.9, 11)
    forces = np.outer(list(AIRS.values()), scale * np.exp(0.3 * rng.standard_normal(patches)))
    along = np.outer(1 - (axis - 0.6) ** 2, forces[0])
    data = {"stopper": stoppers.layout(own, forces, axis, along), "budgets": []}
    data["separation"] = xr.Dataset({"pull_off": data["stopper"].pull_off * 1.2})
    if tilted:
        each = forces * np.array([1.0, 1.1, 0.8])[:, None, None] * np.exp(0.1 * rng.standard_normal((3, 2, patches)))
        shared = stoppers.Tilted(**vars(own), slopes=TILTS)
        data["tilted"] = stoppers.layout_tilted(shared, each, np.array([0.01, 0.01]))
    if voltage:
        water = replace(WATER, capacitor=Capacitor(OXIDE, voltage))
        added = 0.5 * water.capacitor.largest_pressure * 9e-12
        biased = stoppers.layout(own, forces + added, axis, along + added)
        data["biased"] = biased.assign(freeing_potential=biased.pull_off * 0 + 10.0)
    stated = {"voltage": voltage, "dielectric": OXIDE} if voltage else {}
    of = StopperKeys(restoring_force=force, contact=(3e-6, 3e-6), touchdowns=touchdowns, electrode=None, **stated)
    some = (data.get(name) for name in ("biased", "tilted", "separation"))
    data["life"] = beams.layout(stopper_answers(data["stopper"], of, *some), of)
    return data, answer.Settings(1, "S", "stopper", touchdowns=touchdowns)


STOPPERS = {
    "parallel": {},
    "touchdowns": {"touchdowns": 3},
    "tilted": {"tilted": True},
    "voltage": {"voltage": 3.0},
    "all": {"touchdowns": 3, "tilted": True, "voltage": 3.0},
}


@pytest.mark.parametrize("name", STOPPERS)
def test_a_stopper_has_at_least_the_forces_that_stage_life_says_of_stated_conditions(name):
    data, settings = data_of_stopper(**STOPPERS[name])
    found, of_life = answer.compute(data, settings), rows(data)
    assert found.share == 1e-3
    least = [float(data["stopper"].safe_force.sel(part="safe", share=1e-3).max())]
    least += [row.high for key, row in of_life.items() if key in ("after", "restoring_force_tilted")]
    least += [least[0] + of_life["at_voltage"].high] if "at_voltage" in of_life else []
    assert found.build >= max(least) * (1 - 1e-9)
    if settings.touchdowns == 1:
        assert found.build == pytest.approx(max(least), rel=1e-9)
    assert [step.cause for step in found.steps if not step.stated] == [Cause.FAST]
    assert found.verdict is (Verdict.SAFE if found.build < 18.99e-6 else found.verdict)
    assert_equal(astuple(answer.answer_of(answer.layout(found))), astuple(found))


def test_a_stated_shock_puts_fast_separation_inside_and_moves_it_between_no_numbers():
    """The size to build then is that after the step that stands beside without it."""
    data, settings = data_of_stopper()
    slow, shaken = (answer.compute(data, replace(settings, shock=shock)) for shock in (0.0, 3e4))
    (beside,) = [step for step in slow.steps if step.cause is Cause.FAST]
    assert slow.build < beside.size == shaken.build
    assert all(step.stated for step in shaken.steps)
    assert (Cause.FAST in slow.included, Cause.FAST in shaken.included) == (False, True)
    assert [step.size for step in slow.steps] == [step.size for step in shaken.steps]
    named = [list(tables.steps(one)["step"]) for one in (slow, shaken)]
    assert [[row for row in of if "shock" in row] for of in named] == [
        ["fast separation, as in a shock (not stated)"],
        ["fast separation, as in a shock: to build"],
    ]


@pytest.mark.parametrize("uncertain", [False, True])
def test_what_is_not_stated_has_one_size_in_the_ladder_and_in_the_first_sentence(uncertain):
    data, settings = data_of_stopper()
    found = answer.compute(data, settings)
    if uncertain:
        found = replace(found, build=1.1 * found.build, unasked=())
        found = replace(found, unasked=beside.unasked(data["life"], found))
    (fast,) = found.unasked
    (step,) = (step for step in found.steps if step.cause is Cause.FAST)
    assert (step.size == pytest.approx(fast.size, rel=1e-9)) is not uncertain, "the ladder's own is before the inputs"
    *_, build, last = tables.steps(found).itertuples(index=False)
    assert last[1] == safe_size(fast.size, found.sought)
    assert last[0] == "fast separation, as in a shock (not stated)"
    assert (build[0].endswith(": to build"), "to build" in last[0]) == (True, False)
    forbidden = tables.steps(replace(found, forbidden=("gap",)))
    assert not any("to build" in text for text in forbidden["step"])


def test_a_shock_that_nothing_bounds_is_stated_but_not_inside():
    data, settings = data_of_beam(R1, {0.67: 1.0})
    data["fast_strips"] = {0.67: xr.Dataset({"factor": 0.0, "factor_error": np.nan})}
    shaken, slow = (answer.compute(data, replace(settings, shock=shock)) for shock in (3e4, 0.0))
    assert ("shock" in shaken.left_out, "shock" in slow.left_out) == (True, False)
    assert "shock" not in answer.compute({**data, "fast_strips": {}}, replace(settings, shock=3e4)).left_out  # dry


@pytest.mark.parametrize("patches", [100, 250])
def test_too_few_patches_give_no_force_but_a_probability(patches):
    data, settings = data_of_stopper(patches, touchdowns=10, tilted=True, force=1e-4)
    with np.errstate(all="raise"):
        found = answer.compute(data, settings)
    assert np.isnan(found.build)
    assert found.verdict is Verdict.NONE
    assert found.stuck.none_seen
    assert found.stuck.high > 0.01
    assert_equal(astuple(answer.answer_of(answer.layout(found))), astuple(found))


def test_patches_that_hold_nothing_need_no_force():
    data, settings = data_of_stopper(scale=0.0)
    with np.errstate(all="raise"):
        found = answer.compute(data, settings)
    assert found.build == 0
    assert found.verdict is Verdict.SAFE


# Plan

DEVICES = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}


def test_the_job_reads_what_is_stated_alone():
    names = {
        "C1": DEVICES,
        "C2": DEVICES | {"touchdowns": 10, "uncertainty": {"thickness_um": 0.05}, "length_um": 100},
        "C3": DEVICES | {"dielectric": {"thickness_nm": 100, "permittivity": 4}, "voltage_V": 5},
    }
    plan = Plan(load({"devices": names, "liquids": {"mine": {"surface_tension_mN_per_m": 30}}}))
    inputs = {name: Graph(plan).job(f"devices/answer/{name}").inputs for name in names}
    assert inputs["C1"]["after"] == {}
    assert inputs["C2"]["after"] == {0.67: "devices/touchdowns/C2_rh067"}
    assert inputs["C2"]["budgets"] == ["devices/budget/C2_rh067", "devices/budget/C2_rh067_tip"]
    assert inputs["C1"]["biased"] == {}
    assert inputs["C3"]["biased"] == {0.67: "devices/at_voltage/C3_rh067"}
    settings = in_si(answer.Settings, job_settings(plan, "devices/answer/C2"))
    assert (settings.touchdowns, settings.length, settings.liquids) == (10, pytest.approx(1e-4), ("mine",))
    assert settings.budgets == (0.67, 0.67)

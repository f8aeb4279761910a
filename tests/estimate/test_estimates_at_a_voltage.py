"""Lengths and forces at a voltage in plain Python, beside the closed forms and drawn surfaces of a run."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.answer.data import Cause
from stiction.answer.worlds import Condition, Sampled
from stiction.beam.cantilever import Beam
from stiction.config.cases import Case, case_id
from stiction.config.units import in_si
from stiction.contact.correction import ElasticChange
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.devices import bridges
from stiction.estimate.answer import answer, in_one_air
from stiction.estimate.bridge import Bridge, Stretched, known_patch, shorter
from stiction.estimate.force import Stopper
from stiction.estimate.learning import bridges as of_bridges
from stiction.estimate.learning import patches
from stiction.estimate.learning.design import states
from stiction.estimate.learning.training import HUMIDITIES, SETS, air_of, surfaces_of, water_of
from stiction.estimate.length import Lengths
from stiction.estimate.question import Question, questions
from stiction.estimate.state import PatchState, film, stiffness_of
from stiction.estimate.statistics import heights_of, of_pair
from stiction.estimate.table import Surrogate, content, known
from stiction.estimate.voltage import Pulled, at_voltage, drive_of, energy_of, tension_of, without_voltage
from stiction.life import holding
from stiction.plan.stage import At
from stiction.stages.answer import conditions
from stiction.stages.contact import contact, curves
from stiction.stages.contact.changes.patches import GROUND
from stiction.stages.contact.pairs import Settings
from stiction.stages.devices.contact_names import patch_of
from stiction.stages.devices.opening import BEAMS
from stiction.stages.life.answers import HOLD, LifeRow, Name

MODULUS = 164e9
DEVICE = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
OXIDE = {"thickness_nm": 100, "permittivity": 3.9}


def drive(beam, energy):
    """Drive of an energy on a beam."""
    return drive_of(energy, stiffness_of(MODULUS, beam.thickness, beam.gap), beam.gap)


@given(st.floats(5e-5, 1e-3), st.floats(1, 5), st.floats(1, 30), st.floats(1e-6, 1))
def test_lengths_are_those_of_the_closed_form_and_back(length, thickness, gap, energy):
    beam = Beam(1e-3, 30e-6, 1e-6 * thickness, MODULUS, 1e-6 * gap, 1)
    found = at_voltage(length, drive(beam, energy))
    assert found == pytest.approx(float(holding.tip_length_at_voltage(length, beam, energy)), rel=1e-9)
    assert found < length
    assert found**-4 == pytest.approx(length**-3 / found + drive(beam, energy), rel=1e-9)
    if drive(beam, energy) < 1e3 * length**-4:  # beyond, the length without voltage matters less than rounding
        assert without_voltage(found, drive(beam, energy)) == pytest.approx(length, rel=1e-6)


def test_a_length_that_the_voltage_alone_holds_needs_no_surface():
    beam = Beam(1e-3, 30e-6, 2.6e-6, MODULUS, 20e-6, 1)
    alone = drive(beam, 0.01) ** -0.25
    assert without_voltage(1.001 * alone, drive(beam, 0.01)) == math.inf
    assert math.isfinite(without_voltage(0.999 * alone, drive(beam, 0.01)))


@given(st.floats(-50, 50), st.floats(-5, 5), st.floats(10, 1000), st.floats(1, 10))
def test_the_energy_is_that_of_flats_at_the_distance_of_the_dielectric(voltage, offset, thickness, permittivity):
    device = {"voltage_V": voltage, "offset_V": offset}
    device["dielectric"] = {"thickness_nm": thickness, "permittivity": permittivity}
    capacitor = Capacitor(Dielectric(1e-9 * thickness, permittivity), voltage, offset)
    assert energy_of(device, 2e-6) == pytest.approx(holding.energy_of_voltage(capacitor, 2e-6), rel=1e-9, abs=1e-30)


def at(**keys):
    """Answer about the device with more keys."""
    (question,) = questions({"devices": {"C": DEVICE | keys}}, content()).values()
    assert isinstance(question, Question), question
    return answer(question, *known())


def test_a_device_at_a_voltage_has_the_lengths_of_the_closed_form_with_their_intervals():
    without, driven = at(), at(voltage_V=5, offset_V=0.3, dielectric=OXIDE)
    beam = Beam(1e-3, 30e-6, 2.6e-6, MODULUS, 20e-6, 1)
    added = holding.energy_of_voltage(Capacitor(Dielectric(100e-9, 3.9), 5.3), beam.gap)
    for row, bare in zip(driven.rows, without.rows, strict=True):
        for shown, length in [(row.length, bare.length), *zip(row.intervals["90"], bare.intervals["90"], strict=True)]:
            assert shown == pytest.approx(float(holding.tip_length_at_voltage(length, beam, added)), rel=1e-9)


def test_the_fraction_at_a_length_is_that_of_the_length_without_the_voltage():
    question = questions({"devices": {"C": DEVICE | {"voltage_V": 5, "dielectric": OXIDE}}}, content())["C"]
    row = answer(question, *known()).chosen
    value, low, high = answer(replace(question, length=row.length), *known()).stuck
    assert value == pytest.approx(row.fraction, rel=1e-3)
    assert low < value < high
    bare = answer(replace(question, length=row.length, added=0.0), *known()).stuck[0]
    assert bare < 0.9 * value  # control


# Stoppers

STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "humidities": [0.67], "restoring_force_uN": 60}


def of_stopper(**keys):
    """Question about the stopper with more keys."""
    question = questions({"devices": {"S": STOPPER | keys}}, content())["S"]
    assert isinstance(question, Stopper), question
    return question


def moved_by_a_run(monkeypatch, forces, added):
    """Forces at a voltage as a run answers for flats that hold an added force [N]."""
    row = LifeRow(Name.AT_VOLTAGE, HOLD, "", math.nan, added, math.nan, "N", "", "")
    monkeypatch.setattr(conditions, "answers_of", lambda _: [row])
    bare = Condition(0.67, "stopper", Cause.ESTIMATE, "stoppers", Sampled(-np.log(forces), ()))
    (moved,) = conditions.at_voltage_on_flat_patches([bare], None)
    return np.exp(-moved.sampled.values)


def test_200_stoppers_have_the_forces_of_the_closed_form_and_back(monkeypatch):
    rng = np.random.default_rng(3)
    for _ in range(200):
        sides, volts, thickness = rng.uniform(1, 6, 2), rng.uniform(-40, 40), rng.uniform(20, 1000)
        oxide, force = {"thickness_nm": thickness, "permittivity": rng.uniform(1, 10)}, 10 ** rng.uniform(-6, -3)
        asked = of_stopper(contact_um=sides.tolist(), voltage_V=volts, offset_V=0.3, dielectric=oxide)
        capacitor = Capacitor(Dielectric(1e-9 * thickness, oxide["permittivity"]), volts, 0.3)
        on_flats = capacitor.largest_pressure * 1e-12 * sides.prod()
        (expected,) = moved_by_a_run(monkeypatch, [force], on_flats)
        found = asked.closed.length(1 / force)
        assert 1 / found == pytest.approx(expected, rel=1e-9)
        assert asked.closed.bare(found) == pytest.approx(1 / force, rel=1e-6)
        energy = capacitor.work(0.0) * 1e-6 * sides[0]
        assert force + energy != pytest.approx(expected, rel=1e-9), "the control: an energy on one side"


def test_forces_and_their_intervals_grow_by_that_on_flats():
    without = answer(of_stopper(), *known())
    driven = answer(of_stopper(voltage_V=20, dielectric=OXIDE), *known())
    on_flats = Capacitor(Dielectric(100e-9, 3.9), 20.0).largest_pressure * 6e-12
    assert on_flats > 1e-6
    for row, bare in zip(driven.rows, without.rows, strict=True):
        ends = zip(row.intervals["95"], bare.intervals["95"], strict=True)
        for force, own in [(row.force, bare.force), *ends]:
            assert force == pytest.approx(own + on_flats, rel=1e-9)
    assert driven.stuck[0] > 1.1 * without.stuck[0]


@pytest.mark.parametrize("keys", [{"voltage_V": 0, "dielectric": OXIDE}, {"voltage_V": 1e-6, "dielectric": OXIDE}])
def test_without_a_voltage_a_stopper_is_as_it_was(keys):
    bare = answer(of_stopper(), *known())
    assert answer(of_stopper(**keys), *known()).chosen.force == pytest.approx(bare.chosen.force, rel=1e-9)
    assert answer(of_stopper(**keys), *known()).stuck == pytest.approx(bare.stuck, rel=1e-6)


def test_a_spring_weaker_than_the_voltage_does_not_free_most():
    asked = of_stopper(voltage_V=20, dielectric=OXIDE)
    weak = replace(asked, force=0.999 * asked.added)
    assert math.isinf(weak.closed.bare(weak.stated))
    assert answer(weak, *known()).stuck == (asked.most,) * 3
    assert math.isfinite(asked.closed.bare(1 / (1.001 * asked.added)))
    assert Pulled(0.0).bare(5.0) == 5.0


def test_the_fraction_at_a_force_is_that_of_its_row():
    asked = of_stopper(voltage_V=20, dielectric=OXIDE)
    row = answer(asked, *known()).chosen
    value, low, high = answer(replace(asked, force=row.force), *known()).stuck
    assert value == pytest.approx(row.fraction, rel=1e-3)
    assert low < value < high


def pressures_of(point, number, *capacitors):
    """Pull-off pressures of patches of 2 µm on summits, in the air of a point, each at a voltage [Pa]."""
    plan = patches.plan_of(point, (2.0, 2.0), patches.base())
    patch = patch_of(plan, Case(case_id(patches.DEVICE, HUMIDITIES[0])))
    at = At(**{name: str(value) for name, value in patch._asdict().items()})
    settings = replace(in_si(Settings, GROUND.settings(plan, at, number)), seed=1)
    drawn, water = contact.compute(surfaces_of(plan), "drawn", "NG", settings), water_of(plan)
    air, _ = air_of(2e-9, 1.0, water.temperature)
    return air, [curves.pull_offs(drawn, air, replace(water, capacitor=each)) for each in capacitors]


@pytest.mark.parametrize("number", [0, 5])
def test_drawn_patches_need_less_than_the_end_to_use(number):
    """On surfaces that are not the paper's, changed by full contact as a run does."""
    point, device = SETS["check_any"].all[number], {"voltage_V": 20, "dielectric": OXIDE}
    air, (bare, driven) = pressures_of(point, 300, None, Capacitor(Dielectric(100e-9, 3.9), 20.0))
    gained = (driven - bare) / tension_of(device)
    assert 0.05 < gained.min() <= gained.max() <= 1 + 1e-9
    area, water = 4e-12, film(air, 300.0, 2.0)
    asked = Stopper("", tuple(map(heights_of, point.sides)), ({}, {}), (air,), (2e-6, 2e-6))
    patch = PatchState(of_pair(point.sides), water, area, 164e9)
    change = Surrogate(**content()["stoppers"]["full"]).at(patch.coordinates).of
    of_run = area * ElasticChange(math.exp(change["ratio"]), max(1.0, change["power"])).of(driven)(driven)
    uses = [
        in_one_air(each, air, [1e-2], *known())[0].intervals["90"][1]
        for each in (replace(asked, added=tension_of(device) * area), asked)
    ]
    assert np.quantile(of_run, 0.99) < uses[0]
    assert uses[0] - uses[1] == pytest.approx(area * tension_of(device), rel=1e-9), "of which the voltage is a part"


# Bridges

BRIDGE = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 50}
BRIDGE |= {"humidities": [0.67]}


def of_bridge(**keys):
    """Question about the bridge with more keys."""
    question = questions({"devices": {"R": BRIDGE | keys}}, content())["R"]
    assert isinstance(question, Bridge), question
    return question


def drawn_bridges(number):
    """Stresses [Pa], halves and closed forms of random bridges, laws (e, f) and what random voltages add to them."""
    rng = np.random.default_rng(5)
    for _ in range(number):
        thickness, gap, stress = 10 ** rng.uniform(-6.1, -5.3), 10 ** rng.uniform(-6.5, -5.3), rng.uniform(0, 2e8)
        half = bridges.half_of_bridge(Beam(1e-3, 30e-6, thickness, MODULUS, gap, 1), stress)
        pull, tension = 10 ** rng.uniform([5.5, 4], [7.5, 7])
        law = np.array([10 ** rng.uniform(-9, -8) * pull, pull])
        yield half, Stretched.of(stress, thickness, MODULUS), law, np.array([tension * 25e-9, tension])


def held_by(half, law):
    """Length without stress that a law (e, f) holds in the closed form."""
    return (768 * (MODULUS * half.thickness**3) ** 2 * half.gap**3 / law.prod()) ** 0.125


def balance(length, half, law):
    """Curvature and square of the pull of the arms of a bridge over what a law (e, f) balances."""
    force, curvature = bridges.pull(length, half)
    return curvature * force**2 / (8 * half.width**2 * law.prod())


def test_200_bridges_balance_their_arms_at_a_voltage():
    for half, stretched, law, added in drawn_bridges(200):
        driven = replace(stretched, factor=shorter(*law, *added))
        bare = held_by(half, law)
        length = driven.length(bare)
        assert balance(length, half, law + added) == pytest.approx(1, rel=1e-9)
        assert balance(length, half, law + [added[0], 0]) > 1 + 1e-6, "the control: energy alone"
        assert driven.bare(length) == pytest.approx(bare, rel=1e-9)


def test_lengths_shrink_as_those_of_a_run_by_the_same_laws():
    """Up to the effect of the width in contact, which a run has, too."""
    ratios = []
    for half, stretched, law, added in drawn_bridges(200):
        length, shrunk = (bridges.least_length(*each, half) for each in (law, law + added))
        of_run = BEAMS["bridge"].at_voltage(np.array([1.0]), law, law + added, half).item()
        found = replace(stretched, factor=shorter(*law, *added)).length(stretched.bare(length))
        ratios.append(found / length / of_run)
    assert 0.99 < min(ratios) < max(ratios) < 1.035  # the most where a voltage of many volts leaves a third
    assert np.quantile(ratios, [0.05, 0.5, 0.95]) == pytest.approx([1, 1.002, 1.013], abs=2e-3)


def test_all_lengths_of_a_bridge_shrink_by_the_factor_of_its_own_stopper():
    without, driven = of_bridge(), of_bridge(voltage_V=10, dielectric=OXIDE)
    rows = [(answer(each, *known()).rows, each) for each in (without, driven)]
    beam, water = Beam(1e-3, 30e-6, 2e-6, MODULUS, 2e-6, 1), film(0.67, 300.0, 2.0)
    flooded = np.array([water.energy, water.energy / water.height])
    area = bridges.pull(held_by(beam, flooded), beam)[0] / (2 * flooded[1])
    patch = Stopper("", without.surfaces, ({}, {}), (0.67,), (area**0.5, area**0.5))
    (force,) = in_one_air(patch, 0.67, [0.5], *known())
    (half,) = in_one_air(without, 0.67, [0.5], *known())
    pull = force.force / area
    energy = 768 * (MODULUS * 2e-6**3) ** 2 * 2e-6**3 / without.closed.bare(half.length) ** 8 / pull
    capacitor = Capacitor(Dielectric(100e-9, 3.9), 10.0)
    expected = shorter(energy, pull, holding.energy_of_voltage(capacitor, 2e-6), capacitor.largest_pressure)
    assert 0.5 < expected < 0.9
    for bare, row in zip(*(of_rows for of_rows, _ in rows), strict=True):
        both = [(bare.length, row.length), *zip(bare.intervals["95"], row.intervals["95"], strict=True)]
        for length, shrunk in both:
            ratio = without.closed.bare(shrunk) / without.closed.bare(length)
            assert ratio == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("area", "learnt"), [(0.5e-12, 1e-12), (9e-12, 9e-12), (144e-12, 36e-12)])
def test_a_middle_counts_as_the_nearest_area_that_was_learnt(area, learnt):
    patch = PatchState(of_pair(SETS["control"].all[0].sides), film(0.67, 300.0, 2.0), area, MODULUS)
    assert known_patch(patch, content()["stoppers"]).area == pytest.approx(learnt, rel=1e-9)


def test_without_a_voltage_a_bridge_is_as_it_was():
    bare = answer(of_bridge(length_um=180), *known())
    for volts in (0, 1e-6):
        found = answer(of_bridge(length_um=180, voltage_V=volts, dielectric=OXIDE), *known())
        assert found.chosen.length == pytest.approx(bare.chosen.length, rel=1e-9)
        assert found.stuck == pytest.approx(bare.stuck, rel=1e-6)
    driven = answer(of_bridge(length_um=180, voltage_V=3, dielectric=OXIDE), *known())
    assert driven.stuck[0] > 1.1 * bare.stuck[0], "the control"


def test_the_surface_that_a_voltage_shortens_most_decides():
    asked = of_bridge(voltage_V=10, dielectric=OXIDE)
    state, rough = asked.surfaces[0] + asked.surfaces[1], of_pair(SETS["control"].all[0].sides)
    found = {each: Lengths((math.log(2e-4), -9.0, -9.5), 0.1) for each in (state, rough)}
    factors = [asked.closed_on({each: found[each]}, 0.67, content()).factor for each in found]
    assert abs(factors[0] - factors[1]) > 1e-3
    assert asked.closed_on(found, 0.67, content()).factor == min(factors)


@pytest.mark.parametrize("number", [2, 4])
def test_drawn_strips_let_a_bridge_be_no_shorter(number):
    """On surfaces that are not the paper's, a run divides lengths by less, at all fractions."""
    point, effort = SETS["check_any"].all[number], SETS["check_any"]
    strips = of_bridges.TrainingStrips.of(point, of_bridges.plan_of(point, of_bridges.base()), 200, effort.seed)
    (height, _), (thickness, gap, stress) = (
        states(1, point.number, effort.seed)[0],
        of_bridges.sizes_of(point, "check_any")[0],
    )
    air, _ = air_of(height, 1.0, strips.water.temperature)
    device = {"voltage_V": 10, "dielectric": OXIDE}
    waters = (replace(strips.water, capacitor=each) for each in (None, Capacitor(Dielectric(100e-9, 3.9), 10.0)))
    without, at = (curves.vectors(strips.contact, air, water)[0][:, :2].mean(axis=0) for water in waters)
    half = replace(strips.device, thickness=thickness, gap=gap, residual_stress=stress).beam
    of_run = BEAMS["bridge"].at_voltage(np.array([1.0]), without, at, half).item()
    sizes = thickness, gap, 1e-6 * point.width, stress
    bare = Bridge("", tuple(map(heights_of, point.sides)), ({}, {}), (air,), *sizes)
    driven = replace(bare, added=energy_of(device, gap), tension=tension_of(device))
    for fraction in (0.5, 1e-3):
        one, other = (in_one_air(each, air, [fraction], *known())[0].length for each in (bare, driven))
        assert 0.6 * of_run < other / one < of_run < 0.95

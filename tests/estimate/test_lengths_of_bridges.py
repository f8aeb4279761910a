"""Lengths of bridges in the estimate: closed forms beside finite elements, what a run changes, questions, refusals."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from beams import uniform_laws
from hypothesis import given
from hypothesis import strategies as st

from stiction.beam import tension
from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.middle import shortest_held
from stiction.contact.correction import ElasticChange
from stiction.devices import bridges as of_devices
from stiction.estimate import bridge
from stiction.estimate.answer import answer
from stiction.estimate.bridge import COORDINATES, Bridge, MiddleState, Stretched
from stiction.estimate.learning import bridge_rows, bridges, patches
from stiction.estimate.learning import errors as of_estimates
from stiction.estimate.learning.files import save
from stiction.estimate.learning.training import SETS
from stiction.estimate.length import Lengths, NotLearnt
from stiction.estimate.question import questions
from stiction.estimate.state import film
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate, content, known
from stiction.life.freeing import stuck_after

BRIDGE = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 50}
BRIDGE |= {"humidities": [0.67]}
WATER = film(0.67, 300.0, 2.0)
(POINT,) = SETS["control"].all
STATE = MiddleState(of_pair(POINT.sides), WATER, 2e-6, 2e-6, 30e-6, 50e6, 164e9, 164e9)
BEAM = Beam(600e-6, 30e-6, 2e-6, 164e9, 2e-6, 160)
STRESSES = [0.0, 10e6, 50e6, 200e6]


def asked(**keys):
    """Question about the bridge with other keys."""
    return questions({"devices": {"R": BRIDGE | keys}}, content())["R"]


def found(**keys):
    """Answer about the bridge with other keys."""
    return answer(asked(**keys), *known())


def stretched(stress, thickness=2e-6):
    return Stretched.of(stress, thickness, 164e9)


def held(law, stress, **changes):
    """Length of the shortest bridge that finite elements hold on a uniform law."""
    half = of_devices.half_of_bridge(replace(BEAM, **changes), stress)
    zone = replace(half, length=24e-6, elements=48)
    return shortest_held(zone, uniform_laws(48, *law), 2 * float(arrest_length(law[0], zone)))


# Closed forms


@pytest.mark.parametrize("kl", [0.0, 1e-3, 0.029, 0.031, 1.0, 8.0, 80.0])
def test_stiffnesses_of_half_of_a_bridge_are_those_of_a_run(kl):
    expected = tension.end_stiffness(kl)[:2] if kl else (12.0, 6.0)
    np.testing.assert_allclose(bridge.end_stiffness(kl), expected, rtol=1e-12)


def test_flooded_flats_balance_the_arms_at_their_length():
    energy, pull = WATER.energy, WATER.energy / WATER.height
    force, curvature = of_devices.pull(STATE.flooded_length, BEAM)
    assert curvature * force**2 == pytest.approx(8 * BEAM.width**2 * energy * pull, rel=1e-9)
    bound = of_devices.least_length(energy, pull, BEAM)  # with the effect of the width in contact
    assert bound / STATE.flooded_length == pytest.approx(1, abs=0.05)
    assert bound < STATE.flooded_length


@pytest.mark.parametrize("stress", STRESSES)
@pytest.mark.parametrize("length", [60e-6, 200e-6, 2000e-6])
def test_a_bridge_under_stress_pulls_as_one_without_it(stress, length):
    of, half = stretched(stress), of_devices.half_of_bridge(BEAM, stress)
    force, curvature = of_devices.pull(length, half)
    bare_force, bare_curvature = of_devices.pull(of.bare(length), BEAM)
    assert curvature * force**2 == pytest.approx(bare_curvature * bare_force**2, rel=1e-9)
    if stress > 1e7:
        assert bare_force != pytest.approx(force, rel=0.01), "the control: over the own gap they are not"


@given(st.floats(0, 3e8), st.floats(0.5e-6, 6e-6), st.floats(3e-5, 3e-3), st.floats(1.001, 2))
def test_stress_lengthens_and_its_inverse_gives_the_length_back(stress, thickness, bare, more):
    of = stretched(stress, thickness)
    assert of.bare(of.length(bare)) == pytest.approx(bare, rel=1e-9)
    assert of.length(bare) >= bare * (1 - 1e-12)
    ratio = math.log(of.length(more * bare) / of.length(bare)) / math.log(more)
    assert 1 - 1e-6 <= ratio <= 8 / 3 + 1e-6


@pytest.mark.parametrize("law", [(6e-3, 3e6), (50e-3, 10e6)])
@pytest.mark.parametrize(("stress", "error"), [(10e6, 0.002), (50e6, 0.005), (200e6, 0.025)])
def test_finite_elements_under_stress_hold_as_the_closed_form_says(law, stress, error):
    free, under = held(law, 0.0), held(law, stress)
    assert stretched(stress).length(free) == pytest.approx(under, rel=error)
    assert under > 1.01 * free, "the control: stress matters"


@pytest.mark.parametrize(("name", "power"), [("thickness", 0.75), ("gap", 0.375)])
def test_finite_elements_follow_the_closed_form_of_flats(name, power):
    law = 6e-3, 3e6
    ratio = held(law, 0.0, **{name: 2 * getattr(BEAM, name)}) / held(law, 0.0)
    assert math.log2(ratio) == pytest.approx(power, abs=0.02)
    other = replace(STATE, **{name: 2 * getattr(STATE, name)})
    assert math.log2(other.flooded_length / STATE.flooded_length) == pytest.approx(power, rel=1e-9)


def test_finite_elements_follow_energy_and_attraction_as_full_contact_changes_them():
    energy, pull = 6e-3, 3e6
    ratio = held((0.7 * energy, 0.8 * pull), 0.0) / held((energy, pull), 0.0)
    assert math.log(ratio) == pytest.approx(-math.log(0.7 * 0.8) / 8, rel=0.05)


def moved(**changes):
    """Differences of the coordinates with other numbers of the bridge, which are not zero."""
    other = zip(COORDINATES, replace(STATE, **changes).coordinates, STATE.coordinates, strict=True)
    return {name: one - own for name, one, own in other if abs(one - own) > 1e-12}


def test_coordinates_move_with_their_own_numbers_alone():
    area, gap, stress = COORDINATES[6], *COORDINATES[-2:]
    over = STATE.coordinates[-1]  # the stress over the middle
    assert moved(width=4 * STATE.width) == {area: pytest.approx(math.log(4))}
    assert moved(stress=4 * STATE.stress) == {stress: pytest.approx(over)}
    in_contact = -math.log(2) / 8
    expected = {area: pytest.approx(in_contact), gap: pytest.approx(math.log(2))}
    assert moved(gap=2 * STATE.gap) == expected | {stress: pytest.approx(over * math.expm1(in_contact))}
    assert replace(STATE, stress=0.0).coordinates[-1] == 0.0


def test_the_area_in_contact_is_that_on_which_flooded_flats_balance_the_pull():
    summits = math.sqrt(STATE.heights.moments[2] / STATE.heights.moments[1])
    force, _ = of_devices.pull(STATE.flooded_length, BEAM)
    area = force / 2 / (WATER.energy / WATER.height)
    assert STATE.coordinates[6] == pytest.approx(math.log(area * summits**2), rel=1e-9)
    half = of_devices.half_of_bridge(BEAM, STATE.stress)
    assert STATE.coordinates[-1] == pytest.approx(half.decay * area / BEAM.width, rel=1e-9)


# Learnt quantities


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


MIDDLE, SAME = process_of(at_0=0.5, at_1=0.4, at_2=0.3, slope=0.1), process_of(shift=0.0, power=1.0)


@pytest.mark.parametrize("score", [0.0, -1.0, -3.0])
@pytest.mark.parametrize(("shift", "power"), [(0.0, 1.0), (0.1, 1.0), (0.1, 1.5)])
def test_lengths_are_those_of_flats_with_what_was_learnt(score, shift, power):
    lengths = bridge.lengths(STATE, MIDDLE, process_of(shift=shift, power=power))
    expected = 0.5 + shift + power * 0.1 * score
    assert math.log(lengths.at(score) / STATE.flooded_length) == pytest.approx(expected)


@pytest.mark.parametrize("power", [0.9, 1.3])
def test_full_contact_moves_the_median_and_scales_the_scatter(power):
    summits = Lengths((-8.0, -8.1, -8.25), 0.2)
    changed = bridge.changed(summits, 0.05, power)
    assert changed.logarithms == pytest.approx((-7.95, -7.95 - 0.1 * power, -7.95 - 0.25 * power))
    assert changed.slope == pytest.approx(0.2 * power)


def numbers_of(stress=50e6, scatter=0.1, full=1.1):
    """Numbers of a point with bridges in two airs, whose lengths scatter, and full contact of the first."""
    rng = np.random.default_rng(3)
    bare = STATE.flooded_length * np.exp(0.5 + scatter * rng.normal(size=(2, 4000)))
    under = stretched(stress)
    lengths = np.array([[under.length(one) for one in row] for row in bare])
    sizes = np.tile([STATE.thickness, STATE.gap, stress], (2, 1))
    changed = np.array([under.length(full * one) for one in bare[0]])
    airs = np.array([[WATER.height, 1.0]] * 2)
    return {"airs": airs, "sizes": sizes, "lengths": lengths, "changed": changed, "ratio": 0.7, "ratio_error": 0.05}


def stored(monkeypatch, module, *points):
    monkeypatch.setattr(module, "stored", lambda folder, _: _of_folder(folder, points))


def _of_folder(folder, points):
    """Points of bridges, or the ratios of forces of the same points."""
    if folder.name == bridges.FOLDER:
        return [(replace(POINT, width=30.0, number=k), one) for k, one in enumerate(points)]
    return [(replace(POINT, number=k), {"ratio": 0.8}) for k in range(len(points))]


def test_rows_of_bridges_have_the_scores_of_their_lengths_without_stress(monkeypatch):
    unknown = numbers_of()
    unknown["lengths"][1, ::2] = np.inf
    stored(monkeypatch, bridge_rows, numbers_of(), unknown)
    rows = bridge_rows.rows_of_middles(Path(), "learn", 164e9)
    assert rows.surface.tolist() == [0, 0, 1], "a bridge of which half come free has no row"
    for name, value in {"at_0": 0.5, "at_1": 0.4, "at_2": 0.3, "slope": 0.1}.items():
        np.testing.assert_allclose(rows.values[name], value, atol=0.02)
    np.testing.assert_allclose(rows.coordinates[0], STATE.coordinates, rtol=1e-9)


def test_a_few_bridges_that_come_free_are_longer_than_all_others(monkeypatch):
    few = numbers_of()
    for lengths in (few["lengths"][0], few["changed"]):
        lengths[lengths >= np.sort(lengths)[-400]] = np.inf
    stored(monkeypatch, bridge_rows, few)
    rows = bridge_rows.rows_of_middles(Path(), "learn", 164e9)
    np.testing.assert_allclose(rows.values["at_2"], 0.3, atol=0.02)


@pytest.mark.parametrize(("free", "learnt", "tested"), [(0.4, 1, 1), (0.6, 0, 1), (0.95, 0, 0)])
def test_few_finite_lengths_are_tested_and_not_learnt(monkeypatch, free, learnt, tested):
    some = numbers_of()
    for lengths in (*some["lengths"], some["changed"]):
        lengths[lengths >= np.quantile(lengths, 1 - free)] = np.inf
    stored(monkeypatch, bridge_rows, some)
    assert len(list(bridge_rows.with_changes(Path(), "learn"))) == learnt
    found = list(of_estimates.tested_bridges(Path(), "any", 164e9, -3.0902, lambda _: (MIDDLE, SAME)))
    assert len(found) == tested
    for one in found:
        assert math.log(one.true / STATE.flooded_length) == pytest.approx(0.5 - 0.30902 + math.log(1.1), abs=0.04)


def test_rows_of_full_contact_follow_energy_and_attraction(monkeypatch):
    without = {key: numbers_of()[key] for key in ("airs", "sizes", "lengths")}
    stored(monkeypatch, bridge_rows, numbers_of(), without, numbers_of() | {"ratio": 0.9, "ratio_error": 0.1})
    rows = bridge_rows.rows_of_changes(Path(), "learn", 164e9)
    assert rows.surface.tolist() == [0, 2]
    np.testing.assert_allclose(rows.values["shift"], [-math.log(0.7 * 0.8) / 8, -math.log(0.9 * 0.8) / 8])
    np.testing.assert_allclose(rows.values["power"], 1.0, atol=1e-6)
    np.testing.assert_allclose(rows.noise, [0.05, 0.1])
    np.testing.assert_allclose(rows.coordinates, [STATE.coordinates] * 2, rtol=1e-9)


def test_a_tested_length_is_that_of_bridges_in_full_contact(monkeypatch):
    monkeypatch.setattr(of_estimates, "with_changes", lambda *_: [(replace(POINT, width=30.0), numbers_of())])
    (one,) = of_estimates.tested_bridges(Path(), "any", 164e9, -3.0902, lambda _: (MIDDLE, SAME))
    assert math.log(one.estimate / STATE.flooded_length) == pytest.approx(0.5 - 0.30902, abs=1e-6)
    assert math.log(one.true / STATE.flooded_length) == pytest.approx(0.5 - 0.30902 + math.log(1.1), abs=0.03)
    assert one.error == pytest.approx(math.log(one.true / one.estimate))


def test_the_weakest_tested_bridge_is_the_longest_over_that_on_flats(monkeypatch):
    points = [(replace(POINT, width=width), numbers_of()) for width in (30.0, 20.0)]
    monkeypatch.setattr(of_estimates, "with_changes", lambda *_: points)
    longest = of_estimates.longest_tested(Path(), "decide", 164e9, MIDDLE, SAME)
    assert longest == pytest.approx(math.exp(0.3))
    monkeypatch.setattr(of_estimates, "lengths_of_bridges", refused_first())
    assert of_estimates.longest_tested(Path(), "decide", 164e9, MIDDLE, SAME) == pytest.approx(
        1e-4 / STATE.flooded_length
    )


def refused_first():
    """Lengths of which the first are refused, and all others are 100 µm."""
    called = []

    def lengths(*_):
        """Lengths, of the second call on."""
        called.append(1)
        if len(called) == 1:
            raise NotLearnt
        return Lengths((math.log(1e-4),) * 3, 0.1)

    return lengths


@pytest.mark.parametrize("over", [0.999, 1.001])
def test_a_bridge_that_sticks_more_weakly_than_all_tested_ones_is_refused(over):
    """Length over that on flooded flats, beside the largest that was tested."""
    question, (table, *processes) = asked(), known()
    heights, (air,) = question.surfaces[0] + question.surfaces[1], question.humidities
    water = film(air, question.temperature, question.solids.wetting)
    ratio = bridge.over_flooded(question._state(heights, water), question.lengths(heights, water, table))
    assert ratio < table["bridges"]["longest"], "its own table knows this bridge"
    other = table | {"bridges": table["bridges"] | {"longest": over * ratio}}
    if over > 1:
        assert answer(question, other, *processes).rows == found().rows
    else:
        with pytest.raises(NotLearnt, match="no bridge as long was tested"):
            answer(question, other, *processes)


# Training


def test_bridges_of_a_point_are_within_their_ranges_and_its_own():
    drawn = np.concatenate([bridges.sizes_of(point, "learn_any") for point in SETS["learn_any"].all])
    units = np.array([1e-6, 1e-6, 1e6])
    for column, name in zip((drawn / units).T, ("thickness", "gap", "stress"), strict=True):
        ends = bridges.RANGES[name]
        assert ends[0] - 1e-3 <= column.min() <= ends[0] + 0.1 * (ends[1] - ends[0])
        assert ends[1] - 0.1 * (ends[1] - ends[0]) <= column.max() <= ends[1] + 1e-3
    assert np.median(drawn[:, 0]) == pytest.approx(1e-6 * math.sqrt(0.7 * 6), rel=0.1)
    assert len(np.unique(drawn, axis=0)) > 0.9 * len(drawn)
    np.testing.assert_allclose(bridges.sizes_of(POINT, "check_paper"), [[2e-6, 2e-6, 50e6]])


@pytest.mark.parametrize(("power", "applied"), [(0.8, 1.0), (1.2, 1.2)])
def test_a_correction_changes_energies_and_attractions_by_their_own_ratios(power, applied):
    ratio = SimpleNamespace(ratio=0.7, power=power)
    water = SimpleNamespace(temperature=300.0)
    changes = bridges.correction_of(ratio, {"ratio": 0.8, "power": 1.3}, 3e-9, water)
    assert changes.energy.power.tolist() == [applied]
    (air,) = changes.humidities
    for change, expected in zip(changes.at(air), (ElasticChange(0.7, applied), ElasticChange(0.8, 1.3)), strict=True):
        assert (change.ratio, change.power) == pytest.approx((expected.ratio, expected.power))


class Strips:
    """Strips whose bridges have lengths that say in what they are."""

    water = SimpleNamespace(temperature=300.0)

    def lengths(self, height, sizes, number, change=None):
        return np.full(number, height + sizes[0] if change is None else 2 * (height + sizes[0]))


@pytest.mark.parametrize("ratio", [0.8, math.nan])
def test_numbers_of_a_point_have_full_contact_where_the_set_has_it(monkeypatch, tmp_path, ratio):
    monkeypatch.chdir(tmp_path)
    save(Path(patches.FOLDER) / "learn_any", 2, {"ratio": 0.9, "power": 1.0})
    monkeypatch.setattr(bridges, "plan_of", lambda *_: None)
    monkeypatch.setattr(bridges.TrainingStrips, "of", lambda *_: Strips())
    energy = SimpleNamespace(ratio=ratio, error=0.05, power=1.1)
    monkeypatch.setattr(bridges, "ratio_of_energies", lambda *_: energy)
    of = SETS["learn_any"]
    with_it, without = (bridges.computed(replace(POINT, number=number), "learn_any", {}) for number in (2, 3))
    for each in (with_it, without):
        assert each["lengths"].shape == (of.states, of.patches)
        np.testing.assert_allclose(each["lengths"][:, 0], each["airs"][:, 0] + each["sizes"][:, 0], rtol=1e-6)
    assert ("changed" in with_it) == math.isfinite(ratio)
    assert (with_it["ratio_error"], with_it["power"]) == (0.05, 1.1)
    assert not {"changed", "ratio"} & set(without)
    if math.isfinite(ratio):
        np.testing.assert_allclose(with_it["changed"], 2 * with_it["lengths"][0])


# Questions


def test_fewer_stick_at_shorter_lengths_within_intervals_and_touchdowns_need_shorter_ones():
    once, often = found(), found(touchdowns=100)
    lengths = [row.length for row in once.rows]
    assert lengths == sorted(lengths, reverse=True)
    for row in once.rows:
        (low90, high90), (low95, high95) = row.intervals["90"], row.intervals["95"]
        assert low95 <= low90 < row.length < high90 <= high95
    assert all(more.length < row.length for row, more in zip(once.rows, often.rows, strict=True))


@pytest.mark.parametrize(
    "keys", [{"thickness_um": 3}, {"gap_um": 3}, {"residual_stress_MPa": 100}, {"humidities": [0.5]}]
)
def test_what_frees_a_bridge_lets_it_be_longer(keys):
    assert found(**keys).chosen.length > 1.02 * found().chosen.length


@pytest.mark.parametrize(("stress", "least", "most"), [(0.0, 1.0, 1.0), (50.0, 1.1, 1.5), (200.0, 1.5, 2.4)])
def test_stress_multiplies_both_ends_of_an_interval_as_the_length(stress, least, most):
    row, under = found(residual_stress_MPa=stress).chosen, stretched(stress * 1e6)
    sizes = row.intervals["90"][0], row.length, row.intervals["90"][1]
    below, above = np.diff(np.log([under.bare(size) for size in sizes]))
    assert below == pytest.approx(above, rel=1e-6)
    amplified = np.diff(np.log(sizes)) / below
    assert np.all((amplified > least - 1e-6) & (amplified < most + 1e-6))


def test_the_driest_of_two_airs_does_not_decide():
    both, wetter = found(humidities=[0.5, 0.85]), found(humidities=[0.85])
    assert both.chosen == wetter.chosen
    assert both.humidity == 0.85


def test_no_estimate_is_below_the_length_of_flooded_flats_with_van_der_waals_attraction():
    energy, pull = WATER.energy + 0.05, WATER.energy / WATER.height + 1e8
    bound = of_devices.least_length(energy, pull, of_devices.half_of_bridge(BEAM, 50e6))
    assert found().rows[-1].intervals["95"][0] > bound


def test_the_fraction_at_a_length_is_that_of_its_row_after_all_touchdowns():
    row = found().chosen
    value, low, high = answer(replace(asked(), length=row.length), *known()).stuck
    assert value == pytest.approx(row.fraction, rel=1e-3)
    assert low < value < high
    often = answer(replace(asked(touchdowns=50), length=row.length), *known()).stuck[0]
    assert often == pytest.approx(float(stuck_after(row.fraction, 50)), rel=1e-3)
    assert answer(replace(asked(), length=1.0), *known()).stuck[0] == asked().most == 0.5
    assert asked(length_um=200).size == pytest.approx(200e-6)
    assert isinstance(asked(), Bridge)


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"residual_stress_MPa": -5}, "residual_stress_MPa must be 0 or above, got -5"),
        ({"residual_stress_MPa": float("nan")}, "residual_stress_MPa must be 0 or above, got nan"),
        ({"gap_um": 0}, "gap_um must be above 0, got 0"),
        ({"voltage_V": 3}, "its file is not complete, at 'dielectric'"),
        ({"dimples": {}}, "dimples was not learnt"),
        ({"strip_um": 0.4}, "strip_um was not learnt"),
        ({"humidities": [0.999]}, "beyond what was learnt"),
        ({"gap_um": 6.5}, "the gap of a bridge must be from 0.3 to 6 µm"),
        ({"thickness_um": 0.5}, "the thickness of a bridge must be from 0.7 to 6 µm"),
        ({"width_um": 50}, "the width of a bridge must be from 8 to 40 µm"),
        ({"residual_stress_MPa": 300}, "the stress of a bridge must be from 0 to 200 MPa"),
    ],
)
def test_a_bridge_that_was_not_learnt_has_no_number(keys, reason):
    with pytest.raises(NotLearnt, match=reason):
        found(**keys)

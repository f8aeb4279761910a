"""Bridges in dry air in the estimate: closed form, similarity, learning, and drawn bridges beside the end to use."""

import math
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from stiction.beam.cantilever import Beam
from stiction.devices import bridges as of_devices
from stiction.estimate import dry_bridge
from stiction.estimate.answer import answer, in_one_air
from stiction.estimate.bridge import Bridge, Stretched
from stiction.estimate.dry import AT_REST, DryPatch, reciprocals
from stiction.estimate.dry_bridge import AREA, COORDINATES, DryMiddle
from stiction.estimate.learning import dry, dry_bridges, dry_patches, dry_rows, training
from stiction.estimate.learning.bridges import base, sizes_of
from stiction.estimate.learning.fit import DesignRows, everywhere, fitted
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import questions
from stiction.estimate.solids import SolidPair
from stiction.estimate.statistics import heights_of, of_pair
from stiction.estimate.table import Surrogate, content, known
from stiction.progress import without_progress
from stiction.stages.contact import full_contact

BRIDGE = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 50}
BRIDGE |= {"humidities": ["dry"]}
(POINT,) = dry_bridges.SETS["control"].all
PATCH = DryPatch(of_pair(POINT.sides), 1.5e-19, AREA, 164e9)
STATE = DryMiddle(PATCH, 2e6, 164e9 * 2e-6**3, 2e-6, 30e-6)


def asked(**keys):
    """Question about the bridge with other keys."""
    return questions({"devices": {"R": BRIDGE | keys}}, content())["R"]


def found(**keys):
    """Answer about the bridge with other keys."""
    return answer(asked(**keys), *known())


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


MIDDLE = process_of(at_0=-0.2, at_1=-0.3, at_2=-0.4, slope=0.1)
#: Processes of patches whose pull-off pressure is that of flats over e⁵.
PATCHES = process_of(at_0=5.0, at_1=4.6, at_2=4.2, slope=0.4), process_of(ratio=0.0, power=1.0)


# Closed form


def test_a_law_of_the_pull_off_and_the_distance_at_rest_balances_the_arms():
    force, curvature = of_devices.pull(STATE.patch_length, Beam(1e-3, 30e-6, 2e-6, 164e9, 2e-6, 1))
    energy = STATE.pull_off * AT_REST
    assert curvature * force**2 == pytest.approx(8 * STATE.width**2 * energy * STATE.pull_off, rel=1e-9)
    stronger = replace(STATE, pull_off=2 * STATE.pull_off)
    assert STATE.patch_length / stronger.patch_length == pytest.approx(2**0.25, rel=1e-9)


def moved(**changes):
    """Differences of the coordinates with other numbers, which are not zero."""
    both = zip(COORDINATES, replace(STATE, **changes).coordinates, STATE.coordinates, strict=True)
    return {name: one - own for name, one, own in both if abs(one - own) > 1e-12}


def test_coordinates_move_with_their_own_numbers_alone():
    rms, attraction, area = COORDINATES
    assert moved(width=4 * STATE.width) == {area: pytest.approx(math.log(4))}
    assert moved(gap=2 * STATE.gap) == {area: pytest.approx(-math.log(2) / 8)}
    assert moved(patch=replace(PATCH, constant=3e-19)) == {attraction: pytest.approx(math.log(2))}
    contact = of_devices.pull(STATE.patch_length, Beam(1e-3, 30e-6, 2e-6, 164e9, 2e-6, 1))[0] / (2 * STATE.pull_off)
    (own,) = (value for name, value in zip(COORDINATES, STATE.coordinates, strict=True) if name == area)
    assert own == pytest.approx(math.log(contact * PATCH.heights.moments[2] / PATCH.heights.moments[1]), rel=1e-9)


def test_lengths_are_those_of_the_process_over_the_closed_form():
    lengths = dry_bridge.lengths(STATE, MIDDLE)
    assert lengths.at(0.0) == pytest.approx(STATE.patch_length * math.exp(-0.2))
    assert lengths.at(-3.0) == pytest.approx(STATE.patch_length * math.exp(-0.5))


# Answers


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_a_stiffer_solid_that_attracts_as_much_more_has_the_same_lengths(factor):
    solids = SolidPair(factor * 164e9, factor * 164e9, in_dry_air=factor * SolidPair.in_dry_air)
    alone = SolidPair(in_dry_air=1.5 * SolidPair.in_dry_air)
    own = asked(residual_stress_MPa=0)
    lengths = [answer(replace(own, solids=each), *known()).chosen.length for each in (SolidPair(), solids, alone)]
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-9)
    assert lengths[2] < 0.98 * lengths[0], "the control: the constant alone"


@pytest.mark.parametrize("keys", [{"thickness_um": 3}, {"gap_um": 3}, {"residual_stress_MPa": 100}])
def test_what_frees_a_bridge_lets_it_be_longer(keys):
    assert found(**keys).chosen.length > 1.05 * found().chosen.length


def test_rougher_bridges_may_be_longer():
    library, on = content()["library"], {"pairs": {"b": {"beam": "S", "substrate": "Sub1"}}}
    sections = [
        on | {"surfaces": {"S": library["B2"] | {"rms_nm": rms}}, "devices": {"R": BRIDGE}}
        for rms in (1.5, 2, 2.5, 3.2)
    ]
    lengths = [answer(questions(each, content())["R"], *known()).chosen.length for each in sections]
    assert np.all(np.diff(lengths) > 0)


def test_fewer_stick_at_shorter_lengths_within_intervals_and_the_worst_air_decides():
    once, both = found(), found(humidities=["dry", 0.85])
    lengths = [row.length for row in once.rows]
    assert lengths == sorted(lengths, reverse=True)
    for row in once.rows:
        (low90, high90), (low95, high95) = row.intervals["90"], row.intervals["95"]
        assert low95 <= low90 < row.length < high90 <= high95
    assert both.chosen.length == min(once.chosen.length, found(humidities=[0.85]).chosen.length)


def test_a_voltage_shortens_them_by_the_pull_off_of_their_stopper():
    oxide = {"thickness_nm": 100, "permittivity": 3.9}
    bare, driven = asked(), asked(voltage_V=5, dielectric=oxide)
    (half,) = in_one_air(bare, 0.0, [0.5], *known())
    (other,) = in_one_air(driven, 0.0, [0.5], *known())
    patch = DryPatch(bare.surfaces[0] + bare.surfaces[1], SolidPair.in_dry_air, AREA, 164e9)
    processes = (Surrogate(**content()["dry"]["stoppers"][name]) for name in ("forces", "full"))
    pull = math.exp(-reciprocals(patch, *processes).logarithms[0]) / AREA
    product = 768 * (164e9 * 2e-6**3) ** 2 * 2e-6**3 / bare.closed.bare(half.length) ** 8
    expected = ((product / pull + driven.added) * (pull + driven.tension) / product) ** -0.125
    assert bare.closed.bare(other.length) / bare.closed.bare(half.length) == pytest.approx(expected, rel=1e-9)
    assert expected < 0.99


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"gap_um": 6.5}, "the gap of a bridge must be from 0.3 to 6 µm"),
        ({"residual_stress_MPa": 300}, "the stress of a bridge must be from 0 to 200 MPa"),
    ],
)
def test_a_bridge_that_was_not_learnt_has_no_number(keys, reason):
    with pytest.raises(NotLearnt, match=reason):
        found(**keys)


# Learning


def stored_bridges(monkeypatch, *more):
    """One computed point with two bridges, and others."""
    lengths = 2e-4 * np.exp(0.1 * np.random.default_rng(1).normal(size=(2, 4000)))
    numbers = {"constant": 1.5e-19, "sizes": np.array([[2e-6, 2e-6, 50e6], [3e-6, 1e-6, 0.0]]), "lengths": lengths}
    points = [(POINT, numbers | each) for each in ({}, *more)]
    without = {key: numbers[key] for key in ("constant", "sizes")}
    monkeypatch.setattr(dry_rows, "stored", lambda *_: [*points, (POINT, without)])
    return numbers


def test_rows_are_lengths_without_stress_over_the_closed_form(monkeypatch):
    numbers = stored_bridges(monkeypatch, {"lengths": np.full((2, 100), np.inf)})
    rows = dry_rows.rows_of_middles(Path(), "learn", 164e9, *PATCHES)
    states = dry_rows.bridges_of(POINT, numbers, 164e9, *PATCHES)
    assert len(rows.surface) == 2
    assert states[0].pull_off == pytest.approx(PATCH.flat_force / AREA * math.exp(-5), rel=1e-9)
    np.testing.assert_allclose(rows.coordinates, [state.coordinates for state in states])
    bare = [
        Stretched.of(50e6, 2e-6, 164e9).bare(float(np.median(numbers["lengths"][0]))),
        np.median(numbers["lengths"][1]),
    ]
    expected = [math.log(length / state.patch_length) for length, state in zip(bare, states, strict=True)]
    np.testing.assert_allclose(rows.values["at_0"], expected, atol=1e-3)


@pytest.mark.parametrize(("free", "number"), [(0.5, 1), (0.95, 0)])
def test_a_tested_length_is_that_of_the_first_bridge(monkeypatch, free, number):
    numbers = stored_bridges(monkeypatch)
    for lengths in numbers["lengths"]:
        lengths[lengths >= np.quantile(lengths, 1 - free)] = np.inf
    tested = list(dry_rows.tested_bridges(Path(), "any", 164e9, -3.0902, lambda _: (MIDDLE, *PATCHES)))
    assert len(tested) == number
    for one in tested:
        state = dry_rows.bridges_of(POINT, numbers, 164e9, *PATCHES)[0]
        assert one.estimate == pytest.approx(state.patch_length * math.exp(-0.4 - 0.1 * 1.0902))
        bare = Stretched.of(50e6, 2e-6, 164e9).bare(2e-4 * math.exp(-0.30902))
        assert one.true == pytest.approx(bare, rel=0.05)


def test_a_patch_that_was_not_learnt_is_refused(monkeypatch):
    stored_bridges(monkeypatch)
    beyond = Surrogate(
        [0],
        [0.0],
        [1.0],
        [1.0],
        [[0.0]],
        {"ratio": [0.0, 0.0], "power": [1.0, 0.0]},
        {"ratio": [0.0], "power": [0.0]},
        [0.0],
        [1.0],
        1.0,
    )
    (one,) = dry_rows.tested_bridges(Path(), "any", 164e9, -3.0902, lambda _: (MIDDLE, PATCHES[0], beyond))
    assert not one.is_known


@pytest.mark.parametrize(("power", "applied"), [(0.8, 1.0), (1.2, 1.2)])
def test_a_correction_changes_energies_and_attractions_by_their_own_ratios(monkeypatch, power, applied):
    at = np.array([0.0])
    summits = np.exp(0.2 * np.random.default_rng(3).normal(size=(400, 1)))
    full = [ratio * summits**power for ratio in (1.3, 1.6)]
    monkeypatch.setattr(full_contact, "energies", lambda _: (at, full[0], summits))
    monkeypatch.setattr(full_contact, "pull_offs", lambda _: (at, full[1], summits))
    models = np.array([np.stack(full, axis=-1), np.stack([summits] * 2, axis=-1)])
    monkeypatch.setattr(full_contact, "moved_models", lambda _: models)
    change = dry_bridges.correction_of(None)
    for one, values in zip(change.at(0.0), full, strict=True):
        assert one.ratio == pytest.approx(values.mean() / summits.mean(), rel=0.01)
        assert one.power == pytest.approx(applied, rel=0.02)


def test_numbers_of_a_point_have_lengths_where_full_contact_is_found(monkeypatch):
    studies = iter([None, "study"])
    ratio = SimpleNamespace(ratio=np.array([1.5]))
    change = SimpleNamespace(energy=ratio, pull_off=ratio)
    monkeypatch.setattr(dry_patches, "study_of", lambda *_: next(studies))
    monkeypatch.setattr(dry_bridges, "correction_of", lambda _: change)
    strips = SimpleNamespace(lengths_in=lambda air, sizes, number, change: np.full(number, air + sizes[0]))
    monkeypatch.setattr(dry_bridges.TrainingStrips, "of", lambda *_: strips)
    without, numbers = (dry_bridges.computed(replace(POINT, number=2), "learn_any", base(["dry"])) for _ in range(2))
    assert set(without) == {"constant", "sizes"}
    sizes = sizes_of(replace(POINT, number=2), "learn_any")[:3]
    np.testing.assert_array_equal(numbers["sizes"], sizes)
    np.testing.assert_allclose(numbers["lengths"], np.repeat(sizes[:, :1], 200, axis=1), rtol=1e-6)
    assert numbers["constant"] == dry.constants(replace(POINT, number=2), "learn_any")[0]
    assert numbers["ratios"].tolist() == [1.5, 1.5]


def test_the_process_is_trusted_all_over_its_design_and_not_beyond():
    rng = np.random.default_rng(4)
    along = rng.uniform(0, 3, 60)
    coordinates = np.column_stack([along, along + 0.1 * rng.normal(size=60)])  # along a diagonal, far from two corners
    rows = DesignRows(coordinates, {"at_2": np.sin(5 * along)}, np.arange(60), np.ones(60))
    near = fitted(rows, "at_2", range(2), 30)
    process = Surrogate(**everywhere(near).content)
    corners = [process.at(corner) for corner in product(*zip(process.low, process.high, strict=True))]
    assert all(corner.distance <= process.farthest and not corner.outside for corner in corners)
    assert any(corner.distance > near.content["farthest"] for corner in corners), "the control: near nodes alone"
    assert process.at((process.low[0] - 1e-3, 1.0)).outside == (0,)


def test_points_are_the_first_of_those_in_humid_air():
    for name, effort in dry_bridges.SETS.items():
        assert effort.all == training.SETS[name].all[: effort.points]
        assert effort.seed == training.SETS[name].seed


def test_drawn_bridges_are_longer_than_the_end_to_use():
    """On surfaces that are not the paper's and were not learnt, in full contact as of a run."""
    point, name = dry_bridges.SETS["check_any"].all[2], "check_any"
    with without_progress():
        numbers = dry_bridges.computed(point, name, base(["dry"]))
    thickness, gap, stress = numbers["sizes"][0].tolist()
    sizes = thickness, gap, 1e-6 * point.width, stress
    solids = SolidPair(in_dry_air=float(numbers["constant"]))
    bridge = Bridge("", tuple(map(heights_of, point.sides)), ({}, {}), (0.0,), *sizes, solids=solids)
    (row,) = in_one_air(bridge, 0.0, [1e-2], *known())
    low, high = row.intervals["90"]
    assert low < np.quantile(numbers["lengths"][0], 0.01) < high

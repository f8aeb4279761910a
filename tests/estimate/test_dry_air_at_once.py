"""The estimate in dry air: flats, scaling with the Hamaker constant, what a run changes, words, and refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.correction import ElasticChange
from stiction.contact.environment import flooded_law
from stiction.contact.vanderwaals import DugdaleAttraction
from stiction.estimate import dry
from stiction.estimate.answer import TO_USE, answer
from stiction.estimate.learning.training import SETS
from stiction.estimate.length import NotLearnt, normal_score
from stiction.estimate.question import questions
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate, content, known

POLYSILICON = HAMAKER_CONSTANT["dry"]
LEVER = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": ["dry"]}
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": ["dry"], "restoring_force_uN": 60}
(POINT,) = SETS["control"].all
HEIGHTS = of_pair(POINT.sides)
TIP = dry.DryTip(HEIGHTS, 1.5e-19, 7000.0, 20e-6, 164e9)
PATCH = dry.DryPatch(HEIGHTS, 1.5e-19, 9e-12, 164e9)


def of_material(constant, **more):
    """Sections of surfaces like the paper's pair b, whose material has a Hamaker constant in dry air [zJ]."""
    sides = {name: content()["library"][like] | {"material": "Mine"} for name, like in (("S", "B2"), ("T", "Sub1"))}
    material = {"hamaker_constant_zJ": {"water": 50, "dry": constant}} | more
    return {"surfaces": sides, "pairs": {"b": {"beam": "S", "substrate": "T"}}, "materials": {"Mine": material}}


def found(device=LEVER, sections=None, **keys):
    """Answer about a device with other keys."""
    return answer(questions({"devices": {"D": device | keys}} | (sections or {}), content())["D"], *known())


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


def falling(first, step=0.1, slope=0.15):
    """Process of quantities that fall by a step between scores."""
    return process_of(at_0=first, at_1=first - step, at_2=first - 2 * step, slope=slope)


@pytest.mark.parametrize("constant", [POLYSILICON, 1e-19])
def test_flats_hold_with_the_work_of_solids_that_touch(constant):
    solids = DugdaleAttraction(constant)
    assert dry.work_of(constant) == pytest.approx(solids.work_of_adhesion)
    assert pytest.approx(solids.equilibrium_distance) == dry.AT_REST
    tip = replace(TIP, constant=constant)
    # The balance of arcs, 2/27 K θ³ = ω/θ: `stiction.devices.arcs`.
    assert 2 / 27 * tip.stiffness * tip.flat_slope**4 == pytest.approx(solids.work_of_adhesion)


def test_rough_stoppers_hold_less_than_flats():
    """The pressure between flats is a bound of that of any surfaces."""
    from stiction.contact.environment import Gaps, Water

    both = {"water": POLYSILICON, "dry": POLYSILICON}
    _, largest = flooded_law(0.0, Water(300.0, gaps=Gaps(both, "dry")), POLYSILICON)
    rare = found(BUMP).rows[-1]
    assert rare.force < 0.2 * largest * 9e-12
    assert largest * 9e-12 > 0.3 * replace(PATCH, constant=POLYSILICON).flat_force  # it is of the size of ω/D₀


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_a_stiffer_solid_that_attracts_as_much_more_has_the_same_lengths(factor):
    scaled = {"constant": factor * 1.5e-19, "modulus": factor * 164e9}
    tip, patch = replace(TIP, **scaled, stiffness=factor * 7000.0), replace(PATCH, **scaled)
    np.testing.assert_allclose(tip.coordinates, TIP.coordinates, rtol=1e-12)
    np.testing.assert_allclose(patch.coordinates, PATCH.coordinates, rtol=1e-12)
    assert tip.flat_slope == pytest.approx(TIP.flat_slope)
    assert patch.flat_force == pytest.approx(factor * PATCH.flat_force)
    soft = replace(TIP, constant=factor * 1.5e-19).coordinates  # control: the constant alone
    moved = np.subtract(soft, TIP.coordinates)[[dry.OF_TIPS.index(name) for name in dry.OF_TIPS if "Hamaker" in name]]
    np.testing.assert_allclose(moved, math.log(factor))


def test_an_area_and_a_width_move_their_own_coordinates_alone():
    for one, name, changes in (
        (PATCH, "area in contact in summits", {"area": 36e-12}),
        (TIP, "width", {"width": 80e-6}),
    ):
        moved = np.subtract(replace(one, **changes).coordinates, one.coordinates)
        (k,) = (k for k, of in enumerate(one.names) if of.startswith(name))
        assert moved[k] == pytest.approx(math.log(4))
        np.testing.assert_allclose(np.delete(moved, k), 0, atol=1e-12)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.4])
def test_full_contact_of_tips_acts_as_a_softer_beam(ratio):
    gap, tips = 2e-5, falling(0.9)
    own = dry.lengths(TIP, gap, tips, process_of(ratio=0.0, power=1.0))
    changed = dry.lengths(TIP, gap, tips, process_of(ratio=math.log(ratio), power=0.9))
    for score in (0.0, -1.5, -4.0):
        assert changed.at(score) == pytest.approx(own.at(score) * ratio**-0.25)
    assert own.at(0.0) == pytest.approx(1.5 * gap / TIP.flat_slope * math.exp(0.9))


def test_full_contact_that_scatters_more_keeps_the_mean_force_of_tips():
    """Of forces that fall with the slope as of smooth tips, lengths are those of the changed forces."""
    scatter, power = 0.4, 1.3
    forces = np.exp(scatter * np.random.default_rng(1).normal(size=400_000))
    changed = ElasticChange(1.2, power).of(forces)(forces)
    tips = falling(0.9, scatter / 4, scatter / 4)
    own = dry.lengths(TIP, 1.0, tips, process_of(ratio=0.0, power=1.0))
    of_full = dry.lengths(TIP, 1.0, tips, process_of(ratio=math.log(1.2), power=power))
    for score in (0.0, -1.0, -3.0):
        expected = own.at(0.0) * np.quantile(changed, norm.sf(score)) ** -0.25
        assert of_full.at(score) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("power", [1.0, 1.3])
def test_lognormal_forces_of_stoppers_change_as_in_a_run(power):
    scatter = 0.5
    forces = PATCH.flat_force * np.exp(-4 + scatter * np.random.default_rng(1).normal(size=1_000_000))
    changed = ElasticChange(1.4, power).of(forces)(forces)
    lengths = dry.reciprocals(PATCH, falling(4, scatter, scatter), process_of(ratio=math.log(1.4), power=power))
    for score in (0.0, -1.0, -2.0, -3.0):
        assert 1 / lengths.at(score) == pytest.approx(np.quantile(changed, norm.sf(score)), rel=0.015)


@pytest.mark.parametrize("device", [LEVER, BUMP])
def test_more_attraction_holds_more_and_polysilicon_is_what_is_not_stated(device):
    weak, own, strong = (found(device, of_material(constant)).chosen.size for constant in (120, 186.5, 300))
    signs = np.sign(np.diff([weak, own, strong]))
    assert np.all(signs == (1 if device is BUMP else -1))
    assert own == pytest.approx(found(device).chosen.size)


@pytest.mark.parametrize(("device", "sign"), [(LEVER, 1), (BUMP, -1)])
def test_rougher_surfaces_hold_less(device, sign):
    library, on = content()["library"], {"pairs": {"b": {"beam": "S", "substrate": "Sub1"}}}
    surfaces = ({"surfaces": {"S": library["B2"] | {"rms_nm": rms}}} for rms in (1.7, 2.5, 3.5, 5.0, 7.0))
    sizes = [found(device, on | each).chosen.size for each in surfaces]
    assert np.all(sign * np.diff(sizes) > 0)


def test_thicker_beams_and_those_over_larger_gaps_may_be_longer():
    thin, own, low = (found(**keys).chosen.length for keys in ({"thickness_um": 2}, {}, {"gap_um": 25}))
    assert thin < own < low  # L ∝ (t³ h²)^(1/4), because a larger gap bends more


def test_dry_air_is_a_word_or_zero_and_the_worst_of_several_airs_decides():
    dry_air, humid = found(), found(humidities=[0.85])
    assert found(humidities=[0.0]).rows == dry_air.rows
    both = found(humidities=["dry", 0.85])
    assert both.chosen.length == min(dry_air.chosen.length, humid.chosen.length)
    assert {dry_air.humidity, humid.humidity} == {0.0, 0.85}
    assert both.humidity in (0.0, 0.85)


@pytest.mark.parametrize("device", [LEVER, BUMP])
def test_fewer_stick_beyond_and_intervals_are_nested(device):
    once, often = found(device), found(device, touchdowns=100)
    sizes = [row.size for row in once.rows]
    assert sizes == sorted(sizes, reverse=device is LEVER)
    for row in once.rows:
        (low90, high90), (low95, high95) = row.intervals["90"], row.intervals["95"]
        assert low95 <= low90 < row.size < high90 <= high95
    harder = [more.size > row.size for row, more in zip(once.rows, often.rows, strict=True)]
    assert all(harder) if device is BUMP else not any(harder)


def test_intervals_are_those_of_dry_air():
    row, part = found().chosen, content()["dry"]
    tip = dry.DryTip(
        of_pair([content()["library"][name] for name in ("B2", "Sub1")]),
        POLYSILICON,
        164e9 * 2.6**3 / 400 * 1e-6,
        30e-6,
        164e9,
    )
    slope = dry.lengths(tip, 20e-6, *dry.processes(part, "tips", "full")).slope
    score = max(1.0, normal_score(1e-3) / part["tested_score"])
    unit, (low, high) = math.hypot(slope, part["rest"]) * score, row.intervals["90"]
    assert math.log(row.length / low) == pytest.approx(part["margins"][TO_USE] * unit)
    assert math.log(high / row.length) == pytest.approx(part["margins"]["90"] * unit)
    assert part["margins"][TO_USE] > 1.1 * part["margins"]["90"], "control"


@pytest.mark.parametrize(
    ("device", "keys", "sections", "reason"),
    [
        (LEVER, {}, of_material(150, coating_nm=1.2), "coating_nm of Mine was not learnt"),
        (LEVER, {}, of_material(150) | {"materials": {}}, "material Mine is not among"),
        (LEVER, {}, of_material(5), "attraction of the solids over slopes .* is too small"),
        (BUMP, {}, of_material(3000), "attraction of the solids over slopes .* is too large"),
        (BUMP, {"contact_um": [3, 30]}, {}, "from 1 to 6 µm"),
        (LEVER, {"width_um": 3000}, {}, "width of the beam in summits is too large"),
        (LEVER, {}, {"attraction": {"reach": "touching"}}, "attraction was not learnt"),
    ],
)
def test_what_was_not_learnt_in_dry_air_has_no_number(device, keys, sections, reason):
    with pytest.raises(NotLearnt, match=reason):
        found(device, sections, **keys)


def test_the_reach_that_devices_have_may_be_stated():
    assert found(LEVER, {"attraction": {"reach": "all"}}).rows == found().rows

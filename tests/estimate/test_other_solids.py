"""Other solids, contact angles and temperatures in the estimate: similarity, what a run states, learning, refusals."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stiction
from stiction.config.messages import ConfigError
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.materials import Solid
from stiction.contact.solids import composite_modulus, hamaker_constant
from stiction.estimate import question as asking
from stiction.estimate.answer import CONFIDENCES, MARGINS, OF_OTHER_SOLIDS, answer
from stiction.estimate.bridge import COORDINATES as OF_BRIDGES
from stiction.estimate.bridge import MiddleState
from stiction.estimate.force import reciprocals
from stiction.estimate.learning import bridges, make, patches, training
from stiction.estimate.learning import errors as of_estimates
from stiction.estimate.learning.design import states
from stiction.estimate.learning.files import save
from stiction.estimate.learning.other_solids import points, ratios, rows
from stiction.estimate.learning.other_solids.ratios import ALL, material_of
from stiction.estimate.learning.rows import of_forces, patches_of, states_of
from stiction.estimate.length import Impossible, NotLearnt, lengths, on_solids
from stiction.estimate.question import ENDS, OF_ATTRACTION, questions
from stiction.estimate.solids import OF_POLYSILICON, OF_WATER, BesideWater, SolidPair, following
from stiction.estimate.state import COORDINATES, OF_PATCHES, Film, PatchState, TipState, film
from stiction.estimate.statistics import of_pair
from stiction.estimate.table import Surrogate, content, known, processes
from stiction.progress import without_progress

LEVER = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.7]}
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": [0.7], "restoring_force_uN": 60}
ARCH = {"kind": "bridge", "pair": "b", "thickness_um": 2, "gap_um": 2, "width_um": 30, "residual_stress_MPa": 50}
ARCH |= {"humidities": [0.7]}
(POINT,) = training.SETS["control"].all
HEIGHTS = of_pair(POINT.sides)
WATER = film(0.7, 300.0, 2.0)
TIP = TipState(HEIGHTS, WATER, 7000.0, 20e-6, 164e9)
PATCH = PatchState(HEIGHTS, WATER, 9e-12, 164e9)


def process_of(**quantities):
    """Process of quantities that are the same everywhere."""
    trend = {key: [value] for key, value in quantities.items()}
    return Surrogate([], [], [], [], [[]], trend, {key: [0.0] for key in quantities}, [], [], math.inf)


def falling(first):
    """Process of quantities that fall by a tenth between scores."""
    return process_of(at_0=first, at_1=first - 0.1, at_2=first - 0.2, slope=0.1)


def found(device, sections=None, **keys):
    """Answer about a device in a file with other sections."""
    return answer(questions({"devices": {"D": device | keys}} | (sections or {}), content())["D"], *known())


def of_material(**material):
    """Sections of a file in which both sides of pair b are of a material."""
    sides = {"B2": {"material": "Mine"}, "Sub1": {"material": "Mine"}}
    return {"surfaces": sides, "materials": {"Mine": material}}


bodies = st.builds(
    Solid,
    young_modulus=st.floats(5e9, 5e11),
    poisson_ratio=st.floats(0.0, 0.45),
    hamaker_constant=st.fixed_dictionaries({"water": st.floats(1e-21, 3e-19), "dry": st.floats(4e-20, 5e-19)}),
    contact_angle=st.floats(0, 1.5),
)


def in_file(body):
    """Section of the material of a body."""
    constants = {medium: 1e21 * value for medium, value in body.hamaker_constant.items()}
    numbers = {"young_modulus_GPa": 1e-9 * body.young_modulus, "poisson_ratio": body.poisson_ratio}
    return numbers | {"hamaker_constant_zJ": constants, "contact_angle_deg": math.degrees(body.contact_angle)}


@given(bodies, bodies)
def test_two_bodies_are_combined_as_in_a_run(first, second):
    pair, polysilicon = SolidPair.of(in_file(first), in_file(second)), Solid()
    equal = replace(polysilicon, young_modulus=pair.modulus)
    assert composite_modulus(equal, equal) == pytest.approx(composite_modulus(first, second))
    assert pair.beam_modulus == pytest.approx(first.young_modulus)
    assert pair.through_water == pytest.approx(hamaker_constant(first, second, "water"))
    assert pair.in_dry_air == pytest.approx(hamaker_constant(first, second, "dry"))
    assert pair.wetting == pytest.approx(math.cos(first.contact_angle) + math.cos(second.contact_angle))


def test_what_is_not_stated_is_exactly_polysilicon_that_water_wets():
    assert SolidPair.of({}, {}) == SolidPair()
    assert SolidPair().beside_water(film(0.7, 300.0, 2.0).energy) == OF_POLYSILICON
    assert OF_POLYSILICON.logarithms == (0.0, 0.0, 0.0)
    assert Solid().young_modulus == SolidPair().modulus == content()["modulus"]
    assert paper()["solid"]["poisson_ratio"] == Solid().poisson_ratio
    assert dict(Solid().hamaker_constant) == {"water": SolidPair().through_water, "dry": SolidPair().in_dry_air}


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_a_state_of_the_same_numbers_is_the_same(factor):
    """Water, solids and beam that are all stronger by a factor: no coordinate changes, and no attraction beside."""
    stronger = Film(WATER.height, factor * WATER.energy)
    tip = replace(TIP, film=stronger, stiffness=factor * TIP.stiffness, modulus=factor * TIP.modulus)
    np.testing.assert_allclose(tip.coordinates, TIP.coordinates, rtol=1e-12)
    own = SolidPair()
    solids = SolidPair(
        modulus=factor * own.modulus,
        through_water=factor * own.through_water,
        in_dry_air=factor * own.in_dry_air,
    )
    assert solids.beside_water(stronger.energy).logarithms == pytest.approx((0, 0, 0), abs=1e-12)
    control = own.beside_water(stronger.energy)
    assert control.through_water == pytest.approx(1 / factor), "the control: water alone"
    combined = ((math.sqrt(97.5 / factor) + math.sqrt(37)) / (math.sqrt(97.5) + math.sqrt(37))) ** 2
    assert control.through_air * combined == pytest.approx(1 / factor)
    assert control.stiffness == pytest.approx(1 / factor)


@given(st.floats(1e-21, 5e-19), st.floats(1e-21, 5e-19))
def test_attraction_through_air_that_follows_is_that_of_the_combining_relation(first, second):
    """Of constants in vacuum, the root of that through a medium is the difference of the roots, that in air none."""

    def through_water(in_air):
        """Constant through water of two bodies of a constant in air."""
        return (math.sqrt(in_air) - math.sqrt(OF_WATER)) ** 2

    of_air = sorted(OF_WATER + each for each in (first, second))
    for in_air in of_air:
        assert following(through_water(in_air)) == pytest.approx(in_air, rel=1e-6)
    one, other = (SolidPair(through_water=through_water(each), in_dry_air=each).beside_water(0.144) for each in of_air)
    assert one.through_air == pytest.approx(other.through_air, rel=1e-6), "all that follow have the same"
    more = SolidPair(through_water=through_water(of_air[0]), in_dry_air=2 * of_air[0]).beside_water(0.144)
    assert more.through_air == pytest.approx(2 * one.through_air)
    assert more.through_water == one.through_water


def pressures_of(modulus=164, ratio=1.0, humidity=0.6, temperature=300.0, angle=0.0):
    """Pull-off pressures of patches of the control point."""
    plan = patches.plan_of(POINT, (1.0, 1.0), patches.base())
    material = {"young_modulus_GPa": modulus, "contact_angle_deg": angle}
    material |= {"hamaker_constant_zJ": {name: 1e21 * ratio * value for name, value in HAMAKER_CONSTANT.items()}}
    with without_progress():
        return patches.forces_in(POINT, points.with_solids(plan, temperature, [material] * 2), [humidity], 3, 1)[0]


def test_contacts_of_a_run_have_the_similarity():
    """Of a film of the same height with half the energy, solids half as stiff that attract half as much hold half."""
    own, height = pressures_of(), film(0.6, 300.0, 2.0).height
    materials = [{"contact_angle_deg": 60.0}] * 2
    drier = points.humidity_of(300.0, materials, height)
    assert film(drier, 300.0, 1.0).height == pytest.approx(height, rel=1e-3)
    half, alone = pressures_of(82, 0.5, drier, angle=60.0), pressures_of(82, 1.0, drier, angle=60.0)
    np.testing.assert_allclose(half, own / 2, rtol=2e-3)
    assert np.all(alone > 1.02 * own / 2), "the control: solids that attract as before"


def test_stronger_attraction_shortens_by_what_was_learnt_for_each_logarithm():
    change = process_of(at_0=-0.1, at_1=-0.2, at_2=-0.3)
    own = lengths(TIP, 1.0, falling(0.9), None, change)
    strong = lengths(replace(TIP, beside_water=BesideWater(math.e)), 1.0, falling(0.9), None, change)
    for score, by in ((0.0, 0.1), (-1.0, 0.2), (-2.0, 0.3)):
        assert strong.at(score) == pytest.approx(own.at(score) * math.exp(-by))
    weak = lengths(replace(TIP, beside_water=BesideWater(math.exp(-0.5))), 1.0, falling(0.9), None, change)
    assert weak.at(-1.0) == pytest.approx(own.at(-1.0) * math.exp(0.1))
    in_air = replace(TIP, beside_water=BesideWater(1.0, math.e))
    assert lengths(in_air, 1.0, falling(0.9), None, change).at(-1.0) == own.at(-1.0), "the control: it is not learnt"
    assert lengths(in_air, 1.0, falling(0.9), None, change, change).at(-1.0) == pytest.approx(strong.at(-1.0))
    both = lengths(
        replace(TIP, beside_water=BesideWater(math.e, math.exp(-0.5))), 1.0, falling(0.9), None, change, change
    )
    assert both.at(-1.0) == pytest.approx(own.at(-1.0) * math.exp(-0.1))
    forces = falling(1.5), process_of(ratio=0.0, power=1.0), change
    more = reciprocals(replace(PATCH, beside_water=BesideWater(math.e)), *forces)
    assert more.at(0.0) == pytest.approx(reciprocals(PATCH, *forces).at(0.0) * math.exp(-0.1))


def test_stiffer_solids_are_those_of_polysilicon_and_what_was_learnt_for_its_logarithm():
    """Not a state of polysilicon's water with another modulus, of which nothing was learnt."""
    nothing = process_of(at_0=0.0, at_1=0.0, at_2=0.0)
    change = process_of(at_0=0.1, at_1=0.1, at_2=0.1)
    softness = 1
    steep = Surrogate([softness], [0.0], [1.0], [1.0], [[0.0]], *slopes_of(0.5), [-9.0], [9.0], math.inf)
    stiff = replace(TIP, modulus=4 * TIP.modulus, beside_water=BesideWater(stiffness=4.0))
    own = lengths(TIP, 1.0, steep, None)
    assert lengths(stiff, 1.0, steep, None).at(-1.0) == pytest.approx(own.at(-1.0), rel=1e-12)
    learnt = lengths(stiff, 1.0, steep, None, nothing, nothing, change)
    assert learnt.at(-1.0) == pytest.approx(own.at(-1.0) * 4**0.1)
    control = lengths(replace(TIP, modulus=4 * TIP.modulus), 1.0, steep, None)
    assert control.at(-1.0) == pytest.approx(own.at(-1.0) * 4**-0.5)
    pad = replace(PATCH, modulus=4 * PATCH.modulus, beside_water=BesideWater(stiffness=4.0))
    forces = steep, process_of(ratio=0.0, power=1.0), nothing, nothing, change
    assert reciprocals(pad, *forces).at(0.0) == pytest.approx(reciprocals(PATCH, *forces).at(0.0) * 4**0.1)


def slopes_of(slope):
    """Trends of quantities that rise by a slope, and weights without effect."""
    trend = {f"at_{k}": [2.0 - 0.1 * k, slope] for k in range(3)} | {"slope": [0.1, 0.0]}
    return trend, dict.fromkeys(trend, [0.0])


def test_lengths_of_bridges_change_by_what_was_learnt_and_moduli_act_in_their_places():
    from stiction.estimate import bridge

    state = MiddleState(HEIGHTS, WATER, 2e-6, 2e-6, 30e-6, 50e6, 164e9, 164e9)
    learnt = falling(0.5), process_of(shift=0.0, power=1.0), process_of(at_0=-0.1, at_1=-0.1, at_2=-0.1)
    own, strong = (bridge.lengths(each, *learnt) for each in (state, replace(state, beside_water=BesideWater(math.e))))
    assert strong.at(-2.0) == pytest.approx(own.at(-2.0) * math.exp(-0.1))
    stiff = replace(state, modulus_in_contact=2 * 164e9).coordinates
    assert stiff[1] == pytest.approx(state.coordinates[1] - math.log(2))
    np.testing.assert_allclose(np.delete(stiff, 1), np.delete(state.coordinates, 1))


def test_attraction_beyond_what_was_learnt_is_refused_by_its_name():
    quantities = (
        {"at_0": [0.0, 0.0], "at_1": [0.0, 0.0], "at_2": [0.0, 0.0]},
        dict.fromkeys(("at_0", "at_1", "at_2"), [0.0]),
    )
    process, in_air = (
        Surrogate([column], [0.0], [1.0], [1.0], [[0.0]], *quantities, [-1.0], [1.0], 9.0) for column in (10, 11)
    )
    learnt = falling(0.0)
    with pytest.raises(NotLearnt, match="attraction of the solids beside that of the water .* is too large"):
        on_solids(learnt, replace(TIP, beside_water=BesideWater(9.0)), process, in_air)
    with pytest.raises(
        NotLearnt, match="attraction of the solids through air beside that through water .* is too small"
    ):
        on_solids(learnt, replace(TIP, beside_water=BesideWater(2.0, 0.1)), process, in_air)
    assert on_solids(learnt, TIP, process, in_air) == learnt.at(()).of


@pytest.mark.parametrize("device", [LEVER, BUMP, ARCH])
def test_softer_solids_stick_more_and_less_wetting_ones_less(device):
    def holds(**material):
        """What holds it, in proportion to its tendency to stick."""
        size = found(device, of_material(**material)).chosen.size
        return size if device is BUMP else 1 / size

    own = holds()
    assert holds(young_modulus_GPa=120) > own
    assert holds(contact_angle_deg=50) < own
    assert holds(hamaker_constant_zJ={"water": 200, "dry": 400}) > own
    assert found(device).chosen.size == pytest.approx(1 / own if device is not BUMP else own, rel=1e-12)


def test_a_material_of_the_beam_alone_bends_it_and_that_of_the_whole_solid_both():
    hard = {"young_modulus_GPa": 300}
    one = {"surfaces": {"B2": {"material": "Mine"}}, "materials": {"Mine": hard}}
    beam = questions({"devices": {"D": LEVER}} | one, content())["D"].solids
    whole = questions({"devices": {"D": LEVER}, "solid": hard}, content())["D"].solids
    assert (beam.beam_modulus, whole.beam_modulus, whole.modulus) == pytest.approx((300e9, 300e9, 300e9))
    assert beam.modulus == pytest.approx(2 / (1 / 300e9 + 1 / 164e9))


def test_a_material_by_name_has_the_numbers_of_a_run():
    silica = questions({"devices": {"D": LEVER}, "surfaces": {"B2": {"material": "SiO2"}}}, content())["D"].solids
    assert silica.beam_modulus == pytest.approx(73.1e9)
    assert silica.through_water == pytest.approx(math.sqrt(4.6e-21 * HAMAKER_CONSTANT["water"]))
    like = {"surfaces": {"B2": {"material": "Mine"}}, "materials": {"Mine": {"like": "SiO2", "contact_angle_deg": 60}}}
    mine = questions({"devices": {"D": LEVER}} | like, content())["D"].solids
    assert (mine.beam_modulus, mine.wetting) == pytest.approx((silica.beam_modulus, 1.5))


def test_what_water_does_not_wet_sticks_as_in_dry_air():
    both = of_material(contact_angle_deg=100)
    assert found(LEVER, both).rows == found(LEVER, both, humidities=["dry"]).rows
    assert found(LEVER, of_material(contact_angle_deg=60)).rows != found(LEVER, both).rows, "the control"


def test_warmer_water_has_its_own_film():
    warm = found(LEVER, {"water": {"temperature_K": 350}})
    assert warm.chosen.size > found(LEVER).chosen.size
    assert found(LEVER, {"water": {"temperature_K": 300}}).rows == found(LEVER).rows


def test_a_file_changes_single_keys_of_a_typical_surface():
    rougher = found(LEVER, {"surfaces": {"B2": {"rms_nm": 5}}})
    assert rougher.chosen.size > found(LEVER).chosen.size


# What a run refuses


def refused(values, key, value):
    """Sentence with which a run refuses a value at a path, None if it does not."""
    sections = {"surfaces": {"Mine": {"like": "B2", "rms_nm": 3}}, "materials": {"Soft": {}}, "solid": {}, "water": {}}
    place = sections
    for name in values:
        place = place.setdefault(name, {})
    place[key] = value
    try:
        stiction.load({"run": {"pairs": [], "studies": []}, **{k: v for k, v in sections.items() if v}})
    except ConfigError as error:
        return next((line for line in error.problems if line.startswith(".".join([*values, key]))), None)
    return None


def estimate_refuses(values, key, value):
    """Sentence with which the estimate refuses it."""
    surfaces = {"B2": {"material": "Soft"}, "Mine": {"like": "B2", "rms_nm": 3, "material": "Soft"}}
    sections = {"surfaces": surfaces, "materials": {"Soft": {}}, "solid": {}, "water": {}}
    sections |= {"pairs": {"p": {"beam": "Mine", "substrate": "Sub1"}}}
    place = sections
    for name in values:
        place = place.setdefault(name, {})
    place[key] = value
    reason = questions({"devices": {"D": LEVER | {"pair": "p"}}} | sections, content())["D"]
    return str(reason) if isinstance(reason, Impossible) else None


def _schema_of(values):
    """Schema of the keys at a path."""
    part = schema()["properties"][values[0]]
    for name in values[1:]:
        part = part["properties"][name] if name in part.get("properties", {}) else part["additionalProperties"]
    return part["properties"]


PLACES = [("surfaces", "Mine"), ("materials", "Soft"), ("solid",), ("water",)]
KNOWN = {"surfaces": asking.OF_SURFACES, "materials": asking.OF_MATERIALS} | asking.OF_SECTIONS


@pytest.mark.parametrize("values", PLACES)
def test_numbers_that_a_run_refuses_are_refused_with_its_sentence(values):
    """All numbers of what the estimate reads: each a little beyond each of its ends, and at them."""
    seen = 0
    for key, part in _schema_of(values).items():
        if key not in KNOWN[values[0]] or part.get("type") != "number":
            continue
        if key in ("hardness_GPa", "density_kg_per_m3"):
            continue  # they change no length or force
        for least, inside in (("minimum", True), ("exclusiveMinimum", False), ("maximum", True)):
            if least in part:
                beyond = part[least] * 1.5 + 1 if least == "maximum" else part[least] - 0.5
                assert (expected := refused(values, key, beyond)), (key, beyond)
                sentence = estimate_refuses(values, key, beyond)
                assert sentence, (key, beyond)
                assert expected.startswith(f"{sentence}:"), (sentence, expected)
                assert ENDS[key].refusal(part[least]) is None or not inside, (key, least)
                seen += 1
    assert seen >= 1
    assert estimate_refuses(("surfaces", "Mine"), "hurst", 0.9) is None, "the control: what a run takes"


@pytest.mark.parametrize("like", ["B1", "B2"])
def test_a_hurst_exponent_above_one_is_refused_beside_a_typical_surface(like):
    surface = {"like": like, "rms_nm": 3, "hurst": 1.5}
    sections = {"surfaces": {"Mine": surface}, "pairs": {"p": {"beam": "Mine", "substrate": "Sub1"}}}
    reason = questions({"devices": {"D": LEVER | {"pair": "p"}}} | sections, content())["D"]
    assert str(reason) == "surfaces.Mine.hurst is 1.5, must be a number at least 0 and at most 1"


def test_one_moment_alone_and_a_corner_above_the_cutoff_are_refused():
    sections = {"pairs": {"p": {"beam": "Mine", "substrate": "Sub1"}}}
    for more, words in (
        ({"skewness": -0.5}, "both are stated or neither"),
        ({"corner_rad_per_um": 130}, "no spectrum"),
    ):
        surface = {"surfaces": {"Mine": {"like": "B2", "rms_nm": 3} | more}}
        reason = questions({"devices": {"D": LEVER | {"pair": "p"}}} | sections | surface, content())["D"]
        assert isinstance(reason, Impossible)
        assert words in str(reason)


def test_constants_beyond_their_ends_are_refused():
    (reason,) = [OF_ATTRACTION["water"].refusal(0)]
    assert reason == "is 0, must be a number above 0 and at most 10000"
    with pytest.raises(Impossible, match="materials.Mine.hamaker_constant_zJ.water is 0"):
        found(LEVER, of_material(hamaker_constant_zJ={"water": 0, "dry": 100}))


# Learning


@pytest.mark.parametrize("ratio", ALL, ids=lambda ratio: ratio.name)
def test_ratios_of_points_are_within_their_range_and_each_its_own(ratio):
    points_of_set = ratio.sets["learn_any"].all
    drawn = [getattr(ratio.beside_water(point, 1), ratio.name) for point in points_of_set]
    low, high = ratio.range
    assert low <= min(drawn) < max(drawn) <= high
    assert len(set(drawn)) == len(drawn)
    assert np.median(np.log(drawn)) == pytest.approx(0.5 * math.log(low * high), abs=0.9)
    for name, effort in ratio.sets.items():
        assert effort.all == training.SETS[name].all[: effort.points]


@pytest.mark.parametrize("ratio", ALL, ids=lambda ratio: ratio.name)
def test_points_of_a_ratio_have_the_other_ratios_of_those_beside_which_they_are(ratio):
    for mine, of_before in ((ratio.points, "points"), (ratio.bridges, "bridges")):
        assert mine <= getattr(ratio.before or training.SETS["learn_any"], of_before, math.inf)
    before = ratio.before.beside_water(POINT, 3) if ratio.before else OF_POLYSILICON
    ratios, without = vars(ratio.beside_water(POINT, 3)), vars(before)
    assert without[ratio.name] == 1.0 != ratios[ratio.name]
    assert {name for name in ratios if ratios[name] != without[name]} == {ratio.name}


def test_nothing_is_learnt_of_the_stiffness_on_polysilicon_alone():
    """The tension of its water follows from film, rms and spectrum, until moduli differ."""

    def least(moduli):
        """Least scatter of any combination of the coordinates in their own scatters."""
        states = [
            PatchState(of_pair(each.sides), film(0.4 + 0.01 * k, 300.0, 2.0), 1e-12 * (1 + k % 7), modulus)
            for k, (each, modulus) in enumerate(zip(training.SETS["check_any"].all, moduli, strict=True))
        ]
        coordinates = np.array([state.coordinates for state in states])
        standard = (coordinates - coordinates.mean(axis=0)) / coordinates.std(axis=0)
        return np.linalg.svd(standard, compute_uv=False).min() / math.sqrt(len(standard))

    number = training.SETS["check_any"].points
    assert least([164e9] * number) < 1e-9
    assert least(np.exp(np.random.default_rng(1).uniform(24.8, 26.7, number))) > 0.1, "the control: other moduli"


@given(st.floats(5e9, 5e11), st.floats(0.5, 2.0), st.floats(280, 360))
def test_states_know_the_stiffness_of_solids_by_its_ratio_alone(modulus, wetting, temperature):
    water = film(0.7, temperature, wetting)
    pair = SolidPair(modulus=modulus, wetting=wetting)
    stiff, own = pair.beside_water(water.energy), SolidPair(wetting=wetting).beside_water(water.energy)
    for state, key in (
        (TipState(HEIGHTS, water, 7000.0, 20e-6, modulus, stiff), "modulus"),
        (PatchState(HEIGHTS, water, 9e-12, modulus, stiff), "modulus"),
        (MiddleState(HEIGHTS, water, 2e-6, 2e-6, 30e-6, 50e6, 164e9, modulus, stiff), "modulus_in_contact"),
    ):
        of_polysilicon = replace(state, beside_water=own, **{key: 164e9})
        np.testing.assert_allclose(state.coordinates, of_polysilicon.coordinates, rtol=1e-9)
        control = replace(state, **{key: 2 * modulus}).coordinates
        assert control[1] == pytest.approx(state.coordinates[1] - math.log(2))


def test_forces_change_with_stiffness_as_was_learnt():
    """Nearer to contacts that were not learnt than without a change, and than a modulus among the coordinates."""
    effort, learnt = training.SETS["check_any"], content()["stoppers"]
    forces, _, *changes = processes(learnt, "forces", "full")
    stiffness, errors = BesideWater(stiffness=2.5), []
    for point in effort.all[:4]:
        sides, airs = patches.sides_of(point, effort.seed, effort.law), states(1, point.number, effort.seed)
        (own,) = patches_of(point, {"sides": np.array(sides), "airs": airs}, 164e9)
        plan, material = patches.plan_of(point, sides, patches.base()), material_of(stiffness)
        both = plan, training.with_materials(plan, material, material)
        with without_progress():
            pressures = [patches.forces_of(point, each, airs[:, 0], 100, effort.seed)[0] for each in both]
        before, true = (of_forces(each, own)["at_2"] for each in pressures)
        stiff = replace(own, modulus=stiffness.stiffness * own.modulus)
        at_once = on_solids(forces, replace(stiff, beside_water=stiffness), *changes)["at_2"]
        by_coordinates, on_polysilicon = (forces.at(each.coordinates).of["at_2"] for each in (stiff, own))
        errors.append(
            [each - (true - before) for each in (at_once - on_polysilicon, by_coordinates - on_polysilicon, 0)]
        )
    of_learnt, of_coordinates, of_nothing = np.sqrt(np.mean(np.square(errors), axis=0))
    assert of_learnt < of_coordinates, "the first control"
    assert of_learnt < of_nothing, "the second control"


def test_bridges_of_stiffer_solids_are_thinner_so_that_their_coordinates_stay():
    sizes = np.array([[2e-6, 1.5e-6, 50e6], [3e-6, 1e-6, 20e6]])
    for (thickness, gap, stress), size in zip(ratios.as_stiff(sizes, 5.0), sizes.tolist(), strict=True):
        own = MiddleState(HEIGHTS, WATER, size[0], size[1], 30e-6, size[2], 164e9, 164e9)
        stiff = replace(own, thickness=thickness, gap=gap, stress=stress, modulus=5 * 164e9)
        np.testing.assert_allclose(stiff.coordinates, own.coordinates, rtol=1e-12)
        assert stiff.flooded_length == pytest.approx(own.flooded_length)
        assert stiff.stretched.bare(2e-4) == pytest.approx(own.stretched.bare(2e-4))
        assert replace(own, modulus=5 * 164e9).coordinates != pytest.approx(own.coordinates), "the control"


@pytest.mark.parametrize("numbers", [(0.05, 1.0), (1.0, 1.0), (4.0, 1.0), (0.3, 2.0), (1.0, 1.0, 3.0), (0.3, 2.0, 0.4)])
def test_materials_of_ratios_have_them_in_the_estimate(numbers):
    beside = BesideWater(*numbers)
    material = material_of(beside)
    plan = training.with_materials(training.plan_of(POINT, training.base()), material, material)
    water = training.water_of(plan).gaps.hamaker_constant["water"]
    assert water == pytest.approx(beside.through_water * HAMAKER_CONSTANT["water"])
    assert plan.config["materials"]["OfT"]["young_modulus_GPa"] == pytest.approx(164 * beside.stiffness)
    found_ratios = SolidPair.of(material, material).beside_water(0.144)
    assert found_ratios.logarithms == pytest.approx(beside.logarithms, abs=1e-9)


def test_solids_of_points_are_within_their_ranges_and_each_its_own():
    seen = [points.drawn(point, 21) for point in points.SETS["decide_any"].all]
    sides = [side for _, both in seen for side in both]
    for key, name in (("young_modulus_GPa", "modulus"), ("contact_angle_deg", "angle")):
        low, high = points.RANGES[name]
        numbers = [side[key] for side in sides]
        assert low <= min(numbers) < max(numbers) <= high
        assert len(set(numbers)) > 0.9 * len(numbers)
    assert all(points.TEMPERATURES[0] <= kelvin <= points.TEMPERATURES[1] for kelvin, _ in seen)
    # polysilicon and silica, by the combining relation of A. J. N. Israelachvili
    for water, dry in ((4.6, 65), (250, 479)):
        assert (water**0.5 + 37**0.5) ** 2 == pytest.approx(dry, rel=0.05)
    constants = [side["hamaker_constant_zJ"] for side in sides]
    assert all(one["dry"] == pytest.approx((one["water"] ** 0.5 + 37**0.5) ** 2, rel=1e-2) for one in constants)


def test_seeds_of_tested_points_are_in_no_other_set():
    others = {effort.seed for effort in training.SETS.values()}
    assert not others & {effort.seed for effort in points.SETS.values()}
    assert len({effort.seed for effort in points.SETS.values()}) == len(points.SETS)


def test_a_plan_has_the_solids_and_the_stiffness_of_its_point():
    valid, (temperature, materials) = training.base(), points.drawn(POINT, 21)
    plan = points.with_solids(
        training.plan_of(training.of_beam(POINT, materials[0], valid), valid), temperature, materials
    )
    device = plan.config["devices"][training.DEVICE]
    modulus = 1e9 * materials[0]["young_modulus_GPa"]
    assert modulus * (1e-6 * device["thickness_um"]) ** 3 / (1e-6 * device["gap_um"]) ** 2 == pytest.approx(
        POINT.stiffness, rel=1e-3
    )
    water = training.water_of(plan)
    assert water.temperature == temperature
    assert water.contact_angles == pytest.approx([math.radians(side["contact_angle_deg"]) for side in materials])
    humidity = points.humidity_of(temperature, materials, 3e-9)
    assert water.film(humidity)[0] == pytest.approx(3e-9, rel=2e-3)


def saved(folder, exponents):
    """Files of one point at all ratios, of numbers that grow by powers of these. Returns its airs."""
    airs, (point,), seed = np.array([[2e-9, 1.0], [5e-9, 1.0]]), *first_point()
    slopes = 0.05 * np.exp(0.1 * np.random.default_rng(1).normal(size=(2, 3, 400)))
    forces = 1e6 * np.exp(0.1 * np.random.default_rng(2).normal(size=(2, 400)))
    held = 2e-4 * np.exp(0.1 * np.random.default_rng(3).normal(size=(2, 400)))
    own = {"airs": airs, "sides": np.array([2.0, 3.0]), "sizes": np.array([[2e-6, 2e-6, 0.0], [3e-6, 1e-6, 0.0]])}
    for ratio in (None, *ALL):
        changed = ratio.beside_water(point, seed) if ratio else OF_POLYSILICON
        factor = math.exp(np.dot(exponents, changed.logarithms))
        lost = np.where(np.arange(400) < 300, np.inf, held[1]) if ratio else held[1]
        numbers = own | dict(zip(ratios.KEYS, vars(changed).values(), strict=True))
        numbers |= {"slopes": factor * slopes, "forces": factor * forces, "lengths": np.array([factor * held[0], lost])}
        for part in ("", patches.FOLDER, bridges.FOLDER):
            place = Path(ratio.folder, part) if ratio else Path(part or training.FOLDER)
            save(folder / place / "learn_any", 0, numbers)
    return airs


def first_point():
    """First point from which is learnt, and its seed."""
    return training.SETS["learn_any"].all[:1], training.SETS["learn_any"].seed


@pytest.mark.parametrize(
    ("ratio", "by_one"), list(zip(ALL, (0.8, 0.3, -0.5), strict=True)), ids=lambda each: getattr(each, "name", "")
)
def test_rows_of_a_ratio_have_the_change_of_their_own_contacts(tmp_path, ratio, by_one):
    """The slope by the logarithm of the ratio alone: numbers grow by another power of the other ones."""
    airs, ((point,), seed) = saved(tmp_path, (0.8, 0.3, -0.5)), first_point()
    of_all = [of(tmp_path, 164e9, ratio) for of in (rows.rows_of_tips, rows.rows_of_patches, rows.rows_of_bridges)]
    tips, of_patches, of_bridges = (each.rows for each in of_all)
    counts = tuple(len(each.surface) for each in (tips, of_patches, of_bridges))
    assert counts == (6, 2, 1), "free bridges are unknown"
    np.testing.assert_allclose(of_bridges.values["at_2"], by_one, rtol=1e-5)
    for values in (*tips.values.values(), *of_patches.values.values()):
        np.testing.assert_allclose(values, -by_one, rtol=1e-5)
    logarithms = ratio.beside_water(point, seed).logarithms
    differ = [number for number, logarithm in enumerate(logarithms) if logarithm]
    for each, names in zip(of_all, (COORDINATES, OF_PATCHES, OF_BRIDGES), strict=True):
        np.testing.assert_allclose(each.rows.coordinates[0, len(names) :], logarithms)
        assert [column - len(names) for column in each.columns if column >= len(names)] == differ
        assert each.columns[-1] == len(names) + list(vars(OF_POLYSILICON)).index(ratio.name)
    expected = states_of(point, airs, 164e9)[1][2].coordinates
    np.testing.assert_allclose(tips.coordinates[-1, : len(expected)], expected)


def test_a_tested_length_on_other_solids_is_that_of_its_changed_tips(tmp_path):
    name, point = "decide_any", points.SETS["decide_any"].all[0]
    folder = tmp_path / points.FOLDER / name
    temperature, materials = points.drawn(point, points.SETS[name].seed)
    humidity = points.humidity_of(temperature, materials, 3e-9)
    slopes = 0.05 * np.exp(0.1 * np.random.default_rng(1).normal(size=2000))
    save(folder, 0, {"humidity": np.array(humidity), "changed": slopes})
    processes = falling(1.0), None, process_of(at_0=-0.1, at_1=-0.1, at_2=-0.1)
    (one,) = rows.tested(tmp_path, name, -1.0, processes, as_polysilicon=False)
    assert one.true == pytest.approx(1.5 / np.quantile(slopes, 0.8413), rel=0.02)
    pair, kelvin = rows.solids_of(point, name)
    water = film(humidity, kelvin, pair.wetting)
    expected = 1.5 / (13.5 * water.energy / point.stiffness) ** 0.25 * math.exp(0.9)
    assert one.estimate == pytest.approx(expected * pair.beside_water(water.energy).through_water ** -0.1)
    (control,) = rows.tested(tmp_path, name, -1.0, processes, as_polysilicon=True)
    assert control.true == one.true
    assert control.estimate != pytest.approx(one.estimate, rel=1e-3)
    numbers = {"humidity": np.array(humidity), "sides": np.array([2.0, 3.0]), "ratio": 0.8, "power": 1.0}
    numbers |= {"forces": 1e6 * np.exp(0.1 * np.random.default_rng(1).normal(size=(1, 2000)))}
    save(tmp_path / points.FOLDER / patches.FOLDER / name, 0, numbers)
    of_forces = falling(1.0), process_of(ratio=0.0, power=1.0), processes[2]
    (force,) = rows.tested_forces(tmp_path, name, -1.0, of_forces, as_polysilicon=False)
    assert 1 / force.true == pytest.approx(6e-12 * 0.8 * np.quantile(numbers["forces"], 0.8413), rel=0.02)


def test_intervals_of_other_solids_are_wider_but_not_in_dry_air():
    def widths(sections, **keys):
        """Ratios of the ends of all intervals."""
        row = found(LEVER, sections, **keys).chosen
        return [high / low for low, high in row.intervals.values()]

    part = content()
    for section in (part, part["stoppers"], part["bridges"]):
        for name, margin in section["margins"].items():
            assert section[OF_OTHER_SOLIDS][name] >= margin
    almost = {"solid": {"young_modulus_GPa": 164.0001}}
    for wide, own, name in zip(widths(almost), widths({}), CONFIDENCES, strict=True):
        of_others, of_own = (sum(part[key][side] for side in MARGINS[name]) for key in (OF_OTHER_SOLIDS, "margins"))
        assert math.log(wide) / math.log(own) == pytest.approx(of_others / of_own, rel=1e-3)
    dry_almost, dry_own = (widths(sections, humidities=["dry"]) for sections in (almost, {}))
    assert dry_almost == pytest.approx(dry_own, rel=1e-4)


def test_margins_of_other_solids_are_conformal_and_no_less_than_those_of_polysilicon(monkeypatch):
    rng, part = np.random.default_rng(1), content()
    errors = {0.02: rng.normal(size=40) * 0.02, 1.0: rng.normal(size=40)}

    def tested(scale):
        """Errors of surfaces of a scale, half in each set."""
        surfaces = [of_estimates.Tested(k, 0.1, math.exp(error), 1.0) for k, error in enumerate(errors[scale])]
        return lambda _folder, name, *_, **__: surfaces[1::2] if "any" in name else surfaces[::2]

    monkeypatch.setattr(make.of_solids, "tested", tested(0.02))
    monkeypatch.setattr(make.of_solids, "tested_forces", tested(1.0))
    found_margins = make.margins_of_other_solids(None, part)
    assert found_margins[""] == part["margins"], "small errors widen nothing"
    stoppers = part["stoppers"]
    expected = of_estimates.margins_of(errors[1.0] / math.hypot(0.1, stoppers["rest"]))
    assert found_margins["stoppers"] == pytest.approx(expected, abs=1e-3)
    growth = found_margins["stoppers"]["90"] / stoppers["margins"]["90"]
    assert found_margins["bridges"]["90"] == pytest.approx(growth * part["bridges"]["margins"]["90"], rel=1e-3)

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.constants import HAMAKER_CONSTANT, HARDNESS
from stiction.contact.asperity import HertzAsperity, MaugisTable, reduced_modulus
from stiction.contact.environment import Gaps
from stiction.contact.gaps import FlatAttraction
from stiction.contact.materials import Solid
from stiction.contact.solids import (
    asperity_between,
    attraction_between,
    composite_modulus,
    hamaker_constant,
    interfaces,
    softer_hardness,
)
from stiction.contact.vanderwaals import DugdaleAttraction

POLYSILICON = Solid()
GOLD = Solid(79e9, 0.42, 1e9, {"water": 25e-20}, np.radians(70))
moduli = st.floats(1e9, 1e12)
ratios = st.floats(0, 0.5)


@given(moduli, ratios)
def test_equal_bodies_have_the_reduced_modulus_of_the_paper_byte_for_byte(modulus, ratio):
    solid = Solid(modulus, ratio)
    assert composite_modulus(solid, solid) == reduced_modulus(modulus, ratio)


@given(moduli, moduli, ratios, ratios)
def test_compliances_of_two_bodies_add_up(first, second, one, other):
    bodies = Solid(first, one), Solid(second, other)
    compliance = (1 - one**2) / first + (1 - other**2) / second
    np.testing.assert_allclose(1 / composite_modulus(*bodies), compliance, rtol=1e-14)
    np.testing.assert_allclose(composite_modulus(*bodies), composite_modulus(*bodies[::-1]), rtol=1e-14)


def test_on_a_rigid_body_the_other_deforms_twice_as_much():
    rigid = Solid(1e30)
    np.testing.assert_allclose(composite_modulus(POLYSILICON, rigid), 2 * reduced_modulus(164e9, 0.23), rtol=1e-12)


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_polysilicon_on_polysilicon_has_the_constants_of_the_paper(medium):
    assert hamaker_constant(POLYSILICON, POLYSILICON, medium) == HAMAKER_CONSTANT[medium]
    assert softer_hardness(POLYSILICON, POLYSILICON) == HARDNESS


@given(st.floats(4e-20, 5e-19), st.floats(4e-20, 5e-19))
def test_mixing_through_a_medium_is_that_of_the_constants_in_vacuum(first, second):
    # Equal bodies have A₁₃₁ = (√A₁₁ - √A₃₃)², two different ones A₁₃₂ = (√A₁₁ - √A₃₃) (√A₂₂ - √A₃₃).
    for medium in (3.7e-20, 0.0):
        roots = [np.sqrt(vacuum) - np.sqrt(medium) for vacuum in (first, second)]
        bodies = [replace(POLYSILICON, hamaker_constant={"water": root**2}) for root in roots]
        np.testing.assert_allclose(hamaker_constant(*bodies, "water"), np.prod(roots), rtol=1e-12)


def test_the_mixture_is_between_its_parts_and_the_softer_body_yields():
    mixed = hamaker_constant(POLYSILICON, GOLD, "water")
    assert HAMAKER_CONSTANT["water"] < mixed < 25e-20
    assert softer_hardness(POLYSILICON, GOLD) == softer_hardness(GOLD, POLYSILICON) == 1e9


def test_an_asperity_has_the_modulus_and_the_attraction_of_both_bodies():
    modulus = composite_modulus(POLYSILICON, GOLD)
    both = DugdaleAttraction(hamaker_constant(POLYSILICON, GOLD, "water"))
    assert asperity_between(POLYSILICON, GOLD, "water") == MaugisTable(modulus, both)
    assert asperity_between(POLYSILICON, GOLD, "none") == HertzAsperity(modulus)


def test_coatings_of_both_bodies_keep_them_apart_and_leave_stiffness_and_hardness():
    thin, thick = (replace(POLYSILICON, coating=thickness) for thickness in (1e-9, 1.5e-9))
    assert attraction_between(thin, thick, "dry") == DugdaleAttraction(HAMAKER_CONSTANT["dry"], 2.5e-9)
    assert attraction_between(thin, POLYSILICON, "water").spacer == 1e-9
    assert attraction_between(thin, thick, "none") is None
    assert composite_modulus(thin, thick) == composite_modulus(POLYSILICON, POLYSILICON)
    assert softer_hardness(thin, thick) == HARDNESS


# Coatings that attract


AIR = HAMAKER_CONSTANT["dry"]


def coated(constant, thickness=1.2e-9):
    """Polysilicon with a coating whose Hamaker constant through air is given [J]."""
    return replace(POLYSILICON, coating=thickness, coating_hamaker_constant={"water": 0.0, "dry": constant})


def layers(bodies, gap):
    """Work of two coated half spaces [J/m²]: that of every slab of one with every slab of the other, without repulsion.

    Each is the r⁻⁶ of its molecules, of the density √A, added up over both slabs.
    """
    from_surface = []  # density from each surface downwards, and its depth
    for body in bodies:
        outer, inner = np.sqrt(body.coating_hamaker_constant["dry"]), np.sqrt(body.hamaker_constant["dry"])
        from_surface.append([(outer, 0.0, body.coating), (inner, body.coating, np.inf)])
    total = 0.0
    for (one, a, b), (other, c, d) in product(*from_surface):
        ends = 1 / np.array([gap + a + c, gap + a + d, gap + b + c, gap + b + d]) ** 2
        total += one * other * (ends[0] - ends[1] - ends[2] + ends[3]) / (12 * np.pi)
    return total


@pytest.mark.parametrize("gap", [0.3e-9, 2e-9, 20e-9])
def test_pairs_of_interfaces_attract_as_the_slabs_between_them_added_up(gap):
    bodies = coated(5e-20), coated(8e-20, 2.5e-9)
    found = sum(each / (12 * np.pi * (gap + apart) ** 2) for each, apart in interfaces(*bodies, "dry"))
    assert found == pytest.approx(layers(bodies, gap), rel=1e-12)
    swapped = coated(5e-20, 2.5e-9), coated(8e-20)
    assert abs(found / layers(swapped, gap) - 1) > 1e-4  # what is where matters
    assert sum(each for each, _ in interfaces(*bodies, "dry")) == pytest.approx(AIR, rel=1e-14)  # from far, the solids


@pytest.mark.parametrize("medium", ["water", "dry"])
def test_a_coating_that_attracts_nothing_is_a_spacer_and_one_like_its_solid_is_not_there(medium):
    """To the last bit."""
    nothing, spacer = coated(0.0), replace(POLYSILICON, coating=1.2e-9)
    solid = replace(spacer, coating_hamaker_constant=HAMAKER_CONSTANT)
    assert attraction_between(nothing, nothing, medium) == attraction_between(spacer, spacer, medium)
    assert attraction_between(solid, solid, medium) == attraction_between(POLYSILICON, POLYSILICON, medium)
    assert attraction_between(nothing, solid, medium) == attraction_between(spacer, POLYSILICON, medium)
    assert attraction_between(nothing, nothing, medium) != attraction_between(solid, solid, medium)


def test_a_coating_that_hardly_attracts_is_nearly_a_spacer():
    hardly, spacer = (attraction_between(*2 * [coated(share * AIR)], "dry") for share in (1e-9, 0.0))
    assert hardly.work_of_adhesion == pytest.approx(spacer.work_of_adhesion, rel=2e-3)
    assert hardly.range == pytest.approx(spacer.range, rel=2e-3)


def test_thick_coatings_that_touch_need_the_work_of_eq_10_with_their_own_constant():
    thick, thin = (attraction_between(*2 * [coated(5e-20, thickness)], "dry") for thickness in (100e-9, 1e-9))
    own = DugdaleAttraction(5e-20)
    assert thick.work_of_adhesion == pytest.approx(own.work_of_adhesion, rel=1e-4)
    assert thick.stress == pytest.approx(own.stress, rel=1e-4)
    assert thin.work_of_adhesion > 1.03 * own.work_of_adhesion  # the solid below attracts through a thin one


@given(st.floats(0.01, 0.99), st.floats(0.2, 20))
def test_summits_have_the_tangent_of_the_work_of_coated_flats_so_that_nothing_counts_twice(share, thickness):
    """Gaps are left with nothing where coatings touch, and nowhere with less than bare solids leave them."""
    body, gaps = coated(share * AIR, thickness * 1e-9), np.linspace(0, 4 * thickness, 300) * 1e-9

    def left(*bodies):
        both = dict(zip(("beam", "substrate"), bodies, strict=True))
        counted = attraction_between(*bodies, "dry")
        assert counted.stress * counted.range == pytest.approx(counted.work_of_adhesion)
        return Gaps(HAMAKER_CONSTANT, "dry", bodies=both).work(gaps, 0.0) / counted.work_of_adhesion

    assert left(body, body)[0] == pytest.approx(0, abs=1e-14)
    assert np.all(left(body, body) > min(left(POLYSILICON, POLYSILICON)) - 2e-3)


@given(st.floats(0.01, 0.99), st.floats(0.2, 20), st.floats(0, 50))
def test_the_attraction_of_coated_solids_is_between_that_across_a_spacer_and_that_of_bare_solids(share, thickness, gap):
    body = coated(share * AIR, thickness * 1e-9)
    between = Gaps(HAMAKER_CONSTANT, "dry", bodies={"beam": body, "substrate": body}).through("dry").work(gap * 1e-9)
    bare, spacer = (FlatAttraction(AIR, spacer=apart).work(gap * 1e-9) for apart in (0.0, 2 * body.coating))
    assert spacer < between < bare


def test_coatings_attract_more_the_larger_their_constant_and_the_thinner_they_are():
    constants = [attraction_between(*2 * [coated(each)], "dry").work_of_adhesion for each in np.linspace(0, AIR, 9)]
    assert np.all(np.diff(constants) > 0)
    thicknesses = [attraction_between(*2 * [coated(5e-20, each)], "dry").stress for each in (0.5e-9, 1e-9, 2e-9, 5e-9)]
    assert np.all(np.diff(thicknesses) < 0)


def test_a_constant_that_is_not_stated_is_reported():
    with pytest.raises(ValueError, match="through dry is not stated, only through water"):
        hamaker_constant(POLYSILICON, GOLD, "dry")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"young_modulus": 0}, "Young's modulus.*0"),
        ({"hardness": np.inf}, "hardness.*inf"),
        ({"poisson_ratio": 0.51}, "Poisson's ratio.*0.51"),
        ({"poisson_ratio": -1.0}, "Poisson's ratio.*-1.0"),
        ({"hamaker_constant": {"water": -1.0}}, "Hamaker constant .water.*-1.0"),
        ({"contact_angle": -0.1}, "contact angle.*-0.1"),
        ({"contact_angle": 3.2}, "contact angle.*3.2"),
        ({"coating": -1e-9}, "coating.*-1e-09"),
        ({"coating": np.inf}, "coating.*inf"),
        (
            {"coating_hamaker_constant": {"dry": -1e-21}},
            "coating .dry. must be from 0 to that of its solid, got -1e-21",
        ),
        ({"coating_hamaker_constant": {"dry": 2e-19}}, "coating .dry. must be from 0 to that of its solid, got 2e-19"),
    ],
)
def test_a_solid_is_checked_at_once(change, message):
    with pytest.raises(ValueError, match=message):
        replace(POLYSILICON, **change)

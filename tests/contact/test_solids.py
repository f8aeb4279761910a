from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.constants import HAMAKER_CONSTANT, HARDNESS
from stiction.contact.asperity import HertzAsperity, MaugisTable, reduced_modulus
from stiction.contact.solids import (
    Solid,
    asperity_between,
    attraction_between,
    composite_modulus,
    hamaker_constant,
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
    ],
)
def test_a_solid_is_checked_at_once(change, message):
    with pytest.raises(ValueError, match=message):
        replace(POLYSILICON, **change)

"""Whole typical surfaces in place of one that is partly assumed."""

import numpy as np
import pytest
from configurations import PAPER
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from stiction.config.surfaces import described
from stiction.config.surfaces.knowledge import slope
from stiction.config.surfaces.members import is_itself, limits, members, quantities
from stiction.report.limits.words import texts
from stiction.surface import self_affine
from stiction.surface.feasible import is_feasible

LIBRARY = PAPER["surfaces"]
LIKE = {"rms_nm": 3.0, "like": "B2"}
FORM = ("skewness", "kurtosis")


def normal(entry):
    """Normal form of a surface."""
    return described.complete(entry, LIBRARY)


def of(entry, **more):
    """Members of a surface as users state it."""
    return members(normal(entry), LIBRARY, **more)


@pytest.mark.parametrize("like", LIBRARY)
def test_members_of_a_surface_like_another_are_that_rms_like_each_of_the_library(like):
    found = of(LIKE | {"like": like})
    assert list(found) == list(LIBRARY)
    for name, member in found.items():
        other = quantities(normal(LIKE | {"like": name}))
        assert member == pytest.approx({word: other[word] for word in member}, rel=1e-8)
        assert set(other) - set(member) == {"rms"}
        assert is_itself(normal(LIKE | {"like": like}), member) == (name == like)


def test_a_surface_that_is_like_none_of_the_library_is_none_of_its_members():
    entry = {"rms_nm": 5.0, "hurst": 0.8, "correlation_length_nm": 60, "cutoff_rad_per_um": 125}
    found = of(entry)
    assert [set(member) for member in found.values()] == [set(FORM)] * 4
    assert not any(is_itself(normal(entry), member) for member in found.values())


#: Keys that users may state beside ``like``, with the words of what they fix.
STATED = {
    "skewness": ({"skewness": -0.2, "kurtosis": 3.05}, set(FORM)),
    "hurst": ({"hurst": 0.8}, {"hurst"}),
    "corner": ({"corner_rad_per_um": 20}, {"corner"}),
    "length": ({"correlation_length_nm": 60}, {"corner"}),
    "cutoff": ({"cutoff_rad_per_um": 120}, {"cutoff"}),
    "errors": ({"uncertainty": {"kurtosis": 0.3, "hurst": 0.1}}, {"kurtosis", "hurst"}),
}


@settings(max_examples=25, deadline=None)
@given(st.sets(st.sampled_from(list(STATED))))
def test_what_is_stated_stays_and_all_else_is_of_one_surface_that_exists(keys):
    assume(not {"corner", "length"} <= keys)
    entry, fixed = dict(LIKE), {"rms"}
    for key in keys:
        entry |= STATED[key][0]
        fixed |= STATED[key][1]
    own, found = quantities(normal(entry)), of(entry, end=200.0)
    for name, member in found.items():
        assert not fixed & set(member)
        whole, typical = own | member, quantities(LIBRARY[name])
        assert set(own) == set(member) | fixed
        assert is_feasible(whole["skewness"], whole["kurtosis"])
        self_affine.spectrum(3e-9, whole["hurst"], *(1e6 * whole[key] for key in ("corner", "cutoff")))  # exists
        assert whole["cutoff"] <= 200
        assert all(value == pytest.approx(typical[word]) for word, value in member.items() if word == "hurst")


@pytest.mark.parametrize("skewness", [0.0, -0.2, -0.5])
@pytest.mark.parametrize("unknown", FORM)
def test_a_form_that_no_heights_have_is_the_nearest_one_that_they_have(unknown, skewness):
    kurtosis = 3.0 + 0.4 * skewness**2
    entry = {"rms_nm": 3.0, "skewness": skewness, "kurtosis": kurtosis, "psd": "published", "unknown": [unknown]}
    entry |= {"published_psd": LIBRARY["B2"]["published_psd"]}
    for name, member in members(entry, LIBRARY).items():
        (value,), typical = member.values(), LIBRARY[name][unknown]
        assert is_feasible(*((entry | member)[key] for key in FORM))
        if value != typical:
            toward = value + 0.01 * (typical - entry[unknown])
            assert not is_feasible(*((entry | {unknown: toward})[key] for key in FORM))  # no nearer one
    said = texts(limits("Mine", entry, LIBRARY))
    changed = [name for name, member in members(entry, LIBRARY).items() if member[unknown] != LIBRARY[name][unknown]]
    assert len(said) == 1 + bool(changed)
    assert all(f" of {name}" in said[-1] for name in changed)


def test_a_cutoff_ends_with_the_grid_and_a_corner_below_a_stated_cutoff():
    assert of(LIKE, end=200.0)["Sub1"]["cutoff"] == 200
    assert of(LIKE)["Sub1"]["cutoff"] == 264
    low = of(LIKE | {"cutoff_rad_per_um": 40.0})
    assert low["Sub2"]["corner"] == pytest.approx(40 * np.exp(-0.05))
    assert low["B1"]["corner"] == 32
    assert slope(LIBRARY["Sub2"]["published_psd"]) == low["Sub2"]["hurst"]


def test_one_typical_surface_says_nothing_about_its_kind_and_readers_are_told():
    few, entry = {"B2": LIBRARY["B2"]}, normal(LIKE)
    assert members(entry, few) == {}
    (said,) = texts(limits("Mine", entry, few))
    assert "without an uncertainty, for want of typical surfaces: skewness -0.76; " in said
    assert members(LIBRARY["B2"], LIBRARY) == {}
    assert limits("B2", LIBRARY["B2"], LIBRARY) == []

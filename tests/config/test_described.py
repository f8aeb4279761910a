"""Surfaces without scans: as papers state them, or their rms and a typical surface; and what is not known of them."""

import numpy as np
import pytest
from configurations import PAPER, problems
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.surfaces import described, knowledge, members
from stiction.config.units import in_si
from stiction.plan.devices import DevicePlan
from stiction.report.limits.words import texts
from stiction.surface import self_affine
from stiction.surface.spectrum import CutoffSelfAffine

LIBRARY = PAPER["surfaces"]
STATED = {"rms_nm": 5, "hurst": 0.8, "correlation_length_nm": 60, "cutoff_rad_per_um": 125}
LIKE = {"rms_nm": 5, "like": "B2"}
C1 = {"kind": "cantilever", "pair": "m", "thickness_um": 2.6, "gap_um": 10, "width_um": 20, "humidities": [0.88]}
DEVICE = {
    "devices": {"C1": C1},
    "pairs": {"m": {"beam": "Mine", "substrate": "Sub1", "gap_um": 10, "humidities": [0.88]}},
}


def of(entry):
    """Overlay with a surface of a device."""
    return {"surfaces": {"Mine": entry}} | DEVICE


def normal(entry):
    """Normal form of a surface."""
    return load(of(entry))["surfaces"]["Mine"]


def spectrum(entry):
    """Eq. (7) of the normal form of a surface."""
    return in_si(CutoffSelfAffine, normal(entry)["published_psd"])


def test_a_surface_as_papers_state_it_has_its_rms_hurst_exponent_correlation_length_and_cutoff():
    found = spectrum(STATED)
    assert_allclose(np.sqrt(found.variance), 5e-9, rtol=1e-6)
    assert_allclose(self_affine.hurst_of(found.slope), 0.8, rtol=1e-6)
    shape = found.slope, found.corner, found.cutoff
    assert_allclose(self_affine.correlation_at(60e-9, *shape), np.exp(-1), rtol=1e-5)
    assert found.cutoff == 125e6


def test_a_corner_takes_the_place_of_the_correlation_length():
    entry = {key: value for key, value in STATED.items() if key != "correlation_length_nm"} | {"corner_rad_per_um": 20}
    assert spectrum(entry).corner == 20e6


def test_a_surface_like_another_one_is_that_surface_with_another_rms():
    found, typical = normal(LIKE), LIBRARY["B2"]
    assert found["rms_nm"] == 5
    assert [found[key] for key in ("skewness", "kurtosis")] == [typical["skewness"], typical["kurtosis"]]
    of_library = in_si(CutoffSelfAffine, typical["published_psd"])
    zeta = np.geomspace(1e6, 124e6, 30)
    assert_allclose(spectrum(LIKE)(zeta) / 25e-18, of_library(zeta) / of_library.variance, rtol=1e-6)


def test_what_a_surface_states_beside_the_typical_one_is_its_own():
    found = normal(LIKE | {"hurst": 0.8, "skewness": -0.2, "kurtosis": 3.05})
    assert (found["skewness"], found["kurtosis"], found["unknown"]) == (-0.2, 3.05, ["corner", "cutoff"])
    assert_allclose(self_affine.hurst_of(in_si(CutoffSelfAffine, found["published_psd"]).slope), 0.8, rtol=1e-6)


def test_the_normal_form_is_valid_and_its_own_normal_form():
    for entry in (STATED, LIKE, STATED | {"uncertainty": {"correlation_length_nm": 6}}):
        config = load(of(entry))
        assert load(config) == config
        assert not set(described.KEYS) & set(config["surfaces"]["Mine"])


@pytest.mark.parametrize(
    ("entry", "unknown"),
    [
        (LIKE, ["skewness", "kurtosis", "corner", "hurst", "cutoff"]),
        (STATED, ["skewness", "kurtosis"]),
        (STATED | {"skewness": 0, "kurtosis": 3}, None),
        (STATED | {"skewness": 0, "kurtosis": 3, "unknown": ["rms"]}, ["rms"]),
    ],
)
def test_what_a_surface_leaves_open_is_unknown(entry, unknown):
    assert normal(entry).get("unknown") == unknown


def known(entry):
    """What is known of the surface of a device with test beams, and its uncertain quantities."""
    plan = DevicePlan(merged(load(of(entry)), {"devices": {"C1": {"test_beams": ["T"]}}}))
    return plan.surface_errors("C1")["Mine"], [quantity for _, quantity in plan.quantities("C1")]


def test_the_scatter_over_the_library_is_the_uncertainty_of_what_is_unknown():
    found, uncertain = known(LIKE)
    rows = np.array([[entry[key] for key in ("skewness", "kurtosis")] for entry in LIBRARY.values()])
    assert found.quantities == tuple(uncertain) == ("skewness", "kurtosis", "corner", "slope")
    assert_allclose(found.covariance[:2, :2], np.cov(rows.T))
    assert_allclose(found.covariance[:2, 2:], 0)
    corners = [np.log(entry["published_psd"]["corner_rad_per_um"]) for entry in LIBRARY.values()]
    assert_allclose(found.covariance[2, 2], np.var(corners, ddof=1))


def test_a_stated_uncertainty_takes_the_place_of_the_scatter_and_is_in_the_units_of_the_slopes():
    stated = {"rms_nm": 0.5, "kurtosis": 0.2, "correlation_length_nm": 6, "hurst": 0.1}
    found, uncertain = known(STATED | {"uncertainty": stated})
    assert found.quantities == tuple(uncertain) == ("rms", "skewness", "kurtosis", "corner", "slope")
    expected = [0.1, np.sqrt(knowledge.scatter(LIBRARY)[1, 1]), 0.2, 0.1, 0.2]
    assert_allclose(np.sqrt(np.diag(found.covariance)), expected, rtol=1e-6)
    assert_allclose(found.covariance - np.diag(np.diag(found.covariance)), 0)


def test_a_device_on_such_a_surface_has_a_budget_and_one_on_surfaces_of_the_paper_has_none():
    assert DevicePlan(load(of(LIKE))).with_budget == ["C1"]
    assert DevicePlan(load(of(STATED | {"skewness": 0, "kurtosis": 3}))).with_budget == []


def test_readers_are_told_what_is_assumed_and_how_uncertain_it_is():
    (said,) = texts(members.limits("Mine", normal(STATED), LIBRARY))
    assert said.startswith("surface Mine: not measured but assumed, any of 4 typical surfaces (B1, B2")
    assert said.endswith("skewness -0.738 ± 0.32; kurtosis 4.17 ± 0.87")
    assert members.limits("B2", LIBRARY["B2"], LIBRARY) == []
    both = {"skewness": 0.1, "kurtosis": 0.2}
    assert members.limits("Mine", normal(STATED | {"uncertainty": both}), LIBRARY) == []


@pytest.mark.parametrize(
    ("entry", "line"),
    [
        (
            {"rms_nm": 5},
            "surfaces.Mine is without skewness, kurtosis, psd, must state rms_nm, skewness, kurtosis and psd; or",
        ),
        ({"like": "B2"}, "surfaces.Mine.rms_nm is missing, must be a number"),
        (
            LIKE | {"like": "B3"},
            "surfaces.Mine.like is 'B3', must be one of B1, B2, Sub1, Sub2, the library of typical",
        ),
        (
            LIKE | {"mean_summit_radius_um": 1},
            "surfaces.Mine.like is 'B2', must not be given beside mean_summit_radius_um",
        ),
        (LIKE | {"skewness": 0}, "surfaces.Mine.skewness is 0, must come with kurtosis: both are stated or neither"),
        (
            {"rms_nm": 5, "hurst": 0.8},
            "surfaces.Mine.hurst is 0.8, must come with cutoff_rad_per_um, correlation_length_nm",
        ),
        (STATED | {"hurst": 1.2}, "surfaces.Mine.hurst is 1.2, must be a number at least 0 and at most 1"),
        (STATED | {"corner_rad_per_um": 20}, "surfaces.Mine.correlation_length_nm is 60, must come without corner"),
        (
            STATED | {"correlation_length_nm": 10},
            "surfaces.Mine.correlation_length_nm is 10, no spectrum has it: need a",
        ),
        (STATED | {"cutoff_rad_per_um": 400}, "surfaces.Mine.cutoff_rad_per_um is 400, must be at most the Nyquist"),
        (STATED | {"uncertainty": {"corner_nm": 1}}, "surfaces.Mine.uncertainty.corner_nm is unknown"),
        (STATED | {"unknown": ["slope"]}, "surfaces.Mine.unknown[0] is 'slope', must be one of rms, skewness"),
        (
            LIKE | {"uncertainty": {"correlation_length_nm": 1}},
            "surfaces.Mine.uncertainty.correlation_length_nm is 1, must",
        ),
        (
            {"scans": {"files": ["a.gwy"]}, "unknown": ["rms"]},
            "surfaces.Mine.unknown is ['rms'], must not be given beside scans",
        ),
    ],
)
def test_what_cannot_be_completed_is_refused_once_with_the_key_that_users_stated(entry, line):
    found = [problem for problem in problems(merged(PAPER, of(entry))) if "a.gwy" not in problem]
    assert len(found) == 1
    assert found[0].startswith(line)


def test_a_relation_between_computed_numbers_is_about_the_key_that_they_follow_from():
    found = problems(merged(PAPER, of(STATED | {"correlation_length_nm": 600})))
    assert found
    assert all(line.startswith("sampling.") and "surfaces.Mine.correlation_length_nm = 600" in line for line in found)


def test_keys_of_such_a_surface_can_be_compared():
    config = load(of(LIKE), {"compare": {"surfaces.Mine.rms_nm": [2, 4]}})
    assert [config["surfaces"][f"MineRms{rms}"]["rms_nm"] for rms in (2, 4)] == [2, 4]
    assert list(config["devices"]) == ["C1Rms2", "C1Rms4"]


#: Keys of a surface with values of which some are allowed and some are not.
VALUES = {
    "rms_nm": [5, -1, "5"],
    "like": ["B2", "B9", 5, None],
    "hurst": [0, 0.8, 1, 1.2, True],
    "correlation_length_nm": [60, 1e-3, 10, 1e5, "60"],
    "corner_rad_per_um": [20, 124.9, 200, 0],
    "cutoff_rad_per_um": [125, 1e5, None],
    "skewness": [-0.5, 12],
    "kurtosis": [3.5, 1, 90],
    "unknown": [["rms"], [], "rms", ["slope"]],
    "uncertainty": [{"rms_nm": 1}, {"correlation_length_nm": 5}, {"hurst": 0.1, "kurtosis": 1}, 5, {}],
    "psd": ["published", "identified", "fitted"],
    "material": ["Oxide", 3],
}
entries = st.lists(st.sampled_from(list(VALUES)), unique=True, max_size=8).flatmap(
    lambda keys: st.fixed_dictionaries({key: st.sampled_from(VALUES[key]) for key in keys})
)


@settings(max_examples=60, deadline=None)
@given(entries)
def test_every_section_of_a_surface_is_completed_or_refused_in_sentences_about_it(entry):
    lines = problems(merged(PAPER, of(entry)))
    assert all(
        line.split()[0].split("[")[0].split(".")[0] in ("surfaces", "sampling", "studies", "pairs", "devices")
        for line in lines
    )
    if not lines:
        assert normal(entry)["psd"] in ("published", "identified")

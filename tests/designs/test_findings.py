from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from beams import PAPER
from ground import C1, R1, UM, safe_with_tips, safe_without_tips

from stiction.config import jobs
from stiction.config.files import load
from stiction.config.plan import Plan
from stiction.designs import findings
from stiction.devices.limits import NOT_MODELLED

PLAN = Plan(load())


def beams(s_shaped, arc, crack=700 * UM):
    """Dataset of stage beams with numbers of S-shaped beams and of arcs."""
    state = np.repeat([0, 1], [s_shaped, arc])
    return xr.Dataset({"state": ("sample", state), "crack_length": ("sample", np.where(state, 1500 * UM, crack))})


def device(energy=2e-3, of=C1):
    tips = energy * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    return safe_with_tips(tips), findings.OfDevice(of, 0.15 * UM)


# Main line


def test_s_shaped_beams_of_the_paper_have_no_warning():
    assert findings.of_beams(beams(50, 0), PAPER, 1.5 * UM) == []


def test_arcs_and_what_their_mean_lacks_are_each_said_once():
    arcs, mean = findings.of_beams(beams(58, 42, 1400 * UM), PAPER, 1.5 * UM)
    assert "42.0% of the beams end as arcs" in arcs
    assert "1.5 µm" in arcs
    assert "1400 µm" in mean
    assert "1500 µm" in mean


def test_beams_that_all_end_as_arcs_have_no_mean_to_warn_about():
    (sentence,) = findings.of_beams(beams(0, 10), PAPER, 1.5 * UM)
    assert "100.0%" in sentence


@pytest.mark.parametrize(
    ("beam", "words"),
    [
        (replace(PAPER, gap=60 * UM), "slope of 0.13"),
        (replace(PAPER, thickness=50 * UM), "14 times as long"),
        (replace(PAPER, width=700 * UM), "bends as a plate"),
    ],
)
def test_each_dimension_beyond_the_model_is_said_once(beam, words):
    (sentence,) = findings.of_beams(beams(9, 0), beam, 1.5 * UM)
    assert words in sentence


def test_only_pairs_with_plastic_contact_are_said_to_be_plastic():
    plasticity = {
        pair: xr.Dataset({"plastic_share": share}) for pair, share in {"a": 0.0, "b": 0.02, "c": 0.58}.items()
    }
    cases = {("b", 0.67, "NG"): beams(20, 0), ("b", 0.67, "G"): beams(10, 10)}
    found = findings.of_pairs(cases, plasticity, jobs.model_limits(PLAN)["pairs"])
    assert {subject for subject, sentences in found.items() if sentences} == {"pair c", "pair b, RH 0.67, G"}
    assert found["pair c"][0].startswith("58% of the contact area is plastic")


def test_pairs_whose_plasticity_was_not_studied_have_no_sentence_about_it():
    found = findings.of_pairs({}, {}, jobs.model_limits(PLAN)["pairs"])
    assert not any(found.values())


# Devices


def test_a_device_within_the_limits_has_no_warning():
    found, of = device()
    assert findings.of_device(found, of) == []
    assert findings.of_device(found, of, plastic=0.02) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"device": replace(C1, gap=100 * UM)}, "reaches a slope of"),
        ({"device": replace(C1, thickness=50 * UM)}, "times as long as the beam is thick"),
        ({"device": replace(C1, width=700 * UM)}, "bends as a plate"),
        ({"tip": 1.5 * UM}, "strips of 1.5 µm, more than twice"),
        ({"materials": (("Gold", ("hardness",)),)}, "4 properties of Gold are not stated"),
    ],
)
def test_each_limit_of_a_device_is_said_once(changes, words):
    found, of = device()
    (sentence,) = findings.of_device(found, replace(of, **changes))
    assert words in sentence


def test_plastic_contact_of_a_device_is_said():
    found, of = device()
    (sentence,) = findings.of_device(found, of, plastic=0.58)
    assert "58%" in sentence


def test_a_gap_that_the_film_fills_is_said():
    found, of = device()
    (sentence,) = findings.of_device(found.assign(film=2e-6), of)
    assert "less than 20 times film height plus roughness" in sentence


def test_a_bridge_that_stretches_is_said_and_has_half_its_length_as_crack():
    wide = safe_without_tips()
    crack = float(wide.estimate.min()) / 2
    assert len(findings.of_device(wide, findings.OfDevice(replace(R1, thickness=3 * UM), 0.15 * UM))) == 0
    (sentence,) = findings.of_device(wide, findings.OfDevice(R1, 0.15 * UM))
    assert "1 times the thickness of the bridge" in sentence
    slope = findings.of_device(wide, findings.OfDevice(replace(R1, gap=0.11 / 1.5 * crack, thickness=80 * UM), 0.0))
    assert any("slope of 0.11" in sentence for sentence in slope)


def test_warnings_about_all_devices_have_their_names():
    found, of = device()
    plan = Plan(load({"devices": {"C1": {"kind": "cantilever", "pair": "c", "thickness_um": 2.6, "gap_um": 20,
                                         "width_um": 30, "humidities": [0.67]}}}))  # fmt: skip
    plasticity = {"c": xr.Dataset({"plastic_share": 0.58})}
    ((key, sentences),) = findings.of_devices(
        {("C1", 0.67): found}, plasticity, jobs.beyond_the_model(plan)["devices"]
    ).items()
    assert key == ("C1", 0.67)
    assert len(sentences) == 1
    assert of.device.kind == "cantilever"


# Page


def test_the_page_has_one_line_per_warning_and_what_is_not_modelled():
    page = findings.as_markdown({"pair a": [], "pair b": ["One.", "Two."]}, {("C1", 0.67): ["Three."]})
    assert [line for line in page.splitlines() if line.startswith("-")] == [
        "- pair b: One.",
        "- pair b: Two.",
        "- C1, RH 0.67: Three.",
    ]
    assert NOT_MODELLED in page


def test_a_page_without_warnings_says_so():
    assert "No result is beyond the limits" in findings.as_markdown({"pair a": []}, {})


def test_sentences_have_the_number_of_their_first_use():
    sentences, numbers = findings.numbered({"a": ["x.", "y."], "b": ["z.", "x."]})
    assert sentences == ["x.", "y.", "z."]
    assert numbers == {"a": [1, 2], "b": [3, 1]}

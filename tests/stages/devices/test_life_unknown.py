"""Every page answers the four questions of a designer, with a number or with the key that gives it."""

from dataclasses import replace
from itertools import chain, combinations

import numpy as np
import pytest
from answers import stopper_dataset
from ground import C1, R1, safe_with_tips, safe_without_tips
from lives import OF, STOPPER, UNSTATED

from stiction.contact.voltage import Dielectric
from stiction.devices.risk import samples_for
from stiction.report.devices import life as report
from stiction.stages.life.answers import QUESTIONS, answers_of, layout
from stiction.stages.life.beams import beam_answers, length_of
from stiction.stages.life.inputs import StopperKeys
from stiction.stages.life.stoppers import stopper_answers

ON = {"voltage": 5.0, "dielectric": Dielectric(100e-9, 4.0)}
#: What each key gives to a stopper.
KEYS = {
    "mass_ng": {"mass": STOPPER.mass},
    "electrode": {"electrode": STOPPER.electrode, "stiffness": STOPPER.stiffness, "gap": STOPPER.gap},
    "voltage_V": ON,
}


def all_of(keys):
    """All sets of keys."""
    return list(chain.from_iterable(combinations(keys, number) for number in range(len(keys) + 1)))


def answer_all_questions(dataset):
    """Check that each question has a number or a sentence, in the table and on the page. Return the keys asked for."""
    answers, said = answers_of(dataset), report.sentences(dataset)
    assert {one.question for one in answers} == set(QUESTIONS)
    cells = report.table({"D": dataset}).cells
    for one, cell, form in zip(answers, cells["at least"], cells["form"], strict=True):
        assert np.isnan([one.low, one.high]).all() == bool(one.needs), "a row has a number or asks for a key"
        assert not one.needs or (cell, form) == ("–", f"unknown: state {one.needs}")
        assert (f"The {one.what} is unknown: state {one.needs}." in said) == bool(one.needs)
    report.figure({"D": dataset}, {"D": None})
    return {one.name: one.needs for one in answers if one.needs}


@pytest.mark.parametrize("stated", all_of(KEYS), ids="-".join)
@pytest.mark.parametrize("number", [400, 200])
def test_a_stopper_asks_for_the_keys_that_it_lacks(stated, number):
    of = StopperKeys(**UNSTATED)
    for key in stated:
        of = replace(of, **KEYS[key])
    dataset = stopper_dataset().isel(sample=slice(number))
    if number < samples_for(0.01):
        dataset["basis"] = dataset.basis.copy(data=np.full(dataset.basis.shape, "fitted"))
    asked = answer_all_questions(layout(stopper_answers(dataset, of), of))
    expected = {
        "shock": "" if "mass_ng" in stated else "mass_ng",
        "voltage": "" if "electrode" in stated else "electrode, stiffness_N_per_m and gap_um",
        "at_voltage": "" if "voltage_V" in stated else "voltage_V and dielectric",
        "restoring_force": "" if number == 400 else "contact.samples of 299 or more",
    }
    expected["freeing"] = expected["shock"] or expected["restoring_force"]
    assert asked == {name: needs for name, needs in expected.items() if needs}


@pytest.mark.parametrize("kind", [C1, R1], ids=["cantilever", "bridge"])
@pytest.mark.parametrize("length", [0.0, 200e-6])
@pytest.mark.parametrize("safe", [1.0, np.inf, 0.0])
@pytest.mark.parametrize("on", [{}, ON], ids=["", "voltage"])
def test_a_beam_asks_for_its_length_if_no_safe_one_is_known(kind, length, safe, on):
    of = replace(OF, device=kind, length=length, **on)
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    one = safe_with_tips(tips) if kind is C1 else safe_without_tips()
    lengths = {0.67: one.assign(safe_length=safe * one.safe_length if safe else 0 * one.safe_length)}
    at = length_of(lengths, of)
    asked = answer_all_questions(layout(beam_answers(lengths, {}, of), of, at))
    expected = {} if 0 < at < np.inf else dict.fromkeys(("voltage", "shock", "energy", "force"), "length_um")
    assert asked == expected | ({} if on else {"voltage_energy": "voltage_V and dielectric"})

"""The first screen of a page has one answer, which agrees with the datasets, or the limit that forbids it."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from answers import (
    BRIDGE,
    BUDGETS,
    CANTILEVER,
    STOPPER,
    STOPPERS,
    TIPS,
    beam_answer,
    beam_page,
    budget_dataset,
    least,
    of_length,
    safe,
    screen_of,
    silent,
    stopper_answer,
    stopper_dataset,
    stopper_page,
)
from drawn_curves import etched, law_of, rough

from stiction.answer.data import Probability, Verdict
from stiction.answer.sought import FORCE, LENGTH
from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.devices.budget import LARGEST
from stiction.devices.limits import rules as limits
from stiction.devices.risk import one_in
from stiction.report.answer import words
from stiction.report.axes.section import with_process
from stiction.report.format import safe_size
from stiction.report.limits.words import text
from stiction.report.page import Page, Section, Summary
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.devices.budget import budget_of
from stiction.stages.devices.opening import ARC, S_SHAPE
from stiction.stages.test_beams.inference import shape_of

UNSAFE, STEEP = limits.plastic_contact(0.5, 1e8), limits.large_rotation(20e-6, 100e-6)
OF_TIP = {(0.67, "tip"): BUDGETS["C1", 0.67, "tip"]}


def with_total(budget, total):
    """Budget of another total, with slopes that are known exactly."""
    known = budget.assign(slope_error=0 * budget.slope_error)
    return known.assign(covariance=known.covariance * (total / budget_of(known).total) ** 2)


def test_without_a_length_the_answer_is_the_length_to_build_in_the_worst_air():
    lengths = {0.44: safe(), 0.67: safe(longest=500e-6)}
    answer = beam_answer(CANTILEVER, lengths)
    shown = screen_of(answer, CANTILEVER)
    # All inputs count as exact: the simulated limit of the worst air, as far as 4000 draws tell it.
    assert answer.build == pytest.approx(least(lengths[0.67]), rel=5e-3)
    assert (shown.tone, shown.sign) == ("good", "Length to build")
    assert shown.answer == f"No longer than {safe_size(answer.build, LENGTH)}."
    assert shown.points["What decides"].startswith("RH 0.67, the strictest of the stated airs, stuck by the tip.")
    assert "at relative humidities of 0.44, 0.67 (95 % confidence, if the model holds)." in shown.basis[0]
    assert "All inputs count as exact." in shown.basis[1]
    assert shown.cells["RH"].tolist() == ["0.44", "0.67 (decides)"]
    alone = [1e6 * least(one) for one in lengths.values()]
    np.testing.assert_allclose(shown.cells["length to build [µm]"].astype(float), alone, rtol=1e-2)


@pytest.mark.parametrize(
    ("length", "verdict", "sign"),
    [(150, "safe", "Safe"), (275, "open", "Not shown to be safe"), (400, "bad", "Too long")],
)
def test_a_stated_length_is_judged_by_the_size_to_build_and_its_own_fraction(length, verdict, sign):
    # All 400 devices stick between 280 and 420 µm, by beam or tip.
    section = CANTILEVER | {"length_um": length}
    answer = beam_answer(section, {0.67: of_length(1e-6 * length)})
    shown = screen_of(answer, section)
    assert (answer.verdict, shown.sign) == (Verdict(verdict), sign)
    assert answer.stuck.value == pytest.approx(max(length - 280, 0) / 140, abs=0.01)
    said = words.stuck_in_words(answer.stuck)
    assert shown.answer.endswith(f"; with your {length:g} µm, {said} stick.")
    assert shown.cells.iloc[0, -1] == said


def test_dry_air_is_in_words():
    forces = stopper_dataset().assign_coords(humidity=[0.0, 0.67]).assign(restoring_force=1e-9)
    section = CANTILEVER | {"length_um": 400}
    stopped = screen_of(stopper_answer(forces), STOPPER)
    released = screen_of(beam_answer(section, {0.0: of_length(400e-6)}), section)
    for shown in (stopped, released):
        assert shown.points["What decides"].startswith(("Dry air, the strictest", "Dry air, stuck by"))
        assert shown.cells.RH[0].removesuffix(" (decides)") == "dry"
    assert " in dry air (95 % confidence, if the model holds)." in beam_page(CANTILEVER, {0.0: safe()}).summary.basis[0]


def test_the_uncertainty_of_the_inputs_shortens_the_answer_and_names_what_to_measure():
    exact, answer = (beam_answer(CANTILEVER, {0.67: safe()}, budgets) for budgets in ({}, OF_TIP))
    assert answer.build < exact.build == pytest.approx(answer.exact)
    assert answer.measure == "heights of B2"
    assert answer.build < answer.if_measured < answer.exact
    wide = {(0.67, "tip"): with_total(OF_TIP[0.67, "tip"], 0.2)}
    answer = beam_answer(CANTILEVER, {0.67: safe()}, wide)
    shown = screen_of(answer, CANTILEVER)
    assert f"would be {safe_size(answer.if_measured, LENGTH)}" in shown.points["What to measure"]
    assert shown.points["What to measure"].startswith("Heights of B2: known exactly")
    assert "uncertainty" in screen_of(exact, CANTILEVER).points["What to measure"]


@pytest.mark.parametrize("own", [None, 50, 400])
def test_inputs_that_leave_a_length_too_uncertain_allow_no_length_to_build(own):
    section = CANTILEVER | ({"length_um": own} if own else {})
    lengths = {0.67: of_length(own * 1e-6) if own else safe()}
    above, below = (
        beam_answer(section, lengths, {(0.67, "tip"): with_total(OF_TIP[0.67, "tip"], total * LARGEST)})
        for total in (1.02, 0.98)
    )
    shown = screen_of(above, section)
    sign = "Too long" if own == 400 else "Not known"
    assert (above.verdict, shown.sign) == (Verdict.BAD if own == 400 else Verdict.NONE, sign)
    assert f"Were all exact, it would be {1e6 * above.exact:.0f} µm." in shown.answer
    assert not any("95 % confidence" in text for text in shown.basis), "nothing is promised"
    assert ("with your" in shown.answer) == bool(own)
    assert screen_of(below, section).answer.startswith(f"No longer than {1e6 * below.build:.0f} µm")


def test_the_sizes_to_change_need_the_adhesion_energy_of_the_length_to_build():
    section = CANTILEVER | {"length_um": 400}
    answer = beam_answer(section, {0.67: of_length(400e-6)})
    shown = screen_of(answer, section)
    thickness, gap = (float(part.split()[0]) for part in shown.points["What to change"].split(" of ")[2:])

    def energy(crack, thickness, gap):
        beam = Beam(1500e-6, 30e-6, 1e-6 * thickness, 164e9, 1e-6 * gap, 200)
        return apparent_adhesion_energy(1e-6 * crack, beam)

    at_build = energy(1e6 * answer.build, CANTILEVER["thickness_um"], CANTILEVER["gap_um"])
    np.testing.assert_allclose(energy(400, thickness, CANTILEVER["gap_um"]), at_build, rtol=0.02)
    np.testing.assert_allclose(energy(400, CANTILEVER["thickness_um"], gap), at_build, rtol=0.02)


@pytest.mark.parametrize("budgets", [{}, {(0.44,): BUDGETS["S1", 0.67]}])
def test_a_stopper_suffices_if_and_only_if_it_has_the_force_to_build(budgets):
    stopper = STOPPERS["S1"]
    needed = stopper_answer(stopper, budgets).build
    limit = float(stopper.safe_force.sel(part="safe", share=1e-2).max())
    assert needed == pytest.approx(limit, rel=5e-3) if not budgets else needed > 1.005 * limit
    for by, sign in ((2, "Suffices"), (1.001, "Suffices"), (0.999, "Not shown to suffice"), (0.1, "Too weak")):
        answer = stopper_answer(stopper.assign(restoring_force=by * needed), budgets)
        shown = screen_of(answer, STOPPER)
        assert shown.sign == sign
        own = f"with your {1e6 * by * needed:.4g} µN, {words.stuck_in_words(answer.stuck)} stick"
        assert shown.answer == f"At least {safe_size(needed, FORCE)}; {own}."
        build = "Nothing." if by > 1 else f"A restoring force of {safe_size(needed, FORCE)}."
        assert shown.points["What to change"] == build


def test_a_limit_on_the_unsafe_side_stands_in_place_of_the_number():
    beam = beam_answer(CANTILEVER, {0.67: safe()}, limits=[UNSAFE])
    stopped = stopper_answer(STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, [UNSAFE])
    for answer, section in ((beam, CANTILEVER), (stopped, STOPPER)):
        shown = screen_of(answer, section, [UNSAFE])
        assert (shown.tone, shown.sign, shown.answer) == ("bad", "Do not rely on a number", text(UNSAFE))
        assert (shown.cells.iloc[:, 1:] == "–").all(axis=None)
    assert (
        "No longer than"
        in beam_page(CANTILEVER, {0.67: safe()}, warnings=silent({0.67: safe()}, limits=[STEEP])).lines[0]
    )


# Test beams


def updated_by_tests(responses, p_value=0.2):
    """Update of one result for each response by test beams."""
    number = len(responses)
    before, shift, after = np.array([0.2, 0.1]), np.array([0.05, -0.02]), np.array([0.1, 0.04])
    scores = np.linspace(-6, 6, 61)
    return xr.Dataset(
        {
            "p_value": p_value,
            "response": ("result", list(responses)),
            "humidity_of_result": ("result", [0.67] * number),
            "result_before": ("result", before[:number]),
            "result_shift": ("result", shift[:number]),
            "result_after": ("result", after[:number]),
            "result_quantile": (("result", "score"), (shift[:, None] + np.outer(after, scores))[:number]),
            "measured": ("datum", [np.nan]),
            "stuck": ("count", []),
        },
        {"shape": list(map(shape_of, responses)), "score": scores},
    )


def of_tips(p_value=0.2):
    return updated_by_tests([ARC, S_SHAPE], p_value)


@pytest.mark.parametrize(("p_value", "forbidden"), [(1e-5, True), (0.2, False)])
def test_test_beams_that_nothing_explains_forbid_the_number(p_value, forbidden, monkeypatch):
    monkeypatch.setattr("stiction.report.devices.pages._test_beam_sections", lambda name, update: [])
    contradicted = [tables_test_beams.contradiction(of_tips(p_value))] * forbidden
    monkeypatch.setattr(tables_test_beams, "warnings", lambda update: contradicted)
    page = beam_page(CANTILEVER, {0.67: safe()}, test_beams=of_tips(p_value))
    assert (page.summary.sign == "Do not rely on a number") == forbidden
    assert ("rely neither on the update" in page.summary.answer) == forbidden


def test_the_answer_of_a_device_with_test_beams_is_the_one_that_they_give():
    dataset = safe()
    answer = beam_answer(CANTILEVER, {0.67: dataset}, OF_TIP, test_beams=of_tips())
    without = beam_answer(CANTILEVER, {0.67: dataset}, OF_TIP)
    # The tip decides: its length moves by exp(0.05) with a standard deviation of 0.1, which is far more than the
    # simulation leaves, so that its 5 % quantile is that of a lognormal length.
    by_hand = float(dataset.estimate.sel(share=1e-3).min()) * np.exp(0.05 - 1.645 * 0.1)
    assert answer.build == pytest.approx(by_hand, rel=0.02)
    assert answer.without_test_beams == pytest.approx(without.build, rel=1e-12)
    shown = screen_of(answer, CANTILEVER)
    assert shown.answer == f"No longer than {safe_size(answer.build, LENGTH)}."
    assert f"Without the test beams, it would be {1e6 * without.build:.0f} µm." in shown.basis
    assert shown.cells["length to build [µm]"].tolist() == [safe_size(answer.build, LENGTH).split()[0]]


# Pages with a limit that forbids a number


def beam(section, warnings, **given):
    """Page of a cantilever or bridge, with a warning about all shapes."""
    is_bridge = section["kind"] == "bridge"
    lengths = {rh: safe("bridge") if is_bridge else of_length(800e-6) for rh in (0.44, 0.67)}
    return beam_page(section, lengths, {} if is_bridge else OF_TIP, warnings=silent(lengths, limits=warnings), **given)


def stopper(warnings, **given):
    """Page of a stopper."""
    return stopper_page(STOPPER, STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, warnings, **given)


def processed(warnings):
    """Page of a stopper over a process."""
    curve, settings = etched()
    data = {"process": curve, "process_settings": settings, "process_laws": [law_of()]}
    return with_process(stopper(warnings), "D", data)


KINDS = {
    "cantilever": lambda warnings: beam(CANTILEVER | {"length_um": 800}, warnings),
    "bridge": lambda warnings: beam(BRIDGE, warnings),
    "stopper": stopper,
    "roughness": lambda warnings: stopper(warnings, roughness=rough()),
    "process": processed,
}


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=[pytest.mark.slow] * (kind != "bridge")) for kind in KINDS])
def test_the_limit_that_forbids_a_number_stands_in_the_place_of_all_numbers_in_words(kind):
    open_, shut = (replace(KINDS[kind](one), more=["More."], explorer={"name": kind}) for one in ([STEEP], [UNSAFE]))
    assert len(open_.lines) > 1
    assert shut.summary.answer.endswith(text(UNSAFE))
    first, *others = shut.lines
    assert first == f"Do not rely on a number: {shut.summary.answer}"
    assert not any(re.search(r"\d (µm|µN|%)", line) for line in others)
    assert (open_.controls["forbidden"], shut.controls["forbidden"]) == ("", first)
    assert "– means no number: the warning above forbids to rely on one." in shut.html
    assert ("What to change" in open_.summary.points, "What to change" in shut.summary.points) == (True, False)
    assert ("More in words" in open_.html, "More in words" in shut.html) == (True, False)


def test_a_number_comes_with_the_error_of_the_model_or_says_that_it_is_not_stated():
    for said, number in (([], 1), ([UNSAFE], 0)):
        lengths = {0.67: safe()}
        page = beam_page(CANTILEVER, lengths, warnings=silent(lengths, limits=said))
        assert sum("error of the model" in text for text in page.summary.basis) == number


def test_limits_forbid_a_number_only_on_the_unsafe_side():
    forbidding = (
        UNSAFE,
        limits.spacer("FDTS", [limits.OF_COATINGS[limits.COATING]]),
        limits.without_gaps({0.1: (-0.2, 0.01)}, shorter=True),
        limits.wide_meniscus(1e-6, (3e-6, 3e-6)),
    )
    assert all(limit.forbids for limit in forbidding)
    others = limits.large_rotation(20e-6, 100e-6), limits.flat_patches(0.1), limits.stretched_bridge(2e-6, 2e-6)
    assert not any(limit.forbids for limit in others)


@pytest.mark.parametrize("cell", ["–", "1"])
def test_a_cell_without_a_number_is_explained_where_it_stands(cell):
    cells = pd.DataFrame({"RH": [cell]})
    summary = Summary("good", "Safe", "5 µm", (), {}, cells)
    page = Page("C1", {}, ["Yes."], [Section("Table", (), cells, missing="no tip")], summary=summary).html
    assert ("– means no number: no tip." in page) == (cell == "–")
    assert page.count("– means no number") == 2 * (cell == "–")


def test_the_longest_lengths_are_those_of_beams_whose_tip_cannot_touch():
    dataset = safe()
    answer = beam_answer(CANTILEVER, {0.67: dataset})
    (air,) = answer.airs
    assert air.without_tip == pytest.approx(float(dataset.safe_length.sel(share=1e-3, shape=S_SHAPE)), rel=5e-3)
    shown = screen_of(answer, CANTILEVER)
    assert shown.cells["if the tip cannot touch and the model holds [µm]"].tolist() == [
        safe_size(air.without_tip, LENGTH).split()[0]
    ]
    assert (
        "if the tip cannot touch and the model holds [µm]"
        not in screen_of(beam_answer(BRIDGE, {0.67: safe("bridge")}), BRIDGE).cells
    )


def test_what_decides_a_stopper_is_the_air_of_the_largest_force_in_its_table():
    for humidities in ([0.0, 0.67], [0.67, 0.0]):
        forces = stopper_dataset().assign_coords(humidity=humidities)
        for force in (1e-9, 19e-6, 1.0):
            shown = screen_of(stopper_answer(forces.assign(restoring_force=force)), STOPPER)
            worst = shown.cells.RH[shown.cells["force to build [µN]"].astype(float).idxmax()]
            named = "Dry air, " if worst == "dry (decides)" else f"RH {worst.removesuffix(' (decides)')}, "
            assert "(decides)" in worst
            assert shown.points["What decides"].startswith(named)


@pytest.mark.parametrize("factor", [0.99, 1.01, np.nan])
def test_an_air_that_decides_in_most_draws_need_not_be_the_strictest_alone(factor):
    forces = stopper_dataset().assign_coords(humidity=[0.44, 0.67])
    answer = stopper_answer(forces)
    decides = answer.stated_steps[-1].humidity
    (strictest,) = (air for air in answer.airs if air.humidity == decides)
    airs = tuple(air if air is strictest else replace(air, build=factor * strictest.build) for air in answer.airs)
    said = words.decides(replace(answer, airs=airs))
    assert said.startswith(f"RH {decides}, {'most often ' * (factor > 1)}the strictest of the stated airs.")


def test_one_air_has_one_size_and_that_of_the_air_that_decides_is_in_all_of_them():
    answer = stopper_answer(stopper_dataset().assign_coords(humidity=[0.44, 0.67], restoring_force=20e-6))
    together = replace(answer, build=1.02 * max(air.build for air in answer.airs), stuck=Probability(0.9, 0.8, 0.95))
    rows = {row["RH"]: row for row in words.of_airs(together)}
    (decides,) = (air for air in answer.airs if air.humidity == together.together.humidity)
    row = rows.pop(f"{decides.humidity:g} (decides)")
    assert row["force to build [µN]"] == safe_size(together.build, together.sought).split()[0]
    assert row["force to build [µN]"] != safe_size(decides.build, together.sought).split()[0]
    assert row["P(stuck) at 20 µN"] == words.stuck_in_words(together.stuck)
    ((text, other),) = rows.items()  # the control: another air has its own
    (air,) = (air for air in answer.airs if air is not decides)
    assert text == f"{air.humidity:g}"
    assert other["force to build [µN]"] == safe_size(air.build, together.sought).split()[0]
    (single,) = words.of_airs(replace(answer, airs=(decides,)))
    assert single["RH"] == f"{decides.humidity:g}"


@pytest.mark.parametrize(("touchdowns", "said"), [(1, "one touchdown"), (20_000, "20 000 touchdowns")])
def test_a_size_to_build_says_for_how_many_touchdowns_it_is(touchdowns, said):
    for answer in (beam_answer(CANTILEVER, {0.67: safe()}), stopper_answer(stopper_dataset())):
        promised = words.promise(replace(answer, touchdowns=touchdowns))
        assert promised.startswith(f"At most {one_in(answer.share)} sticks after {said} at ")


@pytest.mark.parametrize(
    ("touchdowns", "head"),
    [(1, "P(stuck) at 275 µm"), (1000, "P(stuck) after 1000 touchdowns, each on other summits, at 275 µm")],
)
def test_the_head_of_a_fraction_has_the_touchdowns_that_it_counts(touchdowns, head):
    section = CANTILEVER | {"length_um": 275, "touchdowns": touchdowns}
    assert screen_of(beam_answer(section, {0.67: of_length(275e-6)}), section).cells.columns[-1] == head


def test_a_bridge_has_the_budget_of_its_middle_and_not_that_of_tips():
    lengths = {0.67: safe("bridge")}
    tip = beam_answer(BRIDGE, lengths, {(0.67, "tip"): budget_dataset(5.0, TIPS)})
    assert tip.build == beam_answer(BRIDGE, lengths).build


@pytest.mark.parametrize("fraction", [0.9899, 0.9901, 0.9949, 0.9951, 0.9962, 0.998994])
def test_nearly_all_is_not_rounded_to_all(fraction):
    for end in ("", "low", "high"):
        shown = float(words.percent(fraction, end).removesuffix(" %"))
        assert shown < 100
        digits = 100 * min(fraction, 1 - fraction) if fraction > 0.99 else 100 * fraction
        step = 0.05 if end else 0.05 / 2  # of two digits; an end is rounded outwards
        assert shown == pytest.approx(100 * fraction, abs=2 * step * digits)

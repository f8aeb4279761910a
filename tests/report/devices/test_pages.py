"""Pages of devices show the answer, the numbers of the datasets, figures and warnings."""

import base64
import json
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
    stopper_answer,
    stopper_dataset,
    stopper_page,
)
from charted import charted
from hostile import HOSTILE, Reading
from matplotlib.figure import Figure
from noted import noted

import stiction
from stiction.answer.data import Between, Cause
from stiction.contact.environment import Water
from stiction.devices.risk import VERIFIED
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.devices import pages, sentences
from stiction.report.devices import tables as tables_devices
from stiction.report.format import safe_size
from stiction.report.page import Page, Section, Summary
from stiction.report.surfaces.words import surface_in_words
from stiction.stages.axes import requirement, roughness
from stiction.stages.axes.requirement import RequiredStopper, Response
from stiction.stages.devices import device_warnings
from stiction.stages.devices.device_warnings import OfDevices
from stiction.stages.devices.opening import EITHER, S_SHAPE


@pytest.fixture(scope="module")
def stopper():
    budgets = {(0.67,): BUDGETS["S1", 0.67]}
    return stopper_page(STOPPER, STOPPERS["S1"], budgets, [noted("Too hot.")]).html


def test_a_page_is_one_file_with_its_figures(stopper):
    assert stopper.startswith("<!DOCTYPE html>")
    pictures = re.findall(r'src="data:image/webp;base64,([^"]+)"', stopper)
    assert stopper.count('class="panels"') == 3
    assert {base64.b64decode(picture)[8:12] for picture in pictures} == {b"WEBP"}
    assert not re.findall(r'(?:src|href)="(?!data:|#)', stopper)


def test_long_descriptions_of_surfaces_are_wrapped_and_numbers_of_tables_are_not(stopper):
    assert ".facts td { white-space: normal;" in stopper
    assert stopper.count('<table class="facts">') == 1
    assert "td { white-space: nowrap }" in stopper


def test_the_page_of_a_stopper_says_how_many_stick_and_in_which_air(stopper):
    assert f"<td>at most {100 * VERIFIED:g} %</td>" in stopper
    assert (
        "mean force is largest at a relative humidity of 0.70: larger than in drier and wetter air, from 0.4 to 0.9"
        in stopper
    )
    assert "Where most stick in this range, at most 0.918 % do at one touchdown." in stopper
    found = STOPPERS["S1"].sel(share=1e-2)
    stated, any_air = (
        1e6 * float(force.max()) for force in (found.safe_force.sel(part="safe"), found.safe_force_along)
    )
    assert (
        f"a restoring force of {stated:.3g} µN leaves at most 1 in 100 stuck at one touchdown (95 % confidence)"
        in stopper
    )
    assert f"; at any humidity from 0.4 to 0.9, {any_air:.3g} µN are needed." in stopper
    assert (
        "leaves at most 1 in 1000 stuck at one touchdown (95 % confidence, by a line through the largest 5 % of the "
        "forces)" in stopper
    )
    assert "leaves at most 1 in 1 000 000 stuck at one touchdown (extrapolated, by a line" in stopper.replace(
        "\N{NO-BREAK SPACE}", " "
    )
    assert "<td>3 x 3 µm</td>" in stopper
    assert "<td>relative humidities</td><td>0.44, 0.67</td>" in stopper


def test_a_worst_humidity_at_the_end_is_stated_as_one():
    assert sentences.worst_sentence(stopper_dataset(peak=1.0)) == (
        "Between relative humidities of 0.4 and 0.9, its mean force is largest at 0.9. "
        "The strictest air can be another one: the few places that hold most decide. "
        "Where most stick in this range, at most 0.918 % do at one touchdown."
    )


def test_a_page_names_the_roughness_that_was_asked_for_and_its_answer_in_the_second_sentence():
    asked = RequiredStopper(
        seed=1, water=Water(300.0), humidities=(0.6,), contact=(1e-6, 1e-6), share=0.05, restoring_force=1e-6
    )
    forces = {rms: 1e-6 * (4e-9 / rms) ** 3 for rms in (2e-9, 8e-9, 3.4e-9)}
    responses = {
        rms: Response(1.1 * force, force, 0.03 * force, np.nan, (0.1, 0.05, 0.15)) for rms, force in forces.items()
    }
    said = {name: ("humidity", [""]) for name in ("flagged", "refused")}
    points = [
        requirement.layout([[one]], 400, asked).assign(said | {"roughness": rms}) for rms, one in responses.items()
    ]
    rough = roughness.curve_or_map(points, "B2", "rms_nm")
    section = STOPPER | {"requirement": {"share": 0.05}, "roughness": {"surface": "B2", "rms_nm": [2, 8]}}
    page = stopper_page(section, STOPPERS["S1"], roughness=rough)
    assert "<td>requirement</td><td>at most 1 in 20 sticks</td>" in page.html
    assert "<td>roughness of B2 asked for</td><td>rms from 2 to 8 nm</td>" in page.html
    shown = page.html.partition("<h2>How rough must it be?</h2>")[2].partition("<h2>Limits")[0]
    assert "exactly 1 in 20 sticks at " in shown
    assert "On the surfaces as they are given, at 3.4 nm" in shown
    assert shown.count('class="panels"') == 1
    assert shown.count("rms of B2 [nm]</td>") == len(responses)
    assert page.answer[-1] == (
        "For a restoring force of 1 µN, at a relative humidity of 0.6, at most 1 in 20 sticks where the rms of B2 is "
        "4.13 to 8 nm (by simulation alone, 95 % confidence, given the drawn surfaces; computed for 2 to 8 nm)."
    )


def test_a_bound_of_all_stoppers_is_no_statement():
    all_stuck = stopper_dataset().assign(stuck_along=xr.ones_like(STOPPERS["S1"].stuck_along))
    assert sentences.worst_sentence(all_stuck).endswith("the few places that hold most decide.")


def test_advice_warnings_and_what_is_not_modelled_are_shown(stopper):
    assert "Relative humidity 0.67: Measure heights of B2 better" in stopper
    assert "<p>surface B2: Too hot.</p>" in stopper
    assert "<p>Not all.</p>" in replace(Page("S1", {}, ["Yes."]), not_modelled="Not all.").html


def test_sentences_on_safe_forces_begin_with_the_humidities_of_the_stopper():
    found = STOPPERS["S1"]
    answer = stopper_answer(found)
    assert sentences.safe_force_sentences(found, answer)[0].startswith(
        "By simulation alone, at all these humidities, a restoring force of"
    )
    single = sentences.safe_force_sentences(found.sel(humidity=[0.67]), answer)
    assert single[0].startswith("By simulation alone, at a relative humidity of 0.67, a restoring force of")


def test_the_limit_for_the_fraction_of_the_answer_stands_beside_the_force_to_build():
    found = STOPPERS["S1"]
    exact = replace(stopper_answer(found), share=1e-3, touchdowns=1000)
    (step,) = (step for step in exact.steps if step.cause is Cause.SIMULATION)
    answer = replace(exact, steps=(*exact.steps, replace(step, cause=Cause.INPUTS)))
    told = sentences.safe_force_sentences(found, answer)
    assert [" The force to build, " in text for text in told] == ["1 in 1 000 000 " in text for text in told]
    assert sum(" The force to build, " in text for text in told) == 1
    assert told[-1].endswith(
        f" The force to build, {safe_size(answer.build, answer.sought)}, allows the same 1 in 1 000 000 at each of "
        "1000 touchdowns, and counts the uncertainty of the inputs as well."
    )
    between = replace(answer, between=Between(0.5, 2 * answer.build, 3 * answer.build))
    size = safe_size(2 * answer.build, answer.sought)
    assert f" ({size} between the stated airs), allows" in sentences.safe_force_sentences(found, between)[-1]
    for control in (exact, replace(answer, touchdowns=300), replace(answer, forbidden=("gap",))):
        assert "force to build" not in " ".join(sentences.safe_force_sentences(found, control))


def test_a_page_explains_the_terms_that_it_uses_and_no_others():
    bridge = beam_page(BRIDGE, {0.67: safe("bridge")}).html
    assert "<dt>Held by the middle</dt>" in bridge
    assert "Held by the tip" not in bridge
    assert "Choice of the model" not in bridge
    budgets = {(0.67,): budget_dataset()}
    beam = beam_page(CANTILEVER, {0.67: safe()}, budgets).html
    assert "<dt>Held by the tip</dt>" in beam
    assert "Held by the middle" not in beam
    assert "<dt>Van der Waals in dry gaps, or none</dt>" in beam
    assert "<dt>Grid</dt>" not in beam


def test_surfaces_are_described_by_their_numbers_or_their_scans():
    assert surface_in_words({"rms_nm": 2, "psd": "identified", "summit_density_per_um2": 40}, {}) == (
        "rms 2 nm, density of summits 40 per µm²"
    )
    assert surface_in_words({"scans": {"files": ["a.gwy", "b.gwy"]}}, {}) == "described by 2 scans"


def test_the_adhesion_parameter_of_a_pair_is_a_fact_where_its_summits_are_stated():
    bump = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 1, "humidities": ["dry", 0.6]}

    def facts(config):
        section = Graph(Plan(stiction.load(config))).job("devices/S1.html").settings
        return pages._facts_of(section)

    stated = facts({"devices": {"S1": bump}})["adhesion parameter θ"]
    assert (
        stated == "81.1 to 113 (for comparison: dry wafers bond below 1 and do not adhere above 12; water is left out)"
    )
    mine = {"rms_nm": 5, "hurst": 0.8, "correlation_length_nm": 100, "cutoff_rad_per_um": 138, "like": "B2"}
    unknown = {
        "surfaces": {"Mine": mine},
        "pairs": {"mine": {"beam": "Mine", "substrate": "Sub1", "gap_um": 2, "humidities": [0.6]}},
    }
    others = facts(unknown | {"devices": {"S1": bump | {"pair": "mine"}}})
    assert "adhesion parameter θ" not in others


def test_the_saturated_air_of_the_headline_is_explained_without_a_chart():
    assert "<dt>Bound</dt>" in beam_page(CANTILEVER, {0.67: safe()}).html


SHAPES = S_SHAPE, EITHER


def test_a_beam_without_chart_and_budget_has_neither():
    plain = beam_page(CANTILEVER, {0.67: safe()}).html
    assert "Uncertainty, and" not in plain
    assert "Other thicknesses" not in plain
    assert plain.count('class="panels"') == 2
    budgets = {(0.44,): budget_dataset(2.0), (0.67,): budget_dataset(), (0.67, "tip"): budget_dataset(0.5, TIPS)}
    both = beam_page(CANTILEVER, {0.67: safe()}, budgets).html
    assert both.count('class="panels"') == 3
    assert all(f"RH {humidity}: effect [%]" in both for humidity in (0.44, 0.67))
    assert both.count("Counted as exact: ") == 1
    assert "1 in 1000 tips hold (arc) would fall" in both
    rows = re.findall(r"<td[^>]*>thickness</td>\s*<td[^>]*>(beam|tip)</td>", both)
    assert rows == ["beam", "tip"]


def test_warnings_of_a_beam_have_the_numbers_of_its_tables():
    warned = {("C1", 0.67, shape): [noted("Too steep.")] * (shape == EITHER) for shape in SHAPES}
    curves = [("C1", *curve) for curve in device_warnings.curves(charted(0.5))]
    warned |= dict.fromkeys(curves, []) | {curves[0]: [noted("Too thin."), noted("Too steep.")]}
    page = beam_page(CANTILEVER, {0.67: safe()}, charts={0.5: charted(0.5)}, warnings=OfDevices(warned, {}, {})).html
    assert "<p>(1) surface B2: Too steep.</p>\n<p>(2) surface B2: Too thin.</p>" in page
    rows = re.findall(r"<td[^>]*>([^<]*)</td>\s*</tr>", page.partition("By simulation alone")[2])  # last cells
    assert rows == [""] * 3 + ["1"] * 3 + ["2, 1"] + [""] * 7
    assert page.count('class="panels"') == 3
    assert "<details>" not in page


def test_a_long_table_is_folded():
    charts = {humidity: charted(humidity) for humidity in np.linspace(0.4, 0.9, 9).round(3)}
    silent = {("C1", 0.67, shape): [] for shape in SHAPES}
    silent |= {("C1", *curve): [] for curve in device_warnings.curves(charted(0.5))}
    page = beam_page(CANTILEVER, {0.67: safe()}, charts=charts, warnings=OfDevices(silent, {}, {})).html
    assert page.count("<details><summary>Table of 72 rows</summary>") == 1


def test_a_saved_page_ends_with_date_version_and_commit_of_the_last_run_and_differs_in_nothing_else(tmp_path):
    save, page, lines = pages.STAGES[0].save, Page("S1", {}, ["Build it, -5.3 %."]), []
    for day, commit in (("01", "abc"), ("02", "def")):
        run = {"versions": {"stiction": "1.2"}, "config": {}}
        runs = [run | {"started": f"2026-03-{day}T08:30:59+00:00"} for day in ("31", day)]
        runs[0]["git"], runs[1]["git"] = None, {"commit": commit, "changed": ["law.py"], "untracked": ["mine.gwy"]}
        (tmp_path / "provenance.json").write_text(json.dumps(runs))
        save(page, {"html": str(tmp_path / "devices" / "S1.html"), "answer": str(tmp_path / "devices" / "S1.txt")})
        lines.append((tmp_path / "devices" / "S1.html").read_text(encoding="utf-8").splitlines())
        for part in (
            f"run of 2026-03-{day} 08:30 UTC.",
            f"stiction 1.2, commit {commit}.",
            "changed in its folder: law.py",
        ):
            assert part in "".join(lines[-1])
        assert "mine.gwy" not in "".join(lines[-1]), "is no code"
    assert sum(one != other for one, other in zip(*lines, strict=True)) == 2
    assert (tmp_path / "devices" / "S1.txt").read_text(encoding="utf-8") == "Build it, −5.3 %.\n"


def test_text_is_shown_as_it_is():
    figure, cells = Figure(figsize=(1, 1)), pd.DataFrame({HOSTILE: [HOSTILE]})
    figure.subplots()
    sections, words = [Section(HOSTILE, [HOSTILE], cells, figure)], {HOSTILE: HOSTILE}
    summary = Summary("good", HOSTILE, HOSTILE, [HOSTILE], words, cells)
    page = Page(HOSTILE, {HOSTILE: HOSTILE}, [HOSTILE] * 2, sections, [HOSTILE], words, [HOSTILE], summary=summary)
    page = replace(page, more=[HOSTILE] * 2)
    shown = Reading(page.html)
    assert [code for code in shown.code if code != "meta"] == []
    for tag, number in {"title": 1, "h1": 1, "th": 2, "td": 4, "dt": 2, "dd": 2}.items():
        assert shown.text[tag] == [HOSTILE] * number
    said = [text.replace("\N{NO-BREAK SPACE}", " ") for text in shown.text["p"]]
    assert [text for text in said if text == HOSTILE] == [HOSTILE] * 9
    assert len(shown.text["p"]) == 11, "with the link to warnings and what is not in the model"
    assert shown.text["h2"] == [HOSTILE, "More in words", "Limits of this prediction", "Terms"]
    assert shown.alt == [HOSTILE]


def test_the_table_has_the_share_at_the_length_of_those_devices_that_have_one():
    cases = {("C1", 0.67): of_length(350e-6), ("C2", 0.67): safe()}
    silent = {(name, 0.67, shape): [] for name in ("C1", "C2") for shape in (S_SHAPE, EITHER)}
    table = tables_devices.safe_lengths(cases, silent)
    one, other = (part for _, part in table.frame.groupby("device"))
    assert set(one.length_um) == {350}
    assert list(one.share_stuck) == [0.0] * 3 + [0.5] * 3
    assert other.length_um.isna().all()
    assert list(table.cells["P(stuck) [%]"])[-1] == "–"
    assert "at their given length" in table.caption
    assert "length [µm]" not in tables_devices.safe_lengths({("C2", 0.67): safe()}, silent).cells


def test_where_few_devices_stick_the_page_begins_with_how_many_do_at_most():
    few = safe(longest=3000e-6, reach=1410e-6)  # 6 of 400 devices stick, by their tips
    page = beam_page(CANTILEVER, {0.67: few})
    assert page.answer[0] == (
        "At a relative humidity of 0.67, hardly any device sticks: none of the 400 simulated ones shorter than 1400 µm "
        "does, and at most 3 % of those of 1410 µm (95 % confidence, given the drawn surfaces). For 1 in 1000, the "
        "length that sticks on flat surfaces counts; 2995 devices in design.beams show whether longer ones release."
    )
    flat = 1e6 * few.flooded_length.sel(shape=EITHER).item()
    assert page.lines[0] == f"Length to build: No longer than {flat:.0f} µm."
    assert '<td class="word">flat</td>' in page.html
    assert not beam_page(CANTILEVER, {0.67: safe()}).answer


def test_where_no_device_sticks_in_enough_simulated_ones_the_longest_is_safe():
    never = safe(longest=3000e-6, reach=500e-6).sel(share=[1e-2])
    assert sentences.few_sentence(0.67, never) == (
        "At a relative humidity of 0.67, hardly any device sticks: none of the 400 simulated ones does, and at most "
        "0.75 % of those of 500 µm (95 % confidence, given the drawn surfaces)."
    )
    assert least(never, 1e-2) == pytest.approx(500e-6)
    assert beam_page(CANTILEVER, {0.67: never}).summary.answer == "No longer than 500 µm."


def test_the_page_does_not_say_again_what_its_first_screen_says():
    page = beam_page(CANTILEVER | {"length_um": 350}, {0.67: of_length(350e-6)})
    screen, *said = page.lines
    assert screen == f"{page.summary.sign}: {page.summary.answer}"
    assert said[len(page.summary.basis) + len(page.summary.points) :] == page.answer
    assert page.summary.answer not in page.more


def test_the_facts_of_a_mission_name_all_its_conditions_and_its_table_has_no_dash():
    conditions = [{"temperature_C": 12, "dew_point_C": 10}, {"temperature_C": 85, "humidity": 0.0}]
    mission = CANTILEVER | {"humidities": [0.0, 0.67], "conditions": conditions}
    lengths = {0.0: of_length(300e-6), 0.67: of_length(300e-6)}
    plain = beam_answer(mission, lengths)
    airs = [replace(one, temperature=293.15 if one.humidity else np.nan) for one in plain.airs]
    found = replace(plain, airs=tuple(airs))
    page = beam_page(mission, lengths, answer=found)
    assert page.facts["conditions"] == "12 °C at a dew point of 10 °C: RH 0.8755; 85 °C: dry"
    assert [str(cell) for cell in page.summary.cells["°C"]] == ["any", "20"]
    assert not page.summary.has_missing
    without = beam_page(CANTILEVER, {0.67: of_length(300e-6)})
    assert "conditions" not in without.facts
    assert "°C" not in without.summary.cells


def test_the_section_of_the_steps_names_all_stricter_sizes():
    """Those of airs between the stated ones, and of causes that are no step, among them."""
    lengths = {0.44: of_length(300e-6), 0.67: of_length(300e-6)}
    found = beam_answer(CANTILEVER, lengths)
    told = []
    for between in (None, Between(0.5, 0.8 * found.build, found.build)):
        page = beam_page(CANTILEVER, lengths, answer=replace(found, between=between, unasked=()))
        (steps,) = [section for section in page.sections if section.title == "From the estimate to the answer"]
        told.append([text for text in steps.paragraphs if text.startswith("Stricter, ")])
    size = safe_size(0.8 * found.build, found.sought)
    assert told == [
        [],
        [f"Stricter, whether it is a row or not: {size} between these airs (interpolated at RH 0.5: compute it)."],
    ]

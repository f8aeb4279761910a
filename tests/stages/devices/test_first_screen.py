"""The first screen of a page has one answer, which agrees with the datasets, or the warning that forbids it."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from drawn_curves import etched, law_of, rough
from test_pages import CANTILEVER, STOPPER, of_length, safe
from test_tables_budget import BUDGETS, STOPPERS, stopper_dataset

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.devices.limits import rules as limits
from stiction.report.devices import first_screen, pages, sentences
from stiction.report.format import fraction_with_band
from stiction.report.limits.words import text
from stiction.report.page import Page, Section, Summary
from stiction.report.process.section import with_process
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.devices.budget import budget_of
from stiction.stages.devices.opening import ARC, EITHER, FORCE, S_SHAPE
from stiction.stages.devices.stoppers import shares_stuck
from stiction.stages.test_beams.inference import shape_of

UNSAFE, STEEP = limits.plastic_contact(0.5, 1e8), limits.large_rotation(20e-6, 100e-6)


def least(dataset):
    """Safe length for the middle one of the shares, however the device is held [µm]."""
    return 1e6 * float(dataset.safe_length.sel(share=1e-3).min())


def test_without_a_length_the_answer_is_the_safe_length_of_the_worst_air():
    lengths = {0.44: safe(), 0.67: safe(longest=500e-6)}
    shown = first_screen.beam_screen(CANTILEVER, lengths, {}, [])
    assert (shown.tone, shown.answer) == ("good", f"Safe up to {least(lengths[0.67]):.0f} µm.")
    assert shown.points["What decides"].startswith("RH 0.67, held by the beam or tip.")
    assert any("at relative humidities of 0.44, 0.67, with 95 % confidence, from 400" in text for text in shown.basis)
    assert shown.cells["RH"].tolist() == ["0.44", "0.67"]
    assert shown.cells["safe length [µm]"].tolist() == [f"{least(one):.0f}" for one in lengths.values()]


@pytest.mark.parametrize(("length", "sign"), [(150e-6, "Safe"), (275e-6, "Not shown to be safe"), (400e-6, "Too long")])
def test_a_stated_length_is_judged_by_its_own_share(length, sign):
    dataset = of_length(length)
    shown = first_screen.beam_screen(CANTILEVER | {"length_um": 1e6 * length}, {0.67: dataset}, {}, [])
    assert shown.sign == sign
    assert f"; your {1e6 * length:g} µm: " in shown.answer
    share = dataset.stuck_at_length.sel(shape=EITHER).values
    assert f"{fraction_with_band(*share, ' %')} stick" in shown.answer
    assert shown.cells.iloc[0, -1] == fraction_with_band(*share)


def test_dry_air_is_in_words():
    forces = stopper_dataset().assign_coords(humidity=[0.0, 0.67])
    stopped = first_screen.stopper_screen(STOPPER, forces.assign(restoring_force=1e-9), {}, [])
    released = first_screen.beam_screen(CANTILEVER | {"length_um": 400}, {0.0: of_length(400e-6)}, {}, [])
    for shown in (stopped, released):
        assert shown.answer.endswith(" %) stick in dry air.")
        assert shown.points["What decides"].startswith("Dry air, ")
    assert any(text.startswith("Estimate in dry air: ") for text in released.basis)


def test_the_uncertainty_of_the_measurements_shortens_the_answer_as_in_words():
    lengths, budgets = {0.67: safe()}, {(0.67, "tip"): BUDGETS["C1", 0.67, "tip"]}
    shown = first_screen.beam_screen(CANTILEVER, lengths, budgets, [])
    (metres,) = sentences.length_to_build(lengths, budgets)[2:]
    assert 1e6 * metres < least(lengths[0.67])
    assert f"Safe up to {1e6 * metres:.0f} µm" in shown.answer
    assert f"Build it no longer than {1e6 * metres:.0f} µm" in sentences.build_sentence(lengths, budgets)
    assert shown.points["What to measure"].startswith("Measure")
    assert "uncertainty" in first_screen.beam_screen(CANTILEVER, lengths, {}, []).points["What to measure"]


@pytest.mark.parametrize("own", [None, 50.0, 400.0])
def test_measurements_that_leave_a_length_too_uncertain_allow_no_length_to_build(own):
    of_device = CANTILEVER | ({"length_um": own} if own else {})
    lengths, known = {0.67: of_length(own * 1e-6) if own else safe()}, BUDGETS["C1", 0.67, "tip"]
    budgets = {(0.67, "tip"): known.assign(covariance=known.covariance * (0.51 / budget_of(known).total) ** 2)}
    shown = first_screen.beam_screen(of_device, lengths, budgets, [])
    assert shown.answer.startswith(f"If the measurements were exact, {least(lengths[0.67]):.0f} µm would be safe.")
    assert "uncertain by 51 %" in shown.answer
    assert ("Your" in shown.answer) == bool(own)
    assert shown.sign == ("Too long" if own == 400 else "Not known")
    assert sentences.build_sentence(lengths, budgets) in shown.answer
    smaller = {(0.67, "tip"): known.assign(covariance=known.covariance * (0.49 / budget_of(known).total) ** 2)}
    assert first_screen.beam_screen(of_device, lengths, smaller, []).answer.startswith("Safe up to")


def test_the_sizes_to_change_need_the_adhesion_energy_of_the_safe_length():
    shown = first_screen.beam_screen(CANTILEVER | {"length_um": 400}, {0.67: of_length(400e-6)}, {}, [])
    thickness, gap = (float(part.split()[0]) for part in shown.points["What to change"].split(" of ")[2:])
    length = least(of_length(400e-6))

    def energy(crack, thickness, gap):
        beam = Beam(1500e-6, 30e-6, 1e-6 * thickness, 164e9, 1e-6 * gap, 200)
        return apparent_adhesion_energy(1e-6 * crack, beam)

    at_safe = energy(length, CANTILEVER["thickness_um"], CANTILEVER["gap_um"])
    np.testing.assert_allclose(energy(400, thickness, CANTILEVER["gap_um"]), at_safe, rtol=0.02)
    np.testing.assert_allclose(energy(400, CANTILEVER["thickness_um"], gap), at_safe, rtol=0.02)


def test_a_stopper_is_judged_by_the_force_that_it_needs():
    stopper = STOPPERS["S1"]
    needed = 1e6 * float(stopper.safe_force.sel(part="safe", share=sentences.bounded_share(stopper)).max())
    for force, sign in ((2 * needed, "Suffices"), (0.1 * needed, "Too weak")):
        changed = stopper.assign(restoring_force=force * 1e-6)
        shown = first_screen.stopper_screen(STOPPER, changed, {}, [])
        assert shown.sign == sign
        humidity, stuck, low, high = max(shares_stuck(changed), key=lambda row: row[1:])
        own = f"with {force:g} µN, {fraction_with_band(stuck, low, high, ' %')} stick at RH {humidity:g}"
        assert shown.answer == f"At least {needed:.3g} µN needed; {own}."


def test_a_warning_of_the_unsafe_side_stands_in_place_of_the_number():
    for shown in (
        first_screen.beam_screen(CANTILEVER, {0.67: safe()}, {}, [STEEP, UNSAFE]),
        first_screen.stopper_screen(STOPPER, STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, [UNSAFE]),
    ):
        assert (shown.tone, shown.answer, shown.basis) == ("bad", text(UNSAFE), ())
    assert "Safe up to" in first_screen.beam_screen(CANTILEVER, {0.67: safe()}, {}, [STEEP]).answer


@pytest.mark.parametrize(("p_value", "forbidden"), [(1e-5, True), (0.2, False)])
def test_test_beams_that_nothing_explains_forbid_the_number(p_value, forbidden):
    update = xr.Dataset(
        {
            "p_value": p_value,
            "result_after": ("result", [np.nan]),
            "updated_safe": (("share", "humidity"), np.full((3, 1), 1e-4)),
        },
        {"humidity": [0.67]},
    )
    found = [] if tables_test_beams.is_reliable(update) else [tables_test_beams.contradiction(update)]
    for shown in (
        first_screen.beam_screen(CANTILEVER, {0.67: safe()}, {}, found, update),
        first_screen.stopper_screen(STOPPER, STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, found, update),
    ):
        assert (shown.sign == "Do not rely on a number") == forbidden
        assert ("rely neither on the update" in shown.answer) == forbidden


def updated_by_tests(responses, sizes, updated, p_value=0.2):
    """Update of two results by test beams, with sizes by share before and after it [m, N]."""
    shapes = list(map(shape_of, responses))
    before, shift, after = np.array([0.2, 0.1]), np.array([0.05, -0.02]), np.array([0.1, 0.04])
    number = len(responses)
    sized = {"safe": sizes, "updated_safe": updated}
    return xr.Dataset(
        {
            "p_value": p_value,
            "response": ("result", list(responses)),
            "result_before": ("result", before[:number]),
            "result_shift": ("result", shift[:number]),
            "result_after": ("result", after[:number]),
            "result_quantile": (("result", "score"), (shift[:, None] + np.outer(after, [-2, 0, 2]))[:number]),
            "measured": ("datum", [np.nan]),
            "stuck": ("count", []),
            **{name: (("share", "shape", "humidity"), np.array(values)) for name, values in sized.items()},
        },
        {"share": [0.01, 0.001, 0.0001], "shape": shapes, "humidity": [0.67], "score": [-2, 0, 2]},
    )


def of_tested_beam(p_value=0.2):
    sizes = 1e-6 * np.array([[[250.0], [600.0]], [[244.0], [590.0]], [[240.0], [580.0]]])
    return updated_by_tests([ARC, S_SHAPE], sizes, 1.02 * sizes, p_value)


def of_tested_stopper(p_value=0.2):
    sizes = 1e-6 * np.array([[[30.0]], [[40.0]], [[50.0]]])
    return updated_by_tests([FORCE], sizes, 0.9 * sizes, p_value)


def screens_with(update_of_beam, update_of_stopper):
    """First screens of a beam and of a stopper, with their test beams."""
    budget = {(0.67,): BUDGETS["S1", 0.67]}
    return (
        first_screen.beam_screen(CANTILEVER, {0.67: safe()}, {}, [], update_of_beam),
        first_screen.stopper_screen(STOPPER, STOPPERS["S1"], budget, [], update_of_stopper),
    )


def test_the_answer_of_a_device_with_test_beams_is_the_one_that_they_give():
    beam, stopper = screens_with(of_tested_beam(), of_tested_stopper())
    after, before = 1.02 * 244 * np.exp(-0.2), 244 * np.exp(-0.4)
    assert beam.answer == f"Safe up to {after:.0f} µm."
    assert beam.basis[-1].endswith(f"Without the test beams: {before:.0f} µm.")
    assert beam.cells["with test beams [µm]"].tolist() == [f"{after:.0f}"]
    after, before = 0.9 * 40 * np.exp(0.2), 40 * np.exp(0.4)
    assert stopper.answer.startswith(f"At least {after:.3g} µN needed; ")
    assert stopper.basis[-1].endswith(f"Without the test beams: {before:.3g} µN.")


@pytest.mark.parametrize("update", [of_tested_beam, of_tested_stopper])
def test_every_place_states_the_answer_with_test_beams(update):
    (number,) = re.findall(r"(\d+ µ[mN])\.$", tables_test_beams.beside_numbers(update()))
    assert number in tables_test_beams.sizes_to_build(update())
    screens = screens_with(of_tested_beam(), of_tested_stopper())
    assert number in screens[update is of_tested_stopper].answer
    assert tables_test_beams.beside_numbers(update(p_value=1e-5)) is None
    assert tables_test_beams.beside_numbers(None) is None


def test_no_sentence_of_a_page_with_test_beams_states_the_answer_without_them(monkeypatch):
    monkeypatch.setattr(pages, "_test_beam_sections", lambda name, update: [])
    monkeypatch.setattr(tables_test_beams, "warnings", lambda update: [])
    lengths = {0.67: safe()}
    warned = {("C1", 0.67, str(shape)): [] for shape in lengths[0.67]["shape"].values}
    with_them = pages.beam_page("C1", CANTILEVER, lengths, {}, {}, warned, of_tested_beam())
    without = pages.beam_page("C1", CANTILEVER, lengths, {}, {}, warned)
    own = sentences.build_sentence(lengths, {})
    assert own in without.lines
    assert own not in with_them.lines
    assert with_them.lines[1] == tables_test_beams.sizes_to_build(of_tested_beam())
    stopped = pages.stopper_page("S1", STOPPER, STOPPERS["S1"], {}, [], of_tested_stopper())
    assert sentences.verdict(STOPPERS["S1"], {}) not in stopped.lines
    assert tables_test_beams.sizes_to_build(of_tested_stopper()) in stopped.lines


TIPS = {(0.67, "tip"): BUDGETS["C1", 0.67, "tip"]}


def beam(kind, warnings, **given):
    """Page of a cantilever or bridge of a length that is too long, with a warning about all shapes."""
    own = {"length_um": 800} if kind == "cantilever" else {"residual_stress_MPa": 10}
    section = CANTILEVER | {"kind": kind} | own
    lengths = {rh: of_length(800e-6) if kind == "cantilever" else safe("bridge") for rh in (0.44, 0.67)}
    shapes = lengths[0.67]["shape"].values
    said = {("C1", humidity, str(shape)): warnings for humidity in lengths for shape in shapes}
    return pages.beam_page("C1", section, lengths, {}, TIPS if kind == "cantilever" else {}, said, **given)


def stopper(warnings, **given):
    """Page of a stopper."""
    return pages.stopper_page("S1", STOPPER, STOPPERS["S1"], {(0.67,): BUDGETS["S1", 0.67]}, warnings, **given)


def processed(warnings):
    """Page of a stopper over a process."""
    curve, settings = etched()
    data = {"process": curve, "process_settings": settings, "process_laws": [law_of()]}
    return with_process(stopper(warnings), "D", data)


KINDS = {
    "cantilever": lambda warnings: beam("cantilever", warnings),
    "bridge": lambda warnings: beam("bridge", warnings),
    "stopper": stopper,
    "roughness": lambda warnings: stopper(warnings, roughness=rough()),
    "process": processed,
}


@pytest.mark.parametrize("kind", [pytest.param(kind, marks=[pytest.mark.slow] * (kind != "bridge")) for kind in KINDS])
def test_the_warning_that_forbids_a_number_stands_in_the_place_of_all_numbers_in_words(kind):
    open_, shut = (replace(KINDS[kind](one), more=["More."], explorer={"name": kind}) for one in ([STEEP], [UNSAFE]))
    assert len(open_.lines) > 1
    assert shut.summary.answer.endswith(text(UNSAFE))
    assert shut.lines == [f"Do not rely on a number: {shut.summary.answer}"]
    assert (open_.controls["forbidden"], shut.controls["forbidden"]) == ("", shut.lines[0])
    numbers = shut.summary.cells.iloc[:, 1:]
    assert numbers.size
    assert (numbers == "–").all(axis=None)
    first = shut.html.partition('class="answer')[2].partition('class="device"')[0]
    assert "– means no number: the warning above forbids to rely on one." in first
    assert not re.findall(r"\d µ[mN]", re.sub(r"<th>[^<]*</th>", "", first))
    assert ("What to change" in open_.summary.points, "What to change" in shut.summary.points) == (True, False)
    assert ("More in words" in open_.html, "More in words" in shut.html) == (True, False)


def test_a_number_comes_with_the_error_of_the_model_or_says_that_it_is_not_stated():
    for warnings, number in (([], 1), ([UNSAFE], 0)):
        shown = {("C1", 0.67, shape): warnings for shape in (S_SHAPE, EITHER)}
        page = pages.beam_page("C1", CANTILEVER, {0.67: safe()}, {}, {}, shown)
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
    shown = first_screen.beam_screen(CANTILEVER, {0.67: dataset}, {}, [])
    without_tip = 1e6 * float(dataset.safe_length.sel(share=1e-3, shape=S_SHAPE))
    assert f"If the tip could not touch: {without_tip:.0f} µm." in shown.points["What decides"]
    assert shown.cells["if the tip cannot touch [µm]"].tolist() == [f"{without_tip:.0f}"]


# Margins of stoppers


@pytest.mark.parametrize("factor", [0.1, 0.5, 1.0, 10.0, 40.0])
def test_a_stopper_suffices_with_twice_the_uncertainty_of_its_measurements_as_a_beam_is_safe(factor):
    known = BUDGETS["S1", 0.67]
    budgets = {(0.67,): known.assign(covariance=known.covariance * factor**2)}
    total, share = budget_of(budgets[0.67,]).total, sentences.bounded_share(STOPPERS["S1"])
    least = float(STOPPERS["S1"].safe_force.sel(part="safe", share=share).max())
    for by in (0.5, 0.99, 1.01, np.exp(2 * total) * 0.99, np.exp(2 * total) * 1.01, 100.0):
        stopper = STOPPERS["S1"].assign(restoring_force=by * least)
        shown = first_screen.stopper_screen(STOPPER, stopper, budgets, [])
        said = sentences.verdict(stopper, budgets)
        # A second route: the needed force, whose logarithm errs by the total, is exceeded by two standard errors.
        enough = sentences.is_bounded(total) and (np.log(by) - 0.0) / total >= 2
        assert (shown.sign == "Suffices") == enough
        assert ("suffices" in said) == enough
        assert ("exact" in shown.answer) == ("exact" in said) == (by > 1 and total > sentences.LARGEST) or by < 1
        # Without the margin, forces in between would suffice: the rule makes a difference.
        bare = first_screen.stopper_screen(STOPPER, stopper, {}, [])
        assert (bare.sign == "Suffices") == (by >= 1)


def test_what_decides_a_stopper_is_the_air_of_the_largest_force_in_its_table():
    for humidities in ([0.0, 0.67], [0.67, 0.0]):
        forces = stopper_dataset().assign_coords(humidity=humidities)
        for force in (1e-9, 19e-6, 1.0):
            stopper = forces.assign(restoring_force=force)
            shown = first_screen.stopper_screen(STOPPER, stopper, {}, [])
            column = shown.cells.iloc[:, -1].astype(float)
            worst = shown.cells.RH[column.idxmax()]
            assert shown.points["What decides"].startswith("Dry air, " if worst == "dry" else f"RH {worst}, ")

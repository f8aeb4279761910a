"""Warnings of a page hold for the shortest length that it states: to build, or the device's own."""

from dataclasses import replace

import answered
import numpy as np
import pytest
from answers import BRIDGE, CANTILEVER, TIPS, beam_page, budget_dataset, least, safe, silent

from stiction.devices.limits import rules as limits
from stiction.report.devices import sentences, warnings_page
from stiction.report.format import bounding
from stiction.report.limits import pages
from stiction.report.limits.words import lines_with_numbers, text, texts
from stiction.stages.answer.answer import layout


def steepest(gap, arm):
    """Largest slope of a clamped beam that has reached the ground without a slope, by differences of its deflection."""
    x = np.linspace(0, 1, 20001)
    return np.abs(np.diff(gap * (3 * x**2 - 2 * x**3))).max() / (arm * np.diff(x)[0])


@pytest.mark.parametrize(("section", "arms"), [(CANTILEVER, 1), (BRIDGE, 2)])
def test_a_length_to_build_with_a_slope_beyond_the_linear_theory_is_flagged(section, arms):
    flagged = []
    for longest in np.geomspace(200e-6, 3000e-6, 8):
        lengths = {0.67: safe(section["kind"], longest)}
        for factor in (0.5, 0.9, 0.99):
            built = factor * least(lengths[0.67])
            answer = replace(answered.of_beam(lengths, kind=section["kind"]), build=built)
            said = [one for one in texts(sentences.shortest_warnings(section, answer)) if "slope" in one]
            slope = steepest(20e-6, built / arms)
            assert bool(said) == (slope > limits.ROTATION)
            assert all(
                f"a slope of {slope:.3g}" in one and f"of {bounding(built / arms * 1e6, 3, up=False)} µm" in one
                for one in said
            )
            flagged += [steepest(20e-6, built / factor / arms) > limits.ROTATION for _ in said]
    assert not all(flagged), "the control: at the simulated limit itself some would have no flag"


def test_the_length_of_the_device_counts_if_it_is_shorter():
    lengths = {0.67: safe(longest=900e-6)}
    limit = least(lengths[0.67])
    answer = replace(answered.of_beam(lengths), build=limit)
    assert sentences.shortest_warnings(CANTILEVER, answer) == []
    (said, *_) = sentences.shortest_warnings(CANTILEVER | {"length_um": 0.2e6 * limit}, answer)
    assert f"slope of {steepest(20e-6, 0.2 * limit):.3g}" in text(said)


def test_the_page_of_a_device_lists_them():
    tip = budget_dataset(2, TIPS)
    page = beam_page(
        CANTILEVER, {0.67: safe(longest=400e-6)}, {(0.67, "tip"): tip.assign(covariance=9 * tip.covariance)}
    )
    built = float(page.summary.answer.split()[3])
    slopes = [
        float(found)
        for one in page.warnings
        for found in [one.partition("a slope of ")[2].split(",")[0].split()[0]]
        if "a slope of" in one
    ]
    assert any(abs(slope / steepest(20e-6, 1e-6 * built) - 1) < 0.01 for slope in slopes)


def test_a_length_to_build_shares_the_line_of_other_steep_lengths_and_is_named():
    steepest_of_chart, built = (limits.large_rotation(20e-6, length) for length in (171e-6, 200e-6))
    chart = {"chart": [steepest_of_chart], "other": [limits.large_rotation(20e-6, 180e-6)]}
    (line,) = lines_with_numbers(chart, [built])
    others = "This is the worst of 3. At 200 µm (the device itself) the slope is 0.15."
    assert line == f"(1) and (2) {text(steepest_of_chart)} {others}"
    assert lines_with_numbers(chart, [steepest_of_chart]) == lines_with_numbers(chart), "it has a number"
    assert lines_with_numbers({}, [built]) == [text(built)]
    (named,) = lines_with_numbers(chart, [built], {steepest_of_chart: "C1, chart, 2 µm thick", built: "no"})
    assert named == line.replace("(2) At", "(2) C1, chart, 2 µm thick: At")
    (worse,) = lines_with_numbers({"chart": [built]}, [steepest_of_chart])
    assert worse == f"(1) {text(steepest_of_chart)} This is the worst of 2.", "the worst is in the sentence"


def test_the_index_and_the_last_lines_count_the_warnings_of_the_page():
    lengths = {0.67: safe(longest=400e-6)}
    built = replace(answered.of_beam(lengths), build=0.5 * least(lengths[0.67]))
    page = beam_page(CANTILEVER, lengths, answer=built)
    of_model = warnings_page.together(silent(lengths), {})
    counted = of_model | warnings_page.of_lengths({"C1": CANTILEVER}, {"C1": layout(built)})
    assert len(pages.by_limit(counted)) == len(page.warnings) > len(pages.by_limit(of_model))

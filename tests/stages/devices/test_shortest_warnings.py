"""Warnings of a page hold for the shortest length that it states: to build, with test beams, or the device's own."""

import itertools

import numpy as np
import pytest
from answers import CANTILEVER, TIPS, budget_dataset, safe

from stiction.devices.limits import rules as limits
from stiction.report.devices import pages, sentences
from stiction.report.limits.words import text, texts
from stiction.stages.devices.opening import EITHER, S_SHAPE

SILENT = {("C1", 0.67, shape): [] for shape in (S_SHAPE, EITHER)}
BRIDGE = CANTILEVER | {"kind": "bridge", "residual_stress_MPa": 50}


def steepest(gap, arm):
    """Largest slope of a clamped beam that has reached the ground without a slope, by differences of its deflection."""
    x = np.linspace(0, 1, 20001)
    return np.abs(np.diff(gap * (3 * x**2 - 2 * x**3))).max() / (arm * np.diff(x)[0])


@pytest.mark.parametrize(("section", "arms"), [(CANTILEVER, 1), (BRIDGE, 2)])
def test_a_length_to_build_with_a_slope_beyond_the_linear_theory_is_flagged(section, arms):
    flagged = []
    for factor, longest in itertools.product((0.5, 5, 15, 100), np.geomspace(200e-6, 3000e-6, 8)):
        lengths = {0.67: safe(section["kind"], longest)}
        budgets = {(0.67, *["tip"] * (arms == 1)): budget_dataset(factor, TIPS)}
        least, total, built = sentences.length_to_build(lengths, budgets)
        said = [one for one in texts(sentences.shortest_warnings(section, lengths, budgets)) if "slope" in one]
        slope = steepest(20e-6, built / arms)
        assert bool(said) == (sentences.is_bounded(total) and slope > limits.ROTATION)
        assert all(f"a slope of {slope:.3g}" in one and f"of {built / arms * 1e6:.0f} µm" in one for one in said)
        flagged += [steepest(20e-6, least / arms) > limits.ROTATION for _ in said]
    assert not all(flagged), "the control: at the safe length itself some would have no flag"


def test_a_shorter_length_with_test_beams_or_of_the_device_counts():
    lengths = {0.67: safe(longest=900e-6)}
    least, _, _ = sentences.length_to_build(lengths, {})
    assert sentences.shortest_warnings(CANTILEVER, lengths, {}) == []
    for said in (
        sentences.shortest_warnings(CANTILEVER, lengths, {}, 0.2 * least),
        sentences.shortest_warnings(CANTILEVER | {"length_um": 0.2e6 * least}, lengths, {}),
    ):
        assert f"slope of {steepest(20e-6, 0.2 * least):.3g}" in text(said[0])


def test_the_page_of_a_device_lists_them():
    lengths, budgets = {0.67: safe(longest=400e-6)}, {(0.67, "tip"): budget_dataset(15, TIPS)}
    (said, *_) = sentences.shortest_warnings(CANTILEVER, lengths, budgets)
    assert text(said) in pages.beam_page("C1", CANTILEVER, lengths, {}, budgets, SILENT).warnings

"""Scripts of the examples that compare the paper's statements and its printed table with this tool."""

import numpy as np
import pandas as pd
import pytest
from configurations import ROOT, module
from numpy.testing import assert_allclose

import stiction
from stiction.config.merging import merged
from stiction.plan.plan import Plan

supplement, compare_print = (module(ROOT / "examples" / f"{name}.py") for name in ("supplement", "compare_print"))
CONFIG = stiction.load()


@pytest.mark.slow
def test_neighbouring_strips_are_the_less_correlated_the_longer_they_are():
    short, long = (supplement.surfaces(CONFIG, (length, 30e-6))["neighbouring strips"] for length in (0.15e-6, 1.5e-6))
    assert (long < short / 3).all()
    assert (short > 0.04).all()
    assert (short < 1).all()


def test_correlation_lengths_are_those_of_the_docs():
    known = pd.read_csv(ROOT / "docs" / "tables" / "studies.csv").set_index("name").text
    found = supplement.surfaces(CONFIG)
    for row in found.to_dict("records"):
        assert_allclose(row["correlation length [µm]"], float(known[f"correlation_{row['surface']}"]), atol=0.006)


def table(factor=1.0, model_std=5.0):
    """Rows of Table III: published lengths times a factor."""
    rows = pd.DataFrame({"pair": ["a", "a", "b"], "relative_humidity": [0.45, 0.6, 0.44]})
    rows = rows.assign(published_um=[716.0, 569.0, 1031.0], published_std_um=10.0, experiment_um=700.0)
    rows = rows.assign(crack_length_um=factor * rows.published_um, crack_length_std_um=model_std)
    rows = rows.assign(crack_length_se_um=1.0, model="NG")
    gaussian = rows.assign(model="G", published_um=np.nan)
    return pd.concat([rows, gaussian], ignore_index=True)


def test_both_readings_are_compared_with_print_case_by_case():
    cases = compare_print.compared(table(0.9), table(1.02, model_std=20.0))
    assert set(cases.model) == {"NG"}
    assert_allclose(cases.base_deviation_percent, -10)
    assert_allclose(cases.print_deviation_percent, 2)
    assert_allclose(cases.print_scatter_ratio, 2)
    text = compare_print.by_pair(cases)
    assert text.count(" -10.0 |") == 2
    assert text.count("+2.0") == 2


@pytest.mark.parametrize("pair", ["a", "b", "c"])
def test_the_baseline_has_the_roughness_of_both_surfaces(pair):
    rougher = merged(CONFIG, {"surfaces": {"Sub1": {"rms_nm": 1.6}, "Sub2": {"rms_nm": 55}}})
    before, after = (supplement.summits(Plan(config), pair) for config in (CONFIG, rougher))
    assert after.rms > 1.1 * before.rms
    assert after.density == before.density

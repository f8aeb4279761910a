"""Table of the fit by Eq. (12)."""

import numpy as np
import pytest

from stiction.report.beams.tables import fit_quality
from stiction.stages.laws import fit as study_fit


@pytest.fixture
def table():
    curve = np.linspace(0.01, 0.21, 101)
    fit = study_fit.layout(np.arange(101), (curve, np.full(101, 1e-16)), 125)
    return fit_quality({("b", 0.67, "NG"): fit})


def test_errors_are_percent_with_their_standard_error(table):
    (row,) = table.frame.to_dict("records")
    assert (row["pair"], row["relative_humidity"], row["model"], row["samples"]) == ("b", 0.67, "NG", 101)
    assert row["curve_error_percent"] == pytest.approx(11)
    assert row["curve_error_median_percent"] == pytest.approx(11)
    assert row["curve_error_95_percent"] == pytest.approx(20)
    # n equally spaced numbers in a range r have the variance r² n (n + 1) / 12 / (n - 1)².
    assert row["curve_error_se_percent"] == pytest.approx(20 * np.sqrt(102 / 12) / 100)
    assert row["energy_error_max_percent"] == pytest.approx(1e-14)


def test_samples_without_a_law_are_counted_not_averaged(table):
    assert table.frame.share_without_law[0] == pytest.approx(24 / 125)


@pytest.mark.parametrize("samples", [0, 1])
def test_fewer_than_two_samples_with_a_law_have_no_errors(samples):
    few = study_fit.layout(np.arange(samples), (np.full(samples, 0.1), np.full(samples, 1e-16)), 125)
    table = fit_quality({("b", 0.67, "NG"): few})
    (row,) = table.frame.to_dict("records")
    assert row["samples"] == samples
    assert row["share_without_law"] == pytest.approx(1 - samples / 125)
    assert all(np.isnan(number) for name, number in row.items() if "_error_" in name)
    assert table.cells["curve [%]"].item() == table.cells["ē at most [%]"].item() == "–"


def test_markdown_describes_the_numbers(table):
    text = table.markdown
    assert "11.00 ± 0.58" in text
    assert "d ≥ d_limit" in text.splitlines()[0]

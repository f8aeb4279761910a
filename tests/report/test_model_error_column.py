"""The error of the model beside a prediction."""

import numpy as np
import pytest
import xarray as xr

from stiction.report.model_error import column


def error(factor=1.1, interpolated=False, applied=False):
    return xr.Dataset(
        {
            "length_factor": factor,
            "length_factor_error": 0.004,
            "force_factor": 0.8,
            "force_factor_error": 0.02,
            "interpolated": interpolated,
            "applied": ("humidity", [applied]),
        }
    )


def test_a_change_is_the_factor_less_one_in_percent():
    found = column.change(error(interpolated=True))
    assert found["model_error_percent"] == pytest.approx(10)
    assert found["model_error_se_percent"] == pytest.approx(0.4)
    assert found["interpolated"] is True
    assert column.change(error(), "force_factor")["model_error_percent"] == pytest.approx(-20)
    assert column.change(error(1.0))["model_error_percent"] == 0


def test_an_unknown_error_is_no_error_of_zero():
    found = column.change(None)
    assert np.isnan(found["model_error_percent"])
    assert column.marked_change(*found.values()) == "–"


@pytest.mark.parametrize(
    ("applied", "words"),
    [
        ((True, True), "has changed what is stated, ±"),
        ((False, False), "would change what is stated, ±"),
        ((True, False), "has changed what is stated in dry air, and would change it in humid air, ±"),
    ],
)
def test_the_caption_says_whether_it_is_in_the_prediction(applied, words):
    caption = str(column.caption({str(k): error(applied=flag) for k, flag in enumerate(applied)}))
    assert words in caption
    assert ("bounds contain its standard error" in caption) == any(applied)

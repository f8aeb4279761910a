"""A case has one name and the name one case; files change single keys."""

import copy
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from snakemake.utils import update_config

from stiction.config.cases import case_id, humidity_of, merged, pair_of


@pytest.mark.parametrize(
    ("humidity", "case"),
    [(0.67, "b_rh067"), (0.6, "b_rh060"), (0.675, "b_rh0675"), (0.0675, "b_rh00675"), (0.0001, "b_rh00001")],
)
def test_a_case_is_named_after_its_pair_and_the_decimals_of_its_humidity(humidity, case):
    assert case_id("b", humidity) == case
    assert (pair_of(case), humidity_of(case)) == ("b", humidity)


@given(st.integers(1, 9999))
def test_every_humidity_of_four_decimals_survives_its_name(tenthousandths):
    humidity = tenthousandths / 10000
    assert humidity_of(case_id("b", humidity)) == humidity


@pytest.mark.parametrize("humidity", [0, 1, -0.5, 0.67512, 0.1 + 0.2, 1e-5, math.nan, 67])
def test_a_humidity_that_no_case_can_be_named_after_is_refused(humidity):
    with pytest.raises(ValueError, match="must be above 0, below 1 and have at most 4 decimals"):
        case_id("b", humidity)


@pytest.mark.parametrize(
    "case", ["b_rh000", "b_rh0600", "b_rh06", "b_rh067512", "b_rh167", "_rh067", "b_rh067\n", "b_rh0٦٧", "rh067", ""]
)
def test_what_is_no_case_has_no_humidity(case):
    with pytest.raises(ValueError, match="must be like b_rh067"):
        humidity_of(case)


@given(*[st.recursive(st.integers(), lambda inner: st.dictionaries(st.sampled_from("abc"), inner, min_size=1))] * 2)
def test_files_are_merged_as_snakemake_does(base, overlay):
    merging = {"root": copy.deepcopy(base)}
    update_config(merging, {"root": overlay})
    assert merged({"root": base}, {"root": overlay}) == merging

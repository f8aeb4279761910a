"""Cases and their names correspond one to one."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.config.cases import CASE, PAIR_IN_AIR, Case, PairInAir, case_id, in_numbers


@pytest.mark.parametrize(
    ("humidity", "case"),
    [(0.67, "b_rh067"), (0.6, "b_rh060"), (0.675, "b_rh0675"), (0.0675, "b_rh00675"), (0.0001, "b_rh00001")],
)
def test_a_case_is_named_after_its_pair_and_the_decimals_of_its_humidity(humidity, case):
    assert case_id("b", humidity) == case
    assert (Case(case).pair, Case(case).humidity) == ("b", humidity)


@pytest.mark.parametrize("name", ["b", "Mine2", "rh0"])
def test_the_pair_of_a_case_may_have_any_name(name):
    assert case_id(name, 0.67).pair == case_id(name, 0.67).device == name


@given(st.integers(1, 9999))
def test_every_humidity_of_four_decimals_is_recovered_from_its_case_name(tenthousandths):
    humidity = tenthousandths / 10000
    assert case_id("b", humidity).humidity == humidity


@pytest.mark.parametrize("humidity", [1, -0.5, 0.67512, 0.1 + 0.2, 1e-5, math.nan, 67, "wet", None, [0.67]])
def test_a_humidity_without_a_valid_case_name_is_rejected(humidity):
    with pytest.raises(ValueError, match="must be dry, or above 0, below 1 and have at most 4 decimals"):
        case_id("b", humidity)


@pytest.mark.parametrize("name", ["b", "Mine2", "dry"])
def test_the_case_of_dry_air_has_the_humidity_zero_and_the_name_of_its_contact(name):
    assert case_id(name, "dry") == case_id(name, 0.0) == PairInAir.in_dry_air(name)
    assert (case_id(name, 0).pair, case_id(name, 0).humidity) == (name, 0.0)
    assert PairInAir.in_dry_air(name).pair == PairInAir(name).pair == name
    assert re.fullmatch(PAIR_IN_AIR, PairInAir.in_dry_air(name))
    assert re.fullmatch(CASE, PairInAir.in_dry_air(name))
    for contact in (PairInAir(name), PairInAir.in_dry_air(name)):
        assert (contact.pair, contact.pair + contact.ending) == (name, contact)


def test_the_word_dry_stands_for_the_number_zero_where_a_humidity_stands_and_nowhere_else():
    config = {
        "figures": {"humidity": "dry", "pair": "dry"},
        "pairs": {"dry": {"beam": "dry", "humidities": ["dry", 0.45]}},
        "test_beams": {"T": {"crack_lengths": [{"humidity": "dry", "mean_um": 700}]}},
        "van_der_waals": "dry",
    }
    numbers = in_numbers(config)
    assert numbers["figures"] == {"humidity": 0.0, "pair": "dry"}
    assert numbers["pairs"] == {"dry": {"beam": "dry", "humidities": [0.0, 0.45]}}
    assert numbers["test_beams"]["T"]["crack_lengths"] == [{"humidity": 0.0, "mean_um": 700}]
    assert numbers["van_der_waals"] == "dry"
    assert in_numbers(numbers) == numbers


@pytest.mark.parametrize(
    "case",
    [
        "b_rh000",
        "b_rh0600",
        "b_rh067_dry",
        "_dry",
        "b_dry\n",
        "dry",
        "b_dry_dry",
        "b_rh06",
        "b_rh067512",
        "b_rh167",
        "_rh067",
        "b_rh067\n",
        "b_rh0٦٧",
        "rh067",
        "",
    ],
)
def test_an_invalid_case_name_is_rejected(case):
    with pytest.raises(ValueError, match="must be like b_rh067"):
        Case(case).humidity  # noqa: B018

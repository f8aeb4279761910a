"""Numbers that a pilot decides are the same after they were kept in a file."""

import json

import pytest

from stiction.config.cases import case_id
from stiction.plan.numbers import Numbers


@pytest.mark.parametrize("numbers", [Numbers(0.03, 400, {"b_1500x3000": 90}, {case_id("C1", 0.88): 0.05}), None])
def test_numbers_survive_json(numbers):
    again = Numbers.from_plain(json.loads(json.dumps(numbers and numbers.plain)))
    assert again == numbers
    assert str(again) == str(numbers)  # which asks a case for its device and air

import re
from pathlib import Path

import pytest

import stiction
from stiction.rounding import grouped, in_percent, is_multiple


@pytest.mark.parametrize(("whole", "part"), [(0.3, 0.1), (1500e-6, 7.5e-6), (1.0, 1.0)])
def test_a_multiple_is_one_up_to_rounding(whole, part):
    assert is_multiple(whole, part)


@pytest.mark.parametrize(("whole", "part"), [(1.0, 0.4), (1.0, 0.999), (1e-12, 1.0), (0.1, 0.3)])
def test_other_lengths_and_parts_longer_than_the_whole_are_no_multiples(whole, part):
    assert not is_multiple(whole, part)


@pytest.mark.parametrize("share", [0.0, 0.00123, 0.0994, 0.9949, 0.995, 0.9999, 1.0, 3.47, 1234.5])
def test_percentages_have_two_digits_or_more_and_no_power_of_ten(share):
    number, unit = in_percent(share).split()
    assert unit == "%"
    assert "e" not in number
    assert float(number) == pytest.approx(100 * share, rel=0.05)


def test_thousands_are_in_groups_from_five_digits_on():
    assert [grouped(number) for number in (1, 1000, 9999, 10_000, 123456.7)] == [
        "1",
        "1000",
        "9999",
        "10 000",
        "123 457",
    ]


def test_sentences_state_no_percentage_by_two_digits_alone():
    """Two digits make 1e+02 % of 99.7 %."""
    sources = {path: path.read_text(encoding="utf-8") for path in Path(stiction.__file__).parent.rglob("*.py")}
    found = {path.name: re.findall(r"[^\n]*:\.2g\} %[^\n]*", text) for path, text in sources.items()}
    assert {name: lines for name, lines in found.items() if lines} == {
        "rounding.py": ['    return f"{value:.2g} %" if abs(value) < 99.5 else f"{value:.0f} %"']
    }

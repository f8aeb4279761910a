import pytest

from stiction.rounding import is_multiple


@pytest.mark.parametrize(("whole", "part"), [(0.3, 0.1), (1500e-6, 7.5e-6), (1.0, 1.0)])
def test_a_multiple_is_one_up_to_rounding(whole, part):
    assert is_multiple(whole, part)


@pytest.mark.parametrize(("whole", "part"), [(1.0, 0.4), (1.0, 0.999), (1e-12, 1.0), (0.1, 0.3)])
def test_other_lengths_and_parts_longer_than_the_whole_are_no_multiples(whole, part):
    assert not is_multiple(whole, part)

"""Power laws of the sorted lengths of beams of many sizes."""

from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

from stiction.devices import sizes

UM = 1e-6
THICKNESSES, GAPS = (1 * UM, 2 * UM, 4 * UM), (5 * UM, 10 * UM, 20 * UM)


def lengths(thickness, gap, bend=0.0, number=200):
    """Lengths of beams, whose short end follows another power than the long one; a bend in the middle of the axes."""
    scores = np.random.default_rng(1).permutation(np.linspace(-2, 2, number))
    of_bend = bend * (np.log(thickness / THICKNESSES[0]) * np.log(thickness / THICKNESSES[-1]))
    return 1e3 * UM * (thickness / UM) ** (0.75 + 0.01 * scores) * (gap / UM) ** 0.49 * np.exp(0.05 * scores + of_bend)


@pytest.mark.parametrize("gaps", [GAPS, GAPS[:1]], ids=["both", "thickness"])
def test_lengths_that_follow_power_laws_are_found_at_every_size(gaps):
    law = sizes.fitted(THICKNESSES, gaps, [lengths(*size) for size in product(THICKNESSES, gaps)])
    assert law.holds
    assert law.error < 1e-12
    for size in product((1.3 * UM, 3.9 * UM), gaps[:2]):
        assert_allclose(law.lengths(*size), np.sort(lengths(*size)), rtol=1e-9)


def test_lengths_between_others_are_shortened_by_what_the_laws_err_at_sizes_not_used():
    law = sizes.fitted(THICKNESSES, GAPS, [lengths(*size, bend=0.01) for size in product(THICKNESSES, GAPS)])
    bend = 0.01 * np.log(2) ** 2
    assert law.holds
    assert_allclose((law.error, law.excess), bend, rtol=1e-6)
    for size in product(THICKNESSES, GAPS):
        found, true = law.lengths(*size), np.sort(lengths(*size, bend=0.01))
        assert np.all(found < true)
        assert np.all(found > (1 - 1.1 * bend) * true)


def test_lengths_are_not_shortened_where_the_laws_are_too_short():
    law = sizes.fitted(THICKNESSES, GAPS, [lengths(*size, bend=-0.01) for size in product(THICKNESSES, GAPS)])
    assert law.excess < 1e-9
    assert_allclose(law.error, 0.01 * np.log(2) ** 2, rtol=1e-6)
    assert_allclose(law.lengths(1 * UM, 5 * UM), np.sort(lengths(1 * UM, 5 * UM)), rtol=1e-9)


def test_laws_do_not_hold_where_they_err_too_much_or_a_length_is_not_known():
    bent = [lengths(*size, bend=0.05) for size in product(THICKNESSES, GAPS)]
    assert not sizes.fitted(THICKNESSES, GAPS, bent).holds
    unknown = [lengths(*size) for size in product(THICKNESSES, GAPS)]
    unknown[4][7] = np.inf
    assert not sizes.fitted(THICKNESSES, GAPS, unknown).holds


def test_the_short_end_counts_by_itself():
    """A law that is right on average and wrong where safe lengths are does not hold."""
    known = {size: np.sort(lengths(*size)) for size in product(THICKNESSES, GAPS)}
    changed = known[2 * UM, 10 * UM]
    changed[:10] *= 0.97
    law = sizes.fitted(THICKNESSES, GAPS, list(known.values()))
    assert abs(np.log(changed / np.sort(lengths(2 * UM, 10 * UM))).mean()) < 0.002
    assert_allclose(law.error, -np.log(0.97), rtol=1e-6)
    assert not law.holds

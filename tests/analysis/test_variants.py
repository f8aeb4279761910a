import numpy as np
import pytest
from numpy.testing import assert_allclose
from standard_errors import ALLOWED

from stiction.analysis import variants
from stiction.streams import stream

SAMPLES, BEAMS = 60, 40


def variant(rng, noise, factor=1.0):
    """A case with crack lengths l ~ ē^(-1/4); ``noise`` is common to the compared cases."""
    pool, place = noise
    energy = factor * 1e-2 * np.exp(0.4 * pool + 0.05 * rng.standard_normal(SAMPLES))
    crack = 7e-4 * (energy.mean() / 1e-2) ** -0.25 * (1 + 0.02 * place + 0.01 * rng.standard_normal(BEAMS))
    return variants.Variant(energy, crack, np.ones(BEAMS, bool))


def compared(k):
    """Two variants, the second with 1.2 times the energy, on common random numbers."""
    rng = stream(1, k)
    noise = rng.standard_normal(SAMPLES), rng.standard_normal(BEAMS)
    return variant(rng, noise), variant(rng, noise, 1.2)


def rms_deviation(variant):
    """Deviation of one crack length from a reference."""
    length, *errors = variants.crack_length_with_errors(variant)
    return variants.rms_deviation([length], *np.reshape(errors, (2, 1)), np.array([6e-4]))


def scatter(estimate):
    """Standard deviation over repeated studies and the mean of their standard errors."""
    values, errors = np.transpose([np.ravel(estimate(*compared(k))) for k in range(200)])
    return values.std(ddof=1), errors.mean()


@pytest.mark.parametrize("estimate", [variants.shift, variants.energy_shift])
def test_standard_errors_of_a_comparison_are_the_scatter_of_repeated_studies(estimate):
    spread, stated = scatter(estimate)
    assert spread == pytest.approx(stated, rel=ALLOWED / np.sqrt(2 * 199))


@pytest.mark.parametrize("estimate", [variants.mean_crack_length, rms_deviation])
def test_standard_errors_of_a_variant_are_the_scatter_of_repeated_studies(estimate):
    spread, stated = scatter(lambda base, _: estimate(base))
    assert spread == pytest.approx(stated, rel=ALLOWED / np.sqrt(2 * 199))


def test_shifts_are_recovered():
    pairs = [compared(k) for k in range(200)]
    energy = np.array([variants.energy_shift(other, base)[0] for base, other in pairs])
    length = np.array([variants.shift(other, base)[0] / base.crack_length.mean() for base, other in pairs])
    for found, expected in ((energy, 0.2), (length, 1.2**-0.25 - 1)):
        assert abs(found.mean() - expected) < ALLOWED * found.std(ddof=1) / np.sqrt(200)


def test_an_energy_that_is_larger_by_a_factor_has_an_error_larger_by_it():
    base, other = compared(0)
    stronger = variants.Variant(3 * other.energy, other.crack_length, other.stuck)
    assert_allclose(variants.energy_shift(stronger, base)[1], 3 * variants.energy_shift(other, base)[1])


def test_common_random_numbers_reduce_the_error_of_a_shift():
    (base, other), (stranger, _) = compared(0), compared(1)
    assert variants.shift(other, base)[1] < 0.5 * variants.shift(other, stranger)[1]


def test_a_variant_does_not_differ_from_itself():
    base, _ = compared(0)
    assert variants.shift(base, base) == (0.0, 0.0)
    assert variants.energy_shift(base, base) == (0.0, 0.0)


def test_beams_that_are_not_stuck_in_both_variants_do_not_count():
    base, other = compared(0)
    free = np.arange(BEAMS) < 5
    lost = variants.Variant(other.energy, np.where(free, 1.5e-3, other.crack_length), ~free)
    expected = (other.crack_length - base.crack_length)[~free].mean()
    assert_allclose(variants.shift(lost, base)[0], expected)
    assert_allclose(variants.shift(base, lost)[0], -expected)
    assert_allclose(variants.mean_crack_length(lost)[0], other.crack_length[~free].mean())


def test_the_rms_deviation_is_that_of_relative_deviations():
    rms, _ = variants.rms_deviation([11.0, 36.0], [0.1, 0.1], [0.0, 0.0], np.array([10.0, 40.0]))
    assert_allclose(rms, 0.1)


def test_the_error_of_an_rms_deviation_separates_own_and_common_noise():
    rng, references = np.random.default_rng(0), np.array([3.0, 5.0, 7.0, 11.0])
    values, errors = references * [1.1, 1.2, 1.3, 0.9], 0.01 * references
    for own, common in ((1, 0), (0, 1), (1, 1)):
        draws = own * rng.standard_normal((400, 4)) + common * rng.standard_normal((400, 1))
        studies = [variants.rms_deviation(values + errors * x, errors, errors, references)[0] for x in draws]
        _, stated = variants.rms_deviation(values, own * errors, common * errors, references)
        assert np.std(studies, ddof=1) == pytest.approx(stated, rel=ALLOWED / np.sqrt(2 * 399))


def test_share_of_the_deviation_that_a_variant_removes():
    references = np.array([10.0, 20.0])
    share, error = variants.removed_share([10.5, 21.0], [11.0, 22.0], references, np.zeros((3, 2)))
    assert_allclose((share, error), (0.75, 0.0), rtol=1e-12, atol=1e-12)
    shifted = variants.removed_share([10.51, 21.02], [11.0, 22.0], references, [[0.01, 0.02], [0, 0], [0, 0]])
    assert share - shifted[0] == pytest.approx(shifted[1], rel=0.02)


@pytest.mark.parametrize("part", [0, 1, 2])
def test_error_of_the_removed_share_is_that_of_repeated_studies(part):
    references, base, shift = np.array([10.0, 20.0, 30.0]), np.array([11.0, 21.0, 33.0]), np.array([-0.5, -0.2, -2.5])
    errors = np.zeros((3, 3))
    errors[part] = 0.02, 0.03, 0.05
    noise = stream(7, part).standard_normal((20_000, 3))
    draws = errors[part] * (noise if part == 1 else noise[:, :1])
    draws *= np.sign(1 - (base + shift) / references) if part == 0 else 1  # shifts that all reduce the deviation
    bases, shifts = (base, shift + draws) if part == 0 else (base + draws, shift)
    found = [
        variants.removed_share(b + s, b, references, errors)[0]
        for b, s in zip(np.broadcast_to(bases, draws.shape), np.broadcast_to(shifts, draws.shape), strict=True)
    ]
    _, error = variants.removed_share(base + shift, base, references, errors)
    # The relative standard error of a standard deviation of n draws is 1/√2n; the slope of the share varies slightly.
    assert np.std(found) == pytest.approx(error, rel=0.03)


@pytest.mark.parametrize("stuck", [0, 1])
def test_fewer_than_two_stuck_beams_have_no_crack_length(stuck):
    base, other = compared(0)
    weak = variants.Variant(other.energy, other.crack_length, np.arange(BEAMS) < stuck)
    assert np.isnan([*variants.mean_crack_length(weak), *variants.shift(weak, base), *variants.shift(base, weak)]).all()
    assert np.isfinite(variants.energy_shift(weak, base)).all()

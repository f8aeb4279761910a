import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.analysis import plasticity
from stiction.constants import HARDNESS
from stiction.contact.asperity import hertz_force, hertz_maximum_stress

SIZES = st.floats(1e-9, 1e-5)


@given(st.floats(1e-11, 1e-8), SIZES, st.floats(1e9, 1e12))
def test_the_largest_hertz_stress_is_one_and_a_half_times_the_mean_stress(interference, radius, modulus):
    mean = hertz_force(interference, radius, modulus) / plasticity.contact_area(interference, radius)
    assert_allclose(hertz_maximum_stress(interference, radius, modulus), 1.5 * mean, rtol=1e-12)


def test_only_summits_above_the_flat_touch_it():
    interference, radius = plasticity.touching(np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 10.0]), 2.0)
    assert_allclose(interference, [1.0])
    assert_allclose(radius, [0.1])


def test_silicon_yields_at_0_6_of_its_hardness():
    assert_allclose(plasticity.ONSET * HARDNESS, 7.68e9)
    assert list(plasticity.yields(np.array([7.6e9, 7.7e9]))) == [False, True]


@pytest.mark.parametrize(("stress", "share"), [(0.59, 0.0), (0.61, 1.0)])
def test_the_plastic_share_is_zero_below_and_one_above_the_onset(stress, share):
    area, strip = np.linspace(1, 2, 10), np.arange(10) // 2
    found = plasticity.plastic_share(area, np.full(10, stress * HARDNESS), strip, 5)
    assert_allclose(found, (share, 0.0), atol=1e-12)


def test_the_plastic_share_is_one_of_areas_not_of_summits():
    stress = np.tile([0.5, 0.7], 4) * HARDNESS
    share, error = plasticity.plastic_share(np.tile([1.0, 3.0], 4), stress, np.arange(8) // 2, 4)
    assert_allclose((share, error), (0.75, 0.0), atol=1e-12)


def test_the_standard_error_of_the_share_is_the_scatter_of_repeated_studies():
    rng, shares = np.random.default_rng(0), []
    for _ in range(200):
        strip = np.repeat(np.arange(40), rng.poisson(6, 40))
        stress = HARDNESS * (0.5 + 0.2 * rng.random(len(strip)))
        shares.append(plasticity.plastic_share(rng.exponential(size=len(strip)), stress, strip, 40))
    values, errors = np.transpose(shares)
    assert values.std(ddof=1) == pytest.approx(errors.mean(), rel=4 / np.sqrt(2 * 199))
    assert abs(values.mean() - 0.5) < 4 * values.std() / np.sqrt(200)


@pytest.mark.parametrize("touching", [0, 2])
def test_without_contact_on_two_strips_there_is_no_plastic_share(touching):
    found = plasticity.plastic_share(np.ones(touching), np.ones(touching), np.zeros(touching, int), 3)
    assert np.isnan(found).all()


def test_the_softer_body_decides_what_is_plastic():
    stress, area, strip = np.full(4, 0.61 * HARDNESS), np.ones(4), np.arange(4)
    shares = [plasticity.plastic_share(area, stress, strip, 4, hardness)[0] for hardness in (HARDNESS, 2 * HARDNESS)]
    assert shares == [1.0, 0.0]
    assert plasticity.yields(1.0, 1.0)
    assert not plasticity.yields(1.0, 2.0)

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stiction.contact.full.halfspace import OWN_DISPLACEMENT, HalfSpace, love, periodic_waves

MODULUS, SPACING = 86.6e9, 1e-8
UNIT = SPACING / MODULUS
#: Pressures are in single precision, and waves beyond a limit are left out of the periodic displacement.
SINGLE, ALIASES = 2e-6, 6e-4


def pressed(shape, places, periodic):
    """Displacement by unit pressures on some elements, in units of p Δ/E'."""
    pressure = np.zeros(shape, np.float32)
    for place in places:
        pressure[place] = MODULUS
    return HalfSpace(shape, SPACING, MODULUS, periodic).displacement(pressure) / SPACING


def test_displacement_of_an_element_under_its_own_pressure_is_that_of_love():
    assert love(0, 0) == pytest.approx(OWN_DISPLACEMENT, rel=1e-12)
    # Numerical integral of 1/(π r) over the square, in polar coordinates of one of its eight triangles.
    angle = (np.arange(1000) + 0.5) / 1000 * np.pi / 4
    assert pytest.approx(8 * np.mean(0.5 / np.cos(angle)) * (np.pi / 4) / np.pi, rel=1e-6) == OWN_DISPLACEMENT


@given(st.integers(20, 2000), st.integers(20, 2000))
def test_far_from_an_element_the_displacement_is_that_of_a_point_force(i, j):
    distance = np.hypot(i, j)
    assert love(i, j) * np.pi * distance == pytest.approx(1, abs=0.2 / distance**2 + 1e-9)


def test_nearby_the_displacement_is_not_that_of_a_point_force():
    assert abs(love(1, 0) * np.pi - 1) > 0.01


@pytest.mark.parametrize("periodic", [True, False])
def test_elements_displace_each_other_alike(periodic):
    first, second = (3, 4), (17, 30)
    there = pressed((24, 40), [first], periodic)[second]
    assert there == pytest.approx(pressed((24, 40), [second], periodic)[first], rel=1e-4)
    both = pressed((24, 40), [first, second], periodic)
    alone = [pressed((24, 40), [place], periodic) for place in (first, second)]
    np.testing.assert_allclose(both, sum(alone), atol=SINGLE)


def test_isolated_elements_have_the_displacement_of_love_up_to_the_ends_of_the_strip():
    i, j = np.arange(24)[:, None], np.arange(40)
    np.testing.assert_allclose(pressed((24, 40), [(0, 39)], False), love(i, 39 - j), atol=SINGLE)


def test_a_periodic_displacement_is_the_sum_over_all_images_less_its_mean():
    shape, far = (16, 16), 60
    i, j = np.arange(16)[:, None], np.arange(16)
    images = range(-far, far + 1)
    total = sum(love(np.abs(i + 16 * a), np.abs(j + 16 * b)) for a in images for b in images)
    for axis in (0, 1):  # the sum has a slope, because its images lie around the origin and not around each element
        total = (total + np.roll(np.flip(total, axis), 1, axis)) / 2
    found = pressed(shape, [(0, 0)], True)
    assert found.mean() == pytest.approx(0, abs=SINGLE)
    np.testing.assert_allclose(found - found[8, 8], total - total[8, 8], atol=ALIASES)
    alone = love(np.minimum(i, 16 - i), np.minimum(j, 16 - j))
    assert np.abs(found - found[8, 8] - alone + alone[8, 8]).max() > 10 * ALIASES


@pytest.mark.parametrize("waves", [1, 2])
def test_a_long_wave_of_pressure_has_the_displacement_of_westergaard(waves):
    """A pressure cos(k x) displaces by 2/(E' k) cos(k x)."""
    number = 2 * np.pi * waves / (256 * SPACING)
    pressure = np.repeat(np.cos(number * SPACING * np.arange(256))[:, None], 8, axis=1).astype(np.float32)
    found = HalfSpace((256, 8), SPACING, MODULUS).displacement(pressure)
    # Square elements give steps in place of a cosine, whose amplitude is less by (k Δ)²/24.
    expected = 2 / (MODULUS * number) * (1 - (number * SPACING) ** 2 / 24)
    np.testing.assert_allclose(found, expected * pressure, atol=1e-4 * expected)


def test_square_elements_are_stiffer_than_waves_of_the_grid_alone():
    """Without the waves beyond the grid, the displacement of a neighbour would be 6 % too large."""
    exact = np.fft.irfft2(periodic_waves((64, 64)))[0, 1]
    wave = 2 * np.pi * np.hypot(np.fft.fftfreq(64)[:, None], np.fft.rfftfreq(64))
    wave[0, 0] = np.inf
    assert np.fft.irfft2(2 / wave)[0, 1] / exact == pytest.approx(1.06, abs=0.01)


def test_tractions_of_displacements_are_the_pressures_without_their_mean():
    space, pressure = HalfSpace((12, 15), SPACING, MODULUS), np.random.default_rng(3).normal(5e7, 1e8, (12, 15))
    displacement = space.displacement(pressure.astype(np.float32)) + np.float32(3e-9)
    np.testing.assert_allclose(space.traction(displacement), pressure - pressure.mean(), atol=1e-4 * 1e8)
    assert space.traction(displacement).mean() == pytest.approx(0, abs=1e2)

"""Statistics that the estimate knows of surfaces and films: beside integrals, drawn heights and what a run reads."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.stats import kurtosis, skew

from stiction.beam.cantilever import Beam
from stiction.config.reading import paper
from stiction.config.surfaces.described import complete
from stiction.config.surfaces.members import members
from stiction.contact import meniscus
from stiction.devices.arcs import longest_free
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import surface
from stiction.estimate.state import Film, TipState, film, stiffness_of
from stiction.estimate.statistics import ORDERS, Heights, heights_of, moments_of
from stiction.surface.self_affine import spectrum

LIBRARY = paper()["surfaces"]


@given(st.floats(8, 60), st.floats(1.2, 10), st.floats(-9, -2.2))
def test_moments_are_the_integrals_of_the_spectrum(corner, ratio, slope):
    shape = spectrum(1e-7, slope, corner, ratio * corner)

    def moment(order):
        return sum(
            quad(lambda zeta: 2 * np.pi * shape(zeta) * zeta ** (order + 1), *ends)[0]
            for ends in ((0, corner), (corner, ratio * corner))
        )

    integrals = [moment(order) / shape.variance for order in ORDERS]
    np.testing.assert_allclose(moments_of(corner, ratio * corner, slope), integrals, rtol=1e-6)


def test_the_sum_of_drawn_heights_has_the_sum_of_their_statistics():
    rng = np.random.default_rng(1)
    gamma, other = 2e-9 * (rng.gamma(9.0, 1 / 3, 10**6) - 3), 1e-9 * rng.normal(size=10**6)
    left = Heights(2e-9, 2 / 3, 3 + 6 / 9, (1.0, 2.0, 3.0))
    both = left + Heights(1e-9, 0.0, 3.0, (3.0, 1.0, 1.0))
    np.testing.assert_allclose(both.rms, (gamma + other).std(), rtol=3e-3)
    np.testing.assert_allclose(both.skewness, skew(gamma + other), atol=0.02)
    np.testing.assert_allclose(both.kurtosis, kurtosis(gamma + other, fisher=False), atol=0.05)
    np.testing.assert_allclose(both.moments, (1.4, 1.8, 2.6))  # variances of 4 and 1 nm² weigh the spectra


@pytest.mark.parametrize(
    "entry",
    [
        {"rms_nm": 3, "like": "B2"},
        {"rms_nm": 2, "like": "Sub2", "hurst": 0.8, "corner_rad_per_um": 20},
        {"rms_nm": 2, "hurst": 0.8, "corner_rad_per_um": 20, "cutoff_rad_per_um": 125},
        {
            "rms_nm": 2,
            "hurst": 0.9,
            "corner_rad_per_um": 20,
            "cutoff_rad_per_um": 99,
            "skewness": -0.3,
            "kurtosis": 3.2,
        },
        LIBRARY["B1"],
    ],
)
def test_a_described_surface_is_the_one_that_a_run_reads(entry):
    whole = complete(dict(entry), LIBRARY)
    stated, of_members = surface(entry, LIBRARY)
    expected = heights_of(whole)
    np.testing.assert_allclose(stated.moments, expected.moments, rtol=1e-6)
    assert (stated.rms, stated.skewness, stated.kurtosis) == pytest.approx(
        (expected.rms, expected.skewness, expected.kurtosis)
    )
    for name, numbers in members(whole, LIBRARY).items():
        others = {"corner": "corner_rad_per_um", "cutoff": "cutoff_rad_per_um"}
        changed = {others.get(word, word): value for word, value in numbers.items()}
        if "hurst" in changed:
            changed["hurst"] = -changed["hurst"] / 2 - 1  # there it is the slope
        again, none = surface({k: v for k, v in entry.items() if k != "like"} | changed, LIBRARY)
        assert not none
        np.testing.assert_allclose(of_members[name].moments, again.moments, rtol=1e-6)
        assert of_members[name].kurtosis == pytest.approx(again.kurtosis)
    normal, of_normal = surface(whole, LIBRARY)  # the same from its normal form
    np.testing.assert_allclose(normal.moments, expected.moments, rtol=1e-6)
    assert of_normal.keys() == of_members.keys()
    for name, member in of_normal.items():
        np.testing.assert_allclose(member.moments, of_members[name].moments, rtol=1e-6)


@pytest.mark.parametrize(
    "entry",
    [{"rms_nm": 3}, {"rms_nm": 3, "like": "B9"}, {"scans": []}, {"rms_nm": 3, "like": "B2", "material": "gold"}],
)
def test_a_surface_that_was_not_learnt_is_refused(entry):
    with pytest.raises(NotLearnt):
        surface(entry, LIBRARY)


@given(st.floats(0.3, 0.95), st.floats(274, 372), st.floats(0, 1.5), st.floats(0, 1.5))
def test_a_film_is_the_meniscus_of_the_contact(humidity, temperature, first, second):
    angles = first, second
    water = film(humidity, temperature, sum(map(math.cos, angles)))
    assert water.height == pytest.approx(float(meniscus.meniscus_height(humidity, temperature, angles)))
    assert water.energy == pytest.approx(meniscus.flooded_energy(temperature, angles))


@given(st.floats(1, 4), st.floats(2, 40))
def test_flooded_flats_hold_a_tip_up_to_the_flooded_slope(thickness, gap):
    beam = Beam(1e-4, 3e-5, 1e-6 * thickness, 164e9, 1e-6 * gap, 1)
    heights = Heights(1e-9, 0.0, 3.0, (1e-7, 1e14, 1e29))
    state = TipState(heights, Film(2e-9, 0.144), stiffness_of(164e9, beam.thickness, beam.gap), 3e-5, 164e9)
    slopes = np.geomspace(0.5, 2, 9) * state.flooded_slope
    (length,) = longest_free(slopes, 0.144 / slopes[None], beam)
    assert 1.5 * beam.gap / length == pytest.approx(state.flooded_slope)


@given(st.floats(0.2, 5))
def test_full_contact_acts_as_a_stiffer_beam(factor):
    beam = Beam(1e-4, 3e-5, 2e-6, 164e9, 1e-5, 1)
    stiffer = Beam(1e-4, 3e-5, 2e-6, 164e9 / factor, 1e-5, 1)
    slopes = np.geomspace(0.01, 1, 40)
    forces = 0.05 / slopes[None] ** 0.6
    assert longest_free(slopes, factor * forces, beam) == pytest.approx(longest_free(slopes, forces, stiffer))


def test_coordinates_do_not_depend_on_the_scale_of_lateral_lengths():
    """Softer solids on longer waves have the same pressures; only the curvature beside the radius of edges changes."""
    film_of_water = Film(2e-9, 0.144)
    low, second, fourth = 1e-7, 1e14, 1e29
    one = TipState(Heights(3e-9, -0.5, 3.4, (low, second, fourth)), film_of_water, 7e3, 3e-5, 164e9)
    longer = Heights(3e-9, -0.5, 3.4, (2 * low, second / 4, fourth / 16))
    other = TipState(longer, film_of_water, 16 * 7e3, 6e-5, 2 * 164e9)
    np.testing.assert_allclose(one.coordinates[:9], other.coordinates[:9], rtol=1e-12)
    assert one.coordinates[9] != pytest.approx(other.coordinates[9])

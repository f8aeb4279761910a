import numpy as np
import pytest
from vectors import sampled_vectors

from stiction.contact.bounds import least_law
from stiction.contact.forcelaw import coefficients

HEIGHTS = np.linspace(-1e-9, 1e-9, 2001)


def test_a_film_that_floods_the_strip_pulls_with_its_full_tension():
    assert least_law(HEIGHTS, 1e-9, (2.1e-9, 5e7))[0] == 5e7


def test_a_film_reaches_the_share_of_the_heights_above_its_surface():
    # Heights are uniform in ±1 nm: a film of 0.5 nm below the highest point wets a quarter.
    assert least_law(HEIGHTS, 1e-9, (0.5e-9, 8e7))[0] == pytest.approx(2e7, rel=2e-3)
    assert least_law(HEIGHTS, 4e-9, (0.5e-9, 8e7))[0] == 0


def test_a_law_that_rises_over_the_whole_distance_to_the_mean_planes_is_the_least_steep():
    # d_max = d0, d_limit = 0 and f_limit = f_max
    law = coefficients(np.array([[0.5, 5e7, 1e-9, 0.0]]), 5e7)[0]
    assert least_law(HEIGHTS, 1e-9, (2.1e-9, 5e7))[1] == pytest.approx(law[2], rel=1e-12)


def test_sampled_laws_are_steeper_than_the_bound():
    vectors = sampled_vectors(300)
    laws = coefficients(vectors, vectors[:, 1].max())
    _, bound = least_law(HEIGHTS, vectors[:, 2].max(), (1e-9, 1e7))
    assert np.all(laws[:, 2] >= bound)
    assert np.any(laws[:, 2] < 20 * bound)

import numpy as np
import pytest
from vectors import F_LIMIT, VECTORS

from stiction.contact import forcelaw
from stiction.contact.correction import Correction, interpolated

HUMIDITIES = np.array([0.44, 0.67, 0.92])
CORRECTION = Correction(HUMIDITIES, np.array([0.64, 0.9, 1.0]), np.array([0.72, 0.95, 1.0]))


def corrected(vectors, humidity):
    """Vectors and threshold times the ratios of energy and force, as laws take them."""
    energy, pull_off = CORRECTION.at(humidity)
    return vectors * [energy, pull_off, 1, 1], F_LIMIT * pull_off


def test_force_laws_have_the_corrected_energy_and_depth_and_keep_the_steepness_of_their_repulsion():
    lawful = VECTORS[forcelaw.admissible(*corrected(VECTORS, 0.44))]
    base, changed = forcelaw.coefficients(lawful, F_LIMIT), forcelaw.coefficients(*corrected(lawful, 0.44))
    np.testing.assert_allclose(forcelaw.energy(changed), 0.64 * forcelaw.energy(base))
    np.testing.assert_allclose(changed[:, 0], 0.72 * base[:, 0])
    np.testing.assert_allclose(changed[:, 1:3], base[:, 1:3])
    assert np.all(changed[:, 3] != base[:, 3])


def test_between_the_computed_humidities_ratios_are_geometric_means():
    ratios = np.array([0.5, 0.98, 1.0])
    assert interpolated(ratios, HUMIDITIES, 0.555) == pytest.approx(0.7)
    assert interpolated(ratios, HUMIDITIES, 0.555) != pytest.approx(0.74)  # of their arithmetic mean
    np.testing.assert_allclose(interpolated(ratios, HUMIDITIES, HUMIDITIES), ratios, rtol=1e-15)


def test_more_points_on_the_same_lines_change_no_correction():
    axis = np.linspace(0.44, 0.92, 7)
    finer = Correction(axis, *np.array([CORRECTION.at(humidity) for humidity in axis]).T)
    finer_at = [finer.at(humidity) for humidity in (0.44, 0.48, 0.6, 0.92)]
    np.testing.assert_allclose(finer_at, [CORRECTION.at(humidity) for humidity in (0.44, 0.48, 0.6, 0.92)])


@pytest.mark.parametrize("humidity", [0.43, 0.93])
def test_nothing_is_extrapolated(humidity):
    assert np.isnan(interpolated(CORRECTION.energy, HUMIDITIES, humidity))
    with pytest.raises(ValueError, match=f"from 0.44 to 0.92 and is not extrapolated to {humidity}"):
        CORRECTION.at(humidity)

import numpy as np
import pytest
from vectors import F_LIMIT, VECTORS

from stiction.contact import forcelaw
from stiction.contact.correction import NONE, Correction, ElasticChange, TipChanges, interpolated

HUMIDITIES = np.array([0.44, 0.67, 0.92])
ENERGY = np.array([0.64, 0.9, 1.0])
CORRECTION = Correction(HUMIDITIES, ElasticChange(ENERGY), ElasticChange(np.array([0.72, 0.95, 1.0])))


def ratios_at(given, humidity):
    """Ratios of e and f_max at a humidity."""
    return [change.ratio for change in given.at(humidity)]


def corrected(vectors, humidity):
    """Vectors and threshold times the ratios of energy and force, as laws take them."""
    energy, pull_off = ratios_at(CORRECTION, humidity)
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
    finer = Correction(axis, *map(ElasticChange, np.array([ratios_at(CORRECTION, humidity) for humidity in axis]).T))
    finer_at = [ratios_at(finer, humidity) for humidity in (0.44, 0.48, 0.6, 0.92)]
    np.testing.assert_allclose(finer_at, [ratios_at(CORRECTION, humidity) for humidity in (0.44, 0.48, 0.6, 0.92)])


@pytest.mark.parametrize("humidity", [0.43, 0.93])
def test_nothing_is_extrapolated(humidity):
    assert np.isnan(interpolated(ENERGY, HUMIDITIES, humidity))
    with pytest.raises(ValueError, match=f"from 0.44 to 0.92 and is not extrapolated to {humidity}"):
        CORRECTION.at(humidity)


# Scatter


def test_beyond_the_airs_of_devices_ratios_err_to_the_safe_side():
    """Energies above those on summits stay and forces grow in wetter air, both rise from below; drier air is as dry."""

    def ratios(wettest, humidity):
        changes = ElasticChange(np.array([0.9, wettest]))
        return ratios_at(Correction(np.array([0.44, 0.67]), changes, changes, nearest=True), humidity)

    for humidity in (0.8, 0.95):
        energy, pull_off = ratios(1.139, humidity)
        assert energy == 1.139
        assert pull_off > 1.2
        np.testing.assert_allclose(ratios(0.8, humidity), 0.8 ** ((1 - humidity) / (1 - 0.67)))
    np.testing.assert_allclose(ratios(0.8, 0.3), 0.9)


@pytest.mark.parametrize("power", [1.0, 1.4, 2.0])
def test_a_change_gives_samples_the_mean_and_the_scatter_of_full_contact(power):
    summits = np.random.default_rng(1).lognormal(-8, 0.5, 4000)
    full = ElasticChange(1.3, power).of(summits)(summits)
    assert full.mean() == pytest.approx(1.3 * summits.mean())
    assert np.log(full).std() == pytest.approx(power * np.log(summits).std())
    assert np.all(np.argsort(full) == np.argsort(summits)), "the order of the samples stays"


def test_a_change_holds_for_other_values_of_the_same_samples_and_for_endless_ones():
    summits = np.array([1.0, 2.0, 4.0])
    change = ElasticChange(1.3, 1.5).of(summits)
    assert change(np.array([2.0]))[0] == change(summits)[1]
    assert change(np.inf) == np.inf
    np.testing.assert_array_equal(ElasticChange(1.3, 1.5).of(np.zeros(3))(np.zeros(3)), np.zeros(3))
    assert NONE.of(summits)(summits) is summits


def test_scatter_is_never_less_than_on_summits():
    less = Correction(np.array([0.0]), ElasticChange(3.0, 0.4, 0.0, 0.1), ElasticChange(2.0, np.nan))
    assert less.at(0) == (ElasticChange(3.0), ElasticChange(2.0))
    nearly, more = Correction(
        np.array([0.0]), ElasticChange(3.0, 0.95, 0.0, 0.15), ElasticChange(3.0, 1.2, 0.0, 0.15)
    ).at(0)
    assert (nearly.power, nearly.power_error) == pytest.approx((1.0, 0.1))
    assert (more.power, more.power_error) == (1.2, 0.15)


def test_the_upper_end_of_a_ratio_is_as_far_as_its_error_says():
    assert ElasticChange(2.0, 1.2, 0.1).at_most(0.95) == pytest.approx((2 * np.exp(0.1645), 1.2, 0.1, 0.0), rel=1e-3)
    assert ElasticChange(2.0).at_most(0.95) == ElasticChange(2.0)


# Tips


def tips(*rows, powers=1.2):
    """Correction in dry air and at 0.44, or at 0.44 alone, with the ratios of tips at slopes of 0.01, 0.02 and 0.08."""
    change = ElasticChange(np.array(rows), np.full(len(rows), powers), np.full((len(rows), 3), 0.1))
    air = ElasticChange(np.ones(len(rows)))
    return Correction(np.array([0.0, 0.44])[-len(rows) :], air, air, TipChanges(np.array([0.01, 0.02, 0.08]), change))


def test_ratios_of_tips_are_geometric_means_between_slopes_and_stay_beyond_them():
    found = tips([3.0, 1.0, 0.5], [0.9, 0.8, 0.7]).of_tips(0.0, [0.005, 0.01, np.sqrt(2e-4), 0.02, 0.04, 0.2])
    np.testing.assert_allclose([one.ratio for one in found], [3, 3, np.sqrt(3), 1, np.sqrt(0.5), 0.5])
    assert {(one.power, round(one.ratio_error, 12)) for one in found} == {(1.2, 0.1)}
    np.testing.assert_allclose(tips([0.9, 0.8, 0.7]).of_tips(0.44, [0.02])[0].ratio, 0.8)


def test_tips_scatter_no_less_than_on_summits_and_are_not_extrapolated():
    assert tips([1.0, 1.0, 1.0], powers=0.7).of_tips(0.44, [0.02])[0].power == 1
    with pytest.raises(ValueError, match="is not extrapolated to 0.5"):
        tips([1.0, 1.0, 1.0]).of_tips(0.5, [0.02])

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import PAPER
from numpy.testing import assert_allclose
from vectors import sampled_vectors

from stiction.beam.energy import arrest_length
from stiction.contact import forcelaw
from stiction.devices import bridges
from stiction.devices.sampling import SampledSurfaces, sampled_surfaces
from stiction.stages.devices import opening

LIMIT = 7e6


def on_mean(energies):
    return float(arrest_length(energies.mean(), PAPER))


def laws(number, seed=1, spread=0.24):
    return forcelaw.coefficients(sampled_vectors(number, spread, seed), LIMIT)


def cantilever(sampled):
    return sampled_surfaces(sampled, forcelaw.energy, on_mean, on_mean(forcelaw.energy(sampled)))


def scatter(sampled):
    """Scatter of the work from the mean distance, of two samples at least."""
    work = forcelaw.energy(sampled) - sampled[:, 0].mean() * (sampled[:, 1] - sampled[:, 1].mean())
    return work.std() / work.mean()


def mean_and_scatter(seed):
    """Logarithms of length and scatter of a study of 300 samples."""
    sampled = laws(300, seed)
    return np.log([on_mean(forcelaw.energy(sampled)), scatter(sampled)])


@pytest.mark.parametrize("number", [50, 300])
def test_the_error_of_the_mean_is_a_quarter_of_the_scatter_of_the_energies_over_the_root_of_their_number(number):
    # Groups of several samples leave an error of 1 / sqrt(2 * 200) in the error itself.
    sampled = laws(number)
    energies, found = forcelaw.energy(sampled), cantilever(sampled)
    expected = 0.25 * energies.std(ddof=1) / energies.mean() / np.sqrt(number)
    assert_allclose(np.sqrt(found.covariance[0, 0]), expected, rtol=0.02 if number <= 200 else 0.2)
    assert found.length == on_mean(energies)


def test_the_covariance_is_that_of_repeated_studies():
    repeated = np.cov(np.transpose([mean_and_scatter(seed) for seed in range(400)]))
    stated = np.mean([cantilever(laws(300, seed)).covariance for seed in range(40)], axis=0)
    scale = np.sqrt(np.outer(np.diag(repeated), np.diag(repeated)))
    # The kurtosis of the scatter makes the errors of its error large in single studies.
    assert_allclose(stated / scale, repeated / scale, atol=0.35)
    assert abs(repeated[0, 1] / scale[0, 1]) < 0.9  # control: mean and scatter are two numbers


def test_the_error_of_a_length_that_follows_mean_and_scatter_is_that_of_repeated_studies():
    # Lengths that lie below that on the mean by 0, 0.3 and 0.6 times the scatter of 0.3.
    below = np.array([0.0, 0.3, 0.6])
    studies = np.array([mean_and_scatter(seed) for seed in range(400)])
    repeated = (studies[:, :1] - below * np.exp(studies[:, 1:])).std(axis=0, ddof=1)
    stated = []
    for seed in range(40):
        found, spread = cantilever(laws(300, seed)), np.exp(mean_and_scatter(seed)[1])
        lengths = found.length * np.exp(-below * spread)
        stated.append(found.error(lambda move, lengths=lengths: np.log(move(lengths))))
    assert_allclose(np.mean(stated, axis=0), repeated, rtol=0.2)
    assert repeated[2] > 1.5 * repeated[0]  # control: the mean alone does not explain it


def test_errors_of_few_strips_in_full_contact_add_to_those_of_the_samples():
    exact = SampledSurfaces(2.0, np.zeros((2, 2)))
    lengths = np.array([2.0, 1.0])
    stated = exact.with_errors(0.03, 0.1).error(lambda move: np.log(move(lengths)))
    assert_allclose(stated, np.hypot(0.03, 0.1 * np.log(2.0 / lengths)), rtol=1e-9)
    assert_allclose(exact.with_errors(0.03, 0.0).with_errors(0.04, 0.0).covariance[0, 0], 0.05**2)


def test_lengths_far_below_that_on_the_mean_move_with_the_scatter_and_infinite_ones_stay():
    surfaces = SampledSurfaces(2.0, np.diag([0.0, 1e-4]))
    stated = surfaces.error(lambda move: move(np.array([2.0, 1.0, np.inf])))
    assert_allclose(stated[:2], [0.0, 1e-2 * np.log(2)], rtol=1e-3, atol=1e-12)
    assert np.isnan(stated[2])


def test_a_statistic_that_only_some_samples_leave_finite_has_no_error():
    # Before, it had an infinite one, which no table could show: two of 200 bridges stuck, just within the reach.
    surfaces = SampledSurfaces(2.0, np.diag([1e-4, 1e-4]))
    for infinite in (lambda length: length < 2, lambda length: length > 2, lambda length: length > 0):
        stated = surfaces.error(lambda move, infinite=infinite: np.array([np.inf if infinite(move(2.0)) else 1.0, 1.0]))
        assert np.isnan(stated[0])
        assert stated[1] == 0


def test_samples_that_are_all_equal_leave_no_error():
    found = cantilever(np.repeat(laws(1), 30, axis=0) * np.array([1 + 1e-12 * np.arange(30)]).T)
    assert np.all(np.abs(found.covariance[0]) < 1e-20)


def test_a_bridge_on_uniform_ground_is_held_as_the_mean_law_holds_it():
    zone = bridges.middle_zone(
        bridges.half_of_bridge(replace(PAPER, gap=2e-6, thickness=2e-6), 50e6), 0.5e-6, laws(300)
    )
    same = np.repeat(laws(1), 30, axis=0)
    assert_allclose(
        bridges.held_on_mean(zone[0], same), bridges.held_length(zone[0], np.repeat(same, 9, axis=0)[: zone[1]])
    )
    mean = forcelaw.mean_law(laws(300))
    assert_allclose(forcelaw.energy(mean), forcelaw.energy(laws(300)).mean(), rtol=1e-12)


def test_errors_of_a_bridge_are_those_of_energy_and_pull_off():
    part, opens = bridges.half_of_bridge(PAPER, 50e6), opening.BEAMS["bridge"]
    sampled = laws(100)

    def length(sampled):
        return bridges.least_length(forcelaw.energy(sampled).mean(), sampled[:, 0].mean(), part)

    left_out = np.log([length(np.delete(sampled, k, axis=0)) for k in range(100)])
    expected = 99 / 100 * np.sum((left_out - left_out.mean()) ** 2)
    found = sampled_surfaces(sampled, opens.contribution, partial(opens.length_on_mean, beam=part), 1e-4)
    assert_allclose(found.covariance[0, 0], expected, rtol=1e-9)

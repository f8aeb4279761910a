from dataclasses import replace

import numpy as np
import pytest
from ground import C1, computed, settings, wanted
from numpy.testing import assert_allclose
from vectors import sampled_vectors

from stiction.stages.devices import safe_lengths

SHARE, STUDIES, LIMIT = 0.01, 50, 7e6


def lengths(seed, samples, beams):
    """Safe length and estimate of P(stuck) = 0.01 of a study, its bound given the surfaces, and its two errors [m]."""
    cracks = computed(replace(settings(C1, beams), seed=seed), sampled_vectors(samples, 0.24, seed), LIMIT)
    exact = cracks.assign(surfaces_covariance=0 * cracks.surfaces_covariance)
    found, given = (
        safe_lengths.compute(one, None, wanted(C1, (SHARE,))).isel(shape=0, share=0) for one in (cracks, exact)
    )
    numbers = found.safe_length, found.estimate, given.safe_length, found.beams_error, found.surfaces_error
    return list(map(float, numbers))


@pytest.mark.slow
def test_bounds_are_too_long_in_one_of_twenty_studies_on_few_samples():
    # On 60 samples, the error of the surfaces is the larger one.
    true = lengths(1, 5000, 4000)[1]
    bounds, estimates, given, of_beams, of_surfaces = np.transpose([lengths(10 + k, 60, 299) for k in range(STUDIES)])
    stated = np.sqrt(np.mean(of_beams**2 + of_surfaces**2))
    assert_allclose(stated, estimates.std(ddof=1), rtol=3 / np.sqrt(2 * STUDIES))
    assert np.mean(bounds > true) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / STUDIES)
    assert np.mean(given > true) > 0.05 + 3 * np.sqrt(0.05 * 0.95 / STUDIES)  # control

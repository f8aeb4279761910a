"""Statistics of strips of which some have no summit."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.stages.surfaces import character

POWERS = np.random.default_rng(3).random((6, 4)) * 1e-3 + [0, 1, 0, 3]
CURVATURE = np.array([2.4e6, 2.6e6, 2.5e6, 2.7e6, 2.3e6, 2.8e6])


def statistics(curvature):
    """Statistics and errors of strips of these mean curvatures."""
    strips = {"power": POWERS[: len(curvature)], "summit_density": 6e13 * np.isfinite(curvature)}
    nothing = np.zeros(1), np.zeros((1, 1))
    strips |= {"mean_curvature": curvature}
    return character.statistics(character.layout(strips, nothing, np.zeros((2, 1)), (1e-9, np.zeros((1, 1)))))


def test_strips_without_a_summit_do_not_affect_the_radius_but_the_density():
    values, errors = statistics(np.where(np.arange(6) < 4, CURVATURE, np.nan))
    of_four, errors_of_four = statistics(CURVATURE[:4])
    assert_allclose(values[3], of_four[3], rtol=1e-12)
    assert errors[3] == pytest.approx(errors_of_four[3], rel=0.1)
    assert values[4] == pytest.approx(4e13)
    assert_array_equal(statistics(CURVATURE)[0][[0, 1, 2]], values[[0, 1, 2]])


def test_the_radius_is_unknown_only_if_no_strip_has_a_summit():
    only = np.where(np.arange(6) == 2, CURVATURE, np.nan)
    values, errors = statistics(only)
    assert values[3] == pytest.approx(1 / 2.5e6)
    assert np.isnan(errors[3])
    values, errors = statistics(np.full(6, np.nan))
    assert np.isnan([values[3], errors[3]]).all()
    assert np.isfinite(np.delete([values, errors], 3, axis=1)).all()


def test_narrow_strips_without_a_summit_are_drawn_without_a_warning():
    settings = small.settings_of(character, job_settings(small.PLAN, "character/B2_NG"))
    narrow = replace(settings, beam=replace(settings.beam, width=0.3e-6), character=character.StripSample(8, 100e-9))
    found = character.compute(small.heights_of("B2"), small.spectrum_of("B2"), "B2", "NG", narrow)
    assert_array_equal(np.isnan(found.mean_curvature), found.summit_density == 0)
    assert 0 < np.isnan(found.mean_curvature).sum() < 8

"""The iterative algorithm of Fig. 4 converges to the target, and to the same spectrum as the closed form."""

from itertools import islice

import numpy as np
import pytest
from published import IDENTITY
from standard_errors import ALLOWED

from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.field import StripGrid
from stiction.surface.iteration import iterate, misfit, sampling_misfit, target_rings
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import Translation, underlying_spectrum

#: Not too steep for a translation of Sub2's heights, the least Gaussian of the paper.
TARGET = CutoffSelfAffine(1e-33, 1e-35, 3e7, 1.5e8)
SKEWED = Translation(maxent.solve(-1.1, 5.1))
GRID = StripGrid(2.56e-6, 2.56e-6, 10e-9, margin=0.0)


@pytest.fixture(scope="module")
def rings():
    return target_rings(TARGET, GRID)


@pytest.fixture(scope="module")
def skewed():
    """Five iterations with a hundred fields each."""
    steps = islice(iterate(TARGET, SKEWED, GRID, 100, stream(1, "iteration")), 5)
    return tuple(np.array(column) for column in zip(*steps, strict=True))


def test_target_on_rings_has_unit_variance_and_ends_at_the_cutoff(rings):
    zeta, spectrum = rings
    variance = np.sum(2 * np.pi * zeta * spectrum) * zeta[0]
    assert variance == pytest.approx(1, rel=0.01)  # rings as areas 2πζΔζ, not as numbers of waves; no wave at 0
    assert TARGET.cutoff - zeta[0] < zeta[-1] <= TARGET.cutoff
    inner = zeta < TARGET.corner - zeta[0]
    np.testing.assert_allclose(spectrum[inner], spectrum[0], rtol=1e-12)
    np.testing.assert_allclose(spectrum[20] / spectrum[0], TARGET(zeta[20]) / TARGET(0), rtol=0.01)


def test_gaussian_heights_have_the_target_spectrum_from_the_start(rings):
    _, wanted = rings
    underlying, periodograms = next(iterate(TARGET, IDENTITY, GRID, 40, stream(2, "iteration")))
    np.testing.assert_allclose(underlying / underlying[0], TARGET(rings[0]) / TARGET(0))
    deviation = (periodograms / wanted).mean(axis=1) - 1
    assert abs(deviation.mean()) < ALLOWED * deviation.std(ddof=1) / np.sqrt(40)
    found, expected = misfit(periodograms.mean(axis=0), wanted), sampling_misfit(periodograms)
    # The relative standard deviation of the mean of n absolute normal deviations is 0.76 / √n.
    assert abs(found / expected - 1) < ALLOWED * 0.76 / np.sqrt(len(wanted))


def test_each_spectrum_is_the_previous_one_times_target_over_estimate(skewed, rings):
    underlying, periodograms = skewed
    for now, after, given in zip(underlying, underlying[1:], periodograms, strict=False):
        np.testing.assert_allclose(after, now * rings[1] / given.mean(axis=0))


def test_iteration_converges_to_the_target_within_the_noise_of_two_estimates(skewed, rings):
    _, periodograms = skewed
    errors, noise = misfit(periodograms.mean(axis=1), rings[1]), sampling_misfit(periodograms)
    assert errors[0] > 3 * noise[0]
    # An iterated spectrum has the noise of its last correction; its estimate has that of its own fields as well.
    assert errors[-1] == pytest.approx(np.sqrt(2) * noise[-1], rel=ALLOWED * 0.76 / np.sqrt(len(rings[1])))


def test_iteration_and_closed_form_find_the_same_gaussian_spectrum(skewed, rings):
    zeta, wanted = rings
    closed, defect = underlying_spectrum(TARGET, SKEWED, GRID.spacing)
    assert defect < 0.01
    # Rings at the corner and the cut-off average over the kink, differently on the two grids.
    inner = np.abs(zeta / TARGET.cutoff - 1) > 0.05
    iterated = skewed[0][-1] / np.sum(skewed[0][-1] * zeta) * np.sum(closed(zeta) * zeta)
    difference = misfit(iterated[inner], closed(zeta)[inner])
    assert difference < 2 * sampling_misfit(skewed[1])[-1]
    assert misfit(wanted[inner], closed(zeta)[inner]) > 2 * difference  # control: the test is sensitive enough


def test_every_estimate_uses_new_fields(skewed):
    first, second = skewed[1][0], skewed[1][1]
    relative = np.corrcoef((first / first.mean(axis=0)).ravel(), (second / second.mean(axis=0)).ravel())[0, 1]
    assert abs(relative) < ALLOWED / np.sqrt(first.size)


def test_misfit_of_a_factor_is_its_logarithm():
    wanted = np.array([1.0, 2.0, 5.0])
    np.testing.assert_allclose(misfit(np.array([wanted * np.e, wanted / np.e, wanted]), wanted), [1, 1, 0])
    assert misfit(wanted * [1, 1, np.e], wanted) == pytest.approx(1 / 3)


def test_sampling_misfit_falls_with_the_root_of_the_number_of_fields():
    periodograms = stream(3).exponential(size=(400, 300))
    assert sampling_misfit(periodograms[:100]) / sampling_misfit(periodograms) == pytest.approx(2, rel=0.05)


def test_a_strip_that_is_no_whole_period_is_refused():
    side = 101 * 10e-9
    assert target_rings(TARGET, StripGrid.periodic(side, 10e-9))[0][0] > 0
    with pytest.raises(ValueError, match=r"\(101, 101\) points is cut from .*: use StripGrid.periodic"):
        target_rings(TARGET, StripGrid(side, side, 10e-9, margin=0.0))

"""The histogram of heights is their density, and its errors are the scatter between scans of one surface."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from published import SURFACES
from scipy.special import ndtr
from test_model_scans import MODEL, streams

from stiction.scans.histogram import EDGES, histogram, histogram_errors
from stiction.scans.levelling import Levelling, level
from stiction.scans.quantiles import SCORES, quantiles
from stiction.scans.scan import Frame
from stiction.surface.translation import LARGEST_SCORE

CENTRES = (EDGES[1:] + EDGES[:-1]) / 2


def as_measured(scans):
    """Histogram without a correction of the quantiles."""
    found = quantiles(scans)
    return histogram(scans, found, found)


@pytest.fixture(scope="module")
def scans():
    return [MODEL.draw(rng) for rng in streams(80, "histogram")]


def test_the_histogram_of_many_scans_is_the_density_of_the_surface(scans):
    error = histogram_errors(MODEL) / np.sqrt(len(scans))
    expected = np.array(
        [np.mean(SURFACES["B2"].density(np.linspace(a, b, 21))) for a, b in zip(EDGES[:-1], EDGES[1:], strict=True)]
    )
    inside = np.abs(CENTRES) < 4
    off = (as_measured(scans) - expected) / np.maximum(error, 1e-6)
    assert np.sqrt(np.mean(off[inside] ** 2)) < 2


@pytest.mark.slow
def test_the_bias_of_levelling_is_taken_out_of_the_histogram_by_that_of_the_quantiles(scans):
    bowed = [level(z, Levelling("plane", "bow")) for z in scans]
    raw, levelled = as_measured(scans), as_measured(bowed)
    corrected = histogram(bowed, quantiles(bowed), quantiles(scans))
    assert np.abs(corrected - raw).max() < 0.3 * np.abs(levelled - raw).max()


def test_heights_beyond_the_outermost_quantiles_move_as_these_do():
    z = np.array([[-5.0, 5.0, *np.zeros(48)]])  # of unit variance
    share = histogram([z], SCORES, SCORES + 0.15)
    np.testing.assert_allclose(CENTRES[share > 0], [-4.9, 0.1, 5.1])


def test_errors_are_the_scatter_between_scans_with_the_true_rms(scans):
    counts = np.array([np.histogram(z / MODEL.rms, EDGES)[0] / z.size for z in scans]) / np.diff(EDGES)
    error = histogram_errors(MODEL)
    often = error > 0.002  # bins that most scans have heights in
    assert often.sum() > 30
    ratio = counts.std(axis=0, ddof=1)[often] / error[often]
    assert 0.85 < np.sqrt(np.mean(ratio**2)) < 1.15
    assert np.all((ratio > 0.6) & (ratio < 1.4))
    independent = np.sqrt(np.mean(counts, axis=0)[often] / np.diff(EDGES)[often] / scans[0].size)
    assert np.median(error[often] / independent) > 2, "neighbouring pixels are not independent"


def test_a_scan_of_a_single_height_has_the_errors_of_one_draw():
    # Its indicators are the same everywhere: the error of a share p is √(p (1 - p)).
    one = SimpleNamespace(translation=MODEL.translation, overlaps=np.ones_like(MODEL.overlaps))
    score = np.interp(EDGES, MODEL.translation.table, np.linspace(-LARGEST_SCORE, LARGEST_SCORE, 4097))
    share = np.diff(ndtr(score))
    inside = share > 1e-3
    errors = histogram_errors(one) * np.diff(EDGES)
    np.testing.assert_allclose(errors[inside], np.sqrt(share * (1 - share))[inside], rtol=0.02)


def test_errors_fall_with_the_side_of_a_scan():
    large = dataclasses.replace(MODEL, frame=Frame((400, 400), (8e-6, 8e-6)))
    ratio = histogram_errors(large)[20:40] / histogram_errors(MODEL)[20:40]
    np.testing.assert_allclose(ratio, 0.5, atol=0.05)


def test_undefined_points_mean_and_scale_do_not_change_the_histogram(scans):
    z = scans[0].copy()
    holed = np.where(np.arange(z.size).reshape(z.shape) % 97 == 0, np.nan, 3 * z + 5e-9)
    np.testing.assert_allclose(as_measured([holed]), as_measured([z[np.isfinite(holed)]]), rtol=1e-9)
